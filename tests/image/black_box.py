# SPDX-License-Identifier: Apache-2.0
"""black_box.py -- a closed box with a display in it, which the sun lights through one small
opening of its ceiling, by way of a patch of the floor or of a chrome knob, or the sky: scenes,
and what the display reflects in closed form.

Metres, +Y up, north -Z. The box is 1.2 x 1 x 1.01 m, the display lies in the plane z = 0 before
its far wall and faces +Z, the eye is inside. Where all but the floor is black, the patch is all
the light there is: its luminance is E sin(elevation) reflectance / pi, and it has the opening's
own shape and area, for ceiling and floor are parallel. The disc of the sun blurs its rim by a
hundredth of its distance, which keeps its flux and its middle. A mirror sphere of radius r
throws an image of the sun as a convex mirror does, of E F r^2 / 4 candela from far away.

Sources: the patch is Lambert's law, the sphere geometrical optics; the panel's BRDF is asked of
the program (reflection.py), which is no path of it.
"""
import math

from gltf import Scene, along, cross, dot, outward, png, sub, unit

WIDTH, HEIGHT = 0.3, 0.15                     # of the display
EYE = [0.1, 0.15, 0.8]
LOW, HIGH = (-0.6, -0.5, -0.01), (0.6, 0.5, 1.0)
HOLE = (0.25, 0.9)                            # x and z of the opening's middle
FLOOR = 0.8
LUX, AZIMUTH, ELEVATION = 90000, 165, 62
SYMBOL_UV = [0.1, 0.1, 0.9, 0.9]
SKY_STEP, FLOOR_STEP = 0.02, 0.06             # m, of sums over openings and floor
CLOSED_WITHIN = 0.003  # D65 for the sun between wavelengths, sums over points


def towards_sun(azimuth=AZIMUTH, elevation=ELEVATION):
    a, e = math.radians(azimuth), math.radians(elevation)
    return [math.cos(e) * math.sin(a), math.sin(e), -math.cos(e) * math.cos(a)]


def environment(lux=LUX, azimuth=AZIMUTH, elevation=ELEVATION):
    """The sun and no sky."""
    return {"type": "constant", "luminance": 0, "sun": {
        "azimuth_deg": azimuth, "elevation_deg": elevation, "illuminance_lx": lux}}


DARK = {"type": "constant", "luminance": 0}


def where_beam_is(height):
    """x and z of the middle of the sun's beam at a height."""
    sun = towards_sun()
    t = (HIGH[1] - height) / sun[1]
    return HOLE[0] - t * sun[0], HOLE[1] - t * sun[2]


def display(scene, level=1, panel="ips.panel", coating=None):
    """Bright bars on black, which the eye looks at."""
    bars = png(60, 30, [[255 if 20 <= x < 40 and 8 <= y < 22 else 0 for x in range(60)
                         for _ in range(3)] for y in range(30)])
    extensions = {"PARHELION_display": {
        "panel": panel, "content": {"index": scene.image("image/png", bars)}, "level": level}}
    if coating:
        extensions["PARHELION_coating"] = coating
    scene.quad(scene.material("screen", extensions=extensions),
               [-WIDTH / 2, -HEIGHT / 2, 0], [WIDTH, 0, 0], [0, HEIGHT, 0])
    scene.view("eye", EYE, [-x for x in EYE], 12)


def rectangle(middle, size):
    """x0, z0, x1, z1"""
    return (middle[0] - size[0] / 2, middle[1] - size[1] / 2,
            middle[0] + size[0] / 2, middle[1] + size[1] / 2)


def level_sheet(scene, material, outside, height, holes=()):
    """A horizontal sheet without the holes, in pieces between all their sides."""
    xs = sorted({outside[0], outside[2], *(h[k] for h in holes for k in (0, 2))})
    zs = sorted({outside[1], outside[3], *(h[k] for h in holes for k in (1, 3))})
    for left, right in zip(xs, xs[1:]):
        for far, near in zip(zs, zs[1:]):
            x, z = (left + right) / 2, (far + near) / 2
            if not any(h[0] < x < h[2] and h[1] < z < h[3] for h in holes):
                scene.quad(material, [left, height, far], [0, 0, near - far],
                           [right - left, 0, 0])


def box(scene, walls, floor, openings, lit_patches=()):
    """The six sides. lit_patches: (x0, z0, x1, z1) of the floor that are left out."""
    wall = scene.lambert(walls, double_sided=True)
    pale = scene.lambert(floor, double_sided=True)
    (x0, y0, z0), (x1, y1, z1) = LOW, HIGH
    w, h, d = x1 - x0, y1 - y0, z1 - z0
    for corner, right, up in (([x0, y0, z0], [w, 0, 0], [0, h, 0]),
                              ([x1, y0, z1], [-w, 0, 0], [0, h, 0]),
                              ([x0, y0, z1], [0, 0, -d], [0, h, 0]),
                              ([x1, y0, z0], [0, 0, d], [0, h, 0])):
        scene.quad(wall, corner, right, up)
    level_sheet(scene, wall, (x0, z0, x1, z1), y1, openings)
    level_sheet(scene, pale, (x0, z0, x1, z1), y0, lit_patches)


class Patch:
    """The sun's patches on the pale floor, of an opening of that size, m, or of several (x0,
    z0, x1, z1) of the ceiling."""
    closed_points = 5  # to a side of the part, for closed_form

    def __init__(self, size=None, walls=0.0, floor=FLOOR, openings=None):
        self.openings = openings or [rectangle(HOLE, size)]
        assert all(LOW[0] < o[0] < o[2] < HIGH[0] and LOW[2] < o[1] < o[3] <= HIGH[2]
                   for o in self.openings), f"outside of the ceiling: {self.openings}"
        self.walls, self.floor = walls, floor
        x, z = where_beam_is(LOW[1])
        dx, dz = x - HOLE[0], z - HOLE[1]
        self.patches = [(a + dx, b + dz, c + dx, d + dz) for a, b, c, d in self.lit()]
        self.cd_m2 = LUX * towards_sun()[1] * floor / math.pi

    def lit(self):
        """Of the openings what the sun shines through."""
        return self.openings

    def add_more(self, scene):
        """What else is in the room."""

    def scene(self, level=1, **of_display):
        scene = Scene()
        display(scene, level, **of_display)
        box(scene, self.walls, self.floor, self.openings)
        self.add_more(scene)
        return scene

    def lamp_scene(self, level=1, **of_display):
        """The same with the patches as lamps, and no sun: what samples of emitters find."""
        scene = Scene()
        display(scene, level, **of_display)
        box(scene, self.walls, self.floor, self.openings, self.patches)
        for x0, z0, x1, z1 in self.patches:
            scene.quad(scene.lambert(self.floor, self.cd_m2), [x0, LOW[1], z0],
                       [0, 0, z1 - z0], [x1 - x0, 0, 0])
        self.add_more(scene)
        return scene

    def lights(self, at):
        """Directions and illuminances on the display at a place, for walls that are black."""
        found = []
        for x0, z0, x1, z1 in self.patches:
            counts = [3 + math.ceil(40 * side) for side in (x1 - x0, z1 - z0)]
            share = self.cd_m2 * (x1 - x0) * (z1 - z0) / (counts[0] * counts[1])
            for i in range(counts[0]):
                for j in range(counts[1]):
                    to = sub([x0 + (x1 - x0) * (i + 0.5) / counts[0], LOW[1],
                              z0 + (z1 - z0) * (j + 0.5) / counts[1]], at)
                    found.append((unit(to), share * -to[1] * to[2] / dot(to, to) ** 2))
        return found

    def environment(self):
        return environment()


def pieces(sides, step):
    """Area and middles of pieces of a rectangle (x0, z0, x1, z1)."""
    lengths = sides[2] - sides[0], sides[3] - sides[1]
    counts = [1 + math.ceil(length / step) for length in lengths]
    places = [(sides[0] + lengths[0] * (i + 0.5) / counts[0],
               sides[1] + lengths[1] * (j + 0.5) / counts[1])
              for i in range(counts[0]) for j in range(counts[1])]
    return lengths[0] * lengths[1] / len(places), places


class UnderSky:
    """A Patch between black walls under a constant sky of 1 cd/m2 and no sun: what is seen of
    it through the openings, and the floor that it lights."""
    walls = 0.0

    def __init__(self, room):
        self.openings = [(area, [x, HIGH[1], z]) for sides in room.openings
                         for area, places in [pieces(sides, SKY_STEP)] for x, z in places]
        self.floor = []  # its places, and their candela
        area, places = pieces((LOW[0], 0, HIGH[0], HIGH[2]), FLOOR_STEP)
        for x, z in places:
            at = [x, LOW[1], z]
            lux = sum(self.lux(piece, at, 1) for piece in self.openings)
            self.floor.append((room.floor / math.pi * lux * area, at))

    @staticmethod
    def lux(piece, at, axis):
        """Of an opening's piece on a surface that faces up the axis."""
        to = sub(piece[1], at)
        return piece[0] * to[1] * to[axis] / dot(to, to) ** 2

    def lights(self, at):
        """As black_box.Patch.lights."""
        found = [(unit(sub(piece[1], at)), self.lux(piece, at, 2)) for piece in self.openings]
        for power, place in self.floor:
            to = sub(place, at)
            found.append((unit(to), power * -to[1] * to[2] / dot(to, to) ** 2))
        return found


class Knob:
    """A chrome sphere in the sun's beam of a wide opening; all else is black."""
    walls, closed_points = 0.0, 5

    def __init__(self, radius=0.015, opening=0.08, height=-0.3, chrome=0.6):
        self.radius, self.opening, self.chrome = radius, opening, chrome
        x, z = where_beam_is(height)
        self.middle = [x, height, z]

    def scene(self, level=1, **of_display):
        scene = Scene()
        display(scene, level, **of_display)
        box(scene, 0, 0, [rectangle(HOLE, (self.opening, self.opening))])
        smooth_sphere(scene, scene.metal(self.chrome), self.middle, self.radius,
                      unit(sub(towards_sun(), [0.2, 0, 0.9])))
        return scene

    def lights(self, at):
        """Schlick's reflectance at half the turn between sun and display; the two focal lengths
        of a convex mirror that is looked at aslant (Coddington's equations)."""
        normal = towards_sun()
        for _ in range(8):  # the place that mirrors the sun to there
            place = along(self.middle, normal, self.radius)
            normal = unit(along(towards_sun(), unit(sub(at, place)), 1))
        to, cosine = sub(place, at), dot(normal, towards_sun())
        mirrored = self.chrome + (1 - self.chrome) * (1 - cosine) ** 5
        distance, half = math.sqrt(dot(to, to)), self.radius / 2
        spread = half ** 2 / (distance + half * cosine) / (distance + half / cosine)
        return [(unit(to), LUX * mirrored * spread * unit(to)[2])]

    def environment(self):
        return environment()


def smooth_sphere(scene, material, centre, radius, pole):
    """With its own normals, so that it mirrors as a ball does; fine within 60 degrees of
    `pole`: a flat facet is seen under another angle than the ball, which is an error of the
    first order in its size. It mirrors best 10 degrees or more off the pole, where facets are
    not thin."""
    thetas = [math.radians(t) for t in [0.5 * i for i in range(121)] + [90, 120, 150, 180]]
    side, x = 240, unit(cross(pole, [0.3, 1, 0.2]))
    y, points, triangles = cross(pole, x), [], []
    for theta in thetas:
        for j in range(side):
            turn = 2 * math.pi * j / side
            points.append([math.cos(theta) * p + math.sin(theta) *
                           (math.cos(turn) * a + math.sin(turn) * b)
                           for p, a, b in zip(pole, x, y)])
    for i in range(len(thetas) - 1):
        for j in range(side):
            a, b, k = side * i, side * (i + 1), (j + 1) % side
            triangles += [[a + j, a + k, b + j]] if i > 0 else []
            triangles += [[a + k, b + k, b + j]] if i < len(thetas) - 2 else []
    places = [[c + radius * p for c, p in zip(centre, point)] for point in points]
    scene.mesh(material, places, outward(points, triangles, 1), points)


def closed_form(room, panel, part, points=3):
    """What the display reflects to the eye, cd/m2: the mean over the judged part (left, top,
    right, bottom, uv), points to a side. panel: reflection.Panel."""
    left, top, right, bottom = part
    total = 0
    for i in range(points):
        for j in range(points):
            u = left + (right - left) * (i + 0.5) / points
            v = top + (bottom - top) * (j + 0.5) / points
            at = [(u - 0.5) * WIDTH, (0.5 - v) * HEIGHT, 0]
            lights = room.lights(at)
            if not lights:
                continue
            answers = panel.ask(unit(sub(EYE, at)), [way for way, _ in lights])
            total += sum(a[0] * lux for a, (_, lux) in zip(answers, lights))
    return total / points ** 2


def review_request(level, conditions, **members):
    """Of that display: one symbol, one eye."""
    return {"title": "rare light", "scene": ["room.gltf"], "profile": "iso-15008",
            "eyes": {"eye": {"camera": "eye"}}, "levels": {"set": {"*": level}},
            "symbols": {"bar": {"display": "screen", "uv": SYMBOL_UV}},
            "frames": {"worst": 0},
            "conditions": [{"level": "set", **c} for c in conditions], **members}
