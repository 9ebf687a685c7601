# SPDX-License-Identifier: Apache-2.0
"""The steering wheel, its column, stalks and paddles."""
import math

import numpy as np
from mathutils import Matrix, Vector

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


def spoke_section(width, thickness, count=20):
    a = np.linspace(0, 2 * math.pi, count, endpoint=False)
    x, y = np.cos(a), np.sin(a)
    return np.column_stack(
        [
            0.5 * width * np.sign(x) * abs(x) ** 0.55,
            0.5 * thickness * np.sign(y) * abs(y) ** 0.7,
        ]
    )


def spoke(name, path, widths, thicknesses, material):
    """A flat arm along path (local), its section across the wheel's plane."""
    path = spline(path, 16)
    widths, thicknesses = (
        spline(np.array(widths)[:, None], 16)[:, 0],
        spline(np.array(thicknesses)[:, None], 16)[:, 0],
    )
    rings = []
    for i, point in enumerate(path):
        tangent = path[min(i + 1, 15)] - path[max(i - 1, 0)]
        tangent /= np.linalg.norm(tangent)
        across = np.cross((0, 0, 1), tangent)
        across /= np.linalg.norm(across)
        lift = np.cross(tangent, across)
        s = spoke_section(widths[i], thicknesses[i])
        rings.append(point + s[:, :1] * across + s[:, 1:] * lift)
    return grid(name, place(np.array(rings), WHEEL), material, closed=True)


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
        paddle(side, sign)
    spoke(
        "steering wheel spoke lower",
        [(0, -0.045, 0.008), (0, -0.10, 0.006), (0, -0.150, 0.000), (0, -0.172, 0)],
        (0.064, 0.048, 0.040, 0.040),
        (0.028, 0.018, 0.014, 0.012),
        "plastic dark",
    )
    slot = WHEEL @ Matrix.Translation((0, -0.118, 0.0145))
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


def switch_pod(side, sign):
    """Gloss black keys with a satin frame on a spoke, and a knurled roller."""
    at = (
        WHEEL
        @ Matrix.Translation((sign * 0.1115, 0.0015, 0.0205))
        @ Matrix.Rotation(sign * math.radians(7), 4, "Y")
    )
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
    for x, y, w, h in (
        (-0.0165, 0.010, 0.017, 0.016),
        (0.0165, 0.010, 0.017, 0.016),
        (-0.0165, -0.010, 0.017, 0.016),
        (0.0165, -0.010, 0.017, 0.016),
    ):
        keys.append(
            box(
                "key",
                (w, h, 0.003),
                at @ Matrix.Translation((x, y, 0.0008)),
                "button",
                0.0012,
                2,
            )
        )
        for k in (-1, 0, 1) if x * sign > 0 else (0,):
            mark = at @ Matrix.Translation((x + 0.0032 * k, y, 0.00236))
            box(
                f"switch mark {side}",
                (
                    0.0010 if x * sign > 0 else 0.0055,
                    0.0042 if x * sign > 0 else 0.0011,
                    0.0001,
                ),
                mark,
                "symbol white",
                0,
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


def paddle(side, sign):
    at = (
        WHEEL
        @ Matrix.Translation((sign * 0.120, 0.030, -0.024))
        @ Matrix.Rotation(sign * math.radians(14), 4, "Z")
    )
    plate(
        f"shift paddle {side}",
        rounded_rectangle(0.030, 0.070, 0.010, 6),
        0.004,
        at,
        "cross-brushed aluminium",
        0.0015,
        3,
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
    """A sun with its two mock suns on the halo."""
    at = WHEEL @ Matrix.Translation((0, 0.000, 0.0352))
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
    for side, sign in (("left", -1), ("right", 1)):
        stalk(side, sign)


def stalk(side, sign):
    path = spline(
        [
            (sign * 0.040, 0.012, -0.070),
            (sign * 0.080, 0.022, -0.064),
            (sign * 0.125, 0.032, -0.055),
            (sign * 0.166, 0.040, -0.048),
        ],
        14,
    )
    radii = np.interp(
        np.linspace(0, 1, 14), (0, 0.25, 0.6, 1), (0.0070, 0.0062, 0.0078, 0.0092)
    )
    turn = tuple(WHEEL.to_3x3() @ Vector((0, 0, 1)))
    tube(
        f"column stalk {side}", place(path, WHEEL), radii, "plastic dark", 16, False, 0.8, turn
    )
    ring = place(path[9:11], WHEEL)
    tube(f"column stalk ring {side}", ring, 0.0090, "satin chrome", 20, False, 0.8, turn)


def build_wheel():
    rim()
    spokes()
    hub()
    column()
