/* SPDX-License-Identifier: Apache-2.0 */
/* cell_lights.h -- how often a guide's cells ask each set of lights.
 *
 * Once a cell knows from where light comes, points of it are lit by one sample of every set, as
 * paths will be. What these find, less what chance finds as well, decides.
 *
 * Threads  one cell's sums belong to one thread.
 */
#pragma once
#include "path/cell_lamps.h"
#include "path/guiding.h"

/* Sums of what light samples find at the points of a cell. */
typedef struct LightFinds {
    double sum[LIGHT_SETS], squares[LIGHT_SETS]; /* illuminances, lx */
    double points;
    LampFinds lamps;
} LightFinds;

/* One sample of every set for a white point of the cell that faces point.ns. */
void cell_lights_try(const PathContext *context, LitPoint point, uint32_t cell,
                     Sampler *sampler, LightFinds *finds);

/* Probabilities for a cell that gets `total` lx in all. */
void cell_lights_weigh(const Lights *lights, const LightFinds *finds, double total,
                       float prob[LIGHT_SETS]);
