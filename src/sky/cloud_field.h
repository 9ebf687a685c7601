/* SPDX-License-Identifier: Apache-2.0 */
/* cloud_field.h -- the tops of a cloud deck as a height field under a light: heights, and how
 * brightly each place is lit, on a square that repeats.
 *
 * The field is synthetic: puffs (domes around jittered points of a lattice, Worley 1996) of
 * three sizes on swells of gradient noise (Perlin 1985), with our own hash, stretched a little
 * along one direction as cloud streets are. It is a picture's relief: no weather was measured.
 * A place's light is that of a matte slope, softened because light travels inside a cloud, less
 * the shadow of what stands towards the light, less what creases and thin cloud lose.
 *
 * Frame     x east, y north, metres from the observer's foot; azimuth from north over east.
 * Units     heights in metres over their mean, shades relative: their mean is 1.
 * Memory    the arena's, 45 MB. Threads: const once built, the same for any number of them.
 * Fails     never.
 */
#pragma once
#include "base/arena.h"

#define CLOUD_FIELD_SIZE 2048 /* texels a side of the finest level */
#define CLOUD_FIELD_TEXEL_M 60.0f
#define CLOUD_FIELD_LEVELS 10 /* each half as fine as the one before */

typedef struct CloudSample {
    float height, shade;
} CloudSample;

typedef struct CloudFieldInput {
    double relief_m;           /* from hollows to tops: four standard deviations of the height */
    double azimuth, elevation; /* of the light, radians; below the horizontal: its glow */
    int threads;
} CloudFieldInput;

typedef struct CloudField {
    CloudSample *level[CLOUD_FIELD_LEVELS];
} CloudField;

void cloud_field_build(const CloudFieldInput *input, Arena *arena, CloudField *out);

/* At a place, averaged over about the width of a texel of a level (0: the finest). */
CloudSample cloud_field_at(const CloudField *field, float x_m, float y_m, float level);
