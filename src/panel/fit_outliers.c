/* Rows of an emission table that stand out of their neighbourhood (hot and dead pixels), and
 * directions that its grid lacks (the shadow of what holds the source). */
#include <math.h>
#include <stdlib.h>

#include "base/units.h"
#include "panel/fit_parts.h"

#define SIGMAS 12.0
#define LEAST 0.25 /* of ln value: what no table's own shape does between neighbours */
#define LEAST_AT_EDGE 0.6 /* where there are neighbours on three sides only */
#define FIRST_RINGS_DEG 15.0

/* The row at either side on the ring, or -1. begin, end: of the ring. */
static int beside(const AngleTable *table, int row, int step, int begin, int end)
{
    int other = row + step;
    if (end - begin < 8) return -1;
    if (other < begin) other = end - 1;
    if (other >= end) other = begin;
    double gap = fabs((double)(table->phi[other] - table->phi[row]));
    return fmin(gap, 2 * PI - gap) < radians_from_degrees(FIRST_RINGS_DEG) ? other : -1;
}

typedef struct Search {
    const AngleTable *table;
    const int        *inner; /* of FitNeighbours */
    int              *outer; /* its inverse, -1: none */
    float            *ring;  /* rows x 3: ln of the ring's median, how light falls with theta */
    double            noise[3], dim[3], least[3];
} Search;

/* ln of a value. */
static double log_of(const Search *search, int row, int channel)
{
    double value = (double)search->table->value[3 * (size_t)row + (size_t)channel];
    return log(fmax(value, search->least[channel]));
}

/* ln of a value over its ring's median. */
static double level_of(const Search *search, int row, int channel)
{
    return log_of(search, row, channel) -
           (double)search->ring[3 * (size_t)row + (size_t)channel];
}

/* Up to four neighbours: on the ring and on the meridian; of the pole, four of the first ring. */
static int neighbours(const Search *search, int row, int begin, int end, int near[4])
{
    int count = 0;
    if (row == 0 && end == 1 && search->table->theta[0] == 0) {
        int next = 1;
        while (next < search->table->rows && search->table->theta[next] == search->table->theta[1])
            next++;
        for (int k = 0; k < 4 && next > 8; k++) near[count++] = 1 + k * (next - 1) / 4;
        return count;
    }
    int found[4] = {beside(search->table, row, -1, begin, end),
                    beside(search->table, row, 1, begin, end), search->inner[row],
                    search->outer[row]};
    for (int k = 0; k < 4; k++)
        if (found[k] >= 0) near[count++] = found[k];
    return count;
}

/* Median over up to four neighbours. */
static double median_level(const Search *search, const int *near, int count, int channel)
{
    double value[4];
    for (int k = 0; k < count; k++) value[k] = level_of(search, near[k], channel);
    qsort(value, (size_t)count, sizeof *value, fit_by_value);
    return count % 2 ? value[count / 2] : 0.5 * (value[count / 2 - 1] + value[count / 2]);
}

/* Does any of the three tristimulus values stand out? */
static bool stands_out(const Search *search, int row, const int *near, int count)
{
    for (int j = 0; j < 3; j++) {
        double expected = median_level(search, near, count, j);
        double value = level_of(search, row, j);
        double dim = search->dim[j] /
                     exp(fmin(value, expected) + (double)search->ring[3 * row + j]);
        double sigma = sqrt(search->noise[j] * search->noise[j] + dim * dim);
        if (fabs(value - expected) > fmax(SIGMAS * sigma, count < 4 ? LEAST_AT_EDGE : LEAST)) return true;
    }
    return false;
}

static void add_flag(FitFlags *flags, FitFlag flag)
{
    if (flags->count < FIT_FLAGS_MAX) flags->flag[flags->count] = flag;
    flags->count++;
}

/* The median over a ring, of rings that have rows enough to tell; else it stays 0. */
static void find_ring(Search *search, int begin, int end, Arena scratch)
{
    double *list = ARENA_NEW(&scratch, double, end - begin);
    if (end - begin > 1 && end - begin < 8) return;
    for (int j = 0; j < 3; j++) {
        for (int i = begin; i < end; i++) list[i - begin] = log_of(search, i, j);
        qsort(list, (size_t)(end - begin), sizeof *list, fit_by_value);
        for (int i = begin; i < end; i++)
            search->ring[3 * i + j] = (float)list[(end - begin) / 2];
    }
}

static void find_rings(Search *search, Arena scratch)
{
    const AngleTable *table = search->table;
    for (int begin = 0, end = 0; begin < table->rows; begin = end) {
        while (end < table->rows && table->theta[end] == table->theta[begin]) end++;
        find_ring(search, begin, end, scratch);
    }
}

static Search start_search(const AngleTable *table, Arena *arena)
{
    FitNeighbours near;
    Search        search = {.table = table};
    fit_neighbours(table, arena, &near);
    search.inner = near.inner;
    search.outer = ARENA_NEW(arena, int, table->rows);
    search.ring = ARENA_NEW(arena, float, 3 * (size_t)table->rows);
    for (int i = 0; i < table->rows; i++) search.outer[i] = -1;
    for (int i = 0; i < table->rows; i++)
        if (near.inner[i] > 0) search.outer[near.inner[i]] = i;
    for (int j = 0; j < 3; j++) {
        double most = 0;
        search.noise[j] = fit_noise(table, j, *arena);
        search.dim[j] = fit_dim_noise(table, j, *arena);
        for (int i = 0; i < table->rows; i++)
            most = fmax(most, (double)table->value[3 * (size_t)i + (size_t)j]);
        search.least[j] = fmax(fmax(1e-5 * most, 0.3 * search.dim[j]), 1e-9);
    }
    find_rings(&search, *arena);
    return search;
}

int fit_find_outliers(const AngleTable *table, uint8_t *is_outlier, FitFlags *flags,
                      Arena scratch)
{
    Search search = start_search(table, &scratch);
    int    begin = 0, end = 0, found = table->pole_outliers;
    for (int i = 0; i < found; i++)
        add_flag(flags, (FitFlag){table->name, 0, (double)table->pole_outlier[i].phi,
                                  (double)table->pole_outlier[i].value,
                                  (double)table->pole_outlier[i].expected});
    for (int i = 0; i < table->rows; i++) {
        int near[4];
        if (i == end) {
            begin = i;
            while (end < table->rows && table->theta[end] == table->theta[begin]) end++;
        }
        int count = neighbours(&search, i, begin, end, near);
        is_outlier[i] = count >= 3 && stands_out(&search, i, near, count);
        if (!is_outlier[i]) continue;
        found++;
        add_flag(flags, (FitFlag){table->name, (double)table->theta[i], (double)table->phi[i],
                                  (double)table->value[3 * (size_t)i + 1],
                                  exp(median_level(&search, near, count, 1) +
                                      (double)search.ring[3 * (size_t)i + 1])});
    }
    return found;
}

/* ---- holes ------------------------------------------------------------------------------ */

static int by_float(const void *a, const void *b)
{
    float p = *(const float *)a, q = *(const float *)b;
    return p < q ? -1 : p > q;
}

/* Different azimuths of a table, rising. */
static int azimuths(const AngleTable *table, float *out)
{
    int count = 0;
    for (int i = 0; i < table->rows; i++)
        if (table->theta[i] > 0) out[count++] = table->phi[i];
    qsort(out, (size_t)count, sizeof *out, by_float);
    int kept = 0;
    for (int i = 0; i < count; i++)
        if (!kept || out[i] > out[kept - 1]) out[kept++] = out[i];
    return kept;
}

static int rings(const AngleTable *table)
{
    int count = 0;
    for (int i = 0; i < table->rows; i++)
        count += table->theta[i] > 0 && (i == 0 || table->theta[i] != table->theta[i - 1]);
    return count;
}

int fit_find_holes(const AngleTable *table, FitFlags *flags, Arena scratch)
{
    float *phi = ARENA_NEW(&scratch, float, table->rows + 1);
    int    phis = azimuths(table, phi), found = 0;
    double cells = (double)phis * rings(table);
    int    i = table->rows && table->theta[0] == 0;
    if (cells > 1.3 * (table->rows - i)) return 0; /* no grid at all */
    while (i < table->rows) {
        float theta = table->theta[i];
        for (int p = 0; p < phis; p++) {
            bool is_there = i < table->rows && table->theta[i] == theta &&
                            table->phi[i] == phi[p];
            if (is_there) {
                i++;
                continue;
            }
            found++;
            add_flag(flags, (FitFlag){table->name, (double)theta, (double)phi[p], 0, 0});
        }
    }
    return found;
}
