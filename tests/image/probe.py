# SPDX-License-Identifier: Apache-2.0
"""probe.py PARHELION -- what one pixel sees: the ways of light add up to the frame's pixel, by
lights they are its layers, the spectrum is the one that shines; lines of glTF, errors.
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


class Prober(Program):
    def probe(self, scene, pixel, *options):
        done = self.run("probe", scene, "--pixel", "{},{}".format(*pixel), "--json", "--size",
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
    options = ("--spp", str(SPP), "--seed", "3")
    told = program.probe("room.gltf", pixel, *options, "--ways", "1000")
    frame = program.pixel("room.gltf", pixel, *options, "--layers", "xyz,light")
    for c, value in zip("XYZ", told["XYZ"]):
        wanted = frame.channels[f"xyz.{c}"][0]
        report.claim(close(value, wanted, 2e-6), f"{what}: {c} {value}, the frame has {wanted}")
    total = math.fsum(way["cd_m2"] for way in told["ways"]) + told["other_ways"]["cd_m2"]
    report.claim(close(total, told["luminance_cd_m2"], 1e-6) and
                 told["luminance_cd_m2"] == told["XYZ"][1], f"{what}: ways add up to {total}")
    report.claim(told["paths"] == SPP and told["pixel"] == list(pixel), f"{what}: the question")
    report.claim(all(a["cd_m2"] >= b["cd_m2"]
                     for a, b in zip(told["ways"], told["ways"][1:])), f"{what}: the order")
    report.claim(all(close(way["share"] * told["luminance_cd_m2"], way["cd_m2"], 1e-6)
                     for way in told["ways"]), f"{what}: shares")
    for layer, name in ALONE.items():
        found = math.fsum(way["cd_m2"] for way in told["ways"] if way["light"] == name)
        wanted = sum(k * frame.channels[f"light.{layer}.{c}"][0]
                     for k, c in zip(LUMINANCE, "RGB"))
        report.claim(told["other_ways"]["count"] == 0 and
                     abs(found - wanted) <= 2e-4 * wanted + 1e-6 * total,
                     f"{what}: {found} of {name}, its layer has {wanted}")
    return told


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
    ways = [way for way in ball["ways"] if way["bounces"]]
    report.claim(all(way["bounces"][0]["what"] == "mirror" for way in ways) and ways,
                 "a mirror is met first")
    for way in ways[:5]:
        at = way["bounces"][0]["at_m"]
        radius = math.dist(at, (-0.7, 0.6, -0.9))
        report.claim(0.47 < radius < 0.5001, f"{at} on the ball")
    sky = next(way for way in window["ways"] if way["light"] == "sky")
    report.claim(sky["kind"] == "sky" and sky["from_m"] is None and
                 [b["what"] for b in sky["bounces"]] == ["passes"] and
                 sky["bounces"][0]["at_m"] is None, f"the sky through the pane: {sky}")
    own = next(way for way in display["ways"] if way["light"] == "cluster")
    report.claim(own["bounces"] == [] and own["kind"] == "surface" and
                 own["from_m"] is not None, f"the display itself: {own}")
    behind = [way for way in display["ways"] if way["bounces"]]
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
    told = program.probe("white.gltf", (20, 10), "--spp", "4096")
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
    report.claim(close(told["luminance_cd_m2"], 250, 1e-3) and len(told["ways"]) == 1,
                 f"{told['luminance_cd_m2']} cd/m2")


def check_lines(report, program):
    """Lines of each way, in one colour for one light; `check` takes the file."""
    told = program.probe("room.gltf", PIXELS["floor"], "--spp", str(SPP), "--seed", "3",
                         "--ways", "12")
    for name in ("ways.gltf", "ways.glb"):
        done = program.run("probe", "room.gltf", "--pixel", "24,25", "--size", "48x28", "--spp",
                           str(SPP), "--seed", "3", "--ways", "12", "--quiet", "--gltf", name)
        report.claim(done.returncode == 0, done.stderr)
        done = program.run("check", name, "--json")
        report.claim(done.returncode == 0 and json.loads(done.stdout)["ok"], done.stdout)
    with open(os.path.join(program.folder, "ways.gltf"), encoding="utf-8") as file:
        document = json.load(file)
    drawn = [way for way in told["ways"] if way["rays"]]
    report.claim(len(document["meshes"]) == len(drawn) and len(drawn) > 6,
                 f"{len(document['meshes'])} meshes, {len(drawn)} ways")
    modes = {p["mode"] for mesh in document["meshes"] for p in mesh["primitives"]}
    report.claim(modes == {1}, f"modes {modes}")
    colours = {}
    for way, material in zip(drawn, document["materials"]):
        colour = tuple(material["pbrMetallicRoughness"]["baseColorFactor"])
        colours.setdefault(way["light"], set()).add(colour)
    report.claim(all(len(c) == 1 for c in colours.values()), "one colour for a light")
    report.claim(len(set().union(*colours.values())) == len(colours) > 1, "one light a colour")
    first, accessor = drawn[0]["rays"], document["accessors"][0]
    report.claim(accessor["count"] == sum(map(len, first)) and
                 all(abs(low - min(p[i] for ray in first for p in ray)) < 1e-5
                     for i, low in enumerate(accessor["min"])), "the points of the first way")


def check_words(report, program):
    line = ("probe", "room.gltf", "--size", "48x28", "--spp", "128", "--quiet")
    text = program.run(*line, "--pixel", "17,17").stdout
    report.claim(text.startswith("pixel      17,17 of 48x28, 128 paths\nluminance  "), text)
    report.claim(" mirror " in text and "error  light, and" in text and
                 text.count("\n") > 50 and "   825  " in text, text)
    again = program.run(*line, "--pixel", "17,17", "--threads", "1").stdout
    report.claim(text == again, "other threads, other figures")
    black = program.run(*line[:2], "--size", "48x28", "--pixel", "40,14", "--max-bounces", "0",
                        "--environment", "constant:0", "--display-level", "*=0")
    report.claim(black.returncode == 0 and "luminance  0 cd/m2" in black.stdout and
                 " nan" not in black.stdout, black.stdout)
    data = json.loads(program.run(*line[:2], "--size", "48x28", "--pixel", "40,14", "--json",
                                  "--max-bounces", "0", "--environment", "constant:0").stdout)
    report.claim(data["ways"] == [] and data["luminance_cd_m2"] == 0, f"{data}")


def check_harm(report, program):
    """What is read is not written over, and what has no measure is no answer."""
    with open(os.path.join(program.folder, "white.gltf"), "rb") as file:
        before = file.read()
    os.symlink("white.gltf", os.path.join(program.folder, "other.gltf"))
    line = ("--pixel", "20,10", "--size", "48x28", "--spp", "128", "--quiet")
    for words in (("probe", "white.gltf", *line, "--gltf", "white.gltf"),
                  ("probe", "room.gltf", "white.gltf", *line, "--gltf", "other.gltf"),
                  ("explain", "white.gltf", *line[:4], "-o", "./white.gltf")):
        done = program.run(*words)
        with open(os.path.join(program.folder, "white.gltf"), "rb") as file:
            report.claim(file.read() == before, f"{words}: the scene is gone")
        report.claim(done.returncode == 4 and len(done.stderr.splitlines()) == 1 and
                     "white.gltf: is read" in done.stderr.replace("other", "white"),
                     f"{words}: {done.returncode} {done.stderr}")
    emitter(os.path.join(program.folder, "blinding.gltf"), 3e38)
    for more in ((), ("--json",), ("--gltf", "ways.glb")):
        if os.path.exists(os.path.join(program.folder, "ways.glb")):
            os.remove(os.path.join(program.folder, "ways.glb"))
        done = program.run("probe", "blinding.gltf", *line, *more)
        report.claim(done.returncode == 3 and done.stderr.count("\n") == 1 and
                     "pixel 20,10: its light is not finite" in done.stderr and
                     not os.path.exists(os.path.join(program.folder, "ways.glb")),
                     f"{more}: {done.returncode} {done.stderr}")


def check_errors(report, program):
    for options, wanted in (
            ((), "no pixel — add --pixel X,Y"),
            (("--pixel", "48,3"), "--pixel 48,3: is no pixel of a picture of 48x28"),
            (("--pixel", "3,28"), "--pixel 3,28: is no pixel"),
            (("--pixel", "-1,2"), "--pixel -1,2: is no pixel"),
            (("--pixel", "1.5,2"), "--pixel 1.5,2: is no pixel"),
            (("--pixel", "1"), "--pixel"), (("--pixel", "1,x"), "--pixel"),
            (("--pixel", "1,2", "--spp", "127"), "--spp"),
            (("--pixel", "1,2", "--ways", "0"), "--ways"),
            (("--pixel", "1,2", "--gltf", "ways.obj"), "ways.obj: required: a name that ends "
                                                       "in"),
            (("--pixel", "1,2", "--camera", "nobody"), "--camera nobody"),
            (("--pixel", "1,2", "--field", "f", "--no-guiding"), "--field f")):
        done = program.run("probe", "room.gltf", "--size", "48x28", *options)
        report.claim(done.returncode == 2 and len(done.stderr.splitlines()) == 1 and
                     wanted in done.stderr, f"{options}: {done.returncode} {done.stderr}")
    done = program.run("probe", "absent.gltf", "--pixel", "1,2")
    report.claim(done.returncode == 3 and "absent.gltf" in done.stderr, done.stderr)
    done = program.run("probe", "room.gltf", "--pixel", "1,2", "--gltf", "absent/ways.gltf")
    report.claim(done.returncode == 4 and not done.stdout, done.stderr)


def main():
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        program = Prober(os.path.abspath(sys.argv[-1]), folder)
        room(os.path.join(folder, "room.gltf"), lambda what: True)
        told = {what: check_pixel(report, program, what, pixel)
                for what, pixel in PIXELS.items()}
        for what, answer in told.items():
            check_spectrum(report, answer, what)
        check_chains(report, told)
        check_white(report, program)
        check_lines(report, program)
        check_words(report, program)
        check_harm(report, program)
        check_errors(report, program)
    report.finish()


if __name__ == "__main__":
    main()
