# SPDX-License-Identifier: Apache-2.0
"""report.py -- counts claims and prints the broken ones, for every check written in Python."""
import os
import re
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SOURCE_FOLDERS = ("src", "shaders", "third_party")


class Report:
    """A check says what it claims; the last line of its output counts them."""

    def __init__(self):
        self.passed = self.failed = self.skipped = 0

    def claim(self, holds, message):
        if holds:
            self.passed += 1
        else:
            self.failed += 1
            print(f"FAILED {message}")
        return holds

    def claim_none(self, what, faults):
        """One claim, of which every fault is printed."""
        for fault in faults:
            print(f"  {fault}")
        self.claim(not faults, f"{what}: {len(faults)} found")

    def skip(self, message):
        self.skipped += 1
        print(f"skipped {message}")

    def finish(self):
        skipped = f", {self.skipped} skipped" if self.skipped else ""
        print(f"{self.passed} passed, {self.failed} failed{skipped}")
        sys.exit(self.failed > 0)


def places(there, text):
    """Where the text has these words and signs one after another, whatever blanks and ends of
    lines stand between them: a list of matches."""
    return list(re.finditer(r"\s*".join(map(re.escape, re.findall(r"\w+|\S", there))), text))


def project_files():
    """Every file that is, or would be, committed, relative to the root."""
    try:
        listed = subprocess.run(
            ["git", "-c", f"safe.directory={ROOT}", "-C", ROOT, "ls-files", "-z", "--cached",
             "--others", "--exclude-standard"], capture_output=True, check=True).stdout
        names = [name for name in listed.decode().split("\0") if name]
    except (OSError, subprocess.CalledProcessError):
        names = [os.path.relpath(os.path.join(folder, name), ROOT)
                 for folder, folders, files in os.walk(ROOT)
                 for name in files if not prune(folders)]
    return sorted(name for name in set(names) if os.path.isfile(os.path.join(ROOT, name)))


def prune(folders):
    """Keeps os.walk out of hidden folders; always False, for use in a condition."""
    folders[:] = [name for name in folders if name not in (".git", ".build")]
    return False


def read(name):
    with open(os.path.join(ROOT, name), encoding="utf-8") as file:
        return file.read()


def sources(*endings):
    """C and C++ files of the product, relative to the root."""
    return [name for name in project_files()
            if name.split("/")[0] in SOURCE_FOLDERS and name.endswith(endings)]
