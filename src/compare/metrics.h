/* SPDX-License-Identifier: Apache-2.0 */
/* metrics.h -- computes what a comparison requires: metrics, their maps, contrasts, the test.
 *
 * Memory   from the arena that is passed in.
 * Threads  `threads` of the options for FLIP.
 * Fails    for a frame that cannot be developed, and without noise layers for a test that was
 *          requested.
 */
#pragma once
#include "compare/comparison.h"
#include "compare/metrics/deltae.h"

/* Codes of both frames, developed with one exposure: for those who look at them. Pictures have
 * theirs. */
bool metrics_develop(const CompareOptions *options, Arena *arena, Comparison *out, Error *err);

/* Of frames: fills light, mask, grid, maps, values, contrasts and the statistic of `out`, whose
 * sides have the same pixels; adds notes. groups: GROUP_... bits. */
bool metrics_measure(const CompareOptions *options, unsigned groups, Arena *arena, Comparison *out,
                     Error *err);

/* Errors, FLIP and colour differences among the values of `out`, the groups' ones. */
void metrics_set_errors(const PixelErrors *errors, unsigned groups, Comparison *out);
void metrics_set_flip(const MapSummary *flip, Comparison *out);
void metrics_set_deltae(const MapSummary *deltae, Comparison *out);

/* EV of a factor 2^stops of light, and back: 18 % grey of exposure.h becomes 0.18. */
double ev_of_stops(double stops);
double stops_of_ev(double ev);
