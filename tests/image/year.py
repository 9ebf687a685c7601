# SPDX-License-Identifier: Apache-2.0
"""year.py [--all] PARHELION -- a year's steps by loops that share nothing with the program.

A display lies on the ground, faces up in the open, and reflects as a white wall does: its
illuminance is the sky's global one, what it reflects that times its albedo over pi, and its
contrast follows. Two years: under clear skies, whose steps are held to moments, frames, the
luxmeter and `sky` at twelve dates, since all have one sun; and under a weather file, recounted
row by row with Perez's efficacies and a sun of the Astronomical Almanac's. --all: by the file's
own lux, too, and the shared data's weather of Amsterdam, every hour, by either rule; and every
date, else two.
"""
import csv
import datetime
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile

from gltf import Scene, png

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

AMSTERDAM = os.path.join(ROOT, "..", "shared", "data", "solar",
                         "NLD_Amsterdam062400_IWEC.epw")
YEAR, ALBEDO, WHITE_CD_M2, LIMIT = 2026, 0.15, 400.0, 1.5
PLACE = (48.14, 11.58, 520)
DATES = [f"{YEAR}-{month:02}-{day:02}" for month, day in
         ((1, 3), (2, 9), (3, 20), (4, 15), (5, 21), (6, 21), (7, 2), (8, 11), (9, 23),
          (10, 18), (11, 13), (12, 21))]

# Perez, Ineichen, Seals, Michalsky, Stewart 1990: direct and diffuse luminous efficacy
BINS = (1.065, 1.23, 1.5, 1.95, 2.8, 4.5, 6.2)
DIRECT = ((57.20, 98.99, 109.83, 110.34, 106.36, 107.19, 105.75, 101.18),
          (-4.55, -3.46, -4.90, -5.84, -3.97, -1.25, 0.77, 1.58),
          (-2.98, -1.21, -1.71, -1.99, -1.75, -1.51, -1.26, -1.10),
          (117.12, 12.38, -8.81, -4.56, -6.16, -26.73, -34.44, -8.29))
DIFFUSE = ((97.24, 107.22, 104.97, 102.39, 100.71, 106.42, 141.88, 152.23),
           (-0.46, 1.15, 2.96, 5.59, 5.94, 3.83, 1.90, 0.35),
           (12.00, 0.59, -5.53, -13.95, -22.75, -36.15, -53.24, -45.27),
           (-8.91, -3.95, -8.77, -13.90, -23.74, -28.83, -14.03, -7.98))


# ---- an own sun and an own sky -----------------------------------------------------------

def sun_of(moment, latitude, longitude):
    """Elevation in degrees, refraction in it, and the distance in au: the Astronomical
    Almanac's low-precision formulas (0.01 degrees)."""
    days = (moment - datetime.datetime(2000, 1, 1, 12)).total_seconds() / 86400
    anomaly = math.radians(357.528 + 0.9856003 * days)
    along = math.radians(280.460 + 0.9856474 * days + 1.915 * math.sin(anomaly) +
                         0.020 * math.sin(2 * anomaly))
    tilt = math.radians(23.439 - 4e-7 * days)
    ascension = math.atan2(math.cos(tilt) * math.sin(along), math.cos(along))
    declination = math.asin(math.sin(tilt) * math.sin(along))
    turned = math.radians(280.46062 + 360.98564737 * days + longitude) - ascension
    here = math.radians(latitude)
    true = math.degrees(math.asin(math.sin(here) * math.sin(declination) + math.cos(here) *
                                  math.cos(declination) * math.cos(turned)))
    lift = 1.02 / math.tan(math.radians(true + 10.3 / (true + 5.11))) / 60 if true > -1 else 0
    return true + lift, 1.00014 - 0.01671 * math.cos(anomaly) - 0.00014 * math.cos(2 * anomaly)


def clearness(direct, diffuse, zenith):
    bent = 1.041 * zenith ** 3
    return min(max(((direct + diffuse) / diffuse + bent) / (1 + bent), 1), 12)


def perez_lux(direct, diffuse, elevation, distance, water):
    """Direct normal and diffuse horizontal lux."""
    zenith = math.radians(min(89.9, 90 - elevation))
    clear = clearness(direct, diffuse, zenith)
    mass = 1 / (math.cos(zenith) + 0.15 * (93.885 - math.degrees(zenith)) ** -1.253)
    bright = min(max(diffuse * mass * distance ** 2 / 1367, 0.01), 0.6)
    k = sum(clear >= edge for edge in BINS)
    beam, sky = ([column[k] for column in table] for table in (DIRECT, DIFFUSE))
    return (direct * max(0, beam[0] + beam[1] * water + beam[2] * math.exp(5.73 * zenith - 5) +
                         beam[3] * bright),
            diffuse * (sky[0] + sky[1] * water + sky[2] * math.cos(zenith) +
                       sky[3] * math.log(bright)))


# ---- the scene ---------------------------------------------------------------------------

def wall_panel(program, folder):
    """A panel that reflects alike in all directions, and white of 400 cd/m2."""
    def table(name, head, rows):
        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
            file.write(head + "\n" + "".join(row + "\n" for row in rows))
    incidences = [0, 10, 20, 30, 40, 50, 60, 70, 80, 85]
    y = WHITE_CD_M2
    table("white.csv", "theta,phi,X,Y,Z",
          [f"{t},0,{0.9505 * y:.4f},{y},{1.089 * y:.4f}" for t in range(0, 86, 5)])
    for incidence in incidences:
        table(f"i{incidence}.csv", "theta,phi,550",
              [f"{t},{p},{ALBEDO / math.pi:.8f}" for t in range(0, 89, 8)
               for p in (range(0, 360, 30) if t else (0,))])
    with open(os.path.join(folder, "wall.json"), "w", encoding="utf-8") as file:
        json.dump({"emission": {"white": "white.csv"}, "reflection": {
            "wavelengths_nm": [550], "incidence_deg": incidences,
            "files": "i{incidence}.csv"}}, file)
    subprocess.run([program, "panel", "fit", "wall.json", "-o", "wall.panel", "--quiet"],
                   cwd=folder, check=True, capture_output=True)


def ground():
    scene = Scene()
    bars = png(60, 30, [[255 if 20 <= x < 40 and 8 <= y < 22 else 0 for x in range(60)
                         for _ in range(3)] for y in range(30)])
    screen = scene.material("screen", extensions={"PARHELION_display": {
        "panel": "wall.panel", "content": {"index": scene.image("image/png", bars)},
        "level": 1}})
    scene.quad(screen, [-0.15, 0, 0.075], [0.3, 0, 0], [0, 0, -0.15])
    scene.probe("above", [0, 1, 0], [0, -1, 0], 0.07)
    return scene


PROFILE = {"title": "one limit", "edition": "1", "ambient": {
    "night_below_lx": 5, "twilight_below_lx": 100, "source": "test",
    "read_in_the_standard": False}, "limits": [{
        "ambient": "any", "kind": "contrast_ratio", "value": LIMIT, "unit": "1",
        "source": "test", "read_in_the_standard": False}]}


class Year:
    def __init__(self, program, folder):
        self.program, self.folder = os.path.abspath(program), folder
        wall_panel(self.program, folder)
        ground().write(self.path("ground.gltf"))
        self.write("one.json", json.dumps(PROFILE))

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)

    def run(self, *line):
        done = subprocess.run([self.program, *line, "--quiet"], cwd=self.folder,
                              capture_output=True, text=True, check=False)
        assert done.returncode in (0, 1), f"{' '.join(line)}: {done.stderr}"
        return done.stdout

    def review(self, out, *conditions):
        """What the review says, with the rows of its sweeps' tables."""
        self.write("r.json", json.dumps({
            "title": "year", "scene": ["ground.gltf"], "profile": "./one.json",
            "eyes": {"eye": {"position_m": [0.05, 0.8, 0.3]}},
            "symbols": {"bar": {"display": "screen", "uv": [0.1, 0.1, 0.9, 0.9]}},
            "levels": {"on": {"*": 1}}, "frames": {"size": [16, 9], "noise": 1, "worst": 0},
            "precision": {"contrast": 0.01}, "conditions": list(conditions)}))
        self.run("review", "r.json", "-o", out)
        with open(os.path.join(self.folder, out, "review.json"), encoding="utf-8") as file:
            found = json.load(file)
        for sweep in found["sweeps"]:
            table = os.path.join(self.folder, out, sweep["table"])
            with open(table, encoding="utf-8") as file:
                sweep["rows"] = list(csv.DictReader(file))
        return found


def shown(lux):
    """Contrast of the symbol."""
    return 1 + WHITE_CD_M2 / (ALBEDO / math.pi * lux)


def moment_of(row):
    return datetime.datetime(YEAR, 1, 1) + datetime.timedelta(
        days=int(row["day_of_year"]) - 1, hours=float(row["hour_utc"]))


# ---- one sun for all commands ------------------------------------------------------------

CLEAR = {"name": "clear", "level": "on", "sweep": {"year": YEAR, "where": PLACE,
                                                   "step_minutes": 1440}}


def moment(date):
    return {"name": date, "level": "on", "environment": {
        "type": "sky", "when": date + "T12:00:00Z", "where": PLACE, "moon": False}}


def by_frame(year, light):
    """What the luxmeter says, and the luminance of the display in a frame."""
    meter = json.loads(year.run("measure", "ground.gltf", "--illuminance", "0,0.001,0,0,1,0",
                                "--samples", "4096", "--json", *light))
    year.run("render", "ground.gltf", "--camera", "above", "--size", "8x8", "--spp", "64",
             "-o", "f.exr", "--display-level", "screen=0", *light)
    frame = json.loads(year.run("measure", "f.exr", "--json"))
    return meter["illuminance_lx"], frame["luminance_cd_m2"]


def check_date(report, year, date, step, case):
    """Light that is reflected is known less well than lux: the panel's fit has an error."""
    light = ("--environment", "sky:clear", "--when", date + "T12:00:00Z", "--where",
             ",".join(map(str, PLACE)))
    sky = json.loads(year.run("sky", *light, "--json"))
    truth = sky["global_horizontal_lx"]
    reflected = ALBEDO / math.pi * truth
    told = {"a step's lux": float(step["display_lx"]) / truth,
            "a step's light": float(step["reflected_cd_m2"]) / reflected}
    told["a moment's lux"] = case["display_lux"] / truth
    told["a moment's light"] = case["luminance_cd_m2"]["reflected"] / reflected
    lux, luminance = by_frame(year, light)
    told["a luxmeter's lux"] = lux / truth
    told["a frame's light"] = luminance / reflected
    print(f"{date}: the sky's {truth:.0f} lx; " +
          ", ".join(f"{what} {100 * ratio - 100:+.2f} %" for what, ratio in told.items()))
    for what, ratio in told.items():
        report.claim(abs(ratio - 1) < (0.003 if what.endswith("lux") else 0.006),
                     f"{date}: {what} is {ratio:.4f} of the sky's {truth:.0f} lx")
    own = sun_of(datetime.datetime.fromisoformat(date + "T12:00:00"), *PLACE[:2])
    report.claim(abs(sky["sun"]["distance_au"] - own[1]) < 1e-4 and
                 abs(sky["sun"]["elevation_deg"] - own[0]) < 0.03,
                 f"{date}: sun {sky['sun']}, by the Almanac {own}")


def check_one_sun(report, year, found, dates):
    """Noon of some dates: steps of a clear year beside `sky`, moments, the luxmeter and
    frames. The earth is 1.7 % nearer or farther at the ends of the year, 3.4 % in its light."""
    steps = {moment_of(row).date().isoformat(): row for row in found["sweeps"][0]["rows"]}
    cases = {case["condition"]: case for case in found["cases"]}
    for date in dates:
        check_date(report, year, date, steps[date], cases[date])


# ---- a year by its weather ---------------------------------------------------------------

def weather_rows(path):
    """The place, and by month, day and label: direct, diffuse, dew point, lux columns."""
    with open(path, encoding="utf-8") as file:
        lines = [line.rstrip("\n").split(",") for line in file]
    head = lines[0]
    rows = {(int(f[1]), int(f[2]), int(f[3])): tuple(float(f[i]) for i in (14, 15, 7, 17, 18))
            for f in lines if f[0].isdigit()}
    return (float(head[6]), float(head[7])), float(head[8]), rows


def own_lux(moment, weather, by_file):
    """Global horizontal lux, and whether it is sure: the sun stands high and the sky's
    clearness is not at one of Perez's bounds, where his fit jumps; None: the row is dark."""
    (latitude, longitude), zone, rows = weather
    label = moment + datetime.timedelta(hours=zone + 0.5)
    day = label - datetime.timedelta(hours=1)
    direct, diffuse, dew_point, *lux = rows[day.month, day.day, day.hour + 1]
    elevation, distance = sun_of(moment, latitude, longitude)
    if not diffuse:
        return None, True
    clear = clearness(direct, diffuse, math.radians(90 - elevation))
    sure = elevation > 5 and (by_file or all(abs(clear / edge - 1) > 2e-3 for edge in BINS))
    if not by_file:
        lux = perez_lux(direct, diffuse, elevation, distance,
                        math.exp(0.07 * dew_point - 0.075))
    return lux[1] + lux[0] * math.sin(math.radians(elevation)), sure


def by_weather(name, path, step_minutes, rule):
    return {"name": name, "level": "on", "sweep": {
        "year": YEAR, "step_minutes": step_minutes, "weather": path, "weather_lux": rule}}


def recount(report, year, found, condition):
    """Each step's lux and contrast, their sum, and the share that fails."""
    name, asked = condition["name"], condition["sweep"]
    is_files = asked["weather_lux"] == "file"
    weather = weather_rows(year.path(asked["weather"]))
    sweep = next(s for s in found["sweeps"] if s["condition"] == name)
    sums, failing, worst = [0, 0], 0, (0, "")
    for row in sweep["rows"]:
        lux, sure = own_lux(moment_of(row), weather, is_files)
        if lux is None:
            report.claim(float(row["display_lx"]) == 0, f"{row}: lit, and its row is dark")
            continue
        sums = [sums[0] + float(row["display_lx"]), sums[1] + lux]
        failing += shown(lux) < LIMIT
        off = float(row["display_lx"]) / lux - 1
        if sure and abs(off) > worst[0]:
            worst = (abs(off), f"{moment_of(row)}: {row['display_lx']} lx, own {lux:.0f}")
    share = failing / len(sweep["rows"])
    print(f"{name}: {len(sweep['rows'])} steps, {100 * sums[0] / sums[1] - 100:+.2f} % of "
          f"light, fails {sweep['failed_share']:.4f}, own {share:.4f}; worst {worst[1]}")
    report.claim(abs(sums[0] / sums[1] - 1) < 0.005, f"{name}: lux {sums}")
    report.claim(worst[0] < 0.02, f"{name}: {worst}")
    report.claim(0.1 < share < 0.9 and abs(sweep["failed_share"] - share) < 0.006,
                 f"{name}: {sweep['failed_share']} fails, own {share}")
    words = "the file's own columns" if is_files else "Perez 1990's luminous efficacies"
    report.claim(words in " ".join(found["notes"]),
                 f"{name}: no word of the rule in {found['notes']}")
    words = "lx by the file's columns" if is_files else "lx by Perez 1990"
    report.claim(words in sweep["worst"]["when"], f"{name}: {sweep['worst']['when']}")


def weather_text():
    """A year of noons: clear, broken and overcast days, damp and dry ones; the lux columns
    are no efficacy's."""
    rows = []
    for day in range(365):
        date = datetime.date(YEAR, 1, 1) + datetime.timedelta(days=day)
        season = 0.5 - 0.5 * math.cos(2 * math.pi * (day + 10) / 365)
        cloud = (day * 7 % 11) / 10
        direct = round((300 + 500 * season) * max(0, 1 - 1.4 * cloud))
        diffuse = round(60 + (60 + 200 * season) * cloud)
        rows.append(f"{date.year},{date.month},{date.day},13,60,x,9,{day * 5 % 31 - 12},79,"
                    f"100100,0,1415,288,0,{direct},{diffuse},0,{100 * direct},"
                    f"{115 * diffuse},0\n")
    return ("LOCATION,Testville,-,DEU,Data,0,48.14,11.58,0.5,520\n"
            "DATA PERIODS,1,1,Data,Sunday, 1/ 1,12/31\n" + "".join(rows))


def main(program, whole):
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        year = Year(program, folder)
        year.write("noons.epw", weather_text())
        rules = ("perez", "file") if whole else ("perez",)
        years = [by_weather(rule, "noons.epw", 1440, rule) for rule in rules]
        if whole and os.path.exists(AMSTERDAM):
            shutil.copy(AMSTERDAM, year.path("amsterdam.epw"))
            years += [by_weather(f"Amsterdam, {rule}", "amsterdam.epw", 60, rule)
                      for rule in rules]
        elif whole:
            report.skip("a year of Amsterdam: the shared data is not beside the checkout")
        chosen = DATES if whole else DATES[::6]
        found = year.review("out", CLEAR, *years, *map(moment, chosen))
        check_one_sun(report, year, found, chosen)
        for condition in years:
            recount(report, year, found, condition)
    return report.finish()


if __name__ == "__main__":
    sys.exit(main(sys.argv[-1], "--all" in sys.argv))
