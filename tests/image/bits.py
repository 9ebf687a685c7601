# SPDX-License-Identifier: Apache-2.0
"""bits.py [--small | --all | --against OTHER] PARHELION -- a frame's pixels have the same bits
with 1, 2 and 5 threads, as its denoised picture has, and a crop has those of the whole; an
instruction set that is asked for gives the same bits on a CPU that has more. --small: one render
with 2 threads of the small scene, for the thread sanitizer. --all: where light comes from is
learnt in every scene, under every sky, not in one and under one; and the dashboard has more
pixels and samples. --against: the same bits as another build's.
"""
import argparse
import hashlib
import os
import subprocess
import sys
import tempfile

from exr import Frame
from gltf import Scene, png

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402


# Every kind of modelled sky: their tables are made in double precision before the first ray.
PLACE = ["--when", "2026-06-21T08:30+02:00", "--where", "48.14,11.58,520"]
SKIES = [("sky:clear", PLACE), ("cie:12:20000", ["--sun", "120,35"]),
         ("perez:800,100", PLACE), ("constant:500", ["--sun", "200,30,90000"])]


def write_scene(path):
    """A little of everything that a path can meet."""
    scene = Scene()
    scene.box_inside(scene.lambert(0.7), [-2, 0, -2], [2, 2.5, 2])
    scene.facing_quad(scene.emitter(500), [0, 2.49, 0], [0, -1, 0], 0.8)
    scene.sphere(scene.metal(0.8, 0.3), [-0.7, 0.5, -0.8], 0.5)
    scene.sphere(scene.metal(0.9), [0.7, 0.5, -0.8], 0.5, rings=12)
    scene.facing_quad(scene.window(1.52, (0.9, 1, 0.9)), [0, 1, 0.5], [0.3, 0, 1], 1.5)
    picture = scene.image("image/png", png(2, 2, [[255, 0, 0, 0, 255, 0],
                                                  [0, 0, 255, 255, 255, 255]]))
    scene.quad(scene.material(pbrMetallicRoughness={
        "baseColorTexture": {"index": picture}, "roughnessFactor": 0.4, "metallicFactor": 0}),
        [-1, 0.5, -1.9], [2, 0, 0], [0, 1.5, 0])
    scene.facing_quad(scene.metal(0.9), [-1.5, 0.8, 0.8], [1, 0, 0], 0.8)
    scene.facing_quad(scene.emitter(50000), [0.5, 0.9, 1], [-1, -0.2, 0], 0.05)
    scene.light("spot", 200, [1, 2.2, 1], [-1, -2, -1])
    scene.light("spot", 500, [0.5, 1, 0.6], [-1, -0.1, 0])
    scene.view("eye", [0, 1.2, 1.9], [0, -0.1, -1], 60)
    scene.write(path)


# What the C library is told not to use: its exp, sin ... then round otherwise.
LESSER_CPU = {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2,-AVX512F,-AVX512VL,-ERMS"}


def render(program, scenes, out, options, environment=None):
    done = subprocess.run([program, "render", *scenes, "-o", out, "--layers", "all", "--quiet",
                           *options], capture_output=True, text=True,
                          env={**os.environ, **(environment or {})})
    if done.returncode != 0:
        print(done.stdout + done.stderr)
        return None
    return Frame(out)


def digest(frame, box):
    """SHA-256 over every channel's values inside the box."""
    total = hashlib.sha256()
    pixels = frame.pixels(box)
    for name in sorted(frame.channels):
        channel = frame.channels[name]
        total.update(name.encode())
        total.update(type(channel)(channel.typecode, [channel[i] for i in pixels]).tobytes())
    return total.hexdigest()


def picture(program, frame, threads):
    """The bytes of its picture, which many threads filter and compress."""
    out = frame + ".png"
    done = subprocess.run([program, "develop", frame, "-o", out, "--denoise", "--adapt", "local",
                           "--quiet", "--threads", str(threads)], capture_output=True, text=True)
    if done.returncode != 0:
        print(done.stdout + done.stderr)
        return None
    with open(out, "rb") as file:
        return file.read()


def compare(report, program, scenes, folder, options):
    """Threads against each other, then a crop against the whole."""
    name, out = os.path.basename(scenes[0]), os.path.join(folder, "frame.exr")
    frames = {threads: render(program, scenes, out, [*options, "--threads", str(threads)])
              for threads in (1, 2, 5)}
    if not report.claim(None not in frames.values(), f"{name}: not rendered"):
        return
    whole = frames[1]
    for threads in (2, 5):
        report.claim(digest(frames[threads], whole.box) == digest(whole, whole.box),
                     f"{name}: {threads} threads give other bits than one")
    alone = picture(program, out, 1)
    report.claim(alone is not None, f"{name}: not developed")
    for threads in (2, 5):
        report.claim(picture(program, out, threads) == alone,
                     f"{name}: {threads} threads give another picture than one")
    x1, y1 = whole.width - 7, whole.height - 3
    crop = render(program, scenes, out, [*options, "--crop", f"13,5,{x1},{y1}"])
    if report.claim(crop is not None and crop.box == (13, 5, x1, y1), f"{name}: crop's window"):
        report.claim(digest(crop, crop.box) == digest(whole, crop.box),
                     f"{name}: the crop has other bits than the whole")
    seed = render(program, scenes, out, [*options, "--seed", "2"])
    report.claim(seed is not None and digest(seed, None) != digest(whole, None),
                 f"{name}: another seed gives the same bits")
    print(f"{name}: {digest(whole, whole.box)}")


def compare_cpus(report, program, scenes, folder, options):
    """One instruction set on a CPU that has more and on one that, to the C library, has not."""
    name, out = os.path.basename(scenes[0]), os.path.join(folder, "frame.exr")
    options = [*options, "--isa", "sse2"]
    frames = [render(program, scenes, out, options, environment)
              for environment in (None, LESSER_CPU)]
    if report.claim(None not in frames, f"{name}: not rendered"):
        report.claim(digest(frames[0], None) == digest(frames[1], None),
                     f"{name} {options}: a lesser CPU gives other bits")


def compare_builds(report, programs, scenes, folder, options):
    """Two programs, one picture."""
    name, out = os.path.basename(scenes[0]), os.path.join(folder, "frame.exr")
    frames = [render(program, scenes, out, options) for program in programs]
    if report.claim(None not in frames, f"{name}: not rendered"):
        report.claim(digest(frames[0], None) == digest(frames[1], None),
                     f"{name}: {programs[0]} and {programs[1]} give different bits")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--small", action="store_true")
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--against")
    parser.add_argument("program")
    arguments = parser.parse_args()
    report, program = Report(), os.path.abspath(arguments.program)
    with tempfile.TemporaryDirectory() as folder:
        small = os.path.join(folder, "small.gltf")
        write_scene(small)
        dashboard = [os.path.join(ROOT, "scenes", name)
                     for name in ("car_dashboard.gltf", "noon.gltf")]
        learns = [] if arguments.all or arguments.against else ["--no-guiding"]
        works = [([small], ["--size", "96x64", "--spp", "8"]),
                 ([small], ["--size", "64x48", "--spp", "4", "--no-guiding"]),
                 (dashboard, ["--size", "64x36", "--spp", "2", *learns] if learns else
                  ["--size", "96x54", "--spp", "4"])]
        cpus = [([small], ["--size", "48x32", "--spp", "4", "--environment", sky, *more,
                           *(learns if i else [])]) for i, (sky, more) in enumerate(SKIES)]
        if arguments.small:
            frame = render(program, [small], os.path.join(folder, "frame.exr"),
                           ["--size", "32x32", "--spp", "2", "--threads", "2"])
            report.claim(frame is not None, "two threads at once")
            works = cpus = []
        for scenes, options in cpus:
            compare_cpus(report, program, scenes, folder, options)
        for scenes, options in works:
            if arguments.against:
                other = os.path.abspath(arguments.against)
                compare_builds(report, [program, other], scenes, folder, options)
            else:
                compare(report, program, scenes, folder, options)
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
