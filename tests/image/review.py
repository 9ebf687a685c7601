# SPDX-License-Identifier: Apache-2.0
"""review.py [--all] PARHELION -- a glare review says what its scene is: its figures hang
together and are those of a frame, a sweep's suns and a weather file's hours are those of
moments, and nothing depends on the threads. --all: thirty of those hours, which take minutes,
three more of those suns, and eyes at one place.
"""
import csv
import datetime
import json
import math
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile

from exr import Frame
from gltf import Scene, png
import review_laws

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

PANEL = os.path.join(ROOT, "assets", "panels", "ips_cluster.panel")
EYE = [0.1, 0.15, 0.8]


def dashboard():
    """A display in a niche of white walls, open above and to the right, under a uniform sky."""
    scene = Scene()
    bars = png(60, 30, [[255 if 20 <= x < 40 and 8 <= y < 22 else 0 for x in range(60)
                         for _ in range(3)] for y in range(30)])
    screen = scene.material("screen", extensions={"PARHELION_display": {
        "panel": "ips.panel", "content": {"index": scene.image("image/png", bars)},
        "level": 1}})
    wall = scene.lambert(0.5)
    scene.quad(screen, [-0.15, -0.075, 0], [0.3, 0, 0], [0, 0.15, 0])
    scene.quad(wall, [-0.6, -0.3, 1.2], [1.2, 0, 0], [0, 0, -1.3])
    scene.quad(wall, [-0.6, -0.3, 1.2], [0, 0, -1.3], [0, 0.8, 0])
    direction = [-x for x in EYE]
    scene.view("eye", EYE, direction, 8)
    return scene


def request(**members):
    return {"title": "test", "scene": ["dash.gltf"], "eyes": {"eye": {"camera": "eye"}},
            "symbols": {"bar": {"display": "screen", "uv": [0.1, 0.1, 0.9, 0.9]}},
            "profile": "iso-15008", "precision": {"contrast": 0.004},
            "frames": {"size": [64, 36], "noise": 0.5, "worst": 0}, **members}


def moment(name, **environment):
    return {"name": name, "environment": environment}


class Reviewer:
    def __init__(self, program, folder):
        self.program, self.folder = os.path.abspath(program), folder

    def write(self, name, document):
        with open(os.path.join(self.folder, name), "w", encoding="utf-8") as file:
            json.dump(document, file)

    def run(self, *line):
        return subprocess.run([self.program, *line, "--quiet"], cwd=self.folder,
                              capture_output=True, text=True, check=False)

    def sun_lux(self, elevation):
        return json.loads(self.run("sky", "--environment", "sky:clear", "--sun",
                                   f"0,{elevation}", "--json").stdout)["direct_normal_lx"]

    def review(self, document, out, *options):
        """The status and what review.json says."""
        self.write("r.json", document)
        done = self.run("review", "r.json", "-o", out, *options)
        assert done.returncode in (0, 1), done.stderr
        with open(os.path.join(self.folder, out, "review.json"), encoding="utf-8") as file:
            found = json.load(file)
        folder = os.path.join(self.folder, out)
        for said in review_laws.broken_laws(found, folder, done):
            raise AssertionError(f"{out}: {said}")
        return done.returncode, found


def close(found, wanted, share):
    return abs(found - wanted) <= share * abs(wanted)


def check_figures(report, reviewer):
    document = request(conditions=[moment("grey", type="constant", luminance=3000)])
    status, review = reviewer.review(document, "grey", "--threads", "2")
    case = review["cases"][0]
    light = case["luminance_cd_m2"]
    bright = max(light["foreground"], light["background"]) + light["reflected"]
    dark = min(light["foreground"], light["background"]) + light["reflected"]
    report.claim(close(case["contrast_ratio"], bright / dark, 1e-4), "contrast of its parts")
    report.claim(close(light["mirror"] + light["scattered"], light["reflected"], 1e-4),
                 "mirror and scattered do not add up")
    report.claim(light["mirror"] > 0 and light["scattered"] > 0, "no mirror, or nothing else")
    low, high = case["contrast_interval"]
    report.claim(low < case["contrast_ratio"] < high, "contrast lies outside its interval")
    report.claim(case["visible_share"] == 1, f"visible {case['visible_share']}")
    report.claim(status == (0 if review["pass"] else 1), f"status {status}")
    shares = [cause["share"] for cause in case["causes"]]
    report.claim(close(sum(shares), 1, 1e-4), f"causes add up to {sum(shares)}")
    report.claim(shares[:-1] == sorted(shares[:-1], reverse=True), "causes by their share")
    return case, (high - low) / 4 / case["contrast_ratio"]


def check_frame(report, reviewer, case, sure):
    """The frame's mean over the same part."""
    reflected, part = case["luminance_cd_m2"]["reflected"], case["judged_part_uv"]
    reviewer.run("render", "dash.gltf", "--environment", "constant:3000", "--size", "64x36",
                 "--spp", "48", "--layers", "display,uv,id", "-o", "frame.exr")
    c = Frame(os.path.join(reviewer.folder, "frame.exr")).channels
    seen = [i for i, display in enumerate(c["id.display"]) if display >= 0 and
            c["display.coverage"][i] == 1 and part["left"] < c["uv.U"][i] < part["right"] and
            part["top"] < c["uv.V"][i] < part["bottom"]]
    def mean(name):
        return sum(0.2126 * c[name + ".R"][i] + 0.7152 * c[name + ".G"][i] +
                   0.0722 * c[name + ".B"][i] for i in seen) / len(seen)
    report.claim(len(seen) > 100, f"{len(seen)} pixels of the part")
    wanted = mean("display.reflected")
    report.claim(abs(reflected / wanted - 1) < 0.01 + 3 * sure,
                 f"reflected {reflected:.5g}, in the frame {wanted:.5g}")
    report.claim(close(mean("display.mirror") + mean("display.scattered"), wanted, 1e-5),
                 "the frame's mirror and scattered do not add up")


def check_pictures(report, reviewer):
    """Two symbols of one view: both cards show its pictures, the first screen its frame, whole
    and its display close up; they stand in the page once."""
    document = request(conditions=[moment("grey", type="constant", luminance=3000)], symbols={
        "bar": {"display": "screen", "uv": [0.1, 0.1, 0.9, 0.9]},
        "edge": {"display": "screen", "uv": [0.2, 0.1, 0.8, 0.9]}},
        frames={"size": [64, 36], "noise": 0.5, "worst": 2})
    _, review = reviewer.review(document, "pictures", "--self-contained")
    frames = {case["frame"] for case in review["cases"]}
    name = frames.pop()
    report.claim(not frames and name.endswith(".png"), "one view has two frames")
    for end in (".png", "-luminance.png", "-contrast.png", ".exr"):
        path = os.path.join(reviewer.folder, "pictures", name[:-4] + end)
        report.claim(os.path.isfile(path), f"no {path}")
    index = os.path.join(reviewer.folder, "pictures", "index.html")
    with open(index, encoding="utf-8") as file:
        page = file.read()
    cards = [page.count("<h3>" + title) for title in ("Frame<", "Luminance<", "Contrast map<")]
    found = [page.count(words) for words in ("<image id=", "<use href=")]
    report.claim(cards == [2, 2, 2] and found == [3, 5],
                 f"pictures on the page: {cards}, {found}")
    check_beside(report, reviewer, document, index)


def check_first_picture(report, reviewer):
    """A symbol that is too small from afar, in either light: the page tells the first, whose
    contrast has the larger margin, and that is the one that has a frame."""
    far = {"position_m": [x + 40 * (y - x) for x, y in zip([0, 0, 0], EYE)]}
    document = request(eyes={"far": far}, conditions=[
        moment("dim", type="constant", luminance=300),
        moment("bright", type="constant", luminance=3000)],
        frames={"size": [64, 36], "noise": 0.5, "worst": 1})
    _, review = reviewer.review(document, "first")
    dim, bright = review["cases"]
    report.claim(dim["verdict"] == bright["verdict"] == "fail" and
                 dim["margin"] > bright["margin"], "the cases are not as the test wants them")
    report.claim(dim.get("frame") and not bright.get("frame"), "another case has the frame")
    with open(os.path.join(reviewer.folder, "first", "index.html"), encoding="utf-8") as file:
        worst = file.read().split('<section class="worst"')[1].split("</section>")[0]
    report.claim(worst.count("<img") == 1 and worst.count('<svg class="rim"') == 1,
                 "the first screen has no picture, or no line around the symbol")


def check_beside(report, reviewer, document, alone):
    """The same with pictures beside the page: all that it names are there; and back again."""
    folder = os.path.join(reviewer.folder, "pictures")
    size = os.path.getsize(alone)
    reviewer.review(document, "pictures")
    with open(alone, encoding="utf-8") as file:
        page = file.read()
    named = re.findall(r' src="([^"#]+)"', page)
    lost = [name for name in named if not os.path.isfile(os.path.join(folder, name))]
    report.claim(len(named) == 1 + 2 * 3 and not lost,
                 f"beside the page: {named}, {lost}")
    report.claim("data:image/png" not in page and len(page) < size,
                 f"{len(page)} bytes beside {size}")
    reviewer.review(document, "pictures", "--self-contained")
    scripts = [name for name in os.listdir(os.path.join(folder, "frames"))
               if name.endswith(".js")]
    report.claim(not scripts, f"left behind: {scripts}")


def check_threads(report, reviewer, document):
    """The review that one thread makes is that of five; returns it."""
    gazes = [{"at": "symbols"}, {"name": "wall", "direction": [-1, 0, -0.3]}]
    texts = []
    for threads in (1, 5):
        out = f"threads{threads}"
        _, review = reviewer.review({**document, "gaze": gazes}, out, "--threads", str(threads))
        texts.append([open(os.path.join(reviewer.folder, out, name), "rb").read()
                      for name in ("review.json", "cases.csv", review["sweeps"][0]["table"])])
    report.claim(texts[0] == texts[1], "threads change the review")
    for gaze in review["gazes"]:
        report.claim(gaze["gaze"] == "wall" and 0 < gaze["contrast_left"] < 1, f"gaze {gaze}")
    report.claim(len(review["gazes"]) == len(review["cases"]), f"gazes {review['gazes']}")
    index = os.path.join(reviewer.folder, out, "index.html")
    with open(index, encoding="utf-8") as file:
        page = file.read()
    asked = set(re.findall(r'(?:src|href)="(?!#|data:)([^"]*)', page))
    beside = {name for name in os.listdir(os.path.join(reviewer.folder, out))}
    report.claim(asked <= beside,
                 f"the page asks for {asked - beside}, which does not stand beside it")
    return out, review


def check_diff(report, reviewer):
    document = request(conditions=[moment("grey", type="constant", luminance=3000)])
    _, review = reviewer.review(document, "again", "--diff", "grey")
    with open(os.path.join(reviewer.folder, "again", "diff.json"), encoding="utf-8") as file:
        diff = json.load(file)
    report.claim(diff["count"]["same"] == len(review["cases"]) == 1,
                 f"the same design differs: {diff['count']}")


def check_start(report, reviewer):
    done = reviewer.run("review", "--init", "start.json", "dash.gltf")
    report.claim(done.returncode == 0, done.stderr)
    done = reviewer.run("review", "start.json", "--dry-run")
    report.claim(done.returncode == 3 and "symbol 'screen': no text was found" in done.stderr,
                 f"bars were taken for text: {done.stderr}")
    with open(os.path.join(reviewer.folder, "start.json"), encoding="utf-8") as file:
        document = json.load(file)
    document["symbols"]["screen"] = {"display": "screen", "uv": [0.1, 0.1, 0.9, 0.9]}
    reviewer.write("edited.json", document)
    done = reviewer.run("review", "edited.json", "--dry-run", "--json")
    plan = json.loads(done.stdout)
    report.claim(plan["eyes"] == 1 and plan["symbols"] == 1 and plan["sweeps"] > 0, str(plan))
    done = reviewer.run("review", "--init", "start.json", "dash.gltf")
    report.claim(done.returncode == 4 and "start.json" in done.stderr, done.stderr)


def check_suns(report, reviewer, whole):
    """Suns of a sweep as moments of their own, whatever the threads: five of 24, or one of two.
    """
    azimuths, elevations, count = ((0, 330, 30), (30, 42, 12), 24) if whole else \
        ((0, 45, 45), (30, 30, 1), 2)
    suns = random.Random(5).sample(
        [(a, e) for a in range(azimuths[0], azimuths[1] + 1, azimuths[2])
         for e in range(elevations[0], elevations[1] + 1, elevations[2])], 5 if whole else 1)
    out, review = check_threads(report, reviewer, request(
        precision={"contrast": 0.01 if whole else 0.03}, conditions=[{"name": "suns", "sweep": {
            "sun": {"azimuth_deg": azimuths, "elevation_deg": elevations}, "sky": "sky"}}] + [
        moment(f"{a} {e}", type="sky", sun={"azimuth_deg": a, "elevation_deg": e,
                                            "illuminance_lx": reviewer.sun_lux(e)})
        for a, e in suns]))
    with open(os.path.join(reviewer.folder, out, review["sweeps"][0]["table"]),
              encoding="utf-8") as file:
        rows = {(round(float(r["sun_azimuth_deg"])), round(float(r["sun_elevation_deg"]))): r
                for r in csv.DictReader(file)}
    report.claim(len(rows) == count == review["sweeps"][0]["cases"], f"{len(rows)} suns")
    for sun, case in zip(suns, review["cases"]):
        found = float(rows[sun]["reflected_cd_m2"])
        wanted = case["luminance_cd_m2"]["reflected"]
        mean = case["symbol_mean"]["reflected"]  # as which a step counts all but the sun
        report.claim(0.94 * min(mean, wanted) <= found <= 1.06 * wanted,
                     f"sun {sun}: {found:.5g} in the sweep, {wanted:.5g} by itself, of all of "
                     f"it {mean:.5g}")
        told = case["sun"]["azimuth_deg"], case["sun"]["elevation_deg"]
        off = (told[0] - sun[0] + 180) % 360 - 180, told[1] - sun[1]
        report.claim(max(map(abs, off)) < 0.0005, f"sun {sun}: told as {told}")


def read_table(reviewer, out, review):
    with open(os.path.join(reviewer.folder, out, review["sweeps"][0]["table"]),
              encoding="utf-8") as file:
        return [(float(r["sun_azimuth_deg"]), float(r["sun_elevation_deg"]),
                 float(r["reflected_cd_m2"])) for r in csv.DictReader(file)]


def check_worst(report, reviewer):
    """What a sweep of four degrees calls its worst sun, beside all suns a tenth of a degree
    apart: the eye sees the sun's image in the middle of the display."""
    def sweep(name, azimuth, elevation):
        document = request(
            eyes={"low": {"position_m": [0.1, -0.2, 0.8]}}, precision={"contrast": 0.05},
            symbols={"bar": {"display": "screen", "uv": [0.3, 0.4, 0.4, 0.6]}},
            conditions=[{"name": "suns", "sweep": {
                "sun": {"azimuth_deg": azimuth, "elevation_deg": elevation}, "sky": "sky"}}])
        _, review = reviewer.review(document, name)
        return review["sweeps"][0]["worst"]["sun"], read_table(reviewer, name, review)
    sun, coarse = sweep("coarse", [162, 202, 4], [3, 27, 4])
    at = [sun["azimuth_deg"], sun["elevation_deg"]]
    _, fine = sweep("fine", [round(at[0] - 2, 2), round(at[0] + 2, 2), 0.1],
                    [round(at[1] - 2, 2), round(at[1] + 2, 2), 0.1])
    most = max(reflected for _, _, reflected in fine)
    found = min(fine, key=lambda row: math.hypot(row[0] - at[0], row[1] - at[1]))
    report.claim(max(row[2] for row in coarse) < 0.5 * most, "four degrees were enough")
    report.claim(close(found[2], most, 0.01),
                 f"worst at {at}: {found[2]:.5g} cd/m2, nearby {most:.5g}")
    near = min(math.hypot(a - at[0], e - at[1]) for a, e, reflected in fine
               if reflected > 0.999 * most)
    report.claim(near <= 0.1 + 0.08, f"the worst lies {near:.2f} degrees away")


EPW = "".join(f"{line}\n" for line in (
    "LOCATION,Testville,-,NLD,Data,0,48.14,11.58,1.0,520", "DESIGN CONDITIONS,0",
    "TYPICAL/EXTREME PERIODS,0", "GROUND TEMPERATURES,0", "HOLIDAYS/DAYLIGHT SAVINGS,No,0,0,0",
    "COMMENTS 1,none", "COMMENTS 2,none", "DATA PERIODS,1,1,Data,Sunday, 1/ 1,12/31"))


def check_twins(report, reviewer):
    """Eyes at one place share what a sweep asks: the same tables as either has by itself."""
    x, y, z = EYE
    both = {"point": {"position_m": EYE},
            "box": {"centre_m": EYE, "half_size_m": [0.02, 0, 0], "grid": [3, 1, 1]},
            "ellipse": {"centre_m": EYE, "ellipse_m": [0.1, 0.04, 0.06], "tilt_deg": 5},
            "beside": {"position_m": [x + 0.05, y, z]}}
    sweep = {"name": "suns", "sweep": {"sun": {"azimuth_deg": [0, 90, 30],
                                               "elevation_deg": [30, 60, 30]}, "sky": "sky"}}
    tables = {}
    for name, eyes in (("all", both), ("alone", {"box": both["box"]})):
        document = request(eyes=eyes, conditions=[sweep], precision={"contrast": 0.05})
        _, found = reviewer.review(document, f"twins-{name}")
        tables[name] = {s["eye"]: (s["failed_share"], read_table(reviewer, f"twins-{name}",
                                                                 {"sweeps": [s]}))
                        for s in found["sweeps"]}
        names = {r["probe"] for r in found["responses"]}
        report.claim(len(names) == (3 if name == "all" else 2), f"asked: {sorted(names)}")
        places = {p["eye"]: p["read_share"] for p in found["eye_places"]}
        report.claim(set(places) == set(eyes) & {"box", "ellipse"} and
                     all(0 <= share <= 1 for share in places.values()), f"places: {places}")
    report.claim(list(tables["all"]) == list(both), f"order: {list(tables['all'])}")
    for eye in ("box", "ellipse"):
        report.claim(tables["all"][eye] == tables["all"]["point"], f"{eye}: other than its eye")
    report.claim(tables["all"]["box"] == tables["alone"]["box"], "shared is other than alone")
    report.claim(tables["all"]["beside"] != tables["all"]["point"], "all eyes are one")


def weather_row(month, day, label, direct, diffuse, _):
    return (f"2011,{month},{day},{label},60,x,20,12,79,100100,0,1415,288,9999,{direct},{diffuse},"
            "0,0,0,0\n")


def weather_hours():
    """Hours of a year: (the row's instant, W/m2 direct and diffuse). The sun shines about noon."""
    draw = random.Random(9)
    instant = datetime.datetime(2026, 1, 1, 0, 30)
    while instant.year == 2026:
        cloud = draw.random()
        direct = round(max(0, 900 * (1 - 1.5 * cloud))) if 9 < instant.hour < 15 else 0
        yield instant, direct, round(60 + 250 * cloud)
        instant += datetime.timedelta(hours=1)


def check_weather(report, reviewer, count):
    """Hours of a year by a weather file, and some, the worst among them, each as a moment of its
    own, traced in full: within three standard errors (of paths and response) or 2 % of what a
    moment's worst part reflects, or between that and the symbol's mean, as which a step counts
    all but the sun. Each instant lies half an hour before its label."""
    hours = {instant: light for instant, *light in weather_hours()}
    with open(os.path.join(reviewer.folder, "w.epw"), "w", encoding="utf-8") as file:
        file.write(EPW + "".join(
            weather_row(at.month, at.day, at.hour + 1, *light, 0) for at, light in hours.items()))
    sweep = {"year": 2026, "weather": "w.epw", "headings_deg": [0, 50, 130, 200, 290]}
    _, review = reviewer.review(request(conditions=[{"name": "year", "sweep": sweep}]), "year")
    with open(os.path.join(reviewer.folder, "year", review["sweeps"][0]["table"]),
              encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    report.claim(len(rows) == review["sweeps"][0]["cases"] > 5 * 4000, f"{len(rows)} steps")
    worst = min(rows, key=lambda row: float(row["contrast_ratio"]))
    asked = [worst] + random.Random(3).sample(rows, count)
    at = [datetime.datetime(2026, 1, 1) + datetime.timedelta(
        days=int(row["day_of_year"]) - 1, hours=float(row["hour_utc"])) for row in asked]
    lit = [hours[instant + datetime.timedelta(hours=1)] for instant in at]  # of the file's zone
    _, found = reviewer.review(request(precision={"contrast": 0.01}, conditions=[
        {**moment(str(number), type="perez", direct_normal_w_m2=light[0],
                  diffuse_horizontal_w_m2=light[1], when=f"{instant.isoformat()}Z",
                  where=[48.14, 11.58, 520]), "heading_deg": float(row["heading_deg"])}
        for number, (row, instant, light) in enumerate(zip(asked, at, lit))]), "weather")
    for row, case, instant in zip(asked, found["cases"], at):
        reflected, wanted = float(row["reflected_cd_m2"]), case["luminance_cd_m2"]["reflected"]
        low, high = case["contrast_interval"]
        sigma = math.hypot((high - low) / 4 / case["contrast_ratio"],
                           review["responses"][0]["relative_error"])
        mean, share = case["symbol_mean"]["reflected"], max(0.02, 3 * sigma)
        report.claim((1 - share) * min(mean, wanted) <= reflected <= (1 + share) * wanted,
                     f"{instant}: {reflected:.5g} in the sweep, {wanted:.5g} by itself "
                     f"({reflected / wanted - 1:+.4f}, sigma {sigma:.4f})")
    told = review["sweeps"][0]["worst"]
    report.claim(close(told["contrast_ratio"], found["cases"][0]["contrast_ratio"], 0.03) and
                 f"{at[0]:%Y-%m-%d %H:%M} UTC" in told["when"] and
                 f"{lit[0][0]} W/m2 direct, {lit[0][1]} diffuse" in told["when"],
                 f"worst {told['when']}, the table's {at[0]}")


def check_refusals(report, reviewer):
    for document, words in (
            (request(conditions=[moment("x", type="constant", luminance=1)],
                     symbols={"bar": {"display": "scren", "uv": [0, 0, 1, 1]}}), "scren"),
            (request(conditions=[moment("x", type="constant", luminance=1)],
                     profile="iso-1500"), "iso-1500"),
            (request(conditions=[moment("x", type="constant", luminance=1)],
                     symbols={"bar": {"display": "screen", "uv": [0.1, 0.1, 1.4, 1]}}), "1.4"),
            (request(conditions=[moment("x", type="constant", luminance=1)],
                     symbols={"bar": {"display": "screen", "uv": [0, 0, 0.2, 0.2]}}), "bar")):
        reviewer.write("r.json", document)
        done = reviewer.run("review", "r.json", "-o", "refused")
        lines = done.stderr.strip().splitlines()
        report.claim(done.returncode == 3 and words in done.stderr and len(lines) == 1,
                     f"status {done.returncode}: {done.stderr}")


def main(program, whole):
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        reviewer = Reviewer(program, folder)
        shutil.copy(PANEL, os.path.join(folder, "ips.panel"))
        dashboard().write(os.path.join(folder, "dash.gltf"))
        check_frame(report, reviewer, *check_figures(report, reviewer))
        check_pictures(report, reviewer)
        check_first_picture(report, reviewer)
        check_diff(report, reviewer)
        check_start(report, reviewer)
        check_suns(report, reviewer, whole)
        if whole:
            check_twins(report, reviewer)
            check_weather(report, reviewer, 30)
            check_worst(report, reviewer)
        check_refusals(report, reviewer)
    return report.finish()


if __name__ == "__main__":
    sys.exit(main(sys.argv[-1], "--all" in sys.argv))
