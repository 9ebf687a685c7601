#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the car's head-up display: car_hud.gltf (.bin) beside itself and what it shows,
assets/content/hud.png.

    python3 scenes/model_hud.py [--figures]     (prints its figures, and makes nothing)

Needs numpy, and to make it python3-cairo and the font Inter; no Blender. An overlay: its mirror
and picture lie in the well of car_dashboard.gltf's pad, whose windscreen throws the picture at
the driver. The optics: modelling/hud_optics.py.
"""
import os
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "modelling"))

from hud_optics import EYE, FIELD, Optics, dot, on_image, sight, unit  # noqa: E402
from packing import Packing  # noqa: E402
from textures import write_png  # noqa: E402

SIZE, PIXELS = (0.0360, 0.0228), (1080, 684)  # m, of the picture's active area
MIRROR_STEPS = (121, 81)  # points along and up the mirror
SMALL = {"magFilter": 9728, "minFilter": 9728, "wrapS": 33071, "wrapT": 33071}


def mirror_mesh(optics):
    """Points, normals and triangles; fronts look at the light."""
    (u0, u1), (v0, v1) = optics.patch()
    u, v = np.meshgrid(np.linspace(u0, u1, MIRROR_STEPS[0]),
                       np.linspace(v0, v1, MIRROR_STEPS[1]))
    rows, columns = u.shape
    first = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).reshape(-1)
    faces = np.concatenate([np.stack([first, first + 1, first + columns], -1),
                            np.stack([first + 1, first + columns + 1, first + columns], -1)])
    points = optics.mirror(u, v).reshape(-1, 3)
    normals = optics.mirror_normal(u, v).reshape(-1, 3)
    a, b, c = (points[faces[:, k]] for k in range(3))
    if dot(np.cross(b - a, c - a), normals[faces[:, 0]]).mean() < 0:
        faces = faces[:, ::-1]
    return points, normals, faces


def picture_mesh(optics):
    """A quad; texture coordinates run to the right and down for who faces it."""
    corners = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    points = np.array([optics.picture + 0.5 * x * SIZE[0] * optics.right +
                       0.5 * y * SIZE[1] * optics.up for x, y in corners])
    coordinates = np.array([(0.5 + 0.5 * x, 0.5 - 0.5 * y) for x, y in corners])
    return points, np.tile(optics.facing, (4, 1)), np.array([(0, 1, 2), (0, 2, 3)]), coordinates


def fit_angles(optics):
    """(right, up) in metres on the picture -> (right, up) in degrees for an eye in the middle
    of the box: a polynomial of the fifth degree through sights of the whole field."""
    right, up = np.meshgrid(np.linspace(-0.54, 0.54, 41) * FIELD[0],
                            np.linspace(-0.54, 0.54, 21) * FIELD[1])
    place = optics.on_picture(EYE, sight(right, up)) / SIZE[0]

    def terms(x, y):
        return np.stack([x**i * y**j for i in range(6) for j in range(6 - i)], -1)
    columns = terms(place[..., 0], place[..., 1]).reshape(right.size, -1)
    fits = [np.linalg.lstsq(columns, angle.ravel(), rcond=None)[0] for angle in (right, up)]
    left = max(np.abs(columns @ fit - angle.ravel()).max()
               for fit, angle in zip(fits, (right, up)))
    print(f"the warp is met within {60 * left:.2f} minutes of arc")
    return lambda x, y: tuple(terms(x / SIZE[0], y / SIZE[0]) @ fit for fit in fits)


MATERIALS = [
    {"name": "hud mirror", "doubleSided": True, "pbrMetallicRoughness": {
        "baseColorFactor": [0.92, 0.92, 0.92, 1.0], "metallicFactor": 1.0,
        "roughnessFactor": 0.0}},
    {"name": "hud", "pbrMetallicRoughness": {
        "baseColorFactor": [0.0, 0.0, 0.0, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.1},
     "emissiveTexture": {"index": 0}, "emissiveFactor": [1.0, 1.0, 1.0],
     "extensions": {
         "KHR_materials_emissive_strength": {"emissiveStrength": 80000.0},
         "PARHELION_display": {"panel": "../assets/panels/hud_pgu.panel",
                               "content": {"index": 0, "texCoord": 0}, "level": 1.0}}},
]


CAMERA_DEG = 6.0  # height of what the camera "hud" sees


def camera_node():
    """At the middle of the eye box, towards that of the picture; glTF's up is y."""
    right, ahead, up = sight(0, 0)
    yaw, pitch = -np.arctan2(right, ahead) / 2, np.arcsin(up) / 2
    turn = [np.cos(yaw) * np.sin(pitch), np.sin(yaw) * np.cos(pitch),
            -np.sin(yaw) * np.sin(pitch), np.cos(yaw) * np.cos(pitch)]
    return {"name": "hud", "camera": 0, "translation": [EYE[0], EYE[2], -EYE[1] + 0.0],
            "rotation": [round(float(part), 9) + 0.0 for part in turn]}


def document(optics, packing):
    primitives = [packing.primitive(0, *mirror_mesh(optics)),
                  packing.primitive(1, *picture_mesh(optics))]
    names = ["head-up mirror", "head-up picture"]
    return {
        "asset": {"version": "2.0", "generator": "model_hud.py of Parhelion"},
        "extensionsUsed": ["KHR_materials_emissive_strength", "PARHELION_display"],
        "scene": 0,
        "scenes": [{"nodes": [0, 1, 2]}],
        "nodes": [*({"name": name, "mesh": i} for i, name in enumerate(names)), camera_node()],
        "cameras": [{"name": "hud", "type": "perspective", "perspective": {
            "aspectRatio": 16 / 9, "yfov": float(np.radians(CAMERA_DEG)), "znear": 0.01}}],
        "meshes": [{"name": name, "primitives": [p]} for name, p in zip(names, primitives)],
        "materials": MATERIALS,
        "textures": [{"source": 0, "sampler": 0}],
        "images": [{"uri": "../assets/content/hud.png", "name": "hud"}],
        "samplers": [SMALL],
    }


def report(optics):
    eyes = [(dx, dz) for dx in (-0.0325, 0, 0.0325) for dz in (-0.02, 0, 0.02)]
    right, up = np.meshgrid(np.linspace(-0.5, 0.5, 5) * FIELD[0],
                            np.linspace(-0.5, 0.5, 3) * FIELD[1])
    seen = optics.on_picture(EYE, sight(right, up))
    target = on_image(right, up)
    per_degree = np.abs(optics.on_picture(EYE, sight(0.5, 0.5)) -
                        optics.on_picture(EYE, sight(-0.5, -0.5)))
    moved = []
    for dx, dz in eyes:
        eye = EYE + np.array([dx, 0, dz])
        moved.append(60 * (optics.on_picture(eye, unit(target - eye)) - seen) / per_degree)
    moved = np.hypot(*np.moveaxis(np.array(moved), -1, 0))
    image, glass = optics.ghost(), optics.wedge()
    beside, _ = optics.ghost(glass)
    behind = np.linalg.norm(optics.virtual - optics.surface(*optics.middle))
    print(f"angle at the windscreen {optics.incidence:.2f} degrees, the image {behind:.3f} m "
          f"behind it; s on the picture "
          f"{optics.s_azimuth:.2f} degrees; swimming of the picture: middle "
          f"{moved[:, 1, 2].max():.2f}, median {np.median(moved):.1f}, at the corners "
          f"{moved.max():.1f} minutes; ghost without a wedge {image[0]:.2f}, {image[1]:.2f} "
          f"minutes; wedge {1e3 * glass:.3f} mrad, which leaves {beside:.2f} minutes sideways")


def main():
    optics, packing = Optics(), Packing()
    report(optics)
    if "--figures" in sys.argv:
        return
    from hud_content import bent, driver_view
    picture = bent(driver_view(FIELD), FIELD, fit_angles(optics), SIZE, PIXELS)
    write_png(os.path.join(HERE, "..", "assets", "content", "hud.png"), picture)
    path = os.path.join(HERE, "car_hud.gltf")
    packing.write(path, document(optics, packing), "car_hud.bin")


if __name__ == "__main__":
    main()
