# SPDX-License-Identifier: Apache-2.0
"""one_light.py PARHELION -- one light in every command: for each attribute that changes light,
`sky`, a scene, `render`, `measure`, `develop` and `compare` take the same from the same file,
or refuse it with the same words. And "same" is earned: no pixel differs where no figure does.
"""
import json
import math
import os
import struct
import subprocess
import sys
import tempfile
import zlib

from gltf import Scene
from pictures import text, write_exr, write_png

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
CASES = os.path.join(ROOT, "..", "shared", "data", "cases", "light")
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

WIDTH, HEIGHT = 16, 8
COUNT = WIDTH * HEIGHT
REC709 = (0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290)
SWAPPED = (0.30, 0.60, 0.64, 0.33, 0.15, 0.06, 0.3127, 0.3290)  # red is green
XYZ = (1, 0, 0, 1, 0, 0, 1 / 3, 1 / 3)
WEIGHTS = (0.2126, 0.7152, 0.0722)
NAN, INF = math.nan, math.inf


def luminance(rgb):
    return sum(w * v for w, v in zip(WEIGHTS, rgb))


# ---- files of light --------------------------------------------------------------------------

CODE = (200, 150, 130, 136)       # (m + 1/2) 2^(e - 136)
STORED = tuple(m + 0.5 for m in CODE[:3])
RADIANCE_LIGHT = tuple(179 * v for v in STORED)


def radiance(lines="", size=f"-Y {HEIGHT} +X {WIDTH}", body=bytes(CODE) * COUNT,
             kind="rgbe"):
    return f"#?RADIANCE\nFORMAT=32-bit_rle_{kind}\n{lines}\n{size}\n".encode() + body


def over(factors):
    return tuple(v / f for v, f in zip(RADIANCE_LIGHT, factors))


def new_runs():
    """Each component as a run of one half and plain bytes for the other."""
    line = bytes([2, 2, 0, WIDTH])
    for code in CODE:
        line += bytes([128 + WIDTH // 2, code, WIDTH // 2]) + bytes([code]) * (WIDTH // 2)
    return line * HEIGHT


OLD_RUNS = (bytes(CODE) + bytes([1, 1, 1, WIDTH - 1])) * HEIGHT

# name, header lines and more, the light of its pixels
RADIANCE = (
    ("plain", {}, RADIANCE_LIGHT),
    ("exposure", {"lines": "EXPOSURE=10\n"}, over((10, 10, 10))),
    ("exposures", {"lines": "EXPOSURE=4\nEXPOSURE= 0.5\n"}, over((2, 2, 2))),
    ("colorcorr", {"lines": "COLORCORR=1 2 4\n"}, over((1, 2, 4))),
    ("primaries", {"lines": "PRIMARIES=" + " ".join(map(str, SWAPPED)) + "\n"},
     (RADIANCE_LIGHT[1], RADIANCE_LIGHT[0], RADIANCE_LIGHT[2])),
    ("new_runs", {"body": new_runs()}, RADIANCE_LIGHT),
    ("old_runs", {"body": OLD_RUNS}, RADIANCE_LIGHT),
)


def number(kind, value):
    return kind, struct.pack({"float": "<f", "double": "<d", "int": "<i"}[kind], value)


def colours(xy):
    return "chromaticities", struct.pack("<8f", *xy)


# name, channels, attributes, the light of its pixels
BASE = (100.0, 50.0, 20.0)
TURNED = (50.0, 100.0, 20.0)
EXR = (
    ("exr", BASE, {}, BASE),
    ("white", BASE, {"whiteLuminance": number("float", 250)}, tuple(250 * v for v in BASE)),
    ("white_double", BASE, {"whiteLuminance": number("double", 0.5)},
     tuple(v / 2 for v in BASE)),
    ("white_int", BASE, {"whiteLuminance": number("int", 3)}, tuple(3 * v for v in BASE)),
    ("rec709", BASE, {"chromaticities": colours(REC709)}, BASE),
    ("chromaticities", BASE, {"chromaticities": colours(SWAPPED)}, TURNED),
    ("both", BASE, {"chromaticities": colours(SWAPPED), "whiteLuminance": number("float", 2)},
     tuple(2 * v for v in TURNED)),
    ("alpha", BASE + (0.5,), {}, BASE),
    ("grey", (7.0,), {}, (7.0,) * 3),
    ("grey_white", (7.0,), {"whiteLuminance": number("float", 10)}, (70.0,) * 3),
    ("grey_turned", (7.0,), {"chromaticities": colours(SWAPPED)}, (7.0,) * 3),
)
NAMES = {1: "Y", 3: "RGB", 4: "RGBA"}
REFUSED = (
    ("white_0", {"whiteLuminance": number("float", 0)}, "whiteLuminance is 0, required:"),
    ("white_less", {"whiteLuminance": number("float", -1)}, "whiteLuminance is -1, required:"),
    ("white_nan", {"whiteLuminance": number("float", NAN)}, "whiteLuminance is nan, required:"),
    ("white_inf", {"whiteLuminance": number("float", INF)}, "whiteLuminance is inf, required:"),
    ("white_text", {"whiteLuminance": text("100")}, "whiteLuminance"),
    ("on_a_line", {"chromaticities": colours((0.3,) * 8)}, "chromaticities: required: x and y"),
    ("colours_nan", {"chromaticities": colours((NAN,) * 8)}, "chromaticities: required: x and "
                                                             "y"),
)


def exr_channels(values):
    return {name: [v] * COUNT for name, v in zip(NAMES[len(values)], values)}


class Commands:
    def __init__(self, program, folder):
        self.program, self.folder = os.path.abspath(program), folder
        Scene().write(self.path("empty.gltf"))

    def path(self, name):
        return os.path.join(self.folder, name)

    def put(self, name, data):
        with open(self.path(name), "wb") as file:
            file.write(data)

    def exr(self, name, channels, attributes=None, **more):
        write_exr(self.path(name), WIDTH, HEIGHT, channels, attributes, **more)

    def run(self, *line):
        return subprocess.run([self.program, *line], cwd=self.folder, capture_output=True,
                              text=True, check=False)

    def json(self, *line):
        done = self.run(*line, "--json")
        return json.loads(done.stdout) if done.returncode < 2 else {"error": done.stderr}

    def lit(self, name):
        """A scene that names the picture."""
        scene = Scene()
        scene.environment(type="hdri", uri=name)
        scene.write(self.path("lit.gltf"))
        return "lit.gltf"

    def all(self, name):
        """What reads a file of light, each as it takes one."""
        return {"sky": ("sky", "--environment", f"hdri:{name}"),
                "a scene": ("sky", self.lit(name)),
                "render": ("render", "empty.gltf", "--environment", f"hdri:{name}", "--size",
                           "4x2", "--spp", "1", "--quiet", "-o", "r.exr"),
                "measure": ("measure", name), "develop": ("develop", name, "-o", "d.tif"),
                "compare": ("compare", name, name, "--metric", "mse")}


def near(value, wanted):
    """A sky is made of spectra that are a colour to a few ten thousandths."""
    return value is not None and abs(value - wanted) <= 1e-3 * abs(wanted)


def claim_light(report, commands, name, rgb):
    wanted = luminance(rgb)
    found = {"sky": commands.json("sky", "--environment", f"hdri:{name}"),
             "a scene": commands.json("sky", commands.lit(name))}
    found = {who: answer.get("diffuse_horizontal_lx", 0) / math.pi
             for who, answer in found.items()}
    commands.run("render", "empty.gltf", "--environment", f"hdri:{name}", "--size", "4x2",
                 "--spp", "64", "--quiet", "-o", "r.exr")
    for who, frame in (("render", "r.exr"), ("measure", name)):
        found[who] = commands.json("measure", frame).get("XYZ", [0, 0])[1]
    for who, value in found.items():
        # a render's few wavelengths know a colour less well
        ok = abs(value / wanted - 1) < 0.03 if who == "render" else near(value, wanted)
        report.claim(ok, f"{name}: {who} takes {value:.6g} cd/m2 instead of {wanted:.6g}")
    commands.exr("right.exr", exr_channels(rgb))
    right = commands.json("compare", "right.exr", name, "--max",
                          f"max_difference={2e-6 * max(rgb)}", "--ignore", "A",
                          "--metric", "mse")
    report.claim(right.get("same"), f"{name}: compare takes another light: {right}")


def check_light(report, commands):
    for name, more, rgb in RADIANCE:
        commands.put(f"{name}.hdr", radiance(**more))
        claim_light(report, commands, f"{name}.hdr", rgb)
    for name, values, attributes, rgb in EXR:
        commands.exr(f"{name}.exr", exr_channels(values), attributes)
        claim_light(report, commands, f"{name}.exr", rgb)
    # CIE XYZ: Y is the luminance, whatever the others are
    commands.put("xyze.hdr", radiance("EXPOSURE=2\n", kind="xyze"))
    for who, line in (("sky", ("sky", "--environment", "hdri:xyze.hdr")),
                      ("measure", ("measure", "xyze.hdr"))):
        answer = commands.json(*line)
        value = answer.get("diffuse_horizontal_lx", 0) / math.pi or answer.get("XYZ", [0, 0])[1]
        report.claim(near(value, RADIANCE_LIGHT[1] / 2) or who == "sky" and value > 0,
                     f"xyze: {who} takes {value} cd/m2")


def check_developed(report, commands):
    """A picture of a frame is that of the same light, stated otherwise."""
    for name in ("primaries.hdr", "both.exr"):
        rgb = next(case[-1] for case in RADIANCE + EXR if name.startswith(case[0] + "."))
        commands.exr("right.exr", exr_channels(rgb))
        for frame, picture in (("right.exr", "right.tif"), (name, "found.tif")):
            commands.run("develop", frame, "--exposure", "12", "--bits", "16", "-o", picture)
        answer = commands.json("compare", "right.tif", "found.tif", "--metric", "mse")
        report.claim(answer.get("metrics", {}).get("max_difference", 1) < 5e-5,
                     f"{name}: develop takes another light: {answer}")


def check_orders(report, commands):
    """The eight orders of pixels are one picture: each pixel has its own code."""
    pixels = [bytes([128 + x, 128 + 8 * y, 200, 136]) for y in range(HEIGHT)
              for x in range(WIDTH)]
    commands.put("upright.hdr", radiance(body=b"".join(pixels)))
    for sx in "+-":
        for sy in "+-":
            columns = range(WIDTH) if sx == "+" else range(WIDTH - 1, -1, -1)
            rows = range(HEIGHT) if sy == "-" else range(HEIGHT - 1, -1, -1)
            for size, body in (
                    (f"{sy}Y {HEIGHT} {sx}X {WIDTH}", [(x, y) for y in rows for x in columns]),
                    (f"{sx}X {WIDTH} {sy}Y {HEIGHT}", [(x, y) for x in columns for y in rows])):
                data = b"".join(pixels[y * WIDTH + x] for x, y in body)
                commands.put("order.hdr", radiance(size=size, body=data))
                answer = commands.json("compare", "upright.hdr", "order.hdr")
                report.claim(answer.get("same"), f"order {size}: {answer}")
    for what, data in (("cut", radiance()[:-1]), ("long run", radiance(body=bytes(CODE) + bytes(
            [1, 1, 1, 200]))), ("first run", radiance(body=bytes([1, 1, 1, 4]))),
                       ("empty run", radiance(body=bytes([2, 2, 0, WIDTH, 0, 0])))):
        commands.put("bad.hdr", data)
        claim_refused(report, commands, "bad.hdr", "damaged hdr picture: scan line", what)


def claim_refused(report, commands, name, words, what=""):
    """The same words in all, and status 3."""
    for who, line in commands.all(name).items():
        done = commands.run(*line)
        told = done.stderr + done.stdout
        report.claim(done.returncode == 3 and words in told and name in told,
                     f"{name} {what}: {who}: {done.returncode}, {told[-300:]}")


def check_refused(report, commands):
    for name, attributes, words in REFUSED:
        commands.exr(f"{name}.exr", exr_channels(BASE), attributes)
        claim_refused(report, commands, f"{name}.exr", words)
    write_png(commands.path("plain.png"), WIDTH, HEIGHT, [90] * 3 * COUNT)
    for who, line in commands.all("plain.png").items():
        if who != "compare":
            done = commands.run(*line)
            report.claim(done.returncode == 3 and "holds display codes" in
                         done.stderr + done.stdout, f"plain.png: {who}: {done.stderr}")
    commands.exr("coarse.exr", exr_channels(BASE))
    data = bytearray(open(commands.path("coarse.exr"), "rb").read())
    at = data.index(b"B\0\2\0\0\0") + 10
    data[at:at + 8] = struct.pack("<ii", 2, 2)
    commands.put("coarse.exr", bytes(data))
    claim_refused(report, commands, "coarse.exr", "coarse.exr")


def claim_warned(report, commands, name, words, but=()):
    for who, line in commands.all(name).items():
        if who == "develop" and who in but:
            continue  # a second each
        done = commands.run(*line)
        told = done.stderr + done.stdout
        report.claim(done.returncode in (0, 1) and (words in told) != (who in but),
                     f"{name}: {who}: {done.returncode}, {words!r}: {told[-300:]}")


FRAMES = ("measure", "develop", "compare")  # for which it is no picture of surroundings


def check_warned(report, commands):
    values = [BASE[1]] * COUNT
    for what, bad, words in (("nan", NAN, "1 values that are not finite"),
                             ("inf", INF, "1 values that are not finite"),
                             ("negative", -3.0, "1 negative values count as 0")):
        commands.exr(f"{what}.exr", {"R": values, "G": [bad] + values[1:], "B": values})
        claim_warned(report, commands, f"{what}.exr", words, FRAMES)
    for name, words in (("measure", "left out     1"), ("develop", "1 pixels are not finite"),
                        ("compare", "NaN or infinite")):
        done = commands.run(*commands.all("nan.exr")[name])
        report.claim(words in done.stdout + done.stderr, f"nan.exr: {name}: {done.stdout}")
    commands.exr("named.exr", exr_channels(BASE), {"oiio:ColorSpace": text("ACEScg")})
    claim_warned(report, commands, "named.exr", "'ACEScg' is not read")
    write_exr(commands.path("square.exr"), 8, 8, {c: [1.0] * 64 for c in "RGB"})
    claim_warned(report, commands, "square.exr", "twice as wide as high", FRAMES)
    commands.put("view.hdr", radiance("VIEW= -vtv -vh 40 -vv 20\n"))
    claim_warned(report, commands, "view.hdr", "is the view of a camera", FRAMES)


def check_windows(report, commands):
    """Light is that of the display window; what the data window has beside it is told of."""
    half = {"R": [40.0] * 64, "G": [40.0] * 64, "B": [40.0] * 64}
    commands.exr("half.exr", half, data=(0, 0, WIDTH, 4))  # the upper half
    lux = commands.json("sky", "--environment", "hdri:half.exr")["diffuse_horizontal_lx"]
    report.claim(abs(lux / 40 / math.pi - 1) < 0.01, f"the upper half alone: {lux} lx")
    for name, last in (("over_a.exr", 1.0), ("over_b.exr", 2.0)):
        plane = [1.0] * (COUNT + WIDTH - 1) + [last]
        commands.exr(name, {c: plane for c in "RGB"}, data=(0, 0, WIDTH, HEIGHT + 1))
    done = commands.run("compare", "over_a.exr", "over_b.exr")
    report.claim(done.returncode == 1 and "outside of the display window differ" in done.stdout,
                 f"beyond the display window: {done.stdout}")


# ---- OpenEXR files of parts ------------------------------------------------------------------

def parts_exr(path, parts):
    """parts: (name, value, attributes) of WIDTH x HEIGHT, channels R, G, B; uncompressed."""
    heads, chunks = b"", []
    for i, (name, value, attributes) in enumerate(parts):
        listed = b"".join(c + b"\0" + struct.pack("<iB3xii", 2, 0, 1, 1)
                          for c in (b"B", b"G", b"R")) + b"\0"
        window = struct.pack("<4i", 0, 0, WIDTH - 1, HEIGHT - 1)
        header = {"channels": ("chlist", listed), "compression": ("compression", b"\0"),
                  "chunkCount": number("int", HEIGHT), "dataWindow": ("box2i", window),
                  "displayWindow": ("box2i", window), "lineOrder": ("lineOrder", b"\0"),
                  "name": text(name), "pixelAspectRatio": number("float", 1),
                  "screenWindowCenter": ("v2f", bytes(8)),
                  "screenWindowWidth": number("float", 1), "type": text("scanlineimage"),
                  **attributes}
        for key, (kind, data) in header.items():
            heads += key.encode() + b"\0" + kind.encode() + b"\0"
            heads += struct.pack("<i", len(data)) + data
        heads += b"\0"
        row = struct.pack(f"<{3 * WIDTH}f", *[value] * 3 * WIDTH)
        chunks += [struct.pack("<iii", i, y, len(row)) + row for y in range(HEIGHT)]
    heads = struct.pack("<II", 20000630, 2 | 0x1000) + heads + b"\0"
    at, table = len(heads) + 8 * len(chunks), b""
    for chunk in chunks:
        table += struct.pack("<Q", at)
        at += len(chunk)
    with open(path, "wb") as file:
        file.write(heads + table + b"".join(chunks))


def check_parts(report, commands):
    day = {"capDate": text("2026:01:01 00:00:00")}
    white = {"whiteLuminance": number("float", 2)}
    first = ("one", 5.0, {})
    for name, second in (("aa", ("two", 5.0, {})), ("same", ("two", 5.0, day)),
                         ("ab", ("two", 6.0, {})), ("named", ("other", 5.0, {})),
                         ("white", ("two", 5.0, white))):
        parts_exr(commands.path(f"{name}_parts.exr"), (first, second))
    commands.exr("single.exr", {c: [5.0] * COUNT for c in "RGB"})
    claim_warned(report, commands, "aa_parts.exr", "has 2 parts: the first one alone is read")
    for other, status, words in (("aa", 0, "equal in every pixel"), ("same", 0, "equal"),
                                 ("ab", 1, "part two differs"),
                                 ("white", 1, "part two differs"),
                                 ("named", 1, "part two is missing in the test")):
        done = commands.run("compare", "aa_parts.exr", f"{other}_parts.exr", "--max", "mse=1")
        report.claim(done.returncode == status and words in done.stdout,
                     f"parts aa, {other}: {done.returncode}, {done.stdout[-300:]}")
    done = commands.run("compare", "aa_parts.exr", "single.exr")
    report.claim(done.returncode == 1 and "part two is missing" in done.stdout,
                 f"a part on one side: {done.stdout[-300:]}")
    done = commands.run("compare", "aa_parts.exr", "ab_parts.exr", "--ignore", "two")
    report.claim(done.returncode == 0, f"a part left out: {done.stdout[-300:]}")


def check_cube(report, commands):
    """Each face has its own light: where it lies is OpenEXR's, and lights a plane so."""
    side = 8
    def cube(bright):
        values = [float(face == bright) for face in range(6) for _ in range(side * side)]
        write_exr(commands.path("cube.exr"), side, 6 * side, {c: values for c in "RGB"},
                  {"envmap": ("envmap", b"\1")})
        return commands.json("sky", "--environment", "hdri:cube.exr")
    # of a face overhead: 4 integral of dx dy / (1 + x^2 + y^2)^2 over the unit square
    top = 4 * (math.atan(1 / math.sqrt(2)) / math.sqrt(2))
    beside = (math.pi - top) / 4
    for face, wanted in ((0, beside), (1, beside), (2, top), (3, 0), (4, beside), (5, beside)):
        lux = cube(face)["diffuse_horizontal_lx"]
        report.claim(abs(lux - wanted) < 0.02, f"face {face}: {lux} lx instead of {wanted}")
    for envmap, other in ((b"\1", b"\0"), (b"\1", None)):
        for name, value in (("a.exr", envmap), ("b.exr", other)):
            write_exr(commands.path(name), side, 6 * side,
                      {c: [1.0] * 6 * side * side for c in "RGB"},
                      {"envmap": ("envmap", value)} if value else {})
        done = commands.run("compare", "a.exr", "b.exr")
        report.claim(done.returncode == 1 and "envmap" in done.stdout,
                     f"envmap {envmap} and {other}: {done.stdout}")


# ---- pictures of codes -----------------------------------------------------------------------

def part(kind, body):
    checksum = struct.pack(">I", zlib.crc32(kind + body))
    return struct.pack(">I", len(body)) + kind + body + checksum


def png(codes, *parts, width=WIDTH, height=HEIGHT):
    rows = b"".join(b"\0" + bytes(codes[3 * width * y:3 * width * (y + 1)])
                    for y in range(height))
    return (b"\x89PNG\r\n\x1a\n" + part(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0,
                                                               0, 0))
            + b"".join(parts) + part(b"IDAT", zlib.compress(rows)) + part(b"IEND", b""))


def exif(orientation):
    return b"MM\0*" + struct.pack(">IHHHIHHI", 8, 1, 274, 3, 1, orientation, 0, 0)


def chrm(xy):
    return part(b"cHRM", b"".join(struct.pack(">I", round(v * 1e5)) for v in xy[6:] + xy[:6]))


def profile(gamma, space=b"RGB "):
    """Rec.709's primaries of D50, and one power."""
    columns = {b"rXYZ": (0.43607, 0.22249, 0.01392), b"gXYZ": (0.38515, 0.71687, 0.09708),
               b"bXYZ": (0.14307, 0.06061, 0.71410)}
    tags = {name: b"XYZ " + bytes(4) + b"".join(struct.pack(">i", round(v * 65536))
                                                 for v in xyz) for name, xyz in columns.items()}
    for name in (b"rTRC", b"gTRC", b"bTRC"):
        tags[name] = b"curv" + bytes(4) + struct.pack(">IH", 1, round(gamma * 256)) + bytes(2)
    table, data = struct.pack(">I", len(tags)), b""
    for name, body in tags.items():
        table += name + struct.pack(">II", 132 + 12 * len(tags) + len(data), len(body))
        data += body
    head = struct.pack(">I4xI", 128 + len(table) + len(data), 0x02400000) + b"mntr" + space
    head += b"XYZ " + bytes(12) + b"acsp" + bytes(28) + struct.pack(">3i", 63190, 65536, 54061)
    return head + bytes(128 - len(head)) + table + data


def iccp(data):
    return part(b"iCCP", b"x\0\0" + zlib.compress(data))


GAMMA1, SRGB_GAMMA = part(b"gAMA", struct.pack(">I", 100000)), part(b"gAMA",
                                                                  struct.pack(">I", 45455))
P3 = (0.680, 0.320, 0.265, 0.690, 0.150, 0.060, 0.3127, 0.3290)


def srgb(light):
    return 12.92 * light if light <= 0.0031308 else 1.055 * light ** (1 / 2.4) - 0.055


def cicp(*codes):
    return part(b"cICP", bytes(codes))


# name, parts, the grey that 128 is shown as (None: not known), what content is warned of
GREY = 128 / 255
PICTURES = (
    ("sRGB", (part(b"sRGB", b"\0"),), GREY, None),
    ("gAMA of sRGB", (SRGB_GAMMA,), GREY, None),
    ("sRGB before gAMA", (part(b"sRGB", b"\0"), GAMMA1), GREY, None),
    ("gAMA 1", (GAMMA1,), srgb(GREY), "gAMA"),
    ("cHRM of P3", (chrm(P3),), GREY, "cHRM"),
    ("gAMA, cHRM", (GAMMA1, chrm(P3)), srgb(GREY), "gAMA and cHRM"),
    ("iCCP", (iccp(profile(1.8)),), srgb(GREY ** 1.8), "an ICC profile"),
    ("cICP of sRGB", (cicp(1, 13, 0, 1),), GREY, None),
    ("cICP of P3", (cicp(12, 13, 0, 1),), GREY, "cICP 12/13/0/1"),
    ("cICP before iCCP", (cicp(1, 8, 0, 1), iccp(profile(1.8))), srgb(GREY), "cICP 1/8/0/1"),
    ("cICP of PQ", (cicp(9, 16, 0, 1),), None, "cICP 9/16/0/1"),
    ("iCCP of CMYK", (iccp(profile(1, b"CMYK")),), None, "an ICC profile"),
    ("iCCP cut", (part(b"iCCP", b"x\0\0abc"),), None, "an ICC profile (damaged)"),
)

TOLD = ("sRGB", "gAMA 1", "gAMA, cHRM", "iCCP", "cICP of P3")  # as contents


def claim_content(report, commands, name, words):
    """Codes are shown as they are, and what the file says of them is told of."""
    panel = os.path.join(ROOT, "assets", "panels", "ips_cluster.panel")
    scene = Scene()
    material = scene.material("shown", {"PARHELION_display": {
        "panel": os.path.relpath(panel, commands.folder), "content": {"index": 0}}})
    scene.quad(material, (0, 0, -1), (1, 0, 0), (0, 1, 0))
    scene.write(commands.path("shown.gltf"))
    with open(commands.path("shown.gltf"), encoding="utf-8") as file:
        tree = json.load(file)
    tree.update({"images": [{"uri": name}], "textures": [{"source": 0}]})
    with open(commands.path("shown.gltf"), "w", encoding="utf-8") as file:
        json.dump(tree, file)
    done = commands.run("check", "shown.gltf", "--root", "/")
    told = "its content states" in done.stdout
    report.claim(done.returncode == 0 and told == bool(words) and (words or "") in done.stdout,
                 f"content {name}: {words}: {done.stdout} {done.stderr}")


def check_pictures(report, commands):
    grey = [128] * 3 * COUNT
    red = [200, 30, 30] * COUNT
    commands.put("bare.png", png(grey))
    commands.put("bare_red.png", png(red))
    for name, parts, shown, words in PICTURES:
        commands.put("a.png", png(grey, *parts))
        commands.put("red.png", png(red, *parts))
        if name in TOLD:
            claim_content(report, commands, "a.png", words)
        if shown is None:
            done = commands.json("compare", "a.png", "a.png")
            report.claim(done.get("same"), f"{name}: is not the same as itself: {done}")
        done = commands.json("compare", "bare.png", "a.png")
        found = done["metrics"]["max_difference"]
        report.claim(found is not None and (
            not done["same"] if shown is None else abs(found - abs(shown - GREY)) < 3e-3),
            f"{name}: grey differs by {found} instead of {shown} - {GREY}")
        if "P3" not in name:
            continue
        other = commands.json("compare", "bare_red.png", "red.png")
        report.claim((other["differing_pixels"] == 0) == (other["metrics"]["mae"] == 0),
                     f"{name}: {other['differing_pixels']} pixels, mae "
                     f"{other['metrics']['mae']}")
        report.claim(not other["same"] and other["metrics"]["deltae_mean"] > 2,
                     f"{name}: red is another red: {other['metrics']}")


def oriented(codes, orientation):
    """The stored picture whose upright one is `codes`: Exif's table, the other way round."""
    turns = orientation >= 5
    width, height = (HEIGHT, WIDTH) if turns else (WIDTH, HEIGHT)
    out = []
    for row in range(height):
        for column in range(width):
            x, y = (row, column) if turns else (column, row)
            x = WIDTH - 1 - x if orientation in (2, 3, 6, 7) else x
            y = HEIGHT - 1 - y if orientation in (3, 4, 7, 8) else y
            out += codes[3 * (y * WIDTH + x):3 * (y * WIDTH + x) + 3]
    return out, width, height


def check_orientation(report, commands):
    codes = [(i * 7) % 251 for i in range(3 * COUNT)]
    commands.put("up.png", png(codes))
    for orientation in range(1, 9):
        stored, width, height = oriented(codes, orientation)
        commands.put("o.png", png(stored, part(b"eXIf", exif(orientation)), width=width,
                                  height=height))
        done = commands.json("compare", "up.png", "o.png")
        report.claim(done.get("same"), f"orientation {orientation}: {done}")
    claim_content(report, commands, "o.png", "orientation 8")
    claim_content(report, commands, "exposure.hdr", "linear light")


# ---- the cases that were reported ------------------------------------------------------------

def check_masks(report, commands):
    """What lies under a mask decides nothing, in no figure."""
    codes = [(i * 7) % 251 for i in range(3 * COUNT)]
    mask = [255] * 3 * COUNT
    at = 3 * (3 * WIDTH + 5)
    mask[at:at + 3] = [0, 0, 0]
    commands.put("mask.png", png(mask))
    commands.put("plain.png", png(codes))
    changed = list(codes)
    changed[at:at + 3] = [255, 0, 255]
    commands.put("masked.png", png(changed))
    moved = [min(255, v + 3) for v in codes]
    commands.put("moved.png", png(moved))
    moved[at:at + 3] = [0, 255, 0]
    commands.put("moved_too.png", png(moved))
    one = commands.json("compare", "plain.png", "moved.png", "--mask", "mask.png")["metrics"]
    other = commands.json("compare", "masked.png", "moved_too.png", "--mask",
                          "mask.png")["metrics"]
    report.claim(one == other and one["flip"] > 0, f"under a mask: {one} and {other}")
    values = [1.0 + i % 7 for i in range(COUNT)]
    sun = list(values)
    sun[at // 3] = 1e7
    commands.exr("day.exr", {c: values for c in "RGB"})
    commands.exr("sun.exr", {c: sun for c in "RGB"})
    commands.exr("moon.exr", {c: [1.1 * v for v in values] for c in "RGB"})
    one, other = (commands.json("compare", name, "moon.exr", "--mask", "mask.png", "--metric",
                                "flip,mse")["metrics"] for name in ("day.exr", "sun.exr"))
    report.claim(one == other and one["flip"] > 0, f"a masked sun: {one} and {other}")


def check_ignored(report, commands):
    """A channel that is left out is left out of all figures."""
    commands.exr("a.exr", exr_channels(BASE))
    commands.exr("b.exr", exr_channels((BASE[0], 99.0, BASE[2])))
    write_png(commands.path("a.png"), WIDTH, HEIGHT, [90, 90, 90] * COUNT)
    write_png(commands.path("b.png"), WIDTH, HEIGHT, [90, 91, 90] * COUNT)
    for ending in ("exr", "png"):
        for ignored in ((), ("--ignore", "G")):
            done = commands.json("compare", f"a.{ending}", f"b.{ending}", *ignored)
            figures = done["metrics"]
            differs = [figures[name] != 0 for name in ("mae", "flip", "deltae_mean")]
            report.claim(differs == [done["differing_pixels"] > 0] * 3 and
                         done["same"] == bool(ignored), f"{ending} {ignored}: {figures}")


def check_folders(report, commands):
    os.mkdir(commands.path("golden"))
    os.mkdir(commands.path("today"))
    commands.exr("today/a.exr", exr_channels(BASE))
    done = commands.run("compare", "golden", "today", "--allow-extra")
    report.claim(done.returncode == 3 and "nothing was compared" in done.stderr,
                 f"an empty folder: {done.returncode}, {done.stdout} {done.stderr}")


def check_shared(report, commands):
    if not os.path.isdir(CASES):
        report.skip("no ../shared/data/cases/light")
        return
    def case(name):
        return os.path.join(CASES, name)
    for a, b, more, status in (
            ("02_plain.hdr", "02_exposure_10.hdr", (), 1),
            ("03_plain.exr", "03_chromaticities_ap0.exr", ("--ignore", "chromaticities"), 1),
            ("04_two_parts_aa.exr", "04_two_parts_ab.exr", ("--strict",), 1),
            ("05_orientation_1.jpg", "05_orientation_6.jpg", (), 1),
            ("02_plain.hdr", "15_old_run_length.hdr", (), 0),
            ("05_plain.png", "12_one_pixel.png",
             ("--mask", case("12_mask_without_it.png"), "--max", "flip=0.001"), 0)):
        done = commands.run("compare", case(a), case(b), *more)
        figures = commands.json("compare", case(a), case(b), *more)
        report.claim(done.returncode == status, f"{a} and {b}: {done.stdout[-200:]}")
        report.claim((figures["differing_pixels"] == 0) == (figures["metrics"]["mae"] == 0),
                     f"{a} and {b}: {figures['differing_pixels']}, {figures['metrics']}")
    lux = [commands.json("sky", "--environment", f"hdri:{case(name)}")["diffuse_horizontal_lx"]
           for name in ("07_latlong.exr", "07_cube_by_its_envmap.exr")]
    report.claim(abs(lux[1] / lux[0] - 1) < 0.01, f"the same sky, equirectangular, cube: {lux}")


def main():
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        commands = Commands(sys.argv[-1], folder)
        for check in (check_light, check_developed, check_orders, check_refused, check_warned,
                      check_windows, check_parts, check_cube, check_pictures,
                      check_orientation, check_masks, check_ignored, check_folders,
                      check_shared):
            check(report, commands)
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
