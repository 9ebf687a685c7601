/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/common/direction_grid.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "base/sort.h"
#include "base/units.h"

#define SAME_ANGLE 2e-6f /* radians: two rings or azimuths nearer than this are one */
#define NEAREST_COUNT 10 /* rows that fill a cell without a row */

int direction_grid_index(const float *sorted, int count, float value, float apart) {
    int low = 0, high = count - 1;
    while (low < high) {
        int middle = (low + high) / 2;
        if (sorted[middle] < value - apart) low = middle + 1;
        else high = middle;
    }
    return low;
}

/* Azimuths of all rows off the pole. */
static int row_azimuths(const AngleTable *table, bool mirrored, float *phi) {
    int count = 0;
    for (int i = 0; i < table->rows; i++)
        if (table->theta[i] > SAME_ANGLE)
            phi[count++] = direction_grid_fold(table->phi[i], mirrored);
    return count;
}

static float widest_azimuth_gap(const float *phi, int count, bool mirrored) {
    float widest = mirrored ? fmaxf(2 * phi[0], 2 * (PI_F - phi[count - 1]))
                            : phi[0] + 2 * PI_F - phi[count - 1];
    for (int i = 1; i < count; i++) widest = fmaxf(widest, phi[i] - phi[i - 1]);
    return widest;
}

/* Evenly spaced rings and azimuths, about as dense as the rows are. */
static void even_grid(const AngleTable *table, DirectionGrid *grid, Arena *arena) {
    float area = 2 * PI_F * (1 - cos_of(table->theta_max));
    float step = sqrtf(area / (float)table->rows);
    int thetas = (int)fmaxf(2, ceilf(table->theta_max / step)) + 1;
    int half = (int)fmaxf(2, ceilf(PI_F / step));
    float *theta = ARENA_NEW(arena, float, thetas), *phi = ARENA_NEW(arena, float, 2 * half);
    grid->phis = grid->is_mirrored ? half + 1 : 2 * half;
    for (int i = 0; i < thetas; i++) theta[i] = table->theta_max * (float)i / (float)(thetas - 1);
    for (int i = 0; i < grid->phis; i++) phi[i] = PI_F * (float)i / (float)half;
    grid->theta = theta;
    grid->phi = phi;
    grid->thetas = thetas;
    grid->is_scattered = true;
}

/* The table's own rings and azimuths; an even grid where they do not meet. */
static void choose_axes(const AngleTable *table, DirectionGrid *grid, Arena *arena) {
    float *theta = ARENA_NEW(arena, float, table->rows);
    float *phi = ARENA_NEW(arena, float, table->rows + 1);
    memcpy(theta, table->theta, sizeof *theta * (size_t)table->rows);
    int thetas = sort_distinct(theta, table->rows, SAME_ANGLE);
    int count = row_azimuths(table, grid->is_mirrored, phi);
    int phis = count ? sort_distinct(phi, count, SAME_ANGLE) : 1;
    grid->widest_gap = count ? widest_azimuth_gap(phi, phis, grid->is_mirrored) : 2 * PI_F;
    if ((double)thetas * phis > 2.0 * table->rows + 16 && table->rows >= 16) {
        even_grid(table, grid, arena);
    } else {
        grid->theta = theta;
        grid->phi = phi;
        grid->thetas = thetas;
        grid->phis = phis;
    }
    grid->has_pole = grid->theta[0] <= SAME_ANGLE;
}

/* ---- what a cell is made of ------------------------------------------------------------ */

typedef struct Near {
    float distance; /* squared chord */
    int row;
} Near;

static void chord_axis(float theta, float phi, float out[3]) {
    out[0] = sin_of(theta) * cos_of(phi);
    out[1] = sin_of(theta) * sin_of(phi);
    out[2] = cos_of(theta);
}

static float squared_chord(const float a[3], const float b[3]) {
    float x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    return x * x + y * y + z * z;
}

/* Keeps the list sorted by distance. Returns its new length. */
static int insert_near(Near *list, int count, Near candidate) {
    int at = count < NEAREST_COUNT ? count : NEAREST_COUNT - 1;
    if (count == NEAREST_COUNT && candidate.distance >= list[at].distance) return count;
    while (at > 0 && list[at - 1].distance > candidate.distance) {
        list[at] = list[at - 1];
        at--;
    }
    list[at] = candidate;
    return count < NEAREST_COUNT ? count + 1 : count;
}

static int nearest_rows(const AngleTable *table, bool mirrored, const float at[3], Near *list) {
    int count = 0;
    for (int i = 0; i < table->rows; i++) {
        float there[3];
        chord_axis(table->theta[i], direction_grid_fold(table->phi[i], mirrored), there);
        count = insert_near(list, count, (Near){squared_chord(at, there), i});
    }
    return count;
}

/* Solves the symmetric 3 x 3 system a x = b; false when it is singular. */
static bool solve_3(double a[3][3], double b[3]) {
    for (int i = 0; i < 3; i++) {
        if (!(fabs(a[i][i]) > 1e-12)) return false;
        for (int j = i + 1; j < 3; j++) {
            double f = a[j][i] / a[i][i];
            for (int k = i; k < 3; k++) a[j][k] -= f * a[i][k];
            b[j] -= f * b[i];
        }
    }
    for (int i = 2; i >= 0; i--) {
        for (int k = i + 1; k < 3; k++) b[i] -= a[i][k] * b[k];
        b[i] /= a[i][i];
    }
    return true;
}

/* Weights of a moving least-squares plane through the neighbours (Gaussian by distance), read
 * at the cell; inverse distances where the neighbours lie on a line. */
static void fill_weights(const AngleTable *table, bool mirrored, const float at[2],
                         const Near *list, int count, float *weight) {
    double m[3][3] = {{0}}, b[3] = {1, 0, 0}, basis[NEAREST_COUNT][3], w[NEAREST_COUNT];
    double scale = (double)list[count - 1].distance + 1e-12, sum = 0;
    for (int i = 0; i < count; i++) {
        double theta = (double)table->theta[list[i].row];
        double phi = (double)direction_grid_fold(table->phi[list[i].row], mirrored);
        double turn = phi - (double)at[1];
        basis[i][0] = 1;
        basis[i][1] = (theta * cos_d(turn) - (double)at[0]) / sqrt(scale);
        basis[i][2] = theta * sin_d(turn) / sqrt(scale);
        w[i] = exp_d(-4 * (double)list[i].distance / scale) + 1e-9;
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 3; c++) m[r][c] += w[i] * basis[i][r] * basis[i][c];
        sum += w[i];
    }
    for (int r = 0; r < 3; r++) m[r][r] += 1e-6 * sum;
    bool ok = solve_3(m, b);
    for (int i = 0; i < count; i++)
        weight[i] =
            (float)(ok ? w[i] * (b[0] + b[1] * basis[i][1] + b[2] * basis[i][2]) : w[i] / sum);
    double total = 0;
    for (int i = 0; i < count; i++) total += (double)weight[i];
    for (int i = 0; i < count; i++) weight[i] = (float)((double)weight[i] / total);
}

typedef struct CellRows {
    int *first, *second; /* rows of a cell, -1: none; two when both halves were measured */
} CellRows;

static CellRows place_rows(const AngleTable *table, const DirectionGrid *grid, Arena *arena) {
    int cells = grid->thetas * grid->phis;
    CellRows rows = {ARENA_NEW(arena, int, cells), ARENA_NEW(arena, int, cells)};
    for (int c = 0; c < cells; c++) rows.first[c] = rows.second[c] = -1;
    for (int i = 0; i < table->rows && !grid->is_scattered; i++) {
        float phi = direction_grid_fold(table->phi[i], grid->is_mirrored);
        int t = direction_grid_index(grid->theta, grid->thetas, table->theta[i], SAME_ANGLE);
        int p = direction_grid_index(grid->phi, grid->phis, phi, SAME_ANGLE);
        bool is_pole = table->theta[i] <= SAME_ANGLE;
        for (int c = is_pole ? 0 : t * grid->phis + p, last = is_pole ? grid->phis - 1 : c;
             c <= last; c++) {
            if (rows.first[c] < 0) rows.first[c] = i;
            else rows.second[c] = i;
        }
    }
    return rows;
}

static int fill_cell(const AngleTable *table, const DirectionGrid *grid, int cell, int *row,
                     float *weight) {
    Near list[NEAREST_COUNT];
    float at[2] = {grid->theta[cell / grid->phis], grid->phi[cell % grid->phis]}, axis[3];
    chord_axis(at[0], at[1], axis);
    int count = nearest_rows(table, grid->is_mirrored, axis, list);
    fill_weights(table, grid->is_mirrored, at, list, count, weight);
    for (int i = 0; i < count; i++) row[i] = list[i].row;
    return count;
}

void direction_grid_build(const AngleTable *table, bool mirrored, Arena *arena,
                          DirectionGrid *out) {
    DirectionGrid grid = {.is_mirrored = mirrored};
    choose_axes(table, &grid, arena);
    int cells = grid.thetas * grid.phis, used = 0;
    CellRows rows = place_rows(table, &grid, arena);
    int *start = ARENA_NEW(arena, int, cells + 1);
    int *row = ARENA_NEW(arena, int, (size_t)cells *NEAREST_COUNT);
    float *weight = ARENA_NEW(arena, float, (size_t)cells *NEAREST_COUNT);
    for (int c = 0; c < cells; c++) {
        start[c] = used;
        if (rows.first[c] < 0) {
            used += fill_cell(table, &grid, c, row + used, weight + used);
            grid.filled_cells++;
            continue;
        }
        bool both = rows.second[c] >= 0;
        row[used] = rows.first[c];
        weight[used++] = both ? 0.5f : 1;
        if (both) {
            row[used] = rows.second[c];
            weight[used++] = 0.5f;
        }
    }
    start[cells] = used;
    grid.start = start;
    grid.row = row;
    grid.weight = weight;
    *out = grid;
}

float *direction_grid_cells(const DirectionGrid *grid, const float *value, int channels,
                            Arena *arena) {
    size_t cells = (size_t)(grid->thetas * grid->phis), size = (size_t)channels;
    float *out = ARENA_NEW(arena, float, cells *size);
    for (size_t c = 0; c < cells; c++)
        for (int i = grid->start[c]; i < grid->start[c + 1]; i++) {
            const float *from = value + (size_t)grid->row[i] * size;
            for (size_t k = 0; k < size; k++) out[c * size + k] += grid->weight[i] * from[k];
        }
    return out;
}

/* ---- reading between cells ------------------------------------------------------------- */

/* Weights of a cubic Hermite piece between x[1] and x[2] whose slopes are those of the
 * parabolas through three neighbours. */
static void cubic_weights(const float x[4], float at, float w[4]) {
    float h0 = x[1] - x[0], h1 = x[2] - x[1], h2 = x[3] - x[2];
    float t = (at - x[1]) / h1, t2 = t * t, t3 = t2 * t;
    float a = (t3 - 2 * t2 + t) * h1, b = (t3 - t2) * h1; /* of the two slopes */
    /* slope at x1: (h1 d0 + h0 d1) / (h0 + h1), d the divided differences; the same at x2 */
    float a0 = a * h1 / (h0 + h1), a1 = a * h0 / (h0 + h1);
    float b1 = b * h2 / (h1 + h2), b2 = b * h1 / (h1 + h2);
    w[0] = -a0 / h0;
    w[1] = 2 * t3 - 3 * t2 + 1 + a0 / h0 - (a1 + b1) / h1;
    w[2] = 3 * t2 - 2 * t3 + (a1 + b1) / h1 - b2 / h2;
    w[3] = b2 / h2;
}

/* Last index whose value is not above `at`, in [0, count - 1]. */
static int interval_of(const float *sorted, int count, float at) {
    int low = 0, high = count - 1;
    while (low < high) {
        int middle = (low + high + 1) / 2;
        if (sorted[middle] <= at) low = middle;
        else high = middle - 1;
    }
    return low;
}

/* Four azimuths around phi and their weights on one ring. */
static void azimuth_taps(const DirectionGrid *grid, float phi, int index[4], float weight[4]) {
    int n = grid->phis;
    float x[4];
    if (n == 1) {
        for (int i = 0; i < 4; i++) index[i] = 0, weight[i] = i == 1;
        return;
    }
    int first = interval_of(grid->phi, n, phi);
    if (phi < grid->phi[0]) first = -1;
    for (int i = 0; i < 4; i++) {
        int j = first - 1 + i;
        if (grid->is_mirrored) { /* reflect at 0 and pi: the values are even there */
            bool low = j < 0, high = j >= n;
            int skip_low = grid->phi[0] < SAME_ANGLE;
            int skip_high = grid->phi[n - 1] > PI_F - SAME_ANGLE;
            int k = low ? -j - 1 + skip_low : high ? 2 * n - 1 - j - skip_high : j;
            k = k < 0 ? 0 : k >= n ? n - 1 : k;
            x[i] = low ? -grid->phi[k] : high ? 2 * PI_F - grid->phi[k] : grid->phi[k];
            index[i] = k;
        } else {
            int turn = j < 0 ? -1 : j >= n ? j / n : 0;
            index[i] = j - turn * n;
            if (index[i] < 0) index[i] = 0;
            x[i] = grid->phi[index[i]] + 2 * PI_F * (float)turn;
        }
    }
    for (int i = 1; i < 4; i++)
        if (!(x[i] > x[i - 1])) x[i] = x[i - 1] + 1e-3f;
    cubic_weights(x, phi, weight);
}

static void add_ring(const DirectionGrid *grid, int ring, float phi, float weight, GridTaps *taps) {
    int index[4];
    float w[4];
    if (weight == 0) return;
    azimuth_taps(grid, phi, index, w);
    for (int i = 0; i < 4; i++) {
        if (w[i] == 0) continue;
        taps->cell[taps->count] = ring * grid->phis + index[i];
        taps->weight[taps->count++] = weight * w[i];
    }
}

static float wrapped_phi(const DirectionGrid *grid, float phi) {
    phi -= 2 * PI_F * floorf(phi / (2 * PI_F));
    return direction_grid_fold(phi, grid->is_mirrored);
}

void direction_grid_taps(const DirectionGrid *grid, float theta, float phi, GridTaps *taps) {
    int n = grid->thetas;
    float here = wrapped_phi(grid, phi), there = wrapped_phi(grid, phi + PI_F);
    *taps = (GridTaps){0};
    if (n == 1 || theta >= grid->theta[n - 1]) {
        add_ring(grid, n - 1, here, 1, taps);
        return;
    }
    int first = theta < grid->theta[0] ? -1 : interval_of(grid->theta, n, theta);
    float x[4], w[4], fold = 0;
    int ring[4];
    bool opposite[4];
    for (int i = 0; i < 4; i++) { /* a ring before the first is one of the other side */
        int j = first - 1 + i;
        opposite[i] = j < 0;
        ring[i] = j < 0 ? -j - 1 + grid->has_pole : j;
        if (ring[i] >= n) ring[i] = n - 1, fold = 1;
        x[i] = opposite[i] ? -grid->theta[ring[i]] : grid->theta[ring[i]];
    }
    if (fold > 0) x[3] = 2 * x[2] - x[1];
    cubic_weights(x, theta, w);
    if (fold > 0) { /* beyond the last ring: the parabola through the last three */
        w[2] += 3 * w[3];
        w[1] -= 3 * w[3];
        w[0] += w[3];
        w[3] = 0;
    }
    for (int i = 0; i < 4; i++) add_ring(grid, ring[i], opposite[i] ? there : here, w[i], taps);
}

void direction_grid_read(const GridTaps *taps, const float *cells, int channels, float *out) {
    for (int k = 0; k < channels; k++) out[k] = 0;
    for (int i = 0; i < taps->count; i++) {
        const float *cell = cells + (size_t)taps->cell[i] * (size_t)channels;
        for (int k = 0; k < channels; k++) out[k] += taps->weight[i] * cell[k];
    }
}
