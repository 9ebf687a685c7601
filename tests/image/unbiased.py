# SPDX-License-Identifier: Apache-2.0
"""unbiased.py PARHELION [--seeds N] -- samples where a pilot finds noise, taken by
what was learnt, have the mean of samples that know neither.

Of N seeds (64) with `--for noise` and of a quarter as many plain frames of 32 times the
samples, the mean luminances of blocks of pixels: no block may differ by more than chance allows
one of so many (0.1 % in Student's distribution), nor all of them together. Spreads are those of
the seeds: no variance layer is believed. The last frame of each scene stays in .build/unbiased.
"""
import argparse
import math
import os
import statistics
import subprocess
import sys
from statistics import NormalDist

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.normpath(os.path.join(HERE, "..", ".."))
sys.path.insert(0, os.path.join(HERE, "..", "structure"))
from exr import Frame  # noqa: E402
from report import Report  # noqa: E402

CASES = {
    "car_noon": ["car_dashboard.gltf", "noon.gltf"],
    "car_night": ["car_dashboard.gltf", "night.gltf"],
    "deck_low_sun": ["cockpit.gltf", "low_sun_left.gltf", "--camera", "captain"],
}
SIZE, BLOCK = (96, 54), (8, 9)
SAMPLES, PLAIN_SAMPLES = 16, 512
RGB = (("R", 0.2126), ("G", 0.7152), ("B", 0.0722))
CHANCE = 0.001


def blocks(path):
    """Mean luminance of each block of the frame."""
    c = Frame(path).channels
    y = [sum(k * c[n][i] for n, k in RGB) for i in range(SIZE[0] * SIZE[1])]
    return [statistics.fmean(y[row * SIZE[0] + column]
                             for row in range(top, top + BLOCK[1])
                             for column in range(left, left + BLOCK[0]))
            for top in range(0, SIZE[1], BLOCK[1]) for left in range(0, SIZE[0], BLOCK[0])]


def render(program, words, out, *more):
    words = [os.path.join("scenes", word) if word.endswith(".gltf") else word for word in words]
    done = subprocess.run(
        [program, "render", *words, "-o", out, "--size", "{}x{}".format(*SIZE), "--quiet",
         *more], cwd=ROOT, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"unbiased.py: {out}: {done.stderr.strip()}")
    return blocks(out)


def mean_and_square(values):
    """Of independent values: their mean, and its squared standard error."""
    return statistics.fmean(values), statistics.variance(values) / len(values)


def apart(ours, theirs):
    """Of two sets of independent values: their means' difference in standard errors, and the
    degrees of freedom of that (Welch, 1947)."""
    (a, u), (b, v) = mean_and_square(ours), mean_and_square(theirs)
    freedom = (u + v) ** 2 / (u * u / (len(ours) - 1) + v * v / (len(theirs) - 1))
    return (a - b) / math.sqrt(u + v), freedom


def normal_of_student(t, freedom):
    """As unlikely as t is in Student's distribution (Wallace, 1959)."""
    size = math.sqrt(freedom * math.log1p(t * t / freedom))
    return math.copysign((8 * freedom + 1) / (8 * freedom + 3) * size, t)


def normal_of_square(square, freedom):
    """As unlikely as that is in the distribution of chi square (Wilson and Hilferty, 1931)."""
    spread = 2 / (9 * freedom)
    return ((square / freedom) ** (1 / 3) - (1 - spread)) / math.sqrt(spread)


def most_by_chance(trials):
    """What the largest of so many normal scores stays below, but for CHANCE."""
    return NormalDist().inv_cdf(1 - CHANCE / (2 * trials))


def check(report, name, ours, theirs):
    """ours, theirs: for each seed the blocks."""
    scores = [normal_of_student(*apart(a, b)) for a, b in zip(zip(*ours), zip(*theirs))]
    most, square = max(scores, key=abs), sum(z * z for z in scores)
    whole = normal_of_student(*apart([statistics.fmean(f) for f in ours],
                                     [statistics.fmean(f) for f in theirs]))
    ratio = statistics.fmean(map(statistics.fmean, ours)) / \
        statistics.fmean(map(statistics.fmean, theirs))
    print(f"{name}: mean {ratio:.5f} of the plain one, {whole:+.2f} standard errors; "
          f"{len(scores)} blocks, rms {math.sqrt(square / len(scores)):.2f}, most {most:+.2f}")
    report.claim(abs(whole) < most_by_chance(1), f"{name}: the mean, {whole:+.2f} sigma")
    report.claim(abs(most) < most_by_chance(len(scores)), f"{name}: a block, {most:+.2f} sigma")
    report.claim(normal_of_square(square, len(scores)) < most_by_chance(1),
                 f"{name}: the blocks' squares sum to {square:.1f} of {len(scores)}")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("parhelion")
    parser.add_argument("--seeds", type=int, default=64, help="8 or more (64)")
    arguments = parser.parse_args()
    if arguments.seeds < 8:
        parser.error("--seeds: required: 8 or more, for two plain frames have a spread")
    program, report = os.path.abspath(arguments.parhelion), Report()
    folder = os.path.join(ROOT, ".build", "unbiased")
    os.makedirs(folder, exist_ok=True)
    for name, words in CASES.items():
        frame = os.path.join(folder, f"{name}.exr")
        ours = [render(program, words, frame, "--spp", str(SAMPLES), "--for", "noise",
                       "--seed", str(seed)) for seed in range(arguments.seeds)]
        theirs = [render(program, words, frame, "--spp", str(PLAIN_SAMPLES),
                         "--no-guiding", "--seed", str(1000 + seed))
                  for seed in range(arguments.seeds // 4)]
        check(report, name, ours, theirs)
    report.finish()


main()
