/* SPDX-License-Identifier: Apache-2.0 */
/* render_answer.h -- what comes out of `parhelion render`: a frame with everything that is
 * needed to make it again, and what is printed.
 *
 * Memory   the arena's.
 */
#pragma once
#include "cli/render/render_request.h"

/* The film as it stands, with its metadata: for frame_write alone (film_to_rows), or R, G, B for
 * looking, with what a denoiser requires where the request has one. */
typedef enum FrameUse { FRAME_FILE, FRAME_PICTURE } FrameUse;
FrameImage render_make_frame(const RenderRequest *request, const Scene *scene,
                             const SceneCamera *camera, const RenderResult *result, FrameUse use,
                             Arena *arena);

/* The command's answer on stdout. live_s: seconds that the file of --live took; pictures: a list of
 * look_options.h's answers, which is taken. */
bool render_print_answer(const RenderRequest *request, const RenderResult *result, double live_s,
                         json_t *pictures, const Problems *problems, Error *err);

/* The value of the one sample that was replayed, on stdout. */
bool render_print_replay(const RenderRequest *request, const Scene *scene,
                         const RenderResult *result, Arena *arena, Error *err);

/* How a frame came out: the same from a render and from a merge of its parts. */
typedef struct FrameOutcome {
    uint32_t first_sample, end_sample; /* half-open, of the frame */
    bool complete;                     /* all samples that were requested, or the requested noise */
    double relative_error;             /* film.h's, of the frame */
    double rare_error;                 /* likewise; or NaN */
    uint64_t dropped_samples;
} FrameOutcome;

/* Sets "parhelion:samples", "parhelion:complete", "parhelion:relativeError",
 * "parhelion:rareError" where there is one, and "parhelion:droppedSamples"; and the time, "capDate"
 * with "utcOffset", when SOURCE_DATE_EPOCH gives one (reproducible-builds.org). It is left out
 * otherwise, so that the same render gives the same file. */
void frame_set_outcome(FrameImage *frame, const FrameOutcome *outcome, Arena *arena);

/* What is to be said of samples that the film does not hold; NULL: it holds them all. line: the
 * command that made it, to see one of them again; NULL: none is known. */
const char *frame_dropped_warning(const Film *film, const char *line, Arena *arena);

/* False: it holds none of them, and there is no frame (ERROR_INPUT). */
bool frame_check_dropped(const Film *film, const char *line, Arena scratch, Error *err);
