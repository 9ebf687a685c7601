# SPDX-License-Identifier: Apache-2.0
"""steps.py -- a step of tests/long.sh is run again when a file changes that it depends on: with
a folder it names all that the folder includes, as layers.txt has it, and the tests that it
runs. src/cli/ (the commands' own files, which know every room) hands on and is let off.
What steps.sh keeps, lists and leaves out is tried on four steps of a project of their own."""
import os
import re
import shutil
import subprocess
import tempfile
import xml.etree.ElementTree as ElementTree

from layers import allowed_includes
from report import ROOT, Report, read

ASSIGNED = re.compile(r'^(\w+)=(["\'])(.*?)\2', re.M | re.DOTALL)
STEP = re.compile(r"^ *(of|run|start|needs) (.*(?:\\\n.*)*)", re.M)
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


SCRIPT_OF_STEPS = (
    '. tests/steps.sh\n'
    'build() { echo "$@"; }\n'
    'keep_steps "$@"\n'
    'of src\n'
    'run one one sh src/one.sh\n'
    "of 'shaders scenes/'\n"
    "start 'two & <more>' two sh shaders/two.sh\n"
    "start three three sh -c 'sleep 0.3; echo 3 passed, 0 failed'\n"
    'gather\n'
    "needs 'native all'\n"
    "run four four sh -c 'echo 0 passed, 1 failed; exit 1'\n"
    'finish\n'
)
NAMES = ("src", "shaders", "scenes", "assets", "tests", "third_party")
FILES = ("CMakeLists.txt", "CMakePresets.json", "README.md", "CONTRIBUTING.md")


class Steps:
    """A project of its own with four steps."""

    def __init__(self, folder):
        self.folder = folder
        for name in NAMES:
            os.mkdir(os.path.join(folder, name))
        for name in FILES:
            self.write(name, name)
        shutil.copy(os.path.join(ROOT, "tests", "steps.sh"), os.path.join(folder, "tests"))
        self.write("src/one.sh", "echo 1 passed, 0 failed")
        self.write("shaders/two.sh", "echo 2 passed, 0 failed, 1 skipped")
        self.write("steps.sh", SCRIPT_OF_STEPS)
        self.write(".gitignore", ".build")
        self.git("init", "-q")
        self.commit()

    def write(self, name, text):
        with open(os.path.join(self.folder, name), "w", encoding="utf-8") as file:
            file.write(text + "\n")

    def git(self, *words):
        own = {name: value for name, value in os.environ.items()
               if not name.startswith("GIT_")}  # a hook's say which repository is meant
        subprocess.run(["git", "-c", "user.name=a", "-c", "user.email=a@b", *words], check=True,
                       cwd=self.folder, capture_output=True, env=own)

    def commit(self):
        self.git("add", "-A")
        self.git("commit", "-q", "--allow-empty", "-m", "x")

    def run(self, *options):
        """Step -> what its line says; None: the count, as it is printed."""
        done = subprocess.run(["sh", "steps.sh", *options], cwd=self.folder, text=True,
                              capture_output=True, check=False)
        said = {}
        for line in done.stdout.splitlines():
            words = line.split(None, 1)
            if words[0] in ("one", "two", "three", "four"):
                said[words[0]] = re.sub(r" +", " ", words[1]).removeprefix("& <more> ")
        return said, done.stdout.splitlines()[-1] if done.stdout else "", done.returncode


def check_junit(report, folder):
    cases = ElementTree.parse(os.path.join(folder, ".build/logs/junit.xml")).getroot()
    found = [(case.get("name"), case.find("failure") is not None) for case in cases]
    report.claim(sorted(found) == [("build: native all", False), ("four", True), ("one", False),
                                   ("three", False), ("two & <more>", False)],
                 f"JUnit: {found}")
    report.claim(all(case.get("time").isdigit() for case in cases),
                 "JUnit: a time is no number")


def check_running(report):
    with tempfile.TemporaryDirectory() as folder:
        steps = Steps(folder)
        said, count, status = steps.run()
        report.claim(count == "7 passed, 1 failed" and status == 1, f"first run: {count}")
        check_junit(report, folder)
        report.claim(said.get("four", "").startswith("0 passed 1 failed"),
                     f"a step before which something was built: {said}")
        report.claim(re.match(r"2 passed 0 failed 1 skipped \(\d+ s,", said["two"]),
                     f"two: {said['two']}")
        said, count, _ = steps.run()
        kept = [name for name, words in said.items() if "kept" in words]
        report.claim(kept == ["one", "two", "three"] and count == "7 passed, 1 failed",
                     f"kept: {said}, {count}")
        check_junit(report, folder)
        steps.write("shaders/two.sh", "echo 5 passed, 0 failed")
        said, _, _ = steps.run("--list")
        report.claim([words.split(",")[0] for words in said.values()] ==
                     ["fresh", "stale", "stale", "never run"], f"list: {said}")
        steps.commit()
        steps.write("src/one.sh", "echo 7 passed, 0 failed")
        steps.write("scenes/x", "of no step: folders in it are")
        steps.commit()
        said, count, _ = steps.run("--changed")
        report.claim(said["one"].startswith("7 passed") and said["two"].startswith("5 passed"),
                     f"changed: {said}")
        steps.write("src/one.sh", "echo 8 passed, 0 failed")
        steps.write("shaders/two.sh", "echo 6 passed, 0 failed")
        steps.commit()
        steps.write("src/one.sh", "echo 9 passed, 0 failed")
        steps.commit()
        said, count, _ = steps.run("--changed")
        report.claim(said["one"].startswith("9 passed") and said["two"] == "not reached",
                     f"changed since the last commit: {said}")
        _, _, status = steps.run("--change")
        report.claim(status == 2, f"an unknown option: {status}")


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
    check_running(report)
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
