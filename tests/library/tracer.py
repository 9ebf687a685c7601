# SPDX-License-Identifier: Apache-2.0
"""tracer.py -- another renderer: a path tracer of a room with a measured display and a lamp, in
numpy, that asks the panel through libparhelion-panel. It shares nothing with the program but
the panel: sums over wavelengths instead of 16 lanes, one lamp sample a bounce, no weighting.

The room is a list of rectangles: corner, right, up (front towards right x up), and what they
are made of. Light that BSDF samples find on the lamp counts after the camera and mirrors only,
since every other bounce asks the lamp itself; the display's light counts wherever it is met.
"""
import numpy

FIRST_NM, LAST_NM, WAVES = 360, 830, 32
LUMENS = 683.002


class Rectangle:
    def __init__(self, corner, right, up, reflectance=0.5, emission=0.0, panel=None,
                 content=None):
        self.corner, self.right, self.up = (numpy.array(v, float) for v in (corner, right, up))
        cross = numpy.cross(self.right, self.up)
        self.area = numpy.linalg.norm(cross)
        self.normal = cross / self.area
        self.reflectance, self.emission, self.panel = reflectance, emission, panel
        self.content = None if content is None else numpy.array(content, float)

    def hit(self, origin, direction):
        """Distance (inf: none), and u to the right, v up, 0 to 1."""
        down = direction @ self.normal
        with numpy.errstate(divide="ignore", invalid="ignore"):
            t = ((self.corner - origin) @ self.normal) / down
            at = origin + t[:, None] * direction - self.corner
            u, v = at @ self.right / (self.right @ self.right), at @ self.up / (
                self.up @ self.up)
            good = (t > 1e-6) & (u >= 0) & (u <= 1) & (v >= 0) & (v <= 1)
        return numpy.where(good, t, numpy.inf), u, v

    def frame(self):
        """Rows right, up, normal: the display's own axes."""
        return numpy.stack([self.right / numpy.linalg.norm(self.right),
                            self.up / numpy.linalg.norm(self.up), self.normal])


def frame_of(normal):
    """Two directions across a normal, which varies by path."""
    other = numpy.where(numpy.abs(normal[:, :1]) < 0.9, [[1.0, 0, 0]], [[0, 1.0, 0]])
    x = numpy.cross(other, normal)
    x /= numpy.linalg.norm(x, axis=1, keepdims=True)
    return x, numpy.cross(normal, x)


class Tracer:
    """table: rows of x, y, z of the observer and D65's radiance of 1 cd/m2 in column 6, every
    nm from 360 on."""

    def __init__(self, room, table, seed, bounces):
        self.room, self.table, self.bounces = room, numpy.array(table), bounces
        self.random = numpy.random.default_rng(seed)
        self.lamps = [k for k, r in enumerate(room) if r.emission]

    def choose_wavelengths(self):
        step = (LAST_NM - FIRST_NM) / WAVES
        self.nm = FIRST_NM + step * (numpy.arange(WAVES) + self.random.random())
        nm = numpy.arange(FIRST_NM, LAST_NM + 1)
        self.to_xyz = LUMENS * step * numpy.stack(
            [numpy.interp(self.nm, nm, self.table[:, k]) for k in range(3)], 1)
        self.daylight = numpy.interp(self.nm, nm, self.table[:, 6])

    def nearest(self, origin, direction):
        rows = [r.hit(origin, direction) for r in self.room]
        t = numpy.stack([row[0] for row in rows])
        which = numpy.argmin(t, 0)
        path = numpy.arange(len(origin))
        u, v = (numpy.stack([row[k] for row in rows])[which, path] for k in (1, 2))
        return which, t[which, path], u, v

    def is_clear(self, origin, to):
        """Nothing between two points."""
        t = numpy.min([r.hit(origin, to - origin)[0] for r in self.room], 0)
        return t > 1 - 1e-6

    def trace(self, origin, direction):
        """XYZ along rays, cd/m2."""
        self.choose_wavelengths()
        count = len(origin)
        self.xyz, self.light = numpy.zeros((count, 3)), numpy.zeros((count, WAVES))
        throughput = numpy.ones((count, WAVES))
        counts = numpy.ones(count, bool)  # whether a lamp that is met counts
        alive = numpy.arange(count)
        for bounce in range(self.bounces + 1):
            which, t, u, v = self.nearest(origin, direction)
            state = [a[t < numpy.inf] for a in (which, u, v, throughput, counts, alive)]
            good = t < numpy.inf
            point = (origin + t[:, None] * direction)[good]
            ways = -direction[good]
            which, u, v, throughput, counts, alive = state
            self.add_emission(bounce, which, (u, v), ways, (throughput, counts, alive))
            if bounce == self.bounces or not len(which):
                break
            out = self.scatter(which, point, (u, v), ways, (throughput, alive))
            origin, direction, throughput, counts, keep = out
            alive = alive[keep]
        return self.xyz + self.light @ self.to_xyz

    def add_emission(self, bounce, which, uv, ways, state):
        throughput, counts, alive = state
        for k, r in enumerate(self.room):
            on = (which == k) & (ways @ r.normal > 0)
            if r.emission:
                on &= counts
                self.light[alive[on]] += throughput[on] * r.emission * self.daylight
            if r.panel:
                local = ways[on] @ r.frame().T
                code, place = self.content_at(r, uv[0][on], uv[1][on])
                if bounce == 0:  # seen straight: the measured XYZ
                    self.xyz[alive[on]] += r.panel.emission_xyz(local, code, place)
                else:
                    self.light[alive[on]] += throughput[on] * r.panel.emission_spectrum(
                        local, code, self.nm, place)

    @staticmethod
    def content_at(r, u, v):
        rows, columns = r.content.shape[:2]
        i = numpy.minimum((u * columns).astype(int), columns - 1)
        j = numpy.minimum(((1 - v) * rows).astype(int), rows - 1)
        return r.content[j, i], numpy.stack([u, 1 - v], 1)

    def scatter(self, which, point, uv, ways, state):
        """Asks a lamp, chooses a direction; the paths that go on."""
        throughput, alive = state
        count = len(which)
        normal = numpy.stack([r.normal for r in self.room])[which]
        onward, weight = numpy.zeros((count, 3)), numpy.zeros((count, WAVES))
        counts = numpy.zeros(count, bool)
        lamp, share = self.lamp_sample(point, normal)
        front = numpy.sum(ways * normal, 1) > 0
        for k, r in enumerate(self.room):
            on = numpy.flatnonzero((which == k) & front)
            if not len(on):
                continue
            if r.panel:
                place = self.content_at(r, uv[0][on], uv[1][on])[1]
                f, onward[on], weight[on], counts[on] = self.display(r, ways[on], lamp[on],
                                                                     place)
            else:
                f = numpy.full((len(on), WAVES), r.reflectance / numpy.pi)
                onward[on], weight[on] = self.diffuse(normal[on]), r.reflectance
            self.light[alive[on]] += throughput[on] * f * share[on, None] * self.daylight
        keep = weight.max(1) > 0
        return (point[keep], onward[keep], (throughput * weight)[keep], counts[keep],
                numpy.flatnonzero(keep))

    def lamp_sample(self, point, normal):
        """The direction to a random point of a lamp, and its cosines, area and light."""
        k = self.lamps[self.random.integers(len(self.lamps))]
        r = self.room[k]
        s = self.random.random((len(point), 2))
        to = r.corner + s[:, :1] * r.right + s[:, 1:] * r.up
        way = to - point
        square = numpy.maximum(numpy.sum(way * way, 1), 1e-12)
        way /= numpy.sqrt(square)[:, None]
        there = numpy.maximum(0, -(way @ r.normal))
        here = numpy.maximum(0, numpy.sum(way * normal, 1))
        share = here * there / square * r.area * r.emission * len(self.lamps)
        return way, share * self.is_clear(point, to)

    def diffuse(self, normal):
        """Directions by the cosine."""
        a, b = self.random.random(len(normal)), 2 * numpy.pi * self.random.random(len(normal))
        x, y = frame_of(normal)
        s = numpy.sqrt(a)
        return (x * (s * numpy.cos(b))[:, None] + y * (s * numpy.sin(b))[:, None]
                + normal * numpy.sqrt(1 - a)[:, None])

    def display(self, r, ways, lamp, place):
        """f towards the lamp; a direction, its weight, and whether it is the mirror's."""
        axes = r.frame()
        viewer = ways @ axes.T
        f = r.panel.brdf(viewer, lamp @ axes.T, self.nm, place)
        mirror = r.panel.mirror(viewer, self.nm, place)
        haze = r.panel.albedo(viewer, place)
        mean = mirror.mean(1)
        chance = mean / numpy.maximum(mean + haze, 1e-9)
        is_mirror = self.random.random(len(ways)) < chance
        light, density = r.panel.sample(viewer, self.random.random((len(ways), 3)), place)
        light = numpy.where(is_mirror[:, None], viewer * [-1, -1, 1], light)
        onwards = r.panel.brdf(viewer, light, self.nm, place) * light[:, 2:]
        with numpy.errstate(divide="ignore", invalid="ignore"):
            weight = numpy.where(is_mirror[:, None], mirror / chance[:, None],
                                 onwards / (density * (1 - chance))[:, None])
        weight = numpy.where(is_mirror | (density > 0), weight.T, 0).T
        return f, light @ axes, weight, is_mirror


def camera_rays(random, eye, forward, yfov, size):
    """One ray through a random place of each pixel, row by row from the top; up is +Y."""
    width, height = size
    forward = numpy.array(forward, float) / numpy.linalg.norm(forward)
    right = numpy.cross(forward, [0, 1, 0])
    right /= numpy.linalg.norm(right)
    up = numpy.cross(right, forward)
    j, i = numpy.divmod(numpy.arange(width * height), width)
    x = 2 * (i + random.random(len(i))) / width - 1
    y = 1 - 2 * (j + random.random(len(j))) / height
    half = numpy.tan(yfov / 2)
    ways = (forward + (x * half * width / height)[:, None] * right + (y * half)[:, None] * up)
    ways /= numpy.linalg.norm(ways, axis=1, keepdims=True)
    return numpy.tile(numpy.array(eye, float), (len(ways), 1)), ways
