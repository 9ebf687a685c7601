# SPDX-License-Identifier: Apache-2.0
"""modules.py -- the module is the file: a public function is declared in the header of its own
file's name, somebody in the product calls it, no two structs share a name, and no two files
of a folder need each other. What may differ stands in exceptions.txt with its reason."""
import json
import os
import re
import subprocess
import sys
from collections import Counter, defaultdict

from report import ROOT, Report, project_files, read, sources
from source import exceptions

MOST_FILES = 38  # in a folder
OUTSIDE = "src/library/"  # other programs call what stands there
NOT_CODE = re.compile(r'/\*.*?\*/|//[^\n]*|"(?:\\.|[^"\\\n])*"', re.DOTALL)
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*"([^"]+)"', re.M)


def project_c(folder):
    return [name for name in project_files()
            if name.startswith(folder + "/") and name.endswith((".c", ".h"))]


def stem(name):
    return os.path.splitext(name)[0]


class Tree:
    """The sources as modules: `functions` maps a public function to its file and line,
    `declared` to the headers that declare it, `structs` a name to the files that define it."""

    def __init__(self, texts):
        self.texts = texts
        code = {name: NOT_CODE.sub(" ", text) for name, text in texts.items()}
        self.words = {name: Counter(re.findall(r"\w+", text)) for name, text in code.items()}
        self.functions, self.declared, self.structs = {}, defaultdict(list), defaultdict(set)
        self.inline = {}
        for tag in tags(texts):
            name, path, kind = tag["name"], tag["path"], tag["kind"]
            is_header = path.endswith(".h")
            if kind == "function" and is_header:
                self.inline[name] = path
            elif kind == "function" and name != "main" and not is_local(tag):
                self.functions[name] = path, tag["line"]
            elif kind == "prototype" and is_header:
                self.declared[name].append(path)
            elif kind == "struct" and not name.startswith("__anon"):
                self.structs[name].add(path)

    def place(self, name):
        path, line = self.functions[name]
        return f"{path}:{line}: {name}"

    def foreign(self):
        """Public functions that the header of their file's name does not declare."""
        return [f"{self.place(name)} is declared in {', '.join(self.declared[name]) or 'none'}"
                for name, (path, _) in self.functions.items()
                if stem(path) + ".h" not in self.declared[name]]

    def uses(self, name, home):
        """How often the name stands in the file of its definition, and elsewhere; neither
        definition nor declarations are uses."""
        inside = self.words[home][name] - 1
        everywhere = sum(words[name] for words in self.words.values()) - 1
        return inside, everywhere - inside - len(self.declared[name])

    def uncalled(self):
        allowed = exceptions("uncalled")
        used = {name: self.uses(name, path) for name, (path, _) in self.functions.items()
                if not path.startswith(OUTSIDE)}
        never = [self.place(name) for name, (inside, outside) in used.items()
                 if inside + outside <= 0 and name not in allowed]
        never += [f"{path}: {name}" for name, path in self.inline.items()
                  if sum(self.uses(name, path)) <= 0]
        tested = set(re.findall(r"\w+", " ".join(map(read, project_c("tests")))))
        alone = [self.place(name) for name, (inside, outside) in used.items()
                 if inside > 0 >= outside and name not in tested]
        return never, alone

    def ambiguous(self):
        return [f"{name}: {', '.join(sorted(paths))}" for name, paths in self.structs.items()
                if len(paths) > 1]

    def needs(self):
        """module -> modules whose header it includes or whose function it calls."""
        edges = defaultdict(set)
        for name, text in self.texts.items():
            for header in INCLUDE.findall(text):
                places = (os.path.normpath(os.path.join(folder, header))
                          for folder in (os.path.dirname(name), "src", ".", "third_party"))
                found = next((place for place in places if place in self.texts), None)
                if found:
                    edges[stem(name)].add(stem(found))
        for function, (path, _) in self.functions.items():
            for name, words in self.words.items():
                if not name.endswith(".h") and words[function]:
                    edges[stem(name)].add(stem(path))
        return edges


def is_local(tag):
    return tag.get("file") or tag.get("scope")  # static, or in a namespace without a name


def tags(texts):
    listed = subprocess.run(
        ["ctags", "--output-format=json", "--fields=+nefs", "--kinds-C=fps", "--kinds-C++=fps",
         "-o", "-", *texts], cwd=ROOT, capture_output=True, check=True, text=True).stdout
    return map(json.loads, listed.splitlines())


def circles(edges):
    """Groups of modules each of which needs all others (Tarjan's strongly connected sets)."""
    number, low, stack, found = {}, {}, [], []

    def visit(node):
        number[node] = low[node] = len(number)
        stack.append(node)
        for other in edges.get(node, ()):
            if other not in number:
                visit(other)
            if other in stack:
                low[node] = min(low[node], low[other])
        if low[node] == number[node]:
            group = stack[stack.index(node):]
            del stack[stack.index(node):]
            if len(group) > 1:
                found.append(sorted(group))

    for node in sorted(edges):
        if node not in number:
            visit(node)
    return found


def crowded(names):
    count = Counter(os.path.dirname(name) for name in names)
    return [f"{folder}: {files} files" for folder, files in count.items() if files > MOST_FILES]


def check_itself(report):
    ring = {"a": {"b"}, "b": {"c"}, "c": {"a"}, "d": {"a"}}
    report.claim(circles(ring) == [["a", "b", "c"]], f"circles: {circles(ring)}")
    report.claim(not circles({"a": {"b"}, "b": set()}), "a circle where there is none")
    report.claim(crowded(["x/a.c"] * 39) and not crowded(["x/a.c"] * 38),
                 "files are miscounted")


def main():
    sys.setrecursionlimit(10000)
    report = Report()
    check_itself(report)
    names = sources(".c", ".h", ".cpp")
    tree = Tree({name: read(name) for name in names})
    never, alone = tree.uncalled()
    report.claim(len(tree.functions) > 300, f"only {len(tree.functions)} public functions seen")
    report.claim_none("public functions that the header of their file does not declare",
                      tree.foreign())
    report.claim_none("functions that nothing but tests calls", never)
    report.claim_none("functions that no other file and no test calls, and are not static",
                      alone)
    report.claim_none("structs of one name", tree.ambiguous())
    report.claim_none("files that need each other in a circle", [
        "; ".join(group) for group in circles(tree.needs())
        if not set(group) & exceptions("circle")])
    report.claim_none(f"folders of more than {MOST_FILES} files", crowded(names))
    report.finish()


if __name__ == "__main__":
    main()
