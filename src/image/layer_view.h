/* SPDX-License-Identifier: Apache-2.0 */
/* layer_view.h -- how each layer of a frame is looked at.
 *
 * Memory   planes and pictures come from the arena that is passed in.
 * Threads  pure functions.
 */
#pragma once
#include "image/frame.h"
#include "image/picture.h"

typedef enum LayerShow {
    SHOW_LIGHT,       /* 3 planes, linear Rec.709 in cd m^-2: developed */
    SHOW_REFLECTANCE, /* 3 planes, linear Rec.709, 0 .. 1: as sRGB */
    SHOW_DIRECTION,   /* 3 planes, -1 .. 1: 0 is half grey */
    SHOW_POSITION,    /* 3 planes: each axis over the range that most pixels have */
    SHOW_UV,          /* 2 planes: the fractions as red and green */
    SHOW_ID,          /* 1 plane: every number its own colour */
    SHOW_NUMBER       /* 1 plane: false colours with their scale */
} LayerShow;

typedef struct LayerView {
    LayerShow show;
    const float *planes[3]; /* the display window, row by row; NaN where there is nothing */
    int width, height;
    bool has_gaps;    /* NaN is no accident: pixels off displays, too few samples */
    const char *unit; /* SHOW_NUMBER, as stroke_font.h writes it */
    bool is_log;      /* SHOW_NUMBER: on a logarithmic scale */
    float low, high;  /* SHOW_NUMBER: the scale's ends; both 0: what fits the values */
} LayerView;

/* layer: NULL or "" for the frame's own R, G, B; a layer ("normal", "display.emitted",
 * "light.sun") or one channel ("depth.Z"). Planes are in Rec.709 for any primaries of the file.
 * An unknown name is an error that lists the layers there are. */
bool layer_view_find(const FrameImage *frame, const char *layer, Arena *arena, LayerView *out,
                     Error *err);

/* The luminance of SHOW_LIGHT, cd m^-2: 0.2126 R + 0.7152 G + 0.0722 B. */
float *layer_view_luminance(const LayerView *view, Arena *arena);

/* The picture of a layer that is not SHOW_LIGHT. scale (may be NULL): what a number's colours
 * mean, in words; at least 160 characters. */
Picture layer_view_picture(const LayerView *view, Arena *arena, char *scale);
