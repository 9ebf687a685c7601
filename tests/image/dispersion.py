# SPDX-License-Identifier: Apache-2.0
"""dispersion.py PARHELION -- a prism parts white light: what of it lands beyond an edge against
Snell's law at both faces and Cauchy's index; indices and metals measured by wavelength
(OpenMaterial_ior_data); and what is none.
"""
import json
import math
import os
import subprocess
import sys
import tempfile

import layers
from eye import Eye
from gltf import Scene, cross, dot, unit

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

INDEX, DISPERSION = 1.6, 20 / 25.0
LUMINANCE = 1000
SCREEN = 4.0                                  # m behind the prism
APEX, LEFT, RIGHT = (0, 0.09), (-0.06, 0), (0.05, 0)  # of the prism, m; it lies along z
RAY = (math.cos(0.35), math.sin(0.35))        # of the eye, upwards onto the left face


# ---- closed forms --------------------------------------------------------------------------

def cauchy(nm):
    b = (INDEX - 1) * DISPERSION / 20 / (486.1 ** -2 - 656.3 ** -2)
    return INDEX + b * (nm ** -2 - 587.6 ** -2)


def outward_normal(a, b):
    """Of the side from a to b, turning clockwise."""
    return unit([-(b[1] - a[1]), b[0] - a[0], 0])[:2]


def bend(way, normal, ratio):
    """Snell: the new way, and what passes of unpolarised light. ratio: index over index."""
    cosine = -(way[0] * normal[0] + way[1] * normal[1])
    if cosine < 0:
        normal, cosine = [-x for x in normal], -cosine
    behind = math.sqrt(1 - ratio * ratio * (1 - cosine * cosine))
    out = [ratio * w + (ratio * cosine - behind) * n for w, n in zip(way, normal)]
    s, p = (ratio * cosine - behind) / (ratio * cosine + behind), \
        (cosine - ratio * behind) / (cosine + ratio * behind)
    return out, 1 - (s * s + p * p) / 2


def meet(place, way, a, b):
    """Where the ray meets the line through a and b."""
    side = [b[0] - a[0], b[1] - a[1]]
    cross = way[0] * side[1] - way[1] * side[0]
    t = ((a[0] - place[0]) * side[1] - (a[1] - place[1]) * side[0]) / cross
    return [place[0] + t * way[0], place[1] + t * way[1]]


def entry():
    return [(APEX[i] + LEFT[i]) / 2 for i in range(2)]


def landing(nm):
    """Height on the screen, and the share that gets there."""
    n = cauchy(nm)
    way, first = bend(RAY, outward_normal(LEFT, APEX), 1 / n)
    place = meet(entry(), way, APEX, RIGHT)
    assert RIGHT[1] < place[1] < APEX[1]
    way, second = bend(way, outward_normal(APEX, RIGHT), n)
    return meet(place, way, (SCREEN, 0), (SCREEN, 1))[1], first * second


def beyond(edge):
    """Share of white light that lands above the edge."""
    total = 0
    for nm, weight in layers.WHITE:
        y, share = landing(nm)
        total += weight * share * (y > edge)
    return total


# ---- scenes --------------------------------------------------------------------------------

def prism_glass(**more):
    return {"KHR_materials_transmission": {"transmissionFactor": 1},
            "KHR_materials_volume": {"thicknessFactor": 1},
            "KHR_materials_ior": {"ior": INDEX}, **more}


CAUCHY = {"KHR_materials_dispersion": {"dispersion": DISPERSION}}
MEASURED = {"OpenMaterial_material_parameters": {
    "user_preferences": {}, "physical_properties": {"refractive_index_uri": "glass_ior.gltf"}}}


def index_file(data):
    return json.dumps({"asset": {"version": "1.0"}, "extensionsUsed": ["OpenMaterial_ior_data"],
                       "extensions": {"OpenMaterial_ior_data": {"data": data}}}).encode()


def room_glass():
    """Measured when it was cold and hot, too: another glass then."""
    rows = [[nm * 1e-9, cauchy(nm)] for nm in range(350, 851)]
    return index_file([
        {"temperature": 100, "n": [[5e-7, 1.3]], "k": [[5e-7, 0]]},
        {"temperature": 300.0, "n": rows, "k": [[4e-7, 0.0], [7e-7, 0.0]]},
        {"temperature": 500, "n": [[5e-7, 2.3]], "k": [[5e-7, 0]]}])


def prism_scene(extensions, edge):
    """The prism, a screen that shines above the edge, and an eye that is one ray."""
    scene = Scene()
    glass = scene.material("prism", prism_glass(**extensions), pbrMetallicRoughness={
        "metallicFactor": 0, "roughnessFactor": 0})
    flat = [(*p, z) for z in (-0.5, 0.5) for p in (LEFT, RIGHT, APEX)]
    faces = [[0, 1, 2], [3, 4, 5], [0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [2, 0, 3],
             [2, 3, 5]]
    centre = [sum(p[i] for p in flat) / 6 for i in range(3)]
    turned = []
    for i, j, k in faces:
        a, b, c = flat[i], flat[j], flat[k]
        u, v = [b[n] - a[n] for n in range(3)], [c[n] - a[n] for n in range(3)]
        normal = cross(u, v)
        away = [a[n] - centre[n] for n in range(3)]
        turned.append([i, j, k] if dot(normal, away) > 0 else [i, k, j])
    scene.mesh(glass, [list(p) for p in flat], turned)
    scene.quad(scene.emitter(LUMINANCE), [SCREEN, edge, -5], [0, 0, 10], [0, 10, 0])
    if "OpenMaterial_material_parameters" in extensions:
        scene.files["glass_ior.gltf"] = room_glass()
    start = [e - 0.5 * r for e, r in zip(entry(), RAY)]
    scene.probe("eye", [*start, 0], [*RAY, 0], 1e-7)
    return scene


def check_prism(report, eye):
    for nm in (480.5, 550.5, 600.5):  # between the rows of the sum
        edge = landing(nm)[0]
        wanted = beyond(edge)
        for name, extensions in (("Cauchy", CAUCHY), ("measured", MEASURED)):
            found = eye.mean(prism_scene(extensions, edge), 2048, "--max-bounces",
                             "2") / LUMINANCE
            report.claim(abs(found - wanted) < 0.01 * wanted,
                         f"{name}: {found:.5f} of the light lands beyond {nm} nm, required: "
                         f"{wanted:.5f}")


def check_furnace(report, eye):
    """Clear glass in a sky of one luminance is not seen, however it parts light."""
    for name, extensions in (("Cauchy", CAUCHY), ("measured", MEASURED)):
        scene = Scene()
        glass = scene.material("slab", prism_glass(**extensions), pbrMetallicRoughness={
            "metallicFactor": 0, "roughnessFactor": 0})
        scene.box_outside(glass, [-50, -0.1, -50], [50, 0, 50])
        scene.files["glass_ior.gltf"] = room_glass()
        scene.environment(type="constant", luminance=LUMINANCE)
        scene.probe("eye", [-0.8, 0.6, 0], [0.8, -0.6, 0], 0.1)
        found = eye.mean(scene, 4096, "--max-bounces", "64") / LUMINANCE
        report.claim(abs(found - 1) < 0.002, f"{name}: a slab in a furnace shows {found:.5f}")


def check_metal(report, eye):
    n, k = 0.62, 2.1
    for degrees in (0, 60, 80):
        angle, scene = math.radians(degrees), Scene()
        metal = scene.material("metal", MEASURED, pbrMetallicRoughness={
            "metallicFactor": 1, "roughnessFactor": 0})
        scene.facing_quad(metal, [0, 0, 0], [0, 1, 0], 2)
        scene.environment(type="constant", luminance=LUMINANCE)
        scene.files["glass_ior.gltf"] = index_file(
            [{"temperature": 293, "n": [[3e-7, n], [8e-7, n]],
              "k": [[3.8e-7, k], [7.8e-7, k]]}])
        way = [math.sin(angle), -math.cos(angle), 0]
        scene.probe("eye", [-x for x in way], way, 0.01)
        found = eye.mean(scene, 16) / LUMINANCE
        wanted = layers.metal(math.cos(angle), complex(n, k))
        report.claim(abs(found - wanted) < 1e-3, f"a measured metal at {degrees} degrees "
                                                 f"reflects {found:.5f}, required: "
                                                 f"{wanted:.5f}")


RADAR = index_file([{"temperature": 300, "n": [[3.9e-3, 2.5]], "k": [[3.9e-3, 0.1]]}])


def check_unused(report, eye):
    """A file that says nothing of visible light leaves the index as it was; so does a
    dispersion beside it, which is told not to be used."""
    edge, found = landing(550.5)[0], []
    for extensions in ({}, MEASURED, {**MEASURED, **CAUCHY}):
        scene = prism_scene(extensions, edge)
        if extensions:
            scene.files["glass_ior.gltf"] = RADAR
        found.append(eye.mean(scene, 64, "--max-bounces", "2"))
    report.claim(found[0] == found[1] == found[2] > 0, f"a file of radar waves alone: {found}")


# ---- what is none --------------------------------------------------------------------------

GOOD = {"temperature": 300, "n": [[3.8e-7, 1.5], [7.8e-7, 1.4]],
        "k": [[3.8e-7, 0], [7.8e-7, 0]]}
FILES = [
    (b"{", "glass_ior.gltf"), (b"[]", "OpenMaterial_ior_data is required"),
    (b'{"extensions": {"OpenMaterial_ior_data": {}}}', '"data" is required'),
    (index_file([]), '"data" is required'),
    (index_file([{**GOOD, "temperature": "300"}]), '/data/0: "temperature" is required'),
    (index_file([GOOD, {**GOOD, "temperature": 0}]), '/data/1: "temperature" is required'),
    (index_file([{"temperature": 300, "n": GOOD["n"]}]), '/data/0: "k" is required'),
    (index_file([{**GOOD, "n": []}]), '/data/0/n: "n" is required'),
    (index_file([{**GOOD, "n": [[4e-7]]}]), "/data/0/n/0: a pair"),
    (index_file([{**GOOD, "n": [[4e-7, 1.5, 0]]}]), "/data/0/n/0: a pair"),
    (index_file([{**GOOD, "n": [[4e-7, "1.5"]]}]), "/data/0/n/0: a pair"),
    (index_file([{**GOOD, "n": [[0, 1.5]]}]), "/data/0/n/0: a pair"),
    (index_file([{**GOOD, "k": [[4e-7, -1]]}]), "/data/0/k/0: a pair"),
    (index_file([{**GOOD, "n": [[4e-7, 1.5], [4e-7, 1.5]]}]), "/data/0/n/1: wavelengths that"),
    (index_file([{**GOOD, "n": [[3.8e-7, 0], [7.8e-7, 0]]}]), "/data/0: n and k are both 0"),
    (index_file([{**GOOD, "n": [[3.8e-7, 0.5], [7.8e-7, 0.5]]}]),
     "n is 0.5 at 360 nm: a metal's"),
]
MEMBERS = [
    ({"physical_properties": {"refractive_index_uri": 3}}, "is no text"),
    ({"physical_properties": []}, "is no object"),
    ({"physical_properties": {"refractive_index_uri": "no.gltf"}}, "no.gltf"),
    ({"physical_properties": {"refractive_index_uri": "http://a/b.gltf"}}, "scheme"),
]


def check(program, folder, extensions, files=None, metallic=0):
    scene = Scene()
    glass = scene.material("glass", extensions, pbrMetallicRoughness={
        "metallicFactor": metallic, "roughnessFactor": 0})
    scene.box_outside(glass, [0, 0, 0], [1, 1, 1])
    scene.files.update(files or {})
    path = os.path.join(folder, "fault.gltf")
    scene.write(path)
    done = subprocess.run([program, "check", path], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def check_faults(report, program, folder):
    for data, said in FILES:
        status, text = check(program, folder, prism_glass(**MEASURED), {"glass_ior.gltf": data})
        report.claim(status == 3 and said in text and "NOT OK: 1 errors" in text,
                     f"{data[:120]} ends with {status}: {text[:300]}")
    for members, said in MEMBERS:
        status, text = check(program, folder,
                             prism_glass(OpenMaterial_material_parameters=members))
        report.claim(status == 3 and said in text, f"{members} ends with {status}: {text}")
    for value, said in ((-1, "is -1"), ("1", "dispersion"),
                        (1e5, "the index at 360 nm would be")):
        status, text = check(program, folder,
                             prism_glass(KHR_materials_dispersion={"dispersion": value}))
        report.claim(status == 3 and said in text, f"dispersion {value}: {status}, {text}")


def check_company(report, program, folder):
    """What stands beside an index by wavelength: refused, or told and left out."""
    coat = {"PARHELION_coating": {"stack": "mgf2"}}
    glass = {"glass_ior.gltf": index_file([GOOD])}
    thin = {k: v for k, v in prism_glass(**CAUCHY).items() if k != "KHR_materials_volume"}
    radar = {"glass_ior.gltf": RADAR}
    short = {"glass_ior.gltf": index_file([{**GOOD, "k": [[4e-7, 0], [7e-7, 0]]}])}
    metal = {**MEASURED, "PARHELION_spectrum": {"conductor": "metal.csv"}}
    tables = {**glass, "metal.csv": b"400,1,6\n700,1,6\n"}
    for wanted, said, extensions, files, metallic in (
            (3, "stands beside PARHELION_coating", prism_glass(**CAUCHY, **coat), {}, 0),
            (3, "stands beside PARHELION_coating", prism_glass(**MEASURED, **coat), glass, 0),
            (0, "spreads nothing", thin, {}, 0),
            (0, "the index is measured", prism_glass(**CAUCHY, **MEASURED), glass, 0),
            (0, "does not reach from 400 to 700 nm", prism_glass(**MEASURED), radar, 0),
            (0, "of V(lambda) is extrapolated", prism_glass(**MEASURED), short, 0),
            (0, 'PARHELION_spectrum has "conductor"', metal, tables, 1),
            (0, "0 warnings", {**MEASURED, **coat}, glass, 1)):
        status, text = check(program, folder, extensions, files, metallic)
        report.claim(status == wanted and said in text,
                     f"{list(extensions)}: {status}, {text}, required: {said}")


def main():
    program = os.path.abspath(sys.argv[-1])
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        eye = Eye(program, folder)
        check_prism(report, eye)
        check_furnace(report, eye)
        check_metal(report, eye)
        check_unused(report, eye)
        check_faults(report, program, folder)
        check_company(report, program, folder)
    return report.finish()


if __name__ == "__main__":
    sys.exit(main())
