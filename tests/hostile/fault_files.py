# SPDX-License-Identifier: Apache-2.0
"""fault_files.py -- disks, folders, permissions, files that change: part of faults.py.

Documented in README.md beside it and in src/base/file.h: status 4 with the output's name and
the system's reason when an output cannot be written, status 3 likewise for an input; no
half-written file, under no name.
"""
import json
import math
import os
import resource
import shutil
import signal
import subprocess
import threading
import time

from fault_kit import NOBODY, ROOT, tree
from mutate import sound_scene

FULL, PROTECTED, DENIED = "No space left", "Read-only file system", "Permission denied"
RECIPE = os.path.join(ROOT, "assets", "panels", "ips_cluster.recipe.json")
SKY = ("--environment", "cie:1:10000")


def table_text(scale=1.0):
    """A white table of 49 directions."""
    rows = ["theta,phi,X,Y,Z"]
    for theta in (0, 20, 40, 60):
        for phi in range(0, 360, 30) if theta else (0,):
            y = scale * 400 * math.cos(math.radians(theta)) ** 1.5
            rows.append(f"{theta},{phi},{0.95 * y:.6g},{y:.6g},{1.09 * y:.6g}")
    return "\n".join(rows) + "\n"




def make_inputs(bench):
    """A scene, its frame, a panel, its table, a sky: what the commands below work on."""
    if os.path.exists(bench.file("in", "x.panel")):
        return
    os.makedirs(bench.file("in"), exist_ok=True)
    sound_scene().write(bench.file("in", "scene.gltf"))
    with open(bench.file("in", "white.csv"), "w") as file:
        file.write(table_text())
    bench.works(bench.render(bench.file("in", "scene.gltf"), out="in/frame.exr"))
    done = bench.run("panel", "fit", bench.file("in", "white.csv"), "-o",
                     bench.file("in", "x.panel"), "--quiet")
    bench.works(done)


def writers(bench, folder):
    """(name of the output, the command that writes it there)."""
    scene, frame = bench.file("in", "scene.gltf"), bench.file("in", "frame.exr")
    panel, table = bench.file("in", "x.panel"), bench.file("in", "white.csv")

    def to(*names):
        return os.path.join(folder, *names)
    tiny = ("--size", "64x64", "--spp", "1", "--quiet")
    return [
        ("f.exr", ("render", scene, "-o", to("f.exr"), *tiny)),
        ("p.png", ("develop", frame, "-o", to("p.png"))),
        ("x.panel", ("panel", "fit", table, "-o", to("x.panel"), "--quiet")),
        ("white.csv", ("panel", "import", table, "--role", "white.csv=white", "-o",
                       to("MANIFEST.json"), "--quiet")),
        ("sim", ("panel", "simulate", RECIPE, "-o", to("sim"), "--grid", "4x6", "--quiet")),
        ("plot.svg", ("panel", "plot", panel, "--kind", "luminance", "-o", to("plot.svg"))),
        ("r.html", ("panel", "report", panel, "-o", to("r.html"))),
        ("tables", ("panel", "report", panel, "--csv", to("tables"))),
        ("sky.exr", ("sky", *SKY, "-o", to("sky.exr"), "--size", "64x32")),
        ("sky.png", ("sky", *SKY, "-o", to("sky.png"))),
    ]


def fill_disk(bench, free, names):
    make_inputs(bench)
    disk = bench.file("small")
    if disk not in bench.disks.mounted and not bench.disks.small(disk, 64):
        return bench.report.skip("a full disk: this process may not mount one")
    with open(os.path.join(disk, "filler"), "wb") as file:
        file.write(bytes(65536 - free))
    before = tree(disk)
    for name, command in writers(bench, disk):
        if name in names:
            bench.fails(bench.run(*command), 4, FULL, what=f"{free} bytes free, {name}")
            bench.leaves(before, disk, f"{free} bytes free, {name}")


def check_full_disk(bench):
    """Not a byte free."""
    fill_disk(bench, 0, [name for name, _ in writers(bench, "")])


def check_nearly_full_disk(bench):
    """A page is free: what is larger is begun and cannot be finished."""
    fill_disk(bench, 4096, ("f.exr", "white.csv", "sim", "plot.svg", "r.html",
                            "sky.png"))


def check_picture_on_full_disk(bench):
    """The frame is whole and stays, the picture that does not fit is status 4."""
    make_inputs(bench)
    bench.disks.small(bench.file("small_too"), 4)
    done = bench.render(bench.file("in", "scene.gltf"), "--png",
                        bench.file("small_too", "p.png"), out="stays.exr", size="64x64")
    if not bench.disks.are_there:
        return bench.report.skip("a full disk: this process may not mount one")
    bench.fails(done, 4, "p.png", FULL)
    bench.claim(os.path.exists(bench.file("stays.exr")), "the frame went with its picture")
    bench.leaves([], bench.file("small_too"), "the picture on a full disk")


def check_file_limit(bench):
    """ulimit -f, whose signal would kill: as a full disk. Needs no right to mount."""
    make_inputs(bench)
    os.makedirs(bench.file("limited"), exist_ok=True)
    few = (writers(bench, bench.file("limited"))[i] for i in (0, 4, 5, 6))
    for name, command in few:
        done = bench.run(*command, limits=[(resource.RLIMIT_FSIZE, 1024)])
        bench.fails(done, 4, "File too large", what=f"ulimit -f, {name}")
        bench.leaves([], bench.file("limited"), f"ulimit -f, {name}")


def check_read_only_disk(bench):
    make_inputs(bench)
    disk = bench.file("read_only")
    os.makedirs(disk, exist_ok=True)
    with open(os.path.join(disk, "f.exr"), "wb") as file:
        file.write(b"kept")
    if not bench.disks.read_only(disk):
        return bench.report.skip("a read-only disk: this process may not mount one")
    for name, command in writers(bench, disk):
        bench.fails(bench.run(*command), 4, PROTECTED, what=f"read-only disk, {name}")


def check_permissions(bench):
    """As a user who may read the inputs and nothing else: root may do everything."""
    make_inputs(bench)
    if os.geteuid() != 0:
        return bench.report.skip("missing permissions: needs to become another user")
    if bench.run("--version", user=NOBODY).returncode != 0:
        return bench.report.skip("missing permissions: others may not run the program")
    folder, locked = bench.file("theirs"), bench.file("locked")
    os.makedirs(folder, exist_ok=True)
    os.makedirs(locked, exist_ok=True)
    os.chmod(locked, 0o555)
    scene, out = bench.file("in", "scene.gltf"), bench.file("theirs", "f.exr")
    for name, command in writers(bench, locked)[:5]:
        bench.fails(bench.run(*command, user=NOBODY), 4, DENIED, what=f"no permission, {name}")
    os.chmod(folder, 0o777)
    with open(out, "wb") as file:
        file.write(b"kept")
    os.chmod(out, 0o444)
    render = ("render", scene, "-o", out, "--size", "8x8", "--spp", "1", "--quiet")
    bench.fails(bench.run(*render, user=NOBODY), 4, "f.exr", DENIED,
                what="over a write-protected frame")
    bench.claim(open(out, "rb").read() == b"kept", "a write-protected frame was replaced")
    secret = bench.file("in", "secret.gltf")
    shutil.copy(scene, secret)
    os.chmod(secret, 0)
    for command in (("render", secret, "-o", bench.file("theirs", "g.exr"), "--quiet"),
                    ("develop", secret, "-o", bench.file("theirs", "p.png")),
                    ("panel", "info", secret), ("panel", "fit", secret, "-o",
                                                bench.file("theirs", "x.panel")),
                    ("panel", "import", secret, "-o", bench.file("theirs", "MANIFEST.json"))):
        bench.fails(bench.run(*command, user=NOBODY), 3, "secret.gltf", DENIED)
    bench.claim(sorted(os.listdir(folder)) == ["f.exr"], f"left {os.listdir(folder)}")


def check_places(bench):
    """A folder where a file is required and the other way round; a folder that is not there."""
    make_inputs(bench)
    folder = bench.file("folders")
    for name in ("f.exr", "p.png", "x.panel", "plot.svg", "MANIFEST.json", "sky.exr"):
        os.makedirs(os.path.join(folder, name), exist_ok=True)
    for name in ("sim", "tables"):
        with open(os.path.join(folder, name), "w") as file:
            file.write("kept")
    before = tree(folder)
    for name, command in writers(bench, folder):
        if name in ("r.html", "sky.png", "white.csv"):
            continue
        done = bench.run(*command)
        bench.fails(done, 4, name, what=f"{name} is a folder")
        bench.leaves(before, folder, f"{name} is a folder")
    for name, command in writers(bench, bench.file("not", "there")):
        words = ("No such file",) if name not in ("white.csv", "sim") else ()
        bench.fails(bench.run(*command), 4, *words, what=f"no such folder, {name}")
    bench.claim(not os.path.exists(bench.file("not")), "a folder was made on the way")
    bench.fails(bench.run("render", folder, "-o", bench.file("x.exr"), "--quiet"), 3,
                "is a folder")
    bench.fails(bench.run("panel", "info", folder), 3, "is a folder")
    bench.fails(bench.run("panel", "fit", folder, "-o", bench.file("y.panel")), 3,
                "is a folder")


def check_special_files(bench):
    """Devices take what is written; a pipe as an input is not waited for."""
    make_inputs(bench)
    full, pipe = bench.file("full.exr"), bench.file("pipe.gltf")
    os.symlink("/dev/full", full)
    bench.fails(bench.render(bench.file("in", "scene.gltf"), out="full.exr"), 4, FULL)
    os.mkfifo(pipe)
    for command in (("check", pipe), ("panel", "info", pipe),
                    ("develop", pipe, "-o", bench.file("z.png")),
                    ("panel", "fit", pipe, "-o", bench.file("y.panel")),
                    ("panel", "import", pipe, "-o", bench.file("MANIFEST.json")),
                    ("panel", "simulate", pipe, "-o", bench.file("y"))):
        done = bench.run(*command, timeout=20)
        bench.claim_sound(done) and bench.claim(
            done.returncode == 3 and "not a regular file" in done.stderr + done.stdout,
            f"{command[0]} of a pipe: {done.returncode} {done.stderr.strip()}")


def check_stdout(bench):
    """An answer that nobody could read is status 4; a reader who left is no death."""
    make_inputs(bench)
    panel, scene = bench.file("in", "x.panel"), bench.file("in", "scene.gltf")
    for command in (("--help",), ("check", scene), ("panel", "info", panel, "--json")):
        with open("/dev/full", "w") as full:
            bench.fails(bench.run(*command, stdout=full), 4, "stdout", FULL)
    read, write = os.pipe()
    os.close(read)
    bench.fails(bench.run("check", scene, stdout=write), 4, "stdout", "Broken pipe")
    os.close(write)
    with open("/dev/full", "w") as full:
        done = bench.render(scene, "--json", out="kept.exr", stdout=full)
    bench.fails(done, 4, "stdout", FULL)
    bench.claim(os.path.getsize(bench.file("kept.exr")) > 0, "the frame went with the answer")


def check_every_stdout(bench):
    make_inputs(bench)
    panel, scene = bench.file("in", "x.panel"), bench.file("in", "scene.gltf")
    for command in (("--version",), ("render", "--help"), ("check", scene, "--json"),
                    ("panel", "info", panel), ("sky", *SKY), ("sky", *SKY, "--json"),
                    ("panel", "eval", panel, "--theta", "0", "--phi", "0", "--rgb", "9,9,9"),
                    ("measure", bench.file("in", "frame.exr"))):
        with open("/dev/full", "w") as full:
            bench.fails(bench.run(*command, stdout=full), 4, "stdout", FULL)


def check_closed_streams(bench):
    """Where a stream is closed, the next file that is opened must not take its place."""
    make_inputs(bench)
    script = '"$0" render "$1" -o "$2" --size 8x8 --spp 1 >&- 2>&-'
    out = bench.file("closed.exr")
    done = subprocess.run(["sh", "-c", script, bench.program, bench.file("in", "scene.gltf"),
                           out], capture_output=True)
    bench.claim(done.returncode == 0 and open(out, "rb").read(4) == b"\x76\x2f\x31\x01",
                f"with closed streams: {done.returncode}, or the frame holds something else")


# ---- files that change while they are read ------------------------------------------------


def display_scene(bench):
    """A scene whose display has a panel, its content and vertices in files of their own."""
    scene = sound_scene()
    document = scene.document
    scene.used.add("PARHELION_display")
    document["materials"][0].setdefault("extensions", {})["PARHELION_display"] = {
        "panel": "moving.panel"}
    path = bench.file("in", "display.gltf")
    scene.write(path)
    with open(bench.file("in", "moving.bin"), "wb") as file:
        file.write(bytes(scene.binary))
    document["buffers"] = [{"byteLength": len(scene.binary), "uri": "moving.bin"}]
    with open(path, "w") as file:
        json.dump(document, file)
    shutil.copy(bench.file("in", "x.panel"), bench.file("in", "moving.panel"))
    return path


def wait_for_progress(running):
    """Its first line is JSON: everything is loaded, and signals are heard."""
    while not running.stderr.readline().startswith(b"{"):
        pass


def check_shrinking_while_used(bench):
    """A panel and vertices that are cut and then overwritten while a frame is being rendered:
    what was read counts."""
    make_inputs(bench)
    out = bench.file("used.exr")
    running = subprocess.Popen(
        [bench.program, "render", display_scene(bench), "-o", out, "--size", "320x180", "--spp",
         "1000000", "--threads", "1", "--progress", "json"], stderr=subprocess.PIPE)
    wait_for_progress(running)
    for name in ("moving.panel", "moving.bin"):
        os.truncate(bench.file("in", name), 0)
    time.sleep(0.3)
    for name in ("moving.panel", "moving.bin"):
        with open(bench.file("in", name), "wb") as file:
            file.write(os.urandom(100000))
    time.sleep(0.3)
    running.send_signal(signal.SIGINT)
    _, err = running.communicate(timeout=60)
    bench.claim(running.returncode == 130 and os.path.getsize(out) > 0,
                f"files that shrink while a frame is rendered: {running.returncode} "
                f"{err.decode()[-300:]}")


def check_shrinking_while_read(bench):
    """Somebody cuts, overwrites and restores the inputs all the time: each run reads them whole
    or refuses them, in one line."""
    make_inputs(bench)
    scene = display_scene(bench)
    names = [bench.file("in", name) for name in ("moving.panel", "moving.bin", "display.gltf")]
    whole = {name: open(name, "rb").read() for name in names}
    stop, turn = threading.Event(), [0]

    def disturb():
        while not stop.is_set():
            turn[0] += 1
            name = names[turn[0] % len(names)]
            data = whole[name]
            cut = len(data) * (turn[0] % 7) // 7
            with open(name, "r+b") as file:
                file.truncate(cut)
                if turn[0] % 2:
                    file.write(os.urandom(64))
                file.seek(0)
                file.write(data)
                file.truncate(len(data))
    thread = threading.Thread(target=disturb)
    thread.start()
    outcomes = {}
    for i in range(10 if bench.is_sanitized else 20):
        command = ("panel", "info", names[0]) if i % 2 else ("check", scene)
        done = bench.run(*command)
        outcomes[done.returncode] = outcomes.get(done.returncode, 0) + 1
        bench.claim_sound(done)
        bench.claim(done.returncode in (0, 3) and len(done.stderr.splitlines())
                    == (done.returncode == 3 and command[0] == "panel"),
                    f"files that change: {done.returncode} {done.stderr.strip()[:300]}")
    stop.set()
    thread.join()
    print(f"  inputs that change while they are read: statuses {outcomes}")


def check_interrupt(bench):
    """A frame of more samples than anybody waits for, stopped: a frame marked incomplete."""
    make_inputs(bench)
    out = bench.file("endless.exr")
    running = subprocess.Popen(
        [bench.program, "render", bench.file("in", "scene.gltf"), "-o", out, "--size", "64x36",
         "--spp", "4000000", "--threads", "1", "--progress", "json"], stderr=subprocess.PIPE)
    wait_for_progress(running)
    running.send_signal(signal.SIGTERM)
    _, err = running.communicate(timeout=60)
    bench.claim(running.returncode == 143 and b"incomplete" in err and os.path.getsize(out) > 0,
                f"--spp 4000000, TERM: {running.returncode} {err.decode()[-300:]}")


CHECKS = (check_full_disk, check_stdout, check_closed_streams, check_shrinking_while_used)
MORE = (check_nearly_full_disk, check_picture_on_full_disk, check_file_limit,
        check_every_stdout, check_read_only_disk, check_permissions, check_places,
        check_special_files, check_shrinking_while_read, check_interrupt)
