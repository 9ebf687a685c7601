/* SPDX-License-Identifier: Apache-2.0 */
/* emission_tree.h -- the tree of what the smooth part leaves of an emission.
 *
 * Values at the vertices of triangles come from the surface through the samples' rest
 * (scatter_surface.h), in any layout; they are corrected until triangles meet the samples, held
 * to the colours of the samples around, and coded so that every channel of every table keeps
 * the tolerance at every sample that it can hold at. Triangles become finer while that helps.
 *
 * Memory   the arena's. Threads: options->threads; the bytes do not depend on how many.
 * Fails    with what the coder cannot store (ERROR_INPUT).
 */
#pragma once
#include "base/error.h"
#include "hemisphere/tree.h"
#include "panel/fit/common/fit_options.h"
#include "panel/fit/emission/emission_model.h"

typedef struct EmissionTree {
    const void *bytes; /* as in the file */
    TreeReport report;
    int level;
    int missed; /* samples beyond tolerance and noise */
} EmissionTree;

bool emission_tree_build(const EmissionModel *model, const FitOptions *options, Arena *arena,
                         EmissionTree *out, Error *err);

/* Components of the coded tree and the smooth part at a direction (PANEL_COMPONENTS_MAX
 * floats). */
void emission_tree_components(const EmissionModel *model, const Tree *tree, Vec3 direction,
                              float *components);
