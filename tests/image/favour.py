# SPDX-License-Identifier: Apache-2.0
"""favour.py PARHELION -- --for gives all samples to an area: its pixels have the bits of a
frame of as many samples, all others those of an eighth of them; in parts, crops, any threads,
and stopped and resumed as in one run. For noise each pixel has the bits of a frame of its own
number of samples, more where noise is, and the frame's error falls faster.
"""
import json
import os
import signal
import statistics
import subprocess
import sys
import tempfile

from bits import digest
from exr import Frame
from gltf import Scene, png

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

SIZE = 40, 24
SAMPLES, OTHERS = 24, 8
SQUARE = 4  # pixels of one share
RECT = (5, 3, 22, 15)
PANEL = os.path.abspath(os.path.join(ROOT, "assets", "panels", "ips_cluster.panel"))


def write_scene(path):
    """Two displays in a room, one of them behind a window."""
    scene = Scene()
    scene.box_inside(scene.lambert(0.6), [-2, 0, -2], [2, 2.5, 2])
    scene.facing_quad(scene.emitter(800), [0, 2.49, 0], [0, -1, 0], 0.8)
    scene.facing_quad(scene.window(1.52), [-0.6, 1.2, 0], [0.2, 0, 1], 0.8)
    content = scene.image("image/png", png(2, 1, [[255, 200, 90, 20, 40, 255]]))
    for name, x in ("left", -0.9), ("right", 0.3):
        material = scene.material(name, extensions={"PARHELION_display": {
            "panel": os.path.relpath(PANEL, os.path.dirname(path)),
            "content": {"index": content}, "level": 1}})
        scene.quad(material, [x, 0.9, -1], [0.6, 0, 0], [0, 0.4, 0])
    scene.view("eye", [0, 1.2, 1.9], [0, -0.05, -1], 50)
    scene.write(path)


class Program:
    def __init__(self, path, folder):
        self.path, self.folder = path, folder

    def words(self, out, *options):
        return [self.path, "render", "room.gltf", "-o", out, "--size", "{}x{}".format(*SIZE),
                "--root", ROOT, "--quiet", "--layers", "all", *options]

    def run(self, out, *options):
        return subprocess.run(self.words(out, *options), cwd=self.folder, capture_output=True,
                              text=True)

    def file(self, name):
        return os.path.join(self.folder, name)

    def frame(self, out, *options):
        done = self.run(out, *options)
        if done.returncode != 0:
            print(done.stderr)
        return Frame(self.file(out))

    def read(self, name):
        with open(self.file(name), "rb") as file:
            return file.read()


def pixel(frame, i):
    """Its bits in every channel: what is no number differs from itself."""
    return [channel[i:i + 1].tobytes() for channel in frame.channels.values()]


def check_pixels(report, program, area, is_inside):
    """is_inside(x, y, frame of all samples): does the pixel count for sure, or surely not?
    None: an edge, where either may be."""
    frame = program.frame("frame.exr", "--spp", str(SAMPLES), "--for", area)
    whole = program.frame("whole.exr", "--spp", str(SAMPLES))
    others = program.frame("others.exr", "--spp", str(SAMPLES // OTHERS))
    wrong, counts = [], {True: 0, False: 0}
    for i in range(SIZE[0] * SIZE[1]):
        full = frame.channels["samples.N"][i] == SAMPLES
        wanted = is_inside(i % SIZE[0], i // SIZE[0], whole)
        counts[full] += 1
        if pixel(frame, i) != pixel(whole if full else others, i) or wanted not in (full, None):
            wrong.append(i)
    report.claim(not wrong, f"--for {area}: {len(wrong)} pixels have other bits or counts, the "
                            f"first {wrong[:1]}")
    report.claim(counts[True] > 20 and counts[False] > 20, f"--for {area}: {counts}")
    said = frame.attributes.get("parhelion:for", b"").decode()
    report.claim(said.endswith("of other pixels 1 in 8"), f"--for {area}: it says {said}")


def shows(names):
    """By the samples that saw one, in the pixel and about it."""
    def is_inside(x, y, frame):
        def share(i, j):
            at = j * SIZE[0] + i
            seen = frame.channels["display.coverage"][at]
            own = frame.channels["id.display"][at] in names
            return seen if own else 0
        near = [share(i, j) for i in range(max(x - 1, 0), min(x + 2, SIZE[0]))
                for j in range(max(y - 1, 0), min(y + 2, SIZE[1]))]
        return True if max(near) == 1 else False if max(near) == 0 else None
    return is_inside


def in_rect(x, y, _):
    return RECT[0] <= x < RECT[2] and RECT[1] <= y < RECT[3]


def luminances(frame):
    rgb = [frame.channels[name] for name in "RGB"]
    return [0.2126 * r + 0.7152 * g + 0.0722 * b for r, g, b in zip(*rgb)]


def spreads(program, options):
    """Relative standard deviation of each pixel, and samples of all, over some seeds."""
    frames = [program.frame("seed.exr", *options, "--seed", str(seed)) for seed in range(8)]
    columns = list(zip(*map(luminances, frames)))
    lowest = 0.5 * statistics.geometric_mean(
        [statistics.mean(column) for column in columns if statistics.mean(column) > 0])
    return ([statistics.stdev(column) / max(statistics.mean(column), lowest)
             for column in columns], sum(frames[0].channels["samples.N"]))


def check_noise(report, program):
    """Each pixel as a frame of its own count; many samples where the noise of another seed is;
    and less error than as many samples spread evenly."""
    lamp = ["--eye", "0,1.9,0.1", "--look-at", "0.45,2.5,0", "--fov", "60"]
    frame = program.frame("frame.exr", "--spp", "64", "--for", "noise", *lamp)
    counts = [int(n) for n in frame.channels["samples.N"]]
    wrong = [i for n in sorted(set(counts))
             for plain in [program.frame("plain.exr", "--spp", str(n), *lamp)]
             for i in range(len(counts)) if counts[i] == n and pixel(frame, i) !=
             pixel(plain, i)]
    report.claim(not wrong, f"--for noise: {len(wrong)} pixels have other bits, {wrong[:1]}")
    squares = {(i % SIZE[0] // SQUARE, i // SIZE[0] // SQUARE): n for i, n in enumerate(counts)}
    report.claim(all(squares[i % SIZE[0] // SQUARE, i // SIZE[0] // SQUARE] == n
                     for i, n in enumerate(counts)), "a square of several counts")
    report.claim(min(counts) >= 4 and max(counts) <= 64 and len(set(counts)) > 8,
                 f"counts {sorted(set(counts))}")
    error, taken = spreads(program, ["--spp", "64", "--for", "noise", *lamp])
    mean = taken / len(counts)
    plain, _ = spreads(program, ["--spp", str(round(mean)), *lamp])
    ratio = statistics.mean(error) / statistics.mean(plain) * (mean / round(mean)) ** 0.5
    report.claim(ratio < 0.93, f"the error of as many samples, spread evenly: {ratio:.3f}")
    halves = sorted(range(len(counts)), key=lambda i: plain[i])
    share = [statistics.mean(counts[i] for i in half)
             for half in (halves[:len(halves) // 2], halves[len(halves) // 2:])]
    report.claim(share[1] > 1.5 * share[0], f"samples of quiet and of noisy pixels: {share}")
    said = frame.attributes.get("parhelion:for", b"").decode()
    report.claim(said == "samples where 4 of each pixel found noise", f"it says {said}")


def check_noise_answer(report, program):
    done = program.run("frame.exr", "--spp", "64", "--for", "noise", "--json")
    answer, counts = json.loads(done.stdout), Frame(program.file("frame.exr")).channels[
        "samples.N"]
    told = answer["for"]
    report.claim(told["area"] == "noise" and told["others"] is None and told["pixels"] ==
                 sum(n == 64 for n in counts) and
                 abs(told["mean_samples"] - statistics.mean(counts)) < 1e-3, f"{told}")
    dark = program.frame("dark.exr", "--spp", "8", "--for", "noise", "--max-bounces", "0",
                         "--eye", "0,1.2,1.9", "--look-at", "0,1.2,3")
    report.claim(set(dark.channels["samples.N"]) == {8}, "a black frame has fewer samples")
    done = program.run("no.exr", "--spp", "1", "--noise", "noise:0.1")
    report.claim(done.returncode == 2 and "--noise noise:R: required: display" in done.stderr,
                 f"--noise noise: {done.stderr}")


def check_same(report, program, favour):
    """In parts, by another number of threads, and with another seed the same area."""
    program.frame("frame.exr", "--spp", str(SAMPLES), *favour)
    parts = [(f"p{k}.exr", options) for k, options in enumerate((
        ["--spp", str(SAMPLES), "--crop", "0,0,13,24"],
        ["--samples", "0:5", "--crop", "13,0,40,24"],
        ["--samples", f"5:{SAMPLES}", "--crop", "13,0,40,24", "--threads", "1"]))]
    for name, options in parts:
        program.frame(name, *options, *favour)
    done = subprocess.run([program.path, "merge", *[name for name, _ in parts], "-o",
                           "merged.exr", "--quiet"], cwd=program.folder, capture_output=True,
                          text=True)
    report.claim(done.returncode == 0 and program.read("merged.exr") ==
                 program.read("frame.exr"), f"parts make another frame: {done.stderr}")
    seed = program.frame("seed.exr", "--spp", str(SAMPLES), *favour, "--seed", "3")
    frame = Frame(program.file("frame.exr"))
    report.claim(seed.channels["samples.N"] == frame.channels["samples.N"],
                 "another seed favours other pixels")
    report.claim(digest(seed, None) != digest(frame, None), "a seed that changes nothing")
    program.frame("p0.exr", "--spp", str(SAMPLES), "--crop", "0,0,13,24")
    done = subprocess.run([program.path, "merge", "p0.exr", "p1.exr", "p2.exr", "-o", "m.exr"],
                          cwd=program.folder, capture_output=True, text=True)
    report.claim(done.returncode != 0 and "all samples for" in done.stderr,
                 f"a part without --for among others: {done.stderr}")


def check_resumed(report, program, area):
    goal = ["--spp", "4000", "--noise", "display:0.02"]
    long = [*goal, "--for", area]
    program.frame("frame.exr", *long)
    whole = program.read("frame.exr")
    run = subprocess.Popen(program.words("frame.exr", *long, "--checkpoint-interval", "0"),
                           cwd=program.folder, stdout=subprocess.PIPE,
                           stderr=subprocess.PIPE, text=True)
    while run.poll() is None and not os.path.exists(program.file("frame.exr.checkpoint")):
        pass
    run.send_signal(signal.SIGTERM)
    said = run.communicate()[1]
    report.claim(run.returncode == 128 + signal.SIGTERM, f"not stopped: {said}")
    done = program.run("frame.exr", *goal, "--resume")
    report.claim(done.returncode != 0 and "all samples for" in done.stderr,
                 f"a checkpoint of --for by a run without: {done.stderr}")
    program.frame("frame.exr", *long, "--resume")
    report.claim(program.read("frame.exr") == whole, "stopped and resumed: other bytes")


def check_answer(report, program):
    """An area's error for less: what was taken is counted true."""
    goal = ["--noise", "display:right:0.03"]
    answers = [json.loads(program.run("frame.exr", *goal, "--json", *options).stdout)
               for options in ([], ["--for", "display:right"])]
    taken = sum(Frame(program.file("frame.exr")).channels["samples.N"])
    plain, favoured = answers
    report.claim(plain["for"] is None and favoured["for"]["area"] == "display:right" and
                 favoured["for"]["others"] == 1 / OTHERS, f"the answer: {favoured['for']}")
    report.claim(favoured["samples"] == plain["samples"] and favoured["complete"],
                 "the area's error wants another number of samples")
    count = favoured["for"]["pixels"]
    others = SIZE[0] * SIZE[1] - count
    n = favoured["samples"]
    report.claim(taken == count * n + others * -(-n // OTHERS), f"{taken} samples in the layer")
    rate = favoured["samples_per_s"] * favoured["seconds"]
    report.claim(abs(rate / taken - 1) < 1e-3, f"{rate} samples told, {taken} taken")


def check_denoised(report, program):
    """Pixels around the area have fewer samples: they are filtered with the others."""
    for area in ([], ["--for", "display"], ["--for", "noise"]):
        program.frame("frame.exr", "--spp", "48", *area)
        done = subprocess.run([program.path, "develop", "frame.exr", "--denoise", "-o", "a.png",
                               "--json", "--quiet"], cwd=program.folder, capture_output=True,
                              text=True)
        answer = json.loads(done.stdout or "{}")
        report.claim(abs(answer.get("denoised", {}).get("energy_ratio", 0) - 1) < 0.02,
                     f"denoised {area}: {answer.get('denoised')} {done.stderr}")


def check_words(report, program):
    cases = [(["--for", "display:lft"], "--for display:lft: no display has this name"),
             (["--for", "1,2,3"], "--for 1,2,3: required: noise, display, display:NAME or "
                                  "whole"),
             (["--for", "0,0,41,3"], "inside 0,0,40,24"),
             (["--for", ""], "--for '': required: a text that is not empty")]
    for options, wanted in cases:
        done = program.run("no.exr", "--spp", "1", *options)
        report.claim(done.returncode == 2 and wanted in done.stderr and
                     done.stderr.count("\n") == 1, f"{options}: {done.stderr}")
        report.claim(not os.path.exists(program.file("no.exr")), f"{options}: left a frame")
    done = program.run("away.exr", "--spp", "8", "--eye", "0,1.2,1.9", "--look-at", "0,1.2,3",
                       "--for", "display")
    report.claim(done.returncode == 0 and "nothing of the displays is in view: --for" in
                 done.stderr, f"no display in view: {done.stderr}")
    done = program.run("beside.exr", "--spp", "8", "--crop", "0,0,2,2", "--for", "display",
                       "--json")
    told = json.loads(done.stdout)
    report.claim(told["samples"] == 8 and not done.stderr and told["for"]["pixels"] == 0 and
                 told["for"]["samples_of_others"] == 1, f"beside the area: {told}{done.stderr}")


def main():
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        program = Program(os.path.abspath(sys.argv[1]), folder)
        write_scene(program.file("room.gltf"))
        check_pixels(report, program, "display", shows([0, 1]))
        check_pixels(report, program, "display:right", shows([1]))
        check_pixels(report, program, ",".join(map(str, RECT)), in_rect)
        check_noise(report, program)
        check_noise_answer(report, program)
        for area in "display:left", "noise":
            check_same(report, program, ["--for", area])
        for area in "display", "noise":
            check_resumed(report, program, area)
        check_answer(report, program)
        check_denoised(report, program)
        check_words(report, program)
    report.finish()


if __name__ == "__main__":
    main()
