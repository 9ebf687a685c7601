# SPDX-License-Identifier: Apache-2.0
"""real_sizes.py PARHELION -- a panel is small.

Law   of every real file that is imported the panel has at most 1.5 % of the source's bytes as
      32-bit numbers without angles, or at most 16 kB, whichever is more; of every shipped panel
      too.
Needs  ../shared/data; skipped without it."""
import glob
import json
import os
import subprocess
import sys
import tempfile

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

DATA = os.path.join(ROOT, "..", "shared", "data")
SHARE, LEAST = 0.015, 16384
# Its tree alone takes 12.5 kB at the bound of 2.5 %, for 19 incidences.
LARGER = {"bsdf/speos/R_test.anisotropicbsdf": 17664}
AT_650 = ["--wavelength", "650"]
FILES = { # what a file does not say itself
    "display/viewing_angle_oled_phi0_90.csv": ["--role", "*=white"],
    "bsdf/loft-rt300s/AnoBlackEC1onAlum.bsdf": AT_650,
    "bsdf/loft-rt300s/AnoBlackNiTEonINVAR.bsdf": AT_650,
    "bsdf/loft-rt300s/BrownVinyl_TIS_validation.bsdf": AT_650,
    "bsdf/speos/L100_2.simplescattering": [],
    "bsdf/speos/R_test.anisotropicbsdf": [],
    "photometry/ABSOLUTE_LED.ies": [],
    "photometry/ASA_15M_R2.ies": [],
    "photometry/FL_MAX_900W_SYM60.ldt": [],
    "photometry/Indoor_60W_5300lm.ies": [],
    "photometry/MAXWELL_measured_IESNA.ies": ["--area-mm", "300,300"],
    "photometry/examp1.ies": [],
    "photometry/road_luminaire.ldt": [],
    "photometry/threejs_007cfb.ies": [],
}

def call(program, *words):
    done = subprocess.run([program, "panel", *words], capture_output=True, text=True,
                          check=False)
    if done.returncode:
        sys.exit(f"panel {' '.join(words)}: {done.stderr}")
    return done.stdout


def claim_small(report, name, size, source):
    print(f"{name}: {size} bytes, {100 * size / source:.2f} % of the source")
    most = LARGER.get(name, max(SHARE * source, LEAST))
    report.claim(size <= most, f"{name}: {size} bytes of {source}; required <= {most:.0f}")


def check_shipped(report, program):
    for path in sorted(glob.glob(os.path.join(ROOT, "assets", "panels", "*.panel"))):
        total = json.loads(call(program, "info", path, "--json"))["total"]
        claim_small(report, os.path.basename(path), os.path.getsize(path),
                    total["source_bytes_float32"])


def check(report, program, folder, path):
    measured, out = os.path.join(folder, "MANIFEST.json"), os.path.join(folder, "x.panel")
    call(program, "import", os.path.join(DATA, path), "-o", measured, *FILES[path])
    total = json.loads(call(program, "fit", measured, "-o", out, "--force", "--json"))["total"]
    size, source = os.path.getsize(out), total["source_bytes_float32"]
    claim_small(report, path, size, source)


def main():
    report = Report()
    program = os.path.abspath(sys.argv[1])
    check_shipped(report, program)
    for path in FILES:
        if not os.path.exists(os.path.join(DATA, path)):
            print(f"skipped: {path}")
            continue
        with tempfile.TemporaryDirectory() as folder:
            check(report, program, folder, path)
    report.finish()


if __name__ == "__main__":
    main()
