# SPDX-License-Identifier: Apache-2.0
"""display_area.py PARHELION -- a display is measured by its part of each pixel: figures and
intervals of a panel known in closed form do not depend on what is around it, on --size or on
--spp; tilted, beside another, behind a bezel or a knob, cut by the frame. What only the wall
behind it changes is no change of the display.
"""
import json
import math
import os
import subprocess
import sys
import tempfile

from gltf import Scene, png
from contrast import write_set

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

SIZES = ("17x8", "19x10", "23x11", "26x14", "31x16", "35x17", "40x21", "47x24", "56x27",
         "67x34")
DARK, BRIGHT = 0.1, 10000  # walls, cd/m2
CODES = (0, 64, 128, 192, 255)  # measured levels of the panel
COLUMNS, ROWS = 4, 5
ROUNDING = 2e-6  # of a value: channels in single precision
# two contents of 4 x 5 cells, as indices into CODES
CELLS = ((4, 0, 2, 1, 3, 4, 0, 1, 2, 4, 0, 3, 1, 0, 4, 2, 3, 0, 1, 4),
         (1, 2, 4, 0, 0, 3, 1, 4, 4, 2, 0, 0, 3, 1, 4, 1, 0, 2, 4, 3))
TURN = 0.12  # radians, so that no rim runs along the pixels


def turned(x, y, z=0.0, tilt=0.0):
    """In the plane of the displays, which is tilted about x first."""
    y, z = y * math.cos(tilt), z + y * math.sin(tilt)
    return [x * math.cos(TURN) - y * math.sin(TURN), x * math.sin(TURN) + y * math.cos(TURN), z]


class Bench:
    def __init__(self, program, folder):
        self.program, self.folder = os.path.abspath(program), folder

    def ask(self, *line):
        return subprocess.run([self.program, *line, "--quiet"], cwd=self.folder,
                              capture_output=True, text=True, check=False)

    def run(self, *line):
        done = self.ask(*line)
        assert done.returncode == 0, f"{' '.join(line)}: {done.stderr}"
        return done.stdout

    def frame(self, scene, size, spp, seed=1, out="frame.exr", layers="all"):
        self.run("render", scene, "-o", out, "--size", size, "--spp", str(spp), "--seed",
                 str(seed), "--layers", layers)

    def measure(self, display, frame="frame.exr"):
        return json.loads(self.run("measure", frame, "--display", display, "--json"))

    def eval(self, theta, code):
        return json.loads(self.run("panel", "eval", "closed.panel", "--theta", str(theta),
                                   "--rgb", f"{code},{code},{code}", "--json"))


class Room:
    """Displays in front of a wall, before a parallel camera that sees 0.4 by 0.2 m."""

    def __init__(self, wall, tilt=0.0):
        self.scene, self.tilt = Scene(), tilt
        self.scene.quad(self.scene.emitter(wall), [-2, -2, -0.5], [4, 0, 0], [0, 4, 0])
        self.scene.probe("eye", [0, 0, 1], [0, 0, -1], 0.1, 0.2)

    def display(self, name, x, width, cells=(4,), level=1.0, height=0.1, at=(0, 0)):
        columns, rows = (COLUMNS, ROWS) if len(cells) > 1 else (1, 1)
        picture = png(columns, rows, [[CODES[i] for i in cells[columns * r:columns * (r + 1)]
                                       for _ in range(3)] for r in range(rows)])
        material = self.scene.material(name, extensions={"PARHELION_display": {
            "panel": "closed.panel", "level": level,
            "content": {"index": self.scene.image("image/png", picture)}}})
        corner = turned(x, -height / 2, tilt=self.tilt)
        corner = [corner[0] + at[0], corner[1] + at[1], corner[2]]
        self.scene.quad(material, corner, turned(width, 0), turned(0, height, tilt=self.tilt))

    def cover(self, x, width, height, luminance=3000):
        """A bar or a knob before them."""
        self.scene.quad(self.scene.emitter(luminance), turned(x, -height / 2, 0.1),
                        turned(width, 0), turned(0, height))

    def write(self, bench, name):
        self.scene.write(os.path.join(bench.folder, name))


def holds(measured, wanted):
    low, high = measured["luminance_interval"]
    return low <= wanted <= high


def check_even(report, bench):
    """No noise at all: the value, whatever is around and however few pixels there are."""
    white, black = bench.eval(0, 255), bench.eval(0, 0)
    wanted = 0.5 * white["luminance_cd_m2"]
    report.claim(abs(wanted - 500) < 0.1, f"the panel's white is {2 * wanted} cd/m2")
    for wall in (DARK, BRIGHT):
        room = Room(wall)
        room.display("screen", -0.08, 0.16, level=0.5)
        room.write(bench, "even.gltf")
        for i, size in enumerate(SIZES):
            spp = (2, 4, 16)[i % 3]
            bench.frame("even.gltf", size, spp)
            found = bench.measure("screen")
            what = f"wall {wall}, {size}, {spp} samples"
            close = abs(found["luminance_cd_m2"] - wanted) <= ROUNDING * wanted
            report.claim(close and holds(found, wanted),
                         f"{what}: {found['luminance_cd_m2']} {found['luminance_interval']} "
                         f"instead of {wanted}")
            apart = max(abs(a - b) for a, b in zip(found["xy"], (0.31272, 0.32904)))
            report.claim(apart < 1e-5, f"{what}: x, y {found['xy']}")
            ratio = white["luminance_cd_m2"] / black["luminance_cd_m2"]
            report.claim(abs(found["contrast"]["value"] / ratio - 1) < 1e-4 and
                         abs(found["contrast"]["shown_cd_m2"] / wanted - 1) < ROUNDING,
                         f"{what}: contrast {found['contrast']['value']}")
            report.claim(found["rim"] == "by coverage" and found["rim_pixels"] > 0 and
                         found["area_pixels"] < found["pixels"], f"{what}: {found['rim']}")


def mean_of(bench, cells, level, theta=0):
    return level * sum(bench.eval(theta, CODES[i])["luminance_cd_m2"]
                       for i in cells) / len(cells)


def claim_intervals(report, what, scores):
    """Scores: (value - right) / sigma. Rims and contents have noise: 95 of 100 intervals hold,
    and the values have no bias."""
    inside = sum(abs(score) <= 1.96 for score in scores)
    bias = sum(scores) / math.sqrt(len(scores))
    report.claim(inside >= 0.93 * len(scores) - 1e-9,
                 f"{what}: {inside} of {len(scores)} intervals hold")
    report.claim(abs(bias) < 3, f"{what}: {bias:.2f} standard errors off in the mean")


def score(found, wanted):
    low, high = found["luminance_interval"]
    return (found["luminance_cd_m2"] - wanted) / ((high - low) / 2 / 1.96)


def check_content(report, bench):
    """An uneven content: the same figures before either wall, bit for bit almost."""
    wanted, scores = mean_of(bench, CELLS[0], 0.5), []
    for wall, name in ((DARK, "dark.gltf"), (BRIGHT, "bright.gltf")):
        room = Room(wall)
        room.display("screen", -0.08, 0.16, CELLS[0], 0.5)
        room.write(bench, name)
    for i, size in enumerate(SIZES):
        spp, found = (2, 4, 8)[i % 3], []
        for name in ("dark.gltf", "bright.gltf"):
            bench.frame(name, size, spp, i)
            found.append(bench.measure("screen"))
        scores.append(score(found[0], wanted))
        for key in ("luminance_cd_m2", "luminance_max_cd_m2"):
            report.claim(abs(found[1][key] / found[0][key] - 1) < ROUNDING,
                         f"{size}: {key} {found[0][key]} and {found[1][key]} by the wall")
        widths = [one["luminance_interval"][1] - one["luminance_interval"][0] for one in found]
        report.claim(abs(widths[1] / widths[0] - 1) < 1e-3,
                     f"{size}: intervals {widths} wide by the wall")
    claim_intervals(report, "an uneven content", scores)


def check_tilted(report, bench):
    """A tilted face sees the wall behind it: that is dark."""
    wanted = bench.eval(40, 255)["luminance_cd_m2"]
    room = Room(DARK, math.radians(40))
    room.display("screen", -0.08, 0.16)
    room.write(bench, "tilted.gltf")
    for size in SIZES[::3]:
        bench.frame("tilted.gltf", size, 4)
        found = bench.measure("screen")
        report.claim(abs(found["luminance_cd_m2"] / wanted - 1) < 1e-4,
                     f"tilted, {size}: {found['luminance_cd_m2']} instead of {wanted}")


def check_neighbours(report, bench):
    """Two displays of uneven contents that touch; three even ones, so that pixels show two or
    more of them."""
    levels = (0.5, 0.02)
    wanted = [mean_of(bench, CELLS[k], levels[k]) for k in range(2)]
    room = Room(BRIGHT)
    for k in range(2):
        room.display(f"s{k}", -0.17 + 0.17 * k, 0.17, CELLS[k], levels[k])
    room.write(bench, "two.gltf")
    scores, shared = ([], []), 0
    for i, size in enumerate(("5x3", *SIZES)):
        bench.frame("two.gltf", size, 4, i)
        for k in range(2):
            found = bench.measure(f"s{k}")
            scores[k].append(score(found, wanted[k]))
            shared += found["shared_pixels"]
    report.claim(shared > 100, f"only {shared} pixels show two displays")
    claim_intervals(report, "displays side by side", scores[0] + scores[1])
    room = Room(DARK)
    for k, level in enumerate((1, 0.01, 0.3)):
        room.display(f"s{k}", -0.17 + 0.1 * k, 0.1, level=level)
    room.write(bench, "three.gltf")
    white = bench.eval(0, 255)["luminance_cd_m2"]
    for size in ("9x4", *SIZES[::4]):
        bench.frame("three.gltf", size, 8)
        for k, level in enumerate((1, 0.01, 0.3)):
            found = bench.measure(f"s{k}")
            report.claim(holds(found, level * white),
                         f"display {k} of three, {size}: {found['luminance_cd_m2']} "
                         f"{found['luminance_interval']} instead of {level * white}")


def check_hidden(report, bench):
    """A bezel over the seam, a knob before a display, one that the frame cuts."""
    white = bench.eval(0, 255)["luminance_cd_m2"]
    room = Room(BRIGHT)
    room.display("left", -0.15, 0.15)
    room.display("right", 0, 0.15, level=0.1)
    room.cover(-0.005, 0.01, 0.2)
    room.write(bench, "bezel.gltf")
    knob = Room(BRIGHT)
    knob.display("screen", -0.08, 0.16)
    knob.cover(0.02, 0.033, 0.07, 20000)
    knob.write(bench, "knob.gltf")
    cut = Room(BRIGHT)
    cut.display("screen", -0.08, 0.16, at=(0.17, 0.04))
    cut.write(bench, "cut.gltf")
    for scene, display, level in (("bezel.gltf", "left", 1), ("bezel.gltf", "right", 0.1),
                                  ("knob.gltf", "screen", 1), ("cut.gltf", "screen", 1)):
        for size, spp in (("17x8", 3), ("35x17", 8)):
            bench.frame(scene, size, spp)
            found = bench.measure(display)
            report.claim(holds(found, level * white),
                         f"{scene} {display}, {size}: {found['luminance_cd_m2']} "
                         f"{found['luminance_interval']} instead of {level * white}")


def screen_of(answer):
    """The display's mean among the rows of a comparison."""
    return next((row for row in json.loads(answer)["rows"]
                 if (row["figure"], row["of"]) == ("mean", "display screen")), None)


def check_compared(report, bench):
    """dark.gltf and bright.gltf of check_content: walls apart."""
    room = Room(DARK)
    room.display("screen", -0.08, 0.16, CELLS[0], 0.45)
    room.write(bench, "dimmed.gltf")
    for size, spp in (("17x8", 64), ("67x34", 16)):
        bench.frame("dark.gltf", size, spp, 1, "a.exr")
        for name, seed, is_same in (("bright.gltf", 1, True), ("bright.gltf", 2, True),
                                    ("dimmed.gltf", 3, False)):
            bench.frame(name, size, spp, seed, "b.exr")
            done = bench.ask("compare", "a.exr", "b.exr", "--display", "screen", "--json")
            verdict = json.loads(done.stdout)["verdict"]
            report.claim(done.returncode == (0 if is_same else 1),
                         f"{size}: a display before {name}, seed {seed}: {verdict}")
            if seed == 1:
                report.claim("equal in every pixel" in verdict, f"{size}, one seed: {verdict}")
    moved = screen_of(done.stdout)
    report.claim(moved and moved["verdict"] == "moved" and abs(moved["value"] + 0.1) <
                 1.6 * moved["half_width"], f"dimmed by a tenth: {moved}")
    bench.frame("bright.gltf", "67x34", 16, 2, "b.exr")
    whole = bench.ask("compare", "a.exr", "b.exr", "--json")
    screen = screen_of(whole.stdout)
    report.claim(whole.returncode == 1 and screen and screen["verdict"] != "moved",
                 f"with the wall the display moved: {screen}")


def check_other_layers(report, bench):
    """What a frame without the layers says: rims left out, or whole."""
    wanted = 0.5 * bench.eval(0, 255)["luminance_cd_m2"]
    names = "id,variance,display.emitted,display.reflected,display.coverage"
    bench.frame("even.gltf", "35x17", 4, layers=names)
    found = bench.measure("screen")
    report.claim(found["rim"] == "left out" and found["rim_pixels"] > 0 and
                 abs(found["luminance_cd_m2"] / wanted - 1) < ROUNDING, f"left out: {found}")
    report.claim("left out" in bench.run("measure", "frame.exr", "--display", "screen"),
                 "that rims are left out is not said")
    bench.frame("even.gltf", "35x17", 4, layers="id")
    found = bench.measure("screen")
    report.claim(found["rim"] == "whole" and found["luminance_cd_m2"] > 1.2 * wanted,
                 f"whole: {found}")
    report.claim("whole, with what is around" in
                 bench.run("measure", "frame.exr", "--display", "screen"),
                 "that rims are whole is not said")
    bench.frame("even.gltf", "3x2", 4, layers=names)
    done = bench.ask("measure", "frame.exr", "--display", "screen")
    report.claim(done.returncode == 3 and "--layers display" in done.stderr, done.stderr)


def main(program):
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        write_set(folder)
        bench = Bench(program, folder)
        bench.run("panel", "fit", "MANIFEST.json", "-o", "closed.panel")
        for check in (check_even, check_content, check_tilted, check_neighbours, check_hidden,
                      check_compared, check_other_layers):
            check(report, bench)
    return report.finish()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
