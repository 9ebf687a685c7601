# SPDX-License-Identifier: Apache-2.0
"""planted.py [ROOM...] -- faults planted one at a time in a copy of the project: the unit test
that planted.txt names beside each must fail. Rooms are folders of src/, and shaders; without
one all rows are tried.

How a row and the source are broken into lines does not matter. A row that no longer fits the
source is a failure, as is a fault that does not build; a test that crashes or does not end has
found its fault. The copy lies in .build/planted and stays, so that the next run builds only
what has changed.
"""
import os
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections import namedtuple

from layers import allowed_includes, folder_of
from report import ROOT, Report, places, project_files, prune, read, sources

TABLE = "tests/structure/planted.txt"
COPY = os.path.join(ROOT, ".build", "planted")
BUILD = os.path.join(COPY, ".build", "release")
PATIENCE_S = 60  # and twenty times what the test takes unplanted

# what: the fault in words; there: what stands once in the file; planted: what replaces it.
Row = namedtuple("Row", "file test what there planted")


def room_of(row):
    return "shaders" if row.file.startswith("shaders/") else row.file.split("/")[1]


def read_rows(text):
    """Blocks of three lines: "FILE TEST what is wrong", "- there", "+ planted"."""
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith("#")]
    for head, there, planted in zip(*[iter(lines)] * 3, strict=True):
        if there[:2] != "- " or planted[:2] != "+ ":
            raise ValueError(f"{TABLE}: after {head!r} a line with - and one with + are "
                             f"required")
        yield Row(*head.split(None, 2), there[2:], planted[2:])


def by_layers(rows):
    """From the upper layers down: what is taken back is then seldom built again. Rows of one
    test follow each other, so that it is linked as often as there are faults for it."""
    layers = list(allowed_includes())
    return sorted(rows, key=lambda row: (-layers.index(folder_of(row.file, layers)), row.test,
                                         row.file))


# ---- the copy ----

def get(name):
    path = os.path.join(COPY, name)
    if not os.path.isfile(path):
        return ""
    with open(path, encoding="utf-8", newline="") as file:
        return file.read()


def put(name, text):
    with open(os.path.join(COPY, name), "w", encoding="utf-8", newline="") as file:
        file.write(text)


def is_same(one, other):
    if not os.path.isfile(other):
        return False
    with open(one, "rb") as a, open(other, "rb") as b:
        return a.read() == b.read()


def copy_project():
    """Files that are the same already keep their time, so that nothing is built again."""
    names = project_files()
    for name in names:
        path = os.path.join(COPY, name)
        if is_same(os.path.join(ROOT, name), path):
            continue
        os.makedirs(os.path.dirname(path), exist_ok=True)
        shutil.copy(os.path.join(ROOT, name), path)
    known = set(names)
    for folder, folders, files in os.walk(COPY):
        prune(folders)
        for name in files:
            path = os.path.join(folder, name)
            if os.path.relpath(path, COPY) not in known:
                os.remove(path)


# ---- building and running ----

def build(*targets):
    """None, or what the compiler said."""
    done = subprocess.run(["cmake", "--build", BUILD, "-j", str(os.cpu_count()), "--target",
                           *targets], capture_output=True, text=True, check=False)
    return None if done.returncode == 0 else (done.stdout + done.stderr)[-800:]


def no_core():
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def run_test(test, limit_s):
    """What became of it, "passed" if it found nothing, and the seconds."""
    begun = time.monotonic()
    with tempfile.TemporaryDirectory(dir=BUILD) as folder:
        try:
            done = subprocess.run([os.path.join(BUILD, f"test_{test}")], cwd=BUILD,
                                  env=dict(os.environ, TMPDIR=folder), preexec_fn=no_core,
                                  capture_output=True, timeout=limit_s, check=False)
        except subprocess.TimeoutExpired:
            return "ran out of time", limit_s
    became = ("passed" if done.returncode == 0 else
              f"ended by signal {-done.returncode}" if done.returncode < 0 else "failed")
    return became, time.monotonic() - begun


def run_unplanted(report, tests):
    """Test -> seconds, of those that pass."""
    seconds = {}
    said = build(*(f"test_{test}" for test in tests))
    report.claim(not said, f"unplanted nothing is built: {said}")
    print(f"{len(tests)} test programs are built", flush=True)
    for test in tests if not said else []:
        became, taken_s = run_test(test, 600)
        if report.claim(became == "passed", f"{test}: {became} with nothing planted"):
            seconds[test] = taken_s
    return seconds


def try_row(report, row, limit_s):
    name = f"{row.file}, {row.what}"
    text = get(row.file)
    found = places(row.there, text)
    if len(found) != 1:
        now = [file for file in sources(".c", ".h") if places(row.there, get(file))]
        report.claim(False, f"{name}: {len(found)} times {row.there!r}; now in "
                            f"{now or 'no file'}")
        return "does not fit"
    put(row.file, text[:found[0].start()] + row.planted + text[found[0].end():])
    try:
        said = build(f"test_{row.test}")
        if not report.claim(not said, f"{name}: is not built: {said}"):
            return "is not built"
        became, taken_s = run_test(row.test, limit_s)
    finally:
        put(row.file, text)
    report.claim(became != "passed", f"{name}: {row.test} does not find it")
    return f"{row.test} {became}, {taken_s:.1f} s"


def main():
    report, begun = Report(), time.monotonic()
    rows = by_layers(read_rows(read(TABLE)))
    rooms = {room_of(row) for row in rows}
    unknown = [room for room in sys.argv[1:] if room not in rooms]
    if unknown:
        sys.exit(f"planted: {unknown[0]}: required: some of {', '.join(sorted(rooms))}")
    rows = [row for row in rows if room_of(row) in (sys.argv[1:] or rooms)]
    copy_project()
    subprocess.run(["cmake", "--preset", "release"], cwd=COPY, stdout=subprocess.DEVNULL,
                   check=True)
    seconds = run_unplanted(report, sorted({row.test for row in rows}))
    print(f"{len(seconds)} tests pass unplanted, {time.monotonic() - begun:.0f} s", flush=True)
    for i, row in enumerate(rows):
        if row.test not in seconds:
            report.claim(False, f"{row.file}, {row.what}: not tried")
            continue
        became = try_row(report, row, PATIENCE_S + 20 * seconds[row.test])
        print(f"{i + 1} of {len(rows)}, {time.monotonic() - begun:.0f} s: {row.file}, "
              f"{row.what}: {became}", flush=True)
    report.finish()


if __name__ == "__main__":
    main()
