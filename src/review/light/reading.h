/* SPDX-License-Identifier: Apache-2.0 */
/* reading.h -- what a probe reads under the light that is there.
 *
 * A pilot (estimate/estimate_plan.h) finds how many paths will do, because the reading is sure
 * enough then or the answer to a question is clear; so many others make the reading. Where a
 * number of paths is given, there is no pilot. Intervals are those of all estimates
 * (estimate/estimate.h).
 *
 * Where a stop is requested (render/signals.h), a reading ends at once and means nothing.
 *
 * Units    cd m^-2 (a luxmeter: lx).
 * Memory   scratch only.
 * Threads  starts its own; the same numbers for any count.
 */
#pragma once
#include "base/arena.h"
#include "estimate/estimate.h"
#include "probe/probe.h"
#include "review/light/light_parts.h"

/* Where the probe is and looks, as a hash. */
uint64_t reading_aim_hash(const ProbeAim *aim);

/* A decision that depends on a reading, such as a verdict. */
typedef struct ReadingQuestion {
    /* Is the answer the same wherever in the interval the true reading lies? The scratch is
     * that of whoever takes the reading, behind what it still needs: an asker that kept scratch
     * of its own would write over the batches. */
    bool (*is_decided)(void *user, MeanInterval reflected, Arena scratch);
    void *user;
    double precision; /* at which a decided question may end: coarser than the goal's, and
                         requested of the reading itself too */
} ReadingQuestion;

/* When a reading is sure enough: when one standard error moves the contrast of what is shown by
 * less than `precision` of it, or the reading itself. */
typedef struct ReadingGoal {
    double brighter, darker;         /* emitted, cd m^-2; both 0: the reading itself counts */
    double precision;                /* relative, above 0; or 0, without a question: `most` paths */
    long most;                       /* paths, at most */
    int times;                       /* so many times the paths that would do, for a difference to
                                        another reading; 0 is 1 */
    long least;                      /* no fewer, as many as that other one has; 0 as a rule */
    double known;                    /* the part by the display's mirror: paths leave it out
                                        (path_context.h); it is added, with the error of
                                        response_mirror_paths */
    double known_beside[2];          /* its X and Z */
    const ReadingQuestion *question; /* NULL: none */
} ReadingGoal;

/* batches are alike and independent: each has a seed of its own, its samples are well spread among
 * themselves */
#define READING_BATCHES ESTIMATE_BATCHES

typedef struct Reading {
    double reflected;                  /* Y; of a luxmeter the illuminance */
    double sigma;                      /* its standard error */
    MeanInterval interval;             /* 95 %, whether there was a question or not */
    double mirror;                     /* part via the display's mirror */
    double unseen;                     /* EstimateSums's */
    double found_share;                /* paths whose first surface was a display */
    BrightSamples bright;              /* its paths, by the light that each found */
    double batches[READING_BATCHES];   /* of each batch by itself; their mean is `reflected` */
    double beside[READING_BATCHES][2]; /* X and Z of each, where that is Y; likewise */
    double reached; /* by how much of itself one standard error moves what counts */
    long paths;     /* that it was read from; a pilot's do not count */
} Reading;

/* paths of a reading that a pilot decides; twice its pilot's, at least */
#define READING_LEAST 1024
/* with a question: light that only one path in hundreds finds must have been met */
#define READING_ASKED_LEAST 4096

Reading reading_take(const ProbeAim *aim, const ReadingGoal *goal, const ProbeTools *tools,
                     Arena scratch);

/* A reading of `paths` paths, whatever they find (a multiple of READING_BATCHES), that also
 * reports which target sends how much: to find what is read then. known: as a goal's; not in
 * targets, which are [aim->target_count] 0 before. */
Reading reading_field(const ProbeAim *aim, long paths, double known, const ProbeTools *tools,
                      TargetLight *targets, Arena scratch);
