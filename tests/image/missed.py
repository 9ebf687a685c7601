# SPDX-License-Identifier: Apache-2.0
"""missed.py PARHELION -- light that no connection makes is named before it is missed: a lamp by
two mirrors, a small emitter by two, the sun and a lamp through a solid sphere and a wedge.

`check` and `render` name lamp, mirror and solid; how much of it there is agrees with the closed
form, where there is one. A frame of a fixed number of samples says so in its answer and in its
metadata, `measure` of it again, whatever its error is, and so does a merged one.
The same words for any number of threads. Light that paths connect, and light that is too little
to matter, need no word.
"""
import json
import math
import os
import subprocess
import sys
import tempfile

from exr import Frame
from gltf import Scene

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

PATCH, ALBEDO = [0, 1, 0], 0.5      # what the camera sees, and its reflectance
CANDELA, RHO = 1000, 0.9
LUMINANCE, EDGE = 1e6, 0.02         # of the emitter; m
SUN = ["--environment", "constant:0.0001", "--sun", "90,0.5,80000", "--heading", "0",
       "--forward", "0,0,-1"]
WITHIN = 0.03                       # of a closed form: some thousand rays


def name(scene, text):
    scene.document["nodes"][-1]["name"] = text


def patch_scene():
    """Faces +X; a camera sees 8 cm of it, aslant 16."""
    scene = Scene()
    scene.facing_quad(scene.lambert(ALBEDO), PATCH, [1, 0, 0], 0.3)
    eye = [0.6, 1, 1]
    scene.view("eye", eye, [p - e for p, e in zip(PATCH, eye)], 4)
    return scene


def two_mirrors(is_emitter=False):
    """A periscope: the lamp stands behind the patch's plane, its image by both 3.1 m off."""
    scene = patch_scene()
    if is_emitter:
        scene.facing_quad(scene.emitter(LUMINANCE), [-0.1, 0, 0], [1, 0, 0], EDGE)
        name(scene, "led")
    else:
        scene.light("point", CANDELA, [-0.1, 0, 0])
        name(scene, "headlamp")
    metal = scene.metal(RHO)
    scene.facing_quad(metal, [1, 0, 0], [-1, 1, 0], 0.3)
    name(scene, "low")
    scene.facing_quad(metal, [1, 1, 0], [-1, -1, 0], 0.4)
    name(scene, "high")
    candela = LUMINANCE * EDGE ** 2 if is_emitter else CANDELA
    return scene, candela * RHO ** 2 / 3.1 ** 2


def emitter_by_mirror():
    scene = patch_scene()
    scene.facing_quad(scene.emitter(LUMINANCE), [-0.1, 0, 0], [1, 0, 0], EDGE)
    name(scene, "led")
    scene.facing_quad(scene.metal(RHO), [1, 0.5, 0], [-1, 0, 0], 0.5)
    name(scene, "low")
    return scene


def wedge(scene, glass):
    """Before the patch, its far face turned by ten degrees."""
    lean = 0.2 * math.tan(math.radians(10))
    x0, x1, y0, y1, z = 0.4, 0.44, 0.8, 1.2, 0.2
    points = [[x0, y0, -z], [x0, y1, -z], [x0, y0, z], [x0, y1, z],
              [x1, y0, -z], [x1 + 2 * lean, y1, -z], [x1, y0, z], [x1 + 2 * lean, y1, z]]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    corners = [points[i] for face in faces for i in face]
    triangles = [t for f in range(6) for t in ([4 * f, 4 * f + 1, 4 * f + 2],
                                               [4 * f, 4 * f + 2, 4 * f + 3])]
    scene.mesh(glass, corners, triangles, node={"name": "wedge"})


def through(solid, lamp):
    """The solid stands before the patch; the camera looks in beside it."""
    scene = patch_scene()
    glass = scene.glass(1.5)
    if solid == "sphere":
        scene.sphere(glass, [0.4, 1, 0], 0.15)
        name(scene, "sphere")
    else:
        wedge(scene, glass)
    if lamp:
        scene.light("point", CANDELA, [1.2, 1, 0])
        name(scene, "headlamp")
    return scene


class Program:
    def __init__(self, program, folder, report):
        self.program, self.folder, self.report = program, folder, report

    def run(self, *line):
        return subprocess.run([self.program, *line, "--quiet"], cwd=self.folder,
                              capture_output=True, text=True, check=False)

    def json(self, *line):
        done = self.run(*line, "--json")
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)

    def render(self, out, *options):
        return self.json("render", "s.gltf", "-o", out, "--size", "16x16", *options)

    def write(self, scene):
        scene.write(os.path.join(self.folder, "s.gltf"))


def attribute(path, key):
    value = Frame(path).attributes.get(key)
    return None if value is None else value.decode().rstrip("\0")


def check_words(program, what, words):
    """One sentence, wherever the frame is read."""
    report, sentence = program.report, words["words"]
    frame = os.path.join(program.folder, "a.exr")
    report.claim(attribute(frame, "parhelion:mayMiss") == sentence, f"{what}: the frame's")
    report.claim(program.json("measure", "a.exr")["may_miss"] == sentence, f"{what}: measure")
    said = program.run("measure", "a.exr").stdout
    report.claim(["may", "miss", "light", *sentence.split()] in
                 [line.split() for line in said.splitlines()], f"{what}: measure says {said}")


def check_case(program, what, scene, wanted, lux=None, light=()):
    """wanted: light, its name, "mirror" or "solid", the part, the next one, is it lost?"""
    report = program.report
    program.write(scene)
    told = program.render("a.exr", "--spp", "16", *light)
    missed = told["may_miss"]
    report.claim(missed is not None, f"{what}: no word")
    if missed is None:
        return
    pair = missed["lights"][0]
    found = tuple(pair[key] for key in ("light", "name", "by", "part", "then", "is_lost"))
    report.claim(found == wanted, f"{what}: {found}, wanted {wanted}")
    report.claim(0 < pair["share"] <= missed["share"] <= 1, f"{what}: shares {missed}")
    warned = [x["message"] for x in told["warnings"] if wanted[3] in x["message"]]
    report.claim(bool(warned), f"{what}: no warning names {wanted[3]}")
    if lux:
        truth = lux * ALBEDO / math.pi
        report.claim(abs(pair["cd_m2"] / truth - 1) < WITHIN,
                     f"{what}: {pair['cd_m2']} cd/m2, {truth} is right")
    check_words(program, what, missed)
    line = program.run("render", "s.gltf", "-o", "b.exr", "--size", "16x16", "--spp", "1",
                       "--threads", "3", *light).stdout
    report.claim(["may", "miss", "light", *missed["words"].split()] in
                 [words.split() for words in line.splitlines()], f"{what}: three threads: {line}")


def check_checked(program, what, scene, part, light):
    program.write(scene)
    told = program.json("check", "s.gltf")
    found = [pair["part"] for pair in told["missed_light"]]
    program.report.claim(part in found, f"{what}: check names {found}")
    said = program.run("check", "s.gltf").stdout
    program.report.claim(f"{light} shines" in said and f"\"{part}\"" in said,
                         f"{what}: check says {said}")


def check_silence(program, what, scene, light=()):
    program.write(scene)
    told = program.render("a.exr", "--spp", "4", *light)
    program.report.claim(told["may_miss"] is None, f"{what}: {told['may_miss']}")
    program.report.claim(program.json("measure", "a.exr")["may_miss"] is None,
                         f"{what}: measure says something")


def check_merged(program):
    """Parts and what is merged of them say the same; a layer of zeros is no reason to forget."""
    scene = two_mirrors()[0]
    program.write(scene)
    for i in (1, 2):
        program.run("render", "s.gltf", "-o", f"p{i}.exr", "--size", "16x16", "--spp", "4",
                    "--part", f"{i}/2")
    done = program.run("merge", "p1.exr", "p2.exr", "-o", "m.exr")
    part, merged = (attribute(os.path.join(program.folder, x), "parhelion:mayMiss")
                    for x in ("p1.exr", "m.exr"))
    program.report.claim(done.returncode == 0 and part and part == merged,
                         f"merged: {merged}, a part: {part} {done.stderr}")


def main():
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        program = Program(os.path.abspath(sys.argv[1]), folder, report)
        scene, lux = two_mirrors()
        check_case(program, "two mirrors", scene,
                   ("lamp", "headlamp", "mirror", "low", "high", True), lux)
        check_checked(program, "two mirrors", scene, "low", 'lamp "headlamp"')
        scene, lux = two_mirrors(is_emitter=True)
        check_case(program, "an emitter by two mirrors", scene,
                   ("emitter", "led", "mirror", "low", "high", False), lux)
        check_checked(program, "an emitter by two mirrors", scene, "low", 'emitter "led"')
        check_silence(program, "a small emitter by one mirror", emitter_by_mirror())
        for solid in ("sphere", "wedge"):
            check_case(program, f"a lamp through a {solid}", through(solid, True),
                       ("lamp", "headlamp", "solid", solid, None, True))
            check_case(program, f"the sun through a {solid}", through(solid, False),
                       ("sun", "", "solid", solid, None, False),
                       light=SUN)
        check_merged(program)
        lit = patch_scene()
        lit.light("point", CANDELA, [1.2, 1, 0])
        check_silence(program, "a lamp alone", lit)
        lit.facing_quad(lit.window(1.5), [0.6, 1, 0], [1, 0, 0], 0.4)
        check_silence(program, "a lamp behind a pane", lit)
        dim = two_mirrors()[0]
        dim.light("point", 300 * CANDELA, [1.2, 2, 0])
        check_silence(program, "two mirrors beside a bright lamp", dim)
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
