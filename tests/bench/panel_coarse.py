# SPDX-License-Identifier: Apache-2.0
"""panel_coarse.py PARHELION [--cases all|some] [--share K/N] [--jobs N] -- does a panel's
verdict know what its grid saw?

For grids, lobes and mirrors of every width: simulate, fit, ask, and compare with the closed
form. A row of the table is WRONG, and the status 1, when anything asked is more than 5 % off
and the verdict is "good" all the same.
--share: of N shares of them the Kth.

The panel   haze (1 + b^2 / w^2)^-1.8, whose full width at half is the lobe's; it takes 3 % of
            the light at the normal at 550 nm, the mirror its own share besides; a lambertian
            part of 0.3 %; two thirds of both grow by a sixth towards 400 and 700 nm. No
            emission. The instrument's image is 1.2 degrees wide, its noise 0.1 %.
The error   of the BRDF, relative, the largest of directions 0 to 4 widths of the lobe and 1.1
            to 25 degrees from the mirror direction, all around it, at 20, 30, 35, 50 and 60
            degrees of incidence (35 is between measured ones), at 450 and 620 nm; of the
            mirror, relative to it or to 0.2 % if it is less, at the same incidences. None of
            the directions is a measured one but those at distance 0. The exact BRDF has no
            mirror in it; within the image's width that is what the instrument could not see.
"spec"      the same with the specular measurement that `panel simulate` writes.
"""
import concurrent.futures
import json
import math
import os
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import panels  # noqa: E402

GRIDS = ("12x24", "22x36", "44x90", "88x120", "88x360")
LOBES = (0.2, 0.5, 1, 2, 5, 10)
MIRRORS = (0, 0.002, 0.006, 0.02, 0.06)
INCIDENCES, ASKED = (20, 30, 40, 50, 60), (20, 30, 35, 50, 60)
WAVELENGTHS = (450, 620)
POWER, HAZE, FLOOR, LEAST = 1.8, 0.03, 0.003, 0.002
LIMIT = 0.05


# ---- the closed form -------------------------------------------------------------------------

def fresnel(cosine, index):
    s = math.sqrt(1 - (1 - cosine * cosine) / (index * index))
    rs = (cosine - index * s) / (cosine + index * s)
    rp = (index * cosine - s) / (index * cosine + s)
    return 0.5 * (rs * rs + rp * rp)


class Truth:
    def __init__(self, lobe_deg, mirror):
        self.width = math.radians(lobe_deg) / (2 * math.sqrt(2 ** (1 / POWER) - 1))
        self.share = HAZE / (HAZE + mirror)
        low, high = 1.01, 3.0
        for _ in range(60):
            self.index = 0.5 * (low + high)
            if self.coated(1, 550) < HAZE + mirror:
                low = self.index
            else:
                high = self.index

    def coated(self, cosine, nm):
        f, c = fresnel(cosine, self.index), 0.85 + 0.15 * ((nm - 550) / 150) ** 2
        return f * (c + (1 - c) * f)

    def mirror(self, theta, nm):
        return (1 - self.share) * self.coated(math.cos(theta), nm)

    def brdf(self, incidence, theta, phi, nm):
        si, so, sp = math.sin(incidence), math.sin(theta), math.sin(0.5 * phi)
        b2, w2 = (so - si) ** 2 + 4 * so * si * sp * sp, self.width ** 2
        k = (POWER - 1) / (math.pi * w2) * (1 + b2 / w2) ** -POWER
        ci, co = math.cos(incidence), math.cos(theta)
        under = (1 - fresnel(ci, self.index)) * (1 - fresnel(co, self.index))
        return (self.share * math.sqrt(self.coated(ci, nm) * self.coated(co, nm)) * k +
                FLOOR / math.pi * under)

    def recipe(self):
        spectrum = {"peaks_nm": [550], "fwhm_nm": [30], "weights": [1]}
        return {"panel": "coarse", "refractive_index": self.index,
                "emission": {"red": spectrum, "green": spectrum, "blue": spectrum,
                             "levels": [255]},
                "reflection": {"coating": 0.85, "coating_blue": 0.15,
                               "haze_share": self.share, "haze_width": self.width,
                               "haze_power": POWER, "floor_albedo": FLOOR,
                               "incidence_deg": list(INCIDENCES),
                               "wavelengths_nm": list(WAVELENGTHS)},
                "instrument": {"theta_max_deg": 88, "theta_step_deg": 1, "phi_step_deg": 3,
                               "fwhm_deg": 1.2, "noise_relative": 0.001,
                               "noise_brdf_sr": 2e-6, "seed": 1}}


# ---- one case --------------------------------------------------------------------------------

def around(incidence, distance, turn):
    """Theta and phi at a distance from the mirror direction, radians."""
    x, y, z = (math.sin(distance) * math.cos(turn), math.sin(distance) * math.sin(turn),
               math.cos(distance))
    c, s = math.cos(incidence), math.sin(incidence)
    x, z = c * x + s * z, c * z - s * x
    return math.acos(max(-1, min(1, z))), math.atan2(y, x)


def directions(incidence, lobe):
    near = [lobe * k for k in (0.25, 0.5, 0.75, 1, 1.5, 2, 3, 4)]
    yield incidence, 0.0
    for distance in near + [1.1, 2.3, 4.1, 6.3, 9.7, 14.3, 19, 25]:
        for k in range(6):
            theta, phi = around(incidence, math.radians(distance), 0.2 + k * math.pi / 3)
            if distance < 26 and math.degrees(theta) < 80:
                yield theta, phi


def errors(program, panel, truth, lobe):
    """Largest relative errors of the BRDF, with its place, and of the mirror."""
    rows, exact = [], []
    for incidence in ASKED:
        i = math.radians(incidence)
        for theta, phi in directions(i, lobe):
            for nm in WAVELENGTHS:
                rows.append((math.degrees(theta), math.degrees(phi), incidence, nm))
                exact.append((truth.brdf(i, theta, phi, nm), truth.mirror(i, nm)))
    names, answers = program.ask(panel, ("theta", "phi", "incidence", "wavelength"), rows,
                                 "--brdf")
    brdf, mirror = names.index("brdf"), names.index("mirror")
    worst = max((abs(a[brdf] / e[0] - 1), row[:3]) for a, e, row in zip(answers, exact, rows))
    off = max(abs(a[mirror] - e[1]) / max(e[1], LEAST) for a, e in zip(answers, exact))
    return worst[0], worst[1], off


def make_set(program, case, truth):
    grid, _, _, has_specular = case
    with open(program.file("recipe.json"), "w") as file:
        json.dump(truth.recipe(), file)
    program.run("panel", "simulate", program.file("recipe.json"), "--grid", grid, "-o",
                program.file("set"), "--quiet")
    path = program.file("set", "MANIFEST.json")
    with open(path) as file:
        manifest = json.load(file)
    for key in ("emission", "primaries"):
        del manifest[key]
    if not has_specular:
        manifest["reflection"].pop("specular", None)
    with open(path, "w") as file:
        json.dump(manifest, file)
    return path


def run_case(path, case):
    grid, lobe, mirror, has_specular = case
    truth = Truth(lobe, mirror)
    with tempfile.TemporaryDirectory() as folder:
        program = panels.Program(path, folder)
        panel = program.file("x.panel")
        report = json.loads(program.run("panel", "fit", make_set(program, case, truth), "-o",
                                        panel, "--json", "--quiet", "--force", "--threads", 1))
        brdf, place, off = errors(program, panel, truth, lobe)
        program.launcher.communicate()
    verdict = "coarse" if report.get("coarse") else report["verdict"]
    is_wrong = report["verdict"] == "good" and max(brdf, off) > LIMIT
    name = grid + (" spec" if has_specular else "")
    return (f"{name:>11} {lobe:5g} {100 * mirror:6.1f}% {100 * brdf:9.1f}% "
            f"{100 * off:9.1f}%  {verdict:<16} {'WRONG' if is_wrong else 'ok':<6}"
            f"worst at {place[0]:.1f},{place[1]:.1f} of {place[2]:g}", is_wrong, verdict)


def cases_of(kind):
    """All: every lobe with every mirror on every grid. Some: every lobe on every grid with
    three of the mirrors in turn, two on the fine grids, whose fits take a minute; with a
    specular measurement one."""
    told = [(g, l, m, True) for g in GRIDS[:3] for l in LOBES[2:] for m in MIRRORS[1:]]
    if kind == "all":
        return [(g, l, m, False) for g in GRIDS for l in LOBES for m in MIRRORS] + told
    some = []
    for k, grid in enumerate(GRIDS):
        some += [(grid, l, MIRRORS[(i + k + 2 * j) % 5], False)
                 for i, l in enumerate(LOBES) for j in range(3 if k < 3 else 2)]
    return some + told[::5]


def main():
    arguments = sys.argv[1:]
    jobs = int(panels.take_option(arguments, "--jobs", os.cpu_count()))
    kind = panels.take_option(arguments, "--cases", "all")
    share, shares = map(int, panels.take_option(arguments, "--share", "1/1").split("/"))
    cases = cases_of(kind)[share - 1::shares] if 1 <= share <= shares else []
    if not cases:
        sys.exit(f"panel_coarse: --share {share}/{shares} has no case")
    wrong, counts = 0, {}
    print(f"{'grid':>11} {'lobe':>5} {'mirror':>7} {'BRDF err':>10} {'mirror err':>10}  "
          "verdict")
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for row, is_wrong, verdict in pool.map(lambda c: run_case(arguments[0], c), cases):
            print(row, flush=True)
            wrong += is_wrong
            counts[verdict] = counts.get(verdict, 0) + 1
    print(", ".join(f"{count} {verdict}" for verdict, count in sorted(counts.items())))
    print(f"{len(cases) - wrong} passed, {wrong} failed")
    sys.exit(wrong > 0)


if __name__ == "__main__":
    main()
