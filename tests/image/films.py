# SPDX-License-Identifier: Apache-2.0
"""films.py PARHELION -- thin films on solids of glass (KHR_materials_iridescence) against
Airy's closed form: what one face reflects, what a slab lets through, its textures, the sun by
way of it.
"""
import cmath
import math
import os
import subprocess
import sys
import tempfile

import layers
from exr import Frame
from gltf import Scene, png

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

LUMINANCE = 1000
NAME = "KHR_materials_iridescence"
BLACK = ([0, 0, 0], 1e-6)  # what goes in does not come out


class Eye:
    def __init__(self, program, folder):
        self.program, self.folder = os.path.abspath(program), folder

    def luminance(self, scene, *options):
        scene.write(os.path.join(self.folder, "scene.gltf"))
        done = subprocess.run([self.program, "render", "scene.gltf", "-o", "frame.exr",
                               "--size", "8x8", *options, "--quiet"], cwd=self.folder,
                              capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        frame = Frame(os.path.join(self.folder, "frame.exr"))
        values = [0.2126 * r + 0.7152 * g + 0.0722 * b
                  for r, g, b in zip(*(frame.channels[c] for c in "RGB"))]
        return sum(values) / len(values)


def airy(cosine, nm, is_p, film, thickness_nm, body):
    """Born and Wolf, 7.6.1: one clear layer between air and a clear body."""
    first, inside = layers.amplitude((1, film), cosine, is_p)
    second, _ = layers.amplitude((film, body), inside, is_p)
    turn = cmath.exp(4j * math.pi * film * thickness_nm * inside / nm)
    return abs((first + second * turn) / (1 + first * second * turn)) ** 2


def sunlit(reflectance):
    """Mean of reflectance(nm, is_p) over the light of a black body of 5500 K, the plain sun."""
    def planck(nm):
        return nm ** -5 / (math.exp(1.438777e7 / (nm * 5500)) - 1)
    rows = [(nm, y * planck(nm)) for nm, _, y, _ in layers.table("cie1931_2deg.csv")]
    return sum(weight * (reflectance(nm, False) + reflectance(nm, True)) / 2
               for nm, weight in rows) / sum(weight for _, weight in rows)


def face(cosine, film, thickness_nm, body, share=1.0, light=layers.white):
    """What one face reflects of the light."""
    def mixed(nm, is_p):
        bare = abs(layers.amplitude((1, body), cosine, is_p)[0]) ** 2
        return bare + share * (airy(cosine, nm, is_p, film, thickness_nm, body) - bare)
    return light(mixed)


def slab(cosine, film, thickness_nm, body):
    """What both faces let through: (1 - r) / (1 + r), the light unpolarised at each."""
    def through(nm, _):
        r = sum(airy(cosine, nm, is_p, film, thickness_nm, body) for is_p in (0, 1)) / 2
        return (1 - r) / (1 + r)
    return layers.white(through)


# ---- scenes --------------------------------------------------------------------------------

def filmed(scene, body, film, attenuation=None, half=50):
    """A slab with its top at y = 0."""
    material = scene.glass(body, attenuation)
    members = scene.document["materials"][material]
    members["extensions"][NAME] = film
    scene.used.add(NAME)
    scene.box_outside(material, [-half, -0.1, -half], [half, 0, half])


def layer(film, thickness_nm, **more):
    return {"iridescenceFactor": 1, "iridescenceIor": film,
            "iridescenceThicknessMaximum": thickness_nm, **more}


def look(scene, degrees):
    angle = math.radians(degrees)
    way = [math.sin(angle), -math.cos(angle), 0]
    scene.probe("eye", [-x for x in way], way, 0.01)


FILMS = [(1.33, 420, 1.0), (1.8, 150, 1.5), (1.8, 520, 1.5), (1.3, 400, 2.4)]


def check_face(report, eye):
    for film, thickness_nm, body in FILMS:
        for degrees in (0, 50, 80):
            scene = Scene()
            filmed(scene, body, layer(film, thickness_nm), BLACK)
            look(scene, degrees)
            scene.environment(type="constant", luminance=LUMINANCE)
            found = eye.luminance(scene, "--spp", "1024", "--max-bounces", "3") / LUMINANCE
            wanted = face(math.cos(math.radians(degrees)), film, thickness_nm, body)
            report.claim(abs(found - wanted) < 0.002 + 0.01 * wanted,
                         f"a film of {thickness_nm} nm, {film} on {body}, at {degrees} degrees "
                         f"reflects {found:.5f}, required: {wanted:.5f}")


def check_slab(report, eye):
    """A sky above a black ground: the eye looks up through the slab."""
    for film, thickness_nm, body in FILMS[1:3]:
        for degrees in (0, 60):
            scene = Scene()
            filmed(scene, body, layer(film, thickness_nm))
            scene.facing_quad(scene.emitter(0), [0, -1, 0], [0, 1, 0], 400)
            angle = math.radians(degrees)
            way = [math.sin(angle), math.cos(angle), 0]
            scene.probe("eye", [-0.8 * x for x in way], way, 0.01)
            scene.environment(type="constant", luminance=LUMINANCE)
            found = eye.luminance(scene, "--spp", "1024", "--max-bounces", "40") / LUMINANCE
            wanted = slab(math.cos(angle), film, thickness_nm, body)
            report.claim(abs(found - wanted) < 0.004,
                         f"through {thickness_nm} nm, {film} on {body}, at {degrees} degrees "
                         f"comes {found:.5f}, required: {wanted:.5f}")


def check_textures(report, eye):
    """R is the share, G the thickness between both ends; each moved by a transform."""
    for u in (0, 0.5):
        scene = Scene()
        share = scene.image("image/png", png(2, 1, [[51, 9, 9, 204, 9, 9]]))
        thickness = scene.image("image/png", png(2, 1, [[9, 255, 9, 9, 51, 9]]))
        scene.used.add("KHR_texture_transform")
        place = {"KHR_texture_transform": {"offset": [u, 0], "scale": [0, 0]}}
        other = {"KHR_texture_transform": {"offset": [0.5 - u, 0], "scale": [0, 0]}}
        film = layer(1.9, 600, iridescenceFactor=0.9, iridescenceThicknessMinimum=100,
                     iridescenceTexture={"index": share, "extensions": place},
                     iridescenceThicknessTexture={"index": thickness, "extensions": other})
        filmed(scene, 1.5, film, BLACK)
        look(scene, 30)
        scene.environment(type="constant", luminance=LUMINANCE)
        found = eye.luminance(scene, "--spp", "1024", "--max-bounces", "3") / LUMINANCE
        wanted = face(math.cos(math.radians(30)), 1.9, 600 if u else 200, 1.5,
                      0.9 * (0.8 if u else 0.2))
        report.claim(abs(found - wanted) < 0.002 + 0.01 * wanted,
                     f"textures at {u}: {found:.5f}, required: {wanted:.5f}")


def check_sun(report, eye):
    """The sun by way of the face lights the underside of a white card."""
    for film, thickness_nm, body in FILMS[:2]:
        scene = Scene()
        filmed(scene, body, layer(film, thickness_nm), BLACK, 0.5)
        scene.facing_quad(scene.lambert(0.8), [-1, 1, 0], [0, -1, 0], 0.2)
        scene.environment(type="constant", luminance=0, sun={
            "azimuth_deg": 90, "elevation_deg": 45, "illuminance_lx": LUMINANCE})
        scene.probe("eye", [-1, 0.5, 0], [0, 1, 0], 0.05)
        found = eye.luminance(scene, "--spp", "512", "--max-bounces", "3")
        cosine = math.cos(math.radians(45))
        wanted = 0.8 * LUMINANCE * cosine / math.pi * face(cosine, film, thickness_nm, body,
                                                           light=sunlit)
        report.claim(abs(found / wanted - 1) < 0.003,
                     f"the sun by way of {thickness_nm} nm, {film} on {body}: {found:.2f} "
                     f"cd/m2, required: {wanted:.2f}")


def main():
    program = os.path.abspath(sys.argv[-1])
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        eye = Eye(program, folder)
        check_face(report, eye)
        check_slab(report, eye)
        check_textures(report, eye)
        check_sun(report, eye)
    return report.finish()


if __name__ == "__main__":
    sys.exit(main())
