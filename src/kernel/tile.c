#include "kernel/kernel.h"

#include "path/path_features.h"

static void copy3(float to[3], const float from[3])
{
    for (int i = 0; i < 3; i++) to[i] = from[i];
}

static void set3(float to[3], Vec3 from)
{
    to[0] = from.x;
    to[1] = from.y;
    to[2] = from.z;
}

static void add_features(const TileJob *job, const PathResult *result,
                         const Wavelengths *wavelengths, FilmSample *sample)
{
    PathFeatures features;
    path_features(job->context, result, wavelengths, &features);
    sample->hit = true;
    sample->depth = features.depth;
    set3(sample->position, features.position);
    set3(sample->normal, features.normal);
    copy3(sample->albedo, features.albedo);
    sample->uv[0] = features.uv[0];
    sample->uv[1] = features.uv[1];
    sample->part_id = features.part_id;
    sample->display_id = features.display_id;
    copy3(sample->emitted, features.emitted);
    copy3(sample->white, features.white);
    copy3(sample->black, features.black);
    sample->theta = features.theta;
    sample->phi = features.phi;
}

static void tile_sample(const TileJob *job, int x, int y, uint32_t index, FilmSample *out,
                        PathStatistics *statistics)
{
    Sampler sampler = sampler_start(job->seed, x, y, index);
    Vec2    at = sampler_2d(&sampler); /* the filter is a box of one pixel */
    Wavelengths wavelengths;
    PathResult  result;
    wavelengths_sample(sampler_1d(&sampler), &wavelengths);
    Ray ray = camera_ray(job->camera, (float)x + at.x, (float)y + at.y);
    path_trace(job->context, ray, &wavelengths, &sampler, &result, statistics);
    *out = (FilmSample){.sample_index = index, .part_id = -1, .display_id = -1};
    copy3(out->xyz, result.xyz);
    if (job->with_features && result.hit) add_features(job, &result, &wavelengths, out);
}

static void tile_render(const TileJob *job, FilmRect rect, PathStatistics *statistics)
{
    for (int y = rect.y0; y < rect.y1; y++)
        for (int x = rect.x0; x < rect.x1; x++)
            for (uint32_t index = job->first_sample; index < job->end_sample; index++) {
                FilmSample sample;
                tile_sample(job, x, y, index, &sample, statistics);
                film_add_sample(job->film, x, y, &sample);
            }
}

/* The build compiles this file once for each instruction set, each under its own name. */
#ifndef KERNEL_NAME
#define KERNEL_NAME kernel_base
#endif
#if defined(__AVX512F__)
#define KERNEL_ISA "avx512"
#elif defined(__AVX2__)
#define KERNEL_ISA "avx2"
#elif defined(__x86_64__)
#define KERNEL_ISA "sse2"
#else
#define KERNEL_ISA "native"
#endif
extern const Kernel KERNEL_NAME;
const Kernel KERNEL_NAME = {KERNEL_ISA, tile_render};
