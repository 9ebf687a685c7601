/* SPDX-License-Identifier: Apache-2.0 */
#include "render/tiles.h"

#define TILE_SIDE 16                 /* pixels: a few milliseconds of work */
#define PASS_PATHS ((size_t)1 << 22) /* of one pass at most, where a pixel gets more than one */
#define PASS_SAMPLES_MAX 16u

static int tiles_across(FilmRect crop) {
    return (crop.x1 - crop.x0 + TILE_SIDE - 1) / TILE_SIDE;
}

int render_tile_count(FilmRect crop) {
    return tiles_across(crop) * ((crop.y1 - crop.y0 + TILE_SIDE - 1) / TILE_SIDE);
}

FilmRect render_tile(FilmRect crop, int index) {
    int x0 = crop.x0 + index % tiles_across(crop) * TILE_SIDE;
    int y0 = crop.y0 + index / tiles_across(crop) * TILE_SIDE;
    return (FilmRect){x0, y0, x0 + TILE_SIDE < crop.x1 ? x0 + TILE_SIDE : crop.x1,
                      y0 + TILE_SIDE < crop.y1 ? y0 + TILE_SIDE : crop.y1};
}

uint32_t render_pass_samples(uint32_t done, size_t pixels) {
    size_t fits = PASS_PATHS / pixels;
    uint32_t most = fits < 1 ? 1 : fits > PASS_SAMPLES_MAX ? PASS_SAMPLES_MAX : (uint32_t)fits;
    uint32_t end = 0;
    while (end < most && end <= done) end += end < 1 ? 1 : end;
    if (end <= done) end += ((done - end) / most + 1) * most;
    return end - done;
}

PathStatistics worker_counts_sum(const WorkerCounts *counts, int threads) {
    PathStatistics sum = {0};
    for (int i = 0; i < threads; i++) {
        sum.samples += counts[i].statistics.samples;
        sum.camera_rays += counts[i].statistics.camera_rays;
        sum.bounce_rays += counts[i].statistics.bounce_rays;
        sum.shadow_rays += counts[i].statistics.shadow_rays;
    }
    return sum;
}
