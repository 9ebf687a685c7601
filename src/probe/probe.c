/* SPDX-License-Identifier: Apache-2.0 */
/* probe_read comes first: rounds of pieces, each of them begun, followed and merged.
 * follow_piece is what a thread does with one: path by path, whose light is handed to every
 * fold. */
#include "probe/probe.h"

#include <stddef.h>

#include "base/parallel.h"
#include "base/sampler.h"
#include "render/signals.h"

typedef struct PieceWork {
    const struct Round *round;
    ProbePiece piece;
    ProbePart parts[PROBE_FOLDS];
} PieceWork;

typedef struct Round {
    const ProbeGoal *goal;
    const Kernel *kernel;
    const ProbeFold *folds;
    int fold_count;
    PieceWork *pieces;
} Round;

static void begin_piece(PieceWork *work, const ProbeAim *aim, int id, Arena *arena);
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
            round.pieces[i].round = &round;
            begin_piece(&round.pieces[i], aim, first + i, &room);
        }
        parallel_for(tools->threads, count, follow_piece, &round);
        for (int i = 0; i < count * fold_count; i++)
            if (folds[i % fold_count].merge)
                folds[i % fold_count].merge(&round.pieces[i / fold_count].parts[i % fold_count]);
    }
}

static void begin_piece(PieceWork *work, const ProbeAim *aim, int id, Arena *arena) {
    const ProbeGoal *goal = work->round->goal;
    int streams = goal->streams ? goal->streams : 1;
    int first = goal->first + id / streams * goal->paths;
    work->piece = (ProbePiece){
        .id = id, .stream = id % streams, .first = first, .end = first + goal->paths, .aim = *aim};
    if (goal->streams) {
        work->piece.aim.seed = hash_combine(hash_u32(aim->seed), (uint32_t)work->piece.stream);
        work->piece.aim.is_spread = true;
    }
    for (int k = 0; k < work->round->fold_count; k++) {
        const ProbeFold *fold = &work->round->folds[k];
        void *own = fold->bytes ? arena_alloc(arena, fold->bytes, _Alignof(max_align_t), 1) : NULL;
        work->parts[k] = (ProbePart){fold->user, own, &work->piece};
        if (fold->begin) fold->begin(&work->parts[k], arena);
    }
}

/* ---- one piece --------------------------------------------------------------------------- */

static void on_light(void *user, const PathHistory *history, const float xyz[3]) {
    const PieceWork *work = user;
    for (int k = 0; k < work->round->fold_count; k++)
        work->round->folds[k].on_light(&work->parts[k], history, xyz);
}

static void on_mirror(void *user, const PathHistory *history, Vec3 towards, float share) {
    const PieceWork *work = user;
    for (int k = 0; k < work->round->fold_count; k++)
        if (work->round->folds[k].on_mirror)
            work->round->folds[k].on_mirror(&work->parts[k], history, towards, share);
}

static void follow_piece(void *user, int item, int worker) {
    (void)worker;
    const Round *round = user;
    PieceWork *work = &round->pieces[item];
    ProbePiece *piece = &work->piece;
    const ProbeFold *folds = round->folds, *last = folds + round->fold_count - 1;
    PathListener listener = round->goal->like;
    int step = round->goal->together ? round->goal->together : 1;
    ProbeLook look;
    listener.user = work;
    listener.on_light = on_light;
    listener.on_mirror = folds->on_mirror || last->on_mirror ? on_mirror : NULL;
    if (folds->ask) {
        folds->ask(&work->parts[0], round->kernel);
        return;
    }
    for (int path = piece->first; path < piece->end && !signals_stop_requested(); path += step) {
        int end = path + step < piece->end ? path + step : piece->end;
        piece->path = path;
        for (int k = 0; k < round->fold_count; k++)
            if (folds[k].before) folds[k].before(&work->parts[k]);
        if (folds->look)
            round->kernel->look(&piece->aim, path, path + 1, &look, &piece->statistics);
        else round->kernel->trace(&piece->aim, path, end, &listener, &piece->statistics);
        for (int k = 0; k < round->fold_count; k++) {
            if (folds[k].look) folds[k].look(&work->parts[k], &look);
            if (folds[k].after) folds[k].after(&work->parts[k]);
        }
    }
}
