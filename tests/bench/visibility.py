#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""visibility.py BENCH_VISIBILITY [FOLDER] -- the visibility level's thresholds (src/vision/
visibility.h) beside what people saw.

FOLDER (../shared/data/vision unless given) holds tables of castleCSF (gfxdisp/castleCSF, data/,
MIT): castlecsf_backgrounds.csv, castlecsf_color_directions.csv, and any castlecsf_*.csv with a
column log_cone_contrast. Taken is every row about a disc that stands still, is looked at and
differs in luminance; the others are counted with the reason why they are left out.

Size        the disc's diameter, 2 ge_sigma, in arc minutes.
Adaptation  the background's luminance; the veil of a dark room is not known and left out.
Contrast    a threshold is k d, d the direction (L, M, S) and B the background. Its cone
            contrast is defined as c = k sqrt(((dL/BL)^2 + (dM/BM)^2 + (dS/BS)^2)/3); luminance
            is L + M in these tables (it gives the column of luminances). So it differs by
                c (dL + dM) / sqrt(mean of (d/B)^2).
            Were the direction the background's own, that would be c times the background. It
            is nearly so for L and M, but S of hdr_csf_disc's directions is 2.3 times as much,
            so that the contrast of luminance is 0.65 c. Whether that is how the discs were or
            how the table counts S is not known: both are printed.
Observers   25 years where no age is given, looking as long as they liked, discs lighter than
            their background.
Criterion   these thresholds are of a choice among four or so. The formula has 2.6 for what is
            seen nearly always; 1 in its place is for half. So the mean by which the formula is
            above is a matter of the criterion, `rms about it` of the formula.
Spread      the root of the mean of var_log_cone_contrast: how sure each threshold is."""
import csv
import glob
import math
import os
import subprocess
import sys

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
USUAL = os.path.join(ROOT, "..", "shared", "data", "vision")
USUAL_AGE, LEISURE_S, K = 25.0, 2.0, 2.6
LUMINANCE_ALIKE = 0.05  # of dL/BL and dM/BM: more is another colour


def number(row, key):
    try:
        value = float(row.get(key) or "nan")
    except ValueError:
        return math.nan
    return value


def table(folder, name):
    with open(os.path.join(folder, name), encoding="utf-8") as file:
        return list(csv.DictReader(file))


def vectors(rows, id_key, keys):
    """By study and number: the tables use some numbers twice."""
    return {(row["dataset"], row[id_key]): [number(row, key) for key in keys] for row in rows}


def why_left_out(row, background, direction):
    if row["stimulus"] not in ("disk", "disc"):
        return "no discs"
    if number(row, "t_frequency") != 0:
        return "they flicker"
    if number(row, "eccentricity") != 0:
        return "they are not looked at"
    if not background or not direction or not all(map(math.isfinite, background + direction)):
        return "no background or direction in the tables"
    by_cone = [d / b for d, b in zip(direction, background)]
    if not by_cone[1] or abs(by_cone[0] / by_cone[1] - 1) > LUMINANCE_ALIKE:
        return "they differ in colour"
    if sum(direction[:2]) < 0:
        return "darker: whether the tables' sign means that is not stated"
    return None


def contrasts(row, background, direction):
    """(by the direction's own numbers, as if the direction were the background's)"""
    cone = 10 ** number(row, "log_cone_contrast")
    mean = math.sqrt(sum((d / b) ** 2 for d, b in zip(direction, background)) / 3)
    return cone * sum(direction[:2]) / mean / sum(background[:2]), cone


def taken_rows(folder):
    """[(study, row, contrasts)], {study: {reason: count}}, studies without thresholds here"""
    backgrounds = vectors(table(folder, "castlecsf_backgrounds.csv"), "bkg_id", "LMS")
    directions = vectors(table(folder, "castlecsf_color_directions.csv"), "col_dir_id",
                         ("L_delta", "M_delta", "S_delta"))
    taken, left = [], {}
    for path in sorted(glob.glob(os.path.join(folder, "castlecsf_*.csv"))):
        for row in table(folder, os.path.basename(path)):
            if "log_cone_contrast" not in row:
                break
            study = row["dataset"]
            background = backgrounds.get((study, row["bkg_id"]))
            direction = directions.get((study, row["col_dir_id"]))
            reason = why_left_out(row, background, direction)
            if reason:
                counts = left.setdefault(study, {})
                counts[reason] = counts.get(reason, 0) + 1
            else:
                taken.append((study, row, contrasts(row, background, direction)))
    studies = {study for study, _ in [*backgrounds, *directions]}
    absent = studies - {study for study, _, _ in taken} - set(left)
    return taken, left, sorted(absent)


def diameter_arcmin(row):
    radius = number(row, "ge_sigma")
    return 120 * (radius if math.isfinite(radius) else math.sqrt(number(row, "area") / math.pi))


def age_of(row):
    age = number(row, "age")
    return age if math.isfinite(age) else USUAL_AGE


def predictions(bench, taken):
    lines = [f"{diameter_arcmin(row):.17g} {number(row, 'luminance'):.17g} {age_of(row):.17g} "
             f"{LEISURE_S} 0" for _, row, _ in taken]
    run = subprocess.run([bench], input="\n".join(lines), text=True, check=True,
                         stdout=subprocess.PIPE)
    return [float(line) for line in run.stdout.split()]


def rms(values):
    return math.sqrt(sum(value * value for value in values) / len(values))


def print_study(study, rows):
    print(f"{study}\n  cd/m2  diameter'  people dL/L  formula dL/L  lg ratio")
    for row, found, threshold in rows:
        light = number(row, "luminance")
        print(f"  {light:<6g} {diameter_arcmin(row):8.4g}  {found[0]:12.4f}  "
              f"{threshold / light:12.4f}  {math.log10(threshold / light / found[0]):+8.3f}")
    variances = [number(row, "var_log_cone_contrast") for row, _, _ in rows]
    variances = [value for value in variances if math.isfinite(value)]
    spread = f"{math.sqrt(sum(variances) / len(variances)):.3f}" if variances else "not told"
    for which, words in ((0, "contrast by the direction's own S"),
                         (1, "contrast as if the disc had the background's colour")):
        errors = [math.log10(threshold / number(row, "luminance") / found[which])
                  for row, found, threshold in rows]
        mean = sum(errors) / len(errors)
        print(f"  {len(errors)} thresholds, {words}: rms {rms(errors):.3f} in lg, mean "
              f"{mean:+.3f}, rms about it {rms([error - mean for error in errors]):.3f}; "
              f"with 1 for {K}: rms {rms([error - math.log10(K) for error in errors]):.3f}; "
              f"the data's own spread {spread}")


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    folder = sys.argv[2] if len(sys.argv) == 3 else USUAL
    if not os.path.exists(os.path.join(folder, "castlecsf_backgrounds.csv")):
        print(f"visibility beside people: skipped, no castleCSF tables in {folder}")
        return
    taken, left, absent = taken_rows(folder)
    by_study = {}
    for (study, row, found), threshold in zip(taken, predictions(sys.argv[1], taken)):
        if math.isfinite(threshold):
            by_study.setdefault(study, []).append((row, found, threshold))
        else:
            counts = left.setdefault(study, {})
            reason = "outside of the formula's ages"
            counts[reason] = counts.get(reason, 0) + 1
    for study, rows in by_study.items():
        print_study(study, rows)
    for study, counts in sorted(left.items()):
        for reason, count in counts.items():
            print(f"left out, {study}: {count} rows, {reason}")
    if absent:
        print(f"without thresholds in this folder: {', '.join(absent)}")


if __name__ == "__main__":
    main()
