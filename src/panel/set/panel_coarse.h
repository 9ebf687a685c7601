/* SPDX-License-Identifier: Apache-2.0 */
/* panel_coarse.h -- a panel read at a coarser level of its trees, and how far off that is.
 *
 * Every level of a tree is a whole function of its own, so a panel can be evaluated at any of
 * them; the finest one is the panel itself, to the bit. What is no tree stays as it is: the
 * smooth part of an emission, spectra, the mirror, and what
 * opening made of the whole panel (panel_sample, panel_pdf, albedos).
 *
 * Vertices A level of the vertex basis is no mean: it has the whole panel's values at the
 *          level's vertices, to rounding, and logarithms linear between them. What lies between
 *          is left out, be it a peak.
 * Memory   scratch by value. Threads: nobody else may use the panel while it changes.
 */
#pragma once
#include <stdbool.h>

#include "base/arena.h"
#include "panel/query/panel.h"
#include "panel/query/panel_open.h"

/* Of one tree: the level that it is read at, its own finest one, and relative differences to
 * the whole panel. Where the tree is of the vertex basis, max bounds X, Y and Z of all codes
 * from 1 on, and the BRDF at all wavelengths, at every direction, for incidences up to the last
 * measured one at measured azimuths: logarithms are linear between vertices, and all vertices
 * are evaluated. Of Haar trees the leaves' centres are evaluated, and max is the largest found.
 * rms is over the points that are evaluated, evenly over the tree's own triangles: X, Y, Z of
 * the primaries at code 255; the BRDF of all tables at all measured wavelengths. With several
 * spots both are the worst of theirs. */
typedef struct PanelCoarsePart {
    bool is_asked; /* and there; else the rest is 0 */
    int level, finest;
    double max, rms;
} PanelCoarsePart;

typedef struct PanelCoarse {
    int level; /* as it was requested; a tree that ends before is read whole */
    PanelCoarsePart emission, reflection;
} PanelCoarse;

/* How far a level, 0 to the finest, is off. parts: PANEL_COARSE_... */
void panel_coarse_compare(const Panel *panel, int level, unsigned parts, Arena scratch,
                          PanelCoarse *out);
