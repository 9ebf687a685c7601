/* SPDX-License-Identifier: Apache-2.0 */
/* html_pictures.h -- the pictures of a report: both sides and the maps of their difference,
 * each with its scale; private to the report.
 *
 * Memory   pictures come from the arena that is passed in. Threads: pure.
 */
#pragma once
#include "compare/comparison.h"
#include "image/picture.h"
#include "text/text.h"

typedef enum ShotKind {
    SHOT_REFERENCE,
    SHOT_TEST,
    SHOT_DIFFERENCE,
    SHOT_BLOCKS,
    SHOT_P_VALUE,
    SHOT_FLIP,
    SHOT_DELTAE,
    SHOT_COUNT
} ShotKind;

/* The colour scale of a map: low at the left end of the ramp, high at the right. */
typedef struct ShotScale {
    bool is_signed; /* the ramp with a neutral middle */
    double low, high;
    const char *unit;     /* "" none */
    const char *ticks[5]; /* evenly spaced along the ramp */
    const char *also;     /* the same scale in another unit; NULL: none */
} ShotScale;

typedef struct Shot {
    ShotKind kind;
    const char *title, *caption;
    bool has_scale;
    ShotScale scale;
    Picture picture;
} Shot;

/* False when this comparison has no such picture. factor: this many pixels along a side become
 * one, so that a report stays small: light is averaged, of a map the greatest value stays. */
bool shot_make(const Comparison *c, ShotKind kind, int factor, Arena *arena, Shot *out);

/* So that no more than `most` pixels are left. */
int shot_factor(const Planes *planes, long most);

/* A small picture of one side (SHOT_REFERENCE, SHOT_TEST), at most `side` pixels wide. */
Picture shot_thumbnail(const Comparison *c, ShotKind kind, int side, Arena *arena);

/* The colours of a ramp from left to right, as "rrggbb" 256 times. */
void shot_ramp_digits(Text *text, bool is_signed);

/* The stops of a ramp as a gradient of CSS: ",#rrggbb,...". */
void shot_ramp_gradient(Text *html, bool is_signed);
