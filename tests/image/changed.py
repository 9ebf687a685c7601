# SPDX-License-Identifier: Apache-2.0
"""changed.py [--all] PARHELION -- a door that opens in a variant is the door of a scene that
was opened by hand; a mirrored vehicle under mirrored light gives the figures of the vehicle as
it was, is the vehicle that was mirrored by hand, and its displays can still be read. --all:
also about a node's own origin, from a box of eyes, and the mirrored light.
"""
import math
import os
import shutil
import sys
import tempfile

from gltf import Scene, png
from review import PANEL, Report, Reviewer

AHEAD = [math.sin(0.3), 0, -math.cos(0.3)]   # where the vehicle points
RIGHT = [math.cos(0.3), 0, math.sin(0.3)]
MIDDLE = 0.05                                # of the vehicle, to the right of the origin
HINGE = [-0.3, 0, 0.75]                      # ahead, up, right of the vehicle's middle
SWING_DEG = 50
SYMBOLS = ("bar", 0.1, 0.9), ("left", 0.02, 0.35)


def bars(even):
    """A bar in the middle, or one on its left as well, so that left and right differ."""
    lit = [(24, 36)] if even else [(6, 16), (24, 36)]
    return png(60, 30, [[255 * (any(a <= x < b for a, b in lit) and 8 <= y < 22)
                         for x in range(60) for _ in range(3)] for y in range(30)])


def placed(ahead, up, right):
    """A point of the vehicle, right of its middle plane."""
    return [ahead * AHEAD[i] + (right + MIDDLE) * RIGHT[i] + (up if i == 1 else 0)
            for i in range(3)]


def way(ahead, up, right):
    return [ahead * AHEAD[i] + right * RIGHT[i] + (up if i == 1 else 0) for i in range(3)]


def car(side=1, even=True, door_deg=0.0):
    """Seen from the right seat (side 1) or its mirror image, built so by hand: a display before
    the driver, a white wall on their outer side, a dark one behind them, a door that may be
    open by so many degrees about its hinge, which stands upright."""
    scene = Scene()
    screen = scene.material("screen", extensions={"PARHELION_display": {
        "panel": "ips.panel", "content": {"index": scene.image("image/png", bars(even))}}})

    def quad(material, corner, along, up, name, **node):
        """along: left to right of who faces it; mirrored the corners change places."""
        corner = [corner[0], corner[1], side * corner[2]]
        along = [along[0], along[1], side * along[2]]
        if side < 0:
            corner = [c + a for c, a in zip(corner, along)]
            along = [-a for a in along]
        up = [up[0], up[1], side * up[2]]
        hang = node.pop("hang", None)
        at = way(*[c - h for c, h in zip(corner, hang)]) if hang else placed(*corner)
        scene.quad(material, at, way(*along), way(*up))
        scene.document["nodes"][-1].update(name=name, **node)
    quad(screen, [0.7, -0.1, 0.2], [0, 0, 0.3], [0.03, 0.15, 0.02], "face")
    quad(scene.lambert(0.8), [0.9, -0.5, 0.9], [-1.2, 0, 0], [0, 0.9, 0], "wall")
    quad(scene.lambert(0.2), [-1.2, -0.3, 0.9], [0, 0, -1.3], [0, 0.6, 0.1], "seat")
    hinge = [HINGE[0], HINGE[1], side * HINGE[2]]
    turn = side * math.radians(door_deg) / 2
    quad(scene.lambert(0.9), [-0.3, -0.1, 0.75], [0, 0, -0.8], [0, 0.9, 0], "door",
         hang=hinge, translation=placed(*hinge),
         rotation=[0, math.sin(turn), 0, math.cos(turn)])
    scene.view("eye", placed(0, 0.2, side * 0.35), way(1, -0.2, 0), 20)
    return scene


def asked(azimuth_deg, whole=True, side=1, even=True, **members):
    box = {"box": {"centre_m": placed(0, 0.25, side * 0.4), "grid": [1, 2, 1],
                   "half_size_m": [0, 0.05, 0]}} if whole else {}
    sun = {"azimuth_deg": azimuth_deg, "elevation_deg": 40, "illuminance_lx": 30000}
    return {
        "title": "test", "scene": ["car.gltf"], "forward": AHEAD, "profile": "iso-15008",
        "eyes": {"driver": {"camera": "eye"}, **box},
        "symbols": {name: {"display": "screen", "uv": [left, 0.1, right, 0.9]}
                    for name, left, right in SYMBOLS[:2 - even]},
        "levels": {"auto": {"sensor": {"position_m": placed(0.6, 0.2, side * 0.5),
                                       "normal": way(-0.5, 1, side * -0.4)},
                            "table_lx": [[100, 0.1], [40000, 1]]}},
        "precision": {"contrast": 0.02, "clear": 0.02}, "frames": {"worst": 0},
        "conditions": [{"name": "sunny", "level": "auto", "heading_deg": 0, "environment": {
            "type": "constant", "luminance": 900, "sun": sun}}], **members}


def figures(review):
    return {(c["eye"], c["symbol"]): c for c in review["cases"]}


def check_same(report, what, found, wanted):
    """Contrasts within their intervals and levels within their sensor's one per cent."""
    for key, case in wanted.items():
        mine = found[key]
        low, high = mine["contrast_interval"]
        other = case["contrast_interval"]
        width = math.hypot(high - low, other[1] - other[0]) / 2
        report.claim(width < 0.1 * case["contrast_ratio"], f"{what}, {key}: width {width}")
        report.claim(abs(mine["contrast_ratio"] - case["contrast_ratio"]) <= 1.5 * width,
                     f"{what}, {key}: {mine['contrast_ratio']}, required: "
                     f"{case['contrast_ratio']} within {width}")
        report.claim(abs(mine["level"] / case["level"] - 1) < 0.04,
                     f"{what}, {key}: level {mine['level']}, required: {case['level']}")


def differ(report, what, found, plain):
    """The change does something at all."""
    most = max(abs(found[key]["contrast_ratio"] / plain[key]["contrast_ratio"] - 1)
               for key in plain)
    report.claim(most > 0.05, f"{what}: differs by {most} at most")


def changes(whole):
    turn = {"axis": [0, 3, 0], "angle_deg": SWING_DEG}
    hinges = {"door": {**turn, "through_m": placed(*HINGE)}}
    if whole:
        hinges["door, own"] = turn
    doors = {name: {"nodes": {"door": {"hinge": hinge}}} for name, hinge in hinges.items()}
    return {**doors, "right": {"mirror": {"middle_m": MIDDLE}}}


def check_by_hand(report, reviewer, whole):
    path = os.path.join(reviewer.folder, "car.gltf")
    car(even=False).write(path)
    _, base = reviewer.review(asked(20, whole, even=False, variants=changes(whole)), "base")
    for variant in base["variants"]:
        name, found = variant["name"], figures(variant)
        side = -1 if name == "right" else 1
        car(side, False, 0 if name == "right" else SWING_DEG).write(path)
        _, by_hand = reviewer.review(asked(20, whole, side, even=False), "hand")
        check_same(report, name, found, figures(by_hand))
        differ(report, name, found, figures(base))


def check_mirrored_light(report, reviewer):
    car().write(os.path.join(reviewer.folder, "car.gltf"))
    _, base = reviewer.review(asked(70), "left")
    _, other = reviewer.review(asked(-70, variants={"right": changes(False)["right"]}), "other")
    check_same(report, "under mirrored light", figures(other["variants"][0]), figures(base))


def main(program, whole):
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        reviewer = Reviewer(program, folder)
        shutil.copy(PANEL, os.path.join(folder, "ips.panel"))
        check_by_hand(report, reviewer, whole)
        if whole:
            check_mirrored_light(report, reviewer)
    return report.finish()


if __name__ == "__main__":
    sys.exit(main(sys.argv[-1], "--all" in sys.argv))
