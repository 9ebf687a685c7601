# SPDX-License-Identifier: Apache-2.0
"""Shapes the car is made of, as Blender meshes.

Frame: x to the right, y forward, z up, metres (the exporter turns it into glTF's +Y up, -Z
forward). Texture coordinates are kept in metres along the surface; finish.py scales them by
each material's tile. A face's front is where its corners run counter-clockwise.
"""
import math

import bmesh
import bpy
import numpy as np
from mathutils import Matrix, Vector

SHARP = math.radians(38)  # edges blunter than this are shaded smooth


def spline(points, count):
    """`count` points of a Catmull-Rom curve through `points`, evenly spaced in parameter."""
    p = np.asarray(points, float)
    p = np.vstack([2 * p[0] - p[1], p, 2 * p[-1] - p[-2]])
    t = np.linspace(0, len(p) - 3 - 1e-9, count)
    i = np.floor(t).astype(int)
    f = (t - i)[:, None]
    a, b, c, d = p[i], p[i + 1], p[i + 2], p[i + 3]
    return 0.5 * (
        2 * b
        + (c - a) * f
        + (2 * a - 5 * b + 4 * c - d) * f**2
        + (3 * b - a - 3 * c + d) * f**3
    )


def rounded_rectangle(width, height, radius, steps=6):
    """Counter-clockwise outline (n, 2) about the origin; the first point is not repeated."""
    corners = []
    for k, (sx, sy) in enumerate(((1, 1), (-1, 1), (-1, -1), (1, -1))):
        for a in np.linspace(0, math.pi / 2, steps) + k * math.pi / 2:
            corners.append(
                (
                    sx * (width / 2 - radius) + radius * math.cos(a),
                    sy * (height / 2 - radius) + radius * math.sin(a),
                )
            )
    return np.array(corners)


def frame_matrix(origin, right, up):
    """Local (x right, y up, z towards the viewer) to car; right and up are made orthonormal."""
    r = Vector(right).normalized()
    n = r.cross(Vector(up)).normalized()
    u = n.cross(r)
    m = Matrix((r, u, n)).transposed().to_4x4()
    m.translation = Vector(origin)
    return m


def place(points, matrix):
    """Points (..., 3) through a 4x4 matrix."""
    m = np.array(matrix)
    p = np.asarray(points, float)
    return p @ m[:3, :3].T + m[:3, 3]


def mesh(name, vertices, faces, material, loop_uvs=None):
    """An object of one material. loop_uvs: one (u, v) in metres per face corner, or None for a
    projection along the axis that each face looks to (made when the model is finished)."""
    data = bpy.data.meshes.new(name)
    data.from_pydata(
        [tuple(map(float, v)) for v in vertices], [], [tuple(map(int, f)) for f in faces]
    )
    data.materials.append(named_material(material))
    data.polygons.foreach_set("use_smooth", [True] * len(data.polygons))
    data.use_auto_smooth = True
    data.auto_smooth_angle = SHARP
    if loop_uvs is not None:
        layer = data.uv_layers.new(name="UVMap")
        layer.data.foreach_set("uv", np.asarray(loop_uvs, float).ravel())
    data.update()
    item = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(item)
    return item


def named_material(name):
    return bpy.data.materials.get(name) or bpy.data.materials.new(name)


def grid(name, points, material, closed=False, flip=False):
    """A surface through points (rows, columns, 3); `closed` joins the last column to the first.
    Fronts look along (column direction) x (row direction); flip turns them."""
    p = np.asarray(points, float)
    rows, columns = p.shape[:2]
    across = columns if closed else columns - 1
    wrapped = np.concatenate([p, p[:, :1]], axis=1) if closed else p
    u = np.cumsum(np.linalg.norm(np.diff(wrapped, axis=1), axis=2).mean(axis=0))
    v = np.cumsum(np.linalg.norm(np.diff(p, axis=0), axis=2).mean(axis=1))
    u, v = np.concatenate([[0], u]), np.concatenate([[0], v])
    faces, uvs = [], []
    for i in range(rows - 1):
        for j in range(across):
            corners = [(i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j)]
            if flip:
                corners.reverse()
            faces.append([a * columns + b % columns for a, b in corners])
            uvs.extend((u[b], v[a]) for a, b in corners)
    return mesh(name, p.reshape(-1, 3), faces, material, uvs)


def cut(item, faces):
    """Takes faces, by their numbers, out of an object."""
    work = bmesh.new()
    work.from_mesh(item.data)
    work.faces.ensure_lookup_table()
    bmesh.ops.delete(work, geom=[work.faces[i] for i in faces], context="FACES")
    work.to_mesh(item.data)
    work.free()


def tube_points(path, radius, sides=10, closed=False, squash=1.0, up=(0, 0, 1)):
    """Rings (n, sides, 3) of an elliptic tube along path; radius: number or one per point;
    squash scales the ring along `up`."""
    path = np.asarray(path, float)
    if closed:
        tangent = np.roll(path, -1, 0) - np.roll(path, 1, 0)
    else:
        tangent = np.gradient(path, axis=0)
    tangent /= np.linalg.norm(tangent, axis=1)[:, None]
    side = np.cross(tangent, np.asarray(up, float))
    side /= np.maximum(np.linalg.norm(side, axis=1), 1e-9)[:, None]
    lift = np.cross(side, tangent)
    a = np.linspace(0, 2 * math.pi, sides, endpoint=False)
    r = np.broadcast_to(np.asarray(radius, float), (len(path),))[:, None, None]
    return (
        path[:, None]
        + r * np.cos(a)[None, :, None] * side[:, None]
        + squash * r * np.sin(a)[None, :, None] * lift[:, None]
    )


def tube(name, path, radius, material, sides=10, closed=False, squash=1.0, up=(0, 0, 1)):
    """A tube along a curve; open ends are rounded off by two shrinking rings."""
    rings = tube_points(path, radius, sides, closed, squash, up)
    if closed:
        rings = np.concatenate([rings, rings[:1]])
        return grid(name, rings, material, closed=True, flip=True)
    first, last = rings[0], rings[-1]
    begin, end = first.mean(0), last.mean(0)
    r = np.linalg.norm(first[0] - begin), np.linalg.norm(last[0] - end)
    d0 = (begin - rings[1].mean(0)) / max(np.linalg.norm(begin - rings[1].mean(0)), 1e-9)
    d1 = (end - rings[-2].mean(0)) / max(np.linalg.norm(end - rings[-2].mean(0)), 1e-9)
    caps0 = [
        begin + (first - begin) * k + d0 * r[0] * h
        for k, h in ((0.02, 0.6), (0.55, 0.5), (0.88, 0.28))
    ]
    caps1 = [
        end + (last - end) * k + d1 * r[1] * h
        for k, h in ((0.88, 0.28), (0.55, 0.5), (0.02, 0.6))
    ]
    return grid(name, np.concatenate([caps0, rings, caps1]), material, closed=True, flip=True)


def lathe(name, profile, matrix, material, sides=32):
    """Turns (radius, height) pairs about the local z axis; a profile that grows in height at
    the outside shows its front outside."""
    a = np.linspace(0, 2 * math.pi, sides, endpoint=False)
    rings = [[(r * math.cos(t), r * math.sin(t), h) for t in a] for r, h in profile]
    return grid(name, place(rings, matrix), material, closed=True)


def box(name, size, matrix, material, bevel=0.002, segments=2):
    """A box about the origin of `matrix` with bevelled edges."""
    x, y, z = (0.5 * s for s in size)
    corners = [
        (-x, -y, -z),
        (x, -y, -z),
        (x, y, -z),
        (-x, y, -z),
        (-x, -y, z),
        (x, -y, z),
        (x, y, z),
        (-x, y, z),
    ]
    faces = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
    item = mesh(name, place(corners, matrix), faces, material)
    return bevelled(item, bevel, segments)


def plate(name, outline, thickness, matrix, material, bevel=0.001, segments=2, crown=0.0):
    """A flat outline (n, 2) counter-clockwise, extruded from local z = 0 down to -thickness,
    front at z = 0. crown lifts the outline's middle: made by rings shrinking to the centre."""
    o = np.asarray(outline, float)
    n, middle = len(o), o.mean(0)
    rings = [np.column_stack([o, np.full(n, -thickness)]), np.column_stack([o, np.zeros(n)])]
    steps = (0.75, 0.5, 0.25, 0.04) if crown else ()
    for k in steps:
        rings.append(
            np.column_stack([middle + (o - middle) * k, np.full(n, crown * (1 - k * k))])
        )
    vertices = place(np.concatenate(rings), matrix)
    faces = [list(range(n))[::-1]]
    for i in range(len(rings) - 1):
        for j in range(n):
            k = (j + 1) % n
            faces.append([i * n + j, i * n + k, (i + 1) * n + k, (i + 1) * n + j])
    faces.append([(len(rings) - 1) * n + j for j in range(n)])
    return bevelled(mesh(name, vertices, faces, material), bevel, segments)


def frame_ring(name, outline, section, matrix, material):
    """Sweeps a closed section (m, 2: outward, towards the viewer) along a closed outline in
    the local plane: surrounds and bezels."""
    o = np.asarray(outline, float)
    tangent = np.roll(o, -1, 0) - np.roll(o, 1, 0)
    tangent /= np.linalg.norm(tangent, axis=1)[:, None]
    outward = np.column_stack([tangent[:, 1], -tangent[:, 0]])
    s = np.asarray(section, float)
    rings = np.concatenate(
        [
            o[:, None] + s[None, :, :1] * outward[:, None],
            np.broadcast_to(s[None, :, 1:], (len(o), len(s), 1)),
        ],
        axis=2,
    )
    rings = np.concatenate([rings, rings[:1]])
    return grid(name, place(rings, matrix), material, closed=True, flip=True)


def round_section(width, height, steps=10):
    """An ellipse as the section of a surround."""
    a = np.linspace(0, 2 * math.pi, steps, endpoint=False)
    return np.column_stack([0.5 * width * np.cos(a), 0.5 * height * np.sin(a)])


def bevelled(item, width, segments=2):
    if width > 0:
        modifier = item.modifiers.new("bevel", "BEVEL")
        modifier.width = width
        modifier.segments = segments
        modifier.limit_method = "ANGLE"
        modifier.angle_limit = math.radians(32)
        modifier.harden_normals = True
        modifier.use_clamp_overlap = True
    return item


def subdivided(item, levels=1):
    item.modifiers.new("subdivision", "SUBSURF").levels = levels
    return item


def joined(name, items):
    """Applies the modifiers of several objects and makes one object of them."""
    for item in items:
        apply_modifiers(item)
    bpy.ops.object.select_all(action="DESELECT")
    for item in items:
        item.select_set(True)
    bpy.context.view_layer.objects.active = items[0]
    bpy.ops.object.join()
    items[0].name = items[0].data.name = name
    return items[0]


def apply_modifiers(item):
    if not item.modifiers:
        return
    shape = item.evaluated_get(bpy.context.evaluated_depsgraph_get())
    data = bpy.data.meshes.new_from_object(shape)
    data.name = item.data.name
    item.modifiers.clear()
    item.data = data


def stitches(
    name, path, normals, material, length=0.0042, pitch=0.0062, thickness=0.0011, slant=0.0
):
    """A seam: short threads along `path` that dive into the surface at both ends.
    normals: the surface's, one per path point; slant: shift across the seam in metres."""
    path, normals = np.asarray(path, float), np.asarray(normals, float)
    arc = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))])
    vertices, faces = [], []
    ring = [(math.cos(a), math.sin(a)) for a in np.linspace(0, 2 * math.pi, 4, endpoint=False)]
    for start in np.arange(0, arc[-1] - length, pitch):
        s = start + np.array([0.0, 0.3, 0.7, 1.0]) * length
        points = np.column_stack([np.interp(s, arc, path[:, k]) for k in range(3)])
        normal = np.array(
            [np.interp(start + 0.5 * length, arc, normals[:, k]) for k in range(3)]
        )
        normal /= np.linalg.norm(normal)
        along = points[-1] - points[0]
        along /= np.linalg.norm(along)
        side = np.cross(normal, along)
        base = len(vertices)
        for k, (point, lift) in enumerate(zip(points, (-0.7, 0.6, 0.6, -0.7))):
            centre = point + normal * lift * thickness * 0.5 + side * slant * (k / 3 - 0.5)
            wide = 0.5 * thickness * (0.55 if k in (0, 3) else 1.0)
            vertices.extend(centre + wide * (c * side + d * normal) for c, d in ring)
        for k in range(3):
            for j in range(4):
                a, b = base + 4 * k + j, base + 4 * k + (j + 1) % 4
                faces.append([a, b, b + 4, a + 4])
    return mesh(name, vertices, faces, material)


def box_project(item):
    """Texture coordinates in metres, seen along the axis that each face looks to."""
    data = item.data
    layer = data.uv_layers.new(name="UVMap")
    for face in data.polygons:
        n = [abs(c) for c in face.normal]
        axis = n.index(max(n))
        for loop in face.loop_indices:
            x, y, z = item.matrix_world @ data.vertices[data.loops[loop].vertex_index].co
            layer.data[loop].uv = ((y, z), (x, z), (x, y))[axis]
