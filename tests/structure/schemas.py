"""schemas.py -- the shipped scenes hold to the schemas of our own glTF extensions."""
import glob
import json
import os
import re
import sys

from report import ROOT, Report

NAME = re.compile(r"(PARHELION_\w+?)\b")


def load(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def schemas():
    """Extension name -> schema of the object that carries it."""
    found = {}
    for path in sorted(glob.glob(os.path.join(ROOT, "assets/schemas/*.json"))):
        match = NAME.search(os.path.basename(path))
        if match:
            found[match[1]] = load(path)
    return found


def extension_objects(node, path=""):
    """(path, extension, object) of every use of an extension of ours in a document."""
    if isinstance(node, list):
        for i, item in enumerate(node):
            yield from extension_objects(item, f"{path}/{i}")
    elif isinstance(node, dict):
        for name, value in node.get("extensions", {}).items():
            if NAME.fullmatch(name):
                yield f"{path}/extensions/{name}", name, value
        for key, value in node.items():
            yield from extension_objects(value, f"{path}/{key}")


def check_scene(report, known, scene):
    document = load(scene)
    used = set(document.get("extensionsUsed", []))
    faults = []
    for path, name, value in extension_objects(document):
        if name not in known:
            faults.append(f"{path}: no schema for {name}")
            continue
        if name not in used:
            faults.append(f"{path}: {name} is not in extensionsUsed")
        faults += [f"{path}: {error.message}" for error in known[name].iter_errors(value)]
    report.claim_none(f"{os.path.relpath(scene, ROOT)} against its schemas", faults)


def check_can_fail(report, known):
    """A schema that takes anything checks nothing."""
    for name, validator in known.items():
        report.claim(not validator.is_valid([]), f"the schema of {name} takes an array")
        report.claim(not validator.is_valid({"no_such_key": 1}),
                     f"the schema of {name} takes an unknown key")


def main():
    report = Report()
    try:
        import jsonschema
    except ImportError:
        report.skip("scenes against schemas: python3-jsonschema is not installed")
        report.finish()
    known = {}
    for name, schema in schemas().items():
        validator = jsonschema.validators.validator_for(schema)
        try:
            validator.check_schema(schema)
            known[name] = validator(schema)
        except jsonschema.SchemaError as error:
            report.claim(False, f"schema of {name}: {error.message}")
    for name in ("PARHELION_display", "PARHELION_environment"):
        report.claim(name in known, f"assets/schemas holds no valid schema of {name}")
    check_can_fail(report, known)
    scenes = sorted(glob.glob(os.path.join(ROOT, "scenes/**/*.gltf"), recursive=True))
    report.claim(bool(scenes), "scenes holds no .gltf")
    for scene in scenes:
        check_scene(report, known, scene)
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
