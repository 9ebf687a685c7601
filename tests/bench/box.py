# SPDX-License-Identifier: Apache-2.0
"""box.py OUT.gltf [CELLS] -- writes an interior of about a million triangles: a room of
6 x 3 x 5 m whose Lambertian walls are bumpy everywhere, one window to a uniform sky, one panel
of light under the ceiling, a camera named `eye`. Beside it goes OUT.bin. Standard library only.
"""
import array
import json
import math
import os
import sys

SIZE = (6.0, 3.0, 5.0)  # m
CELLS = 294             # squares along each side of a wall
BUMP = 0.01             # m
WINDOW = (0.3, 0.7, 0.35, 0.85)  # part of the wall at -Z: u from, u to, v from, v to


def bump(u, v, wall):
    """Metres into the room, the same for every run: waves of four lengths, none at the edge."""
    edge = min(1.0, 20 * u, 20 * (1 - u), 20 * v, 20 * (1 - v))
    waves = sum(math.sin(k * (17.0 * u + 3.1 * wall) + k * k) * math.cos(k * 13.0 * v - wall)
                for k in (1, 2.7, 5.9, 11.3))
    return BUMP * edge * waves / 2


def walls():
    """(corner, right, up, into the room) of the six walls."""
    x, y, z = SIZE
    return [((0, 0, 0), (x, 0, 0), (0, y, 0), (0, 0, 1)),
            ((x, 0, z), (-x, 0, 0), (0, y, 0), (0, 0, -1)),
            ((0, 0, z), (0, 0, -z), (0, y, 0), (1, 0, 0)),
            ((x, 0, 0), (0, 0, z), (0, y, 0), (-1, 0, 0)),
            ((0, 0, z), (x, 0, 0), (0, 0, -z), (0, 1, 0)),
            ((0, y, 0), (x, 0, 0), (0, 0, z), (0, -1, 0))]


def wall_vertices(wall, cells, index):
    corner, right, up, inwards = wall
    vertices = array.array("f")
    for j in range(cells + 1):
        for i in range(cells + 1):
            u, v = i / cells, j / cells
            h = bump(u, v, index)
            vertices.extend(corner[k] + u * right[k] + v * up[k] + h * inwards[k]
                            for k in range(3))
    return vertices


def wall_indices(cells, has_window):
    indices, row = array.array("I"), cells + 1
    for j in range(cells):
        for i in range(cells):
            u, v = (i + 0.5) / cells, (j + 0.5) / cells
            if has_window and WINDOW[0] < u < WINDOW[1] and WINDOW[2] < v < WINDOW[3]:
                continue
            a = j * row + i
            indices.extend((a, a + 1, a + row + 1, a, a + row + 1, a + row))
    return indices


class Buffer:
    """The binary file and the descriptions of what lies in it."""

    def __init__(self):
        self.data, self.views, self.accessors = bytearray(), [], []

    def add(self, values, kind, component, width):
        accessor = {"bufferView": len(self.views), "componentType": component, "type": kind,
                    "count": len(values) // width}
        if kind == "VEC3":
            accessor["min"] = [min(values[k::3]) for k in range(3)]
            accessor["max"] = [max(values[k::3]) for k in range(3)]
        self.views.append({"buffer": 0, "byteOffset": len(self.data),
                           "byteLength": 4 * len(values)})
        self.data += values.tobytes()
        self.accessors.append(accessor)
        return len(self.accessors) - 1


def primitive(buffer, vertices, indices, material):
    return {"attributes": {"POSITION": buffer.add(vertices, "VEC3", 5126, 3)},
            "indices": buffer.add(indices, "SCALAR", 5125, 1), "material": material}


def materials():
    matte = {"KHR_materials_specular": {"specularFactor": 0}}
    paint = [{"pbrMetallicRoughness": {"baseColorFactor": color + [1], "metallicFactor": 0},
              "extensions": matte} for color in ([0.7, 0.68, 0.64], [0.35, 0.33, 0.3])]
    lamp = {"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0},
            "emissiveFactor": [1, 1, 1], "extensions": {
                **matte, "KHR_materials_emissive_strength": {"emissiveStrength": 2000}}}
    return paint + [lamp]


def document(cells, name):
    buffer, primitives = Buffer(), []
    for index, wall in enumerate(walls()):
        primitives.append(primitive(buffer, wall_vertices(wall, cells, index),
                                    wall_indices(cells, index == 0), 1 if index == 4 else 0))
    y, half = SIZE[1] - 0.05, 0.6
    corners = [(x, y, z) for x, z in ((3 - half, 2.5 - 0.3), (3 + half, 2.5 - 0.3),
                                      (3 + half, 2.5 + 0.3), (3 - half, 2.5 + 0.3))]
    panel = array.array("f", [value for corner in corners for value in corner])
    primitives.append(primitive(buffer, panel, array.array("I", (0, 1, 2, 0, 2, 3)), 2))
    angle = math.radians(-8) / 2
    return buffer.data, {
        "asset": {"version": "2.0"}, "scene": 0, "materials": materials(),
        "meshes": [{"primitives": primitives}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.01}}],
        "nodes": [{"mesh": 0}, {"name": "eye", "camera": 0, "translation": [3, 1.6, 4.6],
                                "rotation": [math.sin(angle), 0, 0, math.cos(angle)]}],
        "scenes": [{"nodes": [0, 1], "extensions": {"PARHELION_environment": {
            "type": "constant", "luminance": 5000, "color": [0.8, 0.9, 1]}}}],
        "extensionsUsed": ["KHR_materials_emissive_strength", "KHR_materials_specular",
                           "PARHELION_environment"],
        "accessors": buffer.accessors, "bufferViews": buffer.views,
        "buffers": [{"uri": name, "byteLength": len(buffer.data)}]}


def main():
    out = sys.argv[1]
    cells = int(sys.argv[2]) if len(sys.argv) > 2 else CELLS
    binary = os.path.splitext(out)[0] + ".bin"
    data, scene = document(cells, os.path.basename(binary))
    with open(binary, "wb") as file:
        file.write(data)
    with open(out, "w", encoding="utf-8") as file:
        json.dump(scene, file)


if __name__ == "__main__":
    main()
