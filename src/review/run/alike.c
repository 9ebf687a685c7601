/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/alike.h"

#include <math.h>
#include <string.h>

#include "review/run/symbols.h"

#define PATHS 1024 /* of the part, and of the whole from all points together */
#define PIECE 64
#define SEED 0x616c696bu
#define POINT_APART 0.05 /* the precision to which the worst point is looked for */

/* The part, then the whole from each point. */
struct CasePilot {
    int aim_count;
    int *first;   /* [aim_count + 1] its paths */
    float *light; /* [path] */
    double mirror;
    int display_count;
    float *levels;      /* of the displays */
    bool is_relevelled; /* nothing else may be other than in the review */
};

typedef struct AlikeWork {
    const ProbeAim *aims;
    const CasePilot *pilot;
} AlikeWork;

/* All points' paths, a piece each, or the part's pieces. */
static void begin_piece(ProbePart *to, Arena *arena) {
    (void)arena;
    const AlikeWork *work = to->user;
    ProbePiece *piece = to->piece;
    int aim = piece->id / (PATHS / PIECE), first = work->pilot->first[aim];
    int count = work->pilot->first[aim + 1] - first;
    piece->aim = work->aims[aim];
    piece->first = piece->id % (PATHS / PIECE) * PIECE;
    piece->end = !piece->aim.target_count       ? 0
                 : piece->first + PIECE < count ? piece->first + PIECE
                                                : count;
    to->own = &work->pilot->light[first];
}

static void take_look(const ProbePart *to, const ProbeLook *look) {
    if (look->is_found) ((float *)to->own)[to->piece->path] = look->reflected[1];
}

const CasePilot *case_pilot(const PilotArgs *args, Arena *arena) {
    int count = 1 + args->point_count;
    const Scene *scene = args->setup->scene;
    CasePilot *pilot = ARENA_NEW(arena, CasePilot, 1);
    *pilot = (CasePilot){.aim_count = count,
                         .first = ARENA_NEW(arena, int, count + 1),
                         .light = ARENA_NEW(arena, float, 2 * PATHS),
                         .mirror = args->mirror,
                         .display_count = scene->display_count,
                         .levels = ARENA_NEW(arena, float, scene->display_count),
                         .is_relevelled = args->setup->request->is_relevelled};
    for (int i = 0; i < scene->display_count; i++) pilot->levels[i] = scene->displays[i].level;
    for (int i = 1; i <= count; i++) pilot->first[i] = PATHS + PATHS * (i - 1) / args->point_count;
    Arena scratch = *arena;
    PathContext without = *args->part->context;
    ProbeAim *aims = ARENA_NEW(&scratch, ProbeAim, count);
    aims[0] = *args->part;
    aims[0].context = &without;
    aims[0].seed = review_seed(args->setup->request, SEED);
    aims[0].is_spread = true;
    for (int i = 1; i < count; i++) {
        aims[i] = aims[0];
        aims[i].eye = args->points[i - 1];
        symbol_aim(args->surface, &scratch, &aims[i]);
    }
    without.without_mirrored_sun = args->mirror > 0;
    AlikeWork work = {aims, pilot};
    ProbeGoal goal = {.pieces = count * (PATHS / PIECE)};
    ProbeFold fold = {.user = &work, .begin = begin_piece, .look = take_look};
    probe_read(&aims[0], &goal, &args->setup->tools, &fold, 1, scratch);
    return pilot;
}

/* All that makes the light. */
static bool is_one(const CasePilot *before, const CasePilot *after) {
    return after->is_relevelled && before->display_count == after->display_count &&
           memcmp(before->levels, after->levels,
                  (size_t)before->display_count * sizeof *before->levels) == 0;
}

/* The upper end of sign times after less before, of some paths. */
static double most_more(const float *before, const float *after, double sign, double mean) {
    EstimateSums sums = {.batches = ESTIMATE_BATCHES, .paths = PATHS, .piece = 1, .share = 1};
    bool is_same = true;
    for (int i = 0; i < PATHS; i++) {
        double more = sign * ((double)after[i] - (double)before[i]);
        sums.batch[i % ESTIMATE_BATCHES] += more;
        bright_add(&sums.bright, fabs(more));
        is_same = is_same && more == 0;
    }
    if (is_same) sums.unmet = estimate_unmet(mean, PATHS);
    return estimate_of(&sums).interval.high;
}

/* Of PATHS of them, and what is known without. */
static double apart(const float *before, const float *after, double known, double moved) {
    double mean = 0;
    for (int i = 0; i < PATHS; i++) mean += (double)before[i] / PATHS;
    double more = fmax(most_more(before, after, 1, mean), most_more(before, after, -1, mean));
    return mean + known > 0 ? (more + moved) / (mean + known) : (double)INFINITY;
}

static bool is_point_alike(const CasePilot *before, const CasePilot *after, int point) {
    double sum = 0, moved = 0;
    for (int i = before->first[point]; i < before->first[point + 1]; i++) {
        sum += (double)before->light[i];
        moved += fabs((double)after->light[i] - (double)before->light[i]);
    }
    return moved <= POINT_APART * sum;
}

double case_pilots_apart(const CasePilot *before, const CasePilot *after) {
    if (before->aim_count != after->aim_count) return (double)INFINITY;
    for (int i = 1; i < before->aim_count && before->aim_count > 2; i++)
        if (!is_point_alike(before, after, i)) return (double)INFINITY;
    if (is_one(before, after) &&
        memcmp(before->light, after->light, 2 * PATHS * sizeof(float)) == 0)
        return fabs(after->mirror - before->mirror) > 0 ? (double)INFINITY : 0;
    double part =
        apart(before->light, after->light, before->mirror, fabs(after->mirror - before->mirror));
    return fmax(part, apart(before->light + PATHS, after->light + PATHS, 0, 0));
}
