# SPDX-License-Identifier: Apache-2.0
"""abi.py BUILD_DIR [--renew] -- what other programs rely on of libparhelion-panel: its symbols
and the layout of its structs are those of abi.txt (--renew writes them, for a new soname or
what is added at the end); the header compiles as C99, C17 and C++17; a program of its own is
linked by pkg-config against an installed tree that was moved, and runs; its answers are those
of `parhelion panel eval`.
"""
import json
import math
import os
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [os.path.join(os.path.dirname(HERE), "structure"), HERE]
import panels  # noqa: E402
from layout import lines_of, symbols_of  # noqa: E402
from report import ROOT, Report, read  # noqa: E402

LIST = os.path.join(HERE, "abi.txt")
HEADER = os.path.join(ROOT, "src", "library", "parhelion_panel.h")
WARN = ["-Wall", "-Wextra", "-Wpedantic", "-Wstrict-prototypes", "-Werror"]
COMPONENTS = ("libparhelion-panel2", "libparhelion-panel-dev")
PANEL = panels.shipped("ips_cluster")


def run(*command, **options):
    return subprocess.run(command, capture_output=True, text=True, timeout=120, **options)


def check_list(report, library, folder):
    found = symbols_of(library) + lines_of(HEADER, os.path.dirname(HEADER), folder)
    if "--renew" in sys.argv:
        with open(LIST, "w", encoding="utf-8") as file:
            file.write(found)
    kept = read(os.path.relpath(LIST, ROOT)).splitlines()
    report.claim(len(kept) > 40, f"abi.txt has {len(kept)} lines only")
    gone = sorted(set(kept) - set(found.splitlines()))
    new = sorted(set(found.splitlines()) - set(kept))
    report.claim(not gone, f"the ABI lost {gone}")
    report.claim(not new, f"the ABI has what abi.txt has not: {new}")


def check_languages(report):
    for compiler, standard, language in (("cc", "c99", "c"), ("cc", "c17", "c"),
                                         ("c++", "c++17", "c++"), ("clang", "c99", "c")):
        warn = [word for word in WARN if language == "c" or "prototypes" not in word]
        done = run(compiler, "-fsyntax-only", f"-std={standard}", *warn, "-x", language,
                   "-I", os.path.dirname(HEADER), "-",
                   input="#include <parhelion_panel.h>\n#include <parhelion_panel.h>\n"
                         "int any;\n")
        report.claim(done.returncode == 0, f"{compiler} {standard}: {done.stderr.strip()}")


def check_object(report, library):
    said = run("readelf", "-d", library).stdout
    needed = {line.split("[")[1].rstrip("]") for line in said.splitlines() if "NEEDED" in line}
    report.claim("[libparhelion-panel.so.2]" in said, "the soname is another")
    report.claim(needed <= {"libc.so.6", "libm.so.6", "ld-linux-x86-64.so.2"},
                 f"the library needs {sorted(needed)}")
    report.claim("RUNPATH" not in said and "TEXTREL" not in said, "a path or text relocation")


def installed(report, build, folder):
    """The prefix of an installed tree, moved after its installation."""
    first, prefix = os.path.join(folder, "first"), os.path.join(folder, "moved here")
    for component in COMPONENTS:
        done = run("cmake", "--install", build, "--component", component, "--prefix", first)
        report.claim(done.returncode == 0, f"install of {component}: {done.stderr.strip()}")
    os.rename(first, prefix)
    return prefix


def files_under(prefix):
    return sorted(os.path.relpath(os.path.join(at, name), prefix)
                  for at, _, names in os.walk(prefix) for name in names)


def check_linked(report, build, folder):
    prefix = installed(report, build, folder)
    names = files_under(prefix)
    for wanted in ("parhelion_panel.h", "parhelion-panel.pc", "libparhelion-panel.so",
                   "libparhelion-panel.so.2", "parhelion_panel.py", "viewing_cone.py"):
        report.claim(any(os.path.basename(name) == wanted for name in names),
                     f"{wanted} is not installed: {names}")
    settings = os.path.dirname(next(name for name in names if name.endswith(".pc")))
    environment = {**os.environ, "PKG_CONFIG_PATH": os.path.join(prefix, settings)}
    flags = run("pkg-config", "--cflags", "--libs", "parhelion-panel", env=environment)
    report.claim(flags.returncode == 0, f"pkg-config: {flags.stderr}")
    binary = os.path.join(folder, "ask_panel")
    compiled = run("sh", "-c", f"cc -std=c99 {' '.join(WARN)} '{HERE}/ask_panel.c' -o "
                   f"'{binary}' {flags.stdout.strip()} -lm")
    if not report.claim(compiled.returncode == 0, f"linking: {compiled.stderr}"):
        return None
    where = os.path.dirname(next(name for name in names if name.endswith(".so.2")))
    asked = run(binary, PANEL, env={**os.environ,
                                    "LD_LIBRARY_PATH": os.path.join(prefix, where)})
    report.claim(asked.returncode == 0, f"ask_panel ends with {asked.returncode}: "
                 + asked.stderr.strip())
    return asked.stdout.splitlines()


def check_answers(report, program, lines):
    """Those of the program, as far as angles in degrees tell directions."""
    for line, (theta, phi, code) in zip(lines[1:], (
            (0, 0, "255,255,255"), (math.degrees(math.acos(0.8)), 0, "10,200.5,0"),
            (math.degrees(math.acos(0.96)), 270, "0,0,0"))):
        told = json.loads(run(program, "panel", "eval", PANEL, "--theta", str(theta), "--phi",
                              str(phi), "--rgb", code, "--json").stdout)
        found = [float(word) for word in line.split()[:3]]
        report.claim(all(abs(a / b - 1) < 1e-5 for a, b in zip(found, told["XYZ"])),
                     f"the library says {found}, the program {told['XYZ']}")
        report.claim(line.split()[3] == "1", f"not measured: {line}")
    dark, bright = ([float(word) for word in lines[i].split()] for i in (3, 1))
    report.claim(0 < dark[1] < 0.01 * bright[1], f"black is {dark}")


def main():
    report, build = Report(), os.path.abspath(sys.argv[1])
    library = os.path.join(build, "libparhelion-panel.so.2")
    with tempfile.TemporaryDirectory(prefix="abi-") as folder:
        check_list(report, library, folder)
        check_languages(report)
        check_object(report, library)
        lines = check_linked(report, build, folder)
        if lines:
            check_answers(report, os.path.join(build, "parhelion"), lines)
    report.finish()


if __name__ == "__main__":
    main()
