/* SPDX-License-Identifier: Apache-2.0 */
/* emitter_tree.h -- gathers the cells of emitters into a tree. Private to src/light. */
#pragma once
#include "light/emitters.h"

/* weight: luminance x area of every cell, the sum above 0. Fills the tree and cells' ranks. */
void emitter_tree_build(const Scene *scene, const double *weight, Arena *arena, Emitters *emitters);
