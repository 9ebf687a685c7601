# SPDX-License-Identifier: Apache-2.0
"""steps.py -- a step of tests/long.sh is run again when a file changes that it depends on: with
a folder it names all that the folder includes, as layers.txt has it, and the tests that it
runs. src/cli/ (the commands' own files, which know every room) hands on and is let off."""
import os
import re

from layers import allowed_includes
from report import ROOT, Report, read

ASSIGNED = re.compile(r'^(\w+)=(["\'])(.*?)\2', re.M | re.DOTALL)
STEP = re.compile(r"^(of|run|start|needs) (.*(?:\\\n.*)*)", re.M)
SCRIPT = re.compile(r"tests/[\w/]+\.(?:py|sh)")


def expand(text, names):
    while "$" in text:
        text = re.sub(r"\$(\w+)", lambda found: names[found.group(1)], text)
    return text.split()


def covers(folders, name):
    """Is the file or folder among them? "FOLDER/" is without the folders in it."""
    return any(name == folder.rstrip("/") or
               (not folder.endswith("/") and name.startswith(folder + "/"))
               for folder in folders)


def not_covered(folders, layers):
    """What a folder among them includes and they do not have."""
    for layer, may in layers.items():
        if covers([folder for folder in folders if folder != "src/cli/"], layer):
            yield from (f"{layer} includes {entry}" for entry in may
                        if not entry.startswith("<") and not covers(folders, entry))


def main():
    report = Report()
    text = read("tests/long.sh")
    names = {name: value for name, _, value in ASSIGNED.findall(text)}
    layers, folders, steps, missing = allowed_includes(), None, 0, []
    for kind, rest in STEP.findall(text):
        if kind == "of":
            folders = expand(rest.strip('"'), names)
            report.claim_none(f"of {rest}", sorted(set(not_covered(folders, layers))))
            missing += [f"{rest}: {name}" for name in folders
                        if not os.path.exists(os.path.join(ROOT, name))]
        elif kind in ("run", "start"):
            steps += 1
            missing += [f"{rest}: {script}" for script in SCRIPT.findall(rest)
                        if not os.path.isfile(os.path.join(ROOT, script))
                        or not covers(folders or [], script)]
    report.claim_none("what is no file, or which a step runs and does not depend on", missing)
    report.claim(steps > 40, f"only {steps} steps were read")
    check_itself(report)
    report.finish()


def check_itself(report):
    for folders, name, wanted in ((["src/path"], "src/path/collect", True),
                                  (["src/path/"], "src/path/collect", False),
                                  (["src/path/"], "src/path", True),
                                  (["src/path"], "src/pathos", False)):
        report.claim(covers(folders, name) == wanted, f"misjudged: {name} in {folders}")
    layers = {"src/a": ["src/b", "<x>"], "src/b": []}
    report.claim(list(not_covered(["src/a"], layers)) == ["src/a includes src/b"],
                 "what is not named does not show")


if __name__ == "__main__":
    main()
