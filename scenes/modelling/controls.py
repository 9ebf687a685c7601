# SPDX-License-Identifier: Apache-2.0
"""What the driver's fingers reach behind the wheel: two stalks with ring switches, two paddles.

Both keep within the outlines of plain tubes and plates that once stood in their place: beyond
these they would hide parts of the displays from low eyes.
"""
import math

import numpy as np
from mathutils import Matrix, Vector

from legends import printed
from shapes import frame_matrix, grid, place, spline, tube, tube_points

SIDES = (("left", -1), ("right", 1))


def arm_section(width, thickness, count=20):
    """A superellipse, counter-clockwise: nearly flat faces, round edges."""
    a = np.linspace(0, 2 * math.pi, count, endpoint=False)
    x, y = np.cos(a), np.sin(a)
    return np.column_stack(
        [
            0.5 * width * np.sign(x) * abs(x) ** 0.55,
            0.5 * thickness * np.sign(y) * abs(y) ** 0.7,
        ]
    )


def arm_rings(path, widths, thicknesses, count=20):
    """Sections along a path of the wheel's frame, across the wheel's plane."""
    rings = []
    for i, point in enumerate(path):
        tangent = path[min(i + 1, len(path) - 1)] - path[max(i - 1, 0)]
        tangent /= np.linalg.norm(tangent)
        across = np.cross((0, 0, 1), tangent)
        across /= np.linalg.norm(across)
        lift = np.cross(tangent, across)
        s = arm_section(widths[i], thicknesses[i], count)
        rings.append(point + s[:, :1] * across + s[:, 1:] * lift)
    return np.array(rings)


def swell(share, table):
    """A radius or width along a part, straight between rows (share, value) of a table."""
    t, v = np.array(table).T
    return np.interp(share, t, v)


# ---- paddles -----------------------------------------------------------------------------

# Shares of a paddle's length: its width and thickness, m; its tip is rounded off.
PADDLE_WIDTH = [(0.0, 0.0215), (0.30, 0.0250), (0.62, 0.0285), (0.84, 0.0275)]
PADDLE_THICKNESS = [(0.0, 0.0046), (0.45, 0.0032), (0.8, 0.0026), (1.0, 0.0022)]


def paddle_path(sign, count):
    """From behind the spoke up and a little inward, bent towards the driver at the tip."""
    return spline(
        [
            (sign * 0.1290, -0.006, -0.0300),
            (sign * 0.1240, 0.014, -0.0290),
            (sign * 0.1185, 0.036, -0.0270),
            (sign * 0.1122, 0.0625, -0.0252),
        ],
        count,
    )


def paddle_mark(sign, wheel):
    """The plane of the engraved sign on a paddle's upper third."""
    path = paddle_path(sign, 41)
    along = path[31] - path[29]
    origin = path[30] + (0, 0, 0.5 * swell(0.75, PADDLE_THICKNESS))
    return wheel @ frame_matrix(origin, (along[1], -along[0], 0), tuple(along))


def paddle(side, sign, wheel):
    tip = 1 - 0.2 * np.cos(np.linspace(0.35, 0.5 * math.pi, 8)) ** 1.5
    share = np.concatenate([np.linspace(0, 0.80, 9), tip])
    path = paddle_path(sign, 401)[np.round(share * 400).astype(int)]
    width, thickness = swell(share, PADDLE_WIDTH), swell(share, PADDLE_THICKNESS)
    end = np.clip((share - 0.80) / 0.20, 0, 1)
    width *= np.maximum(1 - end**2.6, 0.0) ** 0.42 + 0.001
    thickness[-1] *= 0.1
    rings = place(arm_rings(path, width, thickness), wheel)
    # The cluster's glass mirrors the back, which is bare metal; the front is anodised.
    grid(f"shift paddle {side}", rings[:, :11], "satin dark")
    back = np.concatenate([rings[:, 10:], rings[:, :1]], axis=1)
    grid(f"shift paddle back {side}", back, "cross-brushed aluminium")


# ---- stalks ------------------------------------------------------------------------------

# Shares of a stalk's length from the column outward: radius in the wheel's plane, m. The step
# before 0.56 takes the boot, 0.60 to 0.71 is the ring switch, the rest the flat end.
STALK = [
    (0.0, 0.0074),
    (0.10, 0.0070),
    (0.16, 0.0057),
    (0.40, 0.0055),
    (0.53, 0.0064),
    (0.565, 0.0084),
    (0.595, 0.0084),
    (0.600, 0.0066),
    (0.710, 0.0066),
    (0.715, 0.0084),
    (0.80, 0.0089),
    (0.95, 0.0089),
    (0.985, 0.0084),
    (1.0, 0.0066),
]
STALK_FLAT = 0.74  # thickness of a section over its width
ROUND = np.array([0.0, 0.1, 0.16, 0.3, 0.4, 0.48, 0.53, 0.55, 0.565, 0.58, 0.595, 0.6, 0.65])
SHARES = np.concatenate([ROUND, [0.71, 0.715, 0.75, 0.8, 0.87, 0.95, 0.972, 0.985, 1.0]])


def stalk_path(sign, count):
    return spline(
        [
            (sign * 0.040, 0.012, -0.070),
            (sign * 0.080, 0.022, -0.064),
            (sign * 0.125, 0.032, -0.055),
            (sign * 0.166, 0.0398, -0.048),
        ],
        count,
    )


def stalk_plane(sign, wheel, share):
    """On a stalk's flat front at this share of its length: x outward on the right."""
    path = stalk_path(sign, 201)
    k = round(share * 200)
    along = sign * (path[k + 2] - path[k - 2])
    thick = 0.96 * STALK_FLAT * float(swell(share, STALK))
    at = frame_matrix(path[k], tuple(along), (0, 1, 0))
    return wheel @ at @ Matrix.Translation((0, 0, thick))


def stalk(side, sign, wheel):
    path = stalk_path(sign, 401)[np.round(SHARES * 400).astype(int)]
    radius = swell(SHARES, STALK)
    rings = arm_rings(path, 2 * radius, 2 * STALK_FLAT * radius, 24)
    end = path[-1] + 0.0012 * sign * np.array([1.0, 0.18, 0.16])
    caps = [[end + k * (rings[-1] - path[-1])] for k in (0.6, 0.01)]
    rings = np.concatenate([rings, *caps])
    grid(f"column stalk {side}", place(rings, wheel), "plastic dark", closed=True)
    ring_switch(side, sign, wheel)
    line = place(stalk_path(sign, 401)[[222, 226]], wheel)
    turn = tuple(wheel.to_3x3() @ Vector((0, 0, 1)))
    name = f"column stalk line {side}"
    tube(name, line, 0.00865, "satin chrome", 24, False, STALK_FLAT, turn)


def ring_switch(side, sign, wheel):
    """The ring that turns about the stalk, with fine ridges along it."""
    path = stalk_path(sign, 401)[np.round(np.linspace(0.607, 0.703, 6) * 400).astype(int)]
    sides = 44
    radius = np.array([0.0071, 0.0083, 0.0085, 0.0085, 0.0083, 0.0071])
    rings = tube_points(path, radius, sides, False, 0.86, (0, 0, 1))
    ridge = np.where(np.arange(sides) % 2 == 0, 1.0, 0.955)[None, :, None]
    rings = path[:, None] + ridge * (rings - path[:, None])
    name = f"column stalk ring {side}"
    grid(name, place(rings, wheel), "satin dark", closed=True, flip=True)


def engraved(wheel):
    """Rows of legends.printed for the paddles, which are not lit."""
    return [
        (f"paddle sign {side}", "+" if sign > 0 else "-", paddle_mark(sign, wheel), 0.0115)
        for side, sign in SIDES
    ]


def prints(wheel):
    """Rows of legends.printed for the stalks."""
    rows = []
    for sign, side, near, far in (
        (-1, "left", "beam", ("arrow left", "arrow right")),
        (1, "right", "wipe", ("INT", "OFF")),
    ):
        rows.append((f"stalk icon {side}", near, stalk_plane(sign, wheel, 0.93), 0.0082))
        for k, what in zip((0.0024, -0.0024), far):
            at = stalk_plane(sign, wheel, 0.80) @ Matrix.Translation((0, k, 0))
            height = 0.0040 if sign < 0 else 0.0026
            rows.append((f"stalk sign {side} {what}", what, at, height))
    return rows


def build_controls(wheel):
    for side, sign in SIDES:
        stalk(side, sign, wheel)
        paddle(side, sign, wheel)
    for row in prints(wheel) + engraved(wheel):
        printed(*row)
