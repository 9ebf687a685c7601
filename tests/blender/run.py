# SPDX-License-Identifier: Apache-2.0
"""run.py PARHELION -- the Blender add-on, in a Blender without windows: what it marks is
written, checks without a fault and renders as its panel emits; what is lost or broken is told
by name.

Skipped where blender is not installed. glTF-Validator is asked too where node finds it.
"""
import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
for folder in ("structure", "image"):
    sys.path.insert(0, os.path.join(ROOT, "tests", folder))
from exr import Frame  # noqa: E402
from gltf import png  # noqa: E402
from report import Report  # noqa: E402

ADDON = os.path.join(ROOT, "scenes", "blender", "parhelion_addon.py")
GUIDE = os.path.join(ROOT, "assets", "guides", "first-dashboard.md")
PANEL = os.path.join(ROOT, "assets", "panels", "oled_centre.panel")
# Left above, right above, left below, right below: what the display shows.
CODES = ((255, 0, 0), (0, 160, 0), (0, 0, 255), (200, 200, 200))
LEVEL = 0.5
LUMINANCE = {"R": 0.2126390, "G": 0.7151687, "B": 0.0721923}
VALIDATE = """const path = process.argv[1], fs = require('fs'), folder = require('path');
require('gltf-validator').validateBytes(new Uint8Array(fs.readFileSync(path)), {
    externalResourceFunction: uri => Promise.resolve(new Uint8Array(fs.readFileSync(
        folder.resolve(folder.dirname(path), decodeURIComponent(uri)))))
}).then(answer => console.log(JSON.stringify(answer.issues)));"""


def prepare(folder, program):
    for name in ("bin", "panels", "pictures", "scripts/addons"):
        os.makedirs(os.path.join(folder, name))
    for name in ("assets/panels", "assets/content"):  # copies: links lead out of the folder
        shutil.copytree(os.path.join(ROOT, name), os.path.join(folder, name))
    os.symlink(program, os.path.join(folder, "bin", "parhelion"))
    shutil.copy(PANEL, os.path.join(folder, "panels", "oled.panel"))
    shutil.copy(ADDON, os.path.join(folder, "scripts", "addons"))
    rows = [[c for k in (0, 1) for _ in range(8) for c in CODES[2 * half + k]]
            for half in (0, 1) for _ in range(4)]
    with open(os.path.join(folder, "pictures", "codes.png"), "wb") as file:
        file.write(png(16, 8, rows))


def surroundings(folder):
    """Debian's Blender finds the Python that it was built with, and numpy, by PATH."""
    places = [os.path.join(folder, "bin"), "/usr/bin", "/bin", os.environ["PATH"]]
    return {**os.environ, "PATH": os.pathsep.join(places),
            "BLENDER_USER_SCRIPTS": os.path.join(folder, "scripts"),
            "BLENDER_USER_CONFIG": os.path.join(folder, "config")}


def in_blender(folder, program):
    """What marked_scene.py found; its output where it ended early."""
    done = subprocess.run(
        ["blender", "-b", "--factory-startup", "--python-exit-code", "1", "--python",
         os.path.join(HERE, "marked_scene.py"), "--", folder, program], timeout=900,
        capture_output=True, text=True, env=surroundings(folder))
    try:
        with open(os.path.join(folder, "found.json"), encoding="utf-8") as file:
            return json.load(file)
    except OSError:
        return (done.stdout + done.stderr)[-3000:]


def answer(program, *arguments):
    done = subprocess.run([program, *arguments, "--json"], capture_output=True, text=True)
    return json.loads(done.stdout)


def read(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)


# ---- what is claimed -----------------------------------------------------------------------


def check_file(report, program, path):
    """The whole scene as it was written, and what `check` says of it."""
    document = read(path)
    materials = {m["name"]: m.get("extensions", {}) for m in document["materials"]}
    ours = {name for own in materials.values() for name in own if "PARHELION" in name}
    used = set(document["extensionsUsed"])
    report.claim(ours == {"PARHELION_display", "PARHELION_glazing", "PARHELION_coating"}
                 and ours | {"PARHELION_environment"} <= used, f"{ours} of {used}")
    report.claim(not [name for name in document.get("extensionsRequired", [])
                      if "PARHELION" in name], "extensionsRequired names ours")
    display = materials["cluster"]["PARHELION_display"]
    content = display.pop("content")
    image = document["images"][document["textures"][content["index"]]["source"]]
    report.claim(display == {"panel": "../panels/oled.panel", "level": LEVEL}
                 and image["uri"] == "../pictures/codes.png", f"{display} {image}")
    glazing = materials["windscreen"]["PARHELION_glazing"]
    report.claim(len(glazing["layers"]) == 3 and glazing["layers"][1] == {
        "thickness_m": 0.00076, "ior": 1.485, "transmission": 1, "wedge_rad": 0.0003,
        "wedge_toward": "+v"} and glazing["haze"] == {"share": 0.01, "width_deg": 8}
        and glazing["coating_inside"] == {"stack": "mgf2"}, f"{glazing}")
    coating = materials["cover"]["PARHELION_coating"]
    report.claim(coating == {"layers": [{"thickness_nm": 99.6, "n": 1.38, "k": 0}]},
                 f"{coating}")
    sky = document["scenes"][0]["extensions"]["PARHELION_environment"]
    report.claim(sky == {"type": "sky", "when": "2026-06-21T08:30+02:00", "turbidity": 2.5,
                         "where": [47.5, -8.25, 500], "heading_deg": 90, "forward": [0, 0, 1]},
                 f"{sky}")
    for scene in (path, path.replace(".gltf", ".glb")):
        said = answer(program, "check", scene)
        errors = [p for p in said["problems"] if p["severity"] == "error"]
        report.claim(said["ok"] and not errors, f"check {scene}: {errors}")
        report.claim([c["node"] for c in said["cameras"]] == ["driver"]
                     and len(said["displays"]) == 1, f"check: {said['cameras']}")


def check_emission(report, program, path):
    """Each quarter of the display against `panel eval`, straight ahead."""
    frame = Frame(path)
    report.claim((frame.width, frame.height) == (80, 40), f"{frame.width}x{frame.height}")
    # The eye sees 2 tan(1 deg) 2 m = 69.8 mm of the height: of the display's 100 mm the middle.
    for place, rgb in enumerate(CODES):
        x, y = 40 * (place % 2) + 10, 20 * (place // 2) + 5
        region = (x, y, x + 20, y + 10)
        seen = sum(share * frame.mean(name, region) for name, share in LUMINANCE.items())
        told = answer(program, "panel", "eval", PANEL, "--theta", "0", "--rgb",
                      ",".join(map(str, rgb)))["luminance_cd_m2"]
        print(f"codes {rgb}: {seen:.3f} cd/m2, the panel {LEVEL * told:.3f}")
        report.claim(abs(seen - LEVEL * told) < 0.005 * LEVEL * told + 0.001,
                     f"codes {rgb} show {seen:.4f} cd/m2, {LEVEL * told:.4f} are the panel's")


def check_lost(report, found):
    report.claim(found["lost"] == found["lost_glb"] == found["lines"]["none"] == []
                 and found["operator"][1] == "", f"whole, but: {found['lost']}")
    for what in ("extension", "level", "content", "material", "listed", "coordinates"):
        report.claim(any('material "cluster"' in line for line in found["lines"][what]),
                     f"{what} is gone and nothing says so: {found['lines'][what]}")
    report.claim(found["lines"]["environment"] == ["scene: PARHELION_environment was lost"]
                 and found["lines"]["eye"] == ['eye "driver" was lost'], f"{found['lines']}")
    line = 'material "cluster": PARHELION_display was lost'
    report.claim(found["thief"] == [line], f"taken by an add-on: {found['thief']}")
    report.claim("Parhelion: " + line in found["thief_menu"][0], "the same, from the menu: "
                 + found["thief_menu"][0][-300:])
    report.claim("was lost" not in found["menu"][0] and not found["menu"][1],
                 f"the menu's export: {found['menu']}")


def check_broken(report, found, folder):
    for name, words in (("missing", "No such file"), ("empty", "has no panel"),
                        ("other", "is no file of that kind")):
        for way in ("", "_menu"):
            error = found[f"broken_{name}{way}"]
            report.claim('material "cluster"' in error and words in error,
                         f"a panel {name}{way}: {error}")
        report.claim("Traceback" not in found[f"broken_{name}"],
                     f"a panel {name}: {found[f'broken_{name}']}")
    left = os.path.join(folder, "broken")
    report.claim(not os.path.exists(left) or not os.listdir(left),
                 "an aborted export left a file")


def check_extras(report, program, folder):
    for name, kind in (("object", dict), ("text", str)):
        path = os.path.join(folder, "extras", name + ".gltf")
        extras = {m["name"]: m.get("extras", {}) for m in read(path)["materials"]}
        report.claim(isinstance(extras["cluster"].get("PARHELION_display"), kind),
                     f"{name}: {extras}")
        said = answer(program, "check", path)
        report.claim(said["ok"] and [d["name"] for d in said["displays"]] == ["cluster"]
                     and "PARHELION_display" in said["extensions"],
                     f"extras as {name}: {said['problems']}")


# Of square, rectangle (scaled by 2 and 3), circle and ellipse, each a polygon of 32 corners.
LAMP_AREAS_M2 = (0.25, 0.5 * 0.25 * 6, 16 * math.sin(math.tau / 32) * 0.25 ** 2,
                 16 * math.sin(math.tau / 32) * 0.25 * 0.125)


def check_lamps(report, program, found, folder):
    """An area lamp of 10 W is a sheet of 683 * 10 / (4 area) cd/m2, which looks as it did."""
    path = os.path.join(folder, "out", "lamps.gltf")
    document, said = read(path), answer(program, "check", path)
    strengths = [m["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"]
                 for m in document["materials"] if "(area lamp)" in m["name"]]
    wanted = [683 * 10 / (4 * area) for area in LAMP_AREAS_M2]
    report.claim(len(strengths) == 4 and all(abs(s / w - 1) < 1e-5 for s, w in
                                             zip(strengths, wanted)), f"{strengths} {wanted}")
    told = [p["message"] for p in said["problems"] if "area lamp" in p["message"].lower()]
    report.claim(said["ok"] and not told, f"check of area lamps: {told}")
    report.claim(found["left"] == [0, 0, 0], f"left over in Blender: {found['left']}")
    report.claim('area lamp "Area.003": its spread is 57.2958 degrees' in found["lamps"][1][1]
                 and not os.path.exists(os.path.join(folder, "out", "no.gltf")),
                 f"a narrow lamp: {found['lamps'][1]}")


def check_program(report, found):
    report.claim(found["render"][1] == "" and found["picture"] == [[80, 40]],
                 f"render: {found['render']}, {found['picture']}")
    report.claim("yesterday" in found["refused"][1] and "a time like" in found["refused"][1],
                 f"what the program refuses is shown as it is: {found['refused'][1]}")
    report.claim("no_program is not there" in found["no_program"][1],
                 f"no program: {found['no_program'][1]}")
    report.claim(found["was_at_work"] and found["progress"] > 0 and found["stopped"] != 0,
                 f"cancelled: {found['progress']}, status {found['stopped']}")


def check_guide(report, folder):
    """The guide's script and the commands about what it writes, as they stand there."""
    page = open(GUIDE, encoding="utf-8").read()
    blocks = re.findall(r"^```(\w*)\n(.*?)^```$", page, re.M | re.S)
    script, = [text for kind, text in blocks if kind == "python"]
    with open(os.path.join(folder, "dashboard.py"), "w", encoding="utf-8") as file:
        file.write(script)
    commands = "".join(text for kind, text in blocks if not kind).splitlines()
    report.claim(len(commands) >= 4, f"the guide has only {commands}")
    for command in commands:
        command = command.replace("blender -b ", "blender -b --python-exit-code 1 ")
        done = subprocess.run(["sh", "-c", command], cwd=folder, capture_output=True, text=True,
                              env=surroundings(folder), timeout=600)
        report.claim(done.returncode == 0, f"{command}: status {done.returncode}: "
                     f"{(done.stdout + done.stderr)[-1500:]}")
    kept = os.environ.get("KEEP_PICTURE")
    if kept:
        shutil.copy(os.path.join(folder, "dashboard", "scene.png"), kept)


def validate(report, path):
    done = subprocess.run(["node", "-e", VALIDATE, path], capture_output=True, text=True)
    issues = json.loads(done.stdout)
    errors = [m for m in issues["messages"] if m["severity"] == 0]
    report.claim(issues["numErrors"] == 0, f"glTF-Validator: {errors}")
    print(f"glTF-Validator: {issues['numErrors']} errors, {issues['numWarnings']} warnings")


def main():
    report, program = Report(), os.path.abspath(sys.argv[1])
    if not shutil.which("blender"):
        report.skip("the add-on: blender is not installed")
        report.finish()
    with tempfile.TemporaryDirectory(prefix="blender-") as folder:
        folder = os.path.realpath(folder)
        prepare(folder, program)
        found = in_blender(folder, program)
        if report.claim(isinstance(found, dict), f"Blender ended early: {found}"):
            print("Blender", ".".join(map(str, found["version"])))
            whole = os.path.join(folder, "whole", "scene.gltf")
            check_file(report, program, whole)
            check_lost(report, found)
            check_broken(report, found, folder)
            check_extras(report, program, folder)
            check_program(report, found)
            check_lamps(report, program, found, folder)
            check_emission(report, program, os.path.join(folder, "render", "scene.exr"))
            check_guide(report, folder)
            node = shutil.which("node")
            if node and not subprocess.run([node, "-e", "require('gltf-validator')"],
                                           capture_output=True).returncode:
                validate(report, whole)
            else:
                report.skip("glTF-Validator: node does not find gltf-validator")
    report.finish()


if __name__ == "__main__":
    main()
