# SPDX-License-Identifier: Apache-2.0
"""answers.py PARHELION -- what `help --json` says of a command's answer is what is in answers.

Every path of a real answer is a column's, or below one; every column is in a real answer. So the
page that the build makes of the columns (assets/install/pages.py) is right.
"""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

from gltf import Scene, radiance_picture
from lamps import ies
from missed import two_mirrors

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

PANELS = "assets/panels/"
IPS = PANELS + "ips_cluster.panel"
CAR = ("scenes/car_dashboard.gltf", "scenes/noon.gltf")
GLANCE, SKY = "scenes/glance.review.json", ("--environment", "constant:9")
WHEN = ("--when", "2026-06-21T12:00+02:00", "--where", "48.14,11.58,520")
EPW = ("LOCATION,T,-,D,D,0,48.14,11.58,1.0,520\nDATA PERIODS,1,1,Data,Sunday, 1/ 1,12/31\n"
       "2026,6,21,10,60,x,20,8,79,100100,0,1415,288,0,600,150,0,0,0,0\n")
TOWARDS, FROM, GRID = ("--theta", "30"), ("--incidence", "20"), "0:60:30,0:90:90"
SMALL = (*CAR, "--size", "48x27", "--spp", "16")
RENDERED = ("render", *CAR, "--camera", "driver-eye", "--projection", "fisheye", "--size", "64x64",
            "--layers", "display,halves,light", "--spp", "24", "--quiet", "-o", "FOLDER/frame.exr")

# (command, the options that its answer is of, what else is typed; FOLDER: of this test)
RUNS = (
    ("panel import", "", ("FOLDER/set/brdf/i10.csv", "-o", "FOLDER/again/M.json")),
    ("panel fit", "", ("FOLDER/set/MANIFEST.json", "-o", "FOLDER/odd.panel", "--force")),
    *(("panel info", "", (path,)) for path in (IPS, PANELS + "zoned_centre.panel")),
    ("panel info", "--levels", (IPS,)),
    ("panel report", "", (IPS, "--ambient", "300")),
    ("panel plot", "", (IPS, "-o", "FOLDER/map.svg", "--kind", "contrast", "--level", "3")),
    ("panel show", "", (IPS, "--content", "assets/content/cluster.png", "--png", "FOLDER/show.png",
                        "--size", "32x12", "--spp", "1", "--directed", "9,30,0")),
    ("panel eval", "", (IPS, *TOWARDS, "--rgb", "9,9,9", "--at", "0,0", "--level", "3")),
    ("panel eval", "--brdf", (IPS, *TOWARDS, *FROM, "--at", "0,0", "--level", "3")),
    ("panel eval", "--grid", (GRID, IPS, "--rgb", "9,9,9", "--level", "3")),
    ("panel eval", "--brdf --grid", (GRID, IPS, *FROM, "--level", "3")),
    ("sky", "", ("--environment", "perez:800,100", *WHEN, "-o", "FOLDER/sky.exr", "--size", "8x4")),
    ("sky", "", ("--weather", "FOLDER/day.epw", "--when", "2026-06-21T09:30+01:00",
                 "--weather-offset", "-0.5")),
    ("sky", "", ("scenes/cloud_noon.gltf",)),
    *(("check", "", (scene, "--materials")) for scene in (CAR[0], CAR[1], "scenes/night.gltf")),
    ("check", "", ("FOLDER/odd.gltf", "--light", "lamp=FOLDER/lamp.ies")),
    ("measure", "", ("FOLDER/frame.exr", "--display", "cluster")),
    ("measure", "", ("FOLDER/two.hdr", "--region", "0,0,64,64")),
    ("measure", "--glare", ("FOLDER/frame.exr",)),
    ("measure", "--illuminance", ("0.1,0,1,0,0,-1", "FOLDER/odd.gltf", *SKY, "--samples",
                                  "64")),
    ("compare", "", ("FOLDER/frame.exr", "FOLDER/r/frame.exr")),
    ("compare", "FOLDER FOLDER", ("FOLDER/r", "FOLDER/r")),
    ("explain", "", ("FOLDER/whole.review.json", "--condition", "night", "--paths", "1024",
                     "--root", "/")),
    ("explain", "", (*CAR, "--display", "cluster", "--paths", "1024")),
    ("explain", "", ("FOLDER/odd.gltf", *SKY, "--pixel", "4,4", "--size", "8x8", "--paths", "128")),
    ("review", "--dry-run", (GLANCE,)),
    ("equip", "", ("FOLDER/odd.gltf", "-o", "FOLDER/odd.html")),
    ("render", "", (*SMALL, "--noise", "display:0.5", "--layers", "all", "-o", "FOLDER/all.exr",
                    "--png", "FOLDER/a.png", "--denoise")),
    ("render", "", (*SMALL, "--for", "display", "-o", "FOLDER/a.exr", "--png", "FOLDER/a.png",
                    "--false-colour", "luminance")),
    ("render", "", ("FOLDER/missed.gltf", "--size", "16x16", "--samples", "8:24", "-o",
                    "FOLDER/part.exr")),
    ("render", "--replay", ("8,8,0", *SMALL)),
    ("develop", "", ("FOLDER/all.exr", "-o", "FOLDER/a.png", "--denoise", "--eye", "40")),
    ("develop", "", ("FOLDER/all.exr", "-o", "FOLDER/a.png", "--layer", "depth.Z")),
    ("merge", "", ("FOLDER/part.exr", "-o", "FOLDER/whole.exr")),
    ("equip", "--with", ("tests/unit/records/equip.json", "FOLDER/odd.gltf", "-o",
                         "FOLDER/equipped.gltf")),
)


# ---- what the shipped files have not -------------------------------------------------------


def write_set(run, folder):
    """A panel with places and zones, whose first table has an outlier and a hole."""
    with open(os.path.join(ROOT, PANELS, "ips_cluster.recipe.json"), encoding="utf-8") as file:
        recipe = json.load(file)
    recipe["emission"]["levels"] = [255]
    recipe["reflection"].update(wavelengths_nm=[550], incidence_deg=[10, 30, 50])
    recipe.update(size_mm=[300, 200], places={"u": [0.1, 0.9], "v": [0.5, 0.5], "map": [8, 4]},
                  local_dimming={"zones": [6, 4], "drive": {"rule": "mean", "least": 0.25},
                                 "spread": {"radius_mm": [0, 60], "value": [1, 0]}})
    with open(os.path.join(folder, "recipe.json"), "w", encoding="utf-8") as file:
        json.dump(recipe, file)
    run("panel", "simulate", "FOLDER/recipe.json", "-o", "FOLDER/set", "--noise", "off",
        "--grid", "12x24", "--quiet")
    with open(os.path.join(folder, "set/spot_1/emission/red_255.csv"), "r+") as file:
        lines = file.read().splitlines(keepends=True)
        theta, phi, *xyz = lines[60].split(",")
        lines[60] = ",".join([theta, phi, *(str(9 * float(value)) for value in xyz)]) + "\n"
        file.seek(0)
        file.truncate()
        file.writelines(lines[:100] + lines[101:])


def write_scene(folder):
    """A camera of parallel rays, a lamp with opening and tilt, an animation."""
    scene = Scene()
    for name in ("bare", "other"):
        scene.facing_quad(scene.material(name), [0, 0, 0], [0, 0, 1], 1)
    scene.probe("probe", [0, 0, 1], [0, 0, -1], 1)
    scene._node({"name": "lamp", "translation": [0, 1, 0]})
    steps = [scene._accessor(values, kind, 5126, "f", {"min": [0], "max": [1]} if of else {})
             for values, kind, of in (([0.0, 1.0], "SCALAR", True),
                                      ([[0.0, 1, 0], [0, 2, 0]], "VEC3", False))]
    scene.document["animations"] = [{
        "name": "up", "samplers": [{"input": steps[0], "output": steps[1]}],
        "channels": [{"sampler": 0, "target": {"node": 3, "path": "translation"}}]}]
    scene.write(os.path.join(folder, "odd.gltf"))
    two_mirrors()[0].write(os.path.join(folder, "missed.gltf"))
    with open(os.path.join(folder, "lamp.ies"), "w", encoding="utf-8") as file:
        file.write(ies(size="0.1 0.2 0").replace("TILT=NONE",
                                                 "TILT=INCLUDE\n1\n3\n0 60 90\n1 0.9 0.5"))


def write_review(folder):
    """A symbol as large as its display, some of which the binnacle hides."""
    with open(os.path.join(ROOT, GLANCE), encoding="utf-8") as file:
        review = json.load(file)

    def reached(name):
        return os.path.relpath(os.path.join(ROOT, "scenes", name), folder)
    night = review["conditions"][0]
    review["scene"] = [reached(name) for name in review["scene"]]
    night["lights"] = [reached(name) for name in night["lights"]]
    speed = review["symbols"]["speed"]
    speed.update(content=reached(speed["content"]), uv=[0, 0, 1, 1])
    review["conditions"] = [night]
    del review["variants"], review["frames"]
    with open(os.path.join(folder, "whole.review.json"), "w", encoding="utf-8") as file:
        json.dump(review, file)


def write_files(folder):
    with open(os.path.join(folder, "day.epw"), "w", encoding="utf-8") as file:
        file.write(EPW)
    with open(os.path.join(folder, "two.hdr"), "wb") as file:
        file.write(radiance_picture(64, 64, lambda u, v: 100 if u + v < 0.8 else 10))


# ---- paths ---------------------------------------------------------------------------------


def leaves(value, at=""):
    """(path, is there anything) of what is no object and no list of objects: "lights[].name"."""
    if isinstance(value, dict) and value:
        for key, inside in value.items():
            yield from leaves(inside, f"{at}.{key}" if at else key)
    elif isinstance(value, list) and any(isinstance(item, dict) for item in value):
        for item in value:
            yield from leaves(item, f"{at}[]" if at else "")
    else:
        yield at, value not in (None, [], {})


def paths_of(columns):
    """Of each column the path, and that of its interval; an item of a list is the list."""
    for column in columns:
        for path in (column["key"], column.get("interval")):
            if path:
                yield re.sub(r"\.\d+\b", "", path)


def is_below(path, column):
    return path == column or path.startswith((column + ".", column + "[]"))


def is_told(path, has_value, columns):
    """An object or a list that is not there this time is told by its members, too."""
    return any(is_below(path, column) or not has_value and is_below(column, path)
               for column in columns)


def answers_of(told, before=""):
    """{(command, with): the paths of its columns} of what help --json says."""
    found = {}
    for command in told["commands"]:
        name = before + command["name"]
        found.update(answers_of(command, name + " ") if "commands" in command else {})
        for answer in command.get("answers", ()):
            found.setdefault((name, answer["with"]), set()).update(paths_of(answer["columns"]))
    return found


def main():
    report = Report()
    program = os.path.abspath(sys.argv[1])
    seen = {}  # by the columns: an answer of two commands is one, or a part of the other's
    with tempfile.TemporaryDirectory(prefix="answers-") as folder:
        def run(*words):
            done = subprocess.run([program, *(word.replace("FOLDER", folder) for word in words)],
                                  cwd=ROOT, capture_output=True, text=True)
            report.claim(done.returncode in (0, 1), f"{' '.join(words)}: {done.stderr.strip()}")
            return done.stdout
        known = {answer: frozenset(columns) for answer, columns in
                 answers_of(json.loads(run("help", "--json"))).items()}
        write_set(run, folder)
        write_scene(folder)
        write_review(folder)
        write_files(folder)
        run(*RENDERED)
        os.mkdir(os.path.join(folder, "r"))
        shutil.copy(os.path.join(folder, "frame.exr"), os.path.join(folder, "r"))
        for command, option, words in RUNS:
            columns = known.get((command, option), frozenset())
            typed = [word for word in option.split() if word.startswith("--")]
            answer = json.loads(run(*command.split(), *typed, *words, "--json"))
            paths = set(leaves(answer))
            report.claim_none(f"{command} {' '.join(words)}: in the answer and no column's", sorted(
                path for path, has_value in paths if not is_told(path, has_value, columns)))
            seen.setdefault(columns, set()).update(path for path, _ in paths)
    for answer, columns in known.items():
        paths = {path for of, paths in seen.items() if of <= columns for path in paths}
        report.claim_none(f"{' '.join(answer)}: a column and in no answer", sorted(
            column for column in columns if not any(is_below(path, column) for path in paths)))
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
