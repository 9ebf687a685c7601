/* SPDX-License-Identifier: Apache-2.0 */
/* plot_answer.h -- the lines and contrasts that a user requested, as numbers.
 *
 * Units    degrees, lux, the charts' units. Threads: one at a time for a PlotData's arena.
 */
#pragma once
#include <jansson.h>

#include "plot/panel/plot_data.h"

/* "contours": one object for each chart and value, its lines as lists of [theta, phi];
 * "ambient": for each illuminance the reflectance and the contrast at a grid of angles. */
void plot_answer_add(const PlotData *data, PlotKind kind, json_t *answer);
