/* SPDX-License-Identifier: Apache-2.0 */
/* emission_draw.h -- directions drawn as a display shines: luminance times the cosine.
 *
 * One tree of cells with a density for each of the four sources (the primaries at code 255,
 * and black). Codes mix them by their mean luminance. How light falls with the angle may
 * depend on the code: then the density is near to the light, not proportional to it. The file's
 * own panel counts, at every place.
 *
 * Units    densities in sr^-1, the frame of panel.h.
 * Memory   the arena's. Threads: constant after making it.
 */
#pragma once
#include "hemisphere/tree/sampling_tree.h"
#include "panel/query/panel.h"

typedef struct EmissionDraw {
    SamplingTree tree; /* no functions: nothing is emitted */
} EmissionDraw;

bool emission_draw_make(const Panel *panel, Arena *arena, EmissionDraw *out, Error *err);

/* u in [0, 1)^3. False: there is no direction, nothing is emitted with these codes. *pdf: as
 * emission_draw_pdf says, to the bit. */
bool emission_draw_sample(const EmissionDraw *draw, const Panel *panel, const float code[3],
                          const float u[3], Vec3 *direction, float *pdf);

/* 0 below the surface, and with codes that emit nothing; else it integrates to 1. */
float emission_draw_pdf(const EmissionDraw *draw, const Panel *panel, const float code[3],
                        Vec3 direction);
