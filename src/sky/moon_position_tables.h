/* SPDX-License-Identifier: Apache-2.0 */
/* moon_position_tables.h -- the numbers of the lunar theory. Private to src/sky. */
#pragma once

/* multiple: of the moon's elongation D, the sun's anomaly M, the moon's anomaly M' and its
 * argument of latitude F. sine in 1e-6 degrees, cosine in m. */
typedef struct MoonTerm {
    int    multiple[4];
    double sine, cosine;
} MoonTerm;

#define MOON_TERMS 60
extern const MoonTerm moon_longitude_terms[MOON_TERMS]; /* with the distance's cosines */
extern const MoonTerm moon_latitude_terms[MOON_TERMS];
