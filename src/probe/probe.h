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
    int together;      /* paths that listeners follow at once, of which none is known by its
                          number; 0: one */
    PathListener like; /* what listeners want of paths; its functions are the folds' */
} ProbeGoal;

/* Paths that one thread follows. */
typedef struct ProbePiece {
    int id;                    /* in the order of pieces */
    int stream;                /* 0 if there is one */
    int first, end;            /* its paths, half open; */
    ProbeAim aim;              /* by which they go: `begin` may set other ones */
    int path;                  /* at work */
    PathStatistics statistics; /* its paths', when they are done */
} ProbePiece;

/* Where a fold's part of a piece goes. */
typedef struct ProbePart {
    void *user; /* ProbeFold's */
    void *own;  /* its bytes, 0 at first; or what `begin` sets */
    ProbePiece *piece;
} ProbePart;

/* What becomes of the light, which comes by on_light and on_mirror (path/collect/history.h), by
 * look, or as `ask` asks for it; what else is NULL is not called. */
typedef struct ProbeFold {
    void *user;
    size_t bytes; /* of a piece, until it is merged */
    /* In order. The arena's memory is there until the piece is merged. */
    void (*begin)(ProbePart *to, Arena *arena);
    /* By the piece's thread, for each of its paths. */
    void (*before)(const ProbePart *to);
    void (*on_light)(const ProbePart *to, const PathHistory *history, const float xyz[3]);
    void (*on_mirror)(const ProbePart *to, const PathHistory *history, Vec3 towards, float share);
    void (*look)(const ProbePart *to, const ProbeLook *look);
    void (*ask)(const ProbePart *to, const Kernel *kernel); /* all of the piece's paths at once */
    void (*after)(const ProbePart *to);
    /* In order. */
    void (*merge)(const ProbePart *from);
} ProbeFold;

#define PROBE_FOLDS 2 /* at most */

/* fold_count: 1 .. PROBE_FOLDS; two take the light of the same paths, in the same way; one
 * that asks is alone. */
void probe_read(const ProbeAim *aim, const ProbeGoal *goal, const ProbeTools *tools,
                const ProbeFold *folds, int fold_count, Arena scratch);
