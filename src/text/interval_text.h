/* SPDX-License-Identifier: Apache-2.0 */
/* interval_text.h -- a figure that was measured or sampled, as people read it: with its
 * interval, and with no more digits than that allows.
 *
 * The interval's half width keeps two digits where they begin with 1 or 2, else one; the figure
 * ends where that ends.
 *
 * Memory   texts from the arena.
 * Threads  pure functions.
 */
#pragma once
#include "base/arena.h"

/* "420 +- 25"; where it lies aside of the middle "2.95 (2.91 to 3.02)"; exact ones to four
 * digits; one without an end "at least 12"; "unknown" for NaN. */
const char *interval_text(double value, double low, double high, Arena *arena);

/* The figure alone, "420": its last digit is that in which the half width begins; four at most,
 * and of one without an interval four. */
const char *interval_value_text(double value, double low, double high, Arena *arena);
