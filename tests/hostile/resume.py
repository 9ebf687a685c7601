# SPDX-License-Identifier: Apache-2.0
"""resume.py [--small | --kills N] PARHELION -- a render that is killed, stopped or starved goes
on from its checkpoint to the very file that it would have made; what is no checkpoint of it is
refused by name. --kills: how many SIGKILLs at random moments (default 3). --small: one stop and
one second signal with two threads, for the thread sanitizer.
"""
import argparse
import json
import os
import random
import resource
import shlex
import signal
import subprocess
import sys
import tempfile
import time

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
sys.path.insert(0, os.path.join(ROOT, "tests", "image"))
from gltf import Scene  # noqa: E402
from report import Report  # noqa: E402
from running import Running  # noqa: E402
from words import unless_given  # noqa: E402

FILE_LIMIT = 40000  # bytes: room for the little frame, none for its checkpoint
PATIENCE_S = 120


def write_scene(path):
    scene = Scene()
    scene.box_inside(scene.lambert(0.7), [-2, 0, -2], [2, 2.5, 2])
    scene.facing_quad(scene.emitter(500), [0, 2.49, 0], [0, -1, 0], 0.8)
    scene.sphere(scene.metal(0.8, 0.3), [-0.7, 0.5, -0.8], 0.5, rings=8)
    scene.facing_quad(scene.metal(0.9), [-1.5, 0.8, 0.8], [1, 0, 0], 0.8)
    scene.facing_quad(scene.emitter(50000), [0.5, 0.9, 1], [-1, -0.2, 0], 0.05)
    scene.light("spot", 500, [0.5, 1, 0.6], [-1, -0.1, 0])
    grey = {"metallicFactor": 0, "baseColorFactor": [0.8, 0.8, 0.8, 1]}
    scene.quad(scene.material("screen", pbrMetallicRoughness=grey), [-1, 0.5, -1.9], [2, 0, 0],
               [0, 1.5, 0])
    scene.view("eye", [0, 1.2, 1.9], [0, -0.1, -1], 60)
    scene.write(path)


def contents(path):
    with open(path, "rb") as file:
        return file.read()


class Work(Running):
    """A folder with a scene, and the renders in it. `common` are options of all of them."""

    def __init__(self, report, program, folder, *common):
        self.report, self.program, self.folder, self.common = report, program, folder, common
        write_scene(self.path("scene.gltf"))
        self.names = set(os.listdir(folder))
        super().__init__()

    def path(self, name):
        return os.path.join(self.folder, name)

    def words(self, *options):
        return [self.program, "render", "scene.gltf", "-o", "frame.exr",
                *unless_given(self.common, options), *options]

    def run(self, *options, **kept):
        return subprocess.run(self.words(*options), cwd=self.folder, capture_output=True,
                              text=True, timeout=PATIENCE_S, **kept)

    def start(self, *options, **kept):
        self.started.append(subprocess.Popen(
            self.words(*options), cwd=self.folder, stdout=subprocess.PIPE,
            stderr=subprocess.PIPE, text=True, **kept))
        return self.started[-1]

    def wait_for(self, name):
        until = time.monotonic() + PATIENCE_S
        while not os.path.exists(self.path(name)):
            if time.monotonic() > until:
                raise TimeoutError(f"{name} never came")
            time.sleep(0.002)

    def reference(self, *options):
        """The uninterrupted frame's bytes, and how long it took."""
        begun = time.monotonic()
        done = self.run(*options, "--quiet")
        took = time.monotonic() - begun
        if not self.report.claim(done.returncode == 0, f"not rendered: {done.stderr}"):
            return None, took
        frame = contents(self.path("frame.exr"))
        os.remove(self.path("frame.exr"))
        return frame, took

    def claim_finished(self, done, frame, what):
        """Finished, with the reference's bytes and nothing left beside it."""
        if self.report.claim(done.returncode == 0, f"{what}: status {done.returncode}, "
                                                   f"{done.stderr[-300:]}"):
            self.report.claim(contents(self.path("frame.exr")) == frame,
                              f"{what}: other bytes than without interruption")
        left = set(os.listdir(self.folder)) - self.names - {"frame.exr"}
        self.report.claim(not left, f"{what}: leaves {sorted(left)}")
        self.clear()

    def clear(self):
        for name in set(os.listdir(self.folder)) - self.names:
            os.remove(self.path(name))


# ---- killed ------------------------------------------------------------------------------

def kill_once(work, running, wait_s):
    """True when it was killed; False when it had finished before."""
    try:
        running.wait(wait_s)
    except subprocess.TimeoutExpired:
        running.kill()
    out, err = running.communicate(timeout=PATIENCE_S)
    left = {name for name in os.listdir(work.folder) if not name.endswith(".parhelion-part")}
    work.report.claim(left <= work.names | {"frame.exr", "frame.exr.checkpoint"},
                      f"a killed render leaves {sorted(left)}")
    return running.returncode == -signal.SIGKILL, (out, err)


def check_kills(work, kills, *options):
    """Renders that are killed at random moments until so many kills have hit: whoever survives
    makes the reference's bytes."""
    frame, took = work.reference(*options)
    resume = (*options, "--resume", "--checkpoint-interval", "0", "--quiet")
    random.seed(kills)
    hits = frames = 0
    while hits < kills and frames < 20 * kills:
        threads = ("--threads", str(random.choice((1, 2, 3))))
        running = work.start(*resume, *threads)
        was_killed, texts = kill_once(work, running, random.uniform(0, 1.2 * took))
        hits += was_killed
        if not was_killed:
            work.claim_finished(subprocess.CompletedProcess([], running.returncode, *texts),
                                frame, f"after {hits} kills")
            frames += 1
    work.claim_finished(work.run(*resume), frame, f"after all {hits} kills")
    print(f"{hits} kills, {frames + 1} frames finished, {took:.1f} s each: {' '.join(options)}")


# ---- stopped -----------------------------------------------------------------------------

def claim_stopped(work, running, number, status, what):
    """Returns stderr's last line: the command to go on with."""
    running.send_signal(number)
    err = running.communicate(timeout=PATIENCE_S)[1]
    last = err.strip().splitlines()[-1] if err.strip() else ""
    work.report.claim(running.returncode == status,
                      f"{what}: status {running.returncode}, required: {status}: {err[-300:]}")
    work.report.claim("— go on with: parhelion render --resume scene.gltf " in last,
                      f"{what}: does not say how to go on: {last}")
    work.report.claim(os.path.exists(work.path("frame.exr.checkpoint")),
                      f"{what}: no checkpoint")
    return last


def check_stop(work, *options):
    """TERM while checkpoints are kept; the line that is printed goes on."""
    frame, _ = work.reference(*options)
    running = work.start(*options, "--checkpoint-interval", "0", "--threads", "2")
    work.wait_for("frame.exr.checkpoint")
    last = claim_stopped(work, running, signal.SIGTERM, 143, "TERM")
    words = shlex.split(last.partition("go on with: ")[2])
    if work.report.claim(words[:2] == ["parhelion", "render"], f"no command in {last}"):
        done = subprocess.run([work.program, *words[1:]], cwd=work.folder, text=True,
                              capture_output=True, timeout=PATIENCE_S)
        work.report.claim("frame.exr.checkpoint: goes on after " in done.stderr,
                          f"going on is not told: {done.stderr[:300]}")
        work.claim_finished(done, frame, "after TERM")


def check_snapshot(work, *options):
    """USR1 writes the frame so far, also of a render that keeps checkpoints."""
    frame, _ = work.reference(*options)
    running = work.start(*options, "--checkpoint-interval", "0", "--threads", "1")
    work.wait_for("frame.exr.checkpoint")
    running.send_signal(signal.SIGUSR1)
    out, err = running.communicate(timeout=PATIENCE_S)
    work.report.claim("frame.exr: snapshot after " in err, f"USR1: {err[-300:]}")
    work.claim_finished(subprocess.CompletedProcess([], running.returncode, out, err), frame,
                        "after USR1")


def check_second_signal(work):
    """While the first signal waits for its pass, the second ends the process at once."""
    running = work.start("--size", "400x300", "--spp", "100000", "--threads", "1",
                         "--checkpoint-interval", "0")
    work.wait_for("frame.exr.checkpoint")
    before = contents(work.path("frame.exr.checkpoint"))
    running.send_signal(signal.SIGTERM)
    time.sleep(0.05)
    running.send_signal(signal.SIGTERM)
    running.communicate(timeout=PATIENCE_S)
    work.report.claim(running.returncode == 143 and not os.path.exists(work.path("frame.exr"))
                      and contents(work.path("frame.exr.checkpoint")) == before,
                      f"a second TERM: status {running.returncode}, {os.listdir(work.folder)}")
    work.clear()


# ---- refused -----------------------------------------------------------------------------

def stop_without_options(work, *options):
    """A render that was to keep no checkpoint leaves one when it is stopped."""
    running = work.start(*options, "--spp", "1000000", "--progress", "json")
    while not running.stderr.readline().startswith('{"progress"'):  # warnings come before
        pass
    claim_stopped(work, running, signal.SIGINT, 130, "INT without options")
    return contents(work.path("frame.exr.checkpoint"))


def samples_done(refusal):
    words = refusal.partition("has samples 0:")[2].split()
    return int(words[0]) if words else 0


def check_refusals(work, *options):
    checkpoint = stop_without_options(work, *options)
    path = work.path("frame.exr.checkpoint")
    text = contents(work.path("scene.gltf"))

    def refused(status, part, *changed):
        done = work.run("--spp", "1000000", *unless_given(options, changed), *changed,
                        "--resume")
        work.report.claim(done.returncode == status and part in done.stderr and
                          done.stderr.count("\n") == 1,
                          f"{changed}: status {done.returncode}, {done.stderr[:300]!r}, "
                          f"required: {part!r}")
        work.report.claim(contents(path) == checkpoint, f"{changed}: changed the checkpoint")
        return done.stderr

    is_of = "is of another render: "
    refused(3, is_of + "seed: 0 there, 2 here", "--seed", "2")
    version = subprocess.run([work.program, "--version"], capture_output=True, text=True)
    if "instruction set: avx" in version.stdout:
        refused(5, "was made by another program or instruction set: isa: avx", "--isa", "sse2")
    refused(3, is_of + "max bounces: 2 there, 5 here", "--max-bounces", "5")
    refused(3, is_of + "size: 32x24 there, 32x25 here", "--size", "32x25")
    refused(3, is_of + "layers: ", "--layers", "depth")
    refused(3, is_of + "environment: none there, constant here", "--environment", "constant:5")
    refused(3, "is of other pixels: 0,0,32,24 there, 0,0,32,23 here", "--crop", "0,0,32,23")
    refused(3, "does not know which samples saw a display", "--noise", "display:0.1")
    with open(work.path("scene.gltf"), "ab") as file:
        file.write(b"\n")
    refused(3, is_of + "input 0: scene.gltf ")
    with open(work.path("scene.gltf"), "wb") as file:
        file.write(text)
    done = work.run(*options, "--samples", "5:50", "--resume")
    work.report.claim("is of other samples: from 0 there, from 5 here" in done.stderr,
                      f"--samples: {done.stderr}")
    refusal = work.run(*options, "--spp", "1", "--resume").stderr
    more = samples_done(refusal) + 7
    work.report.claim("more than the 0:1 that are asked for" in refusal, refusal)
    flipped = checkpoint[:-9] + bytes([checkpoint[-9] ^ 1]) + checkpoint[-8:]
    for name, broken, part in (("cut", checkpoint[:-9], "is cut off: "),
                               ("flipped", flipped, "is damaged: "),
                               ("text", b"hello", "is there and is not a checkpoint")):
        with open(path, "wb") as file:
            file.write(broken)
        done = work.run(*options, "--resume")
        work.report.claim(part in done.stderr and done.returncode in (3, 4) and
                          contents(path) == broken, f"{name}: {done.stderr[:300]}")
    done = work.run(*options, "--checkpoint", "frame.exr")
    work.report.claim(done.returncode == 2 and
                      "-o and --checkpoint name the same file, frame.exr" in done.stderr,
                      f"one name for both: {done.stderr}")
    work.clear()
    one, _ = work.reference(*options, "--spp", "1")
    with open(path, "wb") as file:
        file.write(checkpoint)
    for changed, line in (((), "a checkpoint is there; this render begins from the start"),
                          (("--resume",), "no checkpoint is there: the render begins from")):
        done = work.run(*options, "--spp", "1", *changed)
        work.report.claim(f"parhelion: frame.exr.checkpoint: {line}" in done.stderr,
                          f"{changed}: not told: {done.stderr[:300]}")
        work.claim_finished(done, one, f"from the start, {changed}")
    # more samples than were asked for at first: on from where it stood
    frame, _ = work.reference(*options, "--spp", str(more))
    with open(path, "wb") as file:
        file.write(checkpoint)
    done = work.run(*options, "--spp", str(more), "--resume", "--json")
    answer = json.loads(done.stdout)
    work.report.claim(answer["resumed_samples"] == more - 7 and answer["samples"] == more and
                      answer["rays_by_class"]["camera"] == more * 32 * 24,
                      f"the answer counts one session alone: {done.stdout[:600]}")
    worst = answer["worst_pixels"]
    work.report.claim(len(worst) == 5 and answer["relative_error"] < worst[4]["relative_error"]
                      and worst == sorted(worst, key=lambda one: -one["relative_error"]),
                      f"worst pixels: {worst}")
    work.claim_finished(done, frame, "with a larger --spp")


def other_file(name):
    with open(os.path.join(ROOT, "assets", *name.split("/")), "rb") as file:
        return file.read()


def check_inputs(work, *options):
    """Every file that is read decides: another one under the same name is another render."""
    skies = []
    for seed in "12":
        skies.append(work.reference(*options, "--spp", "1", "--seed", seed)[0])
    scene = contents(work.path("scene.gltf"))
    files = {"scene.gltf": (scene, scene + b"\n"), "sky.exr": skies,
             "a.panel": (other_file("panels/ips_cluster.panel"),
                         other_file("panels/oled_centre.panel")),
             "a.png": (other_file("content/cluster.png"), other_file("content/centre.png"))}
    for name, (one, _) in files.items():
        with open(work.path(name), "wb") as file:
            file.write(one)
    options = (*options, "--panel", "screen=a.panel", "--content", "screen=a.png",
               "--environment", "hdri:sky.exr")
    stop_without_options(work, *options)
    for name, (one, other) in files.items():
        with open(work.path(name), "wb") as file:
            file.write(other)
        done = work.run(*options, "--spp", "1000000", "--resume")
        work.report.claim(done.returncode == 3 and "is of another render: input " in done.stderr
                          and f": {name} " in done.stderr,
                          f"another {name} is taken: {done.stderr[:300]}")
        with open(work.path(name), "wb") as file:
            file.write(one)
    work.clear()


# ---- a full disk -------------------------------------------------------------------------

def limit_files():
    resource.setrlimit(resource.RLIMIT_FSIZE, (FILE_LIMIT, FILE_LIMIT))


def check_full_disk(work, *options):
    """No room for a checkpoint: told each time, the old one stays, the frame is finished."""
    frame, _ = work.reference(*options)
    running = work.start(*options, "--checkpoint-interval", "0", "--threads", "1")
    work.wait_for("frame.exr.checkpoint")
    running.kill()
    running.communicate(timeout=PATIENCE_S)
    if os.path.exists(work.path("frame.exr")):
        os.remove(work.path("frame.exr"))
    old = contents(work.path("frame.exr.checkpoint"))
    work.report.claim(len(old) > FILE_LIMIT > len(frame), f"{len(old)}, {len(frame)} bytes")
    running = work.start(*options, "--resume", "--checkpoint-interval", "0",
                         preexec_fn=limit_files)
    lines = [running.stderr.readline(), running.stderr.readline()]
    now = contents(work.path("frame.exr.checkpoint")) \
        if os.path.exists(work.path("frame.exr.checkpoint")) else old
    out, err = running.communicate(timeout=PATIENCE_S)
    work.report.claim(lines[1].startswith("parhelion: warning: no checkpoint after ") and
                      "frame.exr.checkpoint: cannot be written: File too large" in lines[1],
                      f"a full disk: {lines}")
    work.report.claim(now == old, "a full disk changes the old checkpoint")
    work.claim_finished(subprocess.CompletedProcess([], running.returncode, out, err), frame,
                        "with a full disk")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--small", action="store_true")
    parser.add_argument("--kills", type=int, default=3)
    parser.add_argument("program")
    arguments = parser.parse_args()
    report, program = Report(), os.path.abspath(arguments.program)
    with tempfile.TemporaryDirectory() as folder, \
            Work(report, program, folder, "--max-bounces", "2") as work:
        little = ("--size", "32x24")
        if arguments.small:
            check_stop(work, *little, "--spp", "64")
            check_second_signal(work)
        else:
            check_kills(work, arguments.kills, "--size", "64x48", "--spp", "80")
            check_kills(work, max(1, arguments.kills // 10), "--size", "64x48", "--spp",
                        "100000", "--noise", "0.07", "--crop", "3,1,60,47")
            check_stop(work, *little, "--spp", "200", "--layers", "all", "--crop", "3,1,31,20")
            check_snapshot(work, *little, "--spp", "200")
            check_second_signal(work)
            check_refusals(work, *little)
            check_inputs(work, *little)
            check_full_disk(work, *little, "--spp", "200")
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
