/* SPDX-License-Identifier: Apache-2.0 */
/* false_colour.h -- shows numbers as colours, with the scale drawn beside the picture.
 *
 * Units    the numbers' own; their unit stands above the scale.
 * Memory   pictures come from the arena that is passed in.
 * Threads  pure functions.
 */
#pragma once
#include "image/picture.h"

/* The colour for t in [0, 1] as sRGB codes: lightness (CIE L*) rises evenly from 8 to 96 while
 * the hue runs evenly from teal over blue, purple and red to yellow, so that order can be seen
 * even without colour vision. Hue and chroma are those of OKLab (Ottosson 2020, "A perceptual
 * color space for image processing"), chroma as much of 0.2 as sRGB can show. */
void false_colour_of(float t, float srgb[3]);

typedef struct ScaleRange {
    float low, high; /* low < high; both above 0 when logarithmic */
    bool is_log;
} ScaleRange;

/* A range with round ends that holds nearly all the finite values: logarithmic from the 5th
 * to the 99.9th percentile of those above zero (two to six decades), linear from the least to
 * the 99.9th. */
ScaleRange scale_range_of(const float *values, size_t count, bool is_log, Arena scratch);

/* Where a value stands on the scale, 0 .. 1 and cut off there. */
float scale_position(ScaleRange range, float value);

/* values: width x height, row 0 at the top; what is not a number (NaN) stays dark grey. The
 * picture is wider than the values by the scale at its right. unit: as stroke_font.h can write
 * it, "cd/m^2". */
Picture false_colour_picture(const float *values, int width, int height, ScaleRange range,
                             const char *unit, Arena *arena);
