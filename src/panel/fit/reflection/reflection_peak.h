/* SPDX-License-Identifier: Apache-2.0 */
/* reflection_peak.h -- taking a narrow peak out of a measured table: the mirror's image, as
 * wide as the instrument, or a lobe of the panel's own, as wide as it comes.
 *
 * Units    radians; reflectances without unit, tables in sr^-1.
 * Memory   the arena's. Threads: pure functions of an arena each. Fails: never.
 */
#pragma once
#include "panel/set/angle_table.h"

/* Takes the mirror's image out of one table: reflectance[wavelength], and the table without
 * it (values in the arena). fwhm: the instrument's. */
void reflection_peak_take_mirror(const AngleTable *slice, double incidence, double fwhm,
                                 Arena *arena, double *reflectance, AngleTable *haze);

/* A Gaussian lobe on the mirror direction that stands on the haze. */
typedef struct ReflectionLobe {
    double  fwhm;        /* radians */
    double *reflectance; /* per wavelength, room for them */
} ReflectionLobe;

/* Takes a lobe out of one table, if a lobe on smooth haze explains the table. noise: relative.
 * False: the table shows none, *haze is *slice. */
bool reflection_peak_take_lobe(const AngleTable *slice, double incidence, double noise,
                               Arena *arena, ReflectionLobe *lobe, AngleTable *haze);
