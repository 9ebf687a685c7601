/* SPDX-License-Identifier: Apache-2.0 */
/* legibility.h -- how well a display can be read, pixel by pixel, from one frame.
 *
 * All figures follow from what a frame keeps of its displays (frame.h): what the panel would
 * send to the eye there in full white and in black, what it shows, and what it reflects. With
 * W, K, S, R for the luminances of these:
 *   ambient contrast ratio  (W + R) / (K + R)
 *   Weber contrast          (W - K) / (K + R), the ratio less one
 *   Michelson contrast      (W - K) / (W + K + 2 R)
 *   error of luminance      R / S: (seen - shown) / shown, where seen is shown + reflected
 *   error of colour         distance in CIE 1976 u', v' of seen from shown
 *
 * Units    light in cd m^-2; the figures are plain numbers.
 * Values   without reflections the errors are 0 and the contrast is the panel's own; the error
 *          of luminance is infinite where nothing is shown, that of colour NaN, and all are NaN
 *          off displays.
 * Memory   planes come from the arena.  Threads  pure functions.
 */
#pragma once
#include "image/frame.h"

/* The light that a display sends to the eye, cd m^-2. */
typedef struct DisplayLight {
    double white, black;          /* luminances */
    double shown[3], reflected[3]; /* XYZ */
} DisplayLight;

double legibility_contrast(const DisplayLight *light);
double legibility_weber(const DisplayLight *light);
double legibility_michelson(const DisplayLight *light);
double legibility_luminance_error(const DisplayLight *light);
double legibility_colour_error(const DisplayLight *light);

/* A layer that a frame need not hold, since it follows from others. */
typedef struct LegibilityLayer {
    const char *name; /* "display.weber" */
    double    (*figure)(const DisplayLight *light);
    const char *from[4]; /* layers; NULL behind the last */
    const char *unit;    /* as stroke_font.h writes it */
    bool        is_log;
} LegibilityLayer;

/* NULL: it is none. */
const LegibilityLayer *legibility_layer(const char *name);

/* ", display.weber, ...": those that the frame does not hold, but that follow from what it
 * holds; "" when there are none. */
const char *legibility_names(const FrameImage *frame, Arena *arena);

/* One number for each pixel of the data window; NULL, with a text that names what is missing,
 * when the frame lacks a layer. */
const float *legibility_plane(const FrameImage *frame, const LegibilityLayer *layer,
                              Arena *arena, Error *err);
