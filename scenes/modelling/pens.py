# SPDX-License-Identifier: Apache-2.0
"""Strokes and letters that both displays are drawn with (cairo).

Lengths are pixels of the panel, y down; angles are degrees clockwise from 3 o'clock.
"""
import math

import cairo

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
    note_word(ctx, string, x - shift * advance, y)
    ctx.move_to(x - shift * advance, y)
    ctx.show_text(string)
    return advance


WORDS = []  # of the picture that is being drawn: its box in pixels, and what it says


def note_word(ctx, string, x, y):
    left, top, width, height, *_ = ctx.text_extents(string)
    corners = [ctx.user_to_device(x + left + s * width, y + top + t * height)
               for s in (0, 1) for t in (0, 1)]
    xs, ys = zip(*corners)
    WORDS.append((min(xs), min(ys), max(xs), max(ys), string))


def save(surface, path):
    """The picture, and beside it what is written in it: NAME.words, a line a word, its left,
    top, right and bottom as shares of the picture."""
    surface.write_to_png(path)
    size = (surface.get_width(), surface.get_height()) * 2
    with open(path.rsplit(".", 1)[0] + ".words", "w", encoding="utf-8") as file:
        for *box, string in WORDS:
            shares = " ".join(f"{v / s:.4f}" for v, s in zip(box, size))
            file.write(f"{shares} {string}\n")
    WORDS.clear()


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
    polygon(
        ctx,
        [
            (x + 0.44 * size, y - 0.92 * size),
            (x + 0.80 * size, y - 0.62 * size),
            (x + 0.44 * size, y - 0.32 * size),
        ],
        color,
    )
