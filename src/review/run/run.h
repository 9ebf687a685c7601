/* run.h -- a request becomes a review: stage by stage, case by case.
 *
 * Memory   the review lives in the arena; stages use scratch of their own.
 * Threads  starts its own; the same review for any count.
 * Fails    as its parts do; nothing is written here.
 */
#pragma once
#include "base/progress.h"
#include "review/profile.h"
#include "review/request/request.h"
#include "review/verdict.h"

typedef struct ReviewRun {
    const ReviewRequest *request;
    const Profile       *profile;
    const char          *root;     /* --root, or NULL */
    int                  threads;
    const char          *isa;      /* kernel.h's; NULL: the best */
    ProgressMode         progress;
    const char          *folder;   /* of the frames, which is there; NULL: none are made */
    Problems            *problems; /* warnings of scenes, once each */
} ReviewRun;

/* The review, and what its sweeps found of every sun. */
typedef struct ReviewOutcome {
    Review            review;
    struct SweepTable *tables; /* sweep.h */
    int                table_count;
} ReviewOutcome;

bool review_run(const ReviewRun *run, Arena *arena, ReviewOutcome *out, Error *err);
