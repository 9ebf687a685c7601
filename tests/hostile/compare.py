# SPDX-License-Identifier: Apache-2.0
"""compare.py PARHELION -- `parhelion compare` as scripts use it: statuses, messages, JSON,
JUnit, folders, every kind of picture, and what must fail whatever the limits are.
"""
import html
import json
import math
import os
import random
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

from mutate import sound_scene

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
sys.path.insert(0, os.path.join(ROOT, "tests", "image"))
import pictures  # noqa: E402
from report import Report  # noqa: E402

WIDTH, HEIGHT = 24, 16
PIXELS = WIDTH * HEIGHT
NAN = math.nan
NEGATIVE_ZERO = re.compile(r"(?<![\w.])-0(\.0*)?(?![\w.])")


def positive_zero(text):
    if float(text) == 0 and text.startswith("-"):
        raise ValueError("-0 in an answer")
    return int(text) if text.lstrip("-").isdigit() else float(text)


class Compare:
    def __init__(self, path, folder):
        self.path, self.folder = os.path.abspath(path), folder

    def file(self, *names):
        path = os.path.join(self.folder, *names)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        return path

    def run(self, *arguments):
        return subprocess.run([self.path, *arguments], capture_output=True, text=True,
                              timeout=120, cwd=self.folder)

    def compare(self, *arguments):
        return self.run("compare", *arguments)

    def json(self, *arguments):
        done = self.compare(*arguments, "--json")
        return done.returncode, json.loads(done.stdout, parse_float=positive_zero,
                                           parse_int=positive_zero)

    def frame(self, name, change=None, attributes=None, **more):
        """A frame of light that rises to the right; change(channels) alters it."""
        light = [10.0 + i % WIDTH for i in range(PIXELS)]
        channels = {"R": light, "G": [0.5 * v for v in light], "B": [0.25 * v for v in light],
                    "display.emitted.R": [NAN if i % WIDTH < 6 else 3.0 for i in range(PIXELS)],
                    "samples.N": [16] * PIXELS}
        if change:
            change(channels)
        plain = {"parhelion:unit": pictures.text("cd/m2"),
                 "parhelion:camera": pictures.text("eye"),
                 "parhelion:seed": pictures.text("1"),
                 "parhelion:samples": pictures.text("0:16"), **(attributes or {})}
        pictures.write_exr(self.file(name), WIDTH, HEIGHT, channels,
                           {key: value for key, value in plain.items() if value}, **more)

    def png(self, name, change=0, bits=8, **more):
        codes = [(i * 7) % 200 * (1 if bits == 8 else 257) for i in range(3 * PIXELS)]
        codes[100] += change
        pictures.write_png(self.file(name), WIDTH, HEIGHT, codes, bits, **more)


def put(name, index, value):
    def change(channels):
        channels[name] = list(channels[name])
        channels[name][index] = value
    return change


def told(report, done, status, *words):
    """An answer: the verdict on stdout, nothing on stderr."""
    arguments = " ".join(os.path.basename(word) for word in done.args[2:])
    report.claim(not NEGATIVE_ZERO.search(done.stdout), f"compare {arguments}: -0 is said")
    report.claim(done.returncode == status and not done.stderr
                 and all(word in done.stdout for word in words),
                 f"compare {arguments}: status {done.returncode} instead of {status}, or "
                 f"without {words}: {done.stdout[-300:]} {done.stderr[:300]}")


def refused(report, done, status, *words):
    """A failure: one line on stderr, nothing on stdout."""
    lines = done.stderr.splitlines()
    arguments = " ".join(os.path.basename(word) for word in done.args[2:])
    report.claim(done.returncode == status and len(lines) == 1 and not done.stdout
                 and lines[0].startswith("parhelion: ") and all(w in lines[0] for w in words),
                 f"compare {arguments}: status {done.returncode} instead of {status}, or not "
                 f"one line with {words}: {done.stderr.strip()[:300]} {done.stdout[:100]}")


# ---- frames ----------------------------------------------------------------------------------

def check_frames(report, program):
    program.frame("a.exr")
    told(report, program.compare("a.exr", "a.exr"), 0, "same: A: equal in every pixel")
    program.frame("b.exr", put("G", 30, 99.0))
    told(report, program.compare("a.exr", "b.exr"), 1, "different: B: 1 of 384 pixels differs, "
         "pixel 6,1: 9.41, now 74.5 cd/m2", "--max flip=0.05")
    told(report, program.compare("a.exr", "b.exr", "--max", "mean_shift=0.5"), 0,
         "within limits: B: ", "Within limits: mean_shift")
    told(report, program.compare("a.exr", "b.exr", "--max", "max_difference=1"), 1,
         "Beyond limits: max_difference")
    told(report, program.compare("a.exr", "b.exr", "--min", "psnr=99"), 1, "psnr ")
    told(report, program.compare("a.exr", "b.exr", "--region", "0,0,4,1"), 0)


def check_itself(report, program):
    """Of a frame beside itself no figure differs, however bright a part of it is."""
    for stops in (0, 2, 3, 6, 12):
        program.frame("self.exr", times(2 ** stops, 2 ** stops, 2 ** stops, lambda x, y: x < 3))
        done = program.compare("self.exr", "self.exr", "--json")
        answer = json.loads(done.stdout)
        equal = {"ssim": 1, "psnr": None, "mean_shift": 0, "deltae_mean": 0, "deltae_max": 0}
        found = {key: answer["metrics"][key] for key in equal}
        report.claim(done.returncode == 0 and answer["outcome"] == "same" and found == equal,
                     f"a part {stops} stops brighter, beside itself: {found}")


def check_structure(report, program):
    """What differs whatever the limits are."""
    loose = ("--max", "differing=1")
    program.frame("camera.exr", attributes={"parhelion:camera": pictures.text("other")})
    told(report, program.compare("a.exr", "camera.exr", *loose), 1, "camera (eye, now other)")
    program.frame("seed.exr", attributes={"parhelion:seed": pictures.text("2")})
    told(report, program.compare("a.exr", "seed.exr"), 0, "note  other metadata: seed (1, now 2)")
    told(report, program.compare("a.exr", "seed.exr", "--strict"), 1, "(--strict)")
    program.frame("layer.exr", lambda c: c.update({"depth.Z": c["R"]}))
    told(report, program.compare("a.exr", "layer.exr", *loose), 0,
         "note  layers that are not compared: only the test has depth\n")
    told(report, program.compare("a.exr", "layer.exr", "--strict"), 1, "has depth (--strict)")
    told(report, program.compare("layer.exr", "a.exr", "--ignore", "depth", "--strict"), 0)
    pictures.write_exr(program.file("small.exr"), 2, 2, {c: [1.0] * 4 for c in "RGB"})
    told(report, program.compare("a.exr", "small.exr", *loose), 1,
         "different: Small: other size: 24 x 16 pixels, now 2 x 2")
    for name, box in (("left.exr", (0, 0, 12, 16)), ("right.exr", (12, 0, 24, 16))):
        pictures.write_exr(program.file(name), WIDTH, HEIGHT,
                           {c: [1.0] * 192 for c in "RGB"}, data=box)
    told(report, program.compare("left.exr", "right.exr", *loose), 1, "other data window")


def check_contrast(report, program):
    """What a display lost leads the answer, before the figures of pixels."""
    def shows(reflected):
        def change(channels):
            for c in "RGB":
                channels.update({f"display.{name}.{c}": [value] * PIXELS for name, value in (
                    ("emitted", 100.0), ("white", 100.0), ("black", 0.0),
                    ("reflected", reflected))})
                channels[c] = [100.0 + reflected] * PIXELS
            channels["id.display"] = [0] * PIXELS
        return change
    named = {"parhelion:display.0": pictures.text("cluster")}
    program.frame("clear.exr", shows(10.0), named)
    program.frame("washed.exr", shows(25.0), named)
    done = program.compare("clear.exr", "washed.exr", "--report", "washed.html")
    told(report, done, 1,
         "different: Washed: 14 % brighter, everywhere. Contrast of cluster 11 : 1, now 5 : 1 "
         "(-54.5 %)")
    lines = done.stdout.splitlines()
    report.claim(columns_of(lines[1]) == ["contrast of cluster", "11 : 1, now 5 : 1 (-54.5 %)"],
                 f"the first row is {lines[1]}")
    with open(program.file("washed.html"), encoding="utf-8") as file:
        page = file.read()
    report.claim(page.index("-54.5 %</b><span>contrast of cluster")
                 < page.index("FLIP, mean"),
                 "contrast does not lead the report")


def check_numbers(report, program):
    """NaN against NaN fails in light; off displays it must stand at the same places."""
    loose = ("--max", "differing=1")
    program.frame("nan.exr", put("R", 5, NAN))
    for pair in (("nan.exr", "nan.exr"), ("a.exr", "nan.exr")):
        told(report, program.compare(*pair, *loose), 1, "channel R has 1 values", "pixel 5,0")
    told(report, program.compare("nan.exr", "nan.exr", "--region", "6,0,24,16"), 0,
         "that do not count")
    program.frame("rim.exr", put("display.emitted.R", 5, 3.0))
    told(report, program.compare("a.exr", "rim.exr", *loose), 1, "on one side only")
    other = {"parhelion:seed": pictures.text("2")}
    program.frame("rim2.exr", put("display.emitted.R", 5, 3.0), other)
    told(report, program.compare("a.exr", "rim2.exr", *loose), 0)
    area = [row * WIDTH + column for row in (4, 5, 6) for column in (1, 2, 3)]
    program.frame("area.exr", lambda c: c.update({"display.emitted.R": [
        3.0 if i in area else v for i, v in enumerate(c["display.emitted.R"])]}), other)
    told(report, program.compare("a.exr", "area.exr", *loose), 1, "on one side only")


# ---- pictures --------------------------------------------------------------------------------

def check_pictures(report, program):
    program.png("a.png")
    program.png("b.png", 1)
    told(report, program.compare("a.png", "a.png"), 0, "equal in every pixel")
    told(report, program.compare("a.png", "b.png"), 1, "1 of 384 pixels differ")
    told(report, program.compare("a.png", "b.png", "--max", "flip=0.05", "--min", "ssim=0.9"),
         0)
    status, answer = program.json("a.png", "b.png")
    wanted = 10 * math.log10(3 * PIXELS * 255 ** 2)
    report.claim(status == 1 and abs(answer["metrics"]["psnr"] - wanted) < 1e-3
                 and answer["differing_pixels"] == 1,
                 f"one code of one channel: {answer['metrics']}, required: {wanted} dB")
    program.png("a16.png", bits=16)
    told(report, program.compare("a.png", "a16.png"), 0, "8 bits, the test 16")
    program.png("b16.png", 1, bits=16)
    told(report, program.compare("a16.png", "b16.png"), 1, "1 of 384")
    pictures.write_png(program.file("clear.png"), WIDTH, HEIGHT, [90] * 4 * PIXELS, channels=4)
    pictures.write_png(program.file("solid.png"), WIDTH, HEIGHT, [90] * 3 * PIXELS)
    told(report, program.compare("clear.png", "solid.png"), 1, "reference is transparent")
    values = [float(1 + i % 5) for i in range(3 * PIXELS)]
    pictures.write_hdr(program.file("a.hdr"), WIDTH, HEIGHT, values)
    values[7] = 40.0
    pictures.write_hdr(program.file("b.hdr"), WIDTH, HEIGHT, values)
    told(report, program.compare("a.hdr", "b.hdr"), 1, "1 of 384 pixels differ")
    for ending in ("jpg", "tif"):
        for name in ("a", "b"):
            program.run("develop", f"{name}.exr", "-o", f"{name}.{ending}")
        told(report, program.compare(f"a.{ending}", f"b.{ending}"), 1, "pixels differ")
    refused(report, program.compare("a.png", "a.exr"), 3, "a.png", "develop")
    refused(report, program.compare("a.png", "b.png", "--metric", "stat"), 3, "picture")


def check_masks(report, program):
    codes = [255] * 3 * PIXELS
    codes[99:102] = [0] * 3
    pictures.write_png(program.file("but33.png"), WIDTH, HEIGHT, codes)
    told(report, program.compare("a.png", "b.png", "--mask", "but33.png"), 0)
    pictures.write_png(program.file("none.png"), WIDTH, HEIGHT, [0] * 3 * PIXELS)
    refused(report, program.compare("a.png", "b.png", "--mask", "none.png"), 3, "no pixel")
    pictures.write_png(program.file("tiny.png"), 2, 2, [255] * 12)
    refused(report, program.compare("a.png", "b.png", "--mask", "tiny.png"), 3, "tiny.png",
            "2 x 2", "24 x 16")
    refused(report, program.compare("a.png", "b.png", "--display", "x"), 2, "--display x")


# ---- the command line ------------------------------------------------------------------------

def check_usage(report, program):
    pair = ("a.png", "b.png")
    refused(report, program.compare(*pair, "--max", "flop=1"), 2, "did you mean flip?")
    refused(report, program.compare(*pair, "--max", "psnr=30"), 2, "say --min psnr=30")
    refused(report, program.compare(*pair, "--region", "0,0,99,99"), 2, "--region")
    refused(report, program.compare("a.exr", "a.exr", "--display", "x"), 2, 'display "x"')
    refused(report, program.compare("a.png", "."), 2, "a folder")


def check_files(report, program):
    refused(report, program.compare("absent.exr", "a.exr"), 3, "absent.exr")
    with open(program.file("a.exr"), "rb") as file:
        whole = file.read()
    for length in (0, 40, len(whole) - 1):
        with open(program.file("cut.exr"), "wb") as out:
            out.write(whole[:length])
        refused(report, program.compare("a.exr", "cut.exr"), 3, "cut.exr")
    refused(report, program.compare("a.exr", "b.exr", "--junit", "no/such/j.xml"), 4, "j.xml")
    os.mkdir(program.file("folder.html"))
    refused(report, program.compare("a.exr", "b.exr", "--report", "folder.html"), 4)
    left = [name for name in os.listdir(program.folder) if name.startswith("folder.html.")]
    report.claim(not left, f"a failed report left {left}")


def check_json(report, program):
    status, answer = program.json("a.exr", "b.exr", "--max", "flip=0.9")
    wanted = {"flip", "flip_p95", "flip_max", "psnr", "ssim", "deltae_mean", "deltae_p95",
              "deltae_max", "mse", "relmse", "mae", "mean_shift", "differing"}
    report.claim(status == 0 and answer["same"] is True and answer["reasons"] == []
                 and wanted <= set(answer["metrics"]) and answer["judged_by"] == "limits",
                 f"compare --json lacks {wanted - set(answer['metrics'])}: {answer}")
    limit = answer["limits"][0]
    report.claim(limit["metric"] == "flip" and limit["holds"] and limit["limit"] == 0.9,
                 f"limits: {answer['limits']}")
    status, answer = program.json("a.exr", "a.exr")
    report.claim(status == 0 and answer["metrics"]["psnr"] is None
                 and answer["metrics"]["flip"] == 0 and answer["metrics"]["ssim"] == 1,
                 f"equal frames: {answer['metrics']}")
    status, answer = program.json("a.exr", "a.exr", "--exposure", "white:300")
    report.claim(answer["metrics"]["deltae_max"] == 0
                 and "untonemapped" in answer["shown_with"],
                 f"equal frames, both by the view that shows white as white: {answer}")
    status, answer = program.json("a.exr", "small.exr")
    report.claim(status == 1 and answer["same"] is False and answer["metrics"] == {}
                 and "other size" in answer["reasons"][0], f"different sizes: {answer}")
    status, answer = program.json("a.exr", "b.exr", "--metric", "mse")
    report.claim("flip" not in answer["metrics"] and "mse" in answer["metrics"],
                 f"--metric mse computes {sorted(answer['metrics'])}")
    status, answer = program.json("absent.exr", "a.exr")
    report.claim(status == 3 and answer["error"]["status"] == 3, f"an absent file: {answer}")


# ---- folders, JUnit, reports -----------------------------------------------------------------

WILD = "we<i>rd & \"q'.png"


def make_folders(program):
    for side in ("ref", "new"):
        program.png(f"{side}/same.png")
        program.png(f"{side}/sub/deep.png", 0 if side == "ref" else 9)
        program.png(f"{side}/{WILD}")
    program.png("ref/gone.png")


def check_folders(report, program):
    make_folders(program)
    done = program.compare("ref", "new", "--quiet")
    told(report, done, 1, "different     sub/deep.png: 1 of",
         "same          same.png", "missing       gone.png: missing in the test",
         "different: 2 of 4 pairs pass: 2 same, 1 different (sub/deep.png), 1 missing (gone.png)")
    os.remove(program.file("ref/gone.png"))
    program.png("new/sub/deep.png")
    told(report, program.compare("ref/", "new", "--quiet"), 0, "same: 3 of 3 pairs")
    program.png("new/extra.png")
    told(report, program.compare("ref", "new", "--quiet"), 1, "extra.png: only in the test")
    told(report, program.compare("ref", "new", "--quiet", "--allow-extra"), 0)
    program.png("new/same.png", 3)
    status, answer = program.json("ref", "new", "--quiet")
    pairs = {pair["name"]: pair for pair in answer["pairs"]}
    report.claim(status == 1 and answer["same"] is False and answer["different"] == 2
                 and pairs["same.png"]["same"] is False and pairs[WILD]["same"] is True
                 and pairs["same.png"]["metrics"]["flip"] > 0, f"folders --json: {answer}")
    os.mkdir(program.file("empty"))
    refused(report, program.compare("empty", "empty", "--quiet"), 3, "no picture")


def check_broken_pair(report, program):
    """One unreadable file is named, the others are compared, and the status tells."""
    with open(program.file("new/same.png"), "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\nnothing")
    done = program.compare("ref", "new", "--quiet", "--junit", "j.xml", "--report", "f.html")
    report.claim(done.returncode == 3 and len(done.stderr.splitlines()) == 1
                 and "new/same.png" in done.stderr and "1 failed (same.png)" in done.stdout,
                 f"a broken pair: {done.returncode} {done.stderr} {done.stdout}")
    suite = xml.parse(program.file("j.xml")).getroot().find("testsuite")
    cases = {case.get("name"): case for case in suite.iter("testcase")}
    report.claim(suite.get("tests") == "4" and suite.get("failures") == "1"
                 and suite.get("errors") == "1" and WILD in cases
                 and cases["same.png"].find("error") is not None
                 and cases["extra.png"].find("failure") is not None
                 and cases[WILD].find("failure") is None,
                 f"junit: {suite.attrib} {sorted(cases)}")
    status, answer = program.json("ref", "new", "--quiet")
    broken = [pair for pair in answer["pairs"] if pair.get("error")]
    report.claim(status == 3 and broken[0]["name"] == "same.png"
                 and broken[0]["error"]["status"] == 3, f"folders --json: {status} {broken}")


def check_pairs(report, program):
    """A line for each pair with limits, masks and regions of its own."""
    for name, change in (("one", 9), ("two", 9), ("sub/three", 0)):
        program.png(f"pa/{name}.png")
        program.png(f"pb/{name}.png", change)
    pictures.write_png(program.file("dark.png"), WIDTH, HEIGHT,
                       [0 if i // 3 == 33 else 255 for i in range(3 * PIXELS)], 8)
    lines = program.file("pairs")

    def run(text, *more):
        with open(lines, "w", encoding="utf-8") as file:
            file.write(text)
        return program.compare("pa", "pb", "--quiet", "--pairs", "pairs", *more)
    told(report, run("# none"), 1, "2 different (one.png, two.png)")
    told(report, run("one --max flip=1"), 1, "within limits one.png",
         "different     two.png")
    told(report, run("one --max flip=1\n\n'two.png'\t--mask dark.png"), 0, "3 of 3")
    told(report, run("one --region 0,0,24,1 --region 0,2,24,16\ntwo --region 0,0,9,2 "
                     "--region 10,0,24,16"), 0, "3 of 3")
    told(report, run("one --region 0,0,24,1 --region 9,1,10,2\ntwo --max flip=1"), 1,
         "different     one.png", "within limits two.png")
    told(report, run("one --max flip=1 --max max_difference=1\ntwo --max flip=1", "--max",
                     "max_difference=0"), 1, "within limits one.png", "different     two.png")
    for text, *words in (("none --max flip=1", "line 1", "no picture is named none"),
                         ("one\n\none", "line 3", "stands in line 1"),
                         ("one --max 'flip=1", "line 1", "a quote is open"),
                         ("one --max flop=1", "line 1", "flop"),
                         ("one --region 1,2", "line 1", "--region 1,2"),
                         ("one two", "line 1", "too many arguments"),
                         ("one --maxx 1", "line 1", "--maxx"), ("one --", "--"),
                         *((f"one {word}", "line 1", re.split("[= ]", word)[0]) for word in (
                             "--report=a.html", "--junit a", "--answer a", "--pairs a",
                             "--json", "--quiet", "--help", "-h", "--version", "--threads 1",
                             "--progress none", "--allow-extra"))):
        refused(report, run(text), 3, "pairs", *words)
    refused(report, program.compare("pa", "pb", "--pairs", "no_such"), 3, "no_such")
    run("one")
    refused(report, program.compare("a.exr", "b.exr", "--pairs", "pairs"), 2, "two folders")


def check_not_made(report, program):
    """A picture that could not be made is an error by its name, and the others are compared."""
    for side, name in (("pb", "one.png"), ("pa", "two.png"), ("pb", "new.png")):
        with open(program.file(side, name + ".failed"), "w", encoding="utf-8") as file:
            file.write(f"no light in {name}\nand more")
    os.remove(program.file("pb/one.png"))
    done = program.compare("pa", "pb", "--quiet", "--allow-extra", "--junit", "j.xml",
                           "--report", "e.html", "--answer", "f.json")
    report.claim(done.returncode == 3 and len(done.stderr.splitlines()) == 3
                 and "pb/one.png.failed: it was not made: no light in one.png" in done.stderr
                 and "failed: 1 of 4 pairs pass: 1 same, 3 failed" in done.stdout,
                 f"not made: {done.returncode} {done.stderr} {done.stdout}")
    root = xml.parse(program.file("j.xml")).getroot()
    errors = {case.get("name") for case in root.iter("testcase")
              if case.find("error") is not None}
    report.claim(errors == {"one.png", "two.png", "new.png"}, f"junit: {errors}")
    with open(program.file("f.json"), encoding="utf-8") as file:
        kept = json.load(file)
    _, answer = program.json("pa", "pb", "--quiet", "--allow-extra", "--answer", "g.json")
    for pair in (*kept["pairs"], *answer["pairs"]):
        pair.pop("seconds", 0)
    report.claim(kept == answer and kept["failed"] == 3, f"--answer: {kept} {answer}")
    refused(report, program.compare("pa", "pb", "--answer", "no/such/j.json"), 4, "j.json")
    told(report, program.compare("a.exr", "a.exr", "--answer", "one.json"), 0, "same:")
    with open(program.file("one.json"), encoding="utf-8") as file:
        report.claim(json.load(file)["same"] is True, "--answer of two files")


def check_junit(report, program):
    told(report, program.compare("a.exr", "b.exr", "--junit", "one.xml"), 1)
    root = xml.parse(program.file("one.xml")).getroot()
    case = root.find("testsuite/testcase")
    named = {p.get("name"): p.get("value") for p in case.iter("property")}
    report.claim(root.get("failures") == "1"
                 and "1 of 384" in case.find("failure").get("message")
                 and float(case.get("time")) >= 0 and float(named["flip"]) > 0,
                 f"junit of one pair: {xml.tostring(root)[:400]}")


def check_report(report, program):
    program.frame("<b>&.exr", put("G", 30, 99.0),
                  {"parhelion:commandLine": pictures.text("<script>alert(1)</script>")})
    told(report, program.compare("a.exr", "<b>&.exr", "--report", "r.html"), 1,
         "report: r.html")
    with open(program.file("r.html"), encoding="utf-8") as file:
        page = file.read()
    report.claim("<b>&.exr" not in page and "&lt;b&gt;&amp;.exr" in page
                 and "<script>alert" not in page, "names are not escaped in the report")
    report.claim(page.count('<img alt=') == 6 and page.count("data:image/png;base64,") == 6,
                 f"the report holds {page.count('<img alt=')} pictures, 6 wanted")
    report.claim("http:" not in page and "https:" not in page and "1 of 384" in page,
                 "the report asks a network, or lacks the verdict")
    with open(program.file("f.html"), encoding="utf-8") as file:
        folders = file.read()
    report.claim(re.search(r"(</a>|</div>)\s*</div>\s*(<details class=.pair|<footer)", folders)
                 and "we&lt;i&gt;rd" in folders and folders.count('<strong>') == 4
                 and "<em>failed</em>" in folders, "the index of folders is not whole")
    program.compare("a.exr", "<b>&.exr", "--report", "again.html")
    with open(program.file("again.html"), encoding="utf-8") as file:
        report.claim(page == file.read(), "the same comparison gives another report")


# ---- noise -----------------------------------------------------------------------------------

def check_noise(report, program):
    """Two seeds are the same, a brighter lamp is not; by the statistic, without any limit."""
    scene = sound_scene()
    scene.write(program.file("scene.gltf"))
    for name, seed in (("one.exr", 1), ("two.exr", 2)):
        done = program.run("render", "scene.gltf", "-o", name, "--size", "64x48", "--spp", "32",
                           "--seed", str(seed), "--layers", "all", "--quiet")
        report.claim(done.returncode == 0, f"render: {done.stderr}")
    told(report, program.compare("one.exr", "two.exr"), 0,
         "within noise: Two: only the noise differs, mean luminance within ",
         ". Inputs unchanged. Settings changed: seed (1, now 2)")
    told(report, program.compare("one.exr", "two.exr", "--max", "differing=0.001"), 1,
         "different: Two: only the noise differs", "Beyond limits: differing 100 %")
    status, answer = program.json("one.exr", "two.exr")
    stat = answer["metrics"]["stat"]
    report.claim(status == 0 and answer["judged_by"] == "stat" and stat["p_value"] > 0.01
                 and stat["verdict"] == "same"
                 and {"fraction_failed", "mean_shift"} <= set(stat), f"stat: {stat}")
    brighter(program, "two.exr", "bright.exr", 1.2)
    status, answer = program.json("one.exr", "bright.exr")
    report.claim(status == 1 and answer["verdict"].startswith("Bright: 20 % brighter, everywhere")
                 and answer["metrics"]["stat"]["verdict"] == "different"
                 and abs(answer["metrics"]["mean_shift"] - 0.2) < 0.1, f"brighter: {answer}")
    for share, factor, place in ((0.04, 1.5, "upper left"), (0.04, 0.7, "centre"),
                                 (0.1, 1.2, "centre"), (0.3, 0.85, "")):
        check_planted(report, program, share, factor, place)
    for name in ("one", "two"):
        program.run("develop", f"{name}.exr", "-o", f"{name}.png")
    told(report, program.compare("one.png", "two.png"), 1, "Two: differs as noise does")
    brighter(program, "two.exr", "glaring.exr", 1e4)
    done = program.compare("one.exr", "glaring.exr")
    told(report, done, 1, "10000 times as bright")
    report.claim(["p of the statistical test", "0"] in map(columns_of, done.stdout.splitlines()),
                 f"light that is certain to differ: {done.stdout}")
    report.claim(program.json("one.exr", "glaring.exr")[1]["metrics"]["stat"]["p_value"] == 0,
                 "a certain change has another p than 0")


def check_planted(report, program, share, factor, place):
    """What changes in one place is told as large and as much as it is, not spread over all."""
    side, start = math.sqrt(share), 0.5 if place == "centre" else 0.1
    if place == "centre":
        start -= side / 2
    brighter(program, "two.exr", "planted.exr", factor, lambda x, y: all(
        start <= at < start + side for at in (x / 64, y / 48)))
    verdict = program.json("one.exr", "planted.exr")[1]["verdict"]
    found = re.search(r"([\d.]+) % (brighter|darker)(?: in|, part .* \() ?([\d.]+) % of the "
                      r"picture(?:, (\w+ ?\w*))?", verdict)
    report.claim(found and abs(float(found[1]) / 100 / abs(factor - 1) - 1) < 0.25
                 and found[2] == ("brighter" if factor > 1 else "darker")
                 and 0.7 < float(found[3]) / 100 / share < 1.4
                 and (found[4] or place).startswith(place),
                 f"planted {factor} in {share}: {verdict}")


# ---- kinds of change, and all views of them --------------------------------------------------

def noisy(program, name, draw, change=None, attributes=None, seed="1"):
    """A frame of 1 % noise that its layers state, a display in its left half."""
    def add(channels):
        for c in "RGB":
            light = channels[c]
            channels[c] = [v * (1 + 0.01 * draw.gauss(0, 1)) for v in light]
            channels["variance." + c] = [(0.01 * v) ** 2 for v in light]
            channels["halves." + c] = [0.01 * v * draw.gauss(0, 1) for v in light]
            for part, share in (("emitted", 0.9), ("white", 0.9), ("black", 0), ("reflected", 0.1)):
                channels[f"display.{part}.{c}"] = [share * v if i % WIDTH < 12 else NAN
                                                   for i, v in enumerate(channels[c])]
        channels["id.display"] = [1 - (i % WIDTH < 12) for i in range(PIXELS)]
        if change:
            change(channels)
    program.frame(name, add, {
        "parhelion:display.0": pictures.text("cluster"), "parhelion:seed": pictures.text(seed),
        "parhelion:inputs": pictures.text("0a  s/night.gltf\n0b  centre.png\n"),
        **(attributes or {})})


def times(red, green, blue, inside=lambda x, y: True):
    def change(channels):
        for c, factor in zip("RGB", (red, green, blue)):
            channels[c] = [v * factor if inside(i % WIDTH, i // WIDTH) else v
                           for i, v in enumerate(channels[c])]
    return change


def one_pixel(variance):
    def change(channels):
        for c in "RGB":
            put(c, 100, 20000.0)(channels)
            if variance:
                put("variance." + c, 100, 4e8)(channels)
    return change


def few(channels):
    times(1.0001, 1.0001, 1.0001, lambda x, y: (x + y) % 4 == 1)(channels)
    times(0.9999, 0.9999, 0.9999, lambda x, y: (x + y) % 4 == 3)(channels)


INPUTS = {"parhelion:inputs": pictures.text("0c  t/night.gltf\n0d  centre.png\n")}
CORNER = times(0.6, 0.6, 0.6, lambda x, y: x > 18 and y < 4)
PIXEL = "pixel 4,4: "
KINDS = (  # the test's seed, what changed, its metadata, status, what the headline says
    ("1", None, {}, 0, "same: K: equal in every pixel"),
    ("1", few, {}, 0, "within noise: K: changed, below the noise: 192 of 384 pixels differ"),
    ("2", None, {}, 0, "within noise: K: only the noise differs, ", ". Inputs unchanged. "
     "Settings changed: seed (1, now 2)"),
    ("2", None, INPUTS, 0, "within noise: K: no change beyond the noise", "Inputs changed: "
     "night.gltf, centre.png"),
    ("2", None, {"parhelion:inputs": None}, 0, "no change beyond the noise", "Inputs not stated"),
    ("1", times(0.98, 0.98, 0.98), INPUTS, 1, "different: K: 2 % darker, everywhere. Inputs "
     "changed: night.gltf, centre.png"),
    ("2", times(0.98, 0.98, 0.98), {}, 1, "K: 2 % darker, everywhere. Inputs unchanged"),
    ("1", times(1.3, 1.3, 1.3), {}, 1, "K: 30 % brighter, everywhere"),
    ("1", times(1.2, 0.891191, 0.8), {}, 1, "different: K: colour shift 0.02", " u'v' at equal "
     "luminance, everywhere. Inputs unchanged"),
    ("1", CORNER, {}, 1, "K: 40 % darker in 5.2 % of the picture, upper right"),
    ("2", CORNER, {}, 1, "K: 40 % darker in 4.2 % of the picture, upper right"),
    ("1", times(0.5, 0.5, 0.5, lambda x, y: x < 12), {}, 1, "K: 50 % darker, display cluster"),
    ("1", times(0.5, 0.5, 0.5), {"parhelion:camera": pictures.text("side"), **INPUTS}, 1,
     "50 % darker, everywhere; other metadata that decides what the picture shows: camera (eye, "
     "now side). Inputs changed: night.gltf, centre.png"),
    ("1", one_pixel(True), {}, 1, "K: 1 of 384 pixels differs, " + PIXEL, ", now 20000 cd/m2"),
    ("2", one_pixel(False), {}, 1, "K: " + PIXEL, ", now 20000 cd/m2. Inputs unchanged"),
    ("2", one_pixel(True), {}, 0, "only the noise differs", "; bright samples: " + PIXEL),
)


def cells(page, start):
    """The tables' rows from there on, as texts."""
    return [[html.unescape(re.sub("<[^>]*>", "", cell)) for cell in re.findall(
        r"<td.*?</td>", row, re.S)] for row in re.findall(r"<tr><td>.*?</tr>", page[start:], re.S)]


def plain(text):
    return html.unescape(text).replace("±", "+-").replace("m²", "m2").replace(")²", ")^2")


def columns_of(line):
    """Of a table's row on the console."""
    return re.split(" {2,}", line)


def check_views(report, program, name, limits=()):
    """Console, JSON, JUnit and page say the same."""
    done = program.compare("ref.exr", "k.exr", *limits, "--answer", "k.json", "--junit", "k.xml",
                           "--report", "k.html")
    with open(program.file("k.json"), encoding="utf-8") as file:
        answer = json.load(file)
    with open(program.file("k.html"), encoding="utf-8") as file:
        page = file.read()
    case = xml.parse(program.file("k.xml")).getroot().find("testsuite/testcase")
    lines = done.stdout.splitlines()
    line = f"{answer['outcome']}: {answer['verdict']}"
    heading = html.unescape(re.sub("<[^>]*>", "", re.search("<h1>(.*?)</h1>", page).group(1)))
    said = case.find("system-out").text.splitlines()
    report.claim(lines[-1] == line == heading == said[0] and answer["same"] == (not done.returncode)
                 and answer["same"] == (answer["outcome"] != "different")
                 and (answer["outcome"] == "same") == (answer["differing_pixels"] == 0
                                                       and answer["same"]),
                 f"{name}: {lines[-1]} | {line} | {heading} | {said[0]}")
    failure = case.find("failure")
    report.claim((failure is None) == answer["same"]
                 and (failure is None or failure.get("message") == answer["verdict"]),
                 f"{name}: JUnit's failure")
    rows = [[r["label"], *filter(None, (r["text"], r["limit"], r["verdict"]))]
            for r in answer["rows"]]
    report.claim(rows == [columns_of(line) for line in lines[1:len(rows) + 1]] and rows,
                 f"{name}: rows {rows[:3]}, {lines[1:4]}")
    report.claim([f"{row[0]}: {', '.join(row[1:])}" for row in rows] == said[1:len(rows) + 1],
                 f"{name}: rows {rows[:3]}, {said[1:4]}")
    table = [plain(cell) for row in cells(page, page.index("shots")) for cell in row]
    report.claim(all(r["text"] in table and (not r["limit"] or r["limit"] in table)
                     for r in answer["rows"]), f"{name}: the page's rows")
    given = {p.get("name"): float(p.get("value")) for p in case.iter("property")}
    wanted = {r["figure"] + (r["of"] and " of " + r["of"]): r["value"] for r in answer["rows"]
              if r["value"] is not None}
    report.claim(given.keys() == wanted.keys() and all(
        math.isclose(given[k], wanted[k], rel_tol=1e-7) for k in wanted), f"{name}: properties")
    cards = [plain(card) for card in re.findall("<b>(.*?)</b><span>", page)]
    report.claim(cards == [r["change"] or r["text"] for r in answer["rows"] if r["is_key"]],
                 f"{name}: {cards}")
    for row in answer["rows"]:
        if row["is_key"] and row["half_width"] is not None and not row["limit"]:
            report.claim(abs(row["value"]) > 2 * row["half_width"], f"{name}: a card of {row}")
    return done, answer


def check_kinds(report, program):
    draw = random.Random(3)
    noisy(program, "ref.exr", random.Random(1))
    for seed, change, attributes, status, *words in KINDS:
        noisy(program, "k.exr", random.Random(int(seed)), change, attributes, seed)
        done, answer = check_views(report, program, words[0])
        told(report, done, status, *words)
        report.claim(seed != "1" or "only the noise" not in done.stdout, f"one seed: {words}")
        metric = draw.choice(("flip", "mae", "mean_shift", "contrast_change", "max_difference"))
        limit = abs(answer["metrics"][metric] or 0) * draw.choice((0.5, 2)) + 1e-9
        check_views(report, program, words[0] + metric, ("--max", f"{metric}={limit}"))


def check_random(report, program):
    """Rectangles of any size and factor: all views agree, and the line has its direction."""
    draw = random.Random(5)
    for k in range(12):
        seed, factor = draw.choice("12"), draw.choice((0.3, 0.9, 1.1, 3))
        left, top = draw.randrange(WIDTH), draw.randrange(HEIGHT)
        right, bottom = draw.randrange(left, WIDTH), draw.randrange(top, HEIGHT)
        noisy(program, "k.exr", random.Random(int(seed)), times(
            factor, factor, factor, lambda x, y: left <= x <= right and top <= y <= bottom),
            draw.choice((INPUTS, {})), seed)
        _, answer = check_views(report, program, f"random {k}")
        words = {word for word in ("brighter", "darker") if word in answer["verdict"]}
        count = (right - left + 1) * (bottom - top + 1)
        report.claim(words <= {"brighter" if factor > 1 else "darker"}
                     and (seed == "2" or (words or count < 10)
                          and answer["differing_pixels"] == count),
                     f"random {k}: {factor} in {count} pixels: {answer['verdict']}")


def check_folder_views(report, program):
    """Of folders the same, and one line has all pairs."""
    for side, factor in (("fa", 1), ("fb", 0.5)):
        for name in ("night", "noon"):
            noisy(program, f"{side}/{name}.exr", random.Random(1),
                  times(factor, factor, factor) if name == "night" else None,
                  INPUTS if name == "night" and factor != 1 else {})
    noisy(program, "fa/gone.exr", random.Random(1))
    done = program.compare("fa", "fb", "--quiet", "--answer", "f.json", "--junit", "f.xml",
                           "--report", "f.html")
    with open(program.file("f.json"), encoding="utf-8") as file:
        answer = json.load(file)
    with open(program.file("f.html"), encoding="utf-8") as file:
        page = file.read()
    told(report, done, 1, "missing       gone.exr: missing in the test\ndifferent     night.exr: "
         "50 % darker, everywhere. Inputs changed: night.gltf, centre.png\nsame          noon.exr: "
         "equal in every pixel\n")
    line = f"{answer['outcome']}: {answer['verdict']}"
    headings = [html.unescape(re.sub("<[^>]*>", "", heading))
                for heading in re.findall("<h1>(.*?)</h1>", page)]
    cases = xml.parse(program.file("f.xml")).getroot().iter("testcase")
    report.claim(done.stdout.splitlines()[-1] == line == headings[0] == "different: 1 of 3 pairs "
                 "pass: 1 same, 1 different (night.exr), 1 missing (gone.exr). Inputs changed: "
                 "night.gltf, centre.png", f"folders: {line} | {headings}")
    report.claim([f"{pair['outcome']}: {pair['verdict']}" for pair in answer["pairs"]]
                 == [case.find("system-out").text.splitlines()[0] for case in cases],
                 "folders: JUnit's cases are not the pairs")


def brighter(program, name, out, factor, inside=lambda x, y: True):
    """The same frame with its light times a factor, metadata and all."""
    frame = pictures.read_exr(program.file(name))
    for kind, by in (("", factor), ("variance.", factor ** 2)):
        for channel in (kind + c for c in "RGB"):
            frame["channels"][channel] = [
                by * v if inside(i % frame["width"], i // frame["width"]) else v
                for i, v in enumerate(frame["channels"][channel])]
    pictures.write_exr(program.file(out), frame["width"], frame["height"], frame["channels"],
                       frame["attributes"])


def check_limits_of_noise(report, program):
    refused(report, program.compare("a.exr", "b.exr", "--level", "0.05"), 3)
    refused(report, program.compare("one.exr", "two.exr", "--level", "0"), 2, "--level")


def main():
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        program = Compare(sys.argv[-1], folder)
        for check in (check_frames, check_itself, check_structure, check_contrast, check_numbers,
                      check_pictures, check_masks, check_usage, check_files,
                      check_json, check_folders, check_broken_pair,
                      check_pairs, check_not_made, check_junit, check_report, check_noise,
                      check_limits_of_noise, check_kinds, check_random, check_folder_views):
            try:
                check(report, program)
            except (ValueError, KeyError, IndexError, OSError, AttributeError,
                    subprocess.TimeoutExpired) as error:
                report.claim(False, f"{check.__name__}: {type(error).__name__}: {error}")
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
