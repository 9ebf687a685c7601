/* SPDX-License-Identifier: Apache-2.0 */
/* emission_smooth.h -- the smooth part of an emission's components: cubic B-splines in theta
 * times harmonics of the azimuth (panel_spline.h). */
#pragma once
#include "panel/fit/emission/emission_model.h"

/* Fits the scores less the beams, into the model. False: it cannot be stored. */
bool emission_smooth_fit(EmissionModel *model, Arena *arena);

/* No smooth part. False: that cannot be stored. */
bool emission_smooth_clear(EmissionModel *model, Arena *arena);
