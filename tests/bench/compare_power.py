# SPDX-License-Identifier: Apache-2.0
"""compare_power.py [--pairs N] [--frames N] [--only TEXT] [--climb SAMPLES] [--together N]
PARHELION BENCH_STATISTIC -- the statistical test of two frames on frames of this program: false
alarms over N pairs of seeds, and how often it finds 1 % more light in a display's reflection,
the sun 0.3 degrees higher, and a missing lamp. Scenes: the car at noon and at night, the flight
deck under a low sun, a room with a mirror ball, a window, sun and lamps that is made here.

Every pair of the false alarms has two seeds of its own, a quarter of them frames of different
sample counts. A change is counted over all pairs of N frames before and N after it (10: 100
pairs), each with a seed of its own; share_found says what that is worth. Claims: false alarms
of a level of 1 % (five of 200), and no change missed in more than one of a hundred pairs.
--climb: where more are missed, again with twice the samples, up to so many. --together: frames
made at a time, one thread each: much of a small frame's time is its start.
"""
import argparse
import concurrent.futures
import json
import math
import os
import subprocess
import sys
import tempfile

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path[:0] = [os.path.join(ROOT, "tests", name) for name in ("image", "structure")]
from gltf import Scene, png  # noqa: E402
from report import Report  # noqa: E402

SCENES = os.path.join(ROOT, "scenes")
LAYERS = "variance,halves,samples,display,id"
SMALL = "96x54"


# ---- scenes ---------------------------------------------------------------------------------

class View:
    """What is rendered: scene files, options, samples a pixel."""

    def __init__(self, name, files, samples, *options):
        self.name, self.files, self.samples, self.options = name, files, samples, options


def in_folder(folder, name):
    return os.path.join(folder, name)


def write_room(path, elevation=10, lamps=2):
    """A display on a desk before a window; a ball that throws the sun about. Its panel is that
    of Program.panels, beside it."""
    scene = Scene()
    scene.box_inside(scene.lambert(0.6), [-2, 0, -2], [2, 2.5, 6])
    scene.document["scenes"][0]["nodes"].pop(3)  # the wall at z = 6: the sun comes from there
    scene.sphere(scene.metal(0.9, 0.05), [-0.6, 0.9, -0.5], 0.25, rings=48)
    scene.sphere(scene.metal(0.8, 0.3), [0.7, 1, -0.7], 0.3)
    scene.facing_quad(scene.window(1.52), [0, 1.2, 0.4], [0, 0, 1], 1.5)
    scene.facing_quad(scene.emitter(300), [1.2, 2.45, 0], [0, -1, 0], 0.4)
    picture = scene.image("image/png", png(4, 2, [[0, 0, 0, 255, 255, 255, 40, 40, 40, 9, 9, 9],
                                                  [255, 0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0]]))
    display = scene.material("cluster", extensions={"PARHELION_display": {
        "panel": "base.panel", "content": {"index": picture}, "level": 0.3}})
    scene.quad(display, [-0.3, 0.7, -0.4], [0.7, 0, 0], [0, 0.35, -0.1])
    for k in range(lamps):
        scene.light("spot", 9000, [-1 + 2 * k, 2.3, 0.5], [0.3 - 0.6 * k, -1, -0.4])
    scene.environment(type="constant", luminance=500, sun={
        "azimuth_deg": 170, "elevation_deg": elevation, "illuminance_lx": 70000})
    scene.view("eye", [0, 1.15, 1], [0, -0.15, -1], 45)
    scene.write(path)


def changed_scene(folder, name, result, change):
    """A scene file of the project with a change; what it names lies beside it."""
    with open(os.path.join(SCENES, name), encoding="utf-8") as file:
        document = json.load(file)
    change(document)
    for beside in ("noon_sky.exr", "night.bin"):
        link = in_folder(folder, beside)
        if not os.path.exists(link):
            with open(os.path.join(SCENES, beside), "rb") as original, open(link, "wb") as copy:
                copy.write(original.read())
    with open(in_folder(folder, result), "w", encoding="utf-8") as file:
        json.dump(document, file)
    return in_folder(folder, result)


def raise_sun(document):
    sun = document["scenes"][0]["extensions"]["PARHELION_environment"]["sun"]
    sun["elevation_deg"] += 0.3


def without_node(name):
    def change(document):
        nodes = document["nodes"]
        index = next(i for i, node in enumerate(nodes) if node.get("name") == name)
        document["scenes"][0]["nodes"].remove(index)
    return change


# ---- the program ----------------------------------------------------------------------------

class Program:
    def __init__(self, program, judge, folder, together):
        self.program, self.judge = os.path.abspath(program), os.path.abspath(judge)
        self.folder, self.pool = folder, concurrent.futures.ThreadPoolExecutor(together)

    def run(self, *arguments):
        done = subprocess.run([self.program, *map(str, arguments)], capture_output=True,
                              text=True)
        if done.returncode != 0:
            sys.exit(f"{' '.join(map(str, arguments))}: {done.stderr.strip()}")

    def render(self, view, seed, samples=None):
        out = in_folder(self.folder, f"{view.name.replace(' ', '_')}-{seed}.exr")
        self.run("render", *view.files, "-o", out, "--seed", seed, "--spp",
                 samples or view.samples, "--layers", LAYERS, "--quiet", "--threads", 1,
                 *view.options)
        return out

    def compare(self, reference, test):
        done = subprocess.run([self.judge, reference, test], capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(done.stderr.strip())
        return json.loads(done.stdout)

    @staticmethod
    def forget(*frames):
        for frame in frames:
            os.remove(frame)

    def panels(self):
        """A cluster's panel and one that reflects 1 % more: fitted to the same tables, times
        1.01."""
        with open(os.path.join(ROOT, "assets", "panels", "ips_cluster.recipe.json"),
                  encoding="utf-8") as file:
            recipe = json.load(file)
        recipe["instrument"].update(theta_step_deg=2, phi_step_deg=6, brdf_theta_step_deg=1,
                                    brdf_phi_step_deg=3)
        path, tables = in_folder(self.folder, "recipe.json"), in_folder(self.folder, "tables")
        with open(path, "w", encoding="utf-8") as file:
            json.dump(recipe, file)
        self.run("panel", "simulate", path, "-o", tables, "--noise", "off", "--quiet")
        for name, factor in (("base", 1), ("more", 1.01)):
            scale_reflection(os.path.join(tables, "brdf"), factor)
            self.run("panel", "fit", os.path.join(tables, "MANIFEST.json"), "-o",
                     in_folder(self.folder, f"{name}.panel"), "--quiet")


def scale_reflection(folder, factor):
    for name in os.listdir(folder):
        path = os.path.join(folder, name)
        with open(path, encoding="utf-8") as file:
            head, *rows = file.read().splitlines()
        with open(path, "w", encoding="utf-8") as file:
            file.write(head + "\n")
            for row in rows:
                values = row.split(",")
                scaled = [f"{factor * float(v):.9g}" for v in values[2:]]
                file.write(",".join(values[:2] + scaled) + "\n")


# ---- what is measured -----------------------------------------------------------------------

def quiet_views(folder):
    """Views and how often each is taken."""
    car = os.path.join(SCENES, "car_dashboard.gltf")
    return [(View("noon", [car, os.path.join(SCENES, "noon.gltf")], 32, "--size", SMALL), 3),
            (View("night", [car, os.path.join(SCENES, "night.gltf")], 32, "--size", SMALL), 2),
            (View("low sun", [os.path.join(SCENES, "cockpit.gltf"),
                              os.path.join(SCENES, "low_sun_left.gltf")], 16, "--size", SMALL),
             1),
            (View("room", [in_folder(folder, "room.gltf")], 64, "--size", SMALL), 2)]


def changes(folder):
    """name, the view before, the view after."""
    car = os.path.join(SCENES, "car_dashboard.gltf")
    noon, night = os.path.join(SCENES, "noon.gltf"), os.path.join(SCENES, "night.gltf")
    higher = changed_scene(folder, "noon.gltf", "higher.gltf", raise_sun)
    darker = changed_scene(folder, "night.gltf", "darker.gltf", without_node("street lamp 1"))
    write_room(in_folder(folder, "room_higher.gltf"), elevation=10.3)
    write_room(in_folder(folder, "room_darker.gltf"), lamps=1)
    room = in_folder(folder, "room.gltf")
    # The display fills the view: a frame of 480 x 270 of which only it is rendered.
    close = ("--size", "480x270", "--crop", "144,148,264,200", "--panel")
    near = ("--size", "160x90", "--panel")

    def panel(name):
        return "cluster=" + in_folder(folder, f"{name}.panel")
    return [("1 % haze, car at noon",
             View("haze a", [car, noon], 256, *close, panel("base")),
             View("haze b", [car, noon], 256, *close, panel("more"))),
            ("1 % haze, room", View("haze c", [room], 256, *near, panel("base")),
             View("haze d", [room], 256, *near, panel("more"))),
            ("sun 0.3 degrees, car at noon",
             View("sun a", [car, noon], 256, "--size", "160x90"),
             View("sun b", [car, higher], 256, "--size", "160x90")),
            ("sun 0.3 degrees, room", View("sun c", [room], 256, "--size", SMALL),
             View("sun d", [in_folder(folder, "room_higher.gltf")], 256, "--size", SMALL)),
            ("a lamp less, car at night", View("lamp a", [car, night], 256, "--size", SMALL),
             View("lamp b", [car, darker], 256, "--size", SMALL)),
            ("a lamp less, room", View("lamp c", [room], 256, "--size", SMALL),
             View("lamp d", [in_folder(folder, "room_darker.gltf")], 256, "--size", SMALL))]


def allowed(tests, share=0.01):
    """The least count that so many tests of this level exceed in less than 2 % of all cases:
    5 of 200."""
    below = count = 0
    while True:
        below += math.comb(tests, count) * share**count * (1 - share)**(tests - count)
        if 1 - below < 0.02:
            return count
        count += 1


def judge_pair(program, view, k, samples):
    """Two frames of one view, of seeds 2 k and 2 k + 1."""
    pair = program.render(view, 2 * k), program.render(view, 2 * k + 1, samples)
    found = program.compare(*pair)
    program.forget(*pair)
    return found


def measure_alarms(program, report, pairs):
    views = [view for view, weight in quiet_views(program.folder) for _ in range(weight)]
    alarms, counts, judged = [], {}, []
    for k in range(pairs):
        view = views[k % len(views)]
        more = view.samples * 2 if k // len(views) % 4 == 3 else view.samples
        judged.append((k, view, program.pool.submit(judge_pair, program, view, k, more)))
    for k, view, pair in judged:
        found = pair.result()
        counts.setdefault(view.name, []).append(found["p"])
        if found["verdict"] == "different":
            alarms.append(f"{view.name}, seeds {2 * k} and {2 * k + 1}: {found['reason']}")
    for name, values in counts.items():
        print(f"{name:10} {len(values):4} pairs, least p {min(values):.2g}, p below 0.1: "
              f"{sum(p < 0.1 for p in values) / len(values):.1%}")
    for alarm in alarms:
        print("  alarm:", alarm)
    print(f"false alarms: {len(alarms)} of {pairs} at a level of 1 %")
    report.claim(len(alarms) <= allowed(pairs), f"{len(alarms)} false alarms of {pairs}")


def share_found(found):
    """The share of a table of pairs (a row a frame before, a column a frame after) that were
    found, and its standard error. Pairs of one frame are not independent, frames are: the
    delete-one jackknife over rows and over columns tells the error of the mean over both."""
    rows, columns = len(found), len(found[0])
    total = sum(map(sum, found))

    def spread(sums, others):
        n = len(sums)
        left = [(total - s) / ((n - 1) * others) for s in sums]
        mean = sum(left) / n
        return (n - 1) / n * sum((share - mean) ** 2 for share in left)
    square = (spread([sum(row) for row in found], columns)
              + spread([sum(column) for column in zip(*found)], rows))
    return total / (rows * columns), math.sqrt(square)


def sure_share(count):
    """With all of so many independent pairs found, the share that is found with 95 % surety:
    a lesser one would have missed some in 19 of 20 cases."""
    return 0.05 ** (1 / count)


def judge_change(program, before, after, frames, samples):
    """Every frame before against every frame after: rows of answers."""
    asked = ([(before, 5000 + k) for k in range(frames)]
             + [(after, 9000 + k) for k in range(frames)])
    made = list(program.pool.map(lambda frame: program.render(*frame, samples), asked))
    firsts, seconds = made[:frames], made[frames:]
    table = [[program.compare(first, second) for second in seconds] for first in firsts]
    program.forget(*firsts, *seconds)
    return table


def measure_change(program, name, before, after, frames, samples):
    """Tells how many of all pairs were found; true from 99 of 100 on."""
    table = judge_change(program, before, after, frames, samples)
    share, error = share_found([[r["verdict"] == "different" for r in row] for row in table])
    worst = max(r["p"] for row in table for r in row)
    size = before.options[before.options.index("--size") + 1]
    print(f"{name}, {size}, {samples} samples: {share * frames ** 2:.0f} of {frames ** 2} "
          f"pairs found, {share:.1%} +- {1.96 * error:.1%}", end="")
    if share == 1:
        print(f" (at least {sure_share(frames):.1%} by {frames} independent pairs alone)",
              end="")
    print(f", greatest p {worst:.2g}, such as: {table[0][0]['reason']}", flush=True)
    return share >= 0.99


def measure_changes(program, report, options):
    """At twice the samples again, and again, where less than 99 % were found and --climb asks
    for it: the last line of a change says what it takes."""
    for name, before, after in changes(program.folder):
        if options.only not in name:
            continue
        samples = before.samples
        reached = measure_change(program, name, before, after, options.frames, samples)
        report.claim(reached, f"{name}: fewer than 99 % of pairs found")
        while not reached and samples < options.climb:
            samples *= 2
            reached = measure_change(program, name, before, after, options.frames, samples)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--pairs", type=int, default=200)
    parser.add_argument("--frames", type=int, default=10)
    parser.add_argument("--only", default="")
    parser.add_argument("--climb", type=int, default=0)
    parser.add_argument("--together", type=int, default=os.cpu_count())
    parser.add_argument("program")
    parser.add_argument("judge", help="bench_statistic")
    options = parser.parse_args()
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        program = Program(options.program, options.judge, folder, options.together)
        program.panels()
        write_room(in_folder(folder, "room.gltf"))
        if options.pairs:
            measure_alarms(program, report, options.pairs)
        if options.frames:
            measure_changes(program, report, options)
    report.finish()


if __name__ == "__main__":
    main()
