#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Models the people of the two interiors and writes their glTF files beside itself.

    python3 scenes/model_occupant.py

occupant.gltf (white shirt), occupant_grey.gltf, occupant_dark.gltf: the car's driver, one mesh
in occupant.bin; crew.gltf, crew_dark.gltf: the flight deck's two pilots, one mesh in crew.bin
and its mirror image. Everything is a solid in scenes/modelling/figure.py, meshed where it is
zero.
"""
import json
import math
import os
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "modelling"))

from figure import Figure, Grip  # noqa: E402
from isosurface import folded_sheet, surface  # noqa: E402

# The car's wheel: middle, radius, and its plane's up and the way to the driver.
WHEEL, RADIUS, TILT = np.array([0.0, 1.030, -0.425]), 0.1815, math.radians(24)
WHEEL_UP = np.array([0.0, math.cos(TILT), -math.sin(TILT)])
WHEEL_REAR = np.array([0.0, math.sin(TILT), math.cos(TILT)])
BELOW_DEG = 25.0  # the hands, below nine and three o'clock


def wheel_grip(side):
    a = math.radians(BELOW_DEG)
    outward = math.cos(a) * np.array([side, 0, 0]) - math.sin(a) * WHEEL_UP
    along = math.sin(a) * np.array([side, 0, 0]) + math.cos(a) * WHEEL_UP
    return Grip(WHEEL + RADIUS * outward, along, outward, WHEEL_REAR, 0.0172)


DRIVER = {
    "hip": (0.655, 0.108),
    "lean_deg": 20.0,
    "eye": (1.300, 0.160),
    "grips": {side: wheel_grip(side) for side in (-1, 1)},
    "drops": {side: (0.55 * side, -1.0, 0.0) for side in (-1, 1)},
    "forward": {-1: 0.035, 1: 0.035},
    "legs": {
        -1: ((-0.150, 0.720, -0.325), (-0.150, 0.335, -0.500)),
        1: ((0.115, 0.715, -0.335), (0.125, 0.345, -0.560)),
    },
    "toes": {-1: (-0.01, 0.03, 0.0), 1: (0.0, 0.045, 0.0)},
}

PILOT = {
    "hip": (0.552, -0.060),
    "lean_deg": 21.0,
    "eye": (1.195, 0.080),
    "grips": {
        -1: Grip((-0.323, 0.872, -0.410), (0, 1, 0), (-1, 0, -0.3), (0, 0, 1), 0.0200),
        1: Grip(
            (0.125, 0.715, -0.250), (-1, 0, -0.35), (0, 0.6, -1), (0, 0.4, 1), 0.0200, True
        ),
    },
    "drops": {-1: (-0.6, -1.0, 0.1), 1: (0.7, -1.0, 0.2)},
    "forward": {-1: 0.02, 1: 0.0},
    "legs": {
        -1: ((-0.140, 0.600, -0.440), (-0.140, 0.120, -0.540)),
        1: ((0.140, 0.600, -0.440), (0.140, 0.120, -0.540)),
    },
}

NOTE = (
    "The head leans back so that the interior's cameras, and eyes about them, lie free before "
    "the face: by 0.12 m in the car (an eye box of 0.08 m fits), by 0.04 m in the flight deck."
)
SHIRTS = {"white": 0.8, "grey": 0.4, "dark": 0.05}
CLOTH = {"trousers": (0.035, 0.037, 0.045), "belt": (0.02, 0.017, 0.015)}
OTHER = {"hair": (0.030, 0.020, 0.014), "shoes": (0.018, 0.016, 0.015)}


def parts(figure):
    """name: [(solid, box's low and high corner, cell in metres)]"""
    low, high = np.array([-0.42, 0.0, -0.80]), np.array([0.42, 1.6, 0.55])

    def about(point, half, cell, solid):
        return solid, np.asarray(point) - half, np.asarray(point) + half, cell

    out = {
        "shirt": [
            (figure.shirt, low, high, 0.0148),
            (figure.placket, np.array([-0.03, 0.4, -0.2]), np.array([0.03, 1.4, 0.4]), 0.0065),
        ],
        "trousers": [(figure.trousers, low, high, 0.0210)],
        "belt": [about(figure.on_spine(0.12), 0.22, 0.0150, figure.belt)],
        "skin": [about(figure.eye + (0, -0.05, 0.06), 0.25, 0.0092, figure.head)],
        "hair": [about(figure.eye + (0, 0.02, 0.08), 0.18, 0.0105, figure.hair)],
        "shoes": [],
    }
    for side, (_, bend, wrist) in figure.arms.items():
        out["shirt"].append(
            about(wrist, 0.16, 0.0105, lambda p, s=side: figure.cuffs(p, s))
        )
        out["skin"].append(about(wrist, 0.17, 0.0066, lambda p, s=side: figure.glove(p, s)))
        ankle = figure.posture["legs"][side][1]
        out["shoes"].append(about(ankle, 0.30, 0.0140, lambda p, s=side: figure.shoe(p, s)))
    return out


def meshed(figure):
    """name: (points, normals, triangles) of all its solids."""
    out = {}
    for name, solids in parts(figure).items():
        pieces, base = [], 0
        surfaces = [surface(*solid) for solid in solids]
        if name == "shirt":
            surfaces.append(folded_sheet(figure.collar()))
        for points, normals, faces in surfaces:
            pieces.append((points, normals, faces + base))
            base += len(points)
        out[name] = [np.concatenate(column) for column in zip(*pieces)]
    return out


def packed(meshes):
    """The bytes, and the accessors and views that say what lies where."""
    data, views, accessors, entries = b"", [], [], {}

    def add(array, kind, target, component, **more):
        nonlocal data
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": array.nbytes,
                      "target": target})
        accessors.append({"bufferView": len(views) - 1, "componentType": component,
                          "count": array.size // (3 if kind == "VEC3" else 1), "type": kind,
                          **more})
        data += array.tobytes() + b"\0" * (-array.nbytes % 4)
        return len(accessors) - 1

    for name, (points, normals, faces) in meshes.items():
        points = np.round(points, 6).astype("<f4")
        entries[name] = {
            "attributes": {
                "POSITION": add(points, "VEC3", 34962, 5126, min=points.min(0).tolist(),
                                max=points.max(0).tolist()),
                "NORMAL": add(normals.astype("<f4"), "VEC3", 34962, 5126),
            },
            "indices": add(faces.astype("<u2").reshape(-1), "SCALAR", 34963, 5123),
        }
    return data, views, accessors, entries


def material(name, shirt):
    """Cloth and skin are Lambertian: what they are said to reflect is all that they reflect."""
    if name == "shirt":
        value = SHIRTS[shirt]
        out = {"name": f"{shirt} shirt", "color": [value] * 3, "file": f"cloth_{shirt}.csv"}
    elif name == "skin":
        out = {"name": "skin", "color": [0.47, 0.295, 0.224], "file": "skin_light.csv"}
    else:
        out = {"name": f"occupant {name}", "color": (CLOTH | OTHER)[name]}
    dull = name in ("shirt", "skin") or name in CLOTH
    extensions = {"KHR_materials_specular": {"specularFactor": 0.0}} if dull else {}
    if "file" in out:
        uri = "../assets/spectra/" + out["file"]
        extensions["PARHELION_spectrum"] = {"baseColor": uri}
    return {
        "name": out["name"],
        "pbrMetallicRoughness": {
            "baseColorFactor": [*out["color"], 1.0],
            "metallicFactor": 0.0,
            "roughnessFactor": 0.9 if dull else 0.6,
        },
        **({"extensions": extensions} if extensions else {}),
        **({"extras": {"luminous_reflectance": SHIRTS[shirt]}} if name == "shirt" else {}),
    }


def write(name, packing, shirt, people, binary):
    _, views, accessors, entries = packing
    document = {
        "asset": {
            "version": "2.0",
            "generator": "Parhelion's scenes/model_occupant.py",
            "extras": {"note": NOTE},
        },
        "extensionsUsed": ["KHR_materials_specular", "PARHELION_spectrum"],
        "scene": 0,
        "scenes": [{"nodes": list(range(len(people)))}],
        "nodes": [],
        "materials": [material(part, shirt) for part in entries],
        "meshes": [
            {"name": part, "primitives": [{**entries[part], "material": i}]}
            for i, part in enumerate(entries)
        ],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"uri": binary, "byteLength": len(packing[0])}],
    }
    for person, placed in people.items():
        document["nodes"].append({"name": person, **placed, "children": []})
    for i, (person, _) in enumerate(people.items()):
        for k, part in enumerate(entries):
            document["nodes"][i]["children"].append(len(document["nodes"]))
            document["nodes"].append({"name": f"{person}'s {part}", "mesh": k})
    with open(os.path.join(HERE, name), "w", encoding="utf-8") as file:
        json.dump(document, file, indent=1)
        file.write("\n")


def model(posture, binary, people, files):
    packing = packed(meshed(Figure(posture)))
    with open(os.path.join(HERE, binary), "wb") as file:
        file.write(packing[0])
    for name, shirt in files.items():
        write(name, packing, shirt, people, binary)
    triangles = sum(a["count"] // 3 for a in packing[2] if a["type"] == "SCALAR")
    print(f"{binary}: {len(packing[0]) // 1024} KiB, {triangles} triangles")


def main():
    model(
        DRIVER,
        "occupant.bin",
        {"driver": {"translation": [-0.37, 0, 0]}},
        {"occupant.gltf": "white", "occupant_grey.gltf": "grey", "occupant_dark.gltf": "dark"},
    )
    model(
        PILOT,
        "crew.bin",
        {
            "captain": {"translation": [-0.53, 0, 0]},
            "first officer": {"translation": [0.53, 0, 0], "scale": [-1, 1, 1]},
        },
        {"crew.gltf": "white", "crew_dark.gltf": "dark"},
    )


if __name__ == "__main__":
    main()
