/* SPDX-License-Identifier: Apache-2.0 */
/* render_live.h -- --live: the frame so far in a file, for whoever watches it. It changes
 * nothing of the frame, and a render never ends because of it.
 *
 * Time     written between passes, at most every ten seconds, and more rarely where that would
 *          take more than a twentieth of the time.
 * Threads  the one that called render_prepared.
 * Fails    once: with why the file is not written; from then on there is none.
 */
#pragma once
#include "cli/render/render_request.h"

typedef struct RenderLive {
    const char *path; /* NULL: nothing is written, or not any more */
    double begun_s;   /* all of the monotonic clock: when the render began, */
    double written_s; /* and the file was last written; 0: never */
    double spent_s;   /* seconds that all of its writing took, */
    double longest_s; /* and the one that took longest */
} RenderLive;

RenderLive render_live_begin(const RenderRequest *request);

/* Whether the file should be written now. */
bool render_live_is_due(const RenderLive *live);

/* The frame so far becomes the file. begun_s: when its making began, monotonic. */
bool render_live_write(RenderLive *live, const FrameImage *frame, double begun_s, Error *err);
