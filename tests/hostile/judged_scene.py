# SPDX-License-Identifier: Apache-2.0
"""judged_scene.py -- a small display with two symbols and an eye before it, for reviews that
take a second."""
import json
import os
import shutil
import struct
import zlib

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
WIDTH, HEIGHT = 64, 32
SYMBOLS = {"bar": [0.05, 0.2, 0.45, 0.8], "letter": [0.55, 0.1, 0.95, 0.9]}


def content():
    """A filled bar, and an H of strokes an eighth as wide as it is high."""
    rows = [[0] * WIDTH for _ in range(HEIGHT)]
    for y in range(10, 22):
        for x in range(8, 24):
            rows[y][x] = 255
    for y in range(8, 24):
        for x in range(42, 54):
            if x < 44 or x >= 52 or 15 <= y < 17:
                rows[y][x] = 255
    raw = b"".join(b"\0" + bytes(row) for row in rows)

    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data +
                struct.pack(">I", zlib.crc32(kind + data)))
    return (b"\x89PNG\r\n\x1a\n" +
            chunk(b"IHDR", struct.pack(">IIBBBBB", WIDTH, HEIGHT, 8, 0, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b""))


PANEL = os.path.join(ROOT, "assets/panels/ips_cluster.panel")


def write_scene(folder, things=(), panel=PANEL):
    """A display of 0.2 x 0.1 m that faces an eye 0.7 m away. things: (material, place, scale)
    of plates that are as the display is."""
    x, y = 0.1, 0.05
    points = struct.pack("<12f", -x, -y, 0, x, -y, 0, x, y, 0, -x, y, 0)
    uv = struct.pack("<8f", 0, 1, 1, 1, 1, 0, 0, 0)
    data = points + uv + struct.pack("<6H", 0, 1, 2, 0, 2, 3)
    open(os.path.join(folder, "data.bin"), "wb").write(data)
    open(os.path.join(folder, "content.png"), "wb").write(content())
    shutil.copy(panel, os.path.join(folder, "display.panel"))
    views = [(0, len(points)), (len(points), len(uv)), (len(points) + len(uv), 12)]
    scene = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0, "name": "display"},
                  {"name": "eye", "camera": 0, "translation": [0.02, 0.01, 0.7]}],
        "cameras": [{"type": "perspective",
                     "perspective": {"yfov": 0.3, "znear": 0.01, "aspectRatio": 2}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1},
                                    "indices": 2, "material": 0}]}],
        "images": [{"uri": "content.png"}], "samplers": [{"magFilter": 9728}],
        "textures": [{"source": 0, "sampler": 0}],
        "materials": [{"name": "screen", "extensions": {"PARHELION_display": {
            "panel": "display.panel", "content": {"index": 0}, "level": 1}}}],
        "extensionsUsed": ["PARHELION_display"],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
             "min": [-x, -y, 0], "max": [x, y, 0]},
            {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"},
            {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteOffset": at, "byteLength": size}
                        for at, size in views],
        "buffers": [{"uri": "data.bin", "byteLength": len(data)}]}
    for i, (material, place, scale) in enumerate(things):
        scene["scenes"][0]["nodes"].append(len(scene["nodes"]))
        scene["nodes"].append({"name": f"plate {i}", "mesh": 1 + i, "translation": place,
                               "scale": [scale] * 3})
        scene["meshes"].append({"primitives": [{"attributes": {"POSITION": 0}, "indices": 2,
                                                "material": 1 + i}]})
        scene["materials"].append({"doubleSided": True, **material})
    json.dump(scene, open(os.path.join(folder, "scene.gltf"), "w"))


def request(conditions, levels, symbols=SYMBOLS):
    return {"title": "judged", "scene": ["scene.gltf"], "eyes": {"eye": {"camera": "eye"}},
            "symbols": {name: {"display": "screen", "uv": SYMBOLS[name],
                               "polarity": "light-on-dark"} for name in symbols},
            "profile": "iso-15008", "levels": {k: {"*": v} for k, v in levels.items()},
            "precision": {"contrast": 0.01, "paths": 65536}, "frames": {"worst": 0},
            "conditions": [{"name": name, "level": level,
                            "environment": {"type": "constant", "luminance": light}}
                           for name, (level, light) in conditions.items()]}
