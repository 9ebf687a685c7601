# SPDX-License-Identifier: Apache-2.0
"""denoise.py [--only NAME] [--size WxH] [--crop X0,Y0,X1,Y1] [--reference N] [--keep DIR]
PARHELION -- how close pictures of 4 and 24 samples come to one of many, denoised and not: FLIP,
on the views and lights that ship.

All pictures of a view have the exposure of its reference. The reference is of another seed; it
has noise of its own, which counts in every column alike. Frames are kept in DIR (default:
.build/denoise) and taken from there the next time: after a change of the tracer empty it. What
is measured is `develop`, of the program that is given.
"""
import argparse
import json
import os
import subprocess

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.normpath(os.path.join(HERE, "..", ".."))
CAR, DECK = "car_dashboard.gltf", "cockpit.gltf"
LIGHTS = {  # of a scene: the file and how bright the displays are set
    CAR: {"noon": ("noon.gltf", 100), "night": ("night.gltf", 4)},
    DECK: {"low_sun": ("low_sun_left.gltf", 100), "dusk": ("dusk.gltf", 6),
           "cloud": ("cloud_noon.gltf", 100), "night": ("flight_night.gltf", 1)},
}
CAMERAS = {CAR: ["driver-eye", "passenger-eye", "outside"],
           DECK: ["captain", "pfd", "first_officer", "wide"]}
FEW = (4, 24)


def views():
    """Every camera under every light, the first camera of both scenes first."""
    for rank in range(4):
        for scene, cameras in CAMERAS.items():
            for light, (file, level) in LIGHTS[scene].items():
                if rank < len(cameras):
                    yield (f"{cameras[rank]} {light}",
                           [os.path.join(ROOT, "scenes", scene),
                            os.path.join(ROOT, "scenes", file), "--camera", cameras[rank],
                            "--display-level", f"*={level}"])


def run(words):
    done = subprocess.run(words, capture_output=True, text=True)
    if not done.stdout.startswith("{"):
        raise SystemExit(done.stdout + done.stderr)
    return json.loads(done.stdout)


class Bench:
    def __init__(self, arguments):
        self.program, self.keep = os.path.abspath(arguments.program), arguments.keep
        self.size, self.reference = arguments.size, arguments.reference
        self.crop = arguments.crop
        width, height = (int(side) for side in self.size.split("x"))
        x0, y0, x1, y1 = (int(side) for side in self.crop.split(","))
        self.outside = width * height / ((x1 - x0) * (y1 - y0))  # what is black in both

    def path(self, view, name):
        return os.path.join(self.keep, f"{view.replace(' ', '_')}.{name}")

    def frame(self, view, words, samples, seed):
        out = self.path(view, f"{self.size}.{samples}.exr")
        if not os.path.exists(out):
            run([self.program, "render", *words, "--size", self.size, "--crop", self.crop,
                 "--spp", str(samples), "--seed", str(seed), "--layers", "all",
                 "-o", out, "--quiet", "--json"])
        return out

    def develop(self, view, frame, name, *words):
        picture = self.path(view, f"{name}.png")
        answer = run([self.program, "develop", frame, "-o", picture, "--json", *words])
        return picture, answer

    def flip(self, reference, picture):
        answer = run([self.program, "compare", reference, picture, "--metric", "flip", "--json",
                      "--quiet"])
        return answer["metrics"]["flip"] * self.outside

    def row(self, view, words):
        wanted, answer = self.develop(view, self.frame(view, words, self.reference, 1), "many",
                                      "--adapt", "none")
        exposure = f"--exposure={answer['exposure_ev']:.6f}"
        figures, energies = [], []
        for samples in FEW:
            frame = self.frame(view, words, samples, 0)
            noisy, _ = self.develop(view, frame, f"noisy{samples}", exposure)
            clean, answer = self.develop(view, frame, f"clean{samples}", exposure, "--denoise")
            figures += [self.flip(wanted, noisy), self.flip(wanted, clean)]
            energies.append(answer["denoised"]["energy_ratio"])
        print(f"| {view} | " + " | ".join(f"{f:.4f}" for f in figures) + " | " +
              " | ".join(f"{energy:.4f}" for energy in energies) + " |", flush=True)
        return figures


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--only", default="")
    parser.add_argument("--size", default="480x270")
    parser.add_argument("--crop", default="144,100,336,208")
    parser.add_argument("--reference", type=int, default=512)
    parser.add_argument("--keep", default=os.path.join(ROOT, ".build", "denoise"))
    parser.add_argument("program")
    arguments = parser.parse_args()
    os.makedirs(arguments.keep, exist_ok=True)
    bench, rows = Bench(arguments), []
    print("| view | " + " | ".join(f"{n} | {n} denoised" for n in FEW) + " | " +
          " | ".join(f"energy {n}" for n in FEW) + " |\n" + "|---" * (1 + 3 * len(FEW)) + "|")
    for view, words in views():
        if arguments.only in view:
            rows.append(bench.row(view, words))
    means = [sum(column) / len(rows) for column in zip(*rows)]
    print("| mean | " + " | ".join(f"{mean:.4f}" for mean in means) +
          " |" * (1 + len(FEW)))


if __name__ == "__main__":
    main()
