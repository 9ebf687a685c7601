/* SPDX-License-Identifier: Apache-2.0 */
#include "review/engine/engine.h"

#include "base/count.h"
#include "review/keep/frame_kept.h"
#include "review/review_decide.h"
#include "review/run/run.h"
#include "review/run/frames.h"
#include "review/vary/variants.h"
#include "text/text.h"

/* A step after all conditions are reviewed; they run in turn. */
typedef struct LaterStep {
    bool (*make)(const ReviewRun *run, ReviewOutcome *outcome, Arena *arena, Error *err);
    const char *what;
    bool        is_wanted;
} LaterStep;

/* NULL: nothing. */
static const char *still_to_come(const LaterStep *steps, int first, int count, Arena *arena)
{
    Text words = {.arena = arena};
    bool any = false;
    text_add(&words, "every verdict is there; to come: ");
    for (int i = first; i < count; i++) {
        if (!steps[i].is_wanted) continue;
        text_format(&words, "%s%s", any ? ", " : "", steps[i].what);
        any = true;
    }
    return any ? words.data : NULL;
}

/* Frames take long: they come last. */
static bool run_steps(const ReviewRun *run, const ReviewSteps *steps, ReviewOutcome *outcome,
                      Arena *arena, Error *err)
{
    const ReviewRequest *request = run->request;
    const LaterStep later[] = {
        {review_variants, "variants", request->variant_count > 0},
        {review_sensitivities, "sensitivity",
         request->parameter_count > 0 && steps->with_sensitivities},
        {review_mend, "remedy", run->mend != NULL},
        {review_frames, "pictures", request->frames.worst > 0}};
    for (int i = -1; i < COUNT_OF(later); i++) {
        if (i >= 0 && !later[i].is_wanted) continue;
        if (i >= 0 && !later[i].make(run, outcome, arena, err)) return false;
        if (!review_goes_on(run->means.journal, err)) return false;
        outcome->review.to_come = still_to_come(later, i + 1, COUNT_OF(later), arena);
        if (steps->on_step && !steps->on_step(steps->user, outcome, err)) return false;
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
