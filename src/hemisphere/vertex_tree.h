/* vertex_tree.h -- compresses a vector-valued function on the hemisphere in the vertex basis.
 *
 * A vertex of level i+1 is new on an edge (u, w) of level i; its detail is f(v) - (f(u)+f(w))/2.
 * What a query reconstructs is the barycentric interpolation on the finest triangles:
 * continuous, and between the values of its vertices everywhere. Coded in a closed loop from
 * the top: every vertex is predicted from RECONSTRUCTED ends, and a detail is stored only where
 * the prediction is not accepted, so that no error adds up over levels.
 *
 * The blob is opened by tree_open and read by tree_query.h like a Haar tree's: TreeHeader's
 * basis says which one it is.
 */
#pragma once
#include "hemisphere/tree.h"
#include "hemisphere/vertex.h"

/* Is this reconstruction of a vertex good enough? reconstructed: `components` numbers. A
 * function of its arguments only. */
typedef bool VertexAccepts(const void *context, uint32_t vertex, const float *reconstructed);

typedef struct VertexTreeOptions {
    VertexLattice  lattice;    /* of the values */
    int            components; /* 1..TREE_MAX_COMPONENTS */
    VertexAccepts *accepts;
    const void    *context;
    /* What one component's rounding may cost in its own unit, where that matters beyond
     * `accepts`: the coarsest step that the coder may use; NULL: it chooses. */
    const float   *coarsest_step;
} VertexTreeOptions;

/* values: vertex_count(lattice) x components, finite. Fails (ERROR_INPUT) on values that are not
 * finite, and when a stored value cannot be made acceptable (named by its direction). */
bool vertex_tree_build(const VertexTreeOptions *options, const float *values, Arena *arena,
                       const void **blob, TreeReport *report, Error *err);
