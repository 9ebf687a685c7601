/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/emission/emission_outliers.h"

#include <math.h>

#include "base/mathd.h"
#include "base/sort.h"
#include "base/units.h"
#include "panel/fit/common/table_rows.h"
#include "panel/fit/emission/emission_samples.h"

#define SIGMAS 12.0
#define LEAST 0.25        /* of ln value: what no table's own shape does between neighbours */
#define LEAST_AT_EDGE 0.6 /* where there are neighbours on three sides only */
#define EDGE 8.0          /* ratio of the neighbours on either side */
#define FIRST_RINGS_DEG 15.0

/* The row at either side on the ring, or -1. begin, end: of the ring. */
static int beside(const AngleTable *table, int row, int step, int begin, int end) {
    int other = row + step;
    if (end - begin < 8) return -1;
    if (other < begin) other = end - 1;
    if (other >= end) other = begin;
    double gap = fabs((double)(table->phi[other] - table->phi[row]));
    return fmin(gap, 2 * PI - gap) < radians_from_degrees(FIRST_RINGS_DEG) ? other : -1;
}

typedef struct OutlierSearch {
    const AngleTable *table;
    const int *inner; /* of TableNeighbours */
    int *outer;       /* its inverse, -1: none */
    float *ring;      /* rows x 3: ln of the ring's median, how light falls with theta */
    double noise[3], dim[3], least[3];
} OutlierSearch;

/* ln of a value. */
static double log_of(const OutlierSearch *search, int row, int channel) {
    double value = (double)search->table->value[3 * (size_t)row + (size_t)channel];
    return log_d(fmax(value, search->least[channel]));
}

/* ln of a value over its ring's median. */
static double level_of(const OutlierSearch *search, int row, int channel) {
    return log_of(search, row, channel) - (double)search->ring[3 * (size_t)row + (size_t)channel];
}

/* Neighbours in pairs on either side, -1 where there is none: on the ring, on the meridian; of
 * the pole, opposite ones of the first ring. Returns how many there are. */
static int neighbours(const OutlierSearch *search, int row, int begin, int end, int near[4]) {
    const AngleTable *table = search->table;
    if (row == 0 && end == 1 && table->theta[0] == 0) {
        int next = table_ring_end(table, 1);
        for (int k = 0; k < 4; k++)
            near[k] = next > 8 ? 1 + (k % 2 * 2 + k / 2) * (next - 1) / 4 : -1;
    } else {
        near[0] = beside(table, row, -1, begin, end);
        near[1] = beside(table, row, 1, begin, end);
        near[2] = search->inner[row];
        near[3] = search->outer[row];
    }
    int count = 0;
    for (int k = 0; k < 4; k++) count += near[k] >= 0;
    return count;
}

/* Levels that the neighbours predict: the means of pairs; of three neighbours also the
 * median. An outlier is beyond the limit of every one. */
typedef struct Expected {
    int count;
    double level[3], limit[3];
} Expected;

static Expected expected_of(const OutlierSearch *search, const int near[4], int channel) {
    Expected out = {0};
    double value[4];
    int found = 0;
    for (int k = 0; k < 4; k++)
        if (near[k] >= 0) value[found++] = level_of(search, near[k], channel);
    for (int k = 0; k < 4; k += 2)
        if (near[k] >= 0 && near[k + 1] >= 0) {
            out.level[out.count] =
                0.5 * (level_of(search, near[k], channel) + level_of(search, near[k + 1], channel));
            out.limit[out.count++] = LEAST;
        }
    if (found != 3) return out;
    out.level[out.count] = sort_median(value, 3);
    out.limit[out.count++] = LEAST_AT_EDGE;
    return out;
}

/* A hot or dead pixel differs from all neighbours, or from all but one that is hit as well; the
 * corner of a beam that is cut off has two that are as bright. */
static bool is_alone(const OutlierSearch *search, int row, const int near[4], int channel) {
    double value = level_of(search, row, channel);
    int above = 0, below = 0, count = 0;
    for (int k = 0; k < 4; k++) {
        if (near[k] < 0) continue;
        double rest = value - level_of(search, near[k], channel);
        above += rest > LEAST, below += rest < -LEAST;
        count++;
    }
    return above >= count - 1 || below >= count - 1;
}

/* The neighbour's neighbour in the same direction, or -1. */
static int behind(const OutlierSearch *search, int near, int side, int begin, int end) {
    if (near < 0) return -1;
    return side == 0   ? beside(search->table, near, -1, begin, end)
           : side == 1 ? beside(search->table, near, 1, begin, end)
           : side == 2 ? search->inner[near]
                       : search->outer[near];
}

/* The tip of a beam that is cut off goes on to one side, further than two pixels that are hit
 * do; and across an edge, where neighbours on either side are as day and night, what lies
 * between them is none. */
static bool is_at_edge(const OutlierSearch *search, int row, const int ring[2], const int near[4],
                       int channel) {
    double value = log_of(search, row, channel);
    for (int k = 0; k < 4; k++) {
        int next = row ? behind(search, near[k], k, ring[0], ring[1]) : -1;
        if (next >= 0 && next != row && fabs(log_of(search, near[k], channel) - value) < LEAST &&
            fabs(log_of(search, next, channel) - value) < LEAST)
            return true;
    }
    for (int k = 0; k < 4; k += 2) {
        if (near[k] < 0 || near[k + 1] < 0) continue;
        double a = log_of(search, near[k], channel), b = log_of(search, near[k + 1], channel);
        if (fabs(a - b) > log_d(EDGE) && value >= fmin(a, b) && value <= fmax(a, b)) return true;
    }
    return false;
}

/* Does any of the three tristimulus values stand out? */
static bool stands_out(const OutlierSearch *search, int row, const int ring[2], const int near[4]) {
    for (int j = 0; j < 3; j++) {
        Expected expected = expected_of(search, near, j);
        double value = level_of(search, row, j), median = (double)search->ring[3 * row + j];
        bool is_far = expected.count > 0 &&
                      fmax(value, expected.level[0]) + median > log_d(100 * EMISSION_NO_LIGHT);
        for (int k = 0; k < expected.count; k++) {
            double dim = search->dim[j] / exp_d(fmin(value, expected.level[k]) + median);
            double sigma = sqrt(search->noise[j] * search->noise[j] + dim * dim);
            is_far &= fabs(value - expected.level[k]) > fmax(SIGMAS * sigma, expected.limit[k]);
        }
        if (is_far && is_alone(search, row, near, j) && !is_at_edge(search, row, ring, near, j))
            return true;
    }
    return false;
}

static void add_flag(EmissionFlags *flags, EmissionFlag flag) {
    if (flags->count < EMISSION_FLAGS_MAX) flags->flag[flags->count] = flag;
    flags->count++;
}

/* The median over a ring, of rings that have rows enough; else it stays 0. */
static void find_ring(OutlierSearch *search, int begin, int end, Arena scratch) {
    double *list = ARENA_NEW(&scratch, double, end - begin);
    if (end - begin > 1 && end - begin < 8) return;
    for (int j = 0; j < 3; j++) {
        for (int i = begin; i < end; i++) list[i - begin] = log_of(search, i, j);
        float median = (float)sort_median(list, end - begin);
        for (int i = begin; i < end; i++) search->ring[3 * i + j] = median;
    }
}

static void find_rings(OutlierSearch *search, Arena scratch) {
    const AngleTable *table = search->table;
    for (int begin = 0, end = 0; begin < table->rows; begin = end) {
        end = table_ring_end(table, begin);
        find_ring(search, begin, end, scratch);
    }
}

static OutlierSearch start_search(const AngleTable *table, Arena *arena) {
    TableNeighbours near = table_neighbours(table, arena);
    OutlierSearch search = {.table = table};
    search.inner = near.inner;
    search.outer = ARENA_NEW(arena, int, table->rows);
    search.ring = ARENA_NEW(arena, float, 3 * (size_t)table->rows);
    for (int i = 0; i < table->rows; i++) search.outer[i] = -1;
    for (int i = 0; i < table->rows; i++)
        if (near.inner[i] > 0) search.outer[near.inner[i]] = i;
    for (int j = 0; j < 3; j++) {
        double most = 0;
        search.noise[j] = table_noise_relative(table, j, *arena);
        search.dim[j] = table_noise_dim(table, j, *arena);
        for (int i = 0; i < table->rows; i++)
            most = fmax(most, (double)table->value[3 * (size_t)i + (size_t)j]);
        search.least[j] = fmax(fmax(1e-5 * most, 0.3 * search.dim[j]), EMISSION_NO_LIGHT);
    }
    find_rings(&search, *arena);
    return search;
}

int emission_outliers_find(const AngleTable *table, uint8_t *is_outlier, EmissionFlags *flags,
                           Arena scratch) {
    OutlierSearch search = start_search(table, &scratch);
    int begin = 0, end = 0, found = table->pole_outliers;
    for (int i = 0; i < found; i++)
        add_flag(flags, (EmissionFlag){table->name, 0, (double)table->pole_outlier[i].phi,
                                       (double)table->pole_outlier[i].value,
                                       (double)table->pole_outlier[i].expected});
    for (int i = 0; i < table->rows; i++) {
        int near[4];
        if (i == end) {
            begin = i;
            end = table_ring_end(table, begin);
        }
        int count = neighbours(&search, i, begin, end, near), ring[2] = {begin, end};
        is_outlier[i] = count >= 3 && stands_out(&search, i, ring, near);
        if (!is_outlier[i]) continue;
        found++;
        add_flag(flags, (EmissionFlag){table->name, (double)table->theta[i], (double)table->phi[i],
                                       (double)table->value[3 * (size_t)i + 1],
                                       exp_d(expected_of(&search, near, 1).level[0] +
                                             (double)search.ring[3 * (size_t)i + 1])});
    }
    return found;
}

/* ---- holes ------------------------------------------------------------------------------ */

/* Different azimuths of a table, rising. */
static int azimuths(const AngleTable *table, float *out) {
    int count = 0;
    for (int i = 0; i < table->rows; i++)
        if (table->theta[i] > 0) out[count++] = table->phi[i];
    return sort_distinct(out, count, 0);
}

static int rings(const AngleTable *table) {
    int count = 0;
    for (int i = 0; i < table->rows; i++)
        count += table->theta[i] > 0 && (i == 0 || table->theta[i] != table->theta[i - 1]);
    return count;
}

int emission_outliers_find_holes(const AngleTable *table, EmissionFlags *flags, Arena scratch) {
    float *phi = ARENA_NEW(&scratch, float, table->rows + 1);
    int phis = azimuths(table, phi), found = 0;
    double cells = (double)phis * rings(table);
    int i = table->rows && table->theta[0] == 0;
    if (cells > 1.3 * (table->rows - i)) return 0; /* no grid at all */
    while (i < table->rows) {
        float theta = table->theta[i];
        for (int p = 0; p < phis; p++) {
            bool is_there = i < table->rows && table->theta[i] == theta && table->phi[i] == phi[p];
            if (is_there) {
                i++;
                continue;
            }
            found++;
            add_flag(flags, (EmissionFlag){table->name, (double)theta, (double)phi[p], 0, 0});
        }
    }
    return found;
}
