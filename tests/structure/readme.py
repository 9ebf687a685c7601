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


def tabled_files(text):
    """What the first cells of a folder's table of files name: `light/setup`, `run/`, `a`, `b`
    (the second in the folder of the first)."""
    for line in text.splitlines():
        if not line.startswith("| `"):
            continue
        folder = ""
        for name in re.findall(r"`([^`]+)`", line.split("|")[1]):
            yield name if "/" in name else folder + name, name
            folder = name.rpartition("/")[0] + "/" if "/" in name else folder


def check_table(report, folder):
    for with_folder, name in tabled_files(read(f"{folder}/README.md")):
        places = [os.path.join(ROOT, folder, each) for each in (with_folder, name)]
        report.claim(any(os.path.exists(place + ending) for place in places
                         for ending in ("", ".h", ".js")),
                     f"{folder}/README.md names {name}, which is not there")


def main():
    report = Report()
    text = read("README.md")
    ray = text.partition("## Follow one ray")[2].partition("\n## ")[0]
    report.claim(len(named_paths(ray)) >= 9, "README: `Follow one ray` names too few files")
    for sister, least in (("One measurement", 7), ("One verdict", 8)):
        told = text.partition(f"**{sister}**")[2].partition("\n\n")[0]
        report.claim(len(named_paths(told)) >= least, f"README: `{sister}` names too few files")
    for path in named_paths(text):
        report.claim(exists(path), f"README.md names {path}, which is not there")
    report.claim(not exists("src/nowhere.c"), "a missing file passes for a present one")
    check_table(report, "src/review")
    check_table(report, "src/path")
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
