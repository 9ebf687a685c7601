# SPDX-License-Identifier: Apache-2.0
"""panel_checks.py -- what the checks of displays against their panels share."""
import glob
import math
import os
import subprocess
import sys
import tempfile

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402


def direction(theta_deg, phi_deg):
    """Towards the eye: theta from the normal (+Z), phi from the right (+X) to above (+Y)."""
    theta, phi = math.radians(theta_deg), math.radians(phi_deg)
    return [math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta)]


def check_panels(check_panel):
    """`[--all] [PANEL...] PARHELION` of the command line; the panels of assets/panels when none
    is named.
    check_panel(report, program, panel, folder) says what it found to the report."""
    report, program = Report(), os.path.abspath(sys.argv[-1])
    named = [word for word in sys.argv[1:-1] if word != "--all"]
    panels = named or sorted(glob.glob(os.path.join(ROOT, "assets/panels/*.panel")))
    report.claim(bool(panels), "assets/panels holds no panel")
    with tempfile.TemporaryDirectory() as folder:
        for panel in panels:
            try:
                check_panel(report, program, panel, folder)
            except subprocess.CalledProcessError as error:
                report.claim(False, f"{panel}: {error.stderr}")
    report.finish()
