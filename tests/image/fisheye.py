# SPDX-License-Identifier: Apache-2.0
"""fisheye.py PARHELION -- frames of half the space: their directions and solid angles by closed
forms, their light by a luxmeter; cut, resumed and merged to the same bits; as Radiance
pictures; and `measure --glare` of them, also beside evalglare where it is installed."""
import json
import math
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile

from exr import Frame
from gltf import Scene

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

CASES = os.path.join(ROOT, "..", "shared", "data", "cases", "sky", "glare.csv")
KINDS = ("equidistant", "equisolid")


class Program:
    def __init__(self, path, folder):
        self.path, self.folder = path, folder

    def run(self, *words):
        return subprocess.run([self.path, *words], cwd=self.folder, capture_output=True,
                              text=True, check=False)

    def render(self, scene, out, *words):
        done = self.run("render", scene, "-o", out, "--quiet", *words)
        if done.returncode:
            raise SystemExit(f"render {scene} -o {out}: {done.stderr}")
        return done

    def glare(self, frame, *words):
        return json.loads(self.run("measure", frame, "--glare", "--json", *words).stdout)

    def file(self, name):
        return os.path.join(self.folder, name)

    def read(self, name):
        with open(self.file(name), "rb") as file:
            return file.read()


def angle_of(kind, radius):
    return radius * math.pi / 2 if kind == "equidistant" else 2 * math.asin(radius / 2 ** 0.5)


def direction(kind, size, x, y):
    """Of a place of the film: right, up, ahead; None outside of the circle."""
    u, v = 2 * x / size - 1, 1 - 2 * y / size
    radius = math.hypot(u, v)
    if radius > 1:
        return None
    a = angle_of(kind, radius)
    sine = math.sin(a) / radius if radius else 0
    return sine * u, sine * v, math.cos(a)


# ---- directions ------------------------------------------------------------------------------

def room():
    """A box about an eye at (1, 2, 3) that looks along -Z, whose sides are all alike."""
    scene = Scene()
    scene.box_inside(scene.lambert(0.5), (0, 1, 2), (2, 3, 4))
    scene.view("eye", (1, 2, 3), (0, 0, -1), 50)
    scene.environment(type="constant", luminance=1)
    return scene


def check_directions(report, program, kind):
    """The pixel's mean place on the box's walls, half a metre or more from their edges."""
    size = 48
    room().write(program.file("room.gltf"))
    program.render("room.gltf", "room.exr", "--projection", kind, "--size", f"{size}x{size}",
                   "--spp", "64", "--layers", "position,samples", "--max-bounces", "0")
    frame = Frame(program.file("room.exr"))
    worst = count = 0
    for y in range(size):
        for x in range(size):
            way = direction(kind, size, x + 0.5, y + 0.5)
            samples = frame.channels["samples.N"][y * size + x]
            near = math.hypot(max(abs(x + 0.5 - size / 2) - 0.5, 0),
                              max(abs(y + 0.5 - size / 2) - 0.5, 0))
            if abs(near - size / 2) > 1e-6:
                count += samples != (64 if near < size / 2 else 0)
            if not way or math.hypot(abs(x + 0.5 - size / 2) + 0.5,
                                     abs(y + 0.5 - size / 2) + 0.5) > size / 2:
                continue  # cut by the circle: its mean place is not its middle's
            place = [frame.channels[f"position.{c}"][y * size + x] - o
                     for c, o in zip("XYZ", (1, 2, 3))]
            most = max(abs(c) for c in way)
            if sorted(abs(c) / most for c in way)[1] > 0.5:
                continue
            wanted = [c / most for c in (way[0], way[1], -way[2])]
            worst = max(worst, *(abs(a - b) for a, b in zip(place, wanted)))
    report.claim(count == 0, f"{kind}: {count} pixels have samples where none are, or none")
    report.claim(worst < 0.02, f"{kind}: a pixel looks {worst:.3f} m off on a wall 1 m away")


# ---- light -----------------------------------------------------------------------------------

def lit_room():
    scene = room()
    scene.facing_quad(scene.lambert(0.5, 3000), (0.2, 2.2, 2.3), (1, 0, 0.5), 0.3)
    return scene


def check_lux(report, program):
    """Either projection and a luxmeter at the eye."""
    lit_room().write(program.file("lit.gltf"))
    words = ("--illuminance", "1,2,3,0,0,-1", "--samples", "65536", "--json")
    meter = json.loads(program.run("measure", "lit.gltf", *words).stdout)
    for kind in KINDS:
        program.render("lit.gltf", f"{kind}.exr", "--projection", kind, "--size", "64x64",
                       "--spp", "32", "--layers", "halves,variance")
        glare = program.glare(f"{kind}.exr")
        low, high = glare["vertical_illuminance_interval"]
        apart = glare["vertical_illuminance_lx"] - meter["illuminance_lx"]
        sigma = math.hypot(high - low, meter["illuminance_interval"][1] -
                           meter["illuminance_interval"][0]) / 3.92
        report.claim(abs(apart) < 3 * sigma + 1e-3 * meter["illuminance_lx"],
                     f"{kind}: {glare['vertical_illuminance_lx']} lx, the luxmeter has "
                     f"{meter['illuminance_lx']}")
        report.claim(abs(glare["solid_angle_sr"] / (2 * math.pi) - 1) < 1e-6 and
                     abs(glare["half_space_seen"] - 1) < 1e-6, f"{kind}: not half the space")


# ---- the same bits ---------------------------------------------------------------------------

def check_bits(report, program):
    words = ("--projection", "fisheye", "--size", "40x40", "--layers", "all")
    program.render("lit.gltf", "whole.exr", *words, "--spp", "4")
    parts = []
    for name, crop in (("a", "0,0,17,40"), ("b", "17,0,40,9"), ("c", "17,9,40,40")):
        for samples in ("0:1", "1:4"):
            parts.append(f"{name}{samples[0]}.exr")
            program.render("lit.gltf", parts[-1], *words, "--crop", crop, "--samples", samples)
    done = program.run("merge", *parts, "-o", "merged.exr", "--quiet", "--json")
    whole, merged = Frame(program.file("whole.exr")), Frame(program.file("merged.exr"))
    report.claim(done.returncode == 0 and all(
        whole.channels[n].tobytes() == merged.channels[n].tobytes() for n in whole.channels),
        f"parts of a fisheye make another frame: {done.stderr}")
    error = "parhelion:relativeError"
    report.claim(whole.attributes[error] == merged.attributes[error],
                 "parts of a fisheye have another relative error")
    corner = [whole.channels[n][0] for n in "RGB"] + [whole.channels["samples.N"][0]]
    report.claim(corner == [0, 0, 0, 0], f"the corner is not black: {corner}")
    done = program.run("merge", "a0.exr", "-o", "m.exr", "--quiet")
    program.render("lit.gltf", "p.exr", "--size", "40x40", "--layers", "all", "--crop",
                   "17,0,40,40", "--samples", "0:1")
    done = program.run("merge", "a0.exr", "p.exr", "-o", "m.exr")
    report.claim(done.returncode == 3 and "camera" in done.stderr,
                 f"a part of another projection is merged: {done.stderr}")


def check_error(report, program):
    """Black corners are no pixels without noise: the error is that of the circle."""
    program.render("lit.gltf", "e.exr", "--projection", "equisolid", "--size", "64x64", "--spp",
                   "8")
    program.render("lit.gltf", "i.exr", "--projection", "equisolid", "--size", "64x64", "--spp",
                   "8", "--crop", "10,10,54,54")
    e, i = (struct.unpack("<d", Frame(program.file(n)).attributes["parhelion:relativeError"])[0]
            for n in ("e.exr", "i.exr"))
    report.claim(0.8 < e / i < 1.25, f"the circle's relative error {e}, its inside's {i}")
    done = program.run("measure", "e.exr", "--json")
    answer = json.loads(done.stdout)
    seen = sum(1 for y in range(64) for x in range(64)
               if math.hypot(max(abs(x - 31.5) - 0.5, 0), max(abs(y - 31.5) - 0.5, 0)) < 32)
    report.claim(answer["pixels"] == seen and answer["luminance_min_cd_m2"] > 0,
                 f"measure takes {answer['pixels']} pixels, {seen} are in the circle")


def check_outside(report, program):
    """Nothing but corners outside the circle: one line says so, and no figure is no number."""
    words = ("lit.gltf", "--projection", "equisolid", "--size", "64x64", "--spp", "2")
    done = program.run("render", *words, "--crop", "0,0,4,4", "-o", "corner.exr")
    report.claim(done.returncode == 0 and "nan" not in done.stdout and
                 re.search("relative error +unknown", done.stdout) and
                 "all pixels rendered lie outside its circle" in done.stdout,
                 f"a corner alone: {done.stdout}")
    done = program.run("merge", "corner.exr", "-o", "merged.exr")
    report.claim(done.returncode == 3 or "nan" not in done.stdout, f"merge: {done.stdout}")
    program.render(*words[:1], "all.exr", *words[1:])
    for frame, region in (("corner.exr", ()), ("all.exr", ("--region", "61,61,64,64"))):
        done = program.run("measure", frame, *region)
        report.claim(done.returncode == 3 and done.stderr.endswith(
            "no pixel to measure: all lie outside the fisheye's circle\n"),
            f"measure {frame} {region}: {done.stderr}")


def check_no_frames(report, program):
    """What is neither kind of frame is told both, by whatever name."""
    for name in ("empty.hdr", "empty.exr"):
        with open(program.file(name), "wb"):
            pass
    for name in ("text.hdr", "text.exr", "text"):
        with open(program.file(name), "wb") as file:
            file.write(b"light")
    for name in ("empty.hdr", "empty.exr", "text.hdr", "text.exr", "text"):
        found = "is empty" if "empty" in name else "is neither by its first bytes"
        for command in (("measure", name), ("measure", name, "--glare"),
                        ("develop", name, "-o", "x.png")):
            done = program.run(*command)
            report.claim(done.returncode == 3 and done.stderr == (
                f"parhelion: {name}: {found}, required: an OpenEXR file or a Radiance picture "
                "(.hdr)\n"), f"{command}: {done.stderr}")


# ---- Radiance pictures -----------------------------------------------------------------------

def header_of(program, name):
    return program.read(name).split(b"\n\n")[0].decode().split("\n")


def check_pictures(report, program):
    program.render("lit.gltf", "r.hdr", "--projection", "fisheye", "--size", "64x64", "--spp",
                   "32")
    header = header_of(program, "r.hdr")
    view = next(line for line in header if line.startswith("VIEW="))
    for words in ("-vta ", "-vp 1 2 3 ", "-vd 0 0 -1 ", "-vu 0 1 0 ", "-vh 180 ", "-vv 180 "):
        report.claim(words in view, f"{view}: no {words}")
    report.claim("EXPOSURE= 1" in header and "FORMAT=32-bit_rle_rgbe" in header,
                 f"the header lacks a line: {header}")
    a, b = program.glare("equidistant.exr"), program.glare("r.hdr")
    for key, share in (("vertical_illuminance_lx", 2e-3), ("background_cd_m2", 2e-3)):
        report.claim(abs(a[key] / b[key] - 1) < share, f"{key}: {a[key]} in .exr, {b[key]}")
    report.claim(abs(a["ugr"] - b["ugr"]) < 0.05, f"UGR {a['ugr']} in .exr, {b['ugr']}")
    program.render("lit.gltf", "v.hdr", "--size", "90x60", "--spp", "1")
    view = next(line for line in header_of(program, "v.hdr") if line.startswith("VIEW="))
    wide = math.degrees(2 * math.atan(1.5 * math.tan(math.radians(25))))
    report.claim("-vtv " in view and f"-vh {wide:.4f}"[:-1] in view and "-vv 50" in view, view)
    refused = (("x.hdr", "--layers", "xyz"), ("x.hdr", "--samples", "0:1"),
               ("x.hdr", "--projection", "equisolid"), ("x.exr", "--projection", "fisheye",
                                                        "--size", "90x60"),
               ("x.exr", "--projection", "fisheye", "--eye", "0,0,0", "--look-at", "1,0,0",
                "--fov", "50"))
    for words in refused:
        done = program.run("render", "lit.gltf", "-o", *words)
        report.claim(done.returncode == 2 and len(done.stderr.strip().split("\n")) == 1 and
                     not os.path.exists(program.file(words[0])), f"{words}: {done.stderr}")
    os.mkdir(program.file("shut.hdr"))
    done = program.run("render", "lit.gltf", "-o", "shut.hdr", "--spp", "1", "--size", "8x8")
    report.claim(done.returncode == 4, f"a folder is written over: {done.stderr}")


def check_commands(report, program):
    """Pixels of a fisheye are the same in explain, --replay and the frame."""
    words = ("lit.gltf", "--projection", "equisolid", "--size", "40x40")
    program.render(*words[:1], "w.exr", *words[1:], "--spp", "128", "--layers", "xyz")
    frame = Frame(program.file("w.exr"))
    for x, y in ((9, 12), (5, 6)):  # the second is cut by the circle
        wanted = frame.channels["xyz.Y"][y * 40 + x]
        told = json.loads(program.run("explain", *words, "--pixel", f"{x},{y}", "--paths",
                                      "128", "--json").stdout)
        light = told["luminance_cd_m2"]["all"]
        report.claim(abs(light / wanted - 1) < 1e-5,
                     f"explain of {x},{y}: {light}, the frame has {wanted}")
    for command in (("explain", *words, "--pixel", "0,0"),
                    ("explain", *words, "--region", "0,0,1,1"),
                    ("render", *words, "--replay", "0,0,0")):
        done = program.run(*command)
        report.claim(done.returncode == 2 and "circle" in done.stderr,
                     f"{command[0]} of a corner: {done.stderr}")
    wanted = frame.channels["xyz.Y"][12 * 40 + 9]
    explained = json.loads(program.run("explain", *words, "--region", "9,12,10,13", "--paths",
                                       "4096", "--json").stdout)
    light = explained["luminance_cd_m2"]["all"]
    report.claim(abs(light / wanted - 1) < 0.2, f"explain: {light}, the frame has {wanted}")


# ---- glare -----------------------------------------------------------------------------------

def disc(scene, right, up, width, luminance, away=10, sides=128):
    a, e = math.radians(right), math.radians(up)
    middle = [math.cos(e) * math.sin(a), math.sin(e), -math.cos(e) * math.cos(a)]
    across = [math.cos(a), 0, math.sin(a)]
    over = [-math.sin(e) * math.sin(a), math.cos(e), math.sin(e) * math.cos(a)]
    radius = away * math.tan(math.radians(width / 2))
    rim = [[away * middle[i] + radius * (math.cos(t) * across[i] + math.sin(t) * over[i])
            for i in range(3)] for t in (2 * math.pi * k / sides for k in range(sides))]
    triangles = [(0, 1 + k, 1 + (k + 1) % sides) for k in range(sides)]
    material = scene.emitter(luminance)
    scene.document["materials"][material]["doubleSided"] = True
    scene.mesh(material, [[away * c for c in middle]] + rim, triangles)


def check_case(report, program, row, size):
    case, even, sources, lux, ugr, dgp = row
    scene = Scene()
    for source in sources.split(";"):
        disc(scene, *(float(word) for word in source.split()))
    scene.view("eye", (0, 0, 0), (0, 0, -1), 50)
    scene.environment(type="constant", luminance=float(even))
    scene.write(program.file("case.gltf"))
    words = ("--projection", "fisheye", "--size", f"{size}x{size}", "--spp", "4",
             "--max-bounces", "0", "--no-guiding")
    program.render("case.gltf", "case.exr", *words)
    glare = program.glare("case.exr")
    for key, wanted, most in (("ugr", ugr, 0.3), ("dgp", dgp, 0.005)):
        report.claim(abs(glare[key] - float(wanted)) < most,
                     f"case {case}: {key} {glare[key]}, {wanted}")
    report.claim(abs(glare["vertical_illuminance_lx"] / float(lux) - 1) < 0.005,
                 f"case {case}: {glare['vertical_illuminance_lx']} lx, {lux}")
    report.claim(glare["source_count"] == len(sources.split(";")),
                 f"case {case}: {glare['source_count']} sources")
    return words


def check_evalglare(report, program, words):
    """Its means over all pixels of a source are not ours over its core."""
    tool = shutil.which("evalglare")
    if not tool:
        report.skip("evalglare is not installed")
        return
    program.render("case.gltf", "case.hdr", *words)
    ours = program.glare("case.hdr")
    done = subprocess.run([tool, "-b", "2000", "-d", program.file("case.hdr")],
                          capture_output=True, text=True, check=False)
    names, values = done.stdout.strip().split("\n")[-1].split(":")
    theirs = dict(zip(names.split(","), (float(value) for value in values.split())))
    report.claim(abs(theirs["E_v"] / ours["vertical_illuminance_lx"] - 1) < 2e-3,
                 f"evalglare has {theirs['E_v']} lx, ours {ours['vertical_illuminance_lx']}")
    report.claim(abs(theirs["ugr"] - ours["ugr"]) < 0.4,
                 f"evalglare has UGR {theirs['ugr']}, ours {ours['ugr']}")
    report.claim(abs(theirs["dgi"] - ours["dgi"]) < 0.4,
                 f"evalglare has DGI {theirs['dgi']}, ours {ours['dgi']}")


def check_glare(report, program):
    done = program.run("measure", "v.hdr", "--glare")
    report.claim(done.returncode == 3 and "--vertical-lux" in done.stderr,
                 f"a frame of 50 degrees: {done.stderr}")
    answer = program.glare("v.hdr", "--vertical-lux", "500")
    report.claim(answer["vertical_illuminance_lx"] == 500, f"{answer}")
    for words in (("--threshold", "10"), ("--glare", "--region", "0,0,1,1"),
                  ("--glare", "--task-deg", "20"), ("--no-low-light",)):
        done = program.run("measure", "r.hdr", *words)
        report.claim(done.returncode == 2, f"{words}: status {done.returncode}")
    if not os.path.exists(CASES):
        report.skip("sources in an even field: no ../shared/data/cases/sky")
        return
    with open(CASES, encoding="utf-8") as file:
        rows = {line.split(",")[0]: line.strip().split(",") for line in file}
    check_case(report, program, rows["2"], 640)
    words = check_case(report, program, rows["0"], 512)
    check_evalglare(report, program, words)


def main():
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        program = Program(os.path.realpath(sys.argv[1]), folder)
        for kind in KINDS:
            check_directions(report, program, kind)
        check_lux(report, program)
        check_bits(report, program)
        check_error(report, program)
        check_outside(report, program)
        check_no_frames(report, program)
        check_pictures(report, program)
        check_commands(report, program)
        check_glare(report, program)
    report.finish()


main()
