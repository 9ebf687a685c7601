# SPDX-License-Identifier: Apache-2.0
"""fault_memory.py -- address space that is short (ulimit -v): part of faults.py.

Documented in src/base/arena.h: whatever the limit, a command does its work, or one line says
that memory is short, with status 3. Below what the libraries need to be loaded there is no
program that could say anything; that limit is found first. The libraries of pictures are loaded
when one is met: 370 MB more, of which an error tells.
"""
import json
import os
import resource

from fault_files import make_inputs
from fault_limits import huge_png
from gltf import Scene

MEGABYTE = 1 << 20


def limited(bench, megabytes, *arguments):
    return bench.run(*arguments, limits=[(resource.RLIMIT_AS, megabytes * MEGABYTE)])


def least(bench):
    """Megabytes with which the program starts, to 8 MB."""
    low, high = 64, 4096
    while high - low > 8:
        middle = (low + high) // 2
        if limited(bench, middle, "--version").returncode == 0:
            high = middle
        else:
            low = middle
    return high


def sweep(bench, commands, steps):
    start = least(bench)
    ends = {}
    for step in steps:
        for name, command in commands:
            done = limited(bench, start + step, *command)
            lines = done.stderr.splitlines()
            what = f"{name} with {start + step} MB"
            ends.setdefault(name, []).append(done.returncode)
            bench.claim_sound(done, what) and bench.claim(
                done.returncode == 0 or done.returncode == 3 and (
                    name == "check" and "memory" in done.stdout or len(lines) == 1
                    and lines[0].startswith("parhelion: ")),
                f"{what}: {done.returncode} {lines[:3]}")
            part = [n for n in os.listdir(bench.folder) if ".part" in n]
            bench.claim(not part, f"{what}: left {part}")
    print(f"  the libraries need {start} MB; " + "; ".join(
        f"{name}: {statuses}" for name, statuses in ends.items()))
    return ends


def commands_of(bench):
    scene = bench.file("in", "scene.gltf")
    return [
        ("render", ("render", scene, "-o", bench.file("m.exr"), "--size", "64x36", "--spp", "1",
                    "--quiet", "--threads", "2")),
        ("develop", ("develop", bench.file("in", "frame.exr"), "-o", bench.file("m.png"))),
        ("fit", ("panel", "fit", bench.file("in", "white.csv"), "-o", bench.file("m.panel"),
                 "--quiet")),
        ("check", ("check", scene, "--json")),
        ("info", ("panel", "info", bench.file("in", "x.panel"))),
        ("plot", ("panel", "plot", bench.file("in", "x.panel"), "-o", bench.file("m.svg"),
                  "--threads", "2")),
        ("sky", ("sky", "--environment", "cie:1:10000", "-o", bench.file("m_sky.exr"))),
    ]


def check_short_memory(bench):
    if bench.is_sanitized:
        return bench.report.skip("limits of address space: the sanitizer takes terabytes of it")
    make_inputs(bench)
    ends = sweep(bench, commands_of(bench)[:1], (8, 64, 256, 512, 880))
    bench.claim(ends["render"][-1] == 0, "a gigabyte is not enough for a small scene")


def check_every_memory(bench):
    if bench.is_sanitized:
        return bench.report.skip("limits of address space: the sanitizer takes terabytes of it")
    make_inputs(bench)
    ends = sweep(bench, commands_of(bench),
                 (*range(8, 64, 8), *range(64, 512, 56), 1024, 2048, 4096))
    for name, statuses in ends.items():
        bench.claim(statuses[-1] == 0, f"{name} does not work with 4 GB")


def check_large_frame(bench):
    """A film that memory cannot hold is refused before anything is loaded."""
    make_inputs(bench)
    done = bench.render(bench.file("in", "scene.gltf"), "--layers", "all", size="32768x8192",
                        limits=() if bench.is_sanitized else
                        [(resource.RLIMIT_AS, 4096 * MEGABYTE)])
    if not bench.is_sanitized:
        bench.fails(done, 3, "the film of 32768x8192 pixels needs", "--crop")
    bench.fails(bench.render(bench.file("in", "scene.gltf"), size="65536x65536"), 2,
                "at most")


def scene_of_pictures(path, are_shown):
    """Sixteen materials, each with the large picture; they are somebody's, or nobody's."""
    scene = Scene()
    for i in range(16):
        material = scene.material(f"picture {i}", emissiveTexture={"index": i})
        if are_shown:
            scene.quad(material, [i, 0, 0], [1, 0, 0], [0, 1, 0])
    scene.document |= {"images": [{"uri": "hog.png"}] * 16,
                       "textures": [{"source": i} for i in range(16)]}
    scene.write(path)


def check_many_large_files(bench):
    """A small scene that names one large file again and again, and pictures that are small as
    files and large as texels: the arena's end is met, not the machine's. Pictures that nothing
    shows are told of and left out."""
    if bench.is_sanitized:
        return bench.report.skip("limits of address space: the sanitizer takes terabytes of it")
    with open(bench.file("hog.bin"), "wb") as file:
        file.truncate(512 * MEGABYTE)
    huge_png(bench.file("hog.png"), 8192, 8192, True)
    scene = bench.file("hog.gltf")

    def render():
        return limited(bench, 4096, "render", scene, "-o", bench.file("m.exr"), "--quiet",
                       "--size", "8x8", "--spp", "1")
    with open(scene, "w") as file:
        json.dump({"asset": {"version": "2.0"},
                   "buffers": [{"uri": "hog.bin", "byteLength": 4}] * 16}, file)
    bench.fails(render(), 3, warnings=True, what="16 large buffers")
    scene_of_pictures(scene, True)
    bench.fails(render(), 3, "8192 x 8192", warnings=True, what="16 large pictures")
    scene_of_pictures(scene, False)
    bench.works(render(), "no material shows it", "8192 x 8192",
                what="16 large pictures that nothing shows")


CHECKS = (check_short_memory, check_large_frame)
MORE = (check_every_memory, check_many_large_files)
