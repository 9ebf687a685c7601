# SPDX-License-Identifier: Apache-2.0
"""coverage.py BUILD [--seeds N] [--scenes car,deck,room] [--ways rcaemsfbw] [--moments 1,2,...]
-- how often 95 % intervals hold the true value, for every way to a number: a table of three
scenes under seven lights. BUILD has bench_coverage and bench_sweeps.

A cell is the share of N seeds (200; readings twice as many). The binomial standard error of a
share of 95 % is told beside it: a cell is said to be off where it lies outside 93 to 97 % by
more than two of them; of all cells of a way together the same is asked with all their trials.
"""
import argparse
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "image"))
from gltf import Scene, png  # noqa: E402

SCENES = os.path.join(ROOT, "scenes")
CONTENT = os.path.join(ROOT, "assets", "content")
PANEL = os.path.join(ROOT, "assets", "panels", "ips_cluster.panel")
LEAST, MOST = 0.93, 0.97


# ---- three scenes under seven lights -----------------------------------------------------


def room():
    """A display in a niche of white walls, open above and to the right, a satin rod before
    it."""
    scene = Scene()
    bars = png(60, 30, [[255 if 20 <= x < 40 and 8 <= y < 22 else 0 for x in range(60)
                         for _ in range(3)] for y in range(30)])
    screen = scene.material("screen", extensions={"PARHELION_display": {
        "panel": "ips.panel", "content": {"index": scene.image("image/png", bars)},
        "level": 1}})
    wall = scene.lambert(0.5)
    scene.quad(screen, [-0.15, -0.075, 0], [0.3, 0, 0], [0, 0.15, 0])
    scene.quad(wall, [-0.6, -0.3, 1.2], [1.2, 0, 0], [0, 0, -1.3])
    scene.quad(wall, [-0.6, -0.3, 1.2], [0, 0, -1.3], [0, 0.8, 0])
    scene.box_outside(scene.metal(0.7, 0.6), [-0.2, -0.11, 0.02], [0.2, -0.09, 0.04])
    scene.view("eye", [0.1, 0.15, 0.8], [-0.1, -0.15, -0.8], 8)
    return scene


def lamp():
    scene = Scene()
    for x in (-0.5, 0.1, 0.6):
        scene.light("point", 3, [x, 0.9, 0.7])
    scene.facing_quad(scene.emitter(200), [0.4, 0.6, 0.9], [-0.4, -0.6, -0.9], 0.05)
    return scene


def sky(azimuth, elevation):
    return {"type": "sky", "sun": {"azimuth_deg": azimuth, "elevation_deg": elevation,
                                   **({} if elevation < 0 else
                                      {"illuminance_lx": 30000 if elevation < 15 else 80000})}}


def moments(behind, night, level):
    """behind: azimuth of what is behind the eye, a little to the left."""
    lights = [("low sun", sky(behind, 10)), ("high sun", sky(behind - 140, 60)),
              ("sun ahead", sky(20, 25)), ("sun behind", sky(behind - 30, 35)),
              ("overcast", {"type": "cie", "sky": 1, "diffuse_horizontal_lx": 10000}),
              ("even sky", {"type": "constant", "luminance": 3000})]
    return [{"name": name, "level": "day", "environment": light} for name, light in lights] + \
        [{"name": "night", "level": "night", "lights": [night]}]


def sweep():
    return {"name": "sweep", "level": "day", "sweep": {
        "sky": "sky", "sun": {"azimuth_deg": [20, 260, 120], "elevation_deg": [5, 65, 30]}}}


def request(scene, symbol, eye, night, level, behind):
    return {"title": "coverage", "scene": [scene], "forward": [0, 0, -1], "eyes": {"eye": eye},
            "symbols": {"symbol": symbol}, "profile": "iso-15008",
            "levels": {"day": {"*": 1}, "night": {"*": level}},
            "conditions": moments(behind, night, level) + [sweep()]}


def car(folder):
    return request(os.path.relpath(SCENES, folder) + "/car_dashboard.gltf",
                   {"display": "cluster", "uv": [0.167, 0.408, 0.27, 0.609],
                    "content": os.path.relpath(CONTENT, folder) + "/cluster.png"},
                   {"camera": "driver-eye"},
                   os.path.relpath(SCENES, folder) + "/night.gltf", 0.04, 238)


def deck(folder):
    return request(os.path.relpath(SCENES, folder) + "/cockpit.gltf",
                   {"display": "pfd", "uv": [0.114, 0.451, 0.188, 0.498],
                    "content": os.path.relpath(CONTENT, folder) + "/pfd.png"},
                   {"camera": "captain"},
                   os.path.relpath(SCENES, folder) + "/flight_night.gltf", 0.01, 240)


def niche(folder):
    room().write(os.path.join(folder, "room.gltf"))
    lamp().write(os.path.join(folder, "lamp.gltf"))
    shutil.copy(PANEL, os.path.join(folder, "ips.panel"))
    return request("room.gltf", {"display": "screen", "uv": [0.1, 0.1, 0.9, 0.9]},
                   {"camera": "eye"}, "lamp.gltf", 0.04, 150)


# ---- what the programs print -------------------------------------------------------------


def rows_of(*line):
    with subprocess.Popen(line, stdout=subprocess.PIPE, text=True) as running:
        for row in running.stdout:
            words = row.rstrip("\n").split("\t")
            yield words[0], words[1], [float(x) for x in words[2:]]
    if running.returncode:
        sys.exit(f"{line[0]}: status {running.returncode}")


def judged(held, trials):
    """The share, its standard error, and whether it lies outside by more than two."""
    share, error = held / trials, math.sqrt(0.05 * 0.95 / trials)
    return share, error, not LEAST - 2 * error <= share <= MOST + 2 * error


def print_row(scene, moment, way, numbers):
    trials, held, below, above, paths, error, half, offset, known = numbers
    share, sigma, is_off = judged(held, trials)
    print(f"| {scene} | {moment} | {way} | {100 * share:.1f} +- {100 * sigma:.1f} % | "
          f"{100 * below / trials:.1f}, {100 * above / trials:.1f} % | {trials:.0f} | "
          f"{paths:.0f} | {error:.2f} % | {half:.2f} % | {offset:+.2f} % | "
          f"{'off' if is_off else ''} |", flush=True)
    return is_off


def print_ways(ways):
    print("\n| way | held | trials | cells | off |\n| --- | --- | --- | --- | --- |")
    for way, cells in ways.items():
        held, trials = (sum(cell[i] for cell in cells) for i in (0, 1))
        share, sigma, is_off = judged(held, trials)
        print(f"| {way} | {100 * share:.2f} +- {100 * sigma:.2f} % | {trials:.0f} | "
              f"{len(cells)} | {sum(cell[2] for cell in cells)}{', all together' * is_off} |")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build")
    parser.add_argument("--seeds", type=int, default=200)
    parser.add_argument("--scenes", default="room,car,deck")
    parser.add_argument("--ways", default="rcaemsfbw")
    parser.add_argument("--moments", default="")
    words = parser.parse_args()
    print("| scene | light | number | held | lie below, above the truth | trials | paths | "
          "error | half an interval | offset | |\n" + "| --- " * 11 + "|")
    ways, off = {}, 0
    with tempfile.TemporaryDirectory() as folder:
        made = {"car": car, "deck": deck, "room": niche}
        for scene in words.scenes.split(","):
            document, path = made[scene](folder), os.path.join(folder, scene + ".json")
            if words.moments:
                document["conditions"] = [c for c in document["conditions"]
                                          if c["name"] in words.moments.split(",")]
            with open(path, "w", encoding="utf-8") as file:
                json.dump(document, file)
            for program in ("bench_coverage", "bench_sweeps"):
                if not set(words.ways) & set("sfbw" if program == "bench_sweeps" else "rcaem"):
                    continue
                for moment, way, numbers in rows_of(
                        os.path.join(os.path.abspath(words.build), program), words.ways,
                        f"{words.seeds}", path):
                    is_off = print_row(scene, moment, way, numbers)
                    ways.setdefault(way, []).append((numbers[1], numbers[0], is_off))
                    off += is_off
    print_ways(ways)
    print(f"{off} cells off")
    return 0


if __name__ == "__main__":
    sys.exit(main())
