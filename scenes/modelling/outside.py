# SPDX-License-Identifier: Apache-2.0
"""The street in front of the car: road, kerbs, houses, trees, lamps, traffic, hills.

The car stands in its own lane (x -1.75 .. 1.75); the street runs along y."""
import math
import random

import bmesh
import bpy
import numpy as np
from mathutils import Matrix, Vector
from mathutils import noise as perlin

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

LEFT_KERB, RIGHT_KERB = -5.60, 2.15
NEAR, FAR = -120.0, 760.0

# Lamp heads (x, y, z) of the street lamps; the night scene puts lights there.
LAMPS = [(1.2, 9.0 + 27.0 * i, 7.3) for i in range(-2, 9)] + [
    (-4.7, 22.5 + 27.0 * i, 7.3) for i in range(-2, 9)
]


def level(x, y):
    return frame_matrix((x, y, 0), (1, 0, 0), (0, 1, 0))


def flat(name, x0, x1, y0, y1, z, material):
    return mesh(
        name, [(x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z)], [(0, 1, 2, 3)], material
    )


def road():
    flat("grass", -700, 700, -300, 900, -0.03, "grass")
    flat("road", LEFT_KERB, RIGHT_KERB, NEAR, FAR, 0.0, "asphalt")
    for name, x0, x1 in (("right", RIGHT_KERB + 0.14, 5.4), ("left", -9.0, LEFT_KERB - 0.14)):
        flat(f"pavement {name}", x0, x1, NEAR, FAR, 0.115, "paving")
    for name, x in (("right", RIGHT_KERB + 0.07), ("left", LEFT_KERB - 0.07)):
        at = frame_matrix((x, 0.5 * (NEAR + FAR), 0.02), (1, 0, 0), (0, 1, 0))
        box(f"kerb {name}", (0.14, FAR - NEAR, 0.20), at, "kerb", 0.02, 2)
    dashes = [
        flat("dash", -1.815, -1.685, y, y + 3.0, 0.004, "road marking")
        for y in np.arange(-30, 420, 9.0)
    ]
    dashes += [
        flat("edge", x - 0.06, x + 0.06, NEAR, FAR, 0.004, "road marking")
        for x in (1.72, -5.17)
    ]
    joined("lane markings", dashes)
    stripes = [
        flat("stripe", x, x + 0.5, 46.0, 49.5, 0.005, "road marking")
        for x in np.arange(-5.1, 1.8, 1.0)
    ]
    joined("zebra crossing", stripes)


def house(i, x, y, width, depth, floors, facade, flat_roof):
    height = 3.0 * floors + 0.6
    at = frame_matrix((x, y, height / 2), (1, 0, 0), (0, 1, 0))
    body = box(f"house {i}", (width, depth, height), at, facade, 0.0)
    if flat_roof:
        top = frame_matrix((x, y, height + 0.15), (1, 0, 0), (0, 1, 0))
        box(f"house roof {i}", (width + 0.5, depth + 0.5, 0.5), top, "roof grey", 0.04)
        return body
    w, d, z, rise, o = width / 2 + 0.4, depth / 2 + 0.4, height, 0.42 * width, 0.12
    corners = [
        (x - w, y - d, z),
        (x + w, y - d, z),
        (x + w, y + d, z),
        (x - w, y + d, z),
        (x, y - d + o, z + rise),
        (x, y + d - o, z + rise),
    ]
    mesh(
        f"house roof {i}",
        corners,
        [(0, 4, 5, 3), (1, 2, 5, 4), (0, 1, 4), (2, 3, 5), (0, 3, 2, 1)],
        "roof tile",
    )
    chimney = frame_matrix((x + 0.2 * width, y, z + rise * 0.7), (1, 0, 0), (0, 1, 0))
    box(f"chimney {i}", (0.7, 0.9, 2.6), chimney, "facade brick", 0.03)
    return body


HOUSES = []


def houses():
    rng = random.Random(5)
    facades = ("facade plaster", "facade brick", "facade office")
    i = 0
    for side, setback in ((1, 10.5), (-1, 14.0)):
        y = -34.0
        while y < 330:
            depth = rng.uniform(12, 22)
            width = rng.uniform(10, 14)
            floors = rng.choice((2, 3, 3, 4, 5))
            open_square = side < 0 and y + depth < 30  # lets the low sun onto the car
            if rng.random() < 0.80 and not open_square:
                x = side * (setback + width / 2 + rng.uniform(0, 3.0))
                kind = facades[2] if floors >= 5 else rng.choice(facades[:2])
                house(i, x, y + depth / 2, width, depth, floors, kind, floors >= 4)
                HOUSES.append((x - side * width / 2, y, depth, floors, side))
                i += 1
            y += depth + rng.choice((0.4, 3.0, 7.0))
    for k in range(6):
        floors = (2, 3, 2, 4, 3, 2)[k]
        house(
            i + k, -56.0 - 2 * (k % 2), -86.0 + 22 * k, 13, 19, floors, facades[k % 2], k == 3
        )


def crown(name, centre, radius, seed, material, subdivisions):
    """A leafy crown: a ball pushed in and out by noise."""
    ball = bmesh.new()
    bmesh.ops.create_icosphere(ball, subdivisions=subdivisions, radius=1.0)
    data = bpy.data.meshes.new(name)
    for v in ball.verts:
        n = v.co.normalized()
        bump = perlin.fractal(n * 1.7 + Vector((seed, 0, 0)), 1.0, 2.0, 4)
        fine = perlin.fractal(n * 6.0 + Vector((0, seed, 0)), 1.0, 2.0, 2)
        stretched = Vector((n.x, n.y, n.z * 1.12))
        v.co = Vector(centre) + stretched * radius * (1 + 0.30 * bump + 0.17 * fine)
    ball.to_mesh(data)
    ball.free()
    data.materials.append(named_material(material))
    data.polygons.foreach_set("use_smooth", [True] * len(data.polygons))
    item = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(item)
    return item


def leaves(name, crowns, count, size, material):
    """Sprays of leaves scattered over the crowns: small triangles turned at random."""
    rng = np.random.default_rng(sum(map(ord, name)))
    data = crowns.data
    centres = np.array([p.center for p in data.polygons])
    normals = np.array([p.normal for p in data.polygons])
    areas = np.array([p.area for p in data.polygons])
    chosen = rng.choice(len(centres), count, p=areas / areas.sum())
    middle = centres[chosen] + normals[chosen] * rng.uniform(-0.05, 0.14, (count, 1))
    middle += rng.normal(0, 1, (count, 3)) * (
        0.3 * size + 0.3 * np.sqrt(areas[chosen])[:, None]
    )
    facing = normals[chosen] + rng.normal(0, 0.55, (count, 3)) + np.array([0, 0, 0.35])
    facing /= np.linalg.norm(facing, axis=1)[:, None]
    side = np.cross(facing, rng.normal(0, 1, (count, 3)))
    side /= np.linalg.norm(side, axis=1)[:, None]
    lift = np.cross(facing, side)
    scale = size * rng.uniform(0.6, 1.3, (count, 1))
    corners = [middle - scale * side, middle + scale * (0.5 * side - 0.45 * lift)]
    corners.append(middle + scale * (0.5 * side + 0.45 * lift))
    vertices = np.stack(corners, axis=1).reshape(-1, 3)
    return mesh(name, vertices, np.arange(3 * count).reshape(-1, 3), material)


# Trees are copies of a few: (kind, subdivisions of the crowns, leaves, their size in metres).
TREES = {
    "near": ("foliage", 3, 5200, 0.165),
    "middle": ("foliage light", 3, 1700, 0.28),
    "far": ("foliage", 2, 420, 0.55),
}
TREE_HEIGHT = 6.6  # m, of the originals


def original_tree(label):
    """Trunk, crowns and leaves of one kind of tree, standing at the origin."""
    kind, detail, count, size = TREES[label]
    radius, height = 0.26 * TREE_HEIGHT, TREE_HEIGHT
    path = spline([(0, 0, 0), (0.05, 0, 0.3 * height), (0, 0.1, 0.62 * height)], 5)
    trunk = tube(f"trunk {label}", path, np.linspace(0.17, 0.09, 5), "bark", 8, up=(0, 1, 0))
    balls = [crown("crown", (0, 0, 0.66 * height), radius, len(label) + 1.3, kind, detail)]
    for k, angle in enumerate((0.7, 2.9, 5.0)):
        offset = Vector((math.cos(angle), math.sin(angle), 0)) * radius * 0.55
        centre = Vector((0, 0, height * (0.54 + 0.11 * k))) + offset
        balls.append(crown("crown", centre, radius * 0.62, 4.1 * k + len(label), kind, detail))
    crowns = joined(f"tree {label}", balls)
    spray = leaves(f"leaves {label}", crowns, count, size, kind.replace("foliage", "leaf"))
    return trunk, crowns, spray


def planted(originals, i, x, y, rng):
    """A copy of a tree at (x, y), turned and sized at random."""
    scale, turn = rng.uniform(0.82, 1.22), rng.uniform(0, 2 * math.pi)
    for part in originals:
        copy = bpy.data.objects.new(f"{part.name} {i}", part.data)
        copy.matrix_world = (
            Matrix.Translation((x, y, 0))
            @ Matrix.Rotation(turn, 4, "Z")
            @ Matrix.Scale(scale, 4)
        )
        bpy.context.scene.collection.objects.link(copy)


def trees():
    rng = random.Random(11)
    originals = {label: original_tree(label) for label in TREES}
    spots = [(4.4, y) for y in np.arange(-37, 175, 18)]
    spots += [(-7.9, y) for y in np.arange(11, 175, 18)]
    spots += [(-20, -26), (-31, -12), (-27, -44), (-38, 6), (-24, 14), (-42, -30)]
    for i, (x, y) in enumerate(spots):
        ahead = y > 0 and abs(x) < 10
        label = "near" if ahead and y < 40 else "middle" if ahead and y < 80 else "far"
        where = x + rng.uniform(-0.2, 0.2), y + rng.uniform(-1.5, 1.5)
        planted(originals[label], i, *where, rng)
    for parts in originals.values():
        for part in parts:
            bpy.data.objects.remove(part)


def street_lamps():
    for i, (x, y, z) in enumerate(LAMPS):
        side = 1 if x > 0 else -1
        foot = 3.0 if side > 0 else -6.6
        path = spline(
            [
                (foot, y, 0.1),
                (foot, y, 4.0),
                (foot, y, 6.4),
                (foot - 0.25 * side, y, 7.1),
                (foot - 0.9 * side, y, 7.42),
                (x + 0.3 * side, y, 7.46),
            ],
            14,
        )
        tube(f"lamp post {i}", path, np.linspace(0.075, 0.035, 14), "pole", 7, up=(0, 1, 0))
        box(
            f"lamp housing {i}",
            (0.62, 0.24, 0.09),
            frame_matrix((x, y, z + 0.115), (1, 0, 0), (0, 1, 0)),
            "pole",
            0.03,
            2,
        )


def vehicle(name, x, y, heading, paint):
    """A plain saloon seen from some way off; heading 1 drives away, -1 comes towards us."""

    def at(points):
        return [(x + heading * px, y + heading * py, pz) for px, py, pz in points]

    body, cabin = [], []
    for py, w, low, high in (
        (-2.20, 0.72, 0.42, 0.86),
        (-2.15, 0.84, 0.30, 0.98),
        (-1.7, 0.90, 0.24, 1.02),
        (-0.6, 0.91, 0.24, 1.00),
        (0.7, 0.91, 0.24, 0.98),
        (1.6, 0.88, 0.24, 0.84),
        (2.10, 0.80, 0.28, 0.70),
        (2.20, 0.68, 0.38, 0.58),
    ):
        o = rounded_rectangle(2 * w, high - low, 0.16, 5)
        body.append(at([(a, py, b + (high + low) / 2) for a, b in o]))
    for py, w, low, high in (
        (-1.75, 0.62, 0.94, 1.02),
        (-1.05, 0.70, 0.94, 1.36),
        (-0.4, 0.72, 0.94, 1.44),
        (0.2, 0.70, 0.94, 1.42),
        (1.15, 0.66, 0.92, 0.98),
    ):
        o = rounded_rectangle(2 * w, high - low, min(0.14, 0.45 * (high - low)), 5)
        cabin.append(at([(a, py, b + (high + low) / 2) for a, b in o]))
    for part, rings, material in (("body", body, paint), ("windows", cabin, "dark glass")):
        rings = [np.array(r) for r in rings]
        rings = (
            [rings[0].mean(0) + (rings[0] - rings[0].mean(0)) * 0.02]
            + rings
            + [rings[-1].mean(0) + (rings[-1] - rings[-1].mean(0)) * 0.02]
        )
        smooth = np.stack(
            [spline(np.array(rings)[:, k], 24) for k in range(len(rings[0]))], axis=1
        )
        grid(f"{name} {part}", smooth, material, closed=True)
    roof = frame_matrix((x, y - 0.25 * heading, 1.425), (1, 0, 0), (0, 1, 0))
    plate(
        f"{name} roof",
        rounded_rectangle(1.16, 1.2, 0.2, 6),
        0.05,
        roof @ Matrix.Translation((0, 0, 0.035)),
        paint,
        0.02,
        3,
    )
    for k in (-1, 1):
        rear = frame_matrix(
            (x + 0.62 * k, y - 2.185 * heading, 0.80), (heading, 0, 0), (0, 0, 1)
        )
        box(f"{name} tail lamp {k}", (0.36, 0.12, 0.10), rear, "tail lamp", 0.03, 3)
        front = frame_matrix(
            (x + 0.62 * k, y + 2.10 * heading, 0.64), (heading, 0, 0), (0, 0, 1)
        )
        box(f"{name} head lamp {k}", (0.34, 0.11, 0.16), front, "bright chrome", 0.03, 3)
        for py in (-1.35, 1.35):
            wheel = frame_matrix((x + 0.78 * k, y + py, 0.33), (0, 1, 0), (0, 0, 1))
            lathe(
                f"{name} tyre",
                [
                    (0.02, -0.12),
                    (0.30, -0.12),
                    (0.33, -0.09),
                    (0.33, 0.09),
                    (0.30, 0.12),
                    (0.02, 0.12),
                ],
                wheel,
                "rubber",
                24,
            )
    plate_at = frame_matrix((x, y - 2.225 * heading, 0.62), (heading, 0, 0), (0, 0, 1))
    box(f"{name} number plate", (0.52, 0.11, 0.01), plate_at, "road marking", 0.002)


def hills():
    rng = random.Random(3)
    for name, distance, height, material, seed in (
        ("hills near", 620.0, 46.0, "hills", 1.0),
        ("hills far", 1500.0, 150.0, "hills far", 9.0),
    ):
        rows = [[], [], [], []]
        for a in np.linspace(-math.pi, math.pi, 220):
            x, y = distance * math.sin(a), distance * math.cos(a)
            spot = Vector((3.2 * math.sin(a) + seed, seed, 3.2 * math.cos(a)))
            n = 0.5 + 0.5 * perlin.fractal(spot, 1.0, 2.0, 6)
            h = height * (0.25 + n)
            for row, (k, back) in enumerate(
                ((0.0, -0.16), (0.45, -0.06), (0.86, 0.0), (1.0, 0.05))
            ):
                rows[row].append(
                    (
                        x * (1 + back),
                        y * (1 + back),
                        h * k
                        - 1.0
                        + 0.06 * height * k * rng.uniform(-0.4, 0.4) * (abs(a) < 3.1),
                    )
                )
        grid(name, np.array(rows), material)


def furniture():
    """A guard rail on the left, a direction sign, a traffic light at the crossing."""
    ys = np.linspace(60, 180, 60)
    section = [
        (-9.30, 0.52),
        (-9.22, 0.56),
        (-9.27, 0.62),
        (-9.27, 0.68),
        (-9.22, 0.74),
        (-9.30, 0.78),
    ]
    grid(
        "guard rail",
        np.array([[(x, y, z) for y in ys] for x, z in section]),
        "galvanised steel",
    )
    posts = [
        box(
            "post",
            (0.08, 0.10, 0.80),
            frame_matrix((-9.36, y, 0.40), (1, 0, 0), (0, 1, 0)),
            "galvanised steel",
            0.01,
        )
        for y in np.arange(60, 181, 4.0)
    ]
    joined("guard rail posts", posts)
    tube("sign post", [(2.9, 34, 0), (2.9, 34, 3.4)], 0.04, "pole", 8, up=(0, 1, 0))
    sign = frame_matrix((2.9, 33.94, 2.9), (1, 0, 0), (0, 0, 1))
    plate(
        "direction sign", rounded_rectangle(1.5, 0.85, 0.08, 5), 0.03, sign, "sign blue", 0.005
    )
    arrow = [
        (-0.05, -0.30),
        (0.05, -0.30),
        (0.05, 0.08),
        (0.16, 0.08),
        (0.0, 0.30),
        (-0.16, 0.08),
        (-0.05, 0.08),
    ]
    plate(
        "direction sign arrow",
        np.array(arrow) + (-0.45, 0),
        0.006,
        sign @ Matrix.Translation((0, 0, 0.007)),
        "road marking",
        0,
    )
    for k in range(2):
        bar = sign @ Matrix.Translation((0.22, 0.16 - 0.30 * k, 0.002))
        box(f"direction sign line {k}", (0.75 - 0.2 * k, 0.11, 0.01), bar, "road marking", 0)
    tube(
        "traffic light post",
        [(2.75, 45.2, 0), (2.75, 45.2, 3.5)],
        0.05,
        "pole",
        8,
        up=(0, 1, 0),
    )
    box(
        "traffic light",
        (0.26, 0.22, 0.80),
        frame_matrix((2.75, 45.05, 3.1), (1, 0, 0), (0, 1, 0)),
        "plastic dark",
        0.03,
        3,
    )


def build_outside():
    road()
    houses()
    trees()
    street_lamps()
    vehicle("car ahead", 0.05, 21.0, 1, "paint other")
    vehicle("oncoming car", -3.55, 47.0, -1, "paint red")
    vehicle("parked car", 4.0, -16.0, 1, "paint other")
    hills()
    furniture()
