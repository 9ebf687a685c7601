# SPDX-License-Identifier: Apache-2.0
"""reflection.py [PANEL...] PARHELION -- a dark display under the sun alone, and under a uniform
sky alone, shows the integral of its BRDF as `panel eval` tells it: luminance and its
lambertian part within 0.5 %, the share that is extrapolated within 0.01.

The luminous mean over wavelengths is that of D65 (assets/spectra); the sun's own spectrum is
near enough for a BRDF that changes slowly with wavelength.
"""
import csv
import json
import math
import os
import shutil
import subprocess

from exr import Frame
from gltf import Scene, along, cross, dot, unit
from panel_checks import ROOT, check_panels, direction

SUN_RADIUS = math.radians(0.26645)
EYES = [(0, 0), (30, 20), (35, 100), (55, 250), (70, 0)]     # theta, phi in degrees
SUNS = [(20, 130), (33, 200), (50, 60), (40, 178), (15, 90)]  # each before the eye of its place
LUX, SKY_CD_M2, WITHIN = 90000, 1000, 0.005
EXTRAPOLATED_WITHIN = 0.01


def angles(vector):
    return (math.degrees(math.acos(min(1, max(-1, vector[2])))),
            math.degrees(math.atan2(vector[1], vector[0])) % 360)


def spectrum(name, column):
    """nm -> value of one of the CSV files, linear between its rows."""
    with open(os.path.join(ROOT, "assets", "spectra", name), encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    points = [(float(row["nm"]), float(row[column])) for row in rows]

    def value(nm):
        for (a, low), (b, high) in zip(points, points[1:]):
            if a <= nm <= b:
                return low + (high - low) * (nm - a) / (b - a)
        return 0
    return value


def luminous_weights(wavelengths):
    """What each measured wavelength counts in a luminance under D65, in sum one: linear
    interpolation between them, the end values outside."""
    observer, light = spectrum("cie1931_2deg.csv", "y"), spectrum("d65.csv", "power")
    weights = [0.0] * len(wavelengths)
    for nm in range(360, 831):
        share = observer(nm) * light(nm)
        after = next((i for i, w in enumerate(wavelengths) if w >= nm), len(wavelengths))
        if after in (0, len(wavelengths)):
            weights[min(after, len(wavelengths) - 1)] += share
        else:
            a, b = wavelengths[after - 1], wavelengths[after]
            weights[after - 1] += share * (b - nm) / (b - a)
            weights[after] += share * (nm - a) / (b - a)
    total = sum(weights)
    return [w / total for w in weights]


class Panel:
    """Luminous BRDF and mirror reflectance, asked of the program for many directions."""

    def __init__(self, program, path, folder):
        self.program, self.path, self.folder, self.weights = program, path, folder, None

    def ask(self, eye, lights, names=("brdf_sr", "lambertian_sr", "extrapolated")):
        """[(brdf, its lambertian part, is it extrapolated)] for one eye and many directions of
        light."""
        rows = os.path.join(self.folder, "rows.csv")
        theta, phi = angles(eye)
        with open(rows, "w", encoding="utf-8") as file:
            file.write("incidence,incidence_phi,theta,phi\n")
            for light in lights:
                file.write("{:.9g},{:.9g},{:.9g},{:.9g}\n".format(*angles(light), theta, phi))
        done = subprocess.run([self.program, "panel", "eval", self.path, "--brdf", "--batch",
                               rows, "--json"], check=True, capture_output=True, text=True)
        answers = json.loads(done.stdout)
        self.weights = self.weights or luminous_weights(answers[0]["wavelengths_nm"])
        return [[dot(self.weights, a[name]) if isinstance(a[name], list) else a[name]
                 for name in names] for a in answers]


def disc(centre, rings=6):
    """Equal-area points of the sun's disc."""
    x = unit(cross(centre, [0.3, 1, 0.2]))
    y = cross(centre, x)
    points = []
    for i in range(rings):
        for j in range(6 * i + 3):
            radius = SUN_RADIUS * math.sqrt(disc_share(i, rings))
            turn = 2 * math.pi * (j + 0.5) / (6 * i + 3)
            points.append(unit(along(along(centre, x, radius * math.cos(turn)), y,
                                     radius * math.sin(turn))))
    return points


def disc_share(ring, rings):
    """Middle of the ring, as a share of the disc's area; ring i has 6 i + 3 points of 3 n^2."""
    return (ring * ring + (ring + 1) ** 2) / 2 / rings ** 2


def under_sun(panel, eye, sun):
    points = disc(sun)
    values = panel.ask(eye, points)
    return [LUX * sum(v[i] * p[2] for v, p in zip(values, points)) / len(points)
            for i in (0, 1)]


def under_sky(panel, eye, steps=90, turns=72):
    """Midpoints in rings about the mirror direction, dense where the haze is steep."""
    mirror = [-eye[0], -eye[1], eye[2]]
    x = unit(cross(mirror, [0.3, 1, 0.2]))
    y = cross(mirror, x)
    lights, shares, total = [], [], 0
    for i in range(steps):
        inner, outer = (math.pi * (k / steps) ** 2 for k in (i, i + 1))
        middle = (inner + outer) / 2
        solid = (math.cos(inner) - math.cos(outer)) * 2 * math.pi / turns
        for j in range(turns):
            turn = 2 * math.pi * (j + 0.5) / turns
            across = along([math.cos(turn) * k for k in x], y, math.sin(turn))
            light = unit(along([math.cos(middle) * k for k in mirror], across,
                               math.sin(middle)))
            if light[2] > 1e-6:
                lights.append(light)
                shares.append(solid * light[2])
    values = panel.ask(eye, lights)
    total, lambertian = (sum(v[i] * share for v, share in zip(values, shares)) for i in (0, 1))
    guess = sum(v[0] * share for v, share in zip(values, shares) if v[2])
    in_mirror, is_guess = panel.ask(eye, [mirror], ["mirror", "extrapolated"])[0]
    total += in_mirror
    guess += in_mirror * is_guess
    return SKY_CD_M2 * total, SKY_CD_M2 * lambertian, guess / total


def scene_of(panel_path, environment, eyes):
    scene = Scene()
    material = scene.material("display", extensions={"PARHELION_display": {
        "panel": panel_path, "level": 0}})
    scene.quad(material, [-1, -1, 0], [2, 0, 0], [0, 2, 0])
    scene.environment(**environment)
    for i, eye in enumerate(eyes):
        scene.probe(f"eye{i}", [0.05 * k for k in eye], [-k for k in eye], 0.001)
    return scene


def stated_share(program, frame):
    """Of the reflected light; the line that people read says the same."""
    text, answer = (subprocess.run([program, "measure", frame, *words], check=True,
                                   capture_output=True, text=True).stdout
                    for words in ((), ("--json",)))
    share = json.loads(answer)["contrast"]["extrapolated_share"]
    told = [float(line.split()[-2]) for line in text.splitlines()
            if line.startswith("reflected, by extrapolation")]
    assert abs(sum(told) - 100 * share) <= 0.005 * 100 * share + 0.001, text
    return share


def shown(program, path, camera, folder, with_parts):
    """The frame's luminance, with samples until its own error is a fifth of the allowed; that
    of the lambertian layer and the extrapolated share as `measure` states it, for which the
    first samples do; None where nobody asks."""
    samples, out, parts = 256, os.path.join(folder, "frame.exr"), None
    while True:
        more = ",display" if with_parts and not parts else ""
        subprocess.run([program, "render", path, "-o", out, "--camera", camera, "--size",
                        "16x16", "--spp", str(samples), "--max-bounces", "1", "--layers",
                        "variance" + more, "--quiet"],
                       check=True, capture_output=True, text=True)
        frame = Frame(out)
        if more:
            parts = frame.mean_of("display.lambertian"), stated_share(program, out)
        mean, sigma = frame.mean_luminance()
        excess = 5 * sigma / (WITHIN * mean)
        if excess <= 1 or samples >= 65536:
            return (mean, sigma), parts
        samples = math.ceil(min(65536, 1.1 * samples * excess ** 2))


def sun_environment(sun):
    """The glTF description of a sun in this direction; north is -Z, east +X."""
    azimuth = math.degrees(math.atan2(sun[0], -sun[2])) % 360
    return {"type": "constant", "luminance": 0, "sun": {
        "azimuth_deg": azimuth, "elevation_deg": math.degrees(math.asin(sun[1])),
        "illuminance_lx": LUX}}


def claim(report, what, value, expected):
    mean, sigma = value
    text = (f"{what}: {mean:.6g} cd/m2 in the frame, {expected:.6g} by `panel eval` "
            f"({100 * (mean / expected - 1):+.2g} %, sigma {100 * sigma / expected:.2g} %)")
    if report.claim(abs(mean - expected) <= WITHIN * expected + 3 * sigma, text):
        print(f"passed {text}")


def claim_extrapolated(report, what, found, expected):
    text = f"{what}: {found:.4f} of it is extrapolated, {expected:.4f} by `panel eval`"
    if report.claim(abs(found - expected) <= EXTRAPOLATED_WITHIN, text):
        print(f"passed {text}")


def claim_lambertian(report, what, found, expected):
    text = (f"{what}: {found:.6g} cd/m2 lambertian, {expected:.6g} by `panel eval` "
            f"({100 * (found / expected - 1):+.2g} %)")
    if report.claim(abs(found - expected) <= WITHIN * expected, text):
        print(f"passed {text}")


def check_panel(report, program, path, folder):
    panel, name = Panel(program, path, folder), os.path.basename(path)
    shutil.copy(path, folder)  # a scene reads only what lies in or beside its folder
    scene_path = os.path.join(folder, "scene.gltf")
    eyes = [direction(*eye) for eye in EYES]

    def check(i, light, expected):
        what = f"{name} from {EYES[i]} under {light}"
        found, parts = shown(program, scene_path, f"eye{i}", folder, i % 2 == 0)
        claim(report, what, found, expected[0])
        if parts:
            claim_lambertian(report, what, parts[0], expected[1])
        if parts and len(expected) > 2:
            claim_extrapolated(report, what, parts[1], expected[2])
    for i, (eye, sun_angles) in enumerate(zip(eyes, SUNS)):
        sun = direction(*sun_angles)
        scene_of(name, sun_environment(sun), eyes).write(scene_path)
        check(i, f"the sun at {sun_angles}", under_sun(panel, eye, sun))
    scene_of(name, {"type": "constant", "luminance": SKY_CD_M2}, eyes).write(scene_path)
    for i, eye in enumerate(eyes):
        check(i, "a uniform sky", under_sky(panel, eye))


if __name__ == "__main__":
    check_panels(check_panel)
