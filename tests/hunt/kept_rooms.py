# SPDX-License-Identifier: Apache-2.0
"""kept_rooms.py -- the rooms of a hunt one after the other, with what is left to do; those that
are done are kept in a file, a line each as JSON, so that a hunt that was cut off goes on. A
line counts for the same program and the same tests alone.
"""
import glob
import hashlib
import json
import os
import statistics
import sys
import time


def digest_of(program):
    """Of all that decides what is found."""
    digest, here = hashlib.sha256(), os.path.dirname(os.path.abspath(__file__))
    for path in [program, *sorted(glob.glob(os.path.join(here, "*.py")) +
                                  glob.glob(os.path.join(here, "..", "image", "*.py")))]:
        with open(path, "rb") as file:
            digest.update(file.read())
    return digest.hexdigest()[:16]


def read(path, digest):
    """{seed: what was found}. A line that was cut off does not count."""
    found = {}
    if path and os.path.exists(path):
        with open(path, encoding="utf-8") as file:
            for line in file:
                if line.endswith("\n"):
                    room = json.loads(line)
                    if room["of"] == digest:
                        found[room["seed"]] = room
    return found


def take(hunt, room):
    """Counts as if it had been done now."""
    hunt.report.passed += room["passed"]
    hunt.report.failed += room["failed"]
    hunt.found += room["z"]
    hunt.held += room["held"]


def do(hunt, seed):
    report, begin = hunt.report, time.monotonic()
    before = report.passed, report.failed, len(hunt.found), len(hunt.held)
    hunt.go(seed)
    return {"seed": seed, "passed": report.passed - before[0],
            "failed": report.failed - before[1], "z": hunt.found[before[2]:],
            "held": hunt.held[before[3]:], "seconds": round(time.monotonic() - begin, 1)}


def add(path, room):
    with open(path, "a", encoding="utf-8") as file:
        file.write(json.dumps(room) + "\n")


def go(hunt, seeds, path):
    """path: of the file; None: nothing is kept."""
    digest, times = digest_of(hunt.reviewer.program), []
    kept = read(path, digest)
    for i, seed in enumerate(seeds):
        if seed in kept:
            take(hunt, kept[seed])
            continue
        room = do(hunt, seed)
        times.append(room["seconds"])
        if path:
            add(path, {"of": digest, **room})
        left = sum(seed not in kept for seed in seeds[i + 1:]) * statistics.fmean(times)
        print(f"room {i + 1} of {len(seeds)}, {statistics.median(times):.0f} s each, about "
              f"{left / 60:.0f} minutes left", file=sys.stderr, flush=True)
