# SPDX-License-Identifier: Apache-2.0
"""gltf_codes.py PARHELION -- glTF's faults, by the codes of the Khronos validator.

src/scene/check/README.md says of each code whether such a file is refused, reported, or why it
does not matter. Here every code that is refused or reported is shown by a model that is whole
but for one fault; the whole one passes. Then, of the same model: every property of a wrong kind
is told, every required one that is missing, and valid files of unusual kinds are taken.
"""
import copy
import json
import os
import re
import subprocess
import sys
import tempfile

from gltf_faults import FAULTS
from gltf_model import valid_model
from gltf_valid import VALID

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report, read  # noqa: E402

PAGE = os.path.join(ROOT, "src", "scene", "check", "README.md")
OUTCOMES = ("refused", "reported", "no matter")

# Members that must be there, by the name of the list or object that holds them.
REQUIRED = {
    "document": ["asset"], "asset": ["version"], "buffers": ["byteLength"],
    "bufferViews": ["buffer", "byteLength"], "accessors": ["componentType", "count", "type"],
    "sparse": ["count", "indices", "values"], "indices": ["bufferView", "componentType"],
    "values": ["bufferView"], "meshes": ["primitives"], "primitives": ["attributes"],
    "skins": ["joints"], "cameras": ["type"], "perspective": ["yfov", "znear"],
    "orthographic": ["xmag", "ymag", "znear", "zfar"], "animations": ["channels", "samplers"],
    "channels": ["sampler", "target"], "target": ["path"], "animations/samplers": [
        "input", "output"], "lights": ["type"], "KHR_lights_punctual": ["lights", "light"],
    "EXT_lights_ies": ["lights", "light"],
    "variants": ["name"], "KHR_materials_variants": ["variants", "mappings"],
    "mappings": ["variants", "material"], "KHR_animation_pointer": ["pointer"],
    "*Texture": ["index"]}


def table():
    """Code -> outcome, of the page."""
    rows = re.findall(r"^\| `([A-Z0-9_]+)` \| ([a-z ]+) \| (.+) \|$", read(PAGE), re.M)
    return {code: (outcome, words) for code, outcome, words in rows}


# ---- one model -----------------------------------------------------------------------------


def write(folder, number, model):
    """The model as a file of a name of its own."""
    if hasattr(model, "change_glb"):
        path, data = f"{number}.glb", model.change_glb(model.glb())
    else:
        path, data = f"{number}.gltf", model.text()
    if hasattr(model, "change_text"):
        data = model.change_text(data)
    with open(os.path.join(folder, path), "wb") as file:
        file.write(data)
    return os.path.join(folder, path)


def check(program, paths):
    """(status, set of (severity, message, place)) of each file; one run of the program for
    all, which takes them for one scene but tells what is wrong by file."""
    done = subprocess.run([program, "check", "--json", *paths], capture_output=True,
                          timeout=600)
    found = {path: set() for path in paths}
    for p in json.loads(done.stdout)["problems"]:
        if "no optical data" in p["message"]:  # of all files together, and no fault: no_data.py
            continue
        found[p["file"]].add((p["severity"], p["message"], p["path"]))
    return [(3 if any(p[0] == "error" for p in found[path]) else 0, found[path])
            for path in paths]


def broken(edits):
    model = valid_model()
    for edit in edits:
        edit(model)
    return model


class Trial:
    """Models made in a folder, checked together."""

    def __init__(self, program, folder):
        self.program, self.folder, self.count = program, folder, 0
        [(status, self.usual)] = check(program, [self.write(valid_model())])
        self.whole = status == 0 and all(
            any(word in p[1] for word in ("is not supported", "animation skipped",
                                          "makes the solid clear", "has no effect",
                                          "clear as a whole", "the range of"))
            for p in self.usual)

    def write(self, model):
        self.count += 1
        return write(self.folder, self.count, model)

    def of_all(self, models):
        """(status, problems beyond the whole model's) of each."""
        found = check(self.program, [self.write(model) for model in models])
        return [(status, problems - self.usual) for status, problems in found]


# ---- the codes -----------------------------------------------------------------------------


def judge_fault(report, fault, outcome, found):
    code, words, (status, problems) = fault[0], fault[1], found
    outcome = {"~": "reported", "!": "refused"}.get(code[-1], outcome)
    said = [p for p in problems if words in p[1]]
    holds = bool(said) and status == (3 if outcome == "refused" else 0)
    report.claim(holds, f"{code}: {outcome} with \"{words}\" is required, status {status}: "
                 f"{sorted(problems)[:4]}")


def check_codes(report, trial, codes):
    found = trial.of_all([broken(fault[2:]) for fault in FAULTS])
    for fault, outcome in zip(FAULTS, found):
        wanted = codes.get(fault[0].rstrip("~!"), ("missing", ""))[0]
        judge_fault(report, fault, wanted, outcome)
    shown = {fault[0].rstrip("~!") for fault in FAULTS}
    told = {code for code, row in codes.items() if row[0] != "no matter"}
    report.claim(shown == told, f"codes without a model: {sorted(told - shown)}; models of "
                 f"codes that do not matter: {sorted(shown - told)}")
    report.claim(all(row[0] in OUTCOMES and len(row[1]) > 6 for row in codes.values()),
                 "every code has an outcome and a sentence")
    print(f"{len(codes)} codes: " + ", ".join(
        f"{sum(row[0] == outcome for row in codes.values())} {outcome}"
        for outcome in OUTCOMES) + f"; {len(FAULTS)} broken models")


# ---- every property ------------------------------------------------------------------------


def members(value, path=()):
    """(path, key) of every member of every object, but for extras."""
    items = value.items() if isinstance(value, dict) else enumerate(value)
    for key, item in items:
        if key == "extras":
            continue
        if isinstance(value, dict):
            yield path, key
        if isinstance(item, (dict, list)):
            yield from members(item, path + (key,))


def of_another_kind(value):
    """A value that stands nowhere for this one."""
    if isinstance(value, (bool, dict)):
        return "text"
    return 1.5 if isinstance(value, str) else {"a": 1}


def kind_models():
    """(name, model) with each property in turn of a wrong kind."""
    for path, key in members(valid_model().document):
        model = valid_model()
        holder = model.document
        for step in path:
            holder = holder[step]
        holder[key] = of_another_kind(holder[key])
        yield "/".join(map(str, path + (key,))), model


def is_required(path, key):
    names = [step for step in path if isinstance(step, str)] or ["document"]
    long = "/".join(names[-2:])
    if names[-1].endswith("Texture"):
        return key in REQUIRED["*Texture"]
    if long == "animations/samplers":
        return key in REQUIRED[long]
    if names[-1] in ("variants", "samplers", "indices", "values") and long not in (
            "sparse/indices", "sparse/values", "KHR_materials_variants/variants"):
        return False
    return key in REQUIRED.get(names[-1], [])


def missing_models():
    """(name, model) without each required property in turn."""
    for path, key in members(valid_model().document):
        if is_required(path, key):
            model = valid_model()
            model.drop("/".join(map(str, path + (key,))))
            yield "/".join(map(str, path + (key,))), model


def check_properties(report, trial):
    for what, models in (("of a wrong kind", list(kind_models())),
                         ("missing", list(missing_models()))):
        found = trial.of_all([model for _, model in models])
        for (name, _), (status, problems) in zip(models, found):
            report.claim(status in (0, 3) and problems, f"{name} {what}: status {status}, "
                         "nothing is said")
        print(f"{len(models)} properties {what}")


def check_extras(report, trial):
    """Anything may stand under extras, of every object."""
    models = []
    for extras in (5, "text", [1, {"index": 7}], {"nodes": [99]}, None):
        model = valid_model()
        fill(model.document, copy.deepcopy(extras))
        models.append(model)
    for status, problems in trial.of_all(models):
        report.claim(status == 0 and not problems, f"extras: status {status}, {problems}")


def check_deep_text(report, trial):
    """A text in extras that holds our extension is JSON of its own, with the same limits."""
    model = valid_model()
    model.document["materials"][0]["extras"] = {"PARHELION_display": '{"panel":' + "[" * 400}
    [(status, problems)] = trial.of_all([model])
    report.claim(status == 3 and any("nested deeper than 256" in p[1] for p in problems),
                 f"a deep text in extras: status {status}, {sorted(problems)[:4]}")


def fill(value, extras):
    if isinstance(value, dict):
        for key, item in list(value.items()):
            if key not in ("attributes", "targets", "extensions"):
                fill(item, extras)
            elif key == "extensions":
                for extension in item.values():
                    fill(extension, extras)
        value["extras"] = extras
    elif isinstance(value, list):
        for item in value:
            fill(item, extras)


def check_valid(report, trial):
    found = trial.of_all([broken(row[2:]) for row in VALID])
    for row, (status, problems) in zip(VALID, found):
        said = any(row[1] in p[1] for p in problems) if row[1] else not problems
        report.claim(status == 0 and said, f"{row[0]}: is valid, but status {status}: "
                     f"{sorted(problems)[:4]}, required: \"{row[1]}\"")


def main():
    report, program = Report(), os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        trial = Trial(program, folder)
        report.claim(trial.whole, f"the whole model: {sorted(trial.usual)}")
        check_codes(report, trial, table())
        check_properties(report, trial)
        check_extras(report, trial)
        check_deep_text(report, trial)
        check_valid(report, trial)
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
