# SPDX-License-Identifier: Apache-2.0
"""panel_accuracy.py PARHELION [--only PART[,PART...]] [FIT OPTION...] -- how true panels are.

emission    two foreign sets through the importer and the fit, against known truth
reflection  the same for the first set's BRDF: its peak, its haze
incidence   simulated panels between the measured incidences, and with one left out
levels      grey levels left out and predicted, of simulated panels and of measured curves
directions  random directions inside the cone against the closed form

Angles in degrees; errors relative if not said otherwise; delta u'v' in CIE 1976 units.
"""
import csv
import json
import math
import os
import random
import sys
import tempfile

import panels
from panels import Refused

PARTS = ("emission", "reflection", "incidence", "levels", "directions")
SIMULATED = ("ips_cluster", "oled_centre")


def chromaticity(xyz):
    d = xyz[0] + 15 * xyz[1] + 3 * xyz[2]
    return (4 * xyz[0] / d, 9 * xyz[1] / d) if d > 0 else (0.0, 0.0)


def colour_distance(a, b):
    (u, v), (s, t) = chromaticity(a), chromaticity(b)
    return math.hypot(u - s, v - t)


def rms(values):
    return math.sqrt(sum(v * v for v in values) / len(values)) if values else 0.0


def percent(value):
    return f"{100 * value:.3f}%"


# ---- foreign sets --------------------------------------------------------------------------

def truth_rows(name):
    with open(os.path.join(panels.DATA, "panels", "set-a", name)) as file:
        return [list(map(float, row)) for row in list(csv.reader(file))[1:]]


def spikes(manifest):
    """Samples three times as bright as the second brightest of the four beside them on their
    ring: the set's hot pixels."""
    found = []
    for table in panels.read_set(manifest):
        rings = {}
        for t, p, xyz in table.rows:
            if table.incidence is None:
                rings.setdefault(t, []).append((p, xyz[1]))
        for t, ring in rings.items():
            ring.sort()
            for i, (p, y) in enumerate(ring):
                beside = sorted(ring[(i + k) % len(ring)][1] for k in (-2, -1, 1, 2))
                if y > 3 * beside[2]:
                    found.append((table.name, t, p))
    return found


def compare_spikes(name, hot, reported):
    """Every hot pixel reported, and nothing else? The normal is one direction."""
    def key(table, theta, phi):
        parts = table.split()
        level = float(parts[1]) if len(parts) > 1 else 0.0
        return parts[0], level, round(theta), round(phi) % 360 if theta > 0.01 else 0

    wanted = {key(*one) for one in hot}
    told = {key(one["table"], one["theta_deg"], one["phi_deg"]) for one in reported}
    print(f"{name}: {len(wanted)} hot pixels in the tables; reported {len(told & wanted)} of "
          f"them and {len(told - wanted)} others; missed: {sorted(wanted - told)}; too many: "
          f"{sorted(told - wanted)[:8]}")


def measure_emission(program, options):
    limits = {"set-a": (0.005, 0.001), "set-b": (0.015, 0.004)}
    truth = truth_rows("truth_emission.csv")
    for name, (limit_y, limit_uv) in limits.items():
        manifest = panels.imported(program, name)
        panel = program.file(name + ".panel")
        report = program.fit(panels.emission_only(manifest), panel, *options)
        _, answers = program.ask(panel, ("theta", "phi", "r", "g", "b"),
                                 [row[:5] for row in truth])
        luminance, colour = [], []
        for row, answer in zip(truth, answers):
            if row[0] <= 75:
                luminance.append((abs(answer[6] / row[6] - 1), row[:5]))
                colour.append((colour_distance(answer[5:8], row[5:8]), row[:5]))
        worst_y, worst_uv = max(luminance), max(colour)
        print(f"{name} emission to 75 deg: luminance max {percent(worst_y[0])} (limit "
              f"{percent(limit_y)}) rms {percent(rms([e for e, _ in luminance]))} at "
              f"{worst_y[1]}; delta u'v' max {worst_uv[0]:.5f} (limit {limit_uv}) rms "
              f"{rms([e for e, _ in colour]):.5f} at {worst_uv[1]}; file "
              f"{report['file_bytes']} bytes, fit {report['seconds']:.1f} s")
        compare_spikes(name, spikes(manifest), report.get("outliers", []))


# ---- reflection ----------------------------------------------------------------------------

def solve(matrix, right):
    """Gauss elimination of a small symmetric system."""
    n = len(right)
    rows = [list(row) + [b] for row, b in zip(matrix, right)]
    for i in range(n):
        pivot = max(range(i, n), key=lambda k: abs(rows[k][i]))
        rows[i], rows[pivot] = rows[pivot], rows[i]
        for k in range(i + 1, n):
            factor = rows[k][i] / rows[i][i]
            rows[k] = [a - factor * b for a, b in zip(rows[k], rows[i])]
    out = [0.0] * n
    for i in reversed(range(n)):
        out[i] = (rows[i][n] - sum(rows[i][j] * out[j] for j in range(i + 1, n))) / rows[i][i]
    return out


PEAK_SIGMA = 0.9 # degrees: width of the foreign set's peak, read off its tables


def peak_errors(rows):
    """Height and displacement (degrees) of a found Gaussian peak against the true one: the
    logarithm of their ratio is h + (d . offset) / sigma^2, by least squares."""
    matrix, right = [[0.0] * 3 for _ in range(3)], [0.0] * 3
    for offset_t, offset_p, ratio in rows:
        terms = (1.0, offset_t / PEAK_SIGMA ** 2, offset_p / PEAK_SIGMA ** 2)
        for i in range(3):
            right[i] += terms[i] * math.log(ratio)
            for j in range(3):
                matrix[i][j] += terms[i] * terms[j]
    height, dt, dp = solve(matrix, right)
    return math.exp(height) - 1, math.hypot(dt, dp)


def found_peak(program, panel, incidence, wavelength):
    """Where a panel's haze is highest in the plane of incidence: (theta, value)."""
    rows = [(incidence + 0.02 * k, 0, incidence) for k in range(-100, 101)
            if 0 <= incidence + 0.02 * k <= 90]
    _, answers = program.ask(panel, ("theta", "phi", "incidence"), rows, "--brdf",
                             "--wavelength", wavelength)
    value, theta = max((answer[6], row[0]) for row, answer in zip(rows, answers))
    return theta, value


def measure_reflection(program, options):
    truth = truth_rows("truth_brdf.csv")
    panel = program.file("set-a-brdf.panel")
    report = program.fit(panels.imported(program, "set-a"), panel, *options)
    _, answers = program.ask(panel, ("theta", "phi", "incidence", "wavelength"),
                             [(t, p, i, nm) for i, t, p, nm, _ in truth], "--brdf",
                             "--wavelength", 550)
    near, haze, between = {}, [], []
    for (i, t, p, nm, f), answer in zip(truth, answers):
        ratio, d = answer[6] / f, panels.angle_between(t, p, i, 0)
        if d < 1.5 and 5 <= i <= 60:
            side = math.sin(math.radians(t)) * math.degrees(math.sin(math.radians(p)))
            near.setdefault(min(45, 5 + int((i - 5) / 10) * 10), []).append(
                (t - i, side, ratio))
        elif d > 4:
            haze.append((abs(ratio - 1), (i, t, p, nm)))
        elif d >= 1.5:
            between.append(abs(ratio - 1))
    for start, rows in sorted(near.items()):
        height, moved = peak_errors(rows)
        worst = max(abs(ratio - 1) for _, _, ratio in rows)
        print(f"set-a BRDF peak, incidence {start} to "
              f"{start + 10 if start < 45 else 60}: height {100 * height:+.2f}% "
              f"(limit 2%), displaced {moved:.3f} deg (limit 0.2), worst of {len(rows)} points "
              f"within 1.5 deg {percent(worst)}")
    worst = max(haze)
    print(f"set-a BRDF haze (beyond 4 deg of the mirror direction, {len(haze)} points): max "
          f"{percent(worst[0])} (limit 3%) at {worst[1]}, rms "
          f"{percent(rms([e for e, _ in haze]))}; from 1.5 to 4 deg: max "
          f"{percent(max(between))}, rms {percent(rms(between))}")
    for incidence in (15, 20, 30, 40, 50, 55):
        theta, value = found_peak(program, panel, incidence, 550)
        print(f"set-a BRDF: found peak at incidence {incidence}: {theta:.2f} deg, "
              f"{value:.4g} sr^-1")
    print(f"set-a with reflection: file {report['file_bytes']} bytes, fit "
          f"{report['seconds']:.1f} s")


# ---- between incidences ----------------------------------------------------------------------

def compare_slice(program, panel, truth, incidence):
    """Cosine-weighted relative L2, height of the peak, and where it lies."""
    rows = [(t, p, incidence) for t in range(0, 81, 2) for p in range(0, 181, 3)]
    fine = [(incidence + 0.2 * k, 2.0 * j, incidence) for k in range(-40, 41)
            for j in range(0, 11) if incidence + 0.2 * k >= 0]
    error = total = 0.0
    names, answers = program.ask(panel, ("theta", "phi", "incidence"), rows + fine, "--brdf",
                                 "--wavelength", 550)
    for index, ((t, p, i), answer) in enumerate(zip(rows + fine, answers)):
        solid = 6.0 if index < len(rows) else 0.4 # degrees squared
        if index < len(rows) and panels.angle_between(t, p, i, 0) < 8:
            continue
        weight = math.sin(math.radians(t)) * math.cos(math.radians(t)) * solid
        wanted = truth.haze(i, t, p, 550)
        error += weight * (answer[6] - wanted) ** 2
        total += weight * wanted ** 2
    theta, height = found_peak(program, panel, incidence, 550)
    wanted, best = max((truth.haze(incidence, incidence + 0.02 * k, 0, 550),
                        incidence + 0.02 * k) for k in range(-100, 101))
    return math.sqrt(error / total), height / wanted - 1, theta - best


def print_slice(name, what, result, limits):
    print(f"{name}, {what}: L2 {percent(result[0])} (limit {percent(limits[0])}), peak height "
          f"{100 * result[1]:+.2f}% (limit {percent(limits[1])}), displaced "
          f"{result[2]:+.2f} deg")


def measure_incidence(program, options):
    for name in SIMULATED:
        text = panels.without_noise(panels.recipe(name))
        text["reflection"]["wavelengths_nm"] = [450, 550, 650]
        manifest = panels.simulate(program, text, name + "-incidence")
        panel = program.file(name + "-incidence.panel")
        program.fit(manifest, panel, *options)
        truth = panels.Truth(text)
        for incidence in (15, 25, 35, 45, 55):
            print_slice(name, f"middle of the grid, {incidence} deg",
                        compare_slice(program, panel, truth, incidence), (0.01, 0.01))
        for incidence in (20, 30, 40, 50):
            left_out = panels.edit_manifest(
                manifest, "LEFT.json",
                lambda text, i=incidence: text["reflection"]["incidence_deg"].remove(i))
            program.fit(left_out, panel, *options)
            print_slice(name, f"left out, {incidence} deg",
                        compare_slice(program, panel, truth, incidence), (0.035, 0.025))


# ---- grey levels -----------------------------------------------------------------------------

def leave_level_out(program, manifest, level, options):
    """Worst luminance and colour error of the left-out tables to 75 deg."""
    def change(text):
        for primary in panels.PRIMARIES:
            text["emission"][primary].pop(str(level))
        text.pop("reflection", None)
    panel = program.file("levels.panel")
    program.fit(panels.edit_manifest(manifest, "LEFT.json", change), panel, *options)
    luminance = colour = 0.0
    for table in panels.read_set(panels.emission_only(manifest)):
        if table.name not in [f"{p} {level}" for p in panels.PRIMARIES]:
            continue
        columns, questions = table.questions()
        _, answers = program.ask(panel, columns, questions)
        for (t, _, xyz), answer in zip(table.rows, answers):
            if t <= 75:
                luminance = max(luminance, abs(answer[6] / xyz[1] - 1))
                colour = max(colour, colour_distance(answer[5:8], xyz))
    return luminance, colour


def measured_curve_set(folder):
    """A display that shines alike in all directions, with the measured level curve of a real
    one (an OLED monitor, 1024 steps)."""
    with open(os.path.join(panels.DATA, "display", "OLED-SonyPVM-2541_gamma.csv")) as file:
        curve = {round(float(a)): float(b) for a, b in list(csv.reader(file))[1:]}
    xyz = {"red": (41, 21, 2), "green": (36, 72, 12), "blue": (18, 7, 95)}
    manifest = {"panel": "measured level curve", "emission": {"black": "emission/black.csv"}}
    levels = {31 + 32 * k: curve[round((31 + 32 * k) * 1023 / 255)] for k in range(8)}

    def write(name, values):
        rows = [(t, p, *values) for t in range(0, 81, 10) for p in range(0, 360, 30)]
        panels.write_table(os.path.join(folder, name), ("theta", "phi", "X", "Y", "Z"), rows)

    write("emission/black.csv", (0.01, 0.01, 0.01))
    for primary, full in xyz.items():
        manifest["emission"][primary] = {}
        for level, value in levels.items():
            name = f"emission/{primary}_{level:03}.csv"
            write(name, [0.01 + value * v for v in full])
            manifest["emission"][primary][str(level)] = name
    return panels.write_manifest(folder, manifest)


def measure_levels(program, options):
    sets = {}
    for name in SIMULATED:
        text = panels.with_grid(panels.without_noise(panels.recipe(name)), 44, 72)
        text.pop("reflection")
        sets[name] = panels.simulate(program, text, name + "-levels")
    sets["measured OLED curve"] = measured_curve_set(program.file("curve"))
    for name, manifest in sets.items():
        for level in (31, 63, 95, 127, 159, 191, 223):
            luminance, colour = leave_level_out(program, manifest, level, options)
            limit = "" if level == 31 or "curve" in name else " (limits 1%, 0.001)"
            print(f"{name}, level {level} left out: luminance {percent(luminance)}, delta u'v' "
                  f"{colour:.5f}{limit}")


# ---- random directions -----------------------------------------------------------------------

def emission_truth(program, path, questions):
    """XYZ by the program's own closed form, one call a direction: slow, so a few hundred."""
    out = []
    for t, p, r, g, b in questions:
        text = program.run("panel", "simulate", path, "--truth", f"{t:.9g},{p:.9g},{r},{g},{b}")
        out.append(json.loads(text)["XYZ"])
    return out


def measure_directions(program, options):
    """A few hundred here; a million in the unit test panel_directions."""
    for name in SIMULATED:
        text = panels.without_noise(panels.recipe(name))
        text.pop("reflection")
        manifest = panels.simulate(program, text, name + "-directions")
        panel = program.file(name + "-directions.panel")
        program.fit(manifest, panel, *options)
        draw = random.Random(1)
        questions = [(math.degrees(math.acos(draw.uniform(math.cos(math.radians(88)), 1))),
                      draw.uniform(0, 360), *(draw.choice((0, 31, 63, 127, 255))
                                              for _ in range(3))) for _ in range(200)]
        _, answers = program.ask(panel, ("theta", "phi", "r", "g", "b"), questions)
        truth = emission_truth(program, os.path.join(os.path.dirname(manifest), "recipe.json"),
                               questions)
        errors = [(max(abs(f / w - 1) if w > 1e-6 else 0 for f, w in zip(a[5:8], xyz)), q)
                  for a, xyz, q in zip(answers, truth, questions)]
        worst = max(errors)
        print(f"{name}, {len(questions)} random directions and colours to 88 deg: max "
              f"{percent(worst[0])} at {[round(v, 1) for v in worst[1]]}, rms "
              f"{percent(rms([e for e, _ in errors]))}")


def main():
    arguments = sys.argv[1:]
    only = panels.take_option(arguments, "--only", ",".join(PARTS)).split(",")
    if not arguments or set(only) - set(PARTS):
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory(prefix="panels_") as folder:
        program = panels.Program(arguments[0], folder)
        for part in only:
            if part in ("emission", "reflection") and not os.path.isdir(panels.DATA):
                print(f"skipped: {part}: no folder {panels.DATA}")
                continue
            try:
                globals()["measure_" + part](program, arguments[1:])
            except Refused as error:
                print(f"{part}: the program refuses: {error}")
            sys.stdout.flush()


if __name__ == "__main__":
    main()
