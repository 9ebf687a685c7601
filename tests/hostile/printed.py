# SPDX-License-Identifier: Apache-2.0
"""printed.py PARHELION -- names give a terminal no commands: what a scene, a request, a panel,
a measurement set, a file and the command line can name holds control characters, terminal
codes, line ends, bidirectional controls and bytes that are no UTF-8. What each command prints,
as text and as JSON, and each page, table and document that it writes is UTF-8 without any of
them, no line begins as a name would have it begin, and JSON gives the names back.
"""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import urllib.parse
import xml.etree.ElementTree

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path[:0] = [os.path.join(ROOT, "tests", "structure"), os.path.join(ROOT, "tests", "image")]
from report import Report  # noqa: E402
from review import EPW, PANEL, dashboard, weather_row  # noqa: E402

# Erases the line, goes back, colours, begins a link (OSC 8), turns the direction of reading,
# shows nothing, begins a line of its own.
FORGED = "forged: passes"
CODES = ("\x1b[2K\r\b\x7f\x9b1A\u0085\u061c\u200e\u200f\u2028\u2029\u202a\u202e\u2066\u2069"
         "\u00ad\u200b\u2060\ufeff"
         f"\x1b]8;;file:x\x07\t\n{FORGED}\v\f")
OBEYED = re.compile("[\x00-\x1f\x7f-\x9f\u00ad\u061c\u180e\u200b\u200e\u200f\u2028-\u202e"
                    "\u2060-\u206f\ufeff\ufff9-\ufffb\ufffe\uffff]")
NO_UTF8 = "\udcff\udc9b"  # as Python has bytes that are none


def named(kind):
    return kind + CODES


class Work:
    def __init__(self, report, program, folder):
        self.report, self.program, self.folder = report, os.path.abspath(program), folder

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def write(self, name, document):
        with open(self.path(name), "w", encoding="utf-8") as file:
            json.dump(document, file)

    def clean(self, what, data, allowed="\n"):
        """As text, which obeys nothing but the ends of its own lines."""
        try:
            text = data.decode("utf-8")
        except UnicodeDecodeError as error:
            return self.report.claim(False, f"{what}: {error}")
        found = sorted({f"U+{ord(c):04X}" for c in OBEYED.findall(text)} -
                       {f"U+{ord(c):04X}" for c in allowed})
        self.report.claim(not found, f"{what}: {' '.join(found)} as they stand")
        lines = re.split("[\n\r\u2028\u2029\u0085]", text)
        return self.report.claim(not any(line.startswith(FORGED) for line in lines),
                                 f"{what}: a name has a line of its own")

    def run(self, *words, status=0, as_text=True, asks_json=True):
        """As text, then as JSON; the JSON document. status: None: any."""
        what, document = " ".join(ascii(word.replace(CODES, "~")) for word in words), None
        for extra in [[]] * as_text + [["--json"]] * asks_json:
            done = subprocess.run([self.program, *words, *extra], cwd=self.folder,
                                  capture_output=True, check=False)
            self.report.claim(status in (done.returncode, None) and done.returncode >= 0,
                              f"{what}: {done.returncode}: {ascii(done.stderr)[-600:]}")
            self.clean(what + " on stdout", done.stdout)
            self.clean(what + " on stderr", done.stderr)
            if extra:
                document = self.parsed(what, done.stdout)
        return document

    def parsed(self, what, data):
        try:
            return json.loads(data)
        except ValueError as error:
            self.report.claim(False, f"{what}: {error}")
            return {}


    def files_are_clean(self, folder, kinds):
        """What a command wrote; a page and a table may hold other line ends and blanks."""
        for at, _, files in os.walk(self.path(folder)):
            for name in files:
                kind = os.path.splitext(name)[1]
                if kind not in kinds:
                    continue
                with open(os.path.join(at, name), "rb") as file:
                    data = file.read()
                self.clean(f"{ascii(name)} in {ascii(folder)}", data, kinds[kind])
                if kind == ".json":
                    self.parsed(name, data)
                if kind == ".xml":
                    xml.etree.ElementTree.fromstring(data)


TEXTS = {".html": "\n", ".csv": "\r\n", ".json": "\n", ".xml": "\n", ".js": "\n", ".gltf": "\n",
         ".svg": "\n", ".txt": "\n"}
DASH, SCREEN, EYE = named("dash") + ".gltf", named("screen"), named("eye")
FRAME, OTHER = named("frame") + NO_UTF8 + ".exr", named("other") + NO_UTF8 + ".exr"
SET = named("set")


# ---- files whose names and contents are so ---------------------------------------------------

def write_scene(work):
    shutil.copy(PANEL, work.path(named("ips") + ".panel"))
    scene = dashboard()
    scene.light("point", 2, [0.1, 0.1, 0.4])
    document = scene.document
    display = document["materials"][0]["extensions"]["PARHELION_display"]
    display["panel"] = urllib.parse.quote(named("ips") + ".panel")
    for kind in ("nodes", "meshes", "materials", "cameras", "images", "textures"):
        for i, item in enumerate(document.get(kind, [])):
            item["name"] = named(f"{kind} {i} ")
    document["materials"][0]["name"] = SCREEN
    document["nodes"][3]["name"] = EYE
    document["extensions"]["KHR_lights_punctual"]["lights"][0]["name"] = named("lamp")
    document["extras"] = {named("key"): named("value")}
    scene.write(work.path(DASH))


def write_review(work):
    """Everything in it has a name."""
    work.write(named("ask") + ".json", {
        "title": named("title"), "scene": [urllib.parse.quote(DASH)],
        "eyes": {EYE: {"camera": EYE}}, "forward": [0, 0, -1],
        "gaze": [{"name": named("road"), "direction": [0, 0, -1]}],
        "symbols": {named(kind): {"display": SCREEN, "uv": [0.1, 0.1, 0.9, 0.9]}
                    for kind in ("bar", "b a.r")},
        "levels": {named("level"): {SCREEN: 0.5}}, "profile": "iso-15008",
        "precision": {"contrast": 0.2, "paths": 8192},
        "frames": {"size": [16, 9], "noise": 0.9, "worst": 1},
        "variants": {named("matte"): {"brightness": {SCREEN: 2}}},
        "conditions": [{"name": named("noon"), "level": named("level"),
                        "environment": {"type": "constant", "luminance": 3000}}]})


# ---- commands --------------------------------------------------------------------------------

def check_scenes(work):
    found = work.run("check", DASH)
    work.report.claim(found and found["displays"][0]["name"] == SCREEN and
                      found["lights"][0]["name"] == named("lamp"), "names are not given back")
    work.run("check", DASH, "--materials", asks_json=False)
    view = [DASH, "--camera", EYE, "--size", "16x9"]
    work.run("render", *view, "--spp", "2", "-o", FRAME, "--layers", "all", "--png",
             named("picture") + ".png", "--display-level", SCREEN + "=50")
    work.run("render", *view, "--spp", "4", "-o", OTHER, "--layers", "all", "--progress",
             "plain")
    work.run("render", *view, "--replay", "8,4,0", asks_json=False)
    work.run("explain", *view, "--pixel", "8,4", "--paths", "128")
    work.run("explain", *view[:3], "--display", SCREEN, "--paths", "1024")
    work.run("sky", "--environment", "constant:500", "-o", named("sky") + NO_UTF8 + ".exr")
    work.run("measure", FRAME, "--display", SCREEN)
    work.run("develop", FRAME, "-o", named("developed") + NO_UTF8 + ".png")
    work.run("compare", FRAME, OTHER, "--report", named("report") + ".html", "--junit",
             named("report") + ".xml", status=1)


def check_panels(work):
    """A set of one table; a panel, its plots and its set again."""
    os.mkdir(work.path(SET))
    table, manifest = named("i") + "20.csv", os.path.join(SET, "MANIFEST.json")
    with open(work.path(SET, table), "w", encoding="utf-8") as file:
        file.write("theta,phi,brdf\n0,0,0.1\n" + "".join(
            f"{theta},{phi},0.1\n" for theta in range(10, 81, 10) for phi in range(0, 181, 30)))
    work.write(manifest, {
        "panel": named("panel"), "instrument": named("meter"), "note": named("note"),
        "date": named("date"), "operator": named("operator"), "conditions": named("room"),
        "reflection": {"wavelengths_nm": [550], "incidence_deg": [20],
                       "files": table.replace("20", "{incidence}")}})
    panel = named("fitted") + NO_UTF8 + ".panel"
    work.run("panel", "fit", manifest, "-o", panel)
    found = work.run("panel", "info", panel)
    work.report.claim(found.get("panel") == named("panel"), "a panel's name is not given back")
    work.run("panel", "plot", panel, "-o", named("plot") + ".svg", asks_json=False)
    work.run("panel", "report", panel, "-o", named("plot") + ".html")
    work.run("panel", "import", os.path.join(SET, table), "-o", os.path.join(SET, "I.json"),
             "--role", "*=white", asks_json=False, status=None)


def check_lamps(work):
    """What a luminaire says of itself, and a weather file of its place."""
    lamp, weather = named("lamp") + NO_UTF8 + ".ies", named("weather") + ".epw"
    with open(work.path(lamp), "w", encoding="utf-8") as file:
        codes = CODES.replace("\n", "").replace("\r", "")
        file.write(f"IESNA:LM-63-2002\n[TEST] {codes}\n[LAMP] {codes}\n[LUMINAIRE] {codes}\n"
                   "TILT=NONE\n1 1000 1 2 1 1 2 0.1 0.1 0\n1 1 10\n0 90\n0\n100 100\n")
    for words in (["--light", named("lamp node") + "=" + lamp],
                  ["--light", named("lamp node") + "x=" + lamp]):
        work.run("check", DASH, *words, status=None)
    with open(work.path(weather), "w", encoding="utf-8") as file:
        file.write(EPW.replace("Testville", codes) + weather_row(6, 21, "1,60", 500, 100, 0))
    work.run("sky", "--weather", weather, "--when", "2011-06-21T08:30+01:00", status=None)


def check_parts(work):
    parts = [named("part") + NO_UTF8 + f"{i}.exr" for i in range(2)]
    for i, part in enumerate(parts):
        work.run("render", DASH, "--size", "8x4", "--samples", f"{i}:{i + 1}", "-o", part,
                 asks_json=False)
    work.run("merge", *parts, "-o", named("merged") + NO_UTF8 + ".exr")
    work.run("merge", parts[0], parts[0], "-o", "x.exr", status=3)
    for name in ("old", "new"):
        os.mkdir(work.path(named(name)))
        shutil.copy(work.path(parts[0]), work.path(named(name), "same" + NO_UTF8 + ".exr"))
        shutil.copy(work.path(parts[0]), work.path(named(name), named(name) + ".exr"))
    work.run("compare", named("old"), named("new"), "--report", named("folders") + ".html",
             "--junit", named("folders") + ".xml", status=1)


def check_refusals(work):
    """A name that is wrong is quoted; nearest names are proposed."""
    wrong = SCREEN + "x" + NO_UTF8
    no_scene = named("nothing") + NO_UTF8 + ".gltf"
    for words in (["check", no_scene], ["render", no_scene, "-o", "x.exr"],
                  ["render", DASH, "--content", wrong + "=" + no_scene, "-o", "x.exr"],
                  ["render", DASH, "--panel", SCREEN + "=" + no_scene, "-o", "x.exr"],
                  ["explain", DASH, "--display", wrong],
                  ["sky", "--environment", "hdri:" + no_scene], ["panel", "info", no_scene],
                  ["panel", "plot", no_scene, "-o", "x.svg"],
                  ["develop", no_scene, "-o", "x.png"],
                  ["panel", "fit", no_scene, "-o", "x.panel"], ["compare", no_scene, FRAME],
                  ["panel", "import", no_scene, "-o", "x.json"],
                  ["merge", no_scene, "-o", "x.exr"], ["review", no_scene, "-o", "x"],
                  ["equip", no_scene, "-o", "x.html"],
                  ["equip", DASH, "--with", no_scene, "-o", "y.gltf"]):
        work.run(*words, status=3)
    for words in ([wrong], ["panel", wrong], ["measure", FRAME, "--display", wrong],
                  ["render", DASH, "--camera", wrong, "-o", "x.exr"], ["help", wrong],
                  ["render", "--" + wrong], ["check", DASH, "--threads", wrong],
                  ["sky", "--environment", wrong], ["sky", "--when", wrong],
                  ["render", DASH, "-o", named("x") + ".txt"]):
        work.run(*words, status=2)
    no_end = '{"' + named("a").replace("\n", "") + '": 1'
    for text in (CODES, no_end, json.dumps({named("k"): 1})):
        for name in (named("text") + ".gltf", named("text") + ".json"):
            with open(work.path(name), "w", encoding="utf-8") as file:
                file.write(text)
        work.run("check", named("text") + ".gltf", status=3)
        work.run("review", named("text") + ".json", "-o", "x", status=3)
        work.run("panel", "fit", named("text") + ".json", "-o", "x.panel", status=3)
        work.run("equip", DASH, "--with", named("text") + ".json", "-o", "y.gltf", status=3)


def check_review(work):
    write_review(work)
    ask, out = named("ask") + ".json", named("out") + NO_UTF8
    work.run("review", ask, "--dry-run")
    work.run("review", ask, "-o", out, asks_json=False)
    found = work.run("review", ask, "-o", out, "--diff", out, as_text=False)
    work.files_are_clean(out, TEXTS)
    symbols = sorted({c["symbol"] for c in found.get("cases", [])})
    work.report.claim(symbols == sorted(named(kind) for kind in ("bar", "b a.r")),
                      f"symbols are {ascii(symbols)}")
    of_bar = ["--symbol", named("bar"), "--paths", "1024"]
    work.run("explain", ask, "--condition", named("noon"), *of_bar)
    work.run("explain", ask, "--condition", named("moon"), *of_bar, status=2)
    work.run("equip", DASH, "-o", named("equip") + ".html", asks_json=False)
    work.files_are_clean(".", {".html": "\n", ".xml": "\n"})


def main():
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        work = Work(report, sys.argv[1], folder)
        write_scene(work)
        check_scenes(work)
        check_panels(work)
        check_lamps(work)
        check_parts(work)
        check_refusals(work)
        check_review(work)
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
