/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/render/render_live.h"

#include <math.h>

#define SHARE 0.05 /* of the time */
#define INTERVAL_S 10

RenderLive render_live_begin(const RenderRequest *request) {
    return (RenderLive){.path = request->replays ? NULL : request->live,
                        .begun_s = monotonic_seconds()};
}

/* The next one may take as long as the longest. */
bool render_live_is_due(const RenderLive *live) {
    double now_s = monotonic_seconds();
    if (!live->path || !live->written_s) return live->path != NULL;
    return now_s - live->written_s >= INTERVAL_S &&
           live->spent_s + live->longest_s <= SHARE * (now_s - live->begun_s);
}

bool render_live_write(RenderLive *live, const FrameImage *frame, double begun_s, Error *err) {
    bool done = frame_write(live->path, frame, err);
    live->written_s = monotonic_seconds();
    live->spent_s += live->written_s - begun_s;
    live->longest_s = fmax(live->longest_s, live->written_s - begun_s);
    if (!done) live->path = NULL;
    return done || error_prefix(err, "--live: the frame is not shown there any more");
}
