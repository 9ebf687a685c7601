/* SPDX-License-Identifier: Apache-2.0 */
/* emission_fit.h -- from the tables of an emission to the sections of a panel file.
 *
 * Samples at common directions -> few components for all tables -> smooth part -> tree of
 * the rest.
 * Memory   the arena's. Threads: options->threads; the bytes do not depend on how many.
 * Fails    when smooth part or tree cannot be stored (ERROR_INPUT).
 */
#pragma once
#include "panel/fit/common/scatter_gaps.h"
#include "panel/fit/emission/emission_outliers.h"
#include "panel/fit/emission/emission_tree.h"

typedef struct EmissionResult {
    const void *section; /* as in the file */
    size_t section_size;
    EmissionTree tree;
    ScatterGaps gaps;           /* between the samples */
    const EmissionModel *model; /* in the end */
    int table_count;
    bool has_black;
    EmissionNoise noise[EMISSION_TABLES_MAX]; /* per table; last: black */
    uint8_t *outlier[EMISSION_TABLES_MAX];    /* per row */
    int outlier_count, hole_count;
    int shared; /* directions that stand out in every table but the black one */
    EmissionFlag shared_first;
    EmissionFlags outliers, holes;
} EmissionResult;

/* The primaries' section: their spectra at the sampling that they were measured with, or what
 * stands in their place. */
typedef struct EmissionPrimaries {
    const float (*spectrum)[SPECTRAL_COUNT]; /* NULL: none is stored */
    const char *assumed;                     /* in words; NULL: measured */
    const void *bytes;
    size_t size;
} EmissionPrimaries;

void emission_fit_primaries(const Measurement *set, FitNotes *notes, Arena *arena,
                            EmissionPrimaries *out);

bool emission_fit(const Measurement *set, const FitOptions *options, Arena *arena, FitNotes *notes,
                  EmissionResult *out, Error *err);
