# SPDX-License-Identifier: Apache-2.0
"""The body outside: bonnet, cowl, sides, boot, tyres."""

import numpy as np

from dashboard import glass_foot
from shapes import frame_matrix, grid, lathe, mesh, spline, tube
from greenhouse import SIDES


def bonnet_z(x, y):
    """Height of bonnet and wings: the wings' ridge meets the body's shoulder behind."""
    middle = np.interp(
        y,
        (1.10, 1.42, 1.80, 2.20, 2.42, 2.52, 2.56),
        (1.005, 0.985, 0.958, 0.905, 0.855, 0.800, 0.700),
    )
    ridge = np.interp(
        y,
        (1.10, 1.30, 1.80, 2.20, 2.42, 2.52, 2.56),
        (1.034, 1.030, 0.992, 0.935, 0.870, 0.800, 0.700),
    )
    a = abs(x)
    crown = -0.055 * (a / 0.75) ** 2
    wing = np.interp(a, (0.0, 0.782, 0.82, 0.865, 0.905), (0.0, 0.0, -0.014, -0.047, -0.132))
    blend = min(max((a - 0.56) / 0.20, 0.0), 1.0)
    blend = blend * blend * (3 - 2 * blend)
    return (1 - blend) * (middle + crown) + blend * (ridge + wing)


def bonnet():
    xs = np.linspace(-0.905, 0.905, 61)
    ts = np.linspace(0, 1, 30)
    rows = []
    for t in ts:
        row = []
        for x in xs:
            back = glass_foot(np.clip(x, -0.8, 0.8)) + 0.085
            front = 2.56 - 0.16 * (abs(x) / 0.9) ** 3
            y = back + (front - back) * t
            row.append((x, y, bonnet_z(x, y)))
        rows.append(row)
    last = np.array(rows[-1])
    rows.append(last + np.array([0, 0.01, -0.08]))
    rows.append(last * np.array([1, 1, 0]) + np.array([0, -0.02, 0.30]))
    lip = np.array(rows[0])  # the sheet turns down at its rear edge
    rows[:0] = [lip + (0, 0.004, -0.018), lip + (0, -0.001, -0.004)]
    grid("bonnet", np.array(rows), "car paint")
    for side, sign in SIDES:
        line = [
            (sign * 0.665, y, bonnet_z(0.665, y) + 0.0005) for y in np.linspace(1.38, 2.45, 40)
        ]
        tube(f"bonnet shut line {side}", line, 0.0022, "gap", 6)
    us = np.linspace(-0.985, 0.985, 33)

    def cowl(u, d, k, h):
        """From the glass down to below the bonnet's rear edge, which stands over it."""
        x, y = 0.735 * u, glass_foot(0.735 * u) + d
        z = 1.005 + 0.045 * u * u * k + h
        return (x, y, min(z, bonnet_z(x, y) - 0.016) if d > 0.03 else z)

    rows = ((-0.030, 1, 0.004), (0.010, 1, -0.010), (0.050, 0.6, -0.030), (0.110, 0.2, -0.050))
    grid("cowl", np.array([[cowl(u, *row) for u in us] for row in rows]), "plastic grained")


def body_sides():
    profile = [
        (0.782, 1.034),
        (0.800, 1.030),
        (0.865, 0.985),
        (0.905, 0.90),
        (0.912, 0.72),
        (0.895, 0.45),
        (0.86, 0.28),
    ]
    curve = spline(profile, 26)
    for side, sign in SIDES:
        rows = []
        for y in np.linspace(1.30, -2.10, 50):
            taper = 1.0 - 0.06 * max(0.0, (-y - 1.2) / 0.9) ** 2
            rows.append(
                np.column_stack([sign * curve[:, 0] * taper, np.full(26, y), curve[:, 1]])
            )
        grid(f"body side {side}", np.array(rows), "car paint", flip=(sign > 0))
    us = np.linspace(-1, 1, 17)
    boot = [
        [(x * u, y, z + 0.02 * (1 - u * u)) for u in us]
        for x, y, z in (
            (0.79, -1.84, 1.055),
            (0.80, -2.15, 1.02),
            (0.82, -2.30, 0.98),
            (0.82, -2.36, 0.80),
            (0.80, -2.38, 0.35),
        )
    ]
    grid("boot", np.array(boot), "car paint", flip=True)
    mesh(
        "underside",
        [(-0.88, -2.36, 0.28), (0.88, -2.36, 0.28), (0.88, 2.45, 0.28), (-0.88, 2.45, 0.28)],
        [(0, 3, 2, 1)],
        "plastic dark",
    )
    for k, (x, y) in enumerate(((-0.80, 1.72), (0.80, 1.72), (-0.80, -1.35), (0.80, -1.35))):
        at = frame_matrix((x, y, 0.335), (0, 1, 0), (0, 0, 1))
        lathe(
            f"tyre {k}",
            [
                (0.20, -0.10),
                (0.31, -0.11),
                (0.335, -0.08),
                (0.335, 0.08),
                (0.31, 0.11),
                (0.20, 0.10),
            ],
            at,
            "rubber",
            40,
        )


def hull():
    """The closed tub below the windows: floor, firewall, sides, boot wall. The firewall meets
    the bonnet from below, and the cowl where the bonnet ends before it."""
    x, y0, y1, z0, z1 = 0.80, -1.92, 1.34, 0.22, 1.04
    top = [
        (a, y1, min(1.0, bonnet_z(a, y1) - (0.030 if abs(a) < 0.46 else 0.001)))
        for a in np.linspace(x, -x, 41)
    ]
    corners = [(-x, y0, z0), (x, y0, z0), (x, y1, z0), (-x, y1, z0), (-x, y0, z1), (x, y0, z1)]
    faces = [(0, 1, 2, 3), (0, 4, 5, 1), (1, 5, 6, 2), (3, 46, 4, 0)]
    mid = len(corners) + len(top)
    low = [(a, y1, z0) for a in np.linspace(x, -x, 41)[1:-1]]
    feet = [2, *range(mid, mid + 39), 3]
    faces += [(feet[k], 6 + k, 7 + k, feet[k + 1]) for k in range(40)]
    mesh("floor and firewall", corners + top + low, faces, "carpet")


def build_body():
    hull()
    bonnet()
    body_sides()
