/* SPDX-License-Identifier: Apache-2.0 */
/* panel_coarse.h -- a panel read at a coarser level of its trees, and how far off that is.
 *
 * Every level of a tree is a whole function of its own, so a panel can be asked at any of them;
 * the finest one is the panel itself, to the bit.
 *
 * Memory   scratch by value. Threads: nobody else may use the panel while it changes.
 */
#pragma once
#include <stdbool.h>

#include "base/arena.h"
#include "panel/query/panel.h"

/* Relative differences to the whole panel. Where the trees are of the vertex basis, max bounds
 * X, Y and Z of all codes from 1 on, and the BRDF at all wavelengths, at every direction, for
 * incidences up to the last measured one at measured azimuths: logarithms are linear between
 * vertices, and all vertices are asked. Of Haar trees the leaves' centres are asked, and max is
 * the largest found. rms is over the points that are asked: X, Y, Z of the primaries at code
 * 255; the BRDF of all tables at all measured wavelengths. */
typedef struct PanelCoarse {
    int    level;
    bool   has_emission, has_reflection;
    double emission_max, emission_rms;
    double reflection_max, reflection_rms;
} PanelCoarse;

/* The levels at which the panel can be read. Where two trees have different ranges, the level
 * of each is the nearest one in its own. */
void panel_coarse_range(const Panel *panel, int *least, int *most);

/* From now on all queries of values read the trees down to `level`, which is in the range; of
 * several spots too, and then the differences are the worst of theirs. */
void panel_coarsen(Panel *panel, int level, Arena scratch, PanelCoarse *out);
