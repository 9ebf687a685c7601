# SPDX-License-Identifier: Apache-2.0
"""decide.py PARHELION -- a case that is too close to call names what calls it; asked again with
that, it is called, and rightly; one that lies on its limit spends its budget to the path and
says what more would take.
"""
import json
import os
import re
import shutil
import sys
import tempfile

from review import PANEL, ROOT, Report, Reviewer, dashboard, moment, request

PATHS = 8192
AWAY = 0.0012  # of the limit, from the true contrast


def profile(folder, limit):
    with open(os.path.join(ROOT, "assets", "profiles", "iso-15008.json"),
              encoding="utf-8") as file:
        document = json.load(file)
    one = document["limits"][0]
    document["limits"] = [{**one, "ambient": ["night", "twilight", "day", "sun"],
                           "value": limit}]
    with open(os.path.join(folder, "one.json"), "w", encoding="utf-8") as file:
        json.dump(document, file)


def asked(paths, precision, seed):
    return request(conditions=[moment("grey", type="constant", luminance=3000)],
                   precision={"contrast": precision, "clear": precision, "paths": paths,
                              "seed": seed})


def case_of(reviewer, document, out, *options):
    document = dict(document, profile="iso-15008")
    _, review = reviewer.review(document, out, "--profile", "one.json", *options)
    return review["cases"][0]


def rounds(first, budget):
    """The reading's lengths, as assets/guides/glare-review.md says."""
    last, left = first, budget - first
    while left >= 1024:
        last = left if left < 16 * last else 8 * last
        left -= last
    return last


def check_named(report, reviewer, truth):
    """Seeds until some cannot be called by few paths."""
    called = named = 0
    for seed in range(3, 11):
        side = 1 if seed % 2 else -1
        limit = truth * (1 + side * AWAY)
        profile(reviewer.folder, limit)
        document = asked(PATHS, 0.05, seed)
        first = case_of(reviewer, document, "first")
        if first["verdict"] != "too close":
            continue
        named += 1
        times = first["decide_times"]
        page = open(os.path.join(reviewer.folder, "first", "index.html"),
                    encoding="utf-8").read()
        said = re.search(r"; --decide(-times (\d+))? calls it within ", page)
        report.claim(said and (int(said[2] or 64) >= times),
                     f"the page says {said and said[0]}, review.json {times}")
        second = case_of(reviewer, document, "second", "--decide-times", str(int(times)))
        called += second["verdict"] != "too close"
        right = "pass" if side < 0 else "fail"
        report.claim(second["verdict"] in (right, "too close"),
                     f"seed {seed}: {second['verdict']}, right were {right}")
        if named == 3:
            break
    report.claim(named == 3 and called >= 2, f"{called} of {named} are called by what is named")


def check_budget(report, reviewer, truth):
    profile(reviewer.folder, truth)
    document = asked(PATHS, 0.05, 2)
    first = case_of(reviewer, document, "first")
    spent = case_of(reviewer, document, "spent", "--decide-times", "9")
    report.claim(spent["verdict"] == "too close", f"on its limit: {spent['verdict']}")
    wanted = rounds(first["paths"], 9 * PATHS) // 32 * 32
    report.claim(spent["paths"] == wanted, f"{spent['paths']} paths, wanted {wanted}")
    report.claim(spent["decide_times"] > 9, f"{spent['decide_times']} times would decide it")
    done = reviewer.run("review", "r.json", "-o", "none", "--decide-times", "1")
    report.claim(done.returncode == 2 and "--decide-times" in done.stderr, done.stderr)


def main(program):
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        reviewer = Reviewer(program, folder)
        shutil.copy(PANEL, os.path.join(folder, "ips.panel"))
        dashboard().write(os.path.join(folder, "dash.gltf"))
        profile(folder, 3)
        truth = case_of(reviewer, asked(1 << 21, 0.0001, 1), "truth")["contrast_ratio"]
        check_named(report, reviewer, truth)
        check_budget(report, reviewer, truth)
    return report.finish()


if __name__ == "__main__":
    sys.exit(main(sys.argv[-1]))
