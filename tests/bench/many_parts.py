# SPDX-License-Identifier: Apache-2.0
"""many_parts.py OUT.glb TRIANGLES [MOST] -- writes a store of parts as a large assembly has
them: boxes with hard edges, knobs, hoses and bent sheets, each a mesh of MOST / 1000 to MOST
(100,000) triangles with normals and texture coordinates, some of them placed several times;
twelve materials (paint, metal, clear solids, a mask, a normal map that asks for tangents, one
lamp), a floor, a uniform sky, a camera `eye`. TRIANGLES counts what the scene shows, instances
included; the file holds about three quarters of that. The same bytes for the same numbers.
Needs numpy (Debian's: /usr/bin/python3).
"""
import json
import struct
import sys
import zlib

import numpy

SHARED = 0.25         # of the triangles stand in instances behind a mesh's first
MOST = 100_000        # triangles of a mesh, evenly over the logarithm from a thousandth on
ROOM_M = (12.0, 4.0, 12.0)
SMALL = 65_535        # more vertices than this need four bytes an index


def grid(columns, rows):
    """Places (u, v) of a net of columns x rows squares, and its triangles."""
    v, u = numpy.mgrid[0:rows + 1, 0:columns + 1]
    uv = numpy.stack([u.ravel() / columns, v.ravel() / rows], axis=1)
    a = (numpy.arange(rows)[:, None] * (columns + 1) + numpy.arange(columns)).ravel()
    b, c, d = a + 1, a + columns + 2, a + columns + 1
    return uv, numpy.stack([a, b, c, a, c, d], axis=1).ravel()


def hose(uv, rng):
    """A tube that is bent into a ring of another radius."""
    bend, thick = rng.uniform(0.5, 0.9), rng.uniform(0.05, 0.3)
    a, b = 2 * numpy.pi * uv[:, 0], -2 * numpy.pi * uv[:, 1]
    normal = numpy.stack([numpy.cos(a) * numpy.cos(b), numpy.sin(b),
                          numpy.sin(a) * numpy.cos(b)], axis=1)
    ring = numpy.stack([numpy.cos(a), 0 * a, numpy.sin(a)], axis=1)
    return bend * ring + thick * normal, normal


def knob(uv, _):
    a, b = 2 * numpy.pi * uv[:, 0], numpy.pi * (uv[:, 1] - 0.5)
    normal = numpy.stack([numpy.cos(b) * numpy.cos(a), -numpy.sin(b),
                          numpy.cos(b) * numpy.sin(a)], axis=1)
    return normal * [1, 0.6, 1], unit(normal / [1, 0.6, 1])


def sheet(uv, rng):
    """A panel with two waves: heights and their slopes."""
    k, w = rng.uniform(2, 9, 2), rng.uniform(0.02, 0.1)
    x, z = 2 * uv[:, 0] - 1, 1 - 2 * uv[:, 1]
    y = w * numpy.sin(k[0] * x) * numpy.cos(k[1] * z)
    slope = [w * k[0] * numpy.cos(k[0] * x) * numpy.cos(k[1] * z),
             -w * k[1] * numpy.sin(k[0] * x) * numpy.sin(k[1] * z)]
    return (numpy.stack([x, y, z], axis=1),
            unit(numpy.stack([-slope[0], numpy.ones_like(x), -slope[1]], axis=1)))


def unit(v):
    return v / numpy.linalg.norm(v, axis=1, keepdims=True)


def boxes(count, rng):
    """Small boxes of 12 triangles with four vertices a side: hard edges, as machined parts."""
    side = numpy.array([[-1, -1], [1, -1], [1, 1], [-1, 1]], float)
    corners, normals = [], []
    for axis in range(3):
        for sign in (-1, 1):
            face = numpy.empty((4, 3))
            face[:, axis] = sign
            face[:, (axis + 1) % 3] = side[:, 0] * sign
            face[:, (axis + 2) % 3] = side[:, 1]
            corners.append(face)
            normals.append(numpy.eye(3)[axis] * sign + numpy.zeros((4, 3)))
    at, size = rng.uniform(-1, 1, (count, 1, 3)), rng.uniform(0.01, 0.05, (count, 1, 3))
    position = (at + size * numpy.concatenate(corners)).reshape(-1, 3)
    uv = numpy.tile((side + 1) / 2, (6 * count, 1))
    one = (numpy.arange(6)[:, None] * 4 + [0, 1, 2, 0, 2, 3]).ravel()
    index = (24 * numpy.arange(count)[:, None] + one).ravel()
    return position, numpy.tile(numpy.concatenate(normals), (count, 1)), uv, index


def shape(triangles, rng):
    """(positions, normals, uv, indices) of about so many triangles."""
    kind = rng.integers(4)
    if kind == 3:
        return boxes(max(1, round(triangles / 12)), rng)
    columns = max(4, round((triangles / 2) ** 0.5 * rng.uniform(0.7, 1.4)))
    uv, index = grid(columns, max(2, round(triangles / 2 / columns)))
    position, normal = (hose, knob, sheet)[kind](uv, rng)
    return position, normal, uv * 4, index


class Writer:
    """The binary chunk, and the document that describes it."""

    def __init__(self):
        self.parts, self.size = [], 0
        self.views, self.accessors, self.meshes, self.nodes = [], [], [], []

    def view(self, data, **more):
        data += bytes(-len(data) % 4)
        self.views.append({"buffer": 0, "byteOffset": self.size, "byteLength": len(data),
                           **more})
        self.parts.append(data)
        self.size += len(data)
        return len(self.views) - 1

    def accessor(self, values, kind, component, target):
        accessor = {"bufferView": self.view(values.tobytes(), target=target),
                    "componentType": component, "type": kind, "count": len(values)}
        if target == 34962 and kind == "VEC3":
            accessor["min"] = values.min(axis=0).tolist()
            accessor["max"] = values.max(axis=0).tolist()
        self.accessors.append(accessor)
        return len(self.accessors) - 1

    def mesh(self, form, material):
        position, normal, uv, index = form
        floats = [numpy.ascontiguousarray(a, "<f4") for a in (position, normal, uv)]
        wide = len(position) > SMALL
        attributes = {"POSITION": self.accessor(floats[0], "VEC3", 5126, 34962),
                      "NORMAL": self.accessor(floats[1], "VEC3", 5126, 34962),
                      "TEXCOORD_0": self.accessor(floats[2], "VEC2", 5126, 34962)}
        indices = self.accessor(index.astype("<u4" if wide else "<u2"), "SCALAR",
                                5125 if wide else 5123, 34963)
        self.meshes.append({"name": f"mesh {len(self.meshes)}", "primitives": [
            {"attributes": attributes, "indices": indices, "material": material}]})
        return len(self.meshes) - 1

    def place(self, mesh, rng):
        at = rng.uniform([-0.5, 0, -0.5], [0.5, 1, 0.5]) * ROOM_M
        turn = rng.normal(size=4)
        turn /= numpy.linalg.norm(turn)
        self.nodes.append({"name": f"part {len(self.nodes)}", "mesh": mesh,
                           "translation": at.tolist(), "rotation": turn.tolist(),
                           "scale": [float(rng.uniform(0.05, 0.25))] * 3})


def materials():
    paints = [{"name": f"paint {i}", "pbrMetallicRoughness": {
        "baseColorFactor": [0.2 + 0.1 * i, 0.5, 0.8 - 0.1 * i, 1], "metallicFactor": 0,
        "roughnessFactor": 0.3 + 0.1 * i}} for i in range(5)]
    metals = [{"name": f"metal {i}", "pbrMetallicRoughness": {
        "baseColorFactor": [0.9, 0.9 - 0.1 * i, 0.9 - 0.2 * i, 1],
        "roughnessFactor": 0.2 + 0.1 * i}} for i in range(2)]
    clear = {"name": "clear", "pbrMetallicRoughness": {"metallicFactor": 0,
                                                       "roughnessFactor": 0},
             "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1},
                            "KHR_materials_volume": {"thicknessFactor": 0.01}}}
    hide = {"name": "leather", "normalTexture": {"index": 0},
            "pbrMetallicRoughness": {"baseColorFactor": [0.3, 0.2, 0.1, 1],
                                     "metallicFactor": 0}}
    print_ = {"name": "printed", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0},
                                                          "metallicFactor": 0}}
    mesh = {"name": "mesh", "alphaMode": "MASK", "pbrMetallicRoughness": {
        "baseColorTexture": {"index": 1}, "metallicFactor": 0}}
    lamp = {"name": "lamp", "emissiveFactor": [1, 1, 1], "extensions": {
        "KHR_materials_emissive_strength": {"emissiveStrength": 500}},
        "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]}}
    return paints + metals + [clear, hide, print_, mesh, lamp]


LAMP = 11


def png(pixels):
    """8 bits a channel, rows without a filter."""
    height, width, channels = pixels.shape
    rows = b"".join(b"\0" + row.tobytes() for row in pixels)

    def chunk(name, data):
        return (struct.pack(">I", len(data)) + name + data +
                struct.pack(">I", zlib.crc32(name + data)))
    head = struct.pack(">IIBBBBB", width, height, 8, {3: 2, 4: 6}[channels], 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows)) +
            chunk(b"IEND", b""))


def pictures():
    """A bumpy normal map, and dots with holes between them."""
    y, x = numpy.mgrid[0:64, 0:64] * (2 * numpy.pi / 64)
    normal = unit(numpy.stack([0.3 * numpy.cos(2 * x).ravel(), 0.3 * numpy.sin(2 * y).ravel(),
                               numpy.ones(64 * 64)], axis=1)).reshape(64, 64, 3)
    dots = numpy.full((64, 64, 4), 200, "u1")
    dots[..., 3] = numpy.where(numpy.sin(4 * x) * numpy.sin(4 * y) > -0.4, 255, 0)
    return [png(numpy.round(127.5 * normal + 127.5).astype("u1")), png(dots)]


def fill(writer, wanted, most, rng):
    """Meshes and their places until so many triangles are shown; returns how many are."""
    shown, least, number = 2, max(12, most / 1000), 0
    while wanted - shown >= least:
        left = wanted - shown
        size = min(numpy.exp(rng.uniform(numpy.log(least), numpy.log(most))), wanted / 8, left)
        chosen = int(rng.choice(12, p=[0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.05, 0.15, 0.05,
                                       0.05, 0]))
        if number == 0:
            chosen, size = LAMP, least
        mesh = writer.mesh(shape(size, rng), chosen)
        count = writer.accessors[-1]["count"] // 3
        again = int(rng.geometric(0.5)) if rng.random() < SHARED * 0.67 else 0
        for _ in range(1 + min(again, max(0, int(left / count) - 1))):
            writer.place(mesh, rng)
            shown += count
        number += 1
    return shown


def document(wanted, most):
    writer, rng = Writer(), numpy.random.Generator(numpy.random.PCG64(1))
    images = [writer.view(data) for data in pictures()]
    uv, index = grid(1, 1)
    x, _, z = ROOM_M
    floor = numpy.stack([(uv[:, 0] - 0.5) * x, 0 * uv[:, 0], (0.5 - uv[:, 1]) * z], axis=1)
    writer.mesh((floor, numpy.tile([0., 1, 0], (4, 1)), uv, index), 0)
    writer.nodes.append({"name": "floor", "mesh": 0})
    shown = fill(writer, wanted, most, rng)
    writer.nodes.append({"name": "eye", "camera": 0, "translation": [0, 2, 7]})
    return b"".join(writer.parts), shown, {
        "asset": {"version": "2.0", "generator": "many_parts.py"}, "scene": 0,
        "scenes": [{"nodes": list(range(len(writer.nodes))), "extensions": {
            "PARHELION_environment": {"type": "constant", "luminance": 5000}}}],
        "nodes": writer.nodes, "meshes": writer.meshes, "materials": materials(),
        "textures": [{"source": i} for i in range(2)],
        "images": [{"bufferView": view, "mimeType": "image/png"} for view in images],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.9, "znear": 0.01}}],
        "extensionsUsed": ["KHR_materials_emissive_strength", "KHR_materials_transmission",
                           "KHR_materials_volume", "PARHELION_environment"],
        "accessors": writer.accessors, "bufferViews": writer.views,
        "buffers": [{"byteLength": writer.size}]}


def main():
    data, shown, scene = document(int(sys.argv[2]), int(sys.argv[3]) if len(sys.argv) > 3
                                  else MOST)
    text = json.dumps(scene).encode()
    text += b" " * (-len(text) % 4)
    with open(sys.argv[1], "wb") as file:
        file.write(struct.pack("<III", 0x46546C67, 2, 28 + len(text) + len(data)))
        file.write(struct.pack("<II", len(text), 0x4E4F534A) + text)
        file.write(struct.pack("<II", len(data), 0x004E4942) + data)
    print(f"{sys.argv[1]}: {shown} triangles, {len(scene['meshes'])} meshes in "
          f"{len(scene['nodes'])} nodes, {(28 + len(text) + len(data)) / 1e6:.0f} MB")


if __name__ == "__main__":
    main()
