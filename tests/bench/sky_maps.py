# SPDX-License-Identifier: Apache-2.0
"""sky_maps.py PARHELION [PICTURE.png] -- the scattering atmosphere beside fitted clear skies.

Luminance over the dome for suns 15 to 60 degrees high: the own atmosphere, CIE type 12 and
Perez with the same illuminance or irradiances. Prints, for elevations above 5 degrees and more
than 10 degrees from the sun, the rms and the mean of the difference relative to the fitted sky;
the picture shows the maps side by side (plan, north on top, log scale from 500 to 50,000
cd/m2).
"""
import json
import math
import os
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "image"))
from exr import Frame  # noqa: E402

SIDE = 192
SUNS = (15, 30, 45, 60)


def run(*words):
    return subprocess.run(words, check=True, capture_output=True, text=True).stdout


def sky(program, folder, environment, sun):
    """Luminances of a fisheye picture, SIDE x SIDE, and the command's figures."""
    path = os.path.join(folder, "sky.exr")
    text = run(program, "sky", "--environment", environment, "--sun", f"180,{sun}",
               "--projection", "fisheye", "--size", f"{SIDE}x{SIDE}", "-o", path, "--json")
    frame = Frame(path)
    weights = (("R", 0.2126), ("G", 0.7152), ("B", 0.0722))
    return [sum(frame.channels[c][i] * w for c, w in weights) for i in range(SIDE * SIDE)], \
        json.loads(text)


def direction(i, j):
    x, y = 2 * (i + 0.5) / SIDE - 1, 1 - 2 * (j + 0.5) / SIDE
    r = math.hypot(x, y)
    theta = r * math.pi / 2
    if r > 1:
        return None
    return math.sin(theta) * x / r, math.sin(theta) * y / r, math.cos(theta)


def compare(own, other, sun):
    """rms and mean of own / other - 1, by solid angle, away from horizon and sun."""
    sines, total, square, mean = math.sin(math.radians(sun)), 0, 0, 0
    towards = (0, -math.cos(math.radians(sun)), sines)
    for j in range(SIDE):
        for i in range(SIDE):
            d = direction(i, j)
            if not d or d[2] < math.sin(math.radians(5)):
                continue
            if sum(a * b for a, b in zip(d, towards)) > math.cos(math.radians(10)):
                continue
            theta = math.acos(d[2])
            weight = math.sin(theta) / max(theta, 1e-6)
            ratio = own[j * SIDE + i] / other[j * SIDE + i] - 1
            total += weight
            square += weight * ratio * ratio
            mean += weight * ratio
    return math.sqrt(square / total), mean / total


def colour(value):
    """Dark blue over green to yellow, for 500 to 50,000 cd/m2."""
    t = min(1, max(0, math.log(max(value, 1e-9) / 500) / math.log(100)))
    stops = ((0.27, 0.00, 0.33), (0.23, 0.32, 0.55), (0.13, 0.57, 0.55), (0.37, 0.79, 0.38),
             (0.99, 0.91, 0.15))
    k = min(3, int(t * 4))
    return [a + (b - a) * (4 * t - k) for a, b in zip(stops[k], stops[k + 1])]


def draw(path, rows):
    import cairo
    gap, label = 16, 28
    width = 3 * (SIDE + gap) + gap
    height = len(rows) * (SIDE + gap + label) + gap
    page = cairo.ImageSurface(cairo.FORMAT_RGB24, width, height)
    ctx = cairo.Context(page)
    ctx.set_source_rgb(1, 1, 1)
    ctx.paint()
    ctx.select_font_face("DejaVu Sans")
    ctx.set_font_size(11)
    for row, (sun, skies) in enumerate(rows):
        top = gap + row * (SIDE + gap + label)
        for column, (name, values) in enumerate(skies):
            left = gap + column * (SIDE + gap)
            ctx.set_source_rgb(0.1, 0.1, 0.12)
            ctx.move_to(left, top + 12)
            ctx.show_text(f"{name}, sun {sun}°")
            for j in range(SIDE):
                for i in range(SIDE):
                    if direction(i, j):
                        ctx.set_source_rgb(*colour(values[j * SIDE + i]))
                        ctx.rectangle(left + i, top + label - 8 + j, 1, 1)
                        ctx.fill()
    page.write_to_png(path)


def main():
    program, rows = sys.argv[1], []
    print("| sun, deg | sky | rms difference | mean difference |\n| --: | --- | --: | --: |")
    with tempfile.TemporaryDirectory() as folder:
        for sun in SUNS:
            own, figures = sky(program, folder, "sky:clear", sun)
            lux = figures["diffuse_horizontal_lx"]
            cie, _ = sky(program, folder, f"cie:12:{lux:.6g}", sun)
            perez, _ = sky(program, folder, f"perez:{figures['direct_normal_w_m2']:.6g},"
                           f"{figures['diffuse_horizontal_w_m2']:.6g}", sun)
            for name, other in (("CIE 12", cie), ("Perez", perez)):
                rms, mean = compare(own, other, sun)
                print(f"| {sun} | {name} | {100 * rms:.1f} % | {100 * mean:+.1f} % |",
                      flush=True)
            rows.append((sun, (("atmosphere", own), ("CIE 12", cie), ("Perez", perez))))
    if len(sys.argv) > 2:
        draw(sys.argv[2], rows)


if __name__ == "__main__":
    main()
