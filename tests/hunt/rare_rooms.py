# SPDX-License-Identifier: Apache-2.0
"""rare_rooms.py -- random rooms whose light is rare, in a box of black or grey walls
(tests/image/black_box.py): holes of 3 mm to 10 cm, slits, drawn blinds, a gap beside a sun
visor, a chrome knob in the sun, a lamp behind a grille or a keyhole.

Between black walls what the display reflects is a closed form, of the sky that is seen through
the openings, too. With grey ones the patches of sun are replaced by lamps of the same
luminance: a room that samples of emitters find without luck.
"""
import math
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "image"))
import black_box  # noqa: E402
from black_box import HIGH, HOLE, Patch, Knob, rectangle, towards_sun  # noqa: E402
from gltf import Scene, along, dot, sub, unit  # noqa: E402


EVERY = 4  # rooms of the hunt: one is rare


def is_rare(seed):
    return seed % EVERY == 2


def log_uniform(draw, low, high):
    return math.exp(draw.uniform(math.log(low), math.log(high)))


def walls(draw):
    """Black in two rooms of three."""
    return 0.0 if draw.random() < 0.67 else round(draw.uniform(0.02, 0.5), 2)


def hole(draw):
    side = log_uniform(draw, 0.003, 0.1)
    return Patch((side, side * draw.uniform(0.5, 2)), walls(draw), draw.uniform(0.3, 0.85))


def slit(draw):
    width, length = log_uniform(draw, 0.001, 0.01), draw.uniform(0.1, 0.3)
    size = (width, length / 2) if draw.random() < 0.5 else (length, width)
    return Patch(size, walls(draw), draw.uniform(0.3, 0.85))


def blinds(draw):
    """Three to six gaps between slats."""
    count, pitch = draw.randint(3, 6), draw.uniform(0.02, 0.03)
    gap, half = log_uniform(draw, 0.0005, 0.006), draw.uniform(0.05, 0.2)
    first = HOLE[1] - 0.5 * count * pitch
    return Patch(walls=walls(draw), floor=draw.uniform(0.3, 0.85), openings=[
        (HOLE[0] - half, first + i * pitch, HOLE[0] + half, first + i * pitch + gap)
        for i in range(count)])


class Visor(Patch):
    """A wide opening, a visor below it that leaves a gap of the beam."""
    DROP = 0.04

    def __init__(self, draw):
        self.gap = log_uniform(draw, 0.001, 0.02)
        super().__init__((0.16, 0.1), walls(draw), draw.uniform(0.3, 0.85))

    def lit(self):
        (x0, z0, x1, z1), = self.openings
        return [(x1 - self.gap, z0, x1, z1)]

    def add_more(self, scene):
        """As far as the sun's edge at its height, a hand wider on all other sides."""
        (x0, z0, x1, z1), = self.openings
        sun = towards_sun()
        dx, dz = (self.DROP * x / sun[1] for x in (sun[0], sun[2]))
        black_box.level_sheet(scene, scene.lambert(0, double_sided=True),
                              (x0 - dx - 0.1, z0 - dz - 0.1, x1 - self.gap - dx,
                               min(z1 - dz + 0.1, HIGH[2])), HIGH[1] - self.DROP)


def knob(draw):
    return Knob(log_uniform(draw, 0.004, 0.02), 0.08, draw.uniform(-0.4, -0.25),
                draw.uniform(0.4, 0.9))


class Grille:
    """A lamp above the ceiling, which is slats with gaps there; all is black, so that only what
    shines through the gaps is reflected."""
    walls, ABOVE = 0.0, 0.03
    closed_points = 11  # from place to place other parts of the lamp are seen

    def __init__(self, draw):
        self.side, self.cd_m2 = draw.uniform(0.01, 0.06), log_uniform(draw, 1e3, 1e6)
        count, pitch = draw.randint(2, 5), draw.uniform(0.01, 0.02)
        gap = log_uniform(draw, 0.0005, 0.005)
        x, z = (k * HIGH[1] / (HIGH[1] + self.ABOVE) for k in HOLE)  # as the display sees it
        first = z - 0.5 * (count - 1) * pitch
        self.openings = [(x - 0.05, first + i * pitch - gap / 2, x + 0.05,
                          first + i * pitch + gap / 2) for i in range(count)]
        self.middle = [HOLE[0], HIGH[1] + self.ABOVE, HOLE[1]]

    def scene(self, level=1, **of_display):
        scene = Scene()
        black_box.display(scene, level, **of_display)
        black_box.box(scene, 0, 0, self.openings)
        scene.facing_quad(scene.emitter(self.cd_m2), self.middle, [0, -1, 0], self.side)
        return scene

    def lights(self, at):
        """Of each gap the part of the lamp that is seen through it: a rectangle of the lamp's
        plane, for gap and lamp are parallel."""
        t = (self.middle[1] - at[1]) / (HIGH[1] - at[1])
        lamp = rectangle((self.middle[0], self.middle[2]), (self.side, self.side))
        found = []
        for x0, z0, x1, z1 in self.openings:
            seen = [along([at[0], at[2]], [x - at[0], z - at[2]], t)
                    for x, z in ((x0, z0), (x1, z1))]
            a, b = max(seen[0][0], lamp[0]), max(seen[0][1], lamp[1])
            c, d = min(seen[1][0], lamp[2]), min(seen[1][1], lamp[3])
            if c > a and d > b:
                to = sub([(a + c) / 2, self.middle[1], (b + d) / 2], at)
                found.append((unit(to), self.cd_m2 * (c - a) * (d - b) * to[1] * to[2] /
                              dot(to, to) ** 2))
        return found

    def environment(self):
        return black_box.DARK


class Keyhole(Grille):
    """The same behind a small hole."""

    def __init__(self, draw):
        super().__init__(draw)
        x0, z0, x1, z1 = self.openings[0]
        side = log_uniform(draw, 0.003, 0.03)
        self.openings = [rectangle(((x0 + x1) / 2, self.middle[2] * HIGH[1] / self.middle[1]),
                                   (side, side))]


KINDS = {"hole": hole, "slit": slit, "blinds": blinds, "visor": Visor, "knob": knob,
         "grille": Grille, "keyhole": Keyhole}


def has_open_sky(room):
    """Nothing but floor and walls is behind the openings, and the walls are black."""
    return type(room) is Patch and not room.walls


def rare_room(draw, kind):
    return KINDS[kind](draw)
