# SPDX-License-Identifier: Apache-2.0
"""unjudged.py PARHELION -- what a review does not know it does not call a pass: a symbol that
is hidden, a panel that says it is not usable, light via a material without data, a light for
which the profile has no limit. Each is "cannot be judged" with its reason, on the console, the
page, in JSON and in JUnit, with status 1; what need not be seen, or is not asked, does not
count.
"""
import html
import json
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
sys.path.insert(0, os.path.join(ROOT, "tests", "hostile"))
from judged_scene import request, write_scene  # noqa: E402
from report import Report  # noqa: E402

GREY = {"name": "grey", "pbrMetallicRoughness": {"baseColorFactor": [0.4, 0.4, 0.4, 1]}}
BARE = {"name": "bare"}
POST = (dict(GREY, name="post"), [-0.035, 0.005, 0.35], 0.45)  # before the bar
WALL = [0, 0, 1.6]
NIGHT_ONLY = {"title": "By night", "edition": "1", "veil": False,
              "ambient": {"night_below_lx": 5, "twilight_below_lx": 50, "source": "this test",
                          "read_in_the_standard": False},
              "limits": [{"ambient": "night", "kind": "contrast_ratio", "value": 2, "unit": "1",
                          "source": "this test", "read_in_the_standard": False}]}


class Reviews:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def run(self, document, *words):
        shutil.rmtree(os.path.join(self.folder, "out"), ignore_errors=True)
        with open(os.path.join(self.folder, "r.review.json"), "w", encoding="utf-8") as file:
            json.dump(document, file)
        return subprocess.run([self.program, "review", "r.review.json", "-o", "out", "--quiet",
                               *words], cwd=self.folder, capture_output=True, text=True,
                              timeout=600)

    def review(self, document, *words):
        """Status, console, JSON, headline, and whether the headline is green."""
        done = self.run(document, *words)
        if done.returncode > 1:
            sys.exit(done.stderr)
        with open(os.path.join(self.folder, "out", "review.json"), encoding="utf-8") as file:
            found = json.load(file)
        with open(os.path.join(self.folder, "out", "index.html"), encoding="utf-8") as file:
            page = file.read()
        line = re.search(r'<div class="verdict([^"]*)"><h1>(.*?)</h1>', page, re.S)
        return done, found, re.sub("<[^>]*>", "", line.group(2)), "same" in line.group(1)

    def junit(self):
        return xml.parse(os.path.join(self.folder, "out", "junit.xml")).getroot().attrib


def asked(light=100.0, **more):
    document = request({"grey": ("low", light)}, {"low": 0.5})
    document["precision"] = {"contrast": 0.05, "paths": 8192}
    document.update(more)
    return document


def with_visible(document, visible):
    document["symbols"]["bar"]["visible"] = visible
    return document


def claim_unjudged(report, name, reviews, document, reason, words, *options):
    """The whole review is what its bar is."""
    done, found, headline, is_green = reviews.review(document, *options)
    case = next(c for c in found["cases"] if c["symbol"] == "bar")
    report.claim(case["verdict"] == "cannot be judged" and case["reason"] == reason,
                 f"{name}: {case['verdict']}, {case['reason']}")
    report.claim(found["verdict"] == "cannot be judged" and not found["pass"] and
                 done.returncode == 1, f"{name}: {found['verdict']}, status {done.returncode}")
    report.claim(headline.startswith("Cannot be judged") and words in headline and
                 not is_green, f"{name}: headline '{headline}'")
    row = next(row for row in done.stdout.splitlines() if "grey, eye, bar" in row)
    report.claim(row.startswith("cannot be judged") and words in row, f"{name}: '{row}'")
    report.claim(done.stdout.splitlines()[-1] == found["headline"], f"{name}: {done.stdout}")
    report.claim(not case["remedies"], f"{name}: offers {case['remedies']}")
    report.claim(int(reviews.junit()["errors"]) >= 1, f"{name}: JUnit {reviews.junit()}")
    return case, found


# ---- hidden ---------------------------------------------------------------------------------

def check_hidden(report, reviews):
    """A post before the bar; the letter beside it is seen and passes."""
    write_scene(reviews.folder, [POST])
    case, found = claim_unjudged(report, "hidden", reviews, asked(), "hidden", "post")
    report.claim(case["contrast_ratio"] is None and case["visible_share"] == 0 and
                 case["hidden_by"][0]["share"] > 0.99, f"hidden: {case['contrast_ratio']}")
    other = next(c for c in found["cases"] if c["symbol"] == "letter")
    report.claim(other["verdict"] == "pass", f"the letter: {other['verdict']}")
    with open(os.path.join(reviews.folder, "out", "summary-bar.html"),
              encoding="utf-8") as file:
        summary = file.read()
    report.claim("Cannot be judged" in summary and "0.00 : 1" not in summary and
                 "0 : 1" not in re.sub("<svg.*?</svg>", "", summary, flags=re.S) and
                 "raise the brightness level" not in summary, "hidden: the summary")


def check_optional(report, reviews):
    write_scene(reviews.folder, [POST])
    for visible in ("optional", {"eye": "optional"}):
        done, found, headline, is_green = reviews.review(with_visible(asked(), visible))
        case = next(c for c in found["cases"] if c["symbol"] == "bar")
        report.claim(case["optional"] and case["reason"] == "hidden", f"{visible}: {case}")
        report.claim(done.returncode == 0 and found["verdict"] == "pass" and is_green and
                     "letter" in headline, f"{visible}: {done.returncode} '{headline}'")
        report.claim(reviews.junit()["errors"] == "0" and reviews.junit()["skipped"] == "1",
                     f"{visible}: JUnit {reviews.junit()}")
    both = {"eye": {"camera": "eye"}, "other": {"position_m": [0.02, 0.01, 0.7]}}
    done, found, _, _ = reviews.review(with_visible(asked(eyes=both), {"eye": "optional"}))
    report.claim(done.returncode == 1 and found["verdict"] == "cannot be judged",
                 f"the other eye's: {done.returncode}")
    for visible, place in (({"nobody": "optional"}, "/symbols/bar/visible"),
                           ("perhaps", "/symbols/bar"),
                           ({"eye": True}, "/symbols/bar/visible")):
        done = reviews.run(with_visible(asked(), visible))
        report.claim(done.returncode == 3 and len(done.stderr.splitlines()) == 1 and
                     place in done.stderr, f"{visible}: {done.returncode} {done.stderr}")


def check_optional_that_fails(report, reviews):
    """What an eye sees is judged, though it need not see it."""
    write_scene(reviews.folder)
    done, found, _, _ = reviews.review(with_visible(asked(light=30000.0), "optional"))
    case = next(c for c in found["cases"] if c["symbol"] == "bar")
    report.claim(case["verdict"] == "fail" and done.returncode == 1, f"seen: {case['verdict']}")


def check_partly_hidden(report, reviews):
    """A plate half way to the eye, its edge's shadow at a share of the bar: of a half and less
    nobody reads it; what is judged says how much of it is hidden."""
    sweep = {"name": "suns", "level": "low", "sweep": {"sky": "sky", "sun": {
        "azimuth_deg": [0, 0, 1], "elevation_deg": [30, 30, 1]}}}
    for cover in (0.25, 0.75, 0.97):
        edge = (-0.075 + 0.05 * cover + 0.02) / 2
        write_scene(reviews.folder, [(POST[0], [edge - 0.045, 0.005, 0.35], 0.45)])
        both = asked()
        both["conditions"].append(sweep)
        done, found, headline, is_green = reviews.review(both)
        cases = found["cases"] + [s["worst"] for s in found["sweeps"]]
        for case in (c for c in cases if c["symbol"] == "bar"):
            report.claim(abs(case["visible_share"] - 1 + cover) < 0.02,
                         f"{cover} hidden: seen {case['visible_share']}")
            is_hidden = cover > 0.5
            report.claim((case["reason"] == "hidden") == is_hidden and
                         (case["contrast_ratio"] is None) == is_hidden and
                         not case["remedies"],
                         f"{cover} hidden: {case['verdict']}, {case['contrast_ratio']}")
        if cover < 0.5:
            report.claim("hidden by plate 0 (post) 25" in done.stdout, done.stdout)
        else:
            report.claim(done.returncode == 1 and not is_green and
                         "more than 50 % needed" in headline, headline)


def check_hidden_sweep(report, reviews):
    """Seen from behind, also by a box of places: none of them reads it."""
    write_scene(reviews.folder)
    sweep = {"name": "suns", "level": "low", "sweep": {"sky": "sky", "sun": {
        "azimuth_deg": [0, 0, 1], "elevation_deg": [30, 30, 1]}}}
    document = asked(conditions=[sweep], eyes={
        "back": {"position_m": [0, 0, -0.7]},
        "places": {"centre_m": [0, 0, -0.7], "half_size_m": [0.05, 0.05, 0],
                   "grid": [2, 2, 1]}})
    done, found, headline, _ = reviews.review(document)
    report.claim(done.returncode == 1 and "the display's own back" in html.unescape(headline),
                 f"behind: '{headline}'")
    for worst in (s["worst"] for s in found["sweeps"]):
        report.claim(worst["reason"] == "hidden" and worst["contrast_ratio"] is None and
                     worst["limit"] is None and worst["hidden_by"],
                     f"{worst['eye']}: {worst['reason']} {worst['contrast_ratio']}")
    report.claim(found["eye_places"] and
                 all(place["read_share"] == 0 for place in found["eye_places"]),
                 f"places: {found['eye_places']}")


# ---- panels, materials, limits --------------------------------------------------------------

def not_usable(reviews):
    """A panel of nothing but noise."""
    r, table = random.Random(1), os.path.join(reviews.folder, "noise.csv")
    out = os.path.join(reviews.folder, "not_usable.panel")
    with open(table, "w", encoding="utf-8") as file:
        file.write("theta,phi,X,Y,Z\n")
        for theta in range(0, 81, 4):
            for phi in range(0, 360 if theta else 1, 15):
                y = 500 * 2 ** r.uniform(-2, 2)
                file.write(f"{theta},{phi},{0.95 * y:.6g},{y:.6g},{1.09 * y:.6g}\n")
    subprocess.run([reviews.program, "panel", "fit", table, "-o", out, "--force", "--quiet"],
                   check=True, capture_output=True)
    return out


def check_panel(report, reviews):
    write_scene(reviews.folder, panel=not_usable(reviews))
    for options in ((), ("--strict",)):
        case, found = claim_unjudged(report, f"not usable {options}", reviews, asked(),
                                     "panel not usable", "not usable", *options)
        report.claim(all(c["reason"] == "panel not usable" for c in found["cases"]) and
                     found["panels"][0]["verdict"] == "not usable" and
                     found["panels"][0]["coarse"], f"panels: {found['panels']}")
    check = [reviews.program, "check", os.path.join(reviews.folder, "scene.gltf")]
    for options, status in ((["--strict"], 3), ([], 0)):
        done = subprocess.run(check + options, capture_output=True, text=True, check=False)
        report.claim(done.returncode == status and
                     "says of itself that it is not usable" in done.stdout,
                     f"check {options}: {done.returncode}")


def check_data(report, reviews):
    """A wall of a material without data; the same with a colour; and a small piece of it."""
    rows = [("wall", BARE, 40, True), ("a wall with a colour", GREY, 40, False),
            ("a chip", BARE, 0.2, False)]
    for name, material, scale, is_unjudged in rows:
        write_scene(reviews.folder, [(material, WALL, scale)])
        if is_unjudged:
            case, _ = claim_unjudged(report, name, reviews, asked(), "no optical data",
                                     "without optical data")
            report.claim(case["without_data_share"] > 0.1, f"{case['without_data_share']}")
            continue
        done, found, _, _ = reviews.review(asked())
        shares = [c["without_data_share"] for c in found["cases"]]
        report.claim(found["verdict"] == "pass" and done.returncode == 0 and
                     max(shares) <= 0.1, f"{name}: {found['verdict']}, {shares}")


def check_data_of_variants(report, reviews):
    """A variant has its own share: a wall that is described then, or no longer is."""
    plain = {"pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 1]}}
    data = {"pbrMetallicRoughness": {"baseColorFactor": [0.4, 0.4, 0.4, 1]}}
    for name, wall, change, told in (("described", BARE, data, "pass"),
                                     ("left white", GREY, plain, "cannot be judged")):
        write_scene(reviews.folder, [(wall, WALL, 40)])
        variants = {"other wall": {"materials": {wall["name"]: change}},
                    "brighter": {"brightness": {"*": 1.1}}}
        _, found, _, _ = reviews.review(asked(variants=variants))
        shares = {v["name"]: v["cases"][0]["verdict"] for v in found["variants"]}
        report.claim(shares == {"other wall": told, "brighter": found["verdict"]} and
                     found["verdict"] != told, f"{name}: {found['verdict']}, {shares}")


def check_limits(report, reviews):
    """By night there is a limit, by day none: that does not count, and alone is no pass."""
    write_scene(reviews.folder)
    with open(os.path.join(reviews.folder, "night.json"), "w", encoding="utf-8") as file:
        json.dump(NIGHT_ONLY, file)
    done, found, headline, is_green = reviews.review(asked(), "--profile", "night.json")
    report.claim(done.returncode == 1 and found["verdict"] == "cannot be judged" and
                 not is_green and "no limit" in headline,
                 f"by day: {done.returncode} {headline}")
    two = request({"grey": ("low", 100.0), "night": ("low", 0.1)}, {"low": 0.5})
    two["precision"] = {"contrast": 0.05, "paths": 8192}
    done, found, headline, is_green = reviews.review(two, "--profile", "night.json")
    report.claim(done.returncode == 0 and found["verdict"] == "pass" and is_green and
                 "night" in headline, f"both: {done.returncode} {headline}")


def check_older(report, reviews):
    """A review of before, which called it "not visible", is held against one of today."""
    write_scene(reviews.folder, [POST])
    reviews.review(asked())
    old = os.path.join(reviews.folder, "old")
    shutil.copytree(os.path.join(reviews.folder, "out"), old)
    path = os.path.join(old, "review.json")
    with open(path, encoding="utf-8") as file:
        before = json.load(file)
    for case in before["cases"]:
        for key in ("reason", "optional", "panel", "judged", "stroke_ratio"):
            case.pop(key)
    with open(path, "w", encoding="utf-8") as file:
        file.write(json.dumps(before).replace('"cannot be judged"', '"not visible"'))
    done = reviews.run(asked(), "--diff", "old")
    report.claim(done.returncode == 1, f"beside an older review: {done.stderr}")
    with open(os.path.join(reviews.folder, "out", "diff.json"), encoding="utf-8") as file:
        diff = json.load(file)
    report.claim(all(row["change"] == "same" for row in diff["findings"]), f"{diff['findings']}")


def main():
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        reviews = Reviews(os.path.abspath(sys.argv[1]), folder)
        for check in (check_hidden, check_optional, check_optional_that_fails,
                      check_partly_hidden, check_hidden_sweep, check_panel, check_data,
                      check_data_of_variants, check_limits, check_older):
            check(report, reviews)
    report.finish()


main()
