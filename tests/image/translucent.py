# SPDX-License-Identifier: Apache-2.0
"""translucent.py PARHELION -- paper, shades and opal glass (KHR_materials_diffuse_transmission)
against closed forms: lit from either side by every kind of light, in a furnace with and without
lacquer, as a solid that absorbs; its textures, and what is wrong.
"""
import math
import os
import struct
import subprocess
import sys
import tempfile
import zlib

from eye import Eye, mean
from gltf import Scene, png

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

BACK, ACROSS, SHARE = 0.6, 0.8, 0.35  # albedos of both ways, and how much goes across
NAME = "KHR_materials_diffuse_transmission"


def across(factor=SHARE, color=(ACROSS,) * 3, **more):
    return {NAME: {"diffuseTransmissionFactor": factor,
                   "diffuseTransmissionColorFactor": list(color), **more}}


def sheet(scene, extensions, roughness=1.0, specular=0.0, base=BACK, size=2):
    """A sheet at y = 0 with its front up, without gloss unless it is asked for."""
    paper = scene.material("paper", {"KHR_materials_specular": {"specularFactor": specular},
                                     **extensions}, doubleSided=True, pbrMetallicRoughness={
        "baseColorFactor": [base] * 3 + [1], "metallicFactor": 0, "roughnessFactor": roughness})
    scene.facing_quad(paper, [0, 0, 0], [0, 1, 0], size)


def look(scene, from_above=True, degrees=30):
    angle = math.radians(degrees)
    way = [math.sin(angle), -math.cos(angle) if from_above else math.cos(angle), 0]
    scene.probe("eye", [-x for x in way], way, 0.01)


# ---- lights --------------------------------------------------------------------------------

def lamps():
    """(name, luminance of a white Lambert sheet seen from above) for light from below."""
    def sun(scene):
        scene.light("directional", 1000, direction=[0.6, 0.8, 0])
        return 1000 * 0.8

    def disc(scene):
        scene.environment(type="constant", luminance=0, sun={
            "azimuth_deg": 90, "elevation_deg": -50, "illuminance_lx": 1000})
        return 1000 * math.sin(math.radians(50))

    def point(scene):
        scene.light("point", 500, position=[0, -2, 0])
        return 500 / 4

    def panel(scene):
        """A square of 1 m, 1 m below the point: form factor of four rectangles."""
        scene.facing_quad(scene.emitter(700), [0, -1, 0], [0, 1, 0], 1)
        a = 0.5
        side = a / math.sqrt(1 + a * a)
        return 700 * math.pi * 4 * side * math.atan(side) / math.pi

    return [("a parallel lamp", sun), ("the sun", disc), ("a point", point), ("a panel", panel)]


def check_lamps(report, eye):
    """From behind what goes across, from before what goes back."""
    for name, lamp in lamps():
        for from_above, share in ((True, SHARE * ACROSS), (False, (1 - SHARE) * BACK)):
            for is_turned in (False, True):
                scene = Scene()
                sheet(scene, across(), size=0.2)
                lx = lamp(scene)
                look(scene, from_above)
                if is_turned:
                    scene.document["nodes"][0]["rotation"] = [1, 0, 0, 0]  # its back is up
                found = eye.mean(scene, 64, "--max-bounces", "1")
                wanted = lx * share / math.pi
                report.claim(abs(found / wanted - 1) < 0.01,
                             f"{name} {'behind' if from_above else 'before'} the sheet: "
                             f"{found:.3f} cd/m2, required: {wanted:.3f}")


def check_sky(report, eye):
    """A sky above a dark ground, seen from both sides of the sheet."""
    for from_above, share in ((True, (1 - SHARE) * BACK), (False, SHARE * ACROSS)):
        scene = Scene()
        sheet(scene, across())
        scene.facing_quad(scene.emitter(0), [0, -0.5, 0], [0, 1, 0], 400)
        scene.environment(type="constant", luminance=900)
        height = 0.4 if from_above else -0.4
        scene.probe("eye", [-0.2, height, 0], [0.2, -height, 0], 0.01)
        found = eye.mean(scene, 256, "--max-bounces", "1")
        report.claim(abs(found / (900 * share) - 1) < 0.01,
                     f"sky, eye {'above' if from_above else 'below'}: {found:.3f} cd/m2, "
                     f"required: {900 * share:.3f}")


# ---- energy --------------------------------------------------------------------------------

def check_furnace(report, eye):
    """White on both ways it is not seen, lacquered or not, glossy or matt, at any angle."""
    coats = [None, (1, 0), (1, 0.6), (0.5, 0.3)]
    for roughness in (0, 0.5, 1):
        for coat in coats:
            for degrees in (0, 60, 80):
                scene = Scene()
                extensions = across(0.5, (1, 1, 1))
                if coat:
                    extensions["KHR_materials_clearcoat"] = {
                        "clearcoatFactor": coat[0], "clearcoatRoughnessFactor": coat[1]}
                sheet(scene, extensions, roughness, 1, 1)
                look(scene, degrees=degrees)
                scene.environment(type="constant", luminance=1000)
                found = eye.mean(scene, 1024) / 1000
                report.claim(abs(found - 1) < 0.002,
                             f"roughness {roughness}, coat {coat}, {degrees} degrees: a "
                             f"furnace shows {found:.5f}")


def check_solid(report, eye):
    """A ball that lets all light in and out as Lambert does and halves it every metre: of a sky
    L it shows 2 L (1 - (1 + x) e^-x) / x^2, x the absorption along its diameter."""
    scene = Scene()
    opal = scene.material("opal", {
        **across(1, (1, 1, 1)), "KHR_materials_specular": {"specularFactor": 0},
        "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 1,
                                 "attenuationColor": [0.5] * 3}},
        pbrMetallicRoughness={"metallicFactor": 0})
    scene.sphere(opal, [0, 0, 0], 0.8, rings=48)
    scene.environment(type="constant", luminance=1000)
    scene.probe("eye", [0, 0, 3], [0, 0, -1], 0.5)
    found = eye.mean(scene, 1024, "--max-bounces", "4") / 1000
    x = 1.6 * math.log(2)
    wanted = 2 * (1 - (1 + x) * math.exp(-x)) / x ** 2
    report.claim(abs(found / wanted - 1) < 0.005,
                 f"an opal ball shows {found:.5f} of the sky, required: {wanted:.5f}")


def check_lamp_inside(report, eye):
    """Through the wall of that ball goes what a lamp in its middle sends there: by the light
    sample and by chance, less what the way absorbs."""
    radius, r, a = 0.8, 0.2, math.log(2)
    for name in ("point", "ball"):
        scene = Scene()
        opal = scene.material("opal", {
            **across(1, (1, 1, 1)), "KHR_materials_specular": {"specularFactor": 0},
            "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 1,
                                     "attenuationColor": [0.5] * 3}},
            pbrMetallicRoughness={"metallicFactor": 0})
        scene.sphere(opal, [0, 0, 0], radius, rings=64)
        if name == "point":
            scene.light("point", 1000, position=[0, 0, 0])
            wanted = 1000 * math.exp(-a * radius) / radius ** 2
        else:
            scene.sphere(scene.emitter(10000), [0, 0, 0], r, rings=64)
            edge, wanted, count = r / radius, 0, 2000
            for i in range(count):  # over the sine's square: cos sin d angle = d sin^2 / 2
                s2 = edge ** 2 * (i + 0.5) / count
                way = radius * math.sqrt(1 - s2) - math.sqrt(r * r - radius ** 2 * s2)
                wanted += math.pi * 10000 * math.exp(-a * way) * edge ** 2 / count
        scene.probe("eye", [0, 0, 3], [0, 0, -1], 0.3)
        found = eye.mean(scene, 256, "--max-bounces", "2")
        report.claim(abs(found * math.pi / wanted - 1) < 0.005,
                     f"a {name} in an opal ball: {found:.3f} cd/m2, required: "
                     f"{wanted / math.pi:.3f}")


# ---- textures ------------------------------------------------------------------------------

def linear(code):
    c = code / 255
    return c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4


def check_textures(report, eye):
    """The share by alpha, the colour in sRGB; each moved by a transform of its own."""
    for u in (0, 0.5):
        scene = Scene()
        share = scene.image("image/png", rgba_png([(9, 9, 9, 51), (9, 9, 9, 204)]))
        color = scene.image("image/png", png(2, 1, [[188, 120, 60, 60, 188, 120]]))
        scene.used.add("KHR_texture_transform")
        place = {"KHR_texture_transform": {"offset": [u, 0], "scale": [0, 0]}}
        other = {"KHR_texture_transform": {"offset": [0.5 - u, 0], "scale": [0, 0]}}
        sheet(scene, across(0.9, (1, 0.5, 1),
                            diffuseTransmissionTexture={"index": share, "extensions": place},
                            diffuseTransmissionColorTexture={"index": color,
                                                             "extensions": other}))
        scene.light("directional", 1000, direction=[0, 1, 0])
        look(scene)
        frame = eye.frame(scene, "--size", "8x8", "--spp", "1024", "--max-bounces", "1")
        found = [mean(frame.channels[c]) for c in "RGB"]
        rgb = (188, 120, 60) if u else (60, 188, 120)
        wanted = [1000 / math.pi * 0.9 * (0.8 if u else 0.2) * f * linear(c)
                  for f, c in zip((1, 0.5, 1), rgb)]
        report.claim(all(abs(a - b) < 0.01 * max(wanted) for a, b in zip(found, wanted)),
                     f"textures at {u}: {found}, required: {wanted}")


def rgba_png(pixels):
    """One row."""
    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data
                + struct.pack(">I", zlib.crc32(kind + data)))
    raw = b"\0" + bytes(x for pixel in pixels for x in pixel)
    head = struct.pack(">IIBBBBB", len(pixels), 1, 8, 6, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(raw))
            + chunk(b"IEND", b""))


# ---- what is wrong -------------------------------------------------------------------------

FAULTS = [
    ({"diffuseTransmissionFactor": -0.1}, "diffuseTransmissionFactor"),
    ({"diffuseTransmissionFactor": 1.1}, "diffuseTransmissionFactor"),
    ({"diffuseTransmissionFactor": "1"}, "diffuseTransmissionFactor"),
    ({"diffuseTransmissionColorFactor": [1, 1]}, "diffuseTransmissionColorFactor"),
    ({"diffuseTransmissionColorFactor": [1, 1, 2]}, "diffuseTransmissionColorFactor"),
    ({"diffuseTransmissionColorFactor": 1}, "diffuseTransmissionColorFactor"),
    ({"diffuseTransmissionTexture": {}}, "index"),
    ({"diffuseTransmissionTexture": {"index": 7}}, "diffuseTransmissionTexture"),
    ({"diffuseTransmissionColorTexture": {"index": -1}}, "diffuseTransmissionColorTexture"),
    ({"diffuseTransmissionColorTexture": 0}, "diffuseTransmissionColorTexture"),
]


def check_faults(report, program, folder):
    path = os.path.join(folder, "fault.gltf")

    def check(extensions):
        scene = Scene()
        glass = scene.material("a", extensions, pbrMetallicRoughness={"metallicFactor": 0})
        scene.facing_quad(glass, [0, 0, 0], [0, 1, 0], 1)
        scene.write(path)
        done = subprocess.run([program, "check", path], capture_output=True, text=True,
                              check=False)
        return done.returncode, done.stdout + done.stderr

    for members, said in FAULTS:
        status, text = check({NAME: members})
        report.claim(status == 3 and said in text and "NOT OK: 1 errors" in text,
                     f"{members} ends with {status}: {text}")
    solid = {"KHR_materials_volume": {"thicknessFactor": 1}}
    clear = {"KHR_materials_transmission": {"transmissionFactor": 1}}
    for beside, said in (({**solid, **clear}, "makes the solid clear"), (solid, "0 warnings"),
                         (clear, "0 warnings")):
        status, text = check({**across(), **beside})
        report.claim(status == 0 and said in text, f"{list(beside)}: {status}, {text}")


def main():
    program = os.path.abspath(sys.argv[-1])
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        eye = Eye(program, folder)
        check_lamps(report, eye)
        check_sky(report, eye)
        check_furnace(report, eye)
        check_solid(report, eye)
        check_lamp_inside(report, eye)
        check_textures(report, eye)
        check_faults(report, program, folder)
    return report.finish()


if __name__ == "__main__":
    sys.exit(main())
