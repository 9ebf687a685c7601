# SPDX-License-Identifier: Apache-2.0
"""contrast.py PARHELION -- the contrast of the displays in a frame: a panel
known in closed form in the dark, under a uniform sky, with the sun, behind a pane and by the
light of walls; contrast within 0.5 %. The panel has no haze, and the frame says so.
"""
import json
import math
import os
import subprocess
import sys
import tempfile

from exr import Frame
from gltf import Scene, png

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

WHITE, BLACK, RHO = 1000, 1, 0.01  # cd/m2, and of a Lambertian face
WHITE_XYZ = (0.950470, 1, 1.088830)  # D65
GREY = 188                           # the content's right half


def write_set(folder):
    """A panel alike from everywhere, without a mirror."""
    def table(name, columns, values):
        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
            file.write(f"theta,phi,{columns}\n")
            for theta in range(0, 90, 8):
                for phi in range(0, 360, 30):
                    file.write(f"{theta},{phi},{','.join(f'{v:.9g}' for v in values)}\n")
    table("white.csv", "X,Y,Z", [WHITE * x for x in WHITE_XYZ])
    table("face.csv", "450,550,650", [RHO / math.pi] * 3)
    with open(os.path.join(folder, "levels.csv"), "w", encoding="utf-8") as file:
        file.write("level,luminance\n")
        for level in (0, 64, 128, 192, 255):
            file.write(f"{level},{BLACK + (WHITE - BLACK) * (level / 255) ** 2.2:.9g}\n")
    angles = [*range(0, 90, 10), 85, 89]
    for angle in angles:
        os.link(os.path.join(folder, "face.csv"), os.path.join(folder, f"i{angle}.csv"))
    with open(os.path.join(folder, "MANIFEST.json"), "w", encoding="utf-8") as file:
        json.dump({"panel": "closed form", "emission": {"white": "white.csv",
                                                        "levels": "levels.csv"},
                   "reflection": {"wavelengths_nm": [450, 550, 650], "incidence_deg": angles,
                                  "files": "i{incidence}.csv"}}, file)


class Eye:
    def __init__(self, program, folder):
        self.program, self.folder = os.path.abspath(program), folder

    def run(self, *line):
        done = subprocess.run([self.program, *line, "--quiet"], cwd=self.folder,
                              capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        return done.stdout

    def scene(self, environment=None, pane=None, walls=None):
        """A display that faces up, its left half black, its right half grey."""
        scene = Scene()
        halves = scene.image("image/png", png(2, 1, [[0, 0, 0, GREY, GREY, GREY]]))
        screen = scene.material("screen", extensions={"PARHELION_display": {
            "panel": "closed.panel", "content": {"index": halves}, "level": 1}})
        scene.quad(screen, [-0.1, 0, 0.1], [0.2, 0, 0], [0, 0, -0.2])
        if environment:
            scene.environment(**environment)
        if pane:
            scene.quad(scene.window(1.5, pane), [-1, 0.3, 1], [2, 0, 0], [0, 0, -2])
        if walls:
            scene.box_inside(scene.lambert(walls), [-1, -0.5, -1], [1, 1, 1])
            scene.facing_quad(scene.emitter(3000), [0.5, 0.99, 0], [0, -1, 0], 0.3)
        scene.probe("eye", [0.2, 0.5, 0], [-0.2, -0.5, 0], 0.15, up=[0, 0, -1])
        scene.write(os.path.join(self.folder, "scene.gltf"))

    def frame(self, *options):
        self.run("render", "scene.gltf", "-o", "frame.exr", "--size", "24x24", "--layers",
                 "all", *options)
        return Frame(os.path.join(self.folder, "frame.exr")).channels

    def measure(self):
        return json.loads(self.run("measure", "frame.exr", "--display", "screen",
                                   "--json"))["contrast"]


def whole(channels):
    """Pixels that see the display alone."""
    return [i for i, share in enumerate(channels["display.coverage"]) if share == 1]


def luminances(channels, layer, pixels):
    return [0.2126 * channels[layer + ".R"][i] + 0.7152 * channels[layer + ".G"][i] +
            0.0722 * channels[layer + ".B"][i] for i in pixels]


def mean(values):
    return sum(values) / len(values)


def close(found, wanted, share):
    return abs(found - wanted) <= share * abs(wanted)


def check_dark(report, eye):
    """On and off of the panel alone."""
    eye.scene()
    channels = eye.frame("--spp", "16")
    pixels, found = whole(channels), eye.measure()
    report.claim(len(pixels) > 50, f"{len(pixels)} pixels of the display")
    report.claim(close(found["value"], WHITE / BLACK, 0.005), f"contrast {found['value']}")
    report.claim(found["reflected_cd_m2"] == 0, f"reflected in the dark: {found}")
    off = [i for i, share in enumerate(channels["display.coverage"]) if share == 0]
    report.claim(off and all(math.isnan(channels[name][i]) for i in off
                             for name in ("display.white.G", "display.contrast")),
                 "a figure off displays")


def check_order(report, channels):
    pixels = whole(channels)
    white, shown, black = (luminances(channels, "display." + name, pixels)
                           for name in ("white", "emitted", "black"))
    report.claim(all(w >= s * 0.999999 and s >= b * 0.999999
                     for w, s, b in zip(white, shown, black)),
                 "content is not between black and white")
    for parts in (("emitted", "mirror", "scattered"),
                  ("emitted", "mirror", "haze", "lambertian")):
        for c in "RGB":
            sums = [sum(channels[f"display.{part}.{c}"][i] for part in parts) for i in pixels]
            report.claim(all(close(s, channels[c][i], 1e-5) for s, i in zip(sums, pixels)),
                         f"{c}: {', '.join(parts)} are not what is seen")


def check_floor(report, channels, what):
    """The face is fitted within 2 %: haze is what that leaves."""
    pixels = whole(channels)
    haze, floor = (mean(luminances(channels, "display." + name, pixels))
                   for name in ("haze", "lambertian"))
    report.claim(floor > 0 and -1e-6 * floor <= haze < 0.02 * floor,
                 f"{what}: {haze:.4g} cd/m2 of haze and {floor:.4g} of a lambertian face")


def check_sky(report, eye):
    """(on + rho E / pi) / (off + rho E / pi), and the worked example of two lights: 5 klx of
    sky on 1 %, 45 klx of sun on 1.5 %, which is 67.5 klx on this face: 5.310 : 1."""
    for environment, reflected in (
            ({"type": "constant", "luminance": 2000}, RHO * 2000),
            ({"type": "constant", "luminance": 5000 / math.pi, "sun": {
                "azimuth_deg": 90, "elevation_deg": 40,
                "illuminance_lx": 67500 / math.sin(math.radians(40))}}, 230.775)):
        eye.scene(environment)
        channels, found = eye.frame("--spp", "256"), eye.measure()
        wanted = (WHITE + reflected) / (BLACK + reflected)
        report.claim(close(found["value"], wanted, 0.005),
                     f"contrast {found['value']:.5g}, by the formula {wanted:.5g}")
        report.claim(close(found["reflected_cd_m2"], reflected, 0.005),
                     f"reflected {found['reflected_cd_m2']:.5g} of {reflected:.5g}")
        pixel = mean([channels["display.contrast"][i] for i in whole(channels)])
        report.claim(close(pixel, wanted, 0.005), f"contrast of pixels {pixel}")
        check_order(report, channels)
        check_floor(report, channels, environment["type"])


def check_walls(report, eye):
    """Light of a lamp, and more of it by way of white walls: the face has no haze in either."""
    seen = []
    for walls in (0.001, 0.8):
        eye.scene(walls=walls)
        channels = eye.frame("--spp", "64")
        check_order(report, channels)
        check_floor(report, channels, f"walls of {walls}")
        seen.append(mean(luminances(channels, "display.lambertian", whole(channels))))
    report.claim(seen[1] > 1.5 * seen[0], f"the walls add nothing: {seen}")


def slab(cosine, ior=1.5):
    """What a pane lets pass, all reflections between its faces counted."""
    inside = math.sqrt(1 - (1 - cosine ** 2) / ior ** 2)
    s = ((cosine - ior * inside) / (cosine + ior * inside)) ** 2
    p = ((ior * cosine - inside) / (ior * cosine + inside)) ** 2
    r = (s + p) / 2
    return (1 - r) / (1 + r)


def check_pane(report, eye):
    """Behind glass white and black are what comes through it; a blue pane turns both blue."""
    passed = slab(0.5 / math.hypot(0.2, 0.5))
    for tint in ((1, 1, 1), (0.3, 0.5, 0.9)):
        eye.scene(pane=tint)
        channels, found = eye.frame("--spp", "64"), eye.measure()
        if tint == (1, 1, 1):
            report.claim(close(found["white_cd_m2"], WHITE * passed, 0.005),
                         f"white {found['white_cd_m2']:.5g} behind glass")
        report.claim(found["white_cd_m2"] < WHITE * passed * 1.01, "a tint adds light")
        report.claim(0 <= found["reflected_cd_m2"] < 0.002 * found["shown_cd_m2"],
                     f"behind {tint}: {found}")
        check_order(report, channels)
    shown = [mean([channels["display.white." + c][i] for i in whole(channels)]) for c in "RGB"]
    report.claim(shown[0] < 0.6 * shown[2], f"white behind a blue pane is {shown}")


def main(program):
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        write_set(folder)
        eye = Eye(program, folder)
        eye.run("panel", "fit", "MANIFEST.json", "-o", "closed.panel")
        check_dark(report, eye)
        check_sky(report, eye)
        check_pane(report, eye)
        check_walls(report, eye)
    return report.finish()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
