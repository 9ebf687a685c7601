# SPDX-License-Identifier: Apache-2.0
"""format.py [--write] -- C and C++ sources are what clang-format 19 makes of them, by
.clang-format. With --write they are formatted."""
import os
import shutil
import subprocess
import sys

from report import ROOT, Report, project_files

MAJOR = 19  # in Debian 12 and 13; other versions break lines elsewhere


def formatter():
    """The program, or None."""
    for name in (f"clang-format-{MAJOR}", "clang-format"):
        path = shutil.which(name)
        if path and f"version {MAJOR}." in subprocess.run(
                [path, "--version"], capture_output=True, text=True, check=True).stdout:
            return path
    return None


def main():
    report = Report()
    program = formatter()
    if not program:
        report.claim(False, f"clang-format {MAJOR} is absent: third_party/install.sh --tests")
        report.finish()
    names = [name for name in project_files() if name.endswith((".c", ".h", ".cpp"))
             and not name.startswith("tests/fuzz/found/")]
    report.claim(len(names) > 1000, f"{len(names)} sources only")
    if "--write" in sys.argv:
        for _ in range(2):  # what one pass breaks anew, the second one settles
            subprocess.run([program, "-i", *names], cwd=ROOT, check=True)
    done = subprocess.run(["xargs", f"-P{os.cpu_count()}", "-n50", program, "--dry-run"],
                          input="\n".join(names), cwd=ROOT, capture_output=True, text=True,
                          check=True)
    wrong = sorted({line.split(":")[0] for line in done.stderr.splitlines()
                    if "[-Wclang-format-violations]" in line})
    report.claim_none("sources that tests/structure/format.py --write would change", wrong)
    made = subprocess.run([program, "--assume-filename=a.c"], cwd=ROOT, capture_output=True,
                          input="int f(void)\n{\n  return 1;\n}\n", text=True, check=True).stdout
    report.claim(made == "int f(void) {\n    return 1;\n}\n", f"another style: {made!r}")
    report.finish()


if __name__ == "__main__":
    main()
