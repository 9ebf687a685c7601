/* SPDX-License-Identifier: Apache-2.0 */
/* emission_gaps.h -- what a panel may miss of an emission between samples that are no grid.
 *
 * Asked of the brightest channel.
 * Memory   scratch. Threads: pure functions. Fails: never.
 */
#pragma once
#include "panel/fit/common/scatter_gaps.h"
#include "panel/fit/emission/emission_model.h"

/* tree_bytes: of what the smooth part leaves. */
ScatterGaps emission_gaps_find(const EmissionModel *model, const void *tree_bytes, int level,
                               Arena scratch);
