# SPDX-License-Identifier: Apache-2.0
"""fault_machine.py -- machines that grant little: few threads (RLIMIT_NPROC, as pids.max), a
control group's memory, light that no film holds: part of faults.py.

Documented in src/base/parallel.h, src/base/machine.h and cli/render/render_answer.h: a command
goes on with the threads there are, and gives the same bytes; memory that a group does not grant
is one line with status 3 instead of a kill.
"""
import os
import resource
import shutil

from fault_files import make_inputs
from fault_kit import NOBODY, ROOT
from fault_scenes import large_mesh
from gltf import Scene, png

GROUPS = "/sys/fs/cgroup/memory"
MEGABYTE = 1 << 20


def textured_scene(bench):
    """A lit floor whose picture is a JPEG, made by the program."""
    picture, path = bench.file("in", "floor.png"), bench.file("in", "floor.gltf")
    with open(picture, "wb") as file:
        file.write(png(16, 16, [[8 * x, 8 * y, 99] for y in range(16) for x in range(16)]))
    jpeg = bench.file("in", "floor.jpg")
    frame = bench.file("in", "frame.exr")
    done = bench.run("develop", frame, "-o", jpeg)
    bench.claim(done.returncode == 0, f"{jpeg}: {done.stderr[:200]}")
    scene = Scene()
    material = scene.material("floor", pbrMetallicRoughness={"baseColorTexture": {"index": 0}})
    scene.quad(material, [-1, 0, 0], [2, 0, 0], [0, 0, -3])
    scene.view("eye", [0, 1, 2], [0, -0.3, -1], 60)
    scene.document |= {"images": [{"uri": "floor.jpg"}], "textures": [{"source": 0}]}
    scene.write(path)
    os.chmod(bench.file("in"), 0o755)
    return path


def threads_outcome(bench, count, commands):
    """What the commands make where the user may have so many threads; None: no limit."""
    folder = bench.file(f"threads-{count}")
    os.makedirs(folder)
    os.chmod(folder, 0o777)
    limits = [] if count is None else [(resource.RLIMIT_NPROC, count)]
    made = {}
    for name, words in commands:
        done = bench.run(*words, cwd=folder, user=NOBODY, limits=limits)
        bench.claim_sound(done, f"{name} with {count} threads")
        bench.claim(done.returncode == 0, f"{name} with {count} threads: {done.returncode} "
                    f"{done.stderr[:300]}")
        path = os.path.join(folder, name)
        made[name] = open(path, "rb").read() if os.path.exists(path) else None
    return made


def check_few_threads(bench):
    if os.geteuid() != 0:
        return bench.report.skip("few threads: the limit is another user's")
    make_inputs(bench)
    scene = textured_scene(bench)
    commands = [
        ("f.png", ("render", scene, "-o", "f.exr", "--png", "f.png", "--size", "24x16", "--spp",
                   "2", "--environment", "constant:100", "--threads", "4", "--quiet")),
        ("d.png", ("develop", "f.exr", "-o", "d.png", "--threads", "4")),
        ("p.svg", ("panel", "plot", bench.file("in", "x.panel"), "-o", "p.svg", "--threads",
                   "4")),
        ("w.panel", ("panel", "fit", bench.file("in", "white.csv"), "-o", "w.panel",
                     "--quiet", "--threads", "4"))]
    free = threads_outcome(bench, None, commands)
    for count in (1, 2, 3, 4, 6):
        made = threads_outcome(bench, count, commands)
        for name, data in made.items():
            bench.claim(data is not None and data == free[name],
                        f"{name} with {count} threads: other bytes")


def check_small_stack(bench):
    """One line where a stack is too small for some command; from there on all of them work."""
    make_inputs(bench)
    scene, panel = bench.file("in", "scene.gltf"), bench.file("in", "x.panel")
    commands = [("check", scene), ("sky", "--environment", "constant:100"),
                ("render", scene, "-o", bench.file("f.exr"), "--size", "9x9", "--spp", "1",
                 "--environment", "constant:100"),
                ("develop", bench.file("in", "frame.exr"), "-o", bench.file("f.png")),
                ("measure", bench.file("in", "frame.exr")), ("panel", "info", panel),
                ("panel", "plot", panel, "-o", bench.file("p.svg")),
                ("panel", "report", panel, "-o", bench.file("p.html")),
                ("panel", "fit", bench.file("in", "white.csv"), "-o", bench.file("w.panel")),
                ("review", os.path.join(ROOT, "scenes", "glance.review.json"), "--dry-run")]
    for kilobytes in (64, 511, 512):
        for words in commands:
            limit = kilobytes << 10
            done = bench.run(*words, limits=[(resource.RLIMIT_STACK, limit)])
            is_enough = kilobytes >= 512
            if is_enough and bench.is_sanitized:
                continue
            is_line = done.stderr.count("\n") == 1 and "required: 512 — " in done.stderr
            bench.claim(done.returncode == (0 if is_enough else 5) and (is_enough or is_line),
                        f"{words[:2]} with {kilobytes} kB: {done.returncode} {done.stderr[:200]}")


def check_review_without_threads(bench):
    """Its ray tracers follow each other, and none can have a thread of its own."""
    cases = os.path.join(ROOT, "..", "shared", "data", "cases", "faults")
    if os.geteuid() != 0 or not os.path.isdir(cases):
        return bench.report.skip("a review without threads: no other user, or no cases")
    folder = bench.file("review")
    shutil.copytree(cases, folder)
    os.chmod(folder, 0o777)
    os.remove(os.path.join(folder, "ips.panel"))  # of an older version
    shutil.copyfile(os.path.join(ROOT, "assets", "panels", "ips_cluster.panel"),
                    os.path.join(folder, "ips.panel"))

    def answer(*limits):
        done = bench.run("review", os.path.join(folder, "not_usable.review.json"), "--json",
                         "--quiet", "--threads", "2", "-o", os.path.join(folder, "out"),
                         user=NOBODY, limits=limits, cwd=folder)
        bench.claim_sound(done, f"a review, {limits}")
        return done.returncode, done.stdout
    free, short = answer(), answer((resource.RLIMIT_NPROC, 1))
    bench.claim(free[0] == 0 and free == short,
                f"a review without threads: another answer, {free[0]}, {short[0]}")


def check_control_group(bench):
    """Real groups where this process may make one: a film of 1.5 GB within 1 GB, and a ray
    tracer that grows into the limit. Without memory the system kills without a word."""
    group = os.path.join(GROUPS, f"parhelion-{os.getpid()}")

    def limit(megabytes):
        with open(os.path.join(group, "memory.limit_in_bytes"), "w") as file:
            file.write(str(megabytes * MEGABYTE))
    try:
        os.mkdir(group)
        limit(1024)
    except OSError:
        return bench.report.skip("control groups: none can be made here")
    make_inputs(bench)

    def within(*arguments):
        def enter():
            with open(os.path.join(group, "tasks"), "w") as file:
                file.write(str(os.getpid()))
        return bench.run(*arguments, enter=enter)
    try:
        scene = bench.file("in", "scene.gltf")
        done = within("render", scene, "-o", bench.file("g.exr"), "--size", "8000x8000",
                      "--spp", "1", "--quiet")
        bench.fails(done, 3, "GB", "--crop", what="8000x8000 within 1 GB")
        bench.claim(not os.path.exists(bench.file("g.exr")), "a refused film left a frame")
        bench.works(within("render", scene, "-o", bench.file("g.exr"), "--size", "64x64",
                           "--spp", "1", "--quiet", "--json"), what="64x64 within 1 GB")
        scene = large_mesh(bench.folder, 600)
        for megabytes, statuses in ((60, (3,)), (70, (0, 3)), (80, (0, 3)), (160, (0,))):
            limit(megabytes)
            done = within("render", scene, "-o", bench.file("g.exr"), "--size", "64x64",
                          "--spp", "1", "--quiet")
            lines = [line for line in done.stderr.splitlines() if "warning" not in line]
            bench.claim(done.returncode in statuses and len(lines) == (done.returncode == 3)
                        and all("out of memory" in line for line in lines),
                        f"720,000 triangles within {megabytes} MB: {done.returncode} {lines}")
    finally:
        os.rmdir(group)


def lamp_scene(bench, luminance, half_height):
    """A glowing square of 1 m in a view of 2 half_height m."""
    scene = Scene()
    scene.facing_quad(scene.emitter(luminance), [0, 0, 0], [0, 0, 1], 1)
    scene.probe("eye", [0, 0, 5], [0, 0, -1], half_height)
    path = bench.file("glow.gltf")
    scene.write(path)
    return path


def check_dropped(bench):
    """Light beyond the film's range: all of it is no frame, some of it is told with its share,
    by a merge too."""
    frame, size = bench.file("frame.exr"), "16x16"
    bench.works(bench.render(lamp_scene(bench, 1e14, 0.4), "--json", size=size, spp=4))
    os.remove(frame)
    done = bench.render(lamp_scene(bench, 1e15, 0.4), "--json", size=size, spp=4)
    bench.fails(done, 3, "there is no frame: 1024 of 1024 samples (100 %)", "--replay 0,0,0")
    bench.claim(not os.path.exists(frame), "a frame without samples was written")
    scene = lamp_scene(bench, 1e15, 2 ** 0.5 / 2)
    bench.works(bench.render(scene, "--json", size=size, spp=4), "of 1024 samples (5",
                "left out")
    for first in (0, 2):
        bench.works(bench.run("render", scene, "--size", size, "--samples",
                              f"{first}:{first + 2}", "--quiet", "--json", "-o",
                              bench.file(f"part-{first}.exr")), "of 512 samples (")
    bench.works(bench.run("merge", bench.file("part-0.exr"), bench.file("part-2.exr"), "-o",
                          bench.file("whole.exr"), "--json", "--quiet"),
                "of 1024 samples (5", "left out")


CHECKS = (check_few_threads, check_small_stack, check_review_without_threads,
          check_control_group, check_dropped)
MORE = ()
