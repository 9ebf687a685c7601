# SPDX-License-Identifier: Apache-2.0
"""golden.py [--renew] [--all] [--keep DIR] [--only NAME] PARHELION -- the project's own scenes
against golden frames, by `parhelion compare`.

The golden frames (tests/image/golden/*.exr) are of another seed and of four times the samples:
what is asked is whether the mean moved, not whether the bits are the same. A difference leaves
both frames and a report in DIR (default: .build/golden) that shows where. Learning where light
comes from takes as long as all samples here: without --all one frame is guided, the others have
a few samples more, for the same error; and all have half as many as with it: a mean that moved
by one and a half times as much is found as surely.

After a change that is meant to alter pictures, look at the reports, then renew with
    python3 tests/image/golden.py --renew .build/release/parhelion
and say in the commit what moved and why. Renew all of them: a scene's change that a frame just
let pass has used up the room that the noise of another machine's bits needs.
"""
import argparse
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.normpath(os.path.join(HERE, "..", ".."))
sys.path.insert(0, os.path.join(HERE, "..", "structure"))
from report import Report  # noqa: E402

GOLDEN = os.path.join(HERE, "golden")
MORNING = ["--environment", "sky:clear", "--when", "2026-06-21T08:30+02:00", "--where",
           "48.14,11.58,520", "--heading", "90"]
CASES = {
    "car_noon": ["car_dashboard.gltf", "noon.gltf"],
    "car_night": ["car_dashboard.gltf", "night.gltf"],
    "car_morning": ["car_dashboard.gltf", *MORNING],
    "deck_low_sun": ["cockpit.gltf", "low_sun_left.gltf", "--camera", "captain"],
    "deck_dusk_pfd": ["cockpit.gltf", "dusk.gltf", "--camera", "pfd"],
}
GOLDEN_SAMPLES, SAMPLES, LEVEL = 256, 64, "0.001"
FEW_GUIDED, FEW_UNGUIDED = 32, 36
ALWAYS_GUIDED = "deck_low_sun"
LAYERS = "variance,halves,id,display.reflected,display.white,display.black,display.contrast"


def render(program, words, out, samples, seed, *options):
    """Works beside the frame, so that its command line holds no path of this machine."""
    folder, name = os.path.split(out)
    scenes = os.path.relpath(os.path.join(ROOT, "scenes"), folder)
    words = [os.path.join(scenes, word) if word.endswith(".gltf") else word for word in words]
    done = subprocess.run(
        [program, "render", *words, "-o", name, "--size", "96x54", "--spp", str(samples),
         "--seed", str(seed), "--layers", LAYERS, "--isa", "sse2", "--quiet", *options],
        cwd=folder, capture_output=True, text=True)
    if done.returncode != 0:
        print(done.stdout + done.stderr)
    return done.returncode == 0


def render_today(program, name, frame, is_whole):
    more = (FEW_UNGUIDED, 1, "--no-guiding")
    if is_whole or name == ALWAYS_GUIDED:
        more = (SAMPLES if is_whole else FEW_GUIDED, 1)
    return render(program, CASES[name], frame, *more)


def compare(program, name, frame, report):
    done = subprocess.run(
        [program, "compare", os.path.join(GOLDEN, name + ".exr"), frame, "--metric", "stat",
         "--level", LEVEL, "--report", report, "--quiet"], capture_output=True, text=True)
    print(f"{name}:\n{done.stdout}{done.stderr}")
    return done.returncode == 0


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--renew", action="store_true")
    parser.add_argument("--all", action="store_true", help="every frame guided, of 64 samples")
    parser.add_argument("--keep", default=os.path.join(ROOT, ".build", "golden"))
    parser.add_argument("--only", default="")
    parser.add_argument("program")
    arguments = parser.parse_args()
    report, program = Report(), os.path.abspath(arguments.program)
    folder = GOLDEN if arguments.renew else os.path.abspath(arguments.keep)
    os.makedirs(folder, exist_ok=True)
    for name, words in CASES.items():
        if arguments.only not in name:
            continue
        frame = os.path.join(folder, name + ".exr")
        page = os.path.join(folder, name + ".html")
        if arguments.renew:
            report.claim(render(program, words, frame, GOLDEN_SAMPLES, 1000), name)
        elif report.claim(render_today(program, name, frame, arguments.all),
                          f"{name}: not rendered"):
            report.claim(compare(program, name, frame, page),
                         f"{name}: differs from its golden frame, see {page}")
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
