# SPDX-License-Identifier: Apache-2.0
"""panels.py -- what the scripts that measure panels share: running the program, sets of tables,
foreign sets brought into this project's form, and errors at measured samples.
"""
import json
import math
import os
import subprocess
import sys

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
DATA = os.environ.get("SHARED_DATA_DIR", os.path.join(ROOT, "..", "shared", "data"))
PRIMARIES = ("red", "green", "blue")


class Refused(Exception):
    """The program ended with an error; the text is its line."""


# A small process that starts the fits: the peak memory of a child counts from what its parent
# had when it was forked.
LAUNCHER = """
import json, os, subprocess, sys, time
for line in sys.stdin:
    start = time.perf_counter()
    p = subprocess.Popen(json.loads(line), stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    out, errors = p.stdout.read().decode(), p.stderr.read().decode()
    _, status, used = os.wait4(p.pid, 0)
    took = {"seconds": time.perf_counter() - start, "peak_bytes": used.ru_maxrss * 1024,
            "processor_seconds": used.ru_utime + used.ru_stime}
    print(json.dumps([os.waitstatus_to_exitcode(status), out, errors, took]), flush=True)
"""


def take_option(arguments, name, default):
    """The value behind `name`, which goes out of the arguments; the default when it is not
    there."""
    if name not in arguments:
        return default
    at = arguments.index(name)
    value = arguments[at + 1]
    del arguments[at:at + 2]
    return value


class Program:
    def __init__(self, path, folder):
        self.path, self.folder = os.path.abspath(path), folder
        self.launcher = subprocess.Popen([sys.executable, "-c", LAUNCHER], text=True,
                                         stdin=subprocess.PIPE, stdout=subprocess.PIPE)

    def file(self, *names):
        return os.path.join(self.folder, *names)

    def run(self, *arguments):
        done = subprocess.run([self.path, *map(str, arguments)], capture_output=True, text=True)
        if done.returncode != 0:
            raise Refused(done.stderr.strip().splitlines()[-1] if done.stderr else
                          f"status {done.returncode}")
        return done.stdout

    def fit(self, manifest, panel, *options):
        """Fits; the report, with what it took: seconds (wall, processor) and bytes of
        memory."""
        request = [self.path, "panel", "fit", manifest, "-o", panel, "--json", "--quiet",
                   *map(str, options)]
        self.launcher.stdin.write(json.dumps(request) + "\n")
        self.launcher.stdin.flush()
        status, out, errors, took = json.loads(self.launcher.stdout.readline())
        if status != 0:
            raise Refused(errors.strip().splitlines()[-1] if errors else f"status {status}")
        return {**json.loads(out), **took, "file_bytes": os.path.getsize(panel)}

    def ask(self, panel, columns, rows, *options):
        """Answers to a batch of questions, as lists of numbers with their column names."""
        path = self.file("questions.csv")
        with open(path, "w") as out:
            out.write(",".join(columns) + "\n")
            out.writelines(",".join(f"{v:.9g}" for v in row) + "\n" for row in rows)
        text = self.run("panel", "eval", panel, "--batch", path, "--csv", *options)
        lines = text.split("\n")
        return lines[0].split(","), [list(map(float, line.split(","))) for line in lines[1:]
                                     if line]


# ---- tables ------------------------------------------------------------------------------

class Table:
    """One measured table: directions in degrees and a list of values a direction."""

    def __init__(self, name, path=None):
        self.name, self.rows, self.text_bytes = name, [], 0
        self.rgb = self.incidence = None
        self.azimuth, self.wavelengths = 180.0, []
        if path:
            self.read(path)

    def read(self, path):
        self.text_bytes += os.path.getsize(path)
        with open(path) as file:
            lines = [line for line in file if line.strip() and not line.startswith("#")]
        names = [name.strip() for name in lines[0].split(",")]
        theta, phi = names.index("theta"), names.index("phi")
        rest = [i for i in range(len(names)) if i not in (theta, phi)]
        if names[rest[0]] in ("Y", "X") and "Z" in names:
            rest = [names.index(name) for name in "XYZ"]
        for line in lines[1:]:
            cells = list(map(float, line.split(",")))
            self.rows.append((cells[theta], cells[phi], [cells[i] for i in rest]))

    def float32_bytes(self):
        return 4 * sum(len(values) for _, _, values in self.rows)

    def questions(self):
        if self.incidence is None:
            return ("theta", "phi", "r", "g", "b"), [(t, p, *self.rgb) for t, p, _ in self.rows]
        return (("theta", "phi", "incidence", "incidence_phi"),
                [(t, p, self.incidence, self.azimuth) for t, p, _ in self.rows])


def read_set(manifest):
    """All tables of a set in this project's layout."""
    with open(manifest) as file:
        text = json.load(file)
    folder, tables = os.path.dirname(manifest), []
    for name, entry in text.get("emission", {}).items():
        one_level = {"black": "0", "white": "255"}.get(name)
        levels = {one_level: entry} if one_level else entry
        for level, path in levels.items():
            table = Table(name if name in ("black", "white") else f"{name} {level}",
                          os.path.join(folder, path))
            code = float(level)
            table.rgb = ((code, code, code) if name in ("black", "white") else
                         tuple(code if name == p else 0.0 for p in PRIMARIES))
            tables.append(table)
    reflection = text.get("reflection")
    if reflection:
        azimuths = reflection.get("incidence_phi_deg", [180.0])
        for incidence in reflection["incidence_deg"]:
            for azimuth in azimuths:
                tables.append(reflection_table(folder, reflection, incidence, azimuth))
    return tables


def reflection_table(folder, reflection, incidence, azimuth):
    table = Table(f"brdf {incidence:g} deg" +
                  (f" at {azimuth:g}" if "incidence_phi_deg" in reflection else ""))
    pattern = reflection["files"].replace("{incidence}", f"{incidence:.10g}")
    pattern = pattern.replace("{azimuth}", f"{azimuth:.10g}")
    table.read(os.path.join(folder, pattern))
    table.incidence, table.azimuth = incidence, azimuth
    table.wavelengths = reflection["wavelengths_nm"]
    return table


# ---- errors at the measured samples ------------------------------------------------------

class Errors:
    def __init__(self):
        self.max, self.squares, self.count, self.place = 0.0, 0.0, 0, None
        self.found = self.source = 0.0
        self.masked = 0

    def add(self, found, source, place):
        if source <= 0:
            self.masked += 1
            return
        error = abs(found / source - 1)
        if error > self.max:
            self.max, self.place = error, place
        self.squares += error * error
        self.count += 1

    def add_integral(self, found, source, weight):
        self.found += weight * found
        self.source += weight * source

    def merge(self, other):
        if other.max > self.max:
            self.max, self.place = other.max, other.place
        self.squares += other.squares
        self.count += other.count
        self.masked += other.masked

    def rms(self):
        return math.sqrt(self.squares / self.count) if self.count else 0.0

    def integral(self):
        return self.found / self.source - 1 if self.source else 0.0


def solid_angle_weights(rows):
    """cos(theta) times the solid angle that a row stands for, on any product grid."""
    thetas, phis = sorted({t for t, _, _ in rows}), sorted({p for _, p, _ in rows})

    def widths(values, low, high):
        edges = [low] + [(a + b) / 2 for a, b in zip(values, values[1:])] + [high]
        return {v: edges[i + 1] - edges[i] for i, v in enumerate(values)}

    theta_width = widths(thetas, 0, thetas[-1])
    ends = (phis[0] + phis[-1] - 360) / 2
    phi_width = widths(phis, ends, ends + 360) if len(phis) > 1 else {phis[0]: 360}
    at_pole = sum(1 for t, _, _ in rows if t == 0)
    result = []
    for t, p, _ in rows:
        if t == 0:
            high = math.radians(theta_width[0])
            result.append(math.sin(high) ** 2 * math.pi / at_pole)
        else:
            result.append(math.sin(math.radians(t)) * math.cos(math.radians(t)) *
                          math.radians(theta_width[t]) * math.radians(phi_width[p]))
    return result


def angle_between(theta_a, phi_a, theta_b, phi_b):
    """Degrees; exact also for small angles."""
    a, b = math.radians(theta_a), math.radians(theta_b)
    dt, dp = math.sin((a - b) / 2), math.sin(math.radians(phi_a - phi_b) / 2)
    return 2 * math.degrees(math.asin(math.sqrt(min(1, dt * dt + math.sin(a) * math.sin(b) *
                                                    dp * dp))))


def mirror_image(fwhm_deg, incidence, theta, phi):
    """What the instrument sees of a mirror of reflectance 1, sr^-1."""
    sigma = math.radians(fwhm_deg) / math.sqrt(8 * math.log(2))
    d = math.radians(angle_between(theta, phi, incidence, 0))
    return (math.exp(-0.5 * (d / sigma) ** 2) / (2 * math.pi * sigma * sigma) /
            math.cos(math.radians(incidence)))


def compare(program, panel, table, fwhm_deg=0.0):
    """Relative errors of a table's samples, each against its own value. With fwhm_deg the
    mirror's image, as the instrument saw it, belongs to the answer."""
    columns, questions = table.questions()
    options = ["--brdf"] if table.incidence is not None else []
    names, answers = program.ask(panel, columns, questions, *options)
    first = names.index("X" if table.incidence is None else "brdf")
    count = 3 if table.incidence is None else len(table.wavelengths)
    if table.incidence is not None:  # a row a wavelength
        answers, first = [[row[first] for row in answers[i:i + count]]
                          for i in range(0, len(answers), count)], 0
    mirror = [0.0] * count
    if table.incidence is not None and fwhm_deg:
        mirror = json.loads(program.run("panel", "eval", panel, "--brdf", "--incidence",
                                        table.incidence, "--theta", 0, "--json"))["mirror"]
    errors = Errors()
    for (t, p, source), answer, weight in zip(table.rows, answers,
                                              solid_angle_weights(table.rows)):
        found = answer[first:first + count]
        if any(mirror):
            image = mirror_image(fwhm_deg, table.incidence, t, p)
            found = [f + m * image for f, m in zip(found, mirror)]
        for i in range(count):
            errors.add(found[i], source[i], (table.name, t, p, i))
            if count != 3 or table.incidence is not None or i == 1:
                errors.add_integral(found[i], source[i], weight)
    return errors


# ---- sets --------------------------------------------------------------------------------

def recipe(name):
    with open(os.path.join(ROOT, "assets", "panels", name + ".recipe.json")) as file:
        return json.load(file)


def without_noise(text):
    text = json.loads(json.dumps(text))
    text["instrument"].update(noise_relative=0, noise_cd_m2=0, noise_brdf_sr=0)
    return text


def with_grid(text, thetas, phis, theta_max=88):
    """Steps so that the grid has so many rings (the normal apart) and azimuths."""
    text = json.loads(json.dumps(text))
    instrument = text["instrument"]
    instrument.update(theta_max_deg=theta_max, theta_step_deg=theta_max / thetas,
                      phi_step_deg=360 / phis)
    instrument.pop("brdf_theta_step_deg", None)
    instrument.pop("brdf_phi_step_deg", None)
    return text


def simulate(program, text, name):
    """The set's manifest."""
    folder = program.file(name)
    os.makedirs(folder, exist_ok=True)
    path = os.path.join(folder, "recipe.json")
    with open(path, "w") as out:
        json.dump(text, out)
    program.run("panel", "simulate", path, "-o", folder, "--quiet")
    return os.path.join(folder, "MANIFEST.json")


def edit_manifest(manifest, name, change):
    """A second manifest beside the first one."""
    with open(manifest) as file:
        text = json.load(file)
    change(text)
    path = os.path.join(os.path.dirname(manifest), name)
    with open(path, "w") as out:
        json.dump(text, out)
    return path


def emission_only(manifest):
    return edit_manifest(manifest, "EMISSION.json", lambda text: text.pop("reflection", None))


FLAT = "flat.csv" # an emission that hardly takes any bytes


def reflection_only(manifest, flat=False):
    """Without emission, or with a flat one for a program that insists on it."""
    def change(text):
        for key in ("emission", "polarisation"):  # of emitted light
            text.pop(key, None)
        if flat:
            text["emission"] = {"white": FLAT}
            rows = [(t, p, 95, 100, 109) for t in range(0, 81, 10) for p in range(0, 360, 30)]
            write_table(os.path.join(os.path.dirname(manifest), FLAT),
                        ("theta", "phi", "X", "Y", "Z"), rows)
        text.pop("primaries", None)
    return edit_manifest(manifest, "REFLECTION.json", change)


# ---- the foreign sets --------------------------------------------------------------------

def write_table(path, names, rows):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w") as out:
        out.write(",".join(names) + "\n")
        out.writelines(",".join(map(str, row)) + "\n" for row in rows)


def convert_set_a(folder):
    """shared/data/panels/set-a in this project's layout, by this script's own hand."""
    source = os.path.join(DATA, "panels", "set-a")
    manifest = {"panel": "set-a", "emission": {"black": "emission/black.csv"}, "reflection": {}}
    for name in sorted(os.listdir(source)):
        if name.startswith("truth"):
            continue
        kind, level = name[:-4].split("_")
        with open(os.path.join(source, name)) as file:
            lines = file.read().replace("theta_deg", "theta").replace("phi_deg", "phi")
        lines = lines.replace("nm", "")
        target = ("emission/black.csv" if kind == "K" else f"brdf/i{int(level)}.csv"
                  if kind == "BRDF" else f"emission/{kind}_{level}.csv")
        path = os.path.join(folder, target)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w") as out:
            out.write(lines)
        if kind in "RGB":
            key = dict(zip("RGB", PRIMARIES))[kind]
            manifest["emission"].setdefault(key, {})[str(int(level))] = target
    manifest["reflection"] = {"wavelengths_nm": list(range(400, 701, 20)),
                              "incidence_deg": list(range(5, 66, 10)),
                              "files": "brdf/i{incidence}.csv"}
    return write_manifest(folder, manifest)


def convert_set_b(folder):
    source = os.path.join(DATA, "panels", "set-b")
    manifest = {"panel": "set-b", "emission": {"black": "emission/black.csv"}}
    for name in sorted(os.listdir(source)):
        kind, _, level = name[:-4].partition("_")
        target = f"emission/{name[:-4]}.csv"
        write_table(os.path.join(folder, target), ("theta", "phi", "X", "Y", "Z"),
                    matrix_rows(os.path.join(source, name)))
        if kind != "black":
            manifest["emission"].setdefault(kind, {})[level] = target
    return write_manifest(folder, manifest)


def matrix_rows(path):
    """Azimuth 0 at 12 o'clock, clockwise; decimal commas; --- is a hole."""
    with open(path, encoding="latin-1") as file:
        lines = [line.rstrip("\r\n") for line in file]
    values, part, phis = {}, None, []
    for line in lines:
        cells = line.split(";")
        if line in ("[X]", "[Y]", "[Z]"):
            part = "XYZ".index(line[1])
        elif line.startswith("Incl\\"):
            phis = [(90 - float(cell)) % 360 for cell in cells[1:]]
        elif part is not None and cells[0][:1].isdigit():
            for phi, cell in zip(phis, cells[1:]):
                if cell != "---":
                    key = (float(cells[0]), phi)
                    values.setdefault(key, [None] * 3)[part] = float(cell.replace(",", "."))
    return [(t, p, *xyz) for (t, p), xyz in sorted(values.items())]


def write_manifest(folder, manifest):
    path = os.path.join(folder, "MANIFEST.json")
    with open(path, "w") as out:
        json.dump(manifest, out)
    return path


def note(text):
    print(text, file=sys.stderr, flush=True)


def imported(program, name):
    """The set's manifest through `panel import`; by this script's own hand where it refuses."""
    folder = os.path.join(DATA, "panels", name)
    out = program.file(name, "MANIFEST.json")
    if os.path.exists(out):
        return out
    os.makedirs(program.file(name), exist_ok=True)
    files = [os.path.join(folder, f) for f in sorted(os.listdir(folder))
             if not f.startswith("truth")]
    try:
        program.run("panel", "import", *files, "-o", out)
        note(f"{name}: imported by the program")
    except Refused as error:
        note(f"{name}: converted by this script, for the program says: {str(error)[:160]}")
        convert = convert_set_a if name == "set-a" else convert_set_b
        out = convert(program.file(name))
    return out


# ---- the closed form of a synthetic panel (src/panel/set/synthetic_panel.h) ------------------

def fresnel(c, n):
    t = math.sqrt(1 - (1 - c * c) / (n * n))
    s, p = (c - n * t) / (c + n * t), (n * c - t) / (n * c + t)
    return 0.5 * (s * s + p * p)


class Truth:
    def __init__(self, text):
        self.r, self.n = text["reflection"], text["refractive_index"]

    def coated(self, c, nm):
        f, r = fresnel(c, self.n), self.r
        share = min(1, r["coating"] + r["coating_blue"] * ((nm - 550) / 150) ** 2)
        return f * (share + (1 - share) * f)

    def haze(self, incidence, theta, phi, nm):
        r, i, o = self.r, math.radians(incidence), math.radians(theta)
        w2, sp = r["haze_width"] ** 2, math.sin(math.radians(phi) / 2)
        si, so, ci, co = math.sin(i), math.sin(o), math.cos(i), math.cos(o)
        b2 = (so - si) ** 2 + 4 * so * si * sp * sp
        k = (r["haze_power"] - 1) / (math.pi * w2) * (1 + b2 / w2) ** -r["haze_power"]
        gloss = math.sqrt(self.coated(ci, nm) * self.coated(co, nm))
        under = (1 - fresnel(ci, self.n)) * (1 - fresnel(co, self.n))
        return r["haze_share"] * gloss * k + r["floor_albedo"] / math.pi * under
