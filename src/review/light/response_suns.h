/* SPDX-License-Identifier: Apache-2.0 */
/* response_suns.h -- what the first vertex of a probe's paths sends of suns: exact for each, and
 * by the targets of an aim.
 *
 * Units    shares: response.h's.
 * Memory   from the arena.
 * Threads  starts its own; the same numbers for any count.
 */
#pragma once
#include "review/light/response.h"

/* Paths that find what an aim's mirror sends of a sun of that radius (radians) within 1 %,
 * wherever in its patches the sun's image lies; of patches that fill more than 0.3 sr, and of a
 * convex display, less closely. A target without a patch is in the image or not. */
#define RESPONSE_MIRROR_ERROR 0.01
int response_mirror_paths(const ProbeAim *aim, float radius);

/* Shares of the first vertex for suns, exact but for the mean over options' paths: [sun][band],
 * from the arena. */
const float *response_suns(const ProbeAim *aim, const ResponseOptions *options,
                           const ProbeSuns *suns, Arena *arena);

/* The same with what each of the aim's targets sends by itself: by_target[sun][target], the sum
 * over bands of shares times weights, with the same mean over targets as over options' paths,
 * of which every target has as many. */
const float *response_suns_by_target(const ProbeAim *aim, const ResponseOptions *options,
                                     const ProbeSuns *suns,
                                     const float weights[RESPONSE_BANDS], double *by_target,
                                     Arena *arena);
