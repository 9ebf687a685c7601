# SPDX-License-Identifier: Apache-2.0
"""Windscreen, mirrors, side windows, pillars, roof and rear."""
import math

import numpy as np
from mathutils import Matrix

from shapes import (
    box,
    frame_matrix,
    grid,
    joined,
    lathe,
    mesh,
    place,
    plate,
    rounded_rectangle,
    spline,
    tube,
    tube_points,
)
from windscreen import screen

SIDES = (("left", -1), ("right", 1))


# ---- windscreen --------------------------------------------------------------------------


def screen_grid(name, us, vs, material, inward, flip=False):
    """Fronts look into the car; flip turns them."""
    u, v = np.meshgrid(us, vs)
    return grid(name, screen(u, v, inward), material, flip=flip)


def windscreen():
    screen_grid(
        "windscreen",
        np.linspace(-1.02, 1.02, 49),
        np.linspace(-0.03, 1.03, 33),
        "windscreen glass",
        0.0,
        flip=True,
    )
    us, vs = np.linspace(-1.02, 1.02, 49), np.linspace(-0.03, 1.03, 33)
    bands = {
        "foot": (us, np.linspace(-0.03, 0.075, 4)),
        "header": (us, np.linspace(0.93, 1.03, 4)),
        "left": (np.linspace(-1.02, -0.945, 3), vs),
        "right": (np.linspace(0.945, 1.02, 3), vs),
        "mirror foot": (np.linspace(-0.10, 0.10, 5), np.linspace(0.80, 0.94, 5)),
    }
    parts = [screen_grid(k, *b, "frit", 0.0022) for k, b in bands.items()]
    joined("frit band", parts)
    frit_dots()
    for name, a, b in (
        ("driver", (-0.80, 0.030), (-0.06, 0.075)),
        ("passenger", (0.02, 0.030), (0.74, 0.070)),
    ):
        wiper(name, a, b)


# Sections of a wiper (across, away from the glass), m: the flexible blade with its spoiler and
# the rubber's lip below it, and the arm.
BLADE = [(-0.0010, 0.0), (0.0010, 0.0), (0.0022, 0.0045), (0.0060, 0.0052), (0.0062, 0.0066)]
BLADE += [(0.0036, 0.0084), (-0.0008, 0.0128), (-0.0030, 0.0132), (-0.0060, 0.0072)]
BLADE += [(-0.0058, 0.0052), (-0.0022, 0.0045)]
ARM = [(-0.0060, -0.0022), (0.0060, -0.0022), (0.0064, 0.0), (0.0040, 0.0030)]
ARM += [(-0.0040, 0.0030), (-0.0064, 0.0)]


def swept(name, path, section, scale, material):
    """A section carried along a path on the windscreen, closed at both ends."""
    path = np.asarray(path, float)
    along = np.gradient(path, axis=0)
    along /= np.linalg.norm(along, axis=1)[:, None]
    side = np.cross(along, (0, 0.46, 0.89))
    side /= np.linalg.norm(side, axis=1)[:, None]
    lift = np.cross(side, along)
    s = np.asarray(section, float)[None] * np.asarray(scale, float)[:, None, None]
    rings = path[:, None] + s[..., :1] * side[:, None] + s[..., 1:] * lift[:, None]
    ends = [r.mean(0) + 0.02 * (r - r.mean(0)) for r in (rings[0], rings[-1])]
    rings = np.concatenate([ends[:1], rings, ends[1:]])
    return grid(name, rings, material, closed=True)


def wiper(name, a, b):
    """A blade that rests at the screen's foot on a gentle arch, its arm and its pivot's cap."""

    def rest(t, out):
        v = a[1] + (b[1] - a[1]) * t + 0.014 * math.sin(math.pi * t)
        return screen(a[0] + (b[0] - a[0]) * t, v, -out)

    ts = np.concatenate([[0.0, 0.012], np.linspace(0.04, 0.96, 22), [0.988, 1.0]])
    thick = np.concatenate([[0.45, 0.8], np.ones(22), [0.8, 0.45]])
    swept(f"wiper {name}", [rest(t, 0.0012) for t in ts], BLADE, thick, "wiper black")
    joint = frame_matrix(rest(0.52, 0.011), rest(0.56, 0) - rest(0.48, 0), (0, 0.89, -0.46))
    box(f"wiper joint {name}", (0.046, 0.013, 0.010), joint, "wiper black", 0.003, 2)
    start = rest(0.0, 0.012) + (0, 0.05, -0.010)
    knee = rest(0.10, 0.020) + (0, 0.02, 0)
    arm = spline([start, knee, rest(0.32, 0.021), rest(0.53, 0.016)], 16)
    swept(f"wiper arm {name}", arm, ARM, np.linspace(1.5, 0.9, 16), "wiper black")
    lathe(
        f"wiper pivot {name}",
        [(0.017, -0.05), (0.016, 0.004), (0.0135, 0.010), (0.009, 0.0125), (0.0004, 0.013)],
        frame_matrix(start, (1, 0, 0), (0, 0.89, -0.46)),
        "plastic dark",
        24,
    )


def frit_dots():
    """Rows of shrinking dots that fade the band's edge."""
    vertices, faces = [], []
    a = np.linspace(0, 2 * math.pi, 8, endpoint=False)
    for row, (v, radius) in enumerate(((0.0805, 0.0021), (0.0855, 0.0016), (0.0900, 0.0011))):
        for i in range(170):
            u = -0.93 + 1.86 * (i + 0.5 * (row % 2)) / 170
            base = len(vertices)
            vertices.extend(
                screen(u + radius * np.cos(a) / 0.72, v + radius * np.sin(a) / 1.0, 0.0022)
            )
            faces.append([base + k for k in range(8)])
    mesh("frit dots", vertices, faces, "frit")


def rear_view_mirror():
    at = frame_matrix((0.0, 0.500, 1.392), (0.952, -0.305, 0), (0, -0.13, 1))
    outline = rounded_rectangle(0.236, 0.062, 0.022, 8)
    plate(
        "mirror housing",
        outline * 1.02,
        0.022,
        at @ Matrix.Translation((0, 0, -0.001)),
        "plastic dark",
        0.006,
        3,
    )
    plate(
        "mirror glass",
        outline * 0.975,
        0.001,
        at @ Matrix.Translation((0, 0, 0.0006)),
        "mirror silver",
        0.0004,
    )
    tube(
        "mirror stalk",
        spline([(0.0, 0.522, 1.396), (0.0, 0.556, 1.412), screen(0.0, 0.865, 0.004)], 8),
        0.008,
        "plastic dark",
        12,
    )
    box(
        "camera housing",
        (0.10, 0.10, 0.035),
        frame_matrix(screen(0.0, 0.895, 0.020), (1, 0, 0), (0, -0.89, 0.46)),
        "plastic dark",
        0.012,
        3,
    )


def visors():
    for side, sign in SIDES:
        centre = screen(0.52 * sign, 1.0, 0.024) + np.array([0, -0.105, 0.004])
        at = frame_matrix(centre, (1, -0.10 * sign, 0), (0, 1, -0.02))
        plate(
            f"sun visor {side}",
            rounded_rectangle(0.38, 0.15, 0.03, 6),
            0.018,
            at,
            "alcantara grey",
            0.006,
            3,
        )


# ---- greenhouse --------------------------------------------------------------------------


RAIL_Y = np.array([1.11, 0.910, 0.710, 0.510, 0.32, 0.10, -0.20, -0.60, -1.05, -1.40, -1.80])
RAIL_X = np.array([0.748, 0.708, 0.667, 0.627, 0.592, 0.580, 0.574, 0.566, 0.552, 0.572, 0.660])
RAIL_Z = np.array([1.050, 1.165, 1.270, 1.368, 1.447, 1.470, 1.480, 1.472, 1.432, 1.330, 1.070])


def rail(y):
    return np.interp(y, RAIL_Y[::-1], RAIL_X[::-1]), np.interp(y, RAIL_Y[::-1], RAIL_Z[::-1])


BELT_X, BELT_Z = 0.778, 1.036  # m, the windows' lower edge


def side_sheet(name, sign, y_range, material, outward=0.0, low=0.0, high=None, step=0.04):
    """Part of the side window's sheet. low: metres above the belt; high: a height above the
    belt, or None for the roof rail, or minus metres under the rail."""
    ys = np.linspace(*y_range, max(3, int(abs(y_range[1] - y_range[0]) / step)))
    rows = []
    for t in np.linspace(0, 1, 9):
        row = []
        for y in ys:
            (bx, bz), (rx, rz) = (BELT_X, BELT_Z), rail(y)
            rz = max(rz, bz + 0.002)
            top = rz - bz
            start = min(max(top + low, 0), top) if low < 0 else min(low, top)
            end = top if high is None else min(high, top)
            h = start + (end - start) * t
            k = h / top
            x = bx + (rx - bx) * k + 0.030 * 4 * k * (1 - k) * 0.5 + outward
            row.append((sign * x, y, bz + h))
        rows.append(row)
    return grid(name, np.array(rows), material, flip=(sign < 0))


def side_windows():
    for side, sign in SIDES:
        side_sheet(f"side glass {side}", sign, (1.10, -1.60), "side glass")
        for layer, shift, fabric in (
            ("inner", -0.006, "pillar fabric"),
            ("outer", 0.004, "plastic dark"),
        ):
            side_sheet(f"B-pillar {layer} {side}", sign, (-0.17, -0.30), fabric, shift)
            side_sheet(
                f"C-pillar {layer} {side}",
                sign,
                (-1.22, -1.80),
                fabric if layer == "inner" else "car paint",
                shift,
            )
            side_sheet(f"mirror sail {layer} {side}", sign, (1.11, 0.90), "plastic dark", shift)
            side_sheet(
                f"waist seal {layer} {side}", sign, (1.10, -1.6), "rubber", shift, 0.0, 0.016
            )
            side_sheet(
                f"window frame {layer} {side}",
                sign,
                (1.10, -1.6),
                "rubber",
                shift * 1.2,
                -0.030,
                None,
            )
        waist_chrome(side, sign)
        pillar(side, sign)
        door_mirror(side, sign)


def waist_chrome(side, sign):
    ys = np.linspace(1.05, -1.6, 40)
    path = [(sign * (BELT_X + 0.008), y, BELT_Z + 0.004) for y in ys]
    tube(f"waist strip {side}", path, 0.006, "satin chrome", 8)


def pillar(side, sign):
    """A-pillar: fabric inside, paint outside, and the trim along the roof rail behind it."""
    vs = np.linspace(-0.06, 1.0, 26)
    inner = screen(0.995 * sign, vs, 0.022)
    header = np.array(
        [
            (sign * (rail(y)[0] - 0.012), y, rail(y)[1] - 0.012)
            for y in np.linspace(0.24, -1.5, 24)
        ]
    )
    path = np.concatenate([inner, header])
    radius = np.concatenate(
        [np.interp(vs, (-0.06, 0.2, 1), (0.046, 0.036, 0.033)), np.full(24, 0.030)]
    )
    turn = (0, 0.46, 0.89)
    tube(f"A-pillar {side}", path, radius, "pillar fabric", 20, False, 0.80, turn)
    pillar_joint(side, sign, tube_points(path, radius, 20, False, 0.80, turn))
    outer = screen(1.03 * sign, np.array([-0.14, 0.10, 0.35, 0.60, 0.85]), -0.004)
    roof = [
        (sign * (rail(y)[0] + 0.010), y, rail(y)[1] + 0.012)
        for y in (0.16, -0.25, -0.7, -1.1, -1.45, -1.90)
    ]
    tube(
        f"A-pillar outside {side}",
        spline(np.concatenate([outer, roof]), 52),
        0.034,
        "car paint",
        16,
        False,
        0.62,
        (0, 0.46, 0.89),
    )


def pillar_joint(side, sign, rings):
    """Where the pillar's cover meets its back, on the side towards the people."""
    near = np.linalg.norm(rings[13] - (0.37 * sign, 0, 1.30), axis=1).argmin()
    line = rings[:26, (near + 2 * sign) % rings.shape[1]]
    tube(f"A-pillar joint {side}", line, 0.0013, "gap", 6)
    tweeter = frame_matrix((sign * 0.7640, 0.952, 1.0690), (0, -sign, 0), (0.25 * sign, 0, 1))
    lathe(
        f"tweeter ring {side}",
        [(0.0190, -0.006), (0.0190, 0.0020), (0.0180, 0.0034), (0.0166, 0.0028)],
        tweeter,
        "satin dark",
        40,
    )
    lathe(
        f"tweeter {side}",
        [(0.0165, 0.0010), (0.012, 0.0026), (0.006, 0.0034), (0.0003, 0.0036)],
        tweeter,
        "speaker cloth",
        32,
    )


def door_mirror(side, sign):
    at = frame_matrix((sign * 1.00, 0.845, 1.085), (0.970, -0.24 * sign, 0), (0, 0.07, 1))
    outline = rounded_rectangle(0.205, 0.125, 0.045, 8)
    rings = [
        np.column_stack([outline * k, np.full(len(outline), z)])
        for k, z in (
            (0.10, -0.098),
            (0.45, -0.092),
            (0.72, -0.078),
            (0.90, -0.052),
            (0.985, -0.020),
            (1.0, 0.0),
            (0.985, 0.004),
            (0.95, 0.003),
        )
    ]
    grid(f"door mirror {side}", place(np.array(rings), at), "car paint", closed=True)
    plate(f"door mirror glass {side}", outline * 0.95, 0.002, at, "mirror silver", 0.0005)
    tube(
        f"door mirror arm {side}",
        spline(
            [
                (sign * 0.80, 0.90, 1.035),
                (sign * 0.87, 0.895, 1.030),
                (sign * 0.945, 0.88, 1.045),
            ],
            8,
        ),
        0.024,
        "plastic dark",
        14,
        False,
        0.55,
    )


# ---- roof and rear ----------------------------------------------------------------


def roof_point(u, y, lift):
    x, z = rail(y)
    front = -0.120 * u**2 * np.clip((y + 0.4) / 0.84, 0, 1) + 0.0
    return np.array([x * u, y + front, z + 0.040 * (1 - u * u) + lift])


def roof():
    ys = np.linspace(0.44, -1.42, 32)
    us = np.linspace(-1, 1, 25)

    def point(u, y, lift):
        head = screen(u, 1.0, 0.0)
        base = roof_point(u, y, lift)
        blend = np.clip((y - 0.10) / 0.34, 0, 1)
        target = np.array([head[0], head[1] + (y - 0.44), head[2] + lift])
        return base * (1 - blend) + target * blend

    for name, lift, material, flip in (
        ("roof lining", -0.028, "alcantara grey", False),
        ("roof", 0.004, "car paint", True),
    ):
        parts = [
            grid(
                name,
                np.array([[point(u, y, lift) for u in columns] for y in rows]),
                material,
                flip=flip,
            )
            for rows, columns in roof_frame(ys, us)
        ]
        joined(name, parts)
    pane = [
        [point(u, y, -0.002) for u in np.linspace(-0.72, 0.72, 13)]
        for y in np.linspace(0.13, -1.20, 18)
    ]
    grid("roof glass", np.array(pane), "roof glass")
    edge = [point(u, y, -0.014) for u, y in roof_opening()]
    tube("roof glass seal", np.array(edge), 0.016, "rubber", 8, True)
    lip = [
        [screen(u, v, 0.024) + np.array([0, dy, 0]) for u in us]
        for v, dy in ((0.955, 0), (1.0, 0.0), (1.03, -0.02))
    ]
    grid("header trim", np.array(lip), "alcantara grey")
    tube("header edge", screen(us * 0.99, 0.955, 0.020), 0.008, "alcantara grey", 10)
    console_lamp()


def roof_frame(ys, us):
    """Four strips of the roof around its glass: (rows, columns) in y and u."""
    middle = np.linspace(0.10, -1.17, 20)
    return (
        (np.linspace(ys[0], 0.10, 8), us),
        (np.linspace(-1.17, ys[-1], 5), us),
        (middle, np.linspace(-1, -0.70, 6)),
        (middle, np.linspace(0.70, 1, 6)),
    )


def roof_opening():
    """(u, y) around the glass's edge, with rounded corners."""
    outline = rounded_rectangle(1.40, 1.27, 0.10, 6)
    return [(x, y - 0.535) for x, y in outline]


def console_lamp():
    at = frame_matrix((0, 0.23, 1.470), (1, 0, 0), (0, 1, 0.10))
    plate(
        "roof console",
        rounded_rectangle(0.16, 0.18, 0.03, 6),
        0.02,
        at @ Matrix.Translation((0, 0, -0.012)),
        "plastic grained",
        0.005,
        3,
    )


def rear():
    us = np.linspace(-1, 1, 17)
    top = np.array(
        [[rail(-1.40)[0] * u, -1.40, rail(-1.40)[1] + 0.045 * (1 - u * u)] for u in us]
    )
    foot = np.array([[0.66 * u, -1.86 - 0.05 * (1 - u * u), 1.075] for u in us])
    rows = [
        top * (1 - t) + foot * t + np.array([0, -0.02, 0.02]) * 4 * t * (1 - t)
        for t in np.linspace(0, 1, 9)
    ]
    grid("rear glass", np.array(rows), "side glass")
    grid(
        "rear shelf",
        np.array([[(0.78 * u, y, 1.068) for u in us] for y in (-1.30, -1.93)]),
        "carpet",
        flip=True,
    )


def build_greenhouse():
    windscreen()
    rear_view_mirror()
    visors()
    side_windows()
    roof()
    rear()
