# SPDX-License-Identifier: Apache-2.0
"""readme.py -- what the README names exists: "Follow one ray" and every other path."""
import os
import re
import sys

from report import ROOT, Report, read

PLACES = ("src/", "shaders/", "scenes/", "assets/", "tests/", "third_party/", ".ci/")


def named_paths(text):
    """What stands in back quotes, in a link or in a shell block and begins as our paths do."""
    words = re.findall(r"[\w./*-]+", text)
    return sorted({word.rstrip(".") for word in words if word.startswith(PLACES)})


def exists(path):
    if "*" in path:
        folder = os.path.join(ROOT, os.path.dirname(path))
        return os.path.isdir(folder)
    return os.path.exists(os.path.join(ROOT, path))


def main():
    report = Report()
    text = read("README.md")
    ray = text.partition("## Follow one ray")[2].partition("\n## ")[0]
    report.claim(len(named_paths(ray)) >= 9, "README: `Follow one ray` names too few files")
    for path in named_paths(text):
        report.claim(exists(path), f"README.md names {path}, which is not there")
    report.claim(not exists("src/nowhere.c"), "a missing file passes for a present one")
    licence = read("LICENSE")
    report.claim("Apache License" in licence and "Version 2.0" in licence,
                 "LICENSE is not Apache-2.0")
    allowed = {"CMakeLists.txt", "CMakePresets.json", "CONTRIBUTING.md", "LICENSE", "README.md",
               "assets", "scenes", "shaders", "src", "tests", "third_party"}
    top = {name for name in os.listdir(ROOT) if not name.startswith(".")}
    report.claim(top == allowed, f"the top level holds {sorted(top ^ allowed)} more or less")
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
