/* SPDX-License-Identifier: Apache-2.0 */
/* frames.h -- pictures of a setup: what an eye sees under a condition.
 *
 * Frames go to FOLDER/frames: NAME.exr in cd m^-2 with the layers of displays, NAME.png
 * developed, and in false colours NAME-luminance.png and NAME-contrast.png: what contrast full
 * white would have with full black at each pixel of a display. A frame ends at the request's
 * noise or at FRAMES_SAMPLES; where that noise is 1, at the samples of a preview, which pixels
 * about the display that is judged take, others one. Where the
 * request says so NAME.png, and it alone, is of filtered light (denoise/denoise.h), exposed as
 * without, and NAME.exr has the layers for that. What was
 * done before a kill is not done again: a frame that is whole is kept as it is, one that was
 * begun goes on from its checkpoint, to the same bytes. One of another program, or of other
 * layers, begins anew.
 *
 * Memory   scratch only; names live in the arena.
 * Threads  starts its own; the same frames for any count.
 * Fails    when a file cannot be written, and nothing half-written is left; when the user
 *          stops it, after a checkpoint.
 */
#pragma once
#include "review/run/review_run.h"
#include "review/verdict.h"

#define FRAMES_SAMPLES 256
#define FRAMES_PREVIEW_SAMPLES 4
#define FRAMES_PAIR 2       /* a variant's is so many times smaller each way */
#define FRAMES_CONTRAST 100 /* : 1, where the scale of contrasts ends */

typedef enum FrameView { FRAME_PICTURE, FRAME_LUMINANCE, FRAME_CONTRAST, FRAME_VIEWS } FrameView;

/* The picture's name, from that of any other of the frame's files. */
const char *frame_view(const char *frame, FrameView view, Arena *arena);

/* Pictures of a review that is made: of its worst cases, and of the very
 * worst with each variant's change.
 *
 * Memory   names live in the arena; setups use scratch of their own.
 * Threads  starts its own; the same pictures for any count.
 * Fails    as its parts do. */

/* As many as the request requires, into the run's folder; the cases then name them. Where there
 * is any, variants name two of the worst case, without and with their change. */
bool review_frames(const ReviewRun *run, ReviewOutcome *outcome, Arena *arena, Error *err);
