# SPDX-License-Identifier: Apache-2.0
"""recombination.py PARHELION [CASES] -- what a sweep says of a sun beside paths traced for it.

CASES (30) random suns (place, heading, content, brightness), a third of them within 0.5 to 3
degrees of the horizon, and as many within 1 degree of the mirror direction: each is a sweep of
one sun, whose only row was put together from responses and whose worst case was traced. Passed:
within 2 % (aimed: 3 %) or three standard errors of the traced reading.
"""
import csv
import json
import math
import os
import random
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "image"))
from gltf import Scene, png  # noqa: E402

PANEL = os.path.join(ROOT, "assets", "panels", "ips_cluster.panel")
EYE = [0.1, -0.15, 0.8]
HALF = [0.15, 0.075]      # of the display, which looks along +z
SYMBOL = [0.1, 0.9]       # of its content, both ways
LEVELS = [0.25, 0.5, 1]
# A symbol with the sun in it has next to no contrast, however sure its light: paths decide.
PRECISION = {"any": {"contrast": 0.007, "clear": 0.007},
             "aimed": {"contrast": 1e-6, "clear": 1e-6, "paths": 1 << 22}}
HALF_WIDTH = 2.4          # of the interval of a reading that is not clear, in standard errors


def bars(inside, outside):
    return png(60, 30, [[inside if 20 <= x < 40 and 8 <= y < 22 else outside for x in range(60)
                         for _ in range(3)] for y in range(30)])


def niche(half=HALF):
    """A display of half such a size between white walls, open above, behind and to the right;
    the eye is below it and sees the sky in it."""
    scene = Scene()
    screen = scene.material("screen", extensions={"PARHELION_display": {
        "panel": "ips.panel", "content": {"index": scene.image("image/png", bars(255, 0))},
        "level": 1}})
    wall = scene.lambert(0.5)
    scene.quad(screen, [-half[0], -half[1], 0], [2 * half[0], 0, 0], [0, 2 * half[1], 0])
    scene.quad(wall, [-0.6, -0.3, 1.2], [1.2, 0, 0], [0, 0, -1.3])
    scene.quad(wall, [-0.6, -0.3, 1.2], [0, 0, -1.3], [0, 0.8, 0])
    scene.view("eye", EYE, [-x for x in EYE], 8)
    return scene


def mirror_angles(rng):
    """Azimuth of the vehicle and elevation, within a degree of where a point of the symbol
    mirrors the eye's ray to."""
    u, v = (rng.uniform(*SYMBOL) for _ in range(2))
    at = [HALF[0] * (2 * u - 1), HALF[1] * (1 - 2 * v)]
    x, y, z = at[0] - EYE[0], at[1] - EYE[1], EYE[2]
    off, turn = math.sqrt(rng.random()), rng.uniform(0, 2 * math.pi)
    elevation = math.degrees(math.atan2(y, math.hypot(x, z))) + off * math.sin(turn)
    return math.degrees(math.atan2(x, -z)) + off * math.cos(turn), elevation


def suns(cases, rng):
    for i in range(cases):
        low = i % 3 == 0
        yield "any", rng.uniform(0, 360), rng.uniform(0.5, 3) if low else rng.uniform(3, 75)
    for _ in range(cases):
        yield ("aimed", *mirror_angles(rng))


def condition(i, sun, rng):
    heading = rng.choice([0, 90, 225])
    azimuth, elevation = (sun[1] + heading) % 360, max(sun[2], 0.3)
    contents = [{}, {"contents": {"screen": "inverse.png"}}]
    return {"name": f"{i}", "heading_deg": heading, "level": f"{rng.choice(LEVELS)}",
            **contents[i % 2],
            "sweep": {"sun": {"azimuth_deg": [azimuth, azimuth, 1],
                              "elevation_deg": [elevation, elevation, 1]}, "sky": "sky"}}


def request(conditions, precision):
    return {"title": "recombination", "scene": ["niche.gltf"],
            "eyes": {"eye": {"camera": "eye"}},
            "symbols": {"bar": {"display": "screen", "uv": [SYMBOL[0]] * 2 + [SYMBOL[1]] * 2}},
            "profile": "iso-15008", "levels": {f"{level}": {"*": level} for level in LEVELS},
            "precision": precision, "conditions": conditions,
            "frames": {"size": [64, 36], "noise": 0.5, "worst": 0}}


def reflected(light, contrast):
    bright, dark = sorted((light["foreground"], light["background"]), reverse=True)
    return (bright - dark * contrast) / (contrast - 1)


def judge(folder, sweep, kind):
    """Passed, and by how much the row is off."""
    worst = sweep["worst"]
    light = worst["luminance_cd_m2"]
    with open(os.path.join(folder, sweep["table"]), encoding="utf-8") as file:
        found = float(next(csv.DictReader(file))["reflected_cd_m2"])
    high, low = (reflected(light, c) for c in worst["contrast_interval"])
    wanted, sigma = light["reflected"], (high - low) / 2 / HALF_WIDTH
    within = max((0.02 if kind == "any" else 0.03) * wanted, 3 * sigma)
    return abs(found - wanted) <= within, found / wanted - 1, sigma / wanted


def review(program, folder, asked, kind, rng):
    """The sweeps of one kind's suns, by their number among all, and their folder."""
    conditions = [condition(i, sun, rng) for i, sun in enumerate(asked) if sun[0] == kind]
    path, out = (os.path.join(folder, name) for name in (f"{kind}.json", kind))
    with open(path, "w", encoding="utf-8") as file:
        json.dump(request(conditions, PRECISION[kind]), file)
    done = subprocess.run([os.path.abspath(program), "review", path, "-o", out, "--quiet"],
                          capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1):
        sys.exit(done.stderr)
    with open(os.path.join(out, "review.json"), encoding="utf-8") as file:
        return {int(s["condition"]): s for s in json.load(file)["sweeps"]}, out


def compare(program, folder, asked, kind, rng):
    sweeps, out = review(program, folder, asked, kind, rng)
    passed, squares = 0, 0
    for i, sweep in sorted(sweeps.items()):
        good, off, sigma = judge(out, sweep, kind)
        passed += good
        squares += off * off
        print(f"{kind:5} azimuth {asked[i][1] % 360:5.1f} elevation {asked[i][2]:4.1f}: "
              f"{100 * off:+6.2f} % +- {100 * sigma:.2f} % {'' if good else 'MISSED'}")
    print(f"{kind}: {passed} of {len(sweeps)} passed, root mean square "
          f"{100 * math.sqrt(squares / len(sweeps)):.2f} %", flush=True)


def main(program, cases=30):
    rng = random.Random(3)
    asked = list(suns(int(cases), rng))
    with tempfile.TemporaryDirectory() as folder:
        shutil.copy(PANEL, os.path.join(folder, "ips.panel"))
        niche().write(os.path.join(folder, "niche.gltf"))
        with open(os.path.join(folder, "inverse.png"), "wb") as file:
            file.write(bars(0, 255))
        for kind in PRECISION:
            compare(program, folder, asked, kind, rng)


if __name__ == "__main__":
    main(*sys.argv[1:])
