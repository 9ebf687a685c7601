/* SPDX-License-Identifier: Apache-2.0 */
#include "kernel/kernel.h"

#include "path/collect/seen.h"
#include "path/path_features.h"

static void copy3(float to[3], const float from[3]) {
    for (int i = 0; i < 3; i++) to[i] = from[i];
}

static void set3(float to[3], Vec3 from) {
    to[0] = from.x;
    to[1] = from.y;
    to[2] = from.z;
}

/* Of the world: what a frame shows. */
static void set_position(float to[3], const Scene *scene, Vec3 p) {
    double at[3];
    world_from_scene(scene->origin, p, at);
    set3(to, vec3_from_doubles(at));
}

static void add_features(const TileJob *job, const PathResult *result,
                         const Wavelengths *wavelengths, FilmSample *sample) {
    PathFeatures features;
    path_features(job->context, result, wavelengths, &features);
    sample->hit = true;
    sample->depth = features.depth;
    set_position(sample->position, job->context->scene, features.position);
    set3(sample->normal, features.normal);
    copy3(sample->albedo, features.albedo);
    sample->uv[0] = features.uv[0];
    sample->uv[1] = features.uv[1];
    sample->part_id = features.part_id;
    sample->display_id = features.display_id;
    copy3(sample->sources, features.sources);
    copy3(sample->emitted, features.emitted);
    copy3(sample->white, features.white);
    copy3(sample->black, features.black);
    sample->extrapolated[0] = features.is_measured ? 0 : features.emitted[1];
    sample->theta = features.theta;
    sample->phi = features.phi;
}

/* Rays for each sample that saw a display. A few samples place the edges of content badly;
 * many place them well, and more rays would be wasted. */
#define FINE_RAYS 8u
#define FINE_SAMPLES 64u /* after which each has one */
#define FINE_SEED 0x51a7c0deu

/* A sample's rays, as indices of their own points: one after the other without a gap. */
static void fine_range(uint32_t sample, uint32_t *first, uint32_t *count) {
    const uint32_t before = FINE_SAMPLES * (FINE_RAYS - 1);
    *count = sample < FINE_SAMPLES ? FINE_RAYS : 1;
    *first = sample < FINE_SAMPLES ? sample * FINE_RAYS : sample + before;
}

/* Adds what displays send through one place of the film, as `emitted` counts it. */
static void add_fine_ray(const TileJob *job, Ray ray, const Wavelengths *wavelengths,
                         Sampler *sampler, FilmSample *out, PathStatistics *statistics) {
    PathContext eye = *job->context;
    SeenLight seen;
    PathStatistics counted = {0};
    PathStart start = {.context = &eye,
                       .wavelengths = wavelengths,
                       .sampler = sampler,
                       .statistics = &counted,
                       .manner = {.is_dark = true}};
    SeenRequest request = {.listener = NULL};
    float emitted[3];
    eye.max_bounces = 0;
    path_seen(&start, ray, &request, &seen);
    statistics->camera_rays += counted.camera_rays;
    if (!seen.path.hit || !path_display_emission(&eye, &seen.path, wavelengths, emitted)) return;
    for (int i = 0; i < 3; i++) out->fine[i] += emitted[i];
}

/* Rays of their own points, whether the sample's own met a display or not: given how many
 * samples did, the mean of these rays is without bias over the pixel. */
static void add_fine(const TileJob *job, int x, int y, const Wavelengths *wavelengths,
                     FilmSample *out, PathStatistics *statistics) {
    uint32_t first, count;
    fine_range(out->sample_index, &first, &count);
    for (uint32_t k = 0; k < count; k++) {
        Sampler sampler = sampler_start(job->seed ^ FINE_SEED, x, y, first + k);
        Vec2 at = sampler_2d(&sampler);
        Ray ray = camera_pixel_ray(job->camera, x, y, at, &sampler);
        add_fine_ray(job, ray, wavelengths, &sampler, out, statistics);
    }
    for (int i = 0; i < 3; i++) out->fine[i] /= (float)count;
}

/* ---- groups of lights -------------------------------------------------------------------- */

/* The light of each group in one sample. */
typedef struct LightSums {
    const LightGroups *groups;
    int count;
    FilmLight found[FILM_LIGHTS_MAX];
    int place[FILM_LIGHTS_MAX]; /* of a group among those found; -1: not yet */
} LightSums;

static void lights_start(const LightGroups *groups, LightSums *sums) {
    sums->groups = groups;
    sums->count = 0;
    for (int i = 0; groups && i < groups->count; i++) sums->place[i] = -1;
}

static void lights_clear(LightSums *sums) {
    for (int i = 0; i < sums->count; i++) sums->place[sums->found[i].group] = -1;
    sums->count = 0;
}

/* Paths that leave the scene report sun and sky, also where there is none: it has no group. */
static void lights_add(void *user, const PathHistory *history, const float xyz[3]) {
    LightSums *sums = user;
    int group = light_group_of(sums->groups, history->source, history->source_id);
    if (group == NO_ID) return;
    int *place = &sums->place[group];
    if (*place < 0) {
        *place = sums->count++;
        sums->found[*place] = (FilmLight){group, {0, 0, 0}};
    }
    for (int i = 0; i < 3; i++) sums->found[*place].xyz[i] += xyz[i];
}

/* ---- tiles ------------------------------------------------------------------------------- */

/* One thread's work on a tile. */
typedef struct TileWork {
    const TileJob *job;
    PathStatistics *statistics;
    LightSums lights;
} TileWork;

static void trace(TileWork *work, Ray ray, const Wavelengths *wavelengths, Sampler *sampler,
                  SeenLight *out) {
    const TileJob *job = work->job;
    const PathListener listener = {.on_light = lights_add, .user = &work->lights};
    const SeenRequest request = {job->with_lambertian, job->with_extrapolated,
                                 job->lights ? &listener : NULL};
    const PathStart start = {.context = job->context,
                             .wavelengths = wavelengths,
                             .sampler = sampler,
                             .statistics = work->statistics};
    path_seen(&start, ray, &request, out);
}

static void tile_sample(TileWork *work, int x, int y, uint32_t index, FilmSample *out) {
    const TileJob *job = work->job;
    Sampler sampler = sampler_start(job->seed, x, y, index);
    Vec2 at = sampler_2d(&sampler); /* the filter is a box of one pixel */
    Wavelengths wavelengths;
    SeenLight seen;
    wavelengths_sample(sampler_1d(&sampler), &wavelengths);
    Ray ray = camera_pixel_ray(job->camera, x, y, at, &sampler);
    trace(work, ray, &wavelengths, &sampler, &seen);
    *out = (FilmSample){.sample_index = index, .part_id = -1, .display_id = -1};
    copy3(out->xyz, seen.path.xyz);
    copy3(out->stokes, seen.stokes);
    copy3(out->mirror, seen.path.mirror);
    copy3(out->lambertian, seen.lambertian);
    out->extrapolated[1] = seen.extrapolated[1];
    if (job->with_features && seen.path.hit) add_features(job, &seen.path, &wavelengths, out);
    if (job->with_fine && out->display_id >= 0)
        add_fine(job, x, y, &wavelengths, out, work->statistics);
}

static void pixel_render(TileWork *work, int x, int y) {
    const TileJob *job = work->job;
    uint32_t share = sample_shares_at(&job->shares, x, y);
    uint32_t end = sample_shares_own(share, job->end_sample);
    for (uint32_t index = sample_shares_own(share, job->first_sample); index < end; index++) {
        FilmSample sample;
        tile_sample(work, x, y, index, &sample);
        sample.lights = work->lights.found;
        sample.light_count = work->lights.count;
        film_add_sample(job->film, x, y, &sample);
        lights_clear(&work->lights);
    }
}

static void tile_render(const TileJob *job, FilmRect rect, PathStatistics *statistics) {
    TileWork work;
    work.job = job;
    work.statistics = statistics;
    lights_start(job->lights, &work.lights);
    for (int y = rect.y0; y < rect.y1; y++)
        for (int x = rect.x0; x < rect.x1; x++)
            if (camera_sees_pixel(job->camera, x, y)) pixel_render(&work, x, y);
}

/* ---- which pixels show a display --------------------------------------------------------- */

#define SEARCH_RAYS 4u /* through a pixel */
#define SEARCH_SEED 0x666f7264u

static bool ray_shows(const DisplaySearch *search, const PathContext *eye, Sampler *sampler,
                      Ray ray) {
    SeenRequest request = {.listener = NULL};
    PathStatistics uncounted = {0};
    SeenLight seen;
    PathFeatures features;
    Wavelengths wavelengths;
    wavelengths_sample(sampler_1d(sampler), &wavelengths);
    PathStart start = {.context = eye,
                       .wavelengths = &wavelengths,
                       .sampler = sampler,
                       .statistics = &uncounted,
                       .manner = {.is_dark = true}};
    path_seen(&start, ray, &request, &seen);
    if (!seen.path.hit) return false;
    path_features(eye, &seen.path, &wavelengths, &features);
    return search->display == FILM_ANY_DISPLAY ? features.display_id != NO_ID
                                               : features.display_id == search->display;
}

static bool pixel_shows(const DisplaySearch *search, const PathContext *eye, int x, int y) {
    if (!camera_sees_pixel(search->camera, x, y)) return false;
    for (uint32_t k = 0; k < SEARCH_RAYS; k++) {
        Sampler sampler = sampler_start(SEARCH_SEED, x, y, k);
        Vec2 at = sampler_2d(&sampler);
        Ray ray = camera_pixel_ray(search->camera, x, y, at, &sampler);
        if (ray_shows(search, eye, &sampler, ray)) return true;
    }
    return false;
}

static void tile_find_displays(const DisplaySearch *search, FilmRect part) {
    PathContext eye = *search->context;
    size_t columns = (size_t)(search->rect.x1 - search->rect.x0);
    eye.max_bounces = 0;
    for (int y = part.y0; y < part.y1; y++)
        for (int x = part.x0; x < part.x1; x++)
            search->shows[(size_t)(y - search->rect.y0) * columns + (size_t)(x - search->rect.x0)] =
                pixel_shows(search, &eye, x, y);
}

/* ---- training passes --------------------------------------------------------------------- */

static void train_find_places(const TrainingJob *job, FilmRect rect, PathStatistics *statistics) {
    for (int y = rect.y0; y < rect.y1; y++)
        for (int x = rect.x0; x < rect.x1; x++) {
            Sampler sampler = sampler_start(job->seed, x, y, job->index);
            Vec2 at = sampler_2d(&sampler);
            Wavelengths wavelengths;
            wavelengths_sample(sampler_1d(&sampler), &wavelengths);
            Vec2 place = {((float)x + at.x) * job->stretch.x, ((float)y + at.y) * job->stretch.y};
            if (!camera_sees(job->camera, place.x, place.y)) continue;
            Ray ray = camera_ray(job->camera, place.x, place.y);
            TrainingPlaces places =
                training_places(&job->places[(size_t)y * (size_t)job->columns + (size_t)x]);
            PathStart start = {.context = job->context,
                               .wavelengths = &wavelengths,
                               .sampler = &sampler,
                               .statistics = statistics,
                               .collector = &places.base,
                               .manner = {.is_dark = true}};
            path_from_ray(&start, ray, NULL);
        }
}

/* Sends one ray from every point of the training pass into every bin above its horizon. */
static void train_cell(const TrainingJob *job, uint32_t cell, PathStatistics *statistics) {
    const CellTraining *own = &job->training->cells[cell];
    for (int bin = 0; bin < GUIDE_BINS; bin++)
        for (int i = 0; i < own->point_count; i++) {
            Sampler sampler = sampler_start(job->seed, (int)cell, bin, job->index + (uint32_t)i);
            Vec2 at = sampler_2d(&sampler);
            LitPoint point = {own->points[i].position, own->points[i].normal, false};
            Vec3 towards = guide_bin_direction(bin, at.x, at.y);
            Wavelengths wavelengths;
            if (!(vec3_dot(towards, point.ns) > 0)) continue;
            wavelengths_sample(sampler_1d(&sampler), &wavelengths);
            float cd_m2[GUIDE_AIMS];
            PathResult rest;
            TrainingSky sky = training_sky(&cd_m2[GUIDE_SKY]);
            PathStart start = {.context = job->context,
                               .wavelengths = &wavelengths,
                               .sampler = &sampler,
                               .statistics = statistics,
                               .collector = &sky.base,
                               .from = &point};
            path_from_ray(&start, (Ray){point.position, towards, 0, INFINITY}, &rest);
            cd_m2[GUIDE_LIGHT] = rest.xyz[1];
            guide_training_add(own, bin, cd_m2);
        }
}

static void train_try_lights(const TrainingJob *job, uint32_t cell, PathStatistics *statistics) {
    const GuideTraining *training = job->training;
    const PathContext *context = job->context;
    uint32_t first = training->first_place[cell], end = training->first_place[cell + 1];
    statistics->shadow_rays += LIGHT_CHOICES * (uint64_t)(end - first);
    for (uint32_t i = first; i < end; i++) {
        Sampler sampler = sampler_start(job->seed + 1, (int)cell, 0, i - first);
        LitPoint point = {training->places[i].position, training->places[i].normal, false};
        cell_lights_try(context, point, cell, &sampler, &job->finds[cell]);
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
const Kernel KERNEL_NAME = {KERNEL_ISA,        tile_render,      tile_find_displays,
                            train_find_places, train_cell,       train_try_lights,
                            aim_look,          aim_trace,        aim_sample_cells,
                            aim_sample_suns,   aim_sample_images};
