/* SPDX-License-Identifier: Apache-2.0 */
/* path_kinds_read comes first: a pilot of both kinds, then as many fresh paths as it found.
 * read_kind takes one kind on to so many paths, a piece of the probe for each batch; from the
 * batches come the figures. */
#include "probe/path_kinds.h"

#include <math.h>

#include "base/sampler.h"
#include "estimate/estimate_plan.h"

#define MIRROR_SEED 0x6d697272u
#define PILOT_SEED 0x70696c6fu
#define LEAST 2048 /* whole paths */
#define PILOT 1024
#define REACH 32 /* estimate_plan.h */
/* so many times as many by mirrors, at least: they take a third of the time */
#define MIRRORS 4
/* Of the variance that may be, by mirrors; the rest is left to whole paths, which cost more. */
#define MIRRORS_SHARE 0.5
#define UNMET 0.1 /* of all light there: what lamps may have that no path met */

static PathKinds start(const KindPaths *like, uint32_t seed, Arena *arena) {
    PathKinds kinds = {.whole = *like, .mirrors = *like};
    kinds.whole.seed = seed;
    kinds.mirrors.seed = seed ^ MIRROR_SEED;
    kinds.mirrors.by_mirrors = true;
    for (int b = 0; b < ESTIMATE_BATCHES && like->begin; b++) {
        kinds.whole.batch[b].paths = kinds.mirrors.batch[b].paths = like;
        like->begin(&kinds.whole.batch[b], arena);
        like->begin(&kinds.mirrors.batch[b], arena);
    }
    return kinds;
}

static void read_kind(KindPaths *paths, long count, Arena scratch);
static bool mirrors_will_do(void *user, long pilot, long paths);
static bool whole_will_do(void *user, long pilot, long paths);

static void read_mirrors(void *user, long paths) {
    PathKinds *kinds = user;
    read_kind(&kinds->mirrors, paths, kinds->scratch);
}

static void read_whole(void *user, long paths) {
    PathKinds *kinds = user;
    read_kind(&kinds->whole, paths, kinds->scratch);
}

void path_kinds_read(const KindPaths *like, uint32_t seed, Arena *arena, PathKinds *out) {
    PathKinds pilot = start(like, hash_combine(hash_u32(seed), PILOT_SEED), arena);
    EstimatePlan whole = {.pilot = PILOT,
                          .least = LEAST,
                          .reach = REACH,
                          .most = like->most,
                          .user = &pilot,
                          .read_pilot = read_whole,
                          .will_do = whole_will_do};
    EstimatePlan mirrors = whole;
    mirrors.pilot *= MIRRORS;
    mirrors.least *= MIRRORS;
    mirrors.read_pilot = read_mirrors;
    mirrors.will_do = mirrors_will_do;
    *out = start(like, seed, arena);
    pilot.scratch = out->scratch = *arena;
    read_whole(&pilot, PILOT);
    pilot.mirror_paths = estimate_plan(&mirrors);
    read_whole(out, estimate_plan(&whole));
    read_mirrors(out, pilot.mirror_paths);
}

/* ---- batches ----------------------------------------------------------------------------- */

/* Each batch's points are shifted as one (Cranley and Patterson 1976), so that batches differ in
 * nothing but chance. */
static double even_place(uint32_t seed, uint32_t axis, double step, int i) {
    double x = hash_combine(hash_u32(seed), axis) * 0x1p-32 + step * i;
    return x - floor(x);
}

static void begin(ProbePart *to, Arena *arena) {
    (void)arena;
    KindPaths *paths = to->user;
    KindBatch *batch = to->own = &paths->batch[to->piece->stream];
    batch->paths = paths;
    to->piece->aim.targets = &batch->target;
}

static void before(const ProbePart *to) {
    const KindPaths *paths = to->user;
    KindBatch *batch = to->own;
    uint32_t seed = to->piece->aim.seed, axis = paths->first_axis;
    double u = even_place(seed, axis, EVEN_STEP_U, to->piece->path);
    double v = even_place(seed, axis + 1, EVEN_STEP_V, to->piece->path);
    batch->target = vec3_add(paths->eye, paths->towards(batch, u, v));
    for (int k = 0; k < KIND_FIGURES; k++) batch->path[k] = 0;
}

static void after(const ProbePart *to) {
    KindBatch *batch = to->own;
    for (int k = 0; k < KIND_FIGURES; k++) {
        batch->sum[k] += batch->path[k];
        bright_add(&batch->bright[k], batch->path[k]);
    }
}

/* Goes on to so many paths in all, a multiple of ESTIMATE_BATCHES. */
static void read_kind(KindPaths *paths, long count, Arena scratch) {
    int end = (int)(count / ESTIMATE_BATCHES);
    ProbeAim aim = {
        .context = paths->context, .eye = paths->eye, .target_count = 1, .seed = paths->seed};
    ProbeGoal goal = {.pieces = ESTIMATE_BATCHES,
                      .paths = end - paths->end,
                      .first = paths->end,
                      .streams = ESTIMATE_BATCHES,
                      .like = {.is_polarised = paths->is_polarised,
                               .reach = paths->by_mirrors ? PATH_BY_MIRRORS : PATH_TO_ITS_END}};
    ProbeFold fold = {.user = paths,
                      .begin = begin,
                      .before = before,
                      .on_light = paths->on_light,
                      .on_mirror = paths->on_mirror,
                      .after = after};
    probe_read(&aim, &goal, paths->tools, &fold, 1, scratch);
    paths->end = end;
    for (int k = 0; k < KIND_FIGURES && paths->by_mirrors && paths->unmet_of; k++)
        paths->unmet[k] = paths->unmet_of(paths, k, scratch);
}

/* ---- figures ----------------------------------------------------------------------------- */

/* With what may have come by mirrors that were not met. */
static EstimateSums sums_of(const KindPaths *paths, int figure) {
    EstimateSums sums = {.batches = ESTIMATE_BATCHES,
                         .piece = 1,
                         .share = 1,
                         .paths = (long)paths->end * ESTIMATE_BATCHES};
    for (int b = 0; b < ESTIMATE_BATCHES; b++) {
        const KindBatch *batch = &paths->batch[b];
        sums.batch[b] = batch->sum[figure];
        bright_merge(&sums.bright, &batch->bright[figure]);
    }
    sums.unmet = estimate_unmet(paths->unmet[figure], (double)sums.paths);
    return sums;
}

Estimate path_kind_estimate(const KindPaths *paths, int figure) {
    EstimateSums sums = sums_of(paths, figure);
    return estimate_of(&sums);
}

Estimate path_kinds_figure(const PathKinds *kinds, int figure) {
    EstimateSums sums = sums_of(&kinds->whole, figure), mirrors = sums_of(&kinds->mirrors, figure);
    estimate_sums_add(&sums, &mirrors);
    return estimate_of(&sums);
}

/* ---- how many ---------------------------------------------------------------------------- */

static bool mirrors_will_do(void *user, long pilot, long paths) {
    const PathKinds *kinds = user;
    double all = 0, unmet = 0;
    for (int i = 0; i < 2; i++) {
        int figure = kinds->whole.planned[i];
        Estimate mirrors = path_kind_estimate(&kinds->mirrors, figure);
        Estimate then = estimate_expected(&mirrors, (double)paths / (double)pilot);
        double mean = path_kind_estimate(&kinds->whole, figure).mean + mirrors.mean;
        if (then.sigma > kinds->whole.precision * mean * sqrt(MIRRORS_SHARE)) return false;
        all += mean;
        unmet = fmax(unmet, then.unmet);
    }
    return unmet <= UNMET * all;
}

/* What mirrors are expected to leave unsure is known. */
static bool whole_will_do(void *user, long pilot, long paths) {
    const PathKinds *kinds = user;
    double times = (double)kinds->mirror_paths / (double)(kinds->mirrors.end * ESTIMATE_BATCHES);
    for (int i = 0; i < 2; i++) {
        int figure = kinds->whole.planned[i];
        Estimate whole = path_kind_estimate(&kinds->whole, figure);
        Estimate mirrors = path_kind_estimate(&kinds->mirrors, figure);
        double most = kinds->whole.precision * (whole.mean + mirrors.mean);
        double left = kinds->whole.is_halved ? most * sqrt(MIRRORS_SHARE)
                                             : estimate_expected(&mirrors, times).sigma;
        if (hypot(estimate_expected(&whole, (double)paths / (double)pilot).sigma, left) > most)
            return false;
    }
    return true;
}

/* ---- where light came from --------------------------------------------------------------- */

bool path_is_pane(const Scene *scene, int part_id) {
    return scene->materials[scene->parts[part_id].material_id].transmission > 0;
}

int path_mirroring_step(const Scene *scene, const PathHistory *history) {
    int kept = path_steps_kept(history), i = 0;
    while (i < kept && history->step[i].event == PATH_TRANSMITS) i++;
    bool mirrors = i < kept && history->step[i].event == PATH_REFLECTS &&
                   path_is_pane(scene, history->step[i].part_id);
    return mirrors ? i : NO_ID;
}

bool path_is_by_mirrors(const PathHistory *history) {
    if (history->count > PATH_STEPS_MAX) return false;
    for (int i = 0; i < history->count; i++)
        if (history->step[i].event == PATH_SCATTERS) return false;
    return true;
}
