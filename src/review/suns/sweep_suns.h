/* SPDX-License-Identifier: Apache-2.0 */
/* sweep_suns.h -- the suns of a sweep: where each stands, and how much of it counts.
 *
 * Units    degrees; minutes. Azimuths of the vehicle (0 ahead, 90 right) and of the compass.
 * Memory   from the arena.
 * Threads  const once made; the suns of a year are found by several; the same for any count.
 */
#pragma once
#include "review/light/distant_probe.h"
#include "review/request/request.h"

typedef struct SweepSun {
    double azimuth_deg, elevation_deg; /* of the vehicle; apparent */
    double compass_deg;                /* azimuth from north; of a sun sweep that of the vehicle */
    double heading_deg;
    double minutes;       /* that it stands for; sun sweep: 0 */
    int step;             /* of time: year; -1 */
    int heading_id;       /* year; 0 */
    double later_minutes; /* than the middle of its step */
    double light;         /* over that at 1 au, by the earth's distance; sun sweep: 1 */
} SweepSun;

typedef struct SweepSuns {
    const SweepSun *list;
    DistantSun *distant; /* the same, for probes */
    int count;
    bool has_time;                          /* suns of one heading_id follow each other in time */
    double step_minutes;                    /* year */
    ReviewRange azimuth_deg, elevation_deg; /* sun sweep: azimuths of the first elevation,
                                               then of the next */
} SweepSuns;

/* The time of a step of a year, UTC; the condition's steps or others. */
SkyTime sweep_time(const ReviewCondition *condition, double step_minutes, double step);

/* Those that are up, and with `with_night` all. */
SweepSuns sweep_suns(const ReviewCondition *condition, int threads, Arena *arena);

/* Suns about one of them, closer than the sweep's own: SWEEP_CLOSE_DEG apart and as far as its
 * neighbours, in rounds about what the round before found (a sweep over the sun: two; a year:
 * one, along the sun's way). One sun, `sun` itself: there is no closer round. */
#define SWEEP_CLOSE_DEG 0.1
SweepSuns sweep_suns_about(const ReviewCondition *condition, const SweepSun *sun, int round,
                           Arena *arena);

/* A year's suns `later_minutes` after their steps' middles, also below the horizon. Sets the
 * places in `list`, which must outlive the result. */
SweepSuns sweep_suns_later(const ReviewCondition *condition, SweepSun *list, int count,
                           Arena *arena);

/* Date, time and heading of one of them; NULL: a sweep without times. */
const char *sweep_suns_when(const ReviewCondition *condition, const SweepSuns *suns,
                            const SweepSun *sun, Arena *arena);

/* Between where two suns stand as the vehicle sees them. */
double sweep_suns_apart_deg(const SweepSun *a, const SweepSun *b);

/* For how long a sweep fails, also between the steps at which it was sampled.
 *
 * Steps that fail one after the other are a stretch. Where it begins and ends is looked for
 * between the steps, so that hours do not round every failure to hours: to a minute; where
 * there are many, until their sum is known to 1 in 1,000, and the longest to a minute. A
 * stretch shorter than a step is met by a step as seldom as it is shorter: it then counts as a
 * whole one, for those that no step met.
 *
 * Step     fails by its figure; a stretch counts when one of its steps fails for sure, by all
 *          of its interval.
 * Units    minutes.
 * Memory   scratch only.
 * Threads  those of the FailureArgs. */

typedef enum StepState { STEP_PASSES, STEP_FAILS, STEP_FAILS_SURELY } StepState;

/* Fills states[suns->count] for suns between steps. */
typedef struct FailureArgs {
    void (*states)(void *user, const SweepSuns *suns, unsigned char *states, Arena scratch);
    void *user;
} FailureArgs;

typedef struct Failures {
    double share;           /* of the time, 0..1 */
    double longest_minutes; /* of the stretches */
} Failures;

/* For sweeps that have times. args NULL: a stretch ends with its steps. */
Failures sweep_failures(const ReviewCondition *condition, const SweepSuns *suns,
                        const unsigned char *states, const FailureArgs *args, Arena scratch);
