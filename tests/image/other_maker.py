# SPDX-License-Identifier: Apache-2.0
"""other_maker.py PARHELION -- a review of a car that somebody else made, with a display put
before its driver: its causes add up, and when its materials lose their textures the review says
which they are and how much of the light came by way of them.

The car is one of the shared data's; without them the test is skipped.
"""
import json
import os
import shutil
import struct
import sys
import tempfile

from gltf import Scene, png
from review import PANEL, ROOT, Report, Reviewer, moment

CAR = os.path.join(ROOT, "..", "shared", "data", "gltf", "cockpit", "torcs_car8-trb1.glb")
DISPLAY = [-0.25 + 0.62, 0.5, 0.35]  # m: before the driver's eye, above the wheel


def read_glb(path):
    """The document and the bytes behind it."""
    with open(path, "rb") as file:
        data = file.read()
    size = struct.unpack("<I", data[12:16])[0]
    return json.loads(data[20:20 + size]), data[20 + size:]


def write_glb(path, document, rest):
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    with open(path, "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, 20 + len(text) + len(rest)) +
                   struct.pack("<I4s", len(text), b"JSON") + text + rest)


def strip(document):
    """The car as exporters leave it that know no textures; its glass keeps its colour."""
    names = []
    for i, material in enumerate(document["materials"]):
        if "baseColorTexture" in material["pbrMetallicRoughness"]:
            name = material["name"] = f"{material['name']} {i}"
            document["materials"][i] = {"name": name}
            names.append(name)
    for key in ("textures", "images", "samplers"):
        document.pop(key, None)
    return names


def write_display(folder):
    scene = Scene()
    bars = png(60, 30, [[255 if 20 <= x < 40 and 8 <= y < 22 else 0 for x in range(60)
                         for _ in range(3)] for y in range(30)])
    screen = scene.material("screen", extensions={"PARHELION_display": {
        "panel": "ips.panel", "content": {"index": scene.image("image/png", bars)}}})
    scene.facing_quad(screen, DISPLAY, [-1, 0.15, 0], 0.2, 0.1)
    scene.write(os.path.join(folder, "display.gltf"))


REQUEST = {
    "title": "another maker's car", "eyes": {"driver": {"camera": "driver-eye"}},
    "symbols": {"bar": {"display": "screen", "uv": [0.1, 0.1, 0.9, 0.9]}},
    "profile": "iso-15008", "frames": {"worst": 0}, "forward": [1, 0, 0],
    "conditions": [
        moment("overcast", type="cie", sky=1, diffuse_horizontal_lx=10000),
        moment("low sun behind", type="sky", sun={"azimuth_deg": 185, "elevation_deg": 12,
                                                  "illuminance_lx": 40000}),
        moment("high sun", type="sky", sun={"azimuth_deg": 60, "elevation_deg": 55,
                                            "illuminance_lx": 90000})]}


def check_groups(report, name, review):
    for case in review["cases"]:
        for kind, group in case["cause_groups"].items():
            told = ", ".join(f"{s['share']:.1%} {s['what']}" for s in group[:3])
            print(f"{name}, {case['condition']}, {kind}: {told}")
            total = sum(share["share"] for share in group)
            other = sum(share["share"] for share in group if share["what"] == "other")
            report.claim(abs(total - 1) < 1e-4 and other <= 0.1,
                         f"{name}, {case['condition']}, {kind}: {total}, other {other}")


def check(report, reviewer, name, missing, *options):
    status, review = reviewer.review({**REQUEST, "scene": ["car.glb", "display.gltf"]}, name,
                                     *options)
    check_groups(report, name, review)
    report.claim((review["without_data"] or "") == " and ".join(missing),
                 f"{name}: without data {review['without_data']}, required: {missing}")
    for case in review["cases"]:
        share = case["without_data_share"]
        print(f"{name}, {case['condition']}: {share:.1%} by way of materials without data")
        report.claim(0 < share <= 1 if missing else share == 0,
                     f"{name}, {case['condition']}: {share} by way of {missing}")
    if "--strict" in options:
        report.claim(status == 1 and not review["pass"], f"{name}: strict passes")
    done = reviewer.run("check", "car.glb", "--strict")
    report.claim(done.returncode == (3 if missing else 0) and
                 all(material in done.stdout + done.stderr for material in missing),
                 f"{name}: check says {done.returncode} {done.stdout}")


def main(program):
    report = Report()
    if not os.path.isfile(CAR):
        print(f"skipped: no {os.path.relpath(CAR, ROOT)}")
        return report.finish()
    with tempfile.TemporaryDirectory() as folder:
        reviewer = Reviewer(program, folder)
        shutil.copy(PANEL, os.path.join(folder, "ips.panel"))
        write_display(folder)
        shutil.copy(CAR, os.path.join(folder, "car.glb"))
        check(report, reviewer, "as it is", [])
        document, rest = read_glb(CAR)
        missing = strip(document)
        report.claim(len(missing) == 2, f"{missing} had textures")
        os.remove(os.path.join(folder, "car.glb"))
        write_glb(os.path.join(folder, "car.glb"), document, rest)
        check(report, reviewer, "without textures", missing, "--strict")
    return report.finish()


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
