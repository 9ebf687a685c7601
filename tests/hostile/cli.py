# SPDX-License-Identifier: Apache-2.0
"""cli.py PARHELION -- what scripts rely on: exit statuses, one clear line for an error, answers
on stdout, nothing half-written, and signals that leave a frame behind.
"""
import json
import math
import os
import pty
import re
import signal
import subprocess
import sys
import tempfile
import time

from mutate import sound_scene

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
sys.path.insert(0, os.path.join(ROOT, "tests", "image"))
from exr import Frame  # noqa: E402
from gltf import Scene  # noqa: E402
from report import Report  # noqa: E402

COMMANDS = ("render", "develop", "check", "measure", "compare", "merge", "sky", "panel import",
            "panel fit", "panel info", "panel eval", "panel plot", "panel report", "panel show",
            "panel simulate", "explain", "equip", "help")
CAR = os.path.join(ROOT, "scenes", "car_dashboard.gltf")
PANEL = os.path.join(ROOT, "assets", "panels", "ips_cluster.panel")

# What is typed wrongly, and what the line then has to offer: every name of every command.
RENDER = ("render", CAR, "-o", "x.exr", "--size", "8x8")
UNKNOWN_NAMES = (
    (("rendr",), 2, "did you mean render?", "develop", "panel", "help"),
    (("panel",), 2, "import", "fit", "info", "eval", "plot", "report",
     "show", "simulate"),
    (("panel", "fitt"), 2, "did you mean fit?", "import", "simulate"),
    (("help", "comparig"), 2, "did you mean comparing?", "render", "scenes"),
    (("help", "panel", "nope"), 2, "import", "simulate"),
    (("help", "render", "nope"), 2, "nope"),
    (("help", "rendr"), 2, "did you mean render?"),
    ((*RENDER, "--sizes", "8x8"), 2, "did you mean --size?"),
    ((*RENDER, "--content", "clustr=a.png"), 3, "did you mean cluster?",
     "There are cluster, centre;"),
    ((*RENDER, "--display-level", "gap=5"), 3, "is no display", "cluster, centre"),
    ((*RENDER, "--panel", "clustr=a.panel"), 3, "did you mean cluster?",
     'There are cluster, centre, "leather black", '),
    ((*RENDER, "--camera", "driver"), 2, "driver-eye", "passenger-eye", "outside"),
    ((*RENDER, "--layers", "depht"), 2, "did you mean depth?", "all", "xyz",
     "display.contrast"),
    ((*RENDER, "--isa", "z80"), 2, "sse2"),
    ((*RENDER, "--light", "lamp"), 2, "--light"),
    ((*RENDER, "--light", "nobody=nothing.ies"), 3, "nothing.ies"),
    ((*RENDER, "--light-level", "lamp"), 2, "--light-level"),
    ((*RENDER, "--light-cct", "lamp"), 2, "--light-cct"),
    ((*RENDER, "--light-cct", "lamp=3000"), 3, "no lamp of a luminaire file"),
    ((*RENDER, "--environment", "skies"), 2, "sky:clear", "cie:", "perez:", "hdri:",
     "constant:"),
    ((*RENDER, "--environment", "sky:clear", "--ground", "lawn"), 2, "land", "sea", "cloud"),
    ((*RENDER, "--environment", "cie:1:9", "--no-moon"), 2, "sky:clear"),
    ((*RENDER, "--sun", "on"), 2, "auto", "off", "AZ,EL,LUX"),
    ((*RENDER, "--progress", "loud"), 2, "auto|bar|plain|json|none"),
    ((*RENDER, "--png", "x.gif"), 2, ".png", ".jpg", ".tif"),
    ((*RENDER, "--png", "x.png", "--view", "pretty"), 2, "photographic", "raw"),
    (("develop", "named.exr", "-o", "x.png", "--layer", "depht"), 2, "depth", "xyz"),
    (("develop", "named.exr", "-o", "x.png", "--display", "crt"), 2, "sRGB", "Rec.1886"),
    (("develop", "named.exr", "-o", "x.png", "--view", "pretty"), 2, "photographic", "raw"),
    (("develop", "named.exr", "-o", "x.png", "--eye", "old"), 2, "--eye: old", "AGE,PIGMENT"),
    (("develop", "named.exr", "-o", "x.png", "--eye", "40,3"), 2, "40,3", "light blue"),
    (("develop", "named.exr", "-o", "x.png", "--fov", "40"), 2, "--fov", "--eye"),
    (("develop", "named.exr", "-o", "x.gif"), 2, ".png", ".jpg", ".tif"),
    (("measure", "named.exr", "--display", "clustr"), 2, "cluster, centre"),
    (("measure", "named.exr", "--region", "0,0,99,1"), 2, "0,0,8,8"),
    (("compare", "named.exr", "named.exr", "--display", "clustr"), 2, "cluster, centre"),
    (("compare", "named.exr", "named.exr", "--max", "flop=1"), 2, "did you mean flip?",
     "psnr", "contrast_change"),
    (("compare", "named.exr", "named.exr", "--metric", "colour"), 2, "flip", "psnr", "ssim"),
    (("panel", "import", "text.csv", "-o", "m.json", "--format", "iges"), 2, "ies", "eulumdat",
     "text"),
    (("panel", "import", "text.csv", "-o", "m.json", "--role", "*=rd"), 2, "red", "black",
     "brdf", "skip"),
    (("panel", "import", "text.csv", "-o", "m.json", "--layout", "keys.json"), 3,
     "decimal"),
    (("panel", "import", "text.csv", "-o", "m.json", "--format", "text", "--columns",
      "theta,phi,bright"), 2, "theta", "phi", "X", "L", "x", "u'"),
    (("panel", "eval", PANEL, "--theta", "0", "--quantity", "bright"), 2, "X|Y|Z|u|v|brdf"),
    (("panel", "eval", PANEL, "--batch", "text.csv"), 3, "theta", "phi", "incidence"),
    (("panel", "plot", PANEL, "-o", "x.svg", "--kind", "pie"), 2, "luminance", "grey-levels"),
    (("sky", "--environment", "skies"), 2, "sky:clear", "constant:"),
)


class Program:
    def __init__(self, path, folder):
        self.path, self.folder = path, folder

    def file(self, name):
        return os.path.join(self.folder, name)

    def run(self, *arguments, **more):
        return subprocess.run([self.path, *arguments], capture_output=True, text=True,
                              timeout=120, **more)

    def render(self, *options, out="frame.exr"):
        return self.run("render", self.file("scene.gltf"), "-o", self.file(out), "--size",
                        "32x24", "--spp", "2", *options)


# What a machine that is busy says of its work, from a second on.
PROGRESS = re.compile(r"parhelion: \S+ \d+%, .* elapsed, .* left$")


def one_line(done, *words):
    """stderr is one line of ours that holds the words, besides progress."""
    lines = [line for line in done.stderr.splitlines() if not PROGRESS.match(line)]
    return len(lines) == 1 and lines[0].startswith("parhelion: ") \
        and all(word in lines[0] for word in words)


def claim_status(report, done, status, *words):
    arguments = " ".join(os.path.basename(word) for word in done.args)
    report.claim(done.returncode == status and one_line(done, *words),
                 f"{arguments}: status {done.returncode} instead of {status}, or not one line "
                 f"with {words}: {done.stderr.strip()[:300]}")


def check_usage(report, program):
    claim_status(report, program.run("rendr"), 2, "rendr", "render")
    claim_status(report, program.run("render"), 2)
    claim_status(report, program.render("--sp", "4"), 2, "--sp")
    claim_status(report, program.render("--size", "0x9"), 2, "--size", "0x9")
    claim_status(report, program.render("--spp", "many"), 2, "--spp", "many")
    claim_status(report, program.render("--crop", "9,9,3,3"), 2, "--crop")
    claim_status(report, program.render("--camera", "nobody"), 2, "nobody", "eye")
    done = program.run()
    report.claim(done.returncode == 2 and done.stderr, "no arguments: not a usage error")


def check_help(report, program):
    version = program.run("--version")
    report.claim(version.returncode == 0 and re.search(r"[Ee]mbree \d", version.stdout)
                 and "OpenEXR" in version.stdout, "--version does not name its libraries")


def check_help_words(report, program):
    """-h, -V and help: the same everywhere, also where the rest of the line is wrong."""
    overview, version = program.run("--help").stdout, program.run("--version").stdout
    report.claim(program.run("-h").stdout == program.run("help").stdout == overview
                 and "render" in overview, "-h, --help or help")
    report.claim(program.run("-V").stdout == version, "-V")
    for command in (*COMMANDS, "panel"):
        words = command.split()
        done = program.run(*words, "--help")
        report.claim(done.returncode == 0 and f"parhelion {command} " in done.stdout
                     and not done.stderr, f"{command} --help has no example")
        for line in ((*words, "-h"), ("help", *words), (*words, "help"))[command == "help":]:
            again = program.run(*line)
            report.claim(again.returncode == 0 and again.stdout == done.stdout,
                         f"{' '.join(line)} is not --help: {again.stderr.strip()}")
        done = program.run(*words, "-V")
        report.claim(done.returncode == 0 and done.stdout == version, f"{command} -V")
    for line in (("render", "--nonsense", "-h"), ("panel", "fit", "x", "y", "-V")):
        report.claim(program.run(*line).returncode == 0, f"{line}: what is wrong comes first")
    # a value is no question
    claim_status(report, program.run("measure", "--display", "-h", "absent.exr"), 3, "absent")
    report.claim(program.run("check", "--", "-h").returncode == 3, "check -- -h is a file")


def check_names(report, program):
    """Every unknown name is answered by those that would be right, on one line."""
    done = program.run("render", CAR, "-o", "named.exr", "--size", "8x8", "--spp", "1",
                       "--layers", "all", "--quiet", "--environment", "constant:100",
                       cwd=program.folder)
    report.claim(done.returncode == 0, f"the frame with names: {done.stderr.strip()}")
    with open(program.file("text.csv"), "w", encoding="utf-8") as file:
        file.write("alpha,beta,bright\n0,0,1\n10,0,1\n")
    with open(program.file("keys.json"), "w", encoding="utf-8") as file:
        json.dump({"desimal": "comma"}, file)
    for line, status, *words in UNKNOWN_NAMES:
        claim_status(report, program.run(*line, cwd=program.folder), status, *words)


ANSWERS = (
    ("--help",), ("--version",), ("help",), ("help", "comparing"), ("render", "-h"),
    ("panel", "help"), ("check", "scene.gltf"), ("check", "absent.gltf"),
    ("measure", "frame.exr"), ("measure", "frame.exr", "--json"),
    ("measure", "scene.gltf", "--illuminance", "0,0,0,0,1,0", "--samples", "16"),
    ("compare", "frame.exr", "frame.exr"), ("compare", "frame.exr", "other.exr"),
    ("compare", "frame.exr", "frame.exr", "--json"), ("sky", "--environment", "constant:9"),
    ("sky", "--environment", "constant:9", "--json"), ("panel", "info", PANEL),
    ("panel", "info", PANEL, "--json"),
    ("panel", "eval", PANEL, "--theta", "0", "--rgb", "9,9,9"),
    ("panel", "eval", PANEL, "--grid", "0:10:5,0:90:45", "--rgb", "9,9,9", "--csv"),
    ("render", "scene.gltf", "--replay", "1,1,0", "--size", "8x8"),
    ("render", "scene.gltf", "-o", "line.exr", "--json", "--size", "8x8", "--spp", "1"),
)


def quick_scene():
    """The sound scene of the index that coats have: the table of its coat is at hand."""
    scene = sound_scene()
    for material in scene.document["materials"]:
        material.get("extensions", {}).pop("KHR_materials_ior", None)
    return scene


def run_with_stdout(program, line, place):
    """place: what the shell does with stdout."""
    return subprocess.run(["sh", "-c", f'"$0" "$@" {place}', program.path, *line],
                          stderr=subprocess.PIPE, text=True, timeout=120, cwd=program.folder)


def check_answers_lost(report, program):
    """An answer that nobody can read is status 4 and one line, whatever the answer was."""
    program.render()
    program.render("--seed", "1", out="other.exr")
    for line in ANSWERS:
        for place in (">&-", ">/dev/full"):
            done = run_with_stdout(program, line, place)
            lines = [text for text in done.stderr.splitlines() if "warning: " not in text
                     and "100%" not in text]
            report.claim(done.returncode == 4 and len(lines) == 1 and "stdout" in lines[0],
                         f"{' '.join(line)} {place}: {done.returncode} {done.stderr.strip()}")
    # an error is told on stderr, and keeps its status
    done = run_with_stdout(program, ("measure", "absent.exr"), ">&-")
    report.claim(done.returncode == 3, f"an error with stdout closed: {done.returncode}")
    # where a file was asked for, the line about it may be missed
    done = run_with_stdout(program, ("sky", "--environment", "constant:9", "-o", "s.png"),
                           ">&-")
    report.claim(done.returncode == 0 and is_png(program.file("s.png")), "-o, stdout closed")


def on_terminal(program, line, environment):
    """What a terminal receives: stderr is one, stdout too."""
    here, there = pty.openpty()
    running = subprocess.Popen([program.path, *line], stdout=there, stderr=there,
                               cwd=program.folder, env={**os.environ, **environment})
    os.close(there)
    received = b""
    while True:
        try:
            more = os.read(here, 65536)
        except OSError:  # the other end is closed
            break
        if not more:
            break
        received += more
    running.wait()
    os.close(here)
    return received.replace(b"\r\n", b"\n")


def check_terminals(report, program):
    """Colour and a line that is written anew only where a terminal can do it."""
    line = ("render", "scene.gltf", "-o", "line.exr", "--size", "64x48", "--spp", "16")
    environment = {"TERM": "xterm", "NO_COLOR": ""}
    live = on_terminal(program, line, environment)
    report.claim(b"\r" in live and b"\x1b[36m" in live and live.count(b"\x1b") ==
                 live.count(b"\x1b[36m") + live.count(b"\x1b[0m"), f"a bar: {live[-200:]}")
    plain = on_terminal(program, line, {**environment, "NO_COLOR": "1"})
    report.claim(b"\r" in plain and b"\x1b" not in plain, f"NO_COLOR: {plain[-200:]}")
    for term in ("dumb", ""):
        for more in ((), ("--progress", "bar")):
            dumb = on_terminal(program, (*line, *more), {**environment, "TERM": term})
            report.claim(b"\r" not in dumb and b"\x1b" not in dumb and b"100%" in dumb,
                         f"TERM={term} {more}: {dumb[-200:]}")
    done = program.render("--progress", "bar")
    report.claim("\r" not in done.stderr and "\x1b" not in done.stderr and "100%" in
                 done.stderr, "a bar into a pipe")


def check_hang_up(report, program):
    """nohup: a HUP that is ignored from the start stays ignored."""
    running = subprocess.Popen(
        ["nohup", program.path, "render", program.file("scene.gltf"), "-o",
         program.file("nohup.exr"), "--size", "48x32", "--spp", "100000", "--threads",
         "1", "--progress", "json"], stderr=subprocess.PIPE, stdout=subprocess.PIPE)
    while not running.stderr.readline().startswith(b"{"):
        pass
    running.send_signal(signal.SIGHUP)
    time.sleep(1)
    is_running = running.poll() is None
    running.send_signal(signal.SIGTERM)
    running.communicate(timeout=60)
    report.claim(is_running and running.returncode == 143,
                 f"nohup: HUP was heard: {running.returncode}")


def check_inputs(report, program):
    done = program.run("check", program.file("absent.gltf"))
    report.claim(done.returncode == 3 and "absent.gltf: cannot be opened" in done.stdout,
                 f"check of an absent file says {done.stdout}")
    claim_status(report, program.run("render", program.file("absent.gltf"), "-o",
                                     program.file("x.exr")), 3, "absent.gltf")
    report.claim(not os.path.exists(program.file("x.exr")), "a failed render left a file")
    claim_status(report, program.run("panel", "info", program.file("scene.gltf")), 3,
                 "scene.gltf")
    claim_status(report, program.run("develop", program.file("scene.gltf"), "-o",
                                     program.file("x.png")), 3, "scene.gltf")
    done = program.run("check", "--json", program.file("absent.gltf"))
    document = json.loads(done.stdout or "{}")
    error = document.get("error", {})
    report.claim(error.get("status") == 3 or document.get("ok") is False,
                 f"check --json of an absent file says {done.stdout[:200]}")


OCIO = """ocio_profile_version: 2
search_path: .
roles: {scene_linear: lin, aces_interchange: lin, default: lin}
displays: {screen: [!<View> {name: v, colorspace: out}]}
colorspaces:
  - !<ColorSpace> {name: lin}
  - !<ColorSpace> {name: out, from_reference: !<FileTransform> {src: LOOK.spi1d}}
"""


def check_almost(report, program):
    """Whatever is named in another letter case is hinted at, once."""
    for name, text in (("config.ocio", OCIO), ("look.spi1d", ""), ("sky.hdr", ""),
                       ("weather.epw", ""), ("one.panel", "")):
        with open(program.file(name), "w", encoding="utf-8") as file:
            file.write(text)
    for there, words in (
            ("scene.gltf", ("render", "SCENE.gltf", "-o", "x.exr")),
            ("look.spi1d", ("develop", "f.exr", "--config", "config.ocio", "-o", "x.png")),
            ("config.ocio", ("develop", "f.exr", "--config", "Config.ocio", "-o", "x.png")),
            ("sky.hdr", ("sky", "--environment", "hdri:Sky.hdr")),
            ("weather.epw", ("sky", "--weather", "weather.EPW", "--when",
                             "2001-06-21T10:30+01:00")),
            ("one.panel", ("panel", "info", "One.Panel")),
            ("f.exr", ("measure", "F.EXR"))):
        if there == "look.spi1d":
            program.render(out="f.exr")
        moved = [f"hdri:{program.file(w[5:])}" if w.startswith("hdri:") else
                 program.file(w) if "." in w and ":" not in w else w for w in words]
        claim_status(report, program.run(*moved), 3, f'"{there}" is there: its letter case')


def check_outputs(report, program):
    done = program.run("render", program.file("scene.gltf"), "-o",
                       program.file("no/such/frame.exr"), "--size", "8x8", "--spp", "1")
    claim_status(report, done, 4, "frame.exr")
    os.mkdir(program.file("folder.exr"))
    claim_status(report, program.render("--quiet", out="folder.exr"), 4, "folder.exr")
    left = [name for name in os.listdir(program.folder) if name.startswith("folder.exr.")]
    report.claim(not left, f"a failed render left {left}")


def check_answers(report, program):
    done = program.render("--json", "--quiet")
    answer = json.loads(done.stdout)
    wanted = {"output", "size", "samples", "seconds", "rays", "relative_error", "complete",
              "warnings", "samples_per_s", "rays_per_s", "peak_memory_bytes",
              "build_peak_memory_bytes", "nonfinite_samples"}
    report.claim(done.returncode == 0 and wanted <= set(answer),
                 f"render --json lacks {wanted - set(answer)}")
    report.claim(answer["complete"] is True and answer["size"] == [32, 24]
                 and answer["samples"] == 2, f"render --json says {answer}")
    report.claim(1e6 < answer["build_peak_memory_bytes"] <= answer["peak_memory_bytes"],
                 f"render --json: peaks of memory {answer}")
    report.claim(not done.stderr, f"--quiet prints {done.stderr!r}")
    plain = program.render()
    report.claim(not re.search(r"[\x00-\x09\x0b-\x1f]", plain.stderr),
                 "progress into a pipe holds control characters")
    done = program.run("check", "--json", program.file("scene.gltf"))
    answer = json.loads(done.stdout)
    report.claim(done.returncode == 0 and answer["ok"] is True and answer["triangles"] == 6
                 and len(answer["lights"]) >= 1, f"check --json says {done.stdout[:300]}")
    done = program.run("measure", program.file("frame.exr"), "--region", "0,0,32,24", "--json")
    report.claim(done.returncode == 0 and isinstance(json.loads(done.stdout), dict),
                 f"measure --json says {done.stdout[:300]} {done.stderr}")


def check_pictures(report, program):
    program.render("--png", program.file("with.png"))
    report.claim(is_png(program.file("with.png"), 32, 24), "render --png makes no PNG")
    for options in ([], ["--exposure", "0"], ["--exposure", "white:500"],
                    ["--false-colour", "luminance"]):
        out = program.file("developed.png")
        done = program.run("develop", program.file("frame.exr"), "-o", out, *options)
        report.claim(done.returncode == 0 and is_png(out),
                     f"develop {options} fails: {done.stderr.strip()}")
        if os.path.exists(out):
            os.remove(out)


SKY = ("--environment", "sky:clear", "--when", "2026-06-21T08:30+02:00", "--where",
       "48.14,11.58,520")


def check_sky(report, program):
    """Figures, pictures, a drawn sky that lights again as a picture, and what is refused."""
    figures = json.loads(program.run("sky", *SKY, "--json").stdout)
    sun = figures["sun"]
    report.claim(abs(sun["azimuth_deg"] - 86.9) < 0.01 and abs(sun["elevation_deg"] - 29.49)
                 < 0.01 and sun["is_up"], f"sky --json: the sun of Munich, {sun}")
    lux = figures["diffuse_horizontal_lx"]
    report.claim(10000 < lux < 16000 and 60000 < figures["direct_normal_lx"] < 100000,
                 f"sky --json: {figures}")
    report.claim(program.run("sky", *SKY, "-o", program.file("sky.exr")).returncode == 0,
                 "sky -o .exr")
    again = json.loads(program.run("sky", "--environment", "hdri:" + program.file("sky.exr"),
                                   "--json").stdout)
    report.claim(abs(again["diffuse_horizontal_lx"] / lux - 1) < 0.005,
                 f"a drawn sky as HDRI: {again['diffuse_horizontal_lx']} lx for {lux}")
    for name in ("sky.png", "sky.svg"):
        done = program.run("sky", *SKY, "-o", program.file(name))
        report.claim(done.returncode == 0 and os.path.getsize(program.file(name)) > 10000, name)
    report.claim(is_png(program.file("sky.png")), "sky.png is no PNG")
    claim_status(report, program.run("sky"), 2, "wants a sky")
    claim_status(report, program.run("sky", *SKY, "-o", "sky.tif"), 2, ".exr, .png or .svg")
    claim_status(report, program.run("sky", "--environment", "constant:9", "-o",
                                     "/absent/sky.exr"), 4)
    night = ("--environment", "perez:800,100", "--when", "2026-06-21T01:30+02:00", *SKY[4:])
    claim_status(report, program.run("sky", *night), 3, "below the horizon")
    claim_status(report, program.run("sky", "--weather", "absent.epw", *SKY[2:4]), 3,
                 "absent.epw")
    check_weather(report, program)


EPW = "LOCATION,T,-,D,D,0,48.14,11.58,1.0,520\nDATA PERIODS,1,1,Data,Sunday, 1/ 1,12/31\n"


def epw_row(hour, direct, diffuse, dew_point=8, lux=("0", "0")):
    return (f"2026,6,21,{hour},60,x,20,{dew_point},79,100100,0,1415,288,0,{direct},{diffuse},0,"
            f"{lux[0]},{lux[1]},0\n")


def check_weather(report, program):
    """Each hour of a day has its own fault; by which rule the lux are is told."""
    path = program.file("day.epw")
    with open(path, "w", encoding="utf-8") as file:
        file.write(EPW + epw_row(10, 600, 150) + epw_row(11, 600, 150, 99.9) +
                   epw_row(12, 9999, 150) + epw_row(13, 600, 0) + epw_row(14, 0, 0) +
                   epw_row(15, 600, 150, 8, ("999999", "17000")) +
                   epw_row(16, 600, 150, 8, ("54321", "17000")) + epw_row(17, 2000, 150))
    def ask(hour, *options):
        return program.run("sky", "--weather", path, "--weather-offset=-0.5", "--when",
                           f"2026-06-21T{hour - 1}:30+01:00", *options)
    done = json.loads(ask(10, "--json").stdout)
    used = done["luminous_efficacy"]
    water = math.exp(0.07 * 8 - 0.075)
    report.claim(used["rule"] == "perez 1990" and used["water_source"] == "dew point" and
                 abs(used["water_cm"] - water) < 1e-6 and
                 abs(done["direct_normal_lx"] - 600 * used["direct_lm_w"]) < 1,
                 f"sky --weather: {used}")
    done = ask(11, "--json")
    used = json.loads(done.stdout)["luminous_efficacy"]
    report.claim(used["water_source"] == "assumed" and used["water_cm"] == 2 and
                 "line 4" in done.stderr and "2 cm of water vapour are assumed" in done.stderr,
                 f"no dew point: {used}, {done.stderr}")
    done = json.loads(ask(16, "--weather-lux", "file", "--json").stdout)
    report.claim(abs(done["direct_normal_lx"] - 54321) < 1 and
                 abs(done["diffuse_horizontal_lx"] - 17000) < 1 and
                 done["luminous_efficacy"]["rule"] == "file", f"--weather-lux file: {done}")
    report.claim(["lux", "by", "file"] in
                 [line.split() for line in ask(16, "--weather-lux", "file").stdout.splitlines()],
                 "the rule is not printed")
    for hour, options, words in (
            (12, (), ("line 5", "no direct or no diffuse radiation")),
            (13, (), ("line 6", "600 W/m2 of direct light and no diffuse")),
            (14, (), ("line 7", "is dark")), (17, (), ("line 10", "more than the sun's own")),
            (10, ("--weather-lux", "file"), ("line 3", "0 lx direct and 0 lx diffuse")),
            (15, ("--weather-lux", "file"), ("line 8", "no lx direct and 17000 lx diffuse"))):
        claim_status(report, ask(hour, *options), 3, "day.epw", *words)
    claim_status(report, program.run("sky", *SKY, "--weather-lux", "file"), 2,
                 "--weather-lux: there is no weather file")
    check_own_sun(report, program, path)


def check_own_sun(report, program, path):
    """A measured sky keeps its shape and diffuse light below a sun of another illuminance, or
    without one; and a scene's own sun does not stand in for what is measured."""
    scene = Scene()
    scene.environment(type="constant", luminance=9, sun={
        "azimuth_deg": 90, "elevation_deg": 30, "illuminance_lx": 777})
    scene.write(program.file("own_sun.gltf"))
    when = ("--when", "2026-06-21T09:30+01:00")
    skies = {"weather": ("--weather", path, "--weather-offset=-0.5", *when),
             "perez": ("--environment", "perez:600,150", *when, "--where", "48.14,11.58")}
    for name, options in skies.items():
        def ask(*sun):
            return json.loads(program.run("sky", *options, *sun, "--json").stdout)
        own, off, placed = ask(), ask("--sun", "off"), ask("--sun", "180,40")
        lit = ask("--sun", "180,40,12345")
        keys = "direct_normal_lx", "diffuse_horizontal_lx"
        found = [[sky[key] for key in keys] for sky in (own, off, placed, lit)]
        report.claim(own[keys[0]] > 50000 and off[keys[0]] == 0 and
                     off[keys[1]] == own[keys[1]], f"{name} --sun off: {found}")
        report.claim(placed[keys[0]] > 50000 and abs(lit[keys[0]] - 12345) < 1 and
                     lit[keys[1]] == placed[keys[1]], f"{name} --sun AZ,EL,LUX: {found}")
    sky = ("--environment", "perez:600,150", "--sun", "90,30", "--json")
    wanted = json.loads(program.run("sky", *sky).stdout)["global_horizontal_lx"]
    done = program.run("measure", program.file("own_sun.gltf"), "--illuminance", "0,0,0,0,1,0",
                       "--samples", "1024", *sky)
    lux = json.loads(done.stdout)["illuminance_lx"]
    report.claim(abs(lux / wanted - 1) < 0.02,
                 f"a measured sky about a scene with a sun: {lux} lx, {wanted} alone")


def check_night(report, program):
    """A full moon and the background behind it; by day the moon is told and gives no light."""
    words = ("sky", *SKY[:2], *SKY[4:], "--json", "--when")
    lit = json.loads(program.run(*words, "2026-11-24T23:30+01:00").stdout)
    moon, background = lit["moon"], lit["night_background_lx"]
    report.claim(moon["is_up"] and moon["is_in_light"] and moon["illuminated_fraction"] > 0.99
                 and 65 < moon["elevation_deg"] < 67 and 0.2 < moon["direct_normal_lx"] < 0.32
                 and 150 < moon["azimuth_deg"] < 157, f"sky --json: the full moon, {moon}")
    report.claim(6e-4 < background < 1e-3, f"sky --json: the background is {background} lx")
    dark = json.loads(program.run(*words, "2026-11-24T23:30+01:00", "--no-moon").stdout)
    report.claim(dark["moon"] is None and dark["night_background_lx"] == background
                 and abs(dark["global_horizontal_lx"] / background - 1) < 1e-3,
                 f"sky --no-moon --json: {dark}")
    day = json.loads(program.run("sky", *SKY, "--json").stdout)
    report.claim(not day["moon"]["is_in_light"] and day["moon"]["direct_normal_lx"] == 0
                 and day["night_background_lx"] == 0, f"by day: {day['moon']}")
    text = program.run(*words[:5], "--when", "2026-11-24T23:30+01:00").stdout
    report.claim("moon direct normal  0." in text and "night background    0.000" in text, text)
    scene = quick_scene()
    scene.environment(type="sky", when="2026-11-24T23:30+01:00", where=[48.14, 11.58, 520],
                      moon=False)
    scene.write(program.file("moonless.gltf"))
    said = json.loads(program.run("sky", program.file("moonless.gltf"), "--json").stdout)
    report.claim(said["moon"] is None and said["global_horizontal_lx"] < 1e-3,
                 f"a scene that says there is no moon: {said}")
    claim_status(report, program.run("sky", "--environment", "constant:9", "--no-moon"), 2,
                 "only a clear sky has a moon")


def is_png(path, width=None, height=None):
    if not os.path.exists(path):
        return False
    with open(path, "rb") as file:
        head = file.read(24)
    size = int.from_bytes(head[16:20], "big"), int.from_bytes(head[20:24], "big")
    return head[:8] == b"\x89PNG\r\n\x1a\n" and width in (None, size[0]) \
        and height in (None, size[1])


def check_signal(report, program, number, status):
    """A long render that is interrupted leaves a frame that says so."""
    out = program.file(f"signal{status}.exr")
    running = subprocess.Popen(
        [program.path, "render", program.file("scene.gltf"), "-o", out, "--size", "48x32",
         "--spp", "100000", "--threads", "1", "--progress", "json"], stderr=subprocess.PIPE,
        stdout=subprocess.PIPE,
        preexec_fn=lambda: signal.signal(number, signal.SIG_DFL))  # nohup's children ignore HUP
    running.stderr.readline()  # before its first pass the program simply ends
    running.send_signal(number)
    try:
        err = running.communicate(timeout=60)[1].decode()
    except subprocess.TimeoutExpired:
        running.kill()
        err = "still running"
    report.claim(running.returncode == status,
                 f"{number.name}: status {running.returncode}, required: {status}: "
                 f"{err[-300:]}")
    is_partial = os.path.exists(out) and any(
        "complete" in name and value[:1] in (b"\0", b"f", b"n")
        for name, value in Frame(out).attributes.items())
    report.claim(is_partial, f"{number.name}: no frame that is marked incomplete")


def main():
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        program = Program(os.path.abspath(sys.argv[-1]), folder)
        quick_scene().write(program.file("scene.gltf"))
        for check in (check_usage, check_help, check_help_words, check_names,
                      check_answers_lost, check_terminals, check_hang_up, check_inputs,
                      check_almost, check_outputs, check_answers, check_pictures, check_sky,
                      check_night):
            try:
                check(report, program)
            except (ValueError, KeyError, OSError, subprocess.TimeoutExpired) as error:
                report.claim(False, f"{check.__name__}: {type(error).__name__}: {error}")
        check_signal(report, program, signal.SIGINT, 130)
        check_signal(report, program, signal.SIGTERM, 143)
        check_signal(report, program, signal.SIGHUP, 129)
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
