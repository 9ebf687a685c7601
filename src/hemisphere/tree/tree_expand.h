/* tree_expand.h -- a whole tree at once, by another way than queries go: what they are held to.
 *
 * Memory   scratch by value. Threads: pure functions. Fails: never.
 */
#pragma once
#include "hemisphere/tree.h"

/* Inverts the whole tree: haar_leaf_count x components floats (of a vertex tree: its values at
 * the leaves' centres). */
void tree_expand(const Tree *tree, float *leaves, Arena scratch);
