# SPDX-License-Identifier: Apache-2.0
"""panel_bounds.py PARHELION -- a tighter --max-error is never worse.

Law   over falling bounds no printed error of a panel (max, rms) rises by more than 1 % of
      itself (a bound that cannot be met may end elsewhere); integrals stay within the bound, or
      0.1 %. The bound met is at most the largest error, and
      a bound that is met is kept. A simulated set, and real files where they are."""
import json
import os
import subprocess
import sys
import tempfile

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

DATA = os.path.join(ROOT, "..", "shared", "data")
BOUNDS = (0.02, 0.002, 0.0001)
ERRORS = ("max_error", "rms_error")
INTEGRAL = 1e-3


def call(program, *words):
    done = subprocess.run([program, "panel", *words], capture_output=True, text=True,
                          check=False)
    if done.returncode:
        sys.exit(f"panel {' '.join(words)}: {done.stderr}")
    return done.stdout


def simulated(program, folder):
    """One wavelength, one incidence, few directions, no noise."""
    with open(os.path.join(ROOT, "assets", "panels", "oled_centre.recipe.json"),
              encoding="utf-8") as file:
        recipe = json.load(file)
    recipe["reflection"].update(wavelengths_nm=[550], incidence_deg=[30])
    path, measured = (os.path.join(folder, name) for name in ("small.recipe.json", "small"))
    with open(path, "w", encoding="utf-8") as file:
        json.dump(recipe, file)
    call(program, "simulate", path, "-o", measured, "--noise", "off", "--grid", "20x36")
    return os.path.join(measured, "MANIFEST.json")


def check(report, program, folder, name, measured, bounds):
    before = None
    for bound in bounds:
        out = os.path.join(folder, "x.panel")
        fit = json.loads(call(program, "fit", measured, "-o", out, "--force", "--json",
                              "--max-error", f"{bound:g}"))
        total = fit["total"]
        print(f"  {name}, {bound:g}: " + ", ".join(f"{total[e]:.3g}" for e in ERRORS))
        for part in ("emission", "reflection"):
            if part in fit:
                report.claim(abs(fit[part]["tolerance"] / bound - 1) < 1e-5 and
                             fit[part]["bound"] <= total["max_error"] * 1.01,
                             f"{name}, {bound:g}, {part}: states the bound required and met")
        report.claim(total["integral_error"] <= max(bound, INTEGRAL),
                     f"{name}, {bound:g}: integral {total['integral_error']:.3g}")
        for error in ERRORS if before else ():
            report.claim(total[error] <= 1.01 * before[error],
                         f"{name}, {bound:g}: {error} {total[error]:.3g}, looser "
                         f"{before[error]:.3g}")
        before = total


def main():
    report = Report()
    program = os.path.abspath(sys.argv[1])
    real = (("display/viewing_angle_oled_phi0_90.csv", ["--role", "*=white"], BOUNDS),
            ("bsdf/loft-rt300s/AnoBlackEC1onAlum.bsdf", ["--wavelength", "650"],
             (0.05, 0.02)))
    with tempfile.TemporaryDirectory() as folder:
        check(report, program, folder, "simulated", simulated(program, folder), BOUNDS)
        for path, words, bounds in real:
            source, measured = os.path.join(DATA, path), os.path.join(folder, "real")
            if not os.path.exists(source):
                print(f"skipped: {path}")
                continue
            measured += str(len(bounds))
            call(program, "import", source, "-o", measured, *words)
            check(report, program, folder, os.path.basename(path), measured, bounds)
    report.finish()


if __name__ == "__main__":
    main()
