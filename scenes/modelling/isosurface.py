# SPDX-License-Identifier: Apache-2.0
"""Closed meshes: of the surface where a function of space is zero, and of folded sheets.

The function takes points (n, 3) and gives about the signed distance in metres, negative inside.
One vertex a cell that the surface crosses (the dual of a grid), moved onto the surface, evened
out along it; each crossed edge of the grid is a quad. Surfaces smooth beside the cell come out
closed, every edge between two triangles.
"""
import numpy as np

CORNERS = np.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
EDGES = [
    (a, b)
    for a in range(8)
    for b in range(a + 1, 8)
    if abs(CORNERS[a] - CORNERS[b]).sum() == 1
]


def gradient(function, points, step):
    axes = np.eye(3) * step
    return np.column_stack(
        [(function(points + a) - function(points - a)) / (2 * step) for a in axes]
    )


def fill_pinches(value):
    """Where the inside touches itself only across a face's or a cell's diagonal, the smaller of
    the values between becomes inside: the mesh then has no edge of four triangles."""
    for _ in range(20):
        found = 0
        for step in [(1, 1, 0), (1, 0, 1), (0, 1, 1), (1, 1, 1)]:
            box = np.array([c for c in np.ndindex(*(np.array(step) + 1))])
            size = np.array(value.shape) - step
            views = [tuple(slice(a, a + n) for a, n in zip(c, size)) for c in box]
            stack = np.stack([value[v] for v in views], -1)
            inside = stack < 0
            for k in range(len(box) // 2):
                others = [i for i in range(len(box)) if i not in (k, len(box) - 1 - k)]
                pair = inside[..., k] & inside[..., len(box) - 1 - k]
                bad = np.argwhere(pair & ~inside[..., others].any(-1))
                found += len(bad)
                for at in bad:
                    least = min(others, key=lambda i: stack[(*at, i)])
                    value[tuple(at + box[least])] = -1e-6
            if len(step) == 3 and sum(step) == 3:
                for k in range(len(box) // 2):
                    others = [i for i in range(len(box)) if i not in (k, len(box) - 1 - k)]
                    pair = ~inside[..., k] & ~inside[..., len(box) - 1 - k]
                    bad = np.argwhere(pair & inside[..., others].all(-1))
                    found += len(bad)
                    for at in bad:
                        value[tuple(at + box[k])] = -1e-6
        if not found:
            return


def cells(function, low, high, size):
    """The crossed cells' vertices (n, 3) and the index of each cell's vertex, -1 for none."""
    counts = np.ceil((np.asarray(high) - low) / size).astype(int) + 1
    axes = [low[a] + size * np.arange(counts[a]) for a in range(3)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    value = function(grid.reshape(-1, 3)).reshape(counts)
    shape = tuple(counts - 1)
    fill_pinches(value)
    corner = np.stack(
        [value[i : i + shape[0], j : j + shape[1], k : k + shape[2]] for i, j, k in CORNERS], -1
    )
    crossed = (corner < 0).any(-1) & (corner >= 0).any(-1)
    index = np.full(shape, -1)
    index[crossed] = np.arange(crossed.sum())
    at, c = np.argwhere(crossed), corner[crossed]
    total, number = np.zeros((len(at), 3)), np.zeros(len(at))
    for a, b in EDGES:
        cut = (c[:, a] < 0) != (c[:, b] < 0)
        t = np.where(cut, c[:, a] / np.where(cut, c[:, a] - c[:, b], 1.0), 0.0)
        point = CORNERS[a] + t[:, None] * (CORNERS[b] - CORNERS[a])
        total += np.where(cut[:, None], point, 0.0)
        number += cut
    return low + size * (at + total / number[:, None]), index, value


def quads(index, value):
    """Corners (n, 4), counter-clockwise from outside: one for each crossed edge of the grid."""
    out = []
    for axis in range(3):
        near = [slice(1, n) for n in index.shape]
        far = list(near)
        near[axis], far[axis] = slice(0, index.shape[axis]), slice(1, index.shape[axis] + 1)
        before, after = value[tuple(near)] < 0, value[tuple(far)] < 0
        at = np.argwhere(before != after)
        inside = before[before != after]
        cell = at + 1
        cell[:, axis] -= 1
        b, c = np.eye(3, dtype=int)[[(axis + 1) % 3, (axis + 2) % 3]]
        corner = np.stack(
            [index[tuple((cell - d).T)] for d in (0 * b, b, b + c, c)], axis=1
        )
        corner[~inside] = corner[~inside][:, ::-1]
        out.append(corner)
    return np.concatenate(out)


def evened(points, faces, function, size):
    """Each vertex towards the middle of its neighbours, along the surface."""
    start = faces.reshape(-1)
    end = np.roll(faces, -1, axis=1).reshape(-1)
    total, number = np.zeros_like(points), np.zeros(len(points))
    for a, b in ((start, end), (end, start)):
        np.add.at(total, a, points[b])
        np.add.at(number, a, 1)
    move = total / number[:, None] - points
    normal = gradient(function, points, 0.1 * size)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    return points + 0.5 * (move - (move * normal).sum(1)[:, None] * normal)


def ironed(points, faces):
    """Smooths where triangles fold over, in creases finer than a cell: corners to the mean of
    their neighbours."""
    for _ in range(60):
        a, b, c = (points[faces[:, k]] for k in range(3))
        across = np.cross(b - a, c - a)
        across /= np.maximum(np.linalg.norm(across, axis=1), 1e-20)[:, None]
        normal = vertex_normals(points, faces)
        turned = np.min([(across * normal[faces[:, k]]).sum(1) for k in range(3)], axis=0)
        bad = np.unique(faces[turned < 0.35])
        if not len(bad):
            break
        total, number = np.zeros_like(points), np.zeros(len(points))
        for i, j in ((0, 1), (1, 2), (2, 0), (1, 0), (2, 1), (0, 2)):
            np.add.at(total, faces[:, i], points[faces[:, j]])
            np.add.at(number, faces[:, i], 1)
        points = points.copy()
        points[bad] = total[bad] / number[bad][:, None]
    return points


def onto(points, function, size):
    slope = gradient(function, points, 0.1 * size)
    step = function(points) / np.maximum((slope**2).sum(1), 1e-3)
    limit = 0.5 * size / np.maximum(np.abs(step) * np.linalg.norm(slope, axis=1), 1e-12)
    return points - (step * np.minimum(1.0, limit))[:, None] * slope


def vertex_normals(points, faces):
    """The mean of the triangles around, by their angles: no triangle's own side is lost."""
    total = np.zeros_like(points)
    for k in range(3):
        a, b, c = (points[faces[:, (k + i) % 3]] for i in range(3))
        u, v = b - a, c - a
        across = np.cross(u, v)
        sine = np.linalg.norm(across, axis=1)
        angle = np.arctan2(sine, (u * v).sum(1))
        np.add.at(total, faces[:, k], across * (angle / np.maximum(sine, 1e-20))[:, None])
    return total / np.linalg.norm(total, axis=1)[:, None]


def largest(points, faces):
    """The largest piece alone: no bubbles enclosed in a solid."""
    label = np.arange(len(points))
    while True:
        least = label[faces].min(axis=1)
        new = label.copy()
        np.minimum.at(new, faces.reshape(-1), np.repeat(least, faces.shape[1]))
        if (new == label).all():
            break
        label = new
    kept = label == np.bincount(label).argmax()
    number = np.cumsum(kept) - 1
    return points[kept], number[faces[kept[faces[:, 0]]]]


def surface(function, low, high, size):
    """(points, normals, triangles) of the zero set within the box, which it must not touch."""
    points, index, value = cells(function, np.asarray(low, float), high, size)
    points, four = largest(points, quads(index, value))
    for _ in range(4):
        points = onto(evened(points, four, function, size), function, size)
    points = onto(points, function, size)
    a, b, c, d = (points[four[:, k]] for k in range(4))
    short = np.linalg.norm(a - c, axis=1) <= np.linalg.norm(b - d, axis=1)
    order = np.where(short[:, None], [[0, 1, 2, 0, 2, 3]], [[1, 2, 3, 1, 3, 0]])
    faces = np.take_along_axis(four, order, axis=1).reshape(-1, 3)
    points = ironed(points, faces)
    return points, vertex_normals(points, faces), faces


def folded_sheet(rings):
    """A closed mesh of a sheet with two faces: rings (stations, 2, n, 3)."""
    stations, _, n, _ = rings.shape
    loop = np.concatenate([rings[:, 0], rings[:, 1, ::-1]], axis=1)
    index = np.arange(stations * 2 * n).reshape(stations, 2 * n)
    a, b = index[:-1], index[1:]
    sides = [a, np.roll(a, -1, 1), np.roll(b, -1, 1), b]
    four = [np.stack(sides, -1).reshape(-1, 4)]
    for end, order in ((0, (0, 3, 2, 1)), (-1, (0, 1, 2, 3))):
        near, far = index[end, :n], index[end, n:][::-1]
        cap = np.stack([near[:-1], near[1:], far[1:], far[:-1]], -1)
        four.append(cap[:, list(order)])
    four = np.concatenate(four)
    points = loop.reshape(-1, 3)
    faces = np.concatenate([four[:, [0, 1, 2]], four[:, [0, 2, 3]]])
    corner = points[faces]
    if np.einsum("ij,ij->", corner[:, 0], np.cross(corner[:, 1], corner[:, 2])) < 0:
        faces = faces[:, ::-1]
    return points, vertex_normals(points, faces), faces
