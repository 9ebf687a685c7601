/* SPDX-License-Identifier: Apache-2.0 */
#include "review/engine/engine.h"

#include "base/count.h"
#include "review/keep/frame_kept.h"
#include "review/review_decide.h"
#include "review/run/run.h"
#include "review/run/frames.h"
#include "review/vary/variants.h"

/* A step after all conditions are reviewed; they run in turn. */
typedef struct LaterStep {
    bool (*make)(const ReviewRun *run, ReviewOutcome *outcome, Arena *arena, Error *err);
    bool        is_wanted;
} LaterStep;

/* Frames take long: they come last. */
static bool run_steps(const ReviewRun *run, const ReviewSteps *steps, ReviewOutcome *outcome,
                      Arena *arena, Error *err)
{
    const ReviewRequest *request = run->request;
    const LaterStep later[] = {
        {review_variants, request->variant_count > 0},
        {review_sensitivities,
         request->parameter_count > 0 && steps->with_sensitivities},
        {review_mend, run->mend != NULL},
        {review_frames, request->frames.worst > 0}};
    for (int i = 0; i < COUNT_OF(later); i++) {
        if (!later[i].is_wanted) continue;
        if (!later[i].make(run, outcome, arena, err)) return false;
        if (!review_goes_on(run->means.journal, err)) return false;
    }
    return true;
}

bool review_run(const ReviewRun *run, const ReviewSteps *steps, Arena *arena,
                ReviewOutcome *out, Error *err)
{
    if (!review_run_conditions(run, arena, out, err)) return false;
    out->review.is_strict = steps->is_strict;
    review_decide(&out->review);
    return run_steps(run, steps, out, arena, err);
}
