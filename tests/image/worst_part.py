# SPDX-License-Identifier: Apache-2.0
"""worst_part.py [--all] PARHELION -- a symbol is judged by its worst part: five bars on which a
plate throws the straight edge of its shadow, at places and slants for which the share of every
part that the sun lights is a closed form. Moment, variant, `explain`, causes and a sweep's step
say the same. --all: twenty edges instead of five.

The display's face is Lambertian: the sun alone gives rho E cos / pi, in the shade next to
nothing is left.
"""
import csv
import json
import math
import os
import sys
import tempfile

from gltf import Scene, png, unit
from contrast import RHO, write_set
from review import Report, Reviewer, request

WIDE, HIGH = 48, 32                # pixels of the content, a millimetre each
BARS = range(6, 42, 8)             # where the bars begin; they are 4 wide and 20 high
TOP, BOTTOM = 6, 26
BOX = (6, TOP, 42, BOTTOM)         # of the foreground, pixels
STROKE = 4
TOWARDS = unit([-1.5, 1.5, 1])     # the sun, of a display that faces +Z
LUX, SKY = 80000, 5
PLATE = 0.03                       # m before the display
APART = 0.5                        # m between displays
STEP = 1 / 8                       # of a stroke, in which parts are tried
EDGES = [(0, 0), (9.3, 0), (-15.5, 0), (2.5, -30), (4, -90)]
MORE = [(16.4, 0), (-8.2, 0), (4.9, 0), (-17.2, -10), (-3, -20), (11, -25), (14, -40),
        (-11, -45), (3.3, -50), (17, -60), (-6, -70), (7.5, -80), (-7, -90), (8.5, -90),
        (-9, -90)]


def content():
    on = {x for first in BARS for x in range(first, first + STROKE)}
    return png(WIDE, HIGH, [[255 if x in on and TOP <= y < BOTTOM else 0 for x in range(WIDE)
                             for _ in range(3)] for y in range(HIGH)])


def normal_of(slant):
    """Across the edge, to the side of the sun."""
    return math.cos(math.radians(slant)), math.sin(math.radians(slant))


def add_plate(scene, middle, offset, slant):
    """Black, with an edge whose shadow lies `offset` mm from the display's middle."""
    across = normal_of(slant)
    shift = [PLATE * TOWARDS[i] / TOWARDS[2] for i in (0, 1)]
    edge = [middle[i] + shift[i] + 1e-3 * offset * across[i] for i in (0, 1)]
    back = [-0.12 * a for a in across]
    side = [-0.16 * across[1], 0.16 * across[0]]
    corner = [edge[i] + back[i] - side[i] / 2 for i in (0, 1)]
    scene.quad(scene.lambert(0, double_sided=True), [*corner, PLATE], [*side, 0],
               [-back[0], -back[1], 0])


def scene_of(edges):
    scene = Scene()
    picture = scene.image("image/png", content())
    size = [1e-3 * WIDE, 1e-3 * HIGH]
    for i, (offset, slant) in enumerate(edges):
        middle = [APART * (i % 5 - 2), APART * (i // 5 - 1.5)]
        screen = scene.material(f"screen{i}", extensions={"PARHELION_display": {
            "panel": "closed.panel", "content": {"index": picture}, "level": 1}})
        scene.quad(screen, [middle[0] - size[0] / 2, middle[1] - size[1] / 2, 0],
                   [size[0], 0, 0], [0, size[1], 0])
        add_plate(scene, middle, offset, slant)
    scene.view("eye", [0, 0, 2.5], [0, 0, -1], 30)
    return scene


# ---- the closed form ------------------------------------------------------------------------

def lit_at(x, y, offset, slant):
    """Of the sun's disc, how much a place in pixels of the content sees: between the edges of
    the penumbra the disc's part on one side of a straight line."""
    across = normal_of(slant)
    away = across[0] * (x - WIDE / 2) + across[1] * (HIGH / 2 - y) - offset
    ray = [PLATE * 1e3 / TOWARDS[2] * t for t in TOWARDS]
    length = math.sqrt(sum(r * r for r in ray))
    slope = math.sqrt(1 + (sum(a * t for a, t in zip(across, TOWARDS)) / TOWARDS[2]) ** 2)
    t = away / (length * math.tan(math.radians(0.2665)) * slope)
    t = min(1, max(-1, t))
    return 0.5 + (t * math.sqrt(1 - t * t) + math.asin(t)) / math.pi


def lit_share(box, offset, slant, steps=(72, 48)):
    left, top, right, bottom = box
    places = [(left + (i + 0.5) / steps[0] * (right - left),
               top + (j + 0.5) / steps[1] * (bottom - top))
              for i in range(steps[0]) for j in range(steps[1])]
    return sum(lit_at(x, y, offset, slant) for x, y in places) / len(places)


def worst_share(offset, slant):
    """Of all parts a stroke wide, which are as high as the bars."""
    steps = 80
    return max(lit_share((x, TOP, x + STROKE, BOTTOM), offset, slant, (8, 24))
               for x in (BOX[0] + i / steps * (BOX[2] - STROKE - BOX[0])
                         for i in range(steps + 1)))


# ---- claims ---------------------------------------------------------------------------------

def sun_angles():
    """Azimuth over right from ahead, which is -Z; elevation."""
    return (math.degrees(math.atan2(TOWARDS[0], -TOWARDS[2])) % 360,
            math.degrees(math.asin(TOWARDS[1])))


def asked(edges):
    azimuth, elevation = sun_angles()
    sun = {"azimuth_deg": azimuth, "elevation_deg": elevation, "illuminance_lx": LUX}
    return request(
        symbols={f"edge {i}": {"display": f"screen{i}", "uv": [0.02, 0.02, 0.98, 0.98]}
                 for i in range(len(edges))},
        conditions=[{"name": "sun", "environment": {"type": "constant", "luminance": SKY,
                                                    "sun": sun}}],
        precision={"contrast": 0.01}, variants={"the same": {"brightness": {"screen0": 1}}})


def pixels(box):
    return (WIDE * box["left"], HIGH * box["top"], WIDE * box["right"], HIGH * box["bottom"])


def within(value, low, high, tolerance):
    return low - tolerance <= value <= high + tolerance


def check_case(report, case, edge):
    """Returns whether the 95 % intervals of part and mean hold their closed forms."""
    full = RHO * LUX * TOWARDS[2] / math.pi
    name, part = f"edge {edge}", pixels(case["judged_part_uv"])
    report.claim(part[2] - part[0] >= STROKE - 1e-3 and part[2] - part[0] < 1.1 * STROKE and
                 part[3] - part[1] >= BOTTOM - TOP - 1e-3, f"{name}: part {part}")
    rest = RHO * SKY   # at most: the plate hides some of it
    judged, mean = full * lit_share(part, *edge), full * lit_share(BOX, *edge)
    best = full * worst_share(*edge)
    light = case["luminance_cd_m2"]["reflected"]
    low, high = case["reflected_interval"]
    report.claim(abs(light - judged) <= 0.02 * full + rest,
                 f"{name}: part reflects {light:.5g}, closed form {judged:.5g}")
    report.claim(best - judged <= 1.2 * STEP * full / 2,
                 f"{name}: part of {judged:.5g}, the worst has {best:.5g}")
    all_of_it = case["symbol_mean"]
    report.claim(abs(all_of_it["reflected"] - mean) <= 0.04 * full + rest,
                 f"{name}: mean {all_of_it['reflected']:.5g}, closed form {mean:.5g}")
    report.claim(abs(case["lit_share"] - mean / full) < 0.01,
                 f"{name}: {case['lit_share']} lit, closed form {mean / full:.5g}")
    print(f"{name}: part {light:.5g} of {judged:.5g} (worst {best:.5g}), mean "
          f"{all_of_it['reflected']:.5g} of {mean:.5g}, lit {case['lit_share']:.4f} of "
          f"{mean / full:.4f}")
    ends = all_of_it["reflected_interval"]
    numeric = 0.002 * full
    return (within(judged + rest / 2, low, high, numeric + rest / 2),
            within(mean + rest / 2, ends[0], ends[1], numeric + rest / 2))


def numbers(value):
    """All of them, to the digits of a review.json."""
    if isinstance(value, dict):
        return [numbers(value[key]) for key in sorted(value)]
    return [numbers(v) for v in value] if isinstance(value, list) else f"{value:.5g}"


def check_same(report, reviewer, review, edges):
    """A variant that changes nothing, `explain` and the causes have the same part."""
    for case, other in zip(review["cases"], review["variants"][0]["cases"]):
        ends = case["contrast_interval"]
        report.claim(within(other["contrast_ratio"], *ends, 0),
                     f"{case['symbol']}: variant {other['contrast_ratio']} of {ends}")
        light = case["luminance_cd_m2"]["reflected"]
        found = sum(cause["cd_m2"] for cause in case["causes"])
        report.claim(abs(found - light) <= 0.05 * light + 0.1,
                     f"{case['symbol']}: causes of {found:.5g}, part of {light:.5g}")
    last = review["cases"][len(edges) // 2]
    answer = reviewer.run("explain", "r.json", "--symbol", last["symbol"], "--json")
    said = json.loads(answer.stdout)
    for key in ("judged_part_uv", "symbol_mean", "lit_share", "contrast_ratio"):
        report.claim(numbers(said[key]) == numbers(last[key]),
                     f"explain says {key} {said[key]} of {last[key]}")


def check_sweep(report, reviewer, edges):
    """A step with the sun of a moment reflects what the part of that moment does."""
    azimuth, elevation = sun_angles()
    sun = {"azimuth_deg": azimuth, "elevation_deg": elevation}
    document = asked(edges)
    document.pop("variants")
    document["conditions"] = [
        {"name": "moment", "environment": {"type": "sky", "sun": {
            **sun, "illuminance_lx": reviewer.sun_lux(elevation)}}},
        {"name": "suns", "sweep": {"sky": "sky", "sun": {
            key: [value, value, 1] for key, value in sun.items()}}}]
    _, review = reviewer.review(document, "swept")
    for case, sweep in zip(review["cases"], review["sweeps"]):
        with open(os.path.join(reviewer.folder, "swept", sweep["table"]),
                  encoding="utf-8") as file:
            row = next(csv.DictReader(file))
        wanted, found = case["luminance_cd_m2"]["reflected"], float(row["reflected_cd_m2"])
        full = RHO * reviewer.sun_lux(elevation) * TOWARDS[2] / math.pi
        report.claim(abs(found - wanted) < 0.02 * wanted + 0.05 * full, # of 32 places a part
                     f"{case['symbol']}: step of {found:.5g}, moment of {wanted:.5g}")
        worst = sweep["worst"]["luminance_cd_m2"]["reflected"]
        report.claim(abs(worst / wanted - 1) < 0.03,
                     f"{case['symbol']}: worst of {worst:.5g}, moment of {wanted:.5g}")


def main():
    report, edges = Report(), EDGES + (MORE if "--all" in sys.argv else [])
    with tempfile.TemporaryDirectory() as folder:
        reviewer = Reviewer(sys.argv[-1], folder)
        write_set(folder)
        done = reviewer.run("panel", "fit", "MANIFEST.json", "-o", "closed.panel")
        assert done.returncode == 0, done.stderr
        scene_of(edges).write(os.path.join(folder, "dash.gltf"))
        _, review = reviewer.review(asked(edges), "out")
        held = [check_case(report, *pair) for pair in zip(review["cases"], edges)]
        for i, what in enumerate(("part", "mean")):
            count = sum(case[i] for case in held)
            report.claim(count >= 0.95 * len(held) - 1,
                         f"{what}: {count} of {len(held)} intervals hold their closed form")
        check_same(report, reviewer, review, edges)
        check_sweep(report, reviewer, edges[:len(edges) if "--all" in sys.argv else 2])
    report.finish()


if __name__ == "__main__":
    main()
