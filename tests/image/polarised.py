# SPDX-License-Identifier: Apache-2.0
"""polarised.py PARHELION -- polarised light against closed forms: a display and a polariser,
straight and off their axes (Malus), panes at Brewster's angle and others, a display mirrored in
one, the clear sky; unpolarised light stays the same frame; what cannot be asked.
"""
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile

from exr import Frame
from eye import Eye, mean
from gltf import Scene, along, cross, dot, png, unit
from panel_checks import direction

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

DEGREE, AZIMUTH = 0.98, 30.0
INDEX, LUMINANCE = 1.52, 1000


# ---- frames --------------------------------------------------------------------------------

class PolarisedEye(Eye):
    def seen(self, scene, *options, spp=16):
        return self.mean(scene, spp, *options)

    def stokes(self, scene, *options, spp=16):
        """S0 .. S3, means of the frame."""
        frame = self.frame(scene, "--size", "8x8", "--spp", str(spp), "--polarised",
                           "--layers", "stokes", *options)
        return [mean(frame.channels[f"stokes.S{i}"]) for i in range(4)]


def make_panel(program, folder):
    """A coarse LCD whose light is polarised."""
    recipe = os.path.join(ROOT, "assets", "panels", "ips_cluster.recipe.json")
    lab = os.path.join(folder, "lab")
    subprocess.run([program, "panel", "simulate", recipe, "--grid", "22x36", "--noise", "off",
                    "-o", lab, "--quiet"], check=True, capture_output=True)
    path = os.path.join(lab, "MANIFEST.json")
    with open(path, encoding="utf-8") as file:
        manifest = json.load(file)
    manifest["polarisation"] = {"degree": DEGREE, "azimuth_deg": AZIMUTH}
    with open(path, "w", encoding="utf-8") as file:
        json.dump(manifest, file)
    subprocess.run([program, "panel", "fit", path, "-o", os.path.join(folder, "lcd.panel"),
                    "--quiet"], check=True, capture_output=True)
    shutil.rmtree(lab)


def lcd(scene):
    content = scene.image("image/png", png(1, 1, [[255, 255, 255]]))
    return scene.material("display", extensions={"PARHELION_display": {
        "panel": "lcd.panel", "content": {"index": content}, "level": 1}})


def display_scene(theta=0, phi=0, up=(0, 1, 0)):
    """A display in the plane z = 0 that faces +z, seen from a direction."""
    scene = Scene()
    scene.quad(lcd(scene), [-0.5, -0.5, 0], [1, 0, 0], [0, 1, 0])
    eye = direction(theta, phi)
    scene.probe("eye", [0.6 * x for x in eye], [-x for x in eye], 0.01, up=list(up))
    return scene


# ---- a display and a polariser -------------------------------------------------------------

def transmitted_axis(absorbs, way):
    """What an absorption axis leaves of light along `way`: the field across both."""
    return unit(cross(absorbs, way))


def malus(theta, phi, up, degrees):
    """The share of the display's light that passes the glasses; `up` is the camera's."""
    eye = direction(theta, phi)
    forward = [-x for x in eye]
    right = unit(cross(forward, up))
    top = cross(right, forward)
    a, f = math.radians(degrees), math.radians(AZIMUTH)
    glasses = transmitted_axis(along([-math.cos(a) * x for x in right], top, math.sin(a)), eye)
    light = transmitted_axis([-math.sin(f), math.cos(f), 0], eye)
    c = dot(glasses, light)
    return (1 + DEGREE * (2 * c * c - 1)) / 2


def check_malus(report, eye):
    for theta, phi, up in ((0, 0, (0, 1, 0)), (0, 0, (0.5, 1, 0)), (40, 20, (0, 1, 0)),
                           (60, 135, (0, 1, 0)), (70, 250, (0.3, 1, 0.2))):
        scene = display_scene(theta, phi, up)
        bare = eye.seen(scene)
        report.claim(eye.seen(scene, "--polarised") == bare,
                     f"theta {theta}: polarised light is no brighter for an eye alone")
        for degrees in (0, 15, 30, 45, 60, 75, 90, -30, 120):
            found = eye.seen(scene, "--sunglasses", str(degrees)) / bare
            wanted = malus(theta, phi, up, degrees)
            report.claim(abs(found - wanted) < 1e-4,
                         f"theta {theta}, phi {phi}, glasses at {degrees}: {found:.5f}, "
                         f"required: {wanted:.5f}")
    found = eye.seen(display_scene(), "--sunglasses", "-30:50") / eye.seen(display_scene())
    wanted = (1.02 - 0.98 * DEGREE) / 2  # crossed
    report.claim(abs(found - wanted) < 1e-4,
                 f"an extinction of 50: {found:.5f}, required: {wanted:.5f}")


def check_stokes_of_display(report, eye):
    s = eye.stokes(display_scene())
    turn = math.radians(2 * AZIMUTH)
    wanted = [1, DEGREE * math.cos(turn), DEGREE * math.sin(turn), 0]
    for i in range(4):
        report.claim(abs(s[i] / s[0] - wanted[i]) < 1e-4,
                     f"S{i} of the display: {s[i] / s[0]:.5f}, required: {wanted[i]:.5f}")


# ---- panes ---------------------------------------------------------------------------------

def slab(angle):
    """What a sheet reflects of light across and along the plane of incidence, all orders."""
    out, inside = math.cos(angle), math.sqrt(1 - (math.sin(angle) / INDEX) ** 2)
    pairs = (out, INDEX * inside), (INDEX * out, inside)
    faces = [((a - b) / (a + b)) ** 2 for a, b in pairs]
    return [2 * r / (1 + r) for r in faces]


GLAZED = {"PARHELION_glazing": {"layers": [{"thickness_m": 0.002, "ior": INDEX}]}}
SHEET = {"KHR_materials_transmission": {"transmissionFactor": 1},
         "KHR_materials_ior": {"ior": INDEX}}


def slanted(angle, extensions, below=0, above=0, display=False):
    """A pane at y = 0 seen from above at an angle; what is over and under it glows."""
    scene = Scene()
    pane = scene.material("pane", extensions, doubleSided=True, pbrMetallicRoughness={
        "roughnessFactor": 0, "metallicFactor": 0})
    scene.facing_quad(pane, [0, 0, 0], [0, 1, 0], 2)
    way = [math.sin(angle), -math.cos(angle), 0]
    if below:
        scene.facing_quad(scene.emitter(below), [0, -1, 0], [0, 1, 0], 40)
    if above:
        scene.facing_quad(scene.emitter(above), [0, 3, 0], [0, -1, 0], 80)
    if display:  # upright, across the mirrored ray, u along +z
        up = [-math.cos(angle), math.sin(angle), 0]
        corner = [1.5 * math.sin(angle), 1.5 * math.cos(angle), -1]
        corner = along(corner, up, -1)
        scene.quad(lcd(scene), corner, [0, 0, 2], [2 * x for x in up])
    scene.probe("eye", [-x for x in way], way, 0.01)
    return scene


def check_panes(report, eye):
    """The eye looks down: s is horizontal."""
    for name, extensions in (("glazing", GLAZED), ("sheet", SHEET)):
        for degrees in (30, 45, math.degrees(math.atan(INDEX)), 62, 70):
            angle = math.radians(degrees)
            s, p = slab(angle)
            scene = slanted(angle, extensions, above=LUMINANCE)
            stokes = eye.stokes(scene, spp=64)
            report.claim(abs(stokes[1] / stokes[0] - (s - p) / (s + p)) < 1e-3 and
                         abs(stokes[2]) + abs(stokes[3]) < 1e-4 * stokes[0],
                         f"{name} mirrors at {degrees:.4g}: {stokes}, required: S1 "
                         f"{(s - p) / (s + p):.5f}")
            dark = eye.seen(scene, "--sunglasses", "0", spp=64) / LUMINANCE
            report.claim(abs(dark - p / 2) < 2e-3 * s,
                         f"{name} at {degrees:.4g} through glasses: {dark:.6f}, required: "
                         f"{p / 2:.6f}")
            scene = slanted(angle, extensions, below=LUMINANCE)
            stokes = eye.stokes(scene)
            wanted = (p - s) / (2 - s - p)
            report.claim(abs(stokes[1] / stokes[0] - wanted) < 1e-4,
                         f"{name} lets through at {degrees:.4g}: S1 "
                         f"{stokes[1] / stokes[0]:.5f}, required: {wanted:.5f}")


def check_display_in_pane(report, eye):
    """What was told to be wrong by up to two: a display mirrored in a windscreen."""
    for degrees in (45, 62, 70):
        angle = math.radians(degrees)
        s, p = slab(angle)
        scene = slanted(angle, GLAZED, display=True)
        plain = eye.seen(scene, spp=256)
        found = eye.seen(scene, "--polarised", spp=256) / plain
        c = math.cos(math.radians(AZIMUTH)) ** 2  # of the light swings along +z, which is s
        share = (1 + DEGREE * (2 * c - 1)) / 2
        wanted = (share * s + (1 - share) * p) / ((s + p) / 2)
        report.claim(abs(found / wanted - 1) < 2e-3,
                     f"a display in a pane at {degrees}: {found:.5f} of the unpolarised one, "
                     f"required: {wanted:.5f}")


# ---- metals and coatings --------------------------------------------------------------------

METAL = 1.4 + 7.5j
LAYER, NM = 1.38, 99.6  # MgF2, thick a quarter of 550 nm


def metal_waves(angle, index):
    """Amplitudes s and p of a bare metal (Born and Wolf, 14.2); p across its own way."""
    inside = (1 - (math.sin(angle) / index) ** 2) ** 0.5
    return ((math.cos(angle) - index * inside) / (math.cos(angle) + index * inside),
            (index * math.cos(angle) - inside) / (index * math.cos(angle) + inside))


def check_metal(report, eye):
    """A display mirrored in a metal becomes elliptic: S2 and S3 of a field at 30 degrees."""
    for degrees in (30, 60, 80):
        angle = math.radians(degrees)
        scene = slanted(angle, {"PARHELION_spectrum": {"conductor": "metal.csv"}}, display=True)
        scene.document["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] = 1
        scene.files["metal.csv"] = (f"nm,n,k\n360,{METAL.real},{METAL.imag}\n"
                                    f"830,{METAL.real},{METAL.imag}\n").encode()
        stokes = eye.stokes(scene)
        s, p = metal_waves(angle, METAL)
        rs, rp, both = abs(s) ** 2, abs(p) ** 2, s * p.conjugate()
        turn = math.radians(2 * AZIMUTH)
        # the display's u lies along s, its up across the ray: S1, S2 of its light about s
        light = DEGREE * math.cos(turn), DEGREE * math.sin(turn)
        mean_of, half = (rs + rp) / 2, (rs - rp) / 2
        out = [mean_of + half * light[0], half + mean_of * light[0], both.real * light[1],
               both.imag * light[1]]
        for i in (1, 2, 3):
            found, wanted = stokes[i] / stokes[0], out[i] / out[0]
            # the eye's right may be -s and the mirrored up may be down: signs of S2, S3
            sign = 1 if i == 1 else math.copysign(1, stokes[2] * out[2])
            report.claim(abs(found - sign * wanted) < 2e-3,
                         f"S{i} of a display in a metal at {degrees}: {found:.5f}, required: "
                         f"{sign * wanted:.5f}")


def check_coated_cover(report, eye):
    """A quarter wave on the face of black plastic, at its own wavelength and around it: the
    mean over the luminance is near that at 555 nm where the coating is."""
    angle = math.radians(60)
    scene = slanted(angle, {"PARHELION_coating": {"layers": [
        {"n": LAYER, "k": 0, "thickness_nm": NM}]}, "KHR_materials_ior": {"ior": INDEX}},
                    above=LUMINANCE)
    scene.document["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = [0, 0, 0, 1]
    stokes = eye.stokes(scene, spp=64)
    top = bottom = 0
    for nm in range(480, 640, 5):  # a bell for the eye's sensitivity
        s, p = (abs(r) ** 2 for r in film_waves(angle, nm))
        weight = math.exp(-0.5 * ((nm - 557) / 42) ** 2)
        top += weight * (s - p)
        bottom += weight * (s + p)
    found = stokes[1] / stokes[0]
    report.claim(abs(found - top / bottom) < 0.01,
                 f"a coated face at 60: S1 {found:.4f}, required: about {top / bottom:.4f}")


def film_waves(angle, nm):
    """Airy's sum over one layer, s and p."""
    cosines = [math.sqrt(1 - (math.sin(angle) / n) ** 2) for n in (1, LAYER, INDEX)]
    n = (1, LAYER, INDEX)
    phase = 4 * math.pi * LAYER * NM * cosines[1] / nm
    turn = complex(math.cos(phase), math.sin(phase))
    out = []
    for is_p in (False, True):
        u = [c / i if is_p else c * i for c, i in zip(cosines, n)]
        r = [(u[i] - u[i + 1]) / (u[i] + u[i + 1]) for i in (0, 1)]
        out.append((r[0] + r[1] * turn) / (1 + r[0] * r[1] * turn))
    return out


# ---- unpolarised light ---------------------------------------------------------------------

def room():
    """Emitters, matt walls and a mirror, each way with one mirror at most."""
    scene = Scene()
    scene.box_inside(scene.lambert(0.5), [-2, -2, -2], [2, 2, 2])
    scene.facing_quad(scene.emitter(500, (1, 0.8, 0.6)), [0, 1.9, 0], [0, -1, 0], 1)
    scene.facing_quad(scene.material("mirror", pbrMetallicRoughness={
        "baseColorFactor": [0.9, 0.8, 0.7, 1], "metallicFactor": 1, "roughnessFactor": 0}),
        [0, 0, -1.9], [0, 0, 1], 2)
    scene.probe("eye", [0, 0, 1.5], [0, 0, -1], 1)
    return scene


def check_unpolarised(report, eye):
    options = "--size", "32x32", "--spp", "16", "--max-bounces", "2", "--no-guiding"
    frames = [eye.frame(room(), *options, *more) for more in ((), ("--polarised",))]
    worst = max(abs(a - b) / max(a, 1e-3) for c in "RGB"
                for a, b in zip(frames[0].channels[c], frames[1].channels[c]))
    report.claim(worst < 1e-6, f"unpolarised light: frames differ by {worst:.2g}")


# ---- the sky -------------------------------------------------------------------------------

def sky_scene(kind, towards):
    scene = Scene()
    if kind == "sky":
        scene.environment(type="sky", when="2026-06-21T12:00+00:00", where=[50, 0, 100],
                          turbidity=1.3, sun={"azimuth_deg": 180, "elevation_deg": 30,
                               "illuminance_lx": 80000})
    else:
        scene.environment(type="cie", sky=12, diffuse_horizontal_lx=15000,
                          sun={"azimuth_deg": 180, "elevation_deg": 30,
                               "illuminance_lx": 80000})
    scene.facing_quad(scene.lambert(0.5), [0, -5, 0], [0, 1, 0], 0.1)
    scene.probe("eye", [0, 0, 0], list(towards), 0.001, up=[0, 1, 0])
    return scene


def check_sky(report, eye):
    """The field swings across the plane of sun and sight; most of it 90 degrees off the sun."""
    sun = [0, math.sin(math.radians(30)), math.cos(math.radians(30))]
    degrees = []
    for towards in ([1, 0.3, 0], [0, 0.866, -0.5], [0.6, 0.6, -0.5], [-1, 0.5, 0.4]):
        forward = unit(towards)
        right = unit(cross(forward, [0, 1, 0]))
        up = cross(right, forward)
        s = eye.stokes(sky_scene("sky", towards))
        field = unit(cross(forward, sun))
        c = dot(field, right), dot(field, up)
        degree = math.hypot(s[1], s[2]) / s[0]
        wanted = c[0] ** 2 - c[1] ** 2, 2 * c[0] * c[1]
        report.claim(max(abs(s[i + 1] / s[0] - degree * wanted[i]) for i in (0, 1)) < 2e-3,
                     f"the sky towards {towards} swings {s}, required: {wanted}")
        cosine = dot(forward, sun)
        rayleigh = (1 - cosine ** 2) / (1 + cosine ** 2)
        report.claim(0.4 * rayleigh < degree < rayleigh + 1e-3,
                     f"towards {towards}: {degree:.3f}, of Rayleigh's {rayleigh:.3f}")
        degrees.append(degree)
    report.claim(max(degrees) == degrees[1] and degrees[1] > 0.5,
                 f"most polarised across the sun: {degrees}")
    s = eye.stokes(sky_scene("cie", [0, 0.866, -0.5]))
    report.claim(max(abs(x) for x in s[1:]) < 1e-4 * s[0],
                 f"a sky that is only a shape is unpolarised: {s}")


# ---- what else must hold -------------------------------------------------------------------

def check_parts(report, program, folder):
    """Parts of a polarised frame add up to it; what was asked stands in the frame."""
    scene = slanted(math.radians(60), GLAZED, display=True)
    scene.write(os.path.join(folder, "scene.gltf"))

    def run(*words):
        done = subprocess.run([program, *words, "--quiet"], cwd=folder, capture_output=True,
                              text=True, check=False)
        assert done.returncode == 0, done.stderr

    asked = "render", "scene.gltf", "--size", "16x16", "--polarised", "--layers", "stokes,id"
    run(*asked, "--spp", "8", "-o", "whole.exr")
    run(*asked, "--samples", "0:3", "-o", "a.exr")
    run(*asked, "--samples", "3:8", "-o", "b.exr")
    run("merge", "a.exr", "b.exr", "-o", "both.exr")
    whole, both = (Frame(os.path.join(folder, name)) for name in ("whole.exr", "both.exr"))
    report.claim(all(whole.channels[c] == both.channels[c] for c in whole.channels) and
                 "stokes.S3" in both.channels, "two parts make the whole, stokes too")
    report.claim("parhelion:polarised" in whole.attributes, "the frame says how it was made")
    run(*asked[:4], "--layers", "id", "--samples", "3:8", "-o", "plain.exr")
    done = subprocess.run([program, "merge", "a.exr", "plain.exr", "-o", "no.exr"], cwd=folder,
                          capture_output=True, text=True, check=False)
    report.claim(done.returncode == 3 and "plain.exr" in done.stderr,
                 f"a part of another eye is none: {done.stderr.strip()}")


FAULTS = [
    (("--sunglasses", "dark"), "--sunglasses dark"), (("--sunglasses", ""), "--sunglasses"),
    (("--sunglasses", "361"), "361"), (("--sunglasses", "nan"), "nan"),
    (("--sunglasses", "10:"), "10:"), (("--sunglasses", "10:0.5"), "0.5"),
    (("--sunglasses", "10:2x"), "2x"), (("--sunglasses", "10:inf"), "inf"),
    (("--sunglasses", "10 20"), "10 20"), (("--layers", "stokes"), "--polarised"),
    (("--layers", "stokes", "--sunglasses", "0"), "--sunglasses"),
]


def check_faults(report, program, folder):
    display_scene().write(os.path.join(folder, "scene.gltf"))
    for words, wanted in FAULTS:
        done = subprocess.run([program, "render", "scene.gltf", "-o", "no.exr", *words],
                              cwd=folder, capture_output=True, text=True, check=False)
        report.claim(done.returncode == 2 and wanted in done.stderr and
                     done.stderr.count("\n") == 1 and
                     not os.path.exists(os.path.join(folder, "no.exr")),
                     f"{words}: {done.returncode}, {done.stderr.strip()}")


def main():
    program = os.path.abspath(sys.argv[-1])
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        make_panel(program, folder)
        eye = PolarisedEye(program, folder)
        check_malus(report, eye)
        check_stokes_of_display(report, eye)
        check_panes(report, eye)
        check_display_in_pane(report, eye)
        check_metal(report, eye)
        check_coated_cover(report, eye)
        check_unpolarised(report, eye)
        check_sky(report, eye)
        check_parts(report, program, folder)
        check_faults(report, program, folder)
    return report.finish()


if __name__ == "__main__":
    sys.exit(main())
