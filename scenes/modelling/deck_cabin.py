# SPDX-License-Identifier: Apache-2.0
"""Around the pilots: side consoles with sticks, seats, pedals, and the overhead panel."""
import math

import numpy as np
from mathutils import Matrix

from deck_layout import EYE
from kit import Kit, shifted
from shapes import box, frame_matrix, grid, spline, tube

# The side console's inner edge and its foot at the wall, right half, front to rear.
INNER = [
    (0.800, 0.955, 0.900),
    (0.785, 0.700, 0.855),
    (0.780, 0.585, 0.785),
    (0.785, 0.520, 0.752),
    (0.795, 0.20, 0.742),
    (0.80, -0.86, 0.735),
]
OUTER = [
    (0.822, 0.968, 0.902),
    (0.930, 0.707, 0.859),
    (0.991, 0.562, 0.836),
    (1.025, 0.480, 0.823),
    (1.096, 0.310, 0.797),
    (1.139, -0.860, 0.797),
]


def ledge(kit, side):
    """The console's top: level at the stick, rising to the wall in a rounded cove."""
    inner = spline([(side * x, y, z) for x, y, z in INNER], 60)
    outer = spline([(side * x, y, z) for x, y, z in OUTER], 60)
    rows = []
    for t, low in (
        (0.0, 0.012),
        (0.03, 0.003),
        (0.10, 0.0),
        (0.35, 0.0),
        (0.6, 0.006),
        (0.8, 0.012),
        (1.0, 0.0),
    ):
        share = t**2.4
        rows.append(
            np.column_stack(
                [
                    inner[:, 0] + t * (outer[:, 0] - inner[:, 0]),
                    inner[:, 1] + t * (outer[:, 1] - inner[:, 1]),
                    inner[:, 2] + share * (outer[:, 2] - inner[:, 2]) - low,
                ]
            )
        )
    grid(f"side console {side}", np.array(rows), "lining grey", flip=side < 0)
    foot = rows[0].copy()
    foot[:, 2] = 0.0
    grid(f"console wall {side}", np.array([rows[0], foot]), "lining grey", flip=side > 0)
    top = frame_matrix((side * 0.862, 0.37, 0.752), (1, 0, 0), (0, 1, 0.02))
    kit.panel((0.115, 0.245), top, "panel dark", 0.004, 0.010)
    kit.screws(shifted(top, z=0.004), (0.115, 0.245), 0.009, 0.003)
    return top


def side_stick(kit, top, side):
    """A pistol grip in its boot, canted a little inboard."""
    base = shifted(top, 0, 0.020, 0.004)
    kit.lathe(
        [
            (0.040, 0),
            (0.040, 0.004),
            (0.034, 0.008),
            (0.030, 0.016),
            (0.032, 0.020),
            (0.024, 0.028),
            (0.026, 0.032),
            (0.018, 0.041),
            (0.016, 0.050),
        ],
        base,
        "seal",
        28,
    )
    lean = base @ Matrix.Rotation(math.radians(-7), 4, "X")
    lean = lean @ Matrix.Rotation(math.radians(-side * 5), 4, "Y")
    rings = []
    for z, wide, deep, ahead in (
        (0.040, 0.0150, 0.0165, 0.000),
        (0.055, 0.0165, 0.0200, 0.000),
        (0.063, 0.0230, 0.0260, 0.000),
        (0.070, 0.0175, 0.0225, 0.000),
        (0.090, 0.0172, 0.0230, 0.003),
        (0.112, 0.0178, 0.0215, 0.005),
        (0.132, 0.0190, 0.0225, 0.009),
        (0.150, 0.0215, 0.0235, 0.015),
        (0.163, 0.0205, 0.0225, 0.019),
        (0.170, 0.0150, 0.0165, 0.021),
        (0.1725, 0.0010, 0.0010, 0.021),
    ):
        a = np.linspace(0, 2 * math.pi, 24, endpoint=False)
        rings.append(
            np.column_stack([wide * np.cos(a), ahead + deep * np.sin(a), np.full(24, z)])
        )
    smooth = spline(np.array(rings).reshape(len(rings), -1), 40).reshape(40, 24, 3)
    m = np.array(lean)
    grid(f"side stick {side}", smooth @ m[:3, :3].T + m[:3, 3], "stick", closed=True)
    knob = lean @ Matrix.Translation((side * -0.006, 0.010, 0.1690))
    kit.lathe([(0.0062, 0), (0.0062, 0.005), (0.0048, 0.0062)], knob, "guard red", 18)
    trigger = lean @ Matrix.Translation((0, 0.036, 0.138))
    kit.box((0.012, 0.012, 0.026), trigger, "bezel", 0.004)
    kit.text("PRIORITY", shifted(top, 0, -0.085, 0.0043), 0.0050)
    tiller = shifted(top, -side * 0.005, -0.060, 0.004)
    kit.lathe([(0.020, 0), (0.020, 0.008), (0.017, 0.011)], tiller, "knob", 28, 0.05)


def console_details(kit, side):
    """Lamp, speaker grille and air outlet on the wall beside each pilot."""
    wall = frame_matrix(
        (side * 0.975, 0.445, 0.815), (0.1, 1, 0) if side < 0 else (-0.1, -1, 0), (0, 0, 1)
    )
    kit.lathe(
        [(0.026, -0.02), (0.026, 0.004), (0.021, 0.007), (0.015, 0.001)], wall, "bezel", 28
    )
    arm = [
        (side * 0.885, 0.69, 0.880),
        (side * 0.87, 0.66, 0.99),
        (side * 0.85, 0.63, 1.015),
        (side * 0.835, 0.60, 1.010),
    ]
    tube(f"map light neck {side}", spline(arm, 20), 0.0055, "stick", 10)
    head = frame_matrix((side * 0.828, 0.588, 1.006), (1, 0, 0), (0, 0.6, 1))
    kit.lathe(
        [(0.006, -0.030), (0.014, -0.018), (0.015, 0.006), (0.012, 0.008)], head, "stick", 20
    )


def seat(kit, side):
    """A pilot's seat with sheepskin, armrests and belts."""
    x = side * -EYE[0]
    flat = lambda px, py, pz, lean=0.0: frame_matrix(  # noqa: E731
        (px, py, pz), (1, 0, 0), (0, math.cos(lean), math.sin(lean))
    )
    lean = math.radians(104)
    parts = [
        ("cushion", (0.46, 0.46, 0.11), flat(x, 0.12, 0.45, 0.06), "sheepskin", 0.05),
        ("base", (0.48, 0.46, 0.06), flat(x, 0.12, 0.375), "panel dark", 0.012),
        ("back", (0.45, 0.62, 0.10), flat(x, -0.205, 0.775, lean), "deck seat", 0.046),
        ("pad", (0.37, 0.54, 0.05), flat(x, -0.160, 0.775, lean), "sheepskin", 0.024),
        ("head", (0.27, 0.17, 0.085), flat(x, -0.275, 1.190, lean), "deck seat", 0.04),
    ]
    for label, size, at, material, bevel in parts:
        box(f"seat {label} {side}", size, at, material, bevel, 5)
    for k in (-1, 1):
        arm = frame_matrix((x + k * 0.262, 0.03, 0.675), (1, 0, 0), (0, 1, 0.05))
        box(f"armrest {side} {k}", (0.058, 0.31, 0.045), arm, "armrest", 0.018, 4)
        kit.box(
            (0.030, 0.045, 0.25),
            frame_matrix((x + k * 0.262, -0.09, 0.55), (1, 0, 0), (0, 1, 0)),
            "panel dark",
            0.006,
        )
        belt = [
            (x + k * 0.055, -0.33, 1.08),
            (x + k * 0.08, -0.235, 1.075),
            (x + k * 0.10, -0.165, 0.95),
            (x + k * 0.09, -0.115, 0.72),
            (x + k * 0.05, -0.045, 0.56),
        ]
        path = spline(belt, 40)
        strap = np.stack([path - (0.022, 0, 0), path + (0.022, 0, 0)])
        grid(f"belt {side} {k}", strap, "panel dark")
        post = frame_matrix((x + k * 0.07, -0.255, 1.10), (1, 0, 0), (0, 1, 0))
        kit.lathe([(0.007, -0.05), (0.007, 0.06)], post, "steel", 12)
    kit.lathe(
        [(0.09, 0), (0.07, 0.05), (0.055, 0.10), (0.055, 0.35)],
        frame_matrix((x, 0.12, 0), (1, 0, 0), (0, 1, 0)),
        "panel dark",
        28,
    )


def pedals(kit, side):
    for k in (-1, 1):
        x = side * -EYE[0] + k * 0.125
        at = frame_matrix((x, 0.86, 0.22), (1, 0, 0), (0, 0.45, 1))
        kit.box((0.095, 0.17, 0.014), at, "panel dark", 0.004)
        for row in range(6):
            kit.box((0.085, 0.006, 0.004), shifted(at, 0, -0.062 + 0.025 * row, 0.009), "seal")
        kit.box(
            (0.03, 0.03, 0.30),
            frame_matrix((x, 0.90, 0.12), (1, 0, 0), (0, 1, 0)),
            "panel dark",
            0.004,
        )
    kit.box(
        (0.52, 0.02, 0.55),
        frame_matrix((side * -EYE[0], 1.0, 0.30), (1, 0, 0), (0, 1, 0)),
        "panel dark",
        0.004,
    )


SYSTEMS = (
    "ADIRS",
    "HYD",
    "FUEL",
    "ELEC",
    "AIR COND",
    "ANTI ICE",
    "CABIN PRESS",
    "EXT LT",
    "APU",
    "OXYGEN",
    "FIRE",
    "CALLS",
    "RAIN RPLNT",
    "SIGNS",
    "INT LT",
)


def overhead(kit):
    """Three columns of system panels; the lower edge hangs over the windscreens."""
    plane = frame_matrix((0, 0.115, 1.655), (1, 0, 0), (0, -1, 0.155))
    kit.box((0.640, 0.78, 0.05), shifted(plane, z=-0.028), "panel dark", 0.010)
    name = 0
    for row in range(5):
        for column in range(3):
            at = shifted(plane, (column - 1) * 0.208, -0.295 + 0.148 * row)
            kit.panel((0.203, 0.143), at, "panel", 0.004, 0.004)
            face = shifted(at, z=0.004)
            kit.screws(face, (0.203, 0.143), 0.0075, 0.003)
            kit.text(SYSTEMS[name], shifted(face, 0, 0.062), 0.0060)
            kit.line([(-0.092, 0.052), (0.092, 0.052)], face, 0.0010, "legend dim")
            system(kit, face, name)
            name += 1


def system(kit, face, kind):
    """Buttons joined by a flow line, or switches and knobs, by turns."""
    if kind % 3 == 0:
        for i in range(8):
            at = shifted(face, -0.072 + 0.048 * (i % 4), 0.022 - 0.052 * (i // 4))
            kit.button(at, (0.021, 0.021), "key", 0.005)
            kit.text(("GEN 1", "PUMP", "BLEED", "PACK")[i % 4], shifted(at, 0, 0.0165), 0.0038)
            kit.text(
                "AUTO" if i % 3 else "OFF",
                shifted(at, 0, -0.004, 0.0052),
                0.0040,
                "lit white" if i in (2,) and kind == 3 else "legend dim",
            )
        kit.line([(-0.072, -0.006), (0.072, -0.006)], face, 0.0014, "legend dim")
    elif kind % 3 == 1:
        for i in range(3):
            at = shifted(face, -0.058 + 0.058 * i, 0.012)
            kit.knob(shifted(at, turn_deg=40 - 40 * i), 0.013, 0.018)
            kit.text(("COCKPIT", "FWD", "AFT")[i], shifted(at, 0, 0.026), 0.0040)
        for i in range(4):
            at = shifted(face, -0.066 + 0.044 * i, -0.042)
            kit.button(at, (0.019, 0.019), "key", 0.005)
            kit.text(
                "ON",
                shifted(at, 0, -0.003, 0.0052),
                0.0044,
                "lit green" if i == 1 else "legend dim",
            )
    else:
        for i in range(5):
            at = shifted(face, -0.072 + 0.036 * i, 0.014)
            kit.toggle(at, 18 if i % 2 else -18)
            kit.text(
                ("STROBE", "BEACON", "WING", "NAV", "LAND")[i], shifted(at, 0, 0.024), 0.0036
            )
            kit.text("OFF", shifted(at, 0, -0.021), 0.0032)
        for i in range(3):
            kit.knob(shifted(face, -0.058 + 0.058 * i, -0.043, 0, 30 * i), 0.0085, 0.013)


def build_cabin():
    kit = Kit("cabin")
    for side in (-1, 1):
        top = ledge(kit, side)
        side_stick(kit, top, side)
        console_details(kit, side)
        seat(kit, side)
        pedals(kit, side)
    overhead(kit)
    kit.build()
