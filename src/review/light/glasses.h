/* SPDX-License-Identifier: Apache-2.0 */
/* glasses.h -- sunglasses between an eye and all that it sees.
 *
 * They make all light darker by one factor, the luminous transmittance of ISO 12312-1 (of D65,
 * by the eye's V), which no contrast feels. Their colour and a polariser weigh one light more
 * than another: these are parted from that factor. Of unpolarised daylight they let through as
 * much as of any.
 *
 * Polariser  light that oscillates along its axis comes through E times as much as across it;
 *            the axis is given from upright towards the eye's right, the head upright.
 * Memory     the arena's. Threads: pure functions.
 */
#pragma once
#include "path/polarised.h"
#include "review/request/request.h"

typedef struct Glasses {
    double transmittance;          /* luminous; 1: none are worn */
    const Curve *colour;           /* transmittance at each wavelength over that; NULL: 1 */
    const PolarisedEye *polariser; /* mean over all directions 1; NULL: none */
    const char *words;             /* as the request has them; NULL: none */
} Glasses;

/* As the condition has them, on an eye that looks along `towards`. */
Glasses glasses_worn(const ReviewCondition *condition, Vec3 towards, Arena *arena);

/* Of D65, by V. */
double glasses_luminous(const Curve *transmittance);
