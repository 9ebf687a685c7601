# SPDX-License-Identifier: Apache-2.0
"""review_watch.py [--all] PARHELION -- a review that watches its files: whatever is saved, what
stands there then is what a fresh review of the same files says, byte for byte; a file that is
broken for the moment is told of and changes nothing; Ctrl-C ends it, and nothing is left over.
--all: a long one, too, which shows what it knows after a minute, marked so that nobody takes it
for the whole (two minutes).
"""
import argparse
import json
import os
import queue
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
sys.path.insert(0, os.path.join(ROOT, "tests", "image"))
from report import Report  # noqa: E402
from review import dashboard, moment, request  # noqa: E402
from review_resume import PATIENCE_S, Work, cabin, document, files_of  # noqa: E402

WATCHED = "are watched:"


class Watching:
    """parhelion review --watch, line by line."""

    def __init__(self, work):
        self.work = work
        self.process = subprocess.Popen(
            [work.program, "review", "r.json", "-o", "out", "--watch", "--quiet"],
            cwd=work.folder, text=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        self.lines = queue.Queue()
        threading.Thread(target=self.read, daemon=True).start()

    def read(self):
        for line in self.process.stderr:
            self.lines.put(line.rstrip("\n"))

    def until_watching(self):
        """The lines up to the one that says that files are watched."""
        told, end = [], time.monotonic() + PATIENCE_S
        while not told or WATCHED not in told[-1]:
            try:
                told.append(self.lines.get(timeout=max(end - time.monotonic(), 0.1)))
            except queue.Empty:
                break
        self.work.report.claim(bool(told) and WATCHED in told[-1], f"no longer watched: {told}")
        return told[:-1]

    def end(self):
        self.process.send_signal(signal.SIGINT)
        status = self.process.wait(PATIENCE_S)
        self.work.report.claim(status == 0, f"ended by Ctrl-C: status {status}")


def claim_as_fresh(work, what):
    """The same files as a review that knows nothing of what was before."""
    found = {name: data for name, data in work.files().items()
             if not name.startswith("unfinished")}
    fresh = subprocess.run([work.program, "review", "r.json", "-o", "fresh", "--quiet"],
                           cwd=work.folder, capture_output=True, text=True, timeout=PATIENCE_S)
    work.report.claim(fresh.returncode in (0, 1), f"{what}: fresh: {fresh.stderr}")
    wanted = files_of(work.path("fresh"))
    shutil.rmtree(work.path("fresh"))
    told = {name for name in wanted if not name.startswith("responses")}
    more = {name for name in found if not name.startswith("responses")} - told
    work.report.claim(not more, f"{what}: files that a fresh review has not: {more}")
    for name in sorted(told):
        same = found.get(name) == wanted[name].replace(b" -o fresh", b" -o out")
        work.report.claim(same, f"{what}: {name} is other than that of a fresh review")


def save(work, what):
    with open(work.path("r.json"), "w", encoding="utf-8") as file:
        file.write(what if isinstance(what, str) else json.dumps(what))


def check_saved(work, watching, what, name):
    save(work, what)
    told = watching.until_watching()
    work.report.claim(len(told) == 1 and "was saved" in told[0] and "r.json" in told[0],
                      f"{name}: {told}")
    claim_as_fresh(work, name)


def check_broken(work, watching):
    before = work.files()["review.json"]
    save(work, '{"scene": [')
    told = watching.until_watching()
    work.report.claim(len(told) == 2 and "r.json" in told[1] and "not valid JSON" in told[1],
                      f"broken: {told}")
    work.report.claim(work.files()["review.json"] == before, "broken: the review is another")


def check_scene(work, watching):
    scene = cabin()
    scene.quad(scene.lambert(0.2), [-0.6, -0.3, 1.25], [1.2, 0, 0], [0, 0.1, 0])
    scene.write(work.path("dash.gltf"))
    told = watching.until_watching()
    work.report.claim(any("dash.gltf was saved" in line for line in told), f"scene: {told}")
    claim_as_fresh(work, "another scene")


def check_words(work):
    for words, part in ((("--dry-run", "-o", "out"), "--dry-run"),
                        (("--init", "x.review.json"), "--init")):
        done = subprocess.run([work.program, "review", "r.json", "--watch", *words],
                              cwd=work.folder, capture_output=True, text=True,
                              timeout=PATIENCE_S)
        work.report.claim(done.returncode == 2 and done.stderr.count("\n") == 1 and
                          f"--watch does not go with {part}" in done.stderr,
                          f"{words}: {done.stderr}")


def check_watched(work):
    what = document("suns")
    save(work, what)
    watching = Watching(work)
    work.report.claim(watching.until_watching() == [], "told something at first")
    claim_as_fresh(work, "at first")
    what["precision"]["contrast"] = 0.03
    check_saved(work, watching, what, "another precision")
    what["conditions"][0]["environment"]["luminance"] = 1000
    what["title"] = "brighter"
    check_saved(work, watching, what, "another light")
    check_broken(work, watching)
    what["symbols"] = dict(reversed(list(what["symbols"].items())))
    what["eyes"]["other"] = {"position_m": [0.05, 0.15, 0.8]}
    check_saved(work, watching, what, "one eye more")
    check_scene(work, watching)
    watching.end()
    left = [name for name in work.files() if name.startswith("unfinished")]
    work.report.claim(not left, f"left behind: {left}")


# ---- what is known after a minute --------------------------------------------------------

def long_request():
    """Three moments of half a minute each, whatever the machine: paths are many."""
    greys = [moment(f"grey {i}", type="constant", luminance=1000 * (i + 1)) for i in range(4)]
    return request(precision={"contrast": 1e-6, "clear": 1e-6, "paths": 1 << 23},
                   frames={"worst": 0}, conditions=greys)


def wait_for_some(work, running):
    path = work.path("out", "review.json")
    end = time.monotonic() + PATIENCE_S
    while time.monotonic() < end and running.poll() is None:
        if os.path.exists(path):
            return json.loads(work.files()["review.json"])
        time.sleep(0.2)
    return None


def check_so_far(work):
    dashboard().write(work.path("dash.gltf"))
    work.clear()
    save(work, long_request())
    begun = time.monotonic()
    running = work.start()
    some = wait_for_some(work, running)
    if not work.report.claim(some is not None, "nothing is known before the end"):
        return
    took = time.monotonic() - begun
    work.report.claim(took < 110, f"a first page after {took:.0f} s")
    work.report.claim(some.get("provisional") is True and some["pass"] is False and
                      some["verdict"] in ("fail", "provisional") and
                      "of 4 conditions" in some["to_come"], f"says {some.get('to_come')}")
    work.report.claim(0 < len({c["condition"] for c in some["cases"]}) < 4, "whole already")
    page = work.files()["index.html"].decode()
    work.report.claim('class="provisional"' in page and 'http-equiv="refresh"' in page,
                      "a page that does not say so")
    work.report.claim("cases.csv" not in work.files() and "junit.xml" not in work.files(),
                      "tables that do not say so")
    running.send_signal(signal.SIGTERM)
    running.communicate(timeout=PATIENCE_S)
    refused = work.run("--diff", "out")
    work.report.claim(refused.returncode == 3 and "was not finished" in refused.stderr,
                      f"held against half a review: {refused.stderr}")
    what = long_request()
    what["precision"] = {"contrast": 0.05}
    save(work, what)
    work.run()
    page = work.files()["index.html"].decode()
    whole = json.loads(work.files()["review.json"])
    work.report.claim("provisional" not in whole and "to_come" not in whole and
                      'class="provisional"' not in page and "refresh" not in page and
                      "cases.csv" in work.files(), "the whole says that it is not")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--all", action="store_true")
    parser.add_argument("parhelion")
    words = parser.parse_args()
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        work = Work(report, words.parhelion, folder)
        check_words(work)
        check_watched(work)
        if words.all:
            check_so_far(work)
    report.finish()


if __name__ == "__main__":
    main()
