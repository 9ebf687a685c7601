# SPDX-License-Identifier: Apache-2.0
"""short_memory.py BUILD_DIR -- libparhelion-panel where memory is short: short_memory.c, a host
that opens panels within address space from nothing upwards, and with every mapping refused
once, goes on, loses nothing and prints nothing; and its Python module raises MemoryError.
"""
import os
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [os.path.join(os.path.dirname(HERE), "structure"), HERE]
import panels  # noqa: E402
from report import ROOT, Report  # noqa: E402

LIBRARY = os.path.join(ROOT, "src", "library")
RAISES = """
import resource, parhelion_panel
parhelion_panel._library()
with open("/proc/self/statm") as file:
    mapped = int(file.read().split()[0]) * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_AS, (mapped + (4 << 20), resource.RLIM_INFINITY))
try:
    parhelion_panel.Panel(PANEL)
except MemoryError as fault:
    said = str(fault)
resource.setrlimit(resource.RLIMIT_AS, (resource.RLIM_INFINITY,) * 2)
parhelion_panel.Panel(PANEL).close()
print(said)
"""


def check_host(report, build, folder):
    binary = os.path.join(folder, "short_memory")
    made = subprocess.run(
        ["cc", "-std=c17", "-O1", "-I", LIBRARY, os.path.join(HERE, "short_memory.c"), "-o",
         binary, os.path.join(build, "libparhelion-panel.so.2"), f"-Wl,-rpath,{build}", "-ldl"],
        capture_output=True, text=True)
    if not report.claim(made.returncode == 0, f"the host does not compile: {made.stderr}"):
        return
    done = subprocess.run(
        [binary, *(panels.shipped(name) for name in ("ips_cluster", "hud_pgu"))],
        capture_output=True, text=True, timeout=300)
    words = done.stdout.split()
    report.claim(done.returncode == 0 and not done.stderr and len(words) == 4
                 and words[0] == "0" and int(words[2]) >= 8,
                 f"the host ends with {done.returncode}: {done.stdout}{done.stderr}")


def check_module(report, build):
    panel = panels.shipped("ips_cluster")
    done = subprocess.run(
        [sys.executable, "-B", "-c", f"PANEL = {panel!r}\n{RAISES}"], cwd=LIBRARY,
        capture_output=True, text=True, env={
            **os.environ,
            "PARHELION_PANEL_LIBRARY": os.path.join(build, "libparhelion-panel.so.2")})
    report.claim(done.returncode == 0 and done.stdout.startswith(panel) and "out of memory"
                 in done.stdout and not done.stderr,
                 f"the module says {done.stdout}{done.stderr}")


def main():
    build, report = os.path.abspath(sys.argv[1]), Report()
    panels.use_numpy()
    with tempfile.TemporaryDirectory(prefix="short-memory-") as folder:
        check_host(report, build, folder)
    check_module(report, build)
    report.finish()


if __name__ == "__main__":
    main()
