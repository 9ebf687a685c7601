# SPDX-License-Identifier: Apache-2.0
"""schemas.py PARHELION -- files hold to the schemas that it writes, and wrong ones do not.

Shipped scenes against those of our glTF extensions; shipped recipes and reviews, and with the
program the manifest that it writes, against those of the formats. Program and schema refuse
alike.
"""
import base64
import copy
import glob
import json
import os
import re
import struct
import subprocess
import sys
import tempfile

from report import ROOT, Report

NAME = re.compile(r"(PARHELION_\w+?)\b")


def load(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)


EXTENSIONS = ["PARHELION_display", "PARHELION_glazing", "PARHELION_spectrum",
              "PARHELION_coating", "PARHELION_environment"]


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


def written(program, name):
    """The schema that the program writes from the rows that it reads a format by."""
    return json.loads(subprocess.run([program, "schema", name], capture_output=True,
                                     check=True).stdout)


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


def check_misspelt(report, program, folder):
    """A key of an extension with a letter too many names the right one, at its place."""
    for name in EXTENSIONS:
        keys = [key for key in written(program, name)["properties"]
                if key not in ("extensions", "extras")]
        wrong = {"extensions": {name: {f"{key}x": 1 for key in keys}}}
        scene = {"asset": {"version": "2.0"}, "extensionsUsed": [name],
                 **({"scenes": [wrong]} if name == "PARHELION_environment"
                    else {"materials": [wrong]})}
        found = refuses(program, ("check", "DOCUMENT"), folder, scene).stdout.splitlines()
        report.claim_none(f"misspelt keys of {name}", [
            key for key in keys
            if not any(line.endswith(f"/{key}x)") and
                       f"unknown key; the nearest known one is '{key}'" in line
                       for line in found)])


# ---- formats ---------------------------------------------------------------------------------

SPECTRUM = {"peaks_nm": [550], "fwhm_nm": [30], "weights": [1]}
RECIPE = {"emission": {"red": SPECTRUM, "green": SPECTRUM, "blue": SPECTRUM, "levels": [255]},
          "reflection": {"incidence_deg": [30], "wavelengths_nm": [550], "floor_albedo": 0.05},
          "instrument": {"theta_step_deg": 10, "phi_step_deg": 30},
          "polarisation": {"degree": 0.98, "azimuth_deg": -30},
          "size_mm": [300, 200],
          "local_dimming": {"zones": [30, 20], "spread": {"sigma_mm": 7.5},
                            "drive": {"rule": "mean", "least": 0.25}, "compensates": False}}
WRONG_ZONES = [("local_dimming", 3), ("local_dimming", {}), ("local_dimming/zones", None),
               ("local_dimming/zones", [30]), ("local_dimming/zones", [0, 20]),
               ("local_dimming/zones", [3.5, 20]), ("local_dimming/zone", 1),
               ("local_dimming/spread", None), ("local_dimming/spread", {}),
               ("local_dimming/spread", {"sigma_mm": 0}),
               ("local_dimming/spread", {"radius_mm": [0, 30]}),
               ("local_dimming/spread", {"sigma_mm": 7, "radius_mm": [0, 30], "value": [1, 0]}),
               ("local_dimming/drive/rule", "median"), ("local_dimming/drive/least", 1.5),
               ("local_dimming/drive", {"codes": [0, 255]}), ("local_dimming/compensates", 1)]
DECLARATION = load(os.path.join(ROOT, "tests/unit/records/import.json"))
WRONG_RECIPES = [("emission/red/peaks_nm", []), ("emission/red/peaks_nm", None),
                 ("emission/green", None), ("emission/gama", 2.2), ("emission/gamma", 9),
                 ("instrument/theta_step_deg", 20), ("reflection/haze_share", 1.5),
                 ("emission/levels", [300]), ("panel", 7), ("emission", None),
                 ("places", {}), ("places", {"u": [0.5]}), ("places", {"u": [2], "v": [0]}),
                 ("places", {"map": [4]}), ("places", {"map": [4, 4], "bend_deg": 160}),
                 ("places", {"map": [4, 4], "murra": 1}),
                 ("polarisation", 45), ("polarisation/degree", None),
                 ("polarisation/azimuth_deg", None), ("polarisation/degree", -0.1),
                 ("polarisation/azimuth_deg", 361), ("polarisation/azimuth", 1),
                 *WRONG_ZONES]
WRONG_DECLARATIONS = [("delimiter", "pipe"), ("azimuth_zero", "north"), ("azimut_zero", "top"),
                      ("level_max", 0), ("skip", "log_*"), ("isotropic", "yes"),
                      ("symmetry", "round"), ("wavelength_nm", 200), ("levels", 7),
                      ("backlight", "tube"), ("peaks_nm", [620, 530]), ("accept", 1),
                      ("specular", 7), ("specular_aperture_deg", 60), ("gloss", []),
                      ("gloss", [{"geometry_deg": 45, "gu": 9}]),
                      ("gloss", [{"geometry_deg": 60}])]
WRONG_MANIFESTS = [("emission/black", None), ("emission/red", {}), ("emission/red/300", "a"),
                   ("emission/white", "white.csv"), ("emission/levels", "levels.csv"),
                   ("emission/purple", "a.csv"),
                   ("reflection/files", "brdf/i10.csv"), ("reflection/incidence_deg", [95]),
                   ("reflection/wavelengths_nm", None), ("reflection/incidence_phi_deg", [0]),
                   ("reflection/specular", 7), ("reflection/specular", {}),
                   ("reflection/specular/aperture_deg", 40),
                   ("reflection/specular/aperture", 1), ("reflection/gloss", []),
                   ("reflection/gloss", [{"geometry_deg": 60, "gu": 1}]),
                   ("instrument_fwhm_deg", 40), ("date", 2026), ("operator", []),
                   ("pannel", "x"), ("backlight", 1), ("peaks_nm", [620, 530]),
                   ("polarisation", 0.5),
                   ("polarisation", {"degree": 1.5, "azimuth_deg": 0}),
                   ("polarisation", {"degree": "1", "azimuth_deg": 0}),
                   ("polarisation", {"degree": 1, "azimuth_deg": 400}),
                   ("polarisation", {"degree": 1}), ("polarisation", {"azimuth_deg": 1}),
                   ("polarisation", {"degree": 1, "azimuth_deg": 0, "circular": 1}),
                   ("spots", []), ("spots", {}), ("spots", [{"position": [0, 0]}]),
                   ("spots", [{"emission": {"white": "emission/black.csv"}}]),
                   ("spots", [{"position": [0, 1.5],
                               "emission": {"white": "emission/black.csv"}}]),
                   ("spots", [{"position": [0], "emission": {"white": "emission/black.csv"}}]),
                   ("spots", [{"position": [0, 0], "emission": {}}]),
                   ("spots", [{"position": [0, 0], "place": 1,
                               "emission": {"white": "emission/black.csv"}}]),
                   ("uniformity", {}), ("uniformity", "map.csv"), ("uniformity", {"file": 3}),
                   ("uniformity", {"file": "map.csv", "bend_deg": 180}),
                   ("uniformity", {"file": "map.csv", "camera_mm": 1}),
                   ("uniformity", {"file": "map.csv", "white": "map.csv"}),
                   *WRONG_ZONES, ("size_mm", None)]
WRONG_PROFILES = [("title", None), ("title", ""), ("limit", []), ("veil", "yes"),
                  ("ambient", None), ("ambient/night_below_lx", -1),
                  ("ambient/dusk_below_lx", 3), ("limits", None), ("limits", {}),
                  ("limits/0", 5), ("limits/0/value", -5), ("limits/0/value", "5"),
                  ("limits/0/unit", "arcmin"), ("limits/0/kind", "contrast"),
                  ("limits/0/ambient", "dusk"), ("limits/0/ambient", []),
                  ("limits/0/bound", "upper"), ("limits/0/source", None),
                  ("limits/0/read_in_the_standard", 1), ("limits/0/slope", {}),
                  ("facts/0/text", None), ("facts/0/value", 3)]


WRONG_REVIEWS = [("profile", None), ("scene", []), ("eyes", {}), ("eye", {}),
                 ("eyes/driver/position_m", [0, 0, 0]), ("gaze/0/direction", [0, 0, 1]),
                 ("observer/age", 50), ("symbols/speed/uv", [0, 1]), ("symbols/speed/uv", None),
                 ("symbols/speed/polarity", "dark"), ("symbols/speed/find", "digits"),
                 ("levels/night/cluster", -1), ("max_level", 0.5), ("levels/auto/sensor", None),
                 ("levels/auto/table_lx", [[0]]), ("conditions/0/environment/type", "mist"),
                 ("conditions/0/when", "2026"), ("conditions/0/name", None),
                 ("conditions/0/weather", "clear"), ("conditions/0/sweep", {"sun": {}}),
                 ("conditions/0/sweep", {"year": 2026}), ("frames/size", [0, 720]),
                 ("precision/colour", 1)]


EQUIP = load(os.path.join(ROOT, "tests/unit/records/equip.json"))
WRONG_EQUIPS = [("equip", None), ("equip", 2), ("eyes", None), ("eyes", []), ("eye", []),
                ("displays", {}), ("displays/0/name", ""), ("displays/0/up", [0, 0, 0]),
                ("displays/0/width_m", 0), ("displays/0/panel", None),
                ("displays/0/content", ""), ("displays/0/level", -1),
                ("displays/0/level", 25), ("displays/0/max_level", 0.5),
                ("displays/0/width_m", 1.75), ("displays/0/height_m", 0.004),
                ("displays/0/centre_m", [0, 1]), ("displays/0/before_mm", 0),
                ("displays/0/width_mm", 300), ("displays/0/symbols/0/uv", [0, 1]),
                ("displays/0/symbols/0/name", None), ("displays/0/mesh/uv", None),
                ("displays/0/mesh/triangles", [0.5, 1, 2]), ("eyes/0/looks_at", None),
                ("eyes/0/target_m", [0, 0, 0]), ("eyes/0/position_m", None),
                ("materials/0/index", -1), ("materials/0/as", None),
                ("materials/0/ior", 0.5), ("materials/1/base_color", [1, 1, 2]),
                ("profile", "a/b"), ("forward", [0, 0, 0]), ("occupant/eye", None),
                ("occupant/shirt", "red"), ("place", {}),
                ("place/where", [91, 0, 0]), ("place/year", 1900), ("place/headings_deg", [])]


def changed(document, path, value):
    """A copy with one member set, or taken away where the value is None."""
    document = copy.deepcopy(document)
    *folders, last = path.split("/")
    inside = document
    for name in folders:
        inside = inside[int(name) if isinstance(inside, list) else name]
    if isinstance(inside, list):
        last = int(last)
    if value is None:
        del inside[last]
    else:
        inside[last] = value
    return document


def refuses(program, command, folder, document):
    """The program's answer to a document as the file that the command reads."""
    path = os.path.join(folder, "document.json")
    with open(path, "w", encoding="utf-8") as file:
        json.dump(document, file)
    words = [word.replace("DOCUMENT", path).replace("FOLDER", folder) for word in command]
    return subprocess.run([program, *words, "--quiet"], capture_output=True, text=True,
                          timeout=120)


def check_format(report, validator, good, wrong, try_program):
    """The schema takes the good document and none of the wrong ones; so does the program."""
    report.claim_none("a good document", [error.message for error in
                                          validator.iter_errors(good)])
    done = try_program(good)
    report.claim(done is None or done.returncode == 0,
                 f"the program refuses a good document: {done and done.stderr}")
    for path, value in wrong:
        document = changed(good, path, value)
        report.claim(not validator.is_valid(document), f"the schema takes {path}: {value}")
        done = try_program(document)
        report.claim(done is None or done.returncode in (2, 3),
                     f"the program takes {path}: {value}")


def check_formats(report, program, folder, schema_of):
    def trying(*command):
        return lambda document: refuses(program, command, folder, document) if program else None
    recipes, sets = schema_of("recipe"), schema_of("measurement_set")
    for recipe in sorted(glob.glob(os.path.join(ROOT, "assets/panels/*.recipe.json"))):
        report.claim_none(f"{os.path.relpath(recipe, ROOT)} against its schema",
                          [error.message for error in recipes.iter_errors(load(recipe))])
    check_format(report, recipes, RECIPE, WRONG_RECIPES,
                 trying("panel", "simulate", "DOCUMENT", "-o", "FOLDER/set"))
    profiles = schema_of("profile")
    for profile in sorted(glob.glob(os.path.join(ROOT, "assets/profiles/*.json"))):
        report.claim_none(f"{os.path.relpath(profile, ROOT)} against its schema",
                          [error.message for error in profiles.iter_errors(load(profile))])
    # What the program says of wrong ones: tests/unit/test_profile.c.
    good = load(os.path.join(ROOT, "assets/profiles/j1757-1.json"))
    good["limits"] = load(os.path.join(ROOT, "assets/profiles/iso-9241-7.json"))["limits"]
    check_format(report, profiles, good, WRONG_PROFILES, lambda document: None)
    if not program:
        report.skip("a manifest against its schema: no program was given")
        return
    # The set of the last good recipe lies where the manifests are looked for.
    refuses(program, ("panel", "simulate", "DOCUMENT", "-o", "FOLDER"), folder, RECIPE)
    manifest = load(os.path.join(folder, "MANIFEST.json"))
    for key in ("polarisation", "local_dimming"):
        report.claim(manifest[key] == RECIPE[key],
                     f"the manifest does not say the recipe's {key}")
    check_format(report, sets, manifest, WRONG_MANIFESTS,
                 trying("panel", "fit", "DOCUMENT", "-o", "FOLDER/a.panel"))
    with open(os.path.join(folder, "m01.txt"), "w", encoding="utf-8") as file:
        file.write("0;0;1,5;2;1\n5;0;1;2,5;1\n5;90;1;2;1\n5;180;1;2;1\n5;270;1;2,5;1\n")
    with open(os.path.join(folder, "levels.csv"), "w", encoding="utf-8") as file:
        file.write("level,luminance\n0,0.01\n0.5,0.4\n1,2\n")
    check_format(report, schema_of("import_declaration"), DECLARATION, WRONG_DECLARATIONS,
                 lambda document: refuses(
                     program, ("panel", "import", "FOLDER/m01.txt", "--layout", "DOCUMENT",
                               "--role", "m01.txt=white", "-o", "FOLDER/again/MANIFEST.json"),
                     folder, document))


def check_equips(report, program, folder, validator):
    """Onto a triangle; what it would be applied to is the same for all."""
    bare = {"pbrMetallicRoughness": {"roughnessFactor": 0.5}}
    corners = base64.b64encode(struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)).decode()
    triangle = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
                "nodes": [{"mesh": 0}], "materials": [{"name": "bare", **bare}, bare],
                "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
                "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3,
                               "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
                "bufferViews": [{"buffer": 0, "byteLength": 36}],
                "buffers": [{"byteLength": 36,
                             "uri": f"data:application/octet-stream;base64,{corners}"}]}
    with open(os.path.join(folder, "triangle.gltf"), "w", encoding="utf-8") as file:
        json.dump(triangle, file)
    check_format(report, validator, EQUIP, WRONG_EQUIPS, lambda document: program and refuses(
        program, ("equip", "FOLDER/triangle.gltf", "--with", "DOCUMENT", "-o",
                  "FOLDER/equipped.gltf", "--overwrite"), folder, document) or None)


def check_reviews(report, validator):
    reviews = sorted(glob.glob(os.path.join(ROOT, "scenes/*.review.json")))
    report.claim(bool(reviews), "scenes holds no .review.json")
    for review in reviews:
        report.claim_none(f"{os.path.relpath(review, ROOT)} against its schema",
                          [error.message for error in validator.iter_errors(load(review))])
    good = load(os.path.join(ROOT, "scenes/car_dashboard.review.json"))
    check_format(report, validator, good, WRONG_REVIEWS, lambda document: None)


def main():
    report = Report()
    program = os.path.abspath(sys.argv[1])
    try:
        import jsonschema
    except ImportError:
        report.skip("scenes against schemas: python3-jsonschema is not installed")
        report.finish()
    known = {}
    for name in EXTENSIONS:
        schema = written(program, name)
        validator = jsonschema.validators.validator_for(schema)
        try:
            validator.check_schema(schema)
            known[name] = validator(schema)
        except jsonschema.SchemaError as error:
            report.claim(False, f"schema of {name}: {error.message}")
    check_can_fail(report, known)
    def schema_of(name):
        schema = written(program, name)
        validator = jsonschema.validators.validator_for(schema)
        validator.check_schema(schema)
        return validator(schema)
    with tempfile.TemporaryDirectory(prefix="schemas-") as folder:
        check_misspelt(report, program, folder)
        check_formats(report, program, folder, schema_of)
        check_equips(report, program, folder, schema_of("equip"))
    check_reviews(report, schema_of("review"))
    scenes = sorted(glob.glob(os.path.join(ROOT, "scenes/**/*.gltf"), recursive=True))
    report.claim(bool(scenes), "scenes holds no .gltf")
    for scene in scenes:
        check_scene(report, known, scene)
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
