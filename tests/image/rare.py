# SPDX-License-Identifier: Apache-2.0
"""rare.py PARHELION -- light that few paths find is found: a display in a black box that a
patch of sun lights, of a hole of 1.5 and of 3 cm (black_box.py), in closed form.

A review, two seeds each: no verdict is wrong where the true contrast is 3 % under or over the
limit, and the truth lies in what is reflected's interval, or no farther from it than chance has
it once in 10,000 (TOO_FAR standard errors), which is known within a tenth. `render` and
`measure` of the display, dark: the same. In such a scene threads, a crop and parts change no
bit of a frame. Under a sky without sun next to no path meets a hole of 5 mm: no verdict is
wrong, and the intervals of a review and of a luxmeter hold the closed form.
"""
import json
import os
import shutil
import subprocess
import sys
import tempfile

from bits import digest
import black_box
from exr import Frame
from gltf import Scene
import reflection
from review import PANEL, Report, Reviewer, moment

HOLES_M, SEEDS = (0.015, 0.03), (1, 2)
TOO_FAR, KNOWN_WITHIN = 3.9, 0.1
NEAR_DEG = 2          # the frame sees nothing but the display
SIZE, SAMPLES = (24, 16), 48
BITS = ["--size", "40x24", "--layers", "all"]
LIMIT = 5             # of iso-15008 for so little light
SKY_HOLE_M, SKY_CD_M2 = 0.005, 10000
METER = [0, 0, 0.02]  # before the middle of the display


def write_room(folder, room, level):
    scene = room.scene(level)
    scene.view("near", black_box.EYE, [-x for x in black_box.EYE], NEAR_DEG)
    scene.environment(**black_box.environment())
    scene.write(os.path.join(folder, "room.gltf"))


def claim_near(report, what, figure, interval, truth):
    """The truth in the interval, as far as chance allows, which is not too wide."""
    half = (interval[1] - interval[0]) / 2
    allowed = TOO_FAR / 1.96 * half + black_box.CLOSED_WITHIN * truth
    words = f"{what}: {figure:.5g} [{interval[0]:.5g}, {interval[1]:.5g}], truth {truth:.5g}"
    report.claim(abs(figure - truth) <= allowed, words)
    report.claim(half <= KNOWN_WITHIN * truth, f"{words}: not known within a tenth")


# ---- a review -------------------------------------------------------------------------------

def ask(reviewer, level, seed, out, light=None):
    light = light or black_box.environment()
    document = black_box.review_request(level, [{**moment("moment", **light)}],
                                        precision={"seed": seed})
    return reviewer.review(document, out)[1]["cases"][0]


def level_for(shown, reflected, contrast):
    """At which (white + R) / (black + R) is that."""
    white, black = shown
    return (contrast - 1) * reflected / (white - contrast * black)


def check_review(report, reviewer, panel, room, name):
    """The first answer, at some level, tells what is shown and which part is judged."""
    first = ask(reviewer, 0.001, 9, "first")
    light, part = first["luminance_cd_m2"], first["judged_part_uv"]
    shown = light["foreground"] / 0.001, light["background"] / 0.001
    truth = black_box.closed_form(room, panel, [part[side] for side in (
        "left", "top", "right", "bottom")])
    for seed in SEEDS:
        margin = 0.97 if seed % 2 else 1.03
        case = ask(reviewer, level_for(shown, truth, margin * LIMIT), seed, f"seed{seed}")
        what = f"{name}, review, seed {seed}"
        claim_near(report, what, case["luminance_cd_m2"]["reflected"],
                   case["reflected_interval"], truth)
        held = [x for x in case["limits"] if x["kind"] == "contrast_ratio"]
        report.claim(len(held) == 1 and held[0]["value"] == LIMIT, f"{what}: limits {held}")
        claim_not_wrong(report, what, held[0], margin)


def claim_not_wrong(report, what, limit, margin):
    wrong = "pass" if margin < 1 else "fail"
    report.claim(limit["verdict"] != wrong,
                 f"{what}: {wrong}, the true contrast is {margin * LIMIT:g}")


# ---- a sky ----------------------------------------------------------------------------------

def claim_holds(report, what, interval, truth):
    report.claim(interval[0] <= truth <= interval[1],
                 f"{what}: [{interval[0]:.4g}, {interval[1]:.4g}], truth {truth:.4g}")


def check_sky(report, reviewer, panel):
    hole = black_box.Patch((SKY_HOLE_M, SKY_HOLE_M))
    room, light = black_box.UnderSky(hole), {"type": "constant", "luminance": SKY_CD_M2}
    write_room(reviewer.folder, hole, 1)
    first = ask(reviewer, 0.001, 9, "first", light)
    shown = [first["luminance_cd_m2"][side] / 0.001 for side in ("foreground", "background")]
    part = [first["judged_part_uv"][side] for side in ("left", "top", "right", "bottom")]
    truth = SKY_CD_M2 * black_box.closed_form(room, panel, part)
    for seed in SEEDS:
        margin = 0.97 if seed % 2 else 1.03
        case = ask(reviewer, level_for(shown, truth, margin * LIMIT), seed, "sky", light)
        what = f"a sky by a hole of {100 * SKY_HOLE_M:g} cm, seed {seed}"
        claim_holds(report, what, case["reflected_interval"], truth)
        claim_not_wrong(report, what, next(
            x for x in case["limits"] if x["kind"] == "contrast_ratio"), margin)
    bare = Scene()  # no display, which shines itself
    black_box.box(bare, 0, hole.floor, hole.openings)
    bare.write(os.path.join(reviewer.folder, "room.gltf"))
    lux = SKY_CD_M2 * sum(lux for _, lux in room.lights(METER))
    told = json.loads(reviewer.run(
        "measure", "room.gltf", "--environment", f"constant:{SKY_CD_M2}", "--illuminance",
        "{},{},{},0,0,1".format(*METER), "--samples", "1024", "--json").stdout)
    claim_holds(report, "a luxmeter in it", told["illuminance_interval"], lux)


# ---- a frame --------------------------------------------------------------------------------

def render(reviewer, out, *options):
    done = reviewer.run("render", "room.gltf", "-o", out, *options)
    assert done.returncode == 0, done.stderr
    return Frame(os.path.join(reviewer.folder, out))


def check_frame(report, reviewer, panel, room, name):
    frame = render(reviewer, "near.exr", "--camera", "near", "--size", "{}x{}".format(*SIZE),
                   "--spp", str(SAMPLES), "--layers", "all", "--display-level", "screen=0")
    u, v = (frame.channels["uv." + axis] for axis in "UV")
    report.claim(min(frame.channels["display.coverage"]) == 1, f"{name}: more than the display")
    truth = black_box.closed_form(room, panel, [min(u), min(v), max(u), max(v)])
    told = json.loads(reviewer.run("measure", "near.exr", "--json").stdout)
    claim_near(report, f"{name}, frame", told["luminance_cd_m2"],
               told["luminance_interval"], truth)


def check_bits(report, reviewer, name):
    """Threads, a crop, parts."""
    whole = render(reviewer, "whole.exr", *BITS, "--spp", "6", "--threads", "1")
    other = render(reviewer, "threads.exr", *BITS, "--spp", "6", "--threads", "3")
    report.claim(digest(whole, None) == digest(other, None), f"{name}: threads change bits")
    crop = render(reviewer, "crop.exr", *BITS, "--spp", "6", "--crop", "9,5,31,20")
    report.claim(digest(crop, crop.box) == digest(whole, crop.box),
                 f"{name}: a crop changes bits")
    for samples in ("0:2", "2:6"):
        render(reviewer, f"part{samples[0]}.exr", *BITS, "--samples", samples)
    done = subprocess.run([reviewer.program, "merge", "part2.exr", "part0.exr", "-o",
                           "merged.exr", "--quiet"], cwd=reviewer.folder, capture_output=True,
                          text=True, check=False)
    if report.claim(done.returncode == 0, f"{name}: {done.stderr}"):
        merged = Frame(os.path.join(reviewer.folder, "merged.exr"))
        report.claim(digest(merged, None) == digest(whole, None), f"{name}: parts change bits")


def main():
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        shutil.copy(PANEL, os.path.join(folder, "ips.panel"))
        reviewer = Reviewer(sys.argv[1], folder)
        panel = reflection.Panel(reviewer.program, os.path.join(folder, "ips.panel"), folder)
        for side in HOLES_M:
            room, name = black_box.Patch((side, side)), f"hole of {100 * side:g} cm"
            write_room(folder, room, 1)
            check_review(report, reviewer, panel, room, name)
            check_frame(report, reviewer, panel, room, name)
        check_bits(report, reviewer, name)
        check_sky(report, reviewer, panel)
    return report.finish()


if __name__ == "__main__":
    sys.exit(main())
