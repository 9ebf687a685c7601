/* SPDX-License-Identifier: Apache-2.0 */
/* glare_field.h -- the sources of glare that have no light samples of their own: sky in
 * windows, sunlit surfaces, and what is mirrored; and the background.
 *
 * A picture of the half space in front of the eye: equidistant, a ray a pixel. What a ray shows
 * without noise (glare_field_tells) is taken from it; all else from GlareRest. Where a small
 * source ends, pixels are looked at again, 64 rays each. Pixels that touch one another, by a
 * corner at least, are one source.
 *
 * Approximate  what is narrower than a pixel may be missed, unless it is a light by itself.
 * Threads      starts its own; the same figures for any count.
 */
#pragma once
#include "review/eye/glare_table.h"
#include "review/light/setup.h"

/* Sky that is seen straight or through panes, and what the sun sends by one scattering surface
 * that is seen so. */
bool glare_field_tells(const PathHistory *history);

typedef struct GlareFieldArgs {
    const Setup     *setup;
    const GlareRest *rest;
    GlarePaths       found; /* what glare_field_tells of paths: they find what rays miss */
    double threshold_cd_m2;
    double peak_cd_m2;      /* sky that is brighter counts by light samples: it is left out */
    int    pixels;          /* over 180 degrees */
    uint32_t seed;
} GlareFieldArgs;

/* Adds the sources; *background_lx: light from all else, what the rays show and the rest. */
typedef struct GlareBackground {
    double told_lx[GLARE_GROUPS]; /* they add up to it */
    double rest_lx;
} GlareBackground;

void glare_field_add(const GlareFieldArgs *args, GlareTable *table, GlareBackground *background,
                     Arena *arena);
