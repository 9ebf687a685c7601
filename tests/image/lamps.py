# SPDX-License-Identifier: Apache-2.0
"""lamps.py PARHELION -- luminaire files as lamps of a scene (--light, EXT_lights_ies):
illuminances in closed form, flux, nodes that are turned, scaled and mirrored, openings near by
and their soft shadows, tilts, the bits of both ways, and what is refused.
"""
import base64
import json
import math
import os
import subprocess
import sys
import tempfile

from exr import Frame
from gltf import Scene

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
SHARED = os.path.join(ROOT, "..", "shared", "data", "photometry")
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

GAMMAS = (0, 30, 60, 90, 120, 150, 180)
PLANES = (0, 90, 180, 270, 360)
# candela, another one in each direction; what meets at a pole is one value
TABLE = [[400, 300 + 10 * c, 200 - 30 * c, 150 + 5 * c, 90 - 7 * c, 40 + 3 * c, 25]
         for c in (0, 1, 2, 3, 0)]
NODES = {
    "plain": {"translation": [0, 0, 0]},
    "moved": {"translation": [1, -2, 0.5]},
    "down": {"rotation": [-math.sqrt(0.5), 0, 0, math.sqrt(0.5)]},
    "turned": {"translation": [0, 1, 0], "rotation": [0.5, 0.5, -0.5, 0.5]},
    "scaled": {"translation": [0, 1, 0], "scale": [2, 5, 0.25]},
    "mirrored": {"scale": [-1, 1, 1]},
    "both": {"translation": [0.3, 0, 0], "rotation": [0.5, -0.5, 0.5, 0.5],
             "scale": [3, -2, 1]},
}
# the flux that the files state, lm
SHARED_FLUX = {"Indoor_60W_5300lm.ies": 5300, "MAXWELL_measured_IESNA.ies": 1000,
               "FL_MAX_900W_SYM60.ldt": 119760, "road_luminaire.ldt": 28027.4}


def ies(table=None, gammas=GAMMAS, planes=PLANES, head="1 -1 1", factors="1 1 30",
        size="0 0 0"):
    table = table or TABLE
    rows = "\n".join(" ".join(f"{v:g}" for v in row) for row in table)
    return (f"IESNA:LM-63-2002\n[TEST] none\n[MANUFAC] none\nTILT=NONE\n"
            f"{head} {len(gammas)} {len(planes)} 1 2 {size}\n{factors}\n"
            f"{' '.join(map(str, gammas))}\n{' '.join(map(str, planes))}\n{rows}\n")


def ldt(flux, factor=1, cct="", lamp="LED", size=("0", "0", "0")):
    """The same table in cd a klm: four planes, no symmetry. size: length, width, height."""
    head = ["maker", "1", "0", "4", "90", "7", "30", "report", "lamp", "1", "a.ldt", "today",
            "100", "0", "50", *size[:2], *[size[2]] * 4, "100", "100", str(factor), "0", "1",
            "1", lamp, str(flux), cct, "80", "30"] + ["0"] * 10
    values = [f"{v / (flux / 1000) / factor:.9g}" for row in TABLE[:4] for v in row]
    return "\r\n".join(head + ["0", "90", "180", "270", *map(str, GAMMAS), *values]) + "\r\n"


def rotated(q, v):
    x, y, z, w = q
    t = [2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])]
    return [v[0] + w * t[0] + y * t[2] - z * t[1], v[1] + w * t[1] + z * t[0] - x * t[2],
            v[2] + w * t[2] + x * t[1] - y * t[0]]


def axes(node):
    signs = [math.copysign(1, s) for s in node.get("scale", (1, 1, 1))]
    q = node.get("rotation", (0, 0, 0, 1))
    return [[s * v for v in rotated(q, unit)]
            for s, unit in zip(signs, ((1, 0, 0), (0, 1, 0), (0, 0, 1)))]


def intensity(local):
    """Of TABLE, bilinear, by the angles of a unit direction in the lamp's frame."""
    gamma = math.degrees(math.acos(max(-1, min(1, -local[2]))))
    c = math.degrees(math.atan2(local[1], local[0])) % 360
    i, k = min(int(c / 90), 3), min(int(gamma / 30), 5)
    s, t = c / 90 - i, gamma / 30 - k
    low, high = TABLE[i], TABLE[i + 1]
    return ((1 - s) * ((1 - t) * low[k] + t * low[k + 1])
            + s * ((1 - t) * high[k] + t * high[k + 1]))


def expected(node, place, normal):
    origin = node.get("translation", (0, 0, 0))
    away = [p - o for p, o in zip(place, origin)]
    distance = math.sqrt(sum(v * v for v in away))
    unit = [v / distance for v in away]
    local = [sum(a * u for a, u in zip(axis, unit)) for axis in axes(node)]
    cosine = max(0, -sum(n * u for n, u in zip(normal, unit)))
    return intensity(local) * cosine / distance ** 2


class Lamps:
    def __init__(self, program, folder):
        self.program, self.folder = os.path.abspath(program), folder
        self.write("lamp.ies", ies())
        self.write("lamp.ldt", ldt(2500))
        scene = Scene()
        for name, node in NODES.items():
            scene._node({"name": name, **node})
        scene.write(self.path("nodes.gltf"))

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self.path(name), "w", encoding="utf-8", newline="") as file:
            file.write(text)

    def run(self, *line):
        return subprocess.run([self.program, *line], cwd=self.folder, capture_output=True,
                              text=True, check=False)

    def lux(self, scene, place, normal, *options):
        done = self.run("measure", scene, "--illuminance",
                        ",".join(f"{x:.9g}" for x in (*place, *normal)), "--samples", "64",
                        "--json", "--quiet", *options)
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)["illuminance_lx"]

    def near(self, report, what, scene, place, normal, wanted, *options):
        """By samples: within 3.5 of the standard errors that are told, and within 0.5 %."""
        done = self.run("measure", scene, "--illuminance",
                        ",".join(f"{x:.9g}" for x in (*place, *normal)), "--samples", "20000",
                        "--json", "--quiet", *options)
        assert done.returncode == 0, done.stderr
        answer = json.loads(done.stdout)
        found, (low, high) = answer["illuminance_lx"], answer["illuminance_interval"]
        sigma = (high - low) / 2 / 1.96
        apart = abs(found - wanted) - 1e-9
        report.claim(apart <= 3.5 * sigma + 2e-4 * wanted and apart <= 5e-3 * wanted,
                     f"{what}: {found:.6g} +- {sigma:.2g} lx instead of {wanted:.6g}")

    def claim(self, report, what, found, wanted):
        report.claim(abs(found - wanted) <= 1e-3 * wanted + 1e-6,
                     f"{what}: {found:.6g} lx instead of {wanted:.6g}")


PLACES = (((0, 0, -2), (0, 0, 1)), ((1.5, 0, 0), (-1, 0, 0)), ((0, 3, 0), (0, -1, 0)),
          ((-1, -1, -1), (0.6, 0, 0.8)), ((0.2, -0.9, 1.3), (0, 0.8, -0.6)))


def check_nodes(report, lamps):
    for name, node in NODES.items():
        for offset, normal in PLACES:
            place = [o + d for o, d in zip(node.get("translation", (0, 0, 0)), offset)]
            for file in ("lamp.ies", "lamp.ldt")[:2 if name == "both" else 1]:
                found = lamps.lux("nodes.gltf", place, normal, "--light", f"{name}={file}")
                lamps.claim(report, f"{name} {offset} {file}", found,
                            expected(node, place, normal))


def check_factors(report, lamps):
    """Straight below: 400 cd from 2 m is 100 lx; multiplier, ballast, level; node: as well."""
    below = ((0, 0, -2), (0, 0, 1))
    lamps.write("twice.ies", ies(head="1 1000 2", factors="0.9 0.5 30"))
    lamps.write("factor.ldt", ldt(800, 2))
    for options, wanted in ((("--light", "plain=lamp.ies"), 100),
                            (("--light", "node:plain=lamp.ies"), 100),
                            (("--light", "plain=twice.ies"), 90),
                            (("--light", "plain=factor.ldt"), 100),
                            (("--light", "plain=lamp.ies", "--light-level", "plain=25"), 25),
                            (("--light", "plain=lamp.ies", "--light-level", "*=300%"), 300),
                            (("--light", "plain=lamp.ies", "--light-level", "plain=0"), 0)):
        found = lamps.lux("nodes.gltf", *below, *options)
        lamps.claim(report, " ".join(options), found, wanted)


def check_flux(report, lamps):
    """The illuminance on a sphere around a lamp adds up to its flux, and to what check says."""
    gammas = list(range(0, 91, 5))
    lamps.write("lambert.ies", ies([[100 * math.cos(math.radians(g)) for g in gammas]], gammas,
                                   (0,)))
    rings, flux = 16, 0.0
    for i in range(rings):
        z = -1 + (2 * i + 1) / rings
        r = math.sqrt(1 - z * z)
        flux += 4 * math.pi / rings * lamps.lux("nodes.gltf", (r, 0, z), (-r, 0, -z), "--light",
                                                "plain=lambert.ies")
    report.claim(abs(flux / (100 * math.pi) - 1) < 5e-3, f"{flux} lm of 100 pi")
    done = lamps.run("check", "nodes.gltf", "--json", "--light", "turned=lambert.ies")
    lamp, = json.loads(done.stdout)["lights"]
    report.claim(abs(lamp["flux_lm"] / (100 * math.pi) - 1) < 2e-3 and lamp["max_cd"] == 100
                 and lamp["type"] == "luminaire" and lamp["name"] == "turned",
                 f"check: {lamp}")
    down = [-v for v in axes(NODES["turned"])[2]]
    report.claim(all(abs(a - b) < 1e-6 for a, b in zip(lamp["direction"], down)),
                 f"check: direction {lamp['direction']} instead of {down}")


def check_shadow(report, lamps):
    """A plate between lamp and head; and a lamp in place of KHR_lights_punctual's."""
    scene = Scene()
    scene._node({"name": "lamp", "translation": [0, 0, 0]})
    plate = scene.material("plate", pbrMetallicRoughness={"baseColorFactor": [0, 0, 0, 1]})
    scene.quad(plate, [-0.5, -0.5, -1], [1, 0, 0], [0, 1, 0])
    scene.write(lamps.path("plate.gltf"))
    for place, is_lit in (((0, 0, -2), False), ((3, 0, -2), True)):
        found = lamps.lux("plate.gltf", place, (0, 0, 1), "--light", "lamp=lamp.ies")
        report.claim((found > 1) == is_lit, f"behind a plate at {place}: {found} lx")


def lambert(size, candela=100):
    gammas = [2 * i for i in range(46)]
    return ies([[candela * math.cos(math.radians(g)) for g in gammas]], gammas, (0,), size=size)


def even(size):
    return ies([[100, 100]], (0, 180), (0,), size=size)


def rectangle_lux(l, w, d):
    """On axis below l x w of 100 cd / (l w), Lambertian, facing each other: the corner's
    configuration factor (CIE, or any table of view factors) four times."""
    x, y = l / 2 / d, w / 2 / d
    rx, ry = math.sqrt(1 + x * x), math.sqrt(1 + y * y)
    factor = (x / rx * math.atan(y / rx) + y / ry * math.atan(x / ry)) / (2 * math.pi)
    return math.pi * 100 / (l * w) * 4 * factor


def check_openings(report, lamps):
    """Closed forms near by: discs, rectangles and spheres; from afar the point's."""
    for name, text in (("disc.ies", lambert("-0.6 -0.6 0")), ("rect.ies", lambert("0.4 1 0")),
                       ("ball.ies", even("-0.4 -0.4 -0.4")), ("point.ies", lambert("0 0 0")),
                       ("feet.ies", lambert("-0.6 -0.6 0").replace(" 1 2 -0.6", " 1 1 -0.6"))):
        lamps.write(name, text)
    for d in (0.05, 0.2, 1, 5):
        for name, wanted in (("disc", 100 / (0.3 ** 2 + d * d)),
                             ("feet", 100 / ((0.3 * 0.3048) ** 2 + d * d)),
                             ("rect", rectangle_lux(1, 0.4, d)), ("point", 100 / (d * d))):
            if d >= 0.2 or name == "point":
                lamps.near(report, f"{name} at {d} m", "nodes.gltf", (0, 0, -d), (0, 0, 1),
                           wanted, "--light", f"plain={name}.ies")
    for d in (0.25, 0.5, 3):
        for v in ((0, 0, -1), (0.6, 0.8, 0), (0.48, -0.6, 0.64)):
            lamps.near(report, f"ball at {d} m", "nodes.gltf", [d * x for x in v],
                       [-x for x in v], 100 / (d * d), "--light", "plain=ball.ies")
    for size in ("0.4 1 0", "-0.6 -0.6 0", "0.4 1 0.3", "-0.2 1 -0.2", "-0.3 -0.3 0.8"):
        lamps.write("far.ies", ies(size=size))
        for name in ("plain", "turned", "both"):
            origin = NODES[name].get("translation", (0, 0, 0))
            place = [o + x for o, x in zip(origin, (90, -120, 200))]
            normal = [-0.36, 0.48, -0.8]
            lamps.near(report, f"{size} far away, {name}", "nodes.gltf", place, normal,
                       expected(NODES[name], place, normal), "--light", f"{name}=far.ies")


def check_axes(report, lamps):
    """Length lies along C = 0 in IES files, along C = 90 in EULUMDAT: beside the long side of a
    strip it is brighter than beside its end."""
    lamps.write("strip.ies", even("0.01 1 0"))
    lamps.write("strip.ldt", ldt(2500, size=("1000", "10", "0")))
    lamps.write("point.ldt", ldt(2500))
    # 100 cd/m along a line, at 0.1 m from its middle: the integral of 100 h / (h^2 + x^2)^1.5
    beside = 100 * 2 * 0.5 / (0.1 * math.hypot(0.5, 0.1))
    lamps.near(report, "across the strip", "nodes.gltf", (0, 0.1, 0), (0, -1, 0), beside,
               "--light", "plain=strip.ies")
    lamps.near(report, "off the strip's end", "nodes.gltf", (0.6, 0, 0), (-1, 0, 0),
               100 * (1 / 0.1 - 1 / 1.1), "--light", "plain=strip.ies")
    found = shown_light(lamps, "strip.ldt")["opening"]
    report.claim(found["shape"] == "rectangle"
                 and all(abs(a - b) < 1e-6 for a, b in zip(found["size_m"], (0.01, 1, 0))),
                 f"EULUMDAT's strip: {found}")
    report.claim(shown_light(lamps, "point.ldt")["opening"] is None, "a point has an opening")


def shown_light(lamps, file, node="plain"):
    done = lamps.run("check", "nodes.gltf", "--json", "--light", f"{node}={file}")
    return json.loads(done.stdout)["lights"][0]


def check_penumbra(report, lamps):
    """A half plane 1 m under a strip of 0.2 m, and 1 m over the ground: the penumbra is 0.2 m
    wide, and in it what is seen of the strip grows from its one end to the other."""
    lamps.write("soft.ies", even("0.01 0.2 0"))
    scene = Scene()
    scene._node({"name": "lamp", "translation": [0, 0, 0]})
    plate = scene.material("plate", pbrMetallicRoughness={"baseColorFactor": [0, 0, 0, 1]})
    scene.quad(plate, [-9, -9, -1], [9, 0, 0], [0, 18, 0])  # its edge is x = 0
    scene.write(lamps.path("edge.gltf"))
    def lux(x, low, high):
        """From the strip between low and high, along x, 2 m over the ground."""
        at = [(v - x) / 2 for v in (low, high)]
        term = [t / math.sqrt(1 + t * t) for t in at]  # of h / (h^2 + s^2)^1.5, times h
        return 100 / 0.2 * (term[1] - term[0]) / 2
    for x in (-0.15, -0.101, -0.09, -0.05, 0, 0.03, 0.08, 0.099, 0.101, 0.2):
        edge = max(-0.1, min(0.1, -x))  # what lies above it is seen past the plate
        lamps.near(report, f"penumbra at {x}", "edge.gltf", (x, 0, -2), (0, 0, 1),
                   lux(x, edge, 0.1), "--light", "lamp=soft.ies")


MEDIA_TYPE = "application/x-ies-lm-63"


def studio(lamps, name, profile=None, node=None, **root):
    """A floor under a node "lamp" and an eye; with a profile it is a lamp of the scene."""
    scene = Scene()
    grey = scene.material("floor", pbrMetallicRoughness={"baseColorFactor": [0.5, 0.5, 0.5, 1],
                                                         "metallicFactor": 0})
    scene.quad(grey, [-2, -2, -2], [4, 0, 0], [0, 4, 0])
    scene.view("eye", [0, -1, 1], [0, 0.3, -1], 60)
    extensions = {}
    if profile:
        scene.used.add("EXT_lights_ies")
        scene.document["extensions"] = {"EXT_lights_ies": {"lights": [profile]}, **root}
        extensions = {"EXT_lights_ies": {"light": 0, **(node or {})}}
    scene._node({"name": "lamp", "translation": [0.2, 0.1, 0],
                 "rotation": [0.1, 0, 0.2, math.sqrt(0.95)],
                 **({"extensions": extensions} if extensions else {})})
    scene.write(lamps.path(name))
    return name


def bits(lamps, scene, *options):
    done = lamps.run("render", scene, "--size", "24x16", "--spp", "4", "--quiet",
                     "-o", "frame.exr", *options)
    assert done.returncode == 0, done.stderr
    return Frame(lamps.path("frame.exr")).channels


def embedded(lamps):
    """The profile as a buffer view of a scene that has one buffer more."""
    with open(lamps.path(studio(lamps, "view.gltf", {
            "bufferView": 0, "mimeType": MEDIA_TYPE})), encoding="utf-8") as file:
        document = json.load(file)
    data = ies().encode()
    document["buffers"].append({
        "byteLength": len(data),
        "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()})
    document["bufferViews"].append({"buffer": 1, "byteLength": len(data)})
    lights = document["extensions"]["EXT_lights_ies"]["lights"]
    lights[0]["bufferView"] = len(document["bufferViews"]) - 1
    with open(lamps.path("view.gltf"), "w", encoding="utf-8") as file:
        json.dump(document, file)
    return "view.gltf"


def check_extension(report, lamps):
    """EXT_lights_ies by a file, a data URI and a buffer view gives the bits of --light."""
    by_light = bits(lamps, studio(lamps, "bare.gltf"), "--light", "lamp=lamp.ies")
    data = base64.b64encode(ies().encode()).decode()
    scenes = {"file": studio(lamps, "uri.gltf", {"name": "spot", "uri": "lamp.ies"}),
              "data": studio(lamps, "data.gltf", {"uri": f"data:{MEDIA_TYPE};base64,{data}"}),
              "view": embedded(lamps)}
    for name, scene in scenes.items():
        report.claim(bits(lamps, scene) == by_light, f"{name}: other bits than --light")
    report.claim(bits(lamps, scenes["file"], "--light-level", "lamp=50") != by_light,
                 "--light-level does nothing to EXT_lights_ies")
    half = bits(lamps, studio(lamps, "half.gltf", {"uri": "lamp.ies"}, {"multiplier": 0.5}))
    report.claim(half == bits(lamps, "bare.gltf", "--light", "lamp=lamp.ies", "--light-level",
                              "lamp=50"), "multiplier 0.5: other bits than --light-level 50")
    lamps.write("twice.ies", ies(head="1 1000 2"))
    report.claim(bits(lamps, scenes["file"], "--light", "lamp=twice.ies")
                 == bits(lamps, "bare.gltf", "--light", "lamp=twice.ies"),
                 "--light does not take the place of EXT_lights_ies")


def check_listed(report, lamps):
    """Multiplier and color in what check says, and in lux."""
    color = [1, 0.5, 0.25]
    studio(lamps, "tint.gltf", {"name": "spot", "uri": "lamp.ies"},
           {"multiplier": 2, "color": color})
    done = lamps.run("check", "tint.gltf", "--json")
    answer = json.loads(done.stdout)
    lamp, = answer["lights"]
    weight = sum(a * b for a, b in zip((0.2126, 0.7152, 0.0722), color))
    largest = max(map(max, TABLE))
    report.claim(done.returncode == 0 and not answer["problems"]
                 and lamp["type"] == "luminaire" and lamp["name"] == "lamp"
                 and lamp["level"] == 2 and lamp["cct_k"] is None and lamp["file"] == "lamp.ies"
                 and abs(lamp["max_cd"] / (2 * weight * largest) - 1) < 1e-3
                 and all(abs(f / (2 * largest * c) - 1) < 1e-6
                         for f, c in zip(lamp["intensity"], color)), f"tint: {answer}")
    # 2 m from a lamp at the origin, its axis down -Z
    scene = Scene()
    scene.used.add("EXT_lights_ies")
    scene.document["extensions"] = {"EXT_lights_ies": {"lights": [{"uri": "lamp.ies"}]}}
    for x, members in ((0, {"multiplier": 0.25}), (50, {"color": color}), (100, {})):
        scene._node({"translation": [x, 0, 0],
                     "extensions": {"EXT_lights_ies": {"light": 0, **members}}})
    scene.write(lamps.path("row.gltf"))
    for x, wanted in ((0, 25), (50, 100 * weight), (100, 100)):
        found = lamps.lux("row.gltf", (x, 0, -2), (0, 0, 1))
        report.claim(abs(found / wanted - 1) < 2e-2, f"lamp at {x}: {found} lx, not {wanted}")


def shown(lamps, scene, *options):
    answer = json.loads(lamps.run("check", scene, "--json", *options).stdout)
    return [light["cct_k"] for light in answer["lights"]], answer["problems"]


def xy(lamps, *options):
    """Chromaticity of the light on a white floor below the lamp."""
    channels = bits(lamps, "bare.gltf", *options)
    rgb = [sum(channels[c]) for c in "RGB"]
    total = [sum(m * v for m, v in zip(row, rgb)) for row in XYZ_FROM_RGB]
    return total[0] / sum(total), total[1] / sum(total)


XYZ_FROM_RGB = ((0.4124564, 0.3575761, 0.1804375), (0.2126729, 0.7151522, 0.0721750),
                (0.0193339, 0.1191920, 0.9503041))
# CIE 15: x and y of black bodies, and of D50, D55, D65, D75
WHITES = {2000: (0.5267, 0.4133), 2856: (0.44758, 0.40745), 5003: (0.34567, 0.35850),
          5503: (0.33242, 0.34743), 6504: (0.31272, 0.32903), 7504: (0.29902, 0.31485)}


def check_cct(report, lamps):
    """Of files and of --light-cct: what is taken, and the chromaticity of its light."""
    lamps.write("plain.ldt", ldt(2500))
    texts = {"4000": 4000, "4000 K": 4000, "2700K": 2700, "840": 4000, "": None,
             "2700-6500": None, "900": None, "ww": None, "30000": None, "LED 4000K": 4000,
             "830 warm white": 3000, "827/830": None, "4000 lm": None, "4000 K / 840": 4000,
             "812": None, "540": None, "1e300": None, "592654000840": None,
             "Ra 80, 3500 K": 3500,
             **{f"{code}": code % 100 * 100 for code in (
                 730, 827, 830, 835, 840, 850, 865, 930, 940, 950, 965)}}
    for text, wanted in texts.items():
        lamps.write("told.ldt", ldt(2500, cct=text))
        found = shown(lamps, "nodes.gltf", "--light", "plain=told.ldt")
        report.claim(found == ([wanted], []), f"EULUMDAT \"{text}\": {found}")
        said = lamps.run("check", "nodes.gltf", "--light", "plain=told.ldt").stdout
        words = (f'{wanted} K ("{text}")' if wanted else
                 f'D65 ("{text}" tells no colour' if text else "D65 (the file tells no colour")
        report.claim(words in said, f"EULUMDAT \"{text}\": check says {said}")
    for text, wanted in {"LED 4000K": 4000, "TL5 35W/830": 3000, "LED 840": None,
                         "4000 lm": None, "LED E27 2700 K 806 lm": 2700}.items():
        lamps.write("told.ldt", ldt(2500, lamp=text))
        lamps.write("told.ies", ies().replace("TILT", f"[LAMP] {text}\nTILT"))
        for file in ("told.ldt", "told.ies"):
            found = shown(lamps, "nodes.gltf", "--light", f"plain={file}")
            report.claim(found == ([wanted], []), f"{file}, lamp \"{text}\": {found}")
    lamps.write("told.ldt", ldt(2500, cct="3000", lamp="LED 4000 K"))
    report.claim(shown(lamps, "nodes.gltf", "--light", "plain=told.ldt")[0] == [3000],
                 "the colour's line speaks before the lamp's")
    lamps.write("told.ies", ies().replace("TILT", "[LAMP] LED 4000 K\n[_CCT] 3000\nTILT"))
    report.claim(shown(lamps, "nodes.gltf", "--light", "plain=told.ies")[0] == [3000],
                 "the keyword of the colour speaks before the lamp's")
    lamps.write("told.ies", ies().replace("TILT", "[_CCT] 3000 K\nTILT"))
    for keyword in ("[_CCT]", "[CCT]", "[COLORTEMP]", "[_Color_Temp]", "[_COLOR_TEMPERATURE]"):
        lamps.write("told.ies", ies().replace("TILT", f"{keyword} 3000 K\nTILT"))
        found = shown(lamps, "nodes.gltf", "--light", "plain=told.ies")
        report.claim(found == ([3000], []), f"{keyword}: {found}")
    studio(lamps, "told.gltf", {"uri": "told.ies"})
    report.claim(shown(lamps, "told.gltf")[0] == [3000], "the extension's file has 3000 K")
    report.claim(bits(lamps, "told.gltf") == bits(lamps, "bare.gltf", "--light",
                                                  "lamp=told.ies"), "3000 K: other bits")
    for kelvin, wanted in WHITES.items():
        found = xy(lamps, "--light", "lamp=told.ies", "--light-cct", f"*={kelvin}K")
        report.claim(math.dist(found, wanted) < 1.5e-3, f"{kelvin} K: xy {found}, not {wanted}")
    for options in ((), ("--light-cct", "plain=2200"), ("--light-cct", "plain=9300")):
        found = lamps.lux("nodes.gltf", (0, 0, -2), (0, 0, 1), "--light", "plain=lamp.ies",
                          *options)
        report.claim(abs(found / 100 - 1) < 3e-3, f"{options}: {found} lx instead of 100")


def check_tilt(report, lamps):
    """The factors of TILT= count by how the node lies, world -Y being down; a file that is not
    there is told of."""
    def tilted(geometry, head=""):
        return f"{geometry}\n3\n0 60 90\n1 0.9 0.5" + head
    # node: lamps that lie along -Z, +X, +Y of the lamp; their tilts, degrees
    turns = {"plain": (90, 0, 90), "down": (0, 0, 0), "turned": None}
    for node in turns:
        x, y, z = axes(NODES[node])
        for geometry, lamp in ((1, [-v for v in z]), (2, x), (3, y)):
            vertical = math.degrees(math.acos(max(-1, min(1, -lamp[1]))))
            angle = min(vertical, 180 - vertical)
            angle = angle if geometry == 1 else 90 - angle
            report.claim(not turns[node] or abs(angle - turns[node][geometry - 1]) < 1e-3,
                         f"{node} {geometry}: {angle} degrees")
            factor = 1 - angle / 600 if angle < 60 else 0.9 - (angle - 60) / 75
            lamps.write("tilt.ies", ies().replace("TILT=NONE",
                                                  "TILT=INCLUDE\n" + tilted(geometry)))
            light = shown_light(lamps, "tilt.ies", node)
            report.claim(abs(light["tilt"]["angle_deg"] - angle) < 1e-2
                         and abs(light["tilt"]["factor"] - factor) < 1e-5
                         and abs(light["max_cd"] - 400 * factor) < 1e-2,
                         f"{node} {geometry}: {light}")
    lamps.write("tilt.ies", ies().replace("TILT=NONE", "TILT=lamp.tlt"))
    report.claim(shown_light(lamps, "tilt.ies")["tilt"] is None, "no file, but a tilt")
    _, problems = shown(lamps, "nodes.gltf", "--light", "plain=tilt.ies")
    report.claim(len(problems) == 1 and problems[0]["severity"] == "warning"
                 and problems[0]["file"] == "tilt.ies"
                 and "no such file beside it" in problems[0]["message"],
                 f"lamp.tlt: {problems}")
    lamps.write("lamp.tlt", tilted(1))
    found = lamps.lux("nodes.gltf", (0, 0, -2), (0, 0, 1), "--light", "plain=tilt.ies")
    lamps.claim(report, "TILT=lamp.tlt", found, 50)
    studio(lamps, "tilt.gltf", {"uri": "tilt.ies"})
    answer = json.loads(lamps.run("check", "tilt.gltf", "--json").stdout)
    report.claim(not answer["problems"] and answer["lights"][0]["tilt"], f"uri: {answer}")
    lamps.write("lamp.tlt", "1\n3\n0 60 90\n1 0.9")
    done = lamps.run("check", "nodes.gltf", "--light", "plain=tilt.ies")
    report.claim(done.returncode == 3 and "lamp.tlt" in done.stdout + done.stderr
                 and "the file ends before a tilt factor" in done.stdout + done.stderr,
                 f"broken lamp.tlt: {done.returncode} {done.stdout} {done.stderr}")
    os.remove(lamps.path("lamp.tlt"))
    data = base64.b64encode(ies().replace("TILT=NONE", "TILT=lamp.tlt").encode()).decode()
    studio(lamps, "tilt.gltf", {"uri": f"data:{MEDIA_TYPE};base64,{data}"})
    answer = json.loads(lamps.run("check", "tilt.gltf", "--json").stdout)
    report.claim(["inside a scene" in p["message"] for p in answer["problems"]] == [True],
                 f"data: {answer}")


def check_types(report, lamps):
    """Types A and B: (0, 0) is the node's -Z, V = 90 its +X, H = 90 its -Y."""
    angles = list(range(-90, 91, 15))
    for kind, name in ((2, "b.ies"), (3, "a.ies")):
        table = [[100 + v / 9 - h / 3 for v in angles] for h in angles]
        text = ies(table, angles, angles).replace(f" {len(angles)} 1 2 0",
                                                  f" {len(angles)} {kind} 2 0")
        lamps.write(name, text)
        for v, h in ((0, 0), (40, 0), (0, 40), (-25, 50), (70, -20)):
            sv, cv, sh, ch = (f(math.radians(x)) for x in (v, h) for f in (math.sin, math.cos))
            d = (ch * sv, -sh, -ch * cv) if kind == 2 else (sv, -cv * sh, -cv * ch)
            lamps.claim(report, f"{name} at V {v}, H {h}",
                        lamps.lux("nodes.gltf", [2 * x for x in d], [-x for x in d], "--light",
                                  f"plain={name}"), (100 + v / 9 - h / 3) / 4)
        lamps.claim(report, f"{name} behind", lamps.lux("nodes.gltf", (0.3, 0.1, 2), (0, 0, -1),
                                                        "--light", f"plain={name}"), 0)


def check_both(report, lamps):
    """With KHR_lights_punctual on the same node: one lamp, and it is said."""
    punctual = {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 1000}]}}
    studio(lamps, "both.gltf", {"uri": "lamp.ies"}, None, **punctual)
    with open(lamps.path("both.gltf"), encoding="utf-8") as file:
        document = json.load(file)
    document["extensionsUsed"].append("KHR_lights_punctual")
    document["nodes"][-1]["extensions"]["KHR_lights_punctual"] = {"light": 0}
    with open(lamps.path("both.gltf"), "w", encoding="utf-8") as file:
        json.dump(document, file)
    answer = json.loads(lamps.run("check", "both.gltf", "--json").stdout)
    report.claim([light["type"] for light in answer["lights"]] == ["luminaire"]
                 and any("EXT_lights_ies as well" in p["message"]
                         and p["path"].endswith("/extensions/KHR_lights_punctual")
                         for p in answer["problems"]), f"both: {answer}")


def check_extension_refused(report, lamps):
    lamps.write("word.ies", ies().replace("400 300", "400 bright", 1))
    os.makedirs(lamps.path("deep/scene"), exist_ok=True)
    place = "/extensions/EXT_lights_ies/lights/0"
    broken = base64.b64encode(ies()[:-30].encode()).decode()
    for profile, node, words in (
            ({"uri": "none.ies"}, {}, (place + "/uri", "none.ies", "No such file")),
            ({"uri": "word.ies"}, {}, (place + "/uri", "word.ies: line 9", "bright")),
            ({"uri": f"data:{MEDIA_TYPE};base64,{broken}"}, {},
             (place + "/uri", "the file ends before")),
            ({"uri": "../../../etc/lamp.ies"}, {}, (place + "/uri", "--root")),
            ({"uri": "/etc/lamp.ies"}, {}, (place + "/uri", "absolute path")),
            ({"uri": "https://host/lamp.ies"}, {}, (place + "/uri", "https:")),
            ({"uri": "lamp.ldt"}, {}, (place + "/uri", "EULUMDAT", "--light")),
            ({"uri": "lamp.ies", "bufferView": 0, "mimeType": MEDIA_TYPE}, {},
             (place, "has both")),
            ({}, {}, (place, "has neither")),
            ({"uri": 5}, {}, (place + "/uri", "a text is required")),
            ({"bufferView": 99, "mimeType": MEDIA_TYPE}, {},
             (place + "/bufferView", "in bufferViews")),
            ({"bufferView": 0, "mimeType": MEDIA_TYPE}, {}, (place, "no line TILT=")),
            ({"uri": "lamp.ies"}, {"light": 1}, ("/light", "there is 1 in lights")),
            ({"uri": "lamp.ies"}, {"multiplier": -1}, ("/multiplier", "at least 0")),
            ({"uri": "lamp.ies"}, {"color": [1, 2, 1]}, ("/color", "from 0 to 1")),
            ({"uri": "lamp.ies"}, {"color": [1, 1]}, ("/color", "an array of 3"))):
        studio(lamps, "deep/scene/bad.gltf", profile or {"name": "x"}, node)
        for name in ("lamp.ies", "lamp.ldt", "word.ies"):
            with open(lamps.path(name), encoding="utf-8") as file:
                lamps.write(f"deep/scene/{name}", file.read())
        done = lamps.run("check", "deep/scene/bad.gltf")
        said = done.stdout + done.stderr
        report.claim(done.returncode == 3 and "bad.gltf" in said
                     and all(w in said for w in words), f"{profile} {node}: "
                     f"{done.returncode} {said}")


def check_refused(report, lamps):
    lamps.write("word.ies", ies().replace("400 300", "400 bright", 1))
    lamps.write("short.ies", ies()[:-30])
    lamps.write("dark.ies", ies([[0] * 7] * 5))
    lamps.write("short.ldt", ldt(1000)[:120])
    for options, words in (
            (("--light", "porch=lamp.ies"), ('no node is named "porch"', '"plain"', '"both"')),
            (("--light", "plain=none.ies"), ("none.ies",)),
            (("--light", "plain=word.ies"), ("word.ies", "line 9", "bright")),
            (("--light", "plain=short.ies"), ("short.ies", "the file ends before")),
            (("--light", "plain=dark.ies"), ("dark.ies", "above 0 cd")),
            (("--light", "plain=short.ldt"), ("short.ldt", "the file ends before")),
            (("--light", "plain=lamp.ies", "--light-level", "plain=x"), ("--light-level", "x")),
            (("--light", "plain=lamp.ies", "--light-level", "moved=5"), ("moved", '"plain"')),
            (("--light", "plain=lamp.ies", "--light-cct", "moved=3000"), ("moved", '"plain"')),
            (("--light", "plain=lamp.ies", "--light-cct", "*=999"), ("999", "1000 to 25000")),
            (("--light", "plain=lamp.ies", "--light-cct", "*=warm"), ("--light-cct", "warm"))):
        done = lamps.run("measure", "nodes.gltf", "--illuminance", "0,0,0,0,1,0", *options)
        report.claim(done.returncode == 3 and all(w in done.stderr for w in words)
                     and done.stderr.count("\n") == 1,
                     f"{options}: {done.returncode} {done.stderr}")
    done = lamps.run("measure", "nodes.gltf", "--illuminance", "0,0,0,0,1,0", "--light",
                     "plain")
    report.claim(done.returncode == 2, f"no file: {done.returncode} {done.stderr}")


def check_shared(report, lamps):
    if not os.path.isdir(SHARED):
        print("skipped: no ../shared/data/photometry")
        return
    for name, flux in SHARED_FLUX.items():
        done = lamps.run("check", "nodes.gltf", "--json", "--light",
                         f"plain={os.path.join(SHARED, name)}")
        lamp, = json.loads(done.stdout)["lights"]
        report.claim(abs(lamp["flux_lm"] / flux - 1) < 5e-3, f"{name}: {lamp}")


def main():
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        lamps = Lamps(sys.argv[-1], folder)
        for check in (check_nodes, check_factors, check_flux, check_shadow, check_openings,
                      check_axes, check_penumbra, check_types, check_extension, check_listed,
                      check_cct, check_tilt, check_both,
                      check_extension_refused, check_refused, check_shared):
            try:
                check(report, lamps)
            except AssertionError as error:
                report.claim(False, f"{check.__name__}: {error}")
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
