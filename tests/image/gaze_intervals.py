# SPDX-License-Identifier: Apache-2.0
"""gaze_intervals.py [--all] PARHELION -- intervals hold the truth, of a review with a gaze, an
eye and a symbol, where few paths find much of the light.

A pane across the gaze under an even sky mirrors a small bright lamp behind the eye: one
direction of some thousands of the cone meets it. Closed forms: a thin pane of index 1.5 mirrors
R = 2 r / (1 + r) = 0.077, r = 0.04; the lamp's image has the solid angle a^2 cos / d^2, its
mean over the cone is `mirrored`, and its illuminance times the eye's spread is its part of the
veil. What the even sky and the display do is known from the same scene without the lamp, and
the symbol's figures, which many paths find, from the mean of all seeds.
--all: 200 seeds over three places of the lamp, of which 93 % must hold; else three of one
place, of which one may miss."""
import math
import os
import shutil
import sys
import tempfile

from gltf import Scene, cross, dot, png, unit
from review import PANEL, Report, Reviewer, moment, request

SKY, LAMP, SIDE = 1000, 1e8, 0.0008  # cd/m2, cd/m2, m
PLACES = ([0.02, 0.145], [0.0, 0.125], [-0.012, 0.13])  # of the lamp, m across and up
GAZE, BEHIND = [0, 0.05, -1], 0.5
AGE, PIGMENT = 50, 0.5
SEEDS, REFERENCES = 3, 2  # of one place; or, with --all, of all of them:
ALL_SEEDS, ALL_REFERENCES = 200, 8
SHARE = 0.93
R = 2 * 0.04 / 1.04


def scene(place, luminance):
    out = Scene()
    bars = png(60, 30, [[255 if 20 <= x < 40 and 8 <= y < 22 else 0 for x in range(60)
                         for _ in range(3)] for y in range(30)])
    screen = out.material("screen", extensions={"PARHELION_display": {
        "panel": "ips.panel", "content": {"index": out.image("image/png", bars)}, "level": 1}})
    pane = out.material("pane", {"KHR_materials_transmission": {"transmissionFactor": 1}},
                        pbrMetallicRoughness={"metallicFactor": 0, "roughnessFactor": 0})
    out.quad(screen, [-0.146, -0.355, -0.6], [0.292, 0, 0], [0, 0.1095, 0])
    out.quad(pane, [-0.2, -0.1, -1], [0.4, 0, 0], [0, 0.4, 0])
    x, y = place
    out.quad(out.emitter(luminance), [x + SIDE / 2, y - SIDE / 2, BEHIND], [-SIDE, 0, 0],
             [0, SIDE, 0])
    return out


def asked(seed):
    return request(eyes={"eye": {"position_m": [0, 0, 0]}}, forward=[0, 0, -1],
                   observer={"age_years": AGE, "pigment": PIGMENT},
                   gaze=[{"name": "road", "direction": GAZE}],
                   conditions=[moment("sky", type="constant", luminance=SKY)],
                   precision={"contrast": 0.05, "seed": seed})


# ---- closed forms ---------------------------------------------------------------------------

def spread(degrees):
    """CIE 146's glare function, sr^-1 (src/vision/eye_spread.c)."""
    def peak(width):
        return (1 + (degrees / width) ** 2) ** -1.5
    age, x = (AGE / 70) ** 4, 1 + (degrees / 0.1) ** 2
    core = 9.2e6 * peak(0.0046) + 1.5e5 * peak(0.045)
    lens = 400 / x + 3e-8 * degrees ** 2
    wall = 1300 * peak(0.1) + 0.8 / math.sqrt(x)
    return ((1 - 0.08 * age) * core + (1 + 1.6 * age) * (lens + PIGMENT * wall) +
            2.5e-3 * PIGMENT)


def image(place):
    """The lamp's image from the eye: illuminance that it sends there, and degrees off."""
    to = [place[0], place[1], -2 - BEHIND]
    distance = math.sqrt(dot(to, to))
    lux = R * LAMP * SIDE ** 2 * (2 + BEHIND) / distance ** 3
    sine = math.sqrt(dot(cross(unit(to), unit(GAZE)), cross(unit(to), unit(GAZE))))
    return lux, math.degrees(math.asin(sine))


def closed(place, dark):
    """Figures of the gaze; dark: those without the lamp."""
    lux, degrees = image(place)
    cone = 2 * math.pi * (1 - math.cos(math.radians(1)))
    mirrored = R * SKY + lux / cone
    veil = dark["veil_cd_m2"]
    if degrees >= 0.1:
        veil += lux * math.cos(math.radians(degrees)) * spread(degrees)
    through, near = (1 - R) * SKY, dark["veil_parts_cd_m2"]["near"]
    return {"mirrored": mirrored, "veil": veil,
            "contrast": through / (through + mirrored + veil - near)}


# ---- what is printed ------------------------------------------------------------------------

def figures_of(review):
    """Every interval of the symbol with the figure that it is of."""
    case = review["cases"][0]
    light = case["luminance_cd_m2"]
    yield "contrast ratio", case["contrast_ratio"], case["contrast_interval"]
    yield "reflected", light["reflected"], case["reflected_interval"]
    for cause in case["causes"]:
        yield " ".join(map(str, cause["chain"])), cause["cd_m2"], cause["interval"]


class Place:
    """Reviews of one place of the lamp."""

    def __init__(self, reviewer, place, seeds, references):
        self.reviewer, self.place = reviewer, place
        dark = [self.review(seed, 0.001)["gazes"][0] for seed in range(1, 1 + references)]
        self.dark = {**{key: sum(g[key] for g in dark) / len(dark)
                        for key in ("veil_cd_m2", "cornea_lx")},
                     "veil_parts_cd_m2": {"near": sum(
                         g["veil_parts_cd_m2"]["near"] for g in dark) / len(dark)}}
        self.reviews = [self.review(seed, LAMP) for seed in seeds]

    def review(self, seed, luminance):
        scene(self.place, luminance).write(os.path.join(self.reviewer.folder, "dash.gltf"))
        return self.reviewer.review(asked(seed), "out", "--threads", "2")[1]

    def held(self):
        """(name, truth, low, high) of all reviews."""
        truth = closed(self.place, self.dark)
        for review in self.reviews:
            gaze = review["gazes"][0]
            for name, value in truth.items():
                yield name, value, *gaze[name + "_interval"]
        sums = {}
        for review in self.reviews:
            for name, value, _ in figures_of(review):
                sums.setdefault(name, []).append(value)
        for review in self.reviews:
            for name, _, (low, high) in figures_of(review):
                values = sums[name]
                if len(values) == len(self.reviews):  # else it is among the others at times
                    yield name, sum(values) / len(values), low, high


def check(report, places, count):
    held = {}
    for place in places:
        for name, truth, low, high in place.held():
            of = held.setdefault(name, [0, 0])
            of[0] += low <= truth <= high
            of[1] += 1
    for name, (good, all_of) in held.items():
        print(f"{name}: {good} of {all_of} hold")
        least = SHARE * all_of if count == ALL_SEEDS else all_of - 1
        report.claim(good >= least, f"{name}: {good} of {all_of} hold")


def main(words):
    is_all = "--all" in words
    count, references = (ALL_SEEDS, ALL_REFERENCES) if is_all else (SEEDS, REFERENCES)
    some = PLACES if is_all else PLACES[:1]
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        shutil.copy(PANEL, os.path.join(folder, "ips.panel"))
        reviewer = Reviewer(words[-1], folder)
        check(report, [Place(reviewer, place, range(k + 1, count + 1, len(some)), references)
                       for k, place in enumerate(some)], count)
    return report.finish()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
