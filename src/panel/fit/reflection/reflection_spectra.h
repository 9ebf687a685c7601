/* SPDX-License-Identifier: Apache-2.0 */
/* reflection_spectra.h -- a reflection as few numbers a place: spectra on a few rows of a
 * basis, and the tables' coefficients on a few principal components that all tables share. */
#pragma once
#include "panel/fit/reflection/reflection_model.h"

/* Means, spectral basis and loadings, all rounded to what the file holds. */
void reflection_spectra_choose(ReflectionModel *model);

/* ln (f / F) of a table from the tree's components. */
void reflection_spectra_logs(const ReflectionModel *model, int table, const float *component,
                             float *logs);

/* Is that within the tolerance of `wanted` at every wavelength? */
bool reflection_spectra_is_near(const ReflectionModel *model, int table, const float *component,
                                const float *wanted, float tolerance);
