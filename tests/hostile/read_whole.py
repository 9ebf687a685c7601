# SPDX-License-Identifier: Apache-2.0
"""read_whole.py [--all] PARHELION -- a file is read whole, or what is not read of it is named, and
every door says the same: a table of kinds of input by command. Each kind has some twenty
neighbours, made here; without --all the first of each kind. None is silent: a status and words
are required of each.

Pages of pictures, channels of OpenEXR, alpha and transfer as files state them, headers of
spectra, decimal commas, cameras in degrees, pointers of Git LFS, formats by their names.
"""
import json
import os
import random
import struct
import subprocess
import sys
import tempfile
import zlib

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path[:0] = [os.path.join(ROOT, "tests", "structure"), os.path.join(ROOT, "tests", "image")]
import pictures  # noqa: E402
from gltf import data_uri  # noqa: E402
from report import Report  # noqa: E402

W, H = 8, 4
SHORT = 1  # neighbours of a kind without --all: what needs the libraries for pictures is slow


# ---- files -----------------------------------------------------------------------------------

def codes(seed, channels=3, most=255):
    chance = random.Random(seed)
    return [chance.randrange(1, most + 1) for _ in range(W * H * channels)]


def tiff(pages, end="<", bits=8, channels=3, extra=None, kind=None, packed=False):
    """pages: lists of values; extra: ExtraSamples; kind: NewSubfileType of those behind the
    first."""
    letter = {8: "B", 16: "H", 32: "f"}[bits]
    out = bytearray(struct.pack(end + "2sHI", b"II" if end == "<" else b"MM", 42, 8))
    link = 4
    for number, page in enumerate(pages):
        data = struct.pack(f"{end}{len(page)}{letter}", *page)
        data = zlib.compress(data) if packed else data
        strip, depths = len(out), len(out) + len(data) + len(data) % 2
        out += data + b"\0" * (len(data) % 2) + struct.pack(f"{end}{channels}H", *[bits] * channels)
        at = len(out)
        struct.pack_into(end + "I", out, link, at)
        tags = [(256, 4, 1, W), (257, 4, 1, H),
                (258, 3, channels, depths if channels > 2 else bits),
                (259, 3, 1, 8 if packed else 1), (262, 3, 1, 2 if channels > 2 else 1),
                (273, 4, 1, strip), (277, 3, 1, channels), (278, 4, 1, H), (279, 4, 1, len(data)),
                (339, 3, 1, 3 if bits == 32 else 1)]
        tags += [(338, 3, 1, extra)] if extra is not None else []
        tags += [(254, 4, 1, kind)] if number and kind is not None else []
        out += struct.pack(end + "H", len(tags))
        for tag, of, count, value in sorted(tags):
            short = of == 3 and count == 1
            out += struct.pack(end + ("HHIHxx" if short else "HHII"), tag, of, count, value)
        link = len(out)
        out += struct.pack(end + "I", 0)
    return bytes(out)


def gif(frames, delay=10):
    """Grey levels below 128, as codes of 8 bits that are begun again before they would grow."""
    palette = b"".join(bytes([2 * i] * 3) for i in range(128))
    out = b"GIF89a" + struct.pack("<HHBBB", W, H, 0xf6, 0, 0) + palette
    for frame in frames:
        bits, count = 0, 0
        for i, value in enumerate(frame):
            for code in ([128] if i % 100 == 0 else []) + [value]:
                bits |= code << count
                count += 8
        bits |= 129 << count
        data = bits.to_bytes(count // 8 + 2, "little")
        pieces = [data[i:i + 255] for i in range(0, len(data), 255)]
        out += b"\x21\xf9\x04\0" + struct.pack("<H", delay) + b"\0\0\x2c"
        out += struct.pack("<HHHHB", 0, 0, W, H, 0) + b"\x07"
        out += b"".join(bytes([len(piece)]) + piece for piece in pieces) + b"\0"
    return out + b"\x3b"


def apng(frames, shown=True):
    """shown: whether the picture that stands still is the first of the frames."""
    def part(kind, body):
        return struct.pack(">I", len(body)) + kind + body \
            + struct.pack(">I", zlib.crc32(kind + body))
    out = b"\x89PNG\r\n\x1a\n" + part(b"IHDR", struct.pack(">IIBBBBB", W, H, 8, 2, 0, 0, 0))
    out += part(b"acTL", struct.pack(">II", len(frames) - (not shown), 0))
    order = 0
    for number, frame in enumerate(frames):
        data = zlib.compress(b"".join(b"\0" + bytes(frame[3 * W * y:3 * W * (y + 1)])
                                      for y in range(H)))
        if number or shown:
            out += part(b"fcTL", struct.pack(">IIIIIHHBB", order, W, H, 0, 0, 1, 10, 0, 0))
            order += 1
        out += part(b"fdAT", struct.pack(">I", order) + data) if number else part(b"IDAT", data)
        order += number > 0
    return out + part(b"IEND", b"")


def dpx(values, transfer=0, primaries=0, elements=1, end=">"):
    head = bytearray(2048)
    struct.pack_into(end + "I", head, 0, 0x53445058)
    struct.pack_into(end + "I8sI", head, 4, 2048, b"V1.0", 2048 + len(values))
    struct.pack_into(end + "IIII", head, 20, 1, 1664, 384, 0)
    struct.pack_into(end + "HHII", head, 768, 0, elements, W, H)
    struct.pack_into(end + "IIfIfBBBBHHIII", head, 780, 0, 0, 0, 255, 1, 50, transfer, primaries, 8,
                     0, 0, 2048, 0, 0)
    return bytes(head) + bytes(values)


def tga(values, alpha=False, mark=None, kind=2):
    """mark: the attributes type of TGA 2.0; None: no mark of 2.0."""
    step = 4 if alpha else 3
    body = b"".join(bytes([values[i + 2], values[i + 1], values[i], *values[i + 3:i + step]])
                    for i in range(0, len(values), step))
    out = struct.pack("<BBBHHBHHHHBB", 0, 0, kind, 0, 0, 0, 0, 0, W, H, 8 * step,
                      0x20 | (8 if alpha else 0)) + body
    if mark is None:
        return out
    extension = bytearray(495)
    struct.pack_into("<H", extension, 0, 495)
    extension[494] = mark
    return out + bytes(extension) + struct.pack("<II", len(out), 0) + b"TRUEVISION-XFILE.\0"


def square(material=None, image=None, **more):
    """A square of 1 m before a camera; image: (bytes, media type) of a buffer."""
    place = struct.pack("<12f", -.5, -.5, 0, .5, -.5, 0, .5, .5, 0, -.5, .5, 0)
    blob = place + struct.pack("<8f", 0, 1, 1, 1, 1, 0, 0, 0) + struct.pack("<6H", 0, 1, 2, 0, 2, 3)
    blob += struct.pack("<3f", 1, 2, 3) * 4 + (image[0] if image else b"")
    views = [(0, 48), (48, 32), (80, 12), (92, 48)] + ([(140, len(image[0]))] if image else [])
    scene = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
             "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0, 0, 2]}],
             "cameras": [{"type": "orthographic", "orthographic":
                          {"xmag": .5, "ymag": .5, "znear": .1, "zfar": 10}}],
             "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1},
                                         "indices": 2, "material": 0}]}],
             "materials": [material or {"emissiveFactor": [1, 1, 1]}],
             "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
                            "min": [-.5, -.5, 0], "max": [.5, .5, 0]},
                           {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"},
                           {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"},
                           {"bufferView": 3, "componentType": 5126, "count": 3, "type": "SCALAR"}],
             "bufferViews": [{"buffer": 0, "byteOffset": at, "byteLength": size}
                             for at, size in views],
             "buffers": [{"byteLength": len(blob),
                          "uri": data_uri("application/octet-stream", blob)}]}
    if image:
        scene["images"] = [{"bufferView": 4, "mimeType": image[1]}]
        scene["textures"] = [{"source": 0}]
        scene["materials"] = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]
    scene.update(more)
    return scene


def spectral(header, row, slot="baseColor"):
    rows = "".join(row.format(nm) + "\n" for nm in range(380, 781, 50))
    material = {"extensions": {"PARHELION_spectrum": {slot: "s.csv"}}}
    return {"s.csv": f"{header}\n{rows}",
            "s.gltf": square(material, extensionsUsed=["PARHELION_spectrum"])}


# ---- the bench -------------------------------------------------------------------------------

class Bench:
    def __init__(self, report, program, folder):
        self.report, self.program, self.folder = report, os.path.abspath(program), folder

    def write(self, files):
        for name, data in files.items():
            path = os.path.join(self.folder, name)
            data = json.dumps(data) if isinstance(data, dict) else data
            with open(path, "wb") as out:
                out.write(data if isinstance(data, bytes) else data.encode())

    def says(self, kind, status, words, *command):
        """One line of the table: the command on the files as they stand."""
        done = subprocess.run([self.program, *command], cwd=self.folder, capture_output=True,
                              text=True, errors="replace", check=False)
        text = done.stdout + done.stderr
        ok = done.returncode == status and words in text
        self.report.claim(ok, f"{kind}: {' '.join(command)}: {done.returncode} for {status}, "
                              f"\"{words}\" in\n{text[-700:]}")
        return text


def some(all_of_them, bench):
    return list(all_of_them) if bench.is_all else list(all_of_them)[:SHORT]


# ---- kinds -----------------------------------------------------------------------------------

def pages(bench):
    """Of each file a pair that differs behind the first page alone, and the page alone."""
    a, b, c = codes(1), codes(2), codes(3)
    low = [[v % 128 for v in codes(i, 1)] for i in range(5)]
    floats = [[v / 7 for v in codes(i)] for i in range(3)]
    kinds = [("png", apng([a, b]), apng([a, c]), None),
             ("tif", tiff([a, b]), tiff([a, c]), tiff([a])),
             ("gif", gif(low[:2]), gif([low[0], low[2]]), gif(low[:1]))]
    kinds += [("tif", tiff([a] + [b] * n, end), tiff([a] + [b] * (n - 1) + [c], end),
               tiff([a], end)) for n in (2, 3, 7) for end in "<>"]
    kinds += [("tif", tiff([codes(1, most=m), codes(2, most=m)], bits=16),
               tiff([codes(1, most=m), codes(3, most=m)], bits=16), None) for m in (300, 65535)]
    kinds += [("tif", tiff([a, b], packed=True), tiff([a, c], packed=True), None)]
    kinds += [("tif", tiff(floats[:2], bits=32), tiff(floats[::2], bits=32), None)]
    kinds += [("gif", gif(low[:n]), gif([*low[:n - 1], low[4]]), None) for n in (3, 4)]
    kinds += [("gif", gif(low[:2], 10), gif(low[:1] + low[3:4], 20), None)]
    ppm = [b"P6\n# a\n%d %d\n255\n" % (W, H) + bytes(page) for page in (a, b, c)]
    kinds += [("ppm", b"".join(ppm[:2]), ppm[0] + ppm[2], None),
              ("ppm", b"".join(ppm), ppm[0] + ppm[2] + ppm[1], None)]
    kinds += [("png", apng([a, b, c][:n], shown), apng([a, c, b][:n], shown), None)
              for n in (2, 3) for shown in (False, True)]
    for ending, one, other, alone in some(kinds, bench):
        name, second = f"a.{ending}", f"b.{ending}"
        bench.write({name: one, second: other})
        bench.says("pages", 1, "behind the first differ", "compare", name, second)
        bench.says("pages", 1, "behind the first differ", "compare", name, second, "--max",
                   "flip=1")
        if alone:
            bench.write({second: alone})
            bench.says("pages", 1, "differ: 2 in the" if ending != "tif" else "in the reference",
                       "compare", name, second, "--strict")
        bench.says("pages", 0, "the others are the same bytes", "compare", name, name)
        bench.says("pages", 3, "required: one picture that stands still", "compare", "plain.png",
                   "plain.png", "--mask", name)
        bench.write({"s.gltf": square(image=(one, "image/png"))})
        bench.says("pages", 3, "required: one picture that stands still", "check", "s.gltf")
    bench.write({"a.tif": tiff([a, b], kind=1), "b.tif": tiff([a, c], kind=1)})
    bench.says("a TIFF's smaller copy", 0, "equal in every pixel", "compare", "a.tif", "b.tif")


def channels(bench):
    """What is beside R, G and B of an OpenEXR file, and X, Y, Z in their place."""
    rgb = {name: [v / 3 for v in codes(i, 1)] for i, name in enumerate("RGB")}
    xyz = {name: [v / 3 for v in codes(i, 1)] for i, name in enumerate("XYZ")}
    to709 = ((3.2404542, -1.5371385, -.4985314), (-.969266, 1.8760108, .041556),
             (.0556434, -.2040259, 1.0572252))
    same = {name: [sum(m * xyz[c][i] for m, c in zip(row, "XYZ")) for i in range(W * H)]
            for name, row in zip("RGB", to709)}
    pictures.write_exr(os.path.join(bench.folder, "xyz.exr"), W, H, xyz)
    pictures.write_exr(os.path.join(bench.folder, "709.exr"), W, H, same)
    bench.says("X, Y, Z", 0, "within limits: ", "compare", "xyz.exr", "709.exr", "--max",
               "deltae_max=0.1")
    sums = [sum(xyz[c]) for c in "XYZ"]
    text = bench.says("X, Y, Z", 0, "luminance", "measure", "xyz.exr")
    found = [float(line.split()[1]) for line in text.split("\n") if line[:2] in ("x ", "y ")]
    bench.report.claim(max(abs(f - s / sum(sums)) for f, s in zip(found, sums)) < 1e-3,
                       f"X, Y, Z: {found} for {sums}")
    skies = [[float(line.split()[-2]) for line in
              bench.says("X, Y, Z", 0, "lx", "sky", "--environment", f"hdri:{name}.exr").split("\n")
              if line.endswith((" lx", " cd/m²"))] for name in ("xyz", "709")]
    bench.report.claim(len(skies[0]) > 2 and
                       all(abs(a / b - 1) < 2e-3 for a, b in zip(*skies, strict=True)),
                       f"X, Y, Z: {skies}")
    pictures.write_exr(os.path.join(bench.folder, "b.exr"), W, H,
                       {**xyz, "Z": [3 * v for v in xyz["Z"]]})
    bench.says("Z three times", 1, "deltae_max ", "compare", "xyz.exr", "b.exr", "--max",
               "deltae_max=1")
    beside = ["right.R", "Z", "A", "left.G", "depth.Z", "id", "Y", "right.Z", "diffuse.B", "u.V",
              "normal.X", "alpha", "rightEye.R", "ObjectID", "mask", "view2.R", "specular.R",
              "motion.X", "crypto00.r", "N"]
    for name in some(beside, bench):
        pictures.write_exr(os.path.join(bench.folder, "a.exr"), W, H, {**rgb, name: rgb["R"]})
        pictures.write_exr(os.path.join(bench.folder, "b.exr"), W, H,
                           {**rgb, name: [2 * v for v in rgb["R"]]})
        for limit in ("flip=1", "deltae_mean=100", "mse=1e9")[:3 if bench.is_all else 1]:
            bench.says("a channel beside", 1, f"channels differ that no figure is of: {name} ",
                       "compare", "a.exr", "b.exr", "--max", limit)
        bench.says("a channel beside", 0, "same", "compare", "a.exr", "a.exr", "--max", "flip=1")
        bench.says("a channel beside", 0, "same", "compare", "a.exr", "b.exr", "--max", "flip=1",
                   "--ignore", name)
    views = {"multiView": ("stringvector", struct.pack("<i", 4) + b"left" + struct.pack("<i", 5)
                           + b"right")}
    pictures.write_exr(os.path.join(bench.folder, "a.exr"), W, H, {**rgb, "right.R": rgb["G"]},
                       views)
    bench.says("views", 0, "has several views", "measure", "a.exr")
    pictures.write_exr(os.path.join(bench.folder, "a.exr"), W, H,
                       {"Y": rgb["R"], "RY": rgb["G"], "BY": rgb["B"]})
    for command in (["compare", "a.exr", "a.exr"], ["measure", "a.exr"],
                    ["sky", "--environment", "hdri:a.exr"]):
        bench.says("luminance and chroma", 3, "luminance and chroma (Y, RY, BY)", *command)


def packed(bench):
    pictures.write_exr(os.path.join(bench.folder, "a.exr"), W, H, {"Y": [1.0] * W * H})
    with open(os.path.join(bench.folder, "a.exr"), "rb") as file:
        data = file.read()
    at = data.index(b"compression\0compression\0") + 28
    for kind in some(range(10, 32), bench):
        bench.write({"b.exr": data[:at] + bytes([kind]) + data[at + 1:]})
        for command in (["compare", "a.exr", "b.exr"], ["measure", "b.exr"],
                        ["develop", "b.exr", "-o", "x.png"],
                        ["sky", "--environment", "hdri:b.exr"])[:4 if bench.is_all else 2]:
            bench.says("a newer compression", 3, "newer than the library", *command)


def alpha(bench):
    """Colours times alpha, as the file says; the same codes beside alpha; what they stand for."""
    for seed in some(range(20), bench):
        chance = random.Random(seed)
        straight, times, bits = [], [], (8, 16)[seed % 3 == 2]
        full = 2 ** bits - 1
        for _ in range(W * H):
            share = chance.choice((64, 128, 200, 255)) * full // 255
            own = [chance.randrange(share + 1) for _ in range(3)]
            times += own + [share]
            straight += [round(v * full / share) for v in own] + [share]
        as_tga = bits == 8 and seed % 2 == 1
        name = "a.tga" if as_tga else "a.tif"
        bench.write({name: tga(times, True, 4) if as_tga else
                     tiff([times], "<>"[seed % 2], bits, 4, 1, packed=seed % 4 == 0)})
        pictures.write_png(os.path.join(bench.folder, "b.png"), W, H, straight, bits, 4)
        pictures.write_png(os.path.join(bench.folder, "c.png"), W, H, times, bits, 4)
        bench.says("associated alpha", 0, "same: ", "compare", name, "b.png", "--max",
                   "max_difference=0.004")
        bench.says("associated alpha", 1, "pixels differ", "compare", name, "c.png")
        bench.write({name: tga(times, True, 3) if as_tga else tiff([times], bits=bits, channels=4,
                                                                  extra=2)})
        bench.says("straight alpha", 0, "equal in every pixel", "compare", name, "c.png")
    solid = [255, 255, 255] * W * H
    for hole in some(range(20), bench):
        values = [v for i in range(W * H) for v in (255, 255, 255, 0 if i == hole else 255)]
        pictures.write_png(os.path.join(bench.folder, "m.png"), W, H, values, channels=4)
        bench.says("a mask with a hole in alpha", 3, "required: black and white without alpha",
                   "compare", "plain.png", "plain.png", "--mask", "m.png")
    pictures.write_png(os.path.join(bench.folder, "m.png"), W, H, solid)
    bench.says("a mask", 0, "same", "compare", "plain.png", "plain.png", "--mask", "m.png")
    for seed in some(range(20), bench):
        light = [10.0 ** (i % 5 - 2) * (1 + seed) for i in range(W * H)]
        pictures.write_exr(os.path.join(bench.folder, "a.exr"), W, H, dict.fromkeys("RGB", light))
        bench.says("a mask", 0, "", "develop", "a.exr", "-o", "m.jpg")
        bench.says("a mask that is a JPEG", 3, "the mask is a JPEG", "compare", "plain.png",
                   "plain.png", "--mask", "m.jpg")
    bench.write({"a.tif": tiff([codes(1, 5)], channels=5, extra=0)})
    bench.says("channels besides alpha", 3, "channels besides alpha", "compare", "a.tif", "a.tif")


def transfers(bench):
    said = {2: " (linear)", 6: " (BT.709)"}
    values = codes(5)
    bench.write({"plain.dpx": dpx(values)})
    for transfer in some([2, 3, 1, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 30, 200, 254], bench):
        for end in "><"[:2 if bench.is_all else 1]:
            bench.write({"a.dpx": dpx(values, transfer, 6, end=end)})
            is_read = transfer in (2, 5, 6, 7, 8, 9, 10)
            words = f"states DPX transfer {transfer}{said.get(transfer, '')}"
            bench.says("DPX", 1, words if is_read else "is not read (DPX transfer", "compare",
                       "plain.dpx", "a.dpx")
            bench.says("DPX", 0, "same" if is_read else "both state the same", "compare", "a.dpx",
                       "a.dpx")
    for transfer in some([0, 4, 255], bench):
        bench.write({"a.dpx": dpx(values, transfer)})
        bench.says("DPX", 0, "equal in every pixel", "compare", "plain.dpx", "a.dpx")
    bench.write({"a.dpx": dpx(values, elements=2)})
    bench.says("DPX", 3, "holds 2 elements", "compare", "plain.png", "plain.png", "--mask", "a.dpx")


def targa(bench):
    rows = [1 + i % 3 for i in range(W * H)]
    heads = {"a table of colours": (1, 1, 4, 24, 8, bytes(12) + bytes(rows)),
             "a packed table": (1, 9, 4, 24, 8, bytes(12) + b"\x87\1" * H),
             "16 bits": (0, 2, 0, 0, 16, bytes(2 * W * H)), "greys": (0, 3, 0, 0, 8, bytes(rows)),
             "packed colours": (0, 10, 0, 0, 24, b"\x87\1\2\3" * H),
             "packed greys": (0, 11, 0, 0, 8, b"\x87\1" * H)}
    for what, (mapped, kind, length, size, depth, body) in some(heads.items(), bench):
        made = struct.pack("<BBBHHBHHHHBB", 0, mapped, kind, 0, length, size, 0, 0, W, H, depth,
                           0x20) + body
        bench.write({"s.gltf": square(image=(made, "image/x-tga"))})
        bench.says(f"TGA in a buffer, {what}", 0, "ok: 0 errors", "check", "s.gltf")
    for seed in some(range(20), bench):
        made = tga(codes(seed, 3 + seed % 2), seed % 2 == 1, None if seed % 4 < 2 else 3)
        bench.write({"s.gltf": square(image=(made, "image/x-tga")), "a.tga": made, "b.bin": made})
        bench.says("TGA in a buffer", 0, "ok: 0 errors", "check", "s.gltf")
        bench.says("TGA by its head", 0, "same", "compare", "a.tga", "b.bin")


def spectra(bench):
    """check and the glasses of a review read them at one place; what values become:
    tests/unit/test_spectrum.c."""
    refused = ["absorbance", "Abs", "A", "OD", "optical density", "eps1", "T (dB)", "log T", "n",
               "k", "alpha (cm-1)", "absorptance %", "counts", "photons", "transmission loss",
               "R (x1000)", "radiance (W/m2/sr/nm)", "extinction coefficient", "ppm (ppm)", "5 %"]
    taken = ["%R", "R (%)", "T [%]", "R {%}", "R <%>", "reflectance/%", "percent", "R in percent",
             "pct", "R (0-100)", "R_percent", "Reflectance, %", "%T", "R%", "[%]", "(R) %",
             "R (percent)", "R per cent", "R [%] SCI", "% reflectance"]
    for word in some(refused, bench):
        bench.write(spectral(f"nm,{word}", "{},0.3"))
        bench.says("a header", 3, "its header", "check", "s.gltf")
        bench.says("a header", 3, "its header", "check", "--strict", "s.gltf")
    for word in some(taken, bench):
        comma = ";" if "," in word else ","
        bench.write(spectral(f"nm{comma}{word}", "{}" + comma + "80"))
        bench.says("percent", 0, "ok: 0 errors", "check", "s.gltf")
    for word in some(["um", "\u00b5m", "micron", "wavelength (um)", "wavelength [\u03bcm]"], bench):
        bench.write(spectral(f"{word},R", "{},0.3"))
        bench.says("nm said to be um", 3, "holds wavelengths from 380000", "check", "s.gltf")
    for unit in ("furlongs", "zz"):
        bench.write(spectral(f"nm,R ({unit})", "{},0.3"))
        bench.says("a unit that is not known", 0, f"the unit ({unit})", "check", "s.gltf")
    for order in some(["eps1,eps2", "e1,e2", "Re(eps),Im(eps)", "R,T", "n (%),k (%)"], bench):
        bench.write(spectral(f"nm,{order}", "{},2,3", "conductor"))
        bench.says("no index", 3, "its header", "check", "s.gltf")


def cameras(bench):
    angles = [3.14159265358979, 3.2, 40, 10, 25, 30, 35, 45, 50, 55, 60, 65, 70, 75, 80, 90, 100,
              120, 150, 180]
    for angle in some(angles, bench):
        eye = {"type": "perspective", "perspective": {"yfov": angle, "znear": .1}}
        bench.write({"s.gltf": square(cameras=[eye])})
        bench.says("a camera in degrees", 3, "glTF's angles are radians", "check", "s.gltf")
        bench.says("a camera in degrees", 3, "glTF's angles are radians", "render", "s.gltf", "-o",
                   "x.exr")


def instances(bench):
    names = ["_ID", "_COLOR_0", "_FEATURE_ID_0", *(f"_OWN{i}" for i in range(17))]
    for name in some(names, bench):
        scene = square(extensionsUsed=["EXT_mesh_gpu_instancing"])
        scene["nodes"][0]["extensions"] = {"EXT_mesh_gpu_instancing": {"attributes": {name: 3}}}
        bench.write({"s.gltf": scene})
        bench.says("instances without a place", 0, "\"triangles\": 2,", "check", "s.gltf", "--json")


def points(bench):
    bench.write({"s.gltf": square()})
    rows = ["0,5 0,5 0,7", "0;5,0;5,0;7", "0,5;0,5;0,7", "1,5 2,5 3,5", "0 0 0,5 0 1",
            "1.5 0,5 0 0 1", "0,0 0,0 0,1", "-0,5 0,5 0,7", "0\t0,5 0 0 1", "0,5\t0,5\t0,7",
            "1 2,3 4,5 6", "0 0 0 0 0,1",
            "0,1 0 0 0 1", "0,5 ,0 0,7 1", "1,2,3 4,5,6", "1,2,3;4,5,6", "0; 5,0; 5,0; 7",
            " 0,5 0,5 0,7 ", "0,5 0,5 0,7 # a", "1e3,5 0,5 0,7"]
    for row in some(rows, bench):
        bench.write({"p.txt": row + "\n"})
        bench.says("decimal commas", 3, "has commas, and others between", "measure",
                   "--illuminance", "p.txt", "s.gltf")
    for row in some(["0 0 1 0 0 1", "0,0,1,0,0,1", "0, 0, 1, 0, 0, 1", "0;0;1;0;0;1"], bench):
        bench.write({"p.txt": row + "\n"})
        bench.says("points", 0, "lx", "measure", "--illuminance", "p.txt", "s.gltf")


IES = ("IESNA:LM-63-2002\nTILT=NONE\n1 1000 1 2 1 1 2 .1 .1 0\n1 1 10\n0 90\n0\n100 0\n")


def names(bench):
    bench.write({"l.ies": IES})
    for name in some(["a=b", "=", "a=", "=b", "a==b", "x=1", "k=v=w", "a = b", "lamp=5",
                      "\u00e4=\u00f6", "a=b=c=d", "1=2", "l.ies=l", "==", "a=.5", "key=[1]", "p=50",
                      "left=right",
                      "n=1.5", "q=?"], bench):
        if name.startswith("="):
            continue  # no name before the first sign
        bench.write({"s.gltf": {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
                                "nodes": [{"name": name}]}})
        bench.says("a name with =", 0, "0 errors", "check", "s.gltf", "--light", f"{name}=l.ies")
        bench.says("a name with =", 0, "0 errors", "check", "s.gltf", "--light", f"{name}=l.ies",
                   "--light-level", f"{name}=50", "--light-cct", f"{name}=3000")


def pointers(bench):
    """The same line wherever a file is read."""
    text = "version https://git-lfs.github.com/spec/v1\noid sha256:" + "0" * 64 + "\nsize 12345\n"
    said = "git lfs pull"
    bench.write({name: text for name in ("p.png", "p.exr", "p.gltf", "p.glb", "p.ies", "p.csv",
                                         "p.txt", "p.json", "p.epw", "p.hdr", "p.bin", "p.ocio",
                                         "p.panel", "p.vert", "p.tif")})
    mesh = square()
    mesh["buffers"] = [{"byteLength": 140, "uri": "p.bin"}]
    bench.write({"mesh.gltf": mesh, "s.gltf": square(), "tex.gltf": square(
        {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}, images=[{"uri": "p.png"}],
        textures=[{"source": 0}]), "spec.gltf": square(
            {"extensions": {"PARHELION_spectrum": {"baseColor": "p.csv"}}},
            extensionsUsed=["PARHELION_spectrum"])})
    pictures.write_exr(os.path.join(bench.folder, "a.exr"), W, H, {"Y": [1.0] * W * H})
    doors = [["compare", "p.png", "plain.png"], ["check", "p.gltf"],
             ["compare", "plain.png", "p.tif"], ["measure", "p.exr"],
             ["develop", "p.exr", "-o", "x.png"], ["check", "p.glb"],
             ["check", "mesh.gltf"], ["check", "tex.gltf"], ["check", "spec.gltf"],
             ["check", "s.gltf", "--light", "a=p.ies"],
             ["measure", "--illuminance", "p.txt", "s.gltf"],
             ["compare", "plain.png", "plain.png", "--mask", "p.png"],
             ["compare", ".", ".", "--pairs", "p.txt"], ["sky", "--environment", "hdri:p.hdr"],
             ["sky", "--weather", "p.epw", "--when", "2001-06-21T11:30+01:00"],
             ["review", "p.json", "-o", "out"], ["panel", "import", "p.csv", "-o", "set"],
             ["panel", "import", "p.ies", "-o", "set"], ["panel", "info", "p.panel"],
             ["develop", "a.exr", "--config", "p.ocio", "-o", "x.png"],
             ["merge", "p.exr", "-o", "x.exr"]]
    for door in doors if bench.is_all else doors[:10]:
        bench.says("a pointer of Git LFS", 3, said, *door)


def foreign(bench):
    bench.write({"s.gltf": square()})
    for i, text in some(enumerate([
            f'<?xml version="1.0"?>{gap}<{name}{more}>\n</{name}>\n' for name in
            ("IESTM33-18", "IESTM33-22", "IESTM33") for gap in ("\n", "", "\n<!-- x -->\n")
            for more in (' xmlns="http://www.ies.org/tm33-18"', "")]), bench):
        for ending in ("xml", "ies", "ldt"):
            bench.write({f"t.{ending}": text})
            bench.says(f"TM-33 {i}", 3, "IES TM-33 (XML), required", "check", "s.gltf", "--light",
                       f"a=t.{ending}")
            bench.says(f"TM-33 {i}", 3, "IES TM-33 (XML), required", "panel", "import",
                       f"t.{ending}", "-o", "set")
    pictures.write_exr(os.path.join(bench.folder, "a.exr"), W, H, {"Y": [1.0] * W * H})
    for name in ("c.ocioz", "c.ocio", "c"):
        bench.write({name: b"PK\x03\x04" + bytes(40)})
        bench.says("an archive", 3, "unpack it", "develop", "a.exr", "--config", name, "-o",
                   "x.png")
    for mark in (b"\xef\xbb\xbf", b""):
        bench.write({"pairs.txt": mark + b"plain.png --max flip=0.5\n"})
        for side in ("old", "new"):
            os.makedirs(os.path.join(bench.folder, side), exist_ok=True)
            pictures.write_png(os.path.join(bench.folder, side, "plain.png"), W, H, codes(9))
        bench.says("a byte order mark", 0, "1 of 1 pairs", "compare", "old", "new", "--pairs",
                   "pairs.txt")


def main():
    report, is_all = Report(), "--all" in sys.argv
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(report, sys.argv[-1], folder)
        bench.is_all = is_all
        pictures.write_png(os.path.join(folder, "plain.png"), W, H, codes(9))
        for kind in (pages, channels, packed, alpha, transfers, targa, spectra, cameras, instances,
                     points, names, pointers, foreign):
            kind(bench)
    report.finish()


if __name__ == "__main__":
    main()
