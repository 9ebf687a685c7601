/* SPDX-License-Identifier: Apache-2.0 */
/* light_selection.h -- how often each set of lights is worth a sample, by parts of the scene.
 *
 * Before the first path a few points of every part are lit by every set, shadows included. A
 * set that gives a part little is then sampled less often there, and counts more when it is: in
 * the sun a display is a candle, at night it is all there is. Each side of a part has its own
 * numbers: the sky that lights the outside of a wall is no reason to sample it inside.
 *
 * Memory   from the arena. Threads: const after light_selection_build.
 */
#pragma once
#include "sunlit/sunlit_land.h"
#include "surface/plates.h"
#include "sunlit/sunlit_map.h"

typedef struct LightSelection {
    float (*prob)[LIGHT_CHOICES]; /* of sampling one; rows 2 part (front), 2 part + 1; 0: the
                                  set is empty */
    float *lx;                    /* by all sets together, one a row */
    float all[LIGHT_CHOICES];     /* where no part is known: 1 for every set that has lights */
    float sky_cd_m2;              /* the sky's mean: what it makes of a white plane that faces up */
} LightSelection;

/* The same for any number of threads and on every machine whose rays hit the same. */
LightSelection light_selection_build(const SunlitTools *tools, const SunlitMap *sunlit,
                                     const PlateView *plates, Arena *arena);

/* Does the light sample arrive at a point that faces point.ns? Of a lamp behind plates, about. */
bool light_selection_arrives(const PlateView *plates, LitPoint point, const LightSample *light);

/* part_id may be NO_ID. is_back: seen from the side that the triangle's normal points away
 * from. The row lives as long as the selection. */
static inline const float *light_selection_of_side(const LightSelection *selection, int part_id,
                                                   bool is_back) {
    return part_id == NO_ID ? selection->all : selection->prob[2 * part_id + is_back];
}
