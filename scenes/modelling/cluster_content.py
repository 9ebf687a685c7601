# SPDX-License-Identifier: Apache-2.0
"""The picture of the instrument cluster, 1920x720 pixels."""
import math

import cairo

from pens import (
    AMBER, BLUE, DIM, GREEN, GREY, RED, WHITE, glow_disc, polar, polygon, ring, rounded,
    save, text, turn_arrow,
)

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
    polygon(
        ctx,
        [
            (base[0] - side[0], base[1] - side[1]),
            (tip[0] - side[0] / 3, tip[1] - side[1] / 3),
            (tip[0] + side[0] / 3, tip[1] + side[1] / 3),
            (base[0] + side[0], base[1] + side[1]),
        ],
        color,
    )


def dial_trail(ctx, centre, radius, share, color):
    """The lit arc from the dial's start to the value, brighter towards the value."""
    steps = 48
    for i in range(steps):
        a, b = share * i / steps, share * (i + 1.15) / steps
        ring(
            ctx,
            centre,
            radius,
            30,
            (dial_angle(a), dial_angle(min(b, share))),
            color,
            0.10 + 0.75 * ((i + 1) / steps) ** 1.6,
        )


def draw_dial(ctx, centre, radius, share, color):
    glow_disc(ctx, centre, radius * 1.12, color, 0.10)
    ring(ctx, centre, radius + 20, 5, (DIAL_FROM, DIAL_TO), (0.36, 0.42, 0.50))
    dial_trail(ctx, centre, radius - 15, share, color)


def draw_speedometer(ctx):
    centre, radius, speed = (420, 372), 292, 48
    draw_dial(ctx, centre, radius, speed / 240, BLUE)
    labels = [str(10 * i) if i % 2 == 0 else None for i in range(25)]
    dial_ticks(ctx, centre, radius, 24, labels)
    dial_needle(ctx, centre, radius, speed / 240, (1.0, 0.36, 0.16))
    text(ctx, str(speed), centre[0], centre[1] + 48, 150, WHITE, "Inter Display Semi Bold")
    text(ctx, "km/h", centre[0], centre[1] + 100, 34, GREY)
    speed_limit(ctx, (centre[0], centre[1] + 212), 46, "50")


def speed_limit(ctx, centre, radius, limit):
    ctx.new_path()
    ctx.arc(*centre, radius, 0, 2 * math.pi)
    ctx.set_source_rgb(0.96, 0.96, 0.96)
    ctx.fill()
    ring(ctx, centre, radius - 6, 11, (0, 360), (0.90, 0.10, 0.12))
    text(ctx, limit, centre[0], centre[1] + 13, 37, (0.04, 0.04, 0.05), "Inter", True)


def draw_power_gauge(ctx):
    centre, radius, zero, power = (1500, 372), 292, 0.30, 0.42
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
    """The driving view in perspective: lane -1..1 is our own, depth 0 near to 1 far."""
    scale = 1.0 - 0.80 * depth
    return 960 + 55 * depth**2 + 135 * lane * scale, 560 - 290 * depth


def draw_lane(ctx, lane, color, dashed, nearest):
    steps = 24
    for i in range(steps):
        if i / steps < nearest or dashed and i % 4 >= 2:
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
    polygon(
        ctx,
        [
            (x - 66 * s, y),
            (x - 70 * s, y - 46 * s),
            (x - 48 * s, y - 92 * s),
            (x + 48 * s, y - 92 * s),
            (x + 70 * s, y - 46 * s),
            (x + 66 * s, y),
        ],
        color,
    )
    polygon(
        ctx,
        [
            (x - 52 * s, y - 48 * s),
            (x - 41 * s, y - 84 * s),
            (x + 41 * s, y - 84 * s),
            (x + 52 * s, y - 48 * s),
        ],
        (0.10, 0.13, 0.17),
    )
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
    for lane, color, dashed in (
        (-1, BLUE, False),
        (1, BLUE, False),
        (3, GREY, False),
        (-3, GREY, True),
    ):
        draw_lane(ctx, lane, color, dashed, 0.55 if abs(lane) > 1 else 0.0)
    draw_car(ctx, -2, 0.66, (0.38, 0.43, 0.50))
    draw_car(ctx, 0, 0.50, (0.62, 0.68, 0.76))
    draw_car(ctx, 0, 0.02, (0.86, 0.90, 0.95))


def draw_navigation_hint(ctx):
    turn_arrow(ctx, 836, 196, 92, WHITE)
    text(ctx, "350 m", 950, 160, 46, WHITE, "Inter Semi Bold", align="left")
    text(ctx, "Lindenallee", 950, 200, 31, GREY, align="left")


def draw_gear(ctx):
    for i, gear in enumerate("PRND"):
        chosen = gear == "D"
        text(
            ctx,
            gear,
            870 + 60 * i,
            658,
            52 if chosen else 40,
            WHITE if chosen else DIM,
            "Inter Semi Bold",
        )
    ctx.new_path()
    rounded(ctx, 1030, 672, 40, 6, 3)
    ctx.set_source_rgb(*BLUE)
    ctx.fill()


def blinker(ctx, x, y, side, color):
    polygon(
        ctx,
        [
            (x, y - 26),
            (x + 36 * side, y),
            (x, y + 26),
            (x, y + 12),
            (x - 24 * side, y + 12),
            (x - 24 * side, y - 12),
            (x, y - 12),
        ],
        color,
    )


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
    save(surface, path)
