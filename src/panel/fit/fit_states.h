/* SPDX-License-Identifier: Apache-2.0 */
/* fit_states.h -- a measurement set of one state or of several becomes one panel file.
 *
 * Each state is fitted as if it were alone (fit.h); the file is that of panel_states.h, byte
 * for byte what `panel join` makes of the single fits.
 *
 * Memory   the arena's. Threads: one fit at a time per arena.
 * Fails    as panel_fit; what concerns one state names it.
 */
#pragma once
#include "panel/fit/fit.h"

/* As panel_fit. *report: the first state's; of one that is judged not usable, that state's. */
bool fit_states(const Measurement *measurement, const FitOptions *options, const char *path,
                Arena *arena, json_t **report, Error *err);
