/* SPDX-License-Identifier: Apache-2.0 */
/* sampling_make.h -- the sampling section that follows from queries of a panel's reflection: at
 * which incidences and azimuths a tree of directions is required, and the tree. Private to
 * src/panel.
 *
 * The same bytes on every machine. Some milliseconds for each incidence and azimuth. Where the
 * section would be too much of the file it is made when the file is opened: of several azimuths
 * a coarse one, whose weights vary by some percent more, in a fifth of the time.
 * Memory    the section's bytes in the arena.
 * Fails     as sampling_tree_build.
 */
#pragma once
#include <stdbool.h>
#include <stddef.h>

#include "base/arena.h"
#include "base/error.h"
#include "panel/query/panel.h"

#define SAMPLING_MADE_LEVEL 6

typedef struct SamplingSection {
    const void *bytes;
    size_t size;
    int incidences, azimuths;
} SamplingSection;

/* panel: its reflection can be queried, its sampling need not be there. */
bool sampling_make(const Panel *panel, bool is_coarse, Arena *arena, SamplingSection *out,
                   Error *err);
