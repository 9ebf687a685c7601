# SPDX-License-Identifier: Apache-2.0
"""extensions.py PARHELION -- the table of glTF extensions in the guide of scenes is what the
program does: what is read is taken without a word even where it is required, what is not is a
warning where it is used and a refusal where it is required, by name; and no extension that the
sources know, or that Khronos has ratified, is missing in the table.
"""
import json
import os
import re
import subprocess
import sys
import tempfile

from report import ROOT, Report, read

GUIDE = os.path.join(ROOT, "assets", "guides", "scenes.md")
SOURCES = os.path.join(ROOT, "src", "scene")
# The registry's list of ratified extensions (github.com/KhronosGroup/glTF, extensions).
RATIFIED = """animation_pointer draco_mesh_compression gaussian_splatting interactivity
lights_punctual materials_anisotropy materials_clearcoat materials_dispersion
materials_emissive_strength materials_ior materials_iridescence materials_sheen
materials_specular materials_transmission materials_unlit materials_variants materials_volume
mesh_quantization node_hoverability node_selectability node_visibility texture_basisu
texture_transform xmp_json_ld""".split()
VENDORS = ["EXT_mesh_gpu_instancing", "EXT_meshopt_compression", "EXT_texture_webp"]


def table():
    """Extension -> "read", "in part" or "not read"."""
    rows = re.findall(r"^\| `((?:KHR|EXT)_\w+)` \| ([a-z ]+) \|", read(GUIDE), re.M)
    return dict(rows)


def known_names():
    """Every extension that the loader's sources name."""
    found = set()
    for folder, _, files in os.walk(SOURCES):
        for file in files:
            if file.endswith((".c", ".h")):
                text = read(os.path.join(folder, file))
                found.update(re.findall(r'"((?:KHR|EXT)_[a-z]\w+)"', text))
    return found


def problems(program, path):
    done = subprocess.run([program, "check", "--json", path], capture_output=True, text=True)
    return done.returncode, json.loads(done.stdout)["problems"]


def check_one(report, program, folder, name, here):
    for is_required in (False, True):
        document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{}],
                    "extensionsUsed": [name]}
        if is_required:
            document["extensionsRequired"] = [name]
        path = os.path.join(folder, "one.gltf")
        with open(path, "w", encoding="utf-8") as file:
            json.dump(document, file)
        status, said = problems(program, path)
        told = [p["severity"] for p in said if name in p["message"]]
        wanted = [] if here != "not read" else ["error" if is_required else "warning"]
        if name == "KHR_mesh_quantization" and not is_required:
            wanted = ["warning"]  # it must be required
        report.claim(told == wanted and status == (3 if "error" in wanted else 0),
                     f"{name}: {here}, required {is_required}: status {status}, {said}")


def main():
    report, program, rows = Report(), os.path.abspath(sys.argv[1]), table()
    ratified = {"KHR_" + name for name in RATIFIED} | set(VENDORS)
    report.claim_none("extensions without a row in the guide",
                      sorted((known_names() | ratified) - set(rows)))
    with tempfile.TemporaryDirectory() as folder:
        for name, here in rows.items():
            if report.claim(here in ("read", "in part", "not read"), f"{name}: {here}"):
                check_one(report, program, folder, name, here)
    report.finish()


if __name__ == "__main__":
    main()
