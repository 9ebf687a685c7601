/* SPDX-License-Identifier: Apache-2.0 */
/* review_run.h -- what a review is made of and into: shared by the run and its sweeps.
 *
 * Memory   the review lives in the arena of its maker.
 * Threads  plain data.
 */
#pragma once
#include <stdbool.h>

#include "base/problems.h"
#include "base/progress.h"
#include "review/eye/false_suns.h"
#include "review/light/setup.h"
#include "review/profile.h"
#include "review/request/request.h"
#include "review/suns/sweep_suns.h"
#include "review/verdict.h"

typedef struct ReviewOutcome ReviewOutcome;

/* Who listens to a running review; NULL: nobody. read: gets each scene, whose files are known
 * then; verdicts: gets the review once all of it but its pictures stands. Its failure ends the
 * review. */
typedef struct ReviewNews {
    bool (*read)(void *user, const Scene *scene, Error *err);
    bool (*verdicts)(void *user, ReviewOutcome *outcome, Error *err);
    void *user;
} ReviewNews;

typedef struct ReviewRun {
    const ReviewRequest *request;
    const Profile *profile;
    SetupMeans means;
    Progress *progress;       /* in steps (review_steps); of a condition: its own */
    const bool *only;         /* [condition] of those that are reviewed; NULL: all */
    const char *state_text;   /* options of the scene's state, as means.state */
    const char *const *words; /* of the command, by which a merge makes the whole */
    int word_count;
    const char *const *merged;   /* [condition] a file that has it (engine/condition_file.h):
                                    nothing is traced; NULL: no merge */
    const char *folder;          /* of the frames, which is there; */
    const char *unfinished;      /* of conditions that are done, and of checkpoints; NULL:
                                    nothing is kept */
    const char *responses;       /* and of responses: as it is opened (plan: NULL: none), */
    const char *responses_shown; /* and as the review names it */
    ReviewNews news;
    Problems *problems;        /* warnings of scenes, once each */
    SunSearches *sun_searches; /* that its conditions share */
    const Review *base;        /* this is a variant of that, which is made before: verdicts
                                  alone are made (cases.h); NULL: the review itself */
} ReviewRun;

static inline bool review_is_wanted(const ReviewRun *run, int condition_id) {
    return !run->only || run->only[condition_id];
}

/* The case of one sight of a sweep under every sun: [sun] of each. */
typedef struct SunFigures {
    float *contrast, *low, *high; /* with its 95 % interval */
    float *margin, *reflected, *mirror, *level, *lux;
    unsigned char *verdict;
    int worst;       /* sun; -1: none */
    bool is_private; /* it must not be read: more contrast is worse */
} SunFigures;

/* A sweep's results under each of its suns: one symbol, one eye. */
typedef struct SweepTable {
    int sweep_id;          /* of the review */
    SweepSun worst_sun;    /* where near that one it is worst */
    const SweepSuns *suns; /* shared by the sweep's tables */
    SunFigures figures;    /* [suns->count] */
} SweepTable;

/* The review, and what its sweeps found of every sun. */
struct ReviewOutcome {
    Review review;
    SweepTable *tables;
    int table_count;
    int responses_kept; /* of its responses: those that were not traced */
};
