# SPDX-License-Identifier: Apache-2.0
"""far.py [--all] PARHELION -- a scene that stands far off is the same scene: every command that
reads or prints positions of the world says of it what it says of one near the origin, up to the
shift.

The one near stands where the other's coordinates are, less its origin: so all that is no
position must be the same to the last digit. --all: sweeps, and everything at every place.
"""
import json
import math
import os
import re
import shutil
import struct
import sys
import tempfile

from exr import Frame
from gltf import Scene
from moved import move
from review import EYE, PANEL, Report, Reviewer, dashboard, moment, request

PLACES = (1000, 0, 0), (4096.7, -300, 12345)
FAR, NEAR = "far", "near"
POINTS = ("eye_m", "at_m", "from_m", "rays", "place", "bounds_m")
DIGITS = 1e-8  # JSON has nine
OWN = ("origin_m", "seconds", "minutes", "measured_s", "input_files", "sha256", "hash")
SKY = "--environment", "constant:3000"
TARGET = [0, 0, 0]
SENSOR = [0, 0.2, 0.3]


def sum_of(a, b):
    return [x + y for x, y in zip(a, b)]


def numbers(p):
    return ",".join(repr(x) for x in p)


# ---- the scene ------------------------------------------------------------------------------

def lamps():
    scene = Scene()
    scene.light("point", 30, [0.3, 0.4, 0.5])
    scene.quad(scene.emitter(2000), [-0.5, 0.35, 0.2], [0.1, 0, 0], [0, 0, 0.1])
    return scene


def write(folder, place):
    """Both of its files, moved to a place."""
    for name, scene in (("dash.gltf", dashboard()), ("lamps.gltf", lamps())):
        for i, node in enumerate(scene.document["nodes"]):
            node.setdefault("name", f"{name[0]}{i}")
        move(scene.document, place)
        scene.write(os.path.join(folder, name))


class Pair:
    """The scene far away, and where its own coordinates would have it."""

    def __init__(self, program, folder, place):
        self.at, self.runners = {FAR: list(place)}, {}
        for kind in (FAR, NEAR):
            own = os.path.join(folder, kind)
            os.makedirs(own, exist_ok=True)
            shutil.copy(PANEL, os.path.join(own, "ips.panel"))
            self.runners[kind] = Reviewer(program, own)
        write(self.runners[FAR].folder, place)
        self.origin = self.json(FAR, "check", "dash.gltf", "lamps.gltf")["origin_m"]
        self.at[NEAR] = [p - o for p, o in zip(place, self.origin)]
        write(self.runners[NEAR].folder, self.at[NEAR])

    def run(self, kind, *line):
        done = self.runners[kind].run(*line)
        assert done.returncode in (0, 1), done.stderr
        return done.stdout

    def json(self, kind, *line):
        return json.loads(self.run(kind, *line, "--json"))

    def file(self, kind, name):
        return os.path.join(self.runners[kind].folder, name)

    def point(self, kind, p):
        """A point of the scene at home, in the world."""
        return sum_of(p, self.at[kind])


# ---- comparing ------------------------------------------------------------------------------

def is_point(value):
    return isinstance(value, list) and len(value) == 3 and \
        all(isinstance(x, (int, float)) for x in value)


def differences(pair, far, near, path="", as_points=False):
    """Where they differ more than by the shift; points: to their digits."""
    if as_points and is_point(far) and is_point(near):
        if math.dist(far, sum_of(near, pair.origin)) > DIGITS * (1 + math.hypot(*far)):
            yield f"{path}: {far}, near {near}"
    elif isinstance(far, dict) and isinstance(near, dict):
        if far.keys() != near.keys():
            yield f"{path}: keys {far.keys() ^ near.keys()}"
        for key in far.keys() & near.keys():
            if key not in OWN:
                yield from differences(pair, far[key], near[key], f"{path}/{key}",
                                       as_points or key in POINTS)
    elif isinstance(far, list) and isinstance(near, list) and len(far) == len(near):
        for i, (a, b) in enumerate(zip(far, near)):
            yield from differences(pair, a, b, f"{path}/{i}", as_points)
    elif far != near:
        yield f"{path}: {far}, near {near}"


def hold(report, pair, what, far, near):
    report.claim_none(f"{what} at {pair.at[FAR]}", list(differences(pair, far, near))[:5])


def both(pair, *line):
    """line: of the kind, a command's answer."""
    return [pair.json(kind, *(part(kind) if callable(part) else part for part in line))
            for kind in (FAR, NEAR)]


# ---- frames ---------------------------------------------------------------------------------

def view_point(path):
    with open(path, "rb") as file:
        head = file.read(4000)
    return [float(x) for x in re.search(rb"-vp (\S+) (\S+) (\S+)", head).groups()]


def eye_of(frame):
    m = struct.unpack("<16f", frame.attributes["worldToCamera"])
    return [-sum(m[12 + k] * m[4 * i + k] for k in range(3)) for i in range(3)]


def check_frames(report, pair, *camera):
    """All channels are the same but `position`, whose floats are rounded out there."""
    frames, eyes, heads = [], [], []
    for kind in (FAR, NEAR):
        line = [part(kind) if callable(part) else part for part in camera]
        ask = "render", "dash.gltf", "lamps.gltf", *SKY, "--size", "24x16", *line
        pair.run(kind, *ask, "--spp", "4", "--no-guiding", "--layers", "all", "-o", "f.exr")
        frames.append(Frame(pair.file(kind, "f.exr")))
        eyes.append(eye_of(frames[-1]))
        pair.run(kind, *ask, "--spp", "1", "--no-guiding", "-o", "f.hdr")
        heads.append(view_point(pair.file(kind, "f.hdr")))
    coarse = 4 * 2 ** -24 * math.hypot(*pair.at[FAR])
    for far, near in (eyes, heads):
        report.claim(math.dist(far, sum_of(near, pair.origin)) < coarse + 1e-5,
                     f"{camera}: the camera stands at {far}, near at {near}")
    far, near = (frame.channels for frame in frames)
    apart = [name for name in near if not name.startswith("position.") and
             bytes(far[name]) != bytes(near[name])]
    report.claim(not apart, f"{camera}, {pair.at[FAR]}: {apart} differ")
    for axis, o in zip("XYZ", pair.origin):
        worst = max(abs(a - o - b) for a, b in zip(far["position." + axis],
                                                   near["position." + axis]) if b == b)
        report.claim(worst < coarse + 1e-6, f"position.{axis} is off by {worst}")


# ---- commands -------------------------------------------------------------------------------

def check_luxmeter(report, pair):
    places = [0.1, 0.1, 0.4], [-0.2, 0.05, 0.6]
    facing = [0, 1, 0]
    def row(kind, p):
        return numbers(pair.point(kind, p) + facing)
    line = ("measure", "dash.gltf", "lamps.gltf", *SKY, "--samples", "64", "--illuminance")
    hold(report, pair, "a luxmeter", *both(pair, *line, lambda kind: row(kind, places[0])))
    for kind in (FAR, NEAR):
        with open(pair.file(kind, "points.csv"), "w", encoding="utf-8") as file:
            file.write("".join(row(kind, p) + "\n" for p in places))
    hold(report, pair, "a table of luxmeters", *both(pair, *line, "points.csv"))
    tables = [[line.split(",") for line in pair.run(kind, *line, "points.csv", "--csv")
               .split()[1:]] for kind in (FAR, NEAR)]
    report.claim([row[6:] for row in tables[0]] == [row[6:] for row in tables[1]],
                 f"tables {tables}")


def check_ways(report, pair):
    """Of a pixel, a display and a wall."""
    ask = "dash.gltf", "lamps.gltf", *SKY, "--size", "24x16"
    told = pair.run(FAR, "explain", *ask, "--pixel", "12,4", "--paths", "128")
    wanted = f"  {pair.at[FAR][0]:.0f}"[:4]
    report.claim(wanted in told, f"explain's text has no '{wanted}': {told}")
    eye = "--eye", lambda kind: numbers(pair.point(kind, EYE))
    for what in (("--display", "screen", *eye, "--look-at",
                  lambda kind: numbers(pair.point(kind, TARGET))), ("--pixel", "12,4")):
        hold(report, pair, f"explain {what[:2]}",
             *both(pair, "explain", *ask, *what, "--paths", "1024"))


SUNS = {"name": "suns", "level": "day", "sweep": {
    "sun": {"azimuth_deg": [150, 190, 40], "elevation_deg": [20, 20, 20]}, "sky": "sky"}}
VARIANTS = {"tilted": {"nodes": {"d0": {"tilt_deg": 8, "move_m": [0, 0.01, 0]}}},
            "hood": {"hoods": {"screen": 0.05}},
            "higher": {"eyes": {"point": {"move_m": [0, 0.1, 0]}}}}


def asked(pair, kind):
    """Every way to say where an eye or a sensor is."""
    return request(
        scene=["dash.gltf", "lamps.gltf"], precision={"contrast": 0.2, "clear": 0.2},
        conditions=[dict(moment("grey", type="constant", luminance=3000), level="day")],
        levels={"day": {"sensor": {"position_m": pair.point(kind, SENSOR),
                                   "normal": [0, 1, 0]},
                        "table_lx": [[100, 0.1], [20000, 0.3]]}},
        eyes={"camera": {"camera": "eye"}, "point": {"position_m": pair.point(kind, EYE)},
              "box": {"centre_m": pair.point(kind, [0, 0.1, 0.8]), "grid": [2, 1, 2],
                      "half_size_m": [0.03, 0.02, 0.03]}},
        gaze=[{"name": "wall", "direction": [-1, 0, -0.3], "eyes": ["point"]}])


def check_review(report, pair, with_suns):
    found = []
    for kind in (FAR, NEAR):
        document = asked(pair, kind)
        document["variants"] = VARIANTS
        if with_suns:
            document["conditions"].append(SUNS)
        pair.runners[kind].write("r.json", document)
        pair.run(kind, "review", "r.json", "-o", "out")
        with open(pair.file(kind, "out/review.json"), encoding="utf-8") as file:
            found.append(json.load(file))
        for read in found[-1]["inputs"]:
            read.pop("sha256")  # of files that say where they stand
    hold(report, pair, "a review", *found)
    line = "explain", "r.json", "--paths", "1024", "--condition", "grey", "--symbol", "bar"
    hold(report, pair, "explain of a review", *both(pair, *line, "--eye", "point"))


def check_framed(report, pair):
    """Without a camera the program looks by itself, and says from where."""
    said = []
    for kind in (FAR, NEAR):
        done = pair.runners[kind].run("render", "lamps.gltf", "--size", "8x8", "--spp", "1",
                                      "-o", "g.exr")
        said.append([float(x) for x in re.search(r"from ([-\d.,e+]+) ", done.stderr)
                     .group(1).split(",")])
    coarse = 1e-3 * math.hypot(*pair.at[FAR])
    report.claim(math.dist(said[0], sum_of(said[1], pair.origin)) < coarse, f"framed: {said}")


def check_equip(report, pair):
    """The page is in the scene's coordinates and says from where; its file is the world's."""
    runner = pair.runners[FAR]
    runner.run("equip", "dash.gltf", "-o", "page.html")
    with open(pair.file(FAR, "page.html"), encoding="utf-8") as file:
        data = json.loads(re.search(r'id="equip-data">(.*?)</script>', file.read()).group(1))
    report.claim(data["origin"] == pair.origin and
                 max(map(abs, data["low"] + data["high"])) < 5, f"{data['origin']}")
    centre, eye = pair.point(FAR, [0.05, 0.1, 0.2]), pair.point(FAR, EYE)
    runner.write("e.json", {
        "equip": 1, "model": "dash.gltf", "profile": "iso-15008", "forward": [0, 0, -1],
        "displays": [{"name": "new", "on": "side", "centre_m": centre, "right": [1, 0, 0],
                      "up": [0, 1, 0], "width_m": 0.1, "height_m": 0.05, "before_mm": 0.5,
                      "panel": "ips.panel", "level": 1}],
        "eyes": [{"name": "new eye", "position_m": eye, "looks_at": "new"}]})
    done = runner.run("equip", "dash.gltf", "--with", "e.json", "-o", "equipped.gltf")
    report.claim(done.returncode == 0, done.stderr)
    with open(pair.file(FAR, "equipped.gltf"), encoding="utf-8") as file:
        nodes = {node.get("name"): node for node in json.load(file)["nodes"]}
    centre[2] += 0.0005
    for name, wanted in (("new", centre), ("new eye", eye)):
        found = nodes[name]["translation"]
        report.claim(math.dist(found, wanted) < 1e-9, f"{name}: {found}, required: {wanted}")


def main():
    report, is_all = Report(), "--all" in sys.argv
    with tempfile.TemporaryDirectory() as folder:
        for i, place in enumerate(PLACES):
            pair = Pair(sys.argv[-1], os.path.join(folder, str(i)), place)
            report.claim(math.dist(pair.origin, place) < 2, f"origin {pair.origin}")
            hold(report, pair, "check", *both(pair, "check", "dash.gltf", "lamps.gltf"))
            check_frames(report, pair)
            check_frames(report, pair, "--eye", lambda kind: numbers(pair.point(kind, EYE)),
                         "--look-at", lambda kind: numbers(pair.point(kind, TARGET)))
            check_luxmeter(report, pair)
            check_framed(report, pair)
            check_equip(report, pair)
            if is_all or i:
                check_ways(report, pair)
                check_review(report, pair, is_all)
    report.finish()


if __name__ == "__main__":
    main()
