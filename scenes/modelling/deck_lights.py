# SPDX-License-Identifier: Apache-2.0
"""The flight deck's light scenes: skies by place and time; dim flood lights after sunset."""
import json
import math
import os

CRUISE_M = 10668  # FL350

# The autumn equinox at 45 degrees north, 0 east, at FL350 over cloud.
PLACE = [45.0, 0.0, CRUISE_M]


def sky(when, heading_deg, cloud_top_m=3000, place=None):
    return {
        "type": "sky",
        "when": when,
        "where": place or PLACE,
        "heading_deg": heading_deg,
        "turbidity": 2.2,
        "ground": "cloud",
        "cloud_top_m": cloud_top_m,
        "cloud_relief_m": 500,
        "albedo": 0.75,
    }


WARM = [1.0, 0.80, 0.56]

# Spot lights under the coaming that wash the main panel; a dome lamp behind the pilots.
FLOODS = [
    ("panel flood", (x, 0.675, 0.930), (0.0, 0.06, -1.0))
    for x in (-0.58, -0.30, 0.0, 0.30, 0.58)
]
PEDESTAL = ("pedestal flood", (0.0, 0.30, 1.62), (0.0, 0.02, -1.0))


DOME = ("dome", (0.0, -0.35, 1.70), (0.0, 0.35, -1.0))


def lamps(flood_cd, pedestal_cd, dome_cd):
    out = [
        light(name, "spot", flood_cd, place, direction, (20, 85))
        for name, place, direction in FLOODS
    ]
    for (name, place, direction), intensity, cone in (
        (PEDESTAL, pedestal_cd, (8, 18)),
        (DOME, dome_cd, (40, 75)),
    ):
        out.append(light(name, "spot", intensity, place, direction, cone))
    return out


def light(name, kind, intensity, place, direction, cone_deg):
    """Position and direction in the modelling frame (y forward, z up)."""
    return {
        "light": {
            "name": name,
            "type": kind,
            "color": WARM,
            "intensity": intensity,
            "spot": {
                "innerConeAngle": round(math.radians(cone_deg[0]), 6),
                "outerConeAngle": round(math.radians(cone_deg[1]), 6),
            },
        },
        "node": {
            "name": name,
            "translation": [place[0], place[2], -place[1]],
            "rotation": rotation(direction),
        },
    }


def rotation(direction):
    """glTF quaternion (x, y, z, w) that turns -Z into a direction of the modelling frame."""
    x, y, z = direction[0], direction[2], -direction[1]
    length = math.sqrt(x * x + y * y + z * z)
    x, y, z = x / length, y / length, z / length
    # half-way between -Z and the direction: axis (-Z) x d, angle by the dot product
    q = (y, -x, 0.0, 1.0 - z)
    n = math.sqrt(sum(c * c for c in q))
    return [round(c / n, 7) for c in q]


def write_scene(folder, name, environment, lights=()):
    used = ["PARHELION_environment"] + (["KHR_lights_punctual"] if lights else [])
    gltf = {
        "asset": {"version": "2.0", "generator": "deck_lights.py of Parhelion"},
        "extensionsUsed": sorted(used),
        "scene": 0,
        "scenes": [{"name": name, "extensions": {"PARHELION_environment": environment}}],
    }
    if lights:
        gltf["extensions"] = {"KHR_lights_punctual": {"lights": [e["light"] for e in lights]}}
        gltf["nodes"] = [
            dict(e["node"], extensions={"KHR_lights_punctual": {"light": i}})
            for i, e in enumerate(lights)
        ]
        gltf["scenes"][0]["nodes"] = list(range(len(lights)))
    with open(os.path.join(folder, name + ".gltf"), "w", encoding="utf-8") as file:
        json.dump(gltf, file, indent=1)
        file.write("\n")


def write_lights(folder):
    write_scene(folder, "cloud_noon", sky("2026-06-21T12:10+00:00", 70.0))
    write_scene(folder, "low_sun_left", sky("2026-09-21T06:35+00:00", 201.0))
    write_scene(folder, "dusk", sky("2026-09-21T05:17+00:00", 100.0), lamps(1.5, 8.0, 12.0))
    night = {"type": "constant", "luminance": 0.001, "color": [0.62, 0.78, 1.0]}
    write_scene(folder, "flight_night", night, lamps(0.15, 1.0, 0.25))
