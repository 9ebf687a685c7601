# SPDX-License-Identifier: Apache-2.0
"""cabin.py [--seeds N] PARHELION -- a dark cabin's intervals hold what frames of four million
paths have: an LCD below slats that sun and sky or a street lamp shine through, a chrome knob in
that light, a spot, a pane across the gaze, walls that reflect a tenth.

A camera at the eye sees the symbol; the same samples without any bounce are taken off, which
leaves what is reflected at each pixel's place of the content. The brightness of the bars is the
case's own. Truth of the threshold increment and of what a gaze sees mirrored, which no frame
shows, is the mean of all seeds, which is said. The mean of the display's illuminance, which has
no interval, is printed beside that of luxmeters of many paths.
"""
import json
import math
import os
import shutil
import sys
import tempfile

import black_box
import every_interval
from exr import Frame
from gltf import dot, sub
from review import PANEL, Report, Reviewer, moment

SYMBOL = [20 / 60, 8 / 30, 40 / 60, 22 / 30]  # the bars of black_box.display
SLATS, PITCH, GAP = 4, 0.025, 0.006
LEVEL, SEEDS = 0.02, 60
SIZE, SAMPLES = (128, 64), 512  # of the frame
LUMINANCE = {"R": 0.2126, "G": 0.7152, "B": 0.0722}
METERS, METER_PATHS = (6, 3), "65536"
AGE = 60
LIGHTS = {
    "day": (["--environment", "constant:800", "--sun", "165,62,90000"],
            {"type": "constant", "luminance": 800, "sun": black_box.environment()["sun"]}),
    "night": (["--environment", "constant:0.01", "--sun", "off"],
              {"type": "constant", "luminance": 0.01})}


class Cabin(black_box.Patch):
    def __init__(self):
        first = black_box.HOLE[1] - SLATS * PITCH / 2
        super().__init__(walls=0.1, floor=0.2, openings=[
            (black_box.HOLE[0] - 0.12, first + i * PITCH, black_box.HOLE[0] + 0.12,
             first + i * PITCH + GAP) for i in range(SLATS)])

    def add_more(self, scene):
        x, z = black_box.where_beam_is(-0.35)
        scene.sphere(scene.metal(0.6), [x - 0.03, -0.35, z], 0.02, rings=48)
        scene.facing_quad(scene.window(1.5), [0.1, 0.32, 0.45], [0.2, 0.4, 1], 0.3)
        scene.light("spot", 3, [-0.5, 0.4, 0.9], [0.2, -1, -0.2],
                    spot={"innerConeAngle": 0.3, "outerConeAngle": 0.5})
        sun = black_box.towards_sun()
        scene.light("point", 3e4, [black_box.HOLE[0] + 3 * sun[0], black_box.HIGH[1] + 3 * sun[1],
                                   black_box.HOLE[1] + 3 * sun[2]])


def write_cabin(reviewer, level):
    scene = Cabin().scene(level)
    wide, high = black_box.WIDTH, black_box.HEIGHT
    left, top, right, bottom = black_box.SYMBOL_UV
    at = [((left + right) / 2 - 0.5) * wide, (0.5 - (top + bottom) / 2) * high, 0]
    to = sub(at, black_box.EYE)
    reach = math.sqrt(dot(to, to)) - 0.02
    scene.view("near", black_box.EYE, to, 2 * math.degrees(
        math.atan((bottom - top) * high / 2 / reach)))
    scene.write(os.path.join(reviewer.folder, "room.gltf"))


class Truth:
    """Means of what is reflected, by boxes of the content."""

    def __init__(self, reviewer, light):
        c, shown = (self.render(reviewer, light, bounces) for bounces in ([], [
            "--max-bounces", "0", "--no-guiding"]))
        wide, high = SIZE
        self.rows = []
        for j in range(1, high - 1):
            for i in range(1, wide - 1):
                k = j * wide + i
                if c["display.coverage"][k] < 1:
                    continue
                # the piece of the content that a pixel shows
                du, dv, eu, ev = (c["uv." + axis][k + step] - c["uv." + axis][k - step]
                                  for step in (1, wide) for axis in "UV")
                y = sum(share * (c[x][k] - shown[x][k]) for x, share in LUMINANCE.items())
                self.rows.append((c["uv.U"][k], c["uv.V"][k], abs(du * ev - dv * eu), y))

    @staticmethod
    def render(reviewer, light, bounces):
        done = reviewer.run("render", "room.gltf", "--camera", "near", *light, *bounces,
                            "--size", "%dx%d" % SIZE, "--spp", str(SAMPLES), "--layers", "all",
                            "--seed", "77", "-o", "truth.exr")
        assert done.returncode == 0, done.stderr
        return Frame(os.path.join(reviewer.folder, "truth.exr")).channels

    def mean(self, box):
        left, top, right, bottom = box
        rows = [r for r in self.rows if left < r[0] < right and top < r[1] < bottom]
        return sum(r[2] * r[3] for r in rows) / sum(r[2] for r in rows)


def meters(reviewer, light):
    rows = []
    for i in range(METERS[0]):
        for j in range(METERS[1]):
            u, v = ((k + 0.5) / n * 0.8 + 0.1 for k, n in ((i, METERS[0]), (j, METERS[1])))
            rows += ["--illuminance", "%g,%g,1e-4,0,0,1" % ((u - 0.5) * black_box.WIDTH,
                                                           (0.5 - v) * black_box.HEIGHT)]
    found = every_interval.ask(reviewer, "measure", "room.gltf", *rows, *light,
                               "--samples", METER_PATHS)
    return sum(f["illuminance_lx"] for f in found) / len(found)


def asked(seed):
    return black_box.review_request(
        LEVEL, [moment(name, **light) for name, (_, light) in LIGHTS.items()],
        precision={"seed": seed, "contrast": 0.05, "clear": 0.1},
        observer={"age_years": AGE}, gaze=[{"name": "road", "direction": [0, 0.2, -0.5],
                                            "road": {"luminance_cd_m2": 1,
                                                     "ages_years": [AGE]}}])


def measure(reviewer, tally, seeds):
    write_cabin(reviewer, LEVEL)
    truths = {name: Truth(reviewer, light) for name, (light, _) in LIGHTS.items()}
    lux = {name: [] for name in LIGHTS}
    for seed in range(1, seeds + 1):
        review = reviewer.review(asked(seed), "out")[1]
        for case, gaze in zip(review["cases"], review["gazes"]):
            name = case["condition"]
            assert gaze["condition"] == name
            part = truths[name].mean([case["judged_part_uv"][side]
                                      for side in ("left", "top", "right", "bottom")])
            lux[name].append(case["display_lux"])
            told = {k: case[k] for k in ("reflected_interval", "contrast_interval",
                                         "contrast_ratio", "luminance_cd_m2", "symbol_mean")}
            increment = [{"value": age["threshold_increment_pct"],
                          "interval": age["threshold_increment_interval"]}
                         for age in gaze["road"]["ages"]]  # none by day
            mirrored = {k: gaze[k] for k in ("mirrored_cd_m2", "mirrored_interval")}
            tally.add(f"cabin by {name}", {"case": told, "gaze": mirrored, **(
                {"TI": increment[0]} if increment else {})}, {
                "case/reflected_interval": part,
                "case/contrast_interval": every_interval.contrast_of(told["luminance_cd_m2"],
                                                                     part),
                "symbol_mean/reflected_interval": truths[name].mean(SYMBOL),
                "gaze/mirrored_interval": every_interval.OF_SEEDS,
                "/TI/interval": every_interval.OF_SEEDS})
    for name, found in lux.items():
        mean = sum(found) / seeds
        error = math.sqrt(sum((x - mean) ** 2 for x in found) / max(seeds - 1, 1) / seeds)
        print(f"cabin by {name}: display_lux {mean:.5g} +- {error:.2g}, luxmeters "
              f"{meters(reviewer, LIGHTS[name][0]):.5g}", flush=True)


def main(words):
    report = Report()
    tally = every_interval.Tally(report)
    seeds = int(words[words.index("--seeds") + 1]) if "--seeds" in words else SEEDS
    with tempfile.TemporaryDirectory() as folder:
        shutil.copy(PANEL, os.path.join(folder, "ips.panel"))
        measure(Reviewer(words[-1], folder), tally, seeds)
    tally.finish()
    return report.finish()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
