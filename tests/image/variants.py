# SPDX-License-Identifier: Apache-2.0
"""variants.py [--all] PARHELION -- what a review says of its variants is what separate reviews
of scenes changed by hand say; differences are sharper than values; what is not changed is not
read again; pictures stand side by side, each from where its eye is.
Without --all two of the variants in one light and no sweep, each beside one review, and what is
refused.
"""
import math
import operator
import os
import shutil
import sys
import tempfile

from exr import Frame
from gltf import png
from review import EYE, PANEL, Report, Reviewer, dashboard, moment, request

OLED = os.path.join(os.path.dirname(PANEL), "oled_centre.panel")
LEVEL = 0.3
OTHER_SEED = 11
SEEDS = 11, 12, 13  # of reviews by hand: their mean is surer than the one held against it
PRECISION = 0.004


def scene(tilt_deg=0.0, wall=0.5, panel="ips.panel", turned=None):
    """The dashboard, whose screen is tilted by hand about its middle; turned: its content."""
    made = dashboard()
    document = made.document
    document["nodes"][0]["name"] = "face"
    material = next(m for m in document["materials"] if m["name"] == "screen")
    material["extensions"]["PARHELION_display"]["panel"] = panel
    for other in document["materials"]:
        if other is not material:
            other["name"] = "wall"
            other["pbrMetallicRoughness"]["baseColorFactor"] = [wall] * 3 + [1]
    angle = math.radians(-tilt_deg)
    document["nodes"][0]["rotation"] = [math.sin(angle / 2), 0, 0, math.cos(angle / 2)]
    if turned:
        document["images"][0] = {"uri": turned}
    return made


def bars(first, last):
    return png(60, 30, [[255 if first <= x < last and 8 <= y < 22 else 0 for x in range(60)
                         for _ in range(3)] for y in range(30)])


def asked(level=LEVEL, swept=True, **members):
    sun = {"azimuth_deg": [150, 190, 20], "elevation_deg": [20, 40, 20]}
    conditions = [dict(moment("grey", type="constant", luminance=3000), level="day"),
                  {"name": "suns", "level": "day", "sweep": {"sun": sun, "sky": "sky"}}]
    return request(conditions=conditions[:1 + swept], levels={"day": {"*": level}},
                   precision={"contrast": PRECISION, "clear": PRECISION}, **members)


# A variant, and the same by hand: members of the scene, of the request.
VARIANTS = {
    "the same": ({"brightness": {"screen": 1}}, {}, {}),
    "brighter": ({"brightness": {"*": 1.5}}, {}, {"level": 1.5 * LEVEL}),
    "other level": ({"levels": {"day": {"*": 0.2}}}, {}, {"level": 0.2}),
    "tilted": ({"nodes": {"face": {"tilt_deg": 8}}}, {"tilt_deg": 8}, {}),
    "black walls": ({"materials": {"wall": {"pbrMetallicRoughness": {
        "baseColorFactor": [0.1, 0.1, 0.1, 1]}}}}, {"wall": 0.1}, {}),
    "other panel": ({"panels": {"screen": "oled.panel"}}, {"panel": "oled.panel"}, {}),
    "other content": ({"contents": {"screen": "bars.png"}}, {"turned": "bars.png"}, {}),
    "higher eye": ({"eyes": {"eye": {"move_m": [0, 0.1, 0]}}}, {},
                   {"eyes": {"eye": {"position_m": [0.1, 0.25, 0.8]}}}),
    "another file": ({"scene": ["black.gltf"]}, {"wall": 0.1}, {}),
    "more files": ({"add": ["bars.gltf"]}, {}, {"scene": ["dash.gltf", "bars.gltf"]}),
}


SOME = ("the same", "tilted")


def half(pair):
    return 0.5 * (pair[1] - pair[0])


def cases_of(review):
    return {(c["condition"], c["symbol"]): c
            for c in review["cases"] + [s["worst"] for s in review["sweeps"]]}


def margin_half(case):
    """Half the interval of a margin, ln(contrast) over ln(limit) less one."""
    return (half(case["contrast_interval"]) / case["contrast_ratio"] /
            math.log(case["limit"]["value"]))


def check_variant(report, name, variant, base, several, plain):
    """Held against reviews of its own, by other random numbers."""
    for found in variant["cases"] + variant["sweeps"]:
        key = found["condition"], found["symbol"]
        before, by_hand = cases_of(base)[key], cases_of(several[0])[key]
        place = f"{name}, {key[0]}"
        own = margin_half({**found, "limit": by_hand["limit"]})
        margin = sum(cases_of(review)[key]["margin"] for review in several) / len(several)
        report.claim(abs(found["margin"] - margin) <= own + margin_half(by_hand) + 1e-6,
                     f"{place}: margin {found['margin']}, by hand {margin}")
        low, high = found["margin_difference_interval"]
        report.claim(low <= found["margin_difference"] <= high, f"{place}: {low} to {high}")
        report.claim(abs(found["margin"] - found["margin_before"] -
                         found["margin_difference"]) < 1e-4 * (1 + abs(found["margin"])),
                     f"{place}: difference {found['margin_difference']}")
        report.claim(found["margin_before"] == before["margin"], f"{place}: margin before")
        report.claim(found["verdict"] == by_hand["verdict"] or
                     "too close" in (found["verdict"], by_hand["verdict"]),
                     f"{place}: {found['verdict']}, by hand {by_hand['verdict']}")
        yield name, half((low, high)), math.hypot(margin_half(by_hand),
                                                  margin_half(cases_of(plain)[key]))


def check_variants(report, reviewer, names, seeds, swept):
    variants = {name: VARIANTS[name][0] for name in names}
    _, base = reviewer.review(asked(swept=swept, variants=variants), "base")
    report.claim([v["name"] for v in base["variants"]] == list(variants), "variants' names")
    widths, plain = [], None
    for variant in base["variants"]:
        name = variant["name"]
        _, of_scene, of_request = VARIANTS[name]
        scene(**of_scene).write(os.path.join(reviewer.folder, "hand.gltf"))
        document = asked(**{"swept": swept, "scene": ["hand.gltf"], **of_request})
        several = []
        for document["precision"]["seed"] in seeds:
            several.append(reviewer.review(document, "alone")[1])
        plain = plain or several[0]  # the first is the same: the review without variants
        widths += check_variant(report, name, variant, base, several, plain)
        report.claim(variant["pass"] == all(
            c["verdict"] != "fail" for c in variant["cases"] + variant["sweeps"]),
            f"{name}: passes {variant['pass']}")
        least = min(c["margin"] for c in variant["cases"] + variant["sweeps"])
        report.claim(variant["worst"]["margin"] == least, f"{name}: least margin {least}")
    for name, own, separate in widths:
        print(f"  {name}: interval of the difference {own:.2g}, of two reviews {separate:.2g}")
        if name == "the same":
            report.claim(own == 0, "what is not changed differs")
    ratios = sorted(own / separate for name, own, separate in widths if name != "the same")
    print(f"  of the two reviews' by themselves: median {ratios[len(ratios) // 2]:.2f}, most "
          f"{ratios[-1]:.2f}")
    report.claim(ratios[len(ratios) // 2] < 0.5, f"median of sharpness {ratios}")


def curved(times, **members):
    """An eye box, and a level that follows the light: a table that many times as bright."""
    document = asked(**members)
    document["levels"] = {"day": {
        "sensor": {"position_m": [0, 0.2, 0.3], "normal": [0, 1, 0]},
        "table_lx": [[100, 0.1 * times], [20000, 0.3 * times]]}}
    document["eyes"] = {"eye": {"centre_m": [0.1, 0.15, 0.8], "half_size_m": [0.03, 0.02, 0.03],
                                "grid": [2, 2, 2]}}
    return document


def beside(mirror_z=0.0):
    """The dashboard with a mirror to its right, and a plate under its floor, which no light
    that it shows has met."""
    made = scene()
    plate = made.lambert(0.9)
    made.document["materials"][plate]["name"] = "plate"
    made.quad(plate, [-0.4, -0.5, 0.6], [0.2, 0, 0], [0, 0, -0.2])
    made.document["nodes"][-1]["name"] = "plate"
    made.quad(made.metal(0.9), [0.4, -0.2, mirror_z], [0, 0, 0.4], [0, 0.4, 0])
    made.document["nodes"][-1]["name"] = "mirror"
    return made


# What a variant changes, its level, and where its mirror is; whether its light is the review's.
ALIKE = {
    "the same": ({"brightness": {"screen": 1}}, LEVEL, 0, True),
    "brighter": ({"brightness": {"screen": 1.1}}, 1.1 * LEVEL, 0, True),
    "plate moved": ({"nodes": {"plate": {"move_m": [0, 0, 0.1]}}}, LEVEL, 0, True),
    "black plate": ({"materials": {"plate": {"pbrMetallicRoughness": {
        "baseColorFactor": [0, 0, 0, 1]}}}}, LEVEL, 0, True),
    "mirror moved": ({"nodes": {"mirror": {"move_m": [0, 0, -1]}}}, LEVEL, -1, False),
}


def check_alike(report, reviewer):
    """A variant is read by itself only where it changes the light; else its light is the
    review's. Both are what reviews by hand say."""
    beside().write(os.path.join(reviewer.folder, "dash.gltf"))
    changes = {name: change for name, (change, *_) in ALIKE.items()}
    _, base = reviewer.review(asked(swept=False, variants=changes), "alike")
    own, by_hand = base["cases"][0], {}
    for variant in base["variants"]:
        name, found = variant["name"], variant["cases"][0]
        _, level, mirror_z, is_alike = ALIKE[name]
        within = found["alike_within"]
        report.claim((within is not None) == is_alike, f"{name}: alike within {within}")
        if (level, mirror_z) not in by_hand:
            beside(mirror_z).write(os.path.join(reviewer.folder, "hand.gltf"))
            document = asked(level, swept=False, scene=["hand.gltf"])
            document["precision"]["seed"] = OTHER_SEED
            by_hand[level, mirror_z] = reviewer.review(document, "alone")[1]
        for _ in check_variant(report, name, variant, base, [by_hand[level, mirror_z]], base):
            pass
        if not is_alike:
            continue
        report.claim(within <= PRECISION, f"{name}: alike within {within}")
        report.claim(found["reflected_cd_m2"] == own["luminance_cd_m2"]["reflected"],
                     f"{name}: reflects {found['reflected_cd_m2']}, the review {own}")
        if level == LEVEL:
            low, high = found["margin_difference_interval"]
            report.claim(found["margin_difference"] == 0 and low <= 0 <= high and
                         (low == high) == (name == "the same"),
                         f"{name}: differs by {found['margin_difference']}, {low} to {high}")


def width_of(path):
    with open(path, "rb") as file:
        return int.from_bytes(file.read(20)[16:], "big")


def box_of(frame, channel):
    """Where it has numbers, on even pixels: left, top, right, bottom."""
    places = [divmod(i, frame.width) for i, value in enumerate(frame.channels[channel])
              if value == value]
    rows, columns = [y for y, _ in places], [x for _, x in places]
    return (min(columns) // 2 * 2 + 2, min(rows) // 2 * 2 + 2, max(columns) // 2 * 2,
            max(rows) // 2 * 2)


def check_pair(report, reviewer, name, frames, times):
    """The same view twice, the second half as wide: with so much more of what the display
    sends."""
    paths = [os.path.join(reviewer.folder, name, frames[key]) for key in ("before", "after")]
    report.claim([width_of(path) for path in paths] == [256, 128], f"pair {frames}")
    before, after = (Frame(path.replace(".png", ".exr")) for path in paths)
    box = box_of(before, "display.emitted.G")
    (mean, sigma), (more, other) = (before.mean_luminance(box),
                                    after.mean_luminance([side // 2 for side in box]))
    pixels = before.pixels(box)
    emitted = (times - 1) / len(pixels) * sum(
        weight * value for channel, weight in zip("RGB", (0.2126, 0.7152, 0.0722))
        for value in (before.channels[f"display.emitted.{channel}"][i] for i in pixels)
        if value == value) # others are no display's
    wide = 4 * math.hypot(sigma, other) + 0.02 * emitted
    report.claim(wide < 0.2 * emitted and abs(more - mean - emitted) <= wide,
                 f"{times} times as bright: {mean} + {emitted}, {more}, within {wide}")


def check_curves(report, reviewer):
    """Variants of levels alone, under a level that is a curve."""
    variants = {"brighter": {"brightness": {"*": 1.3}}, "dimmer": {"levels": None},
                "much brighter": {"brightness": {"screen": 3}}}
    variants["dimmer"]["levels"] = curved(0.8)["levels"]
    document = curved(1, variants=variants)
    document["frames"] = {"size": [256, 144], "noise": 0.2, "worst": 1}
    _, base = reviewer.review(document, "curves")
    _, plain = reviewer.review(curved(1), "plain")
    for variant, times in zip(base["variants"], (1.3, 0.8, 3)):
        by_hand = curved(times)
        by_hand["precision"]["seed"] = OTHER_SEED
        _, alone = reviewer.review(by_hand, "alone")
        name = variant["name"]
        for _, own, separate in check_variant(report, name, variant, base, [alone], plain):
            if times < 2:
                report.claim(own < 0.5 * separate, f"{name}: sharp to {own} of {separate}")
    check_pair(report, reviewer, "curves", base["variants"][2]["frames"], 3)


def middle_of(path):
    """Where the brighter half of a picture lies, in its own widths from the middle."""
    frame = Frame(path.replace(".png", ".exr"))
    green = frame.channels["G"]
    bright = [i % frame.width for i, value in enumerate(green) if value > max(green) / 2]
    return sum(x + 0.5 for x in bright) / len(bright) / frame.width - 0.5


def check_moved_camera(report, reviewer):
    """An eye that is a camera, moved aside: its picture is the one from there, a pinhole's."""
    aside, half_high = 0.03, math.tan(math.radians(4))
    document = request(conditions=[moment("grey", type="constant", luminance=30)],
                       variants={"aside": {"eyes": {"eye": {"move_m": [aside, 0, 0]}}}})
    document["precision"] = {"contrast": 0.05, "paths": 8192}
    document["frames"] = {"size": [192, 108], "noise": 0.5, "worst": 1}
    _, review = reviewer.review(document, "moved")
    frames = review["variants"][0]["frames"]
    before, after = (middle_of(os.path.join(reviewer.folder, "moved", frames[key]))
                     for key in ("before", "after"))
    ahead = [-x / math.dist(EYE, [0, 0, 0]) for x in EYE]
    right = [-ahead[2] / math.hypot(ahead[0], ahead[2]), 0,
             ahead[0] / math.hypot(ahead[0], ahead[2])]
    seen = [-EYE[0] - aside, -EYE[1], -EYE[2]]
    due = sum(map(operator.mul, right, seen)) / sum(map(operator.mul, ahead, seen)) / \
        (2 * half_high * 192 / 108)
    report.claim(abs(before) < 0.01 and abs(after - due) < 0.01,
                 f"camera moved: the bar at {before}, then {after}; a pinhole says {due}")


def check_refusals(report, reviewer, whole):
    for change, words in (
            ({"nodes": {"fase": {"tilt_deg": 3}}}, "no node is named \"fase\""),
            ({"panels": {"scren": "oled.panel"}}, "is named \"scren\""),
            ({"materials": {"walls": {}}}, "no material is named \"walls\""),
            ({"materials": {"wall": {"doubleSided": 3}}}, "doubleSided"),
            ({"hoods": {"scren": 0.1}}, "no display is named \"scren\""),
            ({"finishes": {"scren": {"scatters": 0.5, "width_deg": 5}}},
             "no display is named \"scren\""),
            ({"finishes": {"screen": {"scatters": 0.5}}}, "width_deg"),
            ({"nodes": {"face": {"hinge": {"axis": [0, 0, 0], "angle_deg": 3}}}},
             "zero vector"),
            ({"nodes": {"face": {"hinge": {"axis": [0, 1, 0]}}}}, "angle_deg"),
            ({"mirror": {"middle_m": "here"}}, "/variants/x/mirror/middle_m"),
            ({"eyes": {"nobody": {"move_m": [0, 0, 0]}}}, "/variants/x/eyes/nobody"),
            ({"levels": {"dusk": {"*": 1}}}, "/variants/x/levels/dusk"),
            ({"brightness": {"scren": 2}}, "scren"),
            ({"panels": {"screen": "none.panel"}}, "none.panel"),
            ({"coatings": {"wall": "gold"}}, "gold"),
            ({"tilt": 3}, "unknown key"), ({}, "changes nothing")):
        reviewer.write("r.json", asked(variants={"x": change}))
        for options in (("-o", "refused"), ("--dry-run",))[:1 + whole]:
            done = reviewer.run("review", "r.json", *options)
            lines = done.stderr.strip().splitlines()
            report.claim(done.returncode == 3 and words in done.stderr and len(lines) == 1,
                         f"{change}: status {done.returncode}: {done.stderr}")
        report.claim(not os.path.exists(os.path.join(reviewer.folder, "refused")),
                     "something is left behind")


def main(program, whole):
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        reviewer = Reviewer(program, folder)
        shutil.copy(PANEL, os.path.join(folder, "ips.panel"))
        shutil.copy(OLED, os.path.join(folder, "oled.panel"))
        with open(os.path.join(folder, "bars.png"), "wb") as file:
            file.write(bars(10, 50))
        scene().write(os.path.join(folder, "dash.gltf"))
        scene(wall=0.1).write(os.path.join(folder, "black.gltf"))
        more = dashboard().__class__()
        more.quad(more.lambert(0.8), [0.3, -0.2, 0.1], [0, 0, 0.5], [0, 0.5, 0])
        more.write(os.path.join(folder, "bars.gltf"))
        if whole:
            check_variants(report, reviewer, VARIANTS, SEEDS, True)
            check_moved_camera(report, reviewer)
            check_curves(report, reviewer)
        else:
            check_variants(report, reviewer, SOME, SEEDS[:1], False)
        check_refusals(report, reviewer, whole)
        check_alike(report, reviewer)
    return report.finish()


if __name__ == "__main__":
    sys.exit(main(sys.argv[-1], "--all" in sys.argv))
