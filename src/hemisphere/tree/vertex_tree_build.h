/* SPDX-License-Identifier: Apache-2.0 */
/* vertex_tree_build.h -- compresses values at the vertices of a lattice (vertex_tree.h).
 *
 * Memory   the blob from the arena. Threads: as many as the options allow.
 */
#pragma once
#include "base/error.h"
#include "hemisphere/tree/vertex_tree.h"

/* values: vertex_count(lattice) x components, finite. Fails (ERROR_INPUT) on values that are
 * not finite, and when a stored value cannot be made acceptable (named by its direction): the
 * least step is a 30,000th of the largest value. The report's errors are over vertices, every
 * component by itself; leaves counts vertices. */
bool vertex_tree_build(const VertexTreeOptions *options, const float *values, Arena *arena,
                       const void **blob, TreeReport *report, Error *err);
