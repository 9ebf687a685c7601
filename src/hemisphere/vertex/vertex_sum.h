/* SPDX-License-Identifier: Apache-2.0 */
/* vertex_sum.h -- what a walk found in a vertex tree, summed up; what tree_sum calls. HOT.
 *
 * Threads  any number, on a constant Tree. Fails: never.
 */
#pragma once
#include "hemisphere/vertex/vertex_tree.h"

/* HOT. tree_sum. */
void vertex_tree_sum(const Tree *tree, const TreeTaps *taps, int first, int count, float *out);
