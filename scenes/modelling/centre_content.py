# SPDX-License-Identifier: Apache-2.0
"""The picture of the centre display, 2560x1440 pixels: a map with guidance, media, climate."""
import math
import random

import cairo

from pens import (
    AMBER, BLUE, DIM, GREEN, GREY, RED, WHITE, glow_disc, note_word, polygon, ring, rounded,
    save, text, turn_arrow,
)

LAND = (0.118, 0.137, 0.165)
BLOCK = (0.150, 0.172, 0.204)
WATER = (0.086, 0.220, 0.345)
PARK = (0.106, 0.240, 0.180)
STREET = (0.300, 0.340, 0.395)
ARTERY = (0.520, 0.545, 0.580)
MOTORWAY = (0.820, 0.600, 0.260)
PANEL = (0.055, 0.064, 0.080)


def curve(ctx, points, width, color):
    """A smooth line through `points` (Catmull-Rom turned into Bezier pieces)."""
    ctx.set_line_width(width)
    ctx.set_line_cap(cairo.LINE_CAP_ROUND)
    ctx.set_line_join(cairo.LINE_JOIN_ROUND)
    ctx.new_path()
    ctx.move_to(*points[0])
    padded = [points[0]] + list(points) + [points[-1]]
    for a, b, c, d in zip(padded, padded[1:], padded[2:], padded[3:]):
        ctx.curve_to(
            b[0] + (c[0] - a[0]) / 6,
            b[1] + (c[1] - a[1]) / 6,
            c[0] - (d[0] - b[0]) / 6,
            c[1] - (d[1] - b[1]) / 6,
            c[0],
            c[1],
        )
    ctx.set_source_rgb(*color)
    ctx.stroke()


def draw_blocks(ctx):
    """Building footprints in a turned grid, with a few left out; the same on every run."""
    rng = random.Random(7)
    ctx.save()
    ctx.translate(960, 540)
    ctx.rotate(math.radians(-14))
    for i in range(-13, 14):
        for j in range(-11, 12):
            if rng.random() < 0.18:
                continue
            x, y = 96 * i + 12, 82 * j + 12
            rounded(ctx, x, y, 72 - rng.random() * 18, 58 - rng.random() * 16, 5)
            ctx.set_source_rgb(*BLOCK)
            ctx.fill()
    for i in range(-13, 14):
        major = i % 4 == 0
        ctx.set_line_width(19 if major else 9)
        ctx.set_source_rgb(*(ARTERY if major else STREET))
        ctx.move_to(96 * i, -1100)
        ctx.line_to(96 * i, 1100)
        ctx.stroke()
    for j in range(-11, 12):
        major = j % 4 == 0
        ctx.set_line_width(19 if major else 9)
        ctx.set_source_rgb(*(ARTERY if major else STREET))
        ctx.move_to(-1400, 82 * j)
        ctx.line_to(1400, 82 * j)
        ctx.stroke()
    ctx.restore()


def grid(i, j):
    """Pixel of the crossing (i, j) of the turned street grid."""
    c, s = math.cos(math.radians(-14)), math.sin(math.radians(-14))
    x, y = 96 * i, 82 * j
    return 960 + c * x - s * y, 540 + s * x + c * y


def draw_nature(ctx):
    polygon(
        ctx,
        [grid(0.3, -5.7), grid(3.7, -5.7), grid(3.7, -4.3), grid(3.7, -0.3), grid(0.3, -0.3)],
        PARK,
    )
    polygon(ctx, [grid(-7.7, 4.3), grid(-4.3, 4.3), grid(-4.3, 7.7), grid(-7.7, 7.7)], PARK)
    curve(
        ctx,
        [grid(1.0, -1.0), grid(1.6, -2.6), grid(2.8, -3.0), grid(3.2, -5.0)],
        6,
        (0.2, 0.36, 0.27),
    )
    curve(ctx, [(1960, 760), (1620, 650), (1440, 800), (1180, 900), (1010, 1130)], 128, WATER)
    curve(ctx, [grid(1.5, -4.6), grid(2.0, -4.2), grid(2.4, -4.5)], 60, WATER)


def draw_bridges_and_motorway(ctx):
    for i in (4, 8):
        ctx.set_line_width(19)
        ctx.set_line_cap(cairo.LINE_CAP_BUTT)
        ctx.set_source_rgb(*ARTERY)
        ctx.move_to(*grid(i, 0.5))
        ctx.line_to(*grid(i, 7))
        ctx.stroke()
    way = [(-40, 300), (300, 220), (640, 250), (1000, 130), (1400, 90), (1960, -60)]
    curve(ctx, way, 34, (0.10, 0.11, 0.13))
    curve(ctx, way, 26, MOTORWAY)
    curve(ctx, way, 3, (0.45, 0.33, 0.14))


def route_path(ctx):
    ctx.new_path()
    for node in ((0, 3.0), (0, 0), (4, 0), (4, -5.6), (8, -5.6)):
        ctx.line_to(*grid(*node))


def draw_route(ctx):
    ctx.set_line_join(cairo.LINE_JOIN_ROUND)
    ctx.set_line_cap(cairo.LINE_CAP_ROUND)
    for width, color in ((30, (0.03, 0.20, 0.48)), (20, (0.16, 0.56, 1.0))):
        route_path(ctx)
        ctx.set_line_width(width)
        ctx.set_source_rgb(*color)
        ctx.stroke()


def draw_position(ctx):
    x, y = grid(0, 3.0)
    glow_disc(ctx, (x, y), 120, BLUE, 0.45)
    ctx.save()
    ctx.translate(x, y)
    ctx.rotate(math.radians(-14))
    polygon(ctx, [(0, -52), (38, 40), (0, 20), (-38, 40)], WHITE)
    polygon(ctx, [(0, -36), (26, 29), (0, 13), (-26, 29)], (0.10, 0.48, 0.98))
    ctx.restore()


def street_label(ctx, i, j, string, along_x, size=27):
    ctx.save()
    ctx.translate(*grid(i, j))
    ctx.rotate(math.radians(-14 if along_x else -104))
    ctx.select_font_face("Inter Medium", cairo.FONT_SLANT_NORMAL, cairo.FONT_WEIGHT_NORMAL)
    ctx.set_font_size(size)
    ctx.move_to(-ctx.text_extents(string).x_advance / 2, size * 0.34)
    note_word(ctx, string, -ctx.text_extents(string).x_advance / 2, size * 0.34)
    ctx.text_path(string)
    ctx.set_source_rgb(0.07, 0.08, 0.10)
    ctx.set_line_width(8)
    ctx.set_line_join(cairo.LINE_JOIN_ROUND)
    ctx.stroke_preserve()
    ctx.set_source_rgb(0.88, 0.91, 0.95)
    ctx.fill()
    ctx.restore()


def draw_labels(ctx):
    street_label(ctx, 2.0, 0, "Lindenallee", True)
    street_label(ctx, -2.5, -4, "Museumstraße", True)
    street_label(ctx, 0, -2.4, "Uferweg", False)
    street_label(ctx, -4, -1.9, "Am Markt", False)
    street_label(ctx, 7.2, 4, "Hafenstraße", True)
    street_label(ctx, 8, 1.2, "Nordring", False)
    text(ctx, "Stadtpark", *grid(2.0, -1.9), 33, (0.52, 0.80, 0.62), "Inter Medium")
    text(ctx, "Fluss", 1180, 905, 33, (0.50, 0.72, 0.92), "Inter Medium")
    rounded(ctx, 560, 214, 74, 42, 8)
    ctx.set_source_rgb(0.10, 0.32, 0.75)
    ctx.fill()
    text(ctx, "A 9", 597, 246, 29, WHITE, "Inter Semi Bold")


def pin(ctx, x, y, color, letter):
    ctx.new_path()
    ctx.arc(x, y - 44, 26, math.radians(150), math.radians(390))
    ctx.line_to(x, y)
    ctx.close_path()
    ctx.set_source_rgb(*color)
    ctx.fill()
    text(ctx, letter, x, y - 34, 28, WHITE, "Inter Semi Bold")


def card(ctx, x, y, width, height, alpha=0.94):
    rounded(ctx, x, y, width, height, 26)
    ctx.set_source_rgba(*PANEL, alpha)
    ctx.fill_preserve()
    ctx.set_line_width(2)
    ctx.set_source_rgba(1, 1, 1, 0.10)
    ctx.stroke()


def draw_search(ctx):
    card(ctx, 150, 92, 560, 84)
    ring(ctx, (200, 130), 15, 5, (0, 360), GREY)
    ctx.move_to(211, 141)
    ctx.line_to(224, 154)
    ctx.set_line_width(6)
    ctx.set_source_rgb(*GREY)
    ctx.stroke()
    text(ctx, "Search for a place", 250, 146, 34, GREY, align="left")


def draw_guidance(ctx):
    card(ctx, 150, 640, 470, 284)
    turn_arrow(ctx, 206, 760, 100, WHITE)
    text(ctx, "350 m", 330, 726, 60, WHITE, "Inter Semi Bold", align="left")
    text(ctx, "Lindenallee", 330, 770, 34, GREY, align="left")
    ctx.rectangle(182, 806, 406, 2)
    ctx.set_source_rgba(1, 1, 1, 0.14)
    ctx.fill()
    for x, value, unit in ((240, "11:08", "arrival"), (382, "26", "min"), (518, "19.4", "km")):
        text(ctx, value, x, 860, 42, WHITE, "Inter Semi Bold")
        text(ctx, unit, x, 896, 26, GREY)


def draw_media(ctx):
    card(ctx, 1370, 92, 500, 210)
    art = cairo.LinearGradient(1394, 116, 1556, 278)
    art.add_color_stop_rgb(0, 0.94, 0.36, 0.22)
    art.add_color_stop_rgb(0.55, 0.56, 0.16, 0.50)
    art.add_color_stop_rgb(1, 0.12, 0.12, 0.42)
    rounded(ctx, 1394, 116, 162, 162, 16)
    ctx.set_source(art)
    ctx.fill()
    glow_disc(ctx, (1475, 204), 60, (1.0, 0.85, 0.55), 0.9)
    text(ctx, "Evening Light", 1586, 158, 34, WHITE, "Inter Semi Bold", align="left")
    text(ctx, "The Parallels", 1586, 198, 28, GREY, align="left")
    rounded(ctx, 1586, 228, 250, 6, 3)
    ctx.set_source_rgb(*DIM)
    ctx.fill()
    rounded(ctx, 1586, 228, 104, 6, 3)
    ctx.set_source_rgb(*WHITE)
    ctx.fill()
    polygon(ctx, [(1700, 250), (1700, 282), (1728, 266)], WHITE)
    polygon(ctx, [(1640, 266), (1660, 252), (1660, 280)], GREY)
    polygon(ctx, [(1790, 266), (1770, 252), (1770, 280)], GREY)


def draw_side_bar(ctx):
    ctx.rectangle(0, 0, 110, 1080)
    ctx.set_source_rgb(*PANEL)
    ctx.fill()
    tints = (BLUE, GREEN, (0.93, 0.40, 0.32), AMBER, (0.62, 0.50, 0.95))
    for i, tint in enumerate(tints):
        rounded(ctx, 22, 120 + 150 * i, 66, 66, 18)
        ctx.set_source_rgb(*tint)
        ctx.fill()
        x, y = 55, 153 + 150 * i
        ctx.set_source_rgb(*WHITE)
        if i == 0:
            polygon(ctx, [(x, y - 20), (x + 15, y + 17), (x, y + 9), (x - 15, y + 17)], WHITE)
        elif i == 1:
            ring(ctx, (x, y), 16, 7, (40, 320), WHITE)
        elif i == 2:
            ctx.arc(x - 6, y + 10, 9, 0, 2 * math.pi)
            ctx.fill()
            ctx.rectangle(x, y - 20, 5, 30)
            ctx.fill()
        elif i == 3:
            ring(ctx, (x, y), 12, 6, (0, 360), WHITE)
        else:
            for k in range(4):
                ctx.rectangle(x - 16 + 18 * (k % 2), y - 16 + 18 * (k // 2), 14, 14)
                ctx.fill()


def draw_climate(ctx):
    ctx.rectangle(0, 960, 1920, 120)
    ctx.set_source_rgb(*PANEL)
    ctx.fill()
    for x, value in ((250, "21.5°"), (1670, "20.0°")):
        text(ctx, value, x, 1042, 60, WHITE, "Inter Display Medium")
        text(ctx, "–", x - 140, 1038, 46, GREY)
        text(ctx, "+", x + 140, 1038, 46, GREY)
    for i, label in enumerate(("AUTO", "A/C", "FAN 3", "SYNC", "REAR")):
        x = 600 + 180 * i
        rounded(ctx, x - 76, 984, 152, 72, 20)
        chosen = i < 2
        ctx.set_source_rgb(*((0.10, 0.30, 0.52) if chosen else (0.12, 0.135, 0.16)))
        ctx.fill()
        text(ctx, label, x, 1032, 32, WHITE if chosen else GREY, "Inter Semi Bold")


def draw_status(ctx):
    ctx.rectangle(110, 0, 1810, 66)
    ctx.set_source_rgba(*PANEL, 0.86)
    ctx.fill()
    text(ctx, "10:42", 1015, 47, 38, WHITE, "Inter Semi Bold")
    text(ctx, "18.5 °C", 150, 46, 32, WHITE, align="left")
    text(ctx, "5G", 1840, 46, 32, WHITE, "Inter Semi Bold", align="right")
    for i in range(4):
        ctx.rectangle(1700 + 14 * i, 46 - 7 * (i + 1), 9, 7 * (i + 1))
        ctx.set_source_rgb(*WHITE)
        ctx.fill()


def draw_centre(path):
    surface = cairo.ImageSurface(cairo.FORMAT_RGB24, 2560, 1440)
    ctx = cairo.Context(surface)
    ctx.scale(2560 / 1920, 1440 / 1080)  # drawn in units of a 1920x1080 panel
    ctx.set_source_rgb(*LAND)
    ctx.paint()
    draw_blocks(ctx)
    draw_nature(ctx)
    draw_bridges_and_motorway(ctx)
    draw_route(ctx)
    draw_labels(ctx)
    pin(ctx, *grid(8, -5.6), RED, "B")
    pin(ctx, *grid(-4, 0.0), GREEN, "P")
    draw_position(ctx)
    draw_search(ctx)
    draw_guidance(ctx)
    draw_media(ctx)
    draw_side_bar(ctx)
    draw_status(ctx)
    draw_climate(ctx)
    save(surface, path)
