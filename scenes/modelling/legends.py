# SPDX-License-Identifier: Apache-2.0
"""What is printed on the car's controls: icons and short words as thin ribbons on their keys.

By day they are printed white; night.py lays the same ribbons over them once more, lit. An icon
is a list of (points, closed) in a square of side 1 about the origin, x right and y up.
"""
import math

import numpy as np

from shapes import mesh, place
from stroke_font import strokes

LIFT = 0.00025  # m, a print over its key


def arc(x, y, radius, first_deg, last_deg, count=9):
    a = np.radians(np.linspace(first_deg, last_deg, count))
    return [(x + radius * math.cos(t), y + radius * math.sin(t)) for t in a]


def heat(x, low, high, swing=0.055):
    """A warm stream: a wave that rises."""
    return [
        (x + swing * math.sin(2 * math.pi * t), low + (high - low) * t)
        for t in np.linspace(0, 1, 7)
    ]


def heats(low, high):
    return [(heat(x, low, high), False) for x in (-0.22, 0.0, 0.22)]


def fan():
    petal = [(0.07, 0), (0.26, -26), (0.46, -16), (0.50, 14), (0.40, 42), (0.20, 40)]
    blades = [
        (
            [
                (r * math.cos(math.radians(a + turn)), r * math.sin(math.radians(a + turn)))
                for r, a in petal
            ],
            True,
        )
        for turn in (0, 120, 240)
    ]
    return blades + [(arc(0, 0, 0.07, 0, 300, 6), True)]


def seat():
    side = [(-0.34, 0.46), (-0.40, 0.34), (-0.26, -0.30), (0.20, -0.34), (0.26, -0.20)]
    side += [(-0.10, -0.12), (-0.24, 0.44)]
    return [(side, True)] + [(heat(x, 0.02, 0.42), False) for x in (0.04, 0.22, 0.40)]


def car_side():
    return [
        (-0.50, -0.24),
        (-0.50, 0.00),
        (-0.34, 0.05),
        (-0.20, 0.28),
        (0.16, 0.28),
        (0.34, 0.05),
        (0.50, 0.00),
        (0.50, -0.24),
    ]


def arrow(sign):
    """A direction indicator's arrow, outlined."""
    half = [(0.48, 0.0), (0.06, 0.36), (0.06, 0.15), (-0.44, 0.15)]
    return [([(sign * x, y) for x, y in half + [(x, -y) for x, y in half[:0:-1]]], True)]


ICONS = {
    "fan": fan(),
    "seat": seat(),
    "seat mirrored": [([(-x, y) for x, y in line], c) for line, c in seat()],
    "screen": [
        ([(-0.5, 0.20)] + arc(0, -0.5, 0.88, 122, 58, 7) + [(0.5, 0.20)]
         + [(0.34, -0.22), (-0.34, -0.22)], True)
    ] + heats(-0.48, 0.12),
    "rear screen": [([(-0.46, -0.22), (0.46, -0.22), (0.46, 0.34), (-0.46, 0.34)], True)]
    + heats(-0.48, 0.14),
    "inside air": [
        (car_side(), True),
        ([(-0.24, -0.10), (0.12, -0.10), (0.22, -0.02), (0.12, 0.07), (-0.02, 0.07)], False),
        ([(0.06, 0.15), (-0.04, 0.07), (0.06, -0.01)], False),
    ],
    "face air": [
        (arc(0.26, 0.32, 0.12, 0, 330, 10), True),
        ([(0.24, 0.14), (0.30, -0.22), (0.02, -0.24), (-0.06, -0.48)], False),
        ([(-0.48, 0.26), (-0.02, 0.26)], False),
        ([(-0.16, 0.38), (-0.02, 0.26), (-0.16, 0.14)], False),
    ],
    "+": [([(-0.42, 0), (0.42, 0)], False), ([(0, -0.42), (0, 0.42)], False)],
    "-": [([(-0.42, 0), (0.42, 0)], False)],
    "cruise": [
        (arc(0, -0.10, 0.46, 200, -20, 13), False),
        ([(0.0, -0.10), (0.24, 0.18)], False),
        (arc(0, -0.10, 0.05, 0, 300, 6), True),
    ],
    "distance": [
        ([(-0.44, 0.02), (-0.32, 0.34), (0.32, 0.34), (0.44, 0.02), (0.44, -0.14)]
         + [(-0.44, -0.14)], True),
        ([(-0.24, -0.30), (0.24, -0.30)], False),
        ([(-0.36, -0.46), (0.36, -0.46)], False),
    ],
    "phone": [
        (arc(0.42, 0.42, 0.86, 182, 268, 8) + [(0.42, -0.20), (0.20, -0.26), (0.08, -0.12)]
         + arc(0.42, 0.42, 0.50, 235, 215, 3) + [(-0.12, 0.08), (-0.26, 0.20), (-0.20, 0.42)],
         True)
    ],
    "voice": [
        (arc(0, 0.28, 0.14, 0, 180, 7) + arc(0, 0.02, 0.14, 180, 360, 7), True),
        (arc(0, 0.02, 0.30, 180, 360, 9), False),
        ([(0, -0.28), (0, -0.46)], False),
        ([(-0.18, -0.46), (0.18, -0.46)], False),
    ],
    "arrow left": arrow(-1),
    "arrow right": arrow(1),
    "beam": [
        ([(0.06, 0.36)] + arc(0.06, 0.0, 0.36, 60, -60, 7) + [(0.06, -0.36)], True),
    ]
    + [([(-0.06, y), (-0.48, y)], False) for y in (0.30, 0.10, -0.10, -0.30)],
    "wipe": [
        (arc(0, -0.56, 0.96, 122, 58, 9) + arc(0, -0.56, 0.34, 58, 122, 5), True),
        ([(0.0, -0.46), (0.16, 0.30)], False),
    ],
    "power": [(arc(0, -0.04, 0.40, 118, 422, 17), False), ([(0, 0.06), (0, 0.48)], False)],
    "window": [
        ([(-0.46, -0.30), (0.46, -0.30), (0.46, 0.02), (0.10, 0.34), (-0.28, 0.34)], True),
        ([(-0.40, 0.02), (0.46, 0.02)], False),
    ],
    "lock": [
        ([(-0.30, -0.42), (0.30, -0.42), (0.30, 0.04), (-0.30, 0.04)], True),
        (arc(0, 0.10, 0.20, 0, 180, 7), False),
    ],
    "bar": [([(-0.5, 0), (0.5, 0)], False)],
}


def ribbon(points, width, closed):
    """Flat quads (points (n, 2), faces) of this width along a line, mitred at its corners."""
    p = np.asarray(points, float)
    n = len(p)
    step = np.roll(p, -1, 0) - p
    step /= np.linalg.norm(step, axis=1)[:, None]
    if not closed:
        step[-1] = step[-2]
    before = np.roll(step, 1, 0)
    if not closed:
        before[0] = step[0]
    side = np.column_stack([-(step + before)[:, 1], (step + before)[:, 0]])
    side /= np.linalg.norm(side, axis=1)[:, None]
    across = np.abs(np.einsum("ij,ij->i", side, np.column_stack([-step[:, 1], step[:, 0]])))
    side *= 0.5 * width / np.maximum(across, 0.5)[:, None]
    corners = np.concatenate([p - side, p + side])
    ends = range(n if closed else n - 1)
    return corners, [(i, (i + 1) % n, n + (i + 1) % n, n + i) for i in ends]


def marks(what, height, weight):
    """Vertices (n, 3) and faces of an icon's name or else of a word, `height` tall."""
    if what in ICONS:
        lines = ICONS[what]
    else:
        pairs, width = strokes(what)
        lines = [([(x - 0.5 * width, y - 0.5) for x, y in pair], False) for pair in pairs]
    vertices, faces = np.empty((0, 2)), []
    for points, closed in lines:
        corners, quads = ribbon(points, weight, closed)
        faces += [[len(vertices) + k for k in quad] for quad in quads]
        vertices = np.concatenate([vertices, corners])
    return np.column_stack([height * vertices, np.zeros(len(vertices))]), faces


def printed(name, what, matrix, height, material="symbol white", weight=0.10, lift=LIFT):
    """One print on the plane of `matrix`, as an object of this name."""
    vertices, faces = marks(what, height, weight)
    return mesh(name, place(vertices + (0, 0, lift), matrix), faces, material)


def lit(name, prints, material):
    """Rows as printed() takes them, without their materials, as one object that shines."""
    vertices, faces = [], []
    for _, what, matrix, height in prints:
        points, quads = marks(what, height, 0.10)
        base = sum(len(v) for v in vertices)
        vertices.append(place(points + (0, 0, LIFT + 0.0001), matrix))
        faces += [[base + k for k in quad] for quad in quads]
    return mesh(name, np.concatenate(vertices), faces, material)
