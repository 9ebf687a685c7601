# SPDX-License-Identifier: Apache-2.0
"""noise_bias.py [--seeds N] [--targets R,...] [--scenes ball,hole,slit] [--json FILE] PARHELION
-- what `render --noise R` stops at where light is rare: bias of the frame's mean, and the error
that it prints beside the real one. 400 seeds in full.

Scenes: a chrome ball and a lamp of 10 cm in a box; a dark display that a patch of sun lights,
of a hole of 6 cm in a black room; one of a slit, between walls of 0.5 (black_box.py). The truth
is the mean of 16 frames of 1,024 samples with seeds of their own: of the ball's scene itself,
of the others with the patch as a lamp, which samples of lamps find.

The real error is what the printed one claims to be: the mean over pixels of the root mean
square over seeds of (found - true) / max(true, half the frame's key). Bias may be 0.2 % as far
as chance allows (three standard errors of the mean); a printed error at most 20 % off the real
one. A frame that says "not yet known" for its relative error (null) makes no claim, and is
counted.
"""
import argparse
import json
import math
import os
import shutil
import statistics
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.join(HERE, "..", "image")]
import black_box  # noqa: E402
from gltf import Scene  # noqa: E402
from time_to_error import half_key, luminance  # noqa: E402

PANEL = os.path.join(HERE, "..", "..", "assets", "panels", "ips_cluster.panel")
SIZE, MOST = "16x12", 16384
TRUTH_FRAMES, TRUTH_SAMPLES = 16, 1024
BIAS, APART = 0.002, 0.2
NEAR = {"hole": 2, "slit": 2}  # degrees: the display alone


def ball():
    scene = Scene()
    scene.box_inside(scene.lambert(0.5), [-1, 0, -1], [1, 2, 1])
    scene.facing_quad(scene.emitter(20000), [0, 1.98, 0], [0, -1, 0], 0.1)
    scene.sphere(scene.metal(0.9), [0.2, 0.4, -0.3], 0.3)
    scene.view("near", [0, 1, 0.95], [0, -0.4, -1], 60)
    return scene, black_box.DARK


def of_patch(room, name):
    def scene(as_lamp=False):
        made = room.lamp_scene(0) if as_lamp else room.scene(0)
        made.view("near", black_box.EYE, [-x for x in black_box.EYE], NEAR[name])
        return made, black_box.DARK if as_lamp else room.environment()
    return scene


SCENES = {"ball": lambda as_lamp=False: ball(),
          "hole": of_patch(black_box.Patch((0.06, 0.06)), "hole"),
          "slit": of_patch(black_box.Patch((0.3, 0.002), 0.5), "slit")}


def frame(program, folder, seed, *options):
    """Luminances, and the printed error (None: not known)."""
    out = os.path.join(folder, "frame.exr")
    done = subprocess.run([program, "render", "room.gltf", "--camera", "near", "--size", SIZE,
                           "--seed", str(seed), "--json", "--quiet", "-o", out, *options],
                          cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"noise_bias.py: {done.stderr.strip()}")
    told = json.loads(done.stdout)
    return luminance(out), told["relative_error"], told["samples"]


def write(folder, scene, environment):
    scene.environment(**environment)
    scene.write(os.path.join(folder, "room.gltf"))


def truth_of(program, folder, name):
    write(folder, *SCENES[name](as_lamp=True))
    frames = [frame(program, folder, 100000 + i, "--spp", str(TRUTH_SAMPLES))[0]
              for i in range(TRUTH_FRAMES)]
    means = [statistics.fmean(f) for f in frames]
    return ([statistics.fmean(pixel) for pixel in zip(*frames)],
            statistics.stdev(means) / math.sqrt(len(means)) / statistics.fmean(means))


def real_error(frames, truth):
    low = half_key(truth)
    return statistics.fmean(
        math.sqrt(statistics.fmean((x - wanted) ** 2 for x in found)) / max(wanted, low)
        for found, wanted in zip(zip(*frames), truth))


def row_of(name, target, found, truth, truth_error):
    frames, printed = [f for f, _, _ in found], [e for _, e, _ in found if e is not None]
    whole = statistics.fmean(truth)
    means = [statistics.fmean(f) / whole - 1 for f in frames]
    bias, error = statistics.fmean(means), statistics.stdev(means) / math.sqrt(len(means))
    real = real_error(frames, truth)
    told = statistics.fmean(printed) if printed else None
    sure = math.hypot(error, truth_error)
    return {"scene": name, "noise": target, "seeds": len(frames), "bias": bias,
            "bias_error": error, "truth_error": truth_error, "printed": told, "real": real,
            "not_known": len(frames) - len(printed),
            "samples": statistics.fmean(s for _, _, s in found),
            "is_good": abs(bias) <= BIAS + 3 * sure and
            (told is None or abs(told / real - 1) <= APART)}


def print_row(row):
    printed = "-" if row["printed"] is None else f"{row['printed']:.3f}"
    print(f"| {row['scene']} | {row['noise']:g} | {row['seeds']} | {100 * row['bias']:+.2f} +- "
          f"{100 * row['bias_error']:.2f} % | {printed} | {row['real']:.3f} | "
          f"{row['not_known']} | {row['samples']:.0f} | {'' if row['is_good'] else 'no'} |",
          flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("parhelion")
    parser.add_argument("--seeds", type=int, default=400)
    parser.add_argument("--targets", default="0.3,0.2,0.1,0.05")
    parser.add_argument("--scenes", default=",".join(SCENES))
    parser.add_argument("--json")
    words = parser.parse_args()
    program, rows = os.path.abspath(words.parhelion), []
    print("| scene | --noise | seeds | bias of the mean | printed | real | not known | samples "
          "| good |\n" + "| --- " * 9 + "|", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        shutil.copy(PANEL, os.path.join(folder, "ips.panel"))
        for name in words.scenes.split(","):
            truth, truth_error = truth_of(program, folder, name)
            write(folder, *SCENES[name]())
            for target in words.targets.split(","):
                found = [frame(program, folder, seed, "--noise", target, "--spp", str(MOST))
                         for seed in range(1, words.seeds + 1)]
                rows.append(row_of(name, float(target), found, truth, truth_error))
                print_row(rows[-1])
    if words.json:
        with open(words.json, "w", encoding="utf-8") as file:
            json.dump(rows, file, indent=1)
    off = sum(not row["is_good"] for row in rows)
    print(f"{off} of {len(rows)} rows are off")
    return off > 0


if __name__ == "__main__":
    sys.exit(main())
