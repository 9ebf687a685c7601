# SPDX-License-Identifier: Apache-2.0
"""render_array.py [--keep DIR] [--only NAME] PARHELION -- a frame in parts by the script that
ships, assets/slurm/render.sbatch, in Debian's Slurm: twelve parts over three nodes, a task that
is requeued, one whose time is over, one that is killed, a node that dies in the middle of a
part, a task that runs twice, tasks of two instruction sets. The frame is that of one run, byte
for byte, or the status is 5. Skipped where slurm-wlm is not installed, or nobody is root.
"""
import argparse
import contextlib
import json
import os
import signal
import subprocess
import sys
import time

import cluster

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
for name in ("structure", "image"):
    sys.path.insert(0, os.path.join(ROOT, "tests", name))
from bits import write_scene  # noqa: E402
from report import Report  # noqa: E402

SCRIPT = os.path.join(ROOT, "assets", "slurm", "render.sbatch")
SMALL = ("--size", "64x48", "--layers", "all", "--spp", "24")
PART_S = 15  # of a part that something happens to
LOGS = "--output=%x.%a.log"


def shared_isa():
    """The script's, where this machine has it."""
    with contextlib.suppress(OSError), open("/proc/cpuinfo", encoding="utf-8") as file:
        return "avx2" if " avx2 " in file.read() else "sse2"
    return "sse2"


def contents(path):
    with open(path, "rb") as file:
        return file.read()


class Frames:
    """A user's folder with a scene, in which frames are rendered and shared."""

    def __init__(self, program, slurm, report):
        self.program, self.slurm, self.report = os.path.abspath(program), slurm, report
        self.folder, self.isa = os.path.join(slurm.folder, "a user's"), shared_isa()
        self.path_of = os.pathsep.join([os.path.dirname(self.program), os.environ["PATH"]])
        self.wholes = {}
        os.makedirs(self.folder)
        write_scene(self.path("small.gltf"))

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def render(self, *words):
        done = subprocess.run([self.program, "render", "--isa", self.isa, "small.gltf", *words],
                              capture_output=True, text=True, cwd=self.folder)
        self.report.claim(done.returncode == 0, f"one run: {done.stderr}")
        return done

    def whole(self, options):
        """The bytes of the frame of one run."""
        if options not in self.wholes:
            self.render("-o", "whole.exr", "--quiet", *options)
            self.wholes[options] = contents(self.path("whole.exr"))
        return self.wholes[options]

    def long(self, parts):
        """Options of a frame whose parts take PART_S each, as fast as this machine is now."""
        done = self.render("-o", "rate.exr", "--size", "96x64", "--spp", "64", "--json",
                           "--quiet")
        rate = 64 / max(json.loads(done.stdout)["seconds"], 0.01)
        samples = parts * max(64, int(PART_S * rate / parts))
        return "--size", "96x64", "--spp", str(samples)

    def submit(self, array, parts, frame, *options, isa=None):
        """The number of the job of these tasks; its logs are FRAME.K.log."""
        return self.slurm.submit(f"--array={array}", f"--job-name={frame}", LOGS, SCRIPT,
                                 str(parts), frame, "small.gltf", *options, cwd=self.folder,
                                 PATH=self.path_of, PARHELION_ISA=isa or self.isa)

    def submit_merge(self, job, parts, frame):
        """The number of the job that merges after it; its log is FRAME.merge.log."""
        return self.slurm.submit(f"--dependency=afterok:{job}", f"--output={frame}.merge.log",
                                 SCRIPT, str(parts), frame, cwd=self.folder, PATH=self.path_of)

    def share(self, parts, frame, *options):
        job = self.submit(f"1-{parts}", parts, frame, *options)
        return job, self.submit_merge(job, parts, frame)

    def checkpoint(self, frame, number):
        return self.path(f"{frame}.parts", f"{number}.exr.checkpoint")

    def wait_for_checkpoint(self, frame, number):
        self.report.claim(self.slurm.wait(lambda: os.path.exists(
            self.checkpoint(frame, number))), f"{frame}: no checkpoint of part {number}: "
            f"{self.log(frame, number)}")

    def log(self, frame, number):
        path = self.path(f"{frame}.{number}.log")
        return contents(path).decode() if os.path.exists(path) else f"no {path}"

    def claim(self, frame, options, what):
        """All has ended, and the frame is that of one run."""
        self.report.claim(self.slurm.wait(self.slurm.is_empty), f"{what}: does not end")
        path = self.path(frame)
        if self.report.claim(os.path.exists(path),
                             f"{what}: no frame: {self.log(frame, 'merge')}"):
            self.report.claim(contents(path) == self.whole(options),
                              f"{what}: not the bytes of one run")
        left = [name for name in os.listdir(f"{path}.parts") if not name.endswith(".exr")]
        self.report.claim(not left, f"{what}: left: {left}")

    def claim_went_on(self, job, frame, what):
        """Its first task came back and went on from its checkpoint."""
        task, log = self.slurm.tasks(job)["1"], self.log(frame, 1)
        self.report.claim((task["Restarts"], task["JobState"]) == ("1", "COMPLETED")
                          and "goes on after" in log, f"{what}: {task} {log}")


def check_array(frames):
    job, merge = frames.share(12, "twelve.exr", *SMALL)
    frames.claim("twelve.exr", SMALL, "twelve parts")
    tasks = frames.slurm.tasks(job)
    frames.report.claim(len(tasks) == 12 and all(task["JobState"] == "COMPLETED"
                                                 for task in tasks.values()), f"{tasks}")
    frames.report.claim({task["NodeList"] for task in tasks.values()} == set(cluster.NODES),
                        f"nodes: {[task['NodeList'] for task in tasks.values()]}")
    frames.report.claim(frames.slurm.tasks(merge)["0"]["JobState"] == "COMPLETED", "the merge")


def check_requeued(frames):
    options = frames.long(2)
    job, _ = frames.share(2, "requeued.exr", *options, "--checkpoint-interval", "0")
    frames.wait_for_checkpoint("requeued.exr", 1)
    frames.slurm.ask("scontrol", "requeue", f"{job}_1")
    frames.claim("requeued.exr", options, "a task that is requeued")
    frames.claim_went_on(job, "requeued.exr", "a task that is requeued")


def check_over(frames):
    """What --signal=B:USR1@60 does, by hand."""
    options = frames.long(2)
    job, _ = frames.share(2, "over.exr", *options, "--checkpoint-interval", "0")
    frames.wait_for_checkpoint("over.exr", 1)
    frames.slurm.ask("scancel", "--batch", "--signal=USR1", f"{job}_1")
    frames.claim("over.exr", options, "a task whose time is over")
    frames.claim_went_on(job, "over.exr", "a task whose time is over")
    frames.report.claim("stopped by TERM" in frames.log("over.exr", 1), "no stop by TERM")


def renders_of(number):
    """The processes that render this part."""
    for pid in map(int, filter(str.isdigit, os.listdir("/proc"))):
        words = cluster.read_proc(pid, "cmdline").split(b"\0")
        if b"render" in words and any(word.startswith(b"%d/" % number) for word in words):
            yield pid


def check_killed(frames):
    """By kill -9: the task fails, nothing is merged, and the same task goes on."""
    options = frames.long(2)
    job, merge = frames.share(2, "killed.exr", *options, "--checkpoint-interval", "0")
    frames.wait_for_checkpoint("killed.exr", 1)
    for pid in renders_of(1):
        os.kill(pid, signal.SIGKILL)
    frames.report.claim(frames.slurm.wait(lambda: frames.slurm.ids() == [merge]),
                        f"a task that is killed: {frames.slurm.ids()}")
    task = frames.slurm.tasks(job)["1"]
    frames.report.claim((task["JobState"], task["ExitCode"]) == ("FAILED", "137:0"),
                        f"a task that is killed: {task}")
    frames.slurm.ask("scancel", merge)
    again = frames.submit("1", 2, "killed.exr", *options)
    frames.submit_merge(again, 2, "killed.exr")
    frames.claim("killed.exr", options, "a task that was killed")
    frames.report.claim("goes on after" in frames.log("killed.exr", 1), "it began anew")


def check_dead(frames):
    """A node dies in the middle of a part: another goes on from the part's checkpoint."""
    options = frames.long(3)
    job, _ = frames.share(3, "dead.exr", *options, "--checkpoint-interval", "0")
    frames.wait_for_checkpoint("dead.exr", 1)
    node = frames.slurm.tasks(job)["1"]["NodeList"]
    frames.slurm.kill_node(node)
    frames.claim("dead.exr", options, "a node that died")
    frames.claim_went_on(job, "dead.exr", "a node that died")
    frames.report.claim(frames.slurm.tasks(job)["1"]["NodeList"] != node, "the dead node works")
    frames.slurm.start_node(node)
    frames.report.claim(frames.slurm.wait(frames.slurm.is_idle, 60), f"{node} stays away")


def check_twice(frames):
    """A task runs on two nodes at once, and a third time when it is done."""
    options = frames.long(2)
    job, _ = frames.share(2, "twice.exr", *options)
    twin = frames.submit("1", 2, "twice.exr", *options)
    frames.claim("twice.exr", options, "a task twice at once")
    part = contents(frames.path("twice.exr.parts", "1.exr"))
    states = [frames.slurm.tasks(one)["1"]["JobState"] for one in (job, twin)]
    frames.report.claim(states == ["COMPLETED"] * 2, f"twice at once: {states}")
    again = frames.submit("1", 2, "twice.exr", *options)
    frames.submit_merge(again, 2, "twice.exr")
    frames.claim("twice.exr", options, "a task again")
    frames.report.claim(contents(frames.path("twice.exr.parts", "1.exr")) == part,
                        "a part made again: other bytes")


def claim_status(frames, job, task, status, log, word):
    facts = frames.slurm.tasks(job)[task]
    frames.report.claim(facts["ExitCode"] == f"{status}:0" and word in log,
                        f"required: status {status} and {word!r}: {facts} {log}")


def check_mixed(frames):
    """A part of another instruction set: status 5 at the merge, and where it goes on."""
    options = frames.long(2)
    frames.submit("1", 2, "mixed.exr", *options)
    other = frames.submit("2", 2, "mixed.exr", *options, isa="sse2")
    merge = frames.submit_merge(other, 2, "mixed.exr")
    frames.report.claim(frames.slurm.wait(frames.slurm.is_empty), "mixed: does not end")
    claim_status(frames, merge, "0", 5, frames.log("mixed.exr", "merge"),
                 f"isa: {frames.isa} there, sse2 here")
    begun = frames.submit("2", 2, "mixed.exr", *options, "--checkpoint-interval", "0")
    frames.wait_for_checkpoint("mixed.exr", 2)
    for pid in renders_of(2):
        os.kill(pid, signal.SIGKILL)
    frames.report.claim(frames.slurm.wait(frames.slurm.is_empty), f"{begun} does not end")
    other = frames.submit("2", 2, "mixed.exr", *options, isa="sse2")
    frames.report.claim(frames.slurm.wait(frames.slurm.is_empty), f"{other} does not end")
    claim_status(frames, other, "2", 5, frames.log("mixed.exr", 2),
                 f"isa: {frames.isa} there, sse2 here")
    last = frames.submit("2", 2, "mixed.exr", *options)
    frames.submit_merge(last, 2, "mixed.exr")
    frames.claim("mixed.exr", options, "all by one instruction set")


def main():
    report = Report()
    parser = argparse.ArgumentParser()
    parser.add_argument("--keep", help="the folder of the daemons and frames, which is kept")
    parser.add_argument("--only", default="", help="cases of which the name has this")
    parser.add_argument("program")
    arguments = parser.parse_args()
    checks = [check_array, check_requeued, check_over, check_killed, check_dead, check_twice]
    with cluster.started(report, arguments.keep) as slurm:
        frames = Frames(arguments.program, slurm, report)
        if frames.isa != "sse2":
            checks.append(check_mixed)
        for check in checks:
            if arguments.only in check.__name__:
                begun = time.time()
                check(frames)
                print(f"{check.__name__}: {time.time() - begun:.0f} s", flush=True)
    report.finish()


if __name__ == "__main__":
    main()
