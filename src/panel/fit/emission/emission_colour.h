/* SPDX-License-Identifier: Apache-2.0 */
/* emission_colour.h -- between samples an emission has no colour that its neighbours lack.
 *
 * A surface through logarithms may pass beyond its samples, and where the channels of a
 * direction do so by different amounts, a white turns blue. Here the ratio of every channel to
 * the brightest Y is held to the range that the samples around the direction span (the ends of
 * its interval of rings and of azimuths), with COLOUR_SIGMAS of their noise and widened at
 * either end by COLOUR_SHARE of itself, at least by COLOUR_LEAST: so far a smooth curve through
 * samples passes beyond a turning point between two of them. Where a ratio leaves its range,
 * those of all channels move together, on the line to their linear interpolation, as far as is
 * necessary; the brightest Y stays what it was. Beyond the last ring nothing is held.
 *
 * Units    as emission_model.h. Memory: the arena's. Threads: const once made. Fails: never.
 */
#pragma once
#include "panel/fit/common/direction_grid.h"
#include "panel/fit/emission/emission_model.h"

#define COLOUR_SIGMAS 6.0f /* of a hundred channels and thousands of samples */
#define COLOUR_SHARE 0.125f
#define COLOUR_LEAST 0.005f

typedef struct EmissionColour {
    const EmissionModel *model;
    DirectionGrid grid;
    int bright;   /* the channel of Y that has the largest value */
    float *ratio; /* rows x channels: ln of a channel's E over the bright one's */
    float *slack; /* rows x channels */
    float *raise; /* components: by 1 they raise the logarithms of all channels by about 1,
                     the bright one's exactly */
} EmissionColour;

void emission_colour_make(const EmissionModel *model, Arena *arena, EmissionColour *out);

/* Holds the components of a direction, smooth part and all (PANEL_COMPONENTS_MAX floats). */
void emission_colour_hold(const EmissionColour *colour, Vec3 direction, float *components);
