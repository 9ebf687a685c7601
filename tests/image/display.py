# SPDX-License-Identifier: Apache-2.0
"""display.py [--all] [PANEL...] PARHELION -- a display in a black room shows what its panel
emits: three primaries at nine grey levels from ten directions, with --all from 25, each against
`panel eval`, luminance within 0.5 % and chromaticity within 0.002 in u'v'. Of a panel whose
backlight has zones white alone, all over: there the zones are full (test_backlight has the
others).
"""
import json
import math
import os
import shutil
import subprocess
import sys

from exr import Frame
from gltf import Scene, along, cross, dot, png, unit
from panel_checks import check_panels, direction

LEVELS = (0, 31, 63, 95, 127, 159, 191, 223, 255)
PATCHES = [tuple(level if k == primary else 0 for k in range(3))
           for primary in range(3) for level in LEVELS]
DIRECTIONS = [(theta, phi) for i, theta in enumerate((5, 20, 40, 60, 80))
              for k, phi in enumerate((0, 72, 144, 216, 288))
              if "--all" in sys.argv or (i + k) % 5 < 2]
COLUMNS, WIDTH = 16, 0.27  # pixels a patch; m
XYZ_FROM_RGB = ((0.4123908, 0.3575843, 0.1804808), (0.2126390, 0.7151687, 0.0721923),
                (0.0193308, 0.1191948, 0.9505322))


def strip_camera(scene, name, eye):
    """A parallel camera whose rows run along the display's own x axis: every patch then has
    COLUMNS pixels, from any direction."""
    along_x = along([1, 0, 0], eye, -eye[0])
    scale = math.sqrt(dot(along_x, along_x))
    scene.probe(name, [0.6 * x for x in eye], [-x for x in eye],
                WIDTH / 2 * scale / (COLUMNS * len(PATCHES)), WIDTH / 2 * scale,
                up=cross(eye, unit(along_x)))


def patches_of(program, panel):
    told = subprocess.run([program, "panel", "info", panel, "--json"], check=True,
                          capture_output=True, text=True).stdout
    return [(255, 255, 255)] * len(PATCHES) if '"local_dimming"' in told else PATCHES


def display_scene(panel, patches):
    scene = Scene()
    content = scene.image("image/png", png(len(patches), 1, [[c for p in patches for c in p]]))
    material = scene.material("display", extensions={"PARHELION_display": {
        "panel": panel, "content": {"index": content}, "level": 1}})
    scene.quad(material, [-WIDTH / 2, -0.05, 0], [WIDTH, 0, 0], [0, 0.1, 0])
    for theta, phi in DIRECTIONS:
        strip_camera(scene, f"{theta},{phi}", direction(theta, phi))
    return scene


def shown(program, path, theta, phi, folder):
    """XYZ of every patch in the frame of one direction."""
    out = os.path.join(folder, f"{theta}_{phi}.exr")
    subprocess.run([program, "render", path, "-o", out, "--camera", f"{theta},{phi}", "--size",
                    f"{COLUMNS * len(PATCHES)}x1", "--spp", "16", "--max-bounces", "0",
                    "--quiet"], check=True, capture_output=True, text=True)
    frame, values = Frame(out), []
    for i in range(len(PATCHES)):
        region = (COLUMNS * i + 5, 0, COLUMNS * i + 11, 1)
        rgb = [frame.mean(name, region) for name in "RGB"]
        values.append([dot(row, rgb) for row in XYZ_FROM_RGB])
    return values


def evaluated(program, panel, patches, folder):
    """`panel eval` of every patch in every direction, in their order."""
    rows = os.path.join(folder, "rows.csv")
    with open(rows, "w", encoding="utf-8") as file:
        file.write("theta,phi,r,g,b\n")
        for theta, phi in DIRECTIONS:
            for rgb in patches:
                file.write(f"{theta},{phi},{rgb[0]},{rgb[1]},{rgb[2]}\n")
    done = subprocess.run([program, "panel", "eval", panel, "--batch", rows, "--json"],
                          check=True, capture_output=True, text=True)
    return json.loads(done.stdout)


def chromaticity(xyz):
    """u', v' (CIE 1976)."""
    total = xyz[0] + 15 * xyz[1] + 3 * xyz[2]
    return (4 * xyz[0] / total, 9 * xyz[1] / total) if total > 0 else (0, 0)


def compare(report, panel, place, xyz, answer):
    luminance = answer["luminance_cd_m2"]
    off = abs(xyz[1] - luminance) / luminance if luminance > 0 else abs(xyz[1])
    u, v = chromaticity(xyz)
    turn = math.hypot(u - answer["uv"][0], v - answer["uv"][1]) if luminance > 1e-6 else 0
    report.claim(off <= 0.005 and turn <= 0.002,
                 f"{panel} {place}: {xyz[1]:.6g} cd/m2 in the frame, {luminance:.6g} by "
                 f"`panel eval`; u'v' off by {turn:.2g}")
    return off, turn


def check_panel(report, program, panel, folder):
    path = os.path.join(folder, os.path.basename(panel) + ".gltf")
    shutil.copy(panel, folder)  # a scene reads only what lies in or beside its folder
    patches = patches_of(program, panel)
    display_scene(os.path.basename(panel), patches).write(path)
    worst = [0, 0]
    answers = iter(evaluated(program, panel, patches, folder))
    for theta, phi in DIRECTIONS:
        for rgb, xyz in zip(patches, shown(program, path, theta, phi, folder)):
            place = f"rgb {rgb} theta {theta} phi {phi}"
            found = compare(report, os.path.basename(panel), place, xyz, next(answers))
            worst = [max(a, b) for a, b in zip(worst, found)]
    print(f"{os.path.basename(panel)}: luminance off by at most {100 * worst[0]:.3g} %, "
          f"u'v' by {worst[1]:.2g}")


if __name__ == "__main__":
    check_panels(check_panel)
