# SPDX-License-Identifier: Apache-2.0
"""viewing_cone.py PANEL [-o OUT.png|OUT.svg] [--code R,G,B] -- draws how a display shines into
its viewing cone: every direction of the hemisphere is a place of a disc, the normal in the
middle, the horizon around it, right to the right and up on top as someone facing it sees them.
Colours are luminance relative to the largest; lines stand every 10 % and at a half.

An example of parhelion_panel.py. A PNG needs Pillow, an SVG nothing but numpy.
"""
import argparse
import sys

import numpy

import parhelion_panel

SIDE, SHADES = 360, 80           # of the disc, pixels; of its colours
SVG = "http:" + "//www.w3.org/2000/svg"
STOPS = numpy.array([[13, 8, 66], [84, 19, 126], [176, 50, 95], [236, 111, 40], [252, 210, 74],
                     [255, 255, 230]], float)  # dark to bright


def disc(side):
    """Directions of a disc's pixels, [side, side, 3]; outside of it z is 0."""
    at = (numpy.arange(side) + 0.5) / side * 2 - 1
    x, y = numpy.meshgrid(at, -at)
    radius = numpy.hypot(x, y)
    theta = numpy.minimum(radius, 1) * numpy.pi / 2
    with numpy.errstate(invalid="ignore", divide="ignore"):
        scale = numpy.where(radius > 0, numpy.sin(theta) / radius, 1)
    z = numpy.where(radius < 1, numpy.cos(theta), 0)
    return numpy.stack([scale * x, scale * y, z], -1)


def colours(share):
    """RGB of shares 0 to 1, between the stops."""
    at = numpy.clip(share, 0, 1) * (len(STOPS) - 1)
    return numpy.stack([numpy.interp(at, range(len(STOPS)), STOPS[:, k]) for k in range(3)], -1)


def picture(panel, code, side):
    """8-bit pixels, and the largest luminance."""
    directions = disc(side)
    xyz, is_measured = panel.emission_xyz(directions, code, measured=True)
    largest = max(float(xyz[..., 1].max()), float(panel.emission_xyz([0, 0, 1], code)[1]))
    share = xyz[..., 1] / largest if largest > 0 else 0 * xyz[..., 1]
    rgb = colours(numpy.round(share * SHADES) / SHADES)
    for level, shade in [(k / 10, 0.8) for k in range(1, 10)] + [(0.5, 0.0)]:
        above = share > level
        edge = numpy.zeros_like(above)
        edge[1:] |= above[1:] != above[:-1]
        edge[:, 1:] |= above[:, 1:] != above[:, :-1]
        rgb[edge & (directions[..., 2] > 0)] *= shade
    rgb[~is_measured] = 0.5 * rgb[~is_measured] + 60  # extrapolated: paler
    rgb[directions[..., 2] <= 0] = 255
    return numpy.round(rgb).astype(numpy.uint8), largest


def svg(pixels, words):
    """Runs of equal colour as rectangles."""
    side = len(pixels)
    lines = [f'<svg xmlns="{SVG}" width="{side}" height="{side + 24}" '
             'shape-rendering="crispEdges">',
             f'<rect width="{side}" height="{side + 24}" fill="white"/>']
    for y, row in enumerate(pixels):
        ends = numpy.flatnonzero((row[1:] != row[:-1]).any(-1)) + 1
        for first, last in zip([0, *ends], [*ends, side]):
            if row[first].min() < 255:
                lines.append(f'<rect x="{first}" y="{y}" width="{last - first}" height="1" '
                             'fill="#{:02x}{:02x}{:02x}"/>'.format(*row[first]))
    lines.append(f'<text x="4" y="{side + 17}" font-size="13" font-family="sans-serif">{words}'
                 '</text></svg>')
    return "\n".join(lines)


def write(path, pixels, words):
    if path.endswith(".svg"):
        with open(path, "w", encoding="utf-8") as file:
            file.write(svg(pixels, words))
        return
    try:
        from PIL import Image, ImageDraw
    except ImportError:
        sys.exit("a PNG needs Pillow (python3-pil); an SVG does not: -o cone.svg")
    out = Image.new("RGB", (len(pixels), len(pixels) + 24), "white")
    out.paste(Image.fromarray(pixels), (0, 0))
    ImageDraw.Draw(out).text((4, len(pixels) + 6), words, fill="black")
    out.save(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("panel")
    parser.add_argument("-o", "--output", default="viewing_cone.png")
    parser.add_argument("--code", default="255,255,255", help="red, green, blue: 0 to 255")
    arguments = parser.parse_args()
    code = [float(word) for word in arguments.code.split(",")]
    try:
        with parhelion_panel.Panel(arguments.panel) as panel:
            pixels, largest = picture(panel, code, SIDE)
            normal = float(panel.emission_xyz([0, 0, 1], code)[1])
    except parhelion_panel.PanelError as fault:
        sys.exit(str(fault))
    words = f"largest {largest:.4g} cd/m2, along the normal {normal:.4g} cd/m2"
    write(arguments.output, pixels, words)
    print(f"{arguments.output}: {words}")


if __name__ == "__main__":
    main()
