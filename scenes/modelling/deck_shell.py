# SPDX-License-Identifier: Apache-2.0
"""The flight deck's shell: windscreens in their posts, lining, ceiling, floor and the nose.

Each half has three flat window facets between a sill line and a top line whose stretches are
parallel, so that every facet is plane. Panes lie outside the lining by the posts' depth.
"""
import numpy as np
from mathutils import Vector
from mathutils.geometry import tessellate_polygon

from kit import Kit, shifted
from shapes import frame_matrix, grid, mesh, place, spline, tube

SILL_Z, TOP_Z = 0.900, 1.485
# (x, y, z) of the right half; the side windows reach lower, along their rear edges.
SILL = [
    (0.0, 1.2454, SILL_Z),
    (0.8208, 0.9684, SILL_Z),
    (1.0969, 0.3097, 0.796),
    (1.139, -0.827, 0.796),
]
TOP = [(0.0, 0.7625), (0.60, 0.56), (0.807, -0.079), (0.84, -0.97)]
DEEP = 0.050  # m from the lining to the pane
# margins of the windows in their facets: sill, rear post, top, front post
MARGINS = (
    (0.030, 0.040, 0.046, 0.036),
    (0.034, 0.032, 0.046, 0.040),
    (0.05, 0.20, 0.06, 0.032),
)
REAR = -0.86  # y of the rear wall


def windscreen_foot(x):
    """(y, z) of the windscreens' sill at x."""
    return 1.2454 - 0.3375 * min(abs(x), 0.8208) + 0.006, SILL_Z + 0.004


def facet(i, side):
    """The four corners of a facet, counter-clockwise from inside: sill near the front first."""
    a, b = SILL[i], SILL[i + 1]
    c, d = TOP[i + 1], TOP[i]
    corners = [
        (side * a[0], a[1], a[2]),
        (side * b[0], b[1], b[2]),
        (side * c[0], c[1], TOP_Z),
        (side * d[0], d[1], TOP_Z),
    ]
    return np.array(corners)


def facet_plane(corners, side):
    """Local x along the sill, z into the cabin."""
    along = corners[1] - corners[0] if side > 0 else corners[0] - corners[1]
    origin = corners[0] if side > 0 else corners[1]
    return frame_matrix(origin, along, corners[3] - corners[0])


def inset(polygon, margins):
    """A convex polygon (n, 2), counter-clockwise, each edge moved inward by its margin."""
    p = np.asarray(polygon, float)
    n = len(p)
    lines = []
    for k in range(n):
        a, b = p[k], p[(k + 1) % n]
        t = (b - a) / np.linalg.norm(b - a)
        inward = np.array([-t[1], t[0]])
        lines.append((a + inward * margins[k], t))
    out = []
    for k in range(n):
        (a, t), (b, s) = lines[k - 1], lines[k]
        m = np.column_stack([t, -s])
        out.append(a + t * np.linalg.solve(m, b - a)[0])
    return np.array(out)


def rounded(polygon, radius, steps=7):
    """A convex polygon with its corners rounded."""
    p = np.asarray(polygon, float)
    out = []
    for k in range(len(p)):
        before, here, after = p[k - 1], p[k], p[(k + 1) % len(p)]
        u = (before - here) / np.linalg.norm(before - here)
        v = (after - here) / np.linalg.norm(after - here)
        half = 0.5 * np.arccos(np.clip(u @ v, -1, 1))
        reach = radius / np.tan(half)
        bisector = (u + v) / np.linalg.norm(u + v)
        centre = here + bisector * radius / np.sin(half)
        a, b = here + u * reach - centre, here + v * reach - centre
        for t in np.linspace(0, 1, steps):
            spot = a * (1 - t) + b * t
            out.append(centre + spot / np.linalg.norm(spot) * radius)
    return np.array(out)


def window_facet(kit, i, side):
    corners = facet(i, side)
    plane = facet_plane(corners, side)
    inverse = np.array(plane.inverted())
    flat = (corners @ inverse[:3, :3].T + inverse[:3, 3])[:, :2]
    margins = MARGINS[i]
    if side < 0:
        flat = flat[[1, 0, 3, 2]]
        margins = (margins[0], margins[3], margins[2], margins[1])
    hole = rounded(inset(flat, margins), 0.055, 9)
    lining_with_hole(f"window lining {i} {side}", flat, hole, plane)
    reveal(hole, plane, f"{i} {side}")
    trim(kit, hole, plane)
    pane(kit, hole, plane, f"{i} {side}")


def lining_with_hole(name, outer, hole, plane):
    loops = [[Vector((*p, 0)) for p in outer], [Vector((*p, 0)) for p in hole]]
    triangles = tessellate_polygon(loops)
    points = np.vstack([outer, hole])
    vertices = place(np.column_stack([points, np.zeros(len(points))]), plane)
    mesh(name, vertices, triangles, "lining")


def reveal(hole, plane, label):
    """The posts' depth: from the lining's edge, slightly tapering, to the pane."""
    middle = hole.mean(0)
    rings = []
    for z, grow in ((0.0, 1.0), (-0.004, 0.994), (-DEEP, 0.985)):
        points = middle + (hole - middle) * grow
        rings.append(np.column_stack([points, np.full(len(hole), z)]))
    grid(f"window reveal {label}", place(rings, plane), "lining grey", closed=True, flip=True)


def trim(kit, hole, plane):
    """A screwed retainer round the opening, and the black seal round the pane."""
    kit.ring(
        hole,
        [
            (0.0, -0.002),
            (0.026, -0.002),
            (0.026, 0.0020),
            (0.0245, 0.0034),
            (0.0035, 0.0034),
            (0.0008, 0.0020),
        ],
        plane,
        "lining grey",
    )
    seal = hole.mean(0) + (hole - hole.mean(0)) * 0.985
    kit.ring(
        seal,
        [
            (0.004, -DEEP),
            (-0.016, -DEEP + 0.0015),
            (-0.015, -DEEP + 0.007),
            (-0.010, -DEEP + 0.011),
            (0.004, -DEEP + 0.013),
        ],
        plane,
        "seal",
    )
    around = np.vstack([hole, hole[:1]])
    arc = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(around, axis=0), axis=1))])
    count = int(arc[-1] / 0.075)
    for s in np.arange(count) * arc[-1] / count:
        x, y = np.interp(s, arc, around[:, 0]), np.interp(s, arc, around[:, 1])
        away = np.array([x, y]) - hole.mean(0)
        k = int(np.searchsorted(arc, s + 1e-6)) - 1
        t = around[k + 1] - around[k]
        t /= np.linalg.norm(t)
        normal = np.array([t[1], -t[0]])
        normal *= 1.0 if normal @ away > 0 else -1.0
        spot = (x + 0.0145 * normal[0], y + 0.0145 * normal[1])
        kit.screw(shifted(plane, *spot, 0.0034), 0.0030)


def pane(kit, hole, plane, label):
    """One sheet; its front is outside."""
    points = hole.mean(0) + (hole - hole.mean(0)) * 0.985
    flat = place(np.column_stack([points, np.full(len(points), -DEEP - 0.0005)]), plane)
    mesh(f"pane {label}", flat, [list(range(len(points)))[::-1]], "cockpit glass")


def post(name, i, side, radius, material, squash):
    """A padded cover along the crease between two facets."""
    a = np.array([side * SILL[i][0], SILL[i][1], SILL[i][2] - 0.02])
    b = np.array([side * TOP[i][0], TOP[i][1], TOP_Z + 0.02])
    path = [a + (b - a) * t for t in np.linspace(0, 1, 12)]
    inward = Vector((-side if i else 0.0, -0.8, 0.0))
    tube(name, path, radius, material, 20, squash=squash, up=inward)


def strip(name, lines, material, flip=False, steps=1):
    """A surface through several lines of equal point counts."""
    rows = np.asarray(lines, float)
    if steps > 1:
        rows = np.stack([spline(rows[:, k], steps) for k in range(rows.shape[1])], axis=1)
    return grid(name, rows, material, flip=flip)


def half_line(points, z, side):
    return [(side * x, y, z) for x, y in points]


def roof(side):
    """From the windows' top line over the brow to the middle of the ceiling."""
    top = half_line(TOP, TOP_Z, side)
    brow = [(side * x * 0.97, y - 0.035, TOP_Z + 0.05) for x, y in TOP]
    high = [
        (0, 0.56, 1.66),
        (side * 0.44, 0.42, 1.67),
        (side * 0.62, -0.12, 1.72),
        (side * 0.64, -0.97, 1.72),
    ]
    middle = [(0, y, z + 0.03) for x, y, z in high]
    strip(f"brow {side}", [top, brow, high], "lining", side > 0, 10)
    strip(f"ceiling {side}", [high, middle], "lining", side > 0)


def walls(side):
    """Below the sill: to the floor; and the rear wall that closes the cabin."""
    sill = [(side * x, y, z) for x, y, z in SILL]
    floor = [(side * x * 0.86, y, 0.0) for x, y, _ in SILL]
    strip(f"side wall {side}", [sill, floor], "lining grey", side < 0)
    rear = [
        (0, REAR, 0.0),
        (side * 1.16, REAR, 0.0),
        (side * 1.16, REAR, 0.796),
        (side * 0.84, REAR, 1.485),
        (side * 0.64, REAR, 1.76),
        (0, REAR, 1.76),
    ]
    mesh(f"rear wall {side}", rear, [list(range(6))], "lining grey")


def floor():
    mesh(
        "floor",
        [(-1.1, REAR, 0.0), (1.1, REAR, 0.0), (1.1, 1.25, 0.0), (-1.1, 1.25, 0.0)],
        [(0, 1, 2, 3)],
        "deck carpet",
    )


def nose():
    """The skin in front of the windscreens, falling away to the radome."""
    rows = []
    for t in np.linspace(0, 1, 24):
        y_middle, z = 1.320 + 1.75 * t, 0.932 - 0.030 * t - 0.40 * t**2.6
        half = 0.98 * (1 - 0.62 * t**1.7)
        row = []
        for u in np.linspace(-1, 1, 41):
            x = half * u
            sweep = (0.3375 * min(abs(x), 0.80) + 1.3 * max(abs(x) - 0.80, 0)) * (1 - t)
            row.append(
                (x, y_middle - sweep - 0.22 * t * u * u, z - 0.30 * abs(u) ** 3.0 * (0.12 + t))
            )
        rows.append(row)
    grid("nose", np.array(rows), "skin")
    rim = np.array(rows[0])
    tube("windscreen foot seal", rim + (0, -0.012, 0.004), 0.012, "seal", 10)
    panel_line = np.array(rows[9]) + (0, 0, 0.0005)
    tube("radome joint", panel_line, 0.0016, "gap", 6)


def wipers(kit):
    """Parked along the foot of the front panes."""
    for side in (-1, 1):
        base = np.array([side * 0.10, 1.307, 0.930])
        tip = np.array([side * 0.64, 1.078, 0.972])
        tube(
            f"wiper arm {side}",
            [base, 0.5 * (base + tip) + (0, 0.01, 0.016), tip],
            0.0075,
            "skin dark",
            8,
        )
        blade = [tip + (side * 0.02, 0.0, 0.09), tip, tip + (-side * 0.16, 0.06, -0.046)]
        tube(f"wiper blade {side}", spline(blade, 10), 0.005, "skin dark", 8)
        at = frame_matrix(base - (0, 0.01, 0.06), (1, 0, 0), (0, 1, 0))
        kit.lathe([(0.020, 0), (0.020, 0.05), (0.012, 0.062)], at, "skin dark", 16)


def compass(kit):
    """The magnetic compass that hangs at the centre post."""
    share = 0.70
    y = SILL[0][1] + share * (TOP[0][1] - SILL[0][1])
    z = SILL_Z + share * (TOP_Z - SILL_Z)
    at = frame_matrix((0, y - 0.055, z), (1, 0, 0), (0, 0, 1))
    kit.box((0.016, 0.030, 0.060), shifted(at, 0, 0.006, -0.035), "bezel", 0.003)
    kit.box((0.070, 0.066, 0.054), at, "stick", 0.010)
    face = shifted(at, z=0.0275)
    kit.panel((0.056, 0.038), shifted(face, 0, 0.004), "compass face", 0.0006, 0.006, 0.0002)
    band = shifted(face, 0, 0.004, 0.0008)
    for k in range(-8, 9):
        x = 0.0062 * k / 2
        tall = 0.0075 if k % 2 == 0 else 0.0045
        kit.line([(x, -0.004), (x, -0.004 + tall)], band, 0.0007)
    for k, name in enumerate(("21", "24", "27", "30", "33")):
        kit.text(name, shifted(band, -0.0224 + 0.0112 * k, 0.009), 0.0048)
    kit.line([(0, -0.013), (0, 0.014)], shifted(band, z=0.0006), 0.0009, "guard red")
    kit.text("STEER BY", shifted(face, 0, -0.0215, 0.0002), 0.0030)
    card = frame_matrix((0, y - 0.010, z - 0.075), (1, 0, 0), (0, 0.5, 1))
    kit.panel((0.062, 0.036), shifted(card, z=0.020), "key light", 0.0012, 0.002)


def visors(kit):
    """Tinted sun visors on a rail above each front pane; the captain's slid to his left."""
    for side in (-1, 1):
        a = np.array([side * 0.05, TOP[0][1] - 0.065, TOP_Z - 0.012])
        b = np.array([side * 0.58, TOP[1][1] - 0.045, TOP_Z - 0.012])
        tube(f"visor rail {side}", [a, 0.5 * (a + b), b], 0.0055, "steel", 10)
        at_share = 0.74 if side < 0 else 0.70
        middle = a + (b - a) * at_share
        along = (b - a) if side > 0 else (a - b)
        at = frame_matrix(middle + (0, -0.012, -0.042), along, (0, 0.30, 1))
        kit.box((0.245, 0.100, 0.0045), at, "visor", 0.002)
        for k in (-1, 1):
            kit.box((0.018, 0.030, 0.014), shifted(at, k * 0.07, 0.045, 0), "bezel", 0.003)


def assist_handles():
    """A handle on each front side post."""
    for side in (-1, 1):
        a = np.array([side * SILL[1][0], SILL[1][1], SILL_Z])
        b = np.array([side * TOP[1][0], TOP[1][1], TOP_Z])
        inward = np.array([-side * 0.60, -0.72, 0.10])
        path = [
            a + (b - a) * 0.50 + inward * 0.015,
            a + (b - a) * 0.52 + inward * 0.052,
            a + (b - a) * 0.60 + inward * 0.060,
            a + (b - a) * 0.72 + inward * 0.060,
            a + (b - a) * 0.80 + inward * 0.052,
            a + (b - a) * 0.82 + inward * 0.015,
        ]
        tube(f"assist handle {side}", spline(path, 28), 0.0085, "stick", 12)


def build_shell():
    kit = Kit("shell")
    for side in (-1, 1):
        for i in range(3):
            window_facet(kit, i, side)
        post(f"side post {side}", 1, side, 0.034, "lining grey", 0.55)
        post(f"rear post {side}", 2, side, 0.030, "lining grey", 0.55)
        roof(side)
        walls(side)
    post("centre post", 0, 1, 0.030, "lining grey", 0.6)
    floor()
    nose()
    wipers(kit)
    compass(kit)
    visors(kit)
    assist_handles()
    kit.build()
