# SPDX-License-Identifier: Apache-2.0
"""glare.py [--all] PARHELION -- UGR, DGP and DGI of a review's gazes and cases are those of the
closed form: round sources of 0.1 to 5 degrees in an even field, by day and by night. --all: all
sizes at 24 places each, with a table; else a few.
"""
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

# ---- closed forms -----------------------------------------------------------------------------


def position_index(right, up, forward):
    """Guth's above the line of sight, Iwata and Tokura's below."""
    sigma = math.degrees(math.atan2(math.hypot(right, up), forward))
    if up < 0:
        ratio = min(math.tan(math.radians(sigma)), 3) if sigma < 90 else 3
        return min(1 + (0.8 if ratio < 0.6 else 1.2) * ratio, 16)
    tau = math.degrees(math.atan2(abs(right), up))
    return min(math.exp((35.2 - 0.31889 * tau - 1.22 * math.exp(-2 * tau / 9)) / 1000 * sigma
                        + (21 + 0.26667 * tau - 0.002963 * tau * tau) / 1e5 * sigma * sigma), 16)


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


def figures(even, discs, low_light=True):
    """Illuminance, UGR, DGP, DGI of discs in an even field."""
    sources = sum(d.luminance * d.cosines for d in discs)
    background = math.pi * even - even * sum(d.cosines for d in discs)
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


# ---- reviews ----------------------------------------------------------------------------------


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


def cases_of_sphere(reviewer, width, luminance, looks, fields):
    """The same of cases: eyes about a small display look at it."""
    scene, far = Scene(), 100
    screen(scene)
    radius = far * math.sin(math.radians(width / 2))
    scene.sphere(scene.emitter(luminance), [0, 0, -far], radius, rings=64)
    eyes = {f"e{i:02}": [-x for x in turned(*look)] for i, look in enumerate(looks)}
    document = request(fields, gaze=[{"at": "symbols"}],
                       eyes={name: {"position_m": at} for name, at in eyes.items()})
    found = []
    for case in reviewer.review(scene, document)["cases"]:
        eye = eyes[case["eye"]]
        towards = sub([0, 0, -far], eye)
        size = 2 * math.degrees(math.asin(radius / math.sqrt(dot(towards, towards))))
        disc = Disc(in_head(towards, [-x for x in eye]), size, luminance)
        found.append((case, figures(fields[case["condition"]], [disc])))
    return found


# ---- claims -----------------------------------------------------------------------------------

ALLOWED = {"ugr": 0.3, "dgp": 0.005, "dgi": 0.3}


def errors_of(found):
    """Of figures beside closed forms: by figure, how many are missing, rms and greatest error."""
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


def main(program, whole):
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        reviewer = Reviewer(program, folder)
        check_sizes(report, reviewer, LUMINANCES if whole else (0.1, 1, 5), 24 if whole else 4)
    report.finish()


if __name__ == "__main__":
    main(sys.argv[-1], "--all" in sys.argv)
