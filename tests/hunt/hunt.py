# SPDX-License-Identifier: Apache-2.0
"""hunt.py [--seed N] [--count N] PARHELION -- a hunt for wrong answers: small random rooms with
a display. What a review says of the symbol's reflected light is held against the sum of its
causes, which other paths find; every figure against its formula; a room under twice the light
against twice the figure; `explain` against the review. Every fifth room is swept over suns.

A line a room, with its seed; at last how the differences are spread, in standard errors.
"""
import json
import math
import os
import random
import shutil
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "image"))
from gltf import Scene, png, unit  # noqa: E402
from review import PANEL, Report, Reviewer, moment, request  # noqa: E402

TOO_FAR = 4  # standard errors


def room(draw):
    """Walls about the display, some of them left out as windows."""
    scene = Scene()
    bars = png(60, 30, [[255 if 20 <= x < 40 and 8 <= y < 22 else 0 for x in range(60)
                         for _ in range(3)] for y in range(30)])
    scene.quad(scene.material("screen", extensions={"PARHELION_display": {
        "panel": "ips.panel", "content": {"index": scene.image("image/png", bars)}}}),
        [-0.15, -0.075, 0], [0.3, 0, 0], [0, 0.15, 0])
    trim, wall = scene.metal(0.6, 0.3), scene.lambert(draw.uniform(0, 0.8))
    walls = [([-0.6, -0.3, 1.2], [1.2, 0, 0], [0, 0, -1.3]),
             ([-0.6, -0.3, 1.2], [0, 0, -1.3], [0, 0.9, 0]),
             ([0.6, -0.3, -0.1], [0, 0, 1.3], [0, 0.9, 0]),
             ([-0.6, 0.6, -0.1], [1.2, 0, 0], [0, 0, 1.3])]
    windows = draw.sample(range(4), draw.randint(1, 3))
    for i, sides in enumerate(walls):
        if i not in windows:
            scene.quad(trim if draw.random() < 0.2 else wall, *sides)
    eye = [draw.uniform(-0.3, 0.3), draw.uniform(-0.1, 0.3), 0.8]
    scene.view("eye", eye, unit([-x for x in eye]), 12)
    return scene


def question(draw, seed):
    luminance = draw.uniform(50, 8000)
    sun = {"azimuth_deg": draw.uniform(0, 360), "elevation_deg": draw.uniform(5, 60),
           "illuminance_lx": draw.uniform(2e4, 1e5)}
    conditions = [moment("moment", type="constant", luminance=luminance),
                  moment("twice", type="constant", luminance=2 * luminance),
                  moment("sun", type="sky", sun=sun)]
    if seed % 5 == 0:
        suns = {"azimuth_deg": [150, 210, 10], "elevation_deg": [5, 35, 10]}
        conditions.append({"name": "suns", "level": "set",
                           "sweep": {"sun": suns, "sky": "sky"}})
    return request(conditions=conditions, precision={"contrast": 0.02},
                   levels={"set": {"*": round(draw.uniform(0.05, 1), 3)}})


def check_case(report, name, case):
    """A contrast is the formula of its luminances, lies in its interval, and decides."""
    light, found = case["luminance_cd_m2"], case["contrast_ratio"]
    if case["verdict"] == "not visible":
        return
    parts = [light[k] + light["reflected"] for k in ("foreground", "background")]
    wanted, (low, high) = max(parts) / min(parts), case["contrast_interval"]
    report.claim(math.isclose(found, wanted, rel_tol=1e-3),
                 f"{name}: contrast {found}, of its luminances {wanted:.5g}")
    report.claim(low <= found <= high, f"{name}: {found} not in {low} to {high}")
    for limit in case["limits"]:
        if limit["kind"] == "contrast_ratio" and not limit["upper"]:
            least, most = limit["interval"]
            says = ("pass" if least >= limit["value"] else
                    "fail" if most < limit["value"] else "too close")
            report.claim(says == limit["verdict"],
                         f"{name}: {limit['verdict']}, its interval says {says}")


def apart(case):
    """What is reflected less what its causes add up to, in standard errors; both, in words."""
    low, high = case["reflected_interval"]
    found = case["luminance_cd_m2"]["reflected"]
    causes = sum(cause["cd_m2"] for cause in case["causes"])
    halves = [(cause["interval"][1] - cause["cd_m2"]) for cause in case["causes"]]
    sigma = math.hypot((high - low) / 2, *halves) / 1.96
    return (found - causes) / max(sigma, 1e-9), f"{found:.6g}, its causes {causes:.6g} cd/m2"


def check_twice(report, seed, one, two):
    """Twice the light, with the same display: its own light in it stays as it is."""
    z = []
    for case in (one, two):
        low, high = case["reflected_interval"]
        z.append((case["luminance_cd_m2"]["reflected"], (high - low) / 3.92))
    (a, sure_a), (b, sure_b) = z
    own = 2 * a - b
    report.claim(-TOO_FAR * math.hypot(2 * sure_a, sure_b) <= own <= a +
                 TOO_FAR * math.hypot(2 * sure_a, sure_b),
                 f"seed {seed}: reflected {a:.6g}, under twice the light {b:.6g}")


def hunt(report, reviewer, seed):
    """The differences, in standard errors."""
    draw = random.Random(seed)
    room(draw).write(os.path.join(reviewer.folder, "dash.gltf"))
    status, review = reviewer.review(question(draw, seed), f"out{seed}")
    report.claim(status == (0 if review["pass"] else 1), f"seed {seed}: status {status}")
    cases = review["cases"] + [sweep["worst"] for sweep in review["sweeps"]]
    found = []
    for case in cases:
        name = f"seed {seed}, {case['condition']}"
        check_case(report, name, case)
        if case["verdict"] == "not visible":
            continue
        z, words = apart(case)
        found.append(z)
        print(f"{name}: {words}, z {z:.2f}", flush=True)
        report.claim(abs(z) <= TOO_FAR, f"{name}: {words}, z {z:.2f}")
    check_twice(report, seed, cases[0], cases[1])
    done = reviewer.run("explain", "r.json", "--condition", "moment", "--json")
    told = json.loads(done.stdout)
    report.claim(math.isclose(told["contrast_ratio"], cases[0]["contrast_ratio"],
                              rel_tol=1e-4), f"seed {seed}: explain {told['contrast_ratio']}")
    return found


def tell_spread(report, found):
    for low in range(-5, 5):
        count = sum(low <= z < low + 1 for z in found)
        print(f"z {low:+d} to {low + 1:+d}: {count:4d} {'#' * count}")
    outside = sum(abs(z) > 1.96 for z in found)
    print(f"{outside} of {len(found)} differ by more than 1.96 standard errors")
    allowed = 0.05 * len(found) + 4 * math.sqrt(0.05 * 0.95 * len(found))
    report.claim(outside <= allowed,
                 f"{outside} of {len(found)} outside, {allowed:.0f} allowed")


def main(words):
    seed, count = 1, 10
    while len(words) > 1:
        if words[0] == "--seed":
            seed, count = int(words[1]), 1
        else:
            count = int(words[1])
        words = words[2:]
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        shutil.copy(PANEL, os.path.join(folder, "ips.panel"))
        found = []
        for each in range(seed, seed + count):
            found += hunt(report, Reviewer(words[0], folder), each)
    tell_spread(report, found)
    return report.finish()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
