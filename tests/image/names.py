# SPDX-License-Identifier: Apache-2.0
"""names.py [--all] PARHELION -- what a command writes has the same bytes whatever its outputs
are called, wherever they stand, and however the run is shown, shared among threads or kept.
Without --all by two names.
"""
import itertools
import os
import subprocess
import sys
import tempfile

from bits import write_scene

ROOT = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

PANEL = os.path.join(ROOT, "assets", "panels", "ips_cluster.panel")
RECIPE = os.path.join(ROOT, "assets", "panels", "ips_cluster.recipe.json")
PLACE = ["--when", "2026-06-21T08:30+02:00", "--where", "48.14,11.58,520"]

# Stems of outputs: beside the inputs, and in a folder with a blank; of frames also by its whole
# path, and like an option.
STEMS = ["a", "another folder/it's a longer name", "{folder}/whole", "./--quiet"]

# What changes nothing besides, one set for each stem.
WAYS = [["--threads", "1"], ["--threads=2", "--progress", "plain"], ["--json"], ["--quiet"]]
RENDER_WAYS = [[], ["--png", "{stem}.png", "--exposure", "12", "--view", "raw"],
               ["--png={stem}.tif", "--false-colour", "luminance", "--checkpoint={stem}.keep"],
               ["--resume", "--checkpoint-interval", "5", "--checkpoint", "{stem}.ck"]]


class Work:
    def __init__(self, report, program, folder, whole):
        self.report, self.program, self.folder = report, program, folder
        self.names = STEMS if whole else STEMS[:2]

    def path(self, name):
        return os.path.join(self.folder, name)

    def run(self, *words):
        done = subprocess.run([self.program, *words], cwd=self.folder, capture_output=True,
                              text=True)
        self.report.claim(done.returncode == 0, f"{words}: {done.stderr.strip()}")

    def stems(self):
        return [stem.format(folder=self.folder) for stem in self.names]

    def contents(self, name):
        """A file's bytes, or those of all files below a folder by their names."""
        path = self.path(name)
        if os.path.isdir(path):
            return {os.path.relpath(os.path.join(at, file), path):
                    self.contents(os.path.join(at, file))
                    for at, _, files in os.walk(path) for file in files}
        try:
            with open(path, "rb") as file:
                return file.read()
        except OSError:
            return None

    def claim_equal(self, what, outputs):
        found = [self.contents(output) for output in outputs]
        for output, bytes_ in zip(outputs, found):
            self.report.claim(bytes_ and bytes_ == found[0],
                              f"{what}: {output} has other bytes than {outputs[0]}")

    def claim_same(self, what, words, ending, option="-o", more=None):
        """words: the command without its output."""
        outputs = []
        for stem, way, other in zip(self.stems(), WAYS, more or ([], [])):
            output = stem + ending
            self.run(*words, *way, f"{option}={output}",
                     *(word.format(stem=stem) for word in other))
            outputs.append(output)
        self.claim_equal(what, outputs)


def check_frames(work):
    render = ["render", "small.gltf", "--size", "24x16", "--layers", "all", "--no-guiding"]
    for what, words in (("frame", ["--spp", "3"]), ("part", ["--samples", "1:3"]),
                        ("noise", ["--noise", "0.5", "--spp", "4"])):
        work.claim_same(what, [*render, *words], f".{what}.exr", more=RENDER_WAYS)
    for stem, way in zip(work.stems(), RENDER_WAYS):
        way = [word.format(stem=stem) for word in way]
        work.run(*render, "--samples", "0:1", "-o", f"{stem}.first.exr", *way)
        work.run(*render, "--samples", "0:3", "-o", f"{stem}.left.exr", "--crop", "0,0,9,16",
                 "--noise", "0.01", *way)
        work.run(*render, "--samples", "0:3", "-o", f"{stem}.right.exr", "--noise", "0.01",
                 "--crop", "9,0,24,16", *way)


def check_lamps(work):
    """A luminaire file as a lamp: its frame too, and its metadata."""
    with open(work.path("lamp.ies"), "w", encoding="ascii") as file:
        file.write("IESNA:LM-63-2002\n[_CCT] 3000\nTILT=NONE\n1 -1 1 2 1 1 2 -.2 -.2 .1\n"
                   "1 1 9\n0 90\n0\n500 20\n")
    work.claim_same("lamp", ["render", "small.gltf", "--size", "24x16", "--spp", "2", "--light",
                             "eye=lamp.ies", "--light-level", "eye=80", "--light-cct",
                             "*=2700"], ".lamp.exr", more=RENDER_WAYS)


def check_merge(work):
    """Of parts of any names, in any order; of --noise no one run makes the whole."""
    for whole, first, second in (("merged.exr", "first.exr", "part.exr"),
                                 ("sides.exr", "left.exr", "right.exr")):
        outputs = []
        for i, stem in enumerate(work.stems()):
            parts = [f"{stem}.{first}", f"{stem}.{second}"]
            work.run("merge", "-o", f"{stem}.{whole}", "--", *(parts[::-1] if i % 2 else parts))
            outputs.append(f"{stem}.{whole}")
        work.claim_equal(whole, outputs)
    work.claim_equal("merged as one run", ["a.merged.exr", "a.frame.exr"])


def check_pictures(work):
    for ending, options in ((".png", []), (".tif", ["--bits=16"]), (".jpg", []),
                            (".false.png", ["--false-colour", "luminance"]),
                            (".layer.png", ["--layer", "depth.Z"])):
        work.claim_same("develop " + ending, ["develop", "a.frame.exr", *options], ending)
    outputs = []
    for i, stem in enumerate(work.stems()[:2]):
        work.run("develop", "-o", f"picture{i}.png", "--", f"{stem}.frame.exr")
        outputs.append(f"picture{i}.png")
    work.claim_equal("develop of a frame of another name", outputs)
    for ending, sky in ((".sky.exr", ["sky:clear", *PLACE]),
                        (".sky.svg", ["cie:12:20000", "--sun", "120,35"])):
        work.claim_same("sky", ["sky", "--environment", *sky], ending)
    work.claim_same("compare", ["compare", "a.png", "a.png"], ".html", "--report")


def check_panels(work):
    work.claim_same("simulate", ["panel", "simulate", RECIPE, "--grid", "6x12"], "_set")
    set_ = "a_set/MANIFEST.json"
    work.claim_same("fit", ["panel", "fit", set_, "--level", "3", "--max-error", "0.5"],
                    ".panel")
    for kind, ending in itertools.product(("luminance", "brdf"), (".svg", ".png")):
        work.claim_same("plot", ["panel", "plot", PANEL, "--kind", kind], f".{kind}{ending}")
    work.claim_same("panel report", ["panel", "report", PANEL], ".panel.html")
    tables = [f"a_set/emission/{name}" for name in sorted(os.listdir(work.path(
        "a_set/emission"))) if "255" in name or name.startswith("black")]
    work.claim_same("import", ["panel", "import", *tables], "_in/MANIFEST.json")
    work.claim_equal("imported tables", [f"{stem}_in" for stem in work.stems()[:2]])


def main():
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        work = Work(report, os.path.abspath(sys.argv[-1]), os.path.realpath(folder),
                    "--all" in sys.argv)
        os.mkdir(work.path("another folder"))
        write_scene(work.path("small.gltf"))
        check_frames(work)
        check_lamps(work)
        check_merge(work)
        check_pictures(work)
        check_panels(work)
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
