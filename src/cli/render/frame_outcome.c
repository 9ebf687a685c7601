/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/render/frame_outcome.h"

#include <stdlib.h>
#include <time.h>

static void set_time(FrameImage *frame, Arena *arena)
{
    const char *epoch = getenv("SOURCE_DATE_EPOCH");
    if (!epoch) return;
    char     *end;
    time_t    seconds = (time_t)strtoll(epoch, &end, 10);
    struct tm date;
    char      text[32];
    if (end == epoch || *end || !gmtime_r(&seconds, &date)) return;
    strftime(text, sizeof text, "%Y:%m:%d %H:%M:%S", &date);
    frame_set_string(frame, "capDate", text, arena);
    frame_set_values(frame, "utcOffset", EXR_FLOAT, (const double[]){0}, arena);
}

void frame_set_outcome(FrameImage *frame, const FrameOutcome *outcome, Arena *arena)
{
    frame_set_string(frame, "parhelion:samples",
                     arena_format(arena, "%u:%u", outcome->first_sample, outcome->end_sample),
                     arena);
    frame_set_whole(frame, "parhelion:complete", outcome->complete, arena);
    frame_set_number(frame, "parhelion:relativeError", outcome->relative_error, arena);
    frame_set_number(frame, "parhelion:droppedSamples", (double)outcome->dropped_samples,
                     arena);
    set_time(frame, arena);
}
