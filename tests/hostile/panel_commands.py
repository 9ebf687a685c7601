# SPDX-License-Identifier: Apache-2.0
"""panel_commands.py [--all] [--against OTHER] PARHELION -- the panel commands as scripts use them:
grids, tables written back, synthetic sets, errors of one line. --against: a panel that one
build wrote says the same, to the last printed figure, when the other build reads it.
"""
import argparse
import csv
import html
import html.parser
import json
import math
import os
import pty
import re
import struct
import subprocess
import sys
import tempfile
from xml.etree import ElementTree

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

RECIPE = os.path.join(ROOT, "assets", "panels", "ips_cluster.recipe.json")
PANELS = ("ips_cluster", "zoned_centre", "oled_centre", "hud_pgu", "hud_pgu_p")
GRID = "0:80:20,0:270:90"
ASKED = (["--rgb", "255,127,31", "--grid", "0:90:3,0:350:10"],
         ["--rgb", "1,0,200", "--grid", "0:88:4,5:355:50"],
         ["--brdf", "--incidence", "30", "--grid", "0:90:3,0:350:10"],
         ["--brdf", "--incidence", "75", "--incidence-phi", "40", "--grid", "0:88:8,0:350:25"])



def squeezed(text):
    """One blank between words, whatever the columns' widths are."""
    return " ".join(text.split())


class Commands:
    def __init__(self, path, folder):
        self.path, self.folder = os.path.abspath(path), folder

    def file(self, *names):
        return os.path.join(self.folder, *names)

    def run(self, *arguments):
        return subprocess.run([self.path, "panel", *arguments], capture_output=True, text=True,
                              timeout=600)

    def on_terminal(self, *arguments):
        """What stands on stderr where that is a terminal."""
        mine, theirs = pty.openpty()
        subprocess.run([self.path, "panel", *arguments], stdout=subprocess.DEVNULL,
                       stderr=theirs, timeout=600, check=False,
                       env={**os.environ, "TERM": "xterm"})
        os.close(theirs)
        shown = os.read(mine, 1 << 16).decode()
        os.close(mine)
        return shown

    def text(self, *arguments):
        done = self.run(*arguments)
        if done.returncode != 0:
            raise ValueError(f"{arguments[0]}: status {done.returncode}: {done.stderr.strip()}")
        return done.stdout

    def make(self, name):
        """A set of 22 x 36 directions of a recipe with few wavelengths, and its panel."""
        with open(RECIPE) as file:
            recipe = json.load(file)
        recipe["reflection"]["wavelengths_nm"] = [450, 550, 650]
        with open(self.file("recipe.json"), "w") as out:
            json.dump(recipe, out)
        self.text("simulate", self.file("recipe.json"), "-o", self.file("set"), "--noise",
                  "off", "--grid", "22x36", "--quiet")
        self.text("fit", self.file("set", "MANIFEST.json"), "-o", self.file(name), "--quiet")
        return self.file(name)


def rows_of(text):
    return list(csv.reader(line for line in text.splitlines() if not line.startswith("#")))


def fails(report, done, status, *words):
    lines = done.stderr.splitlines()
    report.claim(done.returncode == status and len(lines) == 1 and not done.stdout
                 and lines[0].startswith("parhelion: ") and all(w in lines[0] for w in words),
                 f"status {done.returncode} instead of {status}, or not one line with {words}: "
                 f"{done.stderr.strip()[:300]}")


def check_simulation(report, commands):
    with open(commands.file("set", "emission", "red_255.csv")) as file:
        rows = rows_of(file.read())
    report.claim(len(rows) == 2 + 22 * 36 and float(rows[-1][0]) == 88,
                 f"--grid 22x36 has {len(rows)} lines, the last of {rows[-1]}")
    fails(report, commands.run("simulate", RECIPE, "-o", commands.file("x"), "--grid",
                               "60000x36"), 2, "--grid")


def check_grids(report, commands, panel):
    ask = ["eval", panel, "--rgb", "255,127,31"]
    rows = rows_of(commands.text(*ask, "--grid", GRID))
    report.claim(rows[0] == ["theta", "phi", "X", "Y", "Z"] and len(rows) == 21,
                 f"a list of {GRID} is {rows[:2]}, {len(rows)} lines")
    one = json.loads(commands.text(*ask, "--theta", "40", "--phi", "90", "--json"))
    found = [row for row in rows[1:] if row[:2] == ["40", "90"]][0][2:]
    report.claim(all(abs(float(a) - b) <= 1e-6 * abs(b) for a, b in zip(found, one["XYZ"])),
                 f"the list says {found}, one direction {one['XYZ']}")
    matrix = rows_of(commands.text(*ask, "--grid", GRID, "--layout", "matrix"))
    report.claim(matrix[0][1:] == ["0", "90", "180", "270"] and len(matrix) == 6
                 and matrix[3][2] == found[1], f"the matrix of Y says {matrix}")
    colour = rows_of(commands.text(*ask, "--grid", GRID, "--layout", "matrix", "--quantity",
                                   "u"))
    report.claim(abs(float(colour[3][2]) - one["uv"][0]) < 1e-6, f"u' is {colour[3][2]}")
    document = json.loads(commands.text(*ask, "--grid", "0:90:30,0:270:90", "--json"))
    report.claim(document["theta_deg"] == [0, 30, 60, 90] and len(document["Y"]) == 4
                 and len(document["Y"][0]) == 4
                 and document["extrapolated"] == [False, False, False, True],
                 f"a grid as JSON says {str(document)[:300]}")
    ask = ["eval", panel, "--brdf", "--incidence", "30"]
    rows = rows_of(commands.text(*ask, "--grid", GRID))
    report.claim(rows[0] == ["theta", "phi", "450", "550", "650"] and len(rows) == 21,
                 f"a list of reflection is {rows[:2]}")
    matrix = rows_of(commands.text(*ask, "--grid", GRID, "--layout", "matrix", "--wavelength",
                                   "550"))
    report.claim(matrix[3][2] == rows[10][3], f"a matrix of reflection says {matrix[3]}")
    document = json.loads(commands.text(*ask, "--grid", GRID, "--json"))
    report.claim(document["wavelengths_nm"] == [450, 550, 650] and len(document["brdf_sr"]) == 3
                 and len(document["mirror"]) == 3, "a grid of reflection as JSON")
    for wrong in ("0:80:20", "0:95:5,0:9:1", "0:80:0,0:9:1", "a:b:c,0:1:1", "0:80:20,0:9:1x"):
        fails(report, commands.run("eval", panel, "--rgb", "1,2,3", "--grid", wrong), 2,
              "--grid", wrong)
    fails(report, commands.run(*ask, "--grid", GRID, "--layout", "matrix"), 2, "--wavelength")
    fails(report, commands.run(*ask, "--grid", GRID, "--batch", "x.csv"), 2, "--batch")


def check_batch(report, commands, panel):
    path = commands.file("batch.csv")
    with open(path, "w") as out:
        out.write("theta,phi,r,g,b\n40,90,255,127,31\n0,0,0,0,0\n")
    rows = rows_of(commands.text("eval", panel, "--batch", path, "--csv"))
    documents = json.loads(commands.text("eval", panel, "--batch", path, "--json"))
    report.claim(len(rows) == 3 and len(documents) == 2 and all(
        abs(float(row[6]) - document["XYZ"][1]) < 1e-6 * document["XYZ"][1]
        for row, document in zip(rows[1:], documents)), f"a batch says {rows}")
    with open(path, "w") as out:
        out.write("theta,phi,q\n40,90,255\n")
    fails(report, commands.run("eval", panel, "--batch", path), 3, "batch.csv", "'q'")
    with open(path, "w") as out:
        out.write("theta,phi\n40,90\n140,90\n")
    fails(report, commands.run("eval", panel, "--batch", path), 3, "batch.csv", "line 3", "140")
    check_kinds(report, commands, panel)


def check_kinds(report, commands, panel):
    """Incidences ask for reflection; one layout for one answer and for many."""
    path = commands.file("kinds.csv")

    def batch(header, *options):
        with open(path, "w") as out:
            out.write(header + "\n40,90,20\n")
        return ["eval", panel, "--batch", path, *options]
    for column in ("incidence", "incidence_phi", "wavelength"):
        fails(report, commands.run(*batch("theta,phi," + column)), 3, "kinds.csv", column,
              "--brdf")
    fails(report, commands.run(*batch("theta,phi,g", "--brdf")), 3, "'g'", "emission")
    fails(report, commands.run(*batch("theta,phi,u", "--brdf")), 3, "'incidence'")
    fails(report, commands.run("eval", panel, "--theta", "0", "--rgb", "1,2,3", "--incidence",
                               "20"), 2, "--incidence", "--brdf")
    one = ["eval", panel, "--brdf", "--theta", "40", "--phi", "90", "--incidence", "20"]
    many = rows_of(commands.text(*batch("theta,phi,incidence", "--brdf", "--csv")))
    some = rows_of(commands.text(*one, "--wavelength", "550", "--csv"))
    report.claim(many == rows_of(commands.text(*one, "--csv")) and some[0] == many[0] and
                 some[1] in many and [row[4] for row in many[1:]] == ["450", "550", "650"],
                 f"a row a wavelength: {many}, {some}")


def check_levels(report, commands, panel):
    """--level: the finest is the panel, every answer says which level it is of, and what is
    asked wrongly is one line."""
    levels = json.loads(commands.text("info", panel, "--levels", "--json"))
    finest = len(levels) - 1
    report.claim(all(row["level"] == i for i, row in enumerate(levels))
                 and all(levels[finest][part]["max_error"] == 0
                         and levels[0][part]["rms_error"] > levels[finest][part]["rms_error"]
                         for part in ("emission", "reflection")), f"levels {levels}")
    emission = ("--rgb", "255,127,31")
    for ask, part in ((emission, "emission"), (("--brdf", "--incidence", "30"), "reflection")):
        whole = json.loads(commands.text("eval", panel, *ask, "--grid", GRID, "--json"))
        for level in (0, 3, finest):
            read = json.loads(commands.text("eval", panel, *ask, "--grid", GRID, "--json",
                                            "--quiet", "--level", str(level)))
            told = read.pop("level")
            report.claim(told == {"level": level, part: levels[level][part]},
                         f"level {level} says {told}")
            report.claim((read == whole) == (levels[level][part]["max_error"] == 0),
                         f"level {level} of {part} beside the whole panel")
    path = commands.file("levels.csv")
    write_rows(path, "theta,phi", ((40, 90), (0, 0)))
    answers = json.loads(commands.text("eval", panel, "--batch", path, "--json", "--level",
                                       "1"))
    report.claim([a["level"]["emission"] for a in answers] == 2 * [levels[1]["emission"]],
                 f"a batch says {answers}")
    picture = commands.file("level.svg")
    text = commands.text("plot", panel, "--kind", "luminance", "-o", picture, "--level", "3")
    done = json.loads(commands.text("plot", panel, "--kind", "luminance", "-o", picture,
                                    "--level", "3", "--json"))
    report.claim(done["level"] == levels[3] and "level 3 of " in text, f"a plot says {done}")
    for wrong, words in (("-1", (f"required: 0 to {finest}",)), ("1.5", ("a whole number",)),
                         (str(finest + 1), (f"required: 0 to {finest}",)), ("x", ("whole",))):
        fails(report, commands.run("eval", panel, *emission, "--theta", "0", "--level", wrong),
              2, "--level", wrong, *words)
    dark = commands.file("dark.panel")
    commands.text("fit", lambertian_set(commands, "dark", 0.2), "-o", dark, "--quiet")
    fails(report, commands.run("eval", dark, *emission, "--theta", "0", "--level", "0"), 2,
          "dark.panel", "--level is 0", "required: none", "no emission")


def check_traits(report, commands, panel):
    """What a manifest says of polarisation is shown."""
    with open(commands.file("set", "MANIFEST.json")) as file:
        manifest = json.load(file)
    del manifest["reflection"]
    wanted = {"polarisation": {"degree": 0.98, "azimuth_deg": 135}}
    manifest.update(wanted)
    path, panel = commands.file("set", "TRAITS.json"), panel + ".traits"
    write_json(path, manifest)
    commands.text("fit", path, "-o", panel, "--quiet")
    facts = json.loads(commands.text("info", panel, "--json"))["display"]
    report.claim(facts.get("polarisation") == wanted["polarisation"], f"info says {facts}")
    line = "polarised 98.0 % polarised along 135 degrees"
    report.claim(line in squeezed(commands.text("info", panel)), f"info does not say: {line}")
    write_json(path, {**manifest, "polarisation": {"degree": 2, "azimuth_deg": 0}})
    fails(report, commands.run("fit", path, "-o", panel, "--quiet"), 3, "TRAITS.json",
          "/polarisation/degree", "0 to 1")


def write_json(path, document):
    with open(path, "w") as out:
        json.dump(document, out)
    return path


def check_places(report, commands, panel):
    """A simulated display that is not even: fitted, asked by place, shown, drawn; and what
    a damaged one says."""
    with open(RECIPE) as file:
        recipe = json.load(file)
    recipe["emission"]["levels"] = [255]
    del recipe["reflection"]
    recipe["places"] = {"u": [0.1, 0.9, 0.1, 0.9], "v": [0.1, 0.1, 0.9, 0.9],
                        "map": [64, 32], "mura": 0.05, "mura_cycles": [2, 1],
                        "slope": [0.3, -0.2], "clouding": 0.5}
    source = write_json(commands.file("places.json"), recipe)
    folder, path = commands.file("places"), panel + ".places"
    commands.text("simulate", source, "-o", folder, "--noise", "off", "--grid", "12x24",
                  "--quiet")
    commands.text("fit", os.path.join(folder, "MANIFEST.json"), "-o", path, "--quiet")
    for at in ("0.31,0.79", "0.5,0.5", "0.02,0.95"):
        ask = ("--at", at, "--json")
        found = json.loads(commands.text("eval", path, "--theta", "30", "--phi", "50", "--rgb",
                                         "255,255,255", *ask))
        truth = json.loads(commands.text("simulate", source, "--truth", "30,50,255,255,255",
                                         *ask))
        report.claim(found["position"] == [float(x) for x in at.split(",")] and all(
            abs(a / b - 1) < 0.006 for a, b in zip(found["XYZ"], truth["XYZ"])),
            f"at {at}: {found['XYZ']}, truth {truth['XYZ']}")
    info = json.loads(commands.text("info", path, "--json"))
    places = info["display"]["places"]
    report.claim([[round(x, 6) for x in spot] for spot in places["spots"]] ==
                 [[0.1, 0.1], [0.9, 0.1], [0.1, 0.9], [0.9, 0.9]]
                 and places["map"] == [64, 32] and len(info["spots"]) == 3
                 and len(places["white"]["nine_cd_m2"]) == 9
                 and 0.1 < places["white"]["nine_non_uniformity"] < 0.5,
                 f"info says {places}")
    report.claim("non-uniformity" in commands.text("info", path), "info as text has no figures")
    for name in ("u.svg", "u.png"):
        drawn = json.loads(commands.text("plot", path, "--kind", "uniformity", "-o",
                                         commands.file(name), "--json"))
        report.claim(drawn["picture"]["figures"] == 2, f"{name} has {drawn}")
    fails(report, commands.run("eval", path, "--theta", "0", "--rgb", "1,1,1", "--at", "0,2"),
          2, "--at")
    with open(commands.file("batch.csv"), "w") as out:
        out.write("theta,phi,r,g,b,u,v\n0,0,1,1,1,-0.5,-0.5\n")
    fails(report, commands.run("eval", path, "--batch", commands.file("batch.csv")), 3,
          "batch.csv", "u is -0.5")
    fails(report, commands.run("simulate", source, "-o", commands.file("at"), "--at", "0,0"),
          2, "--at", "--truth")
    manifest = os.path.join(folder, "MANIFEST.json")
    with open(manifest) as file:
        good = json.load(file)
    for key, value, words in ((("spots", 1, "position"), [0.1, 0.1], ("/spots/1", "spot 0")),
                              (("spots", 1, "position"), [0, 1.1], ("/position", "1.1")),
                              (("spots", 2, "emission"), None, ("/spots/2", "emission")),
                              (("uniformity", "file"), "gone.exr", ("gone.exr",)),
                              (("uniformity", "black"), "uniformity.csv", ("black",))):
        document = json.loads(json.dumps(good))
        inner = document
        for name in key[:-1]:
            inner = inner[name]
        inner[key[-1]] = value
        if value is None:
            del inner[key[-1]]
        write_json(manifest, document)
        fails(report, commands.run("fit", manifest, "-o", commands.file("no.panel"), "--quiet"),
              3, *words)
    report.claim(not os.path.exists(commands.file("no.panel")), "a refused set left a panel")
    write_json(manifest, good)
    before = open(manifest, "rb").read()
    fails(report, commands.run("fit", manifest, "-o", manifest, "--quiet"), 4, manifest,
          "is read, and -o would write over it")
    report.claim(open(manifest, "rb").read() == before, "a set's manifest was written over")



def lambertian_set(commands, name, reflectance):
    """A reflection alone, the same at every angle."""
    folder = commands.file(name)
    os.mkdir(folder)
    with open(os.path.join(folder, "i20.csv"), "w") as out:
        out.write("theta,phi,brdf\n0,0,%.6g\n" % (reflectance / math.pi))
        out.writelines(f"{theta},{phi},{reflectance / math.pi:.6g}\n"
                       for theta in range(10, 81, 10) for phi in range(0, 181, 30))
    manifest = os.path.join(folder, "MANIFEST.json")
    with open(manifest, "w") as out:
        json.dump({"panel": name, "reflection": {"wavelengths_nm": [550],
                   "incidence_deg": [20], "files": "i{incidence}.csv"}}, out)
    return manifest


def check_verdict(report, commands, panel):
    """A good set is called good; one whose unit is wrong is not written, unless forced, and
    says so wherever it is shown."""
    found = json.loads(commands.text("info", panel, "--json"))
    report.claim(found["verdict"] == "good" and found["reasons"] == [] and found["judged"],
                 f"a simulated panel is {found['verdict']}: {found['reasons']}")
    path = commands.file("unit.panel")
    good = lambertian_set(commands, "grey", 0.5)
    report.claim(json.loads(commands.text("fit", good, "-o", path, "--quiet", "--json"))
                 ["verdict"] == "good", "a grey lambertian panel is not good")
    os.remove(path)
    wrong = lambertian_set(commands, "unit", 50)
    fails(report, commands.run("fit", wrong, "-o", path, "--quiet"), 1, "unit.panel",
          "albedo", "--unit", "--force")
    done = commands.run("fit", wrong, "-o", path, "--quiet", "--json")
    document = json.loads(done.stdout)
    report.claim(done.returncode == 1 and document["verdict"] == "not usable"
                 and len(done.stderr.splitlines()) == 1 and not os.path.exists(path),
                 f"--json of what is refused: {done.returncode}, {done.stderr}")
    shown = commands.on_terminal("fit", wrong, "-o", path, "--progress", "bar")
    report.claim("#" in shown and "\rparhelion: " in shown, f"a terminal shows {shown!r}")
    text = commands.text("fit", wrong, "-o", path, "--quiet", "--force")
    report.claim("verdict not usable" in squeezed(text), f"--force prints {text[:300]}")
    kept = json.loads(commands.text("info", path, "--json"))
    report.claim(kept["verdict"] == "not usable" and kept["reasons"] == document["reasons"]
                 and "verdict not usable" in squeezed(commands.text("info", path)),
                 f"the file keeps {kept['verdict']}")
    page = commands.file("unit.html")
    commands.text("report", path, "-o", page, "--quiet")
    with open(page) as file:
        text = html.unescape(file.read())
    report.claim("not usable" in text and all(reason in text for reason in kept["reasons"]),
                 "the report hides the verdict")


NAME, WHITE, BLACK, ALBEDO = "<b> Lambert & co", 400.0, 0.8, 0.06
INCIDENCES = [10, 20, 30, 40, 50, 60, 70, 80, 88]  # beyond the last it is extrapolated


def write_rows(path, header, rows):
    with open(path, "w") as file:
        file.write(header + "\n" + "".join(",".join(f"{x:.9g}" for x in row) + "\n"
                                           for row in rows))


def make_lambertian(commands, name):
    """White of WHITE cd/m2 and black of BLACK at every angle over a Lambertian surface."""
    folder = commands.file(name)
    os.makedirs(folder)
    angles = [(t, p) for t in range(0, 81, 4) for p in range(0, 360 if t else 1, 15)]
    write_rows(os.path.join(folder, "white.csv"), "theta,phi,X,Y,Z",
               [(t, p, *(WHITE * x for x in (0.95, 1, 1.089))) for t, p in angles])
    write_rows(os.path.join(folder, "levels.csv"), "level,luminance",
               [(0, BLACK), (0.5, BLACK + (WHITE - BLACK) * 0.5 ** 2.2), (1, WHITE)])
    for incidence in INCIDENCES:
        write_rows(os.path.join(folder, f"i{incidence}.csv"), "theta,phi,brdf",
                   [(t, p, ALBEDO / math.pi) for t, p in angles])
    with open(os.path.join(folder, "M.json"), "w") as out:
        json.dump({"panel": NAME, "emission": {"white": "white.csv", "levels": "levels.csv"},
                   "reflection": {"wavelengths_nm": [555], "incidence_deg": INCIDENCES,
                                  "files": "i{incidence}.csv"}}, out)
    panel = commands.file(name + ".panel")
    commands.text("fit", os.path.join(folder, "M.json"), "-o", panel, "--quiet")
    return panel


class Nesting(html.parser.HTMLParser):
    """Whether tags close in their order."""
    EMPTY = ("meta", "img", "br", "link")

    def __init__(self):
        super().__init__()
        self.open, self.count, self.wrong = [], 0, []

    def handle_starttag(self, tag, attrs):
        self.count += 1
        if tag not in self.EMPTY:
            self.open.append(tag)
        for key, value in attrs:
            if key in ("src", "href") and not value.startswith("data:image/svg+xml;base64,"):
                self.wrong.append(f"{tag} {key}={value}")

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.wrong.append(tag)


def check_page(report, page):
    """It stands alone, and names are no markup."""
    with open(page, encoding="utf-8") as file:
        text = file.read()
    nesting = Nesting()
    nesting.feed(text)
    report.claim(nesting.count > 500 and not nesting.open and not nesting.wrong
                 and "@import" not in text, f"{nesting.count} tags, {nesting.wrong[:3]}")
    report.claim(html.escape(NAME) in text and NAME not in text, "the name is not escaped")
    report.claim("nearly constant" in text, "a constant map does not say so")


KINDS = ("all", "luminance", "contrast", "colour-shift", "sections", "chromaticity", "grey-levels",
         "brdf", "reflectance", "fit")


def check_pictures(report, commands, panel):
    """Every kind is a whole SVG, a PNG twice as large; what cannot be drawn is one line, and
    leaves nothing."""
    measured = ("--measured", commands.file("set", "MANIFEST.json"))
    svg, png = commands.file("p.svg"), commands.file("p.png")
    for kind in KINDS:
        commands.text("plot", panel, "-o", svg, "--kind", kind, *measured)
        root = ElementTree.parse(svg).getroot()
        report.claim(root.tag.endswith("svg") and len(list(root.iter())) > 50, f"{kind}: {root}")
    commands.text("plot", panel, "-o", png, "--kind", KINDS[-1], *measured)
    with open(png, "rb") as file:
        size = struct.unpack(">8x8xII", file.read(24))
    report.claim([f"{side / 2:g}px" for side in size] == [root.get("width"), root.get("height")],
                 f"a PNG of {size} beside {root.attrib}")
    os.remove(svg)
    white, grey = commands.file("white.csv"), commands.file("paper.panel")
    write_rows(white, "theta,phi,X,Y,Z", ((t, 0, 95, 100 - t, 108) for t in range(0, 61, 20)))
    commands.text("fit", white, "-o", white + ".panel", "--quiet")
    paper = lambertian_set(commands, "paper", 0.5)
    commands.text("fit", paper, "-o", grey, "--quiet")
    commands.text("plot", grey, "-o", png, "--measured", paper)
    for status, path, target, options, words in (
            (2, panel, svg, ("--kind", "luminanz"), ("luminanz", "contrast")),
            (2, panel, svg, ("--kind", "fit"), ("--measured MANIFEST.json",)),
            (2, panel, commands.file("e.pdf"), (), (".svg or .png",)),
            (3, panel, svg, ("--kind", "uniformity"), ("the same everywhere",)),
            (3, white + ".panel", svg, ("--kind", "brdf"), ("no reflection data", "--kind brdf")),
            (3, white + ".panel", svg, ("--kind", "contrast"), ("its black emits nothing",)),
            (3, white + ".panel", svg, ("--kind", "grey-levels"), ("one level",)),
            (3, grey, svg, ("--kind", "sections"), ("no emission data", "--kind sections")),
            (3, commands.file("none.panel"), svg, (), ("none.panel",)),
            (4, panel, commands.file("none", "x.svg"), (), ("x.svg",))):
        fails(report, commands.run("plot", path, "-o", target, *options), status, *words)
    fails(report, commands.run("plot", panel), 2, "wants -o X.svg")
    report.claim(not os.path.exists(svg), "what cannot be drawn left a file")


def check_light(report, commands, _):
    """Lambertian light and surface: the contrast in light is its formula's."""
    panel, page = make_lambertian(commands, "lambertian"), commands.file("lambertian.html")
    asked = (((300, 0), (20000, 0)), ((300, 20000),), ((0, 20000),))
    options = (("--ambient", "300,20000"), ("--ambient", "300", "--directed", "20000,45"),
               ("--directed", "20000"))
    for lights, words in zip(asked, options):
        tables = json.loads(commands.text("report", panel, "-o", page, *words, "--json"))["tables"]
        rows = [table for table in tables if table["name"] == "ambient_contrast"][0]["rows"]
        rows = [row for row in rows if row["condition"] == "as asked"]
        report.claim([(row["diffuse_lx"], row["directed_lx"]) for row in rows] == list(lights),
                     f"{words}: {rows}")
        for row, lux in zip(rows, lights):
            reflected = ALBEDO * sum(lux) / math.pi
            wanted = (WHITE + reflected) / (BLACK + reflected)
            report.claim(abs(row["contrast"] / wanted - 1) < 0.01,
                         f"{lux} lx: {row['contrast']} instead of {wanted}")
    check_page(report, page)
    for option, value, words in (
            ("--ambient", "-3", "above 0"), ("--ambient", "1,", "required"),
            ("--ambient", "5;6", "no comma"), ("--ambient", "", "required"),
            ("--ambient", ",".join("5" * 9), "more than 8"), ("--directed", "9,90", "below 90")):
        fails(report, commands.run("report", panel, "-o", page, option, value), 2, option, words)


def check_chart_values(report, commands, panel, folder):
    """Beside the tables lie the values of every chart: those that eval has there."""
    names = sorted(name for name in os.listdir(folder) if name.startswith("chart_"))
    compared = 0
    for name in names:
        with open(os.path.join(folder, name), newline="") as file:
            header, *rows = csv.reader(file)
        report.claim(len(rows) > 20 and all(len(row) == 3 for row in rows), f"{name}: {header}")
        if name.endswith("_luminance__white.csv"):
            rows = [row for row in rows if row[:2] == ["40", "90"]]
        elif name.endswith("_vertical_section.csv") and "cd/m²" in header[2]:
            rows = [["40", "90", value] for of, at, value in rows if (of, at) == ("White", "40")]
        else:
            continue
        for theta, phi, value in rows:
            light = json.loads(commands.text("eval", panel, "--rgb", "255,255,255", "--theta",
                                             theta, "--phi", phi, "--json"))["luminance_cd_m2"]
            report.claim(abs(float(value) / light - 1) < 1e-5, f"{name} has {value}, eval {light}")
            compared += 1
    report.claim(len(names) > 8 and compared == 2, f"{compared} of {names} compared")


def check_display(report, commands, panel):
    """What a display engineer asks first is what eval says; a reflection alone has no white."""
    facts = json.loads(commands.text("info", panel, "--json"))["display"]

    def seen(rgb, theta=0.0, phi=0.0):
        return json.loads(commands.text("eval", panel, "--rgb", rgb, "--theta", str(theta),
                                        "--phi", str(phi), "--json"))["luminance_cd_m2"]
    white, black = seen("255,255,255"), seen("0,0,0")
    report.claim(abs(facts["white_cd_m2"] / white - 1) < 1e-4
                 and abs(facts["contrast"] * black / white - 1) < 1e-4,
                 f"white {facts['white_cd_m2']}, contrast {facts['contrast']}; eval says "
                 f"{white} over {black}")
    for phi, theta in zip((0, 90, 180, 270), facts["half_luminance_deg"]):
        share = seen("255,255,255", theta, phi) / white
        report.claim(abs(share - 0.5) < 1e-5, f"half of white at {theta}, {phi} is {share}")
    folder = commands.file("figures")
    commands.text("report", panel, "--csv", folder, "--quiet")
    check_chart_values(report, commands, panel, folder)
    with open(RECIPE) as file:
        gamma = json.load(file)["emission"]["gamma"]
    report.claim(all(abs(found - gamma) < 0.1 for found in facts["gamma"]),
                 f"gamma {facts['gamma']} instead of {gamma}")
    report.claim(0 < facts["dci_p3_coverage"] < facts["srgb_coverage"] <= 1.0001
                 and len(facts["primaries_xy"]) == 3, f"gamut: {facts}")
    grey = commands.file("grey2.panel")
    commands.text("fit", lambertian_set(commands, "grey2", 0.3), "-o", grey, "--quiet")
    text = commands.text("info", grey)
    facts = json.loads(commands.text("info", grey, "--json"))["display"]
    report.claim(abs(facts["diffuse_reflectance"] - 0.3) < 0.01 and "white_cd_m2" not in facts
                 and facts["mirror_reflectance"] == 0 and "haze_fwhm_deg" not in facts
                 and "white" not in text and "like a mirror" in text, f"a grey panel is {facts}")


def page_tables(path):
    """Of a page: every table as rows of the texts of their cells, by its heading's columns."""
    text = open(path, encoding="utf-8").read()
    tables = []
    for table in re.findall(r"<table.*?</table>", text, re.DOTALL):
        rows = [[html.unescape(re.sub(r"<[^>]*>", "", cell)).strip()
                 for cell in re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", row, re.DOTALL)]
                for row in re.findall(r"<tr.*?</tr>", table, re.DOTALL)]
        tables.append(rows)
    return tables


def is_same_cell(value, text):
    """A cell of JSON and one of CSV."""
    if value is None or isinstance(value, str):
        return (value or "") == text
    return float(text) == value


def check_one_string(report, commands, name):
    """A figure is the same string in info, on the page and in the CSV, and that number in JSON."""
    panel = os.path.join(ROOT, "assets", "panels", name + ".panel")
    page, folder = commands.file(name + ".html"), commands.file(name)
    commands.text("report", panel, "-o", page, "--csv", folder, "--quiet")
    on_page = page_tables(page)
    cells = {}
    with open(os.path.join(folder, "report.json"), encoding="utf-8") as file:
        tables = json.load(file)["tables"]
    for table in tables:
        if table["missing"]:
            report.claim(not table["rows"], f"{name}: {table['name']} is missing and has rows")
            continue
        with open(os.path.join(folder, table["name"] + ".csv"), encoding="utf-8", newline="") as f:
            rows = list(csv.reader(f))
        keys = rows[0]
        cells[table["name"]] = [dict(zip(keys, row)) for row in rows[1:]]
        same = len(rows) - 1 == len(table["rows"]) and all(
            list(one) == keys and all(is_same_cell(one[k], text) for k, text in zip(keys, row))
            for one, row in zip(table["rows"], rows[1:]))
        report.claim(same, f"{name}: {table['name']}: JSON and CSV differ")
        report.claim(rows[1:] in [shown[1:] for shown in on_page],
                     f"{name}: {table['name']}: no table of the page has the cells of the CSV")
    text = squeezed(commands.text("info", panel))
    half = cells["viewing_angle"][2]
    primary = {row["primary"].lower(): row for row in cells["primaries"]}
    factor = {row["geometry"]: row["factor_percent"] for row in cells["reflectance_factors"]}
    gamut = {row["standard"]: row["coverage_xy_percent"] for row in cells["gamut"]}
    white = cells["white"][0]
    for words in (f"white {white['luminance_cd_m2']} cd/m2",
                  f"white, xy {white['x']}, {white['y']}",
                  "primaries, xy " + ", ".join(f"{one} {primary[one]['x']} {primary[one]['y']}"
                                               for one in ("red", "green", "blue")),
                  f"covers of sRGB {gamut['sRGB']} %", f"covers of DCI-P3 {gamut['DCI-P3']} %",
                  f"half luminance right {half['phi_0']}, up {half['phi_90']}, "
                  f"left {half['phi_180']}, down {half['phi_270']} degrees",
                  f"diffusely (haze and floor) {factor['8/de']} %"):
        report.claim(words in text, f"{name}: info does not say '{words}', as the report does")


def check_other_build(report, first, second):
    """Both ways: what one wrote, the other reads."""
    for writer, reader in ((first, second), (second, first)):
        panel = writer.make(f"by_{writer is first}.panel")
        for question in ASKED:
            a, b = (c.text("eval", panel, *question) for c in (writer, reader))
            report.claim(a == b and len(a) > 1000, f"what {writer.path} wrote is read "
                         f"otherwise by {reader.path}: {' '.join(question)}")
        a, b = (c.text("info", panel, "--json") for c in (writer, reader))
        report.claim(a == b, "info differs")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--against")
    parser.add_argument("--all", action="store_true", help="all shipped panels, not two")
    parser.add_argument("program")
    options = parser.parse_args()
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        commands = Commands(options.program, folder)
        if options.against:
            check_other_build(report, commands, Commands(options.against, folder))
            report.finish()
        panel = commands.make("small.panel")
        for check in (check_grids, check_batch, check_levels, check_places,
                      check_traits, check_verdict, check_display,
                      check_light, check_pictures):
            try:
                check(report, commands, panel)
            except (ValueError, KeyError, IndexError) as error:
                report.claim(False, f"{check.__name__}: {type(error).__name__}: {error}")
        for name in PANELS if options.all else PANELS[:2]:
            check_one_string(report, commands, name)
        check_simulation(report, commands)
    report.finish()


if __name__ == "__main__":
    main()
