# SPDX-License-Identifier: Apache-2.0
"""decide.py PARHELION -- a case on its limit spends the budget of --decide-times to the path;
one within the panel's own error says that no time decides it.
"""
import json
import os
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


def check_panel(report, reviewer, truth):
    """What lies within the panel's own error no number of paths calls, and nothing is named.
    (What is named otherwise holds nine times in ten: tests/unit/test_read_on.c.)"""
    profile(reviewer.folder, truth * (1 + AWAY))
    first = case_of(reviewer, asked(PATHS, 0.05, 3), "first")
    with open(os.path.join(reviewer.folder, "first", "index.html"), encoding="utf-8") as file:
        page = file.read()
    report.claim(first["verdict"] == "too close" and first["decide_times"] is None and
                 "no time decides it" in page, f"{first['verdict']}, {first['decide_times']}")


def check_budget(report, reviewer, truth):
    profile(reviewer.folder, truth)
    document = asked(PATHS, 0.05, 2)
    first = case_of(reviewer, document, "first")
    spent = case_of(reviewer, document, "spent", "--decide-times", "9")
    report.claim(spent["verdict"] == "too close", f"on its limit: {spent['verdict']}")
    wanted = rounds(first["paths"], 9 * PATHS) // 32 * 32
    report.claim(spent["paths"] == wanted, f"{spent['paths']} paths, wanted {wanted}")
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
        check_panel(report, reviewer, truth)
        check_budget(report, reviewer, truth)
    return report.finish()


if __name__ == "__main__":
    sys.exit(main(sys.argv[-1]))
