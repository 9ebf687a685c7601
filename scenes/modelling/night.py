# SPDX-License-Identifier: Apache-2.0
"""The night scene: lamps, lit windows, tail lights and the cabin's faint ambient light.

Only what shines is in night.gltf; what it shines on is in car_dashboard.gltf."""
import math

from mathutils import Vector

import cabin
import climate
import dashboard
import finish
import legends
import wheel
from outside import LAMPS
from shapes import box, frame_matrix, joined, mesh, tube

LIT_LAMPS = [lamp for lamp in LAMPS if -20.0 < lamp[1] < 150.0]
SKY = {"type": "constant", "luminance": 0.05, "color": [0.55, 0.72, 1.0]}


def build_night(path):
    lamp_heads()
    signals()
    windows()
    ambient_line()
    lit_legends()
    finish.finish_meshes()
    finish.export(path)
    finish.patch(path, SKY)
    add_lights(path)


def lamp_heads():
    faces = [
        box(
            "head",
            (0.42, 0.16, 0.012),
            frame_matrix((x, y, z + 0.062), (1, 0, 0), (0, 1, 0)),
            "lamp head",
            0,
        )
        for x, y, z in LIT_LAMPS
    ]
    joined("street lamp heads", faces)


def signals():
    lamps = []
    for k in (-1, 1):
        lamps.append(
            box(
                "lamp",
                (0.33, 0.01, 0.09),
                frame_matrix((0.05 + 0.62 * k, 18.75, 0.80), (1, 0, 0), (0, 1, 0)),
                "tail lamp lit",
                0,
            )
        )
    joined("lit tail lamps", lamps)
    box(
        "green light",
        (0.19, 0.01, 0.19),
        frame_matrix((2.75, 44.93, 2.86), (1, 0, 0), (0, 1, 0)),
        "traffic green",
        0,
    )


def windows():
    """Some panes of the street's houses are lit; a window grid of 3 m as in the facades."""
    import outside

    outside.HOUSES.clear()
    positions = house_fronts()
    panes = {"lit window": [], "lit window cool": []}
    for number, bay, floor, cool in outside.lit_panes(positions):
        x, y, _, _, side = positions[number]
        panes["lit window cool" if cool else "lit window"].append(
            (x, y + 3 * bay + 1.5, 3 * floor + 1.9, side)
        )
    for kind, spots in panes.items():
        vertices, faces = [], []
        for x, y, z, side in spots:
            front, base = x - 0.03 * side, len(vertices)
            vertices.extend(
                [
                    (front, y - 0.62, z - 0.75),
                    (front, y + 0.62, z - 0.75),
                    (front, y + 0.62, z + 0.75),
                    (front, y - 0.62, z + 0.75),
                ]
            )
            faces.append([base + k for k in (range(4) if side < 0 else range(3, -1, -1))])
        mesh(kind + "s", vertices, faces, kind)


def house_fronts():
    """Where the street's fronts stand: the same random run as the houses themselves."""
    import outside

    build = outside.house
    outside.house = lambda *ignored: None
    try:
        outside.houses()
    finally:
        outside.house = build
    return list(outside.HOUSES)


def ambient_line():
    path = dashboard.along((0.7530, 0.9140), (-0.73, 0.73), 60)
    tube("ambient line", path, 0.0017, "ambient line", 6)


def lit_legends():
    """What is printed on the controls, lit from behind."""
    rows = cabin.prints() + climate.prints() + climate.lamp_prints() + wheel.prints()
    legends.lit("lit legends", rows, "legend lit")
    legends.lit("lit key lamps", climate.lamps(), "legend amber")


def add_lights(path):
    """KHR_lights_punctual by hand: Blender's exporter would turn candela into its own watts."""
    import json

    with open(path, encoding="utf-8") as file:
        gltf = json.load(file)
    lights = [
        {
            "name": "street lamp",
            "type": "spot",
            "color": [1.0, 0.86, 0.66],
            "intensity": 2600.0,
            "spot": {"innerConeAngle": math.radians(48), "outerConeAngle": math.radians(74)},
        },
        {
            "name": "footwell light",
            "type": "point",
            "color": [0.35, 0.66, 1.0],
            "intensity": 0.10,
        },
        {"name": "door light", "type": "point", "color": [1.0, 0.80, 0.58], "intensity": 0.02},
        {
            "name": "own low beam",
            "type": "spot",
            "color": [1.0, 0.96, 0.90],
            "intensity": 9000.0,
            "spot": {"innerConeAngle": math.radians(5), "outerConeAngle": math.radians(14)},
        },
    ]
    gltf["extensions"] = {"KHR_lights_punctual": {"lights": lights}}
    gltf["extensionsUsed"] = sorted(set(gltf["extensionsUsed"]) | {"KHR_lights_punctual"})
    for name, index, place, direction in light_places():
        node = {
            "name": name,
            "translation": [round(v, 4) for v in (place[0], place[2], -place[1])],
            "extensions": {"KHR_lights_punctual": {"light": index}},
        }
        if direction is not None:
            node["rotation"] = [round(v, 7) for v in rotation(direction)]
        gltf["nodes"].append(node)
        gltf["scenes"][0]["nodes"].append(len(gltf["nodes"]) - 1)
    with open(path, "w", encoding="utf-8") as file:
        json.dump(gltf, file, indent=1, ensure_ascii=False)
        file.write("\n")


def light_places():
    """(name, light, position, direction) in the car's frame, y forward and z up."""
    out = [
        (f"street lamp {i}", 0, (x, y, z - 0.02), (0, 0, -1))
        for i, (x, y, z) in enumerate(LIT_LAMPS)
    ]
    out += [
        (f"footwell {side}", 1, (x, 0.62, 0.55), None)
        for side, x in (("left", -0.37), ("right", 0.37))
    ]
    out += [
        (f"door {side}", 2, (x, 0.10, 0.60), None)
        for side, x in (("left", -0.62), ("right", 0.62))
    ]
    out += [
        (f"low beam {side}", 3, (x, 2.62, 0.66), (0.02, 1, -0.20))
        for side, x in (("left", -0.62), ("right", 0.62))
    ]
    return out


def rotation(direction):
    """glTF quaternion (x, y, z, w) that turns -Z into the car-frame direction."""
    x, y, z = Vector(direction).normalized()
    turn = Vector((0, 0, -1)).rotation_difference(Vector((x, z, -y)))
    return turn.x, turn.y, turn.z, turn.w
