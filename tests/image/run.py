# SPDX-License-Identifier: Apache-2.0
"""run.py [--all] [--only TEXT] [--keep DIR] PARHELION -- frames against closed forms.

A claim holds when |shown - expected| <= 3 sigma, sigma being the standard deviation that the
frame itself states and at most 0.1 % of what is expected, 0.2 % without --all, with a quarter of
the samples: until then it is rendered again with more. 1e-4 of the expected value is granted
besides: single precision, Rec.709 weights of four digits, and the few millimetres that a probe
sees.
"""
import argparse
import os
import subprocess
import sys
import tempfile

from cases import all_cases
from exr import Frame

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "structure"))
from report import Report  # noqa: E402

SIGMAS, GRANTED, MOST_SAMPLES = 3, 1e-4, 1 << 20
LARGEST_SIGMA = 0.001 if "--all" in sys.argv else 0.002


def check_formulas(report):
    """The closed forms themselves, against published values."""
    from cases import pane_transmittance, parallel_corner, perpendicular_corner
    import math
    for y, percent in ((0.25, 26.80), (0.75, 30.94), (1.25, 33.98), (1.75, 35.57)):
        factor = 2 * (parallel_corner(2, y, 3) + parallel_corner(2, 4 - y, 3))
        report.claim(abs(100 * factor - percent) < 0.006, f"factor of the ceiling at {y}")
    for z, percent in ((0.25, 45.12), (0.75, 35.90), (1.75, 21.64), (2.75, 12.97)):
        factor = 2 * perpendicular_corner(4, 2, z)
        report.claim(abs(100 * factor - percent) < 0.006, f"factor of the wall at {z}")
    for degrees, expected in ((0, 0.918318), (45, 0.902528), (75, 0.614805)):
        value = pane_transmittance(math.cos(math.radians(degrees)), 1.52)
        report.claim(abs(value - expected) < 1e-6, f"pane at {degrees} degrees: {value}")


class Renderer:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def render(self, case, camera, samples):
        """The frame of one camera; None when the program fails."""
        path = os.path.join(self.folder, "frame.exr")
        done = subprocess.run(
            [self.program, "render", self.scene_path(case), "-o", path, "--camera", camera,
             "--size", "{}x{}".format(*case.size), "--spp", str(samples), "--layers",
             "variance", "--quiet", *case.options], capture_output=True, text=True)
        if done.returncode != 0:
            print(f"{case.name}: {done.stderr.strip()}")
            return None
        return Frame(path)

    def scene_path(self, case):
        path = os.path.join(self.folder, f"case{id(case):x}.gltf")
        if not os.path.exists(path):
            case.scene.write(path)
        return path


def measure(renderer, case, claims):
    """(mean, sigma) of each claim of one camera, with samples enough, and those samples."""
    samples = case.samples
    while True:
        frame = renderer.render(case, claims[0].camera, samples)
        if frame is None:
            return None, samples
        values = [frame.mean_luminance(claim.region) for claim in claims]
        excess = max((sigma / (LARGEST_SIGMA * claim.luminance)
                      for (_, sigma), claim in zip(values, claims) if claim.luminance > 0),
                     default=0)
        if excess <= 1 or samples >= MOST_SAMPLES:
            return values, samples
        samples = int(min(MOST_SAMPLES, max(2 * samples, 1.3 * samples * excess ** 2)))


def check_claim(report, case, claim, value, samples):
    mean, sigma = value
    tolerance = SIGMAS * sigma + GRANTED * claim.luminance
    is_sure = sigma <= LARGEST_SIGMA * claim.luminance
    region = f" {claim.region}" if claim.region else ""
    text = (f"{case.name}, {claim.camera}{region}: {mean:.7g} cd/m2, expected "
            f"{claim.luminance:.7g}, sigma {sigma:.2g}, {samples} samples")
    if report.claim(abs(mean - claim.luminance) <= tolerance and is_sure, text):
        print(f"passed {text}")


def check_case(report, renderer, case):
    cameras = {claim.camera: [c for c in case.claims if c.camera == claim.camera]
               for claim in case.claims}
    for camera, claims in cameras.items():
        values, samples = measure(renderer, case, claims)
        if values is None:
            report.claim(False, f"{case.name}, {camera}: not rendered")
            continue
        for claim, value in zip(claims, values):
            check_claim(report, case, claim, value, samples)
    if hasattr(case, "weighted"):
        check_weighted(report, renderer, case)


def check_weighted(report, renderer, case):
    """A sum over several cameras, each with its size and weight."""
    parts, expected = case.weighted
    total = variance = 0
    for camera, case.size, weight in parts:
        frame = renderer.render(case, camera, case.samples)
        if frame is None:
            report.claim(False, f"{case.name}, {camera}: not rendered")
            return
        mean, sigma = frame.mean_luminance()
        total += weight * mean
        variance += (weight * sigma) ** 2
    sigma = variance ** 0.5
    text = f"{case.name}: {total:.7g}, expected {expected:.7g}, sigma {sigma:.2g}"
    holds = abs(total - expected) <= SIGMAS * sigma + GRANTED * expected
    report.claim(holds and sigma <= LARGEST_SIGMA * expected, text)
    print(text)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--all", action="store_true", help="the slow cases as well")
    parser.add_argument("--only", default="", help="cases whose name contains this")
    parser.add_argument("--keep", help="write scenes here and keep them")
    parser.add_argument("program")
    options = parser.parse_args()
    report = Report()
    check_formulas(report)
    cases = [case for case in all_cases(options.all)
             if (options.all or case.is_quick) and options.only in case.name]
    for case in [] if options.all else cases:
        case.samples = max(case.samples // 4, 16)
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.keep or temporary
        os.makedirs(folder, exist_ok=True)
        for case in cases:
            check_case(report, Renderer(os.path.abspath(options.program), folder), case)
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
