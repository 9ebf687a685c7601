/* SPDX-License-Identifier: Apache-2.0 */
/* sky_degrees.h -- what tables of astronomy are written in: degrees, from J2000 on.
 *
 * Threads  pure functions.  Fails  never.
 */
#pragma once
#include <math.h>

#include "base/mathd.h"
#include "base/units.h"

#define J2000 2451545.0           /* Julian day */
#define EARTH_FLATNESS 0.99664719 /* polar over equatorial radius */

static inline double sin_deg(double degrees) {
    return sin_d(radians_from_degrees(degrees));
}

static inline double cos_deg(double degrees) {
    return cos_d(radians_from_degrees(degrees));
}

/* The same direction in [0, 360). */
static inline double turn_deg(double degrees) {
    double rest = fmod(degrees, 360);
    return rest < 0 ? rest + 360 : rest;
}
