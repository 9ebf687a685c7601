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
    void *own;                 /* the asker's, set by `begin` */
    Vec3 target;               /* of the path at work; */
    double path[KIND_FIGURES]; /* its light: its listener adds to it; and of all */
    double sum[KIND_FIGURES];
    BrightSamples bright[KIND_FIGURES];
} KindBatch;

typedef struct KindPaths {
    const ProbeTools *tools;
    const PathContext *context;
    Vec3 eye;
    const void *goal; /* the asker's */
    void (*begin)(KindBatch *batch, Arena *arena);
    Vec3 (*towards)(KindBatch *batch, double u, double v); /* u, v: in [0, 1) */
    uint32_t first_axis;                                   /* of the random shifts of u and v */
    bool is_polarised;                                     /* PathListener's, as are these: */
    void (*on_light)(const ProbePart *batch, const PathHistory *history, const float xyz[3]);
    void (*on_mirror)(const ProbePart *batch, const PathHistory *history, Vec3 towards,
                      float share);
    double (*unmet_of)(const struct KindPaths *paths, int figure, Arena scratch); /* or NULL */
    double precision; /* relative standard error of each figure that is planned, unless it takes */
    int most;         /* more paths than that */
    int planned[2];   /* figures */
    bool is_halved;   /* half of their variance is whole paths', even if mirrors leave more */
    /* Of one kind, as far as it is read: */
    bool by_mirrors;
    uint32_t seed;
    int end; /* paths of every batch */
    KindBatch batch[ESTIMATE_BATCHES];
    double unmet[KIND_FIGURES]; /* the most that a path may have missed, of paths by mirrors */
} KindPaths;

typedef struct PathKinds {
    KindPaths whole, mirrors;
    long mirror_paths; /* of a pilot: that will do */
    Arena scratch;
} PathKinds;

/* As many fresh paths of both kinds as a pilot finds. What batches have of the arena stays. */
void path_kinds_read(const KindPaths *like, uint32_t seed, Arena *arena, PathKinds *out);

/* Of paths of one kind as far as they are read. */
Estimate path_kind_estimate(const KindPaths *paths, int figure);

/* Of both. */
Estimate path_kinds_figure(const PathKinds *kinds, int figure);

/* ---- where light came from --------------------------------------------------------------- */

/* Glass. */
bool path_is_pane(const Scene *scene, int part_id);

/* The step at which a pane mirrors what the eye sees there; NO_ID: none does. */
int path_mirroring_step(const Scene *scene, const PathHistory *history);

/* By no more surfaces than are kept: of others nobody knows. */
bool path_is_by_mirrors(const PathHistory *history);
