# SPDX-License-Identifier: Apache-2.0
"""layers.py -- an include may only point downwards: layers.txt says to where. Paths are sent out
by one room, whoever asks what they find."""
import os
import re
import sys

from report import ROOT, Report, read, sources

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(["<])([^">]+)[">]', re.M)
C_LIBRARY = re.compile(r"^(sys/|linux/)?[a-z_0-9]+(\.h)?$")  # <math.h>, <sys/stat.h>, <vector>
SEARCH = ("src", ".", "third_party")
SENDS = re.compile(r"\bkernel(?:->|\.)(?:trace|look)\(")  # of src/kernel/kernel.h
SENDER = "src/probe/probe.c"


def allowed_includes():
    table = {}
    for line in read("tests/structure/layers.txt").splitlines():
        if line.strip() and not line.startswith("#"):
            folder, may = line.split(":")
            table[folder.strip()] = may.split()
    return table


def folder_of(name, table):
    """The folder with the longest name that the file stands in."""
    return max((folder for folder in table if name.startswith(folder + "/")), key=len,
               default=None)


def resolve(including, header):
    """The project's file that an include means, or None."""
    places = [os.path.dirname(including)] + list(SEARCH)
    for place in places:
        name = os.path.normpath(os.path.join(place, header))
        if os.path.isfile(os.path.join(ROOT, name)):
            return name
    return None


def fault(table, name, quote, header):
    """Why this include is wrong; None when it is right."""
    folder = folder_of(name, table)
    foreign = [entry[1:-1] for entry in table[folder] if entry.startswith("<")]
    if quote == "<":
        stem = header.split("/")[0].split(".")[0]
        if stem in foreign:
            return None
        others = {e[1:-1] for may in table.values() for e in may if e.startswith("<")}
        if stem in others or not C_LIBRARY.match(header):
            return f"<{header}> is not a library of {folder}"
        return None
    target = resolve(name, header)
    if target is None:
        return f'"{header}" is no file of the project'
    place = folder_of(target, table)
    if place != folder and place not in table[folder] and target not in table[folder]:
        return f"{folder} may not include {target}"
    return None


def downwards(table):
    """The list itself: a folder may only name folders that stand above it in the list,
    or wrappers."""
    faults, seen = [], []
    for folder, may in table.items():
        for entry in may:
            is_below = entry in seen or entry.endswith(".h") and os.path.dirname(entry) in seen
            if entry[0] != "<" and not entry.startswith("third_party/") and not is_below:
                faults.append(f"layers.txt: {folder} names {entry}, which does not lie below")
        seen.append(folder)
    return faults


def main():
    report, table, faults = Report(), allowed_includes(), []
    senders = {name for name in sources(".c", ".h")
               if name.startswith("src/") and SENDS.search(read(name))}
    report.claim(senders == {SENDER}, f"the kernel traces and looks for {sorted(senders)}")
    report.claim_none("layers point downwards", downwards(table))
    for name in sources(".c", ".h", ".cpp"):
        if folder_of(name, table) is None:
            faults.append(f"{name}:1: its folder is not in layers.txt")
            continue
        text = read(name)
        for match in INCLUDE.finditer(text):
            wrong = fault(table, name, match[1], match[2])
            if wrong:
                line = text.count("\n", 0, match.start()) + 1
                faults.append(f"{name}:{line}: {wrong}")
    report.claim_none("includes that point upwards or sideways", faults)
    canary = fault(table, "src/base/error.c", '"', "scene/scene.h")
    report.claim(canary is not None, "an include upwards was not noticed")
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
