# SPDX-License-Identifier: Apache-2.0
"""luxmeter.py PARHELION -- `measure --illuminance` under all light that a command line can set:
closed forms where there are some, else what `sky` says of the same options.
"""
import json
import math
import os
import subprocess
import sys
import tempfile

from gltf import Scene, png

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

UP, EAST, SOUTH = (0, 1, 0), (1, 0, 0), (0, 0, 1)
SUN_LX, AZIMUTH, ELEVATION = 80000, 120, 35
NOON = ("--when", "2026-06-21T12:30+02:00", "--where", "48.14,11.58,520")
PANELS = os.path.join(ROOT, "assets", "panels")


def sun_on(azimuth=None):
    """lx of the sun on a horizontal plane, or on a vertical one that faces an azimuth."""
    elevation = math.radians(ELEVATION)
    return SUN_LX * (math.sin(elevation) if azimuth is None else
                     math.cos(elevation) * math.cos(math.radians(AZIMUTH - azimuth)))


SUN = ("--sun", f"{AZIMUTH},{ELEVATION},{SUN_LX}")
# options, what the head faces, lx
CLOSED_FORMS = (
    (("--environment", "constant:1000"), UP, 1000 * math.pi),
    (("--environment", "constant:1000"), EAST, 1000 * math.pi),
    (("--environment", "cie:3:12000"), UP, 12000),
    (SUN, UP, sun_on()),
    (SUN, EAST, sun_on(90)),
    (SUN, SOUTH, sun_on(180)),
    ((*SUN, "--heading", "90"), SOUTH, sun_on(270 - 360)),     # +Z is west now: none
    ((*SUN, "--heading", "-90"), SOUTH, sun_on(90)),
    ((*SUN, "--forward", "1,0,0"), SOUTH, sun_on(90)),         # +X is north, +Z east
    ((*SUN, "--environment", "constant:100"), UP, sun_on() + 100 * math.pi),
    (("--environment", "hdri:grey.exr", "--hdri-lux", "5000"), UP, 5000),
)
# the same as `sky` says
SKIES = (
    ("--environment", "sky:clear", *NOON),
    ("--environment", "sky:clear", *NOON, "--turbidity", "5"),
    ("--environment", "sky:clear", *NOON, "--visibility", "8"),
    ("--environment", "sky:clear", *NOON, "--ground", "sea"),
    ("--environment", "sky:clear", *NOON, "--sun", "off"),
    ("--environment", "perez:600,150", *NOON),
    ("--weather", "day.epw", "--when", "2026-06-21T12:30+02:00"),
)


def weather_text():
    """One day in June, every hour alike."""
    rows = "".join(f"2026,6,21,{hour},60,x,20,12,79,100100,0,1415,288,650,500,200,0,0,0,0\n"
                   for hour in range(1, 25))
    return ("LOCATION,Testville,-,NLD,Data,0,48.14,11.58,2.0,520\n" + "".join(
        f"{name}\n" for name in ("DESIGN CONDITIONS,0", "TYPICAL/EXTREME PERIODS,0",
                                 "GROUND TEMPERATURES,0", "HOLIDAYS/DAYLIGHT SAVINGS,No,0,0,0",
                                 "COMMENTS 1,none", "COMMENTS 2,none",
                                 "DATA PERIODS,1,1,Data,Sunday, 6/ 1,6/30")) + rows)


class Luxmeter:
    def __init__(self, program, folder):
        self.program, self.folder = os.path.abspath(program), folder

    def run(self, *line):
        done = subprocess.run([self.program, *line, "--json", "--quiet"], cwd=self.folder,
                              capture_output=True, text=True, check=False)
        assert done.returncode == 0, f"{' '.join(line)}: {done.stderr}"
        return json.loads(done.stdout)

    def lux(self, scene, place, normal, *options, samples=16384):
        """lx and its standard error."""
        answer = self.run("measure", scene, "--illuminance",
                          ",".join(f"{x:.9g}" for x in (*place, *normal)), "--samples",
                          str(samples), *options)
        low, high = answer["illuminance_interval"]
        return answer["illuminance_lx"], (high - low) / (2 * 1.96)


def claim(report, what, found, wanted, allowed=2e-3):
    """Within three standard errors and what single precision and tables leave."""
    lux, sigma = found
    report.claim(abs(lux - wanted) <= 3 * sigma + allowed * wanted + 1e-6,
                 f"{what}: {lux:.6g} lx (sigma {sigma:.2g}) instead of {wanted:.6g}")


def check_outside(report, meter):
    Scene().write(os.path.join(meter.folder, "empty.gltf"))
    subprocess.run([meter.program, "sky", "--environment", "constant:1", "-o", "grey.exr",
                    "--size", "64x32"], cwd=meter.folder, check=True, capture_output=True)
    with open(os.path.join(meter.folder, "day.epw"), "w", encoding="utf-8") as file:
        file.write(weather_text())
    for options, normal, wanted in CLOSED_FORMS:
        found = meter.lux("empty.gltf", (0, 0, 0), normal, *options)
        claim(report, f"{' '.join(options)} on {normal}", found, max(wanted, 0))
    for options in SKIES:
        wanted = meter.run("sky", *options)["global_horizontal_lx"]
        claim(report, " ".join(options), meter.lux("empty.gltf", (0, 0, 0), UP, *options),
              wanted, 5e-3)


def check_displays(report, meter):
    """A head 1 m in front of a screen of 1 cm2: its luminance times 1e-4 sr."""
    panels = [os.path.join(PANELS, name) for name in ("ips_cluster.panel", "oled_centre.panel")]
    for name, code in (("white", 255), ("black", 0)):
        with open(os.path.join(meter.folder, name + ".png"), "wb") as file:
            file.write(png(1, 1, [[code] * 3]))
    scene = Scene()
    plain = scene.material("screen")
    scene.quad(plain, [-0.005, -0.005, 0], [0.01, 0, 0], [0, 0.01, 0])
    scene.write(os.path.join(meter.folder, "screen.gltf"))
    for panel in panels:
        for content, code in (("white.png", "255,255,255"), ("black.png", "0,0,0")):
            wanted = meter.run("panel", "eval", panel, "--theta", "0", "--rgb",
                               code)["luminance_cd_m2"] * 1e-4
            for percent in (100, 25):
                options = ("--panel", f"screen={panel}", "--content", f"screen={content}",
                           "--display-level", f"*={percent}")
                found = meter.lux("screen.gltf", (0, 0, 1), (0, 0, -1), *options, "--root",
                                  ROOT)
                claim(report, f"{os.path.basename(panel)} {content} {percent} %", found,
                      wanted * percent / 100, 5e-3)


def check_many(report, meter):
    """Points by options and by files, in their order, each with the figures it has alone; under
    a uniform sky pi L on any plane, under the sun its cosine."""
    rows = [(x, y, z, *unit) for x, y, z, unit in (
        (0, 0, 0, (0, 1, 0)), (1, 2, 3, (0, 0, 5)), (-4, 0.5, 2, (0.6, 0.8, 0)),
        (0, 0, 0, (0, -1, 0)), (7, 7, 7, (-1e-20, 0, 0)))]
    with open(os.path.join(meter.folder, "points.csv"), "w", encoding="utf-8") as file:
        file.write("x,y,z,nx,ny,nz\n" + "".join(
            ",".join(f"{x:.9g}" for x in row) + "\n" for row in rows[1:]))
    light = (*SUN, "--environment", "constant:100")
    line = ("measure", "empty.gltf", "--samples", "4096", *light)
    first = ",".join(f"{x:.9g}" for x in rows[0])
    answers = meter.run(*line, "--illuminance", first, "--illuminance", "points.csv")
    report.claim([(a["place"], a["illuminance_lx"] > 0) for a in answers] ==
                 [(list(map(float, row[:3])), True) for row in rows], f"order: {answers}")
    to_sun = [math.sin(math.radians(AZIMUTH)) * math.cos(math.radians(ELEVATION)),
              math.sin(math.radians(ELEVATION)),
              -math.cos(math.radians(AZIMUTH)) * math.cos(math.radians(ELEVATION))]
    for row, answer in zip(rows, answers):
        normal = [x / math.hypot(*row[3:]) for x in row[3:]]
        wanted = SUN_LX * max(sum(a * b for a, b in zip(normal, to_sun)), 0) + 100 * math.pi
        low, high = answer["illuminance_interval"]
        claim(report, f"many: {row}", (answer["illuminance_lx"], (high - low) / 3.92), wanted)
        alone = meter.run(*line, "--illuminance", ",".join(f"{x:.9g}" for x in row))
        report.claim(alone == answer, f"alone {alone}, among others {answer}")
    done = subprocess.run([meter.program, *line, "--illuminance", "points.csv", "--csv"],
                          cwd=meter.folder, capture_output=True, text=True, check=True)
    table = [line.split(",") for line in done.stdout.splitlines()]
    report.claim(table[0][:7] == ["x", "y", "z", "nx", "ny", "nz", "illuminance_lx"] and
                 [float(row[6]) for row in table[1:]] ==
                 [answer["illuminance_lx"] for answer in answers[1:]], f"--csv: {table}")
    for wrong, status, words in (
            (("--illuminance", "0,0,0,0,0,0"), 2, "has no direction"),
            (("--illuminance", "0,0,0,nan,0,1"), 2, "required 6 numbers"),
            (("--illuminance", "0,0,0"), 2, "required 6 numbers"),
            (("--illuminance", "none.csv"), 3, "none.csv"),
            (("--illuminance", first, "--display", "x"), 2, "--display"),
            (("--illuminance", first, "--region", "0,0,1,1"), 2, "--region")):
        done = subprocess.run([meter.program, *line, *wrong], cwd=meter.folder,
                              capture_output=True, text=True, check=False)
        report.claim(done.returncode == status and words in done.stderr, f"{wrong}: {done}")


def main():
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        meter = Luxmeter(sys.argv[-1], folder)
        for check in (check_outside, check_displays, check_many):
            try:
                check(report, meter)
            except AssertionError as error:
                report.claim(False, f"{check.__name__}: {error}")
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
