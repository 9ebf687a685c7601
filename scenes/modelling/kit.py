# SPDX-License-Identifier: Apache-2.0
"""Many small hard parts as few meshes: switches, knobs, screws, plates, engraved letters.

A Kit collects triangles and quads by material and becomes one mesh a material at the end, so
that a panel of hundreds of parts is a handful of objects. Frames as in shapes.py.
"""
import math

import numpy as np
from mathutils import Matrix

from shapes import mesh, place, rounded_rectangle
from stroke_font import strokes


def shifted(matrix, x=0.0, y=0.0, z=0.0, turn_deg=0.0):
    """The same plane, its origin moved in it and turned about its normal."""
    turn = Matrix.Rotation(math.radians(turn_deg), 4, "Z")
    return matrix @ Matrix.Translation((x, y, z)) @ turn


class Kit:
    def __init__(self, name):
        self.name = name
        self.parts = {}

    def add(self, material, vertices, faces):
        points, corners = self.parts.setdefault(material, ([], []))
        base = sum(len(p) for p in points)
        points.append(np.asarray(vertices, float))
        corners.extend([base + int(k) for k in face] for face in faces)

    def build(self):
        for material, (points, faces) in self.parts.items():
            mesh(f"{self.name} {material}", np.concatenate(points), faces, material)

    def box(self, size, matrix, material, chamfer=0.001):
        """A box about the matrix' origin with chamfered edges."""
        half = 0.5 * np.asarray(size, float)
        c = min(chamfer, 0.49 * half.min())
        self.add(material, *chamfered_box(half, c, matrix))

    def rise(self, size, matrix, material, chamfer=0.001):
        """A box that stands on the plane: its foot at z = 0."""
        self.box(size, shifted(matrix, z=0.5 * size[2]), material, chamfer)

    def plate(self, outline, thickness, matrix, material, chamfer=0.001):
        """An outline (n, 2) from z = 0 up to `thickness`, its upper edge chamfered."""
        o = np.asarray(outline, float)
        n = len(o)
        inner = shrunk(o, chamfer)
        rings = [
            np.column_stack([o, np.zeros(n)]),
            np.column_stack([o, np.full(n, thickness - chamfer)]),
            np.column_stack([inner, np.full(n, thickness)]),
        ]
        faces = [[2 * n + j for j in range(n)]]
        for i in range(2):
            for j in range(n):
                k = (j + 1) % n
                faces.append([i * n + j, i * n + k, (i + 1) * n + k, (i + 1) * n + j])
        self.add(material, place(np.concatenate(rings), matrix), faces)

    def panel(self, size, matrix, material, thickness=0.002, radius=0.003, chamfer=0.0006):
        """A rounded rectangular plate that stands on the plane."""
        outline = rounded_rectangle(size[0], size[1], radius, 4)
        self.plate(outline, thickness, matrix, material, chamfer)

    def lathe(self, profile, matrix, material, sides=20, knurl=0.0):
        """(radius, height) pairs turned about z; knurl: relative depth of ridges."""
        a = np.linspace(0, 2 * math.pi, sides, endpoint=False)
        ridge = np.where(np.arange(sides) % 2 == 0, 1.0, 1.0 - knurl)
        rings = [
            np.column_stack([r * ridge * np.cos(a), r * ridge * np.sin(a), np.full(sides, h)])
            for r, h in profile
        ]
        faces = []
        for i in range(len(rings) - 1):
            for j in range(sides):
                k = (j + 1) % sides
                faces.append(
                    [i * sides + j, i * sides + k, (i + 1) * sides + k, (i + 1) * sides + j]
                )
        faces.append([(len(rings) - 1) * sides + j for j in range(sides)])
        self.add(material, place(np.concatenate(rings), matrix), faces)

    def ring(self, outline, section, matrix, material):
        """A section (m, 2: outward, towards the viewer) carried round an outline (n, 2)."""
        o = np.asarray(outline, float)
        tangent = np.roll(o, -1, 0) - np.roll(o, 1, 0)
        tangent /= np.linalg.norm(tangent, axis=1)[:, None]
        outward = np.column_stack([tangent[:, 1], -tangent[:, 0]])
        s = np.asarray(section, float)
        n, m = len(o), len(s)
        points = np.empty((n, m, 3))
        points[:, :, :2] = o[:, None] + s[None, :, :1] * outward[:, None]
        points[:, :, 2] = s[None, :, 1]
        faces = [
            [i * m + j, (i + 1) % n * m + j, (i + 1) % n * m + (j + 1) % m, i * m + (j + 1) % m]
            for i in range(n)
            for j in range(m)
        ]
        self.add(material, place(points.reshape(-1, 3), matrix), faces)

    def text(self, string, matrix, height, material="legend", align=0.5, weight=0.13):
        """Engraved letters on the plane; `align` 0 left, 0.5 centred, 1 right; the baseline is
        half the height below the origin."""
        lines, width = strokes(string)
        half = 0.5 * weight
        vertices, faces = [], []
        for (ax, ay), (bx, by) in lines:
            length = math.hypot(bx - ax, by - ay)
            tx, ty = (bx - ax) / length * half, (by - ay) / length * half
            base = len(vertices)
            for x, y in (
                (ax - tx + ty, ay - ty - tx),
                (bx + tx + ty, by + ty - tx),
                (bx + tx - ty, by + ty + tx),
                (ax - tx - ty, ay - ty + tx),
            ):
                vertices.append(((x - align * width) * height, (y - 0.5) * height, 0.0003))
            faces.append([base, base + 1, base + 2, base + 3])
        if faces:
            self.add(material, place(vertices, matrix), faces)

    def line(self, points, matrix, width, material="legend", lift=0.0003):
        """A painted line through points (n, 2) of the plane."""
        p = np.asarray(points, float)
        for a, b in zip(p[:-1], p[1:]):
            along = (b - a) / np.linalg.norm(b - a) * 0.5 * width
            side = np.array([along[1], -along[0]])
            corners = [a - along + side, b + along + side, b + along - side, a - along - side]
            self.add(
                material,
                place(np.column_stack([corners, np.full(4, lift)]), matrix),
                [(0, 1, 2, 3)],
            )

    def screw(self, matrix, radius=0.0028):
        """A quarter-turn fastener with its slot."""
        self.lathe(
            [(radius, 0), (radius, 0.0006), (0.82 * radius, 0.0010)], matrix, "fastener", 12
        )
        turned = shifted(matrix, z=0.0011, turn_deg=33.0 + 1e4 * matrix.translation.x % 90)
        self.add(
            "gap",
            place(
                [
                    (-0.7 * radius, -0.14 * radius, 0),
                    (0.7 * radius, -0.14 * radius, 0),
                    (0.7 * radius, 0.14 * radius, 0),
                    (-0.7 * radius, 0.14 * radius, 0),
                ],
                turned,
            ),
            [(0, 1, 2, 3)],
        )

    def screws(self, matrix, size, inset=0.006, radius=0.0028):
        for sx in (-1, 1):
            for sy in (-1, 1):
                self.screw(
                    shifted(matrix, sx * (0.5 * size[0] - inset), sy * (0.5 * size[1] - inset)),
                    radius,
                )

    def knob(self, matrix, radius=0.009, height=0.016, material="knob", pointer=True):
        """A knurled knob on a skirt, with a white line at its turn."""
        self.lathe(
            [(1.25 * radius, 0), (1.25 * radius, 0.0012), (1.12 * radius, 0.0022)],
            matrix,
            material,
            24,
        )
        self.lathe(
            [
                (radius, 0.0022),
                (0.94 * radius, height - 0.0012),
                (0.82 * radius, height),
                (0.55 * radius, height + 0.0002),
            ],
            matrix,
            material,
            32,
            0.07,
        )
        if pointer:
            at = shifted(matrix, z=height)
            self.line([(0, 0.2 * radius), (0, 0.75 * radius)], at, 0.0012)

    def concentric(self, matrix, radius=0.010, material="knob"):
        """Two knobs, one on top of the other."""
        self.knob(matrix, radius, 0.010, material, False)
        self.knob(shifted(matrix, z=0.010), 0.62 * radius, 0.012, material)

    def button(self, matrix, size, material="key", height=0.004):
        """A push button in a dark gap."""
        w, h = size
        self.panel((w + 0.0016, h + 0.0016), matrix, "gap", 0.0005, 0.0012, 0.0002)
        self.panel(size, matrix, material, height, 0.0012, 0.0007)

    def toggle(self, matrix, lean_deg=18.0):
        """A bat-handled switch with its nut."""
        self.lathe([(0.0052, 0), (0.0052, 0.0022), (0.0044, 0.0030)], matrix, "steel", 6)
        tilt = matrix @ Matrix.Rotation(math.radians(lean_deg), 4, "X")
        self.lathe(
            [
                (0.0020, 0.001),
                (0.0024, 0.010),
                (0.0034, 0.0160),
                (0.0032, 0.0185),
                (0.0018, 0.0198),
            ],
            tilt,
            "steel",
            12,
        )


def chamfered_box(half, c, matrix):
    """24 corners, 26 faces: six sides, twelve chamfers, eight corners."""
    vertices, index = [], {}
    for sx in (-1, 1):
        for sy in (-1, 1):
            for sz in (-1, 1):
                for axis in range(3):
                    p = np.array([sx, sy, sz]) * (half - c)
                    p[axis] = (sx, sy, sz)[axis] * half[axis]
                    index[(sx, sy, sz, axis)] = len(vertices)
                    vertices.append(p)
    v = np.array(vertices)
    faces = []

    def face(ids):
        middle = v[ids].mean(0)
        normal = np.cross(v[ids[1]] - v[ids[0]], v[ids[2]] - v[ids[1]])
        faces.append(ids if normal @ middle > 0 else ids[::-1])

    loop = ((-1, -1), (1, -1), (1, 1), (-1, 1))
    for axis in range(3):
        others = [k for k in range(3) if k != axis]
        for s in (-1, 1):
            ids = []
            for pair in loop:
                sign = [0, 0, 0]
                sign[axis], sign[others[0]], sign[others[1]] = s, *pair
                ids.append(index[(*sign, axis)])
            face(ids)
        for pair in loop:
            ids = []
            for s, kind in ((-1, 0), (1, 0), (1, 1), (-1, 1)):
                sign = [0, 0, 0]
                sign[axis], sign[others[0]], sign[others[1]] = s, *pair
                ids.append(index[(*sign, others[kind])])
            face(ids)
    for sx in (-1, 1):
        for sy in (-1, 1):
            for sz in (-1, 1):
                face([index[(sx, sy, sz, axis)] for axis in range(3)])
    return place(v, matrix), faces


def shrunk(outline, by):
    """A counter-clockwise outline moved inward along its normals."""
    o = np.asarray(outline, float)
    tangent = np.roll(o, -1, 0) - np.roll(o, 1, 0)
    tangent /= np.maximum(np.linalg.norm(tangent, axis=1)[:, None], 1e-9)
    return o - by * np.column_stack([tangent[:, 1], -tangent[:, 0]])
