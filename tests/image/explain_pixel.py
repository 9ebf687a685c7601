# SPDX-License-Identifier: Apache-2.0
"""explain_pixel.py PARHELION -- what one pixel sees: the chains of light add up to the frame's
pixel, by lights they are its layers, the spectrum is the one that shines; on a display what it
reflects and its contrasts; errors.
"""
import json
import math
import os
import sys
import tempfile

from exr import Frame
from gltf import Scene
from layers import table
from lights import ALONE, LUMINANCE, Program, room

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

SIZE, SPP = (48, 28), 256
PIXELS = {"floor": (24, 25), "ball": (17, 17), "window": (43, 14), "display": (28, 14)}
K_M, BANDS = 683.002, range(360, 830, 10)


class Explainer(Program):
    def explain(self, scene, pixel, *options):
        done = self.run("explain", scene, "--pixel", "{},{}".format(*pixel), "--json", "--size",
                        "{}x{}".format(*SIZE), "--quiet", *options)
        if done.returncode != 0:
            print(done.stderr)
        return json.loads(done.stdout)

    def pixel(self, scene, pixel, *options):
        (x, y), name = pixel, "pixel.exr"
        done = self.run("render", scene, "-o", name, "--size", "{}x{}".format(*SIZE), "--crop",
                        f"{x},{y},{x + 1},{y + 1}", "--quiet", *options)
        if done.returncode != 0:
            print(done.stderr)
        return Frame(os.path.join(self.folder, name))


def close(a, b, relative):
    return abs(a - b) <= relative * abs(b)


def observer():
    """Means of the observer over the bands, by its whole nanometres."""
    rows = {int(nm): (x, y, z) for nm, x, y, z in table("cie1931_2deg.csv")}
    return [[(sum(rows[first + i][c] for i in range(1, 10)) +
              0.5 * (rows[first][c] + rows[first + 10][c])) / 10 for c in range(3)]
            for first in BANDS]


def check_pixel(report, program, what, pixel):
    """The samples are the frame's: sums differ by the rounding of floats alone."""
    told = program.explain("room.gltf", pixel, "--paths", str(SPP), "--seed", "3", "--ways",
                           "1000")
    frame = program.pixel("room.gltf", pixel, "--spp", str(SPP), "--seed", "3", "--layers",
                          "xyz,light,display")
    for c, value in zip("XYZ", told["XYZ"]):
        wanted = frame.channels[f"xyz.{c}"][0]
        report.claim(close(value, wanted, 2e-6), f"{what}: {c} {value}, the frame has {wanted}")
    chains, all_light = told["chains"], told["luminance_cd_m2"]["all"]
    total = math.fsum(chain["cd_m2"] for chain in chains)
    report.claim(close(total, all_light, 1e-6) and all_light == told["XYZ"][1],
                 f"{what}: chains add up to {total}")
    report.claim(told["paths"] == SPP and told["pixel"] == list(pixel), f"{what}: the question")
    report.claim(all(a["cd_m2"] >= b["cd_m2"] for a, b in zip(chains, chains[1:])),
                 f"{what}: the order")
    report.claim(all(close(chain["share"] * all_light, chain["cd_m2"], 1e-6) and
                     chain["interval"][0] <= chain["cd_m2"] <= chain["interval"][1]
                     for chain in chains), f"{what}: shares, intervals")
    for layer, name in ALONE.items():
        found = math.fsum(chain["cd_m2"] for chain in chains if chain["light"] == name)
        wanted = sum(k * frame.channels[f"light.{layer}.{c}"][0]
                     for k, c in zip(LUMINANCE, "RGB"))
        report.claim(abs(found - wanted) <= 2e-4 * wanted + 1e-6 * total,
                     f"{what}: {found} of {name}, its layer has {wanted}")
    report.claim((told["display"] is not None) == (what == "display"), f"{what}: its display")
    if told["display"]:
        check_display(report, told, frame)
    return told


def check_display(report, told, frame):
    """What it sends and what it reflects, as the frame's layers; contrasts of these."""
    light = told["luminance_cd_m2"]
    parts = {name: sum(k * frame.channels[f"display.{name}.{c}"][0]
                       for k, c in zip(LUMINANCE, "RGB"))
             for name in ("reflected", "mirror", "scattered", "white", "black")}
    for name, wanted in parts.items():
        limit = 1e-4 if name in ("reflected", "mirror", "scattered") else 0.01
        report.claim(abs(light[name] - wanted) <= limit * parts["white"],
                     f"{name}: {light[name]}, the frame has {wanted}")
    own = [chain for chain in told["chains"] if not chain["bounces"]]
    sent = math.fsum(chain["cd_m2"] for chain in own)
    report.claim(close(sent + light["reflected"], light["all"], 1e-6), f"sent: {sent}")
    report.claim(all(chain["contrast_without"] is None for chain in own), f"{own}")
    ratio = (light["white"] + light["reflected"]) / (light["black"] + light["reflected"])
    low, high = told["contrast_interval"]
    report.claim(close(told["contrast_ratio"], ratio, 1e-6) and low <= ratio <= high,
                 f"contrast {told['contrast_ratio']} ({low} to {high}), of its parts {ratio}")
    first = next(chain for chain in told["chains"] if chain["bounces"])
    left = light["reflected"] - first["cd_m2"]
    report.claim(close(first["contrast_without"],
                       (light["white"] + left) / (light["black"] + left), 1e-6),
                 "contrast without the first")


def check_spectrum(report, told, what):
    """It integrates to the tristimulus values: two estimates from the same paths."""
    spectrum, weights = told["spectrum"], observer()
    report.claim(spectrum["nm"] == [first + 5 for first in BANDS], f"{what}: bands")
    most = max(told["XYZ"])
    for c in range(3):
        found = 10 * K_M * math.fsum(v * w[c] for v, w in zip(spectrum["radiance"], weights))
        error = 10 * K_M * math.sqrt(math.fsum((e * w[c]) ** 2 for e, w in
                                               zip(spectrum["standard_error"], weights)))
        report.claim(abs(found - told["XYZ"][c]) <= 4 * error + 0.005 * most and
                     error < 0.2 * most,
                     f"{what}: {'XYZ'[c]} of the spectrum {found:.5g} +- {error:.2g}, "
                     f"told {told['XYZ'][c]:.5g}")


def check_chains(report, told):
    ball, window, display = (told[what] for what in ("ball", "window", "display"))
    ways = [way for way in ball["chains"] if way["bounces"]]
    report.claim(all(way["bounces"][0]["what"] == "mirror" for way in ways) and ways,
                 "a mirror is met first")
    for way in ways[:5]:
        at = way["bounces"][0]["at_m"]
        radius = math.dist(at, (-0.7, 0.6, -0.9))
        report.claim(0.47 < radius < 0.5001, f"{at} on the ball")
    sky = next(way for way in window["chains"] if way["light"] == "sky")
    report.claim(sky["kind"] == "sky" and sky["from_m"] is None and
                 [b["what"] for b in sky["bounces"]] == ["passes"] and
                 sky["bounces"][0]["at_m"] is None, f"the sky through the pane: {sky}")
    own = next(way for way in display["chains"] if way["light"] == "cluster")
    report.claim(own["bounces"] == [] and own["kind"] == "surface" and
                 own["from_m"] is not None, f"the display itself: {own}")
    behind = [way for way in display["chains"] if way["bounces"]]
    report.claim({way["bounces"][0]["material"] for way in behind} == {"cluster"},
                 "the display's material")


def emitter(path, luminance):
    scene = Scene()
    scene.facing_quad(scene.emitter(luminance), [0, 0, 0], [0, 0, 1], 4)
    scene.view("eye", [0, 0, 1], [0, 0, -1], 40)
    scene.write(path)


def check_white(report, program):
    """A surface of white light sends D65: every band against the table, within its error."""
    emitter(os.path.join(program.folder, "white.gltf"), 250)
    told = program.explain("white.gltf", (20, 10), "--paths", "4096")
    power = table("d65.csv")

    def d65(nm):
        return next(x + (y - x) * (nm - a) / (b - a)
                    for (a, x), (b, y) in zip(power, power[1:]) if a <= nm <= b)

    unit = K_M * math.fsum(y * d65(nm) for nm, _, y, _ in table("cie1931_2deg.csv")
                           if 360 <= nm <= 830)
    spectrum, far = told["spectrum"], 0
    for i, first in enumerate(BANDS):
        wanted = 250 / unit * sum(d65(first + k + 0.5) for k in range(10)) / 10
        error = spectrum["standard_error"][i]
        limit = 0.02 if 420 <= first < 680 else 0.08
        far += abs(spectrum["radiance"][i] / wanted - 1) > limit
        report.claim(abs(spectrum["radiance"][i] - wanted) <= 5 * error + 2e-3 * wanted and
                     error < 0.2 * wanted, f"{first} nm: {spectrum['radiance'][i]:.5g} +- "
                     f"{error:.2g}, required: {wanted:.5g}")
    report.claim(far == 0, f"{far} of 47 bands are far off")
    report.claim(close(told["luminance_cd_m2"]["all"], 250, 1e-3) and
                 len(told["chains"]) == 1, f"{told['luminance_cd_m2']} cd/m2")


def check_words(report, program):
    line = ("explain", "room.gltf", "--size", "48x28", "--paths", "128", "--quiet")
    text = program.run(*line, "--pixel", "17,17").stdout
    again = program.run(*line, "--pixel", "17,17", "--threads", "1").stdout
    report.claim(text == again and " mirror " in text and text.count("\n") > 50,
                 f"other threads, other figures {text}")
    black = program.run(*line[:2], "--size", "48x28", "--pixel", "40,14", "--max-bounces", "0",
                        "--environment", "constant:0", "--display-level", "*=0")
    report.claim(black.returncode == 0 and " 0.0000 cd/m2" in black.stdout and
                 " nan" not in black.stdout, black.stdout)
    data = json.loads(program.run(*line[:2], "--size", "48x28", "--pixel", "40,14", "--json",
                                  "--max-bounces", "0", "--environment", "constant:0").stdout)
    report.claim(data["chains"] == [] and data["luminance_cd_m2"] == {"all": 0}, f"{data}")


def check_harm(report, program):
    """What has no measure is no answer."""
    emitter(os.path.join(program.folder, "blinding.gltf"), 3e38)
    for more in ((), ("--json",)):
        done = program.run("explain", "blinding.gltf", "--pixel", "20,10", "--size", "48x28",
                           "--paths", "128", "--quiet", *more)
        report.claim(done.returncode == 3 and done.stderr.count("\n") == 1 and
                     "pixel 20,10: its light is not finite" in done.stderr,
                     f"{more}: {done.returncode} {done.stderr}")


def check_errors(report, program):
    for options, wanted in (
            ((), "--pixel X,Y"),
            (("--pixel", "48,3"), "--pixel 48,3: is no pixel of a picture of 48x28"),
            (("--pixel", "3,28"), "--pixel 3,28: is no pixel"),
            (("--pixel", "-1,2"), "--pixel -1,2: is no pixel"),
            (("--pixel", "1.5,2"), "--pixel 1.5,2: is no pixel"),
            (("--pixel", "1"), "--pixel"), (("--pixel", "1,x"), "--pixel"),
            (("--pixel", "1,2", "--paths", "127"), "--paths"),
            (("--pixel", "1,2", "--spp", "128"), "here it is called --paths"),
            (("--pixel", "1,2", "--ways", "0"), "--ways"),
            (("--pixel", "1,2", "--camera", "nobody"), "--camera nobody")):
        done = program.run("explain", "room.gltf", "--size", "48x28", *options)
        report.claim(done.returncode == 2 and len(done.stderr.splitlines()) == 1 and
                     wanted in done.stderr, f"{options}: {done.returncode} {done.stderr}")
    done = program.run("explain", "absent.gltf", "--pixel", "1,2")
    report.claim(done.returncode == 3 and "absent.gltf" in done.stderr, done.stderr)


def main():
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        program = Explainer(os.path.abspath(sys.argv[-1]), folder)
        room(os.path.join(folder, "room.gltf"), lambda what: True)
        told = {what: check_pixel(report, program, what, pixel)
                for what, pixel in PIXELS.items()}
        for what, answer in told.items():
            check_spectrum(report, answer, what)
        check_chains(report, told)
        check_white(report, program)
        check_words(report, program)
        check_harm(report, program)
        check_errors(report, program)
    report.finish()


if __name__ == "__main__":
    main()
