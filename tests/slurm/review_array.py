# SPDX-License-Identifier: Apache-2.0
"""review_array.py [--keep DIR] [--only NAME] PARHELION -- a review by the script that ships,
assets/slurm/review.sbatch, in Debian's Slurm: a task a condition over three nodes, one that is
requeued, one that is killed, a node that dies in the middle of a condition, a task that runs
again, tasks of two instruction sets. The review is that of one run, byte for byte, or the status
is 5. Skipped where slurm-wlm is not installed, or nobody is root.
"""
import argparse
import json
import os
import shutil
import signal
import subprocess
import sys
import time

import cluster
from render_array import ROOT, shared_isa

for name in ("hostile", "image"):
    sys.path.insert(0, os.path.join(ROOT, "tests", name))
from report import Report  # noqa: E402
from review import PANEL, moment, request  # noqa: E402
from review_resume import cabin, files_of, sweep  # noqa: E402

SCRIPT = os.path.join(ROOT, "assets", "slurm", "review.sbatch")
NAMES = ("grey", "low sun", "dim")
LOGS = "--output=%x.%a.log"


def reviews_of(number):
    """Processes of the task that reviews that condition."""
    found = []
    for pid in filter(str.isdigit, os.listdir("/proc")):
        words = cluster.read_proc(int(pid), "cmdline").split(b"\0")
        if b"review" in words[:2] and b"--only" in words and \
                any(word.endswith(f".parts/{number}".encode()) for word in words):
            found.append(int(pid))
    return found


class Reviews:
    """A user's folder with a request, which is reviewed and shared."""

    def __init__(self, program, slurm, report):
        self.program, self.slurm, self.report = os.path.abspath(program), slurm, report
        self.folder, self.isa = os.path.join(slurm.folder, "a user's"), shared_isa()
        self.path_of = os.pathsep.join([os.path.dirname(self.program), os.environ["PATH"]])
        os.makedirs(self.folder)
        shutil.copy(PANEL, self.path("ips.panel"))
        cabin().write(self.path("dash.gltf"))
        with open(self.path("r.json"), "w", encoding="utf-8") as file:
            json.dump(request(precision={"contrast": 0.02},
                              frames={"size": [48, 27], "noise": 0.1, "worst": 1},
                              variants={"dimmer": {"brightness": {"*": 0.5}}},
                              conditions=[moment("grey", type="constant", luminance=3000),
                                          sweep("low sun"),
                                          moment("dim", type="constant", luminance=300)]), file)
        self.whole = self.one_run()

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def one_run(self):
        done = subprocess.run([self.program, "review", "r.json", "--isa", self.isa, "-o", "out",
                               "--quiet"], capture_output=True, text=True, cwd=self.folder)
        self.report.claim(done.returncode in (0, 1), f"one run: {done.stderr}")
        files = files_of(self.path("out"))
        self.clear()
        return files

    def clear(self):
        for name in ("out", "out.parts"):
            shutil.rmtree(self.path(name), ignore_errors=True)

    def submit(self, array, *options, isa=None):
        """The number of the job of these tasks; its logs are NAME.K.log."""
        return self.slurm.submit(f"--array={array}", "--job-name=out", LOGS, SCRIPT, "out",
                                 "r.json", *NAMES, *options, cwd=self.folder, PATH=self.path_of,
                                 PARHELION_ISA=isa or self.isa)

    def submit_merge(self, job):
        return self.slurm.submit(f"--dependency=afterok:{job}", "--output=merge.log", SCRIPT,
                                 "out", cwd=self.folder, PATH=self.path_of)

    def share(self):
        self.clear()
        job = self.submit(f"1-{len(NAMES)}")
        return job, self.submit_merge(job)

    def log(self, name):
        if not os.path.exists(self.path(f"{name}.log")):
            return f"no {name}.log"
        with open(self.path(f"{name}.log"), encoding="utf-8") as file:
            return file.read()

    def wait_for_work(self, number):
        """Until the condition is in hand."""
        self.report.claim(self.slurm.wait(lambda: reviews_of(number) and os.path.exists(
            self.path("out.parts", str(number), "unfinished", "lock"))),
            f"task {number} does not begin: {self.log(f'out.{number}')}")

    def claim(self, what):
        """All has ended, and the review is that of one run."""
        self.report.claim(self.slurm.wait(self.slurm.is_empty), f"{what}: does not end")
        found = files_of(self.path("out")) if os.path.exists(self.path("out")) else {}
        other = sorted(name for name in self.whole.keys() | found.keys()
                       if self.whole.get(name) != found.get(name))
        self.report.claim(not other, f"{what}: not one run's: {other} {self.log('merge')}")


def check_array(reviews):
    job, merge = reviews.share()
    reviews.claim("a task a condition")
    states = [task["JobState"] for task in reviews.slurm.tasks(job).values()]
    reviews.report.claim(states == ["COMPLETED"] * len(NAMES), f"{states}")
    part = os.path.join("out.parts", "2", "conditions", "2-low-sun.condition")
    with open(reviews.path(part), "rb") as file:
        before = file.read()
    again = reviews.submit("2")
    reviews.submit_merge(again)
    reviews.claim("a task again")
    with open(reviews.path(part), "rb") as file:
        reviews.report.claim(file.read() == before, "a part made again: other bytes")
    reviews.report.claim(reviews.slurm.tasks(merge)["0"]["ExitCode"] in ("0:0", "1:0"),
                         "the merge")


def check_requeued(reviews):
    job, _ = reviews.share()
    reviews.wait_for_work(2)
    reviews.slurm.ask("scontrol", "requeue", f"{job}_2")
    reviews.claim("a task that is requeued")
    task = reviews.slurm.tasks(job)["2"]
    reviews.report.claim((task["Restarts"], task["JobState"]) == ("1", "COMPLETED"), f"{task}")


def check_killed(reviews):
    """By kill -9: the task fails, nothing is merged, and the same task is done again."""
    job, merge = reviews.share()
    reviews.wait_for_work(2)
    for pid in reviews_of(2):
        os.kill(pid, signal.SIGKILL)
    reviews.report.claim(reviews.slurm.wait(lambda: reviews.slurm.ids() == [merge]),
                         f"a task that is killed: {reviews.slurm.ids()}")
    task = reviews.slurm.tasks(job)["2"]
    reviews.report.claim((task["JobState"], task["ExitCode"]) == ("FAILED", "137:0"), f"{task}")
    reviews.slurm.ask("scancel", merge)
    reviews.submit_merge(reviews.submit("2"))
    reviews.claim("a task that was killed")


def check_dead(reviews):
    """A node dies in the middle of a condition: another does it."""
    job, _ = reviews.share()
    reviews.wait_for_work(2)
    node = reviews.slurm.tasks(job)["2"]["NodeList"]
    reviews.slurm.kill_node(node)
    reviews.claim("a node that died")
    reviews.report.claim(reviews.slurm.tasks(job)["2"]["NodeList"] != node, "the dead node works")
    reviews.slurm.start_node(node)
    reviews.report.claim(reviews.slurm.wait(reviews.slurm.is_idle, 60), f"{node} stays away")


def check_mixed(reviews):
    """A part of another instruction set: the merge ends with status 5."""
    reviews.clear()
    reviews.submit("1,3")
    merge = reviews.submit_merge(reviews.submit("2", isa="sse2"))
    reviews.report.claim(reviews.slurm.wait(reviews.slurm.is_empty), "mixed: does not end")
    facts = reviews.slurm.tasks(merge)["0"]
    reviews.report.claim(facts["ExitCode"] == "5:0" and "was made with" in reviews.log("merge")
                         and not os.path.exists(reviews.path("out")),
                         f"{facts} {reviews.log('merge')}")
    reviews.submit_merge(reviews.submit("2"))
    reviews.claim("all by one instruction set")


def main():
    report = Report()
    parser = argparse.ArgumentParser()
    parser.add_argument("--keep", help="the folder of the daemons and reviews, which is kept")
    parser.add_argument("--only", default="", help="cases of which the name has this")
    parser.add_argument("program")
    arguments = parser.parse_args()
    checks = [check_array, check_requeued, check_killed, check_dead]
    with cluster.started(report, arguments.keep) as slurm:
        reviews = Reviews(arguments.program, slurm, report)
        if reviews.isa != "sse2":
            checks.append(check_mixed)
        for check in checks:
            if arguments.only in check.__name__:
                begun = time.time()
                check(reviews)
                print(f"{check.__name__}: {time.time() - begun:.0f} s", flush=True)
    report.finish()


if __name__ == "__main__":
    main()
