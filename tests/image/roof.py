# SPDX-License-Identifier: Apache-2.0
"""roof.py PARHELION [--all] -- daylight through an opening in the roof, for all 15 CIE skies.

CIE 171:2006, case 5.9: a black room 4 x 4 x 3 m with an opening of 1 x 1 or 4 x 4 m in the
middle of its roof, the sun 60 degrees high, its sky without its disc. What arrives at points of
the wall that faces the sun and of the floor is an integral of the sky over the opening, done
here by quadrature; the path tracer's luxmeter must agree within three standard deviations.
"""
import json
import math
import os
import subprocess
import sys
import tempfile

from gltf import Scene

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

# a, b, c, d, e of ISO 15469:2004, types 1 to 15
TYPES = [
    (4, -0.7, 0, -1, 0), (4, -0.7, 2, -1.5, 0.15), (1.1, -0.8, 0, -1, 0),
    (1.1, -0.8, 2, -1.5, 0.15), (0, -1, 0, -1, 0), (0, -1, 2, -1.5, 0.15),
    (0, -1, 5, -2.5, 0.3), (0, -1, 10, -3, 0.45), (-1, -0.55, 2, -1.5, 0.15),
    (-1, -0.55, 5, -2.5, 0.3), (-1, -0.55, 10, -3, 0.45), (-1, -0.32, 10, -3, 0.45),
    (-1, -0.32, 16, -3, 0.3), (-1, -0.15, 16, -3, 0.3), (-1, -0.15, 24, -2.8, 0.15)]
SUN = (0, math.sin(math.radians(60)), math.cos(math.radians(60)))  # in the south, +Z
LUX = 10000.0
HEIGHT, HALF = 3.0, 2.0
WALL = [((0, 2.75 - 0.5 * i, -HALF), (0, 0, 1)) for i in range(6)]   # A to F
FLOOR = [((0, 0, -1.75 + 0.5 * i), (0, 1, 0)) for i in range(8)]     # G to N
NAMES = "ABCDEFGHIJKLMN"


def relative(kind, up, cos_gamma):
    a, b, c, d, e = TYPES[kind - 1]
    gamma = math.acos(max(-1, min(1, cos_gamma)))
    return ((1 + a * math.exp(b / up))
            * (1 + c * (math.exp(d * gamma) - math.exp(d * math.pi / 2)) + e * cos_gamma ** 2))


def horizontal(kind, steps=300):
    """The sky's integral over the hemisphere with the cosine, of the relative luminance."""
    total = 0
    for i in range(steps):
        theta = (i + 0.5) * math.pi / 2 / steps
        ring = 0
        for j in range(steps):
            phi = (j + 0.5) * math.pi / steps
            cosine = (math.cos(theta) * SUN[1]
                      + math.sin(theta) * SUN[2] * math.cos(phi))
            ring += relative(kind, math.cos(theta), cosine)
        total += ring * math.cos(theta) * math.sin(theta)
    return total * math.pi / 2 / steps * 2 * math.pi / steps


def graded(low, high, steps, near):
    """Midpoints and widths of intervals that shrink towards `near`."""
    edges = [low + (high - low) * i / steps for i in range(steps + 1)]
    if low <= near <= high:
        left = [near - (near - low) * (1 - i / steps) ** 3 for i in range(steps + 1)]
        right = [near + (high - near) * (i / steps) ** 3 for i in range(steps + 1)]
        edges = left + right[1:]
    return [((a + b) / 2, b - a) for a, b in zip(edges, edges[1:]) if b > a]


def through_opening(kind, half, point, normal, steps):
    total = 0
    for z, dz in graded(-half, half, steps, max(-half, min(half, point[2]))):
        for x, dx in graded(-half, half, steps, point[0]):
            way = (x - point[0], HEIGHT - point[1], z - point[2])
            d2 = sum(w * w for w in way)
            d = math.sqrt(d2)
            facing = sum(w * n for w, n in zip(way, normal)) / d
            if facing <= 0:
                continue
            up = way[1] / d
            cosine = (way[1] * SUN[1] + way[2] * SUN[2]) / d
            total += relative(kind, up, cosine) * facing * up / d2 * dx * dz
    return total


def room(path, kind, half):
    """The black room under its sky; a roof of four pieces leaves the opening."""
    scene = Scene()
    black = scene.material("black", pbrMetallicRoughness={
        "baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0, "roughnessFactor": 1},
        extensions={"KHR_materials_specular": {"specularFactor": 0}}, doubleSided=True)
    h, top = HALF, HEIGHT
    scene.quad(black, [-h, 0, -h], [0, 0, 2 * h], [2 * h, 0, 0])
    for corner, side in (([-h, 0, -h], [2 * h, 0, 0]), ([-h, 0, h], [2 * h, 0, 0]),
                         ([-h, 0, -h], [0, 0, 2 * h]), ([h, 0, -h], [0, 0, 2 * h])):
        scene.quad(black, corner, side, [0, top, 0])
    if half < h:
        for x0, z0, x1, z1 in ((-h, -h, h, -half), (-h, half, h, h), (-h, -half, -half, half),
                               (half, -half, h, half)):
            scene.quad(black, [x0, top, z0], [x1 - x0, 0, 0], [0, 0, z1 - z0])
    scene.environment(type="cie", sky=kind, diffuse_horizontal_lx=LUX,
                      sun={"azimuth_deg": 180, "elevation_deg": 60, "illuminance_lx": 0})
    scene.write(path)


def measured(program, path, point, normal, samples):
    place = [p + 1e-5 * n for p, n in zip(point, normal)]
    text = subprocess.run(
        [program, "measure", path, "--illuminance", ",".join(map(str, place + list(normal))),
         "--samples", str(samples), "--json", "--quiet"],
        check=True, capture_output=True, text=True).stdout
    answer = json.loads(text)
    low, high = answer["illuminance_interval"]
    return answer["illuminance_lx"], (high - low) / (2 * 1.96)


def main():
    program, everything = sys.argv[1], "--all" in sys.argv
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        for kind in range(1, 16):
            whole = horizontal(kind)
            for half in (2.0, 0.5):
                path = os.path.join(folder, "room.gltf")
                room(path, kind, half)
                places = list(zip(NAMES, WALL + FLOOR))
                if not everything:
                    places = [p for p in places if p[0] in ("BH" if half > 1 else "J")]
                for name, (point, normal) in places:
                    steps = 80 if everything else 60
                    wanted = 100 * through_opening(kind, half, point, normal, steps) / whole
                    lux, sigma = measured(program, path, point, normal,
                                          262144 if everything else 32768)
                    found, sigma = 100 * lux / LUX, 100 * sigma / LUX
                    report.claim(
                        abs(found - wanted) <= 3 * sigma + 5e-4 * wanted,
                        f"type {kind}, opening {2 * half:g} m, point {name}: {found:.3f} % for "
                        f"{wanted:.3f} % (sigma {sigma:.3f})")
    report.finish()


if __name__ == "__main__":
    main()
