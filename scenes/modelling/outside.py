# SPDX-License-Identifier: Apache-2.0
"""The street in front of the car: road, kerbs, houses, trees, lamps, traffic, hills.

The car stands in its own lane (x -1.75 .. 1.75); the street runs along y."""
import math
import random

import numpy as np
from mathutils import Matrix

from shapes import (
    box,
    frame_matrix,
    grid,
    joined,
    lathe,
    mesh,
    named_material,
    plate,
    rounded_rectangle,
    spline,
    tube,
)
from facades import FLOOR, Fronts, near_house
from ground import build_ground, hills, kerbs
from traffic import traffic
from trees import trees

LEFT_KERB, RIGHT_KERB = -5.60, 2.15
NEAR, FAR = -120.0, 760.0

# Lamp heads (x, y, z) of the street lamps; the night scene puts lights there.
LAMPS = [(1.2, 9.0 + 27.0 * i, 7.3) for i in range(-2, 9)] + [
    (-4.7, 22.5 + 27.0 * i, 7.3) for i in range(-2, 9)
]


def level(x, y):
    return frame_matrix((x, y, 0), (1, 0, 0), (0, 1, 0))


def flat(name, x0, x1, y0, y1, z, material):
    return mesh(
        name, [(x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z)], [(0, 1, 2, 3)], material
    )


def road():
    flat("grass", -700, 700, -300, 900, -0.03, "grass")
    flat("road", LEFT_KERB, RIGHT_KERB, NEAR, FAR, 0.0, "asphalt")
    for name, x0, x1 in (("right", RIGHT_KERB + 0.14, 5.4), ("left", -9.0, LEFT_KERB - 0.14)):
        flat(f"pavement {name}", x0, x1, NEAR, FAR, 0.115, "paving")
    kerbs(RIGHT_KERB, LEFT_KERB, NEAR, FAR)
    dashes = [
        flat("dash", -1.815, -1.685, y, y + 3.0, 0.004, "road marking")
        for y in np.arange(-30, 420, 9.0)
    ]
    dashes += [
        flat("edge", x - 0.06, x + 0.06, NEAR, FAR, 0.004, "road marking")
        for x in (1.72, -5.17)
    ]
    joined("lane markings", dashes)
    stripes = [
        flat("stripe", x, x + 0.5, 46.0, 49.5, 0.005, "road marking")
        for x in np.arange(-5.1, 1.8, 1.0)
    ]
    joined("zebra crossing", stripes)


def far_house(i, spot, size, facade, flat_roof):
    """A textured box. spot: its middle; the windows' grid begins where the lit panes' does."""
    (x, y), (width, depth, height) = spot, size
    w, d = width / 2, depth / 2
    plan = [(x - w, y - d), (x + w, y - d), (x + w, y + d), (x - w, y + d)]
    corners = [(*p, z) for z in (0.0, height) for p in plan]
    faces = [(0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7), (4, 5, 6, 7)]
    uvs = []
    for k, face in enumerate(faces):
        for c in face:
            px, py, pz = corners[c]
            along = px - x + w if k in (0, 2) else py - y + d
            uvs.append((along, pz - 0.46) if k < 4 else (0.0, 0.0))
    mesh(f"house {i}", corners, faces, facade, uvs)
    if flat_roof:
        top = level(x, y) @ Matrix.Translation((0, 0, height + 0.15))
        box(f"house roof {i}", (width + 0.5, depth + 0.5, 0.5), top, "roof grey", 0.04)
        return
    w, d, z, rise, o = w + 0.4, d + 0.4, height, 0.42 * width, 0.12
    ridge = [(x, y - d + o, z + rise), (x, y + d - o, z + rise)]
    eaves = [(x - w, y - d, z), (x + w, y - d, z), (x + w, y + d, z), (x - w, y + d, z)]
    faces = [(0, 4, 5, 3), (1, 2, 5, 4), (0, 1, 4), (2, 3, 5), (0, 3, 2, 1)]
    mesh(f"house roof {i}", eaves + ridge, faces, "roof tile far")
    chimney = level(x + 0.2 * width, y) @ Matrix.Translation((0, 0, z + rise * 0.7))
    box(f"chimney {i}", (0.7, 0.9, 2.6), chimney, "roof grey", 0.03)


def house(i, x, y, width, depth, floors, facade, flat_roof):
    """Near the car a house of parts, of which the body is made here; else a textured box."""
    height = FLOOR * floors + 0.6
    side = 1 if x > 0 else -1
    if y > NEAR_HOUSES or x < -40:
        hues = (facade, facade, facade + " ochre", facade + " grey")
        hue = hues[i % 4] if facade == "facade plaster" else facade
        return far_house(i, (x, y), (width, depth, height), hue, flat_roof)
    at = level(x, y) @ Matrix.Translation((0, 0, height / 2))
    box(f"house {i}", (width, depth, height), at, "wall trim", 0.0)
    DETAILED.append((i, (x, y, side), (width, depth, floors, facade.split()[1])))


HOUSES, DETAILED = [], []
NEAR_HOUSES = 92.0  # m ahead: houses whose middle is nearer are of parts


def houses():
    rng = random.Random(5)
    facades = ("facade plaster", "facade brick", "facade office")
    i = 0
    for side, setback in ((1, 10.5), (-1, 14.0)):
        y = -34.0
        while y < 330:
            depth = rng.uniform(12, 22)
            width = rng.uniform(10, 14)
            floors = rng.choice((2, 3, 3, 4, 5))
            open_square = side < 0 and y + depth < 30  # lets the low sun onto the car
            if rng.random() < 0.80 and not open_square:
                x = side * (setback + width / 2 + rng.uniform(0, 3.0))
                kind = facades[2] if floors >= 5 else rng.choice(facades[:2])
                house(i, x, y + depth / 2, width, depth, floors, kind, floors >= 4)
                HOUSES.append((x - side * width / 2, y, depth, floors, side))
                i += 1
            y += depth + rng.choice((0.4, 3.0, 7.0))
    for k in range(6):
        floors = (2, 3, 2, 4, 3, 2)[k]
        house(
            i + k, -56.0 - 2 * (k % 2), -86.0 + 22 * k, 13, 19, floors, facades[k % 2], k == 3
        )


def lit_panes(fronts):
    """By night: (front, bay, storey, whether its light is cool), of fronts as in HOUSES."""
    rng = random.Random(2)
    for number, (_, _, depth, floors, _) in enumerate(fronts):
        for floor in range(floors):
            for bay in range(int(depth // 3)):
                if rng.random() < 0.26:
                    yield number, bay, floor, rng.random() < 0.25


def near_houses():
    """The fronts of the houses near the car, with doors where no pane is lit by night: where
    the doors are."""
    fronts, lit, doors = Fronts(), list(lit_panes(HOUSES)), []
    for i, spot, shape in DETAILED:
        panes = {(bay, f) for n, bay, f, _ in lit if n == i}
        doors += near_house(fronts, i, spot, shape, panes)
    fronts.close()
    return doors


def street_lamps():
    for i, (x, y, z) in enumerate(LAMPS):
        side = 1 if x > 0 else -1
        foot = 3.0 if side > 0 else -6.6
        path = spline(
            [
                (foot, y, 0.1),
                (foot, y, 4.0),
                (foot, y, 6.4),
                (foot - 0.25 * side, y, 7.1),
                (foot - 0.9 * side, y, 7.42),
                (x + 0.3 * side, y, 7.46),
            ],
            14,
        )
        tube(f"lamp post {i}", path, np.linspace(0.075, 0.035, 14), "pole", 7, up=(0, 1, 0))
        box(
            f"lamp housing {i}",
            (0.62, 0.24, 0.09),
            frame_matrix((x, y, z + 0.115), (1, 0, 0), (0, 1, 0)),
            "pole",
            0.03,
            2,
        )


# (name, kind, paint, x, y, heading in degrees: 0 drives away from us)
CARS = [
    ("car ahead", "saloon", "paint other", 0.05, 21.0, 0),
    ("oncoming car", "hatchback", "paint red", -3.55, 47.0, 180),
    ("parked car", "saloon", "paint other", 4.0, -16.0, 0),
    ("car in the bay 0", "estate", "paint dark", -10.5, 35.5, 180),
    ("car in the bay 1", "hatchback", "paint red", -10.5, 42.0, 180),
    ("car on the drive 0", "estate", "paint dark", 8.1, 39.5, 90),
    ("car on the drive 1", "estate", "paint white", 8.0, 62.0, 90),
    ("car far ahead 0", "estate", "paint white", 0.0, 74.0, 0),
    ("car far ahead 1", "hatchback", "paint red", -0.1, 118.0, 0),
    ("car far away", "saloon", "paint other", -3.4, 112.0, 180),
]


def furniture():
    """A guard rail on the left, a direction sign, a traffic light at the crossing."""
    ys = np.linspace(60, 180, 60)
    section = [
        (-9.30, 0.52),
        (-9.22, 0.56),
        (-9.27, 0.62),
        (-9.27, 0.68),
        (-9.22, 0.74),
        (-9.30, 0.78),
    ]
    grid(
        "guard rail",
        np.array([[(x, y, z) for y in ys] for x, z in section]),
        "galvanised steel",
    )
    posts = [
        box(
            "post",
            (0.08, 0.10, 0.80),
            frame_matrix((-9.36, y, 0.40), (1, 0, 0), (0, 1, 0)),
            "galvanised steel",
            0.0,
        )
        for y in np.arange(60, 181, 4.0)
    ]
    joined("guard rail posts", posts)
    tube("sign post", [(2.9, 34, 0), (2.9, 34, 3.4)], 0.04, "pole", 8, up=(0, 1, 0))
    sign = frame_matrix((2.9, 33.94, 2.9), (1, 0, 0), (0, 0, 1))
    plate(
        "direction sign", rounded_rectangle(1.5, 0.85, 0.08, 5), 0.03, sign, "sign blue", 0.005
    )
    arrow = [
        (-0.05, -0.30),
        (0.05, -0.30),
        (0.05, 0.08),
        (0.16, 0.08),
        (0.0, 0.30),
        (-0.16, 0.08),
        (-0.05, 0.08),
    ]
    plate(
        "direction sign arrow",
        np.array(arrow) + (-0.45, 0),
        0.006,
        sign @ Matrix.Translation((0, 0, 0.007)),
        "road marking",
        0,
    )
    for k in range(2):
        bar = sign @ Matrix.Translation((0.22, 0.16 - 0.30 * k, 0.002))
        box(f"direction sign line {k}", (0.75 - 0.2 * k, 0.11, 0.01), bar, "road marking", 0)
    tube(
        "traffic light post",
        [(2.75, 45.2, 0), (2.75, 45.2, 3.5)],
        0.05,
        "pole",
        8,
        up=(0, 1, 0),
    )
    box(
        "traffic light",
        (0.26, 0.22, 0.80),
        frame_matrix((2.75, 45.05, 3.1), (1, 0, 0), (0, 1, 0)),
        "plastic dark",
        0.03,
        3,
    )


def build_outside():
    road()
    houses()
    build_ground(near_houses())
    trees()
    street_lamps()
    traffic(CARS)
    hills()
    furniture()
