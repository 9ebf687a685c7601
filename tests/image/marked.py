# SPDX-License-Identifier: Apache-2.0
"""marked.py PARHELION -- which way round a display is: a panel with a lobe upwards looks bright
from above, content stands upright, the back is black in every layer, and a real viewing-angle
table is seen in a frame within 2 %.
"""
import csv
import json
import math
import os
import subprocess
import sys
import tempfile

from exr import Frame
from gltf import Scene, png
from reflection import direction

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
MEASURED = os.path.normpath(os.path.join(
    ROOT, "..", "shared", "data", "display", "viewing_angle_oled_phi0_90.csv"))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402


def run(*words):
    subprocess.run(words, check=True, capture_output=True, text=True)


def fit(program, folder, name, rows):
    """A panel made of one white table; rows: theta, phi, X, Y, Z."""
    with open(os.path.join(folder, f"{name}.csv"), "w", encoding="utf-8") as file:
        file.write("theta,phi,X,Y,Z\n")
        file.writelines(",".join(f"{value:.6g}" for value in row) + "\n" for row in rows)
    manifest = os.path.join(folder, f"{name}.json")
    with open(manifest, "w", encoding="utf-8") as file:
        json.dump({"panel": name, "emission": {"white": f"{name}.csv"}}, file)
    run(program, "panel", "fit", manifest, "-o", os.path.join(folder, f"{name}.panel"))
    return f"{name}.panel"


def frame_of(program, folder, panel, theta, phi, picture=None):
    """What a parallel camera sees of a spot of 4 mm; of the whole display with a picture."""
    scene = Scene()
    extension = {"panel": panel}
    if picture:
        extension["content"] = {"index": scene.image("image/png", picture)}
    material = scene.material("display", extensions={"PARHELION_display": extension})
    scene.quad(material, [-0.1, -0.1, 0], [0.2, 0, 0], [0, 0.2, 0])
    eye = direction(theta, phi)
    up = [0, 1, 0] if abs(eye[1]) < 0.9 else [0, 0, -1]
    scene.probe("eye", [0.3 * x for x in eye], [-x for x in eye], 0.1 if picture else 0.002,
                up=up)
    path, out = os.path.join(folder, "scene.gltf"), os.path.join(folder, "frame.exr")
    scene.write(path)
    run(program, "render", path, "-o", out, "--size", "16x16", "--spp", "16", "--max-bounces",
        "0", "--layers", "variance", "--quiet")
    return Frame(out)


def check_lobe(report, program, folder):
    """Luminance 100 (1 + 0.8 sin theta sin phi): bright from above."""
    rows = []
    for theta in range(0, 89):
        for phi in range(0, 360, 5) if theta else (0,):
            x, y, _ = direction(theta, phi)
            luminance = 100 * (1 + 0.8 * y)
            rows.append((theta, phi, 0.9505 * luminance, luminance, 1.089 * luminance))
    panel = fit(program, folder, "lobe", rows)
    for name, theta, phi in (("above", 40, 90), ("below", 40, 270), ("the right", 40, 0),
                             ("the left", 40, 180), ("the front", 1, 45)):
        expected = 100 * (1 + 0.8 * math.sin(math.radians(theta)) * math.sin(math.radians(phi)))
        mean, _ = frame_of(program, folder, panel, theta, phi).mean_luminance()
        report.claim(abs(mean / expected - 1) < 0.02,
                     f"a lobe upwards, seen from {name}: {mean:.5g} instead of {expected:.5g}")
    four = png(2, 2, [[255] * 3 + [0] * 3, [0] * 6])
    frame = frame_of(program, folder, panel, 0, 0, four)
    bright, _ = frame.mean_luminance((0, 0, 8, 8))
    dark = max(frame.mean_luminance(region)[0]
               for region in ((8, 0, 16, 8), (0, 8, 8, 16), (8, 8, 16, 16)))
    report.claim(bright > 90 and dark < 1, f"content is not upright: {bright:.4g}, {dark:.4g}")


def measured_rows():
    """theta, phi, X, Y, Z of the table; it tells luminance and chromaticity."""
    with open(MEASURED, encoding="utf-8") as file:
        for row in csv.DictReader(file):
            luminance, x, y = float(row["Y"]), float(row["x"]), float(row["y"])
            yield (float(row["Theta"]), float(row["Phi"]), luminance * x / y, luminance,
                   luminance * (1 - x - y) / y)


def check_measured(report, program, folder):
    if not os.path.exists(MEASURED):
        report.skip("a measured panel: the shared data is not beside the checkout")
        return
    rows = list(measured_rows())
    panel = fit(program, folder, "measured", rows)
    for theta, phi in ((0, 0), (30, 0), (-45, 0), (15, 90), (-12, 90)):
        expected = next(row[3] for row in rows if row[:2] == (theta, phi))
        mean, _ = frame_of(program, folder, panel, theta, phi).mean_luminance()
        report.claim(abs(mean / expected - 1) < 0.02,
                     f"the measured panel at theta {theta}, phi {phi}: {mean:.5g} cd/m2 "
                     f"instead of {expected:.5g}")
        print(f"measured panel at theta {theta}, phi {phi}: off by "
              f"{100 * (mean / expected - 1):+.2g} %")


def back_scene(panel, double_sided, node, between):
    """A display, and what stands between it and the probes before and behind it."""
    scene = Scene()
    material = scene.material("display", doubleSided=double_sided,
                              extensions={"PARHELION_display": {"panel": panel}})
    corners = [[-0.1, -0.1, 0], [0.1, -0.1, 0], [0.1, 0.1, 0], [-0.1, 0.1, 0]]
    is_mirrored = math.prod(node.get("scale", [1])) < 0  # content must not be
    uvs = [[1, 1], [0, 1], [0, 0], [1, 0]] if is_mirrored else [[0, 1], [1, 1], [1, 0], [0, 0]]
    scene.mesh(material, corners, [[0, 1, 2], [0, 2, 3]], uvs=uvs, node=node)
    for name, z in (("front", 0.5), ("back", -0.5)):
        if between == "pane":
            scene.facing_quad(scene.window(1.5), [0, 0, z / 2], [0, 0, 1], 1)
        eye = [0, 0, z]
        if between == "mirror":  # looks away from the display into it
            scene.facing_quad(scene.metal(1), [0, 0, 2 * z], [0, 0, -z], 1)
        scene.probe(name, eye, [0, 0, z if between == "mirror" else -z], 0.05)
    return scene


def front_of(node):
    """The probe on the side that the node turns its +Z to: a mirrored node's triangles run the
    other way round, and so does their front (glTF 2.0, 3.7.2.1)."""
    upside = (-1 if "rotation" in node else 1) * node.get("scale", [1, 1, 1])[2]
    return "front" if upside > 0 else "back"


def check_back(report, program, folder):
    """Black from behind whatever stands in the file: no light, no display in any layer."""
    lambertian = [(theta, 0, 95, 100, 109) for theta in range(0, 89)]
    panel = fit(program, folder, "lambertian", lambertian)
    path, out = os.path.join(folder, "back.gltf"), os.path.join(folder, "back.exr")
    turned = {"rotation": [0, 1, 0, 0]}
    for double_sided, node, between in (
            (False, {}, ""), (True, {}, "mirror"), (True, {"scale": [-1, 1, 1]}, ""),
            (False, {"scale": [1, 1, -1]}, "pane"), (True, turned, "pane"),
            (False, {**turned, "scale": [1, -1, 1]}, "mirror")):
        back_scene(panel, double_sided, node, between).write(path)
        for side in ("front", "back"):
            run(program, "render", path, "-o", out, "--camera", side, "--size", "8x8", "--spp",
                "16", "--layers", "all", "--quiet")
            claim_side(report, program, out, side == front_of(node),
                       f"{side}, doubleSided {double_sided}, {node}, {between or 'nothing'}")


def claim_side(report, program, out, is_front, place):
    frame = Frame(out)
    middle = (2, 2, 6, 6)
    mean, _ = frame.mean_luminance(middle)
    shown = [name for name in frame.channels if name.startswith("display.")
             if any(value > 0 if name == "display.coverage" else value == value
                    for value in frame.channels[name])]
    measured = subprocess.run([program, "measure", out, "--display", "display", "--json"],
                              capture_output=True, text=True, check=False)
    report.claim(mean > 90 if is_front else mean == 0, f"{place}: {mean:.4g} cd/m2")
    is_seen = is_front and not place.endswith("mirror")
    report.claim(bool(shown) == is_seen, f"{place}: values of a display in {shown}")
    report.claim(measured.returncode == (0 if is_seen else 3)
                 and ("no pixel to measure" in measured.stderr) != is_seen,
                 f"{place}: measure --display ends with {measured.returncode}: "
                 f"{measured.stderr}")


def main():
    report, program = Report(), os.path.abspath(sys.argv[-1])
    with tempfile.TemporaryDirectory() as folder:
        for check in (check_lobe, check_back, check_measured):
            try:
                check(report, program, folder)
            except subprocess.CalledProcessError as error:
                report.claim(False, f"{check.__name__}: {error.stderr}")
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
