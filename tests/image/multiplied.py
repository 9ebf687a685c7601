# SPDX-License-Identifier: Apache-2.0
"""multiplied.py PARHELION -- a frame that another program multiplied is not the same.

All channels or R, G, B alone, by 1 and other factors, of the same seed and of another: `compare`
says different, or with status 3 that the noise is not known, and names the layer of counts that
holds none; a reason is never an interval that holds 0.
"""
import os
import re
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.normpath(os.path.join(HERE, "..", ".."))
sys.path.insert(0, os.path.join(HERE, "..", "structure"))
from pictures import read_exr, write_exr  # noqa: E402
from report import Report  # noqa: E402

FACTORS = 1, 1.02, 1.3, 0.5, 0.001
SAME, DIFFERENT, UNKNOWN = 0, 1, 3


def render(program, path, seed):
    scenes = [os.path.join(ROOT, "scenes", name) for name in ("car_dashboard.gltf", "noon.gltf")]
    subprocess.run([program, "render", *scenes, "--size", "64x36", "--spp", "8", "--layers",
                    "all", "--seed", str(seed), "-o", path, "--quiet", "--no-guiding"], check=True,
                   capture_output=True)


def multiply(source, path, factor, only_light):
    frame = read_exr(source)
    channels = {name: [value * (factor if not only_light or name in "RGB" else 1.0)
                       for value in values] for name, values in frame["channels"].items()}
    write_exr(path, frame["width"], frame["height"], channels, frame["attributes"])


def holds_nothing(text):
    """Intervals of what moved that hold 0."""
    return [(change, half) for change, half in
            re.findall(r"([+-][\d.e+-]+) \+- ([\d.e+-]+) %", text)
            if "contrast" not in text and abs(float(change)) <= float(half)]


def main():
    program = os.path.abspath(sys.argv[1])
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        files = [os.path.join(folder, name) for name in ("a.exr", "b.exr", "made.exr")]
        render(program, files[0], 1)
        render(program, files[1], 2)
        for other in files[:2]:
            for factor in FACTORS:
                for only_light in False, True:
                    multiply(other, files[2], factor, only_light)
                    done = subprocess.run([program, "compare", files[0], files[2]],
                                          capture_output=True, text=True)
                    said = done.stdout + done.stderr
                    name = f"{os.path.basename(other)} x {factor}{' light' * only_light}"
                    wanted = (SAME,) if factor == 1 else (DIFFERENT, UNKNOWN)
                    if only_light and other == files[1]:  # what is below the noise is not found
                        wanted = (SAME, DIFFERENT) if factor == 1.02 else wanted[:1]
                    report.claim(done.returncode in wanted, f"{name}: {done.returncode} {said}")
                    multiplied = factor != 1 and not only_light
                    report.claim((" has in layer " in said) == multiplied, f"{name}: {said}")
                    last = said.strip().splitlines()[-1]
                    report.claim(not holds_nothing(last), f"{name}: {last}")
    report.finish()


if __name__ == "__main__":
    main()
