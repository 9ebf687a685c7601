# SPDX-License-Identifier: Apache-2.0
"""The street's ground near the car: seams and patches in the asphalt, kerb stones, covers,
lawns with tufts, hedges, fences, paths to doors, a bus stop, benches, distant woods."""
import math
import random

import bpy
import numpy as np
from mathutils import Matrix
from mathutils import noise as perlin
from mathutils import Vector

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
from trees import leaf_mesh, unit


def at_place(x, y, z=0.0, turn=0.0):
    return Matrix.Translation((x, y, z)) @ Matrix.Rotation(turn, 4, "Z")


def put(part, name, matrix):
    copy = bpy.data.objects.new(name, part.data)
    copy.matrix_world = matrix
    bpy.context.scene.collection.objects.link(copy)


def dropped(parts):
    for part in parts:
        bpy.data.objects.remove(part)


def quads(name, rectangles, z, material):
    """Flat rectangles (x0, x1, y0, y1) as one mesh."""
    corners = [
        (x, y, z) for a, b, c, d in rectangles for x, y in ((a, c), (b, c), (b, d), (a, d))
    ]
    return mesh(name, corners, np.arange(len(corners)).reshape(-1, 4), material)


def seams():
    """Poured joints that wander along and across the lanes; patches of younger asphalt."""
    rng = random.Random(41)
    patches = [(0.55, 1.5, 9.2, 11.4), (-4.6, -3.2, 15.0, 21.0), (-1.2, 0.5, 30.0, 33.0),
               (-4.9, -3.9, 5.0, 6.6), (0.4, 1.6, 40.0, 44.5), (-4.4, -2.6, 52.0, 60.0)]
    quads("asphalt patches", patches, 0.0022, "asphalt patch")
    lines = [[(-1.72 + 0.03 * math.sin(0.9 * y), y) for y in np.arange(-30, 120, 0.7)]]
    for y0 in (4.4, 12.6, 24.5, 36.0, 57.0):
        xs = np.linspace(-5.6, 2.15, 24)
        drift = [y0 + 0.25 * perlin.noise((1.3 * x, y0, 0)) for x in xs]
        lines.append(list(zip(xs, drift)))
    for x0, x1, y0, y1 in patches:
        lines.append([(x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0)])
    for _ in range(9):  # cracks
        x, y = rng.uniform(-5, 1.6), rng.uniform(3, 40)
        line = [(x, y)]
        for _ in range(12):
            x, y = x + rng.uniform(-0.12, 0.14), y + rng.uniform(0.05, 0.35)
            line.append((x, y))
        lines.append(line)
    ribbons = []
    for line in lines:
        p = np.array(line)
        way = np.gradient(p, axis=0)
        side = unit(np.column_stack([-way[:, 1], way[:, 0]])) * 0.018
        rows = [np.column_stack([p + s * side, np.full(len(p), 0.0034)]) for s in (-1, 1)]
        ribbons.append(grid("seam", np.array(rows), "tar"))
    joined("tar seams", ribbons)
    tracks = [(x - 0.28, x + 0.28, -30.0, 300.0) for x in (-0.74, 0.76, -4.2, -2.75)]
    quads("wheel tracks", tracks, 0.0012, "asphalt worn")


def covers():
    """Manhole covers in the lanes, gratings at the kerb."""
    parts = []
    for x, y in ((-0.95, 13.5), (-3.3, 9.0), (0.9, 27.0), (-3.0, 34.0), (-0.9, 52.0)):
        at = at_place(x, y, 0.002)
        parts.append(lathe("cover", [(0.36, 0.0), (0.355, 0.004), (0.33, 0.004), (0.325, 0.001),
                                     (0.30, 0.001), (0.295, 0.004), (0.002, 0.005)], at,
                           "iron", 28))
        for k in range(-3, 4):
            wide = 2 * math.sqrt(0.29**2 - (0.08 * k) ** 2)
            parts.append(box("rib", (wide, 0.03, 0.004), at @ Matrix.Translation(
                (0, 0.08 * k, 0.006)), "iron", 0))
    for x in (1.98, -5.43):
        for y in (10.0, 34.0, 58.0):
            for k in range(7):
                parts.append(box("bar", (0.30, 0.028, 0.008),
                                 at_place(x, y + 0.06 * k, 0.006), "iron", 0))
            pit = at_place(x, y + 0.18, 0.003)
            parts.append(box("pit", (0.34, 0.46, 0.002), pit, "gap", 0))
    joined("covers and gratings", parts)


def kerbs(right, left, near, far):
    """Stones of a metre with joints; a row of setts before them carries the water."""
    for name, x in (("right", right + 0.07), ("left", left - 0.07)):
        at = frame_matrix((x, 0.5 * (near + far), 0.02), (1, 0, 0), (0, 1, 0))
        box(f"kerb {name}", (0.14, far - near, 0.20), at, "kerb", 0.02, 2)
    for name, x in (("right", 5.43), ("left", -9.03)):  # the pavements' outer edges
        box(f"edging {name}", (0.06, far - near, 0.20), at_place(x, 0.5 * (near + far), 0.02),
            "kerb", 0)
    strips = []
    for foot, side in ((right, 1), (left, -1)):
        section = [(foot - 0.002 * side, 0.0), (foot - 0.002 * side, 0.115),
                   (foot + 0.012 * side, 0.1225), (foot + 0.14 * side, 0.1225)]
        for y in np.arange(-24, 90, 1.0):
            strips.append([[(x, y + d, z) for x, z in section] for d in (-0.0045, 0.0045)])
    points, faces = np.array(strips).reshape(-1, 3), []
    for base in range(0, len(points), 8):
        faces += [(base + k, base + k + 1, base + k + 5, base + k + 4) for k in range(3)]
    mesh("kerb joints", points, faces, "gap")
    gutters = [(right - 0.30, right, near, far), (left, left + 0.30, near, far)]
    quads("gutters", gutters, 0.0026, "gutter")


PATCH = 2.2  # m, a patch of tufts along its sides


def tuft_patch(name, seed):
    """Blades of grass: narrow triangles that lean at random."""
    rng = np.random.default_rng(seed)
    n = 900
    half = PATCH / 2 - 0.03
    foot = np.column_stack([rng.uniform(-half, half, (n, 2)), np.full(n, -0.03)])
    clump = 0.5 + 0.5 * np.sin(7 * foot[:, 0] + seed) * np.cos(6 * foot[:, 1] - seed)
    tall = (0.05 + 0.09 * clump * rng.random(n))[:, None]
    turn = rng.uniform(0, 2 * math.pi, n)
    wide = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(n)]) * 0.013
    lean = np.column_stack([rng.normal(0, 0.30, (n, 2)), np.ones(n)]) * tall
    tip = foot + (0, 0, 0.03) + lean
    vertices = np.stack([foot - wide, foot + wide, tip], axis=1).reshape(-1, 3)
    item = mesh(name, vertices, np.arange(3 * n).reshape(-1, 3), "grass blade")
    item.data.materials.append(named_material("grass blade dry"))
    item.data.polygons.foreach_set("material_index", (rng.random(n) < 0.22).astype(int))
    return item


def lawns(clear):
    """Tufts on the verges near the car, but for the rectangles `clear` (x0, x1, y0, y1).
    Patches lie side by side: where boxes overlap, rays have to look into both."""
    rng = random.Random(43)
    patch, i = tuft_patch("grass tufts", 51), 0
    for x0, x1, y0, y1 in ((6.3, 10.7, 1.0, 33.0), (-14.2, -9.8, 6.0, 31.0)):
        for x in np.arange(x0 + PATCH / 2, x1, PATCH):
            for y in np.arange(y0 + PATCH / 2, y1, PATCH):
                far = 0.5 * PATCH - 0.2
                taken = any(a - far < x < b + far and c - far < y < d + far
                            for a, b, c, d in clear)
                if not taken:
                    at = at_place(x, y, 0.0, rng.choice((0, 1, 2, 3)) * math.pi / 2)
                    put(patch, f"grass tufts {i}", at)
                    i += 1
    dropped([patch])


HEDGE = 1.5  # m, a piece's length along its x


def hedge_piece():
    """A clipped hedge: a dark core and leaves over its top and sides."""
    rng = np.random.default_rng(61)
    core = box("core", (HEDGE, 0.44, 0.76), at_place(0, 0, 0.38), "hedge core", 0)
    n = 480
    spot = rng.uniform(-1, 1, (n, 3)) * (HEDGE / 2, 0.27, 0.45) + (0, 0, 0.45)
    face = rng.choice(5, n, p=(0.28, 0.28, 0.28, 0.08, 0.08))
    spot[face == 0, 2] = 0.86 + rng.normal(0, 0.02, (face == 0).sum())
    for k, side in ((1, -1), (2, 1)):
        spot[face == k, 1] = side * 0.27 + rng.normal(0, 0.02, (face == k).sum())
    for k, side in ((3, -1), (4, 1)):
        spot[face == k, 0] = side * 0.78 + rng.normal(0, 0.02, (face == k).sum())
    normal = np.array([(0, 0, 1), (0, -1, 0), (0, 1, 0), (-1, 0, 0), (1, 0, 0)])[face]
    facing = unit(normal + rng.normal(0, 0.45, (n, 3)))
    leaves = leaf_mesh("leaves", spot, facing, 0.112, ("leaf", "leaf dark"), rng)
    return joined("hedge", [core, leaves])


def hedges(runs, gaps):
    """runs: (x, y0, y1) along the street; gaps: y of paths, which stay open on their side."""
    piece = hedge_piece()
    i = 0
    for x, y0, y1 in runs:
        for y in np.arange(y0 + HEDGE / 2, y1, HEDGE):
            if any((gx > 0) == (x > 0) and abs(y - gy) < 1.5 for gx, gy in gaps):
                continue
            turn = math.pi / 2 if i % 2 else -math.pi / 2
            put(piece, f"hedge {i}", at_place(x, y, 0, turn))
            i += 1
    dropped([piece])


def fence(x, ys):
    """Iron railings of 2 m a panel."""
    parts = [tube("rail", [(-1, 0, z), (1, 0, z)], 0.014, "iron", 6) for z in (0.16, 0.94)]
    parts.append(box("post", (0.05, 0.05, 1.1), at_place(-1, 0, 0.55), "iron", 0))
    parts += [
        box("rod", (0.016, 0.016, 0.98), at_place(-0.88 + 0.125 * k, 0, 0.55), "iron", 0)
        for k in range(15)
    ]
    panel = joined("fence", parts)
    for i, y in enumerate(ys):
        put(panel, f"fence {i}", at_place(x, y, 0, math.pi / 2))
    dropped([panel])


def bench(name, at):
    parts = []
    for k in range(4):
        slat = at @ Matrix.Translation((0, -0.17 + 0.115 * k, 0.45))
        parts.append(box("slat", (1.7, 0.095, 0.035), slat, "bench wood", 0))
    for k in range(3):
        slat = at @ Matrix.Translation((0, 0.25 + 0.03 * k, 0.58 + 0.12 * k))
        parts.append(box("slat", (1.7, 0.03, 0.095), slat, "bench wood", 0))
    for s in (-0.7, 0.7):
        parts.append(box("leg", (0.05, 0.42, 0.05), at @ Matrix.Translation((s, 0, 0.40)),
                         "iron", 0))
        for y in (-0.17, 0.20):
            parts.append(box("leg", (0.05, 0.05, 0.44), at @ Matrix.Translation((s, y, 0.22)),
                             "iron", 0))
        parts.append(box("back", (0.05, 0.04, 0.46), at @ Matrix.Translation((s, 0.27, 0.66)),
                         "iron", 0))
    joined(name, parts)


def bus_stop(x, y):
    """A shelter open to the road, a bench in it, the stop's flag; x is its back."""
    at = at_place(x, y, 0.115, -math.pi / 2)  # its x along the street, its -y to the road
    parts = []
    for px in (-1.9, 0.0, 1.9):
        parts.append(box("post", (0.07, 0.07, 2.4), at @ Matrix.Translation((px, 0, 1.2)),
                         "shop frame", 0))
    for s in (-1.9, 1.9):
        parts.append(box("post", (0.07, 0.07, 2.4), at @ Matrix.Translation((s, -1.2, 1.2)),
                         "shop frame", 0))
        parts.append(box("rail", (0.04, 1.2, 0.05), at @ Matrix.Translation((s, -0.6, 0.35)),
                         "shop frame", 0))
    parts.append(box("roof", (4.3, 1.8, 0.12), at @ Matrix.Translation((0, -0.7, 2.46)),
                     "shop frame", 0))
    for z in (0.35, 2.1):
        parts.append(box("rail", (3.8, 0.04, 0.05), at @ Matrix.Translation((0, 0, z)),
                         "shop frame", 0))
    parts.append(box("poster", (0.04, 1.05, 1.6), at @ Matrix.Translation((-1.9, -0.6, 1.25)),
                     "sign blue", 0))
    parts.append(box("poster", (0.05, 0.90, 0.5), at @ Matrix.Translation((-1.9, -0.6, 1.65)),
                     "curtain", 0))
    joined("bus shelter", parts)
    bench("bus shelter bench", at @ Matrix.Translation((0.2, -0.36, 0)))
    tube("bus stop post", [(x - 2.0, y - 2.6, 0.1), (x - 2.0, y - 2.6, 2.7)], 0.03, "pole", 8,
         up=(0, 1, 0))
    flag = frame_matrix((x - 2.0, y - 2.65, 2.5), (1, 0, 0), (0, 0, 1))
    plate("bus stop flag", rounded_rectangle(0.46, 0.46, 0.22, 7), 0.02, flag, "sign yellow",
          0.002)


def bins_and_bollards():
    parts = []
    for x, y in ((3.1, 23.0), (-6.4, 24.0)):
        parts.append(lathe("bin", [(0.15, 0.0), (0.17, 0.1), (0.17, 0.72), (0.19, 0.74),
                                   (0.19, 0.82), (0.13, 0.86), (0.12, 0.70)],
                           at_place(x, y, 0.115), "shop frame", 18))
    for x in (2.55, -5.95):
        for y in (42.0, 43.6, 50.5, 52.1):
            parts.append(lathe("bollard", [(0.055, 0.0), (0.055, 0.82), (0.065, 0.84),
                                           (0.065, 0.90), (0.04, 0.95), (0.002, 0.96)],
                               at_place(x, y, 0.115), "iron", 12))
    joined("bins and bollards", parts)


def hill_rows(distance, height, seed):
    """Slopes that rise to a ridge, with spurs; the outline is of the ridge alone."""
    rows = []
    for k, back in ((0.0, -0.16), (0.22, -0.11), (0.45, -0.06), (0.66, -0.03), (0.86, 0.0),
                    (0.95, 0.02), (1.0, 0.05)):
        row = []
        for a in np.linspace(-math.pi, math.pi, 261):
            x, y = distance * math.sin(a), distance * math.cos(a)
            spot = Vector((3.2 * math.sin(a) + seed, seed, 3.2 * math.cos(a)))
            n = 0.5 + 0.5 * perlin.fractal(spot, 1.0, 2.0, 6)
            spur = perlin.fractal(spot * 2.6 + Vector((0, 2.0 * k, 0)), 1.0, 2.0, 4)
            out = 1 + back + 0.035 * spur * (1 - k)
            wood = perlin.noise(spot * 90.0) if k > 0.9 else 0.0
            z = height * (0.25 + n) * k * (1 + 0.10 * spur * (1 - k)) + 0.022 * height * wood
            row.append((x * out, y * out, z - 1.0))
        rows.append(row)
    return np.array(rows)


def hills():
    grid("hills near", hill_rows(620.0, 46.0, 1.0), "hills")
    grid("hills far", hill_rows(1500.0, 150.0, 9.0), "hills far")


def paths(doors):
    """Slabs from the pavement to each door (x of the front, y); their rectangles."""
    out = []
    for x, y in doors:
        a, b = (5.46, x - 0.6) if x > 0 else (x + 0.6, -9.06)
        out.append((a, b, y - 0.75, y + 0.75))
    slabs = [
        box("path", (d - c, f - e, 0.16), at_place(0.5 * (c + d), 0.5 * (e + f), 0.03),
            "paving", 0)
        for c, d, e, f in out
    ]
    joined("paths", slabs)
    return out


BAYS = [(-12.2, -9.06, 31.5, 46.0), (5.46, 10.4, 37.6, 41.4), (5.46, 10.4, 60.2, 63.8)]


def build_ground(doors):
    """All of it; doors: (x of the front, y) of the near houses' doors."""
    seams()
    covers()
    quads("parking bays", BAYS, -0.012, "asphalt patch")
    near = [d for d in doors if -10 < d[1] < 90]
    lawns(paths(near) + BAYS)
    cars = [(side * 7, 0.5 * (y0 + y1)) for side in (1,) for _, _, y0, y1 in BAYS[1:]]
    runs = [(6.0, 11.0, 36.5), (-9.6, 6.0, 30.0), (6.0, 43.0, 59.0)]
    hedges(runs, near + cars)
    fence(-13.2, np.arange(32.0, 58.0, 2.0))
    bus_stop(5.05, 26.0)
    bench("bench", at_place(-8.6, 18.5, 0.115, math.pi / 2))
    bins_and_bollards()
