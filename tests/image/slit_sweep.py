# SPDX-License-Identifier: Apache-2.0
"""slit_sweep.py [--all] [--paths N] PARHELION -- a sweep of the shipped car whose sun comes
through a slit of its roof blind: each step beside a moment of many paths.

Blinds are drawn about the whole car, black, a slit of 1 cm is open over the glass of the roof:
the sun's stripe on seats and console lights the cluster, and nothing else does but the sky in
the slit. Two steps of a sweep of four; --all: each of a sweep of twelve, and a slit of 3 mm.

A moment of so many paths (262,144; --all 4,194,304) must be known within 5 %, and a step must
be as bright within 6 %, or as far as chance allows by the intervals that both print; so must a
step's own interval reach it.
"""
import argparse
import csv
import json
import math
import os
import sys
import tempfile

from black_box import level_sheet
from gltf import Scene
from review import ROOT, Report, Reviewer, moment

LOW, HIGH = (-1.1, 0.03, -2.6), (1.1, 1.56, 2.4)  # of the blinds: the car stands in them
SLIT_Z, SLIT_HALF = 0.35, 0.4                     # over the glass of the roof
KNOWN_WITHIN, AGREES_WITHIN, TOO_FAR = 0.05, 0.06, 3.9
LEVEL = 0.002
FEW = [165, 195, 30], [50, 60, 10]
EVERY = [150, 210, 20], [44, 64, 10]


def blinds(path, width):
    scene = Scene()
    cloth = scene.lambert(0.03, double_sided=True)
    (x0, y0, z0), (x1, y1, z1) = LOW, HIGH
    for corner, side in (([x0, y0, z0], [x1 - x0, 0, 0]), ([x0, y0, z1], [x1 - x0, 0, 0]),
                         ([x0, y0, z0], [0, 0, z1 - z0]), ([x1, y0, z0], [0, 0, z1 - z0])):
        scene.quad(cloth, corner, side, [0, y1 - y0, 0])
    level_sheet(scene, cloth, (x0, z0, x1, z1), y0)
    level_sheet(scene, cloth, (x0, z0, x1, z1), y1,
                [(-SLIT_HALF, SLIT_Z - width / 2, SLIT_HALF, SLIT_Z + width / 2)])
    scene.write(path)


def request(folder, conditions, **members):
    car = os.path.relpath(os.path.join(ROOT, "scenes", "car_dashboard.gltf"), folder)
    shown = os.path.relpath(os.path.join(ROOT, "assets", "content", "cluster.png"), folder)
    return {"title": "slit", "scene": [car, "blinds.gltf"], "profile": "iso-15008",
            "eyes": {"driver": {"camera": "driver-eye"}},
            "symbols": {"speed": {"display": "cluster", "content": shown,
                                  "uv": [0.167, 0.408, 0.27, 0.609]}},
            "levels": {"set": {"*": LEVEL}}, "frames": {"worst": 0},
            "conditions": [{"level": "set", **c} for c in conditions], **members}


def review_of(report, reviewer, document, out):
    """What review.json says, also where it breaks a law of every review, which is told."""
    try:
        return reviewer.review(document, out, "--root", ROOT)[1]
    except AssertionError as broken:
        report.claim(False, str(broken))
    with open(os.path.join(reviewer.folder, out, "review.json"), encoding="utf-8") as file:
        return json.load(file)


def steps_of(report, reviewer, azimuths, elevations):
    """(azimuth, elevation) -> row of the sweep's table."""
    document = request(reviewer.folder, [{"name": "suns", "sweep": {
        "sun": {"azimuth_deg": azimuths, "elevation_deg": elevations}, "sky": "sky"}}])
    review = review_of(report, reviewer, document, "sweep")
    table = os.path.join(reviewer.folder, "sweep", review["sweeps"][0]["table"])
    with open(table, encoding="utf-8") as file:
        return {(round(float(r["sun_azimuth_deg"])), round(float(r["sun_elevation_deg"]))): r
                for r in csv.DictReader(file)}


def moments_of(report, reviewer, suns, paths):
    """What each reflects, with its interval, the mean over the symbol, and what is shown."""
    document = request(reviewer.folder, [
        moment(f"{a} {e}", type="sky", sun={
            "azimuth_deg": a, "elevation_deg": e, "illuminance_lx": reviewer.sun_lux(e)})
        for a, e in suns], precision={"contrast": 1e-3, "clear": 1e-3, "paths": paths})
    return review_of(report, reviewer, document, "moments")["cases"]


def reflected_for(light, contrast):
    """What makes (high + R) / (low + R) = contrast."""
    high = max(light["foreground"], light["background"])
    low = min(light["foreground"], light["background"])
    return (high - contrast * low) / (contrast - 1)


def check_step(report, name, row, case):
    found, light = float(row["reflected_cd_m2"]), case["luminance_cd_m2"]
    wanted, (low, high) = light["reflected"], case["reflected_interval"]
    least, most = (reflected_for(light, float(row["contrast_" + end]))
                   for end in ("high", "low"))
    half, own = (high - low) / 2, (most - least) / 2
    words = (f"{name}: {found:.4g} [{least:.4g}, {most:.4g}] cd/m2 in the sweep, {wanted:.4g} "
             f"[{low:.4g}, {high:.4g}] by itself")
    print(words, flush=True)
    report.claim(half <= KNOWN_WITHIN * wanted, f"{words}: not known within 5 %")
    mean = case["symbol_mean"]["reflected"]  # as which a step counts all but the sun
    allowed = TOO_FAR / 1.96 * math.hypot(half, own)
    report.claim(min(mean, wanted) - allowed - AGREES_WITHIN * wanted <= found <=
                 wanted + allowed + AGREES_WITHIN * wanted, words)
    report.claim(least - (half + AGREES_WITHIN * wanted) <= wanted <=
                 most + half + AGREES_WITHIN * wanted, f"{words}: out of its interval")


def check_slit(report, reviewer, width, sweep, suns, paths):
    blinds(os.path.join(reviewer.folder, "blinds.gltf"), width)
    rows = steps_of(report, reviewer, *sweep)
    suns = suns or sorted(rows)
    for sun, case in zip(suns, moments_of(report, reviewer, suns, paths)):
        check_step(report, f"slit of {1000 * width:g} mm, sun {sun}", rows[sun], case)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("parhelion")
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--paths", type=int)
    words = parser.parse_args()
    report = Report()
    os.makedirs(os.path.join(ROOT, ".build"), exist_ok=True)
    with tempfile.TemporaryDirectory(dir=os.path.join(ROOT, ".build")) as folder:
        reviewer = Reviewer(words.parhelion, folder)
        paths = words.paths or (1 << 22 if words.all else 1 << 18)
        if words.all:
            check_slit(report, reviewer, 0.01, EVERY, None, paths)
            check_slit(report, reviewer, 0.003, FEW, None, paths)
        else:
            check_slit(report, reviewer, 0.01, FEW, [(165, 60), (195, 50)], paths)
    return report.finish()


if __name__ == "__main__":
    sys.exit(main())
