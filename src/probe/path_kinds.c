/* SPDX-License-Identifier: Apache-2.0 */
#include "probe/path_kinds.h"

#include <math.h>

#include "base/sampler.h"
#include "estimate/estimate_plan.h"

#define MIRROR_SEED 0x6d697272u
#define LEAST 2048 /* whole paths */
#define PILOT 1024
#define REACH 32 /* estimate_plan.h */
/* so many times as many by mirrors, at least: they take a third of the time */
#define MIRRORS 4

PathKinds path_kinds_start(const KindPaths *like, uint32_t seed) {
    PathKinds kinds = {.whole = *like, .mirrors = *like};
    kinds.whole.seed = seed;
    kinds.mirrors.seed = seed ^ MIRROR_SEED;
    kinds.mirrors.by_mirrors = true;
    return kinds;
}

/* ---- batches ----------------------------------------------------------------------------- */

/* Each batch's points are shifted as one (Cranley and Patterson 1976), so that batches differ in
 * nothing but chance. */
static double even_place(uint32_t seed, uint32_t axis, double step, int i) {
    double x = hash_combine(hash_u32(seed), axis) * 0x1p-32 + step * i;
    return x - floor(x);
}

static void *begin(void *user, ProbePiece *piece, Arena *arena) {
    (void)arena;
    KindPaths *paths = user;
    KindBatch *batch = &paths->batch[piece->stream];
    batch->paths = paths;
    batch->seed = piece->aim.seed;
    piece->aim.targets = &batch->target;
    return batch;
}

static void before(void *sums, int path) {
    KindBatch *batch = sums;
    const KindPaths *paths = batch->paths;
    double u = even_place(batch->seed, paths->first_axis, EVEN_STEP_U, path);
    double v = even_place(batch->seed, paths->first_axis + 1, EVEN_STEP_V, path);
    batch->target = vec3_add(paths->eye, paths->towards(batch, u, v));
    for (int k = 0; k < KIND_FIGURES; k++) batch->path[k] = 0;
}

static void after(void *sums, int path) {
    (void)path;
    KindBatch *batch = sums;
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
                      .reach = paths->by_mirrors ? PATH_BY_MIRRORS : PATH_TO_ITS_END,
                      .is_polarised = paths->listener.is_polarised};
    ProbeFold fold = {.user = paths,
                      .begin = begin,
                      .before = before,
                      .on_light = paths->listener.on_light,
                      .on_mirror = paths->listener.on_mirror,
                      .after = after};
    probe_read(&aim, &goal, paths->tools, &fold, 1, scratch);
    paths->end = end;
    for (int k = 0; k < KIND_FIGURES && paths->by_mirrors && paths->unmet_of; k++)
        paths->unmet[k] = paths->unmet_of(paths, k, scratch);
}

static void read_mirrors(void *user, long paths) {
    PathKinds *kinds = user;
    read_kind(&kinds->mirrors, paths, kinds->scratch);
}

static void read_whole(void *user, long paths) {
    PathKinds *kinds = user;
    read_kind(&kinds->whole, paths, kinds->scratch);
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
        sums.bright.squares += batch->bright[figure].squares;
        sums.bright.fourths += batch->bright[figure].fourths;
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

void path_kinds_plan(PathKinds *pilot, int most, KindsWillDo *mirrors_will_do,
                     KindsWillDo *whole_will_do) {
    EstimatePlan whole = {.pilot = PILOT,
                          .least = LEAST,
                          .reach = REACH,
                          .most = most,
                          .user = pilot,
                          .read_pilot = read_whole,
                          .will_do = whole_will_do};
    EstimatePlan mirrors = whole;
    mirrors.pilot *= MIRRORS;
    mirrors.least *= MIRRORS;
    mirrors.read_pilot = read_mirrors;
    mirrors.will_do = mirrors_will_do;
    read_whole(pilot, PILOT);
    pilot->mirror_paths = estimate_plan(&mirrors);
    pilot->whole_paths = estimate_plan(&whole);
}

void path_kinds_read(PathKinds *fresh, const PathKinds *pilot) {
    read_whole(fresh, pilot->whole_paths);
    read_mirrors(fresh, pilot->mirror_paths);
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
