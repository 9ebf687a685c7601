# SPDX-License-Identifier: Apache-2.0
"""hunt.py [--seed N] [--count N] [--first N] [--rare] [--unguided] [--keep FILE] PARHELION --
a hunt for wrong answers: the same number asked in several ways of small random cockpits
(rooms.py).

What a review says of the symbol's reflected light is held against
  causes   the sum of its causes, which other paths find;
  frame    a frame's display layers, and `measure` of that frame;
  sweep    the step of a sweep that has the moment's sun, which comes of a response;
  closed   in every fifth room, which is empty under a uniform sky, the integral of the panel's
           BRDF as `panel eval` tells it;
and every figure against the formula that it is made of. One room of four has light that is rare
(rare_hunt.py), with closed forms of its own. `explain` says what the review says,
and twice the light gives twice the figure. A line a comparison, with its seed and its
difference in standard errors; at last how these are spread. --seed: that room alone. --rare:
rooms whose light is rare alone. --unguided: frames are, which takes half as long. --keep: a
line a room that is done is added to the file; rooms that have one there are not done again.
"""
import argparse
import csv
import itertools
import json
import math
import os
import random
import shutil
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "image"))
from exr import Frame  # noqa: E402
from gltf import unit  # noqa: E402
import reflection  # noqa: E402
from review import ROOT, Report, Reviewer, moment, request  # noqa: E402
import kept_rooms  # noqa: E402
import rare_hunt  # noqa: E402
import rare_rooms  # noqa: E402
import rooms  # noqa: E402

TOO_FAR = 4       # standard errors
SIZE, SAMPLES = "96x54", 12
SWEEP_EVERY = 16      # rooms: a response costs as much as all else together
FRAME_SHARE = 0.008   # of what the frame shows: pixels on the part's rim are in or out whole
CLOSED_SHARE = 0.004  # what the sum over directions, and D65 between wavelengths, leave
SWEEP_SHARE = 0.01    # a response's triangles, a table of skies: tests/bench/recombination.py
CLOSED_POINTS = 3     # to a side of the symbol


# ---- what is asked --------------------------------------------------------------------------

def question(draw, room, seed, reviewer):
    """A uniform sky, twice of it, a sun, and a sweep of that sun alone; lamps by themselves."""
    luminance = draw.uniform(50, 8000)
    azimuth, elevation = draw.randrange(0, 360, 10), draw.randrange(5, 60, 5)
    sun = {"azimuth_deg": azimuth, "elevation_deg": elevation,
           "illuminance_lx": reviewer.sun_lux(elevation)}
    conditions = [moment("sky", type="constant", luminance=luminance),
                  moment("sun", type="sky", sun=sun)]
    if room.has_lamps:
        conditions.append(moment("lamps", type="constant", luminance=0.01))
    if draw.random() < 0.3 and not room.is_empty:
        conditions.append(moment("twice", type="constant", luminance=2 * luminance))
    if seed % SWEEP_EVERY == 11:  # none of every day's ten
        conditions.append({"name": "suns", "sweep": {"sky": "sky", "sun": {
            "azimuth_deg": [azimuth, azimuth, 1], "elevation_deg": [elevation, elevation, 1]}}})
    for condition in conditions:
        condition["level"] = "set"
    return request(conditions=conditions, precision={"contrast": 0.02, "seed": seed},
                   frames={"worst": 0}, levels={"set": {"*": round(draw.uniform(0.05, 1), 3)}},
                   symbols={"bar": {"display": "screen", "uv": rooms.SYMBOL_UV}})


# ---- figures against what they are made of --------------------------------------------------

def check_case(report, name, case):
    """The contrast decides, by its interval. (Reviewer.review holds the other laws.)"""
    for limit in case["limits"]:
        if limit["kind"] == "contrast_ratio" and not limit["upper"]:
            least, most = limit["interval"]
            says = ("pass" if least >= limit["value"] else
                    "fail" if most < limit["value"] else "too close")
            report.claim(says == limit["verdict"],
                         f"{name}: {limit['verdict']}, its interval says {says}")


def estimate(case):
    """What is reflected and its standard error."""
    low, high = case["reflected_interval"]
    return case["luminance_cd_m2"]["reflected"], (high - low) / 3.92


def part_of(case):
    return [case["judged_part_uv"][side] for side in ("left", "top", "right", "bottom")]


def reflected_for(light, contrast):
    """What makes (high + R) / (low + R) = contrast."""
    high = max(light["foreground"], light["background"])
    low = min(light["foreground"], light["background"])
    return (high - contrast * low) / (contrast - 1)


def of_causes(case):
    halves = [cause["interval"][1] - cause["cd_m2"] for cause in case["causes"]]
    return (sum(cause["cd_m2"] for cause in case["causes"]), math.hypot(*halves) / 1.96)


# ---- a frame --------------------------------------------------------------------------------

def luminance_of(channels, name, i):
    return (0.2126 * channels[name + ".R"][i] + 0.7152 * channels[name + ".G"][i] +
            0.0722 * channels[name + ".B"][i])


def light_of(condition):
    """The same light for `render`."""
    sky = condition["environment"]
    if sky["type"] == "constant":
        return ["--environment", f"constant:{sky['luminance']}"]
    sun = sky["sun"]
    return ["--environment", "sky:clear", "--sun", "{azimuth_deg},{elevation_deg},"
            "{illuminance_lx}".format(**sun)]


def of_frame(reviewer, condition, level, part, more):
    """Two frames that differ in their seeds: the mean over the judged part by its area, as a
    review counts, its error by the pixels' differences; and `measure` of one of them, with the
    mean of that frame's layer by the display's part of each pixel, as it counts."""
    layers, total, squares, both = [], 0, 0, 0
    for seed in (1, 2):
        name = f"frame{seed}.exr"
        done = reviewer.run("render", "dash.gltf", *light_of(condition), "--size", SIZE,
                            "--spp", str(SAMPLES), "--layers", "all", "--seed", str(seed),
                            "-o", name, "--display-level", f"screen={100 * level}",
                            *second(reviewer, level), *more)
        assert done.returncode == 0, done.stderr
        layers.append(Frame(os.path.join(reviewer.folder, name)).channels)
    one, two = layers
    left, top, right, bottom = part
    shown = [i for i, display in enumerate(one["id.display"]) if display == 0]
    for i in shown:
        if one["display.coverage"][i] < 1 or not (
                left < one["uv.U"][i] < right and top < one["uv.V"][i] < bottom):
            continue
        weight = one["depth.Z"][i] ** 2 / math.cos(math.radians(one["display.theta"][i]))
        a, b = (luminance_of(c, "display.reflected", i) for c in layers)
        total, both = total + weight, both + weight * (a + b) / 2
        squares += (weight * (a - b) / 2) ** 2
    told = json.loads(reviewer.run("measure", "frame1.exr", "--display", "screen",
                                   "--json").stdout)["contrast"]
    others = one.get("display.second.coverage", [0] * len(one["id.display"]))
    parts = [(one["display.coverage"][i], luminance_of(one, "display.reflected", i))
             for i in shown if not others[i] > 0]
    by_part = sum(part * light for part, light in parts) / sum(part for part, _ in parts)
    return (both / total, math.sqrt(squares) / total), told, by_part


def second(reviewer, level):
    """The other display's level, where the room has one."""
    with open(os.path.join(reviewer.folder, "dash.gltf"), encoding="utf-8") as file:
        names = [m["name"] for m in json.load(file)["materials"]]
    return ["--display-level", f"second={100 * level}"] if "second" in names else []


def check_measure(report, name, told, by_part):
    """`measure` against the layer and its own formula."""
    contrast = (told["white_cd_m2"] + told["reflected_cd_m2"]) / (
        told["black_cd_m2"] + told["reflected_cd_m2"])
    report.claim(math.isclose(contrast, told["value"], rel_tol=1e-4),
                 f"{name}: measure says {told['value']}, its luminances {contrast}")
    low, high = told["interval"]
    # no upper end: so few samples have no halves, and nothing may be reflected on black
    is_open = high is None and told["black_cd_m2"] == 0
    report.claim(low <= told["value"] and (is_open or told["value"] <= (high or 0)),
                 f"{name}: {told['value']} outside {told['interval']}")
    report.claim(math.isclose(told["reflected_cd_m2"], by_part, rel_tol=1e-4),
                 f"{name}: measure says {told['reflected_cd_m2']}, the layer {by_part}")


# ---- a closed form --------------------------------------------------------------------------

def of_panel(reviewer, room, part, luminance):
    """The mean over points of the judged part of the uniform sky's reflection."""
    path = os.path.join(reviewer.folder, room.panel())
    panel = reflection.Panel(reviewer.program, path, reviewer.folder)
    left, top, right, bottom = part
    total = 0
    for i in range(CLOSED_POINTS):
        for j in range(CLOSED_POINTS):
            u = left + (i + 0.5) / CLOSED_POINTS * (right - left)
            v = top + (j + 0.5) / CLOSED_POINTS * (bottom - top)
            point = [(u - 0.5) * rooms.WIDTH, (0.5 - v) * rooms.HEIGHT, 0]
            eye = unit([e - p for e, p in zip(room.eye, point)])
            total += reflection.under_sky(panel, eye, 60, 48)[0]
    return total / CLOSED_POINTS ** 2 * luminance / reflection.SKY_CD_M2


# ---- one room -------------------------------------------------------------------------------

class Hunt:
    def __init__(self, report, reviewer, of_frames):
        """of_frames: options of the renders."""
        self.report, self.reviewer, self.of_frames, self.found = report, reviewer, of_frames, []
        self.held = []  # does the interval of a light that is hardly known hold the truth?

    def compare(self, name, one, other):
        """Two figures with their standard errors."""
        (a, sure_a), (b, sure_b) = one, other
        z = (a - b) / max(math.hypot(sure_a, sure_b), 1e-6 * abs(a), 1e-12)
        self.found.append(z)
        words = f"{name}: {a:.6g} +- {sure_a:.2g}, {b:.6g} +- {sure_b:.2g} cd/m2, z {z:.2f}"
        print(words, flush=True)
        self.report.claim(abs(z) <= TOO_FAR, words)

    def check_cases(self, seed, room, asked, cases):
        level = asked["levels"]["set"]["*"]
        for case in cases:
            name = f"seed {seed}, {case['condition']}"
            check_case(self.report, name, case)
            if case["reason"] != "hidden":
                self.compare(name + ", causes", estimate(case), of_causes(case))
        moments = [c for c in asked["conditions"] if "environment" in c]
        k = seed % len(moments)
        frame, told, by_part = of_frame(self.reviewer, moments[k], level, part_of(cases[k]),
                                           self.of_frames)
        name = f"seed {seed}, {moments[k]['name']}"
        self.compare(name + ", frame", estimate(cases[k]),
                     (frame[0], math.hypot(frame[1], FRAME_SHARE * frame[0])))
        check_measure(self.report, name, told, by_part)
        if room.is_empty:
            wanted = of_panel(self.reviewer, room, part_of(cases[0]),
                              moments[0]["environment"]["luminance"])
            self.compare(f"seed {seed}, sky, closed", estimate(cases[0]),
                         (wanted, CLOSED_SHARE * wanted))

    def check_sweep(self, seed, out, review, cases):
        if not review["sweeps"]:
            return
        table = os.path.join(self.reviewer.folder, out, review["sweeps"][0]["table"])
        with open(table, encoding="utf-8") as file:
            row = list(csv.DictReader(file))[0]
        wanted, light = float(row["reflected_cd_m2"]), cases[1]["luminance_cd_m2"]
        least = reflected_for(light, float(row["contrast_high"]))
        sure = math.hypot((wanted - least) / 1.96, SWEEP_SHARE * wanted)
        self.compare(f"seed {seed}, sun, sweep", estimate(cases[1]), (wanted, sure))

    def check_twice(self, seed, cases):
        """Under twice the light the display's own light in it stays as it is."""
        twice = [case for case in cases if case["condition"] == "twice"]
        for case in twice:
            (a, sure_a), (b, sure_b) = estimate(cases[0]), estimate(case)
            own, sure = 2 * a - b, math.hypot(2 * sure_a, sure_b)
            self.report.claim(-TOO_FAR * sure <= own <= a + TOO_FAR * sure,
                              f"seed {seed}: {a:.6g}, under twice the light {b:.6g}")

    def check_explain(self, seed, case, *sun):
        done = self.reviewer.run("explain", "r.json", "--condition", case["condition"], *sun,
                                 "--json")
        told, wanted = json.loads(done.stdout), case["contrast_ratio"]
        same = math.isclose(told["contrast_ratio"] or 0, wanted or 0, rel_tol=1e-4)
        self.report.claim(same, f"seed {seed}, {case['condition']}: explain says "
                                f"{told['contrast_ratio']}, the review {wanted}")

    def go(self, seed):
        """A law that is broken is told, and the hunt goes on."""
        try:
            self.room(seed)
        except AssertionError as error:
            self.report.claim(False, f"seed {seed}: {error}")

    def room(self, seed):
        if rare_rooms.is_rare(seed):
            rare_hunt.RareRoom(self, seed).go()
            return
        draw = random.Random(seed)
        room = rooms.Room(draw, seed % 5 == 0)
        room.scene.write(os.path.join(self.reviewer.folder, "dash.gltf"))
        asked, out = question(draw, room, seed, self.reviewer), f"out{seed}"
        status, review = self.reviewer.review(asked, out)
        self.report.claim(status == (0 if review["pass"] else 1),
                          f"seed {seed}: status {status}")
        cases = review["cases"]
        worst = [sweep["worst"] for sweep in review["sweeps"]]
        self.check_cases(seed, room, asked, cases + worst)
        self.check_sweep(seed, out, review, cases)
        self.check_twice(seed, cases)
        self.check_explain(seed, cases[seed % len(cases)])
        for case in worst:
            sun = case["sun"]
            self.check_explain(seed, case, "--sun",
                               f"{sun['azimuth_deg']},{sun['elevation_deg']}")
        shutil.rmtree(os.path.join(self.reviewer.folder, out))

    def tell_spread(self):
        found = self.found
        for low in range(-5, 5):
            count = sum(low <= z < low + 1 for z in found)
            print(f"z {low:+d} to {low + 1:+d}: {count:4d} {'#' * (count // 5 or count > 0)}")
        outside = sum(abs(z) > 1.96 for z in found)
        print(f"{outside} of {len(found)} differ by more than 1.96 standard errors, expected "
              f"{0.05 * len(found):.0f}")
        allowed = 0.05 * len(found) + 4 * math.sqrt(0.05 * 0.95 * len(found))
        self.report.claim(outside <= allowed,
                          f"{outside} of {len(found)} outside, {allowed:.0f} allowed")
        missed, count = self.held.count(False), len(self.held)
        allowed = 0.07 * count + 2 * math.sqrt(0.07 * 0.93 * count)
        print(f"{count - missed} of {count} intervals of a sky by a small opening hold it")
        self.report.claim(missed <= allowed, f"{missed} of {count} intervals of a sky by a "
                                             f"small opening miss it, {allowed:.0f} allowed")


def read_words():
    parser = argparse.ArgumentParser(description="a hunt for wrong answers")
    parser.add_argument("program")
    parser.add_argument("--seed", type=int)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--count", type=int, default=10)
    parser.add_argument("--rare", action="store_true")
    parser.add_argument("--unguided", action="store_true")
    parser.add_argument("--keep")
    return parser.parse_args()


def seeds_of(words):
    if words.seed is not None:
        return [words.seed]
    seeds = (seed for seed in itertools.count(words.first)
             if rare_rooms.is_rare(seed) or not words.rare)
    return list(itertools.islice(seeds, words.count))


def main():
    words, report = read_words(), Report()
    of_frames = ["--no-guiding"] if words.unguided else []
    with tempfile.TemporaryDirectory() as folder:
        for panel in rooms.PANELS:
            shutil.copy(os.path.join(ROOT, "assets", "panels", panel), folder)
        hunt = Hunt(report, Reviewer(words.program, folder), of_frames)
        kept_rooms.go(hunt, seeds_of(words), words.keep)
    hunt.tell_spread()
    return report.finish()


if __name__ == "__main__":
    sys.exit(main())
