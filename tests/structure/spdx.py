# SPDX-License-Identifier: Apache-2.0
"""spdx.py [--write] -- every source says its licence: one line, the project's, near its start.

`SPDX-License-Identifier: Apache-2.0`, in the file's own kind of comment. With --write the line
is put where it is missing.
"""
import os
import sys

from report import ROOT, Report, project_files, read

LINE = "SPDX-License-Identifier: " + "Apache-2.0"  # in two parts: this is not its own line
BLOCK = (".c", ".h", ".cpp", ".hpp", ".css", ".js")
SHARP = (".py", ".sh", ".sbatch", ".cmake", ".bash", "CMakeLists.txt", ".ci/run")
WITHIN = 3  # lines from the start: an interpreter's line comes first


def comment(name):
    return f"/* {LINE} */" if name.endswith(BLOCK) else f"# {LINE}"


def is_marked(name, text):
    return comment(name) in text.splitlines()[:WITHIN]


def marked(name, text):
    """The text with the line as its first one, behind an interpreter's."""
    first, rest = "", text
    if text.startswith("#!"):
        first, _, rest = text.partition("\n")
        first += "\n"
    return f"{first}{comment(name)}\n{rest}"


def sources():
    return [name for name in project_files() if name.endswith((*BLOCK, *SHARP))
            and not name.startswith("tests/fuzz/found/")]


def write(names):
    for name in names:
        text = read(name)
        if not is_marked(name, text):
            with open(os.path.join(ROOT, name), "w", encoding="utf-8") as file:
                file.write(marked(name, text))


def check_itself(report):
    for name, text in (("a.c", "int a;\n"), ("b.sh", "#!/bin/sh\nls\n"), ("c.py", '"""c"""\n')):
        report.claim(not is_marked(name, text), f"{name}: none passes for a line")
        report.claim(is_marked(name, marked(name, text)), f"{name}: the line is not found")
    report.claim(marked("b.sh", "#!/bin/sh\nls\n").startswith("#!/bin/sh\n# "),
                 "an interpreter's line does not come first")
    report.claim("Apache License" in read("LICENSE") and "Version 2.0" in read("LICENSE"),
                 "LICENSE is another one")


def main():
    names = sources()
    if "--write" in sys.argv:
        write(names)
    report = Report()
    report.claim(len(names) > 1000, f"{len(names)} sources only")
    report.claim_none("sources without the line of their licence", [
        name for name in names if not is_marked(name, read(name))])
    check_itself(report)
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
