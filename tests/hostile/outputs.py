# SPDX-License-Identifier: Apache-2.0
"""outputs.py PARHELION -- an output never replaces an input: of every command each option that
takes a file (as its value in `help --json` has it, and shells complete it) gets a file that the
command reads, typed or named inside another file; one that writes gets each of them in turn. No
byte changes, and an option that writes is refused with status 4.

Which options write is found by trying: a new name that is a file afterwards was written.
"""
import glob
import json
import os
import shutil
import subprocess
import sys
import tempfile

from judged_scene import ROOT, request, write_scene

sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
sys.path.insert(0, os.path.join(ROOT, "assets", "install"))
from fault_files import RECIPE, table_text  # noqa: E402
from pages import every_command, means_file  # noqa: E402
from report import Report  # noqa: E402

WORDS = "write over"
QUIET = ("--quiet", "--threads", "1")
SKY = ("--environment", "hdri:hdri.exr")
# Command: its line; the files that it reads; the endings that its outputs may have, by option.
# Two lines of one command: what it writes differs.
LINES = {
    "render": [("render scene.gltf --size 4x2 --spp 1 --no-guiding -o OUT.exr "
                "--panel screen=other.panel --content screen=other.png "
                "--environment hdri:hdri.exr",
                "scene.gltf data.bin other.panel other.png hdri.exr",
                {"-o": ".exr", "--png": ".png", "--live": ".exr"})],
    "develop": [("develop frame.exr -o OUT.png --config user.ocio", "frame.exr user.ocio",
                 {"-o": ".png"})],
    "panel import": [("panel import lab.csv --role *=white --levels levels.csv "
                      "-o OUT/MANIFEST.json",
                      "lab.csv levels.csv", {"-o": ".json"})],
    "panel fit": [("panel fit set/MANIFEST.json -o OUT.panel",
                   "set/MANIFEST.json set/white.csv set/levels.csv", {"-o": ".panel"})],
    "panel info": [("panel info other.panel", "other.panel", {})],
    "panel eval": [("panel eval other.panel --batch rows.csv", "other.panel rows.csv", {})],
    "panel plot": [("panel plot other.panel -o OUT.svg --kind luminance --measured "
                    "set/MANIFEST.json", "other.panel set/MANIFEST.json set/white.csv "
                    "set/levels.csv", {"-o": ".svg"})],
    "panel report": [("panel report other.panel -o OUT.html --measured set/MANIFEST.json",
                      "other.panel set/MANIFEST.json set/white.csv set/levels.csv",
                      {"-o": ".html"})],
    "panel show": [("panel show other.panel --content content.png --size 8x8 --spp 1 "
                    "--size-mm 8,8 -o OUT.exr", "other.panel content.png",
                    {"-o": ".exr", "--png": ".png"}),
                   ("panel show other.panel --content content.png --size 8x8 --spp 1 "
                    "--size-mm 8,8 --png OUT.png", "other.panel content.png",
                    {"--png": ".png"})],
    "panel simulate": [("panel simulate recipe.json -o OUT", "recipe.json", {})],
    "sky": [("sky scene.gltf --environment hdri:hdri.exr --size 8x4 -o OUT.exr",
             "scene.gltf hdri.exr data.bin", {"-o": ".exr"}),
            ("sky lit.gltf --size 8x4 -o OUT.exr", "lit.gltf hdri.exr", {"-o": ".exr"})],
    "check": [("check scene.gltf", "scene.gltf data.bin", {})],
    "compare": [("compare frame.exr other.exr --mask mask.png", "frame.exr other.exr mask.png",
                 {"--report": ".html", "--junit": ".xml"}),
                ("compare left right", "left/a.exr right/a.exr",
                 {"--report": ".html", "--junit": ".xml"})],
    "merge": [("merge p0.exr p1.exr -o OUT.exr", "p0.exr p1.exr", {"-o": ".exr"})],
    "measure": [("measure frame.exr", "frame.exr", {})],
    "review": [("review r.json --dry-run", "r.json scene.gltf content.png display.panel", {}),
               ("review scene.gltf --init OUT.json", "scene.gltf data.bin content.png",
                {"--init": ".json"})],
    "explain": [("explain scene.gltf --display screen --paths 1024 --environment constant:100",
                 "scene.gltf data.bin content.png", {}),
                ("explain r.json --paths 1024 --symbol bar",
                 "r.json scene.gltf data.bin content.png", {})],
    "equip": [("equip model/m.gltf -o OUT.html", "model/m.gltf model/data.bin",
               {"-o": ".html"}),
              ("equip model/m.gltf --with e.json --overwrite -o OUT.gltf",
               "model/m.gltf model/data.bin e.json", {"-o": ".gltf"})],
}
NO_OUTPUT = {"help", "schema"}  # nothing is typed that they write
CONFIG = """ocio_profile_version: 2
roles: {scene_linear: lin, aces_interchange: lin, default: lin}
file_rules:
  - !<Rule> {name: Default, colorspace: lin}
displays:
  d:
    - !<View> {name: v, colorspace: lin}
active_displays: []
active_views: []
colorspaces:
  - !<ColorSpace>
    name: lin
"""


class Program:
    def __init__(self, path, folder):
        self.path, self.folder, self.runs = os.path.abspath(path), folder, 0

    def __call__(self, *words):
        self.runs += 1
        return subprocess.run([self.path, *words], cwd=self.folder, capture_output=True,
                              text=True, errors="replace", timeout=120, check=False)

    def works(self, *words):
        done = self(*words)
        if done.returncode:
            sys.exit(f"{words}: {done.returncode} {done.stderr}")


def write(folder, name, text):
    os.makedirs(os.path.dirname(os.path.join(folder, name)), exist_ok=True)
    with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
        file.write(text)


def make_files(program):
    """All that the lines name."""
    folder = program.folder

    def at(name):
        return os.path.join(folder, name)
    write_scene(folder)
    os.mkdir(at("model"))
    write_scene(at("model"))
    os.rename(at("model/scene.gltf"), at("model/m.gltf"))
    shutil.copy(at("display.panel"), at("other.panel"))
    shutil.copy(at("content.png"), at("other.png"))
    write(folder, "lit.gltf", json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "extensionsUsed": ["PARHELION_environment"],
        "scenes": [{"extensions": {"PARHELION_environment": {"type": "hdri",
                                                             "uri": "hdri.exr"}}}]}))
    write(folder, "r.json", json.dumps(request({"grey": ("full", 100)}, {"full": 1}, ("bar",))))
    write(folder, "user.ocio", CONFIG)
    for name in ("lab.csv", "set/white.csv"):
        write(folder, name, table_text())
    for name in ("levels.csv", "set/levels.csv"):
        write(folder, name, "level,L\n0,0.4\n64,20\n128,90\n255,400\n")
    write(folder, "set/MANIFEST.json", json.dumps({"panel": "x", "emission": {
        "white": "white.csv", "levels": "levels.csv"}}))
    write(folder, "rows.csv", "theta,phi,r,g,b\n0,0,255,255,255\n")
    shutil.copy(RECIPE, at("recipe.json"))
    write(folder, "e.json", json.dumps({"equip": 1, "displays": [
        {"name": "d", "centre_m": [0, 0.2, 0.1], "right": [1, 0, 0], "up": [0, 1, 0],
         "width_m": 0.3, "height_m": 0.1, "panel": "ips_cluster"}],
        "eyes": [{"name": "driver", "position_m": [0, 0.2, 1], "looks_at": "d"}]}))
    program.works("sky", "--environment", "constant:100", "--size", "8x4", "-o", "hdri.exr")
    frame = ("render", "scene.gltf", "--size", "16x16", "--no-guiding", *SKY, *QUIET)
    program.works(*frame, "--spp", "2", "-o", "frame.exr")
    program.works(*frame, "--spp", "2", "--seed", "1", "-o", "other.exr")
    for i in range(2):
        program.works(*frame, "--samples", f"{i}:{i + 1}", "-o", f"p{i}.exr")
    for name, source in (("left/a.exr", "frame.exr"), ("right/a.exr", "other.exr")):
        write(folder, name, "")
        shutil.copy(at(source), at(name))
    program.works("develop", "frame.exr", "-o", "mask.png")


def rows_of(program):
    """{command: its options that take a file}."""
    told = json.loads(program("help", "--json").stdout)["commands"]
    return {" ".join(words): [option["name"] for option in row["options"]
                              if option["value"] and means_file(option["value"]) and
                              "=" not in option["value"]]
            for words, row in every_command(told) if "options" in row}


def contents(folder):
    found = {}
    for path in glob.glob(os.path.join(folder, "**"), recursive=True):
        if os.path.isfile(path):
            with open(path, "rb") as file:
                found[os.path.relpath(path, folder)] = file.read()
    return found


class Line:
    """One command's line in a folder whose files stay as they are."""

    def __init__(self, program, report, text):
        self.program, self.report, self.words = program, report, text.split()
        self.before = contents(program.folder)

    def restore(self):
        """What a run has made goes again. True: nothing that was there has changed."""
        folder, now = self.program.folder, contents(self.program.folder)
        for name in now.keys() - self.before.keys():
            os.remove(os.path.join(folder, name))
        for path in glob.glob(os.path.join(folder, "OUT*")):
            shutil.rmtree(path, ignore_errors=True)
        kept = all(now.get(name) == data for name, data in self.before.items())
        for name, data in self.before.items():
            if now.get(name) != data:
                with open(os.path.join(folder, name), "wb") as file:
                    file.write(data)
        return kept

    def with_option(self, option, value):
        words = list(self.words)
        if option in words:
            words[words.index(option) + 1] = value
        else:
            words += [option, value]
        return words

    def writes(self, option, ending):
        """Whether a new name that the option gets is a file afterwards."""
        name = "OUT_new" + ending
        done = self.program(*self.with_option(option, name), *QUIET)
        made = os.path.isfile(os.path.join(self.program.folder, name))
        self.restore()
        return made, done

    def check(self, option, given, ending, is_output):
        done = self.program(*self.with_option(option, given), *QUIET)
        what = f"{' '.join(self.with_option(option, given))}: {done.returncode} {done.stderr}"
        self.report.claim(self.restore(), f"an input is changed: {what}")
        if is_output and given.endswith(ending):
            lines = done.stderr.strip().splitlines()
            self.report.claim(done.returncode == 4 and len(lines) == 1 and
                              (WORDS in done.stderr or "is read, required:" in done.stderr or
                               "would be written over" in done.stderr), what)


def check_line(program, report, options, row):
    """Every option that takes a file gets every input, by its own name and by a link."""
    text, inputs, endings = row
    line, outputs = Line(program, report, text), 0
    for option in options:
        ending = endings.get(option, "")
        is_output, done = line.writes(option, ending) if option in endings else (False, None)
        report.claim(is_output or option not in endings,
                     f"{text}: {option} writes nothing: {done and done.stderr}")
        outputs += is_output
        for name in inputs.split()[:None if is_output else 1]:
            line.check(option, name, ending, is_output)
        if is_output:
            check_link(line, option, inputs.split()[0], ending)
    return outputs


def check_link(line, option, name, ending):
    """A link with the right ending leads to the same file."""
    path = os.path.join(line.program.folder, "OUT_link" + ending)
    os.symlink(name, path)
    done = line.program(*line.with_option(option, "OUT_link" + ending), *QUIET)
    line.report.claim(done.returncode == 4, f"a link, {option}: {done.stderr}")
    os.remove(path)
    line.report.claim(line.restore(), f"an input is changed by a link, {option}")


def check_folders(program, report):
    """Outputs that are folders: what is read stays, whatever it is called there."""
    folder = program.folder
    for words, name, source in (
            (("panel", "simulate", "OUT/MANIFEST.json", "-o", "OUT"), "OUT/MANIFEST.json",
             "recipe.json"),
            (("panel", "import", "OUT/emission/white.csv", "-o", "OUT/MANIFEST.json"),
             "OUT/emission/white.csv", "lab.csv"),
            (("review", "OUT/review.json", "-o", "OUT", "--quiet"), "OUT/review.json",
             "r.json")):
        line = Line(program, report, "")
        write(folder, name, "")
        shutil.copy(os.path.join(folder, source), os.path.join(folder, name))
        if words[0] == "review":  # as if a review had made it
            shutil.copy(os.path.join(folder, "scene.gltf"), os.path.join(folder, "OUT"))
            for beside in ("data.bin", "content.png", "display.panel"):
                shutil.copy(os.path.join(folder, beside), os.path.join(folder, "OUT"))
            write(folder, "OUT/made-by-review.txt", "review.json\nindex.html\n")
        with open(os.path.join(folder, name), "rb") as file:
            before = file.read()
        done = program(*words)
        with open(os.path.join(folder, name), "rb") as file:
            report.claim(file.read() == before and done.returncode == 4,
                         f"{' '.join(words)}: {done.returncode} {done.stderr}")
        shutil.rmtree(os.path.join(folder, "OUT"))
        line.restore()


def main(path):
    report, outputs = Report(), 0
    with tempfile.TemporaryDirectory(prefix="outputs-") as folder:
        program = Program(path, folder)
        make_files(program)
        rows = rows_of(program)
        report.claim(rows.keys() - NO_OUTPUT == LINES.keys(),
                     f"commands: {sorted(rows.keys() ^ LINES.keys())}")
        for command, lines in LINES.items():
            for line in lines:
                outputs += check_line(program, report, rows[command], line)
        check_folders(program, report)
    print(f"{outputs} outputs of {len(LINES)} commands, {program.runs} runs")
    return report.finish()


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
