/* SPDX-License-Identifier: Apache-2.0 */
/* sweep.h -- a condition that stands for many suns: all directions, or the hours of a
 * year.
 *
 * Each symbol, as each eye sees it, is a probe whose response is traced once (distant_probe.h);
 * its face and the sensor of the level are luxmeters. The worst case of each is read again as a
 * moment, with all paths, so that its figures are not the response's.
 *
 * Approximate  an eye box counts by its middle; glints via a mirror that is no display
 *              are spread over the width of a response's triangle; clear skies between two
 *              elevations of the table are interpolated.
 * Memory       the results live in the arena; the rest is given back.
 * Threads      starts its own; the same figures for any count.
 */
#pragma once
#include "review/run/cases.h"
#include "review/run/review_run.h"

/* Can the condition be swept? To be checked before long work; the error names its place. */
bool sweep_check(const ReviewRequest *request, int condition_id, Arena scratch, Error *err);

/* The clear sky of the setup's sweep under one of its suns; that of its weather file, where the
 * sun has a step. */
Environment sweep_environment(const Setup *setup, const SweepSun *sun);

bool run_sweep(const ReviewRun *run, Setup *setup, Arena *arena, ReviewOutcome *out, Error *err);
