# SPDX-License-Identifier: Apache-2.0
"""sunglasses.py PARHELION -- what a review says of an observer who wears sunglasses: grey ones
leave every contrast and darken what the eye adapts to; lenses whose transmittances add up let
through lights that add up; a polariser follows Malus' law on the panel's own polarisation.
"""
import json
import math
import os
import shutil
import sys
import tempfile

from review import PANEL, ROOT, Report, Reviewer, dashboard, moment, request

EXTINCTION = 50
STEP_NM = 590


def degree():
    path = os.path.join(ROOT, "assets", "panels", "ips_cluster.recipe.json")
    with open(path, encoding="utf-8") as file:
        return json.load(file)["polarisation"]["degree"]


def write_lenses(folder):
    for name, below, above in (("red.csv", 0.1, 0.7), ("blue.csv", 0.5, 0.1)):
        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
            file.write(f"nm,value\n360,{below}\n{STEP_NM},{below}\n{STEP_NM + 10},{above}\n"
                       f"830,{above}\n")
    with open(os.path.join(folder, "sum.csv"), "w", encoding="utf-8") as file:
        file.write(f"nm,value\n360,0.6\n{STEP_NM},0.6\n{STEP_NM + 10},0.8\n830,0.8\n")


LENSES = {"none": None, "category 3": {"category": 3}, "grey": {"transmittance": 0.3},
          "red": {"transmittance": "red.csv"}, "blue": {"transmittance": "blue.csv"},
          "sum": {"transmittance": "sum.csv"},
          **{f"polarised {deg}": {"transmittance": 0.2, "polarising": {
              "axis_deg": deg, "extinction": EXTINCTION}} for deg in (0, 30, 90)}}


def cases(reviewer):
    conditions = [dict(moment(name, type="constant", luminance=3000),
                       **({"sunglasses": lens} if lens else {}))
                  for name, lens in LENSES.items()]
    document = request(conditions=conditions, precision={"contrast": 0.02, "clear": 0.02})
    return {c["condition"]: c for c in reviewer.review(document, "worn")[1]["cases"]}


def check_grey(report, found):
    bare = found["none"]
    for name, lets in (("category 3", 0.13), ("grey", 0.3)):
        case = found[name]
        report.claim(case["contrast_ratio"] == bare["contrast_ratio"] and
                     case["contrast_with_veil"] == bare["contrast_with_veil"],
                     f"{name}: contrast {case['contrast_ratio']}, bare "
                     f"{bare['contrast_ratio']}")
        report.claim(case["glasses_transmittance"] == lets, f"{name}: {lets}")
        report.claim(case["jnd"] < bare["jnd"], f"{name}: {case['jnd']} grey steps")
    report.claim(found["category 3"]["jnd"] < found["grey"]["jnd"], "darker, fewer grey steps")


def check_sums(report, found):
    """Luminance times transmittance is linear in the lens."""
    def behind(name, key):
        case = found[name]
        return case["glasses_transmittance"] * case["luminance_cd_m2"][key]
    for key, share in (("foreground", 1e-4), ("background", 1e-4), ("reflected", 0.02)):
        red, blue, both = (behind(name, key) for name in ("red", "blue", "sum"))
        report.claim(abs(red + blue - both) <= share * both,
                     f"{key}: {red} + {blue} is not {both}")
    lets = [found[name]["glasses_transmittance"] for name in ("red", "blue", "sum")]
    report.claim(abs(lets[0] + lets[1] - lets[2]) < 1e-5, f"transmittances {lets}")
    report.claim(0.1 < lets[0] < 0.4 and 0.2 < lets[1] < 0.5, f"transmittances {lets}")


def check_malus(report, found):
    """The panel's field lies along its right, the eye's; an axis counts from upright."""
    bare = found["none"]["luminance_cd_m2"]
    weight = degree() * (EXTINCTION - 1) / (EXTINCTION + 1)
    for deg in (0, 30, 90):
        case = found[f"polarised {deg}"]
        wanted = 1 + weight * math.cos(2 * math.radians(90 - deg))
        share = case["luminance_cd_m2"]["foreground"] / bare["foreground"]
        report.claim(abs(share - wanted) < 0.01, f"{deg}: {share}, by Malus {wanted}")
        report.claim(abs(case["glasses_display_loss"] - (1 - wanted)) < 0.01 and
                     "polarising" in case["glasses"], f"{deg}: {case['glasses_display_loss']}")
        scattered = case["luminance_cd_m2"]["scattered"] / bare["scattered"]
        report.claim(abs(scattered - 1) < 0.03, f"{deg}: scattered light changes: {scattered}")


WRONG = (({"category": 5}, "category"), ({}, "neither"), ({"category": 1, "transmittance": 1},
                                                        "both"),
         ({"transmittance": 0}, "transmittance"), ({"transmittance": "no.csv"}, "no.csv"),
         ({"transmittance": 0.9, "polarising": {}}, "at most"),
         ({"transmittance": 0.4, "polarising": {"extinction": 0.5}}, "extinction"),
         ({"transmittance": "black.csv"}, "no light"), ({"tint": 1}, "unknown key"))


def check_refused(report, reviewer):
    with open(os.path.join(reviewer.folder, "black.csv"), "w", encoding="utf-8") as file:
        file.write("nm,value\n360,0\n830,0\n")
    sweep = {"sun": {"azimuth_deg": [0, 90, 45], "elevation_deg": [30, 30, 1]}, "sky": "sky"}
    conditions = [(dict(moment("a", type="constant", luminance=1), sunglasses=lens), words)
                  for lens, words in WRONG]
    conditions.append(({"name": "a", "sweep": sweep, "sunglasses": {
        "transmittance": 0.2, "polarising": {}}}, "sweep"))
    for condition, words in conditions:
        reviewer.write("r.json", request(conditions=[condition]))
        done = reviewer.run("review", "r.json", "--dry-run")
        named = words == "no.csv" or "/conditions/0/sunglasses" in done.stderr
        report.claim(done.returncode == 3 and words in done.stderr and named,
                     f"{condition['sunglasses']}: {done.returncode}: {done.stderr}")
    reviewer.write("r.json", request(conditions=[dict(
        moment("a", type="constant", luminance=1), sunglasses={"category": 4})]))
    done = reviewer.run("review", "r.json", "--dry-run")
    report.claim(done.returncode == 0 and "not for driving" in done.stderr, done.stderr)


def main(program):
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        reviewer = Reviewer(program, folder)
        shutil.copy(PANEL, os.path.join(folder, "ips.panel"))
        dashboard().write(os.path.join(folder, "dash.gltf"))
        write_lenses(folder)
        check_refused(report, reviewer)
        found = cases(reviewer)
        check_grey(report, found)
        check_sums(report, found)
        check_malus(report, found)
    return report.finish()


if __name__ == "__main__":
    sys.exit(main(sys.argv[-1]))
