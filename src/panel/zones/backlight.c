/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/zones/backlight.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "base/mathf.h"

/* Zone i of a row of `count` and of its mirror images. */
static int folded(long i, int count) {
    long period = 2L * count, at = i % period;
    if (at < 0) at += period;
    return (int)(at < count ? at : period - 1 - at);
}

#define GAUSSIAN_REACH 6.0 /* sigmas: beyond, 2e-8 of the middle */
#define FINE_SAMPLES 12.0  /* in a sigma; of a table twice as many in its half width */
#define SAMPLES_MOST 4000000.0
#define WORK_MOST 4e8 /* products of a table's spread */

/* A Gaussian of twice the display's side, folded at both ends, is even to 1e-8: no wider one is
 * summed up. */
static double sigma_along(const DimmingZones *zones, int k) {
    return fmin(zones->sigma_mm, 2 * zones->size_mm[k]);
}

static double pitch(const DimmingZones *zones, int k) {
    return zones->size_mm[k] / zones->count[k];
}

/* How far the light of a zone counts, in zones. */
static int reach(const DimmingZones *zones, int k) {
    double mm = zones->sigma_mm > 0 ? GAUSSIAN_REACH * sigma_along(zones, k)
                                    : zones->spread.at[zones->spread.rows - 1];
    return (int)ceil(mm / pitch(zones, k)) + 1;
}

/* Where the spread is half of what it is in the middle. */
static double half_width(const DimmingZones *zones) {
    double most = zones->spread.at[zones->spread.rows - 1], mm = most;
    for (int i = 256; i >= 1; i--)
        if (dimming_zones_spread(zones, most * i / 256) <= 0.5 * dimming_zones_spread(zones, 0))
            mm = most * i / 256;
    return mm;
}

/* ---- the map ----------------------------------------------------------------------------- */

/* A map while it is made. */
typedef struct MapWork {
    const DimmingZones *zones;
    const double *drive;
    int fine[2]; /* samples in a zone */
    int size[2]; /* of the map */
    float *out;  /* Backlight.light */
} MapWork;

static void keep(MapWork *work, int x, int y, double light) {
    float *out = work->out + (size_t)y * (size_t)work->size[0] + x;
    float b = light > 1 - 1e-6 ? 1 : (float)fmax(light, (double)BACKLIGHT_DARK);
    *out = work->zones->sigma_mm > 0 ? log_f(b) : b;
}

/* The shares of a row's zones at each sample along axis k: [sample][zone], adding up to 1. A
 * Gaussian is a product of its axes. */
static double *axis_shares(const MapWork *work, int k, Arena *scratch) {
    const DimmingZones *zones = work->zones;
    int count = zones->count[k], far = reach(zones, k);
    double *share = ARENA_NEW(scratch, double, (size_t)work->size[k] * (size_t)count);
    for (int i = 0; i < work->size[k]; i++) {
        double *row = share + (size_t)i * (size_t)count, full = 0;
        double at = (i + 0.5) / work->fine[k] - 0.5;
        for (long z = lround(at) - far; z <= lround(at) + far; z++) {
            double over = ((double)z - at) * pitch(zones, k) / sigma_along(zones, k);
            double one = exp_d(-0.5 * over * over);
            row[folded(z, count)] += one;
            full += one;
        }
        for (int z = 0; z < count; z++) row[z] /= full;
    }
    return share;
}

static void map_gaussian(MapWork *work, Arena scratch) {
    int columns = work->zones->count[0], rows = work->zones->count[1];
    double *across = axis_shares(work, 0, &scratch), *down = axis_shares(work, 1, &scratch);
    double *line = ARENA_NEW(&scratch, double, columns);
    for (int y = 0; y < work->size[1]; y++) {
        memset(line, 0, sizeof *line * (size_t)columns);
        for (int r = 0; r < rows; r++) {
            double share = down[(size_t)y * (size_t)rows + r];
            if (share < 1e-9) continue;
            for (int c = 0; c < columns; c++)
                line[c] += share * work->drive[(size_t)r * (size_t)columns + c];
        }
        for (int x = 0; x < work->size[0]; x++) {
            const double *share = across + (size_t)x * (size_t)columns;
            double light = 0;
            for (int c = 0; c < columns; c++) light += share[c] * line[c];
            keep(work, x, y, light);
        }
    }
}

/* Light of the zones around a sample: which in a zone, and which zone. */
static double around(const MapWork *work, const double *kernel, const int reaches[2],
                     const int zone[2]) {
    double light = 0;
    for (int dy = -reaches[1]; dy <= reaches[1]; dy++) {
        int row = folded(zone[1] + dy, work->zones->count[1]);
        for (int dx = -reaches[0]; dx <= reaches[0]; dx++, kernel++)
            if (*kernel > 0)
                light += *kernel * work->drive[row * work->zones->count[0] +
                                               folded(zone[0] + dx, work->zones->count[0])];
    }
    return light;
}

/* A table's spread: one kernel for each place in a zone, which serves all zones. */
static void map_table(MapWork *work, Arena scratch) {
    const DimmingZones *zones = work->zones;
    int reaches[2] = {reach(zones, 0), reach(zones, 1)}, in[2], zone[2];
    int wide = 2 * reaches[0] + 1, all = wide * (2 * reaches[1] + 1);
    double *kernel = ARENA_NEW(&scratch, double, all);
    for (int s = 0; s < work->fine[0] * work->fine[1]; s++) {
        double at[2], full = 0;
        in[0] = s % work->fine[0];
        in[1] = s / work->fine[0];
        for (int k = 0; k < 2; k++) at[k] = (in[k] + 0.5) / work->fine[k] - 0.5;
        for (int i = 0; i < all; i++) {
            double dx = (i % wide - reaches[0] - at[0]) * pitch(zones, 0);
            double dy = (i / wide - reaches[1] - at[1]) * pitch(zones, 1);
            full += kernel[i] = dimming_zones_spread(zones, sqrt(dx * dx + dy * dy));
        }
        for (zone[1] = 0; zone[1] < zones->count[1]; zone[1]++)
            for (zone[0] = 0; zone[0] < zones->count[0]; zone[0]++)
                keep(work, zone[0] * work->fine[0] + in[0], zone[1] * work->fine[1] + in[1],
                     around(work, kernel, reaches, zone) / full);
    }
}

static void choose_fineness(MapWork *work) {
    const DimmingZones *zones = work->zones;
    double width = zones->sigma_mm > 0 ? zones->sigma_mm : 0.5 * half_width(zones);
    double most = SAMPLES_MOST;
    if (!(zones->sigma_mm > 0))
        most = fmin(most, WORK_MOST / ((2.0 * reach(zones, 0) + 1) * (2.0 * reach(zones, 1) + 1)));
    for (int k = 0; k < 2; k++)
        work->fine[k] = (int)fmin(fmax(ceil(FINE_SAMPLES * pitch(zones, k) / width), 1), 64);
    for (int k = 0;; k = !k) { /* coarser, one axis after the other */
        double samples = (double)work->fine[0] * work->fine[1] * zones->count[0] * zones->count[1];
        if (samples <= most || work->fine[0] + work->fine[1] <= 2) break;
        if (work->fine[k] > 1) work->fine[k]--;
    }
    for (int k = 0; k < 2; k++) work->size[k] = work->fine[k] * zones->count[k];
}

static const float (*log_shares(const LevelShares *levels, Arena *arena))[256] {
    float(*out)[256] = arena_alloc(arena, sizeof *out, _Alignof(float), 3);
    for (int p = 0; p < 3; p++)
        for (int i = 0; i < 256; i++) out[p][i] = log_f(fmaxf(levels->share[p][i], 1e-12f));
    return (const float(*)[256])out;
}

const Backlight *backlight_make(const DimmingZones *zones, const LevelShares *levels,
                                const double *drive, Arena *arena) {
    Backlight *out = ARENA_NEW(arena, Backlight, 1);
    MapWork work = {.zones = zones, .drive = drive};
    int count = zones->count[0] * zones->count[1];
    choose_fineness(&work);
    work.out = ARENA_NEW(arena, float, (size_t)work.size[0] * (size_t)work.size[1]);
    *out = (Backlight){.width = work.size[0],
                       .height = work.size[1],
                       .light = work.out,
                       .is_log = zones->sigma_mm > 0,
                       .compensates = zones->compensates,
                       .log_share = log_shares(levels, arena)};
    for (int i = 0; i < count; i++) out->mean_drive += drive[i] / count;
    if (zones->sigma_mm > 0) map_gaussian(&work, *arena);
    else map_table(&work, *arena);
    return out;
}
