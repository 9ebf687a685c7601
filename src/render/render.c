/* SPDX-License-Identifier: Apache-2.0 */
#include "render/render.h"

#include <stdatomic.h>

#include "base/file.h"
#include "base/machine.h"
#include "base/parallel.h"
#include "bvh/bvh.h"
#include "film/film_frame.h"
#include "guide/guide_file.h"
#include "light/light.h"
#include "render/favour.h"
#include "render/pilot.h"
#include "render/signals.h"
#include "render/train.h"

/* ---- passes ------------------------------------------------------------------------------ */

static size_t pixel_count(FilmRect crop) {
    return (size_t)(crop.x1 - crop.x0) * (size_t)(crop.y1 - crop.y0);
}

static PathStatistics with_earlier(PathStatistics sum, const Checkpoint *resume) {
    if (!resume) return sum;
    sum.samples += resume->done.paths;
    sum.camera_rays += resume->done.camera_rays;
    sum.bounce_rays += resume->done.bounce_rays;
    sum.shadow_rays += resume->done.shadow_rays;
    return sum;
}

/* ---- all passes -------------------------------------------------------------------------- */

/* Pixels of a pass: all, or those of one colour of a chess board. */
typedef enum PassSquares { SQUARES_ALL, SQUARES_BLACK, SQUARES_WHITE } PassSquares;

/* The state of all passes of a render. */
typedef struct Run {
    const RenderOptions *options;
    TileJob job;
    PassSquares squares;
    WorkerCounts *counts;
    Progress progress;
    uint32_t total;           /* samples of the frame in the end */
    atomic_ullong paths_done; /* of all passes */
    double checkpoint_s;      /* when the last one was written, or the run began */
    RenderResult result;
} Run;

/* Returns how many paths that took. */
static uint64_t render_rect(const Run *run, FilmRect rect, int worker) {
    const TileJob *job = &run->job;
    run->result.kernel->render(job, rect, &run->counts[worker].statistics);
    return sample_shares_sum(&job->shares, rect, job->first_sample, job->end_sample);
}

static uint64_t render_squares(const Run *run, FilmRect rect, int worker) {
    const FilmRect crop = run->options->crop;
    const int colour = run->squares == SQUARES_WHITE;
    uint64_t paths = 0;
    for (int y = rect.y0; y < rect.y1; y++)
        for (int x = rect.x0; x < rect.x1; x++)
            if ((x - crop.x0 + y - crop.y0) % 2 == colour)
                paths += render_rect(run, (FilmRect){x, y, x + 1, y + 1}, worker);
    return paths;
}

static void render_one_tile(void *context, int item, int worker) {
    Run *run = context;
    if (run->options->stops_at_once && signals_stop_requested()) return;
    FilmRect rect = render_tile(run->options->crop, item);
    uint64_t paths = run->squares == SQUARES_ALL ? render_rect(run, rect, worker)
                                                 : render_squares(run, rect, worker);
    uint64_t done = atomic_fetch_add(&run->paths_done, paths) + paths;
    if (worker == 0) progress_update(&run->progress, (double)done);
}

/* Of the first `samples` samples of the run, over all pixels. */
static double paths_of_first(const RenderOptions *options, const SampleShares *shares,
                             uint32_t samples) {
    return (double)sample_shares_sum(shares, options->crop, options->first_sample,
                                     options->first_sample + samples);
}

static void finish_result(Run *run) {
    const RenderOptions *options = run->options;
    run->result.seconds = monotonic_seconds() - run->progress.begun_s;
    if (options->resume) run->result.seconds += options->resume->seconds;
    run->result.statistics =
        with_earlier(worker_counts_sum(run->counts, options->threads), options->resume);
}

static void take_snapshot(Run *run) {
    const RenderOptions *options = run->options;
    if (!options->snapshot || !signals_take_snapshot()) return;
    finish_result(run);
    run->result.error = film_relative_error(run->result.film);
    progress_clear(&run->progress);
    options->snapshot(options->user, &run->result);
}

/* The checkpoint of a render that is stopped or complete is left to the caller. The interval
 * begins when the writing ends. */
static void keep_checkpoint(Run *run) {
    const RenderOptions *options = run->options;
    if (!options->checkpoint || run->result.complete || run->result.stopped_by ||
        monotonic_seconds() - run->checkpoint_s < options->checkpoint_interval_s)
        return;
    finish_result(run);
    progress_clear(&run->progress);
    options->checkpoint(options->user, &run->result);
    run->checkpoint_s = monotonic_seconds();
}

/* The last pass is left to the caller, too. */
static void show_pass(Run *run) {
    const RenderOptions *options = run->options;
    if (!options->pass_ended || run->result.complete || run->result.stopped_by) return;
    finish_result(run);
    options->pass_ended(options->user, &run->result, &run->progress);
}

static void judge_noise(const RenderOptions *options, RenderResult *result) {
    FilmSpikes spikes = film_area_spikes(result->film, options->noise_area);
    result->noise = film_area_error(result->film, options->noise_area);
    result->noise_doubt = noise_stop_doubt(&result->stop, spikes, result->samples);
}

bool render_noise_is_rare(const RenderResult *result) {
    return noise_stop_is_rare(&result->stop, result->noise, result->noise_doubt);
}

static void run_pass(Run *run) {
    const RenderOptions *options = run->options;
    const int tiles = render_tile_count(options->crop);
    bool is_looked_at = options->first_look && !run->result.samples;
    run->squares = is_looked_at ? SQUARES_BLACK : SQUARES_ALL;
    parallel_for(options->threads, tiles, render_one_tile, run);
    if (!is_looked_at) return;
    options->first_look(options->user, &run->result, &run->progress);
    run->squares = SQUARES_WHITE;
    parallel_for(options->threads, tiles, render_one_tile, run);
}

static void run_passes(Run *run) {
    const RenderOptions *options = run->options;
    uint32_t total = run->total;
    size_t pixels = pixel_count(options->crop);
    atomic_store(&run->paths_done,
                 (uint64_t)paths_of_first(options, &run->result.shares, run->result.samples));
    run->result.complete = run->result.samples >= total;
    while (!run->result.complete && !run->result.stopped_by) {
        uint32_t done = run->result.samples, samples = render_pass_samples(done, pixels);
        if (samples > total - done) samples = total - done;
        run->job.first_sample = options->first_sample + done;
        run->job.end_sample = run->job.first_sample + samples;
        run_pass(run);
        run->result.stopped_by = signals_stop_requested();
        if (options->stops_at_once && run->result.stopped_by) return;
        run->result.samples = done + samples;
        run->result.complete = run->result.samples == total;
        take_snapshot(run);
        keep_checkpoint(run);
        show_pass(run);
    }
    progress_end(&run->progress, (double)atomic_load(&run->paths_done));
    finish_result(run);
    run->result.error = film_relative_error(run->result.film);
    if (run->result.samples >= NOISE_LEAST_SAMPLES)
        run->result.rare_error = film_rare_error(run->result.film, run->result.error.frame);
    if (options->noise > 0) judge_noise(options, &run->result);
}

unsigned render_layers(const Scene *scene, unsigned layers) {
    return scene->display_count > 1 ? layers : layers & ~(unsigned)LAYER_DISPLAY_SECOND;
}

static bool make_film(const RenderSetup *setup, const RenderOptions *options, Arena *arena,
                      RenderResult *result, Error *err) {
    const Checkpoint *resume = options->resume;
    const LightGroups *groups = options->lights;
    const FilmLights lights = {groups ? groups->count : 0, groups ? groups->names : NULL};
    result->film = film_create(options->width, options->height, options->crop, options->layers,
                               &lights, arena);
    if (!film_has_room(result->film, arena, err)) return false;
    if (setup->camera.fisheye) film_set_blind(result->film);
    result->has_features = (options->layers & LAYER_FEATURES) ||
                           (options->noise > 0 && options->noise_area.display != FILM_ALL_PIXELS) ||
                           (resume && resume->has_features);
    if (!resume) return true;
    result->samples = resume->done.end_sample - resume->done.first_sample;
    result->resumed_samples = result->samples;
    return checkpoint_load(resume, result->film, *arena, err);
}

static void render_film(const RenderSetup *setup, const RenderOptions *options, Arena *arena,
                        RenderResult *result) {
    Run run = {.options = options, .result = *result};
    run.total =
        options->noise > 0 ? result->stop.samples : options->end_sample - options->first_sample;
    run.job = (TileJob){.context = &setup->context,
                        .camera = &setup->camera,
                        .film = result->film,
                        .with_features = result->has_features,
                        .with_fine = (options->layers & LAYER_DISPLAY_FINE) != 0,
                        .with_lambertian = (options->layers & LAYER_NEEDS_LAMBERTIAN) != 0,
                        .with_extrapolated = (options->layers & LAYER_DISPLAY_EXTRAPOLATED) != 0,
                        .lights = options->layers & LAYER_LIGHT ? options->lights : NULL,
                        .seed = options->seed,
                        .shares = result->shares};
    run.counts = ARENA_NEW(arena, WorkerCounts, options->threads);
    double most = paths_of_first(options, &result->shares, run.total);
    run.progress = options->within ? progress_part(options->within, options->within_weight, most)
                                   : progress_start(options->progress, "render", "samples", most);
    run.progress.first = paths_of_first(options, &result->shares, result->samples);
    run.checkpoint_s = run.progress.begun_s;
    if (!options->within) signals_watch();
    run_passes(&run);
    *result = run.result;
}

bool render_write_checkpoint(const CheckpointName *name, const RenderOptions *options,
                             const RenderResult *so_far, Arena scratch, Error *err) {
    const PathStatistics *cost = &so_far->statistics;
    uint32_t first = options->first_sample;
    Checkpoint what = {.path = name->path,
                       .identity = name->identity,
                       .done = film_part_of(so_far->film, first, first + so_far->samples),
                       .seconds = so_far->seconds,
                       .has_features = so_far->has_features};
    what.done.asked_end = options->end_sample;
    what.done.paths = cost->samples;
    what.done.camera_rays = cost->camera_rays;
    what.done.bounce_rays = cost->bounce_rays;
    what.done.shadow_rays = cost->shadow_rays;
    return checkpoint_write(&what, so_far->film, scratch, err);
}

/* ---- before the first pass --------------------------------------------------------------- */

/* Reads the field from its file, or trains it and writes that file, if one is named. */
static bool find_field(RenderSetup *setup, const RenderOptions *options, Arena *arena, Error *err) {
    const double pixels = (double)options->width * (double)options->height;
    const TrainOptions train = {setup->kernel, options->threads, false,
                                pixels * options->guided_samples};
    double begun_s = monotonic_seconds();
    if (options->field && file_exists(options->field)) {
        GuideScene scene = train_guide_scene(&setup->context);
        if (!guide_read(options->field, &scene, arena, &setup->context.guide, err)) return false;
    } else {
        setup->context.guide =
            train_guide(&setup->context, &setup->camera, &train, arena, &setup->training);
        if (options->field && !guide_write(options->field, setup->context.guide, *arena, err))
            return false;
    }
    setup->field_hash = guide_hash(setup->context.guide);
    setup->training_seconds = monotonic_seconds() - begun_s;
    return true;
}

static const PolarisedEye *place_eye(const PolarisedEye *eye, const Camera *camera, Arena *arena) {
    if (!eye) return NULL;
    PolarisedEye *placed = ARENA_NEW(arena, PolarisedEye, 1);
    *placed = *eye;
    placed->right = camera->world_from_camera.x;
    placed->forward = vec3_neg(camera->world_from_camera.z);
    return placed;
}

bool render_prepare(const Scene *scene, const SceneCamera *camera, const RenderOptions *options,
                    Arena *arena, RenderSetup *out, Error *err) {
    RenderSetup setup = {0};
    double begun_s = monotonic_seconds();
    Lights *lights;
    if (!kernel_choose(options->isa, &setup.kernel, err)) return false;
    if (!lights_build(scene, arena, &lights, err)) return false;
    if (!bvh_build(scene, options->threads, options->isa, options->progress, &setup.bvh, err))
        return false;
    setup.context = (options->is_reading ? path_context_build : path_context_of_frame)(
        scene, setup.bvh, lights, options->max_bounces, arena);
    if (options->no_mirrors) setup.context.beams[BEAMS_OF_SUN].mirrors = NULL;
    setup.camera = camera_from_scene(camera, options->width, options->height);
    setup.context.eye = place_eye(options->eye, &setup.camera, arena);
    if (setup.context.eye)
        setup.context.tables = surface_tables_build(scene, SURFACE_POLARISED, arena);
    setup.build_seconds = monotonic_seconds() - begun_s;
    setup.build_peak_bytes = machine_peak_bytes();
    if (!options->no_guiding && !find_field(&setup, options, arena, err)) {
        bvh_destroy(setup.bvh);
        return false;
    }
    *out = setup;
    return true;
}

void render_setup_end(RenderSetup *setup) {
    bvh_destroy(setup->bvh);
}

static SampleShares find_shares(const RenderSetup *setup, const RenderOptions *options,
                                Arena *arena) {
    const Favour favour = {setup->kernel,     &setup->context, &setup->camera,
                           options->favoured, options->crop,   options->threads};
    const Pilot pilot = {setup->kernel, &setup->context,  &setup->camera,
                         options->crop, options->threads, options->progress};
    return options->favours_noise ? pilot_shares(&pilot, arena) : favour_shares(&favour, arena);
}

static NoiseStop find_stop(const RenderSetup *setup, const RenderOptions *options,
                           const SampleShares *shares, Arena *arena) {
    const NoiseArgs args = {.kernel = setup->kernel,
                            .context = &setup->context,
                            .camera = &setup->camera,
                            .crop = options->crop,
                            .area = options->noise_area,
                            .shares = *shares,
                            .seed = options->seed,
                            .first_sample = options->first_sample,
                            .most = options->end_sample - options->first_sample,
                            .error = options->noise,
                            .threads = options->threads,
                            .stops_at_once = options->stops_at_once,
                            .progress = options->within ? PROGRESS_NONE : options->progress};
    return noise_stop_find(&args, arena);
}

bool render_prepared(const RenderSetup *setup, const RenderOptions *options, Arena *arena,
                     RenderResult *out, Error *err) {
    RenderResult result = {.kernel = setup->kernel,
                           .rare_error = (double)NAN,
                           .build_seconds = setup->build_seconds,
                           .build_peak_bytes = setup->build_peak_bytes,
                           .field_hash = setup->field_hash,
                           .training_seconds = setup->training_seconds,
                           .training_paths = setup->training.samples};
    if (!make_film(setup, options, arena, &result, err)) return false;
    const double begun_s = monotonic_seconds();
    result.shares = find_shares(setup, options, arena);
    if (options->noise > 0) result.stop = find_stop(setup, options, &result.shares, arena);
    result.build_seconds += monotonic_seconds() - begun_s;
    render_film(setup, options, arena, &result);
    *out = result;
    return true;
}
