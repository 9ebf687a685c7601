# SPDX-License-Identifier: Apache-2.0
"""finish.py PARHELION -- a matte finish that is tried out on a display: under an even sky it
reflects as much as the clear one, for light is spread and not lost; of a lamp whose image fills
the symbol it takes away what it spreads beyond. Where bars are as bright as each other the part
that is judged changes from share to share: then it is told, and where it is the same the light
falls evenly.
"""
import json
import math
import os
import shutil
import sys
import tempfile

from gltf import Scene
from review import EYE, PANEL, Report, Reviewer, dashboard, moment, request
from worst_part import HIGH, WIDE, content

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


def bars():
    """A bare display of bars, and a lamp whose image covers most of them."""
    scene = Scene()
    screen = scene.material("screen", extensions={"PARHELION_display": {
        "panel": "ips.panel", "content": {"index": scene.image("image/png", content())},
        "level": 1}})
    width, height = WIDE / 1000, HIGH / 1000
    scene.quad(screen, [-width / 2, -height / 2, 0], [width, 0, 0], [0, height, 0])
    scene.view("eye", [0.05, 0.1, 0.7], [-0.05, -0.1, -0.7], 20)
    scene.facing_quad(scene.emitter(4000), [-0.03, -0.1, 0.7], [0.03, 0.1, -0.7], 0.06, 0.3)
    return scene


def check_parts(report, reviewer):
    bars().write(os.path.join(reviewer.folder, "bars.gltf"))
    shares = [0.05 + 0.06 * i for i in range(12)]
    document = {"scene": ["bars.gltf"], "profile": "iso-15008", "frames": {"worst": 0},
                "eyes": {"eye": {"camera": "eye"}},
                "symbols": {"bars": {"display": "screen", "uv": [0, 0, 1, 1],
                                     "polarity": "light-on-dark"}},
                "conditions": [moment("lamp", type="constant", luminance=20)],
                "precision": {"contrast": 0.01, "clear": 0.01},
                "variants": {f"{share:.2f}": {"finishes": {"screen": {
                    "scatters": share, "width_deg": 4}}} for share in shares}}
    _, review = reviewer.review(document, "bars")
    page = os.path.join(reviewer.folder, "bars", "index.html")
    with open(page, encoding="utf-8") as file:
        page = file.read()
    own = review["cases"][0]["judged_part_uv"]
    found = [v["cases"][0] for v in review["variants"]]
    steps = [math.log(b["reflected_cd_m2"] / a["reflected_cd_m2"])
             for a, b in zip(found, found[1:])]
    even = sorted(steps)[len(steps) // 2]
    for i, step in enumerate(steps):
        if found[i]["judged_part_uv"] == found[i + 1]["judged_part_uv"]:
            report.claim(abs(step - even) < 0.008, f"a step of {step}, as a rule {even}")
    for case in found:
        part = case["judged_part_uv"]
        report.claim(case["other_part"] == (part != own), f"another part: {json.dumps(case)}")
        told = f"another part of the symbol: {100 * part['left']:.0f} to"
        report.claim(part == own or told in page, f"{told} is not told")
    report.claim(any(case["other_part"] for case in found), "no part changes")


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
        check_parts(report, reviewer)
    return report.finish()


if __name__ == "__main__":
    sys.exit(main(sys.argv[-1]))
