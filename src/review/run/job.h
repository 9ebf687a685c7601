/* SPDX-License-Identifier: Apache-2.0 */
/* job.h -- what a review is made of and into: shared by the run and its sweeps.
 *
 * Memory   the review lives in the arena of its maker.
 * Threads  plain data.
 */
#pragma once
#include <stdbool.h>

#include "base/problems.h"
#include "base/progress.h"
#include "keep/journal.h"
#include "review/eye/false_suns.h"
#include "review/light/setup.h"
#include "review/profile.h"
#include "review/request/request.h"
#include "review/suns/sweep_suns.h"
#include "review/verdict.h"

/* Which questions of a review one of several processes answers.
 *
 * Those of a moment are its cases and gazes. The moments lie side by side, all of one size,
 * and each is cut evenly into its questions: a part has one stretch of that, so that it opens
 * few moments. Of the sights of a sweep (a symbol as an eye sees it) it has every count-th,
 * with the responses that those take, and reads the worst case of each; of the eyes, likewise,
 * where mirrors show the sun. The merge answers what is needed once: causes, frames, how often
 * the sun is in mirrors.
 *
 * Threads  pure functions. */

typedef struct ReviewShare {
    int index, count; /* count 0: all questions are its own */
} ReviewShare;

/* A share of one moment: the place-th of `moments`. */
typedef struct MomentShare {
    ReviewShare of;
    int         place, moments;
} MomentShare;

/* Whether it has the at-th of `count` questions of the moment. */
bool moment_share_has(const MomentShare *share, int at, int count);

/* Whether it may have any, however many questions there are. */
bool moment_share_has_any(const MomentShare *share);

/* The same of the at-th sight of a sweep. */
bool review_share_has(const ReviewShare *share, int at);

typedef struct ReviewOutcome ReviewOutcome;

/* Who listens to a running review; NULL: nobody. read: gets each scene, whose files are known
 * then. Its failure ends the review. */
typedef struct ReviewNews {
    bool (*read)(void *user, const Scene *scene, Error *err);
    void  *user;
} ReviewNews;

typedef struct ReviewRun {
    const ReviewRequest *request;
    const Profile       *profile;
    SetupMeans           means;
    Progress            *progress; /* in steps (review_steps); of a condition: its own */
    const char          *folder;   /* of the frames, which is there; */
    const char          *unfinished; /* of checkpoints, */
    const char          *responses;  /* and of responses: as it is opened (plan: NULL: none), */
    const char          *responses_shown; /* and as the review names it */
    ReviewShare          share;    /* of its questions: the others' are left alone */
    const char          *identity; /* review_plan's, of what was planned; NULL: anything */
    ReviewNews           news;
    Problems            *problems; /* warnings of scenes, once each */
    SunSearches         *sun_searches; /* review_run_conditions' own */
    const Review        *base;     /* this is a variant of that, which is made before: verdicts
                                      alone are made (cases.h); NULL: the review itself */
} ReviewRun;

/* A variant's run, by its request, held against that. */
ReviewRun review_run_of(const ReviewRun *run, const ReviewRequest *request, const Review *base);

/* The case of one sight of a sweep under every sun: [sun] of each. */
typedef struct SunFigures {
    float *contrast, *low, *high; /* with its 95 % interval */
    float *margin, *reflected, *mirror, *level, *lux;
    unsigned char *verdict, *ambient;
    int    worst; /* sun; -1: none */
    bool   is_private; /* it must not be read: more contrast is worse */
} SunFigures;

/* A sweep's results under each of its suns: one symbol, one eye. */
typedef struct SweepTable {
    int              sweep_id;  /* of the review */
    SweepSun         worst_sun; /* where near that one it is worst */
    const SweepSuns *suns;      /* shared by the sweep's tables */
    SunFigures       figures;   /* [suns->count] */
    double           foreground, background; /* cd m^-2, emitted at level 1 */
    const LimitVerdict *const *asked; /* [4] the contrast limit of each ambient; NULL: none */
} SweepTable;

/* The review, and what its sweeps found of every sun. */
struct ReviewOutcome {
    Review      review;
    SweepTable *tables;
    int         table_count;
    int         responses_kept; /* of its responses: those that were not traced */
};
