# SPDX-License-Identifier: Apache-2.0
"""source.py -- sizes of functions, files and lines; what must not stand in committed files."""
import json
import os
import re
import subprocess
import sys

from report import ROOT, Report, project_files, read, sources

LONGEST_FUNCTION, LONGEST_FILE, LONGEST_LINE, MOST_PARAMETERS = 100, 800, 100, 6
HAND_WRITTEN = (".c", ".h", ".cpp", ".py", ".sh", ".txt", ".md")
SCRIPTS = (".sh", "CMakeLists.txt", "CMakePresets.json", ".ci/run", "third_party/packages")
# Written in two halves, so that this file passes its own check.
MACHINE_PATH = re.compile("(?<![\\w.}])/" + "(work|tmp|home|root|mnt|Users)/[\\w.]")
HOST = re.compile("(?:http|ftp)s?:/" + "/")
UNFINISHED = re.compile(r"\b(TO" "DO|FIX" "ME|XX" r"X)\b")


def exceptions(limit):
    lines = [line.split() for line in read("tests/structure/exceptions.txt").splitlines()]
    return {words[1] for words in lines if len(words) > 2 and words[0] == limit}


def functions(names):
    """(name, file, line, lines, parameters) of every function, by ctags."""
    tags = subprocess.run(
        ["ctags", "--output-format=json", "--fields=+neS", "--kinds-C=f", "--kinds-C++=f",
         "-o", "-", *names], cwd=ROOT, capture_output=True, check=True, text=True).stdout
    for line in tags.splitlines():
        tag = json.loads(line)
        if "end" in tag:
            length = tag["end"] - tag["line"] + 1
            count = parameter_count(tag.get("signature", "()"))
            yield tag["name"], tag["path"], tag["line"], length, count


def parameter_count(signature):
    inside = signature.strip()[1:-1].strip()
    while re.search(r"\([^()]*\)|\[[^\[\]]*\]|<[^<>]*>", inside):
        inside = re.sub(r"\([^()]*\)|\[[^\[\]]*\]|<[^<>]*>", "", inside)
    return 0 if inside in ("", "void") else inside.count(",") + 1


def check_functions(report):
    found = list(functions(sources(".c", ".h", ".cpp")))
    lengths = [length for _, _, _, length, _ in found]
    print(f"{len(lengths)} functions, the longest of {max(lengths)} lines")
    report.claim_none(f"functions above {LONGEST_FUNCTION} lines", [
        f"{path}:{line}: {name} has {length} lines" for name, path, line, length, _ in found
        if length > LONGEST_FUNCTION and name not in exceptions("function")])
    report.claim_none(f"functions of more than {MOST_PARAMETERS} parameters", [
        f"{path}:{line}: {name} has {count} parameters" for name, path, line, _, count in found
        if count > MOST_PARAMETERS and name not in exceptions("parameters")])


def check_lines(report):
    wide, long, unfinished, dead = [], [], [], []
    for name in project_files():
        if not name.endswith(HAND_WRITTEN):
            continue
        lines = read(name).splitlines()
        if not name.endswith((".md", ".txt")):
            if not name.endswith((".c", ".h", ".cpp")):  # format.py has those
                wide += [f"{name}:{i}: {len(line)} columns" for i, line in enumerate(lines, 1)
                         if len(line) > LONGEST_LINE and name not in exceptions("columns")]
            unfinished += [f"{name}:{i}: {line.strip()}" for i, line in enumerate(lines, 1)
                           if UNFINISHED.search(line)]
        dead += [f"{name}:{i}: #if 0" for i, line in enumerate(lines, 1)
                 if re.match(r"\s*#\s*if\s+0\b", line)]
        if (name.endswith((".c", ".h", ".cpp")) and len(lines) > LONGEST_FILE
                and name not in exceptions("file")):
            long.append(f"{name}: {len(lines)} lines")
    report.claim_none(f"lines above {LONGEST_LINE} columns", wide)
    report.claim_none(f"files above {LONGEST_FILE} lines", long)
    report.claim_none("unfinished business", unfinished)
    report.claim_none("dead code", dead)


def check_places(report):
    """Machines' paths anywhere, hosts in what builds, C++ outside the wrappers."""
    paths, hosts, foreign = [], [], []
    for name in project_files():
        with open(os.path.join(ROOT, name), "rb") as file:
            text = file.read().decode("latin-1")
        paths += [f"{name}:{text.count(chr(10), 0, match.start()) + 1}: {match[0]}"
                  for match in MACHINE_PATH.finditer(text) if is_text_or_path(text, match)]
        if name.endswith(SCRIPTS):
            hosts += [f"{name}: {text[match.start():match.end() + 30].splitlines()[0]}"
                      for match in HOST.finditer(text)]
        is_foreign = name.endswith((".cpp", ".cc", ".cxx", ".hpp"))
        if is_foreign and not name.startswith("third_party/"):
            foreign.append(name)
    report.claim_none("paths of somebody's machine", paths)
    report.claim_none("hosts in what builds and installs", hosts)
    report.claim_none("C++ outside third_party", foreign)


def is_text_or_path(text, match):
    """A path, rather than chance bytes of a picture: what stands around it is printable."""
    around = text[max(0, match.start() - 2):match.end() + 6]
    return all(" " <= letter <= "~" or letter in "\r\n\t" for letter in around)


def check_itself(report):
    report.claim(MACHINE_PATH.search(" /" + "work/x") is not None, "machine paths are not seen")
    report.claim(UNFINISHED.search("/* TO" "DO */") is not None, "unfinished business not seen")
    report.claim(parameter_count("(int a, void (*f)(int, int), T<x, y> b)") == 3,
                 "parameters are miscounted")


def main():
    report = Report()
    check_functions(report)
    check_lines(report)
    check_places(report)
    check_itself(report)
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
