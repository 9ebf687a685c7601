/* SPDX-License-Identifier: Apache-2.0 */
/* frame_outcome.h -- the attributes of how a frame came out: the same from a render and
 * from a merge of its parts.
 *
 * Memory   the arena's.  Threads  no shared state.  Fails  never.
 */
#pragma once
#include <stdbool.h>
#include <stdint.h>

#include "image/frame.h"

typedef struct FrameOutcome {
    uint32_t first_sample, end_sample; /* half-open, of every pixel */
    bool     complete;       /* all samples that were asked for, or the wanted noise */
    double   relative_error; /* film.h's, of the frame */
    uint64_t dropped_samples;
} FrameOutcome;

/* Sets "parhelion:samples", "parhelion:complete", "parhelion:relativeError" and
 * "parhelion:droppedSamples"; and the time, "capDate" with "utcOffset", when SOURCE_DATE_EPOCH
 * gives one (reproducible-builds.org). It is left out otherwise, so that the same render gives
 * the same file. */
void frame_set_outcome(FrameImage *frame, const FrameOutcome *outcome, Arena *arena);
