# SPDX-License-Identifier: Apache-2.0
"""models.py -- a surface model is known by its own files, the list in shaders/bsdf.h, and who
makes one of a material: so that another one takes the six files that CONTRIBUTING.md lists. Two
layers of a material stand for all of them: few files name them."""
import re
import sys

from report import Report, read, sources

MAKER = "src/surface/surface.c"
LIST = "shaders/bsdf.h"


def models():
    """(KIND, name) of every line of BSDF_MODELS."""
    listed = read(LIST).partition("#define BSDF_MODELS")[2]
    return re.findall(r"MODEL\(([A-Z_]+), (\w+), \w+\)", listed)


def named(kind, name, text):
    """What of a model a source names: its kind, its table, its member of Bsdf, its maker."""
    words = rf"\bBSDF_{kind}\b|\b{name}_model\b|bsdf(?:\.|->){name}\b|\bbsdf_be_{name}\b"
    return re.findall(words, text)


def listed_files(title="A surface model"):
    """Of a recipe's list in CONTRIBUTING.md."""
    text = read("CONTRIBUTING.md").partition(f"**{title}**")[2].partition("\n\n")[0]
    return re.findall(r"^\d+\. `([\w./]+)`", text, re.MULTILINE)


# Struct, file, its calls at most: a table that everybody fills grows by one row a case.
TABLES = [
    ("BsdfScatter", "shaders/bsdf_model.h", 5), ("BsdfBoundary", "shaders/bsdf_model.h", 3),
    ("BsdfModel", "shaders/bsdf_model.h", 4), ("PathSteering", "src/path/path_collector.h", 6),
    ("CollectorKind", "src/path/path_collector.h", 10),
]


# The layers of a material that only their own files, and the rows that bring them in, name: a
# word, and how many C files may.
LAYER_WORDS = [("sheen", 8), ("iridesc", 8)]


def files_with(word, texts):
    """Which of {path: text} hold the word, in whatever case."""
    return sorted(path for path, text in texts.items() if word in text.lower())


def calls(struct, text):
    """How many functions a struct points to."""
    body = re.search(rf"typedef struct {struct} {{(.*?)\n}} {struct};", text, re.S)
    return len(re.findall(r"\(\*\w+\)\(", body.group(1))) if body else 0


def main():
    report, names = Report(), sources(".c", ".h")
    found = models()
    report.claim(len(found) >= 5, f"models: {found}")
    for kind, name in found:
        outside = [path for path in names if not path.startswith(("shaders/", "tests/"))
                   and named(kind, name, read(path))]
        report.claim(outside == [MAKER], f"{name} is named in {outside}, required: {MAKER} "
                                         f"alone")
    listed = listed_files()
    report.claim(len(listed) <= 6 and MAKER in listed and LIST in listed,
                 f"CONTRIBUTING.md lists {listed} for a surface model")
    for struct, path, most in TABLES:
        found = calls(struct, read(path))
        report.claim(0 < found <= most, f"{path}: {struct} has {found} calls, required: 1 to "
                                        f"{most}")
    texts = {path: read(path) for path in names
             if path.startswith(("src/", "shaders/", "third_party/"))}
    for word, most in LAYER_WORDS:
        found = files_with(word, texts)
        report.claim(0 < len(found) <= most, f"{word} is named in {len(found)} files, required "
                                             f"1 to {most}: {found}")
    report.claim(files_with("a", {"x": "BA", "y": "b"}) == ["x"],
                 "a word in another case is not seen")
    report.claim(calls("T", "typedef struct T {\n int (*a)(int);\n int b;\n} T;") == 1,
                 "calls are not counted")
    report.claim(named("A", "a", "bsdf.a x; BSDF_A; b_model") == ["bsdf.a", "BSDF_A"],
                 "what names a model is not seen")
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
