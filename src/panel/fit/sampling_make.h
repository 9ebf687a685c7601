/* SPDX-License-Identifier: Apache-2.0 */
/* sampling_make.h -- the sampling section that follows from queries of a panel's reflection: at
 * which incidences and azimuths a tree of directions is required, and the tree.
 *
 * The same bytes on every machine. Some milliseconds for each incidence and azimuth.
 * Memory    the section's bytes in the arena.
 * Fails     as sampling_tree_build.
 */
#pragma once
#include <stdbool.h>
#include <stddef.h>

#include "base/arena.h"
#include "base/error.h"
#include "panel/query/panel.h"

typedef struct SamplingSection {
    const void *bytes;
    size_t size;
    int incidences, azimuths;
} SamplingSection;

/* panel: its reflection can be queried, its sampling need not be there. */
bool sampling_make(const Panel *panel, Arena *arena, SamplingSection *out, Error *err);
