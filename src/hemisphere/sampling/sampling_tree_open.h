/* SPDX-License-Identifier: Apache-2.0 */
/* sampling_tree_open.h -- checks the blob of a sampling tree and expands it for queries.
 *
 * Memory   the arena's. Threads: pure functions. Fails: naming what is wrong.
 */
#pragma once
#include "base/error.h"
#include "hemisphere/sampling/sampling_tree.h"

/* Checks the blob and expands it. It may be freed afterwards; `geodesic` must stay. */
bool sampling_tree_open(const void *blob, size_t size, const Geodesic *geodesic, Arena *arena,
                        SamplingTree *out, Error *err);
