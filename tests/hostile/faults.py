# SPDX-License-Identifier: Apache-2.0
"""faults.py [--all] PARHELION -- disks that are full, folders that may not be written, files
that change while they are read, memory that runs out, scenes at the edge of sense: each has the
outcome that README.md says, with the exit status, one clear line, and nothing half-written.
--all: every fault; else those that fit into the short tests.
"""
import os
import sys
import tempfile

import fault_files
import fault_limits
import fault_machine
import fault_memory
import fault_scenes
from fault_kit import Bench
from report import Report


def main():
    report, everything = Report(), "--all" in sys.argv
    with tempfile.TemporaryDirectory() as folder:
        os.chmod(folder, 0o755)  # for the faults that are tried as another user
        bench = Bench(report, sys.argv[-1], folder)
        try:
            for part in (fault_files, fault_limits, fault_machine, fault_memory, fault_scenes):
                for check in part.CHECKS + (part.MORE if everything else ()):
                    check(bench)
        finally:
            bench.disks.release()
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
