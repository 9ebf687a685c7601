/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: which measured places count at a place. No allocation and no libm in queries. */
#include "panel/shape/spot_ground.h"

#include <math.h>
#include <string.h>

#include "base/mathf.h"

/* ---- a grid ------------------------------------------------------------------------------ */

/* Adds a value to a rising list of different ones. */
static int insert(float *list, int count, float value) {
    int i = count;
    for (int k = 0; k < count; k++)
        if (list[k] == value) return count;
    for (; i > 0 && list[i - 1] > value; i--) list[i] = list[i - 1];
    list[i] = value;
    return count + 1;
}

static int index_of(const float *list, float value) {
    int i = 0;
    while (list[i] != value) i++;
    return i;
}

static void find_grid(SpotGround *g) {
    int columns = 0, rows = 0;
    for (int i = 0; i < g->count; i++) {
        columns = insert(g->u, columns, g->at[i][0]);
        rows = insert(g->v, rows, g->at[i][1]);
    }
    if (columns * rows != g->count) return; /* places differ, so that a full count is a grid */
    g->columns = columns;
    g->rows = rows;
    for (int i = 0; i < g->count; i++)
        g->of_cell[index_of(g->v, g->at[i][1]) * columns + index_of(g->u, g->at[i][0])] =
            (uint8_t)i;
}

/* The interval of a rising list that holds the value, and where in it; the ends hold. */
static int interval_of(const float *list, int count, float value, float *t) {
    int i = 0;
    while (i + 2 < count && list[i + 1] <= value) i++;
    *t = count > 1 ? clampf((value - list[i]) / (list[i + 1] - list[i]), 0, 1) : 0;
    return i;
}

static void add(SpotWeights *out, int spot, float weight) {
    if (!(weight > 0)) return;
    out->spot[out->count] = spot;
    out->weight[out->count++] = weight;
}

static SpotWeights grid_weights(const SpotGround *g, const float place[2]) {
    SpotWeights out = {.count = 0};
    float s, t;
    int i = interval_of(g->u, g->columns, place[0], &s);
    int k = interval_of(g->v, g->rows, place[1], &t);
    int right = i + (g->columns > 1), below = k + (g->rows > 1);
    add(&out, g->of_cell[k * g->columns + i], (1 - s) * (1 - t));
    add(&out, g->of_cell[k * g->columns + right], s * (1 - t));
    add(&out, g->of_cell[below * g->columns + i], (1 - s) * t);
    add(&out, g->of_cell[below * g->columns + right], s * t);
    return out;
}

/* ---- scattered places -------------------------------------------------------------------- */

/* Heights over the paraboloid; what is added by the index cuts squares, whose corners lie on
 * one circle, into two triangles and not into four halves. */
static double lifted(const SpotGround *g, int i) {
    double u = (double)g->at[i][0], v = (double)g->at[i][1];
    return u * u + v * v + 1e-9 * ((i * 7919) % 104729) / 104729;
}

/* Twice the area of a triangle, positive where it turns from u to v. */
static double area_of(const SpotGround *g, int a, int b, int c) {
    double u1 = (double)g->at[b][0] - (double)g->at[a][0];
    double v1 = (double)g->at[b][1] - (double)g->at[a][1];
    double u2 = (double)g->at[c][0] - (double)g->at[a][0];
    double v2 = (double)g->at[c][1] - (double)g->at[a][1];
    return u1 * v2 - u2 * v1;
}

#define LEAST_AREA 1e-7 /* below: the three lie on a line, to the precision of floats */

/* Does the plane through three lifted places leave all others above it? */
static bool is_delaunay(const SpotGround *g, int a, int b, int c) {
    double area = area_of(g, a, b, c);
    if (fabs(area) < LEAST_AREA) return false;
    for (int i = 0; i < g->count; i++) {
        if (i == a || i == b || i == c) continue;
        double plane = (area_of(g, i, b, c) * lifted(g, a) + area_of(g, a, i, c) * lifted(g, b) +
                        area_of(g, a, b, i) * lifted(g, c)) /
                       area;
        if (lifted(g, i) < plane) return false;
    }
    return true;
}

static void find_triangles(SpotGround *g) {
    int room = 2 * SPOT_GROUND_MAX;
    for (int a = 0; a < g->count; a++)
        for (int b = a + 1; b < g->count; b++)
            for (int c = b + 1; c < g->count; c++)
                if (g->triangles < room && is_delaunay(g, a, b, c)) {
                    uint8_t *t = g->triangle[g->triangles++];
                    t[0] = (uint8_t)a, t[1] = (uint8_t)b, t[2] = (uint8_t)c;
                }
}

static int uses_of_edge(const SpotGround *g, int a, int b) {
    int uses = 0;
    for (int i = 0; i < g->triangles; i++) {
        int found = 0;
        for (int k = 0; k < 3; k++) found += g->triangle[i][k] == a || g->triangle[i][k] == b;
        uses += found == 2;
    }
    return uses;
}

/* On one line: does another place lie between the two? */
static bool is_parted(const SpotGround *g, int a, int b) {
    for (int i = 0; i < g->count; i++) {
        if (i == a || i == b) continue;
        double along = 0;
        for (int k = 0; k < 2; k++)
            along += ((double)g->at[i][k] - (double)g->at[a][k]) *
                     ((double)g->at[i][k] - (double)g->at[b][k]);
        if (along < 0) return true;
    }
    return false;
}

static void find_border(SpotGround *g) {
    for (int a = 0; a < g->count; a++)
        for (int b = a + 1; b < g->count; b++) {
            bool is_border = g->triangles ? uses_of_edge(g, a, b) == 1 : !is_parted(g, a, b);
            if (!is_border || g->edges == 2 * SPOT_GROUND_MAX) continue;
            g->edge[g->edges][0] = (uint8_t)a;
            g->edge[g->edges++][1] = (uint8_t)b;
        }
}

/* Weights in the triangle that holds the place; false: none does. */
static bool triangle_weights(const SpotGround *g, const float place[2], SpotWeights *out) {
    for (int i = 0; i < g->triangles; i++) {
        const uint8_t *t = g->triangle[i];
        const float *a = g->at[t[0]], *b = g->at[t[1]], *c = g->at[t[2]];
        float u1 = b[0] - a[0], v1 = b[1] - a[1], u2 = c[0] - a[0], v2 = c[1] - a[1];
        float u = place[0] - a[0], v = place[1] - a[1], area = u1 * v2 - u2 * v1;
        float wb = (u * v2 - u2 * v) / area, wc = (u1 * v - u * v1) / area;
        if (!(wb >= 0 && wc >= 0 && wb + wc <= 1)) continue;
        add(out, t[0], 1 - wb - wc);
        add(out, t[1], wb);
        add(out, t[2], wc);
        return out->count > 0;
    }
    return false;
}

static SpotWeights border_weights(const SpotGround *g, const float place[2]) {
    SpotWeights out = {.count = 0};
    float nearest = INFINITY, at = 0;
    int edge = 0;
    for (int i = 0; i < g->edges; i++) {
        const float *a = g->at[g->edge[i][0]], *b = g->at[g->edge[i][1]];
        float du = b[0] - a[0], dv = b[1] - a[1], u = place[0] - a[0], v = place[1] - a[1];
        float t = clampf((u * du + v * dv) / (du * du + dv * dv), 0, 1);
        float d = (u - t * du) * (u - t * du) + (v - t * dv) * (v - t * dv);
        if (d < nearest) nearest = d, at = t, edge = i;
    }
    add(&out, g->edge[edge][0], 1 - at);
    add(&out, g->edge[edge][1], at);
    return out;
}

/* ---- both -------------------------------------------------------------------------------- */

void spot_ground_build(const float (*at)[2], int count, Arena *arena, SpotGround *out) {
    memset(out, 0, sizeof *out);
    out->count = count;
    out->at = at;
    find_grid(out);
    if (out->columns) return;
    out->triangle = arena_alloc(arena, 1, 1, 3 * 2 * SPOT_GROUND_MAX);
    out->edge = arena_alloc(arena, 1, 1, 2 * 2 * SPOT_GROUND_MAX);
    find_triangles(out);
    find_border(out);
}

SpotWeights spot_ground_weights(const SpotGround *ground, const float place[2]) {
    SpotWeights out = {.count = 0};
    float held[2] = {place[0] > 0 ? clampf(place[0], 0, 1) : 0, /* no number: 0 */
                     place[1] > 0 ? clampf(place[1], 0, 1) : 0};
    if (ground->columns) return grid_weights(ground, held);
    if (triangle_weights(ground, held, &out)) return out;
    return border_weights(ground, held);
}
