# SPDX-License-Identifier: Apache-2.0
"""minutes.py PARHELION BENCH_MINUTES [EVERY [PATHS [HEADING ...]]] -- failing minutes of a
year, as sweeps tell them, beside paths traced for the sun of every minute.

One small display in a niche of white walls, one symbol, one eye, a limit of 3 : 1, at each
heading (90 unless given). Sweeps in steps of 60, 15 and 1 minutes say for how long it fails;
BENCH_MINUTES asks each minute by itself, with PATHS (64) of the sun, of EVERY so manyth day (1:
of all). Steps of the same days that lie below that limit, and below others, are counted in the
sweeps' tables.
"""
import csv
import json
import os
import shutil
import subprocess
import sys
import tempfile

from recombination import PANEL, PRECISION, niche, request

HALF = [0.03, 0.015]  # of the display, m
LIMIT = 3
OTHERS = [2.5, 2, 1.5]
STEPS = [60, 15, 1]
PROFILE = {"title": "one limit", "edition": "1", "ambient": {
    "night_below_lx": 5, "twilight_below_lx": 100, "source": "bench",
    "read_in_the_standard": False}, "limits": [{
        "ambient": "any", "kind": "contrast_ratio", "value": LIMIT, "unit": "1",
        "source": "bench", "read_in_the_standard": False}]}


def year(step, heading):
    return {"name": f"{step} {heading:g}", "level": "1", "sweep": {
        "year": 2026, "where": [48.14, 11.58, 520], "step_minutes": step,
        "headings_deg": [heading], "weather": "clear"}}


def write(folder, name, document):
    with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
        json.dump(document, file)


def run(command, folder):
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1):
        sys.exit(done.stderr)
    return done.stdout


def by_table(path, step, every):
    """Minutes with less contrast than each limit, of those days, and of all days with sun."""
    with open(path, encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    found = [float(row["contrast_ratio"]) for row in rows
             if (int(row["day_of_year"]) - 1) % every == 0]
    below = [step * sum(c < limit for c in found) for limit in [LIMIT] + OTHERS]
    return below, step * len(rows)


def tell(folder, out, every):
    with open(os.path.join(folder, out, "review.json"), encoding="utf-8") as file:
        sweeps = json.load(file)["sweeps"]
    for sweep in sweeps:
        step, heading = sweep["condition"].split()
        counts, minutes = by_table(os.path.join(folder, out, sweep["table"]), int(step),
                                   every)
        print(f"heading {heading}, steps of {step}: {sweep['failed_share'] * minutes:.0f} of "
              f"{minutes} minutes fail; below {[LIMIT] + OTHERS} in its table {counts}")


def main(program, bench, every="1", paths="64", *headings):
    with tempfile.TemporaryDirectory() as folder:
        shutil.copy(PANEL, os.path.join(folder, "ips.panel"))
        niche(HALF).write(os.path.join(folder, "niche.gltf"))
        write(folder, "one.json", PROFILE)
        for heading in [float(h) for h in headings] or [90.0]:
            document = request([year(step, heading) for step in STEPS], PRECISION["any"])
            document.update(profile="./one.json", levels={"1": {"*": 1}})
            write(folder, "r.json", document)
            run([os.path.abspath(program), "review", "r.json", "-o", "out", "--quiet"], folder)
            tell(folder, "out", int(every))
            limits = [str(limit) for limit in [LIMIT] + OTHERS]
            print(run([os.path.abspath(bench), paths, every, "r.json"] + limits, folder),
                  end="")


if __name__ == "__main__":
    main(*sys.argv[1:])
