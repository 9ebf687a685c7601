# SPDX-License-Identifier: Apache-2.0
"""settings.py PARHELION -- settings that can be read but cannot be meant: levels of 2,500 %,
displays of 1.75 m, vehicles that point elsewhere than their eyes look, eyes in millimetres,
pictures on their sides. Each is refused or said at its place, each can be said to be meant,
and what is right is not bothered. The angles expected are those of the geometry made here.
"""
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path[:0] = [os.path.join(ROOT, "tests", "structure"), os.path.join(ROOT, "tests", "image")]
from gltf import Scene, png  # noqa: E402
from report import Report  # noqa: E402

PANEL = os.path.join(ROOT, "assets", "panels", "ips_cluster.panel")
CASES = os.path.join(ROOT, "..", "shared", "data", "cases", "review")
SENSOR = {"position_m": [0, 1, 0], "normal": [0, 1, 0]}


class Bench:
    def __init__(self, report, program, folder):
        self.report, self.program, self.folder = report, os.path.abspath(program), folder

    def run(self, *line):
        return subprocess.run([self.program, *line], cwd=self.folder, capture_output=True,
                              text=True, check=False)

    def write(self, name, document):
        with open(os.path.join(self.folder, name), "w", encoding="utf-8") as file:
            json.dump(document, file)

    def check(self, *line):
        """The messages of `check`, errors first."""
        found = json.loads(self.run("check", *line, "--json").stdout)["problems"]
        return [p["severity"] + ": " + p["message"] + " " + p["path"] for p in found]

    def review(self, document):
        self.write("r.review.json", document)
        return self.run("review", "r.review.json", "--dry-run")

    def claim_said(self, what, done, status, *words):
        self.report.claim(done.returncode == status and all(w in done.stderr for w in words),
                          f"{what}: status {done.returncode}, {done.stderr!r} lacks {words}")

    def claim_silent(self, what, done):
        self.report.claim(done.returncode == 0 and not done.stderr,
                          f"{what}: status {done.returncode}, {done.stderr!r}")


def turned(right, up, degrees):
    """The two axes turned to the left by an angle."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return ([c * a + s * b for a, b in zip(right, up)],
            [c * b - s * a for a, b in zip(right, up)])


def cockpit(size=(0.3, 0.15), turn=0, heading=0, eye=(0, 0.2, 0.8), **display):
    """A display at the origin, its picture turned, and an eye before it; all of it turned
    about +Y by a heading."""
    def about(v):
        c, s = math.cos(math.radians(heading)), math.sin(math.radians(heading))
        return [c * v[0] + s * v[2], v[1], c * v[2] - s * v[0]]
    scene = Scene()
    side = min(size) / 20
    columns, rows = (round(x / side) for x in size)
    picture = scene.image("image/png", png(columns, rows, [
        [255 * (0.14 < x / columns < 0.75 and 0.22 < y / rows < 0.6) for x in range(columns)
         for _ in range(3)] for y in range(rows)]))
    material = scene.material("screen", {"PARHELION_display": {
        "panel": "p.panel", "content": {"index": picture}, **display}})
    right, up = turned([1, 0, 0], [0, 1, 0], turn)
    right, up = [[x * length for x in about(axis)] for axis, length in
                 ((right, size[0]), (up, size[1]))]
    scene.quad(material, [-0.5 * (r + u) for r, u in zip(right, up)], right, up)
    scene.view("eye", about(eye), about([-x for x in eye]), 30)
    return scene


def request(**members):
    return {"title": "t", "scene": ["s.gltf"], "eyes": {"eye": {"camera": "eye"}},
            "symbols": {"bar": {"display": "screen", "uv": [0.1, 0.1, 0.9, 0.9]}},
            "profile": "iso-15008", "frames": {"worst": 0},
            "conditions": [{"name": "c", "environment": {"type": "constant",
                                                         "luminance": 100}}], **members}


# ---- levels ----

def levels_of(value):
    """A level wherever a request has one, and its place."""
    table = {"sensor": SENSOR, "table_lx": [[0, 0], [100, value]]}
    yield "/levels/a/*", {"levels": {"a": {"*": value}}}
    yield "/levels/a/screen", {"levels": {"a": {"*": 0.5, "screen": value}}}
    yield "/levels/a/table_lx/1", {"levels": {"a": table}}
    yield "/variants/v/levels/a/*", {"levels": {"a": {"*": 0.5}},
                                     "variants": {"v": {"levels": {"a": {"*": value}}}}}


def check_levels(bench):
    cockpit().write(os.path.join(bench.folder, "s.gltf"))
    for value in (1.0001, 1.5, 25, 60, 100):
        for place, members in levels_of(value):
            told = f"{place} {value}"
            bench.claim_said(told, bench.review(request(**members)), 3, place, f"is {value:g}",
                             "from 0 to 1", "max_level")
            bench.claim_said(told + " above max_level",
                             bench.review(request(max_level=1.00005, **members)), 3, place)
            bench.claim_silent(told + " meant",
                               bench.review(request(max_level=value, **members)))
    for value in (0, 0.04, 1):
        for place, members in levels_of(value):
            bench.claim_silent(f"{place} {value}", bench.review(request(**members)))
    bench.claim_silent("brightness says what it is",
                       bench.review(request(variants={"v": {"brightness": {"*": 4}}})))
    bench.claim_said("a brightness of 80", bench.review(
        request(variants={"v": {"brightness": {"screen": 80}}})), 0,
        "/variants/v/brightness/screen", "is 80 times as bright", "0.8 is")


def check_scene_levels(bench):
    path = os.path.join(bench.folder, "l.gltf")
    for level, most, is_right in ((25, None, False), (1.2, None, False), (1.2, 1.1, False),
                                  (1.2, 1.2, True), (25, 30, True), (1, None, True),
                                  (0.25, None, True)):
        display = {"level": level} if most is None else {"level": level, "max_level": most}
        cockpit(**display).write(path)
        said = bench.check("l.gltf")
        wanted = f"required: a level from 0 to {most or 1:g}"
        bench.report.claim(not said if is_right else len(said) == 1 and wanted in said[0] and
                           "PARHELION_display/level" in said[0], f"{display}: {said}")


def check_percentages(bench):
    cockpit().write(os.path.join(bench.folder, "s.gltf"))
    for value, status, words in (
            ("250", 3, ['"250" is above 100 percent', '"250%"']), ("100.5", 3, ["above 100"]),
            ("250%", 0, []), ("100", 0, []), ("4", 0, []), ("1", 0, []), ("0", 0, []),
            ("0.25", 0, ["0.25 percent, a level of 0.0025", '"25" for a level of 0.25']),
            ("0.25%", 0, []), ("20000%", 3, ["no percentage"])):
        done = bench.run("render", "s.gltf", "--display-level", f"screen={value}", "--size",
                         "8x4", "--spp", "1", "-o", "x.exr", "--quiet", "--environment",
                         "constant:1")
        if words or status:
            bench.claim_said(f"--display-level {value}", done, status, *words)
        else:
            bench.claim_silent(f"--display-level {value}", done)


# ---- sizes ----

def check_sizes(bench):
    path = os.path.join(bench.folder, "s.gltf")
    for size in ((1.75, 0.98), (0.3, 1.6), (300, 150), (0.0003, 0.00015), (0.3, 0.004)):
        is_tiny = max(size) < 0.01
        eye = [x * max(size[0], 0.5) for x in (0, 0.2, 0.8)]
        told = f"{size[0]:.3g} m wide and {size[1]:.3g} m high"
        cockpit(size, eye=eye).write(path)
        said = bench.check("s.gltf")
        bench.report.claim(any(told in s and "0.005 to 1.5 m" in s for s in said),
                           f"check of {told}: {said}")
        done = bench.review(request())
        bench.claim_said(f"a review of {told}", done, 3, told, "required: 0.005 to 1.5 m",
                         "/symbols/bar/display")
        cockpit(size, eye=eye, any_size=True).write(path)
        done = bench.review(request())
        bench.report.claim(done.returncode == 0 and "any_size" not in done.stderr or is_tiny,
                           f"{told} is meant: {done.stderr}")
    for size in ((1.4, 0.2), (0.012, 0.006), (0.3, 0.15)):
        cockpit(size).write(path)
        bench.report.claim(not bench.check("s.gltf"), f"{size}: {bench.check('s.gltf')}")
        bench.claim_silent(f"a review of {size}", bench.review(request()))


# ---- forward ----

def check_forward(bench):
    """The eye looks at the display, `heading` to the left of -Z; forward is -Z turned by
    another angle to the left."""
    for heading in (0, 50, 90, 180):
        cockpit(heading=heading).write(os.path.join(bench.folder, "s.gltf"))
        for ahead in (0, 44, 46, 90, 137, 180, 270):
            apart = abs((heading - ahead + 180) % 360 - 180)
            a = math.radians(ahead)
            done = bench.review(request(forward=[-math.sin(a), 0.1, -math.cos(a)]))
            if apart > 45:
                bench.claim_said(f"forward {ahead}, eye {heading}", done, 0, "/forward",
                                 f"is {apart} degrees off", '"eye"', "within 45")
            else:
                bench.claim_silent(f"forward {ahead}, eye {heading}", done)


def check_other_eyes(bench):
    """Eyes without a camera look at what they read; one whose gaze is ahead looks ahead."""
    cockpit(heading=90).write(os.path.join(bench.folder, "s.gltf"))
    seat = {"seat": {"position_m": [0.8, 0.2, 0]}}
    done = bench.review(request(eyes=seat))
    bench.claim_said("a point that looks along -X", done, 0, "is 90 degrees off", '"seat"',
                     "(-0.97, -0.243, 0)")
    bench.claim_silent("forward is -X", bench.review(request(eyes=seat, forward=[-1, 0, 0])))
    gaze = [{"at": "symbols"}, {"name": "road", "direction": [0, 0, -1]}]
    bench.claim_silent("a gaze to the road", bench.review(request(eyes=seat, gaze=gaze)))
    box = {"seat": {"centre_m": [0.8, 0.2, 0], "half_size_m": [0.05, 5, 0.05],
                    "grid": [1, 2, 1]}}
    bench.claim_said("a box of 10 m", bench.review(request(eyes=box, forward=[-1, 0, 0])), 0,
                     "/eyes/seat", "reaches over 10 m", "at most 1 m")
    far = {"seat": {"position_m": [800, 200, 0]}}
    done = bench.review(request(eyes=far, forward=[-1, 0, 0]))
    bench.claim_said("an eye in millimetres", done, 0, "/eyes/seat", "825 m from",
                     "0.1 to 10 m")


def check_scene_forward(bench):
    """`check`: an environment that turns the scene, and a camera that looks at a display."""
    cockpit(heading=90).write(os.path.join(bench.folder, "s.gltf"))
    for members, words in (({}, ""), ({"heading_deg": 30}, "is 90 degrees off"),
                           ({"forward": [-1, 0, 0]}, ""),
                           ({"forward": [1, 0, 0]}, "is 180 degrees off")):
        sky = Scene()
        sky.quad(sky.lambert(0.5), [9, 0, 0], [0.1, 0, 0], [0, 0.1, 0])
        sky.environment(type="sky", when="2026-06-21T12:00+02:00", where=[48, 11, 500],
                        **members)
        sky.write(os.path.join(bench.folder, "sky.gltf"))
        said = bench.check("s.gltf", "sky.gltf")
        bench.report.claim(len(said) == 1 and words in said[0] if words else not said,
                           f"check with {members}: {said}")


# ---- pictures that are turned ----

def check_turns(bench):
    path = os.path.join(bench.folder, "s.gltf")
    for turn, words in ((0, ""), (30, ""), (-45, ""), (90, "on its left side"),
                        (-90, "on its right side"), (180, "upside down"),
                        (150, "upside down")):
        cockpit(turn=turn, size=(0.2, 0.2), eye=(0, 0, 0.8)).write(path)
        done = bench.review(request())
        said = bench.check("s.gltf")
        wanted = f"turned by {abs(turn)} degrees"
        if words:
            bench.claim_said(f"turned by {turn}", done, 0, words, wanted,
                             "/symbols/bar/display")
        else:
            bench.claim_silent(f"turned by {turn}", done)
        bench.report.claim(len(said) == 1 and words in said[0] and wanted in said[0]
                           if words else not said, f"check of {turn}: {said}")


def check_mirrored(bench):
    """The usual fault of an export: v runs the other way."""
    scene = cockpit()
    text = json.dumps(scene.document["materials"][0])
    flipped = json.loads(text)
    flipped["extensions"]["PARHELION_display"]["content"]["extensions"] = {
        "KHR_texture_transform": {"offset": [0, 1], "scale": [1, -1]}}
    scene.document["materials"][0] = flipped
    scene.used.add("KHR_texture_transform")
    scene.write(os.path.join(bench.folder, "s.gltf"))
    said = bench.check("s.gltf")
    bench.report.claim(any("mirrored" in s and s.startswith("error") for s in said),
                       f"mirrored: {said}")
    flipped["extensions"]["PARHELION_display"]["content"]["extensions"] = {
        "KHR_texture_transform": {"offset": [1, 1], "scale": [-1, -1]}}
    scene.write(os.path.join(bench.folder, "s.gltf"))
    said = bench.check("s.gltf")
    bench.report.claim(len(said) == 1 and "upside down (turned by 180" in said[0],
                       f"both flipped: {said}")


# ---- equip ----

def equipment(**display):
    return {"equip": 1, "displays": [{"name": "d", "centre_m": [0, 0, 0], "right": [0, 0, -1],
                                      "up": [0, 1, 0], "width_m": 0.3, "height_m": 0.1125,
                                      "panel": "ips_cluster", "content": "cluster", **display}],
            "eyes": [{"name": "e", "position_m": [0.7, 0.2, 0.1], "looks_at": "d"}]}


def equip(bench, document):
    bench.write("e.json", document)
    return bench.run("equip", "wall.gltf", "--with", "e.json", "-o", "new.gltf", "--overwrite")


def check_equip(bench):
    scene = Scene()
    scene.quad(scene.lambert(0.5), [-0.01, -1, 1], [0, 0, -2], [0, 2, 0])
    scene.write(os.path.join(bench.folder, "wall.gltf"))
    new = os.path.join(bench.folder, "new.review.json")
    done = equip(bench, equipment())
    bench.claim_silent("forward is left out", done)
    with open(new, encoding="utf-8") as file:
        bench.report.claim(json.load(file)["forward"] == [-1, 0, 0], "forward is not proposed")
    bench.report.claim("proposed from where" in done.stdout, done.stdout)
    done = equip(bench, {**equipment(), "forward": [0, 0, -1]})
    bench.claim_said("ahead is -Z", done, 0, "/forward", "is 82 degrees off where", '"e"')
    for members, place, words in (
            ({"level": 25}, "/displays/0/level", ["is 25", "from 0 to 1"]),
            ({"width_m": 1.75}, "/displays/0/width_m", ["is 1.75 m", "0.005 to 1.5 m"]),
            ({"height_m": 0.002}, "/displays/0/height_m", ["is 0.002 m"])):
        bench.claim_said(str(members), equip(bench, equipment(**members)), 3, place, *words)
    for members in ({"level": 25, "max_level": 25}, {"width_m": 1.75, "any_size": True}):
        bench.claim_silent(str(members), equip(bench, equipment(**members)))
    down = equipment(right=[0, 0, 1], up=[0, -1, 0])
    bench.claim_said("equipped upside down", equip(bench, down), 0, "upside down")


# ---- keys ----

def check_keys(bench):
    """A key with another unit behind it names the one that is meant."""
    for members, wanted in (({"type": "constant", "luminance_cd_m2": 9}, "luminance"),
                            ({"type": "constant", "luminance": 9, "heading_degrees": 4},
                             "heading_deg"), ({"type": "constant", "lumninance": 9},
                                              "luminance")):
        scene = Scene()
        scene.environment(**members)
        scene.write(os.path.join(bench.folder, "k.gltf"))
        said = bench.check("k.gltf")
        bench.report.claim(any(f"the nearest known one is '{wanted}'" in s for s in said),
                           f"{members}: {said}")


def check_case(bench):
    path = os.path.join(CASES, "level_25.review.json")
    if not os.path.isfile(path):
        bench.report.skip("the shared data are not there: level_25.review.json")
        return
    with open(path, encoding="utf-8") as file:
        document = json.load(file)
    scenes = os.path.join(ROOT, "scenes")
    document["scene"] = [os.path.join("scenes", s) for s in document["scene"]]
    document["symbols"]["speed"]["content"] = "assets/content/cluster.png"
    document["conditions"][0]["lights"] = ["scenes/night.gltf"]
    for folder in ("scenes", "assets"):
        os.symlink(os.path.join(os.path.dirname(scenes), folder),
                   os.path.join(bench.folder, folder))
    bench.write("r.review.json", document)
    done = bench.run("review", "r.review.json", "--dry-run", "--root", ROOT)
    bench.claim_said("level_25.review.json", done, 3, "/levels/dimmed/*", "is 25")


def main(program):
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        shutil.copy(PANEL, os.path.join(folder, "p.panel"))
        bench = Bench(report, program, folder)
        for check in (check_levels, check_scene_levels, check_percentages, check_sizes,
                      check_forward, check_other_eyes, check_scene_forward, check_turns,
                      check_mirrored, check_equip, check_keys, check_case):
            check(bench)
    return report.finish()


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
