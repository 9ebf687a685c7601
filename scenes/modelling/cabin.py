# SPDX-License-Identifier: Apache-2.0
"""Doors, console and seats."""

import numpy as np
from mathutils import Matrix

from legends import printed
from shapes import (
    box,
    frame_matrix,
    frame_ring,
    grid,
    joined,
    lathe,
    place,
    plate,
    round_section,
    rounded_rectangle,
    spline,
    stitches,
    tube,
)
from greenhouse import SIDES


# ---- doors -------------------------------------------------------------------------------


def door_profile(points, y, sign, count):
    curve = spline(points, count)
    ease = 0.012 * np.clip((y - 0.55) / 0.4, 0, 1) ** 2
    return np.column_stack([sign * (curve[:, 0] - ease), np.full(count, y), curve[:, 1]])


DOOR_TOP = [
    (0.800, 1.030),
    (0.775, 1.040),
    (0.748, 1.039),
    (0.733, 1.022),
    (0.727, 0.980),
    (0.730, 0.935),
    (0.738, 0.915),
]
DOOR_INSERT = [(0.742, 0.905), (0.735, 0.890), (0.735, 0.80), (0.742, 0.722)]
DOOR_REST = [
    (0.742, 0.728),
    (0.690, 0.722),
    (0.662, 0.708),
    (0.655, 0.682),
    (0.672, 0.655),
    (0.735, 0.635),
]
DOOR_LOW = [(0.737, 0.632), (0.745, 0.50), (0.770, 0.28)]


def doors():
    ys = np.linspace(1.05, -1.30, 60)
    for side, sign in SIDES:
        for part, points, material, count in (
            ("top", DOOR_TOP, "leather black", 18),
            ("insert", DOOR_INSERT, "leather cognac", 8),
            ("armrest", DOOR_REST, "leather black", 14),
            ("lower", DOOR_LOW, "plastic grained", 6),
        ):
            rows = np.array([door_profile(points, y, sign, count) for y in ys])
            grid(f"door {part} {side}", rows, material, flip=(sign < 0))
        strip = [door_profile([(0.7385, 0.910), (0.7380, 0.9095)], y, sign, 2)[0] for y in ys]
        tube(f"door strip {side}", strip, 0.0045, "brushed aluminium", 10)
        seam = np.array([(sign * 0.7455, y, 1.0405) for y in np.linspace(1.0, 0.15, 90)])
        stitches(f"door seam {side}", seam, np.tile((-0.3 * sign, 0, 1), (90, 1)), "thread")
        door_fittings(side, sign)


def door_fittings(side, sign):
    path = spline(
        [
            (sign * 0.733, 0.36, 0.852),
            (sign * 0.712, 0.345, 0.856),
            (sign * 0.708, 0.29, 0.858),
            (sign * 0.714, 0.235, 0.856),
        ],
        14,
    )
    tube(
        f"door handle {side}",
        path,
        np.linspace(0.008, 0.0065, 14),
        "satin chrome",
        12,
        False,
        1.25,
    )
    cup = frame_matrix((sign * 0.7345, 0.30, 0.855), (0, -sign, 0), (0, 0, 1))
    frame_ring(
        f"door handle cup {side}",
        rounded_rectangle(0.150, 0.045, 0.02, 8),
        round_section(0.004, 0.005),
        cup,
        "satin chrome",
    )
    plate(
        f"door handle well {side}",
        rounded_rectangle(0.148, 0.043, 0.02, 8),
        0.002,
        cup,
        "plastic dark",
        0.0005,
    )
    plate(
        f"window switches {side}",
        rounded_rectangle(0.14, 0.050, 0.012, 6),
        0.004,
        frame_matrix((sign * 0.697, 0.33, 0.7275), (1, 0, 0), (0, 1, 0)),
        "piano black",
        0.001,
    )
    for i in range(4):
        at = window_switch(sign, i)
        box(f"window switch {side} {i}", (0.0185, 0.028, 0.008), at, "button", 0.002, 2)
    speaker = frame_matrix((sign * 0.752, 0.55, 0.47), (0, -sign, 0), (0, 0, 1))
    lathe(
        f"door speaker {side}",
        [
            (0.085, -0.01),
            (0.085, 0.006),
            (0.080, 0.008),
            (0.076, 0.005),
            (0.05, 0.009),
            (0.001, 0.011),
        ],
        speaker,
        "plastic dark",
        48,
    )


# ---- console and seats -------------------------------------------------------------------


def console():
    rows = []
    for y, z, w in (
        (0.80, 0.800, 0.30),
        (0.72, 0.790, 0.30),
        (0.66, 0.760, 0.275),
        (0.58, 0.725, 0.255),
        (0.45, 0.700, 0.245),
        (0.25, 0.690, 0.240),
        (0.02, 0.690, 0.236),
    ):
        o = [
            (-w / 2 - 0.012, z - 0.50),
            (-w / 2 - 0.006, z - 0.06),
            (-w / 2, z - 0.018),
            (-w / 2 + 0.012, z),
            (0, z + 0.001),
            (w / 2 - 0.012, z),
            (w / 2, z - 0.018),
            (w / 2 + 0.006, z - 0.06),
            (w / 2 + 0.012, z - 0.50),
        ]
        curve = spline(o, 33)
        rows.append(np.column_stack([curve[:, 0], np.full(33, y), curve[:, 1]]))
    smooth = np.stack([spline(np.array(rows)[:, k], 30) for k in range(33)], axis=1)
    grid("centre console", smooth[::-1], "leather black", flip=False)
    deck = frame_matrix((0, 0.37, 0.699), (1, 0, 0), (0, 1, 0.055))
    outline = rounded_rectangle(0.185, 0.40, 0.03, 6)
    plate(
        "console deck",
        outline,
        0.01,
        deck @ Matrix.Translation((0, 0, 0.004)),
        "walnut open pore",
        0.002,
        3,
    )
    frame_ring(
        "console deck trim",
        outline,
        round_section(0.005, 0.006, 10),
        deck @ Matrix.Translation((0, 0, 0.002)),
        "brushed aluminium",
    )
    selector()
    cup_holders()
    armrest = frame_matrix((0, -0.10, 0.735), (1, 0, 0), (0, 1, 0))
    box("centre armrest", (0.205, 0.34, 0.09), armrest, "leather black", 0.028, 5)


def selector():
    base = SELECTOR
    plate(
        "gear selector base",
        rounded_rectangle(0.062, 0.125, 0.02, 6),
        0.006,
        base,
        "piano black",
        0.0015,
        3,
    )
    rings = []
    for z, w, d, shift in (
        (0.0, 0.026, 0.036, 0),
        (0.018, 0.024, 0.032, 0),
        (0.034, 0.030, 0.044, -0.003),
        (0.046, 0.036, 0.056, -0.007),
        (0.056, 0.036, 0.058, -0.010),
        (0.062, 0.031, 0.050, -0.011),
        (0.0645, 0.020, 0.034, -0.011),
        (0.065, 0.001, 0.001, -0.011),
    ):
        o = rounded_rectangle(w, d, 0.45 * min(w, d), 6)
        rings.append(np.column_stack([o[:, 0], o[:, 1] + shift, np.full(len(o), z)]))
    grid("gear selector", place(np.array(rings), base), "leather wheel", closed=True)
    collar = rounded_rectangle(0.029, 0.040, 0.012, 6)
    frame_ring(
        "gear selector collar",
        collar,
        round_section(0.004, 0.004),
        base @ Matrix.Translation((0, 0, 0.020)),
        "satin chrome",
    )
    lathe(
        "start button",
        [(0.017, -0.004), (0.017, 0.003), (0.0155, 0.0045), (0.0145, 0.0035), (0.0005, 0.003)],
        START,
        "cross-brushed aluminium",
        40,
    )
    lathe(
        "start button cap",
        [(0.0142, 0.0030), (0.0138, 0.0046), (0.0128, 0.0050), (0.0005, 0.0052)],
        START,
        "button",
        40,
    )
    for i in range(3):
        box(f"console key {i}", (0.055, 0.028, 0.008), console_key(i), "button", 0.002, 2)


# ---- what is printed on the keys between and beside the people ---------------------------

SELECTOR = frame_matrix((-0.045, 0.44, 0.712), (1, 0, 0), (0, 1, 0.055))
START = frame_matrix((-0.055, 0.545, 0.722), (1, 0, 0), (0, 1, 0.2))
CONSOLE_WORDS = ("MODE", "HOLD", "PARK")


def console_key(number):
    return frame_matrix((0.05, 0.50 - 0.035 * number, 0.7145), (1, 0, 0), (0, 1, 0.055))


def window_switch(sign, number):
    """The top of one of a door's four switches."""
    x, y = sign * 0.697 - 0.012 + 0.024 * (number % 2), 0.35 - 0.045 * (number // 2)
    return frame_matrix((x, y, 0.7300), (1, 0, 0), (0, 1, 0.25))


def prints():
    """Rows of legends.printed: name, what, plane, height."""
    rows = [("start sign", "power", START @ Matrix.Translation((0, 0, 0.0050)), 0.0115)]
    for k, letter in enumerate("PRND"):
        at = SELECTOR @ Matrix.Translation((0.0245, 0.036 - 0.024 * k, 0.0002))
        rows.append((f"gear {letter}", letter, at, 0.0070))
    for i, word in enumerate(CONSOLE_WORDS):
        at = console_key(i) @ Matrix.Translation((0, 0, 0.0042))
        rows.append((f"console word {i}", word, at, 0.0058))
    for side, sign in SIDES:
        for i in range(4):
            at = window_switch(sign, i) @ Matrix.Translation((0, 0.004, 0.0042))
            rows.append((f"window sign {side} {i}", "window", at, 0.0085))
    return rows


def tray():
    """A tray for a telephone on the console's slope: a ribbed mat in a raised frame."""
    at = frame_matrix((0, 0.640, 0.7535), (1, 0, 0), (0, 1, 0.44))
    outline = rounded_rectangle(0.176, 0.124, 0.018, 7)
    section = [(-0.0050, -0.004), (0.0046, -0.004), (0.0030, 0.0040), (0.0, 0.0056)]
    section += [(-0.0030, 0.0050), (-0.0044, 0.0024)]
    frame_ring("console tray rim", outline, section[::-1], at, "plastic dark")
    mat = at @ Matrix.Translation((0, 0, 0.0022))
    plate("console tray mat", outline * 0.985, 0.006, mat, "wiper black", 0.0)
    ribs = [
        box(
            "rib",
            (0.148, 0.0034, 0.0030),
            mat @ Matrix.Translation((0, -0.045 + 0.0112 * i, 0.0004)),
            "wiper black",
            0.0011,
            2,
        )
        for i in range(9)
    ]
    joined("console tray ribs", ribs)


def cup_holders():
    for i, y in enumerate((0.345, 0.255)):
        at = frame_matrix((0.045, y, 0.7055), (1, 0, 0), (0, 1, 0.055))
        lathe(
            f"cup holder ring {i}",
            [
                (0.041, -0.002),
                (0.0425, 0.002),
                (0.040, 0.004),
                (0.037, 0.002),
                (0.0365, -0.001),
            ],
            at,
            "cross-brushed aluminium",
            48,
        )
        lathe(f"cup holder {i}", [(0.037, 0.0006), (0.0005, 0.0006)], at, "gap", 32)


def cushion(name, size, origin, right, up, material, bevel=0.06):
    return box(name, size, frame_matrix(origin, right, up), material, bevel, 6)


def seats():
    for side, sign in SIDES:
        x = 0.37 * sign
        cushion(
            f"seat cushion {side}",
            (0.50, 0.50, 0.16),
            (x, 0.10, 0.52),
            (1, 0, 0),
            (0, 1, 0.14),
            "seat leather",
        )
        back = (0, -0.36, 1)
        cushion(
            f"seat back {side}",
            (0.40, 0.62, 0.13),
            (x, -0.36, 0.85),
            (1, 0, 0),
            back,
            "seat leather",
        )
        for k in (-1, 1):
            cushion(
                f"seat bolster {side} {k}",
                (0.10, 0.52, 0.20),
                (x + 0.215 * k, -0.315, 0.80),
                (1, 0, 0),
                back,
                "leather black",
                0.045,
            )
        cushion(
            f"headrest {side}",
            (0.25, 0.17, 0.10),
            (x, -0.475, 1.265),
            (1, 0, 0),
            (0, -0.12, 1),
            "leather black",
            0.045,
        )
        for k in (-1, 1):
            tube(
                f"headrest rod {side} {k}",
                [(x + 0.055 * k, -0.468, 1.10), (x + 0.055 * k, -0.475, 1.22)],
                0.006,
                "bright chrome",
                10,
                up=(1, 0, 0),
            )
    cushion(
        "rear bench",
        (1.30, 0.52, 0.18),
        (0, -0.98, 0.50),
        (1, 0, 0),
        (0, 1, 0.12),
        "seat leather",
    )
    cushion(
        "rear back",
        (1.32, 0.62, 0.16),
        (0, -1.34, 0.80),
        (1, 0, 0),
        (0, -0.38, 1),
        "seat leather",
    )
    for k in (-1, 1):
        cushion(
            f"rear headrest {k}",
            (0.24, 0.14, 0.09),
            (0.36 * k, -1.47, 1.135),
            (1, 0, 0),
            (0, -0.2, 1),
            "leather black",
            0.04,
        )


def build_cabin():
    doors()
    console()
    tray()
    seats()
    for row in prints():
        printed(*row)
