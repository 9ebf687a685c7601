/* SPDX-License-Identifier: Apache-2.0 */
#include "review/eye/gaze_reading.h"

#include <math.h>
#include <string.h>

#include "base/count.h"
#include "base/parallel.h"
#include "base/sampler.h"
#include "base/units.h"
#include "estimate/estimate_plan.h"
#include "render/signals.h"
#include "review/eye/unmet_lamps.h"
#include "review/light/reading.h"

/* One over the root of x^3 = x + 1, and its square: points that fill a square evenly, however
 * many (M. Roberts' sequence). */
#define STEP_U 0.7548776662466927
#define STEP_V 0.5698402909980532
#define SHIFT_U 0x75u
#define SHIFT_V 0x76u
#define CHUNK 32 /* paths that are aimed together */

/* ---- the cone ---------------------------------------------------------------------------- */

static double fraction(double x) {
    return x - floor(x);
}

static double shift_of(uint32_t seed, uint32_t axis) {
    return hash_combine(hash_u32(seed), axis) * 0x1p-32;
}

/* Path i of a batch. Even over the cone's solid angle; each batch's points are shifted as one
 * (Cranley and Patterson 1976), so that batches differ in nothing but chance. */
static Vec3 target_of(const GazePaths *paths, uint32_t seed, int i) {
    double u = fraction(shift_of(seed, SHIFT_U) + STEP_U * i);
    double v = fraction(shift_of(seed, SHIFT_V) + STEP_V * i);
    double cosine = 1 - (1 - cos(radians_from_degrees(GAZE_CONE_DEG))) * u;
    double sine = sqrt(1 - cosine * cosine), phi = 2 * PI * v;
    Vec3 d = vec3((float)(sine * cos(phi)), (float)(sine * sin(phi)), (float)cosine);
    return vec3_add(paths->eye, frame_to_world(&paths->frame, d));
}

/* ---- what paths find --------------------------------------------------------------------- */

static bool is_pane(const Scene *scene, int part_id) {
    return scene->materials[scene->parts[part_id].material_id].transmission > 0;
}

/* The step at which a pane mirrors what the eye sees there; NO_ID: none does. */
static int mirroring_step(const Scene *scene, const PathHistory *history) {
    int kept = path_steps_kept(history), i = 0;
    while (i < kept && history->step[i].event == PATH_TRANSMITS) i++;
    bool mirrors = i < kept && history->step[i].event == PATH_REFLECTS &&
                   is_pane(scene, history->step[i].part_id);
    return mirrors ? i : NO_ID;
}

/* By no more surfaces than are kept: of others nobody knows. */
static bool is_by_mirrors(const PathHistory *history) {
    if (history->count > PATH_STEPS_MAX) return false;
    for (int i = 0; i < history->count; i++)
        if (history->step[i].event == PATH_SCATTERS) return false;
    return true;
}

/* Straight, or through panes with a thickness. */
static bool is_suns_disc(const PathHistory *history) {
    for (int i = 0; i < path_steps_kept(history); i++)
        if (history->step[i].event != PATH_TRANSMITS) return false;
    return history->source == LIGHTS_SUN;
}

static int place_shown(const Scene *scene, const PathHistory *history, int from) {
    for (int i = from + 1; i < path_steps_kept(history); i++)
        if (!is_pane(scene, history->step[i].part_id)) return history->step[i].part_id;
    return history->source == LIGHTS_EMITTERS ? history->source_id
                                              : scene->part_count + (int)history->source;
}

static void on_light(void *user, const PathHistory *history, const float xyz[3]) {
    GazeBatch *batch = user;
    if (is_suns_disc(history) || is_by_mirrors(history) != batch->by_mirrors) return;
    int step = mirroring_step(batch->scene, history);
    GazeFigure figure = step == NO_ID ? GAZE_THROUGH : GAZE_MIRRORED;
    batch->path[figure] += (double)xyz[1];
    if (batch->by_mirrors && history->source == LIGHTS_EMITTERS)
        batch->met[figure][history->source_id] = true;
    if (step == NO_ID) return;
    batch->panes[history->step[step].part_id] += (double)xyz[1];
    batch->shown[place_shown(batch->scene, history, step)] += (double)xyz[1];
}

static int mirrors_of(const PathHistory *history) {
    int count = 0;
    for (int i = 0; i < path_steps_kept(history); i++)
        count += history->step[i].event == PATH_REFLECTS;
    return count;
}

static void on_mirror(void *user, const PathHistory *history, Vec3 towards, float share) {
    GazeBatch *batch = user;
    bool is_mirrored = mirroring_step(batch->scene, history) != NO_ID;
    GazeFigure figure = is_mirrored ? GAZE_MIRRORED : GAZE_THROUGH;
    int again = mirrors_of(history) > 1, *count = &batch->images[figure][again];
    if (history->count > PATH_STEPS_MAX || *count == GAZE_IMAGES) return;
    Vec3 from = history->step[history->count - 1].position;
    batch->image[figure][again][(*count)++] = (GazeImage){(Ray){from, towards, 0, INFINITY}, share};
}

/* ---- batches ----------------------------------------------------------------------------- */

static void trace_one(const GazePaths *paths, const ProbeAim *aim, int i, GazeBatch *batch) {
    PathListener listener = {.on_light = on_light,
                             .on_mirror = on_mirror,
                             .user = batch,
                             .reach = paths->by_mirrors ? PATH_BY_MIRRORS : PATH_TO_ITS_END};
    PathStatistics statistics = {0};
    batch->path[GAZE_THROUGH] = batch->path[GAZE_MIRRORED] = 0;
    paths->setup->tools.kernel->trace(aim, i, i + 1, &listener, &statistics);
    for (int k = 0; k < GAZE_FIGURES; k++) {
        batch->sum[k] += batch->path[k];
        bright_add(&batch->bright[k], batch->path[k]);
    }
}

static void read_batch(void *user, int item, int worker) {
    (void)worker;
    const GazePaths *paths = user;
    uint32_t seed = hash_combine(hash_u32(paths->seed), (uint32_t)item);
    Vec3 targets[CHUNK];
    ProbeAim aim = {.context = &paths->setup->context,
                    .eye = paths->eye,
                    .targets = targets,
                    .target_count = CHUNK,
                    .seed = seed};
    for (int i = paths->first; i < paths->end; i++) {
        if (signals_stop_requested()) return;
        targets[i % CHUNK] = target_of(paths, seed, i);
        trace_one(paths, &aim, i, &paths->batches[item]);
    }
}

static GazePaths gaze_paths_start(const Setup *setup, const GazeAim *gaze, bool by_mirrors,
                                  uint32_t seed, Arena *arena) {
    int parts = setup->scene->part_count;
    GazePaths paths = {.setup = setup,
                       .eye = gaze->eye,
                       .seed = seed,
                       .frame = frame_from_z(vec3_normalize(gaze->towards)),
                       .by_mirrors = by_mirrors,
                       .batches = ARENA_NEW(arena, GazeBatch, ESTIMATE_BATCHES)};
    for (int b = 0; b < ESTIMATE_BATCHES; b++) {
        GazeBatch *batch = &paths.batches[b];
        batch->scene = setup->scene;
        batch->by_mirrors = by_mirrors;
        batch->panes = ARENA_NEW(arena, double, parts);
        batch->shown = ARENA_NEW(arena, double, parts + LIGHT_SETS);
        for (int k = 0; k < GAZE_FIGURES; k++) batch->met[k] = ARENA_NEW(arena, bool, parts);
    }
    return paths;
}

/* ---- figures ----------------------------------------------------------------------------- */

/* What no path met of lamps that the eye may see there, straight or by the mirrors that paths
 * came by. */
static double unmet(const GazePaths *paths, GazeFigure figure, Arena scratch) {
    const Setup *setup = paths->setup;
    int parts = setup->scene->part_count;
    bool *met = ARENA_NEW(&scratch, bool, parts);
    double most = 0, half = radians_from_degrees(GAZE_CONE_DEG);
    for (int b = 0; b < ESTIMATE_BATCHES; b++)
        for (int i = 0; i < parts; i++) met[i] |= paths->batches[b].met[figure][i];
    UnmetLamps lamps = lamps_unmet(setup, met, &scratch);
    if (figure == GAZE_THROUGH)
        most = lamps_brightest(&lamps, (Ray){paths->eye, paths->frame.z, 0, INFINITY}, half, false);
    for (int i = 0; i < ESTIMATE_BATCHES * 2 * GAZE_IMAGES; i++) {
        const GazeBatch *batch = &paths->batches[i / 2 / GAZE_IMAGES];
        int again = i / GAZE_IMAGES % 2, k = i % GAZE_IMAGES;
        if (k >= batch->images[figure][again]) continue;
        const GazeImage *image = &batch->image[figure][again][k];
        most = fmax(most, (double)image->share * lamps_brightest(&lamps, image->ray, half, false));
    }
    return most;
}

/* Goes on to so many paths in all, a multiple of 32. */
static void gaze_paths_read(GazePaths *paths, long count, Arena scratch) {
    paths->end = (int)(count / ESTIMATE_BATCHES);
    parallel_for(paths->setup->tools.threads, ESTIMATE_BATCHES, read_batch, paths);
    paths->first = paths->end;
    for (int k = 0; k < GAZE_FIGURES && paths->by_mirrors; k++)
        paths->unmet[k] = unmet(paths, (GazeFigure)k, scratch);
}

/* With what lamps may have sent by mirrors that were not met. */
static EstimateSums gaze_paths_sums(const GazePaths *paths, GazeFigure figure) {
    EstimateSums sums = {.batches = ESTIMATE_BATCHES,
                         .piece = 1,
                         .share = 1,
                         .paths = (long)paths->end * ESTIMATE_BATCHES};
    for (int b = 0; b < ESTIMATE_BATCHES; b++) {
        const GazeBatch *batch = &paths->batches[b];
        sums.batch[b] = batch->sum[figure];
        sums.bright.squares += batch->bright[figure].squares;
        sums.bright.fourths += batch->bright[figure].fourths;
    }
    sums.unmet = estimate_unmet(paths->unmet[figure], (double)sums.paths);
    return sums;
}

/* Adds where mirrored light came from, each path by `weight`: [part], [part and sets]. */
static void gaze_paths_places(const GazePaths *paths, double weight, double *panes, double *shown) {
    int parts = paths->setup->scene->part_count;
    for (int b = 0; b < ESTIMATE_BATCHES; b++) {
        const GazeBatch *batch = &paths->batches[b];
        for (int i = 0; i < parts; i++) panes[i] += weight * batch->panes[i];
        for (int i = 0; i < parts + LIGHT_SETS; i++) shown[i] += weight * batch->shown[i];
    }
}

#define SEED 0x67617a65u
#define PILOT_SEED 0x70696c6fu
#define MIRROR_SEED 0x6d697272u
#define LEAST 2048 /* whole paths */
#define PILOT 1024
#define REACH 32 /* estimate_plan.h */
/* so many times as many by mirrors, at least: they take a third of the time */
#define MIRRORS 4
#define UNMET 0.1 /* of all light there: what lamps may have that no path met */

/* Paths of both kinds. */
typedef struct GazePair {
    const GazeGoal *goal;
    GazePaths whole, mirrors;
    long whole_paths, mirror_paths; /* that will do */
    Arena scratch;
} GazePair;

static GazePair start(const Setup *setup, const GazeGoal *goal, uint32_t seed, Arena *scratch) {
    GazePair pair = {.goal = goal};
    GazeAim aim = {goal->eye, goal->towards};
    pair.whole = gaze_paths_start(setup, &aim, false, seed, scratch);
    pair.mirrors = gaze_paths_start(setup, &aim, true, seed ^ MIRROR_SEED, scratch);
    pair.scratch = *scratch;
    return pair;
}

/* ---- how many ---------------------------------------------------------------------------- */

static void read_mirrors(void *user, long paths) {
    GazePair *pair = user;
    gaze_paths_read(&pair->mirrors, paths, pair->scratch);
}

static void read_whole(void *user, long paths) {
    GazePair *pair = user;
    gaze_paths_read(&pair->whole, paths, pair->scratch);
}

/* Of the variance that may be, by mirrors; the rest is left to whole paths, which cost more. */
#define MIRRORS_SHARE 0.5

/* One figure of both kinds. */
typedef struct FigurePair {
    Estimate whole, mirrors;
} FigurePair;

static FigurePair found_by(const GazePair *pair, GazeFigure figure) {
    EstimateSums whole = gaze_paths_sums(&pair->whole, figure);
    EstimateSums mirrors = gaze_paths_sums(&pair->mirrors, figure);
    return (FigurePair){estimate_of(&whole), estimate_of(&mirrors)};
}

static bool mirrors_will_do(void *user, long pilot, long paths) {
    const GazePair *pair = user;
    double all = 0, unmet = 0;
    for (int k = 0; k < GAZE_FIGURES; k++) {
        FigurePair found = found_by(pair, (GazeFigure)k);
        Estimate then = estimate_expected(&found.mirrors, (double)paths / (double)pilot);
        double mean = found.whole.mean + found.mirrors.mean;
        if (then.sigma > pair->goal->precision * mean * sqrt(MIRRORS_SHARE)) return false;
        all += mean;
        unmet = fmax(unmet, then.unmet);
    }
    return unmet <= UNMET * all;
}

/* What mirrors are expected to leave unsure is known. */
static bool whole_will_do(void *user, long pilot, long paths) {
    const GazePair *pair = user;
    for (int k = 0; k < GAZE_FIGURES; k++) {
        FigurePair found = found_by(pair, (GazeFigure)k);
        double mean = found.whole.mean + found.mirrors.mean;
        double times = (double)pair->mirror_paths / (double)(pair->mirrors.end * ESTIMATE_BATCHES);
        Estimate then = estimate_expected(&found.whole, (double)paths / (double)pilot);
        Estimate mirrors = estimate_expected(&found.mirrors, times);
        if (hypot(then.sigma, mirrors.sigma) > pair->goal->precision * mean) return false;
    }
    return true;
}

/* How many of both; by mirrors first. */
static void plan(GazePair *pilot) {
    EstimatePlan mirrors = {.pilot = PILOT * MIRRORS,
                            .least = LEAST * MIRRORS,
                            .reach = REACH,
                            .most = pilot->goal->most,
                            .user = pilot,
                            .read_pilot = read_mirrors,
                            .will_do = mirrors_will_do};
    EstimatePlan whole = {.pilot = PILOT,
                          .least = LEAST,
                          .reach = REACH,
                          .most = pilot->goal->most,
                          .user = pilot,
                          .read_pilot = read_whole,
                          .will_do = whole_will_do};
    read_whole(pilot, PILOT);
    pilot->mirror_paths = estimate_plan(&mirrors);
    pilot->whole_paths = estimate_plan(&whole);
}

/* ---- what both kinds of paths found ------------------------------------------------------ */

static GazeFound figure_of(const GazePair *pair, GazeFigure figure) {
    EstimateSums sums = gaze_paths_sums(&pair->whole, figure);
    EstimateSums mirrors = gaze_paths_sums(&pair->mirrors, figure);
    estimate_sums_add(&sums, &mirrors);
    Estimate estimate = estimate_of(&sums);
    return (GazeFound){estimate.mean, estimate.sigma, estimate.interval};
}

/* NO_ID: all are 0. */
static int greatest(const double *values, int count) {
    int at = NO_ID;
    for (int i = 0; i < count; i++)
        if (values[i] > (at == NO_ID ? 0 : values[at])) at = i;
    return at;
}

static GazeMirrored find_mirrored(const GazePair *pair) {
    Arena scratch = pair->scratch;
    int parts = pair->whole.setup->scene->part_count;
    double *panes = ARENA_NEW(&scratch, double, parts);
    double *shown = ARENA_NEW(&scratch, double, parts + LIGHT_SETS);
    gaze_paths_places(&pair->whole, 1.0 / pair->whole.end, panes, shown);
    gaze_paths_places(&pair->mirrors, 1.0 / pair->mirrors.end, panes, shown);
    int most = greatest(shown, parts + LIGHT_SETS);
    return (GazeMirrored){greatest(panes, parts), most < parts ? most : NO_ID,
                          most < parts ? LIGHTS_SUN : (LightSet)(most - parts)};
}

GazeReading gaze_read(const Setup *setup, const GazeGoal *goal, Arena scratch) {
    uint32_t seed = review_seed(setup->request, SEED);
    uint32_t first = hash_combine(hash_u32(seed), PILOT_SEED);
    GazePair pilot = start(setup, goal, first, &scratch);
    GazePair fresh = start(setup, goal, seed, &scratch);
    pilot.scratch = fresh.scratch = scratch;
    plan(&pilot);
    read_whole(&fresh, pilot.whole_paths);
    read_mirrors(&fresh, pilot.mirror_paths);
    return (GazeReading){figure_of(&fresh, GAZE_THROUGH), figure_of(&fresh, GAZE_MIRRORED),
                         find_mirrored(&fresh)};
}
