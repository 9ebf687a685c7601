/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/draw/field.h"

#include <math.h>
#include <string.h>

#include "base/sort.h"
#include "base/units.h"

#define THETA_LAST (PI / 2 - 1e-3) /* just above the surface */

Field field_new(int side, double theta_rim, Arena *arena) {
    Field field = {side, theta_rim, ARENA_NEW(arena, float, (size_t)side *(size_t)side)};
    for (int i = 0; i < side * side; i++) field.value[i] = NAN;
    return field;
}

static double grid_theta(const Field *field, int row, int column, double *phi) {
    double half = (field->side - 1) / 2.0, x = (column - half) / half, y = (half - row) / half;
    *phi = atan2(y, x);
    return hypot(x, y) * field->theta_rim;
}

Vec3 field_direction(const Field *field, int row, int column) {
    double phi, theta = grid_theta(field, row, column, &phi);
    double limit = fmin(field->theta_rim, THETA_LAST);
    theta = theta < limit ? theta : limit;
    return vec3((float)(sin(theta) * cos(phi)), (float)(sin(theta) * sin(phi)), (float)cos(theta));
}

void field_place(const Field *field, double theta, double phi, double *column, double *row) {
    double half = (field->side - 1) / 2.0, r = half * theta / field->theta_rim;
    *column = half + r * cos(phi);
    *row = half - r * sin(phi);
}

double field_at(const Field *field, double column, double row) {
    double last = field->side - 1.0;
    column = fmin(fmax(column, 0), last);
    row = fmin(fmax(row, 0), last);
    int c = (int)fmin(column, last - 1), r = (int)fmin(row, last - 1);
    double fx = column - c, fy = row - r;
    const float *v = field->value + (size_t)r * (size_t)field->side + (size_t)c;
    const float *w = v + field->side;
    return (1 - fy) * ((1 - fx) * (double)v[0] + fx * (double)v[1]) +
           fy * ((1 - fx) * (double)w[0] + fx * (double)w[1]);
}

FieldRange field_range(const Field *field, double theta_limit) {
    FieldRange range = {.low = INFINITY, .high = -INFINITY};
    double limit = fmin(theta_limit, field->theta_rim) + 1e-9;
    for (int row = 0; row < field->side; row++) {
        for (int column = 0; column < field->side; column++) {
            double phi, theta = grid_theta(field, row, column, &phi);
            double v = (double)field->value[row * field->side + column];
            if (theta > limit || !isfinite(v)) continue;
            range.low = fmin(range.low, v);
            if (v > range.high) {
                range.high = v;
                range.theta = theta;
                range.phi = phi;
            }
        }
    }
    return range.high < range.low ? (FieldRange){0} : range;
}

double field_quantile(const Field *field, double theta_limit, double share, Arena scratch) {
    float *sorted = ARENA_NEW(&scratch, float, (size_t)field->side *(size_t)field->side);
    int count = 0;
    for (int row = 0; row < field->side; row++)
        for (int column = 0; column < field->side; column++) {
            double phi, theta = grid_theta(field, row, column, &phi);
            float v = field->value[row * field->side + column];
            if (theta <= theta_limit && isfinite(v)) sorted[count++] = v;
        }
    sort_floats(sorted, count);
    return count > 0 ? (double)sorted[(int)(share * (count - 1))] : 0;
}

/* ---- lines of equal value, by marching squares ------------------------------------------- */

/* Every crossing lies on a grid edge; an edge is 2 (row side + column) plus 0 when it runs to
 * the right of that point and 1 when it runs down. Each edge joins at most two segments, so the
 * segments hang together as chains through `other`. */
typedef struct Tracer {
    const float *value;
    int side;
    double level;
    int *link[2]; /* per edge: the edges at the far ends of its segments, -1 none */
    bool *is_done;
} Tracer;

static double above(const Tracer *t, int row, int column) {
    return (double)t->value[(size_t)row * (size_t)t->side + (size_t)column] - t->level;
}

static void join(Tracer *t, int a, int b) {
    t->link[t->link[0][a] < 0 ? 0 : 1][a] = b;
    t->link[t->link[0][b] < 0 ? 0 : 1][b] = a;
}

/* The cell's edges in order: top, right, bottom, left. */
static void cell_edges(const Tracer *t, int row, int column, int edge[4]) {
    int here = row * t->side + column;
    edge[0] = 2 * here;
    edge[1] = 2 * (here + 1) + 1;
    edge[2] = 2 * (here + t->side);
    edge[3] = 2 * here + 1;
}

/* One or two segments; at a saddle the centre's mean decides which corners are joined. */
static void march_cell(Tracer *t, int row, int column) {
    double v[4] = {above(t, row, column), above(t, row, column + 1), above(t, row + 1, column + 1),
                   above(t, row + 1, column)};
    int edge[4], crossed[4], count = 0;
    cell_edges(t, row, column, edge);
    for (int i = 0; i < 4; i++) {
        if (!isfinite(v[i])) return;
        if ((v[i] >= 0) != (v[(i + 1) % 4] >= 0)) crossed[count++] = edge[i];
    }
    if (count == 2) join(t, crossed[0], crossed[1]);
    if (count < 4) return;
    bool centre = v[0] + v[1] + v[2] + v[3] >= 0;
    if (centre == (v[0] >= 0)) { /* corners 0 and 2 are joined: cut off 1 and 3 */
        join(t, edge[0], edge[1]);
        join(t, edge[2], edge[3]);
    } else {
        join(t, edge[3], edge[0]);
        join(t, edge[1], edge[2]);
    }
}

static ContourPoint crossing(const Tracer *t, int edge) {
    int at = edge / 2, row = at / t->side, column = at % t->side, down = edge % 2;
    double a = above(t, row, column), b = above(t, row + down, column + !down);
    double f = a == b ? 0.5 : a / (a - b);
    return (ContourPoint){column + (down ? 0 : f), row + (down ? f : 0)};
}

/* Along the chain from an edge to its end, or round to the start. */
static ContourLine trace(Tracer *t, int start, Arena *arena) {
    int length = 0, edge = start, before = -1;
    for (;;) { /* length first, then the points in one piece */
        t->is_done[edge] = true;
        length++;
        int next = t->link[0][edge] != before ? t->link[0][edge] : t->link[1][edge];
        if (next < 0 || next == start) break;
        before = edge;
        edge = next;
    }
    bool closed = length > 2 && (t->link[0][edge] == start || t->link[1][edge] == start);
    ContourLine line = {length + closed, closed, ARENA_NEW(arena, ContourPoint, length + 1)};
    edge = start;
    before = -1;
    for (int i = 0; i < length; i++) {
        line.point[i] = crossing(t, edge);
        int next = t->link[0][edge] != before ? t->link[0][edge] : t->link[1][edge];
        before = edge;
        edge = next;
    }
    if (closed) line.point[length] = line.point[0];
    return line;
}

ContourSet contour_lines(const float *value, int side, double level, Arena *arena) {
    int edges = 2 * side * side, capacity = 0;
    Tracer t = {.value = value, .side = side, .level = level};
    for (int k = 0; k < 2; k++) {
        t.link[k] = ARENA_NEW(arena, int, edges);
        memset(t.link[k], -1, sizeof(int) * (size_t)edges);
    }
    t.is_done = ARENA_NEW(arena, bool, edges);
    for (int row = 0; row + 1 < side; row++)
        for (int column = 0; column + 1 < side; column++) march_cell(&t, row, column);
    for (int e = 0; e < edges; e++) capacity += t.link[0][e] >= 0;
    ContourSet set = {0, ARENA_NEW(arena, ContourLine, capacity)};
    for (int pass = 0; pass < 2; pass++) /* open chains from their ends, then the rings */
        for (int e = 0; e < edges; e++)
            if (!t.is_done[e] && t.link[0][e] >= 0 && (pass == 1 || t.link[1][e] < 0))
                set.line[set.count++] = trace(&t, e, arena);
    return set;
}
