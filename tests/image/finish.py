# SPDX-License-Identifier: Apache-2.0
"""finish.py PARHELION -- a matte finish that is tried out on a display: under an even sky it
reflects as much as the clear one, for light is spread and not lost; of a lamp whose image fills
the symbol it takes away what it spreads beyond.
"""
import os
import shutil
import sys
import tempfile

from gltf import Scene
from review import EYE, PANEL, Report, Reviewer, dashboard, moment, request

OLED = os.path.join(os.path.dirname(PANEL), "oled_centre.panel")
SHARE = 0.9
FINISHES = {name: {"scatters": share, "width_deg": width} for name, share, width in (
    ("narrow", SHARE, 1), ("wide", SHARE, 18), ("none", 0, 9))}


def alone():
    """The display of the dashboard, without its walls."""
    scene = dashboard()
    scene.document["scenes"][0]["nodes"] = [0, len(scene.document["nodes"]) - 1]
    return scene


def lamp():
    """Where the eye sees it mirrored in the display, which faces +Z at z = 0."""
    scene = Scene()
    scene.facing_quad(scene.emitter(4000), [-EYE[0], -EYE[1], EYE[2] + 0.2],
                      [EYE[0], EYE[1], -EYE[2]], 0.9, 0.5)
    return scene


def main(program):
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        reviewer = Reviewer(program, folder)
        shutil.copy(OLED, os.path.join(folder, "ips.panel"))
        alone().write(os.path.join(folder, "dash.gltf"))
        lamp().write(os.path.join(folder, "lamp.gltf"))
        variants = {name: {"finishes": {"screen": finish}} for name, finish in FINISHES.items()}
        dark = dict(moment("lamp", type="constant", luminance=0), lights=["lamp.gltf"])
        _, review = reviewer.review(request(
            conditions=[moment("even", type="constant", luminance=3000), dark],
            precision={"contrast": 0.01, "clear": 0.01}, variants=variants), "finish")
        bare = {c["condition"]: c["luminance_cd_m2"] for c in review["cases"]}
        report.claim(bare["even"]["mirror"] > 0.5 * bare["even"]["reflected"],
                     "the panel has no mirror to spread")
        found = {v["name"]: {c["condition"]: c["reflected_cd_m2"] for c in v["cases"]}
                 for v in review["variants"]}
        for name, each in found.items():
            share = each["even"] / bare["even"]["reflected"]
            report.claim(abs(share - 1) < 0.025, f"{name}: {share} of an even sky's light")
        kept = {name: each["lamp"] / bare["lamp"]["reflected"] for name, each in found.items()}
        report.claim(abs(kept["none"] - 1) < 0.01, f"no finish: {kept['none']}")
        report.claim(kept["narrow"] > kept["wide"] + 0.1 and kept["narrow"] < 1.02 and
                     kept["wide"] > 1 - SHARE, f"of the lamp's light {kept}")
        words = review["variants"][0]["changes"]
        report.claim("modelled" in words[0], f"it is not said to be modelled: {words}")
    return report.finish()


if __name__ == "__main__":
    sys.exit(main(sys.argv[-1]))
