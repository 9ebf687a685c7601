# SPDX-License-Identifier: Apache-2.0
"""load.py [--keep DIR] [--runs N] [--threads N] [--most TRIANGLES] BENCH_LOAD [TRIANGLES ...]
-- how long scenes of 0.3, 1 and 10 million triangles (many_parts.py) take to the first pixel,
step by step, and how much memory: cold (the file is not in the system's cache) and warm (the
second start). --most: of a mesh, so that fewer make more parts. Times are of all processors, in
brackets the clock's, which means something on a quiet machine only: medians of the runs, and of
the clock's time to the first pixel the least and the most.
"""
import argparse
import os
import statistics
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
PYTHON = "/usr/bin/python3"  # has Debian's numpy
STEPS = ("load", "tree", "lights", "learning", "pixel")


def make(folder, triangles, most):
    name = os.path.join(folder, f"{triangles}_{most}.glb")
    if not os.path.exists(name):
        subprocess.run([PYTHON, os.path.join(HERE, "many_parts.py"), name, str(triangles),
                        str(most)], check=True, stdout=subprocess.DEVNULL)
    return name


def forget(name):
    """The file's pages leave the cache, unless somebody else holds them."""
    with open(name, "rb") as file:
        os.fsync(file.fileno())
        os.posix_fadvise(file.fileno(), 0, 0, os.POSIX_FADV_DONTNEED)


def measure(program, name, threads):
    """{step: (clock s, processor s, MB held, MB at most)} and {"triangles", "parts"}."""
    done = subprocess.run([program, str(threads), name], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stderr)
    *steps, last = [line.split() for line in done.stdout.splitlines()]
    return ({step[0]: [float(word) for word in step[1:]] for step in steps},
            {last[i]: int(last[i + 1]) for i in range(0, len(last), 2)})


def clock(steps):
    return sum(steps[step][0] for step in STEPS)


def measure_all(program, name, threads, start, runs):
    """measure, medians of the runs, and the clock's seconds of each."""
    each = []
    for _ in range(runs):
        if start == "cold":
            forget(name)
        each.append(measure(program, name, threads))
    steps = {step: [statistics.median(values)
                    for values in zip(*(run[step] for run, _ in each))] for step in each[0][0]}
    return steps, each[0][1], [clock(run) for run, _ in each]


def row(name, start, steps, counts, clocks):
    cells = [f"{counts['triangles']:,}", f"{counts['parts']:,}",
             f"{os.path.getsize(name) / 1e6:.0f}", start]
    cells += [f"{steps[step][1]:.2f} ({steps[step][0]:.2f})" for step in STEPS]
    base = steps["start"][3]
    cells += [f"{sum(steps[step][1] for step in STEPS):.2f}",
              f"{statistics.median(clocks):.2f} ({min(clocks):.2f} to {max(clocks):.2f})",
              f"{steps['read'][1]:.2f}"]
    cells += [f"{(steps[step][k] - base) * 1e6 / counts['triangles']:.0f}"
              for step, k in (("load", 3), ("load", 2), ("tree", 3), ("tree", 2))]
    return "| " + " | ".join(cells) + " |"


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("program")
    parser.add_argument("triangles", nargs="*", type=int)
    parser.add_argument("--keep")
    parser.add_argument("--runs", type=int, default=1)
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("--most", type=int, default=100_000)
    args = parser.parse_args()
    heads = ["triangles", "parts", "MB", "start", *STEPS, "all", "first pixel by the clock",
             "reading alone", "load: peak B", "kept B", "tree: peak B", "kept B"]
    print("| " + " | ".join(heads) + " |\n" + "| --- " * len(heads) + "|")
    with tempfile.TemporaryDirectory() as temporary:
        folder = args.keep or temporary
        os.makedirs(folder, exist_ok=True)
        for triangles in args.triangles or (300_000, 1_000_000, 10_000_000):
            name = make(folder, triangles, args.most)
            for start in ("cold", "warm"):
                print(row(name, start, *measure_all(args.program, name, args.threads, start,
                                                    args.runs)), flush=True)


if __name__ == "__main__":
    main()
