/* SPDX-License-Identifier: Apache-2.0 */
/* frame_kept.h -- what a review that was stopped has of a frame: all of it, or a checkpoint.
 *
 * Memory   the arena's.
 * Threads  one at a time.
 * Fails    as render/checkpoint.h; a checkpoint that is damaged is a line on stderr, and the
 *          frame begins anew.
 */
#pragma once
#include "render/render.h"

enum { FRAME_FILES_MOST = 4 };

typedef struct FrameKept {
    const char *unfinished;              /* folder; NULL: nothing is kept */
    const char *identity;                /* all that decides the frame (render/identity.h) */
    const char *files[FRAME_FILES_MOST]; /* the frame, its pictures */
    int file_count;
    Arena *arena;
    const RenderOptions *options; /* from begin on; and: */
    const char *checkpoint;
} FrameKept;

/* Are all files there as they were written? */
bool frame_kept_is_whole(const FrameKept *kept);

/* Options get a checkpoint to go on from, if there is one, and keep others from now on; both
 * must outlive the render. */
bool frame_kept_begin(FrameKept *kept, RenderOptions *options, Error *err);

/* All files are written. */
bool frame_kept_end(const FrameKept *kept, Error *err);

/* Whether a review goes on.
 *
 * Threads  the one that reviews. */

/* False: INT, TERM or HUP requested to stop (signals_stopped: there is no error). */
bool review_goes_on(Error *err);
