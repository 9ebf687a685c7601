/* SPDX-License-Identifier: Apache-2.0 */
/* tree_build.h -- compresses leaf values into a Haar tree's blob (hemisphere/tree.h).
 *
 * Memory   the blob from the arena, aligned to 16 bytes. Threads: pure functions.
 * Fails    on values that are not finite and on options out of range.
 */
#pragma once
#include "base/error.h"
#include "hemisphere/tree.h"

/* leaves: haar_leaf_count x components floats, finite. The blob is allocated from `arena`,
 * aligned to 16 bytes. Fails (ERROR_INPUT) on values that are not finite, on options out of
 * range, and when 16-bit rows cannot hold max_error. report may be NULL. */
bool tree_build(const TreeOptions *options, const float *leaves, Arena *arena,
                const void **blob, TreeReport *report, Error *err);
