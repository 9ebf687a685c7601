/* SPDX-License-Identifier: Apache-2.0 */
/* emission_spectra.h -- the primaries' section of a panel file: their spectra at the sampling
 * that they were measured with. */
#pragma once
#include "panel/fit/common/fit_note.h"
#include "panel/set/measurement.h"

/* *size bytes in the arena. */
const void *emission_spectra_write(const Measurement *set, FitNotes *notes, Arena *arena,
                                   size_t *size);
