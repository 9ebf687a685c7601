/* SPDX-License-Identifier: Apache-2.0 */
/* guide_training.h -- trains a guide, cell by cell, on where light comes from.
 *
 * First the places where paths from the camera scatter make the tree, whose cells hold about as
 * many places each. Then, in rounds, light is looked for from some of the places of every cell
 * in all directions; what a round found guides the paths of the next. A cell's training pass is
 * one thread's, so that the threads decide nothing.
 *
 * Memory   from the arena.
 */
#pragma once
#include "base/arena.h"
#include "guide/guide.h"

typedef struct GuidePlace {
    Vec3 position, normal; /* just off a surface, on the normal's side; scene */
} GuidePlace;

#define GUIDE_POINTS 4 /* of a cell in a round */

/* Points of one cell that a round traces from, and what was found. */
typedef struct CellTraining {
    GuidePlace points[GUIDE_POINTS];
    int point_count;
    float *sums[GUIDE_AIMS]; /* of luminances, one a bin, over all rounds */
    uint32_t *counts;
} CellTraining;

typedef struct GuideTraining {
    LightGuide guide;
    GuidePlace *places;
    uint32_t *first_place; /* of every cell; and behind the last */
    CellTraining *cells;
} GuideTraining;

/* A guide that is not trained yet, over `count` places, which are put into another order. At
 * most `most` places a cell, unless they coincide; more where that would be more cells than
 * GUIDE_CELLS_MAX. */
GuideTraining *guide_training_start(GuidePlace *places, uint32_t count, uint32_t most,
                                    Arena *arena);

/* HOT. A ray of the cell's training pass into a bin found these luminances, cd m^-2. */
static inline void guide_training_add(const CellTraining *own, int bin,
                                      const float cd_m2[GUIDE_AIMS]) {
    for (int aim = 0; aim < GUIDE_AIMS; aim++) own->sums[aim][bin] += cd_m2[aim];
    own->counts[bin]++;
}

/* Chooses points of every cell for the round. */
void guide_training_choose(GuideTraining *training, int round);

/* Makes a cell of the guide of what its training passes and its neighbours' found so far.
 * Several threads may do so at once. */
void guide_training_update(GuideTraining *training, uint32_t cell);

/* Mean illuminance, lx, of the cell's points by what the training passes found, without the
 * sky. */
double guide_training_illuminance(const GuideTraining *training, uint32_t cell);
