# SPDX-License-Identifier: Apache-2.0
"""panes.py PARHELION -- thin panes are two faces and one absorbing body, whatever names their
tint; and displays seen through neutral ones and in neutral mirrors keep the panel's own XYZ,
angle by angle and to single precision, whatever the wavelengths.
"""
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile

from eye import Eye
from gltf import Scene, dot, png

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

PANEL = "ips_cluster.panel"
CODES = (210, 90, 160)
XYZ_FROM_RGB = ((0.4123908, 0.3575843, 0.1804808), (0.2126390, 0.7151687, 0.0721923),
                (0.0193308, 0.1191948, 0.9505322))


# ---- closed forms --------------------------------------------------------------------------

def faces(angle, index):
    """One face's reflectance, s and p (Born and Wolf, 1.5.2)."""
    out, inside = math.cos(angle), math.sqrt(1 - (math.sin(angle) / index) ** 2)
    return [((a - b) / (a + b)) ** 2 for a, b in ((out, index * inside), (index * out, inside))]


def body(angle, index, along_normal):
    return along_normal ** (1 / math.sqrt(1 - (math.sin(angle) / index) ** 2))


def passed(angle, index, tint):
    t = body(angle, index, tint)
    return sum((1 - r) ** 2 * t / (1 - r * r * t * t) for r in faces(angle, index)) / 2


def mirrored(angle, index, tint):
    t2 = body(angle, index, tint) ** 2
    return sum(r + (1 - r) ** 2 * t2 * r / (1 - r * r * t2) for r in faces(angle, index)) / 2


def schlick(angle, f0):
    return f0 + (1 - f0) * (1 - math.cos(angle)) ** 5


# ---- displays ------------------------------------------------------------------------------

def display(scene):
    """1 m about the origin, facing +Z."""
    content = scene.image("image/png", png(1, 1, [list(CODES)]))
    material = scene.material("display", extensions={"PARHELION_display": {
        "panel": PANEL, "content": {"index": content}, "level": 1}})
    scene.quad(material, [-8, -8, 0], [16, 0, 0], [0, 16, 0])


def through(material_of, degrees):
    """Seen through a pane that lies before it."""
    scene, angle = Scene(), math.radians(degrees)
    display(scene)
    scene.quad(material_of(scene), [-30, -30, 0.5], [60, 0, 0], [0, 60, 0])
    away = [math.sin(angle), 0, math.cos(angle)]
    scene.probe("eye", [x / math.cos(angle) for x in away], [-x for x in away], 0.01)
    return scene


def in_mirror(material_of, degrees):
    """Seen in a mirror that lies over it, from between."""
    scene, angle = Scene(), math.radians(degrees)
    display(scene)
    scene.quad(material_of(scene), [-30, 30, 1], [60, 0, 0], [0, -60, 0])
    scene.probe("eye", [-1.5 * math.tan(angle), 0, 0.5], [math.sin(angle), 0, math.cos(angle)],
                0.01)
    return scene


def evaluated(program, folder, degrees, phi):
    done = subprocess.run([program, "panel", "eval", PANEL, "--theta", str(degrees), "--phi",
                           str(phi), "--rgb", ",".join(map(str, CODES)), "--json"], cwd=folder,
                          check=True, capture_output=True, text=True)
    return json.loads(done.stdout)["XYZ"]


def shown(eye, scene, *options):
    frame = eye.frame(scene, "--size", "4x4", *options)
    rgb = [frame.mean(name, (0, 0, 4, 4)) for name in "RGB"]
    return [dot(row, rgb) for row in XYZ_FROM_RGB]


def level_curve(scene, name, value):
    scene.files[name] = f"nm,value\n400,{value}\n555,{value}\n700,{value}\n".encode()
    return name


def level_pane(scene):
    return scene.material(
        pbrMetallicRoughness={"metallicFactor": 0, "roughnessFactor": 0}, doubleSided=True,
        extensions={"KHR_materials_transmission": {"transmissionFactor": 1},
                    "KHR_materials_ior": {"ior": 1.5},
                    "PARHELION_spectrum": {"transmission": level_curve(scene, "t.csv", 0.3)}})


def laminate(scene):
    layers = [{"thickness_m": 0.003, "ior": 1.5, "transmission": 0.55}]
    return scene.material(extensions={"PARHELION_glazing": {"layers": layers}},
                          doubleSided=True)


PANES = [("a grey tint of 0.37", lambda s: s.window(1.5, (0.37,) * 3), 0.37),
         ("a grey tint of 0.8", lambda s: s.window(1.5, (0.8,) * 3), 0.8),
         ("a level curve of 0.3", level_pane, 0.3), ("a laminate of 0.55", laminate, 0.55)]
MIRRORS = [("a grey metal of 0.7", lambda s: s.metal(0.7), lambda a: schlick(a, 0.7)),
           ("a grey metal of 0.33", lambda s: s.metal(0.33), lambda a: schlick(a, 0.33))]


def claim_xyz(report, what, found, wanted, granted):
    worst = max(abs(f / w - 1) for f, w in zip(found, wanted))
    report.claim(worst < granted, f"{what}: XYZ off by {worst:.2g} (allowed {granted:g}): "
                 f"{found}, required: {wanted}")


def bare(scene):
    """A hole: the display itself."""
    return scene.material(alphaMode="MASK", pbrMetallicRoughness={
        "baseColorFactor": [1, 1, 1, 0]})


def check_neutral(report, eye, folder):
    """Beside the panel, and to 2e-5 beside a frame of the display itself, whose RGB came from
    XYZ alike. 4 samples a pixel: paths that kept lanes would be off by some per cent."""
    for degrees in (0, 10, 25, 40, 55, 65):
        angle = math.radians(degrees)
        direct = shown(eye, through(bare, degrees), "--spp", "4", "--max-bounces", "0")
        claim_xyz(report, f"{degrees} degrees, the display itself", direct,
                  evaluated(eye.program, folder, degrees, 0), 3e-4)
        for name, make, tint in PANES:
            share = passed(angle, 1.5, tint)
            found = shown(eye, through(make, degrees), "--spp", "4", "--max-bounces", "0")
            claim_xyz(report, f"{degrees} degrees through {name}", found,
                      [share * x for x in direct], 2e-5)
        panel = evaluated(eye.program, folder, degrees, 180)
        for name, make, reflectance in MIRRORS:
            found = shown(eye, in_mirror(make, degrees), "--spp", "4", "--max-bounces", "1")
            claim_xyz(report, f"{degrees} degrees in {name}", found,
                      [reflectance(angle) * x for x in panel], 3e-4)


def check_lanes(report, eye):
    """A mirror that is no more neutral than a millionth sends the panel's spectrum through the
    lanes: the same in the mean."""
    def almost(scene):
        return scene.material(pbrMetallicRoughness={
            "baseColorFactor": [0.7, 0.7, 0.699999, 1], "metallicFactor": 1,
            "roughnessFactor": 0})
    for degrees in (10, 55):
        neutral = shown(eye, in_mirror(MIRRORS[0][1], degrees), "--spp", "4", "--max-bounces",
                        "1")
        found = shown(eye, in_mirror(almost, degrees), "--spp", "4096", "--max-bounces", "1")
        claim_xyz(report, f"{degrees} degrees by the lanes", found, neutral, 5e-5)


# ---- panes ---------------------------------------------------------------------------------

LUMINANCE = 1000


def lit_pane(material_of, degrees, above):
    """A pane at y = 0 under a wide lamp, or over one, seen from above."""
    scene, angle = Scene(), math.radians(degrees)
    scene.facing_quad(material_of(scene), [0, 0, 0], [0, 1, 0], 2)
    scene.facing_quad(scene.emitter(LUMINANCE), [0, 3 if above else -1, 0],
                      [0, -1 if above else 1, 0], 80)
    way = [math.sin(angle), -math.cos(angle), 0]
    scene.probe("eye", [-x for x in way], way, 0.01)
    return scene


def half_clear(scene):
    """glTF's surface, not its window: a tenth of it is a black body."""
    return scene.material(
        pbrMetallicRoughness={"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0,
                              "roughnessFactor": 0}, doubleSided=True,
        extensions={"KHR_materials_transmission": {"transmissionFactor": 0.9}})


def check_panes(report, eye):
    for tint in (1, 0.5, 0.25, 0.1):
        for degrees in (0, 45, 70):
            angle = math.radians(degrees)
            for above, share in ((True, mirrored), (False, passed)):
                scene = lit_pane(lambda s, t=tint: s.window(1.5, (t,) * 3), degrees, above)
                found = eye.mean(scene, 256 if above else 4, "--max-bounces", "1") / LUMINANCE
                wanted = share(angle, 1.5, tint)
                report.claim(abs(found / wanted - 1) < 0.01,
                             f"tint {tint}, {degrees} degrees: {share.__name__} {found:.5f}, "
                             f"required: {wanted:.5f}")
                if above and not degrees:
                    print(f"upright, tint {tint}: {100 * found:.3f} % mirrored")
    for degrees in (0, 60):
        angle = math.radians(degrees)
        found = eye.mean(lit_pane(half_clear, degrees, True), 256, "--max-bounces", "1")
        wanted = LUMINANCE * (0.9 * mirrored(angle, 1.5, 1e-9) + 0.1 *
                              sum(faces(angle, 1.5)) / 2)
        report.claim(abs(found / wanted - 1) < 0.01, f"black and clear, {degrees} degrees: "
                     f"{found:.4f}, required: {wanted:.4f}")


def check(report, program, folder):
    shutil.copy(os.path.join(ROOT, "assets", "panels", PANEL), folder)
    eye = Eye(program, folder)
    check_panes(report, eye)
    check_neutral(report, eye, folder)
    check_lanes(report, eye)


def main():
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        check(report, sys.argv[1], folder)
    report.finish()


if __name__ == "__main__":
    main()
