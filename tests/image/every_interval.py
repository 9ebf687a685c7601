# SPDX-License-Identifier: Apache-2.0
"""every_interval.py [--all | --seeds N] [ROOM...] PARHELION -- every interval that a command
prints holds the truth: of `review` (gazes, eyes, symbols, causes, limits, variants, --diff),
`explain`, `measure` of frames (regions, displays, contents, --glare, --illuminance) and
`compare`.

Answers are searched for members whose names end with "interval": one for which a room knows no
truth fails. Rooms, each with few samples, as people have them:
    gradient   displays below a wall that a lamp beside them lights: of the part that a review
               names, and of all of the symbol
    patch      a display in a black box that a small hole lights (black_box.py)
    glint      a gaze by a pane that mirrors a tiny lamp (gaze_intervals.py)
    frame      frames of the patch's display
    fisheye    half the space with a window (glare.py)
    wall       a wall that a lamp lights by itself and by way of a mirror, which samples find by
               chance
Truths are closed forms; what has none (colours, small causes) is held against the mean of all
seeds, which is said. --all: 200 seeds a room, of which 93 % must hold, but for what chance
makes of 93 % once in 20 (180 of 200); else three seeds or fewer, one of which may miss."""
import json
import math
import os
import shutil
import sys
import tempfile

import black_box
import contrast
import gaze_intervals
import glare
import reflection
import worst_part
from gltf import Scene, cross, dot, sub, unit
from review import PANEL, Report, Reviewer, moment, request

SHARE, ONCE_IN = 0.93, 20
SEEDS, ALL_SEEDS = 3, 200
FEWER = {"patch": 2, "frame": 2, "gradient": 15}  # of the first
ROUNDING = 1e-9  # of a mean over many
OF_SEEDS = "of seeds"  # a truth that is the mean over seeds of the figure beside the interval


def least_held(count):
    """So few hold once in 20, where each does with SHARE."""
    if count < 20:
        return count - 1
    chance = 0
    for held in range(count + 1):
        chance += math.exp(math.lgamma(count + 1) - math.lgamma(held + 1) -
                           math.lgamma(count - held + 1) + held * math.log(SHARE) +
                           (count - held) * math.log(1 - SHARE))
        if chance > 1 / ONCE_IN:
            return held
    return count


# ---- what is printed ------------------------------------------------------------------------

def figure_beside(node, key):
    """The figure whose interval that is: the member of the same name, with its unit."""
    name = key[:-len("_interval")]
    if key == "interval":
        return next((node[k] for k in ("found", "cd_m2", "value") if k in node), None)
    if name == "reflected" and "luminance_cd_m2" in node:
        node = node["luminance_cd_m2"]
    beside = {"contrast": ["contrast_ratio"]}
    names = beside.get(name, []) + [name] + [name + unit for unit in ("_cd_m2", "_lx")]
    return next((node[n] for n in names if n in node), None)


def intervals(node, path=""):
    """(path, figure, interval) of all, lists by the names of what they list."""
    if isinstance(node, dict):
        for key, value in node.items():
            if key.endswith("interval"):
                yield f"{path}/{key}", figure_beside(node, key), value
            else:
                yield from intervals(value, f"{path}/{key}")
    elif isinstance(node, list):
        for value in node:
            own = value if isinstance(value, dict) else {}
            name = own.get("kind") or own.get("chain") or ""
            name = " ".join(str(n.get("name", n) if isinstance(n, dict) else n)
                            for n in name) if isinstance(name, list) else name
            yield from intervals(value, f"{path}[{name}]" if name else path)


def pairs(figure, interval):
    """An interval of several figures as several of one; None: it is not known."""
    if interval is None or interval == [None, None]:
        return []
    if not isinstance(interval[0], list):
        return [(figure, interval)]
    figures = figure if isinstance(figure, list) else [figure] * len(interval)
    return [one for f, i in zip(figures, interval) for one in pairs(f, i)]


class Tally:
    """Intervals by what they are of."""

    def __init__(self, report):
        self.report, self.told, self.answers = report, {}, {}

    def add(self, room, answer, truths, skip=()):
        """truths: path's end -> number, list of numbers, or OF_SEEDS."""
        self.answers[room] = self.answers.get(room, 0) + 1
        for path, figure, interval in intervals(answer):
            if any(path.endswith(end) for end in skip):
                continue
            end = max((e for e in truths if path.endswith(e) or e.endswith("*") and
                       path.startswith(e[:-1])), key=len, default=None)
            if not self.report.claim(end is not None, f"{room}: no truth of {path}"):
                continue
            truth = truths[end]
            many = pairs(figure, interval)
            truth = truth if isinstance(truth, list) else [truth] * len(many)
            for k, ((value, (low, high)), right) in enumerate(zip(many, truth)):
                name = room, path + (f" {k}" if len(many) > 1 else "")
                self.told.setdefault(name, []).append((value, low, high, right))

    def finish(self):
        for (room, path), rows in self.told.items():
            is_mean = rows[0][3] == OF_SEEDS
            if is_mean and len(rows) < self.answers[room]:
                continue  # among the others at times: no mean of its own
            mean = sum(row[0] for row in rows) / len(rows) if is_mean else None
            rows = [(low, high, mean if is_mean else right) for _, low, high, right in rows]
            held = sum(low - ROUNDING * abs(low) <= right <= high + ROUNDING * abs(high)
                       for low, high, right in rows)
            off = sum((low + high) / 2 - right for low, high, right in rows) / len(rows)
            half = sum(high - low for low, high, _ in rows) / 2 / len(rows)
            words = (f"{room}: {path}: {held} of {len(rows)} hold, half {half:.3g}, middle "
                     f"{off:+.2g}" + (", mean of seeds" if is_mean else ""))
            print(words, flush=True)
            self.report.claim(held >= least_held(len(rows)), words)


def ask(reviewer, *line):
    done = reviewer.run(*line, "--json")
    assert done.returncode in (0, 1), f"{' '.join(line)}: {done.stderr}"
    return json.loads(done.stdout)


# ---- a display in a box ---------------------------------------------------------------------

HOLE, LEVEL = (0.03, 0.03), 0.00012
DIMMER = 0.9


def write_patch(reviewer, level, near_deg=None):
    room = black_box.Patch(HOLE)
    scene = room.scene(level)
    if near_deg:
        scene.view("near", black_box.EYE, [-x for x in black_box.EYE], near_deg)
    scene.environment(**black_box.environment())
    scene.write(os.path.join(reviewer.folder, "room.gltf"))
    return room


def contrast_of(light, reflected, dimmed=1):
    shown = [light[k] * dimmed for k in ("foreground", "background")]
    return (max(shown) + reflected) / (min(shown) + reflected)


def patch(reviewer, tally, seeds):
    room = write_patch(reviewer, LEVEL)
    panel = reflection.Panel(reviewer.program, os.path.join(reviewer.folder, "ips.panel"),
                             reviewer.folder)
    truths = {}
    for seed in range(1, seeds + 1):
        document = black_box.review_request(
            LEVEL, [{**moment("moment", **black_box.environment())}],
            precision={"seed": seed},
            variants={"dim": {"levels": {"set": {"*": DIMMER * LEVEL}}}})
        review = reviewer.review(document, f"out{seed % 2}",
                                 *(["--diff", f"out{1 - seed % 2}"] if seed > 1 else []))[1]
        case = review["cases"][0]
        light, part = case["luminance_cd_m2"], case["judged_part_uv"]
        part = [part[side] for side in ("left", "top", "right", "bottom")]
        if str(part) not in truths:
            truths[str(part)] = black_box.closed_form(room, panel, part, 5)
        if "mean" not in truths:
            truths["mean"] = black_box.closed_form(room, panel, black_box.SYMBOL_UV, 9)
        reflected = truths[str(part)]
        ratio, dim = contrast_of(light, reflected), contrast_of(light, reflected, DIMMER)
        least = case["limit"]["value"]
        known = {"/contrast_interval": ratio, "/reflected_interval": reflected,
                 "symbol_mean/reflected_interval": truths["mean"],
                 "/variants/cases/contrast_interval": dim,
                 "/variants/worst/contrast_interval": dim,
                 "/margin_difference_interval": math.log(dim / ratio) / math.log(least),
                 "/limit/interval": ratio, "/judged/interval": ratio,
                 "/limits[contrast_ratio]/interval": ratio,
                 "/cases/limits*": OF_SEEDS, "/cases/causes*": OF_SEEDS, "/chains*": OF_SEEDS}
        for kind, found in (("review", review), ("explain", ask(
                reviewer, "explain", "r.json"))):
            causes = found["cases"][0]["causes"] if kind == "review" else found["chains"]
            first = max(causes, key=lambda c: c["cd_m2"])
            causes.remove(first)
            (found["cases"][0] if kind == "review" else found)["first_cause"] = first
            tally.add(f"patch, {kind}", found, {**known, "first_cause/interval": reflected})
        if seed > 1:
            with open(os.path.join(reviewer.folder, f"out{seed % 2}", "diff.json"),
                      encoding="utf-8") as file:
                tally.add("patch, diff", json.load(file), {"/contrast_interval": ratio})


# ---- displays below a wall that a lamp beside them lights ------------------------------------

DISPLAYS_X, SPOT_X, SPOT_SIDE, SPOT = (-0.5, -0.2, 0.1, 0.4), -0.9, 0.1, 1e4
CEILING, CEILING_Z, CEILING_HALF = 0.8, 0.6, 2.5  # its reflectance; m


def ceiling_light():
    """(place, luminance times area) of the wall's cells: all in one plane is lit by it alone."""
    side, cells = 0.05, []
    steps = round(2 * CEILING_HALF / side)
    for i in range(steps):
        for j in range(steps):
            x, y = (-CEILING_HALF + (k + 0.5) * side for k in (i, j))
            lux = 0
            for u in (-0.25, 0.25):
                for v in (-0.25, 0.25):
                    square = ((x - SPOT_X - u * SPOT_SIDE) ** 2 + (y - v * SPOT_SIDE) ** 2 +
                              CEILING_Z ** 2)
                    lux += SPOT * (SPOT_SIDE / 2) ** 2 * CEILING_Z ** 2 / square ** 2
            cells.append((x, y, CEILING * lux / math.pi * side ** 2))
    return cells


def gradient_lux(at, cells):
    return sum(light * CEILING_Z ** 2 /
               ((x - at[0]) ** 2 + (y - at[1]) ** 2 + CEILING_Z ** 2) ** 2
               for x, y, light in cells)


def gradient_light(cells, x, uv, points=3):
    """Mean luminance that a box of the display at x reflects."""
    left, top, right, bottom = uv
    places = [(left + (i + 0.5) / points * (right - left), top + (j + 0.5) / points *
               (bottom - top)) for i in range(points) for j in range(points)]
    size = 1e-3 * worst_part.WIDE, 1e-3 * worst_part.HIGH
    return contrast.RHO / math.pi / len(places) * sum(
        gradient_lux([x + (u - 0.5) * size[0], (0.5 - v) * size[1]], cells) for u, v in places)


def gradient_scene():
    scene = Scene()
    picture = scene.image("image/png", worst_part.content())
    wide, high = 1e-3 * worst_part.WIDE, 1e-3 * worst_part.HIGH
    for i, x in enumerate(DISPLAYS_X):
        screen = scene.material(f"screen{i}", extensions={"PARHELION_display": {
            "panel": "closed.panel", "content": {"index": picture}, "level": 1e-3}})
        scene.quad(screen, [x - wide / 2, -high / 2, 0], [wide, 0, 0], [0, high, 0])
    scene.facing_quad(scene.emitter(SPOT), [SPOT_X, 0, 0], [0, 0, 1], SPOT_SIDE)
    scene.facing_quad(scene.lambert(CEILING), [0, 0, CEILING_Z], [0, 0, -1], 2 * CEILING_HALF)
    scene.view("eye", [0, 0, 0.5], [0, 0, -1], 90)
    return scene


def gradient(reviewer, tally, seeds):
    """The place is given: another may be worse by less than the paths that chose it show."""
    contrast.write_set(reviewer.folder)
    assert reviewer.run("panel", "fit", "MANIFEST.json", "-o", "closed.panel").returncode == 0
    gradient_scene().write(os.path.join(reviewer.folder, "dash.gltf"))
    edges = worst_part.BOX
    box = [edges[k] / (worst_part.WIDE, worst_part.HIGH)[k % 2] for k in range(4)]
    truths, cells = {}, ceiling_light()
    for seed in range(1, seeds + 1):
        review = reviewer.review(request(
            symbols={f"s{i}": {"display": f"screen{i}", "uv": [0.02, 0.02, 0.98, 0.98]}
                     for i in range(len(DISPLAYS_X))},
            conditions=[moment("lamp", type="constant", luminance=1e-6)],
            precision={"seed": seed}), "out")[1]
        for case, x in zip(review["cases"], DISPLAYS_X):
            part = [case["judged_part_uv"][side] for side in ("left", "top", "right", "bottom")]
            for uv in (part, box):
                if (x, str(uv)) not in truths:
                    truths[x, str(uv)] = gradient_light(cells, x, uv)
            tally.add("gradient", {k: case[k] for k in (
                "reflected_interval", "luminance_cd_m2", "symbol_mean")}, {
                    "/reflected_interval": truths[x, str(part)],
                    "symbol_mean/reflected_interval": truths[x, str(box)]})


# ---- frames of it ---------------------------------------------------------------------------

NEAR_DEG, SIZE, SAMPLES = 2, "48x32", "16"


def frame(reviewer, tally, seeds):
    """The camera `near` sees a bright bar and nothing else, `eye` the whole display."""
    room = write_patch(reviewer, LEVEL, NEAR_DEG)
    panel = reflection.Panel(reviewer.program, os.path.join(reviewer.folder, "ips.panel"),
                             reviewer.folder)
    reflected = known = None
    for seed in range(1, seeds + 1):
        for camera in ("near", "eye"):
            done = reviewer.run("render", "room.gltf", "-o", f"{camera}{seed % 2}.exr",
                                "--camera", camera, "--size", SIZE, "--spp", SAMPLES,
                                "--layers", "all", "--seed", str(seed))
            assert done.returncode == 0, done.stderr
        name = f"near{seed % 2}.exr"
        told = ask(reviewer, "measure", name, "--display", "screen")
        white, black = (told["contrast"][k] for k in ("white_cd_m2", "black_cd_m2"))
        if reflected is None:
            reflected = seen_in(reviewer, room, panel, name)
        ratio = (white + reflected) / (black + reflected)
        known = {"/luminance_interval": white + reflected, "/contrast/interval": ratio,
                 "/xy_interval": OF_SEEDS, "/uv_interval": OF_SEEDS}
        content = {f"/content/{k}_interval": OF_SEEDS for k in (
            "ratio", "michelson", "weber", "characters", "ground")}
        tally.add("frame, near", told, {**known, **content})
        whole = ask(reviewer, "measure", f"eye{seed % 2}.exr", "--display", "screen")
        tally.add("frame, eye", whole, {**{k: OF_SEEDS for k in known}, **content})
        if seed > 1:
            compared = ask(reviewer, "compare", "near0.exr", "near1.exr")
            tally.add("frame, compare", compared, {"/ratio_interval": 1})


def seen_in(reviewer, room, panel, name):
    from exr import Frame
    seen = Frame(os.path.join(reviewer.folder, name))
    u, v = (seen.channels["uv." + axis] for axis in "UV")
    return black_box.closed_form(room, panel, [min(u), min(v), max(u), max(v)], 3)


def fisheye(reviewer, tally, seeds):
    own = glare.Program(reviewer.program, reviewer.folder)
    for seed in range(1, seeds + 1):
        found, wanted = glare.framed(own, seed, 10)
        tally.add("fisheye", found, {
            "/vertical_illuminance_interval": wanted["lx"],
            "/background_interval": wanted["background_cd_m2"],
            **{f"/{k}_interval": wanted[k] for k in ("ugr", "dgp", "dgi")}})


# ---- a gaze, eyes ---------------------------------------------------------------------------

def glint(reviewer, tally, seeds):
    places = gaze_intervals.PLACES if seeds > 3 else gaze_intervals.PLACES[:1]
    for k, place in enumerate(places):
        asked = gaze_intervals.Place(reviewer, place, range(k + 1, seeds + 1, len(places)),
                                     8 if seeds > 3 else 2)
        truth = gaze_intervals.closed(place, asked.dark)
        for review in asked.reviews:
            case = review["cases"][0]
            tally.add(f"glint {k}", {"gazes": review["gazes"]}, {
                f"/{name}_interval": value for name, value in truth.items()})
            tally.add(f"glint {k}", {"case": case}, {"/case*": OF_SEEDS})


# ---- a lamp and its image on a wall ---------------------------------------------------------

WALL, HALF = 0.5, 0.2     # reflectance; m, half of what the camera sees
CHROME = 0.9
LAMP, LAMP_AT, MIRROR_X = 1e4, [0.3, 0.2, 1.0], -1.0
LAMP_SIDES = (0.1, 0.25)  # m: a frame's samples meet it in the mirror 5 or 30 times
D65_XY, D65_UV = [0.31272, 0.32903], [0.19783, 0.46833]
METER_PATHS = "16384"


def wall_scene(side):
    scene = Scene()
    scene.quad(scene.lambert(WALL), [-0.5, -0.5, 0], [1, 0, 0], [0, 1, 0])
    x, y, z = LAMP_AT
    scene.quad(scene.emitter(LAMP), [x, y - side / 2, z + side / 2], [0, side, 0],
               [0, 0, -side])
    assert unit(cross([0, side, 0], [0, 0, -side]))[0] < 0
    scene.quad(scene.metal(CHROME), [MIRROR_X, -3, 0], [0, 6, 0], [0, 0, 6])
    scene.probe("front", [0, 0, 0.9], [0, 0, -1], HALF)
    return scene


def wall_lux(at, side, points=7):
    """By the lamp, and by its image behind the mirror, Schlick's reflectance at each point."""
    total = 0
    for i in range(points):
        for j in range(points):
            y, z = ((k + 0.5) / points * side - side / 2 for k in (i, j))
            for x in (LAMP_AT[0], 2 * MIRROR_X - LAMP_AT[0]):
                to = sub([x, LAMP_AT[1] + y, LAMP_AT[2] + z], at)
                beside = abs(unit(to)[0])
                share = 1 if x > 0 else CHROME + (1 - CHROME) * (1 - beside) ** 5
                total += share * beside * unit(to)[2] / dot(to, to)
    return LAMP * total * side ** 2 / points ** 2


def wall(reviewer, tally, seeds):
    for side in LAMP_SIDES:
        wall_scene(side).write(os.path.join(reviewer.folder, "wall.gltf"))
        grid = [HALF * (2 * (k + 0.5) / 9 - 1) for k in range(9)]
        mean = sum(wall_lux([x, y, 0], side, 5) for x in grid for y in grid) / 81
        name = f"wall, lamp of {100 * side:g} cm"
        for seed in range(1, seeds + 1):
            done = reviewer.run("render", "wall.gltf", "-o", "wall.exr", "--size", "32x32",
                                "--spp", SAMPLES, "--seed", str(seed), "--layers",
                                "halves,variance")
            assert done.returncode == 0, done.stderr
            tally.add(name, ask(reviewer, "measure", "wall.exr"), {
                "/luminance_interval": WALL * mean / math.pi, "/xy_interval": D65_XY,
                "/uv_interval": D65_UV})
            at = [HALF * math.sin(seed), HALF * math.cos(1.7 * seed), 1e-4]
            told = ask(reviewer, "measure", "wall.gltf", "--samples", METER_PATHS,
                       "--illuminance", ",".join(f"{c:.9g}" for c in at + [0, 0, 1]))
            tally.add(name, told, {"/illuminance_interval": wall_lux(at, side)})


ROOMS = {"gradient": gradient, "patch": patch, "frame": frame, "fisheye": fisheye,
         "glint": glint, "wall": wall}


def main(words):
    seeds, fewer = (ALL_SEEDS, {}) if "--all" in words else (SEEDS, FEWER)
    if "--seeds" in words:
        seeds, fewer = int(words[words.index("--seeds") + 1]), {}
    names = [name for name in ROOMS if name in words] or list(ROOMS)
    report = Report()
    tally = Tally(report)
    for name in names:
        with tempfile.TemporaryDirectory() as folder:
            shutil.copy(PANEL, os.path.join(folder, "ips.panel"))
            ROOMS[name](Reviewer(words[-1], folder), tally, fewer.get(name, seeds))
    tally.finish()
    return report.finish()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
