# SPDX-License-Identifier: Apache-2.0
"""live_view.py PARHELION -- a render that is watched by --live: a file that nobody may see
half-written, in the end the frame itself, and what happens when it cannot be written. Nothing
of it changes the frame.
"""
import os
import signal
import struct
import subprocess
import sys
import tempfile

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
sys.path.insert(0, os.path.join(ROOT, "tests", "image"))
from exr import Frame  # noqa: E402
from gltf import Scene  # noqa: E402
from report import Report  # noqa: E402
from resume import PATIENCE_S, Work, contents  # noqa: E402

PANEL = os.path.join(ROOT, "assets", "panels", "ips_cluster.panel")


def write_scene(path):
    """A room with two screens of one display, and one that shows its back."""
    scene = Scene()
    scene.box_inside(scene.lambert(0.7), [-2, 0, -2], [2, 2.5, 2])
    scene.facing_quad(scene.emitter(500), [0, 2.49, 0], [0, -1, 0], 0.8)
    screen = scene.material("screen", pbrMetallicRoughness={"metallicFactor": 0})
    for x in (-1.0, 0.0):
        scene.quad(screen, [x, 0.5, -1.9], [0.9, 0, 0], [0, 1.5, 0])
    scene.quad(scene.material("away", pbrMetallicRoughness={"metallicFactor": 0}),
               [-1.2, 0.5, -1.5], [-0.4, 0, 0], [0, 0.4, 0])
    scene.view("eye", [0.3, 1.0, 1.5], [0, 0, -1], 60)
    scene.write(path)


def check_words(work):
    for words, status, part in (
            (["--live", "frame.png"], 2, "required: a name that ends in .exr"),
            (["--live", "frame.exr"], 2, "the result is to stand there"),
            (["--live", "x.exr", "--png", "x.exr"], 2, "the picture is to stand there"),
            (["--live", "none/x.exr"], 4, "none/x.exr: cannot be written")):
        done = work.run(*words)
        left = set(os.listdir(work.folder)) - work.names
        work.report.claim(done.returncode == status and part in done.stderr and not left and
                          done.stderr.count("\n") == 1 and
                          (status == 4 or words[0] in done.stderr),
                          f"{words}: status {done.returncode}, {done.stderr[:300]!r}, {left}")


def attribute(frame, name):
    data = frame.attributes[f"parhelion:{name}"]
    return struct.unpack("<i", data)[0] if name == "complete" else data.decode()


def picture_of(frame):
    return {name: values.tobytes() for name, values in frame.channels.items()}


def check_file(work, frame, *options):
    """In the end it is the frame; of a part, without the sums."""
    done = work.run(*options, "--live", "live.exr")
    work.report.claim(contents(work.path("live.exr")) == frame, "the last live file is another")
    os.remove(work.path("live.exr"))
    work.claim_finished(done, frame, "with a live file")
    part, _ = work.reference(*options, "--crop", "3,2,30,20")
    done = work.run(*options, "--crop", "3,2,30,20", "--live", "live.exr")
    live, own = Frame(work.path("live.exr")), Frame(work.path("frame.exr"))
    work.report.claim(picture_of(live) == picture_of(own) and
                      len(live.parts) == 1 < len(own.parts),
                      "a part's live file is not its picture alone")
    os.remove(work.path("live.exr"))
    work.claim_finished(done, part, "a part with a live file")


def check_file_meanwhile(work, *options):
    """It is whole at any time, says how far it is, and outlives the render."""
    running = work.start(*options, "--spp", "1000000", "--live", "live.exr")
    work.wait_for("live.exr")
    live = Frame(work.path("live.exr"))
    first, end = map(int, attribute(live, "samples").split(":"))
    work.report.claim(first == 0 < end < 1000000 and attribute(live, "complete") == 0,
                      f"a live file says {attribute(live, 'samples')}")
    running.send_signal(signal.SIGTERM)
    running.communicate(timeout=PATIENCE_S)
    work.report.claim(running.returncode == 143 and
                      contents(work.path("live.exr")) == contents(work.path("frame.exr")),
                      f"stopped: status {running.returncode}, or another live file")
    work.clear()
    running = work.start(*options, "--spp", "1000000", "--live", "live.exr")
    work.wait_for("live.exr")
    running.kill()
    running.communicate(timeout=PATIENCE_S)
    work.report.claim(attribute(Frame(work.path("live.exr")), "complete") == 0,
                      "a killed render's live file is not whole")
    work.clear()


def check_no_room(work, frame, *options):
    """A live file that cannot be written any more is told of once."""
    os.mkdir(work.path("there"))
    running = work.start(*options, "--live", "there/live.exr", "--json",
                         stdin=subprocess.DEVNULL)
    work.wait_for("there/live.exr")
    os.remove(work.path("there/live.exr"))
    os.rmdir(work.path("there"))
    out, err = running.communicate(timeout=PATIENCE_S)
    told = [line for line in err.splitlines() if "--live: the frame is not shown" in line]
    work.report.claim(len(told) == 1 and "there/live.exr: " in told[0],
                      f"no room: {err[-300:]}")
    work.claim_finished(subprocess.CompletedProcess([], running.returncode, out, err), frame,
                        "without room for the live file")


def main():
    report, program = Report(), os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        work = Work(report, program, folder, "--panel", f"screen={PANEL}", "--panel",
                    f"away={PANEL}", "--max-bounces", "1")
        write_scene(work.path("scene.gltf"))
        small = ("--size", "48x36", "--layers", "all", "--spp", "20")
        frame, _ = work.reference(*small)
        check_words(work)
        check_file(work, frame, *small)
        check_file_meanwhile(work, *small[:4])
        longer = ("--size", "48x36", "--no-guiding", "--layers", "halves,variance", "--spp",
                  "200")
        check_no_room(work, work.reference(*longer)[0], *longer)
    report.finish()


if __name__ == "__main__":
    main()
