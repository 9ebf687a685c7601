/* SPDX-License-Identifier: Apache-2.0 */
/* beam_table.h -- how much of the sun's light reaches a point of the layered air, and how dense
 * the air is there: tables for many rays.
 *
 * Rays through spherical shells (air.h); the sun's disc sets behind the floor's edge. By day
 * they are straight, from the sun's apparent place; for twilight they are bent (bent_ray.h),
 * angles are to the sun's true place, and bending also spreads the light: rays that come dt
 * apart from the true place arrive da apart, thinned by da / dt.
 * Spectra go by pointer, because every build of the hot sources calls this one.
 *
 * Units     metres, m^-1; angles by their cosine to the local zenith.
 * Memory    the arena's, about 300 kB. Threads: const once built; the build takes `threads`.
 * Fails     never.
 */
#pragma once
#include "base/arena.h"
#include "sky/air/air.h"

typedef struct BeamTable {
    AirOptics optics;
    double floor_m;
    float *column;  /* [height][cosine][part]: to space */
    float *thinned; /* [height][cosine]: optical depth of the spreading; NULL: straight */
    float *edge;    /* [height]: true angle to the zenith of the sun at the floor's edge */
    float *density; /* [node][part], m^-1, evenly over the root of the altitude */
} BeamTable;

void beam_table_build(const AirOptics *optics, double floor_m, int threads, Arena *arena,
                      BeamTable *out);

/* With bent rays. */
void beam_table_build_bent(const AirOptics *optics, double floor_m, int threads, Arena *arena,
                           BeamTable *out);

/* A height in the tables, for many suns. */
typedef struct BeamHeight {
    int row;
    float share; /* of the way to the next row */
    double edge; /* cosine of the true angle at which the sun stands at the floor's edge */
} BeamHeight;

BeamHeight beam_table_height(const BeamTable *table, double altitude_m);

/* Transmittance from space to a point; below the floor's edge the edge's own. */
void beam_table_passing(const BeamTable *table, const BeamHeight *at, double cosine, Spectrum *out);

/* The same of the sun's beam: its disc sets behind the floor's edge. */
void beam_table_sun(const BeamTable *table, const BeamHeight *at, double cosine, Spectrum *out);

void beam_table_density(const BeamTable *table, double altitude_m, float density[AIR_PARTS]);
