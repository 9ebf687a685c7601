# SPDX-License-Identifier: Apache-2.0
"""Signed distances, about, of the solids that a figure is made of, and ways to join them.

Points are (n, 3) in metres; a distance is negative inside.
"""
import numpy as np


def joined(a, b, width):
    """The union, its crease filled over `width`."""
    h = np.maximum(width - np.abs(a - b), 0.0) / width
    return np.minimum(a, b) - 0.25 * h * h * width


def common(a, b, width):
    """The intersection, its edge rounded over `width`."""
    return -joined(-a, -b, width)


def without(a, b, width):
    return common(a, -b, width)


def limb(p, a, b, radius_a, radius_b):
    """A round cone from a to b."""
    a, b = np.asarray(a, float), np.asarray(b, float)
    axis = b - a
    t = np.clip((p - a) @ axis / (axis @ axis), 0.0, 1.0)
    return np.linalg.norm(p - a - t[:, None] * axis, axis=1) - (
        radius_a + t * (radius_b - radius_a)
    )


def chain(p, points, radii, width):
    """Limbs from point to point, joined."""
    d = limb(p, points[0], points[1], radii[0], radii[1])
    for i in range(1, len(points) - 1):
        d = joined(d, limb(p, points[i], points[i + 1], radii[i], radii[i + 1]), width)
    return d


def egg(p, centre, radii):
    """An ellipsoid along the axes; the distance is exact on its surface and near it."""
    q = (p - np.asarray(centre, float)) / radii
    scaled = np.linalg.norm(q, axis=1)
    slope = np.linalg.norm(q / radii, axis=1)
    return scaled * (scaled - 1.0) / np.maximum(slope, 1e-9)


def beyond(p, point, direction):
    """The half space on the far side of a plane is outside: positive along `direction`."""
    direction = np.asarray(direction, float)
    return (p - np.asarray(point, float)) @ (direction / np.linalg.norm(direction))


def smooth_table(x, table):
    """Columns of `table` against its first, by cubic pieces through its rows."""
    t, rows = table[:, 0], table[:, 1:]
    x = np.clip(x, t[0], t[-1])
    slope = np.gradient(rows, t, axis=0)
    i = np.clip(np.searchsorted(t, x) - 1, 0, len(t) - 2)
    h = (t[i + 1] - t[i])[:, None]
    u = ((x - t[i])[:, None]) / h
    return (
        rows[i] * (1 + 2 * u) * (1 - u) ** 2
        + rows[i + 1] * u * u * (3 - 2 * u)
        + h * (slope[i] * u * (1 - u) ** 2 - slope[i + 1] * u * u * (1 - u))
    )
