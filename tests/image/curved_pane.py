# SPDX-License-Identifier: Apache-2.0
"""curved_pane.py PARHELION -- the ghost of curved laminated panes against a tracer of the
test's own: two faces, spheres or cylinders, parallel or with a wedge between them, refraction
and mirrors in double precision. Radii 1, 2 and 5 m, convex and concave, curved along, across
and askew of the plane of incidence, 45 to 70 degrees: where the ghost stands, and that the
wedge which the tracer finds takes it away.
"""
import math
import os
import sys
import tempfile

from eye import Eye, luminances
from glazing import INDEX, ROOT, THICKNESS, faces, laminate, pane
from gltf import Scene, along, dot, sub, unit

sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

# The pane touches y = 0 at the origin, where the middle ray meets it. How far away are the eye,
# on the side of -x, and what it sees, on that of +x: in m before a convex pane, in radii before
# a concave one, well within its focus.
CONVEX, CONCAVE = (0.8, 1.7), (0.3, 0.2)
SIDE, SPP = 64, 96  # of a frame,
WIDE = 1.4          # whose half is so many times as wide as the ghost is away
SHAPES = {"sphere": None, "curved along": [0, 0, 1], "curved across": [1, 0, 0],
          "curved askew": [math.sqrt(0.5), 0, math.sqrt(0.5)]}  # axes of cylinders


# ---- the tracer ----------------------------------------------------------------------------

class Face:
    """A sphere or a cylinder; its normal has y > 0 about the origin."""

    def __init__(self, centre, axis, radius):
        self.centre, self.axis, self.radius = centre, axis, radius
        self.sign = 1 if centre[1] < 0 else -1

    def across(self, v):
        return along(v, self.axis, -dot(v, self.axis)) if self.axis else v

    def normal(self, point):
        return [self.sign * x for x in unit(self.across(sub(point, self.centre)))]

    def meet(self, point, way):
        """The place about the origin where the line meets it."""
        q, w = self.across(sub(point, self.centre)), self.across(way)
        half, rest = dot(q, w), dot(q, q) - self.radius ** 2
        root = math.sqrt(half * half - dot(w, w) * rest)
        places = [along(point, way, (-half + x) / dot(w, w)) for x in (root, -root)]
        return min(places, key=lambda p: dot(p, p))

    def leaning(self, depth, alpha):
        """The same turned about the point at this depth, so that y falls towards +x."""
        c, s, middle = math.cos(alpha), math.sin(alpha), [0, -depth, 0]

        def turn(v):
            return [c * v[0] + s * v[1], c * v[1] - s * v[0], v[2]]
        return Face(along(middle, turn(sub(self.centre, middle)), 1),
                    self.axis and turn(self.axis), self.radius)


def pane_faces(shape, radius, alpha=0.0):
    """radius > 0: convex where it is met. alpha: by how much it grows thicker towards +x."""
    far_radius = abs(radius - THICKNESS)
    far = Face([0, -radius, 0], SHAPES[shape], far_radius).leaning(THICKNESS, alpha)
    return Face([0, -radius, 0], SHAPES[shape], abs(radius)), far


def refracted(way, normal, eta):
    """eta: the index before the face over that behind it."""
    cosine = dot(way, normal)
    inside = math.sqrt(1 - eta * eta * (1 - cosine * cosine))
    return along([eta * x for x in way], normal,
                 math.copysign(inside, cosine) - eta * cosine)


def mirrored(way, normal):
    return along(way, normal, -2 * dot(way, normal))


def image_ray(near, far, point, way, order):
    """(place, way) of what a sight becomes after `order` reflections by the far face."""
    point = near.meet(point, way)
    if not order:
        return point, mirrored(way, near.normal(point))
    way = refracted(way, near.normal(point), 1 / INDEX)
    for i in range(order):
        if i:
            way = mirrored(way, near.normal(point))
        point = far.meet(point, way)
        way = mirrored(way, far.normal(point))
        point = near.meet(point, way)
    return point, refracted(way, near.normal(point), INDEX)


class Sight:
    """An eye, what it looks at by way of the pane, and axes across both."""

    def __init__(self, angle, radius):
        self.near, self.far = CONVEX if radius > 0 else (-radius * x for x in CONCAVE)
        self.way = [math.sin(angle), -math.cos(angle), 0]
        self.up, self.right = [math.cos(angle), math.sin(angle), 0], [0, 0, 1]
        self.out = [math.sin(angle), math.cos(angle), 0]
        self.across = [-math.cos(angle), math.sin(angle), 0]
        self.eye = [-self.near * x for x in self.way]
        self.goal = [self.far * x for x in self.out]

    def miss(self, both, order, place):
        """By how much a sight (right, up; tangents) misses the goal, across the way to it."""
        way = unit(along(along(self.way, self.right, place[0]), self.up, place[1]))
        point, way = image_ray(*both, self.eye, way, order)
        way_to = dot(sub(self.goal, point), self.out) / dot(way, self.out)
        off = sub(along(point, way, way_to), self.goal)
        return dot(off, self.right), dot(off, self.across)

    def shown(self, both, order):
        """The sight that meets the goal, by Newton's method."""
        place, h = [0.0, 0.0], 1e-6
        for _ in range(8):
            x, y = self.miss(both, order, place)
            (a, c), (b, d) = (
                [(after - before) / (2 * h) for after, before in
                 zip(self.miss(both, order, [place[0] + h * i, place[1] + h * j]),
                     self.miss(both, order, [place[0] - h * i, place[1] - h * j]))]
                for i, j in ((1, 0), (0, 1)))
            det = a * d - b * c
            place = [place[0] - (d * x - b * y) / det, place[1] - (a * y - c * x) / det]
        return place

    def wedge(self, shape, radius):
        """rad: the ghost stands neither above nor below the image."""
        low, high = 0.0, 1e-3
        for _ in range(8):
            a, b = (self.shown(pane_faces(shape, radius, alpha), 1)[1]
                    for alpha in (low, high))
            if a == b:
                break
            low, high = high, high - b * (high - low) / (b - a)
        return high


# ---- the renderer --------------------------------------------------------------------------

def curved(scene, material, shape, radius):
    """A patch with its exact normals; u grows along x."""
    face, steps, half = pane_faces(shape, radius)[0], 24, 0.07 * abs(radius)
    points, normals, uvs = [], [], []
    for i in range(steps + 1):
        for j in range(steps + 1):
            x, z = half * (2 * i / steps - 1), half * (1 - 2 * j / steps)
            points.append(face.meet([x, 0, z], [0, 1, 0]))
            normals.append(face.normal(points[-1]))
            uvs.append([i / steps, j / steps])
    triangles = []
    for i in range(steps):
        for j in range(steps):
            a, b = i * (steps + 1) + j, (i + 1) * (steps + 1) + j
            triangles += [[a, b, b + 1], [a, b + 1, a + 1]]
    scene.mesh(material, points, triangles, normals, uvs)


def bright_spot(sight, shape, radius, alpha, size):
    scene = Scene()
    layers = laminate(1, abs(alpha), "+u" if alpha > 0 else "-u")
    curved(scene, scene.material("pane", pane(layers), doubleSided=True), shape, radius)
    scene.facing_quad(scene.emitter(1e6), sight.goal, [-x for x in sight.out], size,
                      up=sight.across)
    return scene


def spots(values, least):
    """((right, up) in pixels from the middle, light) of each bright patch, brightest first;
    none of the specks at its edge."""
    left = {i for i, value in enumerate(values) if value > least}
    found = []
    while left:
        edge, light, x, y = [left.pop()], 0, 0, 0
        while edge:
            i = edge.pop()
            light += values[i]
            x += values[i] * (i % SIDE + 0.5 - SIDE / 2)
            y += values[i] * (SIDE / 2 - i // SIDE - 0.5)
            beside = {i - SIDE, i + SIDE} | ({i - 1} if i % SIDE else set()) | (
                {i + 1} if (i + 1) % SIDE else set())
            edge += beside & left
            left -= beside
        found.append(((x / light, y / light), light))
    found.sort(key=lambda spot: -spot[1])
    return [spot for spot in found if spot[1] > 0.1 * found[0][1]]


def look(eye, sight, scene, field):
    """Luminances of a frame whose half is `field`, a tangent."""
    scene.view("eye", sight.eye, sight.way, math.degrees(2 * math.atan(field)), up=sight.up)
    return luminances(eye.frame(scene, "--size", f"{SIDE}x{SIDE}", "--spp", str(SPP)))


def minutes(tangent):
    return 60 * math.degrees(math.atan(tangent))


def check_pane(report, eye, shape, radius, degrees):
    angle = math.radians(degrees)
    sight, both = Sight(angle, radius), pane_faces(shape, radius)
    wanted, missed = sight.shown(both, 1), sight.miss(both, 1, [0, 0])
    away, size = math.hypot(*wanted), math.hypot(*missed) / 5
    values = look(eye, sight, bright_spot(sight, shape, radius, 0, size), WIDE * away)
    name = f"{shape}, radius {radius} m, {degrees} degrees"
    found = spots(values, 0.2 * max(values))
    if len(found) != 2:
        report.claim(False, f"{name}: {len(found)} images, required: 2")
        return
    pixel = 2 * WIDE * away / SIDE
    (first, _), (second, _) = found
    off = [pixel * (b - a) - w for a, b, w in zip(first, second, wanted)]
    report.claim(math.hypot(*off) < 0.02 * away,
                 f"{name}: the ghost stands {minutes(pixel * (second[0] - first[0])):.3f}, "
                 f"{minutes(pixel * (second[1] - first[1])):.3f} minutes beside the image, "
                 f"required: {minutes(wanted[0]):.3f}, {minutes(wanted[1]):.3f}")
    check_wedge(report, eye, (sight, shape, radius, size, away), name)


def check_wedge(report, eye, pane_of, name):
    """Image and ghosts cannot be told apart: their centre is looked at. The ghost has (1 - r)^2
    of the image's light, weaker ones the rest. What is nearer than half a metre asks for a
    wedge of several mrad, which moves where the ghost comes out, too: that is left out."""
    sight, shape, radius, size, away = pane_of
    alpha = sight.wedge(shape, radius)
    values = look(eye, sight, bright_spot(sight, shape, radius, alpha, size), WIDE * away)
    light = sum(values)
    up = sum(v * (SIDE / 2 - i // SIDE - 0.5) for i, v in enumerate(values)) / light
    angle = math.asin(sight.way[0])
    first, second = (sum(share(r) for r in faces(angle)) for share in (
        lambda r: r, lambda r: (1 - r) ** 2 * r))
    left = minutes(2 * WIDE * away / SIDE * up * (first + second) / second)
    least = 0.2 if sight.far > 0.5 else 0.05 * minutes(away)
    report.claim(abs(left) < least, f"{name}: a wedge of {1e3 * alpha:.4f} mrad leaves "
                                    f"{left:.3f} minutes, required: {least:.3f} at most")


def main():
    program, report = sys.argv[-1], Report()
    with tempfile.TemporaryDirectory() as folder:
        eye = Eye(program, folder)
        for radius in (1, -1, 2, -2, 5, -5):
            flattest = 60 if radius == -1 else 70  # beyond, d / radius counts by its square
            for degrees in (45, flattest):
                check_pane(report, eye, "sphere", radius, degrees)
                check_pane(report, eye, "curved askew", radius, degrees)
            check_pane(report, eye, "curved along", radius, 60)
            check_pane(report, eye, "curved across", radius, 60)
    return report.finish()


if __name__ == "__main__":
    sys.exit(main())
