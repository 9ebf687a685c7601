# SPDX-License-Identifier: Apache-2.0
"""private.py PARHELION -- a symbol that the driver must not read and sees in a pane alone: its
review fails by that pane and every view names it, a darker display passes, and figures that
belong together agree; what would dim it in the pane says what can be read no more.
"""
import csv
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "structure"))
from report import Report  # noqa: E402
from gltf import Scene, png  # noqa: E402

ROOT = os.path.dirname(os.path.dirname(HERE))
PANEL = os.path.join(ROOT, "assets", "panels", "ips_cluster.panel")


def scene_of(folder):
    """The display turns its back to the eye; a pane ahead shows it, before an even sky."""
    scene = Scene()
    bars = png(60, 30, [[255 if 20 <= x < 40 and 8 <= y < 22 else 0 for x in range(60)
                         for _ in range(3)] for y in range(30)])
    screen = scene.material("screen", extensions={"PARHELION_display": {
        "panel": "ips.panel", "content": {"index": scene.image("image/png", bars)},
        "level": 1}})
    scene.quad(screen, [0.65, -0.075, 0.2], [-0.3, 0, 0], [0, 0.15, 0])
    scene.quad(scene.window(1.52), [-2, -2, -0.5], [4, 0, 0], [0, 4, 0])
    scene.view("eye", [0.1, 0.15, 0.8], [0, 0, -1], 40)
    scene.write(os.path.join(folder, "room.gltf"))
    shutil.copy(PANEL, os.path.join(folder, "ips.panel"))


def review(program, folder, name, more=None, **symbol):
    document = {"title": name, "scene": ["room.gltf"], "profile": "iso-15008",
                "eyes": {"eye": {"camera": "eye"}},
                "symbols": {"bar": {"display": "screen", "uv": [0.1, 0.1, 0.9, 0.9], **symbol}},
                "precision": {"contrast": 0.2, "paths": 8192}, "frames": {"worst": 0},
                "variants": {"dim": {"brightness": {"*": 0.1}}},
                "conditions": [{"name": "dusk", "environment": {"type": "constant",
                                                                "luminance": 100}}],
                **(more or {})}
    path, out = os.path.join(folder, f"{name}.review.json"), os.path.join(folder, name)
    with open(path, "w", encoding="utf-8") as file:
        json.dump(document, file)
    done = subprocess.run([program, "review", path, "-o", out], capture_output=True, text=True)
    if done.returncode not in (0, 1):
        sys.exit(done.stderr)
    return done, out


def text_of(out, name):
    with open(os.path.join(out, name), encoding="utf-8") as file:
        return file.read()


def check_views(report, done, out, pane):
    report.claim(f"in {pane} (minimum 1)" in done.stdout, "the console names it")
    report.claim("reversed left to right" in done.stdout, "and that it is reversed")
    rows = csv.DictReader(text_of(out, "cases.csv").splitlines())
    row = next(row for row in rows if row["decides"] == "true")
    report.claim(row["in_pane"] == pane and row["verdict"] == "fail", "the table, too")
    report.claim(f"in {pane}" in text_of(out, "junit.xml"), "and CI")
    report.claim(f"<dt>… in {pane}</dt><dd>can be read, reversed" in
                 text_of(out, "index.html") + (text_of(out, "cases.html") if os.path.exists(
                     os.path.join(out, "cases.html")) else ""), "and the page")


def check_breaks(report, program, folder):
    """Who sits before the display reads nothing once the driver sees nothing of it."""
    more = {"eyes": {"eye": {"camera": "eye"}, "reader": {"position_m": [0.5, 0, -0.4]}},
            "pane_images": {"within_deg": 90, "contrast_max": 0.0005}}
    done, out = review(program, folder, "glass", more)
    answer = json.loads(text_of(out, "review.json"))
    pane = next(p for p in answer["pane_images"] if p["eye"] == "eye")
    then = pane["breaks"][0]
    share = pane["limit"]["value"] / pane["limit"]["interval"][1]
    words = (f"{math.floor(1e5 * share) / 1e3:.3g} % of its present brightness level; then bar "
             "(reader) fails: contrast")
    report.claim(words in done.stdout and words in text_of(out, "index.html"), words)
    more["variants"] = {"dim": {"brightness": {"*": share}}}
    _, out = review(program, folder, "dimmed", more)
    case = next(c for c in json.loads(text_of(out, "review.json"))["variants"][0]["cases"]
                if c["eye"] == "reader")
    print(f"then {then['limit']['found']:.4g} : 1, in a review so dim {case['contrast_ratio']:.4g}")
    report.claim(then["subject"] == "bar" and case["verdict"] == "fail" and
                 math.isclose(case["contrast_ratio"], then["limit"]["found"], rel_tol=0.03),
                 "as a review of that level has it")


def main():
    report = Report()
    program = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        scene_of(folder)
        done, out = review(program, folder, "private", must_not_be_read=True)
        answer = json.loads(text_of(out, "review.json"))
        case = answer["cases"][0]
        image = case["must_not_be_read"]["images"][0]
        low, high = image["contrast_interval"]
        ratio = (image["foreground"] + image["against"]) / (image["background"] +
                                                            image["against"])
        print(f"contrast {image['contrast_ratio']:.5g}, {low:.5g} to {high:.5g}")
        report.claim(case["visible_share"] == 0 and case["verdict"] == "fail",
                     "hidden, and read in the pane")
        report.claim(math.isclose(image["contrast_ratio"], ratio, rel_tol=1e-4), "its contrast")
        report.claim(low <= image["contrast_ratio"] <= high, "in its interval")
        report.claim(math.isclose(image["s"], math.log10(ratio / (ratio - 1)), rel_tol=1e-4) and
                     math.isclose(image["s"], case["judged"]["found"], rel_tol=1e-4) and
                     case["judged"]["by_pane"] == image["pane"], "S is what is judged")
        report.claim(image["s_interval"][0] <= image["s"] <= image["s_interval"][1] < 1,
                     "the whole interval misses the limit")
        report.claim(answer["variants"][0]["verdict"] == "pass", "a tenth of it passes")
        check_views(report, done, out, image["pane"])
        check_breaks(report, program, folder)
        _, out = review(program, folder, "open")
        plain = text_of(out, "review.json") + text_of(out, "cases.csv")
        report.claim("by_pane" not in plain and "images" not in json.loads(
            text_of(out, "review.json"))["cases"][0], "what may be read has no images")
    report.finish()


if __name__ == "__main__":
    main()
