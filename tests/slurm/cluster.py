# SPDX-License-Identifier: Apache-2.0
"""cluster.py -- Debian's Slurm on this machine, for tests: slurmctld and three slurmd, whose
nodes can die.

    with cluster.started(report) as slurm:
        job = slurm.submit("--array=1-3", "render.sbatch", "3", "frame.exr", ..., cwd=folder)
        slurm.wait(slurm.is_empty)
"""
import contextlib
import os
import re
import shutil
import signal
import socket
import subprocess
import tempfile
import time

TOOLS = ("slurmctld", "slurmd", "sbatch", "squeue", "scontrol", "scancel", "sinfo")
NODES = ("n1", "n2", "n3")
PATIENCE_S = 420

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

    def submit(self, *words, cwd, **environment):
        """The number of the job that sbatch made; what it prints lies in cwd, NAME.log."""
        done = subprocess.run(["sbatch", "--parsable", *words], capture_output=True, text=True,
                              cwd=cwd, env={**os.environ, **environment}, timeout=60)
        if done.returncode:
            raise RuntimeError(f"sbatch {words}: {done.stderr}")
        return done.stdout.strip().partition(";")[0]

    def ids(self):
        """Of the jobs, or tasks, that are left in the queue."""
        return self.ask("squeue", "--noheader", "--array", "--format=%i").stdout.split()

    def is_empty(self):
        return not self.ids()

    def end(self):
        self.ask("scancel", "--user=root")
        self.wait(self.is_empty, 30)
        for daemon in self.daemons.values():
            if daemon.poll() is None:
                daemon.terminate()
        for daemon in self.daemons.values():
            with contextlib.suppress(subprocess.TimeoutExpired):
                daemon.wait(20)


@contextlib.contextmanager
def started(report, keep=None):
    """A cluster whose nodes are idle; keep: its folder, else one that goes. Ends the test where
    it cannot be: slurm-wlm is not installed, or nobody is root, since without munge only root's
    daemons believe each other."""
    missing = [tool for tool in TOOLS if not shutil.which(tool)]
    if missing or os.geteuid() != 0:
        report.skip(f"Slurm: {', '.join(missing)} are missing (slurm-wlm)" if missing
                    else "Slurm: its daemons need root without munge")
        report.finish()
    folder = os.path.realpath(keep or tempfile.mkdtemp(prefix="slurm-"))
    os.makedirs(folder, exist_ok=True)
    cluster = Cluster(folder)
    try:
        if report.claim(cluster.wait(cluster.is_idle, 60), "the nodes do not come up: " +
                        cluster.ask("sinfo", "-N", "-l").stdout):
            yield cluster
    finally:
        cluster.end()
        if not keep:
            shutil.rmtree(folder, ignore_errors=True)
