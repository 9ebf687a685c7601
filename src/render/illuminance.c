/* SPDX-License-Identifier: Apache-2.0 */
#include "render/illuminance.h"

#include <math.h>

#include "base/parallel.h"
#include "base/sampler.h"
#include "base/units.h"
#include "estimate/estimate.h"

#define BATCHES ESTIMATE_BATCHES /* each with a seed of its own, its samples well spread */
#define POINTS_AT_ONCE 64

typedef struct IlluminanceSums {
    double xyz[3];
    BrightSamples bright;
    uint64_t sky_finds; /* PathStatistics' */
    double lost, rare;  /* PathStatistics' */
} IlluminanceSums;

typedef struct Meter {
    const PathContext *context;
    PathContext *contexts; /* the points' own */
    const IlluminanceOptions *options;
    const LitPoint *points; /* those at work now */
    IlluminanceSums sums[POINTS_AT_ONCE][BATCHES];
} Meter;

/* Samples of a batch; the first batches have one more. */
static long batch_samples(const IlluminanceOptions *options, int batch) {
    return (options->samples - batch + BATCHES - 1) / BATCHES;
}

static void place_meter(void *user, int item, int worker) {
    (void)worker;
    Meter *meter = user;
    meter->contexts[item] = path_context_of_meter(meter->context, meter->points[item]);
}

/* item: a batch of a point. */
static void measure_batch(void *user, int item, int worker) {
    (void)worker;
    Meter *meter = user;
    int point = item / BATCHES, batch = item % BATCHES;
    const IlluminanceOptions *options = meter->options;
    PathStatistics statistics = {0};
    IlluminanceSums *sums = &meter->sums[point][batch];
    uint32_t seed = hash_combine(hash_u32(options->seed), (uint32_t)batch);
    for (long i = 0; i < batch_samples(options, batch); i++) {
        Sampler sampler = sampler_start(seed, 0, 0, (uint32_t)i);
        Wavelengths wavelengths;
        float xyz[3];
        wavelengths_sample(sampler_1d(&sampler), &wavelengths);
        PathStart start = {.context = &meter->contexts[point],
                           .wavelengths = &wavelengths,
                           .sampler = &sampler,
                           .statistics = &statistics};
        path_from_point(&start, meter->points[point], xyz);
        for (int k = 0; k < 3; k++) sums->xyz[k] += (double)xyz[k];
        bright_add(&sums->bright, (double)xyz[1]);
    }
    sums->sky_finds = statistics.sky_finds;
    sums->lost = statistics.lost;
    sums->rare = statistics.rare;
}

/* What comes of the sky by openings that no sample met (review/light/reading.c), lx. */
static double sky_unmet(const Meter *meter, int point) {
    for (int i = 0; i < BATCHES; i++)
        if (meter->sums[point][i].sky_finds) return 0;
    return estimate_unmet(PI * (double)meter->contexts[point].selection.sky_cd_m2,
                          (double)meter->options->samples);
}

static Illuminance add_batches(const Meter *meter, int point) {
    Illuminance total = {0};
    double samples = (double)meter->options->samples, rare = 0;
    EstimateSums y = {.batches = meter->options->samples < BATCHES ? (int)meter->options->samples
                                                                   : BATCHES,
                      .paths = meter->options->samples,
                      .piece = 1,
                      .share = 1,
                      .unmet = sky_unmet(meter, point),
                      .unseen = PI * (double)sunlit_map_unseen(&meter->contexts[point].sunlit)};
    for (int i = 0; i < y.batches; i++) {
        const IlluminanceSums *sums = &meter->sums[point][i];
        y.unseen += sums->lost / samples;
        rare += sums->rare / samples;
        for (int k = 0; k < 3; k++) total.xyz_lx[k] += sums->xyz[k] / samples;
        y.batch[i] = sums->xyz[1];
        bright_merge(&y.bright, &sums->bright);
    }
    y.unseen += fmax(rare, 0);
    MeanInterval in = estimate_of(&y).interval;
    total.low_lx = in.low;
    total.high_lx = in.high;
    return total;
}

bool illuminance_measure(const Scene *scene, const IlluminanceOptions *options, Arena *arena,
                         Illuminance *out, Error *err) {
    Lights *lights;
    Bvh *bvh;
    if (!lights_build(scene, arena, &lights, err)) return false;
    if (!bvh_create(scene, options->threads, NULL, &bvh, err)) return false;
    PathContext context = path_context_build(scene, bvh, lights, options->max_bounces, arena);
    Progress progress = progress_start(options->progress, "illuminance", "points", options->count);
    PathContext *contexts = ARENA_NEW(arena, PathContext, POINTS_AT_ONCE);
    Meter *meter = ARENA_NEW(arena, Meter, 1);
    for (int done = 0; done < options->count; done += POINTS_AT_ONCE) {
        int left = options->count - done;
        int count = left < POINTS_AT_ONCE ? left : POINTS_AT_ONCE;
        const LitPoint *points = options->points + done;
        *meter = (Meter){
            .context = &context, .contexts = contexts, .options = options, .points = points};
        parallel_for(options->threads, count, place_meter, meter);
        parallel_for(options->threads, count * BATCHES, measure_batch, meter);
        for (int i = 0; i < count; i++) out[done + i] = add_batches(meter, i);
        progress_update(&progress, done + count);
    }
    progress_end(&progress, options->count);
    bvh_destroy(bvh);
    return true;
}
