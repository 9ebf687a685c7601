/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/common/table_rows.h"

#include <math.h>

#include "base/mathd.h"
#include "base/sort.h"
#include "base/units.h"

#define NEIGHBOUR_DEG 13.0 /* azimuths further apart than this do not show noise */

Vec3 table_direction(double theta, double phi) {
    return vec3((float)(sin_d(theta) * cos_d(phi)), (float)(sin_d(theta) * sin_d(phi)),
                (float)cos_d(theta));
}

Vec3 table_row_direction(const AngleTable *table, int row) {
    return table_direction((double)table->theta[row], (double)table->phi[row]);
}

double table_row_weight(const AngleTable *table, int row) {
    double t = (double)table->theta[row];
    return sin_d(t > 1e-3 ? t : 1e-3) * cos_d(t);
}

int table_ring_end(const AngleTable *table, int begin) {
    int end = begin;
    while (end < table->rows && table->theta[end] == table->theta[begin]) end++;
    return end;
}

TableNeighbours table_neighbours(const AngleTable *table, Arena *arena) {
    int *ring = ARENA_NEW(arena, int, table->rows);
    int *inner = ARENA_NEW(arena, int, table->rows);
    float most = (float)radians_from_degrees(NEIGHBOUR_DEG);
    int begin = 0, before = -1; /* rings: this one and the one inside it */
    for (int i = 0; i < table->rows; i++) {
        if (table->theta[i] != table->theta[begin]) {
            before = begin;
            begin = i;
        }
        bool is_near = i > begin && table->phi[i] - table->phi[i - 1] < most;
        ring[i] = is_near ? i - 1 : -1;
        inner[i] = -1;
        if (before < 0) continue;
        int from = i > begin && inner[i - 1] >= 0 ? inner[i - 1] : before;
        while (from < begin && table->phi[from] < table->phi[i]) from++;
        if (from < begin && table->phi[from] == table->phi[i]) inner[i] = from;
        else if (begin - before == 1 && table->theta[before] == 0) inner[i] = before;
    }
    return (TableNeighbours){ring, inner};
}

/* ---- how noisy a table is ---------------------------------------------------------------- */

#define ENOUGH 16  /* differences */
#define ASKED 6000 /* rows, at most about so many */
#define MEDIAN_OF_NORMAL 0.6745

static double value_at(const AngleTable *table, int row, int channel) {
    return (double)table->value[(size_t)row * (size_t)table->channels + (size_t)channel];
}

typedef struct NoiseQuestion {
    int channel;
    double from, to;  /* theta, radians */
    bool is_relative; /* to the mean of the rows */
    bool has_zero;    /* differences of 0 count: darkness has no noise. Else rows are copies
                         of each other, without information */
} NoiseQuestion;

/* Differences of rows along one of their neighbourhoods. */
typedef struct DifferenceKind {
    const int *before; /* the neighbour of each row, -1: none */
    int order;
    bool in_logs;
} DifferenceKind;

/* |difference of that order| that ends at a row, over what noise of 1 would make it; of values
 * or, which leaves less of steep functions, of their logarithms. */
static bool high_difference(const AngleTable *table, DifferenceKind kind, int row,
                            const NoiseQuestion *question, double *difference) {
    int order = kind.order;
    bool in_logs = kind.in_logs;
    double sum = 0, squares = 0, binomial = 1, all = 0;
    for (int k = 0; k <= order; k++) {
        if (row < 0) return false;
        double value = value_at(table, row, question->channel);
        if (in_logs && !(value > 0)) return false;
        double term = binomial * (in_logs ? log_d(value) : value);
        sum += k % 2 ? -term : term;
        squares += binomial * binomial;
        all += value;
        binomial = binomial * (order - k) / (k + 1);
        row = kind.before[row];
    }
    double mean = all / (order + 1), found = fabs(sum) / sqrt(squares);
    if (question->is_relative && !(mean > 0)) return false;
    *difference = in_logs == question->is_relative ? found : in_logs ? found * mean : found / mean;
    return true;
}

/* Median over rows; negative: too few. */
static double median_difference(const AngleTable *table, DifferenceKind kind,
                                const NoiseQuestion *question, Arena scratch) {
    double *list = ARENA_NEW(&scratch, double, table->rows + 1), difference;
    int count = 0, asked = 0, stride = 1 + table->rows / ASKED;
    for (int i = kind.order; i < table->rows; i += stride) {
        double theta = (double)table->theta[i];
        if (theta < question->from || theta > question->to) continue;
        asked++;
        if (high_difference(table, kind, i, question, &difference)) list[count++] = difference;
    }
    if (count < ENOUGH || (kind.in_logs && 2 * count < asked)) return -1;
    return sort_median(list, count) / MEDIAN_OF_NORMAL;
}

/* The least over orders, over rings and meridians, over values and logarithms: structure only
 * adds to a difference. */
static double least_difference(const AngleTable *table, bool has_logs,
                               const NoiseQuestion *question, Arena scratch) {
    TableNeighbours near = table_neighbours(table, &scratch);
    double least = INFINITY;
    for (int order = 3; order <= 7; order += 2)
        for (int k = 0; k < (has_logs ? 4 : 2); k++) {
            DifferenceKind kind = {k % 2 ? near.inner : near.ring, order, k > 1};
            double found = median_difference(table, kind, question, scratch);
            if (found > 0 || (found == 0 && question->has_zero)) least = fmin(least, found);
        }
    return least < INFINITY ? least : 0;
}

double table_noise_relative(const AngleTable *table, int channel, Arena scratch) {
    NoiseQuestion question = {channel, 0, radians_from_degrees(70), true, false};
    return least_difference(table, true, &question, scratch);
}

/* Are most rows from there on exactly zero? */
static bool is_dark_from(const AngleTable *table, int channel, double from) {
    int dark = 0, count = 0;
    for (int i = 0; i < table->rows; i++) {
        if ((double)table->theta[i] < from) continue;
        dark += !(value_at(table, i, channel) > 0);
        count++;
    }
    return 2 * dark > count;
}

double table_noise_dim(const AngleTable *table, int channel, Arena scratch) {
    double edge = (double)table->theta_max, from = 0.9 * edge;
    NoiseQuestion question = {channel, from, edge, false, is_dark_from(table, channel, from)};
    return least_difference(table, true, &question, scratch);
}

double table_noise_plain(const AngleTable *table, int channel, Arena scratch) {
    NoiseQuestion question = {channel, 0, PI / 2, false, false};
    return least_difference(table, false, &question, scratch);
}
