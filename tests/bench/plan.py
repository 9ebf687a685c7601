# SPDX-License-Identifier: Apache-2.0
"""plan.py [--parts N] [--samples N] [--runs N] [--keep FILE.json] [--from FILE.json] PARHELION
-- what a frame costs that a cluster shares: a part's start, samples, merge and file traffic as
measured here; one, two and three nodes of Debian's Slurm on this machine beside the schedule
that is simulated (tests/slurm/schedule.py); and what that says of 10, 100 and 1,000 nodes, with
slow nodes and dead ones, for a large frame and for a fleet's year of reviews.

Wants root and slurm-wlm, as tests/slurm/cluster.py, and a machine with nothing else to do.
--keep: what was measured, as JSON. --from: no measuring; the tables of such a file.
"""
import argparse
import dataclasses
import json
import math
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path[:0] = [os.path.join(ROOT, "tests", name) for name in ("slurm", "structure")]
from cluster import NODES, Cluster  # noqa: E402
from schedule import Job, Nodes, Trouble, simulate  # noqa: E402

SCENES = os.path.join(ROOT, "scenes")
SCENE = [os.path.join(SCENES, name) for name in ("car_dashboard.gltf", "noon.gltf")]
SIZE = (320, 180)
PROBES, PROBES_S = 6, (0, 2, 3.5, 5, 7)  # tasks that wait: when does Slurm begin the next one?
TICK_S = 1.0  # so it does at whole seconds; of tasks below 3 s at every third
CORES = os.cpu_count()

# ---- what is assumed of a cluster, and not measured ------------------------------------------

NODE_CORES = 16        # of a node
NODE_WORK = 0.9        # of their work, by 16 threads of one task
FILES_B_S = 1e9        # all nodes together, from and to the folder that they share
LAUNCHES_S = 20.0      # tasks that the scheduler starts in a second
TROUBLE = Trouble(spread=0.05, slow_share=0.01, slow_factor=3, deaths=1 / (30 * 86400),
                  repair=3600, requeue=120, kept_every=60)
FRAME = (3840, 2160, 1024)  # pixels across, down, samples each
REVIEWS = 30 * 4 * 4 * 52   # car lines, panels, trims, weeks


# ---- one command ----------------------------------------------------------------------------

class Cost:
    """What commands that ran at once took."""

    def __init__(self, seconds, cpu, read, written):
        self.seconds, self.cpu, self.read, self.written = seconds, cpu, read, written


def run_all(*commands):
    """Side by side. The clock is that of the slowest; the rest are means."""
    begun = time.monotonic()
    running = [subprocess.Popen(list(map(str, words)), stdout=subprocess.DEVNULL,
                                stderr=subprocess.PIPE) for words in commands]
    cpu = read = written = 0
    for process in running:
        os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)
        with open(f"/proc/{process.pid}/io", encoding="ascii") as file:
            counts = dict(line.split(": ") for line in file.read().splitlines())
        read, written = read + int(counts["rchar"]), written + int(counts["wchar"])
        _, status, usage = os.wait4(process.pid, 0)
        cpu += usage.ru_utime + usage.ru_stime
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode not in (0, 1):  # 1: a review's verdict
            sys.exit(f"{process.args}: {process.stderr.read().decode()}")
    seconds, count = time.monotonic() - begun, len(running)
    return Cost(seconds, cpu / count, read / count, written / count)


class Program:
    def __init__(self, program, folder):
        self.program, self.folder = os.path.abspath(program), folder

    def plan(self, name, parts, samples, split="samples"):
        """A job of so many parts, each on one CPU; its folder."""
        job = os.path.join(self.folder, name)
        run_all([self.program, "render", *SCENE, "--size", f"{SIZE[0]}x{SIZE[1]}", "--spp",
                 samples, "-o", job + ".exr", "--job", job, "--slurm", parts, "--split", split,
                 "--threads", 1])
        return job

    def parts(self, job, *indices):
        """Done anew, each with one thread, side by side."""
        for index in indices:
            for name in os.listdir(job):
                if name.startswith(f"part-{index:04d}."):
                    os.remove(os.path.join(job, name))
        return run_all(*([self.program, "part", "--threads", 1, job, index]
                         for index in indices))

    def merge(self, job):
        return run_all([self.program, "merge", job, "--quiet"])

    def whole(self, samples):
        return run_all([self.program, "render", *SCENE, "--size", f"{SIZE[0]}x{SIZE[1]}",
                        "--spp", samples, "-o", os.path.join(self.folder, "whole.exr"),
                        "--threads", 1, "--quiet"])

    def review(self, name):
        return run_all([self.program, "review", os.path.join(SCENES, name), "-o",
                        os.path.join(self.folder, name + ".folder"), "--quiet"])


def median(measure, runs):
    """Median and spread of the clock, medians of the rest, as a dictionary."""
    costs = [measure() for _ in range(runs)]
    seconds = [cost.seconds for cost in costs]
    found = {key: statistics.median(getattr(cost, key) for cost in costs)
             for key in ("seconds", "cpu", "read", "written")}
    return {**found, "least": min(seconds), "most": max(seconds)}


# ---- without Slurm --------------------------------------------------------------------------

def measure_parts(program, parts, samples, runs):
    """Parts of some samples and of four times as many; one, two and three at once; merges of
    a few and of many; the same by rows."""
    few, many = program.plan("few", parts, parts * samples), \
        program.plan("more", parts, 4 * parts * samples)
    found = {"part": median(lambda: program.parts(many, 0), runs),
             "quarter": median(lambda: program.parts(few, 0), runs)}
    for count in range(2, len(NODES) + 1):
        found[f"beside {count}"] = median(lambda: program.parts(many, *range(count)), runs)
    found["whole"] = median(lambda: program.whole(4 * parts * samples), 1)
    for name, count, split in (("merge", parts, "samples"), ("merge 4", 4 * parts, "samples"),
                               ("rows", parts, "rows")):
        job = program.plan(name.replace(" ", "-"), count, count * 2, split)
        each = [program.parts(job, index).cpu for index in range(count)]
        found[name] = median(lambda: program.merge(job), runs)
        found[name]["parts cpu"] = each
        found[name]["part bytes"] = os.path.getsize(os.path.join(job, "part-0000.exr"))
    return found


# ---- with Slurm -----------------------------------------------------------------------------

def use_nodes(cluster, count):
    """The others take no tasks."""
    for k, node in enumerate(NODES):
        state = ["State=RESUME"] if k < count else ["State=DRAIN", "Reason=bench"]
        cluster.ask("scontrol", "update", f"NodeName={node}", *state)
    time.sleep(1)


def sbatch(cluster, *words):
    done = cluster.ask("sbatch", "--parsable", *words)
    if done.returncode:
        sys.exit(f"sbatch {words}: {done.stderr}")
    return done.stdout.split(";")[0].strip()


def wait_until_empty(cluster):
    if not cluster.wait(cluster.is_empty, 3600):
        sys.exit("Slurm's queue does not become empty")


def probe(cluster, folder, wait_s):
    """Tasks that say when they begin, and wait, on one node: s from one's begin to the next's,
    the last of them a job that waits for all."""
    stamps = os.path.join(folder, f"stamps-{wait_s}")
    words = ("--output=/dev/null", f"--wrap=date +%s.%N >>'{stamps}'; sleep {wait_s}")
    array = sbatch(cluster, f"--array=0-{PROBES - 2}", *words)
    sbatch(cluster, f"--dependency=afterany:{array}", *words)
    wait_until_empty(cluster)
    with open(stamps, encoding="ascii") as file:
        times = sorted(map(float, file))
    return [b - a for a, b in zip(times, times[1:])]


def share(cluster, program, name, parts, samples):
    """From sbatch to the merged frame, s."""
    job = program.plan(name, parts, samples)
    begun = time.time()
    array = sbatch(cluster, os.path.join(job, "array.sbatch"))
    sbatch(cluster, f"--dependency=afterany:{array}", os.path.join(job, "merge.sbatch"))
    wait_until_empty(cluster)
    seconds = os.path.getmtime(job + ".exr") - begun
    shutil.rmtree(job)
    return seconds


def measure_slurm(program, folder, parts, samples, runs):
    found = {"makespans": {}}
    cluster = Cluster(folder)
    try:
        if not cluster.wait(cluster.is_idle, 60):
            sys.exit("the nodes do not come up")
        use_nodes(cluster, 1)
        found["launches"] = {wait_s: probe(cluster, folder, wait_s) for wait_s in PROBES_S}
        for count in range(1, len(NODES) + 1):
            use_nodes(cluster, count)
            found["makespans"][str(count)] = [
                share(cluster, program, f"slurm-{count}-{k}", parts, 4 * parts * samples)
                for k in range(runs)]
    finally:
        cluster.end()
    return found


# ---- the model ------------------------------------------------------------------------------

class Model:
    """A part's start and a sample's cost, as a line through two parts; a merge's as one
    through two merges."""

    def __init__(self, found):
        self.found, parts = found, found["parts"]
        more, few = found["more samples"], found["few samples"]
        part, quarter = parts["part"], parts["quarter"]
        pixels = SIZE[0] * SIZE[1]
        self.sample_s = (part["seconds"] - quarter["seconds"]) / ((more - few) * pixels)
        self.start = part["seconds"] - self.sample_s * more * pixels
        self.work = self.sample_s * more * pixels
        count = len(parts["merge"]["parts cpu"])
        self.merge_s = ((parts["merge 4"]["seconds"] - parts["merge"]["seconds"]) / (3 * count))
        self.merge_first = max(0, parts["merge"]["seconds"] - self.merge_s * count)
        self.part_bytes = parts["merge"]["part bytes"] / pixels
        self.merge_byte_s = self.merge_s / parts["merge"]["part bytes"]
        self.read = part["read"]
        self.cores = {count: count * part["seconds"] / parts[f"beside {count}"]["seconds"]
                      for count in range(2, len(NODES) + 1)}
        rows = [cpu - self.start for cpu in parts["rows"]["parts cpu"]]
        self.rows_spread = statistics.stdev(rows) / statistics.mean(rows)

    def measured_job(self, count):
        """The job that Slurm did here, on so many nodes of this machine."""
        parts = len(self.found["parts"]["merge"]["parts cpu"])
        job = Job([self.work] * parts, self.start, TICK_S, 0,
                  self.merge_first + self.merge_s * parts)
        cores = self.cores.get(count, 1.0)
        return job, Nodes(count, cores)

    def node(self):
        return NODE_CORES * NODE_WORK

    def frame_job(self, nodes, parts, split):
        """FRAME in so many parts. Its file traffic is the nodes' together: what each reads at
        its start, what parts write, and what one merge reads of them."""
        width, height, samples = FRAME
        film = self.part_bytes * width * height
        total = self.sample_s * width * height * samples / self.node()
        held = film * parts if split == "samples" else film
        reading = self.read * min(nodes, parts) / FILES_B_S
        writing = held / parts * min(nodes, parts) / FILES_B_S
        merge = self.merge_first + held * self.merge_byte_s + held / FILES_B_S
        job = Job([total / parts + writing] * parts, self.start + reading, TICK_S,
                  1 / LAUNCHES_S, merge)
        return job, held

    def review_job(self, reviews):
        """A review a part: they need nothing of each other."""
        seconds = self.found["review"]["cpu"] / self.node()
        return Job([seconds] * reviews, self.start, TICK_S, 1 / LAUNCHES_S)


# ---- tables ---------------------------------------------------------------------------------

def spread(values, form="{:.1f}"):
    return (form.format(statistics.median(values))
            + f" ({form.format(min(values))} to {form.format(max(values))})")


def print_costs(model):
    parts, slurm = model.found["parts"], model.found["slurm"]
    count = len(parts["merge"]["parts cpu"])
    whole = parts["whole"]["cpu"]
    print(f"a part before its first sample: {model.start:.2f} s; a million samples: "
          f"{model.sample_s * 1e6:.2f} s")
    print(f"a part read {parts['part']['read'] / 1e6:.1f} MB, wrote "
          f"{parts['part']['written'] / 1e6:.1f} MB; its film is {model.part_bytes:.0f} bytes "
          f"a pixel")
    print(f"merge: {model.merge_first:.2f} s and {model.merge_s * 1e3:.1f} ms a part, "
          f"{model.merge_byte_s * 1e9:.2f} s a GB; of {count} bands of rows "
          f"{parts['rows']['seconds']:.2f} s")
    print(f"processor time: {count} parts {count * parts['part']['cpu']:.1f} s, one run "
          f"{whole:.1f} s; {count} bands of rows differ by "
          f"{model.rows_spread:.0%} (standard deviation)")
    for wait_s, gaps in slurm["launches"].items():
        print(f"Slurm, tasks of {wait_s} s: from one to the next {spread(gaps, '{:.2f}')} s")
    for n, cores in model.cores.items():
        print(f"{n} parts at once: the work of {cores:.2f} cores")


def print_agreement(model):
    makespans = {int(n): values for n, values in model.found["slurm"]["makespans"].items()}
    one = statistics.median(makespans[1])
    print("\n| slurmd | measured s | simulated s | measured / simulated | speed-up | of cores |"
          "\n| --- | --- | --- | --- | --- | --- |")
    for n, values in sorted(makespans.items()):
        found, job = statistics.median(values), simulate(*model.measured_job(n))
        print(f"| {n} | {spread(values)} | {job.seconds:.1f} | {found / job.seconds:.3f} | "
              f"{one / found:.2f} | {one / found / min(n, CORES):.0%} |")


LINE = "| " + " | ".join(["{}"] * 9) + " |"


def print_frame(model):
    width, height, samples = FRAME
    print(f"\nnot measured but assumed: nodes of {NODE_CORES} cores that do the work of "
          f"{NODE_CORES * NODE_WORK:.1f}, {FILES_B_S / 1e9:g} GB/s of files for all, "
          f"{LAUNCHES_S:g} launches a second, {TROUBLE}")
    print(f"\n{width}x{height}, {samples} samples: "
          f"{model.sample_s * width * height * samples / 3600:.1f} h of one core\n\n"
          "| nodes | parts | split | to the frame | of it merge | without trouble | "
          "efficiency | done again | files |\n" + LINE.format(*["---"] * 9))
    for nodes in (10, 100, 1000):
        for each, split in ((1, "samples"), (1, "rows"), (4, "rows"), (16, "rows")):
            parts = nodes * each
            if split == "rows" and parts > height:
                continue
            job, held = model.frame_job(nodes, parts, split)
            unequal = math.sqrt(math.log1p(model.rows_spread ** 2))
            trouble = dataclasses.replace(TROUBLE, spread=unequal if split == "rows"
                                          else TROUBLE.spread)
            outcomes = [simulate(job, Nodes(nodes), trouble, seed) for seed in range(15)]
            calm = simulate(job, Nodes(nodes))
            seconds = statistics.median(o.seconds for o in outcomes)
            useful = sum(job.work)
            print(LINE.format(nodes, parts, split, clock(seconds), clock(job.merge),
                              clock(calm.seconds), f"{useful / (nodes * seconds):.0%}",
                              f"{statistics.mean(o.lost_s for o in outcomes):.0f} s",
                              f"{held / 1e9:.1f} GB"))


def print_year(model):
    cpu = model.found["review"]["cpu"]
    print(f"\n{REVIEWS:,} reviews of {cpu / 60:.1f} minutes of one core: "
          f"{REVIEWS * cpu / 86400 / 365:.2f} years of one core\n\n"
          "| nodes | days | efficiency | deaths | done again |\n"
          "| --- | --- | --- | --- | --- |")
    for nodes in (10, 100, 1000):
        job = model.review_job(REVIEWS)
        done = simulate(job, Nodes(nodes), TROUBLE, 1)
        print(f"| {nodes} | {done.seconds / 86400:.2f} | "
              f"{sum(job.work) / (nodes * done.seconds):.0%} | {done.deaths} | "
              f"{done.lost_s / 3600:.1f} h |")


def clock(seconds):
    if seconds < 120:
        return f"{seconds:.1f} s"
    return f"{seconds / 60:.1f} min" if seconds < 7200 else f"{seconds / 3600:.1f} h"


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("program", nargs="?")
    parser.add_argument("--parts", type=int, default=12)
    parser.add_argument("--samples", type=int, default=8, help="of the smaller part")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--review", default="car_dashboard.review.json")
    parser.add_argument("--keep")
    parser.add_argument("--from", dest="kept")
    options = parser.parse_args()
    if options.kept:
        with open(options.kept, encoding="utf-8") as file:
            found = json.load(file)
    else:
        found = measure(options)
    if options.keep:
        with open(options.keep, "w", encoding="utf-8") as file:
            json.dump(found, file, indent=1)
    model = Model(found)
    for table in (print_costs, print_agreement, print_frame, print_year):
        table(model)


def measure(options):
    with tempfile.TemporaryDirectory(prefix="plan-") as folder:
        program = Program(options.program, folder)
        slurm = os.path.join(folder, "slurm")
        os.mkdir(slurm)
        return {"few samples": options.samples, "more samples": 4 * options.samples,
                "parts": measure_parts(program, options.parts, options.samples, options.runs),
                "review": median(lambda: program.review(options.review), 1),
                "slurm": measure_slurm(program, slurm, options.parts, options.samples,
                                       options.runs)}


if __name__ == "__main__":
    main()
