# SPDX-License-Identifier: Apache-2.0
"""decide.py [--all] PARHELION -- within the panel's own error a review that reads on traces no
path more, and says why, and what would help. --all: of a panel that states no error a case on
its limit has the budget of --decide-times to the path, and of sixty near it, by seeds, limits
and levels, nine in ten are decided with what they name.
"""
import ctypes
import json
import math
import os
import random
import shutil
import struct
import sys
import tempfile

from review import PANEL, ROOT, Report, Reviewer, dashboard, moment, request

PATHS = 8192
AWAY = 0.0012  # of the limit, from the true contrast
ERRORS, UNKNOWN = 8, 99  # kinds of a .panel's sections (assets/guides/panel-format.md)
CHANCE = 1e-3  # of fewer decided ones than are asked for, if nine in ten are


def write_silent(path, library=ctypes.CDLL("libxxhash.so.0")):
    """The panel without the figures of its errors: their section has a kind that no reader
    knows."""
    with open(PANEL, "rb") as file:
        data = bytearray(file.read())
    for at in range(40, 40 + 16 * struct.unpack_from("<I", data, 32)[0], 16):
        if struct.unpack_from("<H", data, at)[0] == ERRORS:
            struct.pack_into("<H", data, at, UNKNOWN)
    rest = bytes(data[24:])
    library.XXH3_64bits.restype = ctypes.c_uint64
    library.XXH3_64bits.argtypes = [ctypes.c_char_p, ctypes.c_size_t]
    struct.pack_into("<Q", data, 16, library.XXH3_64bits(rest, len(rest)))
    with open(path, "wb") as file:
        file.write(data)


def profile(folder, limit):
    with open(os.path.join(ROOT, "assets", "profiles", "iso-15008.json"),
              encoding="utf-8") as file:
        document = json.load(file)
    one = document["limits"][0]
    document["limits"] = [{**one, "ambient": ["night", "twilight", "day", "sun"],
                           "value": limit}]
    with open(os.path.join(folder, "one.json"), "w", encoding="utf-8") as file:
        json.dump(document, file)


def asked(paths, precision, seed, level=1):
    return request(conditions=[dict(moment("grey", type="constant", luminance=3000),
                                    level="one")],
                   levels={"one": {"*": level}},
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


def texts(reviewer, out):
    """What the page and the table for a build server say."""
    for name in ("index.html", "junit.xml"):
        path = os.path.join(reviewer.folder, out, name)
        if os.path.exists(path):
            with open(path, encoding="utf-8") as file:
                yield name, file.read()


# ---- within the panel's own error --------------------------------------------------------

def check_panel(report, reviewer, truth):
    """What lies within the panel's own error no number of paths calls: none is named, none is
    spent, and what would help is said, on the console, the page and in JUnit."""
    profile(reviewer.folder, truth * (1 + AWAY))
    document = asked(PATHS, 0.05, 3)
    first = case_of(reviewer, document, "first")
    again = case_of(reviewer, document, "again", "--decide-times", "5000")
    for case in (first, again):
        report.claim(case["verdict"] == "too close" and case["open_by"] == "panel error" and
                     case["decide_times"] is None and case["paths_to_decide"] is None,
                     f"{case['verdict']}, {case['open_by']}, {case['decide_times']}")
    report.claim(first["paths"] == again["paths"],
                 f"{first['paths']} paths, then {again['paths']}")
    brighter = [r for r in first["remedies"] if r["kind"] == "brightness"]
    report.claim(len(brighter) == 1 and brighter[0]["then"]["verdict"] == "pass",
                 f"remedies: {first['remedies']}")
    said = "no number of paths decides it: the limit lies within the panel's own stated " \
           "error; what helps: the panel measured more exactly, or " + brighter[0]["what"]
    console = reviewer.run("review", "r.json", "-o", "again", "--profile", "one.json").stdout
    for name, text in [("console", console), *texts(reviewer, "again")]:
        text = text.replace("&#39;", "'").replace("&apos;", "'")
        report.claim(said in text and "nine times in ten" not in text,
                     f"{name} does not say: {said}")


# ---- a panel that states no error --------------------------------------------------------

def check_budget(report, reviewer, truth):
    profile(reviewer.folder, truth)
    document = asked(PATHS, 0.05, 2)
    first = case_of(reviewer, document, "first")
    spent = case_of(reviewer, document, "spent", "--decide-times", "9")
    report.claim(spent["verdict"] == "too close", f"on its limit: {spent['verdict']}")
    due = rounds(first["paths"], 9 * PATHS) // 32 * 32
    report.claim(spent["paths"] == due, f"{spent['paths']} paths, required {due}")
    done = reviewer.run("review", "r.json", "-o", "none", "--decide-times", "1")
    report.claim(done.returncode == 2 and "--decide-times" in done.stderr, done.stderr)


def fewest(runs, chance):
    """So many of them are reached but with CHANCE."""
    reached = 0
    for count in range(runs + 1):
        reached += math.comb(runs, count) * chance ** count * (1 - chance) ** (runs - count)
        if reached > CHANCE:
            return count
    return runs


def promise(reviewer, truth, level, seed):
    """A case too close to call, by a true contrast anywhere about its limit; None: it is called
    at once. Is it decided by what it names, and rightly?"""
    limit = truth * (1 + random.uniform(-0.02, 0.02))
    profile(reviewer.folder, limit)
    document = asked(PATHS, 0.05, seed, level)
    first = case_of(reviewer, document, "first")
    if first["verdict"] != "too close":
        return None
    if first["open_by"] != "paths" or not first["decide_times"]:
        raise AssertionError(f"seed {seed}: {first['open_by']}, {first['decide_times']}")
    times = max(2, int(first["decide_times"]))
    then = case_of(reviewer, document, "then", "--decide-times", str(times))
    return then["verdict"], then["verdict"] == ("pass" if truth > limit else "fail")


def check_promises(report, reviewer, truths, runs):
    decided = right = kept = 0
    seed = 100
    while kept < runs:
        seed += 1
        level = random.choice(list(truths))
        found = promise(reviewer, truths[level], level, seed)
        if not found:
            continue
        kept += 1
        decided += found[0] != "too close"
        right += found[1]
    least = fewest(runs, 0.9)
    print(f"{decided} of {runs} cases were decided by what they named, {right} rightly; "
          f"required {least}")
    report.claim(decided >= least, f"{decided} of {runs} are decided")
    report.claim(right >= decided - (runs - fewest(runs, 0.95)),
                 f"{right} of {decided} are right")


def truth_at(reviewer, level, paths):
    profile(reviewer.folder, 3)
    return case_of(reviewer, asked(paths, 0.0001, 1, level), "truth")["contrast_ratio"]


def main(words):
    report = Report()
    random.seed(20)
    with tempfile.TemporaryDirectory() as folder:
        reviewer = Reviewer(words[-1], folder)
        dashboard().write(os.path.join(folder, "dash.gltf"))
        shutil.copy(PANEL, os.path.join(folder, "ips.panel"))
        check_panel(report, reviewer, truth_at(reviewer, 1, 1 << 17))
        if "--all" in words:
            write_silent(os.path.join(folder, "ips.panel"))
            truths = {level: truth_at(reviewer, level, 1 << 20) for level in (1, 0.5)}
            check_budget(report, reviewer, truths[1])
            check_promises(report, reviewer, truths, 60)
    return report.finish()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
