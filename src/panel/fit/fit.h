/* SPDX-License-Identifier: Apache-2.0 */
/* fit.h -- from measured tables to one compressed panel file.
 *
 * Emission: the logarithm of what every table's X, Y, Z add to the black pattern, as a few
 * components over the tables fitted with each number's own noise; of the components a smooth
 * part (splines times harmonics) is taken out first, the rest is one vertex or Haar tree.
 * Reflection: the logarithm of f / F(theta_i) in the specular-following frame, few spectra,
 * all incidences in one tree; the mirror's image is taken out first.
 *
 * Memory   the arena's. Threads: one fit at a time per arena.
 * Fails    with the file that cannot be written; with ERROR_UNUSABLE, and the report, where
 *          the panel is judged not usable (fit_judge.h) and options->force is false.
 */
#pragma once
#include <jansson.h>

#include "panel/fit/common/fit_options.h"
#include "panel/set/measurement.h"

/* Fits, checks against the tables and writes the file at once (nothing half-written stays).
 * *report: what `panel info` shows, owned by the caller (json_decref); NULL after other
 * failures than ERROR_UNUSABLE. */
bool panel_fit(const Measurement *measurement, const FitOptions *options, const char *path,
               Arena *arena, json_t **report, Error *err);
