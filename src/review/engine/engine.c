/* SPDX-License-Identifier: Apache-2.0 */
#include "review/engine/engine.h"

#include "review/keep/frame_kept.h"
#include "review/review_decide.h"
#include "review/run/run.h"
#include "review/run/frames.h"
#include "review/vary/variants.h"

/* Frames take long: they come last. */
bool review_run(const ReviewRun *run, bool is_strict, Arena *arena, ReviewOutcome *out,
                Error *err)
{
    const ReviewRequest *request = run->request;
    if (!review_run_conditions(run, arena, out, err)) return false;
    out->review.is_strict = is_strict;
    review_decide(&out->review);
    if (request->variant_count && !review_variants(run, out, arena, err)) return false;
    if (!review_goes_on(run->means.journal, err)) return false;
    if (request->frames.worst && !review_frames(run, out, arena, err)) return false;
    return review_goes_on(run->means.journal, err);
}
