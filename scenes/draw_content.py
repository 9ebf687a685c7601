#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Draws what the displays show, sRGB code values as a panel receives them, into
assets/content: cluster.png (1920x720) and centre.png (2560x1440) of car_dashboard.gltf; pfd.png
and nav.png (1280x1024), engine.png, standby.png, cdu.png and windows.png of cockpit.gltf.
What is written in each lies beside it (NAME.words). Another folder may be named.

Needs python3-cairo and the font Inter (Debian fonts-inter, SIL Open Font Licence 1.1).
"""
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "modelling"))

from centre_content import draw_centre  # noqa: E402
from cluster_content import draw_cluster  # noqa: E402
from flight_content import draw_nav, draw_pfd  # noqa: E402
from systems_content import draw_systems  # noqa: E402

FOLDER = sys.argv[1] if sys.argv[1:] else os.path.join(HERE, "..", "assets", "content")


if __name__ == "__main__":
    os.makedirs(FOLDER, exist_ok=True)
    draw_cluster(os.path.join(FOLDER, "cluster.png"))
    draw_centre(os.path.join(FOLDER, "centre.png"))
    draw_pfd(os.path.join(FOLDER, "pfd.png"))
    draw_nav(os.path.join(FOLDER, "nav.png"))
    draw_systems(FOLDER)
