/* SPDX-License-Identifier: Apache-2.0 */
/* emission_tree.h -- the tree of what the smooth part leaves of an emission, coded so that the
 * tolerance holds at every sample that it can hold at.
 *
 * Memory   the arena's. Threads: options->threads; the bytes do not depend on how many.
 * Fails    with what the coder cannot store (ERROR_INPUT).
 */
#pragma once
#include "panel/fit/emission/emission_coder.h"

/* Where triangles miss the samples by far the model gets beams. */
bool emission_tree_build(EmissionModel *model, const FitOptions *options, Arena *arena,
                         EmissionTree *out, Error *err);
