# SPDX-License-Identifier: Apache-2.0
"""rare.py BUILD [--trials N] [--holes CM,...] [--walls R,...] [--rooms hole,knob,slit]
[--margins P,...] [--json FILE] -- verdicts and intervals where light comes through one small
opening: a table. BUILD has bench_rare and the program.

Rooms are those of tests/image/black_box.py: a square hole of the ceiling whose patch of sun on
the pale floor lights the display; a chrome knob in such a beam, and a slit of 2 mm by 30 cm,
both between black walls. Limits leave the true contrast, near 3, a margin of -3 and 3 %.

The truth of black walls is a closed form. With others it is the mean of 32 readings of 8,192
paths of the same room in which the patch is a lamp of the same luminance and the sun is off:
samples of lamps find it whatever its size. That is printed beside every closed form, too, with
its standard error. `--light lamp` asks these rooms themselves: what the figures are when the
light is not rare.

A wrong verdict passes where the truth fails, or fails where it passes; "too close" is none. An
interval holds that has the truth inside. Wrong may be one in a hundred, and 93 % must hold;
counts of N trials are held against that as far as chance allows, one in twenty.
"""
import argparse
import json
import math
import os
import shutil
import statistics
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "image"))
import black_box  # noqa: E402
import reflection  # noqa: E402

PANEL = os.path.join(HERE, "..", "..", "assets", "panels", "ips_cluster.panel")
SHOWN_CD_M2 = 500      # the panel's white, near enough for a contrast of 3
TRUTH_RUNS, TRUTH_PATHS = 32, 8192
PASS, FAIL, CLOSE = 0, 1, 2
SLIT = (0.3, 0.002)


def rooms_of(words):
    """(name, room)"""
    found = []
    for name in words.rooms.split(","):
        if name == "hole":
            found += [(f"hole {cm:g} cm, walls {walls:g}",
                       black_box.Patch((cm / 100, cm / 100), walls))
                      for walls in words.walls for cm in words.holes]
        else:
            found.append((name, {"knob": black_box.Knob(),
                                 "slit": black_box.Patch(SLIT)}[name]))
    return found


class Bench:
    def __init__(self, build, folder):
        self.build, self.folder = os.path.abspath(build), folder
        shutil.copy(PANEL, os.path.join(folder, "ips.panel"))
        program = os.path.join(self.build, "parhelion")
        self.panel = reflection.Panel(program, os.path.join(folder, "ips.panel"), folder)

    def ask(self, scene, light, level, precision, line):
        """line: trials, truth, margins. What is shown with the judged part, and trials as
        [margin, seed, verdict, reflected, low, high, paths, seconds]."""
        scene.write(os.path.join(self.folder, "room.gltf"))
        path = os.path.join(self.folder, "review.json")
        with open(path, "w", encoding="utf-8") as file:
            json.dump(black_box.review_request(
                level, [{"name": "moment", "environment": light}], precision=precision), file)
        trials, truth, margins = line
        done = subprocess.run([os.path.join(self.build, "bench_rare"), str(trials),
                               f"{truth:.9g}", path, *(f"{m:g}" for m in margins)],
                              capture_output=True, text=True, check=False)
        if done.returncode:
            sys.exit(f"rare.py: bench_rare: {done.stderr.strip()}")
        rows = [row.split("\t") for row in done.stdout.splitlines()]
        return ([float(x) for x in rows[0][1:]],
                [[float(x) for x in row[1:]] for row in rows[1:]])


def near(room, bench):
    """The closed form of black walls over the middle of the symbol: how bright the display is
    set."""
    return black_box.closed_form(room, bench.panel, (0.4, 0.4, 0.6, 0.6), 1)


def lamp_mean(bench, room, level):
    """The mean with its standard error, and the judged part; None: no such room."""
    if not hasattr(room, "lamp_scene"):
        return None
    shown, trials = bench.ask(
        room.lamp_scene(), black_box.DARK, level,
        {"contrast": 1e-6, "clear": 1e-6, "paths": TRUTH_PATHS}, (TRUTH_RUNS, 0, []))
    found = [t[3] for t in trials]
    return (statistics.fmean(found), statistics.stdev(found) / math.sqrt(len(found)),
            shown[2:])


def truth_of(bench, room, level):
    """Value, standard error in percent, and words that say where it is from. The closed form is
    that of the part which is judged under the sun, the lamps' of that which is judged there:
    the brightest that a review finds."""
    part = bench.ask(room.scene(), room.environment(), level, {}, (1, 0, []))[0][2:]
    lamp = lamp_mean(bench, room, level)
    of_lamp = lamp and f"lamp {lamp[0]:.5g} +- {100 * lamp[1] / lamp[0]:.2f} %"
    if lamp and lamp[2] != part:
        of_lamp += " of another part"
    if room.walls:
        return lamp[0], 100 * lamp[1] / lamp[0], of_lamp
    closed = black_box.closed_form(room, bench.panel, part, 7)
    words = f"closed form {closed:.5g}"
    if lamp:
        of_part = black_box.closed_form(room, bench.panel, lamp[2], 7)
        words += f", {of_lamp} ({100 * (lamp[0] / of_part - 1):+.2f} %)"
    return closed, 100 * black_box.CLOSED_WITHIN, words


def at_least(count, trials, share):
    """The chance of so many or more of so many, each with that chance."""
    if count <= 0 or share >= 1:
        return 1.0
    return min(1.0, sum(math.exp(math.lgamma(trials + 1) - math.lgamma(k + 1) -
                                 math.lgamma(trials - k + 1) + k * math.log(share) +
                                 (trials - k) * math.log1p(-share))
                        for k in range(count, trials + 1)))


def row_of(name, margin, truth, trials):
    verdicts = [int(t[2]) for t in trials]
    wrong = sum(v == (PASS if margin < 0 else FAIL) for v in verdicts)
    held = sum(t[4] <= truth <= t[5] for t in trials)
    n = len(trials)
    return {"room": name, "margin_percent": margin, "trials": n, "wrong": wrong,
            "too_close": sum(v == CLOSE for v in verdicts), "held": held,
            "below": sum(t[5] < truth for t in trials),
            "mean_percent": 100 * (statistics.fmean(t[3] for t in trials) / truth - 1),
            "paths": statistics.fmean(t[6] for t in trials),
            "most_paths": max(t[6] for t in trials),
            "ms": 1000 * statistics.fmean(t[7] for t in trials),
            "is_good": at_least(wrong, n, 0.01) > 0.05 and
            at_least(n - held, n, 0.07) > 0.05}


def print_row(row):
    n = row["trials"]
    print(f"| {row['room']} | {row['margin_percent']:+g} % | {n} | "
          f"{100 * row['wrong'] / n:.1f} % | {100 * row['too_close'] / n:.1f} % | "
          f"{100 * row['held'] / n:.1f} % | {100 * row['below'] / n:.1f} % | "
          f"{row['mean_percent']:+.1f} % | {row['paths']:.0f} | {row['most_paths']:.0f} | "
          f"{row['ms']:.0f} | {'' if row['is_good'] else 'no'} |", flush=True)


def try_room(bench, name, room, words):
    level = min(1, 2 * near(room, bench) / SHOWN_CD_M2)
    truth, error, origin = truth_of(bench, room, level)
    print(f"{name}: {origin}", flush=True)
    scene, light = room.scene(), room.environment()
    if words.light == "lamp":
        if not hasattr(room, "lamp_scene"):
            return []
        scene, light = room.lamp_scene(), black_box.DARK
    shown, trials = bench.ask(scene, light, level, {"contrast": words.precision},
                              (words.trials, truth, words.margins))
    rows = []
    for margin in words.margins:
        row = row_of(name, margin, truth, [t for t in trials if t[0] == margin])
        row.update(truth_cd_m2=truth, truth_error_percent=error, shown_cd_m2=shown[:2])
        print_row(row)
        rows.append(row)
    return rows


def numbers(text):
    return [float(x) for x in text.split(",")]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build")
    parser.add_argument("--trials", type=int, default=200)
    parser.add_argument("--holes", type=numbers, default=[0.5, 1.5, 3, 6, 12])
    parser.add_argument("--walls", type=numbers, default=[0, 0.1, 0.5])
    parser.add_argument("--rooms", default="hole,knob,slit")
    parser.add_argument("--margins", type=numbers, default=[-3, 3])
    parser.add_argument("--light", default="sun", choices=("sun", "lamp"))
    parser.add_argument("--precision", type=float, default=0.01)
    parser.add_argument("--json")
    words = parser.parse_args()
    print("| room | true margin | trials | wrong | too close | held | lie below | mean | paths "
          "| most paths | ms | good |\n" + "| --- " * 12 + "|", flush=True)
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(words.build, folder)
        for name, room in rooms_of(words):
            rows += try_room(bench, name, room, words)
            if words.json:
                with open(words.json, "w", encoding="utf-8") as file:
                    json.dump(rows, file, indent=1)
    off = sum(not row["is_good"] for row in rows)
    print(f"{off} of {len(rows)} rows are wrong or miss too often")
    return off > 0


if __name__ == "__main__":
    sys.exit(main())
