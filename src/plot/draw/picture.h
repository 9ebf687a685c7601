/* SPDX-License-Identifier: Apache-2.0 */
/* picture.h -- a drawing as the bytes of an SVG or PNG picture.
 *
 * Units    points; a PNG has `scale` pixels to each, an SVG unit is a pixel.
 * Memory   the arena's. Threads: one picture at a time per arena.
 * Fails    picture_draw with cairo's reason.
 */
#pragma once
#include "base/error.h"
#include "plot/draw/canvas.h"

typedef struct PlotBytes {
    unsigned char *data; /* data[size] is 0 */
    size_t size;
} PlotBytes;

typedef void PictureDraw(Canvas *canvas, const void *context);

typedef struct PictureSpec {
    double width, height; /* points */
    double scale;         /* pixels per point */
    bool is_svg, is_dark;
    const char *inline_prefix; /* SVG inside a page of HTML: its ids begin so; NULL: a file */
    PictureDraw *draw;
    const void *context;
} PictureSpec;

bool picture_draw(const PictureSpec *spec, Arena *arena, PlotBytes *out, Error *err);

/* Makes cairo's SVG the same every time, and fit to stand inside a page: cairo numbers its
 * elements by counters of the whole process; here every id gets a number by its first
 * appearance, behind a prefix that keeps several drawings of one page apart. A copy, with the
 * coordinates of paths cut to thousandths. is_inline: without the XML declaration. */
PlotBytes picture_with_ids(PlotBytes svg, const char *prefix, bool is_inline, Arena *arena);
