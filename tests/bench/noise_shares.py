# SPDX-License-Identifier: Apache-2.0
"""noise_shares.py PARHELION [--views "car, noon;..."] [--size 320x180] [--spp 32] [--pairs 2]

What `--for noise` saves: rays to equal error, beside a frame whose pixels all have as many
samples. The error is what frames of two seeds differ by, so that the program does not judge
itself; rays do not depend on what else the machine does. At 5 % error the pilot's own rays are
counted as well.
"""
import argparse
import json
import math
import os
import statistics
import subprocess
import sys
import tempfile

from time_to_error import ROOT, VIEWS, half_key, luminance, views_of

GOAL, PILOT = 0.05, 4  # samples a pixel that do not count


def render(program, words, size, spp, seed, folder):
    """Rays, and luminances row by row."""
    out = os.path.join(folder, "frame.exr")
    done = subprocess.run([program, "render", *words, "--size", size, "--spp", str(spp),
                           "--seed", str(seed), "--quiet", "--json", "-o", out, "--field",
                           os.path.join(folder, "field")], cwd=ROOT, capture_output=True,
                          text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(done.args)}: {done.stderr}")
    return json.loads(done.stdout)["rays"], luminance(out)


def error_and_rays(program, words, arguments, spp, folder):
    """Means of sigma / max(Y, half key) and of a frame's rays: two values of one spread differ
    by 2 / sqrt(pi) sigma on average."""
    errors, rays = [], []
    for pair in range(arguments.pairs):
        frames = [render(program, words, arguments.size, spp, 2 * pair + k, folder)
                  for k in (0, 1)]
        means = [(a + b) / 2 for a, b in zip(frames[0][1], frames[1][1])]
        low = half_key(means)
        errors.append(math.sqrt(math.pi) / 2 * statistics.mean(
            abs(a - b) / max(mean, low)
            for a, b, mean in zip(frames[0][1], frames[1][1], means)))
        rays += [frame[0] for frame in frames]
    return statistics.mean(errors), statistics.mean(rays)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--views", default="car, noon;deck, low sun;deck, cloud noon")
    parser.add_argument("--size", default="320x180")
    parser.add_argument("--spp", type=int, default=32)
    parser.add_argument("--pairs", type=int, default=2)
    arguments = parser.parse_args()
    program = os.path.abspath(arguments.program)
    print(f"{'view':18} error %   of rays   with the pilot's at 5 %")
    for view in views_of(arguments.views):
        with tempfile.TemporaryDirectory() as folder:
            words = VIEWS[view]
            even, rays = error_and_rays(program, words, arguments, arguments.spp, folder)
            noise = [*words, "--for", "noise"]
            quarter, _ = render(program, noise, arguments.size, arguments.spp, 0, folder)
            spp = round(arguments.spp * rays / quarter)
            error, taken = error_and_rays(program, noise, arguments, spp, folder)
        ratio = error ** 2 * taken / (even ** 2 * rays)
        pilot = PILOT / (arguments.spp * (even / GOAL) ** 2)
        print(f"{view:18} {100 * even:7.2f} {ratio:9.3f} {ratio + pilot:9.3f}", flush=True)


if __name__ == "__main__":
    main()
