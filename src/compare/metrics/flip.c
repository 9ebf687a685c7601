/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/metrics/flip.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "base/parallel.h"
#include "compare/metrics/flip_tile.h"
#include "compare/metrics/mask_fill.h"
#include "compare/metrics/rank.h"

enum { TILE_ROWS = 128 };

typedef struct Tiles {
    const FlipJob *job;
    FlipScratch  **scratch; /* of each worker */
    int            columns;
} Tiles;

static int lower(int a, int b)
{
    return a < b ? a : b;
}

static void work_on_tile(void *context, int item, int worker)
{
    const Tiles  *tiles = context;
    const Planes *picture = tiles->job->reference;
    int           x0 = item % tiles->columns * FLIP_TILE;
    int           y0 = item / tiles->columns * TILE_ROWS;
    FlipTile      tile = {x0, lower(x0 + FLIP_TILE, picture->width), y0,
                          lower(y0 + TILE_ROWS, picture->height)};
    flip_tile(tiles->job, tile, tiles->scratch[worker]);
}

static void run(const FlipJob *job, int threads, Arena scratch)
{
    const Planes *picture = job->reference;
    size_t        count = planes_pixel_count(picture);
    int           columns = (picture->width + FLIP_TILE - 1) / FLIP_TILE;
    int           items = columns * ((picture->height + TILE_ROWS - 1) / TILE_ROWS);
    int           workers = lower(lower(threads, items), PARALLEL_THREADS_MAX);
    Tiles tiles = {job, ARENA_NEW(&scratch, FlipScratch *, workers), columns};
    for (int i = 0; i < workers; i++) tiles.scratch[i] = flip_scratch_create(job, &scratch);
    memset(job->map, 0, count * sizeof *job->map);
    if (job->exposure_map) memset(job->exposure_map, 0, count * sizeof *job->exposure_map);
    parallel_for(workers, items, work_on_tile, &tiles);
}

static double chosen_ppd(const FlipOptions *options)
{
    return options->pixels_per_degree > 0 ? options->pixels_per_degree : FLIP_PIXELS_PER_DEGREE;
}

void flip_ldr(const Planes *reference, const Planes *test, const FlipOptions *options,
              Arena scratch, float *map)
{
    const Planes filled[2] = {mask_fill(reference, options->mask, &scratch),
                              mask_fill(test, options->mask, &scratch)};
    FlipJob job = flip_job_create(&filled[0], &filled[1], chosen_ppd(options), &scratch);
    job.exposures = 1;
    job.map = map;
    run(&job, options->threads, scratch);
}

/* The greatest and the median luminance of what is not black; false for a black picture. The
 * median is that of FLIP 1.6 where less than half of the picture is black; beyond that the
 * authors' is 0, and their range has no end. */
static bool find_luminances(const Planes *picture, PixelMask mask, Arena scratch,
                            double *median, double *most)
{
    size_t         count = planes_pixel_count(picture), lit = 0, counting = 0;
    float         *luminance = ARENA_NEW(&scratch, float, count);
    unsigned char *is_lit = ARENA_NEW(&scratch, unsigned char, count);
    for (size_t i = 0; i < count; i++) {
        const float weights[3] = {0.2126f, 0.7152f, 0.0722f};
        if (mask && !mask[i]) continue;
        counting++;
        for (int c = 0; c < 3; c++)
            luminance[i] += weights[c] * fmaxf(picture->rgb[c][i], 0);
        is_lit[i] = luminance[i] > 0;
        lit += is_lit[i];
    }
    if (!lit) return false;
    *most = (double)rank_value(luminance, count, mask, 1);
    /* the value at counting / 2, counted from 0 */
    double middle = ((double)(counting / 2) + 0.5) / (double)counting;
    *median = (double)rank_value(luminance, count, mask, middle);
    if (!(*median > 0)) *median = (double)rank_value(luminance, count, is_lit, 0.5);
    return true;
}

/* The brightest light just so at 0.85, and the median just so. */
static FlipExposures find_exposures(const Planes *reference, const FlipOptions *options,
                                    Arena scratch)
{
    FlipExposures range = {options->start_ev, options->stop_ev, options->exposures};
    double        median, most, bright = flip_tone_input(options->tone_mapper, 0.85);
    if (!options->has_range) {
        bool has_light = find_luminances(reference, options->mask, scratch, &median, &most);
        range.start_ev = has_light ? log2_d(bright / most) : 0;
        range.stop_ev = has_light ? log2_d(bright / median) : 1;
    }
    double span = ceil(range.stop_ev - range.start_ev);
    if (range.count <= 0) range.count = span > 2 ? (int)span : 2;
    if (range.stop_ev == range.start_ev) range.count = 1;
    return range;
}

FlipExposures flip_hdr(const Planes *reference, const Planes *test, const FlipOptions *options,
                       Arena scratch, float *map, float *exposure_map)
{
    const Planes filled[2] = {mask_fill(reference, options->mask, &scratch),
                              mask_fill(test, options->mask, &scratch)};
    FlipJob job = flip_job_create(&filled[0], &filled[1], chosen_ppd(options), &scratch);
    const FlipExposures range = find_exposures(reference, options, scratch);
    double *gains = ARENA_NEW(&scratch, double, range.count);
    double  step = range.count > 1 ? (range.stop_ev - range.start_ev) / (range.count - 1) : 0;
    for (int i = 0; i < range.count; i++) gains[i] = exp2_d(range.start_ev + i * step);
    job.is_hdr = true;
    job.tone_mapper = options->tone_mapper;
    job.exposures = range.count;
    job.gains = gains;
    job.map = map;
    job.exposure_map = exposure_map;
    run(&job, options->threads, scratch);
    return range;
}
