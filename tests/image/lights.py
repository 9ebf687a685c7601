# SPDX-License-Identifier: Apache-2.0
"""lights.py PARHELION -- the layers of groups of lights: each is what a render with that light
alone shows, their sum is the frame, parts of a frame make the same bits; names and figures.
"""
import json
import math
import os
import random
import subprocess
import sys
import tempfile

from exr import Frame
from gltf import Scene

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
PANEL = os.path.join(ROOT, "assets", "panels", "ips_cluster.panel")
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

SIZE = 48, 28
SPP, SEEDS = 16, 8
SUN = {"azimuth_deg": 100, "elevation_deg": 35, "illuminance_lx": 20000}
LUMINANCE = (0.2126390, 0.7151687, 0.0721923)
# layer -> what is left on in the scene that has it alone
ALONE = {"sun": "sun", "sky": "sky", "map_lamp": "map lamp", "dome": "dome", "strip": "strip",
         "cluster": "cluster"}


def named_light(scene, on, name, kind, candela, **place):
    scene.light(kind, candela if on(name) else 0, name=name, **place)


def room(path, on):
    """A room with a window, a mirror ball, lamps of two names, a bulb, a display."""
    scene = Scene()
    strength = 400 if on("strip") else 0
    scene.box_inside(scene.lambert(0.6), [-2, 0, -2], [2, 2.5, 2.5])
    for key in ("meshes", "nodes"):
        scene.document[key].pop()  # the wall to the right is open
    scene.document["scenes"][0]["nodes"].pop()
    scene.facing_quad(scene.window(1.52), [1.99, 1.2, 0], [-1, 0, 0], 4, 2.5)
    scene.sphere(scene.metal(0.9), [-0.7, 0.6, -0.9], 0.5, rings=12)
    scene.facing_quad(scene.material(
        "strip", pbrMetallicRoughness={"baseColorFactor": [0, 0, 0, 1]},
        emissiveFactor=[1, 0.8, 0.6] if strength else [0, 0, 0], extensions={
            "KHR_materials_emissive_strength": {"emissiveStrength": strength or 1}}),
        [0, 2.4, -1], [0, -1, 0.3], 0.8, 0.1)
    scene.facing_quad(scene.material("cluster", extensions={"PARHELION_display": {
        "panel": os.path.basename(PANEL), "level": 1 if on("cluster") else 0}}),
        [0.6, 0.9, -1.2], [0.2, 0.1, 1], 0.9, 0.6)
    for x in (-1, 1):
        named_light(scene, on, "map lamp", "spot", 90, position=[x, 2.3, 0],
                    direction=[-0.4 * x, -1, -0.4], color=[1, 0.7, 0.4])
    named_light(scene, on, "dome", "point", 40, position=[0, 2.2, 1.2])
    scene.environment(type="constant", luminance=900 if on("sky") else 0,
                      **({"sun": SUN} if on("sun") else {}))
    scene.view("eye", [0, 1.3, 2.3], [0, -0.12, -1], 60)
    with open(PANEL, "rb") as panel:
        scene.files[os.path.basename(PANEL)] = panel.read()
    scene.write(path)


class Program:
    def __init__(self, path, folder):
        self.path, self.folder = path, folder

    def run(self, *words):
        return subprocess.run([self.path, *words], capture_output=True, text=True,
                              cwd=self.folder)

    def render(self, scene, out, *options):
        done = self.run("render", scene, "-o", out, "--size", "{}x{}".format(*SIZE), "--quiet",
                        *options)
        if done.returncode != 0:
            print(done.stderr)
        return Frame(os.path.join(self.folder, out))

    def channels_of(self, name):
        """As bytes: NaN is equal to itself."""
        frame = Frame(os.path.join(self.folder, name))
        return {channel: values.tobytes() for channel, values in frame.channels.items()}


def layers_of(frame):
    return sorted({name[6:-2] for name in frame.channels if name.startswith("light.")})


def quarters(frame, layer):
    """Mean luminance of the four quarters of the frame; layer "" is the frame itself."""
    w, h = SIZE[0] // 2, SIZE[1] // 2
    prefix = f"light.{layer}." if layer else ""
    return [sum(k * frame.mean(prefix + c, (x, y, x + w, y + h))
                for k, c in zip(LUMINANCE, "RGB"))
            for y in (0, h) for x in (0, w)]


def mean_and_error(values):
    mean = sum(values) / len(values)
    spread = sum((v - mean) ** 2 for v in values) / (len(values) - 1)
    return mean, math.sqrt(spread / len(values))


def check_alone(report, program):
    """Against renders with that light alone; both means with their errors over the seeds."""
    seeds = [("--seed", str(seed), "--spp", str(SPP)) for seed in range(SEEDS)]
    together = [program.render("room.gltf", "all.exr", "--layers", "light", *s) for s in seeds]
    report.claim(layers_of(together[0]) == sorted(ALONE), f"layers: {layers_of(together[0])}")
    for layer, name in ALONE.items():
        room(os.path.join(program.folder, "one.gltf"), lambda what: what == name)
        alone = [program.render("one.gltf", "one.exr", "--no-guiding", *s) for s in seeds]
        found = list(zip(*(quarters(frame, layer) for frame in together)))
        wanted = list(zip(*(quarters(frame, "") for frame in alone)))
        for i in range(4):
            (a, error_a), (b, error_b) = mean_and_error(found[i]), mean_and_error(wanted[i])
            sigma = math.hypot(error_a, error_b)
            report.claim(abs(a - b) <= 4.5 * sigma + 1e-6 * b and sigma < 0.1 * b,
                         f"{layer}, quarter {i}: {a:.5g} together, {b:.5g} alone, "
                         f"+- {sigma:.2g}")
    return together[0]


def check_sum(report, program, frame):
    """The floats that are written: within 2^-19 of the pixel's brightest channel."""
    worst = 0
    names = layers_of(frame)
    for i in range(SIZE[0] * SIZE[1]):
        rgb = [frame.channels[c][i] for c in "RGB"]
        sums = [math.fsum(frame.channels[f"light.{n}.{c}"][i] for n in names) for c in "RGB"]
        most = max(map(abs, rgb))
        worst = max(worst, *(abs(a - b) / most for a, b in zip(rgb, sums)))
    report.claim(worst <= 2 ** -19, f"groups miss the frame by 2^{math.log2(worst):.1f} of it")
    plain = program.render("room.gltf", "plain.exr", "--seed", "0", "--spp", str(SPP))
    report.claim(all(plain.channels[c] == frame.channels[c] for c in "RGB"),
                 "R, G, B differ when lights are kept apart")


def check_parts(report, program):
    """Samples and crops, merged, are the frame of one run byte for byte."""
    options = ("--layers", "light,samples")
    w, h = SIZE
    program.render("room.gltf", "whole.exr", *options, "--spp", "7")
    parts = []
    for first, end in ((0, 3), (3, 7)):
        for x0, x1 in ((0, 17), (17, w)):
            parts.append(f"part{first}_{x0}.exr")
            program.render("room.gltf", parts[-1], *options, "--samples", f"{first}:{end}",
                           "--crop", f"{x0},0,{x1},{h}")
    random.Random(1).shuffle(parts)
    done = program.run("merge", *parts, "-o", "merged.exr", "--quiet")
    report.claim(done.returncode == 0, f"merge: {done.stderr}")
    report.claim(program.channels_of("whole.exr") == program.channels_of("merged.exr"),
                 "merged channels differ")
    program.render("room.gltf", "few.exr", "--samples", "0:3", "--layers", "samples")
    done = program.run("merge", "few.exr", parts[0], "-o", "no.exr", "--quiet")
    report.claim(done.returncode == 3 and "layers: " in done.stderr, f"merge: {done.stderr}")


def check_figures(report, program):
    program.render("room.gltf", "figures.exr", "--spp", "16", "--layers", "light,display,id")
    answer = json.loads(program.run("measure", "figures.exr", "--display", "cluster",
                                    "--json").stdout)
    lights = answer["lights"]
    total = math.fsum(light["cd_m2"] for light in lights)
    report.claim(len(lights) == len(ALONE) and
                 abs(total / answer["luminance_cd_m2"] - 1) < 1e-5,
                 f"measure: {total} of {answer['luminance_cd_m2']}")
    report.claim(abs(math.fsum(light["share"] for light in lights) - 1) < 1e-5, "shares")
    report.claim(lights == sorted(lights, key=lambda light: -light["cd_m2"]), "order")
    report.claim({(x["layer"], x["name"]) for x in lights} >= {("light.map_lamp", "map lamp")},
                 f"names: {lights}")
    one = json.loads(program.run("measure", "figures.exr", "--region", "3,4,4,5",
                                 "--json").stdout)["lights"]
    frame = Frame(os.path.join(program.folder, "figures.exr"))
    for light in one:
        value = sum(k * frame.mean(f"{light['layer']}.{c}", (3, 4, 4, 5))
                    for k, c in zip(LUMINANCE, "RGB"))
        report.claim(abs(value - light["cd_m2"]) <= 1e-4 * abs(value),
                     f"{light['layer']}: {light['cd_m2']}, required: {value}")
    text = program.run("measure", "figures.exr", "--display", "cluster").stdout
    report.claim("by light" in text and "% of " not in text.split("by light")[0] and
                 " %) of map lamp" in text, text)
    plain = json.loads(program.run("measure", "plain.exr", "--json").stdout)
    report.claim("lights" not in plain, "lights of a frame without them")
    done = program.run("develop", "figures.exr", "--layer", "light.map_lamp", "-o", "map.png")
    report.claim(done.returncode == 0, done.stderr)


def check_dark(report, program):
    """No light is no colour, and no group's."""
    lamps(os.path.join(program.folder, "dark.gltf"), [])
    program.render("dark.gltf", "dark.exr", "--spp", "1", "--layers", "light")
    text = program.run("measure", "dark.exr").stdout
    report.claim("luminance    0 cd/m2" in text and " -nan" not in text and
                 text.count("undefined: there is no light") == 4 and "by light" not in text,
                 text)


def lamps(path, names):
    scene = Scene()
    scene.facing_quad(scene.lambert(0.5), [0, 0, 0], [0, 0, 1], 2)
    for i, name in enumerate(names):
        scene.light("point", 1, [0.01 * i, 0, 1], **({"name": name} if name else {}))
    scene.view("eye", [0, 0, 3], [0, 0, -1], 40)
    scene.write(path)


def check_names(report, program):
    path = os.path.join(program.folder, "names.gltf")
    lamps(path, ["a b", "a.b", "sun", "a b", "", "a" * 200])
    done = program.run("render", "names.gltf", "-o", "names.exr", "--size", "8x8", "--spp", "1",
                       "--quiet", "--layers", "light")
    frame = Frame(os.path.join(program.folder, "names.exr"))
    report.claim(layers_of(frame) == sorted(["a_b", "a_b_2", "sun", "light_4", "a" * 64]),
                 f"layers {layers_of(frame)}")
    report.claim('the light of "a.b" is the layer light.a_b_2: another light has light.a_b'
                 in done.stderr, done.stderr)
    report.claim(frame.attributes["parhelion:light.a_b_2"] == b"a.b", "its own name")
    lamps(path, [f"lamp {i}" for i in range(256)])
    done = program.run("render", "names.gltf", "-o", "part.exr", "--size", "8x8", "--samples",
                       "0:1", "--quiet", "--layers", "all")
    many = Frame(os.path.join(program.folder, "part.exr"))
    report.claim(done.returncode == 0 and len(layers_of(many)) == 256, done.stderr)
    done = program.run("merge", "part.exr", "-o", "again.exr", "--quiet")
    report.claim(done.returncode == 0 and
                 program.channels_of("again.exr") == program.channels_of("part.exr"),
                 f"256 groups through a part: {done.stderr}")
    lamps(path, [f"lamp {i}" for i in range(257)])
    done = program.run("render", "names.gltf", "-o", "much.exr", "--size", "8x8", "--spp", "1",
                       "--quiet", "--layers", "light")
    report.claim(done.returncode == 2 and len(done.stderr.splitlines()) == 1 and
                 "--layers light: the lights of the scene have 257 names, at most 256"
                 in done.stderr, done.stderr)
    report.claim(not os.path.exists(os.path.join(program.folder, "much.exr")), "a frame")


def main():
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        program = Program(os.path.abspath(sys.argv[-1]), folder)
        room(os.path.join(folder, "room.gltf"), lambda what: True)
        frame = check_alone(report, program)
        check_sum(report, program, frame)
        check_parts(report, program)
        check_figures(report, program)
        check_names(report, program)
        check_dark(report, program)
    report.finish()


if __name__ == "__main__":
    main()
