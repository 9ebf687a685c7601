# SPDX-License-Identifier: Apache-2.0
"""colour.py PARHELION -- the colours of red, amber and white symbols behind a tinted pane, and
how bright they are: as a frame of the same view shows them, in the dark and in even light; their
limits; and a request that asks for none.
"""
import json
import math
import os
import shutil
import sys
import tempfile

from gltf import Scene, png
from review import PANEL, Report, Reviewer, moment

SIZE = 120, 40
BARS = {"red": (255, 0, 0), "amber": (255, 150, 0), "white": (255, 255, 255)}
LIGHT = 300  # cd/m2, even
LIMIT = {"unit": "1", "source": "a test", "read_in_the_standard": True, "ambient": "any"}


def bar_of(i):
    """Left, top, right, bottom, pixels."""
    return 15 + 40 * i, 10, 25 + 40 * i, 30


def write_room(folder):
    def pixel(x, y):
        for i, code in enumerate(BARS.values()):
            left, top, right, bottom = bar_of(i)
            if left <= x < right and top <= y < bottom:
                return code
        return 0, 0, 0
    scene = Scene()
    picture = png(*SIZE, [[v for x in range(SIZE[0]) for v in pixel(x, y)]
                          for y in range(SIZE[1])])
    screen = scene.material("screen", extensions={"PARHELION_display": {
        "panel": "ips.panel", "content": {"index": scene.image("image/png", picture)},
        "level": 0.5}})
    scene.quad(screen, [-0.15, -0.05, 0], [0.3, 0, 0], [0, 0.1, 0])
    scene.quad(scene.window(1.5, (1, 0.6, 0.3)), [-1, -1, 0.1], [2, 0, 0], [0, 2, 0])
    scene.view("eye", [0, 0, 1], [0, 0, -1], 20)
    scene.write(os.path.join(folder, "room.gltf"))
    shutil.copy(PANEL, os.path.join(folder, "ips.panel"))


def request(**more):
    symbols = {name: {"display": "screen", "polarity": "light-on-dark",
                      "uv": [(40 * i + 8) / SIZE[0], 0.1, (40 * i + 32) / SIZE[0], 0.9]}
                      for i, name in enumerate(BARS)}
    symbols["red"]["distinct_from"] = ["amber", "white"]
    return {"scene": ["room.gltf"], "profile": "./house.json", "symbols": symbols,
            "eyes": {"eye": {"camera": "eye"}}, "frames": {"worst": 0},
            "precision": {"contrast": 0.05},
            "conditions": [moment("even", type="constant", luminance=LIGHT),
                           moment("dark", type="constant", luminance=1e-6)], **more}


def in_frame(reviewer, luminance):
    """What is measured in the middle of each bar, in a frame of the same view."""
    reviewer.run("render", "room.gltf", "--size", "240x135", "--spp", "16", "--environment",
                 f"constant:{luminance}", "-o", "f.exr")
    pixels, found = 67.5 / math.tan(math.radians(10)), {}  # a metre, at the display
    for i, name in enumerate(BARS):
        left, top, right, bottom = bar_of(i)
        x = int(120 + pixels * (0.15 * (left + right) / SIZE[0] - 0.15))
        y = int(67.5 - pixels * (0.05 - 0.05 * (top + bottom) / SIZE[1]))
        answer = reviewer.run("measure", "f.exr", "--region",
                              f"{x - 3},{y - 6},{x + 3},{y + 6}", "--json").stdout
        found[name] = json.loads(answer)
    return found


def delta(one, other):
    return math.dist(one, other)


def limit(kind, value):
    return {"kind": kind, "value": value, **LIMIT}


def check_case(report, case, frame):
    own = case["colours"][0]
    report.claim([c["symbol"] for c in case["colours"]] ==
                 [case["symbol"]] + [name for name in BARS if name != case["symbol"]],
                 "its own colour first")
    report.claim(abs(own["delta_uv"] - delta(own["uv"], own["dark_uv"])) < 3e-6, "its shift")
    for other in case["colours"]:
        low, high = other["interval"]
        seen = frame[other["symbol"]]["uv"]
        print(f"{other['symbol']}: {other['uv']}, in the frame {seen}")
        report.claim(low <= other["delta_uv"] <= high, "in its interval")
        report.claim(delta(other["uv"], seen) < 0.001, "as a frame shows it")
        if other is not own:
            report.claim(abs(other["delta_uv"] - delta(own["uv"], other["uv"])) < 3e-6,
                         "their difference")
    least = min(case["colours"][1:], key=lambda c: c["delta_uv"])
    lines = {line["kind"]: line for line in case["limits"]}
    report.claim(lines["colour_difference"]["found"] == least["delta_uv"] and
                 lines["colour_difference"]["beside"] == least["symbol"], "the least is judged")
    report.claim(lines["colour_shift"]["found"] == own["delta_uv"] and
                 lines["colour_shift"]["upper"], "and the shift, at most")


def main():
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        reviewer = Reviewer(sys.argv[1], folder)
        write_room(folder)
        house = {"title": "house", "edition": "1", "ambient": {
            "night_below_lx": 5, "twilight_below_lx": 100, "source": "a test",
            "read_in_the_standard": False},
            "limits": [limit("contrast_ratio", 1.2), limit("colour_shift", 0.03),
                       limit("colour_difference", 0.05)]}
        reviewer.write("house.json", house)
        _, found = reviewer.review(request(), "asked")
        by_name = {(c["condition"], c["symbol"]): c for c in found["cases"]}
        check_case(report, by_name["even", "red"], in_frame(reviewer, LIGHT))
        frame = in_frame(reviewer, 1e-6)
        for name in BARS:
            dark = by_name["dark", name]["colours"][0]
            report.claim(dark["delta_uv"] < 1e-4 and
                         delta(dark["dark_uv"], frame[name]["uv"]) < 0.001,
                         "in the dark, behind the pane")
            check_light(report, reviewer, name, by_name, frame[name]["luminance_cd_m2"])
            report.claim(by_name["dark", name]["verdict"] == "pass", "which passes")
        report.claim(by_name["even", "red"]["judged"]["kind"] == "colour_shift" and
                     by_name["even", "red"]["verdict"] == "fail", "red pales")
        check_unasked(report, reviewer, house, by_name)
    report.finish()


def check_light(report, reviewer, name, by_name, seen):
    """Each by its own spectrum: what passes of red is more than of white. So does explain."""
    i = list(BARS).index(name)
    left, top, right, bottom = bar_of(i)
    uv = ",".join(str(v) for v in (left / SIZE[0], top / SIZE[1], right / SIZE[0],
                                   bottom / SIZE[1]))
    explained = json.loads(reviewer.run(
        "explain", "room.gltf", "--camera", "eye", "--display", "screen", "--uv", uv, "--paths",
        "256", "--environment", "constant:1e-6", "--json").stdout)["luminance_cd_m2"]
    shown = by_name["dark", name]["luminance_cd_m2"]["foreground"]
    print(f"{name}: {shown} cd/m2, explained {explained['emitted']}, in the frame {seen}")
    report.claim(abs(shown / seen - 1) < 0.005, "as bright as in the frame")
    report.claim(abs(explained["emitted"] / shown - 1) < 0.01, "and as explained")


def check_unasked(report, reviewer, house, asked):
    """Without limit and key nothing is said of colour, and the light is the same."""
    house["limits"] = house["limits"][:1]
    reviewer.write("house.json", house)
    document = request()
    del document["symbols"]["red"]["distinct_from"]
    _, found = reviewer.review(document, "unasked")
    for case in found["cases"]:
        before = asked[case["condition"], case["symbol"]]
        report.claim("colours" not in case, "no colour")
        if case["paths"] == before["paths"]:
            report.claim(case["luminance_cd_m2"] == before["luminance_cd_m2"], "the same light")
    document["symbols"]["red"]["distinct_from"] = ["red"]
    reviewer.write("r.json", document)
    report.claim("names the symbol itself, required: other symbols (/symbols/red/distinct_from)"
                 in reviewer.run("review", "r.json", "-o", "self").stderr, "not itself")


if __name__ == "__main__":
    main()
