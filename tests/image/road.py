# SPDX-License-Identifier: Apache-2.0
"""road.py PARHELION -- the threshold increment of a gaze at a road by night, from reviews of a
small cabin: the level that the first one names makes a second one, of another seed, that lies
on the limit within its interval; figures that belong together agree; what cannot be evaluated
says so.
"""
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "structure"))
from report import Report  # noqa: E402
from gltf import Scene, png  # noqa: E402

ROOT = os.path.dirname(os.path.dirname(HERE))
PANEL = os.path.join(ROOT, "assets", "panels", "ips_cluster.panel")
LIMIT, AGES, ROAD = 10.0, [25, 70], 0.3


def display(scene, name, corner, right, up):
    bars = png(60, 30, [[255 if 20 <= x < 40 and 8 <= y < 22 else 60 for x in range(60)
                         for _ in range(3)] for y in range(30)])
    material = scene.material(name, extensions={"PARHELION_display": {
        "panel": "ips.panel", "content": {"index": scene.image("image/png", bars)},
        "level": 1}})
    scene.quad(material, corner, right, up)


def cabin(folder):
    scene = Scene()
    display(scene, "wide", [0.25, -0.2, -0.8], [0.4, 0, 0.15], [0, 0.18, 0])
    display(scene, "cluster", [-0.15, -0.3, -0.7], [0.3, 0, 0], [0, 0.12, -0.02])
    trim = scene.lambert(0.1, double_sided=True)
    scene.quad(trim, [-1, -0.5, 0.3], [2, 0, 0], [0, 0, -1.5])
    scene.quad(scene.window(1.52), [-1, -0.5, -1.3], [2, 0, 0], [0, 1, 0.5])
    scene.facing_quad(scene.emitter(1000), [-6, 6, -25], [6, -6, 25], 0.5)
    scene.view("eye", [0, 0, 0], [0, 0, -1], 40)
    scene.write(os.path.join(folder, "cabin.gltf"))
    shutil.copy(PANEL, os.path.join(folder, "ips.panel"))
    with open(os.path.join(ROOT, "assets", "profiles", "iso-15008.json"),
              encoding="utf-8") as file:
        profile = json.load(file)
    profile["threshold_increment_max_pct"] = LIMIT
    with open(os.path.join(folder, "own.json"), "w", encoding="utf-8") as file:
        json.dump(profile, file)


def request(levels, seed, **more):
    return {"title": "road", "scene": ["cabin.gltf"], "profile": "iso-15008",
            "eyes": {"eye": {"camera": "eye"}},
            "gaze": [{"name": "road", "direction": [0, 0, -1],
                      "road": {"luminance_cd_m2": ROAD, "s_p": 1.4, "ages_years": AGES}}],
            "symbols": {"bar": {"display": "cluster", "uv": [0.2, 0.2, 0.8, 0.8],
                                "polarity": "light-on-dark"}},
            "levels": {"set": levels}, "precision": {"seed": seed, "paths": 16384},
            "conditions": [{"name": "night", "level": "set"}], "frames": {"worst": 0}, **more}


class Reviews:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def run(self, name, document):
        path = os.path.join(self.folder, f"{name}.review.json")
        with open(path, "w", encoding="utf-8") as file:
            json.dump(document, file)
        out = os.path.join(self.folder, name)
        done = subprocess.run([self.program, "review", path, "-o", out, "--profile",
                               os.path.join(self.folder, "own.json")], capture_output=True,
                              text=True)
        return done, out

    def gaze(self, name, document):
        done, out = self.run(name, document)
        if done.returncode not in (0, 1):
            sys.exit(done.stderr)
        with open(os.path.join(out, "review.json"), encoding="utf-8") as file:
            return done, out, json.load(file)["gazes"][0]


def verdict_of(limit):
    low, high = limit["interval"]
    return ("pass" if high <= limit["value"] else "fail" if low > limit["value"]
            else "too close")


def check_figures(report, road):
    """A figure lies in its interval, a verdict follows from that, parts make the whole."""
    for age in road["ages"]:
        low, high = age["threshold_increment_interval"]
        report.claim(low <= age["threshold_increment_pct"] <= high, "increment in interval")
        report.claim(age["limit"]["verdict"] == verdict_of(age["limit"]),
                     f"verdict of {age['age_years']} years: {age['limit']}")
        report.claim(math.isclose(age["threshold_increment_pct"],
                                  65 * age["veil_cd_m2"] / ROAD ** 0.8, rel_tol=1e-4),
                     "the increment is of its veil")
        for one in age["displays"]:
            report.claim(math.isclose(one["threshold_increment_pct"],
                                      one["veil_share"] * age["threshold_increment_pct"],
                                      rel_tol=1e-4), "a display's share makes its increment")
            report.claim(math.isclose(one["straight_share"] + one["mirrored_share"] +
                                      one["scattered_share"], 1, rel_tol=1e-4), "all ways")
    report.claim(abs(road["mesopic_cd_m2"] - 0.3250) < 1e-4, "mesopic luminance of 0.3 cd/m2")


def check_level(report, reviews, first):
    """All displays but one stay: at its level the review is on the limit."""
    age = first["ages"][-1]
    wide = next(d for d in age["displays"] if d["display"] == "wide")
    report.claim(0 < wide["level_most"] < wide["level"], f"wide must be dimmed: {wide}")
    levels = {"wide": wide["level_most"], "cluster": 0.01}
    _, _, gaze = reviews.gaze("at", request(levels, 7))
    there = gaze["road"]["ages"][-1]
    low, high = there["threshold_increment_interval"]
    print(f"at level {wide['level_most']:.4g}: {there['threshold_increment_pct']:.4g} %, "
          f"{low:.4g} to {high:.4g}; limit {LIMIT:g} %")
    report.claim(low <= LIMIT <= high, "the level lies on the limit")
    report.claim(there["limit"]["verdict"] == "too close", "and is too close there")
    levels["wide"] = 0.97 * wide["level_most_interval"][0]
    done, _, gaze = reviews.gaze("below", request(levels, 8))
    report.claim(gaze["verdict"] == "pass", "below its bounds the limit is kept")
    report.claim("\npass" in done.stdout, "and the review passes")
    levels["wide"] = 1.03 * wide["level_most_interval"][1]
    done, out, gaze = reviews.gaze("above", request(levels, 9))
    report.claim(gaze["verdict"] == "fail" and done.returncode == 1,
                 "above them it is not, and the review fails")
    with open(os.path.join(out, "junit.xml"), encoding="utf-8") as file:
        report.claim('failures="1"' in file.read(), "one test of CI fails")


def check_levels(report, road):
    rows = road["dimming"]
    report.claim(len(rows) == len(AGES) * 6 * 3, "rows of levels")
    own = next(r for r in rows if r["display"] == "wide" and r["road_cd_m2"] == ROAD and
               r["age_years"] == AGES[-1])
    wide = next(d for d in road["ages"][-1]["displays"] if d["display"] == "wide")
    report.claim(math.isclose(own["level_most"], wide["level_most"], rel_tol=1e-4),
                 "its own road's level")
    most = [r["level_most"] for r in rows if r["display"] == "wide" and r["age_years"] == 25]
    report.claim(most == sorted(most), "brighter roads allow more")


def check_left_out(report, reviews):
    day = request({"*": 0.01}, 1)
    day["conditions"].append({"name": "day", "environment": {
        "type": "sky", "sun": {"azimuth_deg": 0, "elevation_deg": 30,
                               "illuminance_lx": 50000}}})
    done, _, _ = reviews.gaze("day", day)
    report.claim("threshold increment not evaluated: the sun is above the horizon" in
                 done.stdout, "by day it is not evaluated, and that is said")
    sweep = request({"*": 0.01}, 1)
    sweep["conditions"] = [{"name": "suns", "sweep": {"sun": {
        "azimuth_deg": [0, 10, 10], "elevation_deg": [10, 10, 1]}, "sky": "sky"}}]
    done, _ = reviews.run("sweep", sweep)
    report.claim(done.returncode not in (0, 1) and "evaluated in moments" in done.stderr,
                 f"a request without a moment is refused: {done.stderr}")
    sweep["gaze"][0]["road"]["conditions"] = ["suns"]
    done, _, gaze = reviews.gaze("dark", sweep)
    report.claim(gaze["road"]["after_dark"] and gaze["condition"] == "suns" and
                 gaze["limits"], "a sweep that is named has it after dark")
    report.claim(gaze["road"]["ages"][0]["displays"][0]["straight_share"] > 0.9,
                 "its displays make it")
    symbols = request({"*": 0.01}, 1)
    symbols["gaze"][0] = {"at": "symbols", "road": {"luminance_cd_m2": 1}}
    done, _ = reviews.run("symbols", symbols)
    report.claim("road" in done.stderr and "required" in done.stderr, "a road at symbols")


def increment_of(finding, age):
    return next(line for line in finding["lines"]
                if line["quantity"] == "threshold_increment" and line["age_years"] == age)


def check_variants(report, reviews):
    """Half as bright displays make half of their increment; the rest stays."""
    document = request({"*": 0.05}, 1)
    document["variants"] = {"half": {"brightness": {"*": 0.5}},
                            "back": {"eyes": {"eye": {"move_m": [0, 0, 0.3]}}}}
    done, out, gaze = reviews.gaze("variants", document)
    with open(os.path.join(out, "review.json"), encoding="utf-8") as file:
        half, back = json.load(file)["variants"]
    age = gaze["road"]["ages"][-1]
    shown = age["threshold_increment_pct"]
    displays = sum(d["threshold_increment_pct"] for d in age["displays"])
    row, line = half["findings"][0], increment_of(half["findings"][0], age["age_years"])
    report.claim(line["found"][0] == shown, "before is the review's")
    report.claim(math.isclose(line["found"][1], shown - displays / 2, rel_tol=1e-3),
                 f"light is linear: {line}, {displays} of {shown}")
    report.claim(row["verdict"][0] == "fail" and half["verdict"] == "pass",
                 "and what it keeps counts")
    behind = increment_of(back["findings"][0], age["age_years"])
    report.claim(behind["interval"][1][0] > behind["interval"][0][1] and
                 back["findings"][0]["verdict"][1] == back["verdict"],
                 "from farther back they stand nearer to the gaze and veil more")
    report.claim("variant half: road, seen by eye, night: threshold increment" in done.stdout,
                 "the console has it")


def main():
    report = Report()
    program = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        cabin(folder)
        reviews = Reviews(program, folder)
        _, _, gaze = reviews.gaze("first", request({"wide": 0.5, "cluster": 0.01}, 3))
        check_figures(report, gaze["road"])
        check_levels(report, gaze["road"])
        check_level(report, reviews, gaze["road"])
        check_left_out(report, reviews)
        check_variants(report, reviews)
    report.finish()


if __name__ == "__main__":
    main()
