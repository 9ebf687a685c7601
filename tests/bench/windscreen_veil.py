#!/usr/bin/env python3
"""windscreen_veil.py PARHELION -- what the car's windscreen mirrors of its dashboard.

The driver looks at the road (a review's gaze: a mean over 1 degree). The dashboard's top and
the hood over the cluster become Lambertian of 5, 13 and 34 %; the sun stands ahead, 50 degrees
high, in a clear sky, as strong as it takes for 88.9 klx in all on the outside of the
windscreen where the eye looks through it. By hand: a dashboard that is lit as the glass is,
less what the pane keeps, seen in the pane: R rho T E / pi, with the slab's formula for R
(65 degrees) and T (the sun's incidence, 16 degrees).

Measured in 18 cars at 88.9 klx on the glass (UMTRI 2003): a veil of 561 cd/m2, of which 60 %,
337 cd/m2, is the dashboard's reflection and the rest is scattered on dirt. Their dashboards'
reflectances are not stated.
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
TINT = 0.2126 * 0.86 + 0.7152 * 0.885 + 0.0722 * 0.875  # the windscreen, straight through
EYE = (-0.37, 1.3, 0.0)
GAZE = (0.0, -0.02, -1.0)
LOOKED_THROUGH = (-0.37, 1.2837, -0.8130)  # on the windscreen, along the gaze
NORMAL = (-0.1288, 0.8898, -0.4378)        # of the glass there
MARK = {"display": "cluster", "content": "../assets/content/cluster.png",
        "uv": [0.167, 0.408, 0.27, 0.609], "polarity": "light-on-dark"}


def copy_car(folder, reflectance):
    """The car in a folder of its own, its dashboard's top another."""
    for name in ("panels", "content"):
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
    with open(os.path.join(scenes, "car_dashboard.gltf"), "w", encoding="utf-8") as file:
        json.dump(car, file)
    return scenes


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
    """Reflectance of both faces of a clear pane, unpolarised, and what passes."""
    inner = math.sqrt(1 - (1 - cosine * cosine) / IOR ** 2)
    faces = ((cosine - IOR * inner) / (cosine + IOR * inner),
             (IOR * cosine - inner) / (IOR * cosine + inner))
    mirrored = sum(2 * r * r / (1 + r * r) for r in faces) / 2
    return mirrored, 1 - mirrored


def by_hand(reflectance):
    e = math.radians(ELEVATION_DEG)
    through = slab(math.sin(e) * NORMAL[1] - math.cos(e) * NORMAL[2])[1] * TINT
    length = math.sqrt(sum(x * x for x in GAZE))
    mirrored = slab(abs(sum(a * b for a, b in zip(GAZE, NORMAL))) / length)[0]
    return mirrored * reflectance * through * GLASS_LX / math.pi


def gaze(program, reflectance, sun_lx):
    with tempfile.TemporaryDirectory() as folder:
        scenes = copy_car(folder, reflectance)
        request = {
            "title": "windscreen", "scene": ["car_dashboard.gltf"], "forward": [0, 0, -1],
            "eyes": {"driver": {"position_m": EYE}}, "symbols": {"speed": MARK},
            "gaze": [{"name": "road", "direction": GAZE}],
            "profile": "iso-15008", "precision": {"contrast": 0.02},
            "frames": {"size": [64, 36], "noise": 1, "worst": 0},
            "conditions": [{"name": "sun ahead", "environment": {
                "type": "sky", "sun": {"azimuth_deg": 0, "elevation_deg": ELEVATION_DEG,
                                       "illuminance_lx": sun_lx}}}]}
        with open(os.path.join(scenes, "r.json"), "w", encoding="utf-8") as file:
            json.dump(request, file)
        out = os.path.join(folder, "out")
        answer(program, "review", os.path.join(scenes, "r.json"), "-o", out)
        with open(os.path.join(out, "review.json"), encoding="utf-8") as file:
            return json.load(file)["gazes"][0]


def main():
    program = os.path.abspath(sys.argv[1])
    sun_lx = sun_for_glass(program)
    print(f"sun {sun_lx:.0f} lx on a plane that faces it: {GLASS_LX:.0f} lx on the glass")
    for reflectance in (0.05, 0.13, 0.34):
        found = gaze(program, reflectance, sun_lx)
        print(f"{100 * reflectance:.0f} %: {found['mirrored_cd_m2']:.0f} cd/m2 mirrored "
              f"({found['mirrored_interval'][0]:.0f} to {found['mirrored_interval'][1]:.0f}), "
              f"by hand {by_hand(reflectance):.0f}; {found['through_cd_m2']:.0f} cd/m2 of the "
              f"road; {found['contrast_behind_glass']:.3f} of its contrast left", flush=True)


if __name__ == "__main__":
    main()
