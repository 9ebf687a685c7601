# SPDX-License-Identifier: Apache-2.0
"""glare.py [--all] PARHELION -- UGR, DGP and DGI of a review's gazes and cases are those of the
closed form: round sources of 0.1 to 5 degrees in an even field, by day and by night. --all: all
sizes at 24 places each, with a table; else a few. And how often their intervals hold the closed
form, and those of `measure --glare`: over forty seeds with --all.
"""
import csv
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile

from gltf import Scene, along, cross, dot, png, sub, unit

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

PANEL = os.path.join(ROOT, "assets", "panels", "ips_cluster.panel")
FIELDS = {"day": 300, "night": 0.05}  # cd/m2
LUMINANCES = {0.1: 1e6, 0.2: 5e5, 0.5: 2e5, 1: 1e5, 2: 3e4, 5: 1e4}  # by full width, degrees

# ---- closed forms ---------------------------------------------------------------------------


def position_index(right, up, forward):
    """Guth's above the line of sight, Iwata and Tokura's below."""
    sigma = math.degrees(math.atan2(math.hypot(right, up), forward))
    if up < 0:
        ratio = min(math.tan(math.radians(sigma)), 3) if sigma < 90 else 3
        return min(1 + (0.8 if ratio < 0.6 else 1.2) * ratio, 16)
    tau = math.degrees(math.atan2(abs(right), up))
    linear = (35.2 - 0.31889 * tau - 1.22 * math.exp(-2 * tau / 9)) / 1000
    square = (21 + 0.26667 * tau - 0.002963 * tau * tau) / 1e5
    return min(math.exp(linear * sigma + square * sigma * sigma), 16)


def axes_about(direction):
    z = unit(direction)
    x = unit(cross([0, 1, 0] if abs(z[1]) < 0.9 else [1, 0, 0], z))
    return x, cross(z, x), z


class Disc:
    """A round source: its solid angle, and the means over it that the figures need."""

    def __init__(self, direction, width_deg, luminance, steps=60):
        """direction: right, up, forward of the head."""
        x, y, z = axes_about(direction)
        low = math.cos(math.radians(width_deg / 2))
        self.luminance, self.sr = luminance, 2 * math.pi * (1 - low)
        self.cosines = self.weights = 0
        for i in range(steps):
            cosine = 1 - (1 - low) * (i + 0.5) / steps
            sine = math.sqrt(1 - cosine * cosine)
            for k in range(steps):
                phi = 2 * math.pi * (k + 0.5) / steps
                d = along(along([cosine * c for c in z], x, sine * math.cos(phi)), y,
                          sine * math.sin(phi))
                self.cosines += d[2] * self.sr / steps ** 2
                self.weights += self.sr / steps ** 2 / position_index(*d) ** 2


def figures(even, discs, low_light=True, around_lx=None):
    """Illuminance, UGR, DGP, DGI of discs in an even field, or in one that gives so much."""
    sources = sum(d.luminance * d.cosines for d in discs)
    background = (around_lx or math.pi * even) - even * sum(d.cosines for d in discs)
    lux, behind = sources + background, background / math.pi
    squares = sum(d.luminance ** 2 * d.weights for d in discs)
    ugr = 8 * math.log10(0.25 / behind * squares)
    dgp = min(5.87e-5 * lux + 0.092 * math.log10(1 + squares / lux ** 1.87) + 0.159, 1)
    if low_light and lux < 1000:
        dgp /= 1 + math.exp(4 - 0.024 * lux)
    dgi = 10 * math.log10(sum(
        0.478 * d.luminance ** 1.6 * d.weights ** 0.8
        / (behind + 0.07 * math.sqrt(d.sr) * d.luminance) for d in discs))
    return {"lx": lux, "ugr": ugr, "dgp": dgp, "dgi": dgi}


def in_head(towards, gaze):
    """A direction as right, up, forward of an upright head."""
    forward = unit(gaze)
    right = unit(cross(forward, [0, 1, 0]))
    d = unit(towards)
    return [dot(d, right), dot(d, cross(right, forward)), dot(d, forward)]


# ---- reviews --------------------------------------------------------------------------------


def places(count):
    """Gazes, yaw and pitch in degrees from -Z: to all sides, 4 to 55 degrees away."""
    found = []
    for i in range(count):
        away = 4 + 51 * ((i * 0.618034 + 0.3) % 1)
        about = 2 * math.pi * (i + 0.4) / count
        found.append((away * math.cos(about), away * math.sin(about)))
    return found


def turned(yaw, pitch):
    a, b = math.radians(yaw), math.radians(pitch)
    return [math.sin(a) * math.cos(b), math.sin(b), -math.cos(a) * math.cos(b)]


def screen(scene):
    """A dark display of 2 cm about the origin that faces +Z."""
    bars = png(30, 30, [[255 if 10 <= x < 20 and 8 <= y < 22 else 0 for x in range(30)
                         for _ in range(3)] for y in range(30)])
    shown = scene.material("screen", extensions={"PARHELION_display": {
        "panel": "ips.panel", "content": {"index": scene.image("image/png", bars)}}})
    scene.quad(shown, [-0.01, -0.01, 0], [0.02, 0, 0], [0, 0.02, 0])


def request(conditions, **members):
    return {"title": "glare", "scene": ["room.gltf"], "forward": [0, 0, -1],
            "symbols": {"bar": {"display": "screen", "uv": [0.1, 0.1, 0.9, 0.9]}},
            "profile": "iso-15008", "precision": {"contrast": 0.2},
            "levels": {"off": {"*": 0.0001}},
            "conditions": [{"name": name, "level": "off",
                            "environment": {"type": "constant", "luminance": luminance}}
                           for name, luminance in conditions.items()],
            "frames": {"size": [64, 36], "noise": 0.5, "worst": 0}, **members}


class Reviewer:
    def __init__(self, program, folder):
        self.program, self.folder = os.path.abspath(program), folder
        shutil.copy(PANEL, os.path.join(folder, "ips.panel"))

    def run(self, *words):
        done = subprocess.run([self.program, *words], cwd=self.folder, capture_output=True,
                              text=True, check=False)
        assert done.returncode == 0, done.stderr
        return done.stdout

    def review(self, scene, document, *options):
        scene.write(os.path.join(self.folder, "room.gltf"))
        with open(os.path.join(self.folder, "r.json"), "w", encoding="utf-8") as file:
            json.dump(document, file)
        shutil.rmtree(os.path.join(self.folder, "out"), ignore_errors=True)
        done = subprocess.run([self.program, "review", "r.json", "-o", "out",
                               "--quiet", *options], cwd=self.folder, capture_output=True,
                              text=True, check=False)
        assert done.returncode in (0, 1), done.stderr
        with open(os.path.join(self.folder, "out", "review.json"), encoding="utf-8") as file:
            return json.load(file)


def gazes_of_sphere(reviewer, width, luminance, looks, fields):
    """The gazes' findings of a sphere far away, each with the closed form's."""
    scene, far = Scene(), 20
    screen(scene)
    scene.sphere(scene.emitter(luminance), [0, 0, -far],
                 far * math.sin(math.radians(width / 2)), rings=64)
    eye = [0, 0, -0.5]
    document = request(fields, eyes={"eye": {"position_m": eye}},
                       gaze=[{"name": f"g{i:02}", "direction": turned(*look)}
                             for i, look in enumerate(looks)])
    found = []
    for gaze in reviewer.review(scene, document)["gazes"]:
        disc = Disc(in_head([0, 0, -1], turned(*looks[int(gaze["gaze"][1:])])),
                    2 * math.degrees(math.asin(far * math.sin(math.radians(width / 2))
                                               / (far - 0.5))), luminance)
        found.append((gaze, figures(fields[gaze["condition"]], [disc])))
    return found


def cases_of_sphere(reviewer, width, luminance, looks, fields, **members):
    """The same of cases: eyes about a small display look at it."""
    scene, far = Scene(), 100
    screen(scene)
    radius = far * math.sin(math.radians(width / 2))
    scene.sphere(scene.emitter(luminance), [0, 0, -far], radius, rings=64)
    eyes = {f"e{i:02}": [-x for x in turned(*look)] for i, look in enumerate(looks)}
    document = request(fields, gaze=[{"at": "symbols"}], **members,
                       eyes={name: {"position_m": at} for name, at in eyes.items()})
    found = []
    for case in reviewer.review(scene, document)["cases"]:
        eye = eyes[case["eye"]]
        towards = sub([0, 0, -far], eye)
        size = 2 * math.degrees(math.asin(radius / math.sqrt(dot(towards, towards))))
        disc = Disc(in_head(towards, [-x for x in eye]), size, luminance)
        found.append((case, figures(fields[case["condition"]], [disc])))
    return found


# ---- claims ---------------------------------------------------------------------------------

ALLOWED = {"ugr": 0.3, "dgp": 0.005, "dgi": 0.3}


def errors_of(found):
    """Of figures beside closed forms: how many are missing, rms and greatest error."""
    table = {}
    for key in ALLOWED:
        apart = [item[key] - wanted[key] for item, wanted in found
                 if item.get(key) is not None]
        rms = math.sqrt(sum(x * x for x in apart) / len(apart)) if apart else math.nan
        table[key] = (len(found) - len(apart), rms, max(map(abs, apart), default=math.nan))
    return table


def check_sizes(report, reviewer, sizes, count):
    looks = places(count)
    for kind, read in (("gazes", gazes_of_sphere), ("cases", cases_of_sphere)):
        for width in sizes:
            found = read(reviewer, width, LUMINANCES[width], looks, FIELDS)
            for field in FIELDS:
                table = errors_of([f for f in found if f[0]["condition"] == field])
                print(f"{kind} {width:4} deg {field:5}: " + "; ".join(
                    f"{key} {missing} missing, rms {rms:.4f}, most {most:.4f}"
                    for key, (missing, rms, most) in table.items()), flush=True)
                for key, (missing, _, most) in table.items():
                    report.claim(not missing and most <= ALLOWED[key],
                                 f"{kind}, {width} degrees, {field}: {key} {missing} missing, "
                                 f"{most:.4f} off at most")


def gazes(reviewer, scene, looks, fields, eye=(0, 0, -0.5), conditions=None, **members):
    """The gazes' findings of a scene, in the order of conditions and looks."""
    screen(scene)
    document = request(fields, eyes={"eye": {"position_m": list(eye)}}, **members,
                       gaze=[{"name": f"g{i:02}", "direction": look}
                             for i, look in enumerate(looks)])
    if conditions:
        document["conditions"] = conditions
    return reviewer.review(scene, document)["gazes"]


def ball(scene, right, up, width, luminance, far=20, eye=(0, 0, -0.5)):
    """A sphere that an eye that looks along -Z sees there, degrees."""
    centre = along(list(eye), turned(right, up), far)
    scene.sphere(scene.emitter(luminance), centre, far * math.sin(math.radians(width / 2)),
                 rings=64)


def check_examples(report, reviewer):
    """The table of closed forms that the project was given: its DGP has the first paper's
    coefficients, 0.0918 and 0.16, where ours are evalglare's, 0.092 and 0.159."""
    path = os.path.join(ROOT, "..", "shared", "data", "cases", "sky", "glare.csv")
    if not os.path.exists(path):
        report.skip("glare.csv: no shared data")
        return
    with open(path, encoding="utf-8", newline="") as file:
        rows = [row for row in csv.reader(file) if row[0] != "case"]
    for row in rows:
        scene = Scene()
        for source in row[2].split(";"):
            ball(scene, *map(float, source.split()))
        found = gazes(reviewer, scene, [[0, 0, -1]], {"even": float(row[1])})[0]
        wanted = dict(zip(("cornea_lx", "ugr", "dgp"), map(float, row[3:])))
        for key, allowed in (("cornea_lx", 0.003 * wanted["cornea_lx"]), ("ugr", 0.1),
                             ("dgp", 0.002)):
            report.claim(found[key] is not None and abs(found[key] - wanted[key]) <= allowed,
                         f"case {row[0]}: {key} {found[key]}, required: {wanted[key]}")
        report.claim(found["glare"]["sources"] == len(row[2].split(";")),
                     f"case {row[0]}: {found['glare']['sources']} sources")


def check_no_source(report, reviewer, whole):
    """A white room that a lamp behind the eye lights: noise is no source. Then an even field
    above the threshold, and one just below and above."""
    scene = Scene()
    scene.box_inside(scene.lambert(0.8), [-2, -1.5, -3], [2, 1.5, 3])
    scene.light("point", 150, [0.5, 0.5, 1.5])
    looks = [turned(yaw, 0) for yaw in ((0, 25, -25) if whole else (25,))]
    black = {"dark": 0.01}
    for found in gazes(reviewer, scene, looks, black):
        report.claim(found["ugr"] is None and found["dgi"] is None
                     and found["glare"]["no_ugr_because"] and found["glare"]["sources"] == 0,
                     f"white room: UGR {found['ugr']}, {found['glare']}")
        lux = found["cornea_lx"]
        dgp = (5.87e-5 * lux + 0.159) / (1 + math.exp(4 - 0.024 * lux) if lux < 1000 else 1)
        report.claim(abs(found["dgp"] - dgp) < 0.001, f"white room: DGP {found['dgp']}, {dgp}")
    evens = {"below": 1900, "above": 2100, "bright": 5000, "peak": 80000}
    for found in gazes(reviewer, Scene(), [[0, 0, -1]], evens):
        name, even = found["condition"], evens[found["condition"]]
        why = found["glare"]["no_ugr_because"] or ""
        report.claim(found["ugr"] is None
                     and ("no source" if even < 2000 else "no background") in why,
                     f"even field {name}: UGR {found['ugr']}, {why!r}")
        report.claim(found["dgp"] is not None, f"even field {name}: no DGP")
        report.claim((found["dgi"] is None) == (even < 2000), f"even field {name}: DGI")


def check_settings(report, reviewer):
    """The request's settings change what the formulas say they change."""
    def read(**glare):
        scene = Scene()
        ball(scene, 15, 10, 2, 5000)
        return gazes(reviewer, scene, [[0, 0, -1]], {"even": 60}, glare=glare)[0]
    usual, disc = read(), Disc(turned(15, 10)[:2] + [-turned(15, 10)[2]], 2, 5000)
    wanted = figures(60, [disc])
    report.claim(abs(usual["ugr"] - wanted["ugr"]) < 0.05, f"UGR {usual['ugr']}")
    plain = read(low_light_factor=False)
    report.claim(abs(plain["dgp"] - figures(60, [disc], False)["dgp"]) < 0.001
                 and not plain["glare"]["low_light_factor"], f"DGP {plain['dgp']}")
    report.claim(usual["glare"]["low_light_factor"], "the low-light factor is not said")
    above = read(threshold_cd_m2=6000)
    report.claim(above["ugr"] is None and above["glare"]["threshold_cd_m2"] == 6000,
                 f"threshold: {above['ugr']}")
    task = read(task_factor=5, task_deg=20)
    report.claim(abs(task["glare"]["threshold_cd_m2"] - 300) < 3 and task["ugr"] is not None,
                 f"task: {task['glare']}")
    for key in ("ugr", "dgp", "dgi"):
        low, high = usual[f"{key}_interval"]
        report.claim(low <= usual[key] <= high and high - low < 0.3, f"{key} {low} {high}")


def shell(scene, material, width, radius=2, centre=(0, 0, -0.5), steps=180, rings=36):
    """A sphere about the centre but for a round hole towards -Z, `width` degrees wide."""
    points, faces = [], []
    for i in range(rings + 1):
        t = math.radians(width / 2 + (180 - width / 2) * (i / rings) ** 2)
        points += [[radius * math.sin(t) * math.cos(2 * math.pi * k / steps) + centre[0],
                    radius * math.sin(t) * math.sin(2 * math.pi * k / steps) + centre[1],
                    -radius * math.cos(t) + centre[2]] for k in range(steps)]
    for i in range(rings):
        for k in range(steps):
            a, b = steps * i + k, steps * i + (k + 1) % steps
            faces += [[a, b, a + steps], [a + steps, b, b + steps]]
    scene.mesh(material, points, faces)


def claim_figures(report, found, wanted, what):
    report.claim(found["ugr"] is not None and abs(found["ugr"] - wanted["ugr"]) < 0.3
                 and abs(found["dgp"] - wanted["dgp"]) < 0.005,
                 f"{what}: UGR {found['ugr']}, {wanted['ugr']:.3f}; DGP {found['dgp']}, "
                 f"{wanted['dgp']:.4f}")


LOOKS = [turned(-12, -8), turned(20, -15), turned(2, 35)]


def window(reviewer, width, luminance, looks, **members):
    """Gazes at sky in a round hole of walls of 50 cd/m2 all around, with closed forms."""
    scene = Scene()
    shell(scene, scene.lambert(0, 50, double_sided=True), width)
    return [(found, figures(50, [Disc(in_head([0, 0, -1], looks[int(found["gaze"][1:])]),
                                      width, luminance)]))
            for found in gazes(reviewer, scene, looks, {"sky": luminance}, **members)]


def sunlit(reviewer, width, looks, lux=50000, reflectance=0.8, **members):
    """Gazes at a white disc that the sun lights from behind the eye, in an even field."""
    scene, far, steps = Scene(), 20, 120
    radius = far * math.tan(math.radians(width / 2))
    points = [[0, 0, -0.5 - far]] + [
        [radius * math.cos(2 * math.pi * k / steps),
         radius * math.sin(2 * math.pi * k / steps), -0.5 - far] for k in range(steps)]
    scene.mesh(scene.lambert(reflectance), points,
               [[0, 1 + k, 1 + (k + 1) % steps] for k in range(steps)])
    sun = {"azimuth_deg": 180, "elevation_deg": 40, "illuminance_lx": lux}
    luminance = reflectance * (lux * math.cos(math.radians(40)) / math.pi + 50)
    conditions = [{"name": "sun", "level": "off", "environment": {
        "type": "constant", "luminance": 50, "sun": sun}}]
    return [(found, figures(50, [Disc(in_head([0, 0, -1], looks[int(found["gaze"][1:])]),
                                      width, luminance)]))
            for found in gazes(reviewer, scene, looks, {}, conditions=conditions, **members)]


def check_surfaces(report, reviewer, whole):
    """Windows and sunlit surfaces, which have no light samples."""
    windows = ((1, 30000), (3, 8000), (20, 8000), (3, 200000))
    for i, (width, luminance) in enumerate(windows if whole else windows[::2]):
        for found in window(reviewer, width, luminance, LOOKS if whole else LOOKS[i:i + 1]):
            claim_figures(report, *found, f"a hole of {width} degrees")
    for i, width in enumerate((1, 3, 10) if whole else (1, 10)):
        for found in sunlit(reviewer, width, LOOKS if whole else LOOKS[2 - i:3 - i]):
            claim_figures(report, *found, f"a sunlit disc of {width}")


# ---- intervals ------------------------------------------------------------------------------

def framed(reviewer, seed, width, size=256, luminance=8000):
    """The hole in a fisheye frame."""
    scene, look = Scene(), LOOKS[0]
    shell(scene, scene.lambert(0, 50, double_sided=True), width)
    scene.environment(type="constant", luminance=luminance)
    scene.view("eye", [0, 0, -0.5], look, 50)
    scene.write(os.path.join(reviewer.folder, "hole.gltf"))
    reviewer.run("render", "hole.gltf", "-o", "hole.exr", "--projection", "fisheye", "--size",
                 f"{size}x{size}", "--spp", "4", "--seed", str(seed), "--layers",
                 "halves,variance", "--max-bounces", "0", "--no-guiding", "--quiet")
    found = json.loads(reviewer.run("measure", "hole.exr", "--glare", "--json"))
    disc = Disc(in_head([0, 0, -1], look), width, luminance)
    wanted = figures(50, [disc])
    return found, {**wanted, "background_cd_m2": 50 * (1 - disc.cosines / math.pi)}


def spread_of(values):
    mean = sum(values) / len(values)
    return math.sqrt(sum((x - mean) ** 2 for x in values) / max(len(values) - 1, 1))


def check_coverage(report, reviewer, seeds):
    """Over seeds, 95 % intervals hold the closed form, and are no wider than they must be: at
    most ten standard deviations to each side. Frames have their samples well spread in each
    pixel, which its own variance does not tell."""
    rooms = {
        "gazes at a window": (window, (10, 8000, LOOKS), 10),
        "gazes at a sunlit disc": (sunlit, (3, LOOKS), 10),
        "cases beside a lamp": (cases_of_sphere, (1, 1e5, [(-12, -8), (20, -15)],
                                                  {"day": 300}), 10),
        "a frame of a window": (framed, None, 30)}
    for room, (read, words, most) in rooms.items():
        told = []
        for seed in range(1, seeds + 1):
            precision = {"contrast": 0.2, "seed": seed}
            told += [framed(reviewer, seed, 10)] if words is None else read(
                reviewer, *words, precision=precision)
        keys = ("ugr", "dgp", "dgi") + (("background_cd_m2",) if words is None else ())
        for key in keys:
            ranges = [item[key.replace("_cd_m2", "") + "_interval"] for item, _ in told]
            held = sum(low <= wanted[key] <= high
                       for (low, high), (_, wanted) in zip(ranges, told))
            spread = spread_of([item[key] - wanted[key] for item, wanted in told])
            half = sum(high - low for low, high in ranges) / 2 / len(told)
            print(f"{room}, {seeds} seeds: {key} {held} of {len(told)} intervals hold it; half "
                  f"a width {half:.3g}, standard deviation {spread:.3g}", flush=True)
            report.claim(held >= 0.9 * len(told) and (seeds < 8 or half < most * spread),
                         f"{room}: {held} of {len(told)} intervals hold {key}; {half} wide, "
                         f"spread {spread}")


def check_threads(report, reviewer):
    """Nothing depends on how many threads read it."""
    texts = []
    for threads in ("1", "5"):
        scene = Scene()
        ball(scene, 12, 5, 0.3, 5e5)
        scene.box_inside(scene.lambert(0.3), [-2, -1.5, -3], [2, 1.5, 3])
        screen(scene)
        document = request({"grey": 3000}, eyes={"eye": {"position_m": [0, 0, -0.5]}},
                           gaze=[{"at": "symbols"}, {"name": "g", "direction": [0, 0, -1]}])
        review = reviewer.review(scene, document, "--threads", threads)
        texts.append(json.dumps([review["cases"], review["gazes"]]))
    report.claim(len(set(texts)) == 1, "figures depend on the number of threads")


def main(program, whole):
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        reviewer = Reviewer(program, folder)
        check_examples(report, reviewer)
        check_no_source(report, reviewer, whole)
        check_settings(report, reviewer)
        check_surfaces(report, reviewer, whole)
        check_threads(report, reviewer)
        check_sizes(report, reviewer, LUMINANCES if whole else (0.1, 5), 24 if whole else 1)
        if whole:
            check_coverage(report, reviewer, 40)
    report.finish()


if __name__ == "__main__":
    main(sys.argv[-1], "--all" in sys.argv)
