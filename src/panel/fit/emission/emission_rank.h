/* SPDX-License-Identifier: Apache-2.0 */
/* emission_rank.h -- few components for all tables of an emission.
 *
 * With E = M less the black pattern (or the black pattern itself),
 *     ln E[channel] = mean[channel] + fall + sum over k of loading[channel][k] score[row][k],
 * fall = cosine_power ln cos theta.
 * Memory   the arena's. Threads: one fit at a time. Fails: never.
 */
#pragma once
#include "base/vec.h"
#include "panel/fit/emission/emission_samples.h"

typedef struct EmissionRank {
    int components;
    float cosine_power;
    float *mean, *loading; /* channels; channels x components */
    float *score;          /* rows x components, variance about 1 */
    float *belief;         /* rows: weight of a row's scores, 0..1 */
    double worst;          /* |M - model| / M beyond the noise, at the worst sample */
} EmissionRank;

void emission_rank_find(const EmissionSamples *samples, Arena *arena, EmissionRank *out);

/* ln E of all channels from components; fall included. */
void emission_rank_logs(const EmissionRank *rank, int channels, const float *components, float fall,
                        float *logs);

/* cosine_power ln cos theta as queries have it. */
float emission_rank_fall(float cosine_power, Vec3 direction);
