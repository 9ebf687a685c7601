# SPDX-License-Identifier: Apache-2.0
"""real_sizes.py PARHELION -- a panel keeps no more than was measured.

Law   of every real file that is imported, the panel's bytes are at most the source's as
      32-bit numbers without angles, and 10 % of them where there are more than 20,000 values.
Needs  ../shared/data; skipped without it."""
import json
import os
import subprocess
import sys
import tempfile

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

DATA = os.path.join(ROOT, "..", "shared", "data")
MANY = 20000
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


def check(report, program, folder, path):
    measured, out = os.path.join(folder, "MANIFEST.json"), os.path.join(folder, "x.panel")
    call(program, "import", os.path.join(DATA, path), "-o", measured, *FILES[path])
    total = json.loads(call(program, "fit", measured, "-o", out, "--force", "--json"))["total"]
    size, source = os.path.getsize(out), total["source_bytes_float32"]
    most = 0.1 if source // 4 > MANY else 1
    report.claim(size <= most * source, f"{path}: {size} bytes, {size / source:.3f} of the "
                 f"source; required <= {most:g}")


def main():
    report = Report()
    program = os.path.abspath(sys.argv[1])
    for path in FILES:
        if not os.path.exists(os.path.join(DATA, path)):
            print(f"skipped: {path}")
            continue
        with tempfile.TemporaryDirectory() as folder:
            check(report, program, folder, path)
    report.finish()


if __name__ == "__main__":
    main()
