/* SPDX-License-Identifier: Apache-2.0 */
/* bench_tracing RUNS SCENE... -- how much of a render is ray tracing itself.
 *
 * Renders a frame with one thread, counts its rays by class, then replays the very same rays in
 * the same order through plain single-ray Embree (windows let every shadow ray pass, unasked
 * for their colour). Share = replay time / render time. A line a figure: unit, median, spread.
 */
#include <stdio.h>
#include <stdlib.h>

#include "bench_timing.h"
#include "film/film.h"
#include "kernel/kernel.h"
#include "scene/load/scene_load.h"

#define WIDTH 320
#define HEIGHT 180
#define SAMPLES 4
#define RUNS_MAX 99
#define RAYS_MAX 20000000

typedef struct Bench {
    PathContext context;
    Camera camera;
    Bvh *bvh;
    const Kernel *kernel;
    BvhRecorder recorder;
} Bench;

static void print_row(const char *scene, const char *what, const char *unit, double *values,
                      int runs) {
    double median = median_of(values, runs);
    printf("%-28s %-22s %10.4g %-10s (%.4g to %.4g)\n", scene, what, median, unit, values[0],
           values[runs - 1]);
}

/* One frame; its time in seconds. */
static double render_once(const Bench *bench, Arena scratch, PathStatistics *statistics) {
    FilmRect whole = {0, 0, WIDTH, HEIGHT};
    TileJob job = {.context = &bench->context,
                   .camera = &bench->camera,
                   .film = film_create(WIDTH, HEIGHT, whole, 0, NULL, &scratch),
                   .seed = 1,
                   .first_sample = 0,
                   .end_sample = SAMPLES};
    double begun = thread_seconds();
    bench->kernel->render(&job, whole, statistics);
    return thread_seconds() - begun;
}

static bool always(void *user, const Hit *hit) {
    (void)user;
    (void)hit;
    return true;
}

static double replay_once(const Bench *bench) {
    long hits = 0;
    double begun = thread_seconds();
    for (size_t i = 0; i < bench->recorder.count; i++) {
        Hit hit;
        Ray ray = bench->recorder.rays[i];
        hits += bench->recorder.is_shadow[i] ? bvh_occluded(bench->bvh, ray, always, NULL)
                                             : bvh_intersect(bench->bvh, ray, 0, &hit);
    }
    return hits < 0 ? 0 : thread_seconds() - begun;
}

static void measure(Bench *bench, const char *name, int runs, Arena *arena) {
    double render_s[RUNS_MAX], replay_s[RUNS_MAX], share[RUNS_MAX], rate[RUNS_MAX];
    PathStatistics counted = {0}, ignored = {0};
    bvh_record(bench->bvh, &bench->recorder);
    render_once(bench, *arena, &counted);
    bvh_record(bench->bvh, NULL);
    double paths = (double)counted.samples;
    printf("%-28s rays a path: %.2f camera, %.2f bounce, %.2f shadow; kernel %s\n", name,
           (double)counted.camera_rays / paths, (double)counted.bounce_rays / paths,
           (double)counted.shadow_rays / paths, bench->kernel->isa);
    for (int i = 0; i < runs; i++) {
        render_s[i] = render_once(bench, *arena, &ignored);
        replay_s[i] = replay_once(bench);
        share[i] = replay_s[i] / render_s[i];
        rate[i] = paths / render_s[i];
        replay_s[i] = (double)bench->recorder.count / replay_s[i];
    }
    print_row(name, "paths per second", "paths/s", rate, runs);
    print_row(name, "plain tracing", "rays/s", replay_s, runs);
    print_row(name, "tracing share", "", share, runs);
}

static bool prepare(const char *const *paths, int count, Arena *arena, Bench *bench, Error *err) {
    Problems problems = problems_start(arena);
    Scene *scene;
    Lights *lights;
    SceneOptions options = {.paths = paths, .path_count = count};
    if (!scene_load(&options, arena, &problems, &scene, err)) return false;
    if (!kernel_choose(NULL, &bench->kernel, err)) return false;
    if (!bvh_create(scene, 1, NULL, &bench->bvh, err)) return false;
    if (!lights_build(scene, arena, &lights, err)) return false;
    SceneCamera camera = scene->camera_count ? scene->cameras[0] : camera_frame_scene(scene);
    bench->camera = camera_from_scene(&camera, WIDTH, HEIGHT);
    bench->context = path_context_build(scene, bench->bvh, lights, 8, arena);
    bench->recorder = (BvhRecorder){.rays = ARENA_NEW(arena, Ray, RAYS_MAX),
                                    .is_shadow = ARENA_NEW(arena, bool, RAYS_MAX),
                                    .capacity = RAYS_MAX};
    return true;
}

int main(int argc, char **argv) {
    Arena arena = arena_reserve((size_t)16 << 30);
    Error err = {0};
    Bench bench = {0};
    int runs = argc > 1 ? atoi(argv[1]) : 5;
    char line[2048];
    if (argc < 3 || runs < 1 || runs > RUNS_MAX) {
        fprintf(stderr, "usage: bench_tracing RUNS SCENE [LIGHTS...]\n");
        return 2;
    }
    if (!prepare((const char *const *)argv + 2, argc - 2, &arena, &bench, &err)) {
        error_line(&err, line, sizeof line);
        fprintf(stderr, "bench_tracing: %s\n", line);
        return 3;
    }
    measure(&bench, argv[2], runs, &arena);
    scene_close((Scene *)bench.context.scene);
    bvh_destroy(bench.bvh);
    return 0;
}
