# SPDX-License-Identifier: Apache-2.0
"""contact_sheet.py PARHELION SCENE.gltf OUT.png [RENDER OPTION...] -- a day's light on a page.

Renders a scene under the clear sky from dawn to dusk (21 June, 48.14 N 11.58 E, heading 90
unless the options say otherwise) and puts the small pictures side by side with time and sun.
Needs Debian's python3-cairo. Used to look at what changes with the light; nothing is tested.
"""
import json
import math
import os
import subprocess
import sys
import tempfile

import cairo

HOURS = ("04:55", "05:15", "06:30", "08:30", "13:00", "17:00", "19:30", "20:55", "21:30")
SIZE, COLUMNS, GAP, LABEL = (384, 216), 3, 12, 22


def picture(program, scene, when, options, path):
    """Renders one moment; returns what to write under it."""
    sky = ["--environment", "sky:clear", "--when", when]
    if "--where" not in options:
        sky += ["--where", "48.14,11.58,520"]
    if "--heading" not in options:
        sky += ["--heading", "90"]
    subprocess.run([program, "render", scene, *sky, *options, "--size", f"{SIZE[0]}x{SIZE[1]}",
                    "-o", path + ".exr", "--png", path, "--quiet"], check=True,
                   stdout=subprocess.DEVNULL)
    place = options[options.index("--where") + 1] if "--where" in options else "48.14,11.58,520"
    answer = subprocess.run([program, "sky", "--environment", "sky:clear", "--when", when,
                             "--where", place, "--json"], check=True, capture_output=True,
                            text=True).stdout
    figures = json.loads(answer)
    return (f"{when[11:16]}  sun {figures['sun']['elevation_deg']:.1f}°  "
            f"{figures['direct_normal_lx']:,.0f} lx direct, "
            f"{figures['diffuse_horizontal_lx']:,.0f} lx diffuse")


def main():
    program, scene, out, *options = sys.argv[1:]
    rows = math.ceil(len(HOURS) / COLUMNS)
    page = cairo.ImageSurface(cairo.FORMAT_RGB24, COLUMNS * (SIZE[0] + GAP) + GAP,
                              rows * (SIZE[1] + GAP + LABEL) + GAP)
    ctx = cairo.Context(page)
    ctx.set_source_rgb(0.97, 0.97, 0.96)
    ctx.paint()
    ctx.select_font_face("DejaVu Sans")
    ctx.set_font_size(12)
    with tempfile.TemporaryDirectory() as folder:
        for i, hour in enumerate(HOURS):
            path = os.path.join(folder, f"{i}.png")
            text = picture(program, scene, f"2026-06-21T{hour}+02:00", options, path)
            x = GAP + i % COLUMNS * (SIZE[0] + GAP)
            y = GAP + i // COLUMNS * (SIZE[1] + GAP + LABEL)
            ctx.set_source_surface(cairo.ImageSurface.create_from_png(path), x, y)
            ctx.paint()
            ctx.set_source_rgb(0.1, 0.1, 0.12)
            ctx.move_to(x, y + SIZE[1] + 16)
            ctx.show_text(text)
            print(text, flush=True)
    page.write_to_png(out)


if __name__ == "__main__":
    main()
