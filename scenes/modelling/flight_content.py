# SPDX-License-Identifier: Apache-2.0
"""What the flight deck's displays show: primary flight and navigation, 1280x1024 pixels."""
import math

import cairo

from pens import polar, polygon, ring, save, text

WHITE = (0.96, 0.97, 0.98)
GREY = (0.58, 0.61, 0.64)
DARK = (0.165, 0.18, 0.20)
CYAN = (0.10, 0.86, 0.96)
GREEN = (0.16, 0.92, 0.30)
MAGENTA = (0.96, 0.32, 0.92)
AMBER = (1.00, 0.66, 0.10)
YELLOW = (1.00, 0.90, 0.10)
RED = (0.98, 0.16, 0.12)
SKY_TOP, SKY_LOW = (0.02, 0.22, 0.62), (0.16, 0.48, 0.88)
EARTH_HIGH, EARTH_DEEP = (0.47, 0.30, 0.13), (0.27, 0.16, 0.07)
FACE = "Inter Medium"
SIZE = (1280, 1024)


def page(size=SIZE):
    surface = cairo.ImageSurface(cairo.FORMAT_RGB24, *size)
    ctx = cairo.Context(surface)
    ctx.set_source_rgb(0.012, 0.014, 0.018)
    ctx.paint()
    return surface, ctx


def line(ctx, points, color, width=3, dash=()):
    ctx.new_path()
    for x, y in points:
        ctx.line_to(x, y)
    ctx.set_dash(dash)
    ctx.set_line_width(width)
    ctx.set_source_rgb(*color)
    ctx.stroke()
    ctx.set_dash([])


def box(ctx, x, y, w, h, fill=None, edge=None, width=3):
    ctx.rectangle(x, y, w, h)
    if fill:
        ctx.set_source_rgb(*fill)
        ctx.fill_preserve()
    if edge:
        ctx.set_source_rgb(*edge)
        ctx.set_line_width(width)
        ctx.stroke_preserve()
    ctx.new_path()


# --- primary flight display ---------------------------------------------------------------

CENTRE = (600, 486)
PIXELS_A_DEGREE = 13.2
PITCH, BANK = 2.5, 0.0
BALL = (352, 226, 496, 520)  # x, y, width, height


def attitude(ctx):
    ctx.save()
    x, y, w, h = BALL
    ctx.new_path()
    r = 74
    ctx.arc(x + w - r, y + r, r, -math.pi / 2, 0)
    ctx.arc(x + w - r, y + h - r, r, 0, math.pi / 2)
    ctx.arc(x + r, y + h - r, r, math.pi / 2, math.pi)
    ctx.arc(x + r, y + r, r, math.pi, 1.5 * math.pi)
    ctx.close_path()
    ctx.clip()
    horizon = CENTRE[1] + PITCH * PIXELS_A_DEGREE
    for top, bottom, a, b in (
        (y - 10, horizon, SKY_TOP, SKY_LOW),
        (horizon, y + h + 10, EARTH_HIGH, EARTH_DEEP),
    ):
        fade = cairo.LinearGradient(0, top, 0, bottom)
        fade.add_color_stop_rgb(0, *a)
        fade.add_color_stop_rgb(1, *b)
        ctx.set_source(fade)
        ctx.rectangle(x, top, w, bottom - top)
        ctx.fill()
    line(ctx, [(x, horizon), (x + w, horizon)], WHITE, 4)
    ladder(ctx, horizon)
    ctx.restore()
    bank_scale(ctx)
    aircraft_symbol(ctx)


def ladder(ctx, horizon):
    for step in range(-8, 9):
        degrees = 2.5 * step
        if step == 0:
            continue
        y = horizon - degrees * PIXELS_A_DEGREE
        if not BALL[1] + 74 < y < BALL[1] + BALL[3] - 40:
            continue
        half = 92 if step % 4 == 0 else 46 if step % 2 == 0 else 22
        line(ctx, [(CENTRE[0] - half, y), (CENTRE[0] + half, y)], WHITE, 3.5)
        if step % 4 == 0:
            for side in (-1, 1):
                text(
                    ctx,
                    str(abs(int(degrees))),
                    CENTRE[0] + side * (half + 32),
                    y + 10,
                    30,
                    WHITE,
                    FACE,
                )


def bank_scale(ctx):
    radius = 236
    for degrees in (-60, -45, -30, -20, -10, 10, 20, 30, 45, 60):
        long = 26 if degrees % 30 == 0 else 15
        a = polar(*CENTRE, radius, degrees - 90)
        b = polar(*CENTRE, radius + long, degrees - 90)
        if abs(degrees) <= 45:
            line(ctx, [a, b], WHITE, 4)
    ring(ctx, CENTRE, radius, 4, (-90 - 45, -90 + 45), WHITE)
    x, y = CENTRE[0], CENTRE[1] - radius
    polygon(ctx, [(x, y), (x - 17, y - 26), (x + 17, y - 26)], YELLOW)
    ctx.set_line_width(3.5)
    for points in (
        [(x, y + 3), (x - 16, y + 26), (x + 16, y + 26)],
        [(x - 20, y + 31), (x + 20, y + 31), (x + 23, y + 40), (x - 23, y + 40)],
    ):
        polygon(ctx, points)
        ctx.set_source_rgb(*WHITE)
        ctx.stroke()


def aircraft_symbol(ctx):
    x, y = CENTRE
    for side in (-1, 1):
        wing = [
            (x + side * 210, y - 7),
            (x + side * 96, y - 7),
            (x + side * 96, y + 32),
            (x + side * 110, y + 32),
            (x + side * 110, y + 8),
            (x + side * 210, y + 8),
        ]
        polygon(ctx, wing, (0.02, 0.02, 0.02))
        polygon(ctx, wing)
        ctx.set_source_rgb(*YELLOW)
        ctx.set_line_width(4)
        ctx.stroke()
    box(ctx, x - 8, y - 8, 16, 16, (0.02, 0.02, 0.02), YELLOW, 4)
    line(ctx, [(x - 120, y - 4), (x + 120, y - 4)], GREEN, 5)
    line(ctx, [(x + 3, y - 112), (x + 3, y + 112)], GREEN, 5)


def tape_back(ctx, x, width, y=226, height=520):
    box(ctx, x, y, width, height, DARK)


def speed_tape(ctx):
    x, width, value, per = 150, 122, 278.0, 4.6
    tape_back(ctx, x, width)
    ctx.save()
    ctx.rectangle(x - 70, 226, width + 110, 520)
    ctx.clip()
    for knots in range(180, 380, 10):
        y = CENTRE[1] - (knots - value) * per
        line(ctx, [(x + width - 20, y), (x + width, y)], WHITE, 3.5)
        if knots % 20 == 0:
            text(ctx, str(knots), x + width - 32, y + 12, 34, WHITE, FACE, align="right")
    y = CENTRE[1] - (326 - value) * per
    for k in range(8):
        box(ctx, x + width + 2, y - 18 - 22 * k, 14, 12, RED)
    y = CENTRE[1] - (226 - value) * per
    line(ctx, [(x + width + 8, 760), (x + width + 8, y), (x + width, y)], AMBER, 5)
    bug = CENTRE[1] - (280 - value) * per
    polygon(ctx, [(x + width + 2, bug), (x + width + 30, bug - 17), (x + width + 30, bug + 17)])
    ctx.set_source_rgb(*CYAN)
    ctx.set_line_width(4.5)
    ctx.stroke()
    line(ctx, [(x + width - 14, CENTRE[1]), (x + width - 14, CENTRE[1] - 66)], YELLOW, 4)
    ctx.restore()
    line(ctx, [(x + width, 226), (x + width, 746)], WHITE, 4)
    line(ctx, [(x, 226), (x + width + 22, 226)], WHITE, 4)
    line(ctx, [(x, 746), (x + width + 22, 746)], WHITE, 4)
    readout(ctx, x - 22, 118, "278", 42)
    text(ctx, "280", x + 60, 212, 38, CYAN, FACE)
    text(ctx, ".784", x + 60, 804, 46, GREEN, FACE)


def readout(ctx, x, width, string, size):
    polygon(
        ctx,
        [
            (x, CENTRE[1] - 32),
            (x + width, CENTRE[1] - 32),
            (x + width, CENTRE[1] - 12),
            (x + width + 16, CENTRE[1]),
            (x + width, CENTRE[1] + 12),
            (x + width, CENTRE[1] + 32),
            (x, CENTRE[1] + 32),
        ],
        (0.02, 0.02, 0.025),
    )
    box(ctx, x, CENTRE[1] - 32, width, 64, (0.02, 0.02, 0.025), YELLOW, 3.5)
    text(ctx, string, x + width - 12, CENTRE[1] + 15, size, GREEN, FACE, align="right")


def altitude_tape(ctx):
    x, width, value, per = 912, 116, 35000.0, 0.46
    tape_back(ctx, x, width)
    ctx.save()
    ctx.rectangle(x - 20, 226, width + 60, 520)
    ctx.clip()
    for feet in range(34000, 36100, 100):
        y = CENTRE[1] - (feet - value) * per
        line(ctx, [(x, y), (x + 16, y)], WHITE, 3)
        if feet % 500 == 0:
            text(ctx, f"{feet // 100}", x + 28, y + 12, 34, WHITE, FACE, align="left")
    ctx.restore()
    line(ctx, [(x + width, 226), (x + width, 746)], WHITE, 4)
    line(ctx, [(x - 8, 226), (x + width, 226)], WHITE, 4)
    line(ctx, [(x - 8, 746), (x + width, 746)], WHITE, 4)
    for dy in (-1, 1):
        line(
            ctx,
            [
                (x - 12, CENTRE[1] + dy * 24),
                (x - 12, CENTRE[1] + dy * 60),
                (x + 12, CENTRE[1] + dy * 60),
            ],
            CYAN,
            4.5,
        )
    box(ctx, x + 6, CENTRE[1] - 34, 92, 68, (0.02, 0.02, 0.025))
    text(ctx, "350", x + 92, CENTRE[1] + 16, 44, GREEN, FACE, align="right")
    box(ctx, x + 98, CENTRE[1] - 56, 56, 112, (0.02, 0.02, 0.025), YELLOW, 3.5)
    for k, number in enumerate(("20", "00", "80")):
        ctx.save()
        ctx.rectangle(x + 99, CENTRE[1] - 53, 54, 106)
        ctx.clip()
        text(ctx, number, x + 126, CENTRE[1] - 30 + 44 * k, 34, GREEN, FACE)
        ctx.restore()
    text(ctx, "FL350", x + 70, 212, 38, CYAN, FACE)
    box(ctx, x + 4, 764, 130, 50, None, YELLOW, 3)
    text(ctx, "STD", x + 69, 803, 40, CYAN, FACE)


def vertical_speed(ctx):
    x = 1102
    polygon(
        ctx,
        [(x, 258), (x + 58, 258), (x + 84, 350), (x + 84, 622), (x + 58, 714), (x, 714)],
        DARK,
    )
    for label, dy in (("6", 200), ("2", 150), ("1", 92)):
        for side in (-1, 1):
            y = CENTRE[1] - side * dy
            line(ctx, [(x + 34, y), (x + 54, y)], WHITE, 5)
            text(ctx, label, x + 20, y + 11, 30, WHITE, FACE)
    for dy in (46, 121, 175):
        for side in (-1, 1):
            y = CENTRE[1] - side * dy
            line(ctx, [(x + 40, y), (x + 54, y)], WHITE, 3)
    line(ctx, [(x + 4, CENTRE[1]), (x + 54, CENTRE[1])], YELLOW, 5)
    line(ctx, [(x + 54, CENTRE[1] - 5), (x + 104, CENTRE[1] - 2)], GREEN, 6)


def heading_tape(ctx):
    cx, cy, radius, heading = CENTRE[0], 1150, 318, 206
    ctx.save()
    ctx.rectangle(300, 795, 600, 229)
    ctx.clip()
    ctx.arc(cx, cy, radius, 0, 2 * math.pi)
    ctx.set_source_rgb(*DARK)
    ctx.fill()
    ring(ctx, (cx, cy), radius, 4, (180, 360), WHITE)
    for degrees in range(heading - 66, heading + 67):
        if degrees % 5:
            continue
        angle = (degrees - heading) - 90
        long = 26 if degrees % 10 == 0 else 14
        line(
            ctx, [polar(cx, cy, radius, angle), polar(cx, cy, radius - long, angle)], WHITE, 3.5
        )
        if degrees % 10 == 0:
            ctx.save()
            px, py = polar(cx, cy, radius - 58, angle)
            ctx.translate(px, py)
            ctx.rotate(math.radians(angle + 90))
            big = degrees % 30 == 0
            text(ctx, str(degrees // 10), 0, 10, 40 if big else 28, WHITE, FACE)
            ctx.restore()
    a = (212 - heading) - 90
    polygon(
        ctx,
        [
            polar(cx, cy, radius + 2, a),
            polar(cx, cy, radius + 30, a - 2.6),
            polar(cx, cy, radius + 30, a + 2.6),
        ],
    )
    ctx.set_source_rgb(*CYAN)
    ctx.set_line_width(4.5)
    ctx.stroke()
    ctx.restore()
    line(ctx, [(cx, 818), (cx, 866)], YELLOW, 6)
    text(ctx, "206°", cx, 968, 44, GREEN, FACE)
    text(ctx, "TRK 209", 190, 980, 33, GREEN, FACE)
    text(ctx, "GS 446", 1010, 980, 33, GREEN, FACE)


def mode_annunciator(ctx):
    box(ctx, 60, 26, 1150, 122, (0.035, 0.040, 0.048))
    for x in (300, 540, 780, 1000):
        line(ctx, [(x, 34), (x, 142)], GREY, 3)
    columns = (180, 420, 660, 890, 1105)
    first = (("MACH", GREEN), ("ALT CRZ", GREEN), ("NAV", GREEN), ("", WHITE), ("AP1", WHITE))
    second = (("", WHITE), ("", CYAN), ("", CYAN), ("CAT 3", WHITE), ("1 FD 2", WHITE))
    third = (("", WHITE), ("OP DES", CYAN), ("", CYAN), ("", WHITE), ("A/THR", WHITE))
    for row, y in ((first, 66), (second, 102), (third, 138)):
        for x, (string, color) in zip(columns, row):
            text(ctx, string, x, y, 35, color, FACE)
    box(ctx, 316, 32, 208, 44, None, WHITE, 2.5)


def draw_pfd(path):
    surface, ctx = page()
    attitude(ctx)
    speed_tape(ctx)
    altitude_tape(ctx)
    vertical_speed(ctx)
    heading_tape(ctx)
    mode_annunciator(ctx)
    save(surface, path)


# --- navigation display -------------------------------------------------------------------

OWN = (640, 812)
RANGE_RADIUS = 600
NAV_HEADING = 206


def weather(ctx):
    """Echoes of rain: blobs of three levels in range cells, as an antenna sweeps them."""
    cells = [
        (-36, 0.78, 0.20, 3),
        (-27, 0.62, 0.12, 2),
        (-40, 0.88, 0.11, 1),
        (5, 0.88, 0.15, 2),
        (36, 0.80, 0.13, 3),
        (38, 0.58, 0.11, 1),
        (31, 0.66, 0.07, 2),
    ]
    levels = {1: (0.0, 0.42, 0.08), 2: (0.74, 0.66, 0.02), 3: (0.76, 0.06, 0.05)}
    for strength in (1, 2, 3):
        for step in range(-120, 121):
            angle = 0.5 * step
            for k in range(20, 98):
                share = k / 98
                power = 0.0
                for a, r, size, level in cells:
                    d2 = ((angle - a) * share / 57.3) ** 2 + (share - r) ** 2
                    power += level * math.exp(-d2 / (0.32 * size) ** 2)
                power *= 1 + 0.30 * math.sin(angle * 1.9 + 3 * share) * math.sin(
                    34 * share + angle
                )
                if power > 0.35 + 0.72 * (strength - 1):
                    ring(
                        ctx,
                        OWN,
                        RANGE_RADIUS * share,
                        6.6,
                        (angle - 90.3, angle - 89.7),
                        levels[strength],
                    )


def rose(ctx):
    for share in (0.25, 0.5, 0.75):
        for k in range(26):
            a = -155 + 130 * k / 25
            ring(ctx, OWN, RANGE_RADIUS * share, 3, (a, a + 2.6), GREY)
    ring(ctx, OWN, RANGE_RADIUS, 4, (-90 - 62, -90 + 62), WHITE)
    for degrees in range(NAV_HEADING - 61, NAV_HEADING + 62):
        if degrees % 5:
            continue
        a = degrees - NAV_HEADING - 90
        long = 24 if degrees % 10 == 0 else 13
        line(
            ctx, [polar(*OWN, RANGE_RADIUS, a), polar(*OWN, RANGE_RADIUS + long, a)], WHITE, 3.5
        )
        if degrees % 10 == 0:
            ctx.save()
            ctx.translate(*polar(*OWN, RANGE_RADIUS + 38, a))
            ctx.rotate(math.radians(a + 90))
            text(ctx, str(degrees // 10), 0, 0, 36 if degrees % 30 == 0 else 27, WHITE, FACE)
            ctx.restore()
    for share, label in ((0.5, "40"), (0.75, "60")):
        for side in (-1, 1):
            x, y = polar(*OWN, RANGE_RADIUS * share, -90 + side * 52)
            text(ctx, label, x, y + 8, 27, CYAN, FACE)
    x = OWN[0]
    line(ctx, [(x, OWN[1] - RANGE_RADIUS - 40), (x, OWN[1] - RANGE_RADIUS + 30)], YELLOW, 6)
    polygon(
        ctx,
        [
            polar(*OWN, RANGE_RADIUS, -84),
            polar(*OWN, RANGE_RADIUS + 26, -85.4),
            polar(*OWN, RANGE_RADIUS + 26, -82.6),
        ],
    )
    ctx.set_source_rgb(*CYAN)
    ctx.set_line_width(4)
    ctx.stroke()


WAYPOINTS = [
    (0.00, 0.00, ""),
    (0.035, 0.33, "TOLKA"),
    (0.02, 0.60, "BRINO"),
    (0.20, 0.80, "KESTU"),
    (0.47, 0.92, "OSMAR"),
    (0.62, 1.12, ""),
]


def spot(dx, ahead):
    return OWN[0] + dx * RANGE_RADIUS, OWN[1] - ahead * RANGE_RADIUS


def route(ctx):
    line(ctx, [spot(*w[:2]) for w in WAYPOINTS], GREEN, 4.5)
    for i, (dx, ahead, name) in enumerate(WAYPOINTS):
        if not name:
            continue
        x, y = spot(dx, ahead)
        color = WHITE if i == 1 else GREEN
        polygon(ctx, [(x, y - 17), (x + 11, y), (x, y + 17), (x - 11, y)])
        ctx.set_source_rgb(*color)
        ctx.set_line_width(4)
        ctx.stroke()
        text(ctx, name, x + 22, y - 10, 31, color, FACE, align="left")
    text(
        ctx,
        "FL350",
        spot(0.20, 0.80)[0] + 22,
        spot(0.20, 0.80)[1] + 34,
        27,
        MAGENTA,
        FACE,
        align="left",
    )
    for dx, ahead, name in ((-0.30, 0.42, "LMR"), (0.36, 0.36, "VDA")):
        x, y = spot(dx, ahead)
        line(ctx, [(x - 14, y), (x + 14, y)], MAGENTA, 4)
        line(ctx, [(x, y - 14), (x, y + 14)], MAGENTA, 4)
        ring(ctx, (x, y), 9, 3, (0, 360), MAGENTA)
        text(ctx, name, x + 20, y + 28, 28, MAGENTA, FACE, align="left")
    x, y = spot(0.11, 0.47)
    line(ctx, [(x - 14, y - 8), (x, y + 14), (x + 14, y - 8)], WHITE, 4)


def traffic(ctx):
    for dx, ahead, label, color, filled, arrow in (
        (-0.17, 0.66, "+10", CYAN, False, 1),
        (0.30, 0.55, "-18", CYAN, True, -1),
        (-0.44, 0.50, "+21", CYAN, False, 0),
        (0.17, 0.27, "-07", AMBER, True, 1),
    ):
        x, y = spot(dx, ahead)
        if color is AMBER:
            ctx.new_path()
            ctx.arc(x, y, 14, 0, 2 * math.pi)
        else:
            polygon(ctx, [(x, y - 18), (x + 14, y), (x, y + 18), (x - 14, y)])
        ctx.set_source_rgb(*color)
        ctx.set_line_width(3.5)
        ctx.fill() if filled else ctx.stroke()
        text(ctx, label, x, y + (-26 if label[0] == "+" else 46), 27, color, FACE)
        if arrow:
            line(ctx, [(x + 28, y + 18), (x + 28, y - 18)], color, 3.5)
            tip = y - 18 * arrow
            line(
                ctx,
                [(x + 20, tip + 11 * arrow), (x + 28, tip), (x + 36, tip + 11 * arrow)],
                color,
                3.5,
            )


def own_aircraft(ctx):
    x, y = OWN
    line(ctx, [(x, y - 34), (x, y + 58)], YELLOW, 8)
    line(ctx, [(x - 46, y), (x + 46, y)], YELLOW, 8)
    line(ctx, [(x - 20, y + 46), (x + 20, y + 46)], YELLOW, 7)


def nav_texts(ctx):
    for x, words in ((40, (("GS", WHITE), ("446", GREEN), ("TAS", WHITE), ("459", GREEN))),):
        for word, color in words:
            x += text(ctx, word, x, 52, 35, color, FACE, align="left") + 16
    text(ctx, "242 / 38", 40, 98, 35, GREEN, FACE, align="left")
    ctx.save()
    ctx.translate(66, 150)
    ctx.rotate(math.radians(242 + 180 - NAV_HEADING))
    line(ctx, [(0, 32), (0, -28)], GREEN, 4.5)
    line(ctx, [(-11, -12), (0, -32), (11, -12)], GREEN, 4.5)
    ctx.restore()
    text(ctx, "TOLKA", 1090, 52, 37, WHITE, FACE)
    text(ctx, "207°", 1210, 52, 35, GREEN, FACE)
    for y, value, unit in ((98, "26.4", "NM"),):
        text(ctx, value, 1150, y, 37, GREEN, FACE, align="right")
        text(ctx, unit, 1164, y, 28, CYAN, FACE, align="left")
    text(ctx, "06:34", 1240, 142, 37, GREEN, FACE, align="right")
    text(ctx, "VOR1", 40, 906, 33, WHITE, FACE, align="left")
    text(ctx, "LMR", 40, 948, 35, WHITE, FACE, align="left")
    text(ctx, "31.0 NM", 40, 990, 33, GREEN, FACE, align="left")
    text(ctx, "VOR2", 1240, 906, 33, WHITE, FACE, align="right")
    text(ctx, "VDA", 1240, 948, 35, WHITE, FACE, align="right")
    text(ctx, "28.5 NM", 1240, 990, 33, GREEN, FACE, align="right")
    text(ctx, "TILT -1.00   WX", 640, 990, 31, CYAN, FACE)
    box(ctx, 505, 898, 270, 46, (0.03, 0.035, 0.04), GREY, 2)
    text(ctx, "GPS PRIMARY", 640, 932, 32, WHITE, FACE)


def draw_nav(path):
    surface, ctx = page()
    weather(ctx)
    rose(ctx)
    route(ctx)
    traffic(ctx)
    own_aircraft(ctx)
    nav_texts(ctx)
    save(surface, path)
