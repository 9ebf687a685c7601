/* SPDX-License-Identifier: Apache-2.0 */
/* sampling_tree_build.h -- makes the blob of a sampling tree, and opens one.
 *
 * Memory   the arena's. Threads: pure functions. Fails: naming what is wrong.
 */
#pragma once
#include "base/error.h"
#include "hemisphere/tree/sampling_tree.h"

typedef struct SamplingOptions {
    int level;           /* of the leaf integrals */
    int octants;         /* 4, or 2: mirror-symmetric in y, sampled over all 4 */
    int functions;       /* 1..SAMPLING_FUNCTIONS_MAX */
    int cells;           /* at most this many cells (of the octants stored), at least `octants` */
    float variance;      /* fewer cells where no function's weights vary more than this, relative
                            to their squared mean; 0: all that `cells` allows */
    float uniform_share; /* part of the samples that ignores the function, [0, 1]: makes the
                            density positive everywhere; 0: only where the integral is */
} SamplingOptions;

/* integrals: functions * octants * 4^level values >= 0, the integral over each leaf (f * cos *
 * Jacobian * area), scaled as one likes. Splits the cells in which the functions' square roots
 * vary most. Fails (ERROR_INPUT) on negative or non-finite values and on a function of 0. */
bool sampling_tree_build(const SamplingOptions *options, const float *integrals, Arena *arena,
                         const void **blob, Error *err);

/* Bytes of a blob that sampling_tree_build made. */
size_t sampling_tree_size(const void *blob);

/* Checks the blob and expands it. It may be freed afterwards; `geodesic` must stay. */
bool sampling_tree_open(const void *blob, size_t size, const Geodesic *geodesic, Arena *arena,
                        SamplingTree *out, Error *err);
