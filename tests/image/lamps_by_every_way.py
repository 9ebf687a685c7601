# SPDX-License-Identifier: Apache-2.0
"""lamps_by_every_way.py [--few] [--case N] PARHELION -- 200 random small scenes in which a lamp
lights a place by one way, beside closed forms.

Lamps: KHR point, spot and directional, a luminaire file with an opening, a small emitter. Ways: a
flat, a convex, a hollow mirror, a thin pane (mirrored or passed), a plate, and two that no
connection follows, a wedge and two mirrors. Readers: a frame, a luxmeter, a symbol of a review,
a gaze's threshold increment, `explain`. All pairs of three occur.

What is read lies within 0.5 % of the closed form or within the interval that is told; where no
connection is made, the interval holds it, or `check` or the frame names the light. An answer
that is wrong, sure and unnamed fails. Intervals are 95 %: of those that are off by more than
0.5 %, one in twenty may miss. A table of lamps, ways and readers is printed. --few: ten cases.

Closed forms: images, Coddington's equations for spheres, Fresnel's and Snell's laws of
each polarisation, all inner reflections of a plate, rays through a wedge; EN 13201-3's veil.
"""
import json
import math
import os
import random
import sys
import tempfile

import contrast
import worst_part
from gltf import Scene, along, cross, dot, quaternion_looking, sub, unit, upright
from review import Report, Reviewer, moment

LAMPS = ("point", "spot", "directional", "luminaire", "emitter")
WAYS = ("flat", "convex", "hollow", "pane", "plate", "wedge", "two mirrors")
READERS = ("frame", "meter", "symbol", "gaze", "explain")
LOST = ("wedge", "two mirrors")    # no connection is made by these
COUNT, FEW = 200, 10
WITHIN, TRUTH_WITHIN = 0.005, {"wedge": 0.02}  # a wedge's inner reflections are left out
IOR, METAL = 1.5, 0.6
HALF = 0.08                        # m, of mirrors and panes
OPENING, EDGE = 0.02, 0.015        # m, of the luminaire and of the emitter
INNER, OUTER = 0.25, 0.5           # radians, of the spot
RHO = 0.5                          # of what a frame sees
WIDE, HIGH = 1e-3 * worst_part.WIDE, 1e-3 * worst_part.HIGH  # m, of the display
UV = [worst_part.BOX[k] / (worst_part.WIDE, worst_part.HIGH)[k % 2] for k in range(4)]
SEEN = 0.02                        # m, half of what a frame sees
AGE = 50


# ---- vectors ---------------------------------------------------------------------------------

def scaled(a, t):
    return [t * x for x in a]


def mirrored(d, n):
    return along(d, n, -2 * dot(d, n))


def length(a):
    return math.sqrt(dot(a, a))


def tilted(draw, d, degrees):
    """d, turned about a random axis across it."""
    x = unit(cross(d, [draw.gauss(0, 1) for _ in range(3)]))
    a = math.radians(degrees)
    return unit(along(scaled(d, math.cos(a)), x, math.sin(a)))


# ---- Fresnel ---------------------------------------------------------------------------------

def faces(cosine, n=IOR):
    """Reflectances of one face, s and p, met in air."""
    inner = math.sqrt(1 - (1 - cosine ** 2) / n ** 2)
    return [((a - b) / (a + b)) ** 2 for a, b in ((cosine, n * inner), (n * cosine, inner))]


def refracted(d, n, ratio):
    """d into the medium behind the face of normal n (either way); ratio: n1 / n2."""
    if dot(d, n) > 0:
        n = scaled(n, -1)
    c = -dot(d, n)
    k = 1 - ratio ** 2 * (1 - c * c)
    return along(scaled(d, ratio), n, ratio * c - math.sqrt(k))


def schlick(c):
    return METAL + (1 - METAL) * (1 - c) ** 5


# ---- lamps -----------------------------------------------------------------------------------

class Lamp:
    def __init__(self, draw, kind, at, aim):
        """aim: where it shines, unit."""
        self.kind, self.at = kind, at
        self.power = draw.uniform(100, 400)  # cd, or lx
        self.axis = aim if kind == "directional" else tilted(draw, aim, draw.uniform(2, 12))

    def cd(self, way):
        c = dot(self.axis, way)
        if self.kind == "spot":
            low, high = math.cos(OUTER), math.cos(INNER)
            return self.power * min(max((c - low) / (high - low), 0), 1) ** 2
        return self.power * (max(c, 0) if self.kind in ("luminaire", "emitter") else 1)

    def add(self, scene):
        if self.kind in ("point", "directional"):
            scene.light(self.kind, self.power, self.at, self.axis)
        elif self.kind == "spot":
            scene.light("spot", self.power, self.at, self.axis,
                        spot={"innerConeAngle": INNER, "outerConeAngle": OUTER})
        elif self.kind == "emitter":
            scene.facing_quad(scene.emitter(self.power / EDGE ** 2), self.at, self.axis, EDGE)
        else:
            self.add_file(scene)

    def add_file(self, scene):
        gammas = range(91)
        values = " ".join("%.7g" % (self.power * math.cos(math.radians(g))) for g in gammas)
        text = ("IESNA:LM-63-2002\n[TEST] none\n[MANUFAC] none\nTILT=NONE\n1 -1 1 91 1 1 2 "
                f"-{OPENING} -{OPENING} 0\n1 1 30\n{' '.join(map(str, gammas))}\n0\n{values}\n")
        scene.files["lamp.ies"] = text.encode()
        scene.used.add("EXT_lights_ies")
        scene.document.setdefault("extensions", {})["EXT_lights_ies"] = {
            "lights": [{"uri": "lamp.ies"}]}
        scene._node({"name": "lamp", "translation": list(self.at),
                     "rotation": quaternion_looking(self.axis, upright(self.axis)),
                     "extensions": {"EXT_lights_ies": {"light": 0}}})


# ---- ways: each tells what it sends to a point, (direction there, lux on what faces it) -----

class Square:
    """A flat piece about `at` that looks along n."""

    def __init__(self, at, n):
        self.at, self.n = at, n
        self.x = unit(cross(upright(n), n))
        self.y = cross(n, self.x)

    def add(self, scene, material):
        scene.facing_quad(material, self.at, self.n, 2 * HALF)

    def image(self, p):
        return along(p, self.n, -2 * dot(sub(p, self.at), self.n))

    def crossed(self, a, d, reach=math.inf, room=1.0):
        """Where the ray meets it, or None."""
        away = dot(d, self.n)
        t = dot(sub(self.at, a), self.n) / away if away else -1
        if not 1e-6 < t < reach:
            return None
        p = along(a, d, t)
        off = sub(p, self.at)
        return p if max(abs(dot(off, self.x)), abs(dot(off, self.y))) < room * HALF else None


class Mirrors:
    """Light by flat mirrors, one after the other from the point on."""

    def __init__(self, squares, share=schlick):
        self.squares, self.share = squares, share

    def add(self, scene):
        for square in self.squares:
            square.add(scene, scene.metal(METAL))

    def sends(self, p, lamp):
        return self.by(p, lamp, self.squares)

    def by(self, p, lamp, squares, room=1.0):
        image, way = lamp.at, lamp.axis
        for square in reversed(squares):
            image, way = square.image(image), mirrored(way, square.n)
        distance = length(sub(image, p))
        d = scaled(way, -1) if lamp.kind == "directional" else unit(sub(image, p))
        share, first, at, to = 1, d, p, d
        for square in squares:
            at = square.crossed(at, to, room=room)
            if at is None:
                return []
            share *= self.share(abs(dot(to, square.n)))
            to = mirrored(to, square.n)
        lux = lamp.power if lamp.kind == "directional" else \
            lamp.cd(scaled(to, -1)) / distance ** 2
        return [(first, share * lux)]


class Pane(Mirrors):
    def __init__(self, square, is_passed):
        super().__init__([square], lambda c: sum(2 * r / (1 + r) for r in faces(c)) / 2)
        self.is_passed = is_passed

    def add(self, scene):
        self.squares[0].add(scene, scene.window(IOR))

    def sends(self, p, lamp):
        if not self.is_passed:
            return super().sends(p, lamp)
        d, lux = straight(p, lamp)
        c = abs(dot(d, self.squares[0].n))
        return [(d, lux * sum((1 - r) / (1 + r) for r in faces(c)) / 2)]


class Sphere:
    """bend: 1 / radius, of a hollow mirror negative; the piece's middle at `at`."""

    def __init__(self, at, n, bend):
        self.at, self.n, self.bend = at, n, bend
        self.x = unit(cross(upright(n), n))
        self.y = cross(n, self.x)
        self.middle = along(at, n, -1 / bend)

    def point(self, a, b):
        """Place and normal towards the front."""
        off = sub(along(along(self.at, self.x, a), self.y, b), self.middle)
        n = scaled(unit(off), math.copysign(1, self.bend))
        return along(self.middle, n, 1 / self.bend), n

    def add(self, scene, steps=48):
        grid = [HALF * (2 * k / steps - 1) for k in range(steps + 1)]
        found = [self.point(a, b) for b in grid for a in grid]
        row = steps + 1
        triangles = [t for j in range(steps) for i in range(steps) for k in [j * row + i]
                     for t in ([k, k + 1, k + row + 1], [k, k + row + 1, k + row])]
        scene.mesh(scene.metal(METAL), [p for p, _ in found], triangles, [n for _, n in found])

    def miss(self, p, lamp, a, b):
        """How far the point of the mirror is from turning the lamp to p."""
        q, n = self.point(a, b)
        to = scaled(lamp.axis, -1) if lamp.kind == "directional" else unit(sub(lamp.at, q))
        off = along(to, unit(sub(p, q)), 1)
        off = along(off, n, -dot(off, n))
        return dot(off, self.x), dot(off, self.y)

    def sends(self, p, lamp):
        a = b = 0.0
        for _ in range(12):  # Newton's steps
            h = 1e-6
            f, fa, fb = (self.miss(p, lamp, a + i, b + j) for i, j in ((0, 0), (h, 0), (0, h)))
            m = [[(fa[k] - f[k]) / h, (fb[k] - f[k]) / h] for k in (0, 1)]
            det = m[0][0] * m[1][1] - m[0][1] * m[1][0]
            a -= (m[1][1] * f[0] - m[0][1] * f[1]) / det
            b -= (m[0][0] * f[1] - m[1][0] * f[0]) / det
        assert max(abs(a), abs(b)) < HALF and max(map(abs, self.miss(p, lamp, a, b))) < 1e-9
        q, n = self.point(a, b)
        to = sub(q, p)
        l, d = length(to), unit(to)
        c, k = -dot(d, n), 2 * self.bend
        if lamp.kind == "directional":
            lux = lamp.power / abs((1 + k * l / c) * (1 + k * l * c))
        else:
            s = length(sub(lamp.at, q))
            lux = lamp.cd(unit(sub(q, lamp.at))) / abs((s + l + k * s * l / c) *
                                                       (s + l + k * s * l * c))
        return [(d, schlick(c) * lux)]


class Solid:
    """Clear, before `at`, as thick as `depth` in its middle; its back leans by `lean`, radians."""

    def __init__(self, at, n, depth, lean=0.0):
        self.front, self.depth, self.lean = Square(at, n), depth, lean
        x = self.front.x
        back = unit(along(scaled(n, -math.cos(lean)), x, math.sin(lean)))
        self.back = Square(along(at, n, -depth), scaled(back, -1))

    def add(self, scene):
        f, slope, half = self.front, math.tan(self.lean), 2 * HALF
        corners = []
        for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
            at = along(along(f.at, f.x, half * x), f.y, half * y)
            corners.append((at, along(at, f.n, -self.depth + slope * half * x)))
        (a, e), (b, g), (c, h), (d, i) = corners
        faces_of = [[a, b, c, d], [i, h, g, e], [e, g, b, a], [g, h, c, b], [h, i, d, c],
                    [i, e, a, d]]
        points = [p for face in faces_of for p in face]
        scene.mesh(scene.glass(IOR), points, [t for k in range(6) for t in (
            [4 * k, 4 * k + 1, 4 * k + 2], [4 * k, 4 * k + 2, 4 * k + 3])])

    # a plate

    def sends(self, p, lamp):
        return self.plate(p, lamp) if not self.lean else self.wedge(p, lamp)

    def plate(self, p, lamp):
        n, t = scaled(self.front.n, -1), self.depth
        if lamp.kind == "directional":
            d = scaled(lamp.axis, -1)
            return [(d, lamp.power * sum((1 - r) / (1 + r) for r in faces(dot(d, n))) / 2)]
        to = sub(lamp.at, p)
        air = dot(to, n) - t
        side = along(to, n, -dot(to, n))
        lateral, side = length(side), unit(side)
        found = []
        for order in range(4):
            def reached(sine, depth=(2 * order + 1) * t):
                return air * sine / math.sqrt(1 - sine ** 2) + \
                    depth * sine / math.sqrt(IOR ** 2 - sine ** 2)
            low, high = 0.0, 1 - 1e-12
            for _ in range(100):
                sine = (low + high) / 2
                low, high = (sine, high) if reached(sine) < lateral else (low, sine)
            cosine, h = math.sqrt(1 - sine ** 2), 1e-6
            slope = (reached(sine + h) - reached(sine - h)) / (2 * h)  # of lateral by the sine
            spread = sine / (lateral * slope * cosine ** 2)
            d = along(scaled(n, cosine), side, sine)
            share = sum((1 - r) ** 2 * r ** (2 * order) for r in faces(cosine)) / 2
            found.append((d, share * spread * lamp.cd(scaled(d, -1))))
        return found

    # a wedge

    def traced(self, p, d):
        """Place and direction behind it."""
        at, n = p, (self.front, self.back)
        for face, ratio in zip(n, (1 / IOR, IOR)):
            at = along(at, d, dot(sub(face.at, at), face.n) / dot(d, face.n))
            d = refracted(d, face.n, ratio)
        return at, d

    def landed(self, p, d, lamp, x, y):
        """Off the lamp, across its light; of a directional one the difference of directions."""
        at, d = self.traced(p, d)
        if lamp.kind == "directional":
            off = sub(d, scaled(lamp.axis, -1))
        else:
            off = sub(along(at, d, dot(sub(lamp.at, at), d)), lamp.at)
        return dot(off, x), dot(off, y), d

    def wedge(self, p, lamp):
        d = scaled(lamp.axis, -1) if lamp.kind == "directional" else unit(sub(lamp.at, p))
        h = 1e-6
        for _ in range(12):
            u = unit(cross(upright(d), d))
            v = cross(d, u)
            way = self.traced(p, d)[1]
            x = unit(cross(upright(way), way))
            y = cross(way, x)
            f, fu, fv = (self.landed(p, unit(e), lamp, x, y)
                         for e in (d, along(d, u, h), along(d, v, h)))
            m = [[(fu[k] - f[k]) / h, (fv[k] - f[k]) / h] for k in (0, 1)]
            det = m[0][0] * m[1][1] - m[0][1] * m[1][0]
            a = (m[1][1] * f[0] - m[0][1] * f[1]) / det
            b = (m[0][0] * f[1] - m[1][0] * f[0]) / det
            d = unit(along(along(d, u, -a), v, -b))
        share = 0.5 * sum((1 - r) * (1 - q) for r, q in zip(
            faces(abs(dot(d, self.front.n))), faces(abs(dot(f[2], self.back.n)))))
        lux = lamp.power if lamp.kind == "directional" else lamp.cd(scaled(f[2], -1))
        return [(d, share * lux / abs(det))]


def straight(p, lamp):
    """As if nothing else were there."""
    if lamp.kind == "directional":
        return scaled(lamp.axis, -1), lamp.power
    to = sub(lamp.at, p)
    return unit(to), lamp.cd(scaled(unit(to), -1)) / dot(to, to)


# ---- a case ----------------------------------------------------------------------------------

ORIGIN = [0, 0, 0]


class Case:
    """The place that is lit is the origin, and faces +Z; gazes look anywhere."""

    def __init__(self, draw, lamp, way, reader):
        self.kinds, self.draw, self.reader = (lamp, way, reader), draw, reader
        while not self.arrange(draw, lamp, way):
            pass

    def arrange(self, draw, lamp, way):
        up, turn = (math.radians(draw.uniform(*r)) for r in ((15, 35), (0, 360)))
        self.to = [math.sin(up) * math.cos(turn), math.sin(up) * math.sin(turn), math.cos(up)]
        l, s = draw.uniform(0.6, 1.1), draw.uniform(0.5, 1.1)
        at, back = scaled(self.to, l), scaled(self.to, -1)
        n = tilted(draw, back, draw.uniform(10, 35))
        beside = along(at, unit(cross(upright(n), n)), draw.uniform(0, 0.2 * HALF))
        on = scaled(mirrored(back, n), -1)  # where what comes from the place goes on
        self.is_beside = True               # the lamp's own light comes, too
        if way == "flat":
            self.way = Mirrors([Square(beside, n)])
        elif way == "pane":
            self.way = Pane(Square(beside, n), draw.random() < 0.5)
        elif way == "convex":
            self.way = Sphere(at, n, 1 / draw.uniform(0.4, 2))
        elif way == "hollow":
            self.way = Sphere(at, n, -1 / draw.uniform(3, 6))
        elif way == "two mirrors":
            second = along(at, on, draw.uniform(0.4, 0.7))
            m = tilted(draw, scaled(on, -1), draw.uniform(10, 35))
            self.way = Mirrors([Square(at, n), Square(second, m)])
            at, on = second, mirrored(on, m)
        else:
            self.way = Solid(at, n, draw.uniform(0.004, 0.015),
                             0 if way == "plate" else math.radians(draw.uniform(3, 8)))
        if way in ("plate", "wedge") or way == "pane" and self.way.is_passed:
            on, self.is_beside = self.to, False
        place = along(at, on, s)
        self.lamp = Lamp(draw, lamp, place, scaled(on, -1))
        if way == "wedge":  # the light that goes by its middle
            place, d = self.way.traced(ORIGIN, self.to)
            self.lamp = Lamp(draw, lamp, along(place, d, s), scaled(d, -1))
        return self.is_clear()

    def is_clear(self):
        """Nothing stands before another, and an emitter's back is not seen."""
        d = straight(ORIGIN, self.lamp)[0]
        if self.is_beside and abs(d[2]) < 0.1:
            return False
        if self.lamp.kind == "emitter" and self.is_beside and dot(d, self.lamp.axis) > 0:
            return False
        if self.kinds[1] != "two mirrors":
            return True
        first, second = self.way.squares
        middle, reach = sub(second.at, first.at), length(sub(self.lamp.at, ORIGIN))
        reach = math.inf if self.lamp.kind == "directional" else reach
        others = [self.way.by(ORIGIN, self.lamp, mirrors, room=1.5) for mirrors in (
            [first], [second], [second, first])]
        return not (any(others) or any(m.crossed(ORIGIN, d, reach, 1.5) for m in (first, second))
                    or second.crossed(ORIGIN, self.to, room=1.5)
                    or first.crossed(second.at, unit(sub(self.lamp.at, second.at)), room=1.5)
                    or dot(middle, first.n) < 0)

    def arrivals(self, p):
        found = self.way.sends(p, self.lamp)
        return found + ([straight(p, self.lamp)] if self.is_beside else [])

    def lux(self, p):
        return sum(lux * max(d[2], 0) for d, lux in self.arrivals(p))

    def mean_lux(self, box, size=(WIDE, HIGH)):
        """Over a box of the display, (left, top, right, bottom)."""
        left, top, right, bottom = box
        places = [[(left + (right - left) * (i + 0.5) / 3 - 0.5) * size[0],
                   (0.5 - top - (bottom - top) * (j + 0.5) / 3) * size[1], 0]
                  for i in range(3) for j in range(3)]
        return sum(map(self.lux, places)) / 9

    # ---- scenes

    def scene(self):
        scene = Scene()
        self.way.add(scene)
        self.lamp.add(scene)
        return scene

    def eye(self):
        """Away from the way's side."""
        side = unit([-self.to[0], -self.to[1], 0])
        return along(scaled(side, 0.2), [0, 0, 1], 0.35)


def screen(scene, corner, right, up, level):
    bars = scene.image("image/png", worst_part.content())
    material = scene.material("screen", extensions={"PARHELION_display": {
        "panel": "closed.panel", "content": {"index": bars}, "level": level}})
    scene.quad(material, corner, right, up)


# ---- readers: (what, found, interval, truth) -------------------------------------------------

class Reader:
    def __init__(self, program, folder):
        self.reviewer = Reviewer(program, folder)
        contrast.write_set(folder)
        assert self.reviewer.run("panel", "fit", "MANIFEST.json", "-o",
                                 "closed.panel").returncode == 0

    def path(self, name):
        return os.path.join(self.reviewer.folder, name)

    def ask(self, *line):
        done = self.reviewer.run(*line, "--json", "--threads", "1")
        assert done.returncode in (0, 1), f"{' '.join(line)}: {done.stderr}"
        return json.loads(done.stdout)

    def frame(self, case):
        scene = case.scene()
        scene.facing_quad(scene.lambert(RHO), ORIGIN, [0, 0, 1], 3 * SEEN)
        scene.probe("eye", [0, 0, 0.1], [0, 0, -1], SEEN)
        scene.write(self.path("s.gltf"))
        self.ask("render", "s.gltf", "-o", "a.exr", "--size", "8x8", "--spp", "64",
                 "--layers", "halves,variance",
                 "--environment", "constant:1e-6")
        told = self.ask("measure", "a.exr")
        return [("luminance", told["luminance_cd_m2"], told["luminance_interval"],
                 RHO / math.pi * case.mean_lux([0, 0, 1, 1], [2 * SEEN] * 2))]

    def meter(self, case):
        case.scene().write(self.path("s.gltf"))
        told = self.ask("measure", "s.gltf", "--illuminance", "0,0,0,0,0,1", "--samples",
                        "16384", "--environment", "constant:1e-6")
        return [("illuminance", told["illuminance_lx"], told["illuminance_interval"],
                 case.lux(ORIGIN))]

    def display_scene(self, case):
        scene = case.scene()
        screen(scene, [-WIDE / 2, -HIGH / 2, 0], [WIDE, 0, 0], [0, HIGH, 0], 1e-3)
        scene.view("eye", case.eye(), scaled(case.eye(), -1), 10)
        scene.write(self.path("s.gltf"))

    def request(self, symbol, gaze=None):
        return {"title": "lamps", "scene": ["s.gltf"], "profile": "iso-15008",
                "eyes": {"eye": {"position_m": ORIGIN} if gaze else {"camera": "eye"}},
                "symbols": {"bar": {"display": "screen", "uv": UV, **symbol}},
                "conditions": [moment("lamp", type="constant", luminance=1e-6)],
                "precision": {"contrast": 0.01, "clear": 0.05}, "frames": {"worst": 0},
                **({"gaze": [gaze]} if gaze else {})}

    def symbol(self, case):
        self.display_scene(case)
        review = self.reviewer.review(self.request({}), "out", "--threads", "1")[1]
        told = review["cases"][0]
        light, mean = told["luminance_cd_m2"], told["symbol_mean"]
        part = [told["judged_part_uv"][side] for side in ("left", "top", "right", "bottom")]
        whole, judged = (contrast.RHO / math.pi * case.mean_lux(box) for box in (UV, part))
        shown = [light[k] for k in ("foreground", "background")]
        return [("symbol mean", mean["reflected"], mean["reflected_interval"], whole),
                ("contrast", told["contrast_ratio"], told["contrast_interval"],
                 (max(shown) + judged) / (min(shown) + judged))]

    def explain(self, case):
        self.display_scene(case)
        told = self.ask("explain", "s.gltf", "--display", "screen", "--eye",
                        ",".join(map(str, case.eye())), "--look-at", "0,0,0",
                        "--uv", ",".join(map(str, UV)),
                        "--paths", "8192", "--environment", "constant:1e-6")
        return [("reflected", told["luminance_cd_m2"]["reflected"], told["reflected_interval"],
                 contrast.RHO / math.pi * case.mean_lux(UV))]

    def gaze(self, case):
        direction = case.to  # nothing within 6 degrees
        while any(dot(d, direction) > 0.9945 for d, _ in case.arrivals(ORIGIN)):
            direction = tilted(case.draw, case.to, case.draw.uniform(9, 18))
        scene = case.scene()
        screen(scene, [-0.05, -0.025, -3], [0.1, 0, 0], [0, 0.05, 0], 1e-9)
        scene.write(self.path("s.gltf"))
        review = self.reviewer.review(self.request({}, {
            "name": "road", "direction": direction,
            "road": {"luminance_cd_m2": 1, "ages_years": [AGE]}}), "out", "--threads", "1")[1]
        told = review["gazes"][0]["road"]["ages"][0]
        veil = 0
        for d, lux in case.arrivals(ORIGIN):
            cosine = dot(d, direction)
            if cosine > 0:
                degrees = math.degrees(math.acos(cosine))
                veil += lux * cosine * 9.86 / degrees ** 2 * (1 + (AGE / 66.4) ** 4)
        return [("TI", told["threshold_increment_pct"], told["threshold_increment_interval"],
                 65 * veil)]

    def names(self):
        """What is said to be missed."""
        return [pair["part"] for pair in self.ask("check", "s.gltf")["missed_light"]]


# ---- what is held ----------------------------------------------------------------------------

class Cell:
    def __init__(self):
        self.figures = self.near = self.held = self.named = self.wrong = 0
        self.worst = 0.0

    def words(self):
        return (f"{self.figures} figures, worst {100 * self.worst:.3g} %, {self.near} within "
                f"0.5 %, {self.held} more in their interval, {self.named} more named, "
                f"{self.wrong} wrong")


def stretched(low, high, times):
    middle, half = (low + high) / 2, (high - low) / 2
    return middle - times * half, middle + times * half


class Table:
    def __init__(self, report):
        self.report, self.cells, self.asked, self.missed = report, {}, 0, 0

    def add(self, number, case, figures, reader):
        names = None
        for what, found, (low, high), truth in figures:
            error = abs(found / truth - 1)
            give = TRUTH_WITHIN.get(case.kinds[1], 1e-4) * truth
            holds = low - give <= truth <= high + give
            low2, high2 = stretched(low, high, 2)
            nearly = low2 - give <= truth <= high2 + give and high > low
            if error > WITHIN:
                self.asked += 1
                self.missed += not holds and nearly
            if error > WITHIN and not holds and names is None:
                names = reader.names()
            is_named = bool(names)
            within = WITHIN
            is_wrong = error > within and not nearly and not is_named
            text = (f"case {number}, {', '.join(case.kinds)}: {what} {found:.5g} [{low:.5g}, "
                    f"{high:.5g}], right is {truth:.5g}")
            if error > WITHIN and not holds:
                print(text + (f", named: {names}" if is_named else ""), flush=True)
            self.report.claim(not is_wrong, text)
            for kind in case.kinds:
                cell = self.cells.setdefault(kind, Cell())
                cell.figures += 1
                cell.near += error <= WITHIN
                cell.held += error > WITHIN and holds
                cell.named += error > WITHIN and not holds and is_named
                cell.wrong += is_wrong
                if case.kinds[1] not in LOST:
                    cell.worst = max(cell.worst, error)

    def finish(self):
        for kind in LAMPS + WAYS + READERS:
            if kind in self.cells:
                print(f"{kind}: {self.cells[kind].words()}")
        print(f"of {self.asked} figures that are off by more, {self.missed} lie just outside of "
              "their intervals")
        self.report.claim(self.missed <= 2 + 0.08 * self.asked,
                          f"{self.missed} of {self.asked} outside of 95 % intervals")


def kinds_of(number, draw):
    """Every lamp, way and reader together once in the first 175; then any."""
    all_of = len(LAMPS) * len(WAYS) * len(READERS)
    k = number * 67 % all_of if number < all_of else draw.randrange(all_of)  # 67: no divisor
    return (LAMPS[k % 5], WAYS[k // 5 % 7], READERS[k // 35])


def main(words):
    count = FEW if "--few" in words else COUNT
    only = [int(words[words.index("--case") + 1])] if "--case" in words else range(count)
    report = Report()
    table = Table(report)
    with tempfile.TemporaryDirectory() as folder:
        reader = Reader(words[-1], folder)
        for number in only:
            draw = random.Random(number)
            case = Case(draw, *kinds_of(number, draw))
            table.add(number, case, getattr(reader, case.reader)(case), reader)
    table.finish()
    return report.finish()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
