# SPDX-License-Identifier: Apache-2.0
"""The steering wheel and its column."""
import math

import numpy as np
from mathutils import Matrix, Vector

import controls
from controls import arm_rings
from legends import printed
from shapes import (
    box,
    frame_matrix,
    grid,
    joined,
    lathe,
    place,
    plate,
    round_section,
    frame_ring,
    rounded_rectangle,
    spline,
    stitches,
    tube,
)

WHEEL = frame_matrix(
    (-0.37, 0.425, 1.030),
    (1, 0, 0),
    (0, math.sin(math.radians(24)), math.cos(math.radians(24))),
)
RADIUS = 0.1815


def rim_path(count, radius=RADIUS, z=0.0):
    """A circle with a slightly flattened foot, from the foot counter-clockwise; open."""
    a = np.linspace(0, 2 * math.pi, count, endpoint=False) - math.pi / 2
    x, y = radius * np.cos(a), radius * np.sin(a)
    flat = -0.172 * radius / RADIUS
    y = np.where(y < flat, flat + 0.25 * (y - flat), y)
    return np.column_stack([x, y, np.full(count, z)])


def rim_radius(count):
    """Thicker where the hands lie, at ten and two."""
    a = np.degrees(np.linspace(0, 2 * math.pi, count, endpoint=False) - math.pi / 2)
    bump = sum(np.exp(-((((a - c + 180) % 360 - 180) / 15) ** 2)) for c in (38, 142))
    return 0.0152 + 0.0016 * bump


def rim():
    count = 144
    path = place(rim_path(count), WHEEL)
    axis = WHEEL.to_3x3() @ Vector((0, 0, 1))
    tube(
        "steering wheel rim",
        path,
        rim_radius(count),
        "leather wheel",
        22,
        True,
        1.12,
        tuple(axis),
    )
    inner = rim_path(720, RADIUS - 0.0150, 0.0)
    normals = -inner * np.array([1, 1, 0])
    turn = np.array(WHEEL.to_3x3())
    for label, z, slant in (("front", 0.0028, 0.0034), ("rear", -0.0028, -0.0034)):
        seam = place(inner + (0, 0, z), WHEEL)
        stitches(
            f"steering wheel stitching {label}",
            seam,
            normals @ turn.T,
            "thread",
            0.0040,
            0.0058,
            0.0011,
            slant,
        )
    tube(
        "steering wheel seam",
        place(inner[::4] * np.array([0.9985, 0.9985, 1]), WHEEL),
        0.0009,
        "gap",
        6,
        True,
    )


def spoke(name, path, widths, thicknesses, material):
    """A flat arm along path (local), its section across the wheel's plane."""
    path = spline(path, 16)
    widths, thicknesses = (
        spline(np.array(widths)[:, None], 16)[:, 0],
        spline(np.array(thicknesses)[:, None], 16)[:, 0],
    )
    rings = arm_rings(path, widths, thicknesses)
    return grid(name, place(rings, WHEEL), material, closed=True)


def spokes():
    for side, sign in (("left", -1), ("right", 1)):
        spoke(
            f"steering wheel spoke {side}",
            [
                (sign * 0.050, -0.004, 0.010),
                (sign * 0.100, -0.001, 0.006),
                (sign * 0.145, 0.004, 0.000),
                (sign * 0.176, 0.007, -0.002),
            ],
            (0.078, 0.062, 0.050, 0.044),
            (0.030, 0.024, 0.020, 0.016),
            "plastic dark",
        )
        switch_pod(side, sign)
        spoke_inlay(side, sign)
    spoke(
        "steering wheel spoke lower",
        [(0, -0.045, 0.008), (0, -0.10, 0.006), (0, -0.150, 0.000), (0, -0.172, 0)],
        (0.064, 0.048, 0.040, 0.040),
        (0.028, 0.018, 0.014, 0.012),
        "plastic dark",
    )
    # leant as the spoke's front, out of which its upper edge would not come otherwise
    slot = WHEEL @ Matrix.Translation((0, -0.118, 0.0158)) @ Matrix.Rotation(0.15, 4, "X")
    plate(
        "steering wheel clasp",
        np.array([(-0.019, -0.040), (0.019, -0.040), (0.024, 0.036), (-0.024, 0.036)]),
        0.004,
        slot,
        "cross-brushed aluminium",
        0.0015,
        3,
    )


def spoke_inlay(side, sign):
    """A satin line along the lower edge of a spoke, from the hub to the rim."""
    path = [(0.070, -0.0360, 0.0195), (0.100, -0.0315, 0.0165), (0.135, -0.0245, 0.0115)]
    path.append((0.160, -0.0175, 0.0075))
    points = spline([(sign * x, y, z) for x, y, z in path], 16)
    turn = tuple(WHEEL.to_3x3() @ Vector((0, 0, 1)))
    tube(f"spoke inlay {side}", place(points, WHEEL), 0.0026, "satin chrome", 10, up=turn)


def pod_place(sign):
    """The plane of the keys on a spoke."""
    return (
        WHEEL
        @ Matrix.Translation((sign * 0.1115, 0.0015, 0.0205))
        @ Matrix.Rotation(sign * math.radians(7), 4, "Y")
    )


KEYS = ((-0.0165, 0.010), (0.0165, 0.010), (-0.0165, -0.010), (0.0165, -0.010))
SIGNS = {"left": ("cruise", "+", "distance", "-"), "right": ("+", "phone", "-", "voice")}


def switch_prints():
    """Rows of legends.printed: the keys' icons."""
    rows = []
    for side, sign in (("left", -1), ("right", 1)):
        for (x, y), what in zip(KEYS, SIGNS[side]):
            at = pod_place(sign) @ Matrix.Translation((x, y, 0.00235))
            height = 0.0060 if what in "+-" else 0.0088
            rows.append((f"switch mark {side} {what}", what, at, height))
    return rows


def prints():
    """All that is printed on the wheel and behind it."""
    return switch_prints() + controls.prints(WHEEL)


def switch_pod(side, sign):
    """Gloss black keys with a satin frame on a spoke, and a knurled roller."""
    at = pod_place(sign)
    outline = rounded_rectangle(0.058, 0.046, 0.012, 6)
    plate(f"switch pod {side}", outline, 0.012, at, "piano black", 0.0018, 3)
    frame_ring(
        f"switch pod frame {side}",
        outline,
        round_section(0.0032, 0.005, 10),
        at @ Matrix.Translation((0, 0, -0.0008)),
        "bright chrome",
    )
    keys = []
    for x, y in KEYS:
        keys.append(
            box(
                "key",
                (0.0175, 0.0170, 0.003),
                at @ Matrix.Translation((x, y, 0.0008)),
                "button",
                0.0012,
                2,
            )
        )
    joined(f"switch keys {side}", keys)
    roller = at @ Matrix.Translation((0, 0, 0.0005)) @ Matrix.Rotation(math.pi / 2, 4, "Y")
    lathe(
        f"switch roller {side}",
        [
            (0.0004, -0.0052),
            (0.0052, -0.0052),
            (0.0060, -0.0045),
            (0.0060, 0.0045),
            (0.0052, 0.0052),
            (0.0004, 0.0052),
        ],
        roller,
        "cross-brushed aluminium",
        28,
    )


def hub():
    """The airbag cover: a crowned cushion with a seam and a badge."""
    a = np.linspace(0, 2 * math.pi, 64, endpoint=False)
    c, s = np.cos(a), np.sin(a)
    top, bottom = 0.060, 0.068
    outline = np.column_stack(
        [
            0.072 * np.sign(c) * abs(c) ** 0.72 * (1 - 0.13 * np.clip(-s, 0, 1)),
            np.where(s > 0, top * abs(s) ** 0.8, -bottom * abs(s) ** 0.9),
        ]
    )
    rings = []
    for scale, z in (
        (0.96, -0.030),
        (1.0, 0.000),
        (1.0, 0.014),
        (0.988, 0.0205),
        (0.955, 0.0245),
        (0.88, 0.0275),
        (0.7, 0.0310),
        (0.45, 0.0335),
        (0.2, 0.0345),
        (0.01, 0.0348),
    ):
        rings.append(np.column_stack([outline * scale, np.full(64, z)]))
    grid("steering wheel hub", place(np.array(rings), WHEEL), "leather black", closed=True)
    groove = np.column_stack([outline * 0.86, np.full(64, 0.0280)])
    tube("hub seam", place(groove, WHEEL), 0.0009, "gap", 6, True)
    badge()


def badge():
    """A sun with its two mock suns on the halo, on a dark disc."""
    rim = [(0.0222, -0.002), (0.0222, 0.0009), (0.0214, 0.0015), (0.0206, 0.0011)]
    middle = WHEEL @ Matrix.Translation((0, 0.000, 0.0346))
    lathe("badge disc", rim + [(0.0003, 0.0011)], middle, "satin dark", 56)
    word = WHEEL @ Matrix.Translation((0, -0.0405, 0.0322)) @ Matrix.Rotation(0.147, 4, "X")
    printed("hub word", "AIRBAG", word, 0.0042, "thread dark", 0.12)
    at = WHEEL @ Matrix.Translation((0, 0.000, 0.0362))
    ring = np.column_stack(
        [
            0.0165 * np.cos(np.linspace(0, 2 * math.pi, 40, endpoint=False)),
            0.0165 * np.sin(np.linspace(0, 2 * math.pi, 40, endpoint=False)),
            np.zeros(40),
        ]
    )
    turn = tuple(WHEEL.to_3x3() @ Vector((0, 0, 1)))
    tube("badge halo", place(ring, at), 0.0015, "bright chrome", 10, True, 1.0, turn)
    for x, r in ((0, 0.0062), (-0.0165, 0.0034), (0.0165, 0.0034)):
        dot = at @ Matrix.Translation((x, 0, 0))
        lathe(
            "badge sun",
            [(r, -0.002), (r, 0.0006), (r * 0.8, 0.0020), (r * 0.4, 0.0026), (0.0002, 0.0028)],
            dot,
            "bright chrome",
            24,
        )


def column_joint():
    """Where the shroud's halves meet, down both its sides."""
    for side, sign in (("left", -1), ("right", 1)):
        path = [(0.0462, -0.006, -0.052), (0.0521, -0.010, -0.110), (0.0561, -0.016, -0.200)]
        path.append((0.0581, -0.022, -0.328))
        points = spline([(sign * x, y, z) for x, y, z in path], 24)
        tube(f"column joint {side}", place(points, WHEEL), 0.0009, "gap", 6)


def column():
    rings = []
    for z, width, height, drop in (
        (-0.030, 0.074, 0.070, 0.0),
        (-0.050, 0.092, 0.086, 0.004),
        (-0.110, 0.104, 0.098, 0.008),
        (-0.200, 0.112, 0.104, 0.014),
        (-0.330, 0.116, 0.106, 0.020),
    ):
        o = rounded_rectangle(width, height, 0.026, 6)
        rings.append(np.column_stack([o[:, 0], o[:, 1] - drop, np.full(len(o), z)]))
    grid(
        "steering column shroud",
        place(np.array(rings)[::-1], WHEEL),
        "plastic grained",
        closed=True,
    )
    column_joint()


def build_wheel():
    rim()
    spokes()
    hub()
    column()
    controls.build_controls(WHEEL)
    for row in switch_prints():
        printed(*row)
