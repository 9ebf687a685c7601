# SPDX-License-Identifier: Apache-2.0
"""explain.py PARHELION -- why a display looks as it does: chains of objects add up to the
frame's layers, and what they foretell comes true.
"""
import json
import math
import os
import shutil
import sys
import tempfile

from exr import Frame
from review import PANEL, Report, Reviewer, close, dashboard, moment, request

REGION = (30, 16, 62, 38)
SIZE = "96x54"


def named_dashboard():
    """Each wall a node and a material of its own."""
    scene = dashboard()
    for i, node in enumerate(scene.document["nodes"]):
        if "mesh" not in node:
            continue
        node["name"] = name = ("screen", "floor", "side")[i]
        if name == "screen":
            continue
        material = scene.lambert(0.5)
        scene.document["materials"][material]["name"] = name + " paint"
        scene.document["meshes"][node["mesh"]]["primitives"][0]["material"] = material
    return scene


def explain(reviewer, *line):
    done = reviewer.run("explain", *line, "--json", "--paths", "16384")
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def region_mean(frame, name):
    """Mean luminance of a layer over the region, and its standard error by rows of pixels."""
    c, width = frame.channels, 96
    rgb = [(c[f"{name}.R"], 0.2126), (c[f"{name}.G"], 0.7152), (c[f"{name}.B"], 0.0722)]
    values = [sum(weight * channel[y * width + x] for channel, weight in rgb)
              for y in range(REGION[1], REGION[3]) for x in range(REGION[0], REGION[2])]
    mean = sum(values) / len(values)
    spread = sum((v - mean) ** 2 for v in values) / (len(values) - 1)
    return mean, math.sqrt(spread / len(values))


def check_frame(report, reviewer):
    reviewer.run("render", "dash.gltf", "--environment", "constant:3000", "--size", SIZE,
                 "--spp", "32", "--layers", "all", "-o", "frame.exr")
    frame = Frame(os.path.join(reviewer.folder, "frame.exr"))
    told = explain(reviewer, "dash.gltf", "--environment", "constant:3000", "--size", SIZE,
                   "--region", ",".join(map(str, REGION)))
    light, chains = told["luminance_cd_m2"], told["chains"]
    added = sum(chain["cd_m2"] for chain in chains)
    reflected, sigma = region_mean(frame, "display.reflected")
    report.claim(close(added, light["reflected"], 1e-6), "chains do not add up")
    report.claim(abs(added - reflected) < 3 * math.hypot(sigma, 0.002 * reflected),
                 f"chains {added:.6g}, the layer {reflected:.6g} +- {sigma:.2g}")
    for part in ("mirror", "scattered"):
        wanted, sigma = region_mean(frame, "display." + part)
        report.claim(abs(light[part] - wanted) < 3 * math.hypot(sigma, 0.003 * wanted),
                     f"{part} {light[part]:.6g}, the layer {wanted:.6g} +- {sigma:.2g}")
    for name in ("white", "black"):
        wanted, _ = region_mean(frame, "display." + name)
        report.claim(close(light[name], wanted, 0.005), f"{name} {light[name]}, {wanted}")
    shown = (light["white"] + light["reflected"]) / (light["black"] + light["reflected"])
    report.claim(close(told["contrast_ratio"], shown, 1e-6), "contrast of its parts")
    first = chains[0]
    without = ((light["white"] + light["reflected"] - first["cd_m2"]) /
               (light["black"] + light["reflected"] - first["cd_m2"]))
    report.claim(close(first["contrast_without"], without, 1e-6), "contrast without the first")
    report.claim(first["interval"][0] < first["cd_m2"] < first["interval"][1], "interval")


def check_wall(report, reviewer):
    """Off displays: all that comes to the eye."""
    reviewer.run("render", "dash.gltf", "--environment", "constant:3000", "--eye",
                 "0.3,0.4,0.9", "--look-at", "0,-0.3,0.5", "--fov", "10", "--size", SIZE,
                 "--spp", "16", "-o", "wall.exr")
    channels = Frame(os.path.join(reviewer.folder, "wall.exr")).channels
    wanted = sum(0.2126 * channels["R"][i] + 0.7152 * channels["G"][i] +
                 0.0722 * channels["B"][i] for i in range(96 * 54)) / (96 * 54)
    told = explain(reviewer, "dash.gltf", "--environment", "constant:3000", "--eye",
                   "0.3,0.4,0.9", "--look-at", "0,-0.3,0.5", "--fov", "10", "--size", SIZE,
                   "--region", "0,0,96,54")
    found = told["luminance_cd_m2"]
    report.claim(told["display"] is None and close(found["all"], wanted, 0.01),
                 f"a wall: {found}, the frame {wanted:.6g}")
    report.claim(told["chains"][0]["chain"][0].startswith("floor (floor paint)"),
                 f"the floor is {told['chains'][0]['chain']}")
    for what, wanted in ((("--pixel", "12,54"), "--pixel 12,54: is no pixel of a picture of"),
                         (("--pixel", "1.5,2"), "--pixel 1.5,2: is no pixel"),
                         (("--region", "0,0,97,54"), "--region: 97 is no edge of a pixel")):
        done = reviewer.run("explain", "dash.gltf", "--size", SIZE, *what)
        report.claim(done.returncode == 2 and len(done.stderr.splitlines()) == 1 and
                     wanted in done.stderr, f"{what}: {done.returncode} {done.stderr}")


def check_remedies(report, reviewer):
    """What is foretold of the brightness, made so and judged again; as remedies.py does."""
    document = request(precision={"contrast": 0.01}, levels={"dim": {"*": 0.1}}, conditions=[
        moment("bright", type="constant", luminance=3000)])
    document["conditions"][0]["level"] = "dim"
    _, review = reviewer.review(document, "washed")
    case = review["cases"][0]
    if not report.claim(case["verdict"] == "fail" and case["remedies"], str(case["remedies"])):
        return

    def judged(what, foretold, found):
        spread = found["contrast_interval"][1] - found["contrast_interval"][0]
        apart = abs(found["contrast_ratio"] - foretold)
        report.claim(apart < 0.02 * foretold or apart < 3 * spread / 3.92,
                     f"{what}: foretold {foretold:.5g}, found {found['contrast_ratio']:.5g}")

    brighter = case["remedies"][0]
    document["levels"] = {"more": {"*": brighter["level"]}}
    document["conditions"][0]["level"] = "more"
    _, review = reviewer.review(document, "brighter")
    judged("brighter", brighter["contrast_ratio"], review["cases"][0])


def check_refusals(report, reviewer):
    reviewer.write("r.json", request(conditions=[
        moment("grey", type="constant", luminance=1),
        {"name": "suns", "sweep": {"sky": "sky", "sun": {
            "azimuth_deg": [0, 0, 1], "elevation_deg": [9, 9, 1]}}}]))
    for status, words, line in (
            (2, "--display", ["dash.gltf"]),
            (3, "scren", ["dash.gltf", "--display", "scren"]),
            (2, "96", ["dash.gltf", "--pixel", "96,3", "--size", SIZE]),
            (2, "--symbol", ["dash.gltf", "--pixel", "9,3", "--symbol", "bar"]),
            (2, "--seed", ["r.json", "--condition", "grey", "--seed", "1"]),
            (2, "'grey', 'suns'", ["r.json"]),
            (2, "'grey', 'suns'", ["r.json", "--condition", "gray"]),
            (2, "--sun", ["r.json", "--condition", "suns"]),
            (2, "--sun", ["r.json", "--condition", "grey", "--sun", "3,4"]),
            (2, "'bar'", ["r.json", "--condition", "grey", "--symbol", "baz"]),
            (2, "'eye'", ["r.json", "--condition", "grey", "--eye", "ear"]),
            (2, "--camera", ["r.json", "--condition", "grey", "--camera", "eye"])):
        done = reviewer.run("explain", *line)
        lines = done.stderr.strip().splitlines()
        report.claim(done.returncode == status and words in done.stderr and len(lines) == 1,
                     f"explain {' '.join(line)}: status {done.returncode}: {done.stderr}")


def main(program):
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        reviewer = Reviewer(program, folder)
        shutil.copy(PANEL, os.path.join(folder, "ips.panel"))
        named_dashboard().write(os.path.join(folder, "dash.gltf"))
        check_frame(report, reviewer)
        check_wall(report, reviewer)
        check_remedies(report, reviewer)
        check_refusals(report, reviewer)
    return report.finish()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
