#include "render/tile.h"

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

void tile_sample(const TileJob *job, int x, int y, uint32_t index, FilmSample *out,
                 PathStatistics *statistics)
{
    Sampler sampler = sampler_start(job->seed, x, y, index);
    Vec2    at = sampler_2d(&sampler); /* the filter is a box of one pixel */
    Wavelengths wavelengths;
    PathResult  result;
    wavelengths_sample(sampler_1d(&sampler), &wavelengths);
    Ray ray = camera_ray(job->camera, (float)x + at.x, (float)y + at.y);
    path_trace(job->context, ray, &wavelengths, &sampler, &result, statistics);
    *out = (FilmSample){.part_id = -1, .display_id = -1};
    copy3(out->xyz, result.xyz);
    if (job->with_features && result.hit) add_features(job, &result, &wavelengths, out);
}

void tile_render(const TileJob *job, FilmRect rect, PathStatistics *statistics)
{
    for (int y = rect.y0; y < rect.y1; y++)
        for (int x = rect.x0; x < rect.x1; x++)
            for (uint32_t index = job->first_sample; index < job->end_sample; index++) {
                FilmSample sample;
                tile_sample(job, x, y, index, &sample, statistics);
                film_add_sample(job->film, x, y, &sample);
            }
}
