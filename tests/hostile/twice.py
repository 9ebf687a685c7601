# SPDX-License-Identifier: Apache-2.0
"""twice.py PARHELION [--all] -- what is measured twice is held against itself. Tables of kinds:
a panel's spectra and its tables, a specular measurement and the BRDF, white and its primaries, a
weather file's light and its place, unit and clock, content's shape and what it fills at every
command, a luminaire's intensities and its lumens. Every neighbour that contradicts itself is
refused or warned of in one line that names both; none that is right is.
"""
import json
import math
import os
import re
import struct
import subprocess
import sys
import tempfile
import zlib

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

PANEL = os.path.join(ROOT, "assets/panels/ips_cluster.panel")
APART = re.compile(r"are \S+( in u'v'| %| h)? apart, required: at most")


class Bench:
    def __init__(self, program, folder, report):
        self.program, self.folder, self.report = program, folder, report

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        os.makedirs(os.path.dirname(self.path(name)), exist_ok=True)
        with open(self.path(name), "wb" if isinstance(text, bytes) else "w") as file:
            file.write(text)
        return name

    def run(self, *words):
        done = subprocess.run([self.program, *words], cwd=self.folder, capture_output=True,
                              text=True, timeout=120)
        return done.returncode, done.stdout + done.stderr

    def silent(self, what, found):
        """found: of things that are right."""
        self.report.claim(not found, f"{what}: is right, and {found}")

    def said(self, what, holds, found):
        self.report.claim(holds, f"{what}: must be refused or warned of: {found}")


# ---- a panel's spectra and tables ----------------------------------------------------------

NM = range(380, 781, 5)
XYZ_BELLS = (((1.056, 599.8, 37.9, 31.0), (0.362, 442.0, 16.0, 26.7), (-0.065, 501.1, 20.4, 26.2)),
             ((0.821, 568.8, 46.9, 40.5), (0.286, 530.9, 16.3, 31.1)),
             ((1.217, 437.0, 11.8, 36.0), (0.681, 459.0, 26.0, 13.8)))


def observer(nm):
    """Wyman, Sloan and Shirley (2013): within 0.005 in u'v' of the tables for wide bands."""
    return [sum(a * math.exp(-0.5 * ((nm - m) / (s if nm < m else t)) ** 2)
                for a, m, s, t in bells) for bells in XYZ_BELLS]


def band(peak, fwhm):
    return [math.exp(-4 * math.log(2) * ((nm - peak) / fwhm) ** 2) for nm in NM]


def colour(spectrum, luminance):
    xyz = [sum(s * observer(nm)[j] for nm, s in zip(NM, spectrum)) for j in range(3)]
    return [luminance * x / xyz[1] for x in xyz]


def table(xyz):
    rows = [f"{t},{p}," + ",".join(f"{x * math.cos(math.radians(t)):.6g}" for x in xyz)
            for t in range(0, 71, 10) for p in range(0, 360 if t else 1, 45)]
    return "theta,phi,X,Y,Z\n" + "\n".join(rows) + "\n"


GAMUTS = {"wide": ((630, 30), (530, 35), (455, 22)), "lcd": ((615, 70), (545, 65), (452, 24)),
          "oled": ((622, 45), (527, 42), (462, 28))}
LUMINANCE = (60.0, 200.0, 20.0)


def panels(bench, gamut):
    """Right spectra; all exchanges; columns, wavelengths and whites that are another's."""
    bands = [band(*b) for b in GAMUTS[gamut]]
    black = [0.3, 0.3, 0.3]
    full = [[b + k for b, k in zip(colour(s, y), black)] for s, y in zip(bands, LUMINANCE)]
    names = ("red_255.csv", "green_255.csv", "blue_255.csv")
    for name, xyz in (*zip(names, full), ("black.csv", black)):
        bench.write(f"{gamut}/{name}", table(xyz))
    white = [sum(f[j] for f in full) - 2 * black[j] for j in range(3)]

    def fit(what, columns, wanted, nm=NM, bright=None):
        text = "nm,red,green,blue\n" + "".join(
            f"{n:.6g}," + ",".join(f"{c[i]:.6g}" for c in columns) + "\n"
            for i, n in enumerate(nm))
        spectra = bench.write(f"{gamut}/{what}.spectra", text)
        files = [f"{gamut}/{n}" for n in (*names, "black.csv")]
        if bright:
            files.append(bench.write(f"{gamut}/white_255.csv", table(bright)))
        status, said = bench.run("panel", "import", *files, "--primaries", spectra, "-o",
                                 "set/MANIFEST.json", "--quiet")
        if bright:
            os.remove(bench.path(f"{gamut}/white_255.csv"))
        if status == 3:
            holds = wanted != "right" and "are columns, or tables, exchanged?" in said
            return bench.report.claim(holds, f"{gamut} {what}: {said}")
        status, said = bench.run("panel", "fit", "set/MANIFEST.json", "-o", "p.panel", "--quiet")
        reasons = [line for line in said.splitlines() if line.startswith("reason")]
        if wanted == "right":
            return bench.silent(f"{gamut} {what}", "\n".join(reasons) or (status and said))
        return bench.said(f"{gamut} {what}", wanted == "reason" and status == 0 and
                          any(APART.search(line) for line in reasons), said[:600])

    r, g, b = bands
    grey = [1.0] * len(r)
    fit("right", bands, "right")
    fit("scaled", [[7 * x for x in r], g, [x / 5 for x in b]], "right")
    for k, order in enumerate(((1, 0, 2), (2, 1, 0), (0, 2, 1), (1, 2, 0), (2, 0, 1))):
        fit(f"order{k}", [bands[i] for i in order], "refused")
    fit("shifted", bands, "reason", [n + 20 for n in NM])
    fit("grey red", [grey, g, b], "reason")
    fit("white right", bands, "right", bright=white)
    fit("white dimmed", bands, "reason", bright=[0.8 * x for x in white])
    fit("white tinted", bands, "reason", bright=[1.15 * white[0], white[1], 0.9 * white[2]])


# ---- a specular measurement and the BRDF ---------------------------------------------------

WIDTH_DEG = 1.2


def fresnel(theta):
    c = math.cos(theta)
    t = math.sqrt(1 - (math.sin(theta) / 1.5) ** 2)
    return 0.5 * (((c - 1.5 * t) / (c + 1.5 * t)) ** 2 + ((1.5 * c - t) / (1.5 * c + t)) ** 2)


def reflection(bench, name, mirror, gap_deg=0, width_deg=WIDTH_DEG):
    """Haze, and the mirror's image as wide as the instrument; rows nearer than the gap left out."""
    sigma = math.radians(width_deg) / math.sqrt(8 * math.log(2))
    for incidence in (15, 45):
        ti = math.radians(incidence)
        rows = []
        thetas = sorted({*range(0, 81, 4), *(incidence + 0.5 * k for k in range(-16, 17))})
        for theta in (t for t in thetas if 0 <= t <= 80):
            fine = abs(theta - incidence) < 8
            for phi in sorted({*range(0, 360, 15), *((k % 360 for k in range(-9, 10)) if fine
                                                      else ())}):
                to, p = math.radians(theta), math.radians(phi)
                x, y = (math.sin(to) * math.cos(p) - math.sin(ti), math.sin(to) * math.sin(p))
                dot = math.sin(to) * math.sin(ti) * math.cos(p) + math.cos(to) * math.cos(ti)
                away = math.acos(max(-1, min(1, dot)))
                if math.degrees(away) < gap_deg:
                    continue
                f = 2.0 * fresnel(ti) / 0.04 * (1 + (x * x + y * y) / 0.09 ** 2) ** -1.8 + 1e-3
                f += (mirror * fresnel(ti) / 0.04 * math.exp(-0.5 * (away / sigma) ** 2) /
                      (2 * math.pi * sigma ** 2 * math.cos(ti)))
                rows.append(f"{theta:g},{phi},{f:.7g},{1.02 * f:.7g}")
        bench.write(f"{name}/BRDF_{incidence}.csv", "theta,phi,450nm,550nm\n" + "\n".join(rows) +
                    "\n")


def speculars(bench, is_all):
    """(BRDF, its mirror, the mirror of the specular table, width given, what is right)."""
    kinds = [("with", 0.04, True, "one"), ("with", 0.04, False, "width"),
             ("with", 0.08, True, "two"), ("without", 0.04, False, "mirror"),
             ("without", 0.04, True, "mirror"), ("hole", 0.04, False, "mirror")]
    if is_all:
        kinds += [("with", s, True, "two") for s in (0.01, 0.02, 0.03, 0.05, 0.06, 0.2)]
        kinds += [("with", s, False, "width") for s in (0.035, 0.045, 0.05)]
        kinds += [("without", s, w, "mirror") for s in (0.02, 0.03, 0.05, 0.08)
                  for w in (False, True)]
        kinds += [("hole", s, False, "mirror") for s in (0.02, 0.08)]
    reflection(bench, "with", 0.04)
    reflection(bench, "without", 0)
    reflection(bench, "hole", 0.04, 5)
    for name, mirror, has_width, wanted in kinds:
        rows = "".join(f"{i},{mirror * fresnel(math.radians(i)) / 0.04:.6g}\n" for i in (15, 45))
        table_file = bench.write(f"{name}/specular.table", "incidence,reflectance\n" + rows)
        files = [f"{name}/BRDF_{i}.csv" for i in (15, 45)]
        width = ["--instrument-fwhm", str(WIDTH_DEG)] if has_width else []
        what = f"BRDF {name} the mirror, specular {mirror}, width {has_width}"
        bench.run("panel", "import", *files, "--specular", table_file, *width, "-o",
                  "r/MANIFEST.json", "--quiet")
        status, said = bench.run("panel", "fit", "r/MANIFEST.json", "-o", "r.panel", "--quiet")
        reasons = "\n".join(x for x in said.splitlines() if x.startswith("reason"))
        apart = APART.search(reasons)
        if wanted == "one":
            bench.silent(what, apart and reasons)
            bench.report.claim(status == 0, f"{what}: status {status}")
        if wanted == "two":
            bench.said(what, status == 0 and apart, said[:900])
        if wanted == "width":
            bench.said(what, status == 1 and "--instrument-fwhm" in reasons, said[:900])
        if wanted == "mirror":
            taken = re.search(r"reflectance (\S+) at 15 deg", said)
            near = taken and abs(float(taken.group(1)) / mirror - 1) < 0.1
            bench.report.claim(status == 0 and near and "specular" not in reasons,
                               f"{what}: must be the mirror part: {said[:900]}")


# ---- weather -------------------------------------------------------------------------------

def sun_sine(latitude, longitude, zone, day, hour):
    """Spencer's declination and equation of time: within some minutes, as files are."""
    g = 2 * math.pi * (day - 1) / 365
    declination = (0.006918 - 0.399912 * math.cos(g) + 0.070257 * math.sin(g) -
                   0.006758 * math.cos(2 * g) + 0.000907 * math.sin(2 * g))
    equation_min = 229.18 * (0.000075 + 0.001868 * math.cos(g) - 0.032077 * math.sin(g) -
                             0.014615 * math.cos(2 * g) - 0.04089 * math.sin(2 * g))
    angle = math.radians(15 * (hour - zone - 12) + longitude + equation_min / 4)
    lat = math.radians(latitude)
    return (math.sin(lat) * math.sin(declination) +
            math.cos(lat) * math.cos(declination) * math.cos(angle))


PLACES = {"munich": (48, 11.5, 1), "new york": (40.8, -74, -5), "delhi": (28.6, 77.2, 5.5),
          "sydney": (-33.9, 151.2, 10), "reykjavik": (64.1, -21.9, 0), "quito": (-0.2, -78.5, -5)}


def weather(bench, name, place, said=None, scale=(1, 1, 1), cloud=None, first=(6, 160)):
    """Light of `place`, under the LOCATION `said`; scale: of global, direct and diffuse."""
    latitude, longitude, zone = PLACES[place]
    shown = said or (latitude, longitude, zone)
    lines = [f"LOCATION,{name},-,TST,TEST,0,{shown[0]},{shown[1]},{shown[2]},100",
             "DESIGN CONDITIONS,0", "TYPICAL/EXTREME PERIODS,0", "GROUND TEMPERATURES,0",
             "HOLIDAYS/DAYLIGHT SAVINGS,No,0,0,0", "COMMENTS 1,x", "COMMENTS 2,y",
             "DATA PERIODS,1,1,Data,Sunday,6/9,6/18"]
    for d in range(10):
        for hour in range(1, 25):
            sine = max(0, sun_sine(latitude, longitude, zone, first[1] + d, hour - 0.5))
            clear = (cloud if cloud is not None else 1.0) if d % 3 else 0.3
            direct = 950 * clear * math.exp(-0.13 / sine) if sine > 0.02 else 0
            diffuse = 1361 * sine * (0.1 if clear > 0.5 else 0.22)
            if cloud == 0:
                direct, diffuse = 0, 1361 * sine * 0.2
            cells = [(direct * sine + diffuse) * scale[0], direct * scale[1], diffuse * scale[2]]
            lines.append(f"2001,6,{9 + d},{hour},60,?9?9,20,10,50,101325,0,0,300," +
                         ",".join(f"{x:.5g}" for x in cells) +
                         ",0,0,0,0,180,3,0,0,20,77777,9,999999999,10,0.1,0,88,0.2,0,1")
    return bench.write(f"weather/{name}.epw", "\n".join(lines) + "\n")


def weathers(bench):
    def ask(name, zone, wanted, **more):
        file = weather(bench, name, **more)
        sign = "-" if zone < 0 else "+"
        clock = f"{sign}{int(abs(zone)):02d}:{int(60 * (abs(zone) % 1)):02d}"
        status, said = bench.run("sky", "--weather", file, "--when",
                                 f"2001-06-11T11:30{clock}", "--quiet")
        lines = [x for x in said.splitlines() if "warning" in x or status]
        if wanted is None:
            bench.silent(f"weather {name}", "\n".join(lines))
        else:
            bench.said(f"weather {name}", any(re.search(wanted, x) for x in lines), said[:700])

    for place, (latitude, longitude, zone) in PLACES.items():
        ask(f"{place} right", zone, None, place=place)
        ask(f"{place} overcast", zone, None, place=place, cloud=0)
        ask(f"{place} sign", zone, "longitude|no hour", place=place,
            said=(latitude, -longitude, zone))
        ask(f"{place} zone", zone, "longitude|no hour", place=place,
            said=(latitude, longitude, -zone if abs(zone) > 1 else 4))
    light = "unit|more than the sun|apart|holds at no instant"
    for name, scale in {"kilowatts": (1e-3,) * 3, "kilojoules": (3.6,) * 3,
                        "megajoules": (3.6e-3,) * 3, "langleys": (1 / 11.6,) * 3,
                        "btu": (1 / 3.155,) * 3, "centijoules": (0.36,) * 3, "twice": (2,) * 3,
                        "direct kW": (1, 1e-3, 1), "diffuse kW": (1, 1, 1e-3),
                        "global kW": (1e-3, 1, 1), "direct kJ": (1, 3.6, 1)}.items():
        for place in ("munich", "sydney"):
            zone = PLACES[place][2]
            ask(f"{place} {name}", zone, light, place=place, scale=scale)
    ask("overcast kilowatts", 1, light, place="munich", scale=(1e-3,) * 3, cloud=0)


# ---- content's shape -----------------------------------------------------------------------

def png(width, height, is_flat=False):
    rows = b"".join(b"\0" + b"".join(b"\x10\x20\x30" if is_flat else
                                     bytes(((x * 7) % 256, (y * 11) % 256, (x ^ y) % 256))
                                     for x in range(width)) for y in range(height))

    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data +
                struct.pack(">I", zlib.crc32(kind + data)))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0,
                                                              0, 0)) +
            chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def scene(bench, name, size, content, span=(1, 1), **more):
    w, h = size[0] / 2, size[1] / 2
    data = struct.pack("<12f12f8f6H", -w, -h, 0, w, -h, 0, w, h, 0, -w, h, 0, *(0, 0, 1) * 4, 0,
                       span[1], span[0], span[1], span[0], 0, 0, 0, 0, 1, 2, 0, 2, 3)
    bench.write("shape/p.panel", open(PANEL, "rb").read())
    bench.write("shape/b.bin", data)
    views = ((0, 48), (48, 48), (96, 32), (128, 12))
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0, "name": "n"}, {"camera": 0, "translation": [0, 0, 0.7],
                                             "name": "eye"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2},
                                    "indices": 3, "material": 0}]}],
        "materials": [{"name": "d", "extensions": {"PARHELION_display": {
            "panel": "p.panel", "content": {"index": 0}, **more}}}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
                       "min": [-w, -h, 0], "max": [w, h, 0]},
                      {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC3"},
                      {"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC2"},
                      {"bufferView": 3, "componentType": 5123, "count": 6, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteOffset": a, "byteLength": n} for a, n in views],
        "buffers": [{"uri": "b.bin", "byteLength": len(data)}],
        "images": [{"uri": os.path.basename(content)}], "textures": [{"source": 0}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.01}}],
        "extensionsUsed": ["PARHELION_display"]}
    return bench.write(f"shape/{name}.gltf", json.dumps(document))


def shapes(bench):
    for width, height in ((64, 64), (64, 32), (96, 54), (32, 64), (80, 60)):
        picture = bench.write(f"shape/{width}x{height}.png", png(width, height))
        flat = bench.write(f"shape/flat{width}x{height}.png", png(width, height, True))
        for size in ((0.2, 0.1), (0.1, 0.1), (0.16, 0.09), (0.1, 0.2), (0.12, 0.09)):
            is_one = abs(width / height / (size[0] / size[1]) - 1) < 0.01
            what = f"content of {width} x {height} on {size[0]} x {size[1]} m"
            _, said = bench.run("check", scene(bench, "s", size, picture))
            found = APART.search(said)
            bench.report.claim(bool(found) != is_one, f"{what}: {said[-600:]}")
            if is_one:
                continue
            for name, more in (("any", {"any_size": True}), ("flat", {})):
                _, said = bench.run("check", scene(bench, name, size,
                                                   flat if name == "flat" else picture, **more))
                bench.silent(f"{what}, {name}", APART.search(said) and said)
    _, said = bench.run("check", scene(bench, "half", (0.1, 0.1), "64x32.png", (0.5, 1)))
    bench.silent("half of the content, square", APART.search(said) and said)
    doors(bench)


def doors(bench):
    """One rule, at every command that takes content."""
    scene(bench, "door", (0.2, 0.1), "64x32.png")
    asked = {"scene": ["door.gltf"], "eyes": {"driver": {"camera": "eye"}},
             "symbols": {"s": {"display": "d", "uv": [0.3, 0.3, 0.6, 0.7]}},
             "profile": "iso-15008",
             "conditions": [{"environment": {"type": "constant", "luminance": 50}, "name": "c"}]}
    places = {"symbol": lambda r: r["symbols"]["s"].update(content="64x64.png"),
              "condition": lambda r: r["conditions"][0].update(contents={"d": "64x64.png"}),
              "variant": lambda r: r.update(variants={"v": {"contents": {"d": "64x64.png"}}})}
    for name, change in {"none": lambda r: None, **places}.items():
        asked_now = json.loads(json.dumps(asked))
        change(asked_now)
        bench.write(f"shape/{name}.review.json", json.dumps(asked_now))
    stretched = ["--content", "d=shape/64x64.png"]
    commands = {
        "render": ["render", "shape/door.gltf", *stretched, "--size", "16x9", "--spp", "1", "-o",
                   "shape/x.exr", "--quiet"],
        "explain": ["explain", "shape/door.gltf", *stretched, "--display", "d", "--quiet"],
        "panel show": ["panel", "show", "shape/p.panel", "--content", "shape/64x64.png", "-o",
                       "shape/y.exr", "--quiet"],
        **{f"review --dry-run, a {name}": ["review", f"shape/{name}.review.json", "--dry-run"]
           for name in places}}
    for name, words in commands.items():
        status, said = bench.run(*words)
        bench.said(name, APART.search(said) and status == 0, said[-600:])
    _, said = bench.run("review", "shape/none.review.json", "--dry-run")
    bench.silent("review --dry-run", APART.search(said) and said)


# ---- luminaires ----------------------------------------------------------------------------

def luminaires(bench):
    """100 cd all round below: 2 pi 100 lm, of lamps of `lumens`."""
    for lumens in (-1, 628, 640, 700, 1000, 3000, 9000, 30000):
        ask_luminaire(bench, lumens, None)
    for k in range(10):
        ask_luminaire(bench, 560 / 1.6 ** k, "times the")
        ask_luminaire(bench, 70000 * 1.6 ** k, "apart, required")


def ask_luminaire(bench, lumens, wanted):
    file = bench.write("l.ies", "IESNA:LM-63-2002\n[TEST] t\n[TESTLAB] t\n[ISSUEDATE] t\n"
                       f"[MANUFAC] t\nTILT=NONE\n1 {lumens:g} 1 3 1 1 2 0.1 0.1 0\n1 1 10\n"
                       "0 45 90\n0\n100 100 100\n")
    _, said = bench.run("panel", "import", file, "-o", "l/MANIFEST.json", "--quiet")
    lines = [x for x in said.splitlines() if "required" in x]
    if wanted is None:
        bench.silent(f"a luminaire of {lumens:g} lm", "\n".join(lines))
    else:
        bench.said(f"a luminaire of {lumens:g} lm", any(wanted in x for x in lines), said[:600])


def main(program, is_all):
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(os.path.abspath(program), folder, report)
        for gamut in GAMUTS if is_all else ("wide",):
            panels(bench, gamut)
        speculars(bench, is_all)
        weathers(bench)
        shapes(bench)
        luminaires(bench)
    report.finish()


if __name__ == "__main__":
    main(next(x for x in sys.argv[1:] if x != "--all"), "--all" in sys.argv)
