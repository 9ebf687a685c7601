/* SPDX-License-Identifier: Apache-2.0 */
/* reflection_parts.h -- the parts of a reflection: the mirror, and what is left for the haze.
 *
 * Tables   one a measured incidence and azimuth of the light: azimuth * incidences + incidence;
 *          rows over wavelengths.
 * Memory   the arena's. Threads: options->threads; results do not depend on how many.
 * Fails    never.
 */
#pragma once
#include "panel/fit/common/fit_options.h"
#include "panel/fit/reflection/reflection_peak.h"
#include "panel/set/measurement.h"
#include "spectrum/twice.h"

typedef struct ReflectionParts {
    int tables;
    AngleTable *haze;                             /* what is left without the mirror */
    double *noise;                                /* relative, per table */
    double *dim_noise;                            /* sr^-1, per table */
    double *reflectance;                          /* of the mirror, [table][wavelength] */
    double mirror_y[MEASUREMENT_INCIDENCES_MAX];  /* luminous, of the first azimuth */
    double luminous[MEASUREMENT_WAVELENGTHS_MAX]; /* observer's weight, sum 1 */
    bool has_mirror;
    bool is_apart;    /* the mirror is the specular measurement's: the samples hold none */
    PeakMirror *peak; /* per table; NULL: the instrument's width is not declared, and the mirror
                         is not apart */
} ReflectionParts;

void reflection_parts_separate(const Measurement *set, const FitOptions *options, Arena *arena,
                               FitNotes *notes, ReflectionParts *out);

/* Up to which both are one: relative, of what is measured twice; a gloss meter is taken for one
 * of twice the error. */
#define SPECULAR_MISS 0.05
#define GLOSS_MISS 0.1

/* The table whose specular measurement and samples are furthest apart; false: not both were
 * measured, or they cannot be compared. */
bool reflection_parts_twice(const Measurement *set, const ReflectionParts *parts, Twice *worst);

/* Relative noise of a table's value f. */
double reflection_parts_noise(const ReflectionParts *parts, int table, double f);

/* That of the noisiest table. */
double reflection_parts_most_noise(const ReflectionParts *parts);
