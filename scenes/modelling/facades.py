# SPDX-License-Identifier: Apache-2.0
"""Fronts of the houses near the car: walls with openings, windows in reveals, doors, shops,
cornices, gutters, balconies, gables and tiled roofs.

A wall is a skin THICK metres before the house's body; windows stand in its openings, as copies
of a few. The night scene's lit panes stand 3 cm before the body, behind the windows' bars.
Frame of a wall: x along it, y up, z outwards, the origin at its foot on the body.
"""
import math
import random

import bpy
import numpy as np
from mathutils import Matrix

from shapes import box, frame_matrix, grid, joined, mesh, named_material, place, plate, tube

THICK = 0.16  # m
FLOOR, PANE_Z = 3.0, 1.9  # a storey's height; a pane's middle above its floor
# Openings (width, height) in metres by style.
SIZES = {"plaster": (1.22, 1.62), "brick": (1.16, 1.70), "office": (2.30, 1.66)}
DOOR, SHOP = (1.44, 2.62), (2.52, 2.50)
WALLS = {
    "plaster": ("wall cream", "wall grey", "wall ochre", "wall green"),
    "brick": ("wall brick", "wall brick dark"),
    "office": ("wall grey", "wall white"),
}


def local_box(name, size, at, centre, material):
    return box(name, size, at @ Matrix.Translation(centre), material, 0.0)


def reveal(width, height, material):
    """The four sides of an opening from the body to the skin's front."""
    x, y = width / 2, height / 2
    ring = [(-x, -y), (x, -y), (x, y), (-x, y)]
    rows = [[(*p, z) for p in ring] for z in (0.0, THICK)]
    return grid("reveal", np.array(rows), material, closed=True, flip=True)


def bars(width, height, spots, thick=0.055):
    """A window's frame and its bars: spots are ('x' or 'y', place) of inner bars."""
    at, z = Matrix(), 0.065
    parts = [
        local_box("bar", (thick, height, 0.06), at, (s * (width - thick) / 2, 0, z),
                  "window frame") for s in (-1, 1)
    ]
    parts += [
        local_box("bar", (width, thick, 0.06), at, (0, s * (height - thick) / 2, z),
                  "window frame") for s in (-1, 1)
    ]
    for axis, spot in spots:
        size = (0.06, height, 0.05) if axis == "x" else (width, 0.045, 0.05)
        where = (spot, 0, z) if axis == "x" else (0, spot, z)
        parts.append(local_box("bar", size, at, where, "window frame"))
    return parts


def sheet(x0, x1, y0, y1, z, material):
    corners = [(x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z)]
    return mesh("sheet", corners, [(0, 1, 2, 3)], material)


def window(name, style, dressing):
    """One window; dressing: 0 bare, 1 curtains at the sides, 2 a blind half down."""
    w, h = SIZES[style]
    trim = "wall brick" if style == "brick" else "wall trim"
    glass = sheet(-w / 2, w / 2, -h / 2, h / 2, 0.012, "dark glass")
    parts = [reveal(w, h, "wall trim"), glass]
    inner = {
        "plaster": [("x", 0.0), ("y", 0.30)],
        "brick": [("y", 0.0), ("x", 0.0)],
        "office": [("x", -0.66), ("x", 0.66)],
    }[style]
    parts += bars(w, h, inner)
    out = local_box("sill", (w + 0.14, 0.05, 0.15), Matrix(), (0, -h / 2 - 0.02, THICK + 0.015),
                    "stone")
    parts.append(out)
    if style == "plaster":
        for s in (-1, 1):
            parts.append(local_box("trim", (0.11, h + 0.24, 0.03), Matrix(),
                                   (s * (w / 2 + 0.055), 0.02, THICK + 0.012), trim))
        parts.append(local_box("trim", (w + 0.34, 0.13, 0.06), Matrix(),
                               (0, h / 2 + 0.075, THICK + 0.025), trim))
    if style == "brick":
        parts.append(local_box("lintel", (w + 0.30, 0.20, 0.02), Matrix(),
                               (0, h / 2 + 0.10, THICK + 0.006), "stone"))
    if dressing == 1:
        for s in (-1, 1):
            parts.append(sheet(s * w / 2, s * (w / 2 - 0.24), -h / 2, h / 2, 0.018, "curtain"))
    if dressing == 2:
        parts.append(sheet(-w / 2, w / 2, 0.12, h / 2, 0.018, "curtain"))
    return joined(name, parts)


def door(name):
    """A panelled door with a light above it, two steps and a canopy; its middle is DOOR's."""
    w, h = DOOR
    parts = [reveal(w, h, "wall trim"), sheet(-w / 2, w / 2, -h / 2, h / 2, 0.01, "dark glass")]
    parts += bars(w, h, [("y", 0.78)], 0.09)
    leaf = (0, -0.27, 0.05)
    parts.append(local_box("leaf", (w - 0.18, 2.02, 0.05), Matrix(), leaf, "door paint"))
    for x in (-0.30, 0.30):
        for y, tall in ((-0.72, 0.72), (0.26, 0.92)):
            parts.append(local_box("panel", (0.44, tall, 0.02), Matrix(), (x, y, 0.082),
                                   "door paint"))
    parts.append(local_box("handle", (0.14, 0.03, 0.05), Matrix(), (0.5, -0.28, 0.10),
                           "galvanised steel"))
    parts.append(local_box("canopy", (2.0, 0.10, 0.95), Matrix(), (0, h / 2 + 0.17, 0.60),
                           "stone"))
    for k, deep in ((0, 0.72), (1, 0.40)):
        parts.append(local_box("step", (1.9, 0.16, deep), Matrix(),
                               (0, -h / 2 - 0.22 + 0.15 * k, THICK + deep / 2), "stone"))
    return joined(name, parts)


def shop(name):
    """A shop's window: a stall riser, three lights, a glazed row above."""
    w, h = SHOP
    parts = [reveal(w, h, "shop frame"),
             sheet(-w / 2, w / 2, -h / 2, h / 2, 0.012, "dark glass")]
    for bar in bars(w, h, [("x", -0.66), ("x", 0.66)], 0.07):
        bar.data.materials[0] = named_material("shop frame")
        parts.append(bar)
    parts.append(local_box("riser", (w, 0.42, 0.10), Matrix(), (0, -h / 2 + 0.21, 0.08),
                           "shop frame"))
    for k, tone in enumerate(("curtain", "door paint", "stone")):
        x = -0.9 + 0.9 * k
        parts.append(sheet(x - 0.22, x + 0.22, -0.82, -0.35 + 0.15 * k, 0.016, tone))
    return joined(name, parts)


def balcony(name):
    parts = [local_box("slab", (2.5, 0.14, 1.0), Matrix(), (0, 0, THICK + 0.5), "stone")]
    for x, z, wide, deep in ((0, THICK + 0.97, 2.46, 0.04), (-1.21, THICK + 0.5, 0.04, 0.96),
                             (1.21, THICK + 0.5, 0.04, 0.96)):
        parts.append(local_box("rail", (wide, 0.05, deep), Matrix(), (x, 1.02, z), "iron"))
    for k in range(21):
        x = -1.2 + 0.12 * k
        parts.append(local_box("rod", (0.016, 0.95, 0.016), Matrix(),
                               (x, 0.55, THICK + 0.97), "iron"))
    for s in (-1, 1):
        for k in range(7):
            parts.append(local_box("rod", (0.016, 0.95, 0.016), Matrix(),
                                   (1.21 * s, 0.55, THICK + 0.08 + 0.13 * k), "iron"))
    return joined(name, parts)


def wall(name, at, length, height, openings, material):
    """The skin: piers as high as a storey, and what is above and below each opening.
    openings: (storey, middle along the wall, middle height, width, height). `at`: see above."""
    quads = []
    storeys = int(height // FLOOR)
    for f in range(storeys):
        low, high = FLOOR * f, FLOOR * (f + 1) if f + 1 < storeys else height
        x = -THICK
        for _, u, v, w, h in sorted(o for o in openings if o[0] == f):
            quads.append((x, u - w / 2, low, high))
            quads.append((u - w / 2, u + w / 2, low, v - h / 2))
            quads.append((u - w / 2, u + w / 2, v + h / 2, high))
            x = u + w / 2
        quads.append((x, length + THICK, low, high))
    corners = [[(a, c), (b, c), (b, d), (a, d)] for a, b, c, d in quads if d > c]
    flat = np.array(corners).reshape(-1, 2)
    vertices = place(np.column_stack([flat, np.full(len(flat), THICK)]), at)
    shift = 0.37 * sum(map(ord, name)) % 5
    faces = np.arange(len(flat)).reshape(-1, 4)
    return mesh(name, vertices, faces, material, flat + (shift, 0.0))


class Fronts:
    """The units that near houses' walls are made of, and what is put where."""

    def __init__(self):
        self.units = {
            (style, k): window(f"window {style} {k}", style, k) for style in SIZES
            for k in range(3)
        }
        self.units["door"], self.units["shop"] = door("door"), shop("shop window")
        self.units["balcony"] = balcony("balcony")
        self.count = 0

    def put(self, key, matrix):
        unit = self.units[key]
        copy = bpy.data.objects.new(f"{unit.name} {self.count}", unit.data)
        copy.matrix_world = matrix
        bpy.context.scene.collection.objects.link(copy)
        self.count += 1

    def close(self):
        for unit in self.units.values():
            bpy.data.objects.remove(unit)


def opening_at(kind, storey, u):
    if kind == "door":
        return (0, u, 0.30 + DOOR[1] / 2, *DOOR)
    if kind == "shop":
        return (0, u, 0.32 + SHOP[1] / 2, *SHOP)
    return (storey, u, FLOOR * storey + PANE_Z, *SIZES[kind])


def furnished(fronts, name, at, bays, plan):
    """One wall of a house: its skin and what stands in its openings. plan: a dict of style,
    floors, length, height, material, doors (bays), shops (bool), balconies (bays), seed."""
    rng = random.Random(plan["seed"])
    openings = []
    for f in range(plan["floors"]):
        for k, u in enumerate(bays):
            kind = plan["style"]
            if f == 0 and k in plan["doors"]:
                kind = "door"
            elif f == 0 and plan["shops"]:
                kind = "shop"
            hole = opening_at(kind, f, u)
            openings.append(hole)
            unit = kind if kind in ("door", "shop") else (kind, rng.choice((0, 0, 1, 2)))
            fronts.put(unit, at @ Matrix.Translation((hole[1], hole[2], 0)))
            if f > 0 and k in plan["balconies"]:
                foot = (u, FLOOR * f + 0.42, 0)
                fronts.put("balcony", at @ Matrix.Translation(foot))
    wall(f"{name} wall", at, plan["length"], plan["height"], openings, plan["material"])
    return [o for o in openings if o[4] == DOOR[1] or (o[0] == 0 and o[4] == SHOP[1])]


def mouldings(name, at, plan, gaps):
    """Plinth between doors, a band over the ground floor, the cornice, a shop's fascia."""
    length, parts = plan["length"], []

    def strip(u0, u1, v, tall, deep, material):
        if u1 - u0 > 0.02:
            parts.append(local_box("strip", (u1 - u0, tall, deep), at,
                                   (0.5 * (u0 + u1), v, THICK + deep / 2 - 0.01), material))

    x = -THICK - 0.03
    for _, u, _, w, _ in sorted(gaps, key=lambda o: o[1]):
        strip(x, u - w / 2, 0.20, 0.48, 0.04, "stone")
        x = u + w / 2
    strip(x, length + THICK + 0.03, 0.20, 0.48, 0.04, "stone")
    end = length + THICK
    if plan["style"] == "plaster":
        strip(-THICK - 0.04, end + 0.04, 3.16, 0.14, 0.06, "wall trim")
    if plan["style"] != "office":
        strip(-THICK - 0.08, end + 0.08, plan["height"] - 0.10, 0.20, 0.14, "wall trim")
    strip(-THICK - 0.05, end + 0.05, plan["height"] - 0.28, 0.12, 0.07, "wall trim")
    if plan["shops"]:
        strip(0.2, length - 0.2, 3.04, 0.40, 0.12, plan["fascia"])
        rng = random.Random(plan["seed"] + 5)
        u = 1.0
        while u < length - 1.5:
            wide = rng.uniform(0.10, 0.22)
            parts.append(local_box("letter", (wide, 0.20, 0.02), at, (u, 3.04, THICK + 0.115),
                                   "road marking"))
            u += wide + (0.06 if rng.random() < 0.8 else 1.6)
    joined(f"{name} mouldings", parts)


def gutter(name, at, length, height):
    """Along the eaves, with a downpipe near its end."""
    z = THICK + 0.34
    pipe = [(-0.2, height + 0.02, z), (length + 0.2, height + 0.02, z)]
    down = [(length - 0.22, height, z), (length - 0.22, height - 0.22, z),
            (length - 0.22, height - 0.50, THICK + 0.07), (length - 0.22, 0.1, THICK + 0.07)]
    joined(f"{name} gutter", [
        tube("gutter", place(pipe, at), 0.07, "galvanised steel", 8),
        tube("downpipe", place(down, at), 0.045, "galvanised steel", 8, up=(0.6, 0.8, 0)),
    ])


def pitched_roof(name, x, y, size, material):
    """Two tiled slabs over gables of the wall's material; size: width, depth, height."""
    width, depth, height = size
    rise, over, d = 0.42 * width, 0.45, depth / 2
    eave = height - rise * over / (width / 2)
    for k, side in enumerate((-1, 1)):
        foot, ridge = (x + side * (width / 2 + over), eave), (x, height + rise)
        corners, uv = [], []
        slope = math.hypot(foot[0] - x, rise)
        for lift in (0.16, 0.0):
            for (px, pz), v in ((foot, 0.0), (ridge, slope)):
                for py in (y - d - 0.42, y + d + 0.42):
                    corners.append((px, py, pz + lift + 0.02))
                    uv.append((py, v))
        faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (0, 2, 6, 4), (1, 5, 7, 3)]
        loops = [uv[c] for face in faces for c in face]
        mesh(f"{name} roof {k}", corners, faces, "roof tile", loops)
    for k, py in enumerate((y - d - THICK, y + d + THICK)):
        corners = [(x - width / 2 - THICK, py, height - 0.02),
                   (x + width / 2 + THICK, py, height - 0.02), (x, py, height + rise - 0.04)]
        mesh(f"{name} gable {k}", corners, [(0, 1, 2)], material)
    tube(f"{name} ridge", [(x, y - d - 0.43, height + rise + 0.15),
                           (x, y + d + 0.43, height + rise + 0.15)], 0.11, "roof tile", 8)
    stack = frame_matrix((x + 0.2 * width, y, height + rise * 0.7), (1, 0, 0), (0, 1, 0))
    parts = [box("chimney", (0.7, 0.9, 2.6), stack, "wall brick", 0.0)]
    parts.append(box("cap", (0.86, 1.06, 0.12), stack @ Matrix.Translation((0, 0, 1.3)),
                     "stone"))
    parts[1].data.materials[0] = named_material("stone")
    joined(f"{name} chimney", parts)


def near_house(fronts, i, spot, shape, lit):
    """A house near the car; its doors as (x, y). spot: (x, y) of its middle and the side of
    the street; shape: (width, depth, floors, style); lit: (bay, storey) of panes that shine
    at night."""
    x, y, side = spot
    width, depth, floors, style = shape
    height = FLOOR * floors + 0.6
    rng = random.Random(70 + i)
    material = WALLS[style][(i + (i // 3)) % len(WALLS[style])]
    base = dict(style=style, floors=floors, height=height, material=material, seed=200 + i,
                shops=i % 3 == 1, balconies=(), doors=(), fascia=f"fascia {i % 2}")
    count = int(depth // 3)
    street = [3.0 * k + 1.5 for k in range(count)]
    front = frame_matrix((x - side * width / 2, y + side * depth / 2, 0), (0, -side, 0),
                         (0, 0, 1))
    if side > 0:  # the wall's x runs against y
        street = [depth - u for u in street]
    dark = [k for k in range(count) if (k, 0) not in lit]
    plan = dict(base, length=depth, doors={dark[len(dark) // 2]} if dark else set())
    if floors >= 4 or (style == "plaster" and floors == 3):
        plan["balconies"] = {rng.randrange(count), count - 1}
    gaps = furnished(fronts, f"house {i} front", front, street, plan)
    mouldings(f"house {i} front", front, plan, gaps)
    ends = ((-1, frame_matrix((x - width / 2, y - depth / 2, 0), (1, 0, 0), (0, 0, 1))),
            (1, frame_matrix((x + width / 2, y + depth / 2, 0), (-1, 0, 0), (0, 0, 1))))
    across = int((width - 1) // 3)
    bays = [width / 2 + 3.0 * (k - (across - 1) / 2) for k in range(across)]
    for sign, at in ends:
        if sign > 0 and y > 0:  # nobody looks back at these
            continue
        some = dict(base, length=width, shops=False, seed=300 + 2 * i + sign)
        furnished(fronts, f"house {i} end {sign}", at, bays, some)
        mouldings(f"house {i} end {sign}", at, some, [])
    if floors < 4:
        gutter(f"house {i}", front, depth, height)
        pitched_roof(f"house {i}", x, y, (width, depth, height), material)
    else:
        top = frame_matrix((x, y, height + 0.15), (1, 0, 0), (0, 1, 0))
        plate(f"house roof {i}", np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
              * (width / 2 + 0.42, depth / 2 + 0.42), 0.34, top, "roof grey", 0.03)
    front_x = x - side * (width / 2 + THICK)
    return [(front_x, y - depth / 2 + 3.0 * k + 1.5) for k in plan["doors"]]
