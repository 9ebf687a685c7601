/* SPDX-License-Identifier: Apache-2.0 */
/* emission_gaps.h -- what a panel may miss of an emission between samples that are no grid.
 *
 * Of the brightest channel.
 * Memory   scratch. Threads: pure functions. Fails: with a tree that cannot be opened.
 */
#pragma once
#include "panel/fit/common/scatter_gaps.h"
#include "panel/fit/emission/emission_coder.h"

/* tree: of what the smooth part leaves. */
bool emission_gaps_find(const EmissionModel *model, const EmissionTree *tree, Arena scratch,
                        ScatterGaps *out, Error *err);
