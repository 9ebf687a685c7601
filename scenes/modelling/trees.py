# SPDX-License-Identifier: Apache-2.0
"""The street's trees: trunks that fork, and crowns of leafy twigs with gaps between them.

A twig is a mesh of a few hundred leaves. A near tree carries copies of twigs, one on each end
of its branches; trees further off are one mesh of larger and fewer leaves.
"""
import math
import random

import bpy
import numpy as np
from mathutils import Matrix

from shapes import grid, joined, mesh, named_material, spline, tube_points

TREE_HEIGHT = 7.4  # m, of the originals


def rotated(vectors, axis, angle):
    """Rodrigues: vectors (n, 3) turned about unit axes (n, 3)."""
    c, s = np.cos(angle)[:, None], np.sin(angle)[:, None]
    along = (axis * vectors).sum(1)[:, None]
    return vectors * c + np.cross(axis, vectors) * s + axis * along * (1 - c)


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


class Branches:
    """Grows a trunk and its branches; keeps what they end in. A twig hides a branch's end."""

    def __init__(self, seed, height):
        self.rng = np.random.default_rng(seed)
        self.height = height
        self.tubes, self.ends = [], []

    def grow(self, foot, direction, length, radius, depth):
        """A branch that bends towards the light, and those that leave it."""
        rng = self.rng
        bend = np.array([*rng.normal(0, 0.16, 2), 0.10 + 0.10 * rng.random()])
        middle = foot + 0.5 * length * unit(direction + 0.4 * bend)
        tip = foot + length * unit(direction + bend)
        sides = (9, 7, 5, 3)[depth]
        self.tubes.append((spline([foot, middle, tip], (7, 6, 4, 3)[depth]), radius, sides))
        if depth == 3:
            self.ends.append((tip, unit(tip - middle)))
            return
        if depth == 2:
            self.ends.append((middle, unit(middle - foot)))
        for k in range((7, 5, 4)[depth]):
            t = (0.42 + 0.58 * (k + rng.random()) / 7) if depth == 0 else 0.35 + 0.65 * (
                (k + 0.8 * rng.random()) / (5, 4)[depth - 1]
            )
            start = (1 - t) ** 2 * foot + 2 * t * (1 - t) * middle + t * t * tip
            turn = 2.4 * k + rng.normal(0, 0.35)
            out = self.outward(direction, turn)
            lean = (0.95, 0.80, 0.75)[depth] * (1.15 - 0.5 * t) + rng.normal(0, 0.10)
            way = unit(direction * math.cos(lean) + out * math.sin(lean))
            share = (0.50, 0.60, 0.60)[depth] * (1.12 - 0.35 * t) * rng.uniform(0.8, 1.15)
            self.grow(start, way, length * share, radius * (0.42, 0.5, 0.55)[depth], depth + 1)

    def outward(self, direction, turn):
        side = unit(np.cross(direction, (0.31, 0.95, 0.02)))
        lift = np.cross(side, direction)
        return math.cos(turn) * side + math.sin(turn) * lift

    def wood(self, name, thinnest):
        parts = []
        for path, radius, sides in self.tubes:
            if radius >= thinnest:
                rs = np.linspace(radius, 0.55 * radius, len(path))
                if sides == 9:
                    rs[0] *= 1.5  # the root's flare
                up = (0.93, 0.21, 0.30)
                rings = tube_points(path, rs, sides, up=up)
                parts.append(grid("branch", rings, "bark", closed=True, flip=True))
        return joined(name, parts)


def leaf_mesh(name, places, facing, size, kinds, rng):
    """Folded rhombic leaves, two triangles each, of several materials by their shares."""
    n = len(places)
    ahead = unit(rng.normal(0, 1, (n, 3)) - (0, 0, 0.5))
    ahead = unit(ahead - facing * (ahead * facing).sum(1)[:, None])
    side = np.cross(facing, ahead)
    length = size * rng.uniform(0.7, 1.25, (n, 1))
    fold = 0.12 * length * facing
    corners = [
        places - 0.5 * length * ahead,
        places + 0.34 * length * side + fold,
        places + 0.5 * length * ahead - 0.4 * fold,
        places - 0.34 * length * side + fold,
    ]
    vertices = np.stack(corners, axis=1).reshape(-1, 3)
    faces = np.arange(4 * n).reshape(-1, 4)
    item = mesh(name, vertices, faces, kinds[0])
    for kind in kinds[1:]:
        item.data.materials.append(named_material(kind))
    shares = np.array((0.45, 0.30, 0.25)[: len(kinds)])
    chosen = rng.choice(len(kinds), n, p=shares / shares.sum())
    item.data.polygons.foreach_set("material_index", chosen)
    return item


KINDS = ("leaf", "leaf light", "leaf dark")


def twig(name, seed, count, size, reach):
    """Leaves around a twig that grows along +z from the origin."""
    rng = np.random.default_rng(seed)
    t = rng.random(count) ** 0.7
    spread = reach * 0.62 * np.sqrt(1.02 - (t - 0.35) ** 2 * 1.4)
    way = unit(rng.normal(0, 1, (count, 3)))
    places = np.column_stack([np.zeros(count), np.zeros(count), 1.1 * reach * (t - 0.25)])
    places += way * (spread * rng.random(count) ** 0.45)[:, None]
    facing = unit(0.7 * way + rng.normal(0, 0.5, (count, 3)) + (0, 0, 0.55))
    return leaf_mesh(name, places, facing, size, KINDS, rng)


def towards(place, direction, turn, scale):
    """Takes +z to a direction at a place."""
    z = np.asarray(direction)
    x = unit(np.cross((0.3, 0.9, 0.1), z))
    m = Matrix(np.column_stack([x, np.cross(z, x), z]).tolist()).to_4x4()
    return (
        Matrix.Translation(place) @ m @ Matrix.Rotation(turn, 4, "Z") @ Matrix.Scale(scale, 4)
    )


def crown_mesh(name, ends, leaves_each, size, reach, seed):
    """All leaves of a tree as one mesh, for trees further off."""
    rng = np.random.default_rng(seed)
    count = leaves_each * len(ends)
    tips = np.repeat(np.array([e for e, _ in ends]), leaves_each, axis=0)
    way = unit(rng.normal(0, 1, (count, 3)))
    places = tips + way * (reach * rng.random(count) ** 0.5)[:, None]
    facing = unit(0.7 * way + rng.normal(0, 0.5, (count, 3)) + (0, 0, 0.55))
    return leaf_mesh(name, places, facing, size, KINDS, rng)


def thinned(ends, keep, seed):
    """Some of the ends, so that copies of one twig fill the crown."""
    rng = np.random.default_rng(seed)
    chosen = rng.choice(len(ends), min(keep, len(ends)), replace=False)
    return [ends[i] for i in sorted(chosen)]


def grown(seed):
    tree = Branches(seed, TREE_HEIGHT)
    tree.grow(np.zeros(3), np.array([0.0, 0.0, 1.0]), 0.74 * TREE_HEIGHT, 0.165, 0)
    return tree


# Kind: (seeds of its trees, thinnest branch, ends kept, leaves an end, their size, reach), m.
TREES = {
    "near": ((4, 9, 15), 0.014, 80, 190, 0.15, 0.78),
    "middle": ((4, 21), 0.022, 150, 16, 0.31, 0.66),
    "far": ((9, 21), 0.08, 130, 5, 0.70, 0.75),
}


def originals(label):
    """The trees of one kind about the origin: (objects, twigs' matrices) each."""
    seeds, thinnest, keep, each, size, reach = TREES[label]
    out = []
    for seed in seeds:
        tree = grown(seed)
        ends = thinned(tree.ends, keep, seed)
        wood = tree.wood(f"trunk {label}", thinnest)
        if label == "near":
            rng = random.Random(seed)
            places = [
                towards(e, d, rng.uniform(0, 6.28), rng.uniform(0.75, 1.2)) for e, d in ends
            ]
            out.append(([wood], places))
        else:
            crown = crown_mesh(f"leaves {label}", ends, each, size, reach, seed)
            out.append(([wood, crown], []))
    return out


def planted(tree, twigs, i, at):
    """A copy of a tree, its twigs copies of theirs."""
    parts, places = tree
    todo = [(part, f"{part.name.split('.')[0]} {i}", Matrix()) for part in parts]
    todo += [(twigs[k % len(twigs)], f"leaves near {i}.{k}", m) for k, m in enumerate(places)]
    for part, name, matrix in todo:
        copy = bpy.data.objects.new(name, part.data)
        copy.matrix_world = at @ matrix
        bpy.context.scene.collection.objects.link(copy)


def woods():
    """Trees in rows and groups beyond the houses, far enough to leave the low sun free."""
    rng = random.Random(23)
    spots = [(x, -112.0 + rng.uniform(-4, 4)) for x in np.arange(-46, -10, 14.0)]
    spots += [(-78 + rng.uniform(-5, 5), y) for y in np.arange(-90, 130, 22.0)]
    spots += [(rng.uniform(-120, -84), rng.uniform(-40, 150)) for _ in range(7)]
    spots += [(rng.uniform(-16, 16), rng.uniform(560, 590)) for _ in range(8)]
    return spots


def trees():
    rng = random.Random(11)
    kinds = {label: originals(label) for label in TREES}
    _, _, _, each, size, reach = TREES["near"]
    twigs = [twig(f"twig {k}", 31 + k, each, size, reach) for k in range(2)]
    spots = [(4.4, y) for y in np.arange(-37, 175, 18)]
    spots += [(-7.9, y) for y in np.arange(11, 175, 18)]
    spots += [(-20, -26), (-31, -12), (-27, -44), (-38, 6), (-24, 14), (-42, -30)]
    spots += woods()
    for i, (x, y) in enumerate(spots):
        ahead = y > -10 and abs(x) < 10
        label = "near" if ahead and y < 40 else "middle" if ahead and y < 80 else "far"
        where = x + rng.uniform(-0.2, 0.2), y + rng.uniform(-1.5, 1.5), 0
        at = (
            Matrix.Translation(where)
            @ Matrix.Rotation(rng.uniform(0, 2 * math.pi), 4, "Z")
            @ Matrix.Scale(rng.uniform(0.86, 1.16), 4)
        )
        choice = kinds[label]
        planted(choice[i % len(choice)], twigs, i, at)
    for parts, _ in [tree for some in kinds.values() for tree in some]:
        for part in parts:
            bpy.data.objects.remove(part)
    for part in twigs:
        bpy.data.objects.remove(part)
