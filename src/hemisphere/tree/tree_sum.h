/* SPDX-License-Identifier: Apache-2.0 */
/* tree_sum.h -- what a walk found in a tree, summed up. HOT.
 *
 * Threads  any number, on a constant Tree. Fails: never.
 */
#pragma once
#include "hemisphere/tree.h"

/* out[i] = component first + i, 0 <= i < count. */
void tree_sum(const Tree *tree, const TreeTaps *taps, int first, int count, float *out);
