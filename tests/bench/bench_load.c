/* SPDX-License-Identifier: Apache-2.0 */
/* bench_load THREADS SCENE [LIGHTS...] -- what passes before the first pixel of a scene.
 *
 * A line a step: its name, seconds of the clock, seconds of all processors, megabytes that are
 * held after it, the most megabytes until then. `read`, in the end, reads the first file once
 * more, now from the system's cache: what loading has to take in any case.
 */
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "base/file.h"
#include "base/machine.h"
#include "bench_timing.h"
#include "bvh/bvh.h"
#include "film/film.h"
#include "kernel/kernel.h"
#include "render/train.h"
#include "scene/load/scene_load.h"

#define SIDE 16 /* pixels of the first tile */
#define MEGABYTE 1e6

typedef struct Bench {
    int threads;
    const char *const *paths;
    int path_count;
    double clock_s, processor_s; /* when the step began */
    Scene *scene;
    Bvh *bvh;
    Lights *lights;
    Camera camera;
    PathContext context;
    const Kernel *kernel;
} Bench;

static double held_bytes(void) {
    unsigned long all = 0, resident = 0; /* proc(5), statm: pages */
    FILE *file = fopen("/proc/self/statm", "r");
    if (file && fscanf(file, "%lu %lu", &all, &resident) != 2) resident = 0;
    if (file) fclose(file);
    return (double)resident * (double)sysconf(_SC_PAGESIZE);
}

static void begin(Bench *bench) {
    bench->clock_s = clock_seconds(CLOCK_MONOTONIC);
    bench->processor_s = clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
}

static void end(Bench *bench, const char *name) {
    printf("%s %.3f %.3f %.1f %.1f\n", name, clock_seconds(CLOCK_MONOTONIC) - bench->clock_s,
           clock_seconds(CLOCK_PROCESS_CPUTIME_ID) - bench->processor_s, held_bytes() / MEGABYTE,
           machine_peak_bytes() / MEGABYTE);
    fflush(stdout);
    begin(bench);
}

static bool read_alone(Bench *bench, Error *err) {
    FileBytes bytes;
    Arena scratch = arena_reserve((size_t)8 << 30);
    bool done = file_read(bench->paths[0], (size_t)4 << 30, &scratch, &bytes, err);
    arena_release(&scratch);
    return done;
}

static bool load(Bench *bench, Arena *arena, Error *err) {
    SceneOptions options = {.paths = bench->paths, .path_count = bench->path_count};
    Problems problems = problems_start(arena);
    return scene_load(&options, arena, &problems, &bench->scene, err);
}

static void render_tile_once(Bench *bench, Arena *arena) {
    FilmRect whole = {0, 0, SIDE, SIDE};
    PathStatistics statistics = {0};
    TileJob job = {.context = &bench->context,
                   .camera = &bench->camera,
                   .film = film_create(SIDE, SIDE, whole, 0, NULL, arena),
                   .seed = 1,
                   .first_sample = 0,
                   .end_sample = 1};
    bench->kernel->render(&job, whole, &statistics);
}

static void make_context(Bench *bench, Arena *arena) {
    const Scene *scene = bench->scene;
    SceneCamera camera = scene->camera_count ? scene->cameras[0] : camera_frame_scene(scene);
    bench->camera = camera_from_scene(&camera, SIDE, SIDE);
    bench->context = path_context_build(scene, bench->bvh, bench->lights, 64, arena);
}

static bool measure(Bench *bench, Arena *arena, Error *err) {
    const TrainOptions train = {bench->kernel, bench->threads, false, 0};
    PathStatistics ignored = {0};
    begin(bench);
    end(bench, "start");
    if (!load(bench, arena, err)) return false;
    end(bench, "load");
    if (!bvh_build(bench->scene, bench->threads, NULL, PROGRESS_NONE, &bench->bvh, err))
        return false;
    end(bench, "tree");
    if (!lights_build(bench->scene, arena, &bench->lights, err)) return false;
    make_context(bench, arena);
    end(bench, "lights");
    bench->context.guide = train_guide(&bench->context, &bench->camera, &train, arena, &ignored);
    end(bench, "learning");
    render_tile_once(bench, arena);
    end(bench, "pixel");
    if (!read_alone(bench, err)) return false;
    end(bench, "read");
    printf("triangles %u parts %d\n", bench->scene->triangle_count, bench->scene->part_count);
    return true;
}

int main(int argc, char **argv) {
    Error err = {0};
    Bench bench = {.threads = argc > 1 ? atoi(argv[1]) : 0};
    char line[2048];
    if (argc < 3 || bench.threads < 1) {
        fprintf(stderr, "usage: bench_load THREADS SCENE [LIGHTS...]\n");
        return 2;
    }
    Arena arena = arena_reserve((size_t)16 << 30);
    bench.paths = (const char *const *)argv + 2;
    bench.path_count = argc - 2;
    if (kernel_choose(NULL, &bench.kernel, &err) && measure(&bench, &arena, &err)) {
        bvh_destroy(bench.bvh);
        scene_close(bench.scene);
        return 0;
    }
    error_line(&err, line, sizeof line);
    fprintf(stderr, "bench_load: %s\n", line);
    return 3;
}
