/* SPDX-License-Identifier: Apache-2.0 */
/* reflection_tree.h -- the reflection's tree, and whether it is good enough at every place and
 * measured sample. */
#pragma once
#include "panel/fit/reflection/reflection_model.h"

typedef struct ReflectionMisses {
    int    samples, misses; /* samples beyond their bound */
    double worst;           /* largest error over its bound */
} ReflectionMisses;

/* The tree; what samples and places miss by is corrected as far as the level lets it be. */
bool reflection_tree_build(ReflectionModel *model, ReflectionMisses *misses, Error *err);
