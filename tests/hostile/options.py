# SPDX-License-Identifier: Apache-2.0
"""options.py [--all] PARHELION -- no command drops an option in silence: every option of every
command, as its --help lists them, is given twice. One that stands once is refused with both
values; of one that is repeatable both are heard. Without --all every third that stands once.
"""
import itertools
import os
import re
import subprocess
import sys
import tempfile

from cli import COMMANDS as OWN

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

ROW = re.compile(r"^  (-\S*)(?: (\S+))?(?:  |$)")
COMMANDS = (*OWN, "review", "explain")
REPEATABLE = "; repeatable"


class Row:
    def __init__(self, command, name, value):
        self.command, self.name, self.value, self.help = command, name, value, ""


def rows_of(program, command):
    """The options of a command, as its help lists them."""
    text = program(command.split() + ["--help"]).stdout
    rows = []
    for line in text.split("\nexample:")[0].splitlines():
        match = ROW.match(line)
        if match:
            rows.append(Row(command, match.group(1), match.group(2)))
        if rows and line.startswith("  "):
            rows[-1].help += line
    return rows


def literal(value):
    """Two different values of such a kind, as far as its help tells."""
    names = [word for word in re.split(r"[|\[]", value) if re.fullmatch(r"[a-z0-9-]+", word)]
    if names:
        return names[0], names[-1]
    if re.fullmatch(r"[A-Z]+x[A-Z]+", value):
        return "8x8", "16x9"
    count = len(re.sub(r"\[.*", "", value).split(","))
    return ",".join(["2"] * count), ",".join(["3"] * count)


def inside_limits(message, value):
    """Values that a message about limits allows."""
    match = re.search(r"required: (-?[\d.e+-]+) to (-?[\d.e+-]+)", message)
    count = value.count(",") + 1
    return match and tuple(",".join([match.group(k)] * count) for k in (1, 2))


def check_once(report, program, row):
    if row.value is None:
        done, values = program(row.command.split() + [row.name, row.name]), ()
    else:
        values = literal(row.value)
        for _ in range(2):
            done = program([*row.command.split(), row.name, values[0],
                            f"{row.name}={values[1]}"])
            allowed = inside_limits(done.stderr, row.value)
            if not allowed:
                break
            values = allowed
    lines = done.stderr.splitlines()
    report.claim(done.returncode == 2 and len(lines) == 1 and
                 all(word in lines[0] for word in (row.name, "given twice", *values)),
                 f"{row.command} {row.name} twice, {values}: status {done.returncode}, "
                 f"{done.stderr[:200]!r}")


# What a command needs besides, so that its lists are read.
NEEDED = {
    "render": ("a.gltf", "-o", "x.exr"), "measure": ("a.gltf", "--illuminance", "0,1,0,0,1,0"),
    "explain": ("a.gltf", "--pixel", "0,0"),
    "compare": ("a.exr", "b.exr"), "panel import": ("a.csv", "-o", "m.json"),
    "review": ("a.json", "-o", "x"), "check": ("a.gltf",), "equip": ("a.gltf", "-o", "x.html")}


GOOD = {"--gloss": "20=5", "--max": "flip=1", "--min": "ssim=1", "--role": "a=red"}


def check_both(report, program, row):
    """Whichever of two stands wrongly, the line tells of it; two that are right are taken."""
    def run(*values):
        options = [word for value in values for word in (row.name, value)]
        return program([*row.command.split(), *NEEDED.get(row.command, ()), *options])

    def names(done, word):
        return done.returncode in (2, 3) and word in done.stderr
    report.claim("given twice" not in run("one=1", "two=2").stderr,
                 f"{row.command} {row.name}: refused the second time")
    if "=" not in row.value or row.value.startswith("PATTERN=DEG"):
        return
    good = GOOD.get(row.name, "one=1")
    done = run(good, "second"), run("first", good)
    report.claim(names(done[0], "second") and names(done[1], "first"),
                 f"{row.command} {row.name}: one of two was not heard: "
                 f"{done[0].stderr[:150]!r}, {done[1].stderr[:150]!r}")


def check_overrides(report, program):
    """Of what one place is stated twice, or is undone by what is said of all."""
    line = ["render", "a.gltf", "-o", "x.exr"]
    for option in ("--content", "--panel", "--display-level", "--light", "--light-level",
                   "--light-cct"):
        done = program([*line, option, "one=1", option, "two=2", option, "one=3"])
        report.claim(done.returncode == 2 and all(
            word in done.stderr for word in (option, "one", "1 and 3", "given twice")),
            f"{option} of one place twice: {done.stderr[:200]!r}")
    done = program([*line, "--display-level", "one=1", "--display-level", "*=3"])
    report.claim(done.returncode == 2 and "*=3 would undo one=1" in done.stderr,
                 f"* behind a name: {done.stderr[:200]!r}")
    done = program([*line, "--display-level", "*=3", "--display-level", "one=1"])
    report.claim(done.returncode == 3, f"* before a name is refused: {done.stderr[:200]!r}")


def check_arguments(report, program):
    """A word too much is refused, not left out."""
    for words in (["help", "comparing", "rendering"],
                  ["develop", "a.exr", "b.exr", "-o", "x.png"],
                  ["measure", "a.exr", "b.exr"], ["compare", "a.exr", "b.exr", "c.exr"],
                  ["review", "a.json", "b.json"], ["explain", "a.json", "b.json"],
                  ["equip", "a.gltf", "b.gltf"]):
        done = program(words)
        report.claim(done.returncode == 2 and done.stderr.count("\n") == 1,
                     f"{words}: status {done.returncode}, {done.stderr[:200]!r}")


def main(path, step):
    report = Report()
    path = os.path.abspath(path)
    with tempfile.TemporaryDirectory() as folder:
        def program(words):
            return subprocess.run([path, *words], capture_output=True, text=True, timeout=60,
                                  cwd=folder)
        for command in COMMANDS:
            rows = [row for row in rows_of(program, command) if row.name not in
                    ("--help", "--version")]
            report.claim(len(rows) >= 4, f"{command}: its help lists {len(rows)} options")
            is_repeatable = [row.help.endswith(REPEATABLE) for row in rows]
            for row in itertools.compress(rows, is_repeatable):
                check_both(report, program, row)
            once = [row for row, both in zip(rows, is_repeatable) if not both]
            for row in once[::step]:
                check_once(report, program, row)
        check_overrides(report, program)
        check_arguments(report, program)
    return report.finish()


if __name__ == "__main__":
    sys.exit(main(sys.argv[-1], 1 if "--all" in sys.argv else 3))
