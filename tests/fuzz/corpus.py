# SPDX-License-Identifier: Apache-2.0
"""corpus.py [--bytes N] [--targets A,B] BUILD_DIR -- chooses what tests/fuzz/corpus keeps.

From the inputs that stand there already and those that run.py has found (BUILD_DIR/fuzzing),
the few that together reach most edges of the code in N bytes (6000) a target.
"""
import argparse
import glob
import hashlib
import os
import shutil
import subprocess
import sys
import tempfile

from run import HERE, targets_of


def edges_of(program, name, most, folders):
    """{path: set of edges}, by the notes that libFuzzer takes while it merges."""
    with tempfile.TemporaryDirectory() as scratch:
        notes = os.path.join(scratch, "notes")
        os.mkdir(os.path.join(scratch, "kept"))
        subprocess.run([program, f"--target={name}", "-merge=1", f"-merge_control_file={notes}",
                        f"-max_len={most}", "-detect_leaks=0", os.path.join(scratch, "kept"),
                        *folders],
                       capture_output=True, check=False, env=dict(os.environ, TMPDIR=scratch))
        with open(notes, encoding="utf-8") as file:
            lines = file.read().splitlines()
    paths = lines[2:2 + int(lines[0])]
    reached = {}
    for line in lines:
        words = line.split()
        if words and words[0] == "COV":
            reached[paths[int(words[1])]] = set(words[2:])
    return reached


def choose(reached, room):
    """Greedily the input that adds most edges for its size; ends when nothing adds or fits."""
    chosen, known = [], set()
    sizes = {path: os.path.getsize(path) for path in reached}
    while True:
        fitting = [path for path in reached
                   if path not in chosen and sizes[path] <= room and reached[path] - known]
        if not fitting:
            return chosen, len(known)
        best = max(fitting, key=lambda path: (len(reached[path] - known) / (sizes[path] + 40),
                                              path))
        chosen.append(best)
        known |= reached[best]
        room -= sizes[best]


def renew(name, chosen):
    folder = os.path.join(HERE, "corpus", name)
    contents = []
    for path in chosen:
        with open(path, "rb") as file:
            contents.append(file.read())
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    for content in contents:
        with open(os.path.join(folder, hashlib.sha1(content).hexdigest()[:12]), "wb") as file:
            file.write(content)


def main():
    options = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    options.add_argument("--bytes", type=int, default=6000)
    options.add_argument("--targets", default="")
    options.add_argument("build")
    options = options.parse_args()
    program = os.path.abspath(os.path.join(options.build, "fuzz"))
    wanted = options.targets.split(",") if options.targets else None
    for name, most in targets_of(program):
        if wanted and name not in wanted:
            continue
        folders = [os.path.join(HERE, "corpus", name),
                   os.path.join(os.path.abspath(options.build), "fuzzing", "corpus", name)]
        folders = [path for path in folders if glob.glob(os.path.join(path, "*"))]
        if not folders:
            print(f"{name}: no input")
            continue
        reached = edges_of(program, name, most, folders)
        chosen, edges = choose(reached, options.bytes)
        whole = len(set().union(*reached.values()))
        renew(name, chosen)
        print(f"{name:18} {len(chosen):3} of {len(reached):5} inputs, {edges} of {whole} edges")


if __name__ == "__main__":
    sys.exit(main())
