# SPDX-License-Identifier: Apache-2.0
"""states.py PARHELION -- what a file can be: a frame of a variant, or of a time, has the bits
of the same scene with that material, or that place, put in by hand; and the command lines that
ask for one are told what is wrong with them.
"""
import copy
import os
import subprocess
import sys
import tempfile

from bits import digest, render
from gltf import Scene

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

OPTIONS = ["--size", "32x24", "--spp", "4"]
VARIANTS = "KHR_materials_variants"


def build():
    """A room with a ball that wears silver, or brass as "warm", and slides by 1 m in 2 s."""
    scene = Scene()
    scene.box_inside(scene.lambert(0.7), [-2, 0, -2], [2, 2.5, 2])
    scene.facing_quad(scene.emitter(500), [0, 2.49, 0], [0, -1, 0], 0.8)
    silver = scene.metal(0.9, 0.2)
    brass = scene.material("brass", pbrMetallicRoughness={
        "baseColorFactor": [0.9, 0.7, 0.3, 1], "metallicFactor": 1, "roughnessFactor": 0.3})
    scene.sphere(silver, [0, 0.6, -0.8], 0.5, rings=8)
    scene.view("eye", [0, 1.2, 1.9], [0, -0.1, -1], 60)
    times = scene._accessor([0.0, 2.0], "SCALAR", 5126, "f", {"min": [0], "max": [2]})
    places = scene._accessor([[0, 0, 0], [1, 0, 0]], "VEC3", 5126, "f")
    document = scene.document
    ball = len(document["meshes"]) - 1
    node = [n.get("mesh") for n in document["nodes"]].index(ball)
    document["meshes"][ball]["primitives"][0]["extensions"] = {
        VARIANTS: {"mappings": [{"variants": [1], "material": brass}]}}
    document["extensions"] = {VARIANTS: {"variants": [{"name": "cold"}, {"name": "warm"}]}}
    document["animations"] = [{"name": "slide", "samplers": [
        {"input": times, "output": places}], "channels": [
            {"sampler": 0, "target": {"node": node, "path": "translation"}}]}]
    scene.used.add(VARIANTS)
    return scene, ball, node, brass


def by_hand(scene, ball, node, material=None, place=None):
    """The same scene without variants and animations."""
    plain = copy.deepcopy(scene)
    document = plain.document
    primitive = document["meshes"][ball]["primitives"][0]
    del primitive["extensions"], document["extensions"], document["animations"]
    plain.used.discard(VARIANTS)
    if material is not None:
        primitive["material"] = material
    if place:
        document["nodes"][node]["translation"] = place
    return plain


def check_frames(report, program, folder):
    scene, ball, node, brass = build()
    whole, hand = (os.path.join(folder, name) for name in ("whole.gltf", "hand.gltf"))
    scene.write(whole)
    cases = (([], {}), (["--variant", "warm"], {"material": brass}),
             (["--variant", "cold"], {}), (["--time", "0.5"], {"place": [0.25, 0, 0]}),
             (["--time", "0"], {}),
             (["--time", "9", "--animation", "slide", "--variant", "warm"],
              {"material": brass, "place": [1, 0, 0]}))
    sums = []
    for chosen, put in cases:
        by_hand(scene, ball, node, **put).write(hand)
        frames = [render(program, [path], os.path.join(folder, "frame.exr"), OPTIONS + more)
                  for path, more in ((whole, chosen), (hand, []))]
        if report.claim(None not in frames, f"{chosen}: not rendered"):
            sums.append(digest(frames[0], None))
            report.claim(sums[-1] == digest(frames[1], None),
                         f"{chosen}: other bits than the scene by hand")
    report.claim(len(set(sums)) == 4, "variants and times that differ give the same frame")
    return whole


COMMANDS = (
    (["--variant", "wurm"], 3, "did you mean warm? There are cold, warm"),
    (["--variant", "warm", "--variant", "cold"], 3, "chooses \"cold\" and \"warm\""),
    (["--animation", "slide"], 2, "--animation slide: at which --time?"),
    (["--time", "1", "--animation", "side"], 3, "did you mean slide? There are slide"),
    (["--time", "-1"], 2, "--time"),
    (["--time", "soon"], 2, "--time"),
)


def check_commands(report, program, scene):
    frame = os.path.join(os.path.dirname(scene), "frame.exr")
    wheres = (["check"], ["render", "-o", frame],
              ["explain", "--pixel", "3,3", "--size", "8x8"])
    for where in wheres:
        for words, status, text in COMMANDS:
            done = subprocess.run([program, *where, scene, *words], capture_output=True,
                                  text=True)
            said = done.stdout + done.stderr
            report.claim(done.returncode == status and text in said,
                         f"{where[0]} {words}: status {done.returncode}: {said.strip()}")
    done = subprocess.run([program, "check", scene, "--variant", "warm", "--time", "1"],
                          capture_output=True, text=True)
    lines = [line.split() for line in done.stdout.splitlines()]
    for words in (["variants", "cold,", "warm"], ["animation", "ends", "at,", "s"], ["slide", "2"]):
        report.claim(done.returncode == 0 and words in lines, f"no {words} in {lines}")


def main():
    report, program = Report(), os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        check_commands(report, program, check_frames(report, program, folder))
    report.finish()


if __name__ == "__main__":
    main()
