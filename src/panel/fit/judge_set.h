/* SPDX-License-Identifier: Apache-2.0 */
/* judge_set.h -- faults that a measurement set shows by itself: units, levels, azimuths.
 *
 * Frame    the display's. Memory: the judge's. Threads: one at a time. Fails: never.
 */
#pragma once
#include "panel/fit/judge_reason.h"
#include "panel/set/measurement.h"

/* White, black and levels along the normal. */
void judge_set_levels(Judge *judge, const Measurement *set);

/* Azimuths that are too far apart, and what that may cost. */
void judge_set_azimuths(Judge *judge, const Measurement *set);
