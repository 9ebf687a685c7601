/* SPDX-License-Identifier: Apache-2.0 */
/* probe.h -- light to a place: sends paths out by an aim and folds what they find. No other room
 * asks the kernel to trace or to look.
 *
 * An aim (kernel/aim.h) says where paths begin and where they go, a goal how many there are and
 * which belong together, folds what becomes of their light. How many paths a precision takes is
 * found before, by a pilot (estimate/estimate_plan.h); the kinds of path by which light comes
 * have a page of their own (path_kinds.h).
 *
 * The order of things: paths are cut into pieces. A piece begins, in order; one thread follows
 * its paths, in order, into sums of the piece's own; pieces are merged, in order. So the result
 * has the same bits for any number of threads and of pieces at once.
 *
 * Where a stop is requested (render/signals.h), a probe ends at once and what it has found means
 * nothing.
 *
 * Units    the aim's: cd m^-2, or lx of a luxmeter.
 * Memory   scratch: the sums of as many pieces as are kept at once.
 * Threads  starts its own.
 * Fails    never.
 */
#pragma once
#include "kernel/kernel.h"

typedef struct ProbeTools {
    const Kernel *kernel;
    int threads;
} ProbeTools;

typedef struct ProbeGoal {
    int pieces;        /* in all; their paths are */
    int paths;         /* of each, */
    int first;         /* and those of a stream begin with this one */
    int streams;       /* piece i is of stream i % streams, in which it follows the one before. A
                          stream has random numbers of its own and takes targets by chance
                          (ProbeAim.is_spread); 0: all are of one, that of the aim as it is */
    int at_once;       /* pieces that are kept until they are merged; 0: all */
    PathReach reach;   /* of listeners */
    bool is_polarised; /* likewise */
} ProbeGoal;

/* Paths that one thread follows. */
typedef struct ProbePiece {
    int id;                    /* in the order of pieces */
    int stream;                /* 0 if there is one */
    int first, end;            /* its paths, half open; */
    ProbeAim aim;              /* by which they go: `begin` may set other ones */
    PathStatistics statistics; /* theirs, when they are done */
} ProbePiece;

/* What becomes of the light: pieces by listeners or by looks. Functions that are NULL are not
 * called, but one of on_light and look is required. `sums` is what `begin` returned. */
typedef struct ProbeFold {
    void *user;
    /* Where the light of a piece goes: zeros of the arena, which are there until the piece is
     * merged, or memory of the caller's own. NULL: to the user. */
    void *(*begin)(void *user, ProbePiece *piece, Arena *arena);
    /* By the piece's thread: before a path; its light (path/collect/history.h); when it is done. */
    void (*before)(void *sums, int path);
    void (*on_light)(void *sums, const PathHistory *history, const float xyz[3]);
    void (*on_mirror)(void *sums, const PathHistory *history, Vec3 towards, float share);
    bool with_lanes, with_extrapolated; /* PathListener's */
    void (*look)(void *sums, int path, const ProbeLook *look);
    void (*after)(void *sums, int path);
    /* By the caller's thread, piece by piece. */
    void (*merge)(void *user, const ProbePiece *piece, void *sums);
} ProbeFold;

/* fold_count: at least 1; several take the light of the same paths, all of them by listeners or
 * all by looks. */
void probe_read(const ProbeAim *aim, const ProbeGoal *goal, const ProbeTools *tools,
                const ProbeFold *folds, int fold_count, Arena scratch);
