# SPDX-License-Identifier: Apache-2.0
"""subpixels.py PARHELION -- a display's sub-pixels in frames: what the panel says and what the
scene says are the same frame; seen straight, in mirrors, flat and bent, and through glass they
show when close, with the light of the even display, and from far they change no pixel.
"""
import json
import math
import os
import subprocess
import sys
import tempfile

from exr import Frame
from gltf import Scene, png, unit

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

PITCH = 1e-4  # m
COLUMNS, ROWS = 16, 12
LAYOUTS = {"stripe": {"layout": "stripe", "fill": 0.6},
           "pentile": {"layout": "pentile", "fill": 0.5}}
# From how far the display seems to be seen, m: of the cover counts its thickness over its
# index, and behind a mirror of focal length f after 1 cm a metre of way is 1 + 0.01 / f.
VIEWS = {"straight": 0.01, "pane": 0.01, "cover": 0.0081 + 0.0019 / 1.5, "mirror": 0.03,
         "ball": 0.01 + 0.02 * (1 + 0.01 / 0.02)}


def make_panel(program, folder, name, subpixels):
    def primary(peak, luminance):
        return {"peaks_nm": [peak], "fwhm_nm": [30], "weights": [1],
                "luminance_cd_m2": luminance}
    recipe = {"emission": {"red": primary(625, 100), "green": primary(530, 300),
                           "blue": primary(455, 40), "black_cd_m2": 0.1},
              "pixels": [COLUMNS, ROWS],
              "instrument": {"theta_step_deg": 5, "phi_step_deg": 30}}
    if subpixels:
        recipe["subpixels"] = subpixels
    path, lab = os.path.join(folder, name + ".json"), os.path.join(folder, "lab_" + name)
    with open(path, "w", encoding="utf-8") as file:
        json.dump(recipe, file)
    for words in (("simulate", path, "-o", lab),
                  ("fit", os.path.join(lab, "MANIFEST.json"), "-o",
                   os.path.join(folder, name + ".panel"), "--force")):
        subprocess.run([program, "panel", *words, "--quiet"], check=True, capture_output=True)


def bent_mirror(scene, z, radius):
    """A metal square about (0, 0, z) that faces -z and mirrors as a ball does."""
    half, corners = 0.01, ((-1, 1), (1, 1), (1, -1), (-1, -1))
    points = [[half * x, half * y, z] for x, y in corners]
    normals = [unit([half * x / radius, half * y / radius, -1]) for x, y in corners]
    scene.mesh(scene.metal(1), points, [[0, 1, 2], [0, 2, 3]], normals)


def make_scene(panel, view, far, subpixels):
    """The display lies about the origin and faces +z; four of its pixels fill a close frame."""
    scene = Scene()
    content = scene.image("image/png", png(1, 1, [[255, 255, 255]]))
    display = {"panel": panel + ".panel", "content": {"index": content}}
    if subpixels:
        display["subpixels"] = subpixels
    width, height = COLUMNS * PITCH, ROWS * PITCH
    scene.quad(scene.material("display", extensions={"PARHELION_display": display}),
               [-width / 2, -height / 2, 0], [width, 0, 0], [0, height, 0])
    if view == "pane":
        scene.facing_quad(scene.window(1.5), [0, 0, 0.005], [0, 0, 1], 0.02)
    if view == "cover":
        scene.box_outside(scene.glass(1.5), [-0.01, -0.01, 1e-4], [0.01, 0.01, 2e-3])
    if view == "mirror":
        scene.facing_quad(scene.metal(1), [0, 0, 0.02], [0, 0, -1], 0.02)
    if view == "ball":
        bent_mirror(scene, 0.02, 0.04)
    towards = [0, 0, 1 if view in ("mirror", "ball") else -1]
    scene.view("eye", [0, 0, 0.01], towards,
               2 * math.degrees(math.atan(far * 2 * PITCH / VIEWS[view])))
    return scene


class Eye:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def sees(self, *scene):
        make_scene(*scene).write(os.path.join(self.folder, "scene.gltf"))
        out = os.path.join(self.folder, "frame.exr")
        subprocess.run([self.program, "render", "scene.gltf", "-o", out, "--size", "48x48",
                        "--spp", "16", "--quiet"], cwd=self.folder, check=True,
                       capture_output=True)
        frame = Frame(out)
        return [list(frame.channels[c]) for c in "RGB"]


def mean(values):
    return sum(values) / len(values)


def check_view(report, eye, layout, view):
    subpixels = LAYOUTS[layout]
    told = {**subpixels, "columns": COLUMNS, "rows": ROWS}
    name = f"{layout}, {view}"
    for far in (1, 20):
        even = eye.sees("even", view, far, None)
        own = eye.sees(layout, view, far, None)
        report.claim(own == eye.sees("even", view, far, told),
                     f"{name}, {far} times as far: panel and scene say the same, the frame not")
        report.claim(even == eye.sees(layout, view, far, {"layout": "none"}),
                     f'{name}, {far} times as far: "none" is not the even display')
        if far > 1:
            report.claim(own == even, f"{name}: from far a pixel changed")
            continue
        for channel, shown, plain in zip("RGB", own, even):
            share = mean(shown) / mean(plain)
            report.claim(abs(share - 1) < 0.03, f"{name}: {channel} shines {share:.4f} times")
            contrast = max(shown) / max(plain)
            report.claim(contrast > 1.5, f"{name}: {channel} is nowhere more than "
                                         f"{contrast:.2f} times as bright")


def main():
    report = Report()
    program = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory(prefix="subpixels-") as folder:
        make_panel(program, folder, "even", None)
        eye = Eye(program, folder)
        for layout, subpixels in LAYOUTS.items():
            make_panel(program, folder, layout, subpixels)
            for view in VIEWS:
                check_view(report, eye, layout, view)
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
