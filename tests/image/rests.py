# SPDX-License-Identifier: Apache-2.0
"""rests.py PARHELION -- a review says what its verdicts rest on: panels measured or synthetic,
materials that were guessed with their share of the light, eyes that were proposed, who sits
there, limits read or quoted; the same line on page, summary, console and in review.json. Every
file that was read is listed, with the hash of its bytes.
"""
import hashlib
import html
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

from exr import Frame
from gltf import Scene, png
from review import PANEL, ROOT, Report, Reviewer, close, moment, request

RECIPE = os.path.join(ROOT, "assets", "panels", "ips_cluster.recipe.json")
OLED = os.path.join(os.path.dirname(PANEL), "oled_centre.panel")


def hash_of(path):
    with open(path, "rb") as file:
        return hashlib.sha256(file.read()).hexdigest()


def bars(last=40):
    return png(60, 30, [[255 if 20 <= x < last and 8 <= y < 22 else 0 for x in range(60)
                         for _ in range(3)] for y in range(30)])


def cabin():
    """A display that sees a wall, whose material is the model's, and the sky beside it."""
    scene = Scene()
    screen = scene.material("screen", extensions={"PARHELION_display": {
        "panel": "ips.panel", "content": {"index": scene.image("image/png", bars())}}})
    scene.quad(screen, [-0.15, -0.075, 0], [0.3, 0, 0], [0, 0.15, 0])
    scene.document["nodes"][0]["name"] = "screen"
    wall = scene.lambert(0.5, double_sided=True)
    scene.document["materials"][wall]["name"] = "wall"
    scene.quad(wall, [-2, -2, 1.5], [4, 0, 0], [0, 4, 0])
    scene.document["nodes"][1]["name"] = "wall"
    scene.view("eye", [0, 0.1, 0.8], [0, -0.1, -0.8], 8)
    return scene


def asked(**members):
    document = request(conditions=[moment("grey", type="constant", luminance=3000)],
                       precision={"contrast": 0.1, "clear": 0.1, "paths": 8192})
    document["symbols"]["bar"]["content"] = "bars.png"
    return {**document, **members}


def said(reviewer, out):
    """The few words as page and summaries have them, and all words of the page."""
    folder, lines = os.path.join(reviewer.folder, out), []
    for name in sorted(os.listdir(folder)):
        if name == "index.html" or name.startswith("summary-"):
            with open(os.path.join(folder, name), encoding="utf-8") as file:
                text = file.read()
            chips = re.findall(r'<p class="rests"><b>Rests on</b>(.*?)</p>', text)
            links = re.findall(r'<a href="(?:index.html)?#(\w+)">(.*?)</a>', "".join(chips))
            lines.append("; ".join(html.unescape(words) for _, words in links))
            whole = text if name == "index.html" else whole
            lines += [f"{name}: {at} leads nowhere" for at, _ in links
                      if f'<dt id="{at}">' not in whole]
    found = re.findall(r'<dt id="\w+">\w+</dt><dd>(.*?)</dd>', whole)
    return lines, "; ".join(html.unescape(words) for words in found)


def review(report, reviewer, document, out, *options):
    reviewer.write("r.json", document)
    done = reviewer.run("review", "r.json", "-o", out, *options)
    assert done.returncode in (0, 1), done.stderr
    lines, whole = said(reviewer, out)
    console = re.search(r"^rests on +(.*)$", done.stdout, re.M)
    with open(os.path.join(reviewer.folder, out, "review.json"), encoding="utf-8") as file:
        found = json.load(file)
    report.claim(len(lines) >= 2 and set(lines) == {console and console[1]} and
                 lines[0].count(";") <= 4, f"{out}: {lines}, {console}")
    report.claim(whole == found["rests_on_line"], f"{out}: {whole}")
    return found


def facts(found, kind):
    return [(fact["basis"], fact["name"], fact["count"], fact["of"])
            for fact in found["rests_on"] if fact["kind"] == kind]


def check_plain(report, reviewer):
    cabin().write(os.path.join(reviewer.folder, "dash.gltf"))
    found = review(report, reviewer, asked(), "plain")
    line = found["rests_on_line"]
    for words in ("panel of screen: synthetic", "materials as the model states them",
                  "eyes as given", "no occupant", "limits as quoted, 0 of"):
        report.claim(words in line, f"'{words}' is not in: {line}")
    report.claim(facts(found, "panel") == [("synthetic", "screen", 1, 1)] and
                 facts(found, "eye") == [("given", "eye", 1, 1)] and
                 facts(found, "occupant") == [("nobody", None, 1, 1)] and
                 facts(found, "limits")[0][2] == 0, f"{found['rests_on']}")
    report.claim(found["cases"][0]["guessed_share"] == 0, "a guess where there is none")
    report.claim(found["cases"][0]["panel"]["spectra_assumed"] is None and
                 "assumed" not in line, f"spectra that were given are assumed: {line}")
    report.claim(0 <= found["cases"][0]["extrapolated_share"] < 0.01 and
                 "extrapolated" not in line, f"extrapolated straight before a panel: {line}")


def check_init(report, reviewer):
    reviewer.run("review", "--init", "new.json", "dash.gltf")
    with open(os.path.join(reviewer.folder, "new.json"), encoding="utf-8") as file:
        eye = json.load(file)["eyes"]["eye"]
    report.claim("eye" in eye.get("proposed_from", ""), f"--init wrote {eye}")
    found = review(report, reviewer, asked(eyes={"eye": eye, "by hand": {
        "position_m": [0, 0.1, 0.8]}}), "proposed")
    report.claim("proposed eye (eye), the others as given" in found["rests_on_line"] and
                 facts(found, "eye") == [("proposed", "eye", 1, 1), ("given", "by hand", 1, 1)],
                 found["rests_on_line"])
    for wrong, words in ((3, "is a number"), ("", "is an empty text")):
        reviewer.write("r.json", asked(eyes={"eye": {"camera": "eye", "proposed_from": wrong}}))
        done = reviewer.run("review", "r.json", "--dry-run")
        report.claim(done.returncode == 3 and "/eyes/eye/proposed_from" in done.stderr and
                     words in done.stderr, f"proposed_from {wrong!r}: {done.stderr}")


def check_equipped(report, reviewer):
    """`equip` gives the wall its usual material, and an eye that its page proposed."""
    equip = {"equip": 1, "materials": [{"index": 1, "name": "wall", "as": "cloth, grey"}],
             "displays": [{"name": "new", "centre_m": [0, 0.2, 0], "right": [1, 0, 0],
                           "up": [0, 1, 0], "width_m": 0.3, "height_m": 0.1,
                           "panel": "ips_cluster", "content": "cluster"}],
             "eyes": [{"name": "driver", "position_m": [0, 0.3, 0.8], "looks_at": "new",
                       "proposed_from": "0.25 m before \"wall\""},
                      {"name": "typed", "position_m": [0, 0.4, 0.8], "looks_at": "new",
                       "proposed_from": "set by hand"}]}
    reviewer.write("e.json", equip)
    done = reviewer.run("equip", "dash.gltf", "--with", "e.json", "-o", "equipped.gltf")
    report.claim(done.returncode == 0, done.stderr)
    with open(os.path.join(reviewer.folder, "equipped.review.json"), encoding="utf-8") as file:
        eyes = json.load(file)["eyes"]
    report.claim(eyes["driver"].get("proposed_from") == "0.25 m before \"wall\"" and
                 "proposed_from" not in eyes["typed"], f"equip's eyes: {eyes}")
    document = asked(scene=["equipped.gltf"], eyes=eyes)
    found = review(report, reviewer, document, "equipped")
    case = found["cases"][0]
    # A single wall under an even sky: what is not straight from the sky has met it.
    off = sum(share["share"] for share in case["cause_groups"]["surface"]
              if share["what"] == "wall (wall)")
    report.claim(0.05 < off < 0.95 and close(case["guessed_share"], off, 0.02),
                 f"guessed {case['guessed_share']}, off the wall {off}")
    report.claim(("guessed", "wall", 1, 1) in facts(found, "material") and
                 "1 guessed material (up to " in found["rests_on_line"] and
                 "proposed eye (driver)" in found["rests_on_line"], found["rests_on_line"])


def check_people_and_limits(report, reviewer):
    shutil.copy(os.path.join(ROOT, "assets", "profiles", "iso-15008.json"),
                os.path.join(reviewer.folder, "house.json"))
    with open(os.path.join(reviewer.folder, "house.json"), encoding="utf-8") as file:
        house = json.load(file)
    for limit in house["limits"]:
        limit["read_in_the_standard"] = True
    reviewer.write("house.json", house)
    body = Scene()
    body.quad(body.lambert(0.5), [1, 1, 1], [0.1, 0, 0], [0, 0.1, 0])
    body.write(os.path.join(reviewer.folder, "body.gltf"))
    document = asked(profile="house.json", **{"with": {"a body": ["body.gltf"]}})
    document["conditions"] = [dict(moment("a", type="constant", luminance=3000),
                                   **{"with": "a body"}),
                              moment("b", type="constant", luminance=300)]
    found = review(report, reviewer, document, "people")
    line = found["rests_on_line"]
    report.claim("occupants: a body (none under 1 of 2 conditions)" in line and
                 "limits as read in the standard" in line, line)
    check_files(report, reviewer, found, ["r.json", "house.json", "dash.gltf", "ips.panel",
                                          "bars.png", "body.gltf"])


def check_files(report, reviewer, found, names):
    listed = {file["path"]: file["sha256"] for file in found["inputs"]}
    wanted = {name: hash_of(os.path.join(reviewer.folder, name)) for name in names}
    report.claim(listed == wanted, f"files {listed}, required: {wanted}")


def check_all_files(report, reviewer):
    """A mask, another condition's content, a light's file, a variant's panel and content."""
    for name, last in (("mask.png", 40), ("other.png", 39), ("third.png", 38)):
        with open(os.path.join(reviewer.folder, name), "wb") as file:
            file.write(bars(last))
    lights = Scene()
    lights.light("point", 100, [0, 1, 1])
    lights.write(os.path.join(reviewer.folder, "lamp.gltf"))
    document = asked(variants={"other": {"panels": {"screen": "oled.panel"},
                                         "contents": {"screen": "third.png"}}})
    document["symbols"]["bar"]["mask"] = "mask.png"
    document["conditions"].append(dict(
        moment("lamp", type="constant", luminance=3), lights=["lamp.gltf"],
        contents={"screen": "other.png"}))
    names = ["r.json", "dash.gltf", "ips.panel", "bars.png", "mask.png", "lamp.gltf",
             "other.png", "oled.panel", "third.png"]
    found = review(report, reviewer, document, "files")
    check_files(report, reviewer, found, names)
    page = open(os.path.join(reviewer.folder, "files", "index.html"), encoding="utf-8").read()
    for file in found["inputs"]:
        report.claim(f"SHA-256 {file['sha256']}" in page, f"{file} is not on the page")
    with open(os.path.join(reviewer.folder, "mask.png"), "ab") as file:
        file.write(b"\0")
    changed = review(report, reviewer, document, "changed")
    apart = [a["path"] for a, b in zip(found["inputs"], changed["inputs"]) if a != b]
    report.claim(apart == ["mask.png"], f"a byte behind the mask changes {apart}")


def check_measured(report, reviewer):
    """A set that an instrument measured, and one that does not say by what it was made."""
    run = lambda *line: subprocess.run([reviewer.program, "panel", *line, "--quiet"],
                                       cwd=reviewer.folder, capture_output=True, check=True)
    with open(RECIPE, encoding="utf-8") as file:
        recipe = json.load(file)
    recipe["reflection"]["wavelengths_nm"] = [450, 550, 650]
    reviewer.write("recipe.json", recipe)
    run("simulate", "recipe.json", "-o", "set", "--noise", "off", "--grid", "22x36")
    path = os.path.join(reviewer.folder, "set", "MANIFEST.json")
    for instrument, words in (("conoscope <4>, lab B", "measured (PX-9; conoscope <4>, lab B)"),
                              ("", "no measurement stated")):
        with open(path, encoding="utf-8") as file:
            manifest = json.load(file)
        manifest.update(panel="PX-9", instrument=instrument, note="")
        manifest.pop("reflection", None)  # what takes long to fit
        with open(path, "w", encoding="utf-8") as file:
            json.dump(manifest, file)
        run("fit", "set/MANIFEST.json", "-o", "ips.panel")
        found = review(report, reviewer, asked(), "measured")
        report.claim(f"panel of screen: {words}" in found["rests_on_line"],
                     f"{words}: {found['rests_on_line']}")


ASSUMED = "spectra of the primaries assumed: bands of a backlight 'wled-ksf'"


def check_assumed(report, reviewer):
    """Of a panel without spectra the review and its frames say what was assumed; of samples
    about the mirror direction alone, how much of the light was not measured."""
    for name, number, x, y in (("red", 110, 0.64, 0.33), ("green", 350, 0.3, 0.6),
                               ("blue", 40, 0.15, 0.06), ("black", 0.4, 0.3, 0.3)):
        with open(os.path.join(reviewer.folder, name + ".csv"), "w", encoding="utf-8") as file:
            file.write("theta,phi,X,Y,Z\n" + "".join(
                f"{t},{p},{number * x / y},{number},{number * (1 - x - y) / y}\n"
                for t in range(0, 71, 10) for p in range(0, 360 if t else 1, 45)))
    with open(os.path.join(reviewer.folder, "haze0.csv"), "w", encoding="utf-8") as file:
        file.write("theta,phi,550\n" + "".join(
            f"{t},{p},0.02\n" for t in range(0, 31, 5) for p in range(0, 360 if t else 1, 45)))
    emission = {color: {"255": color + ".csv"} for color in ("red", "green", "blue")}
    emission["black"] = "black.csv"
    reviewer.write("MANIFEST.json", {
        "panel": "PX-9", "instrument": "lab B", "backlight": "wled-ksf", "emission": emission,
        "reflection": {"wavelengths_nm": [550], "incidence_deg": [0],
                       "files": "haze{incidence}.csv"}})
    done = reviewer.run("panel", "fit", "MANIFEST.json", "-o", "ips.panel", "--force")
    assert done.returncode == 0, done.stderr
    found = review(report, reviewer, asked(frames={"size": [16, 12], "noise": 1}), "assumed")
    line, case = found["rests_on_line"], found["cases"][0]
    report.claim(ASSUMED in line and line.count("assumed") == 1 and
                 case["panel"]["spectra_assumed"].startswith(ASSUMED), f"no spectra: {line}")
    report.claim(0.1 < case["extrapolated_share"] <= 1 and
                 "of its reflected light extrapolated" in line,
                 f"extrapolated {case['extrapolated_share']}: {line}")
    frames = [os.path.join(reviewer.folder, "assumed", case["frame"][:-4] + ".exr")]
    frames.append(os.path.join(reviewer.folder, "frame.exr"))
    done = reviewer.run("render", "dash.gltf", "-o", frames[1], "--size", "16x12", "--spp", "4")
    assert done.returncode == 0, done.stderr
    for path in frames:
        said = Frame(path).attributes.get("parhelion:assumed", b"").decode()
        report.claim(said.startswith("screen: " + ASSUMED) and said.endswith("\n"),
                     f"{path} says of its panel: {said!r}")
    for line in (["compare", frames[1], frames[1]], ["measure", frames[1]]):
        done = reviewer.run(*line)
        report.claim(done.returncode == 0, f"{line[0]}: {done.stderr}")


def main(program):
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        reviewer = Reviewer(program, folder)
        shutil.copy(PANEL, os.path.join(folder, "ips.panel"))
        shutil.copy(OLED, os.path.join(folder, "oled.panel"))
        with open(os.path.join(folder, "bars.png"), "wb") as file:
            file.write(bars())
        for check in (check_plain, check_init, check_equipped, check_people_and_limits,
                      check_all_files, check_measured, check_assumed):
            check(report, reviewer)
    report.finish()


if __name__ == "__main__":
    main(*sys.argv[1:])
