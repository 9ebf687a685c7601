# SPDX-License-Identifier: Apache-2.0
"""glare.py [--all] PARHELION -- UGR, DGP and DGI of `measure --glare` are those of the closed
form, of a window in a fisheye frame; its settings change what the formulas say; and its
intervals hold the closed form: four seeds, with --all forty.
"""
import json
import math
import os
import subprocess
import sys
import tempfile

from gltf import Scene, along, cross, dot, unit

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

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


# ---- frames ---------------------------------------------------------------------------------

class Program:
    def __init__(self, program, folder):
        self.program, self.folder = os.path.abspath(program), folder

    def run(self, *words):
        done = subprocess.run([self.program, *words], cwd=self.folder, capture_output=True,
                              text=True, check=False)
        assert done.returncode == 0, done.stderr
        return done.stdout


def turned(yaw, pitch):
    a, b = math.radians(yaw), math.radians(pitch)
    return [math.sin(a) * math.cos(b), math.sin(b), -math.cos(a) * math.cos(b)]


LOOK = turned(-12, -8)


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


def framed(program, seed, width, size=256, luminance=8000):
    """The hole in a fisheye frame."""
    scene = Scene()
    shell(scene, scene.lambert(0, 50, double_sided=True), width)
    scene.environment(type="constant", luminance=luminance)
    scene.view("eye", [0, 0, -0.5], LOOK, 50)
    scene.write(os.path.join(program.folder, "hole.gltf"))
    program.run("render", "hole.gltf", "-o", "hole.exr", "--projection", "fisheye", "--size",
                 f"{size}x{size}", "--spp", "4", "--seed", str(seed), "--layers",
                 "halves,variance", "--max-bounces", "0", "--no-guiding", "--quiet")
    found = json.loads(program.run("measure", "hole.exr", "--glare", "--json"))
    disc = Disc(in_head([0, 0, -1], LOOK), width, luminance)
    wanted = figures(50, [disc])
    return found, {**wanted, "background_cd_m2": 50 * (1 - disc.cosines / math.pi)}


# ---- claims ---------------------------------------------------------------------------------

ALLOWED = {"ugr": 0.3, "dgp": 0.005, "dgi": 0.3}


def check_settings(report, program):
    """Of the last frame, in the words of the command line."""
    def read(*words):
        return json.loads(program.run("measure", "hole.exr", "--glare", "--json", *words))
    plain = read("--no-low-light")
    wanted = figures(50, [Disc(in_head([0, 0, -1], LOOK), 10, 8000)], False)
    report.claim(abs(plain["dgp"] - wanted["dgp"]) < ALLOWED["dgp"]
                 and not plain["settings"]["low_light"], f"DGP {plain['dgp']}, {wanted['dgp']}")
    above = read("--threshold", "20000")
    report.claim(above["ugr"] is None and above["missing"] and not above["sources"],
                 f"threshold: {above['ugr']}")
    task = read("--task-factor", "5", "--task-deg", "10")
    report.claim(abs(task["settings"]["threshold_cd_m2"] - 250) < 3 and task["ugr"] is not None,
                 f"task: {task['settings']}")


def spread_of(values):
    mean = sum(values) / len(values)
    return math.sqrt(sum((x - mean) ** 2 for x in values) / max(len(values) - 1, 1))


def check_coverage(report, program, seeds):
    """Over seeds, 95 % intervals hold the closed form, and are no wider than they must be: at
    most thirty standard deviations to each side. Frames have their samples well spread in each
    pixel, which its own variance does not tell."""
    told = [framed(program, seed, 10) for seed in range(1, seeds + 1)]
    for key in ("ugr", "dgp", "dgi", "background_cd_m2"):
        ranges = [item[key.replace("_cd_m2", "") + "_interval"] for item, _ in told]
        held = sum(low <= wanted[key] <= high for (low, high), (_, wanted) in zip(ranges, told))
        off = [item[key] - wanted[key] for item, wanted in told]
        spread, half = spread_of(off), sum(high - low for low, high in ranges) / 2 / len(told)
        print(f"{seeds} seeds: {key} {held} of {len(told)} intervals hold it; half a width "
              f"{half:.3g}, standard deviation {spread:.3g}", flush=True)
        report.claim(held >= 0.9 * len(told) and (seeds < 8 or half < 30 * spread),
                     f"{held} of {len(told)} intervals hold {key}; {half} wide, spread {spread}")
        report.claim(max(map(abs, off)) < ALLOWED.get(key, math.inf), f"{key}: off by {off}")


def main(program, whole):
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        own = Program(program, folder)
        check_coverage(report, own, 40 if whole else 4)
        check_settings(report, own)
    report.finish()


if __name__ == "__main__":
    main(sys.argv[-1], "--all" in sys.argv)
