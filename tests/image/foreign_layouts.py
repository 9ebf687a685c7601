# SPDX-License-Identifier: Apache-2.0
"""foreign_layouts.py PARHELION [COUNT [START]] -- emissions and reflections of known form,
measured in layouts that no simulator of ours chooses: grids, rings about the mirror direction,
scattered directions; lobes of 0.5 to 20 degrees; 4 to 36 azimuths; noise of 0 to 2 %. Each is
imported, fitted and evaluated between its samples, where it is measured.

Laws  a panel that is "good" misses at most 5 % of the light (the sum of |panel - truth|,
      weighted by cosine and solid angle, over that of the truth) beside the noise (a lobe of an
      emission that no sample saw is left out: 0), and in a lobe that a sample saw no direction
      by more than 15 % beside three times the noise (so much are two standard deviations of
      the verdict's estimate at most); a table
      of a smooth reflection in any layout errs by at most twice what a grid of as many samples
      does; and between samples a white has no colour that its neighbours lack.
"""
import csv
import math
import os
import random
import subprocess
import sys
import tempfile

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

GOOD_MISSES = 0.05
GOOD_PEAK = 0.15
SEEN = 1.5  # widths from a lobe's centre to a sample: there it has a tenth of its height
PEAK_QUESTIONS = 60
QUESTIONS = 300
WHITE = (0.95, 1.0, 1.09)


def unit(theta, phi):
    t, p = math.radians(theta), math.radians(phi)
    return math.sin(t) * math.cos(p), math.sin(t) * math.sin(p), math.cos(t)


def angles(w):
    return (math.degrees(math.acos(min(1, w[2]))),
            math.degrees(math.atan2(w[1], w[0])) % 360)


def apart(a, b):
    return math.degrees(math.acos(max(-1, min(1, sum(x * y for x, y in zip(a, b))))))


# ---- layouts: directions of one table, (theta, phi) ------------------------------------------

def grid(r, most, samples=None):
    if samples:
        azimuths = 24
        step = most / max(2, (samples - 1) / azimuths)
    else:
        azimuths, step = r.choice([4, 6, 8, 12, 16, 24, 36]), r.choice([2, 3, 5, 7.5, 10])
    rings = int(most / step + 1e-6)
    return [(0, 0)] + [(step * i, 360 * k / azimuths) for i in range(1, rings + 1)
                       for k in range(azimuths)]


def mirror_rings(r, most, theta):
    """Rings about the direction (theta, 0): what of them is above the horizon."""
    azimuths, out = r.choice([12, 24, 36]), [(theta, 0)]
    s, u = unit(theta, 0), unit(theta - 90, 0)
    for radius in (5, 10, 15, 20, 30, 40, 50, 60, 70, 80, 90, 110):
        for k in range(azimuths):
            a, b = math.radians(radius), 2 * math.pi * k / azimuths
            v = (0, 1, 0)
            w = tuple(math.cos(a) * s[i] + math.sin(a) * (math.cos(b) * -u[i] +
                      math.sin(b) * v[i]) for i in range(3))
            if w[2] >= math.cos(math.radians(most)):
                out.append(angles(w))
    return out


def scattered(r, most, samples=None):
    low = math.cos(math.radians(most))
    count = samples or r.choice([200, 500, 1000])
    out = [(0, 0)] + [(most, 15 * k) for k in range(24)]
    while len(out) < count:
        out.append((math.degrees(math.acos(r.uniform(low, 1))), r.uniform(0, 360)))
    return out


# ---- truths ---------------------------------------------------------------------------------

def lit(r):
    """White's XYZ by direction: a cosine power, a pattern over azimuth, a lobe."""
    power, turns, swing = r.uniform(0.5, 4), r.choice([1, 2, 4]), r.uniform(0, 0.3)
    width, height = 0.5 * 40 ** r.random(), r.choice([0, 0.5, 2, 10])
    centre, shift = unit(r.uniform(0, 40), r.uniform(0, 360)), r.uniform(-0.1, 0.1)

    def at(theta, phi):
        c = math.cos(math.radians(theta))
        base = c ** power * (1 + swing * math.sin(math.radians(theta)) ** 2 *
                             math.cos(math.radians(turns * phi)))
        lobe = height * math.exp(-(apart(unit(theta, phi), centre) / width) ** 2)
        y = 300 * (base + lobe)
        return (WHITE[0] * y * (1 + shift * (1 - c)), y, WHITE[2] * y * (1 - shift * (1 - c)))
    at.centre, at.width = centre, width
    return at


def scatter(r, width):
    """A BRDF: a floor and a lobe about the mirror direction that grows towards grazing."""
    floor, height = r.uniform(0.003, 0.02), r.uniform(0.02, 0.3)

    def at(incidence, theta, phi):
        lobe = math.exp(-(apart(unit(theta, phi), unit(incidence, 0)) / width) ** 2)
        return floor + height * lobe * (1 + 2 * (incidence / 70) ** 4)
    at.width = width
    return at


# ---- a panel of them -------------------------------------------------------------------------

class Panel:
    def __init__(self, program, folder, tables, options):
        """tables: file name to its rows, the first one a head."""
        self.program, self.folder = program, folder
        for name, rows in tables.items():
            with open(os.path.join(folder, name), "w") as out:
                out.write("\n".join(",".join(map(str, row)) for row in rows) + "\n")
        self.panel = os.path.join(folder, "x.panel")
        manifest = os.path.join(folder, "set", "m.json")
        self.run("panel", "import", *(os.path.join(folder, n) for n in tables), "-o", manifest,
                 *options)
        self.said = self.run("panel", "fit", manifest, "-o", self.panel, "--force")

    def run(self, *words):
        out = subprocess.run([self.program, *words, "--quiet"], capture_output=True, text=True)
        if out.returncode:
            raise RuntimeError(f"{words[1]}: {out.stderr.strip().splitlines()[-1]}")
        return out.stdout

    @property
    def verdict(self):
        return next(line.split(None, 1)[1] for line in self.said.splitlines()
                    if line.startswith("verdict"))

    def answers(self, columns, rows, *words):
        path = os.path.join(self.folder, "q.csv")
        with open(path, "w") as out:
            out.write(",".join(columns) + "\n")
            out.writelines(",".join(f"{v:.6g}" for v in row) + "\n" for row in rows)
        text = self.run("panel", "eval", self.panel, "--batch", path, "--csv", *words)
        return list(csv.DictReader(text.splitlines()))


def noisy(r, value, noise):
    return f"{value * (1 + noise * r.gauss(0, 1)):.6g}"


def missed(pairs):
    """Of (weight, found, truth)."""
    total = sum(w * t for w, _, t in pairs)
    return sum(w * abs(f - t) for w, f, t in pairs) / total


def directions(r, most):
    low = math.cos(math.radians(most))
    return [(math.degrees(math.acos(r.uniform(low, 1))), r.uniform(0, 360))
            for _ in range(QUESTIONS)]


def weight(theta):
    return math.cos(math.radians(theta))


def around(r, centre, radius):
    """A direction within a radius of one, degrees; evenly over the disc."""
    a, b = math.radians(radius * math.sqrt(r.random())), r.uniform(0, 2 * math.pi)
    across = max(1e-9, math.hypot(centre[0], centre[1]))
    v = (-centre[1] / across, centre[0] / across, 0) if across > 1e-6 else (0, 1, 0)
    u = (v[1] * centre[2], -v[0] * centre[2], v[0] * centre[1] - v[1] * centre[0])
    return angles(tuple(math.cos(a) * centre[i] + math.sin(a) * (math.cos(b) * u[i] +
                        math.sin(b) * v[i]) for i in range(3)))


def nearest(rows, centre):
    return min(apart(unit(t, p), centre) for t, p in rows)


def peak_directions(r, centre, width, rows, most):
    """Inside of a lobe; none where no sample lies within half its width."""
    if nearest(rows, centre) > width / 2:
        return []
    asked = [around(r, centre, 1.2 * width) for _ in range(PEAK_QUESTIONS)]
    return [(t, p) for t, p in asked if t <= most]


def worst_of(pairs):
    """Of (found, truth) where the truth is above a quarter of its largest: relative."""
    most = max((t for _, t in pairs), default=0)
    return max((abs(f / t - 1) for f, t in pairs if t > most / 4), default=0)


def emission(program, folder, r):
    truth, noise = lit(r), r.choice([0, 0, 0.003, 0.01, 0.02])
    name = r.choice(["grid", "grid", "scattered"])
    rows = grid(r, 70) if name == "grid" else scattered(r, 70)
    table = [("theta", "phi", "X", "Y", "Z")] + [
        (f"{t:.4f}", f"{p:.4f}", *(noisy(r, v, noise) for v in truth(t, p))) for t, p in rows]
    panel = Panel(program, folder, {"white.csv": table},
                  ["--role", "*=white", "--azimuth-zero", "right", "--azimuth-sense", "ccw",
                   "--azimuth-seen-from", "viewer", "--unit", "cd/m2"])
    asked = directions(r, max(t for t, _ in rows))
    found = panel.answers(("theta", "phi", "r", "g", "b"),
                          [(t, p, 255, 255, 255) for t, p in asked])
    pairs = [(weight(t), float(f["Y"]), truth(t, p)[1]) for (t, p), f in zip(asked, found)]
    near = peak_directions(r, truth.centre, truth.width, rows, max(t for t, _ in rows))
    peak = near and panel.answers(("theta", "phi", "r", "g", "b"),
                                  [(t, p, 255, 255, 255) for t, p in near])
    worst = worst_of([(float(f["Y"]), truth(t, p)[1]) for (t, p), f in zip(near, peak)])
    is_seen = nearest(rows, truth.centre) < SEEN * truth.width
    return name, noise, panel.verdict, missed(pairs) if is_seen else 0, worst, len(rows)


def brdf_panel(program, folder, r, truth, layout, incidences, noise, seen=None):
    """seen: takes each incidence's directions."""
    tables, count = {}, 0
    for i in incidences:
        rows = layout(i)
        if seen is not None:
            seen[i] = rows
        count += len(rows)
        tables[f"BRDF_{i:02d}.csv"] = [("theta", "phi", "550nm")] + [
            (f"{t:.4f}", f"{p:.4f}", noisy(r, truth(i, t, p), noise)) for t, p in rows]
    return Panel(program, folder, tables,
                 [w for i in incidences for w in ("--role", f"BRDF_{i:02d}.csv=brdf:{i}")] +
                 ["--azimuth-zero", "right", "--azimuth-sense", "ccw",
                  "--azimuth-seen-from", "viewer", "--unit", "brdf", "--isotropic"]), count


def brdf_pairs(panel, r, truth, incidences, most):
    asked = [(r.choice(incidences), t, p) for t, p in directions(r, most)]
    found = panel.answers(("incidence", "theta", "phi"), asked, "--brdf")
    return [(weight(t), float(f["brdf"]), truth(i, t, p))
            for (i, t, p), f in zip(asked, found) if f["measured"] == "1"]


INCIDENCES = (10, 30, 50, 70)


def reflection(program, folder, r):
    width, noise = 2 * 10 ** r.random(), r.choice([0, 0, 0.003, 0.01, 0.02])
    truth = scatter(r, width)
    name = r.choice(["grid", "mirror rings", "scattered"])
    layouts = {"grid": lambda i: grid(r, 80), "scattered": lambda i: scattered(r, 80),
               "mirror rings": lambda i: mirror_rings(r, 80, i)}
    seen = {}
    panel, count = brdf_panel(program, folder, r, truth, layouts[name], INCIDENCES, noise, seen)
    pairs = brdf_pairs(panel, r, truth, INCIDENCES, 80)
    near = [(i, t, p) for i, rows in seen.items()
            for t, p in peak_directions(r, unit(i, 0), width, rows, 80)]
    peak = near and panel.answers(("incidence", "theta", "phi"), near, "--brdf")
    worst = max((worst_of([(float(f["brdf"]), truth(*at)) for at, f in zip(near, peak)
                           if at[0] == i and f["measured"] == "1"]) for i in seen), default=0)
    return name, noise, panel.verdict, missed(pairs), worst, count


# ---- the laws --------------------------------------------------------------------------------

def percentile(values, share):
    values = sorted(values)
    return 100 * values[min(len(values) - 1, int(share * len(values)))]


def print_table(found):
    """found: (kind, layout, noise), verdict, light missed, worst in the lobe."""
    print("  | kind | layout | noise | panels | good | light missed: median | 95 % | worst | "
          "in the lobe: median | 95 % | worst | of good ones |\n  |" + " --- |" * 12)
    for key in sorted({one[0] for one in found}):
        rows = [one for one in found if one[0] == key]
        good = [peak for _, is_good, _, peak in rows if is_good]
        light, peak = [one[2] for one in rows], [one[3] for one in rows]
        cells = [f"{percentile(of, share):.2g} %" for of in (light, peak)
                 for share in (0.5, 0.95, 1)]
        print("  | " + " | ".join([*key, str(len(rows)), str(len(good)), *cells,
                                   f"{100 * max(good):.2g} %" if good else ""]) + " |")


def law_of_good(report, program, count, start):
    found, in_fact, told = [], 0, 0
    for seed in range(start, start + count):
        r = random.Random(seed)
        kind = emission if seed % 2 else reflection
        with tempfile.TemporaryDirectory() as folder:
            name, noise, verdict, error, worst, rows = kind(program, folder, r)
        is_good, text = verdict == "good", f"{kind.__name__} {seed}, {name} of {rows}"
        found.append(((kind.__name__, name, f"{100 * noise:g} %"), is_good, error, worst))
        if error < GOOD_MISSES + noise and worst < GOOD_PEAK + 3 * noise:
            in_fact, told = in_fact + 1, told + is_good
        if is_good and error > GOOD_MISSES + noise:
            report.claim(False, f"{text}, noise {noise:g}: good, and misses "
                         f"{100 * error:.2g} % of the light")
        if is_good and worst > GOOD_PEAK + 3 * noise:
            report.claim(False, f"{text}, noise {noise:g}: good, and misses {100 * worst:.2g} "
                         "% of its lobe")
    print_table(found)
    good = sum(one[1] for one in found)
    print(f"  {in_fact} of {count} panels are within these limits, {told} of them are good")
    report.claim(good > count // 10, f"{good} of {count} panels are good")


def law_of_layouts(report, program):
    for width in (15, 25):
        truth = scatter(random.Random(width), width)
        layouts = {"mirror rings": lambda r, i: mirror_rings(r, 80, i),
                   "scattered": lambda r, i: scattered(r, 80, 400)}
        for name, layout in layouts.items():
            r = random.Random(1)
            with tempfile.TemporaryDirectory() as folder:
                panel, count = brdf_panel(program, folder, r, truth, lambda i: layout(r, i),
                                          INCIDENCES, 0)
                error = missed(brdf_pairs(panel, random.Random(2), truth, INCIDENCES, 80))
            with tempfile.TemporaryDirectory() as folder:
                even = [grid(r, 80, count // 4) for _ in INCIDENCES][0]
                panel, _ = brdf_panel(program, folder, r, truth, lambda i: even, INCIDENCES,
                                      0)
                plain = missed(brdf_pairs(panel, random.Random(2), truth, INCIDENCES, 80))
            text = (f"lobe of {width} degrees, {name}: {100 * error:.2g} % of the light, a "
                    f"grid of as many {100 * plain:.2g} %")
            print(f"  {text}")
            report.claim(error <= 2 * plain + 0.002, text)


def uv(xyz):
    d = xyz[0] + 15 * xyz[1] + 3 * xyz[2]
    return 4 * xyz[0] / d, 9 * xyz[1] / d


def edged(azimuths, drift, steep):
    """A white that ends at a theta that turns with the azimuth; Z ends a little earlier."""
    def at(theta, phi):
        end = 32 + 14 * math.cos(2 * math.radians(phi))
        y, z = (850 / (1 + (theta / e) ** steep) + 8 for e in (end, end * (1 + drift)))
        return 0.958 * y, y, 1.13 * z
    return [(theta, 360 * k / azimuths) for theta in range(61)
            for k in range(azimuths if theta else 1)], at


def law_of_colour(report, program):
    """0.004: what X, Y and Z may miss by at the bound of a smooth fit, and an eighth of the
    neighbours' spread (src/panel/fit/emission/emission_between.h)."""
    for azimuths in (4, 8, 16):
        for drift, steep in ((-0.02, 6), (-0.02, 40), (0.03, 12)):
            rows, truth = edged(azimuths, drift, steep)
            table = [("theta", "phi", "X", "Y", "Z")] + [
                (t, p, *(f"{v:.5f}" for v in truth(t, p))) for t, p in rows]
            with tempfile.TemporaryDirectory() as folder:
                panel = Panel(program, folder, {"white.csv": table},
                              ["--role", "*=white", "--azimuth-zero", "right",
                               "--azimuth-sense", "ccw", "--unit", "cd/m2"])
                asked = [(t, p) for t in range(2, 60, 2) for p in range(0, 360, 5)]
                found = panel.answers(("theta", "phi", "r", "g", "b"),
                                      [(t, p, 255, 255, 255) for t, p in asked])
            worst = 0
            for (t, p), f in zip(asked, found):
                u = uv([float(f[c]) for c in "XYZ"])
                low = math.floor(p * azimuths / 360) * 360 / azimuths
                near = [uv(truth(a, b)) for a in (t - 1, t, t + 1)
                        for b in (low, low + 360 / azimuths)]
                outside = [max(0, u[k] - max(n[k] for n in near),
                               min(n[k] for n in near) - u[k]) for k in (0, 1)]
                worst = max(worst, math.hypot(*outside))
            text = (f"{azimuths} azimuths, Z ends {100 * drift:g} % later, power {steep}: "
                    f"{worst:.4f} in u'v' outside of the neighbours' colours")
            print(f"  {text}")
            report.claim(worst < 0.004, text)


def main():
    report = Report()
    program = os.path.abspath(sys.argv[1])
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 200
    start = int(sys.argv[3]) if len(sys.argv) > 3 else 0
    if not start:
        law_of_colour(report, program)
        law_of_layouts(report, program)
    law_of_good(report, program, count, start)
    report.finish()


if __name__ == "__main__":
    main()
