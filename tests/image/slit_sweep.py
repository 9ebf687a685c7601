# SPDX-License-Identifier: Apache-2.0
"""slit_sweep.py PARHELION -- a sweep of the shipped car whose sun comes
through a slit of its roof blind: each step beside a moment of many paths.

Blinds are drawn about the whole car, black, a slit of 1 cm is open over the glass of the roof:
the sun's stripe on seats and console lights the cluster, and nothing else does but the sky in
the slit. Two steps of a sweep of four.

A moment of 262,144 paths must be known within 5 %, and a step must
be as bright within 6 %, or as far as chance allows by the intervals that both print; so must a
step's own interval reach it.
"""
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
SLIT_Z, SLIT_HALF, WIDTH = 0.35, 0.4, 0.01        # over the glass of the roof
KNOWN_WITHIN, AGREES_WITHIN, TOO_FAR = 0.05, 0.06, 3.9
LEVEL = 0.002
AZIMUTHS, ELEVATIONS = [165, 195, 30], [50, 60, 10]  # of the sweep
SUNS = [(165, 60), (195, 50)]                        # of the moments
PATHS = 1 << 18


def blinds(path):
    scene = Scene()
    cloth = scene.lambert(0.03, double_sided=True)
    (x0, y0, z0), (x1, y1, z1) = LOW, HIGH
    for corner, side in (([x0, y0, z0], [x1 - x0, 0, 0]), ([x0, y0, z1], [x1 - x0, 0, 0]),
                         ([x0, y0, z0], [0, 0, z1 - z0]), ([x1, y0, z0], [0, 0, z1 - z0])):
        scene.quad(cloth, corner, side, [0, y1 - y0, 0])
    level_sheet(scene, cloth, (x0, z0, x1, z1), y0)
    level_sheet(scene, cloth, (x0, z0, x1, z1), y1,
                [(-SLIT_HALF, SLIT_Z - WIDTH / 2, SLIT_HALF, SLIT_Z + WIDTH / 2)])
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


def steps_of(report, reviewer):
    """(azimuth, elevation) -> row of the sweep's table."""
    document = request(reviewer.folder, [{"name": "suns", "sweep": {
        "sun": {"azimuth_deg": AZIMUTHS, "elevation_deg": ELEVATIONS}, "sky": "sky"}}])
    review = review_of(report, reviewer, document, "sweep")
    table = os.path.join(reviewer.folder, "sweep", review["sweeps"][0]["table"])
    with open(table, encoding="utf-8") as file:
        return {(round(float(r["sun_azimuth_deg"])), round(float(r["sun_elevation_deg"]))): r
                for r in csv.DictReader(file)}


def moments_of(report, reviewer):
    """What each reflects, with its interval, the mean over the symbol, and what is shown."""
    document = request(reviewer.folder, [
        moment(f"{a} {e}", type="sky", sun={
            "azimuth_deg": a, "elevation_deg": e, "illuminance_lx": reviewer.sun_lux(e)})
        for a, e in SUNS], precision={"contrast": 1e-3, "clear": 1e-3, "paths": PATHS})
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


def main():
    report = Report()
    os.makedirs(os.path.join(ROOT, ".build"), exist_ok=True)
    with tempfile.TemporaryDirectory(dir=os.path.join(ROOT, ".build")) as folder:
        reviewer = Reviewer(sys.argv[1], folder)
        blinds(os.path.join(folder, "blinds.gltf"))
        rows = steps_of(report, reviewer)
        for sun, case in zip(SUNS, moments_of(report, reviewer)):
            check_step(report, f"sun {sun}", rows[sun], case)
    return report.finish()


if __name__ == "__main__":
    sys.exit(main())
