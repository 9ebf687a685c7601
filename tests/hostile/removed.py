# SPDX-License-Identifier: Apache-2.0
"""removed.py PARHELION -- every option, command and value that was removed (src/text/removed.c)
is refused by one line that says what to do instead. Keys of formats: tests/unit/test_record.c.
"""
import os
import re
import subprocess
import sys

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

# What of a command has to stand before an option that takes a value of these.
VALUES = {"--kind": ("panel", "plot", "x.panel", "-o", "x.svg", "--kind"),
          "--format": ("panel", "import", "x.csv", "-o", "MANIFEST.json", "--format"),
          "--layer": ("develop", "x.exr", "-o", "x.png", "--layer"),
          "--layers": ("render", "x.gltf", "-o", "x.exr", "--layers")}


def rows():
    """(where, word, instead) of the table in the source."""
    source = open(os.path.join(ROOT, "src", "text", "removed.c"), encoding="utf-8").read()
    table = source[source.index("removed_words[] = {"):source.index("{NULL, NULL, NULL}")]
    table = re.sub(r'"\s*\n\s*"', "", table)
    text = r'"((?:[^"\\]|\\.)*)"'
    return re.findall(r"\{" + text + r",\s*" + text + r",\s*" + text + r"\}", table)


def command_of(where, word):
    """The words of a command line that has it; None: it is a key of a format."""
    if where in VALUES:
        return (*VALUES[where], word)
    if where in ("parhelion", "panel"):
        return (*where.split()[1:], *(["panel"] if where == "panel" else []), word)
    return (*where.split(), word, "1") if word.startswith("-") else None


def main(program):
    report = Report()
    for where, word, instead in rows():
        words = command_of(where, word)
        if words is None:
            continue
        run = subprocess.run([program, *words], capture_output=True, text=True, check=False,
                             timeout=60)
        lines = run.stderr.strip().splitlines()
        report.claim(run.returncode == 2 and len(lines) == 1 and word in lines[0] and
                     instead.replace('\\"', '"') in lines[0] and not run.stdout,
                     f"{' '.join(words)}: status {run.returncode}, {run.stderr!r}, "
                     f"required 2 and {instead!r}")
    report.finish()


main(sys.argv[1])
