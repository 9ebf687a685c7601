# SPDX-License-Identifier: Apache-2.0
"""no_data.py PARHELION -- materials that carry no optical data are named, each way that glTF
lets one be left at its defaults; those that say anything of what they reflect are not.
"""
import base64
import json
import os
import struct
import subprocess
import sys
import tempfile

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

PBR = "pbrMetallicRoughness"
WITHOUT = {
    "none at all": None, "empty": {}, "only a name": {"name": "trim"}, "empty pbr": {PBR: {}},
    "white factor": {PBR: {"baseColorFactor": [1, 1, 1, 1]}},
    "roughness alone": {PBR: {"roughnessFactor": 0.5, "metallicFactor": 0}},
    "double sided": {"doubleSided": True},
    "ior alone": {"extensions": {"KHR_materials_ior": {"ior": 1.4}}},
    "empty extension": {"extensions": {"KHR_materials_clearcoat": {}}},
    "emissive of nothing": {"emissiveFactor": [0, 0, 0]},
    "what an exporter leaves of an ambient term": {"emissiveFactor": [0.2, 0.03, 0.03]},
}
WITH = {
    "a colour": {PBR: {"baseColorFactor": [0.5, 0.5, 0.5, 1]}},
    "one channel": {PBR: {"baseColorFactor": [1, 1, 0.9, 1]}},
    "alpha": {"alphaMode": "BLEND", PBR: {"baseColorFactor": [1, 1, 1, 0.5]}},
    "a lamp": {"emissiveFactor": [1, 1, 1]},
    "a dim lamp": {"emissiveFactor": [0.3, 0, 0]},
    "glass": {"extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}}},
    "a coat": {"extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1}}},
    "unlit": {"extensions": {"KHR_materials_unlit": {}}},
}


def triangle(materials, used):
    """A mesh of a triangle by each of the materials that are used; None: without a material."""
    data = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
    extensions = sorted({name for m in materials for name in m.get("extensions", {})})
    primitives = [{"attributes": {"POSITION": 0}, **({} if i is None else {"material": i})}
                  for i in used]
    return {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}], "meshes": [{"primitives": primitives}],
        **({"materials": materials} if materials else {}),
        **({"extensionsUsed": extensions} if extensions else {}),
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                       "min": [0, 0, 0], "max": [1, 1, 0]}],
        "bufferViews": [{"buffer": 0, "byteLength": len(data)}],
        "buffers": [{"byteLength": len(data), "uri": "data:application/octet-stream;base64," +
                     base64.b64encode(data).decode()}]}


def with_colours(document, value):
    """The same triangle, its vertices coloured: float RGB."""
    data = struct.pack("<9f", *[value] * 9)
    view = len(document["bufferViews"])
    document["buffers"].append({"byteLength": len(data), "uri":
                                "data:application/octet-stream;base64," +
                                base64.b64encode(data).decode()})
    document["bufferViews"].append({"buffer": 1, "byteLength": len(data)})
    document["accessors"].append({"bufferView": view, "componentType": 5126, "count": 3,
                                  "type": "VEC3"})
    document["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = 1
    return document


def check(program, folder, document, *options):
    path = os.path.join(folder, "scene.gltf")
    with open(path, "w", encoding="utf-8") as file:
        json.dump(document, file)
    done = subprocess.run([program, "check", path, "--json", *options], capture_output=True,
                          text=True, check=False)
    said = [p for p in json.loads(done.stdout)["problems"] if "optical data" in p["message"]]
    return done.returncode, said


def main(program):
    report, program = Report(), os.path.abspath(program)
    with tempfile.TemporaryDirectory() as folder:
        for kinds, wanted in ((WITHOUT, 1), (WITH, 0)):
            for name, material in kinds.items():
                document = triangle([], [None]) if material is None else \
                    triangle([material], [0])
                status, said = check(program, folder, document)
                report.claim(status == 0 and len(said) == wanted,
                             f"{name}: status {status}: {said}")
                status, said = check(program, folder, document, "--strict")
                report.claim((status != 0) == bool(wanted) and len(said) == wanted,
                             f"{name}, strict: status {status}: {said}")
        for value, wanted in ((0.5, 0), (1, 1)):
            _, said = check(program, folder, with_colours(triangle([{}], [0]), value))
            report.claim(len(said) == wanted, f"vertices of colour {value}: {said}")
        both = with_colours(triangle([{"name": "cloth"}], [0, 0]), 0.5)
        _, said = check(program, folder, both)
        report.claim(len(said) == 1, f"one part coloured, one not: {said}")
        materials = [{"name": "leather"}, {"name": "unused"}, {"name": "wood", PBR: {
            "baseColorFactor": [0.3, 0.2, 0.1, 1]}}, {"name": "headliner"}]
        _, said = check(program, folder, triangle(materials, [0, 2, 3]))
        text = said[0]["message"] if said else ""
        report.claim("leather and headliner" in text and "2 of " in text, f"says {text}")
        report.claim("unused" not in text and "wood" not in text, f"says {text}")
    return report.finish()


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
