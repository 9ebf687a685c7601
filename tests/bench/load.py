# SPDX-License-Identifier: Apache-2.0
"""load.py [--keep DIR] [--threads N] [--most TRIANGLES] BENCH_LOAD [TRIANGLES ...] -- how long
scenes of 0.3, 1 and 10 million triangles (many_parts.py) take to the first pixel, step by step,
and how much memory: cold (the file is not in the system's cache) and warm (the second start).
--most: of a mesh, so that fewer make more parts. Times are of all processors, in brackets the
clock's, which means something on a quiet machine only.
"""
import argparse
import os
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


def row(name, start, steps, counts):
    cells = [f"{counts['triangles']:,}", f"{counts['parts']:,}",
             f"{os.path.getsize(name) / 1e6:.0f}", start]
    cells += [f"{steps[step][1]:.2f} ({steps[step][0]:.2f})" for step in STEPS]
    first = [sum(steps[step][k] for step in STEPS) for k in (1, 0)]
    base = steps["start"][3]
    cells += [f"{first[0]:.2f} ({first[1]:.2f})", f"{steps['read'][1]:.2f}"]
    cells += [f"{(steps[step][k] - base) * 1e6 / counts['triangles']:.0f}"
              for step, k in (("load", 3), ("load", 2), ("tree", 3), ("tree", 2))]
    return "| " + " | ".join(cells) + " |"


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("program")
    parser.add_argument("triangles", nargs="*", type=int)
    parser.add_argument("--keep")
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("--most", type=int, default=100_000)
    args = parser.parse_args()
    heads = ["triangles", "parts", "MB", "start", *STEPS, "first pixel", "reading alone",
             "load: peak B", "kept B", "tree: peak B", "kept B"]
    print("| " + " | ".join(heads) + " |\n" + "| --- " * len(heads) + "|")
    with tempfile.TemporaryDirectory() as temporary:
        folder = args.keep or temporary
        for triangles in args.triangles or (300_000, 1_000_000, 10_000_000):
            name = make(folder, triangles, args.most)
            for start in ("cold", "warm"):
                if start == "cold":
                    forget(name)
                print(row(name, start, *measure(args.program, name, args.threads)), flush=True)


if __name__ == "__main__":
    main()
