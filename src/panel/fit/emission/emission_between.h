/* SPDX-License-Identifier: Apache-2.0 */
/* emission_between.h -- between samples an emission stays between its neighbours.
 *
 * Colour    A surface through logarithms may pass beyond its samples, and where the channels of
 *           a direction do so by different amounts, a white turns blue. The ratio of every
 *           channel to the brightest Y is held to the range that the samples around the
 *           direction span (the ends of its interval of rings and of azimuths), with
 *           BETWEEN_SIGMAS of their noise and widened at either end by BETWEEN_SHARE of itself,
 *           at least by BETWEEN_LEAST: so far a smooth curve through samples passes beyond a
 *           turning point between two of them. Where a ratio leaves its range, those of all
 *           channels move together, on the line to their linear interpolation, as far as is
 *           necessary; the brightest Y stays what it was.
 * Edges     Where the light jumps between two samples of a grid (a cut-off), the surface rings
 *           beside the jump, and what its logarithm says there is many times too bright. Then
 *           light and colour are the samples' linear interpolation everywhere. Where between
 *           two samples the edge stands nobody knows.
 *
 * Beyond the last ring nothing is held.
 *
 * Units    as emission_model.h. Memory: the arena's. Threads: const once made. Fails: never.
 */
#pragma once
#include "panel/fit/common/direction_grid.h"
#include "panel/fit/emission/emission_model.h"

#define BETWEEN_SIGMAS 6.0f /* of a hundred channels and thousands of samples */
#define BETWEEN_SHARE 0.125f
#define BETWEEN_LEAST 0.005f

typedef struct EmissionBetween {
    const EmissionModel *model;
    DirectionGrid grid;
    int bright;   /* the channel of Y that has the largest value */
    float *light; /* rows: ln E of the bright channel */
    float *ratio; /* rows x channels: ln of a channel's E over the bright one's */
    float *slack; /* rows x channels */
    float *raise; /* components: by 1 they raise the logarithms of all channels by about 1,
                     the bright one's exactly */
} EmissionBetween;

void emission_between_make(const EmissionModel *model, Arena *arena, EmissionBetween *out);

/* Holds the components of a direction, smooth part and all (PANEL_COMPONENTS_MAX floats). */
void emission_between_hold(const EmissionBetween *between, Vec3 direction, float *components);
