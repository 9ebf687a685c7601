/* SPDX-License-Identifier: Apache-2.0 */
/* selection.h -- which pixels count: a mask, a region, a display, a data window.
 *
 * Displays count by what they send themselves (measure/display_part.h) where both frames have
 *          the layers that show it: all pixels in which either side sees some of it. Else the
 *          reference's pixels that show it count, whole.
 * Layout   one byte a pixel of the display window, 0: left out.
 * Memory   from the arena. Threads: pure.
 * Fails    for a mask of another size or that cannot be read, a region outside, a display that
 *          is not there, and when nothing is left.
 */
#pragma once
#include "compare/input.h"

typedef struct SelectionRequest {
    const char *mask;         /* a picture's file: black is left out; NULL: none */
    const ExrWindow *regions; /* half-open, pixels of the display window: those of any count */
    int region_count;         /* 0: all */
    const char *display;      /* only what this display sends; NULL: all */
} SelectionRequest;

typedef struct Selection {
    unsigned char *counts;
    long pixels;  /* that count */
    bool is_part; /* some that the frames have are left out by request */
} Selection;

/* Both sides have the same size and data window. */
bool selection_make(const CompareInput *const sides[2], const SelectionRequest *request,
                    Arena *arena, Selection *out, Error *err);

/* Gives both frames the light of that display alone, and what states its noise; false, and
 * nothing is changed, where they do not show it. */
bool selection_take_display(CompareInput *const sides[2], const char *display, Arena *arena,
                            Error *err);

/* Pixels of the display window that the data window holds, for every value of a channel: where
 * channel value i lies, or -1 outside. */
static inline long selection_place(const FrameImage *frame, size_t i) {
    const ExrWindow d = frame->data, w = frame->display;
    long row = d.x1 - d.x0, x = d.x0 + (long)i % row, y = d.y0 + (long)i / row;
    if (x < w.x0 || x >= w.x1 || y < w.y0 || y >= w.y1) return -1;
    return (y - w.y0) * (w.x1 - w.x0) + (x - w.x0);
}
