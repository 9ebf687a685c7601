# SPDX-License-Identifier: Apache-2.0
"""tree.py -- what an installation holds, by the program: commands, guides, manual pages."""
import json
import os
import re
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report, read  # noqa: E402,F401


def run(*words, **more):
    return subprocess.run(words, capture_output=True, text=True, timeout=600, **more)


def version():
    """Where it is written, the only place: CMakeLists.txt."""
    return re.search(r"^project\(parhelion VERSION ([\d.]+) ", read("CMakeLists.txt"), re.M)[1]


def help_json(program):
    return json.loads(run(program, "help", "--json").stdout)


def commands(rows, before=()):
    """Every command as its words: ("render",), ("panel", "fit")."""
    for row in rows:
        words = (*before, row["name"])
        yield words
        yield from commands(row.get("commands", ()), words)


def pages(program):
    """(file below share/man, what it is about) of every command and guide."""
    told = help_json(program)
    yield "man1/parhelion.1.gz", ()
    for words in commands(told["commands"]):
        yield f"man1/parhelion-{'-'.join(words)}.1.gz", words
    for row in told["guides"]:
        yield f"man7/parhelion-{row['name']}.7.gz", (row["name"],)


def options(program, words):
    """The options that a command's --help lists, each with what stands for its value."""
    text = run(program, *words, "--help").stdout
    return re.findall(r"^  (--?[a-z][\w-]*)(?: (\S+))?(?:  .*)?$", text, re.M)
