# SPDX-License-Identifier: Apache-2.0
"""panel_sizes.py PARHELION [--only PART[,PART...]] [--match TEXT] [--haar] [FIT OPTION...] --
sizes and errors of panels as a Markdown table.

emission    simulated panels without noise, 25 tables, at 88x360 and 45x72 directions
reflection  7 incidences x 16 wavelengths of haze, at 88x360 and 45x72 directions
single      one table alone: emission, reflection, and with a peak of half a degree
foreign     the two foreign sets (noisy)
real        every measured file at hand that `panel import` takes
full        28 emission tables and 6 incidences x 31 wavelengths of 88x360: time and memory

Source bytes: of the text, and of the measured values as float32 (angles not counted). Panel
bytes: of the file that is memory-mapped. Errors are relative to each measured value itself;
values of 0 are masked. Albedo: of the cosine-weighted integral. Processor and wall-clock time;
peak memory of the fit. --haar: the other basis with as many bytes beside each row, where a fit
takes less than HAAR_SECONDS. --match: only rows whose source's name holds the text.
"""
import math
import os
import sys
import tempfile

import panels
from panels import Errors, Refused

PARTS = ("emission", "reflection", "single", "foreign", "real", "full")
SIMULATED = ("ips_cluster", "oled_centre")
GRIDS = {"88x360": (88, 360), "45x72": (44, 72)}
HAZE_NM = list(range(400, 701, 20))
HAZE_INCIDENCES = list(range(5, 66, 10))

HAAR_SECONDS = 25 # of processor time: several fits are needed

HEADER = ("source", "basis", "text", "float32", "panel", "share", "limit", "ratio", "max error",
          "rms error", "albedo error", "fit s (cpu)", "peak MB")


def megabytes(count):
    return f"{count / 1e6:.2f}"


class Bench:
    def __init__(self, program, options, wants_haar):
        self.program, self.options, self.wants_haar = program, options, wants_haar
        self.less, self.match = 0, ""
        print("| " + " | ".join(HEADER) + " |\n|" + " --- |" * len(HEADER), flush=True)

    def row(self, name, basis, sizes, report, errors, limit):
        text, floats = sizes
        size = report["file_bytes"]
        total, albedo = errors
        cells = (name, basis, megabytes(text) + " MB", megabytes(floats) + " MB", str(size),
                 f"{100 * size / floats:.3f}%", f"{100 * limit:g}%" if limit else "",
                 f"{floats / size:.0f}", f"{100 * total.max:.2f}%",
                 f"{100 * total.rms():.3f}%", f"{100 * albedo:.3f}%",
                 f"{report['seconds']:.1f} ({report['processor_seconds']:.1f})",
                 f"{report['peak_bytes'] / 1e6:.0f}")
        print("| " + " | ".join(cells) + " |", flush=True)

    def errors(self, panel, tables, fwhm_deg):
        total, albedo = Errors(), 0.0
        for table in tables:
            one = panels.compare(self.program, panel, table, fwhm_deg)
            albedo = max(albedo, abs(one.integral()))
            total.merge(one)
        return total, albedo

    def measure(self, name, manifest, limit=0.0, fwhm_deg=0.0):
        """One row, and with --haar a second one."""
        if self.match not in name:
            return
        panel = self.program.file("sizes.panel")
        try:
            report = self.program.fit(manifest, panel, *self.options)
        except Refused as error:
            if "'emission' is missing" in str(error):
                self.measure_with_flat(name, manifest, limit, fwhm_deg)
                return
            print(f"| {name} | refused: {error} |" + " |" * (len(HEADER) - 2), flush=True)
            return
        tables = read_tables(manifest)
        tables = [t for t in tables if t.text_bytes and t.name != "white" or len(tables) == 1]
        sizes = (sum(t.text_bytes for t in tables), sum(t.float32_bytes() for t in tables))
        errors = self.errors(panel, tables, fwhm_deg)
        basis = report.get("basis", "?")
        report["file_bytes"] -= self.less
        self.row(name, basis, sizes, report, errors, limit)
        if os.environ.get("PLACES"):
            print(f"  worst: {errors[0].place}", file=sys.stderr)
        if (self.wants_haar and basis != "haar" and
                report["processor_seconds"] < HAAR_SECONDS):
            report = self.haar_of_size(manifest, report["file_bytes"], panel, report)
            if report:
                report["file_bytes"] -= self.less
                self.row(name, "haar", sizes, report, self.errors(panel, tables, fwhm_deg), 0)

    def measure_with_flat(self, name, manifest, limit, fwhm_deg):
        """For a program that wants an emission: a flat one, whose own file's bytes do not
        count."""
        with_flat = panels.reflection_only(manifest, flat=True)
        flat = self.program.fit(os.path.join(os.path.dirname(manifest), panels.FLAT),
                                self.program.file("flat.panel"), *self.options)
        self.less = flat["file_bytes"]
        self.measure(name, with_flat, limit, fwhm_deg)
        self.less = 0

    def haar_of_size(self, manifest, wanted, panel, like):
        """The largest share of coefficients found whose file is no larger than wanted bytes:
        regula falsi on bytes over share, with the level of the other basis."""
        options = ["--basis", "haar"]
        part = like.get("reflection") or like.get("emission")
        options += ["--level", max(2, min(9, int(part["level"])))]

        def fit(share):
            return self.program.fit(manifest, panel, *options, "--keep", f"{share:.6g}")

        low = high = None # (share, bytes, report)
        share = 0.003
        for _ in range(6):
            try:
                report = fit(share)
            except Refused:
                return None
            size = report["file_bytes"] - self.less
            if size <= wanted:
                low = (share, size, report)
                if size > 0.97 * wanted or share >= 1:
                    break
            else:
                high = (share, size, report)
            if low and high:
                t = (wanted - low[1]) / (high[1] - low[1])
                share = low[0] + min(0.95, max(0.05, t)) * (high[0] - low[0])
            else:
                share = min(1, max(1e-5, share * (4 if low else 0.25)))
                if high and high[0] <= 1e-5:
                    break
        best = low or high
        return best[2] if best[0] == share else fit(best[0])


def read_tables(manifest):
    if manifest.endswith(".csv"):
        table = panels.Table("table", manifest)
        table.rgb = (255.0,) * 3
        return [table]
    return panels.read_set(manifest)


# ---- sets ----------------------------------------------------------------------------------

def emission_recipe(name, grid):
    text = panels.with_grid(panels.without_noise(panels.recipe(name)), *GRIDS[grid])
    text.pop("reflection")
    return text


def haze_recipe(name, grid):
    """All of the gloss is haze: no mirror that the instrument would smear."""
    text = panels.with_grid(panels.without_noise(panels.recipe(name)), *GRIDS[grid])
    text["reflection"].update(haze_share=1, wavelengths_nm=HAZE_NM,
                              incidence_deg=HAZE_INCIDENCES)
    return text


def measure_emission(bench):
    limits = {"88x360": 0.0015, "45x72": 0.008}
    for grid, limit in limits.items():
        for name in SIMULATED:
            manifest = panels.simulate(bench.program, emission_recipe(name, grid), "emission")
            bench.measure(f"{name} emission, 25 tables {grid}", manifest, limit)


def measure_reflection(bench):
    limits = {"88x360": 0.004, "45x72": 0.015}
    for grid, limit in limits.items():
        for name in SIMULATED:
            manifest = panels.simulate(bench.program, haze_recipe(name, grid), "reflection")
            bench.measure(f"{name} haze, 7 x 16 {grid}", panels.reflection_only(manifest),
                          limit)
    text = haze_recipe("ips_cluster", "88x360")
    text["reflection"]["haze_share"] = panels.recipe("ips_cluster")["reflection"]["haze_share"]
    manifest = panels.simulate(bench.program, text, "reflection")
    bench.measure("ips_cluster haze and mirror, 7 x 16 88x360",
                  panels.reflection_only(manifest), 0, text["instrument"]["fwhm_deg"])


# ---- single tables -------------------------------------------------------------------------

def white_table(bench, name):
    """Red, green and blue at 255 with black once, as a table of its own."""
    folder = os.path.dirname(panels.simulate(bench.program, emission_recipe(name, "88x360"),
                                             "single"))
    parts = [panels.Table(p, os.path.join(folder, "emission", f"{p}_255.csv"))
             for p in panels.PRIMARIES]
    black = panels.Table("black", os.path.join(folder, "emission", "black.csv"))
    rows = [(k[0], k[1], *(f"{sum(part[2][j] for part in p) - 2 * k[2][j]:.6g}"
                           for j in range(3)))
            for k, *p in zip(black.rows, *(part.rows for part in parts))]
    path = os.path.join(folder, name + "_white.csv")
    panels.write_table(path, ("theta", "phi", "X", "Y", "Z"), rows)
    return path, os.path.join(folder, "emission", "red_255.csv")


def one_brdf(bench, name):
    text = haze_recipe(name, "88x360")
    text["reflection"].update(incidence_deg=[30], wavelengths_nm=[550])
    return panels.reflection_only(panels.simulate(bench.program, text, "one"))


PEAK_FWHM = 0.5 # degrees


def dense_range(low, high, step, dense):
    """low to high by a step, with (centre, half width, step) inside it."""
    centre, half, fine = dense
    values = {round(low + step * i, 6) for i in range(int((high - low) / step + 1.5))}
    values |= {round(centre - half + fine * i, 6) for i in range(int(2 * half / fine + 1.5))}
    return sorted(v for v in values if low <= v <= high)


def peak_brdf(bench):
    """A Gaussian peak of half a degree at the mirror direction of 30 degrees on haze."""
    truth = panels.Truth(haze_recipe("ips_cluster", "88x360"))
    folder = bench.program.file("peak")
    phis = sorted({p % 360 for p in dense_range(-180, 180, 2, (0, 6, 0.2)) if p < 180})
    rows = []
    for t in dense_range(0, 88, 1, (30, 4, 0.1)):
        for p in phis if t else [0]:
            value = (panels.mirror_image(PEAK_FWHM, 30, t, p) * 0.01 +
                     truth.haze(30, t, p, 550))
            rows.append((t, p, f"{value:.6g}"))
    panels.write_table(os.path.join(folder, "brdf", "i30.csv"), ("theta", "phi", "550"), rows)
    return panels.write_manifest(folder, {"panel": "peak", "reflection": {
        "wavelengths_nm": [550], "incidence_deg": [30], "files": "brdf/i{incidence}.csv"}})


def peak_emission(bench):
    """A narrow beam, half a degree wide at 30 degrees, on a broad lobe."""
    rows = []
    phis = sorted({p % 360 for p in dense_range(-180, 180, 2, (0, 6, 0.2)) if p < 180})
    for t in dense_range(0, 88, 1, (30, 4, 0.1)):
        for p in phis if t else [0]:
            d = panels.angle_between(t, p, 30, 0) / PEAK_FWHM
            y = 100 * math.cos(math.radians(t)) + 900 * math.exp(-4 * math.log(2) * d * d)
            rows.append((t, p, f"{0.95 * y:.6g}", f"{y:.6g}", f"{1.09 * y:.6g}"))
    path = bench.program.file("peak", "white.csv")
    panels.write_table(path, ("theta", "phi", "X", "Y", "Z"), rows)
    return path


def measure_single(bench):
    for name in SIMULATED:
        white, red = white_table(bench, name)
        bench.measure(f"{name} white 255 alone, 88x360", white, 0.005)
        bench.measure(f"{name} red 255 alone, 88x360", red, 0.005)
    for name in SIMULATED:
        bench.measure(f"{name} haze at 30 deg, 550 nm alone, 88x360", one_brdf(bench, name))
    bench.measure("peak of 0.5 deg on haze, reflection", peak_brdf(bench), 0.03)
    bench.measure("beam of 0.5 deg, emission", peak_emission(bench), 0.03)


# ---- files of others -------------------------------------------------------------------------

def measure_foreign(bench):
    for name in ("set-a", "set-b"):
        manifest = panels.imported(bench.program, name)
        bench.measure(f"{name} emission", panels.emission_only(manifest),
                      0.008 if name == "set-a" else 0)
        if name == "set-a":
            bench.measure("set-a BRDF", panels.reflection_only(manifest), 0.022)


REAL = ("display", "bsdf", "photometry")
TOLD = { # what files do not say themselves, by the ends of their names
    "viewing_angle_oled_phi0_90.csv": ["--role", "*=white"],
    ".bsdf": ["--wavelength", "650"],
    "MAXWELL_measured_IESNA.ies": ["--area-mm", "300,300"],
}


def import_one(bench, path):
    """The manifest, and what had to be said."""
    name = os.path.basename(path)
    told = next((words for end, words in TOLD.items() if name.endswith(end)), [])
    manifest = bench.program.file("real", name, "MANIFEST.json")
    os.makedirs(os.path.dirname(manifest), exist_ok=True)
    bench.program.run("panel", "import", path, "-o", manifest, *told)
    return manifest, " ".join(told)


def measure_real(bench):
    refused = []
    for folder in REAL:
        for place, _, names in sorted(os.walk(os.path.join(panels.DATA, folder))):
            for name in sorted(n for n in names if n not in ("README.md", "notes.txt")):
                path = os.path.join(place, name)
                if bench.match not in path:
                    continue
                try:
                    manifest, told = import_one(bench, path)
                except Refused as error:
                    refused.append(f"{os.path.relpath(path, panels.DATA)}: "
                                   f"{str(error).split(name)[-1].strip(': ')[:150]}")
                    continue
                bench.measure(f"{os.path.relpath(path, panels.DATA)} {told}".strip(), manifest)
    print("\nnot imported:\n" + "\n".join("- " + line for line in refused))


def measure_full(bench):
    """The whole set of the acceptance: 1 + 9 x 3 tables and 6 x 31, 88x360 each."""
    text = panels.with_grid(panels.without_noise(panels.recipe("ips_cluster")), 88, 360)
    text["emission"]["levels"] = [15, 31, 63, 95, 127, 159, 191, 223, 255]
    text["reflection"].update(wavelengths_nm=list(range(400, 701, 10)),
                              incidence_deg=[10, 20, 30, 40, 50, 60])
    manifest = panels.simulate(bench.program, text, "full")
    bench.measure("ips_cluster full set: 28 tables, 6 x 31, 88x360", manifest, 0,
                  text["instrument"]["fwhm_deg"])


def main():
    arguments = sys.argv[1:]
    only = panels.take_option(arguments, "--only", ",".join(PARTS)).split(",")
    match = panels.take_option(arguments, "--match", "")
    wants_haar = "--haar" in arguments
    arguments = [a for a in arguments if a != "--haar"]
    if not arguments or set(only) - set(PARTS):
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory(prefix="panels_") as folder:
        bench = Bench(panels.Program(arguments[0], folder), arguments[1:], wants_haar)
        bench.match = match
        for part in only:
            if part in ("foreign", "real") and not os.path.isdir(panels.DATA):
                print(f"skipped: {part}: no folder {panels.DATA}")
                continue
            globals()["measure_" + part](bench)


if __name__ == "__main__":
    main()
