# SPDX-License-Identifier: Apache-2.0
"""cluster.py [--keep DIR] [--only NAME] PARHELION -- a frame that is shared by Debian's Slurm,
slurmctld and three slurmd on this machine: twelve parts over three nodes, parts that fail, a
task that is warned and comes back, a node that dies in the middle of a part; and a review of
the shipped car. Each time the frame, or the review, is that of one run, byte for byte. Skipped
where slurm-wlm is not installed, or nobody is root: without munge only root's daemons believe
each other.
"""
import argparse
import contextlib
import json
import os
import re
import shutil
import socket
import subprocess
import signal
import sys
import tempfile
import time

from jobs import ISA, Report, ROOT, Work, contents

sys.path.insert(0, os.path.join(ROOT, "tests", "hostile"))
from review_resume import files_of  # noqa: E402

TOOLS = ("slurmctld", "slurmd", "sbatch", "squeue", "scontrol", "scancel", "sinfo")
NODES = ("n1", "n2", "n3")
PATIENCE_S = 420
SMALL = ("--size", "64x48", "--layers", "all", "--spp", "24", *ISA)
PART_S = 40  # of a part that something happens to

# cred_expire is how long a task that is requeued waits; two minutes without it.
CONFIGURATION = """ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
AuthType=auth/none
AuthInfo=cred_expire=5
CredType=cred/none
SlurmUser=root
SlurmdUser=root
StateSaveLocation={folder}/state
SlurmctldPidFile={folder}/slurmctld.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdSpoolDir={folder}/spool.%n
SlurmdPidFile={folder}/%n.pid
SlurmdLogFile={folder}/%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/linear
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SlurmdParameters=config_overrides
ReturnToService=2
SlurmdTimeout=10
KillWait=5
{nodes}
PartitionName=main Nodes={names} Default=YES MaxTime=INFINITE State=UP
"""


def free_ports(count):
    with contextlib.ExitStack() as stack:
        sockets = [stack.enter_context(socket.socket()) for _ in range(count)]
        for one in sockets:
            one.bind(("127.0.0.1", 0))
        return [one.getsockname()[1] for one in sockets]


def read_proc(pid, name):
    with contextlib.suppress(OSError), open(f"/proc/{pid}/{name}", "rb") as file:
        return file.read()
    return b""


def parent_of(pid):
    match = re.search(rb"^PPid:\s*(\d+)", read_proc(pid, "status"), re.M)
    return int(match[1]) if match else 0


class Cluster:
    """The daemons, each a child of this process."""

    def __init__(self, folder):
        self.folder, self.daemons = folder, {}
        host, ports = socket.gethostname().split(".")[0], free_ports(1 + len(NODES))
        nodes = "\n".join(f"NodeName={name} NodeHostname={host} NodeAddr=127.0.0.1 "
                          f"Port={port} CPUs=1 State=UNKNOWN"
                          for name, port in zip(NODES, ports[1:]))
        for name in ("state", *(f"spool.{node}" for node in NODES)):
            os.makedirs(os.path.join(folder, name))
        path = os.path.join(folder, "slurm.conf")
        with open(path, "w", encoding="utf-8") as file:
            file.write(CONFIGURATION.format(folder=folder, host=host, ports=ports, nodes=nodes,
                                            names=",".join(NODES)))
        os.environ["SLURM_CONF"] = path
        self.start("slurmctld", "-D", "-c")
        for node in NODES:
            self.start_node(node)

    def start(self, name, *words, key=None):
        with open(os.path.join(self.folder, f"{key or name}.out"), "wb") as out:
            self.daemons[key or name] = subprocess.Popen([name, *words], stdout=out, stderr=out)

    def start_node(self, node):
        self.start("slurmd", "-D", "-N", node, key=node)

    def kill_node(self, node):
        """The daemon and all that runs on the node, at once, as when its power goes."""
        mark = f"SLURMD_NODENAME={node}\0".encode()
        tasks = [pid for pid in map(int, filter(str.isdigit, os.listdir("/proc")))
                 if mark in read_proc(pid, "environ")]
        steps = {parent_of(pid) for pid in tasks}
        self.daemons[node].kill()
        for pid in [*tasks, *(pid for pid in steps
                              if read_proc(pid, "comm").startswith(b"slurmstepd"))]:
            with contextlib.suppress(ProcessLookupError):
                os.kill(pid, signal.SIGKILL)
        self.daemons[node].wait(20)

    def ask(self, *words):
        return subprocess.run(words, capture_output=True, text=True, timeout=60)

    def wait(self, holds, patience=PATIENCE_S):
        end = time.time() + patience
        while not holds() and time.time() < end:
            time.sleep(0.5)
        return holds()

    def is_idle(self):
        states = self.ask("sinfo", "--noheader", "--Node", "--format=%T").stdout.split()
        return states == ["idle"] * len(NODES)

    def tasks(self, job):
        """Of an array job, or another: index -> what scontrol tells of it."""
        found = {}
        for line in self.ask("scontrol", "--oneliner", "show", "job", job).stdout.splitlines():
            facts = dict(re.findall(r"(\w+)=(\S*)", line))
            found[facts.get("ArrayTaskId", "0")] = facts
        return found

    def is_empty(self):
        return not self.ask("squeue", "--noheader").stdout.strip()

    def end(self):
        self.ask("scancel", "--user=root")
        self.wait(self.is_empty, 30)
        for daemon in self.daemons.values():
            if daemon.poll() is None:
                daemon.terminate()
        for daemon in self.daemons.values():
            with contextlib.suppress(subprocess.TimeoutExpired):
                daemon.wait(20)


def long_frame(work, count):
    """Options of a frame whose parts take PART_S each, as fast as this machine is now."""
    done = work.run("render", "small.gltf", "-o", "rate.exr", "--size", "96x64", "--spp", "64",
                    "--json", "--quiet")
    rate = 64 / max(json.loads(done.stdout)["seconds"], 0.01)
    samples = count * max(64, int(PART_S * rate / len(NODES)))
    return *ISA, "--size", "96x64", "--spp", str(samples)


def submit(work, count, *options, job):
    done = work.run("render", "small.gltf", "-o", f"{job}.exr", "--slurm", str(count), "--job",
                    job, "--submit", "--json", *options)
    work.report.claim(done.returncode == 0, f"--submit: {done.stderr}")
    answer = json.loads(done.stdout)
    return answer["array_job"], answer["merge_job"]


def log_of(work, job, name):
    path = work.path(job, "logs", name)
    return contents(path).decode() if os.path.exists(path) else f"no {name}"


def claim_frame(work, job, options, what):
    """The merge job made the frame of one run."""
    path = work.path(f"{job}.exr")
    if work.report.claim(os.path.exists(path), f"{what}: no frame: "
                         f"{log_of(work, job, 'merge.log')}{work.run('status', job).stdout}"):
        work.report.claim(contents(path) == work.whole(*options),
                          f"{what}: not the bytes of one run")


def check_twelve(work, cluster):
    array, merge = submit(work, 12, *SMALL, job="twelve")
    work.report.claim(cluster.wait(cluster.is_empty), "twelve parts do not end")
    tasks = cluster.tasks(array)
    work.report.claim(len(tasks) == 12 and all(task["JobState"] == "COMPLETED"
                                               for task in tasks.values()), f"{tasks}")
    work.report.claim({task["NodeList"] for task in tasks.values()} == set(NODES),
                      f"nodes: {[task['NodeList'] for task in tasks.values()]}")
    work.report.claim(cluster.tasks(merge)["0"]["JobState"] == "COMPLETED", "the merge")
    work.report.claim(work.status("twelve")[0] == 0, "status")
    claim_frame(work, "twelve", SMALL, "twelve parts")


def check_failing(work, cluster):
    """Bad input is not tried again; the merge tells what is missing, and how to do it."""
    report = work.report
    report.claim(cluster.ask("scontrol", "update", "NodeName=n1,n2,n3", "State=DRAIN",
                             "Reason=test").returncode == 0, "drain")
    array, merge = submit(work, 3, *SMALL, job="failing")
    os.rename(work.path("small.gltf"), work.path("away.gltf"))
    cluster.ask("scontrol", "update", "NodeName=n1,n2,n3", "State=RESUME")
    report.claim(cluster.wait(cluster.is_empty), "failing parts do not end")
    tasks = cluster.tasks(array)
    report.claim(all((task["JobState"], task["ExitCode"], task["Restarts"]) ==
                     ("FAILED", "3:0", "0") for task in tasks.values()), f"failing: {tasks}")
    report.claim(cluster.tasks(merge)["0"]["ExitCode"] == "3:0"
                 and "3 of 3 parts are not done" in log_of(work, "failing", "merge.log"),
                 f"merge of failures: {log_of(work, 'failing', 'merge.log')}")
    status = work.status("failing")[1]
    report.claim(status["failed"] == 3 and "small.gltf" in status["list"][0]["error"],
                 f"status of failures: {status}")
    os.rename(work.path("away.gltf"), work.path("small.gltf"))
    for command in [part["command"] for part in status["list"]] + [status["merge"]]:
        done = subprocess.run(["sh", "-c", command], capture_output=True, text=True, cwd="/")
        report.claim(done.returncode == 0, f"{command}: {done.stderr}")
    claim_frame(work, "failing", SMALL, "failures done by hand")


def kept(work, job, index):
    return work.status(job)[1]["list"][index]["samples_kept"]


def check_warned(work, cluster):
    """What --signal=B:TERM@60 does, by hand: the checkpoint is kept, the task comes back."""
    report = work.report
    options = long_frame(work, 2)
    array, _ = submit(work, 2, *options, "--checkpoint-interval", "0", job="warned")
    report.claim(cluster.wait(lambda: kept(work, "warned", 0) > 0), "no checkpoint")
    cluster.ask("scancel", "--batch", "--signal=TERM", f"{array}_0")
    report.claim(cluster.wait(lambda: "stopped by TERM" in log_of(work, "warned",
                                                                  "part-0.log")),
                 f"the warning: {log_of(work, 'warned', 'part-0.log')}")
    report.claim(cluster.wait(cluster.is_empty), "warned parts do not end")
    log = log_of(work, "warned", "part-0.log")
    task = cluster.tasks(array)["0"]
    report.claim(task["Restarts"] == "1" and task["JobState"] == "COMPLETED"
                 and "goes on after" in log, f"warned: {task} {log}")
    claim_frame(work, "warned", options, "a task that was warned")


def check_dead(work, cluster):
    """A node dies in the middle of a part: another goes on from the part's checkpoint."""
    report = work.report
    options = long_frame(work, 3)
    array, _ = submit(work, 3, *options, "--checkpoint-interval", "0", job="dead")
    report.claim(cluster.wait(lambda: kept(work, "dead", 0) > 0), "no checkpoint")
    node = cluster.tasks(array)["0"]["NodeList"]
    cluster.kill_node(node)
    report.claim(cluster.wait(cluster.is_empty), "parts of a dead node do not end")
    log, task = log_of(work, "dead", "part-0.log"), cluster.tasks(array)["0"]
    report.claim((task["Restarts"], task["JobState"]) == ("1", "COMPLETED")
                 and task["NodeList"] != node and "goes on after" in log,
                 f"a node that died: {node} {task} {log}")
    claim_frame(work, "dead", options, "a node that died")
    cluster.start_node(node)
    report.claim(cluster.wait(cluster.is_idle, 60), f"{node} does not come back")


def check_two_kinds(work, cluster):
    """Two of three nodes lack the instruction set: the third does all parts."""
    report, job = work.report, work.path("kinds")
    work.share(4, *SMALL, job="kinds", output="kinds.exr")
    with open(work.path("kinds", "array.sbatch"), encoding="utf-8") as file:
        script = file.read()
    with open(work.path("lacks"), "w", encoding="utf-8") as file:
        file.write(f'#!/bin/sh\n[ "$SLURMD_NODENAME" = n3 ] || exit 5\n'
                   f'exec {work.program} "$@"\n')
    os.chmod(work.path("lacks"), 0o755)
    with open(work.path("kinds", "array.sbatch"), "w", encoding="utf-8") as file:
        file.write(script.replace(os.path.realpath(work.program) + " part",
                                  work.path("lacks") + " part"))
    array = cluster.ask("sbatch", "--parsable", f"{job}/array.sbatch").stdout.strip()
    report.claim(cluster.wait(cluster.is_empty), "two kinds of nodes do not end: " +
                 cluster.ask("squeue", "--array").stdout)
    tasks = cluster.tasks(array)
    report.claim([(task["JobState"], task["NodeList"]) for task in tasks.values()]
                 == [("COMPLETED", "n3")] * 4, f"two kinds of nodes: {tasks}")
    work.claim_whole("kinds", SMALL, "two kinds of nodes", output="kinds.exr")


def check_review(work, cluster):
    """The shipped car at a glance: a job array, and the merge ends as the review does."""
    asked = os.path.join(ROOT, "scenes", "glance.review.json")
    one = work.run("review", asked, "-o", "glance", "--quiet", *ISA)
    work.report.claim(one.returncode == 1, f"one run: {one.returncode} {one.stderr}")
    os.rename(work.path("glance"), work.path("one"))
    done = work.run("review", asked, "-o", "glance", "--slurm", "6", "--submit", "--json",
                    *ISA)
    if not work.report.claim(done.returncode == 0, f"--submit: {done.stderr}"):
        return
    answer = json.loads(done.stdout)
    work.report.claim(cluster.wait(cluster.is_empty), "a review's parts do not end")
    tasks = cluster.tasks(answer["array_job"])
    work.report.claim([task["JobState"] for task in tasks.values()] == ["COMPLETED"] * 6,
                      f"a review's parts: {tasks}")
    merge = cluster.tasks(answer["merge_job"])["0"]
    work.report.claim(merge["ExitCode"] == "1:0", f"a review that fails: {merge}")
    wanted, found = files_of(work.path("one")), files_of(work.path("glance"))
    other = [name for name in wanted.keys() | found.keys()
             if wanted.get(name) != found.get(name)]
    work.report.claim(wanted and not other, f"not one run's: {other}")


def main():
    report = Report()
    parser = argparse.ArgumentParser()
    parser.add_argument("--keep", help="the folder of the daemons and jobs, which is kept")
    parser.add_argument("--only", default="", help="cases of which the name has this")
    parser.add_argument("program")
    arguments = parser.parse_args()
    missing = [tool for tool in TOOLS if not shutil.which(tool)]
    if missing or os.geteuid() != 0:
        report.skip(f"Slurm: {', '.join(missing)} are missing (slurm-wlm)" if missing
                    else "Slurm: its daemons need root without munge")
        report.finish()
    folder = arguments.keep or tempfile.mkdtemp(prefix="slurm-")
    os.makedirs(folder, exist_ok=True)
    cluster = None
    try:
        cluster = Cluster(os.path.realpath(folder))
        work = Work(arguments.program, os.path.realpath(folder), report)
        if report.claim(cluster.wait(cluster.is_idle, 60), "the nodes do not come up: " +
                        cluster.ask("sinfo", "-N", "-l").stdout):
            for check in (check_twelve, check_failing, check_warned, check_dead,
                          check_two_kinds, check_review):
                if arguments.only not in check.__name__:
                    continue
                begun = time.time()
                check(work, cluster)
                print(f"{check.__name__}: {time.time() - begun:.0f} s", flush=True)
    finally:
        if cluster:
            cluster.end()
        if not arguments.keep:
            shutil.rmtree(folder, ignore_errors=True)
    report.finish()


if __name__ == "__main__":
    main()
