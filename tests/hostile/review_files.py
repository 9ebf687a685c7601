# SPDX-License-Identifier: Apache-2.0
"""review_files.py PARHELION -- the folder of a review is also the user's: symbols of any names
have a page each, to which their link leads; nothing is removed but what an earlier review says
that it made, and a file of somebody else's in the way is told of before any work. Nothing is
written or removed behind a link, and no pipe is waited for.
"""
import html
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path[:0] = [os.path.join(ROOT, "tests", "structure"), os.path.join(ROOT, "tests", "image")]
from report import Report  # noqa: E402
from review import PANEL, dashboard, moment  # noqa: E402

LIST = "made-by-review.txt"
# Of one file's name as letters and digits are kept: by twos and threes, also where large
# letters are small ones; one that looks numbered; too long; and some that no file may have.
ALIKE = ["速度", "転速", "tyre 1.2", "tyre 1-2", "tyre_1-2", "A", "a", "a.2", "a 2", "A.2",
         "x" * 300, "x" * 299 + "y", "..", "/", "a/b", "a\\b", "COM1", "con", "*?:\"<>|", "é",
         "e\u0301", ".hidden", "speed "]


class Work:
    def __init__(self, report, program, folder):
        self.report, self.program, self.folder = report, os.path.abspath(program), folder
        shutil.copy(PANEL, self.path("ips.panel"))
        dashboard().write(self.path("dash.gltf"))

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def put(self, *names, text="mine"):
        os.makedirs(os.path.dirname(self.path(*names)), exist_ok=True)
        with open(self.path(*names), "w", encoding="utf-8") as file:
            file.write(text)

    def text(self, *names):
        with open(self.path(*names), encoding="utf-8") as file:
            return file.read()

    def review(self, out, symbols, *options, condition="grey", worst=0):
        """Exit status and what is said on stderr."""
        document = {
            "title": "t", "scene": ["dash.gltf"], "eyes": {"eye": {"camera": "eye"}},
            "symbols": {name: {"display": "screen", "uv": [0.1, 0.1, 0.9, 0.9]}
                        for name in symbols},
            "profile": "iso-15008", "precision": {"contrast": 0.2, "paths": 8192},
            "frames": {"size": [16, 9], "noise": 0.9, "worst": worst},
            "conditions": [moment(condition, type="constant", luminance=3000)]}
        with open(self.path("ask.json"), "w", encoding="utf-8") as file:
            json.dump(document, file)
        done = subprocess.run([self.program, "review", "ask.json", "-o", out, "--quiet",
                               *options], cwd=self.folder, capture_output=True, text=True,
                              check=False)
        return done.returncode, done.stderr

    def all_files(self, folder):
        return sorted(os.path.relpath(os.path.join(at, name), self.path(folder))
                      for at, _, files in os.walk(self.path(folder)) for name in files)

    def listed(self, folder):
        return sorted(line for line in self.text(folder, LIST).splitlines()
                      if not line.startswith("#"))


def check_links(work):
    """A link and the page that it shows are of one symbol."""
    report, status = work.report, work.review("alike", ALIKE, condition="c" * 300, worst=1)
    report.claim(status == (0, ""), f"symbols of like names: {status}")
    links = re.findall(r'<a class="symbol" href="([^"]*)">([^<]*)</a>',
                       work.text("alike", "index.html"))
    report.claim(len(links) >= 7, f"{len(links)} links")
    pages = sorted(name for name in work.all_files("alike") if name.startswith("summary-"))
    report.claim(len({name.lower() for name in pages}) == len(ALIKE), f"pages: {pages}")
    for file, name in links:
        title = re.search("<title>([^<]*)</title>", work.text("alike", file))
        report.claim(title and title[1] == name, f"{file}, linked as {name[:40]}: {title}")
    titles = {html.unescape(re.search("<title>([^<]*)</title>", work.text("alike", name))[1])
              for name in pages}
    report.claim(titles == set(ALIKE), f"pages without a symbol: {set(ALIKE) - titles}")
    report.claim(work.listed("alike") == [name for name in work.all_files("alike")
                                          if name != LIST], "the list is not what is there")
    plain = {html.unescape(name): file for file, name in links}
    work.review("alike", ["a", "a.2", "a 2", "A.2", "A"], "--summary", "a")
    report.claim("a" not in plain or plain["a"] == "summary-a.2.html",
                 f"the second of two: {plain.get('a')}")


def check_foreign(work):
    """Files that came between two reviews stay, whatever the folder; the first's own go."""
    report, out = work.report, "shared"
    before = work.review(out, ["speed", "range"], worst=1)
    made = work.all_files(out)
    mine = ["summary-for-the-board.docx", "summary-of-mine.html", "summary-speed.pdf",
            "frames/1-grey-eye notes.png", "frames/2-notes.png", "sweeps/1-mine.csv",
            "unfinished/new/notes.txt", "unfinished/notes.checkpoint.txt", "photo.png"]
    for name in mine + ["gazes.csv"]:  # an earlier version's, as its list says
        work.put(out, name)
    work.put("precious.txt")
    work.put(out, LIST, text=work.text(out, LIST) + "gazes.csv\n../precious.txt\nphoto.png\n"
             "frames/../photo.png\nsweeps/../../precious.txt\n/dev/null\n")
    after = work.review(out, ["speed"])
    report.claim(before == after == (0, ""), f"twice in a folder: {before}, {after}")
    there = work.all_files(out)
    report.claim(set(mine) <= set(there) and os.path.exists(work.path("precious.txt")),
                 f"gone: {set(mine) - set(there)}")
    report.claim(all(work.text(out, name) == "mine" for name in mine if name in there),
                 "a file of the user's was written over")
    gone = [name for name in made if name not in there]
    report.claim({"summary-range.html", "frames/1-grey-eye.png"} <= set(gone) and
                 "gazes.csv" not in there,
                 f"an earlier review's files stay: {made} {there}")
    listed = work.listed(out)
    report.claim(sorted(listed + mine + [LIST]) == there, f"listed: {listed}")


def check_without_list(work):
    """A folder of a version that wrote none: its review.json names what it made."""
    report = work.report
    work.review("old", ["speed", "range"], worst=1)
    os.remove(work.path("old", LIST))
    for name in ("summary-mine.html", "frames/1-grey-eye notes.png"):
        work.put("old", name)
    report.claim(work.review("old", ["speed"]) == (0, ""), "a folder without a list is refused")
    there = work.all_files("old")
    report.claim("summary-mine.html" in there and "frames/1-grey-eye notes.png" in there and
                 "summary-range.html" not in there, f"without a list: {there}")


def check_in_the_way(work):
    """One line that names it, before any work: nothing else is there afterwards."""
    for name in ("index.html", "review.json", "Index.HTML", "cases.csv", LIST,
                 "summary-speed.html", "Summary-SPEED.html", "summary-speed.2.html",
                 "frames/1-grey-eye.png", "frames/12-Grey-eye-contrast.png",
                 "frames/1-grey-eye-variant-1-x.exr", "unfinished/1-grey.condition"):
        for options in ([], ["--dry-run"]):
            out = "way"
            work.put(out, name)
            status, said = work.review(out, ["speed"], *options)
            work.report.claim(status == 4 and said.count("\n") == 1 and
                              f"{out}/{name}: " in said and work.all_files(out) == [name]
                              and work.text(out, name) == "mine",
                              f"{name} in the way, {options}: {status} {said!r}")
            shutil.rmtree(work.path(out))


HASH = "0123456789abcdef"
# A user's own, beside and among a review's: names of the review's kinds with other bytes, and
# names that are nearly theirs. All stay, and the folders that hold them.
MINE = ["unfinished/night.checkpoint", f"unfinished/{HASH}.checkpoint", f"unfinished/{HASH}.frame",
        f"unfinished/{HASH.upper()}.checkpoint", f"unfinished/{HASH}0.frame", "unfinished/a.part",
        f"unfinished/{HASH[:15]}.checkpoint", "unfinished/9-grey.condition", "unfinished/.hidden",
        "unfinished/x.parhelion-part", f"unfinished/{HASH}.frame.deadbeef.part",
        f"unfinished/{HASH}.frame.deadbeef-1x.part", "unfinished/deadbeef-1.part",
        "unfinished/n.checkpoint.deadbeef-12.part", "unfinished/new/notes.txt",
        "unfinished/deep/er/x.checkpoint", "unfinished/new/mine.part", "a.part", "b.checkpoint",
        "responses/mine.response", "sweeps/a.csv", "frames/a.png", "conditions/a.condition",
        "responses/speed-0123456789abcdef.response"]
# Folders that are links to others, and what lies there under names of a review's.
LINKED = {"unfinished": [f"{HASH}.checkpoint", "lock", "new/index.html"],
          "unfinished/new": ["index.html", "cases.csv"],
          "unfinished/new/frames": ["1-grey-eye.png"], "unfinished/new/sweeps": ["1-a.csv"],
          "unfinished/new/conditions": ["1-grey.condition"],
          "frames": ["1-grey-eye.png", "1-grey-eye.exr"], "sweeps": ["1-grey-eye-speed.csv"],
          "conditions": ["1-grey.condition"], "responses": ["x-0123456789abcdef.response"]}
EMPTY = ["unfinished", "frames", "sweeps", "conditions", "responses"]
# What is no file where a review writes: nothing waits, nothing is written into.
PIPES = ["unfinished/lock", "unfinished/new/index.html", "unfinished/new/frames/1-grey-eye.exr",
         "unfinished/1-grey.condition", f"unfinished/{HASH}.checkpoint",
         "responses/x-0123456789abcdef.response"]


def bytes_below(folder):
    """All files and links, by name; no link is followed."""
    return {os.path.relpath(os.path.join(at, name), folder):
            os.readlink(os.path.join(at, name)) if os.path.islink(os.path.join(at, name))
            else open(os.path.join(at, name), "rb").read()
            for at, folders, files in os.walk(folder)
            for name in files + [f for f in folders if os.path.islink(os.path.join(at, f))]}


def check_planted(work):
    """A first review in a folder of somebody else's, and one more: what was there stays byte for
    byte; folders that are links, pipes and devices are refused in one line."""
    report = work.report
    for name in MINE:
        work.put("theirs", name)
    os.symlink("night.checkpoint", work.path("theirs", "unfinished", "link"))
    before = bytes_below(work.path("theirs"))
    for times in range(2):
        said = work.review("theirs", ["speed"], worst=1)
        after = bytes_below(work.path("theirs"))
        changed = [name for name in before if after.get(name) != before[name]]
        report.claim(said == (0, "") and not changed, f"planted, {times}: {said} {changed}")
    for name in EMPTY:
        os.makedirs(work.path("empty", name))
    report.claim(work.review("empty", ["speed"]) == (0, "") and
                 set(EMPTY) <= set(os.listdir(work.path("empty"))), "an empty folder is gone")
    shutil.rmtree(work.path("theirs"))
    for name, files in LINKED.items():
        for file in files:
            work.put("other", name, file, text="PRHLCKPT" if "checkpoint" in file else "mine")
        os.makedirs(os.path.dirname(work.path("linked", name)), exist_ok=True)
        os.symlink(work.path("other", name), work.path("linked", name))
        before = bytes_below(work.path("other"))
        status, said = work.review("linked", ["speed"], worst=1)
        report.claim(status == 4 and said.count("\n") == 1 and f"linked/{name}: " in said and
                     bytes_below(work.path("other")) == before and
                     work.all_files("linked") == [] and os.path.islink(work.path("linked", name)),
                     f"{name} is a link: {status} {said!r} {bytes_below(work.path('linked'))}")
        shutil.rmtree(work.path("linked"))
        shutil.rmtree(work.path("other"))
    for name in PIPES:
        for is_link in (False, True):
            place = work.path("pipes", name)
            os.makedirs(os.path.dirname(place), exist_ok=True)
            os.mkfifo(work.path("pipe") if is_link else place)
            if is_link:
                os.symlink(work.path("pipe"), place)
            status, said = work.review("pipes", ["speed"], worst=1)
            report.claim(status == 4 and said.count("\n") == 1 and f"pipes/{name}: " in said,
                         f"{name} is a pipe, {is_link}: {status} {said!r}")
            shutil.rmtree(work.path("pipes"))
            if is_link:
                os.remove(work.path("pipe"))
    work.put("locked", "unfinished", "lock")
    status, said = work.review("locked", ["speed"])
    report.claim(status == 4 and "a lock is empty" in said and
                 work.text("locked", "unfinished", "lock") == "mine", f"a lock: {status} {said!r}")


def main():
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        work = Work(report, sys.argv[1], folder)
        check_links(work)
        check_foreign(work)
        check_without_list(work)
        check_in_the_way(work)
        check_planted(work)
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
