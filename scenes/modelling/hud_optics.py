# SPDX-License-Identifier: Apache-2.0
"""The optics of the car's head-up display: windscreen, one freeform mirror, a small picture.

The mirror is a Cartesian surface: light from the picture's middle P0 that it throws at any
point W of the windscreen leaves towards the eyes as if it came from the virtual image's middle
V0. From Fermat's principle, with o the light's direction behind W, i the one before it and
M = W - t i the point of the mirror,

    |P0 - M| + t = C + |V0 - W|,  t = (k^2 - |Q|^2) / (2 (k + Q.i)),  Q = P0 - W,
    k = C + |V0 - W|;  o = unit(W - V0), i = o - 2 (o.n) n

(n the windscreen's normal; C says how far off the mirror stands). Only the middle is without
fault; what is left elsewhere the picture's warp takes away for an eye in the middle of the box.

Frame as shapes.py: x to the right, y forward, z up, metres; light runs from the picture to the
eye, sight against it.
"""
import math

import numpy as np

from windscreen import screen, screen_normal

EYE = np.array([-0.37, 0.0, 1.300])  # the middle of the eye box
EYE_BOX = (0.110, 0.040)  # m, width and height
DISTANCE = 2.5  # m from the eye to the virtual image
DOWN = 5.5  # degrees, its middle
FIELD = (4.0, 1.5)  # degrees, width and height
TO_MIRROR = 0.320  # m from the windscreen to the mirror along the middle ray
TO_PICTURE = 0.200  # m from the mirror to the picture
PICTURE_WAY = (0.0, -0.995, -0.096)  # from the mirror to the picture
GLASS = ((0.0021, 1.52), (0.00076, 1.485), (0.0021, 1.52))  # m, index: as materials.py has it
MARGIN = 0.004  # m of windscreen around what the eye box needs


def unit(a):
    a = np.asarray(a, float)
    return a / np.linalg.norm(a, axis=-1, keepdims=True)


def dot(a, b):
    return (a * b).sum(-1)[..., None]


def mirrored(way, normal):
    return way - 2 * dot(way, normal) * normal


def refracted(way, normal, eta):
    """eta: the index of refraction before the face over that behind it."""
    cosine = dot(way, normal)
    inside = np.sqrt(1 - eta**2 * (1 - cosine**2))
    return eta * way + (np.copysign(inside, cosine) - eta * cosine) * normal


def meet(surface, origin, way, start):
    """(a, b) where rays meet surface(a, b), by Newton's method from `start`."""
    origin, way = np.broadcast_arrays(np.asarray(origin, float), np.asarray(way, float))
    a, b = (np.broadcast_to(s, way.shape[:-1]).astype(float) for s in start)
    t = np.linalg.norm(surface(a, b) - origin, axis=-1)
    h = 1e-6
    for _ in range(12):
        point = surface(a, b)
        miss = point - origin - t[..., None] * way
        columns = [(surface(a + h, b) - surface(a - h, b)) / (2 * h),
                   (surface(a, b + h) - surface(a, b - h)) / (2 * h), -way]
        step = np.linalg.solve(np.stack(columns, -1), -miss[..., None])[..., 0]
        a, b, t = a + step[..., 0], b + step[..., 1], t + step[..., 2]
    return a, b


def sight(right_deg, up_deg):
    """Where an eye looks: angles from the middle of the field, as on a screen before it."""
    right = np.tan(np.radians(np.asarray(right_deg, float)))
    up = np.tan(np.radians(np.asarray(up_deg, float)))
    c, s = math.cos(math.radians(DOWN)), math.sin(math.radians(DOWN))
    return unit(np.stack(np.broadcast_arrays(right, c + s * up, c * up - s), -1))


def on_image(right_deg, up_deg):
    """A point of the virtual image, the plane across the middle sight."""
    way = sight(right_deg, up_deg)
    return EYE + way * (DISTANCE / dot(way, sight(0, 0)))


class Optics:
    """Everything follows from the constants above and the windscreen's shape."""

    def __init__(self, surface=screen, normal=screen_normal, start=(-0.5, 0.4)):
        self.surface, self.normal, self.start = surface, normal, start
        self.virtual = on_image(0, 0)
        u, v = meet(surface, EYE, sight(0, 0), start)
        self.middle = float(u), float(v)
        glass = surface(u, v)
        way = self._before(u, v)
        first = glass - TO_MIRROR * way
        self.picture = first + TO_PICTURE * unit(PICTURE_WAY)
        self.constant = (TO_PICTURE + TO_MIRROR - np.linalg.norm(self.virtual - glass))
        self._picture_axes(glass, first, way)

    def _before(self, u, v):
        """The light's direction before the windscreen."""
        return mirrored(unit(self.surface(u, v) - self.virtual), self.normal(u, v))

    def mirror(self, u, v):
        """The mirror's point that serves the windscreen's (u, v)."""
        u, v = np.broadcast_arrays(np.asarray(u, float), np.asarray(v, float))
        glass, way = self.surface(u, v), self._before(u, v)
        k = self.constant + np.linalg.norm(self.virtual - glass, axis=-1)[..., None]
        q = self.picture - glass
        return glass - way * (k * k - dot(q, q)) / (2 * (k + dot(q, way)))

    def mirror_normal(self, u, v):
        return unit(self._before(u, v) - unit(self.mirror(u, v) - self.picture))

    def _picture_axes(self, glass, first, way):
        """The picture lies across its middle ray; its up is what the driver sees upright, and
        its right is to the right of someone who faces it."""
        self.facing = unit(first - self.picture)
        angles = [self._on_picture_plane(EYE, sight(*a)) for a in ((0, 0.05), (0, -0.05))]
        self.up = unit(angles[0] - angles[1])
        self.right = np.cross(self.up, self.facing)
        normal = self.normal(*self.middle)
        self.incidence = math.degrees(math.acos(abs(float(dot(way, normal)[0]))))
        s = mirrored(unit(np.cross(way, normal)), self.mirror_normal(*self.middle))
        self.s_azimuth = math.degrees(math.atan2(float(dot(s, self.up)[0]),
                                                 float(dot(s, self.right)[0]))) % 180

    def _on_picture_plane(self, eye, way, ghost=None):
        """Where a sight from the eye ends. ghost: a wedge, rad, for the image of the glass's
        far face."""
        u, v = meet(self.surface, eye, way, self.start)
        glass, back = self.surface(u, v), mirrored(way, self.normal(u, v))
        if ghost is not None:
            glass, back = self._by_far_face(u, v, way, ghost)
        a, b = meet(self.mirror, glass, back, (u, v))
        last = mirrored(back, self.mirror_normal(a, b))
        point = self.mirror(a, b)
        return point + last * (dot(self.picture - point, self.facing) / dot(last, self.facing))

    def _by_far_face(self, u, v, way, wedge):
        """(place, direction) of a sight that went through the glass to its far face and back,
        refracted by each layer's face on its way. Faces are parallel to the inner one; the
        middle layer grows thicker towards the roof, from its thickness at (u, v)."""
        h = 1e-4
        rise = (self.surface(u, v + h) - self.surface(u, v - h)) / (2 * h)  # m for v of 1
        place, index = self.surface(u, v), [1.0] + [n for _, n in GLASS]
        for face in (0, 1, 2, 3, 2, 1, 0):
            depth, grows = sum(d for d, _ in GLASS[:face]), wedge if face > 1 else 0.0

            def surface(a, b, depth=depth, grows=grows * np.linalg.norm(rise, axis=-1)):
                return (self.surface(a, b) +
                        (depth + grows * (b - v))[..., None] * self.normal(a, b))
            a, b = meet(surface, place, way, (u, v))
            place, normal = surface(a, b), unit(self.normal(a, b) - grows * unit(rise))
            if face == 3:
                way = mirrored(way, normal)
            else:
                inwards = dot(way, normal) > 0
                before, after = index[face:face + 2]
                way = refracted(way, normal, np.where(inwards, before / after, after / before))
        return place, way

    def on_picture(self, eye, way, ghost=None):
        """(right, up) in metres on the picture of what an eye sees in a direction."""
        place = self._on_picture_plane(eye, way, ghost) - self.picture
        return np.stack([dot(place, self.right)[..., 0], dot(place, self.up)[..., 0]], -1)

    def ghost(self, wedge=0.0, eye=EYE):
        """(right, up) in minutes of arc from the picture's middle to its ghost."""
        middle = self.virtual - eye
        way = unit(middle)
        right = unit(np.cross(way, (0, 0, 1)))
        up = np.cross(right, way)
        turn = 1e-4
        jacobian = np.stack([
            (self.on_picture(eye, unit(way + turn * d)) -
             self.on_picture(eye, unit(way - turn * d))) / (2 * turn) for d in (right, up)], -1)
        shown = np.linalg.solve(jacobian, -self.on_picture(eye, way, wedge))
        return np.degrees(shown) * 60

    def wedge(self):
        """rad: leaves the middle of the picture without a ghost above or below it."""
        low, high = 0.0, 1e-3
        for _ in range(8):
            a, b = self.ghost(low)[1], self.ghost(high)[1]
            low, high = high, high - b * (high - low) / (b - a) if a != b else high
        return high

    def patch(self):
        """((u, u), (v, v)) of the windscreen that the eye box needs for the whole field."""
        x, z = (np.array([-0.5, 0, 0.5]) * s for s in EYE_BOX)
        f, g = (np.array([-0.5, 0, 0.5]) * s for s in FIELD)
        found = []
        for dx in x:
            for dz in z:
                eye = EYE + np.array([dx, 0, dz])
                target = on_image(f[:, None], g[None, :])
                found.append(np.stack(meet(self.surface, eye, unit(target - eye), self.start),
                                      -1).reshape(-1, 2))
        found = np.concatenate(found)
        more = np.array([MARGIN / 0.66, MARGIN / 0.99])
        low, high = found.min(0) - more, found.max(0) + more
        return (low[0], high[0]), (low[1], high[1])
