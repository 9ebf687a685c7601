# SPDX-License-Identifier: Apache-2.0
"""panels.py -- panels for the tests of the library, of every kind that a file can hold: shipped
ones, and small ones that `panel simulate`, closed forms and `panel fit` make."""
import json
import math
import os
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SHIPPED = os.path.join(ROOT, "assets", "panels")
RECIPE = {
    "panel": "small", "refractive_index": 1.5,
    "emission": {
        "red": {"luminance_cd_m2": 100, "peaks_nm": [628, 610, 545], "fwhm_nm": [26, 60, 60],
                "weights": [1, 0.25, 0.02], "shift": [-0.1, -0.12, 0.1]},
        "green": {"luminance_cd_m2": 300, "peaks_nm": [538, 560, 450], "fwhm_nm": [44, 80, 30],
                  "weights": [1, 0.15, 0.015], "shift": [0.04, 0, 0.06]},
        "blue": {"luminance_cd_m2": 40, "peaks_nm": [449, 465, 540], "fwhm_nm": [20, 40, 60],
                 "weights": [1, 0.25, 0.03], "shift": [-0.05, 0.12, -0.25]},
        "black_cd_m2": 0.3, "leak": 2, "levels": [127, 255]},
    "reflection": {"coating": 0.5, "haze_share": 0.5, "haze_width": 0.15,
                   "floor_albedo": 0.003, "incidence_deg": [0, 20, 55],
                   "wavelengths_nm": [420, 520, 650]},
    "instrument": {"theta_step_deg": 6, "phi_step_deg": 15}}
PLACES = {"u": [0.1, 0.9, 0.4, 0.6], "v": [0.1, 0.2, 0.9, 0.4], "map": [24, 10], "tint": 0.1,
          "clouding": 0.5, "slope": [0.2, -0.1], "mura": 0.04, "mura_cycles": [4, 2],
          "haze_slope": 0.3}


def use_numpy():
    """The module wants numpy: another Python may have it where this one has not."""
    try:
        import numpy  # noqa: F401
    except ImportError:
        system = "/usr/bin/python3"
        if os.path.realpath(sys.executable) == os.path.realpath(system):
            raise
        os.execv(system, [system, *sys.argv])


def shipped(name):
    return os.path.join(SHIPPED, name + ".panel")


def run(*command):
    done = subprocess.run(command, capture_output=True, text=True, timeout=900)
    if done.returncode:
        raise RuntimeError(f"{' '.join(command)}: {done.stderr.strip()}")
    return done.stdout


def fitted(program, folder, name, recipe, *options):
    """The path of a panel that a recipe's set becomes."""
    source, out = os.path.join(folder, name + ".json"), os.path.join(folder, name)
    with open(source, "w") as file:
        json.dump(recipe, file)
    run(program, "panel", "simulate", source, "-o", out, "--noise", "off", "--quiet")
    return fit(program, out, *options)


def fit(program, folder, *options):
    run(program, "panel", "fit", os.path.join(folder, "MANIFEST.json"), "-o",
        folder + ".panel", "--quiet", "--force", *options)
    return folder + ".panel"


def placed(program, folder):
    return fitted(program, folder, "placed", {**RECIPE, "places": PLACES})


def haar(program, folder):
    return fitted(program, folder, "haar", RECIPE, "--basis", "haar", "--level", "4")


def brushed(program, folder, alphas=(0.3, 0.16)):
    """A surface with axes, lit from all sides: GGX facets of index 1.5 on a matt ground."""
    out = os.path.join(folder, "brushed")
    os.makedirs(out)
    incidences, azimuths, nm = [10, 35, 60], [0, 60, 120, 180, 240, 300], [450, 600]
    for incidence in incidences:
        for azimuth in azimuths:
            with open(os.path.join(out, f"i{incidence}a{azimuth}.csv"), "w") as file:
                file.write("theta,phi," + ",".join(map(str, nm)) + "\n")
                for theta in range(0, 85, 6):
                    for phi in range(0, 360 if theta else 1, 15):
                        f = brushed_brdf(incidence, azimuth, theta, phi, alphas)
                        file.write(f"{theta},{phi},{f:.7g},{1.1 * f:.7g}\n")
    with open(os.path.join(out, "MANIFEST.json"), "w") as file:
        json.dump({"panel": "brushed", "reflection": {
            "wavelengths_nm": nm, "incidence_deg": incidences, "incidence_phi_deg": azimuths,
            "files": "i{incidence}a{azimuth}.csv"}}, file)
    return fit(program, out)


def rings(program, folder):
    """Samples on rings about the mirror direction, which do not surround the hemisphere."""
    out = os.path.join(folder, "rings")
    os.makedirs(out)
    incidences = [10, 35, 60]
    for incidence in incidences:
        with open(os.path.join(out, f"i{incidence}.csv"), "w") as file:
            file.write("theta,phi,550\n")
            for theta, phi, angle in ring_directions(math.radians(incidence)):
                f = 0.004 + 0.05 * math.exp(-(angle / math.radians(20)) ** 2)
                file.write(f"{theta:.4f},{phi:.4f},{f:.7g}\n")
    with open(os.path.join(out, "MANIFEST.json"), "w") as file:
        json.dump({"panel": "rings", "reflection": {
            "wavelengths_nm": [550], "incidence_deg": incidences, "files":
            "i{incidence}.csv"}}, file)
    return fit(program, out)


def steps(program, folder):
    """Light that ends between rings, at another theta each azimuth: kept as its cells."""
    out = os.path.join(folder, "steps")
    os.makedirs(out)
    with open(os.path.join(out, "white.csv"), "w") as file:
        file.write("theta,phi,X,Y,Z\n")
        for theta in range(0, 71, 10):
            for phi in range(0, 360 if theta else 1, 45):
                y = 500 - theta if theta < 30 + phi // 12 else 2 + 0.01 * phi
                z = (1.1 + 0.002 * theta) * y
                file.write(f"{theta},{phi},{0.9 * y:.6g},{y:.6g},{z:.6g}\n")
    with open(os.path.join(out, "MANIFEST.json"), "w") as file:
        json.dump({"panel": "steps", "emission": {"white": "white.csv"}}, file)
    return fit(program, out)


def ring_directions(tilt):
    """theta and phi up to 80 degrees, degrees, and the angle to the mirror direction."""
    for ring in (0, 4, 8, 12, 20, 30, 40, 50, 60):
        for turn in range(0, 360 if ring else 1, 12):
            x, y, z = unit(ring, turn)
            x, z = (x * math.cos(tilt) + z * math.sin(tilt),
                    z * math.cos(tilt) - x * math.sin(tilt))
            theta = math.degrees(math.atan2(math.hypot(x, y), z))
            if theta < 80:
                yield theta, math.degrees(math.atan2(y, x)) % 360, math.radians(ring)


def brushed_brdf(incidence, azimuth, theta, phi, alphas):
    """phi counts from the mirror direction, as tables have it."""
    wi, wo = (unit(incidence, azimuth), unit(theta, phi + azimuth + 180))
    h = [a + b for a, b in zip(wi, wo)]
    x, y = h[0] / h[2] / alphas[0], h[1] / h[2] / alphas[1]
    size = math.sqrt(sum(a * a for a in h))
    d = 1 / (math.pi * alphas[0] * alphas[1] * (h[2] / size) ** 4 * (1 + x * x + y * y) ** 2)

    def masked(w):
        return math.sqrt(w[2] ** 2 + (alphas[0] * w[0]) ** 2 + (alphas[1] * w[1]) ** 2)
    cosine = sum(a * b for a, b in zip(wi, h)) / size
    g = math.sqrt(1.5 ** 2 - 1 + cosine * cosine)
    fresnel = 0.5 * ((g - cosine) / (g + cosine)) ** 2 * (
        1 + ((cosine * (g + cosine) - 1) / (cosine * (g - cosine) + 1)) ** 2)
    return 0.002 / math.pi + fresnel * d * 0.5 / (wo[2] * masked(wi) + wi[2] * masked(wo))


def unit(theta, phi):
    t, p = math.radians(theta), math.radians(phi)
    return math.sin(t) * math.cos(p), math.sin(t) * math.sin(p), math.cos(t)
