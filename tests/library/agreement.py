# SPDX-License-Identifier: Apache-2.0
"""agreement.py BUILD_DIR [--queries N] -- libparhelion-panel and a reader that was written
from `parhelion help panel-format` alone (panel_reader.py) give the same answers to N random
questions, shared out over panels of every kind: XYZ, spectra, BRDF, its lambertian part,
mirror, density.

An answer agrees within 1e-6 of the panel's scale: of XYZ and spectra the largest for white,
of the BRDF and its part the largest in mirror directions up to 89 degrees, or the largest
found; of the mirror 1. The library counts in single precision, and where an answer changes
steeply that alone is more: few answers, the share is printed and limited, may be further
off, but by no more than the reader's own answer moves when each number of the directions is
moved (x, y by 2^-21, z by 2^-21 of itself) and logarithms by 2^-22 of themselves, which is
asked for each of them. A spectrum's warp magnifies the steps of ln X, Y, Z (16 of 2^-22
here): of spectra the share is not limited. Densities jump at edges of cells, and rise
without end near the mirror direction: away from edges they agree to 1e-4 of themselves, or
as far as single precision bears.
"""
import argparse
import math
import os
import re
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [os.path.join(os.path.dirname(HERE), "structure"), HERE]
import panels  # noqa: E402
panels.use_numpy()

import numpy  # noqa: E402
from panel_reader import Panel as Reader  # noqa: E402
from report import ROOT, Report, read  # noqa: E402

sys.path.insert(0, os.path.join(ROOT, "src", "library"))
NEAR = 1e-6
MOST_BEYOND = {"XYZ": 0.01, "lambertian": 0.01, "mirror": 0.01, "albedo": 0.01,
               "BRDF": 0.15, "spectra": 1}
TURN, LOG_STEP, DENSITY = 2.0 ** -21, 2.0 ** -22, 1e-4
NM = numpy.array([365, 440.25, 555, 620.5, 705, 800], numpy.float32)
EVERY_SPECTRUM = 10  # of so many questions one is for a spectrum, which takes long


def observer():
    """The page's table, every nm from 360 to 830."""
    text = read("src/spectrum/spectral_table.c")
    rows = [[float(x) for x in row.split(",")]
            for row in re.findall(r"^    \{([^}]*)\},?$", text, re.M)]
    assert len(rows) == 471
    return rows


class Questions:
    def __init__(self, count, seed):
        random = numpy.random.default_rng(seed)
        self.viewer, self.light = (self.directions(random, count) for _ in range(2))
        half = count // 2  # of these the light comes from near the mirror direction
        around = self.viewer[:half] * [-1, -1, 1] + random.normal(size=(half, 3)) * 0.05
        around[:, 2] = numpy.abs(around[:, 2]) + 1e-3
        self.light[:half] = around / numpy.linalg.norm(around, axis=-1, keepdims=True)
        self.code = numpy.floor(random.random((count, 3)) * 256).astype(numpy.float32)
        self.code[::4] += random.random((len(self.code[::4]), 3)) * 0.9
        self.place = random.random((count, 2)).astype(numpy.float32)

    @staticmethod
    def directions(random, count):
        z, phi = random.random(count), random.random(count) * 2 * math.pi
        s = numpy.sqrt(1 - z * z)
        return numpy.stack([s * numpy.cos(phi), s * numpy.sin(phi), z],
                           -1).astype(numpy.float32)


def rounded(d):
    """Directions beside d, as rounding makes them: not of length 1 any more."""
    for k, step in enumerate((TURN, TURN, TURN * d[2])):
        yield [x + step * (j == k) for j, x in enumerate(d)]


def wobble(answer, directions, shifted):
    """How much the reader's answer moves with the directions, and with logarithms' steps."""
    own = numpy.asarray(answer(*directions))
    moved = LOG_STEP * own * numpy.maximum(1, numpy.abs(numpy.log(numpy.maximum(own, 1e-30))))
    for k in range(3) if shifted else ():
        shift = [16 * LOG_STEP * (j == k) for j in range(3)]
        moved = moved + numpy.abs(numpy.asarray(answer(*directions, shift=shift)) - own)
    for k, direction in enumerate(directions):
        for other in rounded(direction):
            changed = [*directions[:k], other, *directions[k + 1:]]
            moved = moved + numpy.abs(numpy.asarray(answer(*changed)) - own)
    return moved


class Claims:
    """Compares the answers of one panel."""

    def __init__(self, report, name):
        self.report, self.name = report, name

    def compare(self, kind, found, scale, answer, directions):
        """found: the library's answers; answer(i, directions...) the reader's; directions:
        lists."""
        asked = [[d[i].astype(float) for d in directions] for i in range(len(found))]
        own = numpy.array([answer(i, *asked[i]) for i in range(len(found))])
        scale = max(scale, float(numpy.max(numpy.abs(found))))
        far = numpy.abs(found - own)
        beyond = [i for i in range(len(found)) if not far[i].max() <= NEAR * scale]
        wrong = [i for i in beyond if not numpy.all(far[i] <= NEAR * scale + wobble(
            lambda *d, i=i, **shift: answer(i, *d, **shift), asked[i], kind == "spectra"))]
        share, what = len(beyond) / len(found), f"{self.name} {kind}"
        print(f"{what}: {len(found)} answers, largest difference {far.max() / scale:.2e} of "
              f"{scale:.4g}; beyond 1e-6: {100 * share:.2f} %")
        self.report.claim(numpy.isfinite(found).all(), f"{what}: answers that are no numbers")
        self.report.claim(share <= MOST_BEYOND[kind], f"{what}: {share:.4f} beyond 1e-6")
        self.report.claim(not wrong, f"{what}: {len(wrong)} answers beyond what single "
                          "precision bears" + (f": {found[wrong[0]]}, reader {own[wrong[0]]}, "
                                               f"{asked[wrong[0]]}" if wrong else ""))


def mirror_directions():
    """(viewer, light) from 0 to 89 degrees, from eight sides."""
    theta, phi = (numpy.radians(numpy.arange(*span)).reshape(shape) for span, shape in
                  (((0, 90, 1), (-1, 1)), ((0, 360, 45), (1, -1))))
    s, z = numpy.sin(theta), numpy.cos(theta) + 0 * phi
    viewer, light = (numpy.stack([k * s * numpy.cos(phi), k * s * numpy.sin(phi), z],
                                 -1).reshape(-1, 3) for k in (1, -1))
    return viewer, light


def compare_densities(report, name, found, reader, q):
    asked = [[a.astype(float) for a in row] for row in zip(q.viewer, q.light, q.place)]
    answers = [reader.pdf(*row) for row in asked]
    inside = [i for i, (own, margin) in enumerate(answers) if margin > 1e-3 and own > 0]
    off = {i: abs(found[i] / answers[i][0] - 1) for i in inside}
    beyond = [i for i in inside if not off[i] <= DENSITY]
    wrong = [i for i in beyond if not abs(found[i] - answers[i][0]) <= DENSITY * answers[i][0]
             + wobble(lambda o, l, i=i: [reader.pdf(o, l, asked[i][2])[0]], asked[i][:2],
                      False)[0]]
    share = len(inside) / len(answers)
    print(f"{name} densities: largest relative difference {max(off.values()):.2e}, away from "
          f"edges {100 * share:.1f} %; beyond {DENSITY:g}: {len(beyond)}")
    report.claim(len(answers) - len(inside) <= max(2, 0.1 * len(answers)),  # of few, chance
                 f"{name}: {len(inside)} of {len(answers)} directions are away from edges")
    report.claim(len(beyond) <= 0.01 * len(found) and not wrong,
                 f"{name}: densities differ: {[asked[i] for i in wrong[:3]]}")


def check_panel(report, name, path, count, table):
    from parhelion_panel import Panel
    q, claims = Questions(count, hash_of(name)), Claims(report, name)
    with open(path, "rb") as file:
        reader = Reader(file.read(), table)
    with Panel(path) as panel:
        emission = reader.panels[0].emission
        if emission:
            check_emission(claims, panel, reader, q)
        if reader.panels[0].reflection:
            check_reflection(claims, panel, reader, q, table)
            compare_densities(report, name, panel.pdf(q.viewer, q.light, q.place), reader, q)


def check_emission(claims, panel, reader, q):
    white = mirror_directions()[0], [255, 255, 255]
    claims.compare("XYZ", panel.emission_xyz(q.viewer, q.code, q.place),
                   float(panel.emission_xyz(*white).max()),
                   lambda i, d: reader.emission_xyz(d, q.code[i].astype(float),
                                                    q.place[i].astype(float)), [q.viewer])
    every, nm = slice(0, None, EVERY_SPECTRUM), NM.astype(float)
    viewer, code, place = q.viewer[every], q.code[every], q.place[every]
    claims.compare("spectra", panel.emission_spectrum(viewer, code, NM, place),
                   float(panel.emission_spectrum(*white, NM).max()),
                   lambda i, d, **shift: reader.emission_spectrum(
                       d, code[i].astype(float), nm, place[i].astype(float), **shift),
                   [viewer])


def check_reflection(claims, panel, reader, q, table):
    nm, both = NM.astype(float), [q.viewer, q.light]
    brdf, part = panel.brdf(*both, NM, q.place, lambertian=True)
    scale = float(panel.brdf(*mirror_directions(), NM).max())
    for kind, found, which in (("BRDF", brdf, 0), ("lambertian", part, 1)):
        claims.compare(kind, found, scale, lambda i, o, l, which=which: reader.brdf(
            o, l, nm, q.place[i].astype(float))[which], both)
    every = slice(0, None, EVERY_SPECTRUM)
    viewer, place = q.viewer[every], q.place[every]
    claims.compare("albedo", panel.albedo(viewer, place)[:, None], 1.0, lambda i, d: [
        reader.albedo(d, table, place[i].astype(float))], [viewer])
    claims.compare("mirror", panel.mirror(q.viewer, NM, q.place), 1.0, lambda i, d:
                   reader.mirror(d, nm, q.place[i].astype(float)), [q.viewer])


def hash_of(name):
    return sum(ord(c) * 31 ** i for i, c in enumerate(name)) % 2 ** 32


class Silent(Report):
    """Counts only."""

    def claim(self, holds, message):
        self.failed += not holds


def check_can_fail(report, folder):
    """A reader of other bytes disagrees: one step of one mean logarithm is changed."""
    with open(panels.shipped("ips_cluster"), "rb") as file:
        data = bytearray(file.read())
    toc = [data[40 + 16 * i:56 + 16 * i] for i in range(data[32])]
    section = next(row for row in toc if row[:4] == b"\x02\x00\x00\x00")
    offset, levels = int.from_bytes(section[8:], "little"), 24
    at = offset + 20 + 2 * levels + 6 * 7 + 2  # Y of red at code 255
    data[at] ^= 1
    path = os.path.join(folder, "changed.panel")
    with open(path, "wb") as file:
        file.write(data)
    from parhelion_panel import Panel, PanelError
    try:
        Panel(path)
        report.claim(False, "a changed byte is read without a word")
    except PanelError as fault:
        report.claim("checksum" in str(fault) and path in str(fault), f"the fault is: {fault}")
    q, silent = Questions(20, 1), Silent()
    with Panel(panels.shipped("ips_cluster")) as panel:
        q.code[:] = 255
        reader = Reader(bytes(data))
        Claims(silent, "changed").compare(
            "XYZ", panel.emission_xyz(q.viewer, q.code), 0, lambda i, d:
            reader.emission_xyz(d, q.code[i].astype(float)), [q.viewer])
    report.claim(silent.failed == 2, "a changed panel passes for the same")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build")
    parser.add_argument("--queries", type=int, default=600)
    arguments = parser.parse_args()
    build = os.path.abspath(arguments.build)
    os.environ["PARHELION_PANEL_LIBRARY"] = os.path.join(build, "libparhelion-panel.so.2")
    program, report = os.path.join(build, "parhelion"), Report()
    table = observer()
    with tempfile.TemporaryDirectory(prefix="agreement-") as folder:
        check_can_fail(report, folder)
        paths = {name: panels.shipped(name) for name in ("ips_cluster", "oled_centre",
                                                         "hud_pgu")}
        for make in (panels.placed, panels.haar, panels.brushed, panels.rings,
                     panels.steps):
            paths[make.__name__] = make(program, folder)
        for name, path in paths.items():
            check_panel(report, name, path, arguments.queries // len(paths), table)
    report.finish()


if __name__ == "__main__":
    main()
