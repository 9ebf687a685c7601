# SPDX-License-Identifier: Apache-2.0
"""Keys and knobs on the dashboard: climate below the centre display, hazard, the lamps'."""
import math

import numpy as np
from mathutils import Matrix

from dashboard import DRIVER_X, KNEES, side_direction, stack_face, wrap
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
    tube,
)

ICONS = ("seat", "AUTO", "fan", "face air", "screen", "rear screen", "inside air")
ICONS += ("seat mirrored",)
WORDS = {"AUTO": 0.0044}  # m, cap height; icons are larger
ICON = 0.0095
KNOBS = (("left", -0.142, "21.5"), ("right", 0.142, "20.0"))  # as the centre display says
KNOB_RADIUS, KNOB_HEIGHT = 0.0195, 0.019


def key_place(number, y, z):
    return stack_face(((number - 3.5) * 0.0262, y, z))


def prints():
    """Rows of legends.printed: name, what, plane, height."""
    rows = [
        (f"climate symbol {i}", what, key_place(i, -0.0322, 0.0075), WORDS.get(what, ICON))
        for i, what in enumerate(ICONS)
    ]
    rows += [
        (f"temperature {side}", digits, knob_face(x), 0.0066) for side, x, digits in KNOBS
    ]
    return rows


def lamps():
    """The lines on the keys that tell what is on: automatic, fan, the driver's seat."""
    return [
        (f"climate lamp {i}", "bar", key_place(i, -0.0397, 0.0075), 0.0070) for i in (0, 1, 2)
    ]


def climate_keys():
    """A row of keys between two knurled temperature knobs, below the vents."""
    keys = []
    for i in range(len(ICONS)):
        at = key_place(i, -0.0335, 0.0045)
        keys.append(box("key", (0.0245, 0.0195, 0.006), at, "button", 0.0016, 3))
    joined("climate keys", keys)
    for row in prints():
        printed(*row)
    for row in lamps():
        printed(*row, "lamp off")
    for side, x, _ in KNOBS:
        at = stack_face((x, -0.0335, 0.003))
        knob(f"temperature knob {side}", at, KNOB_RADIUS, KNOB_HEIGHT)
        lathe(
            f"temperature knob foot {side}",
            [(0.0238, 0.0), (0.0238, 0.0012), (0.0228, 0.0022), (0.0205, 0.0022)],
            stack_face((x, -0.0335, 0.0036)),
            "satin dark",
            48,
        )


def knob_face(x):
    """The plane of a knob's sunk cap."""
    return stack_face((x, -0.0335, 0.003 + 0.951 * KNOB_HEIGHT))


def hazard_key():
    """The two red triangles between the vents."""
    at = stack_face((0, 0.0338, 0.0035))
    box("hazard key", (0.0125, 0.030, 0.006), at, "button", 0.0016, 3)
    triangles = [hazard_triangle(0.0046, 0.00050), hazard_triangle(0.0024, 0.00038)]
    joined("hazard triangle", triangles)


def hazard_triangle(half, radius):
    at = np.array([(-half, -0.62 * half), (half, -0.62 * half), (0, 1.12 * half)])
    corners = np.column_stack([at + (0, 0.0330), np.full(3, 0.00665)])
    edges = [
        corners[k] + (corners[(k + 1) % 3] - corners[k]) * t
        for k in range(3)
        for t in (0.04, 0.5, 0.96)
    ]
    path = place(np.array(edges), stack_face((0, 0, 0)))
    return tube("triangle", path, radius, "symbol red", 6, True)


def knob(name, matrix, radius, height):
    sides = 72
    a = np.linspace(0, 2 * math.pi, sides, endpoint=False)
    ridge = np.where(np.arange(sides) % 2 == 0, 1.0, 0.972)
    rings = []
    for r, h, knurl in (
        (1.0, 0.0, 1),
        (1.0, 0.75, 1),
        (0.985, 0.90, 1),
        (0.93, 0.98, 0),
        (0.86, 1.0, 0),
    ):
        k = radius * r * (ridge if knurl else np.ones(sides))
        rings.append(
            np.column_stack([k * np.cos(a), k * np.sin(a), np.full(sides, h * height)])
        )
    grid(name, place(np.array(rings), matrix), "cross-brushed aluminium", closed=True)
    lathe(
        f"{name} cap",
        [
            (radius * 0.86, height * 0.999),
            (radius * 0.80, height * 0.955),
            (radius * 0.4, height * 0.95),
            (0.0004, height * 0.95),
        ],
        matrix,
        "piano black",
        48,
    )


# ---- the lamps' switch, left of the wheel -------------------------------------------------


def lamp_switch_place(x=0.0, y=0.0, z=0.0):
    """On the panel's face, which stands 3 mm before the lower dashboard."""
    at_x = DRIVER_X - 0.318
    curve = spline(KNEES, 300)
    k = np.argmin(abs(curve[:, 1] - 0.868))
    lean = curve[k - 8] - curve[k + 8]
    origin = (at_x, curve[k, 0] + wrap(at_x) - 0.003, curve[k, 1])
    up = (0, lean[0] / lean[1], 1)
    return frame_matrix(origin, side_direction(at_x), up) @ Matrix.Translation((x, y, z))


def lamp_prints():
    return [
        ("lamp switch word", "AUTO", lamp_switch_place(-0.013, 0.0196, 0), 0.0040),
        ("lamp switch beam", "beam", lamp_switch_place(0.0225, 0.0092, 0.0032), 0.0088),
        ("lamp switch dim", "+", lamp_switch_place(0.0225, -0.0092, 0.0032), 0.0060),
    ]


def lamp_switch():
    outline = rounded_rectangle(0.078, 0.052, 0.010, 6)
    plate("lamp switch panel", outline, 0.012, lamp_switch_place(), "piano black", 0.0012, 2)
    frame_ring(
        "lamp switch frame",
        outline,
        round_section(0.0030, 0.005, 10),
        lamp_switch_place(0, 0, -0.0010),
        "satin chrome",
    )
    knob("lamp switch knob", lamp_switch_place(-0.013, -0.004, 0), 0.0165, 0.014)
    sizes = ((0.0225, 0.0092), (0.0225, -0.0092))
    keys = [
        box("key", (0.0195, 0.0172, 0.005), lamp_switch_place(*at, 0.0005), "button", 0.0014, 2)
        for at in sizes
    ]
    joined("lamp switch keys", keys)
    for row in lamp_prints():
        printed(*row)


def build_climate():
    climate_keys()
    hazard_key()
    lamp_switch()
