# SPDX-License-Identifier: Apache-2.0
"""run.py [--seconds N | --runs N] [--targets A,B] [--jobs N] BUILD_DIR -- fuzzes every target.
run.py --record BUILD_DIR -- adds what was counted there to runs.csv, beside this file.

BUILD_DIR is that of the preset "fuzz". The time (five minutes) is shared among the targets, two
at a time; --runs: so many executions of each instead. What is learned stays in
BUILD_DIR/fuzzing/corpus, an input that breaks something in BUILD_DIR/fuzzing/found/TARGET: it
belongs into tests/fuzz/found/TARGET, with what was wrong put right.

The count goes on from call to call (BUILD_DIR/fuzzing/runs.csv) towards GOAL runs in all; the
targets with the fewest of them come first and get twice the time.
"""
import argparse
import concurrent.futures
import csv
import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
SHARED = os.path.join(os.path.dirname(ROOT), "shared", "data")
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

RECORD, GOAL = os.path.join(HERE, "runs.csv"), 10**8
# Of a process, of one allocation, of one input (others may use the machine too).
MEMORY_MB, BLOCK_MB, INPUT_S = 2560, 256, 20
# Other people's files that are seeds of a target, where they are small enough.
FOREIGN = {
    "gltf": ("gltf/**/*.gltf",), "glb": ("gltf/**/*.glb",), "exr": ("exr/**/*.exr",),
    "image": ("gltf/**/*.png", "gltf/**/*.jpg", "hdri/**/*.hdr"), "png": ("gltf/**/*.png",),
    "import-ies": ("photometry/*.ies",), "import-eulumdat": ("photometry/*.ldt",),
    "import-text": ("display/*.csv", "panels/**/*.csv"), "weather": ("weather/**/*.epw",),
    "import-speos": ("bsdf/speos/**/*",),
    "import-any": ("bsdf/**/*", "photometry/*"),
}


def targets_of(program):
    """(name, largest input) of every target."""
    listed = subprocess.run([program], capture_output=True, text=True, check=True).stdout
    return [(line.split()[0], int(line.split()[1])) for line in listed.splitlines()]


def more_seeds(program, name, most, folder):
    """What the target makes itself, and copies of the shared data's small files for it."""
    seeds = os.path.join(folder, "seeds", name)
    os.makedirs(seeds)
    subprocess.run([program, f"--target={name}", f"--make={seeds}"], check=True)
    for pattern in FOREIGN.get(name, ()):
        for path in glob.glob(os.path.join(SHARED, pattern), recursive=True):
            if os.path.isfile(path) and os.path.getsize(path) <= most:
                shutil.copy(path, os.path.join(seeds, f"{len(os.listdir(seeds))}"))
    return seeds


def counts_of(path):
    """{target: [runs, processor seconds]}, empty without the file."""
    if not os.path.exists(path):
        return {}
    with open(path, newline="", encoding="utf-8") as file:
        return {row["target"]: [int(row["runs"]), float(row["processor_s"])]
                for row in csv.DictReader(file)}


def add_counts(to, more):
    for name, (runs, seconds) in more.items():
        before = to.get(name, [0, 0.0])
        to[name] = [before[0] + runs, before[1] + seconds]
    return to


def write_counts(path, counts):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(("target", "runs", "processor_s"))
        rows.writerows((name, runs, round(seconds)) for name, (runs, seconds)
                       in sorted(counts.items()))


def record(build):
    """The committed table gets what this build has counted."""
    own = os.path.join(build, "fuzzing", "runs.csv")
    write_counts(RECORD, add_counts(counts_of(RECORD), counts_of(own)))
    write_counts(own, {})


def number(pattern, text, default=0):
    found = re.findall(pattern, text)
    return int(found[-1]) if found else default


class Outcome:
    """What one target's run came to, from libFuzzer's own words."""

    def __init__(self, name, text, status, used):
        self.name, self.text, self.status = name, text, status
        self.processor_s = used.ru_utime + used.ru_stime
        self.runs = number(r"number_of_executed_units: *(\d+)", text) or \
            number(r"^#(\d+)", text)
        edges = [int(value) for value in re.findall(r"cov: (\d+)", text)]
        self.edges_before, self.edges = (edges[0], edges[-1]) if edges else (0, 0)

    def line(self):
        rate = self.runs / self.processor_s if self.processor_s else 0
        return (f"{self.name:18} {self.runs:9} runs {rate:8.0f} a processor second "
                f"{self.edges_before:5} -> {self.edges:5} edges")

    def why(self):
        """The first line that says what is wrong."""
        for mark in ("claim failed", "runtime error", "ERROR: ", "SUMMARY", "parhelion:"):
            for line in self.text.splitlines():
                if mark in line:
                    return line.strip()[:200]
        return f"ended with {self.status}"


class Fuzzing:
    def __init__(self, options):
        self.program = os.path.abspath(os.path.join(options.build, "fuzz"))
        self.kept = os.path.abspath(os.path.join(options.build, "fuzzing"))
        self.options = options
        wanted = options.targets.split(",") if options.targets else None
        self.targets = [(name, most) for name, most in targets_of(self.program)
                        if not wanted or name in wanted]
        self.counts = os.path.join(self.kept, "runs.csv")
        known = add_counts(counts_of(RECORD), counts_of(self.counts))
        self.targets.sort(key=lambda target: known.get(target[0], [0])[0])
        self.rare = {name for name, _ in self.targets[:len(self.targets) // 2]}

    def limits(self, name):
        if self.options.runs:
            return [f"-runs={self.options.runs}"]
        parts = len(self.targets) + len(self.rare)
        share = self.options.seconds * self.options.jobs / parts * (1 + (name in self.rare))
        return [f"-max_total_time={max(2, round(share))}"]

    def command(self, name, most, folder):
        corpus = os.path.join(self.kept, "corpus", name)
        found = os.path.join(self.kept, "found", name, "")
        os.makedirs(corpus, exist_ok=True)
        os.makedirs(found, exist_ok=True)
        own = [os.path.join(HERE, kind, name) for kind in ("corpus", "found")]
        words = os.path.join(HERE, "words", f"{name}.dict")
        return [self.program, f"--target={name}", *self.limits(name), f"-max_len={most}",
                f"-timeout={INPUT_S}", f"-report_slow_units={INPUT_S}",
                f"-rss_limit_mb={MEMORY_MB}", f"-malloc_limit_mb={BLOCK_MB}",
                "-detect_leaks=0",  # is done once, at the end: a look after every run is slow
                "-print_final_stats=1", "-reload=0", f"-artifact_prefix={found}",
                *([f"-dict={words}"] if os.path.exists(words) else []), corpus,
                *[path for path in own if os.path.isdir(path)],
                more_seeds(self.program, name, most, folder)]

    def take_one_processor(self):
        """Libraries that code with as many threads as there are processors use none then."""
        processors = sorted(os.sched_getaffinity(0))
        os.sched_setaffinity(0, {processors[os.getpid() % len(processors)]})

    def run(self, name, most, folder):
        files = os.path.join(folder, name)
        os.makedirs(files)
        log = os.path.join(self.kept, f"{name}.log")
        environment = dict(os.environ, TMPDIR=files, UBSAN_OPTIONS="print_stacktrace=1")
        command = self.command(name, most, folder)
        with open(log, "wb") as file:
            process = subprocess.Popen(command, stdout=file, stderr=file, env=environment,
                                       preexec_fn=self.take_one_processor)
            _, status, used = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
        shutil.rmtree(files, ignore_errors=True)
        with open(log, encoding="utf-8", errors="replace") as file:
            return Outcome(name, file.read(), process.returncode, used)

    def run_all(self, report):
        base = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
        counts = {}
        with tempfile.TemporaryDirectory(dir=base) as folder, \
                concurrent.futures.ThreadPoolExecutor(self.options.jobs) as pool:
            waiting = [pool.submit(self.run, name, most, folder) for name, most in self.targets]
            for one in concurrent.futures.as_completed(waiting):
                outcome = one.result()
                print(outcome.line(), flush=True)
                report.claim(outcome.status == 0, f"{outcome.name}: {outcome.why()}; the input "
                             f"is in {os.path.join(self.kept, 'found', outcome.name)}")
                counts[outcome.name] = [outcome.runs, outcome.processor_s]
        write_counts(self.counts, add_counts(counts_of(self.counts), counts))
        known = add_counts(counts_of(RECORD), counts_of(self.counts))
        print(f"{sum(runs for runs, _ in counts.values())} executions in "
              f"{sum(used for _, used in counts.values()):.0f} processor seconds; "
              f"{sum(runs for runs, _ in known.values())} of {GOAL} in all")


def parse():
    options = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    options.add_argument("--seconds", type=float, default=300)
    options.add_argument("--runs", type=int, default=0)
    options.add_argument("--targets", default="")
    options.add_argument("--jobs", type=int, default=2)
    options.add_argument("--record", action="store_true")
    options.add_argument("build")
    return options.parse_args()


def main():
    report, options = Report(), parse()
    if options.record:
        return record(options.build)
    Fuzzing(options).run_all(report)
    return report.finish()


if __name__ == "__main__":
    sys.exit(main())
