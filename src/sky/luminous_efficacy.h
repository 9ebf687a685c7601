/* SPDX-License-Identifier: Apache-2.0 */
/* luminous_efficacy.h -- lumens to a watt of daylight, by how clear, bright and damp the sky
 * is.
 *
 * Source    Perez, Ineichen, Seals, Michalsky and Stewart, "Modeling daylight availability and
 *           irradiance components from direct and global irradiance", Solar Energy 44 (1990),
 *           pages 271 to 289. The fit's clearness and brightness are sky_shape.h's.
 * Units     lm W^-1 of an irradiance from 300 nm to 4 um; radians; cm of precipitable water.
 * Range     direct: never below 0, where the fit falls with the sun at the horizon.
 * Threads   pure functions. Fails: never.
 */
#pragma once
#include "sky/sky_shape.h"

/* Where no dew point is known: that of 11 degrees C, as Radiance's gendaylit has it. */
#define WATER_USUAL_CM 2.0

typedef struct LuminousEfficacy {
    double direct;  /* of the direct normal irradiance, */
    double diffuse; /* of the diffuse horizontal one, */
    double global;  /* of the global horizontal one: a fit of its own */
} LuminousEfficacy;

LuminousEfficacy luminous_efficacy(const PerezState *state, double sun_zenith, double water_cm);

/* Precipitable water above a place, by the dew point at the ground. */
double water_from_dew_point_cm(double celsius);
