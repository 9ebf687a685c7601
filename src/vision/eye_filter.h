/* SPDX-License-Identifier: Apache-2.0 */
/* eye_filter.h -- a picture as it arrives on the retina: every pixel's light spread over the
 * others by the CIE's point spread (vision/eye_spread.h), by true angles.
 *
 *     out(p) = L(p) + sum over s of f(angle of p and s) w(s) (L(s) - L(p))
 *
 * f is the published spread, averaged over pixel p; w(s) pixel s's solid angle. So the veil of
 * a light is the published one, for the lux that it brings to a surface that faces it; a gaze
 * (review/eye/eye_reading.h) has the same f, and counts the lux of the pupil that looks
 * there, smaller by the cosine of the angle.
 *
 * What a pixel sends to the others is taken off its own light; what leaves the picture towards
 * where nothing is known stays where it came from: as if beyond the border it were as bright as
 * each pixel is itself. So no light is made or lost (the sum of out w is that of L w) and an
 * even picture stays even up to its border. What the published function has above one (3 to 17
 * %, eye_spread.h) is missing from the light that stays in its pixel, not from the veil. Where
 * pixels are so fine (some 0.004 degrees, old light eyes) that more than all would leave, a
 * pixel sends all it has: that surplus alone, a few per cent, is gained. Only what the picture
 * sees is spread: a sun outside it veils nothing.
 *
 * A perspective picture's pixels are not alike: the same number of them is another angle at the
 * border. The sum over s is one convolution for each of some places in the picture, from which
 * every pixel's share is interpolated (eye_filter.c); the error stated in
 * tests/unit/test_eye_filter.c is below 0.5 % of the spread for views up to 120 degrees wide.
 *
 * Units    cd m^-2 in each channel.
 * Layout   planes of width * height, row 0 at the top.
 * Memory   scratch: 72 bytes a pixel of a picture twice as wide and high, of two layers 120.
 * Threads  `threads` share the work; the same bits for any number of them.
 * Fails    when memory is out.
 */
#pragma once
#include "base/arena.h"
#include "vision/human_eye.h"

typedef struct EyeView {
    int width, height;     /* pixels of the planes */
    double axis_x, axis_y; /* where the camera looks, in pixels from the planes' upper left
                              corner; may lie outside of them */
    double pixel;          /* side of a square pixel on a plane at distance 1 */
} EyeView;

typedef struct EyeFilter {
    EyeView view;
    HumanEye eye;
    int threads; /* at least 1 */
} EyeFilter;

/* A picture, and where it goes as the eye has it; these must not overlap. */
typedef struct EyeLayer {
    const float *rgb[3];
    float *out[3];
} EyeLayer;

/* Layers of one view, count: at least 1, take less time together. A pixel with a value that is
 * not finite in any of them spreads nothing and stays as it is. */
bool eye_filter(const EyeFilter *filter, const EyeLayer *layers, int count, Arena scratch,
                Error *err);
