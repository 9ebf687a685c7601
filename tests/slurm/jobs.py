# SPDX-License-Identifier: Apache-2.0
"""jobs.py -- what the tests of shared frames have in common: a small scene, the frame of one
run, jobs of it and their parts.
"""
import contextlib
import json
import os
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
for folder in ("structure", "image"):
    sys.path.insert(0, os.path.join(ROOT, "tests", folder))
from bits import write_scene  # noqa: E402
from report import Report  # noqa: E402, F401

PATIENCE_S = 300


def shared_isa():
    """What a job takes unless told, as an option: frames of one run take it too, then."""
    with contextlib.suppress(OSError), open("/proc/cpuinfo", encoding="utf-8") as file:
        if " avx2 " in file.read():
            return "--isa", "avx2"
    return ()


ISA = shared_isa()


def contents(path):
    with open(path, "rb") as file:
        return file.read()


class Work:
    """A folder with a scene, in which frames are rendered and shared."""

    def __init__(self, program, folder, report):
        self.program, self.folder, self.report = os.path.abspath(program), folder, report
        self.wholes = {}
        write_scene(self.path("small.gltf"))

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def run(self, *words, cwd=None, **environment):
        return subprocess.run([self.program, *words], capture_output=True, text=True,
                              cwd=cwd or self.folder, env={**os.environ, **environment},
                              timeout=PATIENCE_S)

    def start(self, *words):
        return subprocess.Popen([self.program, *words], stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, text=True, cwd=self.folder)

    def whole(self, *options):
        """The bytes of the frame of one run."""
        if options not in self.wholes:
            done = self.run("render", "small.gltf", "-o", "whole.exr", "--quiet", *options)
            self.report.claim(done.returncode == 0, f"one run: {done.stderr}")
            self.wholes[options] = contents(self.path("whole.exr"))
        return self.wholes[options]

    def share(self, count, *options, job="job", output="frame.exr", **environment):
        """A job's folder, by --slurm."""
        done = self.run("render", "small.gltf", "-o", output, "--slurm", str(count), "--job",
                        job, *options, **environment)
        self.report.claim(done.returncode == 0, f"--slurm {count} {options}: {done.stderr}")
        return job

    def status(self, job):
        """(exit status, its document)"""
        done = self.run("status", job, "--json")
        return done.returncode, json.loads(done.stdout)

    def states(self, job):
        return [part["state"] for part in self.status(job)[1]["list"]]

    def merge(self, job, output="frame.exr"):
        """The bytes of the merged frame; None with a failed claim."""
        done = self.run("merge", job, "--quiet")
        if self.report.claim(done.returncode == 0, f"merge {job}: {done.stderr}"):
            return contents(self.path(output))
        return None

    def claim_whole(self, job, options, what, output="frame.exr"):
        self.report.claim(self.merge(job, output) == self.whole(*options),
                          f"{what}: not the bytes of one run")

    def claim_line(self, done, status, *words):
        """It ended so, with one line that says this."""
        line = done.stderr.strip()
        self.report.claim(done.returncode == status and "\n" not in line and
                          all(word in line for word in words),
                          f"{done.args[1:]}: status {done.returncode}, required: {status} and "
                          f"{words}: {line!r}")
