/* SPDX-License-Identifier: Apache-2.0 */
/* sun_position_tables.h -- the numbers of the solar position algorithm. Private to src/sky. */
#pragma once

/* a cos(b + c JME); a in 1e-8 rad (distance: 1e-8 au), b in rad, c in rad per millennium. */
typedef struct OrbitTerm {
    double a, b, c;
} OrbitTerm;

/* Terms that are multiplied by the same power of time. */
typedef struct OrbitSeries {
    const OrbitTerm *term;
    int              count;
} OrbitSeries;

/* Heliocentric, for powers 0, 1, ... of JME. */
extern const OrbitSeries orbit_longitude[6], orbit_latitude[2], orbit_distance[5];

/* multiple: of the five arguments X0..X4; the rest in 1/36e6 degrees (per century). */
typedef struct NutationTerm {
    int    multiple[5];
    double psi, psi_rate, epsilon, epsilon_rate;
} NutationTerm;

#define NUTATION_TERMS 63
extern const NutationTerm nutation_terms[NUTATION_TERMS];
