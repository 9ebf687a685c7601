# SPDX-License-Identifier: Apache-2.0
"""show.py PARHELION -- `panel show`: in the dark a white display has the luminance of `panel
eval` there; a dome and a directed source add what `panel report` says they add; every pixel of
the content stands in its place with its code; what is wrong is one line and leaves no file.
"""
import json
import os
import subprocess
import sys
import tempfile

from exr import Frame
from gltf import png

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

PANEL = os.path.join(ROOT, "assets", "panels", "ips_cluster.panel")
COLUMNS, ROWS = 24, 9  # the panel's shape
FAR = ("--distance", "100")
DIRECTED_LX, DOME_LX = 65000.0, 5000.0  # as of the report's usual conditions
CODES = [[(0, 0, 0), (255, 255, 255), (255, 0, 0), (0, 255, 0), (0, 0, 255), (64, 128, 192)][
    (5 * y + x * x) % 6] for y in range(ROWS) for x in range(COLUMNS)]


class Display:
    def __init__(self, report, program, folder):
        self.report, self.program, self.folder = report, program, folder
        self.place("white.png", [(255, 255, 255)] * (COLUMNS * ROWS))
        self.place("codes.png", CODES)

    def place(self, name, codes, width=COLUMNS):
        with open(os.path.join(self.folder, name), "wb") as file:
            file.write(png(width, len(codes) // width,
                           [list(sum(codes[i:i + width], ())) for i in
                            range(0, len(codes), width)]))

    def run(self, *words):
        return subprocess.run([self.program, "panel", *map(str, words)], cwd=self.folder,
                              capture_output=True, text=True, check=False)

    def asked(self, *words):
        return json.loads(self.run(*words, "--json").stdout)

    def luminance(self, *words, spp=64):
        """Of the middle of a white display, and its standard error."""
        answer = self.run("show", PANEL, "--content", "white.png", "-o", "frame.exr", "--size",
                          f"{COLUMNS}x{ROWS}", "--spp", spp, "--layers", "xyz,variance",
                          "--quiet", *words)
        self.report.claim(answer.returncode == 0, answer.stderr)
        frame = Frame(os.path.join(self.folder, "frame.exr"))
        middle = (10, 4, 14, 5)
        return frame.mean("xyz.Y", middle), frame.mean_luminance(middle)[1]

    def eval(self, theta, phi, rgb):
        return self.asked("eval", PANEL, "--theta", theta, "--phi", phi, "--rgb", rgb)


def check_dark(display):
    for theta, phi in ((0, 0), (30, 0), (50, 180), (60, 90), (40, 300)):
        truth = display.eval(theta, phi, "255,255,255")["luminance_cd_m2"]
        seen, _ = display.luminance("--theta", theta, "--phi", phi, *FAR)
        display.report.claim(abs(seen / truth - 1) < 0.002,
                             f"dark, {theta}, {phi}: {seen:.6g} cd/m2, eval says {truth:.6g}")


def added(row, direction, white, black):
    """What a condition of the report adds in a direction, by its contrast there."""
    contrast = row[direction]
    return (white - contrast * black) / (contrast - 1)


def check_light(display):
    tables = {table["name"]: table["rows"] for table in display.asked(
        "report", PANEL, "--directed", f"{DIRECTED_LX:g},45")["tables"]}
    rows = {(row["diffuse_lx"], row["directed_lx"]): row for row in tables["ambient_contrast"]}
    white = {phi: display.eval(30, phi, "255,255,255")["luminance_cd_m2"] for phi in (0, 90)}
    black = {phi: display.eval(30, phi, "0,0,0")["luminance_cd_m2"] for phi in (0, 90)}
    directed = "--directed", f"{DIRECTED_LX:g},45,180"
    for lux, words in (((DOME_LX, 0.0), ("--ambient", DOME_LX)), ((0.0, DIRECTED_LX), directed),
                       ((3 * DOME_LX, DIRECTED_LX), ("--ambient", 3 * DOME_LX, *directed))):
        for phi in (0, 90):
            truth = added(rows[lux], f"contrast_30_phi_{phi}", white[phi], black[phi])
            seen, error = display.luminance("--theta", 30, "--phi", phi, *FAR, *words,
                                            spp=512)
            seen -= white[phi]
            display.report.claim(
                abs(seen - truth) < 4 * error + 0.01 * truth,
                f"{words}, phi {phi}: adds {seen:.4g} cd/m2 (+- {error:.2g}), the report says "
                f"{truth:.4g}")


def check_content(display):
    display.run("show", PANEL, "--content", "codes.png", "-o", "codes.exr", "--size",
                f"{COLUMNS}x{ROWS}", *FAR, "--spp", 16, "--layers", "xyz", "--quiet")
    frame = Frame(os.path.join(display.folder, "codes.exr"))
    truth = {code: display.eval(0, 0, ",".join(map(str, code)))["XYZ"] for code in set(CODES)}
    for i, code in enumerate(CODES):
        seen = [frame.channels["xyz." + c][i] for c in "XYZ"]
        off = max(abs(a - b) for a, b in zip(seen, truth[code]))
        display.report.claim(off < 0.02 * truth[code][1] + 0.01,
                             f"pixel {i % COLUMNS},{i // COLUMNS} of codes {code}: XYZ {seen}, "
                             f"eval says {truth[code]}")


def check_places(display):
    """One place, said in two ways, is one frame."""
    frames = []
    for words in (("--theta", 30, "--distance", 1), ("--eye", "0.5,0,0.8660254037844386")):
        display.luminance(*words, "--ambient", 100, spp=4)
        frames.append(list(Frame(os.path.join(display.folder, "frame.exr")).channels["G"]))
    display.report.claim(max(abs(a - b) for a, b in zip(*frames)) < 1e-3 * max(frames[0]),
                         "--eye and --theta see two pictures")


def check_faults(display):
    with open(PANEL, "rb") as file:
        whole = file.read()
    with open(os.path.join(display.folder, "cut.panel"), "wb") as file:
        file.write(whole[:1000])
    with open(os.path.join(display.folder, "cut.png"), "wb") as file:
        file.write(png(1, 1, [[1, 2, 3]])[:30])
    white = ("--content", "white.png", "--png", "out.png")
    for words, what in (
            (("none.panel", *white), "none.panel"), (("cut.panel", *white), "cut.panel"),
            ((PANEL, "--content", "none.png", "--png", "out.png"), "none.png"),
            ((PANEL, "--content", "cut.png", "--png", "out.png"), "cut.png"),
            ((PANEL, "--content", "white.png", "--png", "white.png"), "white.png"),
            ((PANEL, "--content", "white.png"), "--png"), ((PANEL, "--png", "out.png"),
                                                          "--content"),
            ((PANEL, "--content", "white.png", "-o", "out.png"), ".exr"),
            ((PANEL, *white, "--theta", 90), "--theta"),
            ((PANEL, *white, "--eye", "1,0,-1"), "--eye"),
            ((PANEL, *white, "--eye", "1,0,1", "--theta", 3), "--eye"),
            ((PANEL, *white, "--directed", "5,95,0"), "--directed"),
            ((PANEL, *white, "--directed", "-5,5,0"), "--directed"),
            ((PANEL, *white, "--ambient", "nan"), "--ambient"),
            ((PANEL, *white, "--distance", 0.01, "--theta", 60), "too close")):
        answer = display.run("show", *words, "--size", "8x3", "--spp", 1)
        lines = answer.stderr.splitlines()
        display.report.claim(answer.returncode > 0 and len(lines) == 1 and what in lines[0],
                             f"{words[1:]}: status {answer.returncode}, {lines}")
        display.report.claim(not os.path.exists(os.path.join(display.folder, "out.png")),
                             f"{words[1:]}: a file is left")


def main():
    report = Report()
    with tempfile.TemporaryDirectory(prefix="show-") as folder:
        display = Display(report, os.path.abspath(sys.argv[1]), folder)
        for check in (check_dark, check_light, check_content, check_places, check_faults):
            check(display)
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
