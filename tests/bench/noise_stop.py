#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""noise_stop.py PARHELION [--seeds N] [--scene NAME ...] [--goal R ...] -- what
`render --noise R` makes of frames whose light is rare.

Renders each scene with N seeds (400) to each relative error, and once in a while a plain frame
of very many samples, the truth. Prints of each: the samples taken; the bias of the frames' mean
luminance and its standard error; the error that the answers tell (of those that know it) beside
the true one, which is the mean over pixels of the root of the mean square, over the seeds, of
the distance from the truth, by the pixel's luminance or half the frame's key, as the option
defines it; and how many of the answers say that light is rare and the error not yet known.

--truth SAMPLES: of the plain frames, a pixel. --check: fails where the bias is above four
standard errors, or the error of those who know it, if one in five does, a third off the truth.
"""
import argparse
import concurrent.futures
import json
import math
import os
import statistics
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "image"))
from exr import Frame  # noqa: E402
from gltf import Scene  # noqa: E402

sys.path.insert(0, os.path.join(HERE, "..", "structure"))
from report import Report  # noqa: E402

SIZE = (16, 9)
LEAST = 16  # samples of any frame with --noise
GOALS = (0.3, 0.2, 0.1, 0.05)
LAMP, SUN = 10000, 500  # cd/m2, lx
RGB = (("R", 0.2126729), ("G", 0.7151522), ("B", 0.0721750))


def room(scene, reflectance=0.5):
    scene.box_inside(scene.lambert(reflectance), [-1, 0, -1], [1, 2, 1])
    scene.view("eye", [0, 1, 0.95], [0, -0.25, -1], 60)


def lamp(scene):
    """10 cm wide, under the ceiling."""
    scene.facing_quad(scene.emitter(LAMP), [0.3, 1.98, -0.2], [0, -1, 0], 0.1)


def chrome():
    scene = Scene()
    room(scene)
    lamp(scene)
    scene.sphere(scene.metal(0.9), [-0.25, 0.35, -0.35], 0.35)
    return scene


def satin():
    scene = Scene()
    room(scene)
    lamp(scene)
    scene.sphere(scene.metal(0.9, 0.25), [-0.25, 0.35, -0.35], 0.35)
    return scene


def hole():
    """The lamp gives most of the light; a roof with a hole of 30 cm lets in some sun, whose
    patch on the floor gives the rest."""
    scene = Scene()
    walls, low, high = scene.lambert(0.5), 0.25, 0.55
    room(scene)
    del scene.document["scenes"][0]["nodes"][1]  # the ceiling
    for x0, z0, x1, z1 in ((-1, -1, 1, -0.15), (-1, 0.15, 1, 1), (-1, -0.15, low, 0.15),
                           (high, -0.15, 1, 0.15)):
        scene.quad(walls, [x0, 2, z0], [x1 - x0, 0, 0], [0, 0, z1 - z0])
    scene.facing_quad(scene.emitter(LAMP), [-0.5, 1.98, -0.3], [0, -1, 0], 0.1)
    scene.light("directional", SUN, direction=[-0.2, -1, -0.1])
    return scene


SCENES = {"chrome": chrome, "satin": satin, "hole": hole}


def luminances(path):
    c = Frame(path).channels
    return [sum(k * c[n][i] for n, k in RGB) for i in range(len(c["R"]))]


class Bench:
    def __init__(self, program, folder, scene):
        self.program, self.folder = os.path.abspath(program), folder
        self.scene = os.path.join(folder, f"{scene}.gltf")
        SCENES[scene]().write(self.scene)

    def render(self, seed, *more):
        """Luminances and the answer."""
        out = os.path.join(self.folder, f"{os.path.basename(self.scene)}.{seed}.exr")
        done = subprocess.run(
            [self.program, "render", self.scene, "-o", out, "--size", "{}x{}".format(*SIZE),
             "--seed", str(seed), "--field", f"{self.scene}.field", "--json", "--quiet",
             "--threads", "1", *more], capture_output=True, text=True)
        if done.returncode:
            sys.exit(f"noise_stop.py: {done.stderr}")
        found = luminances(out)
        os.remove(out)
        return found, json.loads(done.stdout)

    def truth(self, samples, jobs):
        """The mean of some frames, and the standard error of its mean."""
        seeds = range(10 ** 6, 10 ** 6 + 8)
        self.render(0, "--spp", "1")
        with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
            frames = list(pool.map(
                lambda seed: self.render(seed, "--spp", str(samples // 8))[0], seeds))
        means = [statistics.fmean(f) for f in frames]
        pixels = [statistics.fmean(values) for values in zip(*frames)]
        return pixels, statistics.stdev(means) / math.sqrt(len(means))


def true_error(frames, truth):
    lit = [y for y in truth if y > 0]
    lowest = 0.5 * math.exp(statistics.fmean(map(math.log, lit)))
    return statistics.fmean(
        math.sqrt(statistics.fmean((f[i] - y) ** 2 for f in frames)) / max(y, lowest)
        for i, y in enumerate(truth))


def runs_of(bench, goal, tighter, args):
    """Of all seeds. tighter: the runs to a smaller error; those that stopped at the least
    samples stop there, too, when more is allowed."""
    def run(seed):
        if tighter and tighter[seed][1]["samples"] == LEAST:
            return tighter[seed]
        return bench.render(seed, "--noise", str(goal), "--spp", "100000")
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        return list(pool.map(run, range(args.seeds)))


def row(runs, truth, goal):
    pixels, doubt = truth
    whole = statistics.fmean(pixels)
    means = [statistics.fmean(frame) / whole - 1 for frame, _ in runs]
    bias = statistics.fmean(means)
    sigma = math.hypot(statistics.stdev(means) / math.sqrt(len(means)), doubt / whole)
    told = [a["relative_error"] for _, a in runs]
    noise = [a.get("noise") or {} for _, a in runs]
    known = [t for t, n in zip(told, noise) if not n.get("rare_light")]
    real = true_error([frame for frame, _ in runs], pixels)
    return {"goal": goal, "samples": statistics.fmean(a["samples"] for _, a in runs),
            "bias": bias, "sigma": sigma, "told": statistics.fmean(told), "real": real,
            "known": statistics.fmean(known) if known else math.nan,
            "rare": 1 - len(known) / len(told),
            "pilot": statistics.fmean(n.get("pilot", {}).get("paths", 0) for n in noise)
            / (SIZE[0] * SIZE[1])}


def check(report, r, what):
    report.claim(abs(r["bias"]) < 4 * r["sigma"], f"{what}: bias {r['bias']} +- {r['sigma']}")
    report.claim(r["rare"] > 0.8 or abs(r["known"] / r["real"] - 1) < 1 / 3,
                 f"{what}: told {r['known']}, real {r['real']}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("--seeds", type=int, default=400)
    parser.add_argument("--scene", nargs="+", default=list(SCENES), choices=list(SCENES))
    parser.add_argument("--goal", nargs="+", type=float, default=list(GOALS))
    parser.add_argument("--truth", type=int, default=1 << 17)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("parhelion")
    args, report = parser.parse_args(), Report()
    print("| scene | required | samples | of others | bias % | told | by those who know | real "
          "| rare light: not yet known |\n"
          "| --- | --- | --- | --- | --- | --- | --- | --- | --- |", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        for name in args.scene:
            bench, runs = Bench(args.parhelion, folder, name), None
            truth = bench.truth(args.truth, args.jobs)
            for goal in sorted(args.goal):
                runs = runs_of(bench, goal, runs, args)
                r = row(runs, truth, goal)
                print(f"| {name} | {goal} | {r['samples']:.0f} | {r['pilot']:.0f} "
                      f"| {100 * r['bias']:+.2f} +- {100 * r['sigma']:.2f} "
                      f"| {r['told']:.3f} | {r['known']:.3f} | {r['real']:.3f} "
                      f"| {100 * r['rare']:.0f} % |", flush=True)
                if args.check:
                    check(report, r, f"{name} {goal}")
    if args.check:
        report.finish()


main()
