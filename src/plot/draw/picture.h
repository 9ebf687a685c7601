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
    bool is_svg;
    PictureDraw *draw;
    const void *context;
} PictureSpec;

/* The same bytes for the same pictures of a process in their order, and version of cairo. */
bool picture_draw(const PictureSpec *spec, Arena *arena, PlotBytes *out, Error *err);
