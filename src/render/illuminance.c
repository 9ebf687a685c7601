/* SPDX-License-Identifier: Apache-2.0 */
#include "render/illuminance.h"

#include "base/parallel.h"

#define CHUNK 1024 /* samples of one piece of work; pieces are added in order */

typedef struct IlluminanceSums {
    double xyz[3], squares;
} IlluminanceSums;

typedef struct Meter {
    const PathContext        *context;
    const IlluminanceOptions *options;
    IlluminanceSums                     *sums; /* one a chunk */
} Meter;

static void measure_chunk(void *user, int chunk, int worker)
{
    (void)worker;
    const Meter *meter = user;
    const IlluminanceOptions *options = meter->options;
    PathStatistics statistics = {0};
    IlluminanceSums *sums = &meter->sums[chunk];
    long  begin = (long)chunk * CHUNK, end = begin + CHUNK;
    for (long i = begin; i < end && i < options->samples; i++) {
        Sampler     sampler = sampler_start(options->seed, 0, 0, (uint32_t)i);
        Wavelengths wavelengths;
        float       xyz[3];
        wavelengths_sample(sampler_1d(&sampler), &wavelengths);
        path_illuminance(meter->context, options->point, &wavelengths, &sampler, xyz,
                         &statistics);
        for (int k = 0; k < 3; k++) sums->xyz[k] += (double)xyz[k];
        sums->squares += (double)xyz[1] * (double)xyz[1];
    }
}

static Illuminance add_chunks(const IlluminanceSums *sums, int chunks, double samples)
{
    Illuminance total = {0};
    double squares = 0;
    for (int c = 0; c < chunks; c++) {
        for (int k = 0; k < 3; k++) total.xyz_lx[k] += sums[c].xyz[k] / samples;
        squares += sums[c].squares / samples;
    }
    double variance = squares - total.xyz_lx[1] * total.xyz_lx[1];
    total.sigma_lx = sqrt(fmax(variance, 0) / (samples - 1));
    return total;
}

bool illuminance_measure(const Scene *scene, const IlluminanceOptions *options, Arena *arena,
                         Illuminance *out, Error *err)
{
    int     chunks = (int)((options->samples + CHUNK - 1) / CHUNK);
    Lights *lights;
    Bvh    *bvh;
    if (!lights_build(scene, arena, &lights, err)) return false;
    if (!bvh_create(scene, options->threads, NULL, &bvh, err)) return false;
    PathContext context = path_context_build(scene, bvh, lights, options->max_bounces, arena);
    Meter meter = {&context, options, ARENA_NEW(arena, IlluminanceSums, chunks)};
    parallel_for(options->threads, chunks, measure_chunk, &meter);
    bvh_destroy(bvh);
    *out = add_chunks(meter.sums, chunks, (double)options->samples);
    return true;
}
