/* SPDX-License-Identifier: Apache-2.0 */
#include "render/train.h"

#include <math.h>

#include "base/parallel.h"
#include "base/sort.h"
#include "render/signals.h"
#include "render/tiles.h"

#define STEPS_MAX 16384.0 /* of the raster */
#define CELLS 1.0         /* times the root of the frame's pixels: so many cells, or more */
#define ROUNDS 2
#define CELL_PATHS (ROUNDS * GUIDE_POINTS * GUIDE_BINS / 2) /* above the horizon */
#define TRAINED 0.06     /* of the paths that are to be guided, or up to twice as many */
#define SEED 0x67756964u /* not a frame's own samples */

typedef struct TrainingRun {
    const Kernel *kernel;
    TrainingJob job;
    GuideTraining *training;
    FilmRect raster;
    WorkerCounts *counts;
    double *light; /* of each cell, lx */
    bool stops_at_once;
} TrainingRun;

static bool is_stopped(const TrainingRun *run) {
    return run->stops_at_once && signals_stop_requested();
}

static void find_places(void *context, int item, int worker) {
    TrainingRun *run = context;
    if (is_stopped(run)) return;
    run->kernel->find_places(&run->job, render_tile(run->raster, item),
                             &run->counts[worker].statistics);
}

static void trace_cell(void *context, int item, int worker) {
    TrainingRun *run = context;
    if (is_stopped(run)) return;
    run->kernel->train(&run->job, (uint32_t)item, &run->counts[worker].statistics);
}

/* The raster keeps the frame's shape. */
static FilmRect raster_of(const Camera *camera) {
    double pixels = (double)camera->width * (double)camera->height;
    double scale = fmin(sqrt(STEPS_MAX / pixels), 1);
    return (FilmRect){0, 0, (int)ceil(camera->width * scale), (int)ceil(camera->height * scale)};
}

static GuidePlace *all_places(const TrainingRun *run, Arena *arena, uint32_t *count) {
    size_t steps = (size_t)run->raster.x1 * (size_t)run->raster.y1;
    GuidePlace *places = ARENA_NEW(arena, GuidePlace, steps * PATH_PLACES_MAX);
    *count = 0;
    for (size_t i = 0; i < steps; i++)
        for (int k = 0; k < run->job.places[i].count; k++) {
            const LitPoint *place = &run->job.places[i].place[k];
            places[(*count)++] = (GuidePlace){place->position, place->ns};
        }
    return places;
}

static void keep_cell(void *context, int item, int worker) {
    (void)worker;
    TrainingRun *run = context;
    guide_training_update(run->training, (uint32_t)item);
}

static void try_lights(void *context, int item, int worker) {
    TrainingRun *run = context;
    if (is_stopped(run)) return;
    run->kernel->try_lights(&run->job, (uint32_t)item, &run->counts[worker].statistics);
}

#define NEIGHBOURS 4    /* on either side in the tree's order */
#define NEAR_LAMPS 0.25 /* weight of what lamps gave a neighbour, by that of the cell's own */
#define DOUBT 8         /* points of them that count as the cell's own */

/* Light that the neighbours' samples find may reach the cell, too. */
static LightFinds with_neighbours(const LightFinds *finds, int cell, int cells) {
    LightFinds own = finds[cell], all = {0};
    for (int i = cell - NEIGHBOURS; i <= cell + NEIGHBOURS; i++) {
        if (i < 0 || i >= cells) continue;
        all.points += finds[i].points;
        for (int set = 0; set < LIGHT_SETS; set++) all.squares[set] += finds[i].squares[set];
        for (int k = 0; k < SUNLIT_PROBS; k++)
            all.sunlit.variance[k] += finds[i].sunlit.variance[k];
        if (i != cell) lamp_finds_join(&own.lamps, &finds[i].lamps, NEAR_LAMPS);
    }
    if (!(all.points > 0)) return own;
    own.points += DOUBT;
    for (int set = 0; set < LIGHT_SETS; set++)
        own.squares[set] += all.squares[set] * DOUBT / all.points;
    for (int k = 0; k < SUNLIT_PROBS; k++)
        own.sunlit.variance[k] += all.sunlit.variance[k] * DOUBT / all.points;
    return own;
}

/* Illuminance of a cell's points, lx, by what training passes and light samples found. */
static void find_light(void *context, int cell, int worker) {
    (void)worker;
    TrainingRun *run = context;
    const LightFinds *finds = &run->job.finds[cell];
    double total = guide_training_illuminance(run->job.training, (uint32_t)cell);
    for (int set = 0; set < LIGHT_SETS; set++)
        total += finds->points > 0 ? finds->sum[set] / finds->points : 0;
    run->light[cell] = total;
}

/* The median of the cell's and its neighbours': a training pass that met a small patch of sun
 * by chance makes one cell a hundred times too bright. */
static double usual_light(const TrainingRun *run, int cell) {
    double value[2 * NEIGHBOURS + 1];
    int count = 0, cells = (int)run->training->guide.cell_count;
    for (int i = cell - NEIGHBOURS; i <= cell + NEIGHBOURS; i++)
        if (i >= 0 && i < cells) value[count++] = run->light[i];
    return sort_median(value, count);
}

static void weigh_cell(void *context, int item, int worker) {
    (void)worker;
    TrainingRun *run = context;
    const Lights *lights = run->job.context->lights;
    const LightFinds *finds = run->job.finds;
    LightGuide *guide = &run->training->guide;
    LightFinds found = with_neighbours(finds, item, (int)guide->cell_count);
    CellLight light = {run->light[item], usual_light(run, item)};
    guide->cells[item].lamps = cell_lamps_keep(&found.lamps, lights_lamp_count(lights));
    cell_lights_weigh(run->job.context, &found, light, guide->cells[item].asked);
}

static TrainingRun run_start(const Camera *camera, const TrainOptions *options, Arena *arena) {
    FilmRect raster = raster_of(camera);
    TrainingRun run = {.kernel = options->kernel,
                       .raster = raster,
                       .counts = ARENA_NEW(arena, WorkerCounts, options->threads),
                       .stops_at_once = options->stops_at_once};
    run.job = (TrainingJob){
        .camera = camera,
        .seed = SEED,
        .columns = raster.x1,
        .stretch = {(float)camera->width / (float)raster.x1,
                    (float)camera->height / (float)raster.y1},
        .places = ARENA_NEW(arena, PathPlaces, (size_t)raster.x1 * (size_t)raster.y1)};
    return run;
}

/* Places of a cell, at most: a small frame is worth a short training pass, and few samples are. */
static uint32_t places_a_cell(const Camera *camera, double paths, uint32_t places) {
    double cells = CELLS * sqrt((double)camera->width * (double)camera->height);
    if (paths > 0) cells = fmax(fmin(cells, TRAINED * paths / CELL_PATHS), 1);
    return (uint32_t)fmax(places / cells, GUIDE_POINTS);
}

GuideScene train_guide_scene(const PathContext *context) {
    GuideScene scene = {.light_count = context->scene->light_count,
                        .lamp_count = lights_lamp_count(context->lights)};
    for (int set = 0; set < GUIDE_LIGHTS; set++) scene.has[set] = path_context_has(context, set);
    return scene;
}

const LightGuide *train_guide(const PathContext *context, const Camera *camera,
                              const TrainOptions *options, Arena *arena, PathStatistics *cost) {
    GuideNode leaf = {0};
    LightGuide nobody = {.nodes = &leaf, .cells = ARENA_NEW(arena, GuideCell, 1)};
    PathContext trainee = *context;
    TrainingRun run = run_start(camera, options, arena);
    uint32_t count;
    trainee.guide = &nobody;
    run.job.context = &trainee;
    parallel_for(options->threads, render_tile_count(run.raster), find_places, &run);
    *cost = (PathStatistics){0};
    if (is_stopped(&run)) return NULL;
    GuidePlace *places = all_places(&run, arena, &count);
    GuideTraining *training =
        guide_training_start(places, count, places_a_cell(camera, options->paths, count), arena);
    LightGuide *guide = &training->guide;
    run.job.training = run.training = training;
    run.job.finds = ARENA_NEW(arena, LightFinds, guide->cell_count);
    trainee.guide = guide;
    for (int round = 0; round < ROUNDS; round++) {
        run.job.index = (uint32_t)round * GUIDE_POINTS;
        guide_training_choose(training, round);
        parallel_for(options->threads, (int)guide->cell_count, trace_cell, &run);
        parallel_for(options->threads, (int)guide->cell_count, keep_cell, &run);
    }
    parallel_for(options->threads, (int)guide->cell_count, try_lights, &run);
    run.light = ARENA_NEW(arena, double, guide->cell_count);
    parallel_for(options->threads, (int)guide->cell_count, find_light, &run);
    parallel_for(options->threads, (int)guide->cell_count, weigh_cell, &run);
    guide->asks = true;
    *cost = worker_counts_sum(run.counts, options->threads);
    return is_stopped(&run) ? NULL : guide;
}
