/* SPDX-License-Identifier: Apache-2.0 */
/* bench_metrics.c -- seconds of processor time of what compares two pictures, 1920 x 1080.
 *
 *     bench_metrics [RUNS]      one thread, fixed seeds, median and spread (least to most)
 */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "bench_timing.h"
#include "compare/metrics/deltae.h"
#include "compare/metrics/flip.h"
#include "compare/metrics/pixel_errors.h"
#include "compare/metrics/ssim.h"

enum { WIDTH = 1920, HEIGHT = 1080, PIXELS = WIDTH * HEIGHT, MAX_RUNS = 99 };

typedef struct Inputs {
    Planes reference, test;
    float *map;
    Arena  scratch;
    double sink; /* keeps results from being dropped */
} Inputs;

typedef void (*Work)(Inputs *in);

static void work_flip(Inputs *in)
{
    const FlipOptions options = {.threads = 1};
    flip_ldr(&in->reference, &in->test, &options, in->scratch, in->map);
    in->sink += map_summary(in->map, PIXELS, NULL).mean;
}

static void work_hdr_flip(Inputs *in)
{
    const FlipOptions options = {.threads = 1, .has_range = true, .start_ev = -6, .stop_ev = 3,
                                 .exposures = 10};
    flip_hdr(&in->reference, &in->test, &options, in->scratch, in->map, NULL);
    in->sink += map_summary(in->map, PIXELS, NULL).mean;
}

static void work_ssim(Inputs *in)
{
    in->sink += ssim_mean(&in->reference, &in->test, NULL, in->map, in->scratch);
}

static void work_deltae(Inputs *in)
{
    in->sink += deltae_pictures(&in->reference, &in->test, NULL, in->map).mean;
}

static void work_errors(Inputs *in)
{
    in->sink += pixel_errors_measure(&in->reference, &in->test, NULL, true, in->scratch).mse;
}

/* Waves of colour with noise of their own. */
static Planes make_picture(uint64_t seed, Arena *arena)
{
    Planes planes = {.width = WIDTH, .height = HEIGHT};
    for (int c = 0; c < 3; c++) {
        float *plane = ARENA_NEW(arena, float, PIXELS);
        for (int i = 0; i < PIXELS; i++) {
            seed = seed * 6364136223846793005u + 1442695040888963407u;
            double noise = (double)(seed >> 40) / (1 << 24);
            double wave = sin(0.01 * (i % WIDTH) + c) * cos(0.012 * (double)(i / WIDTH));
            plane[i] = (float)((0.5 + 0.4 * wave) * (0.8 + 0.2 * noise));
        }
        planes.rgb[c] = plane;
    }
    return planes;
}

static void run(const char *name, Work work, Inputs *in, int runs)
{
    double times[MAX_RUNS];
    for (int r = 0; r < runs; r++) {
        double start = clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
        work(in);
        times[r] = clock_seconds(CLOCK_PROCESS_CPUTIME_ID) - start;
    }
    double median = median_of(times, runs);
    printf("%-24s %8.3f s (%.3f to %.3f)\n", name, median, times[0], times[runs - 1]);
}

int main(int argc, char **argv)
{
    int runs = argc > 1 ? atoi(argv[1]) : 5;
    runs = runs < 1 ? 1 : runs > MAX_RUNS ? MAX_RUNS : runs;
    Arena  arena = arena_reserve((size_t)1 << 30);
    Inputs in = {.reference = make_picture(1, &arena), .test = make_picture(2, &arena),
                 .map = ARENA_NEW(&arena, float, PIXELS)};
    in.scratch = arena;
    run("FLIP", work_flip, &in, runs);
    run("HDR-FLIP, 10 exposures", work_hdr_flip, &in, runs);
    run("SSIM", work_ssim, &in, runs);
    run("CIEDE2000", work_deltae, &in, runs);
    run("MSE, PSNR ...", work_errors, &in, runs);
    arena_release(&arena);
    return in.sink == 0.125; /* used, never true */
}
