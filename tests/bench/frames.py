# SPDX-License-Identifier: Apache-2.0
"""frames.py RUNS PARHELION -- whole renders: rays and paths a second, on one thread and on two,
and the error that a second buys. The million-triangle box must be in .build/bench.
"""
import json
import os
import statistics
import subprocess
import sys
import tempfile

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
SCENES = {
    "dashboard 640x360": (["scenes/car_dashboard.gltf", "scenes/noon.gltf"],
                          ["--size", "640x360", "--spp", "4"]),
    "box 512x512, 8 bounces": ([".build/bench/box.gltf"],
                               ["--size", "512x512", "--spp", "2", "--max-bounces", "8"]),
}


def render(program, scenes, options, threads, folder):
    """The program's own answer about one render."""
    done = subprocess.run(
        [program, "render", *scenes, "-o", os.path.join(folder, "frame.exr"), "--threads",
         str(threads), "--json", "--quiet", *options], cwd=ROOT, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stderr)
    return json.loads(done.stdout)


def line(name, unit, values):
    print(f"{name:42} {statistics.median(values):12.4g} {unit:12} "
          f"{min(values):.4g} .. {max(values):.4g}", flush=True)


def rays_of(answer):
    """Camera, bounce and shadow rays, whether told by class or as one number."""
    rays = answer["rays"]
    return rays if isinstance(rays, dict) else {"all": rays}


def main():
    runs, program = int(sys.argv[1]), os.path.abspath(sys.argv[2])
    with tempfile.TemporaryDirectory() as folder:
        for name, (scenes, options) in SCENES.items():
            rates = {}
            for threads in (1, 2):
                answers = [render(program, scenes, options, threads, folder)
                           for _ in range(runs)]
                rates[threads] = statistics.median(a["samples_per_s"] for a in answers)
                line(f"{name}, {threads} threads", "paths/s",
                     [a["samples_per_s"] for a in answers])
                line(f"{name}, {threads} threads", "rays/s", [a["rays_per_s"] for a in answers])
            first = answers[0]
            for kind, count in rays_of(first).items():
                print(f"{name + ', rays: ' + kind:42} {count:12.4g} rays")
            print(f"{name + ', two threads against one':42} {rates[2] / rates[1]:12.3g} times")
            line(f"{name}, relative error x sqrt(s)", "",
                 [a["relative_error"] * a["seconds"] ** 0.5 for a in answers])


if __name__ == "__main__":
    main()
