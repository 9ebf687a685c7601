# SPDX-License-Identifier: Apache-2.0
"""rare_hunt.py -- one rare room (rare_rooms.py) of the hunt, asked in several ways: a review
under its light alone, through grey and two crossed polarising lenses, under a weather's sky
with and without its sun, and under an even sky alone; a frame of the display, and `measure` of
that.

What each says is held against the closed form of black walls, or against the same room whose
patches of sun are lamps. Sky that comes in by a small opening is rarely known well: its
interval holds the truth, which is counted over all rooms, or misses it by no more than chance
does. No verdict may contradict the true contrast. Displays are the shipped panels and two that
are fitted to foreign measurements, a list and matrices, where the shared data are there.
"""
import glob
import json
import math
import os
import random
import subprocess
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "image"))
import black_box  # noqa: E402
import rare  # noqa: E402
import rare_rooms  # noqa: E402
import reflection  # noqa: E402
from review import ROOT, moment  # noqa: E402
import rooms  # noqa: E402

TOO_FAR = 4            # standard errors, hunt.py's
CLOSED_SHARE = 0.004   # what sums over directions, and D65 between wavelengths, leave
WHITE_CD_M2, LIMIT = 500, 5
KNOWN_WITHIN = 0.1     # a standard error, of the truth: what is not found is not known, too
SKY_CD_M2 = 8000
PRECISE = {"contrast": 0.003, "clear": 0.003}
WEATHER = {"type": "perez", "direct_normal_w_m2": 500, "diffuse_horizontal_w_m2": 120}
GREY = {"transmittance": 0.3}
FOREIGN = os.path.join(os.environ.get("SHARED_DATA_DIR",
                                      os.path.join(ROOT, "..", "shared", "data")), "panels")
LAYOUTS = {"list": ("set-a/[RGBK]_*.csv", "set-a/BRDF_*.csv"),
           "matrices": ("set-b/*.txt", "set-a/BRDF_*.csv")}  # with no reflection of its own


def crossed(axis):
    return {"transmittance": 0.2, "polarising": {"axis_deg": axis, "extinction": 50}}


def estimate(case):
    low, high = case["reflected_interval"]
    return case["luminance_cd_m2"]["reflected"], (high - low) / 3.92


def estimate_mean(case):
    """The same of all of the symbol: two rooms' noise may choose other parts of it."""
    mean = case["symbol_mean"]
    low, high = mean["reflected_interval"]
    return mean["reflected"], (high - low) / 3.92


def part_of(case):
    return [case["judged_part_uv"][side] for side in ("left", "top", "right", "bottom")]


def foreign_panel(reviewer, layout):
    """Fitted once a hunt; None: no data."""
    path = os.path.join(reviewer.folder, layout + ".panel")
    if os.path.isdir(FOREIGN) and not os.path.exists(path):
        tables = [table for pattern in LAYOUTS[layout]
                  for table in sorted(glob.glob(os.path.join(FOREIGN, pattern)))]
        for line in (["import", *tables, "-o", f"{layout}/MANIFEST.json"],
                     ["fit", f"{layout}/MANIFEST.json", "-o", layout + ".panel"]):
            os.makedirs(os.path.join(reviewer.folder, layout), exist_ok=True)
            done = subprocess.run([reviewer.program, "panel", *line], cwd=reviewer.folder,
                                  capture_output=True, text=True, check=False)
            assert done.returncode == 0, done.stderr
    return layout + ".panel" if os.path.exists(path) else None


def is_near(interval, found, truth):
    """In the interval, or no farther outside than TOO_FAR standard errors are."""
    low, high = (found + TOO_FAR / 1.96 * (end - found) for end in interval)
    return low <= truth * (1 + CLOSED_SHARE) and truth * (1 - CLOSED_SHARE) <= high


def conditions_of(room):
    """With what the weather's sun has of the room's own light."""
    sun = room.environment()
    found = [moment("rare", **sun),
             *({**moment(name, **sun), "sunglasses": lens} for name, lens in (
                 ("grey", GREY), ("axis 0", crossed(0)), ("axis 90", crossed(90))))]
    if "sun" in sun:
        for name, lux in (("weather", black_box.LUX / 2), ("sky", 0)):
            found.append(moment(name, **WEATHER, sun={**sun["sun"], "illuminance_lx": lux}))
    if rare_rooms.has_open_sky(room):
        found.append(moment("even", type="constant", luminance=SKY_CD_M2))
    return found


class RareRoom:
    def __init__(self, hunt, seed):
        self.hunt, self.reviewer, self.name = hunt, hunt.reviewer, f"seed {seed}"
        draw = random.Random(seed)
        kinds = list(rare_rooms.KINDS)
        self.kind = kinds[seed // rare_rooms.EVERY % len(kinds)]
        self.room = rare_rooms.rare_room(draw, self.kind)
        self.panel = draw.choice(rooms.PANELS)
        if draw.random() < 0.25:
            layout = draw.choice(list(LAYOUTS))
            self.panel = foreign_panel(self.reviewer, layout) or self.panel
        is_coated = self.room.walls > 0 and draw.random() < 0.3
        self.of_display = {"panel": self.panel,
                           "coating": rooms.SINGLE_MGF2 if is_coated else None}
        self.brdf = reflection.Panel(self.reviewer.program,
                                     os.path.join(self.reviewer.folder, self.panel),
                                     self.reviewer.folder)
        rough = black_box.closed_form(self.room, self.brdf, (0.4, 0.4, 0.6, 0.6), 1)
        self.level = min(1, draw.uniform(0.9, 1.1) * (LIMIT - 1) * rough / WHITE_CD_M2)
        self.seed = draw.randrange(1000)

    def write(self, scene, environment):
        scene.view("near", black_box.EYE, [-x for x in black_box.EYE], rare.NEAR_DEG)
        scene.environment(**environment)
        scene.write(os.path.join(self.reviewer.folder, "room.gltf"))

    def review(self, conditions, precision):
        document = black_box.review_request(self.level, conditions,
                                            precision={"seed": self.seed, **precision})
        return self.reviewer.review(document, "rare")[1]["cases"]

    def frame(self):
        """Mean and standard error, and the part of the display that it sees."""
        frame = rare.render(self.reviewer, "near.exr", "--camera", "near", "--size",
                            "{}x{}".format(*rare.SIZE), "--spp", str(rare.SAMPLES), "--layers",
                            "all", "--seed", str(self.seed), "--display-level", "screen=0")
        u, v = (frame.channels["uv." + axis] for axis in "UV")
        told = json.loads(self.reviewer.run("measure", "near.exr", "--json").stdout)
        low, high = told["luminance_interval"]
        return ((told["luminance_cd_m2"], (high - low) / 3.92),
                [min(u), min(v), max(u), max(v)])

    def closed(self, box, points=None, room=None):
        points = points or self.room.closed_points
        value = black_box.closed_form(room or self.room, self.brdf, box, points)
        return value, CLOSED_SHARE * value

    def truths(self, part, seen):
        """Of the judged part, of all of the symbol and of the frame; None: not known."""
        if not self.room.walls:
            return [self.closed(box) for box in (part, black_box.SYMBOL_UV, seen)]
        self.write(self.room.lamp_scene(**self.of_display), black_box.DARK)
        case = self.review([moment("lamp", **black_box.DARK)], PRECISE)[0]
        judged = estimate(case) if part_of(case) == part else None
        return judged, estimate_mean(case), self.frame()[0]

    def check_verdict(self, case, truth):
        light = case["luminance_cd_m2"]
        shown = light["foreground"], light["background"]
        ratio = (max(shown) + truth[0]) / (min(shown) + truth[0])
        for limit in case["limits"]:
            if limit["kind"] == "contrast_ratio" and not limit["upper"]:
                off = ratio / limit["value"] - 1
                self.hunt.report.claim(
                    abs(off) < 0.01 or limit["verdict"] != ("fail" if off > 0 else "pass"),
                    f"{self.name}: {limit['verdict']}, the true contrast {ratio:.4g} of "
                    f"{limit['value']:g}")

    def compare(self, what, found, truth):
        name = f"{self.name}, {self.kind}, {what}"
        self.hunt.compare(name, found, truth)
        self.hunt.report.claim(found[1] <= KNOWN_WITHIN * truth[0],
                               f"{name}: {found[0]:.4g} +- {found[1]:.2g}, not known within "
                               f"{100 * KNOWN_WITHIN:g} %")

    def check_lenses(self, of, ask, truth):
        """They take paths that are the eye's own: no figures that chance has made anew."""
        a, b = ask(of["rare"])[0], ask(of["grey"])[0]
        self.hunt.report.claim(math.isclose(a, b, rel_tol=1e-4),
                               f"{self.name}: {a:.6g}, by a grey lens {b:.6g}")
        (a, sure_a), (b, sure_b) = (ask(of[f"axis {axis}"]) for axis in (0, 90))
        z = ((a + b) / 2 - truth[0]) / math.hypot(sure_a, sure_b, truth[1])
        self.hunt.report.claim(abs(z) <= TOO_FAR, f"{self.name}: crossed lenses {a:.6g}, "
                                                  f"{b:.6g}, truth {truth[0]:.6g}")

    def check_weather(self, weather, sky, truth):
        """What it has more than its sky alone is half of the room's own sun. Parts of the
        symbol that paths of a sky choose are not the sun's: all of it counts."""
        (a, b), (c, d) = (case["symbol_mean"]["reflected_interval"] for case in (weather, sky))
        found, other = (case["symbol_mean"]["reflected"] for case in (weather, sky))
        words = (f"{self.name}, {self.kind}, weather: {found - other:.6g} [{a - d:.6g}, "
                 f"{b - c:.6g}], truth {truth[0] / 2:.6g}")
        print(words, flush=True)
        self.hunt.report.claim(is_near((a - d, b - c), found - other, truth[0] / 2), words)

    def check_even_sky(self, case):
        room = black_box.UnderSky(self.room)
        truth = SKY_CD_M2 * self.closed(part_of(case), 3, room)[0]
        found, interval = case["luminance_cd_m2"]["reflected"], case["reflected_interval"]
        words = (f"{self.name}, {self.kind}, even sky: {found:.4g} [{interval[0]:.4g}, "
                 f"{interval[1]:.4g}], truth {truth:.4g}")
        print(words, flush=True)
        self.hunt.held.append(interval[0] <= truth <= interval[1])
        self.hunt.report.claim(is_near(interval, found, truth), words)
        self.check_verdict(case, (truth, 0))

    def check_cases(self, cases, judged, mean):
        of = {case["condition"]: case for case in cases}
        ask, truth = (estimate, judged) if judged else (estimate_mean, mean)
        self.compare("rare", ask(of["rare"]), truth)
        if judged:
            self.check_verdict(of["rare"], judged)
        self.check_lenses(of, ask, truth)
        if "sky" in of:
            self.check_weather(of["weather"], of["sky"], mean)
        if "even" in of:
            self.check_even_sky(of["even"])

    def go(self):
        self.write(self.room.scene(**self.of_display), self.room.environment())
        frame, seen = self.frame()
        cases = self.review(conditions_of(self.room), {"contrast": 0.02})
        judged, mean, of_frame = self.truths(part_of(cases[0]), seen)
        self.check_cases(cases, judged, mean)
        self.compare("frame", frame, of_frame)
