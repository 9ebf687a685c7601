# SPDX-License-Identifier: Apache-2.0
"""visibility_levels.py PARHELION -- the visibility levels of a review of the car by night:
Adrian's formula, written down here once more, of the luminances that stand beside them; for an
age the level that a review with an observer of that age has for him; the limit of a profile;
nothing of it in a review that does not ask; the remedy built. A minute.
"""
import csv
import json
import math
import os
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

SCENES = os.path.join(ROOT, "scenes")
OBSERVER, AGES, GLANCE_S = 30, [64, 70], 0.2


def factor_of_age(years):
    return (years - 19) ** 2 / 2160 + 0.99 if years < 64 else (years - 56.6) ** 2 / 116.3 + 1.43


def factor_of_glance(size, light, seconds):
    x, y = math.log10(size) + 0.523, math.log10(light) + 6
    by_size = 0.36 - 0.0972 * x * x / (x * x - 2.513 * x + 2.7895)
    by_light = 0.355 - 0.1217 * y * y / (y * y - 10.4 * y + 52.28)
    return 1 + math.hypot(by_size, by_light) / 2.1 / seconds


def threshold(size, light, years, seconds):
    """Of a target lighter than its background, from 0.00418 cd/m2 on."""
    lg = math.log10(light)
    if light >= 0.6:
        small = math.log10(4.1925 * light ** 0.1556) + 0.1684 * light ** 0.5867
        large = 0.05946 * light ** 0.466
    else:
        small = 10 ** (-0.072 + 0.3372 * lg + 0.0866 * lg * lg)
        large = 10 ** (-1.256 + 0.319 * lg)
    return (2.6 * (small / size + large) ** 2 * factor_of_age(years) *
            factor_of_glance(size, light, seconds))


def request(name, folder, **changes):
    """The shipped glance by night, without the rest."""
    def beside(*path):
        return os.path.relpath(os.path.join(*path), folder)
    with open(os.path.join(SCENES, "glance.review.json"), encoding="utf-8") as file:
        made = json.load(file)
    made["scene"] = [beside(SCENES, each) for each in made["scene"]]
    made["symbols"]["speed"]["content"] = beside(ROOT, "assets", "content", "cluster.png")
    night = made["conditions"][0]
    night["lights"] = [beside(SCENES, each) for each in night["lights"]]
    made["conditions"] = [night]
    del made["variants"]
    made["frames"]["worst"] = 0
    made["precision"] = {"contrast": 0.05, "paths": 16384}
    path = os.path.join(folder, name + ".review.json")
    with open(path, "w", encoding="utf-8") as file:
        json.dump({**made, "observer": {"age_years": OBSERVER}, **changes}, file)
    return path


class Reviews:
    def __init__(self, report, program, folder):
        self.report, self.program, self.folder = report, program, folder

    def review(self, name, **changes):
        out = os.path.join(self.folder, name)
        done = subprocess.run([self.program, "review", request(name, self.folder, **changes),
                               "-o", out, "--root", "/"], capture_output=True, text=True)
        if done.returncode not in (0, 1):
            sys.exit(done.stderr)
        with open(os.path.join(out, "review.json"), encoding="utf-8") as file:
            return json.load(file), done.stdout

    def check_case(self, case):
        claim, light = self.report.claim, case["luminance_cd_m2"]
        levels = case["visibility_levels"]
        claim([v["age_years"] for v in levels] == [OBSERVER, *AGES], f"ages: {levels}")
        claim([v["observer"] for v in levels] == [True, False, False], "who the observer is")
        for v in levels:
            adapted = light["background"] + light["reflected"] + light["veil"] * v["veil_times"]
            least = threshold(v["size_arcmin"], adapted, v["age_years"], GLANCE_S)
            level = (light["foreground"] - light["background"]) / least
            low, high = v["interval"]
            claim(abs(v["level"] / level - 1) < 3e-5,
                  f"{v['age_years']} years: {v['level']}, by the formula {level}")
            claim(abs(v["threshold_cd_m2"] / least - 1) < 3e-5, f"threshold {least}")
            claim(0.8 * level < low < v["level"] < high < 1.2 * level, f"interval {low} {high}")
            claim(0 < v["veil_doubt"] < 0.1, f"the veil is known within {v['veil_doubt']}")
            claim((v["doubts"] is None) == (v["age_years"] != 64), f"doubts: {v['doubts']}")
        claim(levels[0]["veil_times"] == 1 < levels[1]["veil_times"] < levels[2]["veil_times"],
              "an older eye has less veil")

    def check_older(self, young, old):
        """What is told of somebody of 70 is what an observer of 70 is told of himself."""
        for case, his in zip(young["cases"], old["cases"]):
            told, own = case["visibility_levels"][2], his["visibility_levels"][0]
            self.report.claim(own["age_years"] == 70 and own["observer"], "the observer of 70")
            self.report.claim(abs(told["level"] / own["level"] - 1) < 1e-4,
                              f"at 70 {told['level']}, by an observer of 70 {own['level']}")

    def check_limit(self, plain, limit):
        """Just below and above the least level: pass and fail, whose level decides is named."""
        least = min(v["level"] for v in plain["cases"][0]["visibility_levels"])
        for share, verdict in ((0.8, "pass"), (1.1, "fail")):
            limit["value"] = share * least
            with open(os.path.join(self.folder, "own.json"), "w", encoding="utf-8") as file:
                json.dump({"title": "own", "edition": "1", "limits": [limit], "ambient": {
                    "night_below_lx": 10, "twilight_below_lx": 100, "source": "a test",
                    "read_in_the_standard": False}}, file)
            review, console = self.review(
                verdict, profile=os.path.join(self.folder, "own.json"),
                visibility={"ages": AGES, "glance_s": GLANCE_S})
            case = review["cases"][0]
            self.report.claim(case["verdict"] == verdict, f"{share}: {case['verdict']}")
            self.report.claim(case["judged"]["age_years"] == 70, f"judged: {case['judged']}")
            self.report.claim("at 70 years (minimum " in console, console)
            self.report.claim(case["judged"]["found"] == min(
                v["level"] for v in case["visibility_levels"]), "another figure is judged")
        self.check_remedy(case)

    def check_remedy(self, case):
        """A display as bright as it is said to take passes, within 3 % of what is foretold."""
        brighter = case["remedies"]
        self.report.claim(len(brighter) == 1, f"remedies: {case['remedies']}")
        if not brighter:
            return
        review, _ = self.review("brighter", profile=os.path.join(self.folder, "own.json"),
                                levels={"night": {"*": brighter[0]["level"]}},
                                visibility={"ages": AGES, "glance_s": GLANCE_S})
        then, found = brighter[0]["then"], review["cases"][0]["judged"]
        self.report.claim(then["verdict"] == found["verdict"] == "pass", f"{then}, {found}")
        self.report.claim(abs(found["found"] / then["found"] - 1) < 0.03, f"{then}, {found}")

    def check_all(self):
        young, console = self.review("young", visibility={"ages": AGES, "glance_s": GLANCE_S})
        for case in young["cases"]:
            self.check_case(case)
            first = case["visibility_levels"][0]
            self.report.claim("visibility level" in console and " at 30 years, " in console,
                              f"the console says nothing of {first}")
        with open(os.path.join(self.folder, "young", "cases.csv"), encoding="utf-8") as file:
            decided = [row for row in csv.DictReader(file) if row["decides"] == "true"]
            for row, case in zip(decided, young["cases"]):
                self.report.claim(float(row["visibility_level_70_years"]) ==
                                  case["visibility_levels"][2]["level"], f"cases.csv: {row}")
        old, _ = self.review("old", observer={"age_years": 70},
                             visibility={"glance_s": GLANCE_S})
        self.check_older(young, old)
        self.check_limit(young, {"ambient": "any", "kind": "visibility_level", "unit": "1",
                                 "source": "a test", "read_in_the_standard": False})
        none, console = self.review("none")
        words = json.dumps(none) + console
        self.report.claim("isibility level" not in words and "visibility_levels" not in words,
                          "a review that does not ask tells levels")


def main():
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        Reviews(report, os.path.abspath(sys.argv[1]), folder).check_all()
    return report.finish()


if __name__ == "__main__":
    sys.exit(main())
