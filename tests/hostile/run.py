# SPDX-License-Identifier: Apache-2.0
"""run.py [--all] PARHELION -- models that are broken, foreign or strange: no crash, no hang, no
report of a sanitizer; what is valid loads and renders, what is not is refused in one clear line
or reported by `check`. --all, which tests/long.sh runs under the address sanitizer: more
mutations, and where light comes from is learnt of every model, not of the sound one alone.
"""
import concurrent.futures
import glob
import json
import os
import re
import subprocess
import sys
import tempfile

import mutate

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
DATA = os.path.normpath(os.path.join(ROOT, "..", "shared", "data", "gltf"))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

TIMEOUT_S = 120
SANITIZERS = ("AddressSanitizer", "runtime error:", "LeakSanitizer", "ThreadSanitizer")

# Models of other collections that must be refused, and a word that the refusal must hold.
REFUSED = {
    "tinygltf/models/BoundsChecking/invalid-buffer-index.gltf": "buffer",
    "tinygltf/models/BoundsChecking/invalid-buffer-view-index.gltf": "buffer",
    "tinygltf/models/BoundsChecking/invalid-primitive-indices.gltf": "accessors",
    "tinygltf/models/BoundsChecking/integer-out-of-bounds.gltf": "",
    "tinygltf/tests/issue-416.gltf": "version",
    "assimp/IncorrectVertexArrays/Cube.gltf": "bytes",
    "assimp/MissingBin/BoxTextured.gltf": "BoxTextured0.bin",
    "assimp/TestNoRootNode/NoScene.gltf": "scenes",
    # no fault to the validator, which warns: such an angle is one in degrees
    "validator-corpus/base/data/camera/perspective_yfov.gltf": "less than pi",
}


def run(program, *arguments):
    """(status, stdout, stderr); status "hang" after TIMEOUT_S."""
    try:
        done = subprocess.run([program, *arguments], capture_output=True, timeout=TIMEOUT_S)
    except subprocess.TimeoutExpired:
        return "hang", "", ""
    return done.returncode, done.stdout.decode("utf-8", "replace"), \
        done.stderr.decode("utf-8", "replace")


def is_sound(outcome):
    status, out, err = outcome
    return status in (0, 3) and not any(word in err + out for word in SANITIZERS)


def try_model(program, path, folder, *options):
    """What `check` and a tiny render make of one model."""
    check = run(program, "check", "--json", path)
    frame = os.path.join(folder, f"{abs(hash(path))}.exr")
    render = run(program, "render", path, "-o", frame, "--size", "16x9", "--spp", "1",
                 "--max-bounces", "4", "--threads", "1", "--quiet", *options)
    if os.path.exists(frame):
        os.remove(frame)
    return check, render


def problems_of(check):
    try:
        return json.loads(check[1]).get("problems", [])
    except ValueError:
        return []


def claim_sound(report, name, check, render):
    """No crash, whatever the file is. False when there is nothing more to ask."""
    tail = (render[2] if is_sound(check) else check[2]).strip().splitlines()[:3]
    return report.claim(is_sound(check) and is_sound(render),
                        f"{name}: check ends with {check[0]}, render with {render[0]} {tail}")


def claim_refusal(report, name, check, render):
    """One line that names the file, and in `check` at least one error with a text."""
    base = os.path.basename(name)
    lines = [line for line in render[2].splitlines() if "warning:" not in line]
    report.claim(render[0] == 3 and len(lines) == 1 and base in lines[0],
                 f"{name}: refusal is not one line with the file's name: {lines[:3]}")
    errors = [p for p in problems_of(check)
              if p.get("severity") == "error" and p.get("message")]
    report.claim(bool(errors), f"{name}: refused, but `check` names no error: {check[1][:200]}")


def claim_loads(report, name, check, render):
    """Passes the check and renders."""
    holds = check[0] == 0 and render[0] == 0
    errors = [p for p in problems_of(check) if p.get("severity") == "error"]
    report.claim(holds, f"{name}: is valid but refused: {errors[:2]} {render[2].strip()[:200]}")


def codes_of_no_matter():
    """Codes of the validator that this page says are read past, without a word: gltf_codes.py
    holds it to what the program does."""
    with open(os.path.join(ROOT, "src", "scene", "check", "README.md"), encoding="utf-8") as file:
        return set(re.findall(r"^\| `(\w+)` \| no matter \|", file.read(), re.M))


NO_MATTER = codes_of_no_matter()


def faults_in(path):
    """The validator's errors; None when it has no report on the model."""
    try:
        with open(path + ".report.json", encoding="utf-8") as file:
            messages = json.load(file)["issues"]["messages"]
    except OSError:
        return None
    return [m for m in messages if m["severity"] == 0]


def names_extension(check):
    """A valid model may need an extension that we do not have; then it must say which."""
    return any("extension" in p.get("message", "").lower() for p in problems_of(check))


def judge(report, path, outcome):
    name = os.path.relpath(path, DATA)
    check, render = outcome
    if not claim_sound(report, name, check, render):
        return
    faults = faults_in(path)
    if check[0] == 3:
        claim_refusal(report, name, check, render)
    if name in REFUSED:
        text = " ".join(p.get("message", "") for p in problems_of(check))
        report.claim(check[0] == 3 and REFUSED[name] in text, f"{name}: not refused: {text}")
    elif not faults:
        if check[0] != 3 or not names_extension(check):
            claim_loads(report, name, check, render)
    elif not all(fault["code"] in NO_MATTER for fault in faults):
        report.claim(check[0] == 3 or problems_of(check),
                     f"{name}: taken without a word, though {faults[0].get('pointer')}: "
                     f"{faults[0]['message']}")


def print_figures(paths, outcomes):
    """How many of the validator's models were refused, reported and taken."""
    count = dict.fromkeys(("refused", "reported", "silent", "valid", "valid and refused"), 0)
    for path, (check, _) in zip(paths, outcomes):
        faults = faults_in(path)
        if faults:
            count["refused" if check[0] == 3 else
                  "reported" if problems_of(check) else "silent"] += 1
        elif faults is not None:
            count["valid and refused" if check[0] == 3 else "valid"] += 1
    print(f"{len(paths)} foreign models; of {sum(count.values())} with the validator's report: "
          + ", ".join(f"{number} {what}" for what, number in count.items()))


def models():
    return sorted(path for ending in ("*.gltf", "*.glb")
                  for path in glob.glob(os.path.join(DATA, "**", ending), recursive=True))


def run_all(program, paths, folder):
    """Outcomes in the order of paths, several at a time. Six seconds of learning where light
    comes from meet nothing of a model that its first paths have not met."""
    def try_one(path):
        learns = "--all" in sys.argv or os.path.basename(path) == mutate.SOUND
        return try_model(program, path, folder, *([] if learns else ["--no-guiding"]))
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        return list(pool.map(try_one, paths))


def check_mutations(report, program, folder, count):
    """Files of our own that are cut, twisted or absurd: each is taken or refused, soundly."""
    paths = mutate.write_all(folder, count)
    for path, (check, render) in zip(paths, run_all(program, paths, folder)):
        name = os.path.basename(path)
        if claim_sound(report, name, check, render) and check[0] == 3:
            claim_refusal(report, name, check, render)
    check_played(report, program, paths)


def check_played(report, program, paths):
    """The same while they move, and as a variant."""
    words = ("check", "--json", "--time", "0.4", "--variant", "b")
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        outcomes = list(pool.map(lambda path: run(program, *words, path), paths))
    for path, outcome in zip(paths, outcomes):
        report.claim(is_sound(outcome), f"{os.path.basename(path)}: {' '.join(words)} ends "
                     f"with {outcome[0]} {outcome[2].strip().splitlines()[:3]}")
    report.claim(outcomes[0][0] == 0, f"the sound one is refused: {outcomes[0][1][:600]}")


def main():
    report, program = Report(), os.path.abspath(sys.argv[-1])
    with tempfile.TemporaryDirectory() as folder:
        check_mutations(report, program, folder, 4000 if "--all" in sys.argv else 120)
        if os.path.isdir(DATA):
            paths = models()
            outcomes = run_all(program, paths, folder)
            for path, outcome in zip(paths, outcomes):
                judge(report, path, outcome)
            print_figures(paths, outcomes)
        else:
            report.skip("foreign models: the shared data is not beside the checkout")
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
