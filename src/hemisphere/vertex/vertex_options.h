/* SPDX-License-Identifier: Apache-2.0 */
/* vertex_options.h -- how a function is to be compressed in the vertex basis.
 *
 * Memory   plain data. Threads: `accepts` is called by up to `threads` of them.
 */
#pragma once
#include "hemisphere/tree.h"
#include "hemisphere/vertex/vertex.h"

/* Is this reconstruction of a vertex good enough? reconstructed: `components` numbers. A
 * function of its arguments only. */
typedef bool VertexAccepts(const void *context, uint32_t vertex, const float *reconstructed);

typedef struct VertexTreeOptions {
    VertexLattice  lattice;    /* of the values */
    int            components; /* 1..TREE_MAX_COMPONENTS; the largest first pack best */
    VertexAccepts *accepts;
    const void    *context;
    /* The coarsest step that the coder may use for each component, in its own unit, where
     * that matters beyond `accepts`; NULL: it chooses. */
    const float   *coarsest_step;
    int            threads; /* 0 and 1: the caller's alone; the bytes do not depend on it */
} VertexTreeOptions;
