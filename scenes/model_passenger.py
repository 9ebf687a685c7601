#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the car's passenger screen: car_passenger.gltf (.bin) beside itself.

    python3 scenes/model_passenger.py

Needs numpy; no Blender. An overlay to be named beside car_dashboard.gltf: a display of 12
inches that stands before the pad on the passenger's side, and shows what the centre one shows.
"""
import os
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "modelling"))

from packing import Packing  # noqa: E402

MIDDLE = np.array([0.37, 0.68, 1.05])  # m: x right, y ahead, z up
SIZE = np.array([0.2640, 0.1485])      # m, of the active area, 16:9 as its content
LEAN_DEG = 12.0                        # its upper edge leans back
RIM, DEPTH = 0.007, 0.012              # m, of the housing
RIGHT = np.array([1.0, 0, 0])
UP = np.array([0, np.sin(np.radians(LEAN_DEG)), np.cos(np.radians(LEAN_DEG))])
FRONT = np.cross(RIGHT, UP)            # to the passenger
CORNERS = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
FACES = np.array([(0, 1, 2), (0, 2, 3)])


def rectangle(middle, right, up):
    """Four corners about the middle, seen from right x up."""
    points = np.array([middle + x * right + y * up for x, y in CORNERS])
    normal = np.cross(right, up)
    return points, np.tile(normal / np.linalg.norm(normal), (4, 1)), FACES


def joined(parts):
    points, normals = (np.concatenate([part[k] for part in parts]) for k in range(2))
    return points, normals, np.concatenate([FACES + 4 * i for i in range(len(parts))])


def housing():
    """A box whose front lies half a millimetre behind the active area."""
    half = [(0.5 * SIZE[0] + RIM) * RIGHT, (0.5 * SIZE[1] + RIM) * UP, 0.5 * DEPTH * FRONT]
    middle = MIDDLE - half[2] - 0.0005 * FRONT
    sides = []
    for k in range(3):
        out, right, up = half[k], half[(k + 1) % 3], half[(k + 2) % 3]
        sides += [rectangle(middle + out, right, up), rectangle(middle - out, up, right)]
    return joined(sides)


def document(packing):
    coordinates = np.array([(0.5 + 0.5 * x, 0.5 - 0.5 * y) for x, y in CORNERS])
    screen = rectangle(MIDDLE, 0.5 * SIZE[0] * RIGHT, 0.5 * SIZE[1] * UP)
    names = ["passenger housing", "passenger screen"]
    primitives = [packing.primitive(0, *housing()), packing.primitive(1, *screen, coordinates)]
    return {
        "asset": {"version": "2.0", "generator": "model_passenger.py of Parhelion"},
        "extensionsUsed": ["PARHELION_display"],
        "scene": 0,
        "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"name": name, "mesh": i} for i, name in enumerate(names)],
        "meshes": [{"name": name, "primitives": [p]} for name, p in zip(names, primitives)],
        "materials": [
            {"name": "passenger housing", "pbrMetallicRoughness": {
                "baseColorFactor": [0.02, 0.02, 0.022, 1.0], "metallicFactor": 0.0,
                "roughnessFactor": 0.4}},
            {"name": "passenger", "pbrMetallicRoughness": {
                "baseColorFactor": [0.0, 0.0, 0.0, 1.0], "metallicFactor": 0.0,
                "roughnessFactor": 0.1},
             "emissiveTexture": {"index": 0}, "emissiveFactor": [1.0, 1.0, 1.0],
             "extensions": {"PARHELION_display": {
                 "panel": "../assets/panels/oled_centre.panel",
                 "content": {"index": 0, "texCoord": 0}, "level": 1.0}}}],
        "textures": [{"source": 0, "sampler": 0}],
        "images": [{"uri": "../assets/content/centre.png", "name": "centre"}],
        "samplers": [{"magFilter": 9728, "minFilter": 9728, "wrapS": 33071, "wrapT": 33071}],
    }


def main():
    packing = Packing()
    document_made = document(packing)
    packing.write(os.path.join(HERE, "car_passenger.gltf"), document_made, "car_passenger.bin")


if __name__ == "__main__":
    main()
