# SPDX-License-Identifier: Apache-2.0
"""other_renderer.py BUILD_DIR [--samples N] -- a path tracer of some 200 lines (tracer.py),
which asks a panel through libparhelion-panel, and `parhelion render` show the same room: a
display with contents, lit by a lamp whose image stands in its glass. Means over blocks of
pixels agree within three standard deviations of both, but for as many blocks as chance
explains (its square summed over all blocks stays where it belongs, too).
"""
import argparse
import math
import os
import shutil
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
TESTS = os.path.dirname(HERE)
sys.path[:0] = [os.path.join(TESTS, "structure"), os.path.join(TESTS, "image"), HERE]
import panels  # noqa: E402
panels.use_numpy()

import numpy  # noqa: E402
from agreement import observer  # noqa: E402
from exr import Frame  # noqa: E402
from gltf import Scene, png  # noqa: E402
from report import ROOT, Report  # noqa: E402
from tracer import Rectangle, Tracer, camera_rays  # noqa: E402

sys.path.insert(0, os.path.join(ROOT, "src", "library"))
SIZE, BLOCK, BOUNCES = (64, 48), 8, 4
EYE, FORWARD, YFOV = (-0.4, 0.15, 0.6), (0.35, -0.1, -1.5), math.radians(50)
CONTENT = [[(255, 255, 255), (255, 30, 10), (0, 0, 0), (64, 64, 64)],
           [(0, 0, 0), (40, 200, 60), (10, 40, 255), (0, 0, 0)]]
WALL, FLOOR, LAMP = 0.5, 0.2, 3000.0
Y_OF_RGB = (0.2126, 0.7152, 0.0722)


def room_of(panel):
    """The rectangles: a room of 2 m, the display before its back wall, the lamp in front."""
    return [
        Rectangle((-1, -1, 1), (2, 0, 0), (0, 0, -2), FLOOR),
        Rectangle((-1, 1, -1), (2, 0, 0), (0, 0, 2), WALL),
        Rectangle((-1, -1, -1), (2, 0, 0), (0, 2, 0), WALL),
        Rectangle((1, -1, 1), (-2, 0, 0), (0, 2, 0), WALL),
        Rectangle((-1, -1, 1), (0, 0, -2), (0, 2, 0), WALL),
        Rectangle((1, -1, -1), (0, 0, 2), (0, 2, 0), WALL),
        Rectangle((-0.45, -0.4, -0.9), (0.9, 0, 0), (0, 0.6, 0), 0.0, 0.0, panel, CONTENT),
        Rectangle((0.7, -0.35, 0.95), (-0.5, 0, 0), (0, 0.5, 0), 0.0, LAMP)]


def write_scene(path, panel_name):
    scene = Scene()
    walls, floor, lamp = scene.lambert(WALL), scene.lambert(FLOOR), scene.emitter(LAMP)
    texture = scene.image("image/png", png(4, 2, [[c for code in row for c in code]
                                                  for row in CONTENT]))
    display = scene.material("display", extensions={"PARHELION_display": {
        "panel": panel_name, "content": {"index": texture}}})
    black = scene.lambert(0)
    materials = [floor, walls, walls, walls, walls, walls, display, lamp]
    for material, r in zip(materials, room_of(None)):
        scene.quad(material, *(list(map(float, v)) for v in (r.corner, r.right, r.up)))
    for r in room_of(None)[6:]:  # their backs: black
        corner = r.corner + r.right - 1e-5 * r.normal
        scene.quad(black, *(list(map(float, v)) for v in (corner, -r.right, r.up)))
    scene.view("eye", EYE, FORWARD, math.degrees(YFOV), up=[0, 1, 0])
    scene.environment(type="constant", luminance=0)
    scene.write(path)


def blocks_of(rows):
    """Means over blocks, [block]; rows: one number a pixel."""
    width, height = SIZE
    return numpy.asarray(rows).reshape(height // BLOCK, BLOCK, width // BLOCK, BLOCK).mean(
        (1, 3)).reshape(-1)


def rendered(program, folder, samples):
    """(block means of Y, their standard deviations) of the program."""
    scene, out = os.path.join(folder, "room.gltf"), os.path.join(folder, "room.exr")
    write_scene(scene, "ips_cluster.panel")
    shutil.copy(panels.shipped("ips_cluster"), folder)
    panels.run(program, "render", scene, "-o", out, "--size", f"{SIZE[0]}x{SIZE[1]}", "--spp",
               str(samples), "--max-bounces", str(BOUNCES), "--layers", "variance", "--quiet")
    frame = Frame(out)
    y = sum(w * numpy.array(frame.channels[c]) for w, c in zip(Y_OF_RGB, "RGB"))
    deviation = sum(w * numpy.sqrt(numpy.maximum(0, frame.channels[f"variance.{c}"]))
                    for w, c in zip(Y_OF_RGB, "RGB"))
    return blocks_of(y), numpy.sqrt(blocks_of(deviation ** 2)) / BLOCK


def traced(folder, passes):
    """The same of the other renderer, from passes of one sample a pixel each."""
    from parhelion_panel import Panel
    with Panel(os.path.join(folder, "ips_cluster.panel")) as panel:
        tracer = Tracer(room_of(panel), observer(), 7, BOUNCES)
        rows = []
        for _ in range(passes):
            rays = camera_rays(tracer.random, EYE, FORWARD, YFOV, SIZE)
            rows.append(blocks_of(tracer.trace(*rays)[:, 1]))
    rows = numpy.array(rows)
    return rows.mean(0), rows.std(0, ddof=1) / math.sqrt(passes)


def off_by(a, b, factor=1.0):
    return (a[0] * factor - b[0]) / numpy.hypot(a[1], b[1])


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build")
    parser.add_argument("--samples", type=int, default=64)
    arguments = parser.parse_args()
    build, report = os.path.abspath(arguments.build), Report()
    os.environ["PARHELION_PANEL_LIBRARY"] = os.path.join(build, "libparhelion-panel.so.2")
    with tempfile.TemporaryDirectory(prefix="other-renderer-") as folder:
        ours = rendered(os.path.join(build, "parhelion"), folder, arguments.samples)
        other = traced(folder, arguments.samples)
    off = off_by(other, ours)
    noise = numpy.hypot(ours[1], other[1]) / ours[0]
    beyond, mean_square = int((numpy.abs(off) > 3).sum()), float((off ** 2).mean())
    whole = (other[0].mean() / ours[0].mean() - 1,
             math.sqrt((ours[1] ** 2 + other[1] ** 2).sum()) / ours[0].sum())
    print(f"{len(off)} blocks, {ours[0].min():.3g} to {ours[0].max():.3g} cd/m2, noise of a "
          f"block {100 * numpy.median(noise):.2g} %; beyond 3 sigma: {beyond}; mean square "
          f"{mean_square:.2f}; the whole: {100 * whole[0]:+.2f} % of {100 * whole[1]:.2f} %")
    report.claim(beyond <= 1 + len(off) // 50, f"{beyond} blocks beyond three sigma: {off}")
    report.claim(numpy.abs(off).max() < 5, f"a block is off by {numpy.abs(off).max()} sigma")
    report.claim(0.4 < mean_square < 1.7, f"the mean square is {mean_square}")
    report.claim(abs(whole[0]) < 3 * whole[1], f"the whole is off by {whole}")
    report.claim(numpy.median(noise) < 0.3 / math.sqrt(arguments.samples),
                 f"too noisy to tell: {noise}")
    wrong = off_by(other, ours, 1 + 6 * float(whole[1]))
    report.claim(abs(wrong.mean()) > abs(off.mean()), "a factor makes no difference")
    report.finish()


if __name__ == "__main__":
    main()
