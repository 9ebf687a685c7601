#!/usr/bin/python3
"""Draws what the displays of car_dashboard.gltf show: assets/content/cluster.png (1920x720)
and assets/content/centre.png (2560x1440), sRGB code values as a panel receives them.

Needs python3-cairo and the font Inter (Debian fonts-inter, SIL Open Font Licence 1.1).
"""
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "modelling"))

from centre_content import draw_centre  # noqa: E402
from cluster_content import draw_cluster  # noqa: E402

FOLDER = os.path.join(HERE, "..", "assets", "content")


if __name__ == "__main__":
    os.makedirs(FOLDER, exist_ok=True)
    draw_cluster(os.path.join(FOLDER, "cluster.png"))
    draw_centre(os.path.join(FOLDER, "centre.png"))
