/* SPDX-License-Identifier: Apache-2.0 */
/* light_selection.h -- how often each set of lights is worth a sample, by parts of the scene.
 *
 * Before the first path a few points of every part are lit by every set, shadows included. A
 * set that gives a part little is then asked less often there, and counts more when it is: in
 * the sun a display is a candle, at night it is all there is. Each side of a part has its own
 * numbers: the sky that lights the outside of a wall is no reason to ask for it inside.
 *
 * Memory   from the arena. Threads: const after light_selection_build.
 */
#pragma once
#include "bvh/bvh.h"
#include "light/light.h"

typedef struct LightSelection {
    float (*prob)[LIGHT_SETS]; /* of sampling a set; rows 2 part (front) and 2 part + 1; 0: the
                                  set is empty */
    float *lx;                 /* by all sets together, one a row */
    float all[LIGHT_SETS];     /* where no part is known: 1 for every set that has lights */
} LightSelection;

/* The same for any number of threads and on every machine whose rays hit the same. */
LightSelection light_selection_build(const Scene *scene, const Bvh *bvh, const Lights *lights,
                                     Arena *arena);

/* Does the light sample arrive at a point that faces point.ns? */
bool light_selection_arrives(const Bvh *bvh, LitPoint point, const LightSample *light);

/* Illuminance, lx, by a sample that arrives; u in [0, 1) chooses the wavelengths. */
double light_selection_lx(const Lights *lights, LitPoint point, const LightSample *light,
                          float u);

/* part_id may be NO_ID. is_back: seen from the side that the triangle's normal points away
 * from. The row lives as long as the selection. */
static inline const float *light_selection_of_side(const LightSelection *selection, int part_id,
                                                   bool is_back)
{
    return part_id == NO_ID ? selection->all : selection->prob[2 * part_id + is_back];
}
