# SPDX-License-Identifier: Apache-2.0
"""What the flight deck's other displays show: engines, standby, keyboards and windows."""

from flight_content import (
    AMBER,
    CYAN,
    DARK,
    EARTH_DEEP,
    EARTH_HIGH,
    FACE,
    GREEN,
    GREY,
    MAGENTA,
    RED,
    SKY_LOW,
    SKY_TOP,
    WHITE,
    YELLOW,
    box,
    line,
    page,
)
from pens import polar, polygon, ring, save, text

ENGINE_SIZE = (1024, 1280)


def arc_gauge(ctx, centre, radius, share, value, limit=0.94, marks=()):
    """A dial from the left over the top, with a red end and a needle."""
    start, end = 165.0, 375.0
    span = end - start
    ring(ctx, centre, radius, 5, (start, start + limit * span), WHITE)
    ring(ctx, centre, radius, 11, (start + limit * span, end), RED)
    for s, label in marks:
        a = start + s * span
        line(ctx, [polar(*centre, radius, a), polar(*centre, radius - 20, a)], WHITE, 4)
        text(
            ctx,
            label,
            *(lambda p: (p[0], p[1] + 9))(polar(*centre, radius - 40, a)),
            27,
            WHITE,
            FACE,
        )
    a = start + share * span
    line(ctx, [polar(*centre, 0.20 * radius, a), polar(*centre, radius + 4, a)], GREEN, 8)
    bug = start + (share + 0.05) * span
    line(ctx, [polar(*centre, radius, bug), polar(*centre, radius + 20, bug)], CYAN, 7)
    x, y = centre
    box(ctx, x - 12, y + 12, 128, 52, (0.02, 0.02, 0.025), GREY, 3)
    text(ctx, value, x + 108, y + 53, 43, GREEN, FACE, align="right")


def small_gauge(ctx, centre, radius, share, value):
    ring(ctx, centre, radius, 5, (180, 342), WHITE)
    ring(ctx, centre, radius, 10, (330, 360), AMBER)
    a = 180 + 180 * share
    line(ctx, [polar(*centre, 0.3 * radius, a), polar(*centre, radius + 3, a)], GREEN, 7)
    text(ctx, value, centre[0], centre[1] + 34, 41, GREEN, FACE)


def engines(ctx):
    marks = ((0.22, "5"), (0.80, "10"))
    for x, n1, egt, n2, flow in (
        (250, 0.735, 0.60, "91.4", "1180"),
        (774, 0.737, 0.585, "91.5", "1170"),
    ):
        arc_gauge(ctx, (x, 190), 140, n1, "85.3" if x < 500 else "85.4", marks=marks)
        small_gauge(ctx, (x, 405), 90, egt, "612" if x < 500 else "606")
        text(ctx, n2, x, 534, 44, GREEN, FACE)
        text(ctx, flow, x, 612, 44, GREEN, FACE)
    for y, name, unit in (
        (160, "N1", "%"),
        (380, "EGT", "°C"),
        (518, "N2", "%"),
        (596, "FF", "KG/H"),
    ):
        text(ctx, name, 512, y, 38, WHITE, FACE)
        text(ctx, unit, 512, y + 36, 30, CYAN, FACE)
    for y in (516, 596):
        for side in (-1, 1):
            line(ctx, [(512 + side * 60, y - 8), (512 + side * 140, y + 4)], GREY, 3)
    text(ctx, "CRZ", 512, 60, 40, CYAN, FACE)
    text(ctx, "FOB", 90, 706, 38, WHITE, FACE, align="left")
    text(ctx, "8 460", 330, 706, 44, GREEN, FACE, align="right")
    text(ctx, "KG", 346, 706, 30, CYAN, FACE, align="left")


def flaps(ctx):
    x, y = 690, 712
    polygon(ctx, [(x - 12, y - 10), (x + 66, y - 26), (x + 74, y - 8), (x - 4, y + 10)])
    ctx.set_source_rgb(*WHITE)
    ctx.set_line_width(4)
    ctx.stroke()
    for k in range(4):
        box(ctx, x + 112 + 44 * k, y - 8 + 13 * k, 11, 11, None, WHITE, 3)
        box(ctx, x - 56 - 40 * k, y - 8 + 10 * k, 11, 11, None, WHITE, 3)
    text(ctx, "S", x - 190, y + 12, 31, WHITE, FACE)
    text(ctx, "F", x + 290, y + 12, 31, WHITE, FACE)
    text(ctx, "FLAPS", x + 30, y + 58, 31, WHITE, FACE)
    text(ctx, "0", x + 30, y + 92, 36, GREEN, FACE)


def alerts(ctx):
    line(ctx, [(40, 822), (984, 822)], GREY, 4)
    line(ctx, [(690, 834), (690, 1128)], GREY, 4)
    for y, string, color in (
        (880, "FUEL  R TK PUMP 2 LO PR", AMBER),
        (928, "  - R TK PUMP 2 ....... OFF", CYAN),
        (1000, "ENG ANTI ICE", GREEN),
        (1046, "SEAT BELTS", GREEN),
        (1092, "LDG LT RETRACTED", GREEN),
    ):
        text(ctx, string, 50, y, 37, color, FACE, align="left")
    for y, string, color in (
        (880, "ENG A. ICE", GREEN),
        (928, "WX RADAR", GREEN),
        (976, "CTR TK FEEDG", GREEN),
    ):
        text(ctx, string, 712, y, 36, color, FACE, align="left")
    line(ctx, [(40, 1140), (984, 1140)], GREY, 4)
    for x, name, value, unit in ((50, "TAT", "-21", "°C"), (50, "SAT", "-52", "°C")):
        y = 1192 if name == "TAT" else 1244
        text(ctx, name, x, y, 37, WHITE, FACE, align="left")
        text(ctx, value, x + 180, y, 40, GREEN, FACE, align="right")
        text(ctx, unit, x + 196, y, 32, CYAN, FACE, align="left")
    text(ctx, "06:30", 512, 1220, 46, GREEN, FACE)
    text(ctx, "GW", 700, 1220, 37, WHITE, FACE, align="left")
    text(ctx, "61 300", 906, 1220, 42, GREEN, FACE, align="right")
    text(ctx, "KG", 920, 1220, 32, CYAN, FACE, align="left")


def draw_engine(path):
    surface, ctx = page(ENGINE_SIZE)
    engines(ctx)
    flaps(ctx)
    alerts(ctx)
    save(surface, path)


def draw_standby(path):
    surface, ctx = page((512, 512))
    horizon = 272
    box(ctx, 0, 0, 512, horizon, SKY_LOW)
    box(ctx, 0, 0, 512, 90, tuple(0.5 * (a + b) for a, b in zip(SKY_TOP, SKY_LOW)))
    box(ctx, 0, horizon, 512, 240, EARTH_HIGH)
    box(ctx, 0, 430, 512, 82, tuple(0.5 * (a + b) for a, b in zip(EARTH_HIGH, EARTH_DEEP)))
    line(ctx, [(0, horizon), (512, horizon)], WHITE, 3)
    for step in (-4, -3, -2, -1, 1, 2, 3, 4):
        half, y = (46 if step % 2 == 0 else 22), horizon - 37 * step
        line(ctx, [(256 - half, y), (256 + half, y)], WHITE, 3)
        if step % 2 == 0:
            text(ctx, str(abs(5 * step)), 256 + half + 22, y + 8, 22, WHITE, FACE)
    for degrees in (-45, -30, -20, -10, 0, 10, 20, 30, 45):
        a = degrees - 90
        line(ctx, [polar(256, 256, 176, a), polar(256, 256, 190, a)], WHITE, 3)
    polygon(ctx, [(256, 82), (246, 100), (266, 100)], YELLOW)
    for side in (-1, 1):
        polygon(
            ctx,
            [
                (256 + side * 34, 252),
                (256 + side * 108, 252),
                (256 + side * 108, 262),
                (256 + side * 44, 262),
                (256 + side * 44, 276),
                (256 + side * 34, 276),
            ],
            YELLOW,
        )
    box(ctx, 251, 251, 10, 10, YELLOW)
    for x in (0, 420):
        box(ctx, x, 0, 92, 512, (0.10, 0.11, 0.13))
    for k in range(-4, 5):
        y = 256 - 56 * k
        line(ctx, [(80, y), (92, y)], WHITE, 3)
        line(ctx, [(420, y), (432, y)], WHITE, 3)
        if k:
            text(ctx, str(280 + 20 * k), 74, y + 9, 26, WHITE, FACE, align="right")
            text(ctx, str(350 + 5 * k), 438, y + 9, 26, WHITE, FACE, align="left")
    box(ctx, 4, 230, 90, 52, (0.0, 0.0, 0.0), WHITE, 3)
    text(ctx, "278", 84, 270, 40, GREEN, FACE, align="right")
    box(ctx, 414, 230, 94, 52, (0.0, 0.0, 0.0), WHITE, 3)
    text(ctx, "350", 422, 269, 38, GREEN, FACE, align="left")
    text(ctx, "00", 504, 266, 24, GREEN, FACE, align="right")
    box(ctx, 92, 464, 328, 48, (0.0, 0.0, 0.0))
    text(ctx, "STD", 256, 500, 34, CYAN, FACE)
    text(ctx, "M .784", 150, 500, 26, GREEN, FACE)
    save(surface, path)


CDU_LINES = (
    ("FROM", "TIME", "SPD/ALT"),
    ("TOLKA", "0634", ".78/FL350"),
    ("AWY 612", "", "31NM"),
    ("BRINO", "0638", '  "/FL350'),
    ("TRK 207", "", "24"),
    ("KESTU", "0641", '  "/FL350'),
    ("AWY 612", "", "39"),
    ("OSMAR", "0646", '  "/FL350'),
    ("(T/D)", "", "52"),
    ("(T/D)", "0653", '  "/FL350'),
    ("DEST", "TIME  DIST", "EFOB"),
    ("LXGB14", "0731  342", "6.2"),
)


def draw_cdu(path):
    surface, ctx = page((640, 484))
    text(ctx, "FLIGHT 614", 400, 34, 28, WHITE, FACE)
    for k, (left, middle, right) in enumerate(CDU_LINES):
        big, y = k % 2 == 1, 66 + 33.5 * k
        size, color = (30, GREEN) if big else (22, WHITE)
        text(ctx, left, 16, y, size, color, FACE, align="left")
        text(ctx, middle, 330, y, size, color, FACE)
        text(
            ctx, right, 624, y, size, MAGENTA if big and k < 10 else color, FACE, align="right"
        )
    line(ctx, [(10, 402), (630, 402)], GREY, 2)
    box(ctx, 10, 446, 620, 34, DARK)
    text(ctx, "GPS PRIMARY", 20, 474, 29, AMBER, FACE, align="left")
    save(surface, path)


SEGMENTS = {
    "0": "abcdef",
    "1": "bc",
    "2": "abged",
    "3": "abgcd",
    "4": "fgbc",
    "5": "afgcd",
    "6": "afgedc",
    "7": "abc",
    "8": "abcdefg",
    "9": "abfgcd",
    "-": "g",
}


def digit(ctx, x, y, w, h, letter, color):
    """Seven segments, upright."""
    m = y + h / 2
    ends = {
        "a": ((x, y), (x + w, y)),
        "b": ((x + w, y), (x + w, m)),
        "c": ((x + w, m), (x + w, y + h)),
        "d": ((x, y + h), (x + w, y + h)),
        "e": ((x, m), (x, y + h)),
        "f": ((x, y), (x, m)),
        "g": ((x, m), (x + w, m)),
    }
    for name in SEGMENTS.get(letter, ""):
        (ax, ay), (bx, by) = ends[name]
        tx, ty = (4.5, 0) if ay == by else (0, 4.5)
        line(ctx, [(ax + tx, ay + ty), (bx - tx, by - ty)], color, 8)
    if letter == ".":
        polygon(
            ctx,
            [(x - 6, y + h - 6), (x + 4, y + h - 6), (x + 4, y + h + 4), (x - 6, y + h + 4)],
            color,
        )


def draw_windows(path):
    """The glareshield's small windows, one above the other, each 384 x 144."""
    surface, ctx = page((384, 864))
    color = (1.0, 0.78, 0.42)
    for k, string in enumerate((".784", "206", "35000", "---00", "1013", "1013")):
        advance = 66 if len(string) > 4 else 76
        total = advance * len(string.replace(".", "")) - (advance - 42)
        x = 192 - total / 2
        for letter in string:
            digit(ctx, x, 144 * k + 36, 42, 74, letter, color)
            x += 22 if letter == "." else advance
    save(surface, path)


LAND, WATER, PAPER = (0.115, 0.125, 0.130), (0.055, 0.085, 0.115), (0.030, 0.034, 0.040)


def draw_tablet(path):
    """An enroute chart in its night colours."""
    surface, ctx = page((600, 800))
    box(ctx, 0, 0, 600, 800, LAND)
    polygon(
        ctx, [(0, 0), (250, 0), (210, 120), (262, 250), (180, 330), (120, 470), (0, 540)], WATER
    )
    for radius in (90, 150):
        ring(ctx, (330, 430), radius, 2, (0, 360), GREY)
    routes = [
        ((40, 90), (330, 430)),
        ((330, 430), (560, 250)),
        ((330, 430), (470, 760)),
        ((330, 430), (80, 690)),
        ((150, 60), (560, 250)),
        ((470, 760), (560, 250)),
    ]
    for a, b in routes:
        line(ctx, [a, b], (0.45, 0.60, 0.72), 3)
        mx, my = 0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])
        box(ctx, mx - 26, my - 13, 52, 26, PAPER, (0.45, 0.60, 0.72), 2)
        text(ctx, f"{int(a[0] + b[1]) % 900 + 60}", mx, my + 8, 19, WHITE, FACE)
    line(ctx, [(80, 690), (330, 430), (420, 330), (560, 250)], MAGENTA, 5)
    for (x, y), name in (
        ((40, 90), "LMR"),
        ((330, 430), "TOLKA"),
        ((560, 250), "KESTU"),
        ((470, 760), "VDA"),
        ((80, 690), "NIBEX"),
        ((420, 330), "BRINO"),
    ):
        polygon(ctx, [(x, y - 11), (x + 10, y + 8), (x - 10, y + 8)], CYAN)
        text(ctx, name, min(x + 14, 520), y + 28, 22, WHITE, FACE, align="left")
    polygon(ctx, [(206, 545), (216, 574), (206, 567), (196, 574)], YELLOW)
    box(ctx, 0, 0, 600, 54, PAPER)
    text(ctx, "ENROUTE HIGH", 16, 38, 27, WHITE, FACE, align="left")
    text(ctx, "06:30 Z", 584, 38, 27, GREEN, FACE, align="right")
    box(ctx, 0, 738, 600, 62, PAPER)
    for k, name in enumerate(("CHARTS", "PERF", "DOCS", "MSG")):
        text(ctx, name, 75 + 150 * k, 778, 25, CYAN if k == 0 else GREY, FACE)
    save(surface, path)


def draw_systems(folder):
    for name, draw in (
        ("engine", draw_engine),
        ("standby", draw_standby),
        ("cdu", draw_cdu),
        ("windows", draw_windows),
        ("tablet", draw_tablet),
    ):
        draw(f"{folder}/{name}.png")
