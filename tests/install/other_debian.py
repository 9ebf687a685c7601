# SPDX-License-Identifier: Apache-2.0
"""other_debian.py [--root DIR] PARHELION -- another release of Debian than this machine's, with
other compilers and another Embree: in a root of it the project is set up, built and tested by
tests/run.sh, as on a new machine, and its frames have the bits of ours (PARHELION).

The root is made by mmdebstrap, which wants to be root and a mirror, and takes some GB. --root:
one that is kept, and gone on with when it is there.
"""
import argparse
import os
import re
import shutil
import sys
import tempfile

from bare_root import Root, release
from packages import copy_sources
from tree import ROOT, Report, run

RELEASES = ("bookworm", "trixie")  # Debian 12, with Embree 3, and 13, with Embree 4
PROJECT = "/opt/parhelion/main"
SHARED = os.path.join(os.path.dirname(ROOT), "shared")
HOURS = 2


def make(report, folder):
    """The root with the project in it; None: no mirror, or no right to make one."""
    if os.geteuid():
        return report.skip("another Debian wants root")
    if not os.path.isdir(folder):
        other = next(name for name in RELEASES if name != release())
        done = run("mmdebstrap", "--variant=apt", other, folder)
        if done.returncode:
            shutil.rmtree(folder, ignore_errors=True)
            return report.skip("no other Debian: " + " ".join(done.stderr.split())[-300:])
    shutil.copy("/etc/resolv.conf", os.path.join(folder, "etc"))
    project = folder + PROJECT
    kept = project + ".build"
    if os.path.isdir(project + "/.build"):  # what was built there is gone on with
        os.rename(project + "/.build", kept)
    shutil.rmtree(project, ignore_errors=True)
    os.makedirs(project)
    copy_sources(project)
    if os.path.isdir(kept):
        os.rename(kept, os.path.join(project, ".build"))
    return Root(folder)


def step(report, root, line):
    """What it said; the whole of it is shown when it fails."""
    binds = {SHARED: os.path.dirname(PROJECT) + "/shared"} if os.path.isdir(SHARED) else {}
    done = root.run(line, HOURS * 3600, binds)
    if not report.claim(done.returncode == 0, f"{line}: {done.returncode}"):
        print(done.stdout[-8000:], done.stderr[-2000:])
    return done.stdout


def add_up(report, said):
    """The table of run.sh; what it counted counts here."""
    table = [line for line in said.splitlines()
             if re.search(r"\d+ passed +\d+ failed", line)]
    print("\n".join("  " + line for line in table))
    total = re.search(r"^(\d+) passed, (\d+) failed$", said, re.M)
    if report.claim(total and table, "run.sh did not come to its end"):
        report.passed += int(total[1])


def digests(said):
    """(scene, digest) of the frames of tests/image/bits.py, as it prints them."""
    return re.findall(r"^([\w.]+): ([0-9a-f]{64})$", said, re.M)


def check_bits(report, root, program):
    there = step(report, root, f"cd {PROJECT} && python3 tests/image/bits.py "
                               ".build/release/parhelion")
    here = run(sys.executable, os.path.join(ROOT, "tests", "image", "bits.py"), program)
    ours, theirs = digests(here.stdout), digests(there)
    report.claim(len(ours) >= 3, f"frames: {ours}")
    report.claim(ours == theirs, f"another Debian, other bits: {ours} here, {theirs} there")


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--root")
    parser.add_argument("program")
    arguments = parser.parse_args()
    report = Report()
    with tempfile.TemporaryDirectory(prefix="other-") as folder:
        os.chmod(folder, 0o755)
        root = make(report, arguments.root or os.path.join(folder, "root"))
        if root:
            said = step(report, root, "apt-get -qq update && apt-get -qq install -y git && "
                                      f"cd {PROJECT} && sh tests/run.sh")
            add_up(report, said)
            check_bits(report, root, arguments.program)
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
