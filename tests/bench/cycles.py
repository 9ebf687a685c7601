# SPDX-License-Identifier: Apache-2.0
"""cycles.py PARHELION [--views "A;B"] [--size WxH] [--spp N] [--cycles-spp N] [--seeds N]
[--keep FOLDER] -- processor time to equal error beside Cycles, of Debian's Blender.

The same scenes: triangles and textures, camera, sun, sky, displays that glow by their content
(cycles_scene.py); as many bounces, a box filter of a pixel, nothing clamped or denoised.

The two render in turn. Each one's error is against a frame of its own of 16 times all its
samples, since ours is spectral, with measured displays, and Cycles' is not: the mean over
pixels of the root mean square over seeds of the distance of luminance, over max(Y, half of the
key) (time_to_error.py). `start` is what a frame takes before its samples. `to 5 %` is what the
samples take, times (error / 5 %)^2, without the start; `ratio`, ours by Cycles'. `light` is the
mean luminance of ours by Cycles': near 1 if both show the same scene.

--keep: the scenes for Blender, and both references, stay in that folder.
"""
import argparse
import contextlib
import json
import os
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile

from time_to_error import (GOAL, MORE, ROOT, VIEWS, before_samples, luminance, relative_error,
                           render)

HERE = os.path.dirname(os.path.abspath(__file__))
BLENDER = ["blender", "-b", "--python-exit-code", "1"]
DEFAULT_VIEWS = "car, noon;deck, low sun;box"
# Debian's Blender needs the Python that it was built with, and its numpy.
SURROUNDINGS = {**os.environ, "PATH": os.pathsep.join(["/usr/bin", "/bin", os.environ["PATH"]])}


def blender(*words):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([*BLENDER, *words], capture_output=True, text=True, env=SURROUNDINGS,
                          cwd=ROOT)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != 0:
        sys.exit(f"{' '.join(done.args)}:\n{(done.stdout + done.stderr)[-2000:]}")
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def heading_of(scenes):
    """Of the vehicle, degrees; our files say it beside the sky."""
    heading = 0
    for path in scenes:
        with open(os.path.join(ROOT, path), encoding="utf-8") as file:
            document = json.load(file)
        for scene in document["scenes"]:
            around = scene.get("extensions", {}).get("PARHELION_environment", {})
            heading = around.get("heading_deg", heading)
    return heading


def word_after(words, option, default):
    return words[words.index(option) + 1] if option in words else default


def scene_for_cycles(program, words, size, folder):
    """Writes sky and scene; returns the .blend file."""
    scenes = [word for word in words if word.endswith(".gltf")]
    for path in scenes:
        if not os.path.exists(os.path.join(ROOT, path)):
            sys.exit(f"cycles.py: {path} is not there; the box is made by tests/bench/box.py")
    sky = os.path.join(folder, "sky.exr")
    done = subprocess.run([program, "sky", *scenes, "-o", sky, "--size", "2048x1024", "--json",
                           "--quiet"], cwd=ROOT, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stderr)
    figures = json.loads(done.stdout)
    sun = None
    if figures["direct_normal_lx"] > 0:
        sun = {**figures["sun"], "lx": figures["direct_normal_lx"]}
    job = {"models": [os.path.join(ROOT, path) for path in scenes], "sky": sky, "sun": sun,
           "heading_deg": heading_of(scenes), "size": [int(n) for n in size.split("x")],
           "camera": word_after(words, "--camera", ""),
           "bounces": int(word_after(words, "--max-bounces", 64)),
           "blend": os.path.join(folder, "scene.blend")}
    with open(os.path.join(folder, "job.json"), "w", encoding="utf-8") as file:
        json.dump(job, file, indent=1)
    blender("--factory-startup", "--python", os.path.join(HERE, "cycles_scene.py"), "--",
            "build", file.name)
    return job["blend"]


class Ours:
    def __init__(self, program, words, size):
        self.words, self.size = words, size
        self.program = [program, "render"]

    def render(self, spp, seed, out):
        return render(self.program, self.words, self.size, spp, seed, out)[0]


class Cycles:
    def __init__(self, blend):
        self.blend = blend

    def render(self, spp, seed, out):
        return blender(self.blend, "--python", os.path.join(HERE, "cycles_scene.py"), "--",
                       "render", str(spp), str(seed), out)


def measure(renderers, arguments, folder):
    """name -> what it took, how far off it is, how bright."""
    runs = {name: {"one": [], "all": [], "frames": []} for name in renderers}
    for seed in range(arguments.seeds):
        for name, (renderer, spp) in renderers.items():
            out, run = os.path.join(folder, "frame.exr"), runs[name]
            run["one"].append(renderer.render(1, seed, out))
            run["all"].append(renderer.render(spp, seed, out))
            run["frames"].append(luminance(out))
    found = {}
    for name, (renderer, spp) in renderers.items():
        out, run = os.path.join(folder, f"{name}.exr"), runs[name]
        renderer.render(MORE * arguments.seeds * spp, 4711, out)
        truth = luminance(out)
        end = statistics.median(run["all"])
        start = before_samples(statistics.median(run["one"]), end, spp)
        error = relative_error(run["frames"], truth)
        found[name] = {"error": error, "start": start, "all": run["all"],
                       "goal": (end - start) * (error / GOAL) ** 2,
                       "light": statistics.fmean(truth)}
    return found


def print_view(view, found):
    ours, cycles = found["parhelion"], found["cycles"]
    for name, run in found.items():
        ratio = f"{ours['goal'] / cycles['goal']:6.2f}  {ours['light'] / cycles['light']:.2f}"
        print(f"{view:18} {name:10} {100 * run['error']:8.2f} {run['start']:8.2f} "
              f"{statistics.median(run['all']):8.2f} {min(run['all']):6.2f}-"
              f"{max(run['all']):<6.2f} {run['goal']:9.2f} "
              f"{ratio if name == 'parhelion' else ''}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--views", default=DEFAULT_VIEWS)
    parser.add_argument("--size", default="96x54")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--cycles-spp", type=int, default=256)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--keep")
    parser.add_argument("program")
    arguments = parser.parse_args()
    program, views = os.path.abspath(arguments.program), arguments.views.split(";")
    if not shutil.which("blender", path=SURROUNDINGS["PATH"]):
        sys.exit("cycles.py: no blender: apt-get install blender")
    unknown = [view for view in views if view not in VIEWS]
    if unknown:
        sys.exit(f"cycles.py: --views {unknown[0]}: required: some of {'; '.join(VIEWS)}")
    print(f"{'view':18} {'program':10} {'error %':>8} {'start s':>8} {'frame s':>8} "
          f"{'range':>13} {'to 5 % s':>9} {'ratio':>6}  light")
    for view in views:
        with contextlib.ExitStack() as stack:
            folder = arguments.keep and os.path.join(arguments.keep, view.replace(", ", "_"))
            if folder:
                os.makedirs(folder, exist_ok=True)
            else:
                folder = stack.enter_context(tempfile.TemporaryDirectory())
            folder = os.path.abspath(folder)
            blend = scene_for_cycles(program, VIEWS[view], arguments.size, folder)
            renderers = {"parhelion": (Ours(program, VIEWS[view], arguments.size),
                                       arguments.spp),
                         "cycles": (Cycles(blend), arguments.cycles_spp)}
            print_view(view, measure(renderers, arguments, folder))


if __name__ == "__main__":
    main()
