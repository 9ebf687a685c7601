/* SPDX-License-Identifier: Apache-2.0 */
/* reflection_fit.h -- from the tables of a reflection to the sections of a panel file.
 *
 * Mirror, lobe and haze separated -> the haze's logarithm in the specular-following frame ->
 * few spectra and few components for all tables -> one tree -> section, integrals as measured
 * and energy held.
 * Memory   the arena's. Threads: options->threads; the bytes do not depend on how many.
 * Fails    when the tree cannot be stored (ERROR_INPUT).
 */
#pragma once
#include "panel/fit/reflection/reflection_held_out.h"
#include "panel/fit/reflection/reflection_section.h"

typedef struct ReflectionResult {
    const ReflectionModel *model; /* in the end */
    ReflectionParts parts;
    ReflectionSection section;
    const void *sampling; /* the section's bytes; NULL: not yet built */
    size_t sampling_size;
    const HeldOut *held_out; /* per table */
    double worst;            /* largest error over the bound */
} ReflectionResult;

/* All but the sampling, which follows from the panel's answers to queries. */
bool reflection_fit(const Measurement *set, const FitOptions *options, Arena *arena,
                    FitNotes *notes, ReflectionResult *out, Error *err);
