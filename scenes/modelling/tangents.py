# SPDX-License-Identifier: Apache-2.0
"""Tangents for brushed surfaces: glTF tells the grooves' direction from them."""
import os

import numpy as np

WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}
TYPES = {5121: "u1", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
ARRAY_BUFFER = 34962


def values(gltf, data, index):
    """An accessor of a file that Blender wrote: packed, from the start of its view."""
    accessor = gltf["accessors"][index]
    view = gltf["bufferViews"][accessor["bufferView"]]
    width = WIDTHS[accessor["type"]]
    flat = np.frombuffer(
        data, TYPES[accessor["componentType"]], accessor["count"] * width, view["byteOffset"]
    )
    return flat.reshape(-1, width).astype(float)


def unit(vectors):
    return vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-12)


def across(normals):
    """Some direction in the surface, for a vertex that has none of its own."""
    axis = np.eye(3)[np.argmin(abs(normals), axis=1)]
    return unit(np.cross(normals, axis))


def tangents(positions, normals, coordinates, corners):
    """(n, 4): where u grows, weighted by the triangles' areas, and the bitangent's sense."""
    p, t = positions[corners], coordinates[corners]
    e, f = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    eu, fu = t[:, 1] - t[:, 0], t[:, 2] - t[:, 0]
    area = eu[:, 0] * fu[:, 1] - fu[:, 0] * eu[:, 1]  # in coordinates; v runs down
    along = unit((e * fu[:, 1:] - f * eu[:, 1:]) * np.sign(area)[:, None])
    along *= np.linalg.norm(np.cross(e, f), axis=1)[:, None]
    sums, senses = np.zeros_like(normals), np.zeros(len(normals))
    for k in range(3):
        np.add.at(sums, corners[:, k], along)
        np.add.at(senses, corners[:, k], area)
    sums -= normals * (sums * normals).sum(1)[:, None]
    lost = np.linalg.norm(sums, axis=1) < 1e-12
    flat = np.where(lost[:, None], across(normals), unit(sums))
    return np.column_stack([flat, np.where(senses > 0, -1.0, 1.0)])


def add_tangents(gltf, path, brushed):
    """Appends TANGENT to the primitives of `brushed` (names of materials) and their bytes to
    the buffer beside the glTF at `path`."""
    ids = {i for i, m in enumerate(gltf.get("materials", [])) if m["name"] in brushed}
    wanted = [
        p for m in gltf.get("meshes", []) for p in m["primitives"] if p.get("material") in ids
    ]
    if not wanted:
        return
    buffer = gltf["buffers"][0]
    place = os.path.join(os.path.dirname(path), buffer["uri"])
    with open(place, "rb") as file:
        data = file.read()
    for primitive in wanted:
        at = primitive["attributes"]
        arrays = [values(gltf, data, at[k]) for k in ("POSITION", "NORMAL", "TEXCOORD_0")]
        corners = values(gltf, data, primitive["indices"]).astype(int).reshape(-1, 3)
        found = tangents(*arrays, corners).astype("<f4")
        data += b"\0" * (-len(data) % 4)
        gltf["bufferViews"].append(
            {"buffer": 0, "byteLength": found.nbytes, "byteOffset": len(data),
             "target": ARRAY_BUFFER}
        )
        gltf["accessors"].append(
            {"bufferView": len(gltf["bufferViews"]) - 1, "componentType": 5126,
             "count": len(found), "type": "VEC4"}
        )
        at["TANGENT"] = len(gltf["accessors"]) - 1
        data += found.tobytes()
    buffer["byteLength"] = len(data)
    with open(place, "wb") as file:
        file.write(data)
