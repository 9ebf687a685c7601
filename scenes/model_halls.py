#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the car's two halls, garage.gltf and tunnel_exit.gltf (.bin), beside itself.

    python3 scenes/model_halls.py

Needs numpy alone. Light scenes to be named beside car_dashboard.gltf: each is a concrete shell
round the car, between the kerbs and under the trees of its street, with lamps of its own.
x to the right, y forward, z up, metres; the car stands at y = -2.4 .. 2.6 on z = 0.
"""
import os
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "modelling"))

from packing import Packing  # noqa: E402

# linear reflectance; or light, (linear colour, cd/m2)
SURFACES = {
    "concrete": (0.36, 0.355, 0.34),
    "concrete dark": (0.16, 0.158, 0.152),
    "ceiling": (0.46, 0.46, 0.45),
    "floor": (0.20, 0.20, 0.205),
    "floor paint": (0.62, 0.62, 0.60),
    "band": (0.58, 0.40, 0.03),
    "lining": (0.52, 0.52, 0.50),
    "road": (0.085, 0.086, 0.089),
    "housing": (0.55, 0.55, 0.55),
    "night": (0.004, 0.004, 0.004),
}
LIGHTS = {
    "tube": ((0.90, 0.97, 1.0), 7000.0),
    "exit sign": ((0.06, 1.0, 0.32), 250.0),
    "tunnel lamp": ((1.0, 0.97, 0.92), 12000.0),
}


class Hall:
    """Boxes and rectangles, a mesh of each material."""

    def __init__(self):
        self.parts = {}

    def rectangle(self, material, corner, along, across):
        """Its front looks along x across."""
        points = np.array([corner, corner, corner, corner], float)
        points[1:3] += along
        points[2:] += across
        normal = np.cross(along, across)
        self.parts.setdefault(material, []).append((points, normal / np.linalg.norm(normal)))

    def box(self, material, low, high, skip=()):
        """Fronts look out; skip: sides (axis, 0 or 1) that are left away."""
        low, high = np.array(low, float), np.array(high, float)
        for axis in range(3):
            a, b = np.zeros(3), np.zeros(3)
            j, k = (axis + 1) % 3, (axis + 2) % 3
            a[j], b[k] = high[j] - low[j], high[k] - low[k]
            if (axis, 0) not in skip:
                self.rectangle(material, low, b, a)
            if (axis, 1) not in skip:
                self.rectangle(material, np.where(np.arange(3) == axis, high, low), a, b)

    def lamp(self, material, centre, size):
        """A box whose lower face shines."""
        c, s = np.array(centre), np.array(size) / 2
        self.box("housing", c - s, c + s, skip=((2, 0),))
        low = c - s
        self.rectangle(material, low, (0, 2 * s[1], 0), (2 * s[0], 0, 0))

    def write(self, name, environment):
        packing, meshes, materials = Packing(), [], []
        for i, (material, rectangles) in enumerate(sorted(self.parts.items())):
            points = np.concatenate([points for points, _ in rectangles])
            normals = np.repeat([normal for _, normal in rectangles], 4, axis=0)
            first = 4 * np.arange(len(rectangles))[:, None]
            faces = (first + np.array([0, 1, 2, 0, 2, 3])).reshape(-1, 3)
            meshes.append({"name": material, "primitives": [
                packing.primitive(i, points, normals, faces)]})
            materials.append(material_json(material))
        count = len(meshes)
        packing.write(os.path.join(HERE, name + ".gltf"), {
            "asset": {"version": "2.0", "generator": "model_halls.py of Parhelion"},
            "extensionsUsed": ["KHR_materials_emissive_strength", "PARHELION_environment"],
            "scene": 0,
            "scenes": [{"name": name, "nodes": list(range(count)),
                        "extensions": {"PARHELION_environment": environment}}],
            "nodes": [{"name": mesh["name"], "mesh": i} for i, mesh in enumerate(meshes)],
            "meshes": meshes, "materials": materials}, name + ".bin")


def material_json(name):
    out = {"name": name, "doubleSided": True, "pbrMetallicRoughness": {
        "baseColorFactor": [*SURFACES.get(name, (0.1, 0.1, 0.1)), 1.0], "metallicFactor": 0.0,
        "roughnessFactor": 0.9}}
    if name in LIGHTS:
        color, strength = LIGHTS[name]
        out["emissiveFactor"] = list(color)
        out["doubleSided"] = False
        out["extensions"] = {"KHR_materials_emissive_strength": {"emissiveStrength": strength}}
    return out


def garage():
    """An aisle of a parking garage: a wall beside the car, bays and pillars on its left, two
    rows of cool tubes."""
    hall = Hall()
    x0, x1, y0, y1, z1 = -5.5, 2.05, -14.0, 17.5, 2.45
    hall.rectangle("floor", (x0, y0, 0.012), (x1 - x0, 0, 0), (0, y1 - y0, 0))
    hall.rectangle("ceiling", (x0, y0, z1), (0, y1 - y0, 0), (x1 - x0, 0, 0))
    for name, low, high in (("concrete dark", 0.0, 0.25), ("concrete", 0.25, 0.95),
                            ("band", 0.95, 1.10), ("concrete", 1.10, z1)):
        for x, way in ((x0, 1), (x1, -1)):
            hall.rectangle(name, (x, y0 if way < 0 else y1, low), (0, way * (y0 - y1), 0),
                           (0, 0, high - low))
        for y, way in ((y0, -1), (y1, 1)):
            hall.rectangle(name, (x0 if way > 0 else x1, y, low), (way * (x1 - x0), 0, 0),
                           (0, 0, high - low))
    for y in np.arange(-11.5, 17, 5.0):
        hall.box("concrete", (-5.05, y - 0.2, 0.012), (-4.65, y + 0.2, z1))
        hall.box("band", (-5.055, y - 0.205, 0.9), (-4.645, y + 0.205, 1.2))
        hall.box("ceiling", (x0, y - 0.15, 2.22), (x1, y + 0.15, z1))
        for k in (0.2, 2.7):
            hall.rectangle("floor paint", (-5.0, y + k - 0.05, 0.014), (1.6, 0, 0), (0, 0.1, 0))
        for x in (-3.1, 0.35):
            hall.lamp("tube", (x, y + 2.5, 2.36), (0.07, 1.25, 0.05))
    hall.rectangle("exit sign", (-3.2, y1 - 0.03, 2.0), (0.5, 0, 0), (0, 0, 0.18))
    hall.rectangle("housing", (-3.25, y1 - 0.02, 1.95), (0.6, 0, 0), (0, 0, 0.28))
    hall.write("garage", {"type": "constant", "luminance": 0.01})


def tunnel():
    """The last stretch of a road tunnel: faint lamps, and daylight 60 m ahead."""
    hall = Hall()
    x0, x1, y0, y1, z1 = -5.5, 1.48, -60.0, 60.0, 5.0
    hall.rectangle("road", (x0, y0, 0.012), (x1 - x0, 0, 0), (0, y1 - y0, 0))
    for y in np.arange(y0 + 2, y1, 8.0):
        hall.rectangle("floor paint", (-2.06, y, 0.014), (0.12, 0, 0), (0, 3.0, 0))
    hall.rectangle("concrete dark", (x0, y0, z1), (0, y1 - y0, 0), (x1 - x0, 0, 0))
    hall.rectangle("night", (x1, y0, 0), (x0 - x1, 0, 0), (0, 0, z1))
    for name, low, high in (("concrete dark", 0.0, 0.5), ("lining", 0.5, 2.8),
                            ("concrete dark", 2.8, z1)):
        for x, way in ((x0, 1), (x1, -1)):
            hall.rectangle(name, (x, y0 if way < 0 else y1, low), (0, way * (y0 - y1), 0),
                           (0, 0, high - low))
    for y in np.arange(y0 + 4, y1 - 10, 10.0):
        for x in (x0 + 0.9, x1 - 0.9):
            hall.lamp("tunnel lamp", (x, y, 4.75), (0.18, 1.1, 0.12))
    # what stands over the tunnel, so that no light falls in beside the portal
    for low, high in (((-40, y0, 5.2), (40, y1, 9.0)), ((x0 - 12, y0, 0), (x0 - 0.1, y1, 9.0)),
                      ((x1 + 4.5, y0, 0), (x1 + 12, y1, 9.0))):
        hall.box("concrete", low, high)
    hall.write("tunnel_exit", {"type": "sky", "when": "2026-06-21T12:20+02:00",
                               "where": [48.14, 11.58, 520], "heading_deg": 0})


if __name__ == "__main__":
    garage()
    tunnel()
