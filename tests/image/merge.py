# SPDX-License-Identifier: Apache-2.0
"""merge.py [--all] PARHELION -- parts of a frame, however it is cut and in any order, make the
file that one run makes, byte for byte; and what does not make a whole is refused by name.
--all: more ways to cut it, and a scene with displays; and where light comes from is learnt
throughout, not for the first ways alone.
"""
import argparse
import itertools
import json
import os
import random
import resource
import signal
import struct
import subprocess
import sys
import tempfile
import threading

from bits import digest, write_scene
from exr import Frame

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402
from words import unless_given  # noqa: E402

SIZE = 52, 36
WHOLE = (0, 0, *SIZE)
SAMPLES = 7


class Program:
    """Runs commands in one folder, so that all of them name their files in the same way."""

    def __init__(self, path, folder):
        self.path, self.folder = path, folder
        self.scene = ["small.gltf"]
        self.options = ["--size", "{}x{}".format(*SIZE)]
        self.parts = {}

    def run(self, *words, **environment):
        return subprocess.run([self.path, *words], capture_output=True, text=True,
                              cwd=self.folder, env={**os.environ, **environment})

    def file(self, name):
        return os.path.join(self.folder, name)

    def read(self, name):
        with open(self.file(name), "rb") as file:
            return file.read()

    def write(self, name, data):
        with open(self.file(name), "wb") as file:
            file.write(data)

    def render(self, name, *options):
        done = self.run("render", *self.scene, "-o", name,
                        *unless_given(self.options, options), "--quiet", *options)
        if done.returncode != 0:
            print(done.stderr)
        return name

    def part(self, samples, crop=WHOLE):
        """A part of some samples and pixels; rendered once."""
        name = "part{}-{}_{}-{}-{}-{}.exr".format(*samples, *crop)
        if name not in self.parts:
            options = [] if crop == WHOLE else ["--crop", "{},{},{},{}".format(*crop)]
            self.parts[name] = self.render(name, "--layers", "all", "--samples",
                                           "{}:{}".format(*samples), *options)
        return name

    def merge(self, parts, name, *options):
        return self.run("merge", *parts, "-o", name, "--quiet", *options)


def cut(end, places):
    edges = [0, *places, end]
    return list(zip(edges, edges[1:]))


def crops(xs, ys):
    return [(x0, y0, x1, y1) for y0, y1 in cut(SIZE[1], ys) for x0, x1 in cut(SIZE[0], xs)]


def claim_whole(report, program, parts, what):
    """The merged file is the one that a single run wrote, under whatever name."""
    done = program.merge(parts, "merged.exr")
    if report.claim(done.returncode == 0, f"{what}: {done.stderr.strip()}"):
        merged, whole = Frame(program.file("merged.exr")), Frame(program.file("frame.exr"))
        report.claim(digest(merged, None) == digest(whole, None), f"{what}: other pixels")
        report.claim(program.read("merged.exr") == program.read("frame.exr"),
                     f"{what}: other bytes")


def check_splits(report, program, splits):
    rng = random.Random(1)
    for what, boxes in splits.items():
        parts = [program.part(*box) for box in boxes]
        rng.shuffle(parts)
        claim_whole(report, program, parts, what)


def few_splits():
    return {"one part": [((0, 7), WHOLE)],
            "two ranges of samples": [(range_, WHOLE) for range_ in cut(7, [3])],
            "2 x 2 crops": [((0, 7), crop) for crop in crops([17], [20])]}


def dealt(program, count, *options):
    """All parts that samples are dealt to."""
    return [program.render(f"dealt{i}of{count}{''.join(options)}.exr", "--layers", "all", "--spp",
                           str(SAMPLES), "--part", f"{i}/{count}", *options)
            for i in range(1, count + 1)]


def check_dealt(report, program):
    """--part K/N: the file of one run, and what is missing, doubled or another program's."""
    for count in (1, 3, SAMPLES):
        claim_whole(report, program, dealt(program, count)[::-1], f"dealt to {count}")
    one, two, three = dealt(program, 3)
    claim_refused(report, program, [one, three], "part 2 of 3 is missing — ", "--part 2/3")
    claim_refused(report, program, [two], "parts 1,3 of 3 are missing — ", "--part K/3")
    claim_refused(report, program, [two, one, three, two],
                  f"{two}: is part 2 of 3, and so is {two} — leave one of the two out")
    claim_refused(report, program, [one, two, *dealt(program, 2)], "part 3 of 3 is missing")
    crop = ("--crop", "3,2,30,20")
    program.render("crop.exr", "--layers", "all", "--spp", str(SAMPLES), *crop)
    program.merge(dealt(program, 2, *crop), "merged.exr")
    report.claim(program.read("merged.exr") == program.read("crop.exr"), "a crop that is dealt")
    if "instruction set: avx" in program.run("--version").stdout:
        other = dealt(program, 3, "--isa", "sse2")[2]
        claim_refused(report, program, [one, two, other], f"{other}: was made by another "
                      f"program or instruction set than {one}: isa: avx", status=5)


def more_splits():
    return {"seven samples": [(range_, WHOLE) for range_ in cut(7, range(1, 7))],
            "crops by samples": [(range_, crop) for range_ in cut(7, [3])
                                 for crop in crops([17], [])]}


def check_uneven(report, program):
    """Parts whose edges do not meet in one point, some by --spp, some by --samples."""
    parts = [program.render("spp.exr", "--layers", "all", "--spp", "7", "--crop", "0,0,17,36"),
             program.part((0, 3), (17, 0, 52, 36)), program.part((3, 7), (17, 0, 52, 9)),
             program.part((3, 5), (17, 9, 52, 36)), program.part((5, 7), (17, 9, 52, 36))]
    claim_whole(report, program, parts, "the left half whole and the right one in pieces")


def check_nested(report, program):
    """Parts of parts: a half merged from quarters is the half that one run makes."""
    quarters = [program.part((0, 7), crop) for crop in crops([17], [20])]
    program.render("half.exr", "--layers", "all", "--spp", "7", "--crop", "0,0,52,20")
    expected = program.read("half.exr")
    done = program.merge([quarters[1], quarters[0]], "half.exr")
    report.claim(done.returncode == 0 and program.read("half.exr") == expected,
                 f"a half merged from quarters is another: {done.stderr}")
    program.merge(quarters[2:], "other.exr")
    claim_whole(report, program, ["other.exr", "half.exr"], "two merged halves")
    ranges = [program.part(range_) for range_ in cut(7, [1, 3])]
    done = program.merge(ranges[1:], "late.exr", "--json")
    answer = json.loads(done.stdout)
    report.claim(answer["sample_range"] == [1, 7] and answer["is_part"] and answer["complete"]
                 and answer["parts"] == 2 and answer["samples"] == 6, f"answer {done.stdout}")
    claim_whole(report, program, ["late.exr", ranges[0]], "late samples merged first")
    done = program.merge(ranges[:2], "early.exr", "--json")
    report.claim(not json.loads(done.stdout)["is_part"], "early samples are a whole frame")
    claim_refused(report, program, ["early.exr", ranges[2]], "early.exr",
                  "carries no sums, only means: it cannot be merged")
    done = program.merge(ranges[:2], "early.exr", "--part", "--json")
    report.claim(json.loads(done.stdout)["is_part"], f"--part: {done.stdout}{done.stderr}")
    claim_whole(report, program, ["early.exr", ranges[2]], "early samples merged with --part")


def check_time_and_lines(report, program):
    """The time is that of the merge; command lines that do not agree are listed."""
    first, second = program.part((0, 3)), program.part((3, 7))
    done = program.run("merge", first, second, "-o", "dated.exr", "--quiet",
                       SOURCE_DATE_EPOCH="86400")
    dated = Frame(program.file("dated.exr"))
    report.claim(done.returncode == 0 and dated.attributes["capDate"] == b"1970:01:02 00:00:00",
                 f"the date is {dated.attributes.get('capDate')}")
    other = program.render("sorted.exr", "--samples", "3:7", "--layers", "all")
    done = program.merge([first, other], "listed.exr")
    if report.claim(done.returncode == 0, f"another order of options: {done.stderr}"):
        listed = Frame(program.file("listed.exr"))
        report.claim(digest(listed, None) == digest(dated, None), "listed lines, other pixels")
        lines = listed.attributes["parhelion:parts"].decode().split("\n")
        report.claim(lines[0].endswith("--samples 0:3") and lines[1].endswith("--layers all"),
                     f"the parts' lines are {lines}")
        report.claim(listed.attributes["parhelion:commandLine"] == b"parhelion merge",
                     "the command line is the merge's")
        program.merge([other, first], "turned.exr")
        report.claim(program.read("turned.exr") == program.read("listed.exr"),
                     "the same parts in another order, other bytes")


def claim_refused(report, program, parts, *words, status=3):
    before = set(os.listdir(program.folder))
    done = program.merge(parts, "refused.exr")
    report.claim(done.returncode == status, f"{parts}: status {done.returncode}, not {status}")
    line = done.stderr.strip()
    report.claim("\n" not in line and all(word in line for word in words),
                 f"{parts}: required: {words}, found {line!r}")
    report.claim(set(os.listdir(program.folder)) == before, f"{parts}: something is left")


def check_holes(report, program):
    """Overlaps and gaps, with the pixels and samples in question."""
    a, b = program.part((0, 3)), program.part((3, 7))
    left = program.part((3, 7), (0, 0, 17, 36))
    late, first, third = [program.part((i, i + 1)) for i in (6, 0, 2)]
    claim_refused(report, program, [a, b, a], f"{a}: pixels 0,0,52,36, samples 0:3 are in {a}")
    claim_refused(report, program, [b, a, left],
                  f"{left}: pixels 0,0,17,36, samples 3:7 are in {b} as well — leave one")
    claim_refused(report, program, [a, left], "parhelion: no part has samples 3:7 of pixels "
                  "17,0,52,36 — add what `render --samples 3:7 --crop 17,0,52,36` makes")
    claim_refused(report, program, [late, third, first],
                  "no part has samples 1:2 of pixels 0,0,52,36")


def layers_but(program, part, name):
    """The layers of a part as the program lists them, less one."""
    text = program.read(part)
    begin = text.index(b"\nlayers\t") + len(b"\nlayers\t")
    names = text[begin:text.index(b"\n", begin)].decode().split(",")
    return ",".join(other for other in names if other != name)


def check_foreign(report, program):
    """Parts of another frame, and files that are no parts."""
    a = program.part((0, 3))
    program.render("seed.exr", "--layers", "all", "--samples", "3:7", "--seed", "2")
    program.render("layers.exr", "--samples", "3:7")
    program.render("fewer.exr", "--samples", "3:7", "--layers", layers_but(
        program, a, "display.extrapolated"))
    program.render("size.exr", "--layers", "all", "--samples", "3:7", "--size", "52x37")
    scene = json.loads(program.read("small.gltf"))
    scene["nodes"][0]["name"] = "another"
    program.write("other.gltf", json.dumps(scene).encode())
    program.run("render", "other.gltf", "-o", "scene.exr", *program.options, "--layers", "all",
                "--samples", "3:7", "--quiet")
    for name, words in (("seed.exr", "seed: 0 there, 2 here"), ("layers.exr", "layers: xyz"),
                        ("fewer.exr", "layers: display.extrapolated there, not here "),
                        ("size.exr", "size: 52x36 there, 52x37 here"),
                        ("scene.exr", "input 0: small.gltf ")):
        claim_refused(report, program, [a, name],
                      f"{name}: is of another frame than {a}: {words}", "— merge parts of one")
    program.write("text.exr", b"no picture")
    claim_refused(report, program, ["frame.exr"], "frame.exr: carries no sums, only means")
    claim_refused(report, program, [a, "text.exr"], "text.exr: not an OpenEXR file")
    claim_refused(report, program, ["missing.exr"], "missing.exr: cannot be opened: No such")
    claim_refused(report, program, ["."],
                  ".: has no conditions to be merged: `parhelion review --only` makes them")


def check_damage(report, program):
    """Files cut off or changed."""
    a, b = program.part((0, 3)), program.part((3, 7))
    whole = program.read(b)
    for size in (3, 300, 3000, len(whole) // 3, len(whole) - 1):
        program.write("cut.exr", whole[:size])
        fault = "not an OpenEXR file" if size < 4 else "damaged"
        claim_refused(report, program, [a, "cut.exr"], f"cut.exr: {fault}")
    changed = bytearray(whole)
    changed[len(whole) * 9 // 10] ^= 4
    program.write("cut.exr", changed)
    claim_refused(report, program, [a, "cut.exr"], "cut.exr: damaged ")
    changed = bytearray(whole)
    at = whole.index(b"parhelion:layers\0int\0") + 25
    layers, = struct.unpack_from("<i", changed, at)
    struct.pack_into("<i", changed, at, layers ^ 1)  # xyz, which has no sums of its own
    program.write("cut.exr", changed)
    claim_refused(report, program, [a, "cut.exr"], "cut.exr: damaged sums: of 52x36 pixels and "
                  f"layers {layers ^ 1:x}, those of {a} of 52x36 and {layers:x}")
    program.write("cut.exr", whole.replace(b"parhelion:identity", b"parhelion:idontity"))
    claim_refused(report, program, [a, "cut.exr"], "cut.exr: does not say what it was rendered")


def check_stopped(report, program):
    """A part that was interrupted is named, unless others have what it lacks."""
    work = subprocess.Popen(
        [program.path, "render", *program.scene, "-o", "stopped.exr", *program.options,
         "--layers", "all", "--samples", "0:1000000", "--progress", "json"],
        cwd=program.folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    work.stderr.readline()  # the first passes are done: before them it would simply end
    work.send_signal(signal.SIGTERM)  # not INT: a shell's background jobs ignore it
    work.communicate(timeout=120)
    if report.claim(work.returncode == 143, f"interrupted: status {work.returncode}"):
        claim_refused(report, program, ["stopped.exr"],
                      "stopped.exr: incomplete: it was stopped after samples 0:",
                      " of 0:1000000 — ")


def check_changing(report, program):
    """A name that stands for one part and then for another, over and over."""
    names, stop = [program.part((0, 3)), program.part((3, 7))], threading.Event()

    def change():
        for i in itertools.count():
            if stop.is_set():
                return
            os.symlink(names[i % 2], program.file("next"))
            os.replace(program.file("next"), program.file("changing.exr"))
    worker = threading.Thread(target=change)
    worker.start()
    faults = set()
    for _ in range(50):
        done = program.merge(["changing.exr"], "refused.exr")
        faults.add(done.stderr.strip() if done.returncode else "")
        if any(faults):
            break
    stop.set()
    worker.join()
    report.claim(faults - {""} == {"parhelion: changing.exr: has changed while it was merged"},
                 f"a part that changes: {faults}")


def check_memory(report, program):
    """A film that the memory does not hold: half of what the process may take."""
    program.run("render", *program.scene, "-o", "large.exr", "--size", "1000x850", "--layers",
                "all", "--samples", "0:1", "--max-bounces", "0", "--quiet")
    limit = 1000 << 20
    done = subprocess.run(
        [program.path, "merge", "large.exr", "-o", "refused.exr", "--quiet"],
        capture_output=True, text=True, cwd=program.folder,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))
    report.claim(done.returncode == 3 and "the film of 1000x850 pixels needs 0.8 GB, there are "
                 "0.5 GB — merge fewer parts" in done.stderr, f"large: {done.stderr!r}")


def check_line(report, program):
    """The command line, and outputs that cannot be."""
    a = program.part((0, 1))
    for words, status, message in (
            (["merge"], 2, "too few arguments"), (["merge", a], 2, "no output — add -o"),
            (["merge", a, "-o", "x.png"], 2, "-o x.png: required: a name that ends in .exr"),
            (["merge", a, "-o", "none/x.exr"], 4, "none/x.exr: cannot be written: No such"),
            (["merge", a, "-o", "x.exr", "--prat"], 2, "did you mean --part?")):
        done = program.run(*words)
        report.claim(done.returncode == status and message in done.stderr,
                     f"{words}: {done.returncode} {done.stderr!r}")


def check_displays(report, program):
    """A scene with displays: their layers have sums of their own."""
    program.scene = [os.path.join(ROOT, "scenes", name)
                     for name in ("car_dashboard.gltf", "noon.gltf")]
    program.render("frame.exr", "--layers", "all", "--spp", "2")
    parts = [program.render(f"display{i}.exr", "--layers", "all", "--samples",
                            f"{i % 2}:{i % 2 + 1}", "--crop", f"0,{y0},52,{y1}")
             for i, (y0, y1) in enumerate([(0, 21), (0, 21), (21, 36), (21, 36)])]
    claim_whole(report, program, parts, "the dashboard")
    frame = Frame(program.file("frame.exr"))
    report.claim(any(value == value for value in frame.channels["display.contrast"]),
                 "no display is in view")
    check_fine(report, frame)


def check_fine(report, frame):
    """What displays send to the whole pixel, by more rays: where there is a display, and in
    the mean what the samples themselves saw."""
    fine, coverage = frame.channels["display.fine.G"], frame.channels["display.coverage"]
    seen = [(f, e * c) for f, e, c in zip(fine, frame.channels["display.emitted.G"], coverage)
            if c > 0]
    report.claim(all((f == f) == (c > 0) for f, c in zip(fine, coverage)),
                 "display.fine is not where display.coverage is above 0")
    more, own = sum(f for f, _ in seen), sum(e for _, e in seen)
    report.claim(abs(more / own - 1) < 0.1,
                 f"display.fine sums up to {more}, its samples {own}")
    report.claim(more != own, "display.fine is of the samples' own rays")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--all", action="store_true")
    parser.add_argument("program")
    arguments = parser.parse_args()
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        program = Program(os.path.abspath(arguments.program), folder)
        write_scene(os.path.join(folder, "small.gltf"))
        program.render("frame.exr", "--layers", "all", "--spp", str(SAMPLES))
        check_splits(report, program, few_splits())
        if not arguments.all:
            program.options.append("--no-guiding")
            program.parts.clear()
            program.render("frame.exr", "--layers", "all", "--spp", str(SAMPLES))
        check_nested(report, program)
        check_dealt(report, program)
        check_holes(report, program)
        check_foreign(report, program)
        check_damage(report, program)
        check_stopped(report, program)
        check_changing(report, program)
        check_line(report, program)
        if arguments.all:
            check_splits(report, program, more_splits())
            check_uneven(report, program)
            check_time_and_lines(report, program)
            check_memory(report, program)
            check_displays(report, program)
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
