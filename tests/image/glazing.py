# SPDX-License-Identifier: Apache-2.0
"""glazing.py PARHELION -- a laminated pane against closed forms: what passes and what it
mirrors at six angles, where its ghost stands, how bright it is and which wedge takes it away,
what dirt on it shows under the sun, what coated faces do to all of it; and what is no pane.
"""
import cmath
import json
import math
import os
import subprocess
import sys
import tempfile

import layers
from eye import Eye, luminances
from gltf import Scene

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

THICKNESS, INDEX = 0.00496, 1.52
LUMINANCE = 1000


# ---- closed forms --------------------------------------------------------------------------

def faces(angle, index=INDEX):
    """One face's reflectance, s and p (Born and Wolf, 1.5.2)."""
    out, inside = math.cos(angle), math.sqrt(1 - (math.sin(angle) / index) ** 2)
    return [((a - b) / (a + b)) ** 2 for a, b in ((out, index * inside), (index * out, inside))]


def body(angle, along_normal):
    """What a body of this transmittance lets through at the angle."""
    return along_normal ** (1 / math.sqrt(1 - (math.sin(angle) / INDEX) ** 2))


def passed(angle, through=1.0):
    t = body(angle, through)
    return sum((1 - r) ** 2 * t / (1 - r * r * t * t) for r in faces(angle)) / 2


def mirrored(angle, through=1.0):
    t2 = body(angle, through) ** 2
    return sum(r + (1 - r) ** 2 * t2 * r / (1 - r * r * t2) for r in faces(angle)) / 2


def shift(angle):
    """Between the rays of image and ghost: d sin 2t / sqrt(n^2 - sin^2 t)."""
    return THICKNESS * math.sin(2 * angle) / math.sqrt(INDEX ** 2 - math.sin(angle) ** 2)


def wedge(angle, distance):
    """Takes the ghost away of what is this far from the pane: both rays meet there, wherever
    the eye is, when the second one is turned by s over that distance."""
    return (shift(angle) * math.cos(angle) /
            (2 * distance * math.sqrt(INDEX ** 2 - math.sin(angle) ** 2)))


# ---- scenes --------------------------------------------------------------------------------

def pane(layers, haze=None):
    extension = {"layers": layers}
    if haze:
        extension["haze"] = {"share": haze[0], "width_deg": haze[1]}
    return {"PARHELION_glazing": extension}


def laminate(through=1.0, wedge_rad=0.0, towards="+u"):
    """Three layers of one index: 2.1, 0.76 and 2.1 mm."""
    layers = [{"thickness_m": d, "ior": INDEX} for d in (0.0021, 0.00076, 0.0021)]
    layers[0]["transmission"] = layers[2]["transmission"] = math.sqrt(through)
    if wedge_rad:
        layers[1].update(wedge_rad=wedge_rad, wedge_toward=towards)
    return layers


def slanted(angle, extension, below=0, above=0, front=1):
    """A pane at y = 0, its front up (-1: down), seen from above at the angle; under and over it
    glow."""
    scene = Scene()
    glass = scene.material("pane", extension, doubleSided=True)
    scene.facing_quad(glass, [0, 0, 0], [0, front, 0], 2)
    if below:
        scene.facing_quad(scene.emitter(below), [0, -1, 0], [0, 1, 0], 40)
    if above:
        scene.facing_quad(scene.emitter(above), [0, 3, 0], [0, -1, 0], 80)
    way = [math.sin(angle), -math.cos(angle), 0]
    scene.probe("eye", [-x for x in way], way, 0.01)
    return scene


def check_shares(report, eye):
    for degrees in (0, 45, 56.66, 62, 65, 70):
        angle = math.radians(degrees)
        for through in (1.0, 0.75):
            extension = pane(laminate(through))
            found = eye.mean(slanted(angle, extension, below=LUMINANCE), 4) / LUMINANCE
            report.claim(abs(found - passed(angle, through)) < 0.001,
                         f"{degrees} degrees, {through}: lets through {found:.5f}, required: "
                         f"{passed(angle, through):.5f}")
            found = eye.mean(slanted(angle, extension, above=LUMINANCE), 256) / LUMINANCE
            wanted = mirrored(angle, through)
            report.claim(abs(found / wanted - 1) < 0.01,
                         f"{degrees} degrees, {through}: mirrors {found:.5f}, required: "
                         f"{wanted:.5f}")


def check_curve_file(report, eye):
    """The byte order mark of a spreadsheet's CSV does not make its first row a header."""
    found = []
    for name, data in (("plain.csv", b"400,0\n700,1\n"),
                       ("marked.csv", b"\xef\xbb\xbf400,0\n700,1\n")):
        layers_of = [{"thickness_m": THICKNESS, "ior": INDEX, "transmission": name}]
        scene = slanted(0, pane(layers_of), below=LUMINANCE)
        scene.files[name] = data
        found.append(eye.mean(scene, 4))
    report.claim(found[0] == found[1] < 0.7 * LUMINANCE, f"a curve and a marked one: {found}")


# ---- coated faces --------------------------------------------------------------------------

FILMS = {"clear": (1.38 + 0j, 99.6), "dark": (2.5 + 2.5j, 9.0)}  # n + ik, nm


class Face:
    """A face for one polarisation: what it reflects from the air and from the glass, and what
    passes (Born and Wolf 1.6.2, the characteristic matrix; fields e^(-iwt))."""

    def __init__(self, film, cosine, nm, is_p):
        index, depth = FILMS[film] if film else (1 + 0j, 0)
        media = [cmath.sqrt(n * n - 1 + cosine * cosine) for n in (1, index, INDEX)]
        sides = [n * n / z if is_p else z for n, z in zip((1, index, INDEX), media)]
        turn = 2 * math.pi * media[1] * depth / nm
        self.outer, self.through = self.shares(sides, turn)
        self.inner, _ = self.shares(sides[::-1], turn)

    @staticmethod
    def shares(sides, turn):
        front, film, behind = sides
        electric = cmath.cos(turn) - 1j * behind / film * cmath.sin(turn)
        magnetic = behind * cmath.cos(turn) - 1j * film * cmath.sin(turn)
        whole = front * electric + magnetic
        return (abs((front * electric - magnetic) / whole) ** 2,
                4 * front.real * behind.real / abs(whole) ** 2)


def coated_pane(angle, near, far, through):
    """What a pane with these films reflects and lets through, in white light."""
    cosine, t = math.cos(angle), body(angle, through)

    def share(which):
        def of(nm, is_p):
            a, b = Face(near, cosine, nm, is_p), Face(far, cosine, nm, is_p)
            turns = 1 - a.inner * b.inner * t * t
            return (a.outer + a.through ** 2 * t * t * b.inner / turns,
                    a.through * b.through * t / turns)[which]
        return layers.white(of)
    return share(0), share(1)


def coated(outside, inside, through):
    extension = pane(laminate(through))
    for name, film in (("coating_outside", outside), ("coating_inside", inside)):
        if film:
            index, depth = FILMS[film]
            extension["PARHELION_glazing"][name] = {"layers": [
                {"n": index.real, "k": index.imag, "thickness_nm": depth}]}
    return extension


def check_coated(report, eye):
    """From both sides; the dark film looks unlike from glass and air."""
    cases = [(0, "clear", None, 1), (30, None, "dark", 1), (45, "clear", "dark", 1),
             (45, "clear", "dark", -1), (60, "dark", None, -1), (70, "clear", "clear", 1),
             (70, "dark", "clear", -1)]
    for degrees, outside, inside, front in cases:
        angle, through = math.radians(degrees), 0.85
        near, far = (outside, inside) if front > 0 else (inside, outside)
        mirror, straight = coated_pane(angle, near, far, through)
        extension = coated(outside, inside, through)
        name = f"{degrees} degrees, outside {outside}, inside {inside}, front {front}"
        scene = slanted(angle, extension, below=LUMINANCE, front=front)
        found = eye.mean(scene, 64) / LUMINANCE
        report.claim(abs(found - straight) < 0.001,
                     f"{name}: lets through {found:.5f}, required: {straight:.5f}")
        scene = slanted(angle, extension, above=LUMINANCE, front=front)
        found = eye.mean(scene, 256) / LUMINANCE
        report.claim(abs(found - mirror) < 0.01 * mirror + 2e-4,
                     f"{name}: mirrors {found:.5f}, required: {mirror:.5f}")
        check_coated_sun(report, eye, (angle, extension, front), straight, name)


def check_coated_sun(report, eye, coated_at, straight, name):
    """Shadow rays: a parallel lamp through the pane onto a white floor."""
    angle, extension, front = coated_at
    lux, scene = 10000, Scene()
    glass = scene.material("pane", extension, doubleSided=True)
    scene.facing_quad(glass, [0, 1, 0], [0, front, 0], 20)
    scene.quad(scene.lambert(0.01), [-1, 0, 1], [2, 0, 0], [0, 0, -2])
    scene.light("directional", lux, direction=[math.sin(angle), -math.cos(angle), 0])
    scene.probe("eye", [-0.3, 0.5, 0], [0.6, -0.8, 0], 0.01)
    found = eye.mean(scene, 16)
    wanted = lux * math.cos(angle) * straight * 0.01 / math.pi
    report.claim(abs(found / wanted - 1) < 0.003,
                 f"{name}: sunlit floor behind {found:.3f} cd/m2, required: {wanted:.3f}")


def check_coated_ghost(report, eye):
    """The ghost of a pane whose inner face reflects: three quarters of the image."""
    angle, film = math.radians(45), "dark"
    found = images(eye, angle, coated(None, film, 1), STRONG)
    (_, bright), (_, faint), *_ = found
    cosine = math.cos(angle)

    def ghost(nm, is_p):
        near, far = Face(None, cosine, nm, is_p), Face(film, cosine, nm, is_p)
        return near.through ** 2 * far.inner
    wanted = layers.white(ghost) / layers.white(
        lambda nm, is_p: Face(None, cosine, nm, is_p).outer)
    report.claim(abs(faint / bright / wanted - 1) < 0.01,
                 f"a dark film inside: the ghost has {faint / bright:.4f} of the image's "
                 f"light, required: {wanted:.4f}")


# ---- the ghost -----------------------------------------------------------------------------

NEAR, FAR = 0.8, 1.7  # m from the pane to the eye and to a bright line
FIELD = 40            # minutes of arc across the images
FINE = (480, 0.0002, 64)       # rows, the line's width in m, samples: for places,
STRONG = (120, 0.0018, 8192)  # and for how bright an image is


def bright_line(angle, extension, width):
    """An eye on the side of -x and a line on that of +x, both `angle` off the normal."""
    scene = Scene()
    glass = scene.material("pane", extension, doubleSided=True)
    scene.quad(glass, [-1, 0, 1], [2, 0, 0], [0, 0, -2])  # u grows along x
    out = [math.sin(angle), math.cos(angle), 0]
    across = [-math.cos(angle), math.sin(angle), 0]
    scene.facing_quad(scene.emitter(1e6), [FAR * x for x in out], [-x for x in out], 0.2, width,
                      up=across)
    way = [math.sin(angle), -math.cos(angle), 0]
    scene.view("eye", [-NEAR * x for x in way], way, FIELD / 60, up=[math.cos(angle),
                                                                    math.sin(angle), 0])
    return scene


def images(eye, angle, extension, how=FINE):
    """(minutes of arc, light) of the images from the brightest on; up is towards +x."""
    count, width, spp = how
    frame = eye.frame(bright_line(angle, extension, width), "--size", f"8x{count}", "--spp",
                      str(spp))
    values = luminances(frame)
    rows = [sum(values[y * frame.width:(y + 1) * frame.width]) for y in range(count)]
    found, least = [], 1e-3 * max(rows)
    y = 0
    while y < count:
        if rows[y] <= least:
            y += 1
            continue
        end = y
        while end < count and rows[end] > least:
            end += 1
        light = sum(rows[y:end])
        place = sum(rows[i] * (i + 0.5) for i in range(y, end)) / light
        found.append(((count / 2 - place) * FIELD / count, light))
        y = end
    return sorted(found, key=lambda image: -image[1])


def check_ghost(report, eye):
    distance = NEAR + FAR
    for degrees in (45, 60, 62, 70):
        angle, through = math.radians(degrees), 0.9
        (first, _), (second, _), *_ = images(eye, angle, pane(laminate(through)))
        wanted = math.degrees(shift(angle) / distance) * 60
        report.claim(abs(abs(second - first) / wanted - 1) < 0.02,
                     f"{degrees} degrees: the ghost stands {second - first:.3f} minutes beside "
                     f"the image, required: {wanted:.3f}")
        check_wedge(report, eye, angle, wanted)
        if degrees not in (45, 70):
            continue
        (_, bright), (_, faint), *_ = images(eye, angle, pane(laminate(through)), STRONG)
        ratio = (sum((1 - r) ** 2 * body(angle, through) ** 2 * r for r in faces(angle)) /
                 sum(faces(angle)))
        report.claim(abs(faint / bright / ratio - 1) < 0.01,
                     f"{degrees} degrees: the ghost has {faint / bright:.5f} of the image's "
                     f"light, required: {ratio:.5f}")


def check_wedge(report, eye, angle, apart):
    """Thicker towards the eye it takes the ghost away, thicker towards the line it doubles."""
    alpha = wedge(angle, FAR)
    degrees = round(math.degrees(angle))
    left = images(eye, angle, pane(laminate(1, alpha, "-u")))
    spread = max(place for place, _ in left[:2]) - min(place for place, _ in left[:2])
    report.claim(spread < 0.2, f"{degrees} degrees: a wedge of {1e3 * alpha:.3f} mrad leaves "
                               f"{spread:.3f} minutes")
    first, second = images(eye, angle, pane(laminate(1, alpha, "+u")))[:2]
    found = abs(first[0] - second[0])
    report.claim(abs(found / (2 * apart) - 1) < 0.02,
                 f"{degrees} degrees: turned round it makes {found:.3f} minutes, required: "
                 f"{2 * apart:.3f}")


# ---- dirt ----------------------------------------------------------------------------------

def check_haze(report, eye):
    """The sun 40 degrees off the normal beyond the pane, eyes at several angles below it."""
    share, width, lux, sun = 0.03, 12, 80000, math.radians(40)
    for degrees in (-40, -20, 0, 30, 60):
        angle = math.radians(degrees)
        scene = Scene()
        glass = scene.material("pane", pane(laminate(0.8), (share, width)), doubleSided=True)
        scene.facing_quad(glass, [0, 0, 0], [0, 1, 0], 2)
        scene.light("directional", lux, direction=[math.sin(sun), -math.cos(sun), 0])
        way = [math.sin(angle), math.cos(angle), 0]
        scene.probe("eye", [-x for x in way], way, 0.01)
        found = eye.mean(scene, 64)
        moved, w = math.sin(angle) - math.sin(sun) * -1, math.sin(math.radians(width))
        lobe = w * w / (math.pi * (w * w + moved * moved) ** 2)
        wanted = (lux * math.cos(sun) * share * lobe *
                  min(passed(sun, 0.8), passed(abs(angle), 0.8)))
        report.claim(abs(found / wanted - 1) < 0.01,
                     f"dirt from {degrees} degrees: {found:.2f} cd/m2, required: {wanted:.2f}")


def check_furnace(report, eye):
    """A clear dirty pane in a sky of one luminance is not seen, but for what its lobe loses
    beyond the horizon: of b from B on w^2 / (w^2 + B^2), B the least way to the unit circle."""
    for degrees, share, width in ((0, 0.3, 3), (40, 0.5, 5), (60, 0.02, 20)):
        angle, w = math.radians(degrees), math.sin(math.radians(width))
        scene = slanted(angle, pane(laminate(1), (share, width)))
        scene.environment(type="constant", luminance=LUMINANCE)
        found = eye.mean(scene, 1024) / LUMINANCE
        lost = share * w * w / (w * w + (1 - math.sin(angle)) ** 2)
        report.claim(1 - lost - 0.003 < found < 1.003,
                     f"{degrees} degrees, {share} of dirt: {found:.5f} of the sky's light, "
                     f"required: 1 and at most {lost:.5f} less")


# ---- what is no pane -----------------------------------------------------------------------

FAULTS = [
    ({}, "layers"), ({"layers": []}, "layers"),
    ({"layers": [{"thickness_m": 0, "ior": 1.5}]}, "thickness_m"),
    ({"layers": [{"thickness_m": 0.002}]}, "ior"),
    ({"layers": [{"thickness_m": 0.002, "ior": 0.9}]}, "ior"),
    ({"layers": [{"thickness_m": 0.002, "ior": 1.5, "transmission": 1.2}]}, "transmission"),
    ({"layers": [{"thickness_m": 0.002, "ior": 1.5, "transmission": True}]}, "transmission"),
    ({"layers": [{"thickness_m": 0.002, "ior": 1.5, "transmission": "no.csv"}]}, "no.csv"),
    ({"layers": [{"thickness_m": 0.002, "ior": 1.5, "transmission": "bad.csv"}]},
     "line 3: holds 1.5; 0 to 1 is required"),
    ({"layers": [{"thickness_m": 0.002, "ior": 1.5, "transmission": "under.csv"}]},
     "line 2: holds -0.1; 0 to 1 is required"),
    ({"layers": [{"thickness_m": 0.002, "ior": 1.5, "transmission": "wide.csv"}]},
     "wide.csv: has zero bytes, required: text in UTF-8"),
    ({"layers": [{"thickness_m": 0.002, "ior": 1.5, "wedge_rad": 0.001}]}, "wedge_toward"),
    ({"layers": [{"thickness_m": 0.002, "ior": 1.5, "wedge_rad": 0.001, "wedge_toward": "up"}]},
     "wedge_toward"),
    ({"layers": [{"thickness_m": 0.002, "ior": 1.5, "wedge_rad": 1, "wedge_toward": "+u"}]},
     "wedge_rad"),
    ({"layers": [{"thickness_m": 0.002, "ior": 1.5, "wedge_rad": 1e-3, "wedge_toward": "+u"}] *
      2}, "second wedge"),
    ({"layers": [{"thickness_m": 0.002, "ior": 1.5, "tint": 1}]}, "tint"),
    ({"layers": [{"thickness_m": 0.002, "ior": 1.5}] * 9}, "layers"),
    ({"layers": [{"thickness_m": 0.002, "ior": 1.5}], "haze": {"share": 2, "width_deg": 2}},
     "share"),
    ({"layers": [{"thickness_m": 0.002, "ior": 1.5}], "haze": {"share": 0.1}}, "width_deg"),
    ({"layers": [{"thickness_m": 0.002, "ior": 1.5}], "haze": {"share": 0.1, "width_deg": 0}},
     "width_deg"),
    ({"layers": [{"thickness_m": 0.002, "ior": 1.5}], "coating_inside": {}},
     "coating_inside"),
    ({"layers": [{"thickness_m": 0.002, "ior": 1.5}], "coating_inside": []}, "coating_inside"),
    ({"layers": [{"thickness_m": 0.002, "ior": 1.5}], "coating_outside": {"stack": "mgf"}},
     "did you mean mgf2"),
    ({"layers": [{"thickness_m": 0.002, "ior": 1.5}],
      "coating_outside": {"stack": "mgf2", "faces": "front"}}, "is one face"),
    ({"layers": [{"thickness_m": 0.002, "ior": 1.5}],
      "coating_inside": {"stack": "mgf2", "outside": 1.33}}, "a pane stands in air"),
    ({"layers": [{"thickness_m": 0.002, "ior": 1.5}],
      "coating_inside": {"layers": [{"n": 1.38}]}}, "thickness_nm"),
    ({"layers": [{"thickness_m": 0.002, "ior": 1.5}],
      "coating_outside": {"layers": [{"n": "no.csv", "thickness_nm": 10}]}}, "no.csv"),
    ({"layers": [{"thickness_m": 0.002, "ior": 1.5}], "haze": "dirt.panel"}, "haze"),
]


def check_faults(report, program, folder):
    path = os.path.join(folder, "fault.gltf")
    with open(os.path.join(folder, "bad.csv"), "w", encoding="utf-8") as file:
        file.write("nm,value\n400,0.5\n700,1.5\n")
    with open(os.path.join(folder, "under.csv"), "w", encoding="utf-8") as file:
        file.write("nm,value\n400,-0.1\n")
    with open(os.path.join(folder, "wide.csv"), "w", encoding="utf-16") as file:
        file.write("nm,value\n400,0.5\n")
    for extension, word in FAULTS:
        scene = Scene()
        scene.facing_quad(scene.material("pane", {"PARHELION_glazing": extension}), [0, 0, 0],
                          [0, 1, 0], 1)
        scene.write(path)
        done = subprocess.run([program, "check", path, "--json"], capture_output=True,
                              text=True, check=False)
        report.claim(done.returncode == 3 and word in done.stdout + done.stderr,
                     f"{json.dumps(extension)} ends with {done.returncode}: "
                     f"{(done.stdout + done.stderr).strip()[:200]}")


def check_excluded(report, program, folder):
    """What cannot stand beside a pane is refused."""
    path = os.path.join(folder, "beside.gltf")
    for name, body, said in (("KHR_materials_unlit", {}, "a pane does not shine"),
                             ("PARHELION_coating", {"stack": "mgf2"}, "one of them is "
                                                                      "required"),
                             ("PARHELION_display", {"panel": "a.panel"},
                              "a pane is no display")):
        scene = Scene()
        scene.facing_quad(scene.material("pane", {**pane(laminate()), name: body}), [0, 0, 0],
                          [0, 1, 0], 1)
        scene.write(path)
        done = subprocess.run([program, "check", path], capture_output=True, text=True,
                              check=False)
        report.claim(done.returncode == 3 and said in done.stdout + done.stderr,
                     f"{name}: {done.returncode}, {done.stdout + done.stderr}")


def check_hidden(report, program, folder):
    """What a pane's material has besides, and is not seen, is told; and the frame is made."""
    path = os.path.join(folder, "hidden.gltf")
    for name in ("KHR_materials_volume", "KHR_materials_clearcoat",
                 "KHR_materials_diffuse_transmission"):
        scene = Scene()
        scene.facing_quad(scene.material("pane", {**pane(laminate()), name: {},
                                                  "KHR_materials_transmission": {}}),
                          [0, 0, 0], [0, 1, 0], 1)
        scene.write(path)
        done = subprocess.run([program, "check", path], capture_output=True, text=True,
                              check=False)
        said = done.stdout + done.stderr
        report.claim(done.returncode == 0 and "is not seen: PARHELION_glazing" in said and
                     f"extensions/{name})" in said, f"{name}: {said}")


def check_rim(report, eye):
    """A thick pane on the floor of a black box that is closed: its far face's image starts up
    to 6 cm beside where the pane is met, near the rim beyond the wall, and still none of the
    bright sky comes in."""
    scene = Scene()
    scene.box_inside(scene.lambert(0, double_sided=True), [-0.5, -0.5, -0.5], [0.5, 0.5, 0.5])
    scene.quad(scene.material("pane", pane([{"thickness_m": 0.05, "ior": INDEX}]),
                              doubleSided=True),
               [-0.7, -0.49, 0.7], [1.4, 0, 0], [0, 0, -1.4])
    scene.environment(type="constant", luminance=1e6)
    scene.view("eye", [-0.4, -0.4, 0], [1, -0.1, 0], 40)
    seen = luminances(eye.frame(scene, "--size", "64x36", "--spp", "64"))
    report.claim(max(seen) == 0, f"a closed box lets in {max(seen):g} cd/m2 at a pane's rim")


def main():
    program = os.path.abspath(sys.argv[-1])
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        eye = Eye(program, folder)
        check_shares(report, eye)
        check_curve_file(report, eye)
        check_coated(report, eye)
        check_ghost(report, eye)
        check_coated_ghost(report, eye)
        check_rim(report, eye)
        check_haze(report, eye)
        check_furnace(report, eye)
        check_faults(report, program, folder)
        check_excluded(report, program, folder)
        check_hidden(report, program, folder)
    return report.finish()


if __name__ == "__main__":
    sys.exit(main())
