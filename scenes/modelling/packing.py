# SPDX-License-Identifier: Apache-2.0
"""Meshes as the buffer of a glTF, without Blender."""
import json

import numpy as np

WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}


def gltf_axes(points):
    """x right, y forward, z up become glTF's x, y up, -z forward."""
    return np.stack([points[..., 0], points[..., 2], -points[..., 1]], -1)


class Packing:
    """Accessors of one buffer, and the primitives made of them."""

    def __init__(self):
        self.data, self.views, self.accessors = b"", [], []

    def add(self, array, kind, target, component, **more):
        self.views.append({"buffer": 0, "byteOffset": len(self.data),
                           "byteLength": array.nbytes, "target": target})
        self.accessors.append({"bufferView": len(self.views) - 1, "componentType": component,
                               "count": array.size // WIDTHS[kind], "type": kind, **more})
        self.data += array.tobytes() + b"\0" * (-array.nbytes % 4)
        return len(self.accessors) - 1

    def primitive(self, material, points, normals, faces, coordinates=None):
        """points, normals (n, 3) in the modelling frame; faces (n, 3); coordinates (n, 2)."""
        points = gltf_axes(points).astype("<f4")
        attributes = {
            "POSITION": self.add(points, "VEC3", 34962, 5126, min=points.min(0).tolist(),
                                 max=points.max(0).tolist()),
            "NORMAL": self.add(gltf_axes(normals).astype("<f4"), "VEC3", 34962, 5126)}
        if coordinates is not None:
            attributes["TEXCOORD_0"] = self.add(coordinates.astype("<f4"), "VEC2", 34962, 5126)
        indices = self.add(faces.astype("<u2").reshape(-1), "SCALAR", 34963, 5123)
        return {"attributes": attributes, "indices": indices, "material": material}

    def write(self, path, document, uri):
        """The glTF at `path` and its buffer beside it."""
        document = {**document, "accessors": self.accessors, "bufferViews": self.views,
                    "buffers": [{"uri": uri, "byteLength": len(self.data)}]}
        with open(path[:-len(".gltf")] + ".bin", "wb") as file:
            file.write(self.data)
        with open(path, "w", encoding="utf-8") as file:
            json.dump(document, file, indent=1)
            file.write("\n")
