/* SPDX-License-Identifier: Apache-2.0 */
/* live.h -- what the page's reader may move (review/output/review_live.h), from what a review
 * found: the suns of its sweeps, and the frames of its worst cases as they lie in its folder.
 *
 * A frame is divided into what displays emit to the eye and the rest; both are made smaller
 * (means of areas) to LIVE_WIDTH x LIVE_HEIGHT at most, and both are spread as in the
 * observer's eye. Where the request has frames denoised, the denoised frame is divided too, for
 * the picture alone: values, false colours and the eye's view are of the frame itself. What a
 * display's light does in the cabin stays with the rest, at the level of the frame.
 *
 * Memory   what is packed lives in the arena; scratch: a frame with all its channels, and the
 *          filters'.
 * Threads  the filters'; the same bytes for any count.
 * Fails    when a frame cannot be read, or memory is out.
 */
#pragma once
#include "image/frame.h"
#include "review/output/review_live.h"
#include "review/output/review_page.h"
#include "review/run/job.h"
#include "vision/human_eye.h"

/* ---- a frame as a sum: what displays emit to the eye, and the rest ----------------------- */

/* cd m^-2, R, G, B of Rec.709. */
typedef struct LivePlanes {
    int    width, height;
    float *rgb[3];
} LivePlanes;

typedef struct LiveFrame {
    LivePlanes scene, displays; /* add up to the frame's R, G, B */
} LiveFrame;

/* Needs display.emitted and display.coverage. */
bool live_frame_split(const FrameImage *frame, Arena *arena, LiveFrame *out, Error *err);

/* Of a denoised frame: displays are what it was given of their light, display.fine where the
 * frame has it; the rest, which is filtered, is at least 0. */
bool live_clean_split(const FrameImage *denoised, Arena *arena, LiveFrame *out, Error *err);

/* At most so large, as it is or smaller: each pixel is the mean over its area. */
LivePlanes live_frame_shrink(const LivePlanes *planes, int width, int height, Arena *arena);

/* Both pictures. A perspective view, yfov_deg high. */
bool live_frame_spread(LiveFrame *frame, double yfov_deg, HumanEye eye, int threads,
                       Arena *arena, Error *err);

/* ---- all of it --------------------------------------------------------------------------- */

enum { LIVE_WIDTH = 960, LIVE_HEIGHT = 540 };

typedef struct LiveArgs {
    const ReviewRequest *request;
    const ReviewOutcome *outcome;
    const char          *folder; /* of the frames */
    int                  threads;
} LiveArgs;

bool live_make(const LiveArgs *args, Arena *arena, ReviewLive *out, Error *err);

/* What a sweep found of every sun, as a table and as pictures for the page.
 *
 * Memory   from the arena. Threads: pure.
 * Fails    when the table cannot be written. */

/* CSV: a row a sun, azimuths of the compass and of the vehicle. */
bool sweep_table_write(const SweepTable *table, const ReviewCondition *condition,
                       const char *path, Error *err);

/* Contrast over the sun's place in the vehicle's frame: cells of `step_deg`, each with the
 * worst of its suns; of a sweep over the sun its own grid. A cell that the sun of a year passes
 * between two steps has the answer of the one that is nearer in time. */
ReviewMap sweep_map(const SweepTable *table, const ReviewSweep *sweep, double step_deg,
                    Arena *arena);

/* For a year sweep. */
ReviewCalendar sweep_calendar(const SweepTable *table, const ReviewSweep *sweep,
                              const ReviewCondition *condition, Arena *arena);
