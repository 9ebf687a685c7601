# SPDX-License-Identifier: Apache-2.0
"""verdicts.py BUILD [--trials N] [--rooms open,window,grey,sun,trim,glass] [--private] -- how
often a verdict is wrong whose true margin is -10 to 10 %: a table. BUILD has bench_verdicts.
--private: of a symbol that must not be read, by its visual security.

Rooms: a display in the open under an even sky, and in a black box that an even sky and a sun
light through a window, whose truths are closed forms (the panel's BRDF as `panel eval` tells
it, over the sky, or over the window and for the sun) and are held against those of long runs;
in a grey box with a small window; in the open under a sun and a sky; by small lamps over a
glossy trim; with --private also `glass`: a display that turns its back to the eye, which sees
it in a pane. A wrong verdict passes where the truth fails, or fails where it passes; "too
close" is none. At most one in a hundred may be; the upper end is that of Clopper and Pearson's
95 % interval of one side.
"""
import argparse
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "image"))
from gltf import Scene, png, unit  # noqa: E402
import reflection  # noqa: E402

PANEL = os.path.join(HERE, "..", "..", "assets", "panels", "ips_cluster.panel")


def display(scene):
    bars = png(60, 30, [[255 if 20 <= x < 40 and 8 <= y < 22 else 0 for x in range(60)
                         for _ in range(3)] for y in range(30)])
    screen = scene.material("screen", extensions={"PARHELION_display": {
        "panel": "ips.panel", "content": {"index": scene.image("image/png", bars)},
        "level": 1}})
    scene.quad(screen, [-0.15, -0.075, 0], [0.3, 0, 0], [0, 0.15, 0])
    scene.view("eye", EYE, [-x for x in EYE], 8)


EYE, SKY_CD_M2 = [0.1, 0.15, 0.8], 6000


def open_sky():
    """Nothing but the display and the sky."""
    scene = Scene()
    display(scene)
    return scene, {"type": "constant", "luminance": SKY_CD_M2}


def open_light(panel, at, eye):
    """What the panel reflects of the sky at a place, cd/m2."""
    return reflection.under_sky(panel, eye)[0] * SKY_CD_M2 / reflection.SKY_CD_M2


WALLS = ((-1, -1, -0.1), (1, 0.6, 2))  # of a box about the display
PANE = ((-0.7, 0.2), (0.7, 1.6))       # x and z of its window, in the ceiling
PANE_CD_M2, SUN_LUX, SUN_WAY = 20000, 8000, [-0.1, -0.6, -0.7]


def ceiling(scene, wall):
    """Down to the room, about the pane."""
    (x0, _, z0), (x1, y, z1) = WALLS
    (a, c), (b, d) = PANE
    for left, right, far, near in ((x0, a, z0, z1), (b, x1, z0, z1), (a, b, z0, c),
                                   (a, b, d, z1)):
        scene.quad(wall, [left, y, far], [right - left, 0, 0], [0, 0, near - far])


def window():
    """A black box with a window in its ceiling: of what falls in nothing comes back."""
    scene = Scene()
    display(scene)
    wall = scene.lambert(0, double_sided=True)
    (x0, y0, z0), (x1, y1, z1) = WALLS
    w, h, d = x1 - x0, y1 - y0, z1 - z0
    scene.quad(wall, [x0, y0, z0], [w, 0, 0], [0, h, 0])
    scene.quad(wall, [x0, y0, z1], [w, 0, 0], [0, h, 0])
    scene.quad(wall, [x0, y0, z0], [w, 0, 0], [0, 0, d])
    scene.quad(wall, [x0, y0, z0], [0, 0, d], [0, h, 0])
    scene.quad(wall, [x1, y0, z0], [0, 0, d], [0, h, 0])
    ceiling(scene, wall)
    scene.light("directional", SUN_LUX, direction=SUN_WAY)
    return scene, {"type": "constant", "luminance": PANE_CD_M2}


def window_light(panel, at, eye, steps=40):
    """Midpoints of the pane, and the sun, which shines on all of the display."""
    (a, c), (b, d) = PANE
    area, lights, shares = (b - a) * (d - c) / steps ** 2, [], []
    for i in range(steps):
        for j in range(steps):
            to = [p - q for p, q in zip([a + (b - a) * (i + 0.5) / steps, WALLS[1][1],
                                         c + (d - c) * (j + 0.5) / steps], at)]
            square = sum(x * x for x in to)
            lights.append(unit(to))
            shares.append(PANE_CD_M2 * area * to[1] * to[2] / square ** 2)
    lights.append(unit([-x for x in SUN_WAY]))
    shares.append(SUN_LUX * lights[-1][2])
    return sum(v[0] * share for v, share in zip(panel.ask(eye, lights), shares))


def closed_form(light, program, folder, shown, part, points=5):
    """Contrast of what is shown and what the panel reflects: the mean over the judged part,
    points to a side."""
    panel = reflection.Panel(program, os.path.join(folder, "ips.panel"), folder)
    total = 0
    for i in range(points):
        for j in range(points):
            u, v = (part[k] + (part[k + 2] - part[k]) * (n + 0.5) / points
                    for k, n in ((0, i), (1, j)))
            at = [0.3 * (u - 0.5), 0.15 * (0.5 - v), 0]
            total += light(panel, at, unit([e - p for e, p in zip(EYE, at)]))
    reflected = total / points ** 2
    return (max(shown) + reflected) / (min(shown) + reflected)


def grey():
    """Walls that reflect 5 %, open above: the sky stands in a square of 0.4 m."""
    scene = Scene()
    display(scene)
    wall = scene.lambert(0.05, double_sided=True)
    scene.quad(wall, [-1, -1, -0.1], [2, 0, 0], [0, 2, 0])
    scene.quad(wall, [-1, -1, 2], [2, 0, 0], [0, 0, -2.1])
    scene.quad(wall, [-1, -1, 2], [0, 0, -2.1], [0, 2, 0])
    scene.quad(wall, [1, -1, 2], [0, 0, -2.1], [0, 2, 0])
    scene.quad(wall, [-1, -1, 2], [2, 0, 0], [0, 2, 0])
    scene.quad(wall, [-1, 1, 2], [2, 0, 0], [0, 0, -0.8])
    scene.quad(wall, [-1, 1, 0.8], [2, 0, 0], [0, 0, -0.9])
    scene.quad(wall, [-1, 1, 1.2], [0.8, 0, 0], [0, 0, -0.4])
    scene.quad(wall, [0.2, 1, 1.2], [0.8, 0, 0], [0, 0, -0.4])
    return scene, {"type": "constant", "luminance": 2000000}


def sun():
    scene = Scene()
    display(scene)
    return scene, {"type": "sky", "sun": {"azimuth_deg": 175, "elevation_deg": 25,
                                          "illuminance_lx": 40000}}


def trim():
    """A rod of polished metal before the display, which lamps of a small room shine on."""
    scene = Scene()
    display(scene)
    wall = scene.lambert(0.3)
    scene.quad(wall, [-0.6, -0.3, 1.2], [1.2, 0, 0], [0, 0, -1.3])
    scene.box_outside(scene.metal(0.7, 0.3), [-0.2, -0.11, 0.02], [0.2, -0.09, 0.04])
    for x in (-0.3, 0.4):
        scene.facing_quad(scene.emitter(400000), [x, 0.8, 0.7], [-x, -0.8, -0.7], 0.03)
    return scene, {"type": "constant", "luminance": 200}


def glass():
    """A display that the eye sees in a window alone, before an even sky."""
    scene = Scene()
    bars = png(60, 30, [[255 if 20 <= x < 40 and 8 <= y < 22 else 0 for x in range(60)
                         for _ in range(3)] for y in range(30)])
    screen = scene.material("screen", extensions={"PARHELION_display": {
        "panel": "ips.panel", "content": {"index": scene.image("image/png", bars)},
        "level": 1}})
    scene.quad(screen, [0.65, -0.075, 0.2], [-0.3, 0, 0], [0, 0.15, 0])
    scene.quad(scene.window(1.52), [-2, -2, -0.5], [4, 0, 0], [0, 4, 0])
    scene.view("eye", EYE, [0, 0, -1], 40)
    return scene, {"type": "constant", "luminance": 100}


def write_review(room, folder, is_private):
    scene, light = room()
    scene.write(os.path.join(folder, "room.gltf"))
    shutil.copy(PANEL, os.path.join(folder, "ips.panel"))
    path = os.path.join(folder, "review.json")
    with open(path, "w", encoding="utf-8") as file:
        json.dump({"title": "verdicts", "scene": ["room.gltf"], "profile": "iso-15008",
                   "eyes": {"eye": {"camera": "eye"}}, "precision": {"contrast": 0.01},
                   "symbols": {"bar": {"display": "screen", "uv": [0.1, 0.1, 0.9, 0.9],
                                       "must_not_be_read": is_private}},
                   "conditions": [{"name": "moment", "environment": light}]}, file)
    return path


def upper_end(wrong, trials):
    """The chance under which so few or fewer are wrong in one of twenty tries."""
    low, high = wrong / trials, 1.0
    for _ in range(60):
        p = (low + high) / 2
        tail = sum(math.exp(math.lgamma(trials + 1) - math.lgamma(k + 1) -
                            math.lgamma(trials - k + 1) + k * math.log(p) +
                            (trials - k) * math.log1p(-p)) for k in range(wrong + 1))
        low, high = (p, high) if tail > 0.05 else (low, p)
    return high


ROOMS = {"open": open_sky, "window": window, "grey": grey, "sun": sun, "trim": trim,
         "glass": glass}
CLOSED = {"open": open_light, "window": window_light}
CLOSED_WITHIN = 0.003  # the sum over directions, and D65 between wavelengths


def print_truth(room, words, build, folder):
    """False: it is the closed form, where there is one."""
    ratio, error = float(words[2]), float(words[3])
    print(f"{room}: contrast {ratio:.5g}, known within {error:.2g} %", flush=True)
    if room not in CLOSED:
        return False
    shown = float(words[4]), float(words[5])
    program = os.path.join(os.path.abspath(build), "parhelion")
    closed = closed_form(CLOSED[room], program, folder, shown, [float(w) for w in words[6:10]])
    print(f"{room}: in closed form {closed:.5g}, {100 * (ratio / closed - 1):+.2f} %")
    return abs(ratio / closed - 1) > CLOSED_WITHIN + 3 * error / 100


def print_row(room, words):
    margin, (trials, passed, failed, close) = float(words[1]), map(int, words[2:6])
    wrong = passed if margin < 0 else failed
    print(f"| {room} | {margin:+g} % | {trials} | {100 * passed / trials:.1f} % | "
          f"{100 * failed / trials:.1f} % | {100 * close / trials:.1f} % | "
          f"{100 * wrong / trials:.2f} % (at most {100 * upper_end(wrong, trials):.2f} %) | "
          f"{words[6]} |", flush=True)
    return wrong > 0.01 * trials


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build")
    parser.add_argument("--trials", type=int, default=2000)
    parser.add_argument("--rooms", default="open,window,grey,sun,trim")
    parser.add_argument("--private", action="store_true")
    words = parser.parse_args()
    off = 0
    print("| room | true margin | trials | pass | fail | too close | wrong | paths |\n" +
          "| --- " * 8 + "|")
    for name in words.rooms.split(","):
        with tempfile.TemporaryDirectory() as folder:
            path = write_review(ROOMS[name], folder, words.private)
            line = [os.path.join(os.path.abspath(words.build), "bench_verdicts"),
                    f"{words.trials}", path]
            with subprocess.Popen(line, stdout=subprocess.PIPE, text=True) as running:
                for row in running.stdout:
                    cells = row.rstrip("\n").split("\t")
                    if cells[1] == "truth":
                        off += print_truth(name, cells, words.build, folder)
                    else:
                        off += print_row(name, cells)
            if running.returncode:
                return running.returncode
    print(f"{off} cells of more than 1 % wrong")
    return off > 0


if __name__ == "__main__":
    sys.exit(main())
