/* SPDX-License-Identifier: Apache-2.0 */
#include "review/eye/pane_image_reading.h"

#include <math.h>

#include "base/parallel.h"
#include "base/sampler.h"
#include "estimate/estimate_plan.h"
#include "render/signals.h"

/* As gaze_reading.c has them. */
#define STEP_U 0.7548776662466927
#define STEP_V 0.5698402909980532
#define SEED 0x70616e65u
#define PILOT_SEED 0x70696c6fu
#define MIRROR_SEED 0x6d697272u
#define CHUNK 32
#define LEAST 2048
#define PILOT 1024
#define REACH 32
#define MIRRORS 4

enum { IMAGE, THROUGH, AGAINST, FIGURES };

typedef struct PaneImageBatch {
    const struct PaneImagePaths *paths;
    double sum[FIGURES], path[FIGURES]; /* path: of the one at work */
    BrightSamples bright[FIGURES];
    Vec3 place;                  /* of the display, that the near face shows along the path */
    double alone, ghost, beside; /* image light by one reflection; of it, the ghost's;
                                    and that times how far beside it stands, radians */
} PaneImageBatch;

/* Paths of one kind: those by mirrors end where something scatters; whole ones count no other
 * light than that. */
typedef struct PaneImagePaths {
    const Setup *setup;
    const PaneImageGoal *goal;
    PathContext context;
    const double *shares; /* [cell + 1] of the solid angle before each cell */
    bool by_mirrors;
    uint32_t seed;
    int first, end;          /* paths of every batch */
    PaneImageBatch *batches; /* [ESTIMATE_BATCHES] */
} PaneImagePaths;

/* ---- the image's solid angle ------------------------------------------------------------- */

static const double *shares_of(const PaneImage *image, Arena *arena) {
    double *out = ARENA_NEW(arena, double, image->cell_count + 1), sum = 0;
    for (int i = 0; i < image->cell_count; i++) {
        out[i] = sum / image->sr;
        sum += image->cells[i].sr;
    }
    out[image->cell_count] = 1;
    return out;
}

/* u, v: in [0, 1). Cells are so small that even over the plane is even over the sphere. */
static Vec3 direction_at(const PaneImagePaths *paths, double u, double v, Vec3 *place) {
    int low = 0, high = paths->goal->image->cell_count;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (paths->shares[middle] <= u) low = middle;
        else high = middle;
    }
    const PaneCell *cell = &paths->goal->image->cells[low];
    double within = (u - paths->shares[low]) / (paths->shares[low + 1] - paths->shares[low]);
    double root = sqrt(fmin(fmax(within, 0), 1));
    float weight[3] = {(float)(1 - root), (float)(root * (1 - v)), (float)(root * v)};
    Vec3 d = vec3(0, 0, 0), p = vec3(0, 0, 0);
    for (int k = 0; k < 3; k++) {
        d = vec3_along(d, cell->corner[k], weight[k]);
        p = vec3_along(p, cell->place[k], weight[k]);
    }
    *place = p;
    return vec3_normalize(d);
}

static double fraction(double x) {
    return x - floor(x);
}

static Vec3 target_of(const PaneImagePaths *paths, uint32_t seed, int i, Vec3 *place) {
    double u = hash_combine(hash_u32(seed), 0) * 0x1p-32;
    double v = hash_combine(hash_u32(seed), 1) * 0x1p-32;
    Vec3 d = direction_at(paths, fraction(u + STEP_U * i), fraction(v + STEP_V * i), place);
    return vec3_add(paths->goal->eye, d);
}

/* ---- light ------------------------------------------------------------------------------- */

static bool is_pane(const Scene *scene, int part_id) {
    return scene->materials[scene->parts[part_id].material_id].transmission > 0;
}

static bool is_by_mirrors(const PathHistory *history) {
    if (history->count > PATH_STEPS_MAX) return false;
    for (int i = 0; i < history->count; i++)
        if (history->step[i].event == PATH_SCATTERS) return false;
    return true;
}

/* The pane that mirrors what the eye sees there; NO_ID: none does. */
static int mirroring_pane(const Scene *scene, const PathHistory *history) {
    int kept = path_steps_kept(history), i = 0;
    while (i < kept && history->step[i].event == PATH_TRANSMITS) i++;
    if (i == kept || history->step[i].event != PATH_REFLECTS) return NO_ID;
    int part_id = history->step[i].part_id;
    return is_pane(scene, part_id) ? part_id : NO_ID;
}

/* of how far the pane's thickness puts the ghost aside: what is nearer is the image itself.
 * Between a cell's corners the place is known to a minute of arc of a curved pane */
#define GHOST_LEAST 0.25

/* m, across the rays: s = d sin 2t / sqrt(n^2 - sin^2 t) of a flat pane of thickness d; 0: it
 * has none of its own. The turn from the way in to the way out is 180 degrees less 2 t. */
static double ghost_shift(const Scene *scene, int pane_id, Vec3 in, Vec3 out) {
    const Glazing *pane = scene->materials[scene->parts[pane_id].material_id].glazing;
    double thickness = 0;
    if (!pane) return 0;
    for (int i = 0; i < pane->layer_count; i++) thickness += (double)pane->layers[i].thickness_m;
    double cosine2 = fmin(fmax(0.5 * (1 - (double)vec3_dot(in, out)), 0), 1);
    double sine2 = 1 - cosine2, ior = (double)pane->absorbing_ior;
    return 2 * thickness * sqrt(sine2 * cosine2 / (ior * ior - sine2));
}

/* Where the light began lies beside the place that the near face shows, across the way there:
 * that over the whole way is how far the ghost stands beside. */
static void note_ghost(const PathHistory *history, double luminance, PaneImageBatch *batch) {
    Vec3 eye = batch->paths->goal->eye, pane = history->step[0].position;
    Vec3 way = vec3_sub(batch->place, pane), off = vec3_sub(history->from, batch->place);
    double far = (double)(vec3_length(vec3_sub(pane, eye)) + vec3_length(way));
    way = vec3_normalize(way);
    double beside = (double)vec3_length(vec3_along(off, way, -vec3_dot(off, way)));
    double shift =
        ghost_shift(batch->paths->setup->scene, history->step[0].part_id, history->towards, way);
    batch->alone += luminance;
    if (!(shift > 0 && beside > GHOST_LEAST * shift)) return;
    batch->ghost += luminance;
    batch->beside += luminance * beside / far;
}

static void on_light(void *user, const PathHistory *history, const float xyz[3]) {
    PaneImageBatch *batch = user;
    const PaneImagePaths *paths = batch->paths;
    const PaneImage *image = paths->goal->image;
    if (is_by_mirrors(history) != paths->by_mirrors) return;
    int pane = mirroring_pane(paths->setup->scene, history);
    bool is_image = paths->by_mirrors && pane == image->pane_id &&
                    history->source == LIGHTS_EMITTERS && history->source_id == image->part_id;
    batch->path[is_image ? IMAGE : AGAINST] += (double)xyz[1];
    if (pane == NO_ID) batch->path[THROUGH] += (double)xyz[1];
    if (is_image && history->count == 1) note_ghost(history, (double)xyz[1], batch);
}

static void read_batch(void *user, int item, int worker) {
    (void)worker;
    const PaneImagePaths *paths = user;
    PaneImageBatch *batch = &paths->batches[item];
    uint32_t seed = hash_combine(hash_u32(paths->seed), (uint32_t)item);
    Vec3 targets[CHUNK];
    ProbeAim aim = {.context = &paths->context,
                    .eye = paths->goal->eye,
                    .targets = targets,
                    .target_count = CHUNK,
                    .seed = seed};
    PathListener listener = {.on_light = on_light,
                             .user = batch,
                             .is_polarised = true,
                             .reach = paths->by_mirrors ? PATH_BY_MIRRORS : PATH_TO_ITS_END};
    PathStatistics statistics = {0};
    for (int i = paths->first; i < paths->end; i++) {
        if (signals_stop_requested()) return;
        targets[i % CHUNK] = target_of(paths, seed, i, &batch->place);
        for (int k = 0; k < FIGURES; k++) batch->path[k] = 0;
        paths->setup->tools.kernel->trace(&aim, i, i + 1, &listener, &statistics);
        for (int k = 0; k < FIGURES; k++) {
            batch->sum[k] += batch->path[k];
            bright_add(&batch->bright[k], batch->path[k]);
        }
    }
}

/* ---- both kinds -------------------------------------------------------------------------- */

typedef struct PaneImagePair {
    const PaneImageGoal *goal;
    PaneImagePaths whole, mirrors;
    long whole_paths, mirror_paths; /* that will do */
} PaneImagePair;

static PaneImagePaths paths_of(const Setup *setup, const PaneImageGoal *goal,
                               const PolarisedEye *eye, Arena *arena) {
    PaneImagePaths paths = {.setup = setup,
                            .goal = goal,
                            .context = setup->context,
                            .batches = ARENA_NEW(arena, PaneImageBatch, ESTIMATE_BATCHES)};
    paths.context.eye = eye;
    paths.shares = shares_of(goal->image, arena);
    return paths;
}

static PaneImagePair pair_of(const Setup *setup, const PaneImageGoal *goal, uint32_t seed,
                             Arena *arena) {
    PolarisedEye *eye = ARENA_NEW(arena, PolarisedEye, 1);
    Frame frame = frame_from_z(goal->image->towards);
    *eye = (PolarisedEye){.right = frame.x, .forward = frame.z};
    PaneImagePair pair = {.goal = goal,
                          .whole = paths_of(setup, goal, eye, arena),
                          .mirrors = paths_of(setup, goal, eye, arena)};
    pair.whole.seed = seed;
    pair.mirrors.seed = seed ^ MIRROR_SEED;
    pair.mirrors.by_mirrors = true;
    return pair;
}

static void paths_read(PaneImagePaths *paths, long count) {
    paths->end = (int)(count / ESTIMATE_BATCHES);
    for (int i = 0; i < ESTIMATE_BATCHES; i++) paths->batches[i].paths = paths;
    parallel_for(paths->setup->tools.threads, ESTIMATE_BATCHES, read_batch, paths);
    paths->first = paths->end;
}

static void read_whole(void *user, long count) {
    paths_read(&((PaneImagePair *)user)->whole, count);
}

static void read_mirrors(void *user, long count) {
    paths_read(&((PaneImagePair *)user)->mirrors, count);
}

static EstimateSums sums_of(const PaneImagePaths *paths, int figure) {
    EstimateSums sums = {.batches = ESTIMATE_BATCHES,
                         .piece = 1,
                         .share = 1,
                         .paths = (long)paths->end * ESTIMATE_BATCHES};
    for (int b = 0; b < ESTIMATE_BATCHES; b++) {
        sums.batch[b] = paths->batches[b].sum[figure];
        sums.bright.squares += paths->batches[b].bright[figure].squares;
        sums.bright.fourths += paths->batches[b].bright[figure].fourths;
    }
    return sums;
}

static Estimate estimate_by(const PaneImagePaths *paths, int figure) {
    EstimateSums sums = sums_of(paths, figure);
    return estimate_of(&sums);
}

/* Would so many paths of one kind do, with half of the variance that may be left to each? */
static bool will_do(const PaneImagePair *pair, const PaneImagePaths *of, long pilot, long count) {
    static const int KNOWN[] = {IMAGE, AGAINST};
    for (int k = 0; k < 2; k++) {
        Estimate now = estimate_by(of, KNOWN[k]);
        Estimate then = estimate_expected(&now, (double)count / (double)pilot);
        double mean =
            estimate_by(&pair->whole, KNOWN[k]).mean + estimate_by(&pair->mirrors, KNOWN[k]).mean;
        if (then.sigma > pair->goal->precision * mean * sqrt(0.5)) return false;
    }
    return true;
}

static bool whole_will_do(void *user, long pilot, long count) {
    const PaneImagePair *pair = user;
    return will_do(pair, &pair->whole, pilot, count);
}

static bool mirrors_will_do(void *user, long pilot, long count) {
    const PaneImagePair *pair = user;
    return will_do(pair, &pair->mirrors, pilot, count);
}

static void plan(PaneImagePair *pilot) {
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

static GazeFound figure_of(const PaneImagePair *pair, int figure) {
    EstimateSums sums = sums_of(&pair->whole, figure);
    EstimateSums mirrors = sums_of(&pair->mirrors, figure);
    estimate_sums_add(&sums, &mirrors);
    Estimate estimate = estimate_of(&sums);
    return (GazeFound){estimate.mean, estimate.sigma, estimate.interval};
}

static void set_ghost(const PaneImagePaths *paths, PaneImageReading *out) {
    double alone = 0, ghost = 0, beside = 0;
    for (int b = 0; b < ESTIMATE_BATCHES; b++) {
        alone += paths->batches[b].alone;
        ghost += paths->batches[b].ghost;
        beside += paths->batches[b].beside;
    }
    out->ghost_share = alone > 0 ? ghost / alone : 0;
    out->ghost_rad = ghost > 0 ? beside / ghost : (double)NAN;
}

PaneImageReading pane_image_read(const Setup *setup, const PaneImageGoal *goal, Arena scratch) {
    uint32_t seed = review_seed(setup->request, SEED ^ goal->seed);
    uint32_t first = hash_combine(hash_u32(seed), PILOT_SEED);
    PaneImagePair pilot = pair_of(setup, goal, first, &scratch);
    PaneImagePair fresh = pair_of(setup, goal, seed, &scratch);
    plan(&pilot);
    read_whole(&fresh, pilot.whole_paths);
    read_mirrors(&fresh, pilot.mirror_paths);
    PaneImageReading out = {.image = figure_of(&fresh, IMAGE),
                            .through = figure_of(&fresh, THROUGH),
                            .against = figure_of(&fresh, AGAINST)};
    set_ghost(&fresh.mirrors, &out);
    return out;
}
