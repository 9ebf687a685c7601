#!/usr/bin/python3
"""Draws what the displays of car_dashboard.gltf show: assets/content/cluster.png (1920x720)
and assets/content/centre.png (1920x1080), sRGB code values as a panel receives them.

Needs python3-cairo and the font Inter (Debian fonts-inter, SIL Open Font Licence 1.1).
Lengths are pixels of the panel, y down; angles are degrees clockwise from 3 o'clock.
"""
import math
import os
import random

import cairo

FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "assets", "content")

WHITE = (0.95, 0.97, 1.00)
GREY = (0.56, 0.61, 0.68)
DIM = (0.26, 0.30, 0.35)
BLUE = (0.20, 0.62, 1.00)
GREEN = (0.22, 0.86, 0.48)
AMBER = (1.00, 0.68, 0.12)
RED = (1.00, 0.24, 0.22)


def polar(cx, cy, radius, degrees):
    angle = math.radians(degrees)
    return cx + radius * math.cos(angle), cy + radius * math.sin(angle)


def text(ctx, string, x, y, size, color=WHITE, face="Inter", bold=False, align="centre"):
    """Draws `string` with its baseline at y; x is its left, centre or right by `align`."""
    weight = cairo.FONT_WEIGHT_BOLD if bold else cairo.FONT_WEIGHT_NORMAL
    ctx.select_font_face(face, cairo.FONT_SLANT_NORMAL, weight)
    ctx.set_font_size(size)
    advance = ctx.text_extents(string).x_advance
    shift = {"left": 0.0, "centre": 0.5, "right": 1.0}[align]
    ctx.set_source_rgb(*color)
    ctx.move_to(x - shift * advance, y)
    ctx.show_text(string)
    return advance


def rounded(ctx, x, y, width, height, radius):
    ctx.new_path()
    ctx.arc(x + width - radius, y + radius, radius, -math.pi / 2, 0)
    ctx.arc(x + width - radius, y + height - radius, radius, 0, math.pi / 2)
    ctx.arc(x + radius, y + height - radius, radius, math.pi / 2, math.pi)
    ctx.arc(x + radius, y + radius, radius, math.pi, 1.5 * math.pi)
    ctx.close_path()


def polygon(ctx, points, color=None):
    ctx.new_path()
    for point in points:
        ctx.line_to(*point)
    ctx.close_path()
    if color:
        ctx.set_source_rgb(*color)
        ctx.fill()


def ring(ctx, centre, radius, width, span, color, alpha=1.0):
    """An arc of `width` from span[0] to span[1] degrees, clockwise."""
    ctx.new_path()
    ctx.arc(*centre, radius, math.radians(span[0]), math.radians(span[1]))
    ctx.set_line_width(width)
    ctx.set_source_rgba(*color, alpha)
    ctx.stroke()


def glow_disc(ctx, centre, radius, color, alpha):
    fade = cairo.RadialGradient(*centre, 0, *centre, radius)
    fade.add_color_stop_rgba(0.0, *color, alpha)
    fade.add_color_stop_rgba(1.0, *color, 0.0)
    ctx.set_source(fade)
    ctx.arc(*centre, radius, 0, 2 * math.pi)
    ctx.fill()


# ---- instrument cluster ------------------------------------------------------------------

DIAL_FROM, DIAL_TO = 140.0, 400.0  # degrees: lower left, over the top, to lower right


def dial_angle(share):
    return DIAL_FROM + (DIAL_TO - DIAL_FROM) * share


def dial_ticks(ctx, centre, radius, count, labels):
    """`count` intervals; a label (or None) for each of the count + 1 ticks."""
    for i in range(count + 1):
        angle = dial_angle(i / count)
        major = labels[i] is not None
        inner = radius - (34 if major else 18)
        ctx.move_to(*polar(*centre, radius, angle))
        ctx.line_to(*polar(*centre, inner, angle))
        ctx.set_line_width(6 if major else 3)
        ctx.set_source_rgb(*(WHITE if major else GREY))
        ctx.stroke()
        if major:
            x, y = polar(*centre, radius - 66, angle)
            text(ctx, labels[i], x, y + 12, 33, WHITE, "Inter Medium")


def dial_needle(ctx, centre, radius, share, color):
    angle = dial_angle(share)
    tip = polar(*centre, radius + 6, angle)
    base = polar(*centre, radius - 130, angle)
    side = polar(0, 0, 6, angle + 90)
    ctx.set_line_cap(cairo.LINE_CAP_BUTT)
    polygon(ctx, [(base[0] - side[0], base[1] - side[1]), (tip[0] - side[0] / 3, tip[1] - side[1] / 3),
                  (tip[0] + side[0] / 3, tip[1] + side[1] / 3),
                  (base[0] + side[0], base[1] + side[1])], color)


def dial_trail(ctx, centre, radius, share, color):
    """The lit arc from the dial's start to the value, brighter towards the value."""
    steps = 48
    for i in range(steps):
        a, b = share * i / steps, share * (i + 1.15) / steps
        ring(ctx, centre, radius, 30, (dial_angle(a), dial_angle(min(b, share))), color,
             0.10 + 0.75 * ((i + 1) / steps) ** 1.6)


def draw_dial(ctx, centre, radius, share, color):
    glow_disc(ctx, centre, radius * 1.12, color, 0.10)
    ring(ctx, centre, radius + 20, 5, (DIAL_FROM, DIAL_TO), (0.36, 0.42, 0.50))
    dial_trail(ctx, centre, radius - 15, share, color)


def draw_speedometer(ctx):
    centre, radius, speed = (420, 372), 292, 104
    draw_dial(ctx, centre, radius, speed / 240, BLUE)
    labels = [str(10 * i) if i % 2 == 0 else None for i in range(25)]
    labels = [label if label is None or int(label) % 20 == 0 else None for label in labels]
    dial_ticks(ctx, centre, radius, 24, labels)
    dial_needle(ctx, centre, radius, speed / 240, (1.0, 0.36, 0.16))
    text(ctx, str(speed), centre[0], centre[1] + 48, 150, WHITE, "Inter Display Semi Bold")
    text(ctx, "km/h", centre[0], centre[1] + 100, 34, GREY)
    speed_limit(ctx, (centre[0], centre[1] + 212), 46, "120")


def speed_limit(ctx, centre, radius, limit):
    ctx.new_path()
    ctx.arc(*centre, radius, 0, 2 * math.pi)
    ctx.set_source_rgb(0.96, 0.96, 0.96)
    ctx.fill()
    ring(ctx, centre, radius - 6, 11, (0, 360), (0.90, 0.10, 0.12))
    text(ctx, limit, centre[0], centre[1] + 13, 37, (0.04, 0.04, 0.05), "Inter", True)


def draw_power_gauge(ctx):
    centre, radius, zero, power = (1500, 372), 292, 0.30, 0.47
    glow_disc(ctx, centre, radius * 1.12, GREEN, 0.09)
    ring(ctx, centre, radius + 20, 5, (DIAL_FROM, DIAL_TO), (0.36, 0.42, 0.50))
    ring(ctx, centre, radius - 15, 30, (dial_angle(0), dial_angle(zero)), GREEN, 0.22)
    ring(ctx, centre, radius - 15, 30, (dial_angle(zero), dial_angle(power)), GREEN, 0.85)
    ring(ctx, centre, radius - 15, 30, (dial_angle(0.88), dial_angle(1)), RED, 0.55)
    labels = ["60", None, None, "0", None, "40", None, "80", None, "100", None]
    dial_ticks(ctx, centre, radius, 10, labels)
    dial_needle(ctx, centre, radius, power, WHITE)
    text(ctx, "78", centre[0] - 18, centre[1] + 30, 118, WHITE, "Inter Display Semi Bold")
    text(ctx, "%", centre[0] + 88, centre[1] + 30, 48, GREY)
    text(ctx, "POWER", centre[0], centre[1] - 88, 27, GREY, "Inter Medium")
    draw_battery(ctx, centre[0] - 105, centre[1] + 72, 0.78)
    text(ctx, "412 km", centre[0], centre[1] + 180, 44, WHITE, "Inter Medium")
    text(ctx, "range", centre[0], centre[1] + 220, 28, GREY)


def draw_battery(ctx, x, y, charge):
    rounded(ctx, x, y, 200, 44, 10)
    ctx.set_line_width(4)
    ctx.set_source_rgb(*GREY)
    ctx.stroke()
    rounded(ctx, x + 7, y + 7, 186 * charge, 30, 6)
    ctx.set_source_rgb(*GREEN)
    ctx.fill()
    rounded(ctx, x + 204, y + 13, 8, 18, 3)
    ctx.set_source_rgb(*GREY)
    ctx.fill()


def road_point(lane, depth):
    """Perspective of the driving view: lane -1..1 over the own lane's edges, depth 0 near..1 far."""
    scale = 1.0 - 0.80 * depth
    return 960 + 55 * depth ** 2 + 135 * lane * scale, 560 - 290 * depth


def draw_lane(ctx, lane, color, dashed):
    steps = 24
    for i in range(steps):
        if dashed and i % 4 >= 2:
            continue
        a, b = i / steps, (i + 1) / steps
        ctx.move_to(*road_point(lane, a))
        ctx.line_to(*road_point(lane, b))
        ctx.set_line_width(9 * (1 - 0.75 * a))
        ctx.set_source_rgba(*color, 1.0 - 0.85 * a)
        ctx.stroke()


def draw_car(ctx, lane, depth, color):
    x, y = road_point(lane, depth)
    s = 0.95 * (1.0 - 0.72 * depth)
    polygon(ctx, [(x - 66 * s, y), (x - 70 * s, y - 46 * s), (x - 48 * s, y - 92 * s),
                  (x + 48 * s, y - 92 * s), (x + 70 * s, y - 46 * s), (x + 66 * s, y)], color)
    polygon(ctx, [(x - 52 * s, y - 48 * s), (x - 41 * s, y - 84 * s), (x + 41 * s, y - 84 * s),
                  (x + 52 * s, y - 48 * s)], (0.10, 0.13, 0.17))
    for side in (-1, 1):
        rounded(ctx, x + side * 52 * s - 14 * s, y - 42 * s, 28 * s, 12 * s, 4 * s)
        ctx.set_source_rgb(0.95, 0.16, 0.14)
        ctx.fill()


def draw_driving_view(ctx):
    corridor = [road_point(-1, i / 20) for i in range(21)]
    corridor += [road_point(1, i / 20) for i in range(20, -1, -1)]
    polygon(ctx, corridor)
    fade = cairo.LinearGradient(0, 560, 0, 270)
    fade.add_color_stop_rgba(0, *BLUE, 0.40)
    fade.add_color_stop_rgba(1, *BLUE, 0.02)
    ctx.set_source(fade)
    ctx.fill()
    for lane, color, dashed in ((-1, BLUE, False), (1, BLUE, False), (3, GREY, False), (-3, GREY, True)):
        draw_lane(ctx, lane, color, dashed)
    draw_car(ctx, -2, 0.66, (0.38, 0.43, 0.50))
    draw_car(ctx, 0, 0.50, (0.62, 0.68, 0.76))
    draw_car(ctx, 0, 0.02, (0.86, 0.90, 0.95))


def turn_arrow(ctx, x, y, size, color):
    """Turn right: a stem that bends to an arrow head; (x, y) the foot of the stem."""
    ctx.set_line_width(0.20 * size)
    ctx.set_line_cap(cairo.LINE_CAP_BUTT)
    ctx.set_line_join(cairo.LINE_JOIN_ROUND)
    ctx.new_path()
    ctx.move_to(x, y)
    ctx.line_to(x, y - 0.38 * size)
    ctx.arc(x + 0.24 * size, y - 0.38 * size, 0.24 * size, math.pi, 1.5 * math.pi)
    ctx.line_to(x + 0.48 * size, y - 0.62 * size)
    ctx.set_source_rgb(*color)
    ctx.stroke()
    polygon(ctx, [(x + 0.44 * size, y - 0.92 * size), (x + 0.80 * size, y - 0.62 * size),
                  (x + 0.44 * size, y - 0.32 * size)], color)


def draw_navigation_hint(ctx):
    turn_arrow(ctx, 836, 196, 92, WHITE)
    text(ctx, "350 m", 950, 160, 46, WHITE, "Inter Semi Bold", align="left")
    text(ctx, "Lindenallee", 950, 200, 31, GREY, align="left")


def draw_gear(ctx):
    for i, gear in enumerate("PRND"):
        chosen = gear == "D"
        text(ctx, gear, 870 + 60 * i, 658, 52 if chosen else 40, WHITE if chosen else DIM,
             "Inter Semi Bold")
    ctx.new_path()
    rounded(ctx, 1030, 672, 40, 6, 3)
    ctx.set_source_rgb(*BLUE)
    ctx.fill()


def blinker(ctx, x, y, side, color):
    polygon(ctx, [(x, y - 26), (x + 36 * side, y), (x, y + 26), (x, y + 12), (x - 24 * side, y + 12),
                  (x - 24 * side, y - 12), (x, y - 12)], color)


def beam_telltale(ctx, x, y, color):
    ctx.new_path()
    ctx.arc(x, y, 22, -math.pi / 2, math.pi / 2)
    ctx.close_path()
    ctx.set_source_rgb(*color)
    ctx.fill()
    ctx.set_line_width(5)
    for i in range(4):
        ctx.move_to(x - 10, y - 19 + 12.5 * i)
        ctx.line_to(x - 42, y - 12 + 12.5 * i)
    ctx.stroke()


def warning_triangle(ctx, x, y, color):
    ctx.set_line_width(5)
    ctx.set_line_join(cairo.LINE_JOIN_ROUND)
    polygon(ctx, [(x - 26, y + 20), (x, y - 24), (x + 26, y + 20)])
    ctx.set_source_rgb(*color)
    ctx.stroke()
    text(ctx, "!", x, y + 15, 32, color, "Inter", True)


def draw_telltales(ctx):
    blinker(ctx, 700, 60, -1, DIM)
    blinker(ctx, 1220, 60, 1, GREEN)
    beam_telltale(ctx, 126, 650, GREEN)
    text(ctx, "ABS", 210, 662, 30, DIM, "Inter Semi Bold")
    text(ctx, "READY", 690, 662, 32, GREEN, "Inter Semi Bold")
    text(ctx, "AUTO HOLD", 1255, 662, 28, GREEN, "Inter Semi Bold")
    warning_triangle(ctx, 1795, 650, AMBER)


def draw_cluster_status(ctx):
    text(ctx, "10:42", 960, 74, 46, WHITE, "Inter Medium")
    text(ctx, "18.5 °C", 120, 70, 36, WHITE, align="left")
    text(ctx, "Comfort", 1800, 70, 36, WHITE, align="right")
    text(ctx, "14 392 km", 420, 690, 28, GREY)
    text(ctx, "15.8 kWh/100 km", 1500, 690, 28, GREY)


def draw_cluster(path):
    surface = cairo.ImageSurface(cairo.FORMAT_RGB24, 1920, 720)
    ctx = cairo.Context(surface)
    back = cairo.LinearGradient(0, 0, 0, 720)
    back.add_color_stop_rgb(0.0, 0.010, 0.014, 0.022)
    back.add_color_stop_rgb(1.0, 0.028, 0.040, 0.058)
    ctx.set_source(back)
    ctx.paint()
    draw_driving_view(ctx)
    draw_speedometer(ctx)
    draw_power_gauge(ctx)
    draw_navigation_hint(ctx)
    draw_gear(ctx)
    draw_telltales(ctx)
    draw_cluster_status(ctx)
    surface.write_to_png(path)


# ---- centre display ----------------------------------------------------------------------

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
        ctx.curve_to(b[0] + (c[0] - a[0]) / 6, b[1] + (c[1] - a[1]) / 6,
                     c[0] - (d[0] - b[0]) / 6, c[1] - (d[1] - b[1]) / 6, c[0], c[1])
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
    polygon(ctx, [grid(0.3, -5.7), grid(3.7, -5.7), grid(3.7, -4.3), grid(3.7, -0.3), grid(0.3, -0.3)],
            PARK)
    polygon(ctx, [grid(-7.7, 4.3), grid(-4.3, 4.3), grid(-4.3, 7.7), grid(-7.7, 7.7)], PARK)
    curve(ctx, [grid(1.0, -1.0), grid(1.6, -2.6), grid(2.8, -3.0), grid(3.2, -5.0)], 6, (0.2, 0.36, 0.27))
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


ROUTE = [(0, 5.2), (0, 0), (0, 0), (4, 0), (4, 0), (4, -3.2), (4, -6.1)]


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
    street_label(ctx, -4, 1.0, "Am Markt", False)
    street_label(ctx, 7.2, 4, "Hafenstraße", True)
    street_label(ctx, 8, -2, "Nordring", False)
    text(ctx, "Stadtpark", *grid(2.0, -1.9), 33, (0.52, 0.80, 0.62), "Inter Medium")
    text(ctx, "Fluss", 1560, 745, 33, (0.50, 0.72, 0.92), "Inter Medium")
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
    surface = cairo.ImageSurface(cairo.FORMAT_RGB24, 1920, 1080)
    ctx = cairo.Context(surface)
    ctx.set_source_rgb(*LAND)
    ctx.paint()
    draw_blocks(ctx)
    draw_nature(ctx)
    draw_bridges_and_motorway(ctx)
    draw_route(ctx)
    draw_labels(ctx)
    pin(ctx, *grid(8, -5.6), RED, "B")
    pin(ctx, *grid(-4, -1.0), GREEN, "P")
    draw_position(ctx)
    draw_search(ctx)
    draw_guidance(ctx)
    draw_media(ctx)
    draw_side_bar(ctx)
    draw_status(ctx)
    draw_climate(ctx)
    surface.write_to_png(path)


if __name__ == "__main__":
    os.makedirs(FOLDER, exist_ok=True)
    draw_cluster(os.path.join(FOLDER, "cluster.png"))
    draw_centre(os.path.join(FOLDER, "centre.png"))
