# SPDX-License-Identifier: Apache-2.0
"""equip.py PARHELION -- every model of the shared data that can be loaded becomes a scene with
a display and an eye in it that `check` and `review --dry-run` take, far from the model, and
some become pages; one that cannot be loaded is refused in a line, and nothing is left behind.

Without the shared data it is skipped.
"""
import glob
import json
import os
import shlex
import subprocess
import sys
import tempfile

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

DATA = os.path.join(ROOT, "..", "shared", "data", "gltf")
PAGES = 8  # of so many models one becomes a page: each takes half a second
LARGEST = 4 << 20  # bytes of a model: larger ones are equipped by tests/page/equip.py
EQUIP = {"equip": 1,
         "displays": [{"name": "the display", "centre_m": [0, 1, 0], "right": [1, 0, 0],
                       "up": [0, 1, 0], "width_m": 0.3, "height_m": 0.1,
                       "panel": "ips_cluster", "content": "cluster"}],
         "eyes": [{"name": "the eye", "position_m": [0, 1.2, 1], "looks_at": "the display"}]}


def models():
    found = glob.glob(os.path.join(DATA, "**", "*.gl*"), recursive=True)
    return sorted(path for path in found if path.endswith((".gltf", ".glb")) and
                  os.path.getsize(path) <= LARGEST)


def run(program, folder, *line):
    return subprocess.run([program, *line], cwd=folder, capture_output=True, timeout=300,
                          text=True, errors="replace", check=False)


def faults_of(done):
    return [line for line in done.stderr.splitlines() if ": warning: " not in line]


def check_refused(report, program, folder, path, name):
    done = run(program, folder, "equip", path, "--with", "e.json", "-o", "scene.gltf")
    report.claim(done.returncode == 3 and len(faults_of(done)) == 1,
                 f"{name}: {done.returncode} {done.stderr}")
    report.claim(os.listdir(folder) == ["e.json"], f"{name} leaves {os.listdir(folder)}")


def check_equipped(report, program, folder, path, name):
    done = run(program, folder, "equip", path, "--with", "e.json", "-o", "scene.gltf")
    report.claim(done.returncode == 0, f"{name}: {done.stderr}")
    for line in (("check", "scene.gltf"), ("review", "scene.review.json", "--dry-run")):
        done = run(program, folder, *line)
        report.claim(done.returncode == 0, f"{name}, {line[0]}: {done.stdout} {done.stderr}")


def check_look(report, program, folder, path, name):
    """The line that is printed for looking through the first eye makes a labelled picture."""
    said = run(program, folder, "equip", path, "--with", "e.json", "-o", "look.gltf").stdout
    line = next((row for row in said.splitlines() if row.startswith("look ")), "look no")
    words = shlex.split(line)[1:]
    done = run(program, folder, *words[1:], "--size", "32x18", "--quiet")
    with open(os.path.join(folder, "look.png"), "rb") as file:
        picture = file.read()
    report.claim(words[:3] == ["parhelion", "render", "look.gltf"] and "the eye" in words and
                 done.returncode == 0 and b"denoised preview, not for figures" in picture,
                 f"{name}: {line}: {done.stderr}")


def check_page(report, program, folder, path, name):
    page = run(program, folder, "equip", path, "-o", "page.html")
    is_empty = "has no triangles" in page.stderr
    report.claim(page.returncode == (3 if is_empty else 0), f"{name}: {page.stderr}")


def main(program):
    report, taken, program = Report(), 0, os.path.abspath(program)
    if not os.path.isdir(DATA):
        report.skip(f"no {os.path.relpath(DATA, ROOT)}: models of others are not equipped")
        return report.finish()
    for path in models():
        name = os.path.relpath(path, DATA)
        is_whole = run(program, ROOT, "check", path, "--quiet").returncode == 0
        taken += is_whole
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "e.json"), "w", encoding="utf-8") as file:
                json.dump(EQUIP, file)
            (check_equipped if is_whole else check_refused)(report, program, folder, path, name)
            if is_whole and taken == 1:
                check_look(report, program, folder, path, name)
            if is_whole and taken % PAGES == 0:
                check_page(report, program, folder, path, name)
    report.claim(taken > 20, f"only {taken} models were equipped")
    print(f"{taken} models equipped")
    return report.finish()


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
