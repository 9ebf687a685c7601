/* SPDX-License-Identifier: Apache-2.0 */
/* eye_option.h -- --eye AGE[,PIGMENT]: a frame as it arrives on the retina
 * (vision/eye_filter.h), before it becomes a picture.
 *
 * Memory   the filtered frame's planes come from the arena.
 * Threads  one at a time; the filter has its own.
 * Fails    for a word that is no eye, a frame without R, G, B, and one whose field of view is
 *          not known: its metadata have it (parhelion:yfov_deg), else --fov has it.
 */
#pragma once
#include "image/frame.h"
#include "vision/human_eye.h"

typedef struct EyeOption {
    const char *words;   /* of --eye; NULL: not asked */
    double      fov_deg; /* of --fov: the display window's height as an angle; 0: not given */
    HumanEye    eye;     /* by eye_option_check */
} EyeOption;

/* Rows of an option table; `option` is an EyeOption *. */
#define EYE_OPTIONS(option)                                                                    \
    {"--eye", OPTION_TEXT, "AGE[,PIGMENT]",                                                    \
     "light spread as in the eye of somebody so old, iris 0 (dark) to 1.2 (light blue; "       \
     "default 0.5, brown), by the CIE's point spread",                                         \
     .out = &(option)->words},                                                                 \
    {"--fov", OPTION_NUMBER, "DEG",                                                            \
     "with --eye, of a frame that does not say it: the picture's height as an angle",          \
     .out = &(option)->fov_deg, .low = 0.01, .high = 170}

/* Before anything is read. */
bool eye_option_check(EyeOption *option, Error *err);

/* The frame with R, G, B filtered; other channels are shared with it. out may be the frame. */
bool eye_option_apply(const EyeOption *option, const FrameImage *frame, int threads,
                      Arena *arena, FrameImage *out, Error *err);

/* "light as in an eye of 50 years, pigment 0.5; of what lies in the frame". */
const char *eye_option_words(const EyeOption *option, Arena *arena);
