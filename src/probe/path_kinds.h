/* SPDX-License-Identifier: Apache-2.0 */
/* path_kinds.h -- figures of what an eye sees in some directions, by paths of two kinds.
 *
 * Light that comes by mirrors and panes alone is found by chance, and its source may be small:
 * cheap paths of its own, that end where something scatters, find it. All other light is left
 * to whole paths. Both kinds add up. A pilot shows how many of each it takes; fresh ones make
 * the figures (estimate/estimate.h).
 *
 * Units    cd m^-2; metres, scene.
 * Threads  starts its own; the same figures for any count.
 */
#pragma once
#include "estimate/estimate.h"
#include "probe/probe.h"

#define KIND_FIGURES 3 /* at most */

/* One over the root of x^3 = x + 1, and its square: points that fill a square evenly, however
 * many (M. Roberts' sequence). */
#define EVEN_STEP_U 0.7548776662466927
#define EVEN_STEP_V 0.5698402909980532

typedef struct KindBatch {
    const struct KindPaths *paths;
    void *own;                 /* the asker's */
    uint32_t seed;             /* of its random numbers */
    Vec3 target;               /* where the path at work goes */
    double path[KIND_FIGURES]; /* of the path at work: its listener adds to it; and of all */
    double sum[KIND_FIGURES];
    BrightSamples bright[KIND_FIGURES];
} KindBatch;

typedef struct KindPaths {
    const ProbeTools *tools;
    const PathContext *context;
    Vec3 eye;
    const void *goal;                                      /* the asker's */
    Vec3 (*towards)(KindBatch *batch, double u, double v); /* u, v: in [0, 1) */
    uint32_t first_axis;                                   /* of the random shifts of u and v */
    PathListener listener;                                 /* its user becomes the batch */
    double (*unmet_of)(const struct KindPaths *paths, int figure, Arena scratch); /* or NULL */
    bool by_mirrors;
    uint32_t seed;
    int end; /* paths of every batch that are read */
    KindBatch batch[ESTIMATE_BATCHES];
    double unmet[KIND_FIGURES]; /* the most that a path may have missed, of paths by mirrors */
} KindPaths;

typedef struct PathKinds {
    KindPaths whole, mirrors;
    long whole_paths, mirror_paths; /* that will do */
    Arena scratch;
} PathKinds;

/* Both kinds alike but for seed and by_mirrors; `own` and scratch are yet to be set. */
PathKinds path_kinds_start(const KindPaths *like, uint32_t seed);

/* Of paths of one kind as far as they are read. */
Estimate path_kind_estimate(const KindPaths *paths, int figure);

/* Reads the pilot: at most so many whole paths, and as many by mirrors. will_do: estimate_plan.h;
 * their user is the pilot. */
typedef bool KindsWillDo(void *pilot, long count, long paths);
void path_kinds_plan(PathKinds *pilot, int most, KindsWillDo *mirrors_will_do,
                     KindsWillDo *whole_will_do);

/* As many fresh ones as the pilot found. */
void path_kinds_read(PathKinds *fresh, const PathKinds *pilot);

Estimate path_kinds_figure(const PathKinds *kinds, int figure);

/* ---- where light came from --------------------------------------------------------------- */

/* Glass. */
bool path_is_pane(const Scene *scene, int part_id);

/* The step at which a pane mirrors what the eye sees there; NO_ID: none does. */
int path_mirroring_step(const Scene *scene, const PathHistory *history);

/* By no more surfaces than are kept: of others nobody knows. */
bool path_is_by_mirrors(const PathHistory *history);
