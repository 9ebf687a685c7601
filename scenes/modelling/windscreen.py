# SPDX-License-Identifier: Apache-2.0
"""The car's windscreen as a formula: for the modelling and for the head-up display's optics.

Frame as shapes.py: x to the right, y forward, z up, metres.
"""
import numpy as np


def screen(u, v, inward=0.0):
    """Windscreen at u (-1 left .. 1 right), v (0 foot .. 1 header); inward shifts it inside."""
    u, v = np.broadcast_arrays(np.asarray(u, float), np.asarray(v, float))
    foot = np.stack([0.735 * u, 1.340 - 0.230 * u**2, 1.005 + 0.045 * u**2], -1)
    head = np.stack([0.575 * u, 0.440 - 0.120 * u**2, 1.480 - 0.035 * u**2], -1)
    bulge = (0.010 * 4 * v * (1 - v) - inward)[..., None] * np.array([0.0, 0.46, 0.89])
    return foot * (1 - v)[..., None] + head * v[..., None] + bulge


def screen_normal(u, v):
    """Unit normals that point out of the car. Central differences: exact but for rounding,
    since the formula is a parabola along either line."""
    h = 1e-4
    along_u = screen(u + h, v) - screen(u - h, v)
    along_v = screen(u, v + h) - screen(u, v - h)
    normal = np.cross(along_v, along_u)
    return normal / np.linalg.norm(normal, axis=-1, keepdims=True)
