# SPDX-License-Identifier: Apache-2.0
"""hdri.py PARHELION -- pictures of surroundings as light: what their files say of their scale,
in closed form, and the warning that they seem to have none.
"""
import json
import math
import os
import struct
import subprocess
import sys
import tempfile

from exr import Frame
from gltf import Scene
from pictures import write_exr

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
SHARED = os.path.join(ROOT, "..", "shared", "data", "hdri")
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

WIDTH, HEIGHT = 64, 32
REC709 = "0.64 0.33 0.30 0.60 0.15 0.06 0.3127 0.3290"
SWAPPED = "0.30 0.60 0.64 0.33 0.15 0.06 0.3127 0.3290"      # red is green
EQUAL_ENERGY = "0.640 0.330 0.290 0.600 0.150 0.060 0.3333333 0.3333333"
RED = (1, 0, 0)

# header lines behind FORMAT=, the stored value (but for half a step, which a code stands for
# more: (m + 1/2) 2^(e - 136)), cd/m2 of a red, green and blue of 1
WHITE = tuple(179 * part for part in (0.2126, 0.7152, 0.0722))
RADIANCE = (
    ("", (1, 1, 1), WHITE),
    ("", (1.9921875, 1.9921875, 1.9921875), WHITE),          # code 255
    ("EXPOSURE=2\n", (1, 1, 1), tuple(w / 2 for w in WHITE)),
    ("EXPOSURE= 2.0\nEXPOSURE=0.25\n", (1, 1, 1), tuple(w / 0.5 for w in WHITE)),
    ("\tEXPOSURE=8\n", (1, 1, 1), WHITE),                    # of a picture it was made from
    ("SOFTWARE=x\r\nEXPOSURE=4\r\n", (1, 1, 1), tuple(w / 4 for w in WHITE)),
    ("COLORCORR=1 2 4\n", (1, 2, 4), tuple(w / c for w, c in zip(WHITE, (1, 2, 4)))),
    ("COLORCORR=2 2 2\nCOLORCORR=1 2 1\nEXPOSURE=4\n", (1, 1, 1),
     tuple(w / c for w, c in zip(WHITE, (8, 16, 8)))),
    ("", RED, WHITE),
    (f"PRIMARIES={REC709}\n", RED, WHITE),
    (f"PRIMARIES={SWAPPED}\n", RED, (WHITE[1], WHITE[0], WHITE[2])),
    (f"PRIMARIES= {EQUAL_ENERGY}\n", (1, 1, 1), WHITE),
)
TOGETHER = "EXPOSURE= and COLORCORR= together divide"
# header, what the message says, its line (0: of all of the header)
REFUSED = (
    ("EXPOSURE=zero\n", "'EXPOSURE=zero', required: EXPOSURE= and a number above 0", 3),
    ("A=1\nEXPOSURE=-1\n", "'EXPOSURE=-1', required:", 4),
    ("EXPOSURE=0\n", "", 3), ("EXPOSURE=1 2\n", "", 3), ("EXPOSURE=\n", "", 3),
    ("EXPOSURE=1e300\nEXPOSURE=1e300\n", f"{TOGETHER} by inf", 0),
    ("EXPOSURE=1e-300\nCOLORCORR=1 1e-300 1\n", f"{TOGETHER} by 1e-300", 0),
    ("EXPOSURE=1e39\n", f"{TOGETHER} by 1e+39", 0), ("EXPOSURE=0x1p3\n", "", 3),
    ("EXPOSURE=1\0garbage\n", "", 3), ("EXPOSURE=1,5\n", "", 3),
    ("EXPOSURE=1" + " " * 600 + "x\n", "", 3), ("VIEW=-vta" + " " * 600 + "-vh 9\n", "", 3),
    ("EXPOSURE=nan\n", "", 3), ("EXPOSURE=inf\n", "", 3),
    ("COLORCORR=1 1\n", "'COLORCORR=1 1', required: COLORCORR= and three numbers above 0", 3),
    ("COLORCORR=1 0 1\n", "", 3),
    ("PRIMARIES=0.3 0.3\n", "'PRIMARIES=0.3 0.3', required: x and y of red, green, blue", 3),
    ("PRIMARIES=0.3 0.3 0.3 0.3 0.3 0.3 0.3 0.3\n", "", 3),
    ("FORMAT=32-bit_rle_x\n", "'FORMAT=32-bit_rle_x', required: FORMAT=32-bit_rle_rgbe", 3),
)
DOUBT = {"sun": "it shows a sun", "sky": "it shows a sky by day", "unit": "for a display"}
# real pictures, none of which has a scale
SHARED_PICTURES = (("blender/city.exr", "sun"), ("luxcore/infinitelight_latlong.exr", "sun"),
                   ("pmndrs/sky.exr", "sun"), ("pmndrs/dawn.exr", "sky"),
                   ("pmndrs/venice.exr", "sky"), ("pmndrs/forest.exr", "sky"),
                   ("openexr-env/OrientationLatLong.exr", "unit"),
                   ("radiance/flower.hdr", "unit"))


def shift_of(rgb):
    return 3 if max(rgb) >= 2 else 1


def middle(rgb):
    """What the codes stand for."""
    return [v + 2 ** shift_of(rgb) / 512 for v in rgb]


def radiance(header, rgb):
    """A uniform .hdr; rgb in whole multiples of 2^-7."""
    assert all(v * 128 == int(v * 128) and v < 2 for v in rgb) or max(rgb) < 8
    shift = shift_of(rgb)
    pixel = bytes([*(int(v * 256 / 2 ** shift) for v in rgb), 128 + shift])
    text = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n{header}\n-Y {HEIGHT} +X {WIDTH}\n"
    return text.encode() + pixel * (WIDTH * HEIGHT)


class Pictures:
    def __init__(self, program, folder):
        self.program, self.folder = os.path.abspath(program), folder
        Scene().write(self.path("empty.gltf"))

    def path(self, name):
        return os.path.join(self.folder, name)

    def run(self, *line):
        return subprocess.run([self.program, *line], cwd=self.folder, capture_output=True,
                              text=True, check=False)

    def put(self, name, data):
        with open(self.path(name), "wb") as file:
            file.write(data)

    def lux(self, *environment):
        done = self.run("measure", "empty.gltf", "--illuminance", "0,0,0,0,1,0", "--samples",
                        "4096", "--json", "--quiet", *environment)
        assert done.returncode == 0, done.stderr
        answer = json.loads(done.stdout)
        low, high = answer["illuminance_interval"]
        return answer["illuminance_lx"], (high - low) / 3.92, done.stderr

    def claim_lux(self, report, what, wanted, *environment):
        lux, sigma, _ = self.lux(*environment)
        report.claim(abs(lux - wanted) <= 3 * sigma + 2e-3 * wanted,
                     f"{what}: {lux:.6g} lx (sigma {sigma:.2g}) instead of {wanted:.6g}")


def check_radiance(report, pictures):
    for header, rgb, parts in RADIANCE:
        luminance = sum(v * w for v, w in zip(middle(rgb), parts))
        pictures.put("a.hdr", radiance(header, rgb))
        pictures.claim_lux(report, f"{header!r} {rgb}", math.pi * luminance, "--environment",
                           "hdri:a.hdr")
    for header, message, line in REFUSED:
        pictures.put("bad.hdr", radiance(header, (1, 1, 1)))
        done = pictures.run("sky", "--environment", "hdri:bad.hdr")
        report.claim(done.returncode == 3 and f"bad.hdr: {message}" in done.stderr
                     and done.stderr.endswith(f"(line {line})\n" if line else "(header)\n"),
                     f"{header!r}: {done.returncode}, {done.stderr}")
    pictures.put("turned.hdr", radiance("", (1, 1, 1)).replace(b"-Y 32 +X 64", b"-Y 32 -Z 64"))
    done = pictures.run("sky", "--environment", "hdri:turned.hdr")
    report.claim("turned.hdr: '-Y 32 -Z 64', required: -Y HEIGHT +X WIDTH" in done.stderr,
                 f"another axis: {done.stderr}")


def check_scene(report, pictures):
    """The same file named by a scene; its scale multiplies."""
    pictures.put("a.hdr", radiance("EXPOSURE=2\n", (1, 1, 1)))
    scene = Scene()
    scene.environment(type="hdri", uri="a.hdr", scale=3)
    scene.write(pictures.path("lit.gltf"))
    done = pictures.run("measure", "lit.gltf", "--illuminance", "0,0,0,0,1,0", "--samples",
                        "1024", "--json")
    lux = json.loads(done.stdout)["illuminance_lx"]
    report.claim(abs(lux / (math.pi * 179 * 1.5 * 128.5 / 128) - 1) < 2e-3,
                 f"in a scene: {lux} lx")
    pictures.put("a.hdr", radiance("EXPOSURE=x\n", (1, 1, 1)))
    done = pictures.run("check", "lit.gltf")
    report.claim(done.returncode == 3 and "a.hdr: line 3: 'EXPOSURE=x'" in done.stdout,
                 f"a bad line in a scene's picture: {done.stdout}")


def check_exr(report, pictures):
    count = WIDTH * HEIGHT
    white = ("float", struct.pack("<f", 250))
    swapped = ("chromaticities", struct.pack("<8f", *map(float, SWAPPED.split())))
    for rgb, attributes, luminance in (((2, 2, 2), {}, 2), ((2, 2, 2),
                                       {"whiteLuminance": white}, 500),
                                       ((1, 0, 0), {"chromaticities": swapped}, 0.7152),
                                       ((1, 0, 0), {"chromaticities": swapped,
                                                    "whiteLuminance": white}, 250 * 0.7152)):
        write_exr(pictures.path("a.exr"), WIDTH, HEIGHT,
                  {name: [float(v)] * count for name, v in zip("RGB", rgb)}, attributes)
        pictures.claim_lux(report, f"exr {rgb} {sorted(attributes)}", math.pi * luminance,
                           "--environment", "hdri:a.exr")
    write_exr(pictures.path("a.exr"), 2, 1, {name: [1.0, 1.0] for name in "RGB"},
              {"whiteLuminance": ("float", struct.pack("<f", -1))})
    done = pictures.run("sky", "--environment", "hdri:a.exr")
    report.claim(done.returncode == 3
                 and "a.exr: whiteLuminance is -1, required: the cd/m2 of white" in done.stderr,
                 f"negative whiteLuminance: {done.stderr}")


def scaled(pictures, source, target, factor, sun=None):
    """sun: a pixel that is made 200000 times as bright as the mean."""
    frame = Frame(pictures.path(source))
    channels = {name: [v * factor for v in frame.channels[name]] for name in "RGB"}
    for values in channels.values():
        if sun:
            values[sun[1] * frame.width + sun[0]] = 2e5 * sum(values) / len(values)
    write_exr(pictures.path(target), frame.width, frame.height, channels)


def told(report, pictures, name, kind, *options):
    done = pictures.run("sky", "--environment", f"hdri:{name}", *options)
    found = [k for k, words in DOUBT.items() if words in done.stderr]
    report.claim(done.returncode == 0 and found == ([kind] if kind else []),
                 f"{name} {options}: told {found} instead of {kind}: {done.stderr}")
    if kind:
        report.claim(f"warning: {name}: " in done.stderr and "--hdri-lux" in done.stderr,
                     f"{name}: the warning names file and option: {done.stderr}")


def check_skies(report, pictures):
    """Skies that the program itself draws (without the disc), at their own scale and not."""
    skies = {"noon": ("sky:clear", "--sun", "180,60"),
             "sunset": ("sky:clear", "--sun", "270,3"), "overcast": ("cie:1:8000",)}
    for name, environment in skies.items():
        done = pictures.run("sky", "--environment", *environment, "-o", f"{name}.exr", "--size",
                            "256x128", "--json")
        lux = json.loads(done.stdout)["diffuse_horizontal_lx"]
        told(report, pictures, f"{name}.exr", None)
        for dim in (2, 20, 45):
            scaled(pictures, f"{name}.exr", "dim.exr", dim / lux)
            done = pictures.run("sky", "--environment", "hdri:dim.exr")
            report.claim(any(words in done.stderr for words in DOUBT.values()),
                         f"{name} of {dim} lx: nothing is told {done.stderr}")
        told(report, pictures, "dim.exr", None, "--hdri-lux", "2000")
    for name, row in (("noon", 21), ("sunset", 61)):  # the sun's, of 128
        scaled(pictures, f"{name}.exr", "disc.exr", 1e-4, (128, row))
        told(report, pictures, "disc.exr", "sun")
        scaled(pictures, f"{name}.exr", "disc.exr", 1, (128, row))
        told(report, pictures, "disc.exr", None)


def night(x, y, lamp, sky, ground):
    """A street: four lamps, dark sky, lit ground."""
    if y == 12 and x % 16 == 3:
        return lamp
    return sky if y < HEIGHT / 2 else ground


def check_nights(report, pictures):
    for lamp, sky, ground in ((5000, 0.01, 1), (20000, 0.03, 2), (300, 0.002, 0.05),
                              (0, 1e-3, 0)):
        values = [float(night(i % WIDTH, i // WIDTH, lamp, sky, ground))
                  for i in range(WIDTH * HEIGHT)]
        write_exr(pictures.path("night.exr"), WIDTH, HEIGHT, {name: values for name in "RGB"})
        told(report, pictures, "night.exr", None)


def check_unit_range(report, pictures):
    """0 to 1, as a picture for a display; also in a scene, whose scale silences."""
    values = [(i % WIDTH) / (WIDTH - 1) for i in range(WIDTH * HEIGHT)]
    for top, kind in ((1, "unit"), (0.6, "unit"), (0.2, None), (400, None)):
        write_exr(pictures.path("ramp.exr"), WIDTH, HEIGHT,
                  {name: [top * v for v in values] for name in "RGB"})
        told(report, pictures, "ramp.exr", kind)
    write_exr(pictures.path("ramp.exr"), WIDTH, HEIGHT, {name: values for name in "RGB"})
    for scale, is_told in ((1, True), (5000, False)):
        scene = Scene()
        scene.environment(type="hdri", uri="ramp.exr", scale=scale)
        scene.write(pictures.path("lit.gltf"))
        done = pictures.run("check", "lit.gltf")
        report.claim((DOUBT["unit"] in done.stdout) == is_told,
                     f"scale {scale} in a scene: {done.stdout}")


def check_shared(report, pictures):
    if not os.path.isdir(SHARED):
        print("skipped: no ../shared/data/hdri")
        return
    for name, kind in SHARED_PICTURES:
        told(report, pictures, os.path.join(SHARED, name), kind)


def main():
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        pictures = Pictures(sys.argv[-1], folder)
        for check in (check_radiance, check_scene, check_exr, check_skies, check_nights,
                      check_unit_range, check_shared):
            try:
                check(report, pictures)
            except AssertionError as error:
                report.claim(False, f"{check.__name__}: {error}")
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
