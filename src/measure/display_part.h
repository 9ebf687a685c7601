/* SPDX-License-Identifier: Apache-2.0 */
/* display_part.h -- what a display alone sends in the pixels of a frame.
 *
 * A pixel at a display's rim has light of what is around it, too; the layers of displays are
 * means over the samples that saw one. Let v be a sample's light where it saw the display and 0
 * elsewhere, and h of a pixel's n samples have seen it. What the display adds to the pixel is
 * sum(v) / n, its coverage c = h / n, and a display's mean over some pixels the quotient of the
 * sums of both: of two unbiased sums, so that its own bias is of the order of 1 / (all h), far
 * below its error, which is of the order of their root. To first order the quotient R has the
 * variance of the sums of v - R c over the samples: of a pixel
 *     scatter + spread (mean - R)^2
 * with scatter = sum (v - mean)^2 / (n (n - 1)) over the h samples and spread = c (1 - c) /
 * (n - 1), as if samples were independent: too wide for well-spread ones.
 *
 * Units    linear Rec.709, cd m^-2; indices are of the data window, row by row.
 * Threads  pure functions; the layers are views of the frame.
 */
#pragma once
#include "image/frame.h"

typedef struct DisplayLayers {
    const float *emitted[3], *reflected[3], *variance[3];
    const float *id, *coverage, *samples;
    const float *second[3], *second_variance[3];
    const float *second_id, *second_coverage; /* NULL: one display at most */
} DisplayLayers;

/* False: the frame lacks a layer that parts follow from (of two displays or more display.second
 * as well). */
bool display_layers_find(const FrameImage *frame, DisplayLayers *out);

/* A display's part of a pixel. */
typedef struct DisplayPart {
    double coverage;   /* c; 0: none */
    double rgb[3];     /* mean over it */
    double scatter[3]; /* of R, G, B; NaN below two samples */
    double spread;     /* NaN below two samples */
    bool is_shared;    /* with another display: the other display.* layers are of both */
    bool is_unknown;   /* shared with several: no part is reported */
} DisplayPart;

DisplayPart display_part(const DisplayLayers *layers, size_t i, int id);

/* The frame as it would be if all but the display were black: R, G, B, the layer variance (also
 * where the frame has none) and, where it is there, the layer halves are new, all others the
 * frame's. */
FrameImage display_part_frame(const FrameImage *frame, const DisplayLayers *layers, int id,
                              Arena *arena);

/* How the pixels at a display's rim count. */
typedef enum RimCount {
    RIM_BY_COVERAGE, /* by their part */
    RIM_LEFT_OUT,    /* pixels that show nothing else count alone */
    RIM_WHOLE        /* with what is around; and wherever no display was requested */
} RimCount;
