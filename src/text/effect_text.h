/* SPDX-License-Identifier: Apache-2.0 */
/* effect_text.h -- what a change does to a margin, in percent of the limit, with its 95 %
 * interval and no more digits than that allows.
 *
 * Units    shares of the limit go in; `least` is the smallest that is reported.
 * Memory   texts from the arena. Threads: pure. Fails: never.
 */
#pragma once
#include <stdbool.h>

#include "base/arena.h"
#include "base/confidence.h"

#define EFFECT_NONE "none"

/* "+20.8 ± 0.5 %", both to one place; "+20.8 ± less than 0.1 %" where the error is below half
 * of the least; "none above 0.9 %" where it may be 0; EFFECT_NONE; "–" for NaN. */
const char *effect_text(double share, MeanInterval range, double least, Arena *arena);

/* Are it and its error below half of the least? */
bool effect_is_none(double share, MeanInterval range, double least);
