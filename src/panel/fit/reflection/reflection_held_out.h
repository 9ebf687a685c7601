/* SPDX-License-Identifier: Apache-2.0 */
/* reflection_held_out.h -- rows near the mirror direction, where a table is steep, left out and
 * predicted from the others.
 *
 * Every second ring is left out, then every second azimuth, each both ways; what is left is
 * read as the fit reads tables: a cubic, whose error falls with the third power of the step. Of
 * a table with a guide a quarter of the rows near the mirror direction is left out, four ways,
 * and the guide is fitted anew without them. Of scattered rows none is left out, but the gaps
 * between them are judged. Rows under the mirror's image do not count: the
 * fit made them.
 * Memory   scratch. Threads: pure functions. Fails: never.
 */
#pragma once
#include "panel/fit/common/scatter_gaps.h"
#include "panel/fit/reflection/reflection_model.h"

/* The row that is missed most. */
typedef struct HeldOut {
    double error;      /* relative, beside the noise, of rows left out */
    double estimate;   /* between the rows with none left out */
    double theta, phi; /* radians, in the table's frame */
    bool is_scattered; /* no grid: none of the above, but gaps */
    ScatterGaps gaps;
    ScatterDoubt mirror; /* of the surface in the mirror direction */
} HeldOut;

HeldOut reflection_held_out(const ReflectionModel *model, int table, Arena scratch);

/* What one table's samples show in the mirror direction may lie in another one's gap there. */
void reflection_held_out_peaks(const ReflectionModel *model, HeldOut *held_out);

/* The largest share of a table's light that its two neighbours in the light's azimuth miss, so
 * that it is interpolated over twice the step; 0 of an isotropic set. */
double reflection_held_out_azimuths(const ReflectionModel *model);
