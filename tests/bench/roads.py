# SPDX-License-Identifier: Apache-2.0
"""roads.py BUILD [--trials N] [--rooms screen,cabin,street] -- how often the verdict on a gaze
at a road by night is wrong whose true margin is -10 to 10 %: a table. BUILD has bench_roads.

Rooms: a wide screen in the dark; a cabin whose walls it lights, with a pane that mirrors it;
that cabin with street lamps ahead, small ones near the gaze among them. The truth is the mean
of as many readings of other seeds; tests/unit/test_road_verdicts.c has one in closed form.
A wrong verdict passes where the truth fails, or fails where it passes; "too close" is none. At
most one in a hundred may be; the upper end is that of Clopper and Pearson's 95 % interval of
one side.
"""
import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile

from verdicts import PANEL, upper_end
from gltf import Scene, png


def screen(scene):
    white = png(2, 1, [[255] * 6])
    wide = scene.material("screen", extensions={"PARHELION_display": {
        "panel": "ips.panel", "content": {"index": scene.image("image/png", white)},
        "level": 0.05}})
    scene.quad(wide, [0.25, -0.2, -0.8], [0.4, 0, 0.15], [0, 0.18, 0])
    scene.view("eye", [0, 0, 0], [0, 0, -1], 40)


def alone():
    scene = Scene()
    screen(scene)
    return scene


def cabin():
    """Grey trim below and beside, a pane ahead that leans."""
    scene = Scene()
    screen(scene)
    trim = scene.lambert(0.1, double_sided=True)
    scene.quad(trim, [-1, -0.4, 0.3], [2, 0, 0], [0, 0, -1.5])
    scene.quad(trim, [1, -0.4, 0.3], [0, 0, -1.5], [0, 1, 0])
    scene.quad(trim, [-1, 0.6, 0.3], [0, 0, -1.5], [2, 0, 0])
    scene.quad(scene.window(1.52), [-1, -0.4, -1.3], [2, 0, 0], [0, 1, 0.5])
    return scene


def street():
    """And lamps some way ahead."""
    scene = cabin()
    for x, z in ((-6, -25), (6, -40), (-6, -60)):
        scene.facing_quad(scene.emitter(3000), [x, 6, z], [-x, -6, -z], 0.5)
    for x in (-0.8, 0.8):  # tail lamps
        scene.facing_quad(scene.emitter(500), [x, -0.3, -50], [-x, 0.3, 50], 0.1)
    scene.sphere(scene.metal(0.6), [0.1, -0.3, -0.8], 0.01)  # shows them all
    return scene


ROOMS = {"screen": alone, "cabin": cabin, "street": street}


def write_review(room, folder):
    room().write(os.path.join(folder, "room.gltf"))
    shutil.copy(PANEL, os.path.join(folder, "ips.panel"))
    path = os.path.join(folder, "review.json")
    with open(path, "w", encoding="utf-8") as file:
        json.dump({"title": "roads", "scene": ["room.gltf"], "profile": "iso-15008",
                   "eyes": {"eye": {"camera": "eye"}},
                   "gaze": [{"name": "road", "direction": [0, 0, -1],
                             "road": {"luminance_cd_m2": 0.3}}],
                   "symbols": {"all": {"display": "screen", "uv": [0.1, 0.1, 0.9, 0.9]}},
                   "conditions": [{"name": "night"}]}, file)
    return path


def print_row(room, words):
    margin, (trials, passed, failed, close) = float(words[1]), map(int, words[2:6])
    wrong = passed if margin < 0 else failed
    print(f"| {room} | {margin:+g} % | {trials} | {100 * passed / trials:.1f} % | "
          f"{100 * failed / trials:.1f} % | {100 * close / trials:.1f} % | "
          f"{100 * wrong / trials:.2f} % (at most {100 * upper_end(wrong, trials):.2f} %) |",
          flush=True)
    return wrong > 0.01 * trials


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build")
    parser.add_argument("--trials", type=int, default=500)
    parser.add_argument("--rooms", default="screen,cabin,street")
    words = parser.parse_args()
    off = 0
    print("| room | true margin | trials | pass | fail | too close | wrong |\n" + "| --- " * 7 +
          "|")
    for name in words.rooms.split(","):
        with tempfile.TemporaryDirectory() as folder:
            line = [os.path.join(os.path.abspath(words.build), "bench_roads"),
                    f"{words.trials}", write_review(ROOMS[name], folder)]
            with subprocess.Popen(line, stdout=subprocess.PIPE, text=True) as running:
                for row in running.stdout:
                    cells = row.rstrip("\n").split("\t")
                    if cells[1] == "truth":
                        print(f"{name}: increment {cells[2]} %, known within {cells[3]} %",
                              flush=True)
                    else:
                        off += print_row(name, cells)
            if running.returncode:
                return running.returncode
    print(f"{off} cells of more than 1 % wrong")
    return off > 0


if __name__ == "__main__":
    sys.exit(main())
