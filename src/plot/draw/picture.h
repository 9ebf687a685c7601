/* SPDX-License-Identifier: Apache-2.0 */
/* picture.h -- a drawing as the bytes of an SVG or PNG picture.
 *
 * Units    points; a PNG has `scale` pixels to each, an SVG unit is a pixel.
 * Memory   the arena's. Threads: one picture at a time per arena.
 * Fails    with cairo's reason.
 */
#pragma once
#include "base/error.h"
#include "plot/draw/canvas.h"
#include "plot/draw/svg_text.h"

typedef void PictureDraw(Canvas *canvas, const void *context);

typedef struct PictureSpec {
    double width, height; /* points */
    double scale;         /* pixels per point */
    bool   is_svg, is_dark;
    const char  *inline_prefix; /* SVG inside a page of HTML: its ids begin so; NULL: a file */
    PictureDraw *draw;
    const void  *context;
} PictureSpec;

bool picture_draw(const PictureSpec *spec, Arena *arena, PlotBytes *out, Error *err);
