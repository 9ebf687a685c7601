/* SPDX-License-Identifier: Apache-2.0 */
/* probe_read comes first: rounds of pieces, each of them begun, traced and merged. follow_piece
 * is what a thread does with one: some paths at a time, or path by path where a fold wants to
 * know which one is at work. The listener below it hands light on to every fold. */
#include "probe/probe.h"

#include "base/parallel.h"
#include "base/sampler.h"
#include "render/signals.h"

#define LOOKS 64 /* paths that are followed before a stop is noticed */

typedef struct Round {
    const ProbeGoal *goal;
    const Kernel *kernel;
    const ProbeFold *folds;
    int fold_count;
    struct PieceWork *pieces;
} Round;

typedef struct PieceWork {
    ProbePiece piece;
    const Round *round;
    void **sums; /* [fold] */
} PieceWork;

static ProbePiece piece_of(const ProbeAim *aim, const ProbeGoal *goal, int id) {
    int streams = goal->streams ? goal->streams : 1;
    int first = goal->first + id / streams * goal->paths;
    ProbePiece piece = {
        .id = id, .stream = id % streams, .first = first, .end = first + goal->paths, .aim = *aim};
    if (goal->streams) {
        piece.aim.seed = hash_combine(hash_u32(aim->seed), (uint32_t)piece.stream);
        piece.aim.is_spread = true;
    }
    return piece;
}

static void follow_piece(void *user, int item, int worker);

void probe_read(const ProbeAim *aim, const ProbeGoal *goal, const ProbeTools *tools,
                const ProbeFold *folds, int fold_count, Arena scratch) {
    Round round = {.goal = goal, .kernel = tools->kernel, .folds = folds, .fold_count = fold_count};
    int at_once = goal->at_once ? goal->at_once : goal->pieces, count;
    for (int first = 0; first < goal->pieces && !signals_stop_requested(); first += count) {
        Arena room = scratch;
        count = goal->pieces - first < at_once ? goal->pieces - first : at_once;
        round.pieces = ARENA_NEW(&room, PieceWork, count);
        for (int i = 0; i < count; i++) {
            PieceWork *work = &round.pieces[i];
            *work = (PieceWork){.piece = piece_of(aim, goal, first + i),
                                .round = &round,
                                .sums = ARENA_NEW(&room, void *, fold_count)};
            for (int k = 0; k < fold_count; k++)
                work->sums[k] = folds[k].begin ? folds[k].begin(folds[k].user, &work->piece, &room)
                                               : folds[k].user;
        }
        parallel_for(tools->threads, count, follow_piece, &round);
        for (int i = 0; i < count; i++)
            for (int k = 0; k < fold_count; k++)
                if (folds[k].merge)
                    folds[k].merge(folds[k].user, &round.pieces[i].piece, round.pieces[i].sums[k]);
    }
}

/* ---- one piece --------------------------------------------------------------------------- */

static void on_light(void *user, const PathHistory *history, const float xyz[3]) {
    const PieceWork *work = user;
    for (int k = 0; k < work->round->fold_count; k++)
        work->round->folds[k].on_light(work->sums[k], history, xyz);
}

static void on_mirror(void *user, const PathHistory *history, Vec3 towards, float share) {
    const PieceWork *work = user;
    for (int k = 0; k < work->round->fold_count; k++)
        if (work->round->folds[k].on_mirror)
            work->round->folds[k].on_mirror(work->sums[k], history, towards, share);
}

static PathListener listener_of(PieceWork *work) {
    const Round *round = work->round;
    PathListener listener = {.on_light = on_light,
                             .user = work,
                             .is_polarised = round->goal->is_polarised,
                             .reach = round->goal->reach};
    for (int k = 0; k < round->fold_count; k++) {
        const ProbeFold *fold = &round->folds[k];
        if (fold->on_mirror) listener.on_mirror = on_mirror;
        listener.with_lanes |= fold->with_lanes;
        listener.with_extrapolated |= fold->with_extrapolated;
    }
    return listener;
}

static void look(PieceWork *work, int first, int end) {
    ProbeLook looks[LOOKS];
    const Round *round = work->round;
    round->kernel->look(&work->piece.aim, first, end, looks, &work->piece.statistics);
    for (int path = first; path < end; path++)
        for (int k = 0; k < round->fold_count; k++)
            round->folds[k].look(work->sums[k], path, &looks[path - first]);
}

static void follow_piece(void *user, int item, int worker) {
    (void)worker;
    const Round *round = user;
    PieceWork *work = &round->pieces[item];
    ProbePiece *piece = &work->piece;
    PathListener listener = listener_of(work);
    int step = LOOKS, end;
    for (int k = 0; k < round->fold_count; k++)
        if (round->folds[k].before || round->folds[k].after) step = 1;
    for (int path = piece->first; path < piece->end && !signals_stop_requested(); path = end) {
        end = path + step < piece->end ? path + step : piece->end;
        for (int k = 0; k < round->fold_count; k++)
            if (round->folds[k].before) round->folds[k].before(work->sums[k], path);
        if (round->folds[0].look) look(work, path, end);
        else round->kernel->trace(&piece->aim, path, end, &listener, &piece->statistics);
        for (int k = 0; k < round->fold_count; k++)
            if (round->folds[k].after) round->folds[k].after(work->sums[k], path);
    }
}
