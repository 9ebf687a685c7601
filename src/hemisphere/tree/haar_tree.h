/* SPDX-License-Identifier: Apache-2.0 */
/* haar_tree.h -- leaf values to a compressed tree of the Haar basis: transform (haar.h), the
 * details of the largest normalised size stay, one blob (tree.h). Opened and read like any tree
 * (tree_open.h, tree_query.h).
 *
 * Memory   the blob takes the arena's memory, also for work; it is shrunk at the end.
 * Threads  pure. Fails: ERROR_INPUT with what is found and required.
 */
#pragma once
#include "base/error.h"
#include "hemisphere/tree/haar.h"
#include "hemisphere/tree.h"

/* Lossless: keep_share 1 and TREE_ROWS_FLOAT; leaves come back to the rounding of float32. */
typedef struct HaarTreeOptions {
    HaarShape shape;
    float keep_share;             /* stored rows (octant means included) over leaves, (0, 1] */
    const float *component_scale; /* what a component's error is worth; NULL: all 1 */
    TreeRowFormat rows;
} HaarTreeOptions;

/* leaves: haar_leaf_count x components. report may be NULL. */
bool haar_tree_build(const HaarTreeOptions *options, const float *leaves, Arena *arena,
                     const void **blob, TreeReport *report, Error *err);
