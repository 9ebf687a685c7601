# SPDX-License-Identifier: Apache-2.0
"""remedies.py PARHELION -- what a review says would mend a case: the brightness that is
foretold comes true when it is made so and reviewed again, and passes; where nobody sits a seat
is named as empty, and nothing else is.
"""
import os
import re
import shutil
import sys
import tempfile

from gltf import Scene, png
from review import PANEL, Report, Reviewer, close, request

OLED = os.path.join(os.path.dirname(PANEL), "oled_centre.panel")
SEAT, PANE, PLATE = "Lehne_7", "Scheibe", "Konsole"


class Cabin:
    """A display at the origin that looks along +Z at an eye before it."""

    def __init__(self, panel, eye, turned=(0, 0, -1)):
        self.scene, self.eye, self.forward = Scene(), eye, list(turned)
        bars = png(60, 30, [[255 if 26 <= x < 34 and 12 <= y < 18 else 0 for x in range(60)
                             for _ in range(3)] for y in range(30)])
        screen = self.scene.material("screen", extensions={"PARHELION_display": {
            "panel": os.path.basename(panel), "level": 1,
            "content": {"index": self.scene.image("image/png", bars)}}})
        self.quad("screen", screen, [-0.15, -0.075, 0], [0.3, 0, 0], [0, 0.15, 0])
        self.scene.view("eye", eye, [-x for x in eye], 8)

    def quad(self, name, material, corner, right, up):
        self.scene.quad(material, corner, right, up)
        self.scene.document["nodes"][-1]["name"] = name

    def cloth(self, reflectance, name):
        material = self.scene.lambert(reflectance, double_sided=True)
        self.scene.document["materials"][material]["name"] = name
        return material

    def write(self, reviewer, name="dash.gltf"):
        self.scene.write(os.path.join(reviewer.folder, name))


def asked(cabin, azimuth, elevation, level, sky=100, **members):
    environment = {"type": "constant", "luminance": sky, "sun": {
        "azimuth_deg": azimuth, "elevation_deg": elevation, "illuminance_lx": 80000}}
    return request(
        eyes={"driver": {"position_m": cabin.eye}}, forward=cabin.forward,
        symbols={"bar": {"display": "screen", "uv": [0.4, 0.35, 0.6, 0.65]}},
        levels={"day": {"*": level}}, precision={"contrast": 0.005, "clear": 0.005},
        conditions=[{"name": "sun", "level": "day", "environment": environment}], **members)


def reviewed(reviewer, cabin, document, out):
    cabin.write(reviewer)
    return reviewer.review(document, out)[1]["cases"][0]


def check_list(report, case, what):
    report.claim(len(case["remedies"]) <= 1, f"{what}: {case['remedies']}")
    for remedy in case["remedies"]:
        words, ratio = remedy["what"], remedy["contrast_ratio"]
        report.claim(re.match(r"(raise the brightness level|dim) from [\d.e-]+ % to [\d.e-]+ %",
                              words), f"{what}: {words}")
        report.claim(remedy["level"] <= 1, f"{what}: more than the display has: {words}")
        report.claim(ratio > case["contrast_interval"][1], f"{what}: {words} gives {ratio}")


def agrees(report, what, foretold, found, share):
    spread = found["contrast_interval"][1] - found["contrast_interval"][0]
    apart = abs(found["contrast_ratio"] - foretold)
    report.claim(apart < share * foretold or apart < 3 * spread / 3.92,
                 f"{what}: foretold {foretold:.5g}, found {found['contrast_ratio']:.5g}")


# ---- a seat behind the eye, lit through a pane; its picture in a glossy display --------------

def seat_cabin(forward=(0, 0, -1)):
    cabin = Cabin(OLED, [0, 0.15, 0.7], forward)
    seat = cabin.cloth(0.5, "Stoff 3")
    pane = cabin.scene.window(1.5)
    cabin.scene.document["materials"][pane]["name"] = "Glas"
    cabin.quad(SEAT, seat, [0.4, -0.9, 1.05], [-0.8, 0, 0], [0, 0.8, 0])
    cabin.quad(PANE, pane, [-2, 0.4, -0.5], [4, 0, 0], [0, 2, 0])
    return cabin


def check_seat(report, reviewer):
    cabin = seat_cabin()
    document = asked(cabin, 0, 40, 0.2)
    case = reviewed(reviewer, cabin, document, "seat")
    surface = case["cause_groups"]["surface"][0]
    report.claim(case["verdict"] == "fail" and SEAT in surface["what"] and
                 surface["share"] > 0.8, f"the seat does not wash it out: {surface}")
    check_list(report, case, "an empty seat")
    report.claim(case["empty_seat"] and SEAT in case["empty_seat"] and
                 close(case["empty_seat_share"], surface["share"], 0.02),
                 f"an empty seat: {case['empty_seat']}, {case['empty_seat_share']}")
    page = open(os.path.join(reviewer.folder, "seat", "index.html"), encoding="utf-8").read()
    report.claim("Empty seat" in page and "of the reflected light; add an occupant" in page,
                 "the page does not say so")
    if report.claim(case["remedies"], "no brightness"):
        check_brighter(report, reviewer, cabin, document, case["remedies"][0])


def check_brighter(report, reviewer, cabin, document, remedy):
    document = {**document, "levels": {"day": {"*": remedy["level"]}}}
    found = reviewed(reviewer, cabin, document, "brighter")
    agrees(report, remedy["what"], remedy["contrast_ratio"], found, 0.01)
    report.claim(found["verdict"] == "pass", f"{remedy['what']}: {found['contrast_interval']}")


def check_occupied(report, reviewer):
    """The same seat, with somebody named under the condition; and one who faces elsewhere."""
    cabin = seat_cabin()
    body = Scene()
    shirt = body.lambert(0.5, double_sided=True)
    body.quad(shirt, [0.2, -0.6, 0.75], [-0.4, 0, 0], [0, 0.5, 0])
    body.write(os.path.join(reviewer.folder, "body.gltf"))
    document = asked(cabin, 0, 40, 0.2, **{"with": {"somebody": ["body.gltf"]}})
    document["conditions"][0]["with"] = "somebody"
    case = reviewed(reviewer, cabin, document, "occupied")
    report.claim(case["empty_seat"] is None, f"an occupied seat: {case['empty_seat']}")
    check_list(report, case, "an occupied seat")
    aside = seat_cabin(forward=(1, 0, 0))
    case = reviewed(reviewer, aside, asked(aside, 90, 40, 0.2), "aside")
    report.claim(case["empty_seat"], "a forward direction across the gaze hides the seat")


# ---- a plate before the display, and a sun on it ---------------------------------------------

def check_plate(report, reviewer):
    cabin = Cabin(OLED, [0, 0.3, 0.9])
    cabin.quad(PLATE, cabin.cloth(0.6, "Lack"), [-0.4, -0.1, 0.45], [0.8, 0, 0], [0, 0, -0.35])
    case = reviewed(reviewer, cabin, asked(cabin, 0, 70, 0.1), "plate")
    check_list(report, case, "a plate")
    report.claim(case["empty_seat"] is None, "a plate is a seat")


def main(program):
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        reviewer = Reviewer(program, folder)
        for panel in (PANEL, OLED):
            shutil.copy(panel, folder)
        for check in (check_seat, check_occupied, check_plate):
            check(report, reviewer)
    report.finish()


if __name__ == "__main__":
    main(*sys.argv[1:])
