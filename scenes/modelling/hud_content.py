# SPDX-License-Identifier: Apache-2.0
"""What the head-up display shows: drawn as the driver sees it, then bent for its optics."""
import math

import cairo
import numpy as np

from pens import polygon, text

PER_DEGREE = 480  # pixels of the drawing
CYAN = (0.62, 1.0, 0.86)


def driver_view(field):
    """Codes (rows, columns, 3) from 0 to 255 of the field (degrees), as it shall be seen: the
    speed in the middle, its limit to the left, a turn to the right."""
    w, h = (int(round(side * PER_DEGREE)) for side in field)
    surface = cairo.ImageSurface(cairo.FORMAT_RGB24, w, h)
    ctx = cairo.Context(surface)
    ctx.translate(w / 2, h / 2)
    ctx.scale(PER_DEGREE, PER_DEGREE)
    text(ctx, "48", 0, 0.26, 0.80, (1, 1, 1), bold=True)
    text(ctx, "km/h", 0, 0.56, 0.22, CYAN)
    limit(ctx, -1.25, 0.02)
    arrow(ctx, 0.95, 0.02)
    text(ctx, "350 m", 1.28, 0.56, 0.22, CYAN)
    rows = np.frombuffer(surface.get_data(), np.uint8).reshape(h, surface.get_stride())
    return rows[:, : 4 * w].reshape(h, w, 4)[:, :, 2::-1].astype(float)


def limit(ctx, x, y):
    ctx.new_path()
    ctx.arc(x, y, 0.33, 0, 2 * math.pi)
    ctx.set_line_width(0.075)
    ctx.set_source_rgb(1.0, 0.10, 0.08)
    ctx.stroke()
    text(ctx, "50", x, y + 0.125, 0.36, (1, 1, 1), bold=True)


def arrow(ctx, x, y):
    """A turn to the right."""
    ctx.new_path()
    ctx.move_to(x, y + 0.34)
    ctx.line_to(x, y - 0.02)
    ctx.curve_to(x, y - 0.16, x + 0.06, y - 0.20, x + 0.18, y - 0.20)
    ctx.line_to(x + 0.36, y - 0.20)
    ctx.set_line_width(0.11)
    ctx.set_source_rgb(*CYAN)
    ctx.stroke()
    tip = [(x + 0.34, y - 0.40), (x + 0.64, y - 0.20), (x + 0.34, y)]
    polygon(ctx, tip, CYAN)


def bent(view, field, angles_of, size, pixels):
    """The picture's pixels: what the driver's view holds at the angles that each shows.
    angles_of((right, up) in metres) -> (right, up) in degrees; light is averaged, not codes."""
    width, height = pixels
    light = (view / 255) ** 2.2
    total = np.zeros((height, width, 3))
    steps = (np.arange(3) + 0.5) / 3
    for dy in steps:
        for dx in steps:
            x = ((np.arange(width) + dx) / width - 0.5) * size[0]
            y = (0.5 - (np.arange(height) + dy) / height) * size[1]
            right, up = angles_of(*np.meshgrid(x, y))
            column = np.floor((right / field[0] + 0.5) * view.shape[1]).astype(int)
            row = np.floor((0.5 - up / field[1]) * view.shape[0]).astype(int)
            inside = ((column >= 0) & (column < view.shape[1]) & (row >= 0) &
                      (row < view.shape[0]))
            total[inside] += light[row[inside], column[inside]]
    return np.round(255 * (total / 9) ** (1 / 2.2)).astype(np.uint8)
