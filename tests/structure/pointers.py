# SPDX-License-Identifier: Apache-2.0
"""pointers.py -- comments, pages and scripts point only to what is in the repository.

A word that looks like a path of ours (src/..., assets/..., panel/query/panel.h, README.md) must
name a file or a folder: from the root, from the file's own folder, from src, or any file whose
path ends so. Nothing may point to a design that lies elsewhere.
"""
import os
import re
import sys

from report import Report, project_files, read

TOP = ("src", "shaders", "scenes", "assets", "tests", "third_party", ".ci")
WORD = re.compile(r"(?<![\w./{}$<>*\-])((?:[\w-]+|\.{1,2}|\.ci)(?:/[\w.+*-]+)*)(?![\w{}<>])")
ENDINGS = (".h", ".c", ".hpp", ".cpp", ".md", ".py", ".sh", ".cmake")
DESIGN = re.compile(r"\bdesign: ?[a-z]|shared/design|\bdesign documents?\b", re.I)
COMMENT_C = re.compile(r"/\*.*?\*/|//[^\n]*", re.S)
COMMENT_SCRIPT = re.compile(r"^\s*#[^\n]*|\"\"\".*?\"\"\"|\s# [^\n]*", re.S | re.M)
# Names that are not of this repository, or that stand for any: what a reader is to put there.
FOREIGN = {"config.h", "packages.h", "libm.so"}
PLACEHOLDER = re.compile(r"/[A-Z]{4,}\b(?!\.md|\.json)|NAME|\bX\.|\.\.\.")
MADE = ("tests/fuzz/corpus",)


def comments(name, text):
    """(offset, text) of what speaks to people in a file."""
    if name.endswith(".md"):
        return [(0, text)]
    if name.endswith((".c", ".h", ".cpp", ".hpp")):
        return [(m.start(), m[0]) for m in COMMENT_C.finditer(text)]
    if name.endswith((".py", ".sh", ".cmake", ".txt")):
        return [(m.start(), m[0]) for m in COMMENT_SCRIPT.finditer(text)]
    return []


def pointers(text):
    """(offset, path) of the words that look like paths of ours, braces and lists left alone."""
    for match in WORD.finditer(text):
        word = match[1].rstrip(".")
        first = word.split("/")[0]
        if "*" in word or PLACEHOLDER.search(word) or word in FOREIGN:
            continue
        if ("/" in word and first in TOP) or word.endswith(ENDINGS):
            yield match.start(), word


class Tree:
    """What the repository holds."""

    def __init__(self, names):
        self.paths = set(names)
        self.names = {os.path.basename(name) for name in names}
        for name in names:
            while os.path.dirname(name):
                name = os.path.dirname(name)
                self.paths.add(name)

    def has(self, word, folder):
        word = word.rstrip("/")
        if "/" not in word and word in self.names:
            return True
        places = ("", folder, "src", os.path.dirname(folder))
        return any(os.path.normpath(os.path.join(place, word)) in self.paths
                   for place in places) or any(path.endswith("/" + word) for path in self.paths)


def faults(name, text, tree):
    found = []
    for start, part in comments(name, text):
        for match in DESIGN.finditer(part):
            found.append((start + match.start(), f"points to a design: {match[0]}"))
        for offset, word in pointers(part):
            if not tree.has(word, os.path.dirname(name)):
                found.append((start + offset, f"{word} is not there"))
    return [f"{name}:{text.count(chr(10), 0, at) + 1}: {what}" for at, what in found]


def check_itself(report, tree):
    made_up = "/* as src/nowhere/nothing.h says (de" "sign: panel, section 7) */"
    report.claim(len(faults("src/base/x.c", made_up, tree)) == 2, "made-up pointers pass")
    report.claim(faults("a.md", "see `assets/nothing.md`", tree) != [], "a made-up page passes")
    true = "/* src/base/arena.h, arena.h, base/arena.h */"
    report.claim(not faults("src/base/x.c", true, tree), "true pointers fail")


def main():
    report = Report()
    names = project_files()
    tree = Tree(names)
    found = []
    for name in names:
        if name.startswith(MADE) or not name.endswith((*ENDINGS, ".txt")):
            continue
        if name != "tests/structure/pointers.py":
            found += faults(name, read(name), tree)
    report.claim_none("pointers to what is not in the repository", found)
    check_itself(report, tree)
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
