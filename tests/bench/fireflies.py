# SPDX-License-Identifier: Apache-2.0
"""fireflies.py [--views "A;B"] [--size WxH] [--spp N] [--seeds N] NAME=PARHELION[,OPTION] ...
-- how many pixels of a frame one rare sample made far too bright.

Each program renders each view with N samples and several seeds, an odd number of them. With M
the median over the seeds of a pixel's luminance, and low the half of the frame's key, below
which a frame's own relative error does not look (src/film/film.h): a firefly is a pixel of one
frame that is brighter than M + max(M, low), twice as bright as it should be. One in a single
frame does not move the median. With 64 samples a pixel's error is a tenth of that in these
views by day, so that the noise of many small samples makes none.

Told are the fireflies of a frame, least to most, on the average; of the squared relative errors
of all pixels (over max(M, low)) the share that is theirs; and that error without them.
"""
import argparse
import math
import os
import statistics
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from time_to_error import (VIEWS, half_key, luminance, programs_of,  # noqa: E402
                           render, views_of)


def count(frames):
    """Of each frame its fireflies; the sums of squared relative errors of theirs and of all."""
    middle = [statistics.median(values) for values in zip(*frames)]
    low = half_key(middle)
    found, theirs, every = [], 0, 0
    for frame in frames:
        number = 0
        for value, wanted in zip(frame, middle):
            error = (value - wanted) / max(wanted, low)
            every += error * error
            if error > 1:
                number += 1
                theirs += error * error
        found.append(number)
    return found, theirs, every


def measure(programs, words, arguments, folder):
    out = os.path.join(folder, "frame.exr")
    frames = {name: [] for name in programs}
    seconds = {name: [] for name in programs}
    for seed in range(1, arguments.seeds + 1):
        for name, program in programs.items():
            took, _ = render(program, words, arguments.size, arguments.spp, seed, out)
            frames[name].append(luminance(out))
            seconds[name].append(took)
    return frames, seconds


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--views", default="")
    parser.add_argument("--size", default="320x180")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("programs", nargs="+")
    arguments = parser.parse_args()
    if arguments.seeds % 2 == 0 or arguments.seeds < 3:
        parser.error("--seeds: an odd number, 3 or more")
    programs, views = programs_of(arguments.programs), views_of(arguments.views)
    print(f"{'view':18} {'program':12} {'fireflies':>15} {'their share':>12} "
          f"{'error without':>14} {'frame s':>8}")
    with tempfile.TemporaryDirectory() as folder:
        for view in views:
            frames, seconds = measure(programs, VIEWS[view], arguments, folder)
            for name in programs:
                found, theirs, every = count(frames[name])
                pixels = len(frames[name]) * len(frames[name][0])
                rest = math.sqrt((every - theirs) / pixels)
                told = f"{min(found)}-{max(found)}, {statistics.mean(found):.0f}"
                print(f"{view:18} {name:12} {told:>15} {100 * theirs / every:11.0f}% "
                      f"{100 * rest:13.2f}% {statistics.median(seconds[name]):8.2f}",
                      flush=True)


if __name__ == "__main__":
    main()
