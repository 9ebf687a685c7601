# SPDX-License-Identifier: Apache-2.0
"""guided.py PARHELION -- what is learnt of the light decides noise, never the mean: every
shipped scene in every shipped light, with and without.

Of independent seeds, the frames' mean luminance and the mean over pixels of luminance over the
pixel's own (dark ones count as much) may differ by five standard errors. These come from the
frames' variance layers, which take well spread samples for independent ones: too large rather
than too small; but few samples miss rare bright ones, and look surer than they are. `parhelion
compare` weighs pixels by their noise and so takes two estimators of other tails for two scenes.
Frames stay in .build/guided.
"""
import math
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.normpath(os.path.join(HERE, "..", ".."))
sys.path.insert(0, os.path.join(HERE, "..", "structure"))
sys.path.insert(0, HERE)
from exr import Frame  # noqa: E402
from report import Report  # noqa: E402

MORNING = ["--environment", "sky:clear", "--when", "2026-06-21T08:30+02:00", "--where",
           "48.14,11.58,520", "--heading", "90"]
OVERCAST = ["--environment", "cie:16:10000"]
CAR = ["car_dashboard.gltf"]
DECK = ["cockpit.gltf", "--camera", "captain"]
CASES = {
    "car_noon": [*CAR, "noon.gltf"], "car_night": [*CAR, "night.gltf"],
    "car_morning": [*CAR, *MORNING], "car_overcast": [*CAR, *OVERCAST],
    "deck_low_sun": [*DECK, "low_sun_left.gltf"], "deck_dusk": [*DECK, "dusk.gltf"],
    "deck_night": [*DECK, "flight_night.gltf"], "deck_cloud": [*DECK, "cloud_noon.gltf"],
    "deck_morning": [*DECK, *MORNING], "deck_overcast": [*DECK, *OVERCAST],
}
SIZE, SAMPLES, MOST_SIGMAS = "96x54", "512", 5
RGB = (("R", 0.2126), ("G", 0.7152), ("B", 0.0722))


def render(report, program, words, out, *more):
    words = [os.path.join("scenes", word) if word.endswith(".gltf") else word for word in words]
    done = subprocess.run(
        [program, "render", *words, "-o", out, "--size", SIZE, "--spp", SAMPLES, "--layers",
         "variance", "--quiet", *more], cwd=ROOT, capture_output=True, text=True)
    return report.claim(done.returncode == 0, f"{out}: {done.stderr}")


def luminances(path):
    """Of every pixel: luminance, and its standard error."""
    c = Frame(path).channels
    y = [sum(k * c[n][i] for n, k in RGB) for i in range(len(c["R"]))]
    sigma = [sum(k * math.sqrt(max(c["variance." + n][i], 0)) for n, k in RGB)
             for i in range(len(c["R"]))]
    return y, sigma


def difference(a, b, weights):
    """Of two frames' weighted means: relative, and in standard errors."""
    apart = sum(w * (q - p) for p, q, w in zip(a[0], b[0], weights))
    error = math.sqrt(sum(w * w * (p * p + q * q) for p, q, w in zip(a[1], b[1], weights)))
    return apart / sum(w * p for p, w in zip(a[0], weights)), apart / error


def check(report, name, plain, led):
    a, b = luminances(plain), luminances(led)
    low = sorted(a[0])[len(a[0]) // 2] / 4
    for what, weights in (("the mean", [1] * len(a[0])),
                          ("dark and bright", [1 / max((p + q) / 2, low)
                                               for p, q in zip(a[0], b[0])])):
        relative, sigmas = difference(a, b, weights)
        print(f"{name}, {what}: {100 * relative:+.3f} %, {sigmas:+.2f} standard errors")
        report.claim(abs(sigmas) < MOST_SIGMAS,
                     f"{name}, {what}: {100 * relative:+.3f} % apart, {sigmas:+.2f} sigma")


def main():
    program, report = os.path.abspath(sys.argv[1]), Report()
    folder = os.path.join(ROOT, ".build", "guided")
    os.makedirs(folder, exist_ok=True)
    for name, words in CASES.items():
        plain, led = (os.path.join(folder, f"{name}_{kind}.exr") for kind in ("plain", "led"))
        if render(report, program, words, plain, "--no-guiding", "--seed", "1") and \
           render(report, program, words, led, "--seed", "2"):
            check(report, name, plain, led)
    report.finish()


main()
