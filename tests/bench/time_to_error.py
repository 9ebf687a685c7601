# SPDX-License-Identifier: Apache-2.0
"""time_to_error.py [--views "A;B"] [--size WxH] [--spp N] [--seeds N] NAME=PARHELION[,OPTION]
... -- what processor time each program needs to 5 % relative error, by true errors.

Each program renders each view with N samples and several seeds, in turns. The error of a pixel
is the root mean square over seeds of its luminance's distance from a frame of the first program
with 16 times all these samples, over max(Y, half of the key), as a frame's own relative error
is (src/film/film.h); the frame's is the mean over pixels. What a frame takes besides its
samples, start-up and what it learns first, is told by a frame of one sample; the time to 5 % is
that and what the samples took times (error / 5 %)^2. The last columns are ratios to the first
NAME: of that time, of what comes before the samples, of squared errors, of what the samples
took.

What a program never finds (a lamp in a mirror) counts as its error, and by few samples it may
still look sure: the reference should be the surest program's. The million-triangle box must be
in .build/bench (box.py).
"""
import argparse
import json
import math
import os
import resource
import statistics
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.join(HERE, "..", "..")
sys.path.insert(0, os.path.join(HERE, "..", "image"))
from exr import Frame  # noqa: E402

CAR, DECK = "scenes/car_dashboard.gltf", "scenes/cockpit.gltf"
CAPTAIN = ["--camera", "captain"]
VIEWS = {
    "car, noon": [CAR, "scenes/noon.gltf"],
    "car, 08:30": [CAR, "--environment", "sky:clear", "--when", "2026-06-21T08:30+02:00",
                   "--where", "48.14,11.58,520", "--heading", "90"],
    "deck, cloud noon": [DECK, "scenes/cloud_noon.gltf", *CAPTAIN],
    "deck, low sun": [DECK, "scenes/low_sun_left.gltf", *CAPTAIN],
    "car, night": [CAR, "scenes/night.gltf"],
    "deck, night": [DECK, "scenes/flight_night.gltf", *CAPTAIN],
    "car, tunnel exit": [CAR, "scenes/tunnel_exit.gltf"],
    "car, garage": [CAR, "scenes/garage.gltf"],
    "box": [".build/bench/box.gltf", "--max-bounces", "8"],
}
GOAL, MORE = 0.05, 16


def render(program, words, size, spp, seed, out):
    """Processor seconds, and the program's own answer."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([*program, *words, "--size", size, "--spp", str(spp), "--seed",
                           str(seed), "--quiet", "--json", "-o", out],
                          cwd=ROOT, capture_output=True, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != 0:
        sys.exit(f"{' '.join(done.args)}: {done.stderr}")
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return seconds, json.loads(done.stdout)


def luminance(path):
    """Row by row; frames are in linear Rec. 709."""
    c = Frame(path).channels
    return [0.2126 * r + 0.7152 * g + 0.0722 * b for r, g, b in zip(c["R"], c["G"], c["B"])]


def half_key(values):
    above = [math.log(v) for v in values if v > 0]
    return 0.5 * math.exp(sum(above) / len(above))


def relative_error(frames, truth):
    low = half_key(truth)
    total = 0
    for at, wanted in enumerate(truth):
        square = sum((frame[at] - wanted) ** 2 for frame in frames) / len(frames)
        total += math.sqrt(square) / max(wanted, low)
    return total / len(truth)


def measure(programs, words, arguments, folder):
    """name -> (error, s of frames of one sample, s of frames of N samples)."""
    out = os.path.join(folder, "frame.exr")
    found = {name: {"frames": [], "start": [], "all": []} for name in programs}
    reference = next(iter(programs.values()))
    render(reference, words, arguments.size, MORE * arguments.seeds * arguments.spp, 4711, out)
    truth = luminance(out)
    for seed in range(arguments.seeds):
        for name, program in programs.items():
            of = found[name]
            of["start"].append(render(program, words, arguments.size, 1, seed, out)[0])
            of["all"].append(render(program, words, arguments.size, arguments.spp, seed,
                                    out)[0])
            of["frames"].append(luminance(out))
    return {name: (relative_error(of["frames"], truth), of["start"], of["all"])
            for name, of in found.items()}


def before_samples(one, whole, spp):
    """Of what frames of one and of spp samples took."""
    return one - max(whole - one, 0) / (spp - 1)


def time_to_goal(error, start, whole):
    return start + max(whole - start, 0) * (error / GOAL) ** 2


def views_of(text):
    """"A;B", of VIEWS; all of them where it is empty."""
    views = text.split(";") if text else list(VIEWS)
    unknown = [view for view in views if view not in VIEWS]
    if unknown:
        sys.exit(f"--views: there is no {unknown[0]!r}, required: one of: {'; '.join(VIEWS)}")
    return views


def programs_of(items):
    """NAME=PARHELION[,OPTION] ... -> name: the first words of its command."""
    programs = {}
    for item in items:
        name, equals, words = item.partition("=")
        if not equals:
            sys.exit(f"{item}: required: NAME=PARHELION[,OPTION]")
        program, *options = words.split(",")
        programs[name] = [os.path.abspath(program), "render", *options]
    return programs


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--views", default="")
    parser.add_argument("--size", default="96x54")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("programs", nargs="+")
    arguments = parser.parse_args()
    programs, views = programs_of(arguments.programs), views_of(arguments.views)
    print(f"{'view':18} {'program':12} {'error %':>8} {'before s':>8} {'frame s':>8} "
          f"{'range':>13} {'to 5 % s':>9} {'ratio':>6}  before error^2 samples")
    with tempfile.TemporaryDirectory() as folder:
        for view in views:
            words = VIEWS[view]
            first = None
            for name, (error, start, whole) in measure(programs, words, arguments,
                                                       folder).items():
                end = statistics.median(whole)
                begin = before_samples(statistics.median(start), end, arguments.spp)
                now = (time_to_goal(error, begin, end), begin, error ** 2, end - begin)
                first = first or now
                print(f"{view:18} {name:12} {100 * error:8.2f} {begin:8.2f} {end:8.2f} "
                      f"{min(whole):6.2f}-{max(whole):<6.2f} {now[0]:9.2f} "
                      f"{now[0] / first[0]:6.2f}  "
                      + " ".join(f"{a / b:.2f}" for a, b in zip(now[1:], first[1:])),
                      flush=True)


if __name__ == "__main__":
    main()
