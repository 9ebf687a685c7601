# SPDX-License-Identifier: Apache-2.0
"""moved.py [--all] PARHELION -- where a scene stands, how it is turned and
in which order its file names things changes no figure.

  closed forms  a lamp that lights a parallel plate at a grazing angle, and a large tilted plane
                under a uniform sky, at random places: within 0.5 %
  rooms         random rooms (tests/hunt/rooms.py), moved by 0.3, 10 and 1,000 m, turned by any
                angle, their nodes in another order: the same means within standard errors
  scenes        those that ship, moved and turned about the vertical: the same
"""
import argparse
import json
import math
import os
import random
import statistics
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.normpath(os.path.join(HERE, "..", ".."))
sys.path[:0] = [os.path.join(HERE, "..", "hunt"), os.path.join(HERE, "..", "structure")]
from exr import Frame  # noqa: E402
from gltf import Scene, along, cross, unit  # noqa: E402
from report import Report  # noqa: E402
import rooms  # noqa: E402

CLOSE = 0.005       # of a closed form
SEEDS = 4           # of each frame: their means' spread tells the standard error
SAMPLES = 64        # of a pixel of the scenes that ship
TOO_FAR = 10        # such standard errors (Student's, 6 degrees of freedom: once in 17,000)
TOO_WIDE = 1.6      # rms of many, 1.22 by chance
BLOCKS = 2          # to a side of a room's frame; 4 of a scene's
DISTANCES_M = (0.3, 10, 1000)
SKY = ("--environment", "constant:1000")
MORNING = ("--environment", "sky:clear", "--when", "2026-06-21T08:30+02:00", "--where",
           "48.14,11.58,520", "--heading", "90")
SCENES = {
    "car_noon": (("car_dashboard.gltf", "noon.gltf"), ()),
    "car_morning": (("car_dashboard.gltf",), MORNING),
    "car_night": (("car_dashboard.gltf", "night.gltf"), ()),
    "car_hud": (("car_hud.gltf", "noon.gltf"), ()),
    "car_tunnel": (("car_dashboard.gltf", "tunnel_exit.gltf"), ()),
    "car_garage": (("car_dashboard.gltf", "garage.gltf"), ()),
    "deck_low_sun": (("cockpit.gltf", "low_sun_left.gltf"), ("--camera", "captain")),
    "deck_dusk": (("cockpit.gltf", "dusk.gltf"), ("--camera", "pfd")),
}


# ---- moving ---------------------------------------------------------------------------------

def random_direction(draw):
    z, phi = draw.uniform(-1, 1), draw.uniform(0, 2 * math.pi)
    return [math.sqrt(1 - z * z) * math.cos(phi), math.sqrt(1 - z * z) * math.sin(phi), z]


def random_turn(draw):
    """A quaternion by any angle about any axis."""
    angle, axis = draw.uniform(0, 2 * math.pi), random_direction(draw)
    return [math.sin(angle / 2) * x for x in axis] + [math.cos(angle / 2)]


def turn_about_vertical(angle):
    return [0, math.sin(angle / 2), 0, math.cos(angle / 2)]


def rotated(quaternion, p):
    u, s = quaternion[:3], quaternion[3]
    t = [2 * x for x in cross(u, p)]
    return along(along(p, t, s), cross(u, t), 1)


def move(document, translation=(0, 0, 0), rotation=(0, 0, 0, 1)):
    """Puts all roots of the document's scene below one node."""
    scene = document["scenes"][document.get("scene", 0)]
    if not scene.get("nodes"):
        return
    document["nodes"].append({"name": "moved", "children": scene["nodes"],
                              "translation": list(translation), "rotation": list(rotation)})
    scene["nodes"] = [len(document["nodes"]) - 1]


def reorder(document, draw):
    nodes = document["scenes"][document.get("scene", 0)]["nodes"]
    draw.shuffle(nodes)


# ---- rendering and comparing ----------------------------------------------------------------

class Renderer:
    def __init__(self, program, folder, report):
        self.program, self.folder, self.report = program, folder, report
        self.seed, self.apart = 0, {}

    def render(self, files, options, size, samples):
        """The frame, of another seed each time."""
        self.seed += 1
        out = os.path.join(self.folder, "frame.exr")
        done = subprocess.run(
            [self.program, "render", *files, "-o", out, "--size", size, "--spp", str(samples),
             "--seed", str(self.seed), "--layers", "variance", "--quiet", "--no-guiding",
             *options], cwd=self.folder, capture_output=True, text=True)
        if done.returncode:
            sys.exit(f"moved.py: {' '.join(files)}: {done.stderr.strip()}")
        return Frame(out)

    def means(self, files, options, size, samples, blocks):
        """Of each block of the frame and of the whole: mean and standard error of SEEDS."""
        found = [block_means(self.render(files, options, size, samples), blocks)
                 for _ in range(SEEDS)]
        return [(statistics.mean(values), statistics.stdev(values) / math.sqrt(SEEDS))
                for values in zip(*found)]

    def compare(self, kind, what, before, after):
        """Holds the blocks' means against each other."""
        apart = [(b[0] - a[0]) / max(math.hypot(a[1], b[1]), 1e-30)
                 for a, b in zip(before, after)]
        worst = max(apart, key=abs)
        self.apart.setdefault(kind, []).extend(apart)
        self.report.claim(abs(worst) <= TOO_FAR,
                          f"{what} {kind}: a block is {worst:+.2f} standard errors apart")

    def conclude(self):
        """Holds the spread of all differences against chance."""
        for kind, values in self.apart.items():
            rms = math.sqrt(sum(v * v for v in values) / len(values))
            text = (f"{kind}: {len(values)} means, apart by {rms:.2f} standard errors rms, "
                    f"{max(abs(v) for v in values):.2f} at most")
            print(text)
            if len(values) > 100:
                self.report.claim(rms <= TOO_WIDE, text)


def block_means(frame, blocks):
    """Luminance of each block of the frame, cd/m2, and at last the whole's."""
    def cut(length, i):
        return i * length // blocks
    regions = [(cut(frame.width, i), cut(frame.height, j), cut(frame.width, i + 1),
                cut(frame.height, j + 1)) for j in range(blocks) for i in range(blocks)]
    return [frame.mean_luminance(region)[0] for region in [*regions, None]]


# ---- closed forms ---------------------------------------------------------------------------

def plate_luminance(angle, side, lamp_cd_m2, reflectance):
    """Of a plate's middle, lit by a square in a parallel plane: its middle 1 m away, `angle`
    from both normals."""
    n, total = 100, 0
    across, up = math.sin(angle), math.cos(angle)
    for i in range(n):
        for k in range(n):
            x = across + side * ((i + 0.5) / n - 0.5)
            z = side * ((k + 0.5) / n - 0.5)
            total += up * up / (x * x + up * up + z * z) ** 2
    return reflectance / math.pi * lamp_cd_m2 * total * (side / n) ** 2


def lamp_and_plate(angle, side, lamp_cd_m2, reflectance):
    scene = Scene()
    plate = scene.lambert(reflectance, double_sided=True)
    lamp = scene.lambert(0, lamp_cd_m2, double_sided=True)
    scene.facing_quad(plate, [0, 0, 0], [0, 1, 0], 0.1)
    scene.facing_quad(lamp, [math.sin(angle), math.cos(angle), 0], [0, -1, 0], side)
    scene.probe("probe", [0, 0.4, 0.7], unit([0, -0.4, -0.7]), 0.0005)
    return scene


def tilted_plane(size, tilt, draw):
    scene = Scene()
    normal = [math.sin(tilt), math.cos(tilt), 0]
    scene.facing_quad(scene.lambert(0.5, double_sided=True), [0, 0, 0], normal, size)
    scene.view("view", along([0, 0, 0], normal, 0.01 * size), [-x for x in normal], 60,
               random_direction(draw))
    scene.environment(type="constant", luminance=1000)
    return scene


def random_place(draw):
    reach = draw.choice([0, 10 ** draw.uniform(-1, 2)])
    return along([0, 0, 0], random_direction(draw), reach)


def check_closed_forms(renderer, draw, count):
    """The lamp is moved along its plate, as corners of a file are; the plane anywhere."""
    path = os.path.join(renderer.folder, "closed.gltf")
    for _ in range(count):
        angle, side = math.radians(draw.uniform(20, 89.5)), draw.uniform(0.02, 0.3)
        expected = plate_luminance(angle, side, 20000, 0.5)
        scene, place = lamp_and_plate(angle, side, 20000, 0.5), random_place(draw)
        move(scene.document, [place[0], 0, place[2]] if draw.random() < 0.5 else place)
        scene.write(path)
        found = renderer.render([path], ["--max-bounces", "1"], "4x4", 1024)
        hold(renderer.report, f"lamp at {math.degrees(angle):.1f} degrees, {place}",
             found.mean_luminance(), expected)
        size, tilt = 10 ** draw.uniform(-1, 3), math.radians(draw.uniform(0, 90))
        scene, place = tilted_plane(size, tilt, draw), random_place(draw)
        move(scene.document, place)
        scene.write(path)
        found = renderer.render([path], [], "8x8", 256)
        hold(renderer.report, f"plane of {size:.3g} m, {math.degrees(tilt):.0f} degrees, "
             f"{place}", found.mean_luminance(), 500)


def hold(report, what, found, expected):
    slack = CLOSE * expected + 3 * found[1]
    report.claim(abs(found[0] - expected) <= slack,
                 f"{what}: {found[0]:.6g} cd/m2, closed form {expected:.6g}")


# ---- rooms ----------------------------------------------------------------------------------

def room_scene(seed):
    draw = random.Random(seed)
    room = rooms.Room(draw, False)
    for camera in room.scene.document["cameras"]:
        camera["perspective"]["yfov"] = 1.2
    return room.scene


def changed(seed, draw):
    """Name and scene of each change of a room."""
    for distance in DISTANCES_M:
        scene = room_scene(seed)
        move(scene.document, along([0, 0, 0], random_direction(draw), distance))
        yield f"moved by {distance} m", scene
    scene = room_scene(seed)
    move(scene.document, rotation=random_turn(draw))
    yield "turned", scene
    scene = room_scene(seed)
    reorder(scene.document, draw)
    yield "in another order", scene


def check_rooms(renderer, draw, seeds):
    path = os.path.join(renderer.folder, "room.gltf")
    ask = [path], [*SKY, "--root", "/"], "16x10", 32, BLOCKS
    for panel in rooms.PANELS:
        os.symlink(os.path.join(ROOT, "assets", "panels", panel),
                   os.path.join(renderer.folder, panel))
    for seed in seeds:
        room_scene(seed).write(path)
        before = renderer.means(*ask)
        for kind, scene in changed(seed, draw):
            scene.write(path)
            renderer.compare(kind, f"room {seed}", before, renderer.means(*ask))


# ---- scenes that ship -----------------------------------------------------------------------

def link_scenes(folder):
    """A folder like `scenes`, to which moved files may be added."""
    beside = os.path.join(folder, "scenes")
    os.mkdir(beside)
    os.symlink(os.path.join(ROOT, "assets"), os.path.join(folder, "assets"))
    for name in os.listdir(os.path.join(ROOT, "scenes")):
        os.symlink(os.path.join(ROOT, "scenes", name), os.path.join(beside, name))
    return beside


def write_moved(beside, file, place, turn):
    """The scene's file, moved; its path."""
    with open(os.path.join(beside, file), encoding="utf-8") as source:
        document = json.load(source)
    move(document, place, turn)
    path = os.path.join(beside, f"moved_{file}")
    with open(path, "w", encoding="utf-8") as out:
        json.dump(document, out)
    return path


def check_scenes(renderer, draw):
    beside = link_scenes(renderer.folder)
    for name, (files, options) in SCENES.items():
        ask = [*options, "--root", "/"], "96x54", SAMPLES // SEEDS, 4
        before = renderer.means([os.path.join(beside, file) for file in files], *ask)
        for distance in (*DISTANCES_M, 0):
            turn = turn_about_vertical(0 if distance else draw.uniform(0, 2 * math.pi))
            place = along([0, 0, 0], random_direction(draw), distance)
            moved = [write_moved(beside, file, place, turn) for file in files]
            ahead = ",".join(f"{x:.9f}" for x in rotated(turn, [0, 0, -1]))
            after = renderer.means(moved, [*ask[0], "--forward", ahead], *ask[1:])
            kind = f"moved by {distance} m" if distance else "turned"
            renderer.compare(kind, name, before, after)
            a, b = before[-1], after[-1]
            print(f"{name} {kind}: {100 * (b[0] / a[0] - 1):+.3f} +- "
                  f"{100 * math.hypot(a[1], b[1]) / a[0]:.3f} %")


def main():
    options = argparse.ArgumentParser()
    options.add_argument("--all", action="store_true")
    options.add_argument("program")
    options = options.parse_args()
    report, draw = Report(), random.Random(7)
    with tempfile.TemporaryDirectory() as folder:
        renderer = Renderer(os.path.abspath(options.program), folder, report)
        check_closed_forms(renderer, draw, 100 if options.all else 8)
        check_rooms(renderer, draw, range(200 if options.all else 3))
        if options.all:
            check_scenes(renderer, draw)
    renderer.conclude()
    report.finish()


if __name__ == "__main__":
    main()
