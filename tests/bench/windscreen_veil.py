#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""windscreen_veil.py PARHELION -- what the car's windscreen lays over the road.

The driver looks at the road (a mean over 1 degree). The dashboard's top and the hood over the
cluster become Lambertian of 5, 13 and 34 %; the sun stands ahead, 50 degrees high, in a clear
sky, as strong as it takes for 88.9 klx in all on the outside of the windscreen where the eye
looks through it. The windscreen is the car's, laminated and of green glass, with its own little
haze, or dirty: 1.5 % of what passes scattered, half of that within 20 degrees.

By hand: a dashboard that is lit as the glass is, less what the pane keeps, seen in the pane, R
rho T E / pi, with a slab's formulas for R (65 degrees) and T (the sun's incidence, 15 degrees);
and the sun's light in the dirt's lobe (shaders/glazing.c).

Measured in 18 cars at 88.9 klx on the glass (UMTRI 2003): a veil of 561 cd/m2, of which 60 %,
337 cd/m2, is the dashboard's reflection and the rest, 224 cd/m2, is scattered on dirt. Their
dashboards' reflectances and their dirt are not stated.
"""
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
GLASS_LX, ELEVATION_DEG, IOR = 88900.0, 50.0, 1.52
TINT = 0.834  # the windscreen's body, straight through
EYE = (-0.37, 1.3, 0.0)
GAZE = (0.0, -0.02, -1.0)
LOOKED_THROUGH = (-0.37, 1.2845, -0.7757)  # on the windscreen, along the gaze
NORMAL = (-0.1326, 0.8879, -0.4405)        # of the glass there
DIRT = {"as it ships": None, "dirty": {"share": 0.015, "width_deg": 20}}


def copy_car(folder, reflectance, dirt):
    """The car in a folder of its own, its dashboard's top another."""
    for name in ("panels", "content", "spectra"):
        at = os.path.join("assets", name)
        shutil.copytree(os.path.join(ROOT, at), os.path.join(folder, at))
    scenes = os.path.join(folder, "scenes")
    shutil.copytree(os.path.join(ROOT, "scenes", "textures"), os.path.join(scenes, "textures"))
    shutil.copy(os.path.join(ROOT, "scenes", "car_dashboard.bin"), scenes)
    with open(os.path.join(ROOT, "scenes", "car_dashboard.gltf"), encoding="utf-8") as file:
        car = json.load(file)
    car["extensionsUsed"] = [*car["extensionsUsed"], "KHR_materials_specular"]
    car["materials"].append({
        "name": "dashboard top", "doubleSided": True,
        "pbrMetallicRoughness": {"baseColorFactor": [*[reflectance] * 3, 1],
                                 "metallicFactor": 0, "roughnessFactor": 1},
        "extensions": {"KHR_materials_specular": {"specularFactor": 0}}})
    for node in car["nodes"]:
        if node["name"] in ("dashboard pad", "binnacle hood"):
            for part in car["meshes"][node["mesh"]]["primitives"]:
                part["material"] = len(car["materials"]) - 1
    for material in car["materials"]:
        glazing = material.get("extensions", {}).get("PARHELION_glazing")
        if glazing and dirt:
            glazing["haze"] = dirt
    path = os.path.join(scenes, "car_dashboard.gltf")
    with open(path, "w", encoding="utf-8") as file:
        json.dump(car, file)
    return path


def answer(program, *line):
    done = subprocess.run([program, *line, "--quiet"], capture_output=True, text=True,
                          check=False)
    assert done.returncode in (0, 1), done.stderr
    return done.stdout


def glass_lx(program, sun_lx):
    outside = [p + 0.004 * n for p, n in zip(LOOKED_THROUGH, NORMAL)]
    at = ",".join(str(x) for x in (*outside, *NORMAL))
    car = os.path.join(ROOT, "scenes", "car_dashboard.gltf")
    return json.loads(answer(program, "measure", car,
                             f"--illuminance={at}", "--environment", "sky:clear", "--sun",
                             f"0,{ELEVATION_DEG},{sun_lx}", "--json"))["illuminance_lx"]


def sun_for_glass(program):
    """The sun's lx (on a plane that faces it) that makes GLASS_LX with the sky's."""
    low, high = glass_lx(program, 60000), glass_lx(program, 110000)
    return 60000 + (GLASS_LX - low) / (high - low) * 50000


def slab(cosine):
    """What a tinted pane mirrors and lets pass, both polarisations, all orders."""
    inner = math.sqrt(1 - (1 - cosine * cosine) / IOR ** 2)
    t = TINT ** (1 / inner)
    faces = [((cosine - IOR * inner) / (cosine + IOR * inner)) ** 2,
             ((IOR * cosine - inner) / (IOR * cosine + inner)) ** 2]
    mirrored = sum(r + (1 - r) ** 2 * t * t * r / (1 - r * r * t * t) for r in faces) / 2
    return mirrored, sum((1 - r) ** 2 * t / (1 - r * r * t * t) for r in faces) / 2


def by_hand(reflectance):
    e, length = math.radians(ELEVATION_DEG), math.sqrt(sum(x * x for x in GAZE))
    through = slab(math.sin(e) * NORMAL[1] - math.cos(e) * NORMAL[2])[1]
    mirrored = slab(abs(sum(a * b for a, b in zip(GAZE, NORMAL))) / length)[0]
    return mirrored * reflectance * through * GLASS_LX / math.pi


def dirt_by_hand(dirt, sun_lx):
    """The sun alone: its light on the pane, times the lobe where the eye is."""
    e, length = math.radians(ELEVATION_DEG), math.sqrt(sum(x * x for x in GAZE))
    to_sun = (0, math.sin(e), -math.cos(e))
    to_eye = [-x / length for x in GAZE]
    cosines = [sum(a * b for a, b in zip(way, NORMAL)) for way in (to_sun, to_eye)]
    moved = [a + b - (cosines[0] + cosines[1]) * n for a, b, n in zip(to_sun, to_eye, NORMAL)]
    w2, b2 = math.sin(math.radians(dirt["width_deg"])) ** 2, sum(x * x for x in moved)
    lobe = w2 / (math.pi * (w2 + b2) ** 2)
    passed = min(slab(abs(c))[1] for c in cosines)
    return sun_lx * cosines[0] * dirt["share"] * passed * lobe


def veil(program, reflectance, dirt, sun_lx):
    """cd/m2 that the windscreen mirrors and scatters, and all that is seen."""
    with tempfile.TemporaryDirectory() as folder:
        car = copy_car(folder, reflectance, dirt)
        target = ",".join(str(a + b) for a, b in zip(EYE, GAZE))
        seen = json.loads(answer(
            program, "explain", car, "--environment", "sky:clear", "--sun",
            f"0,{ELEVATION_DEG},{sun_lx}", "--eye", ",".join(map(str, EYE)), "--look-at",
            target, "--fov", "1", "--size", "1x1", "--pixel", "0,0", "--paths", "65536",
            "--ways", "200", "--json"))
    total = {"mirror": 0, "scatters": 0, "sun": 0}
    for way in seen["chains"]:
        first = way["bounces"][0] if way.get("bounces") else {}
        if first.get("node") == "windscreen" and first["what"] in total:
            total[first["what"]] += way["cd_m2"]
            if first["what"] == "scatters" and way["light"] == "sun":
                total["sun"] += way["cd_m2"] if len(way["bounces"]) == 1 else 0
    return total, seen


def main():
    program = os.path.abspath(sys.argv[1])
    sun_lx = sun_for_glass(program)
    print(f"sun {sun_lx:.0f} lx on a plane that faces it: {GLASS_LX:.0f} lx on the glass")
    for name, dirt in DIRT.items():
        scattered = f", by hand {dirt_by_hand(dirt, sun_lx):.0f}" if dirt else ""
        for reflectance in (0.05, 0.13, 0.34):
            total, seen = veil(program, reflectance, dirt, sun_lx)
            mirror, haze = total["mirror"], total["scatters"]
            print(f"{name}, {100 * reflectance:.0f} %: {mirror:.0f} cd/m2 mirrored, by hand "
                  f"{by_hand(reflectance):.0f}; {haze:.0f} scattered, of it the sun's own "
                  f"{total['sun']:.0f}{scattered}; together {mirror + haze:.0f} of "
                  f"{seen['luminance_cd_m2']:.0f}, all known to "
                  f"{seen['standard_error_cd_m2']:.0f}", flush=True)


if __name__ == "__main__":
    main()
