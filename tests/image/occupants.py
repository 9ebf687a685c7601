# SPDX-License-Identifier: Apache-2.0
"""occupants.py PARHELION -- the people of scenes/ are what they are said to be: closed bodies
whose normals agree with their sides, clear of the eyes and of what these read, in cloth of the
reflectance that it is named for; a white shirt lights the display, a dark one does not.
"""
import array
import csv
import json
import os
import shutil
import subprocess
import sys
import tempfile

from gltf import Scene, cross, dot, sub

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

SCENES = os.path.join(ROOT, "scenes")
SPECTRA = os.path.join(ROOT, "assets", "spectra")
FILES = {"occupant.gltf": ("car_dashboard", 0.8), "occupant_grey.gltf": ("car_dashboard", 0.4),
         "occupant_dark.gltf": ("car_dashboard", 0.05), "crew.gltf": ("cockpit", 0.8),
         "crew_dark.gltf": ("cockpit", 0.05)}
# In the person's own coordinates: eyes, how far away everything must be, corners of displays.
CAR = [(0, 1.3, 0), (0, 1.35, 0.03)] + [(x, y, z) for x in (-0.03, 0.03) for y in (1.25, 1.35)
                                       for z in (-0.08, 0.08)]
CLUSTER = [(x, y, -0.73) for x in (-0.146, 0.146) for y in (0.98, 1.09)]
CENTRE = [(0.55, 1.10, -0.69)]
DECK = [(x, y, z) for x in (-0.18, 0.07) for y, z in ((0.69, -0.667), (0.882, -0.723))]
VIEWS = {"occupant.gltf": (CAR, 0.04, CLUSTER + CENTRE),
         "crew.gltf": ([(0, 1.17, 0)], 0.04, DECK)}


def load(name):
    with open(os.path.join(SCENES, name), encoding="utf-8") as file:
        return json.load(file)


def meshes(document):
    """name: points, normals, triangles."""
    with open(os.path.join(SCENES, document["buffers"][0]["uri"]), "rb") as file:
        data = file.read()

    def rows(index):
        accessor = document["accessors"][index]
        view = document["bufferViews"][accessor["bufferView"]]
        values = array.array("f" if accessor["componentType"] == 5126 else "H")
        values.frombytes(data[view["byteOffset"]:view["byteOffset"] + view["byteLength"]])
        return list(zip(values[0::3], values[1::3], values[2::3]))

    for mesh in document["meshes"]:
        one = mesh["primitives"][0]
        yield (mesh["name"], rows(one["attributes"]["POSITION"]),
               rows(one["attributes"]["NORMAL"]), rows(one["indices"]))


def check_body(report, name, points, normals, triangles):
    edges = {(a, b) for t in triangles for a, b in ((t[0], t[1]), (t[1], t[2]), (t[2], t[0]))}
    report.claim(len(edges) == 3 * len(triangles), f"{name}: an edge of two equal sides")
    open_edges = sum((b, a) not in edges for a, b in edges)
    report.claim(open_edges == 0, f"{name}: {open_edges} open edges")
    volume, turned = 0.0, 0
    for corners in triangles:
        a, b, c = (points[k] for k in corners)
        across = cross(sub(b, a), sub(c, a))
        volume += dot(a, across) / 6
        turned += any(dot(normals[k], across) <= 0 for k in corners)
    report.claim(volume > 0.001, f"{name}: a volume of {volume:.5f} m3")
    report.claim(turned == 0, f"{name}: {turned} triangles turned from their normals")
    lengths = [dot(n, n) for n in normals]
    report.claim(max(abs(x - 1) for x in lengths) < 1e-5, f"{name}: normals of no unit length")


def crossed(eye, mark, corners):
    """Whether the line from eye to mark meets a triangle (Moeller and Trumbore 1997)."""
    a, b, c = corners
    way, u, v = sub(mark, eye), sub(b, a), sub(c, a)
    p = cross(way, v)
    det = dot(u, p)
    if abs(det) < 1e-15:
        return False
    s = sub(eye, a)
    q = cross(s, u)
    x, y, t = dot(s, p) / det, dot(way, q) / det, dot(v, q) / det
    return x >= 0 and y >= 0 and x + y <= 1 and 0 < t < 1


def check_eyes(report, name, bodies):
    eyes, clear, marks = VIEWS[name]
    ahead = []
    for part, points, _, triangles in bodies:
        least = min(dot(sub(p, e), sub(p, e)) for e in eyes for p in points) ** 0.5
        report.claim(least > clear, f"{name} {part}: {least:.3f} m from an eye")
        if part in ("skin", "shirt"):
            ahead += [[points[k] for k in t] for t in triangles
                      if points[t[0]][2] < -0.02 and points[t[0]][1] > 0.8]
    for eye in eyes:
        hidden = sum(any(crossed(eye, mark, c) for c in ahead) for mark in marks)
        report.claim(hidden == 0, f"{name}: hides {hidden} corners from the eye {eye}")


def answer(program, *line):
    done = subprocess.run([program, *line, "--json", "--quiet"], capture_output=True, text=True,
                          check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def check_cloth(report, program, folder):
    """A sheet of each cloth under an even sky sends back its share of it."""
    for name in FILES:
        cloth = next(m for m in load(name)["materials"] if "shirt" in m["name"])
        named, spectrum = cloth["extras"]["luminous_reflectance"], cloth["extensions"]
        report.claim(named == FILES[name][1], f"{name}: cloth of {named}")
        uri = spectrum["PARHELION_spectrum"]["baseColor"]
        shutil.copy(os.path.join(SCENES, uri), folder)
        scene = Scene()
        extensions = {**spectrum, "PARHELION_spectrum": {"baseColor": os.path.basename(uri)}}
        pbr = cloth["pbrMetallicRoughness"]
        report.claim(pbr["baseColorFactor"][:3] == [named] * 3, f"{name}: another core colour")
        sheet = scene.material(cloth["name"], extensions, pbrMetallicRoughness=pbr)
        scene.quad(sheet, [-1, -1, 0], [2, 0, 0], [0, 2, 0])
        scene.view("eye", [0, 0, 1], [0, 0, -1], 20)
        scene.write(os.path.join(folder, "sheet.gltf"))
        frame = os.path.join(folder, "sheet.exr")
        subprocess.run([program, "render", os.path.join(folder, "sheet.gltf"), "--environment",
                        "constant:1000", "--size", "32x32", "--spp", "16", "--quiet", "-o",
                        frame], check=True, capture_output=True)
        found = answer(program, "measure", frame)["luminance_cd_m2"] / 1000
        report.claim(abs(found / named - 1) < 0.01, f"{name}: {found:.4f} instead of {named}")


def table(name):
    with open(os.path.join(SPECTRA, name), encoding="utf-8") as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))[1:]
    return {float(r[0]): [float(x) for x in r[1:]] for r in rows}


def check_skin(report):
    """The chart's maker gives Y = 35.8 for the patch."""
    skin, light, eye = table("skin_light.csv"), table("d65.csv"), table("cie1931_2deg.csv")
    weight = {nm: light[nm][0] * eye[nm][1] for nm in skin}
    found = sum(weight[nm] * skin[nm][0] for nm in skin) / sum(weight.values())
    report.claim(abs(found - 0.358) < 0.005, f"skin reflects {found:.3f} of D65, not 0.358")


def check_light(report, program):
    """The sun ahead leaves the cluster's foot in shade and lights the shirt."""
    car, lux = os.path.join(SCENES, "car_dashboard.gltf"), {}
    for name in ("occupant.gltf", "occupant_dark.gltf"):
        lux[name] = answer(program, "measure", car, os.path.join(SCENES, name), "--illuminance",
                           "-0.44,0.985,-0.7,0,0.17,0.985", "--sun", "35,30,80000", "--samples",
                           "16384")["illuminance_lx"]
    white, dark = lux["occupant.gltf"], lux["occupant_dark.gltf"]
    report.claim(white > 1.5 * dark, f"{white} lx by a white shirt, {dark} by a dark one")


def main():
    report, program = Report(), os.path.abspath(sys.argv[1])
    for name, (interior, _) in FILES.items():
        done = subprocess.run([program, "check", os.path.join(SCENES, interior + ".gltf"),
                               os.path.join(SCENES, name)], capture_output=True, text=True,
                              check=False)
        report.claim("ok: 0 errors, 0 warnings" in done.stdout, f"{name}: {done.stdout[-300:]}")
        if name in VIEWS:
            bodies = list(meshes(load(name)))
            for body in bodies:
                check_body(report, f"{name} {body[0]}", *body[1:])
            check_eyes(report, name, bodies)
    with tempfile.TemporaryDirectory() as folder:
        check_cloth(report, program, folder)
    check_skin(report)
    check_light(report, program)
    report.finish()


if __name__ == "__main__":
    main()
