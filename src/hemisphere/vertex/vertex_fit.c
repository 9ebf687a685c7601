/* SPDX-License-Identifier: Apache-2.0 */
#include "hemisphere/vertex/vertex_fit.h"

#include <stdlib.h>
#include <string.h>

#include "hemisphere/vertex/vertex.h"

/* min over h of sum w (A S h - y)^2 / W + sum penalty h^2: A interpolates (three weights a
 * sample), S makes values of details. Conjugate gradients with a diagonal preconditioner, every
 * component by itself but all in one pass; in double precision, since the penalties are many
 * powers of ten below the data. */
typedef struct LeastSquares {
    VertexLattice lattice;
    int components;
    size_t numbers;          /* vertices x components */
    const VertexEdge *edges; /* of all levels, from the coarsest */
    uint32_t edge_count;
    uint32_t pole, corner[4]; /* corners on the horizon */
    const VertexPoint *points;
    const double *weight; /* of samples, over their sum */
    int samples;
    const double *penalty, *inverse_diagonal; /* of vertices */
} LeastSquares;

#define MAX_ITERATIONS 1000
#define TOLERANCE 1e-8 /* of the preconditioned residual against the first */

/* ---- details to values and back ---------------------------------------------------------- */

static int corner_count(const LeastSquares *p) {
    return p->lattice.octants == 2 ? 3 : 4;
}

static void add_row(const LeastSquares *p, uint32_t to, uint32_t from, double factor,
                    double *rows) {
    size_t k = (size_t)p->components;
    double *a = rows + to * k, *b = rows + from * k;
    for (size_t c = 0; c < k; c++) a[c] += factor * b[c];
}

/* h to S h, in place. Corners on the horizon are relative to the pole. */
static void synthesise(const LeastSquares *p, double *rows) {
    for (int i = 0; i < corner_count(p); i++) add_row(p, p->corner[i], p->pole, 1, rows);
    for (uint32_t e = 0; e < p->edge_count; e++)
        for (int i = 0; i < 2; i++) add_row(p, p->edges[e].vertex, p->edges[e].end[i], 0.5, rows);
}

/* x to S^T x, in place. */
static void transpose(const LeastSquares *p, double *rows) {
    for (uint32_t e = p->edge_count; e-- > 0;)
        for (int i = 0; i < 2; i++) add_row(p, p->edges[e].end[i], p->edges[e].vertex, 0.5, rows);
    for (int i = 0; i < corner_count(p); i++) add_row(p, p->pole, p->corner[i], 1, rows);
}

/* ---- the normal equations ---------------------------------------------------------------- */

/* out += A^T w (A values - y), y NULL: 0. */
static void add_data_gradient(const LeastSquares *p, const double *values, const float *y,
                              double *out) {
    size_t k = (size_t)p->components;
    for (int s = 0; s < p->samples; s++) {
        const VertexPoint *at = &p->points[s];
        if (p->weight[s] == 0) continue;
        for (size_t c = 0; c < k; c++) {
            double f = 0;
            for (int i = 0; i < 3; i++) f += (double)at->weight[i] * values[at->vertex[i] * k + c];
            if (y) f -= (double)y[(size_t)s * k + c];
            for (int i = 0; i < 3; i++)
                out[at->vertex[i] * k + c] += p->weight[s] * (double)at->weight[i] * f;
        }
    }
}

/* out = (S^T A^T w A S + penalty) h; values: room for S h. */
static void apply(const LeastSquares *p, const double *h, double *values, double *out) {
    size_t k = (size_t)p->components;
    memcpy(values, h, p->numbers * sizeof *h);
    synthesise(p, values);
    memset(out, 0, p->numbers * sizeof *out);
    add_data_gradient(p, values, NULL, out);
    transpose(p, out);
    for (size_t i = 0; i < p->numbers; i++) out[i] += p->penalty[i / k] * h[i];
}

/* a . b, of every component. */
static void dots(const LeastSquares *p, const double *a, const double *b, double *dot) {
    size_t k = (size_t)p->components;
    for (size_t c = 0; c < k; c++) dot[c] = 0;
    for (size_t i = 0; i < p->numbers; i += k)
        for (size_t c = 0; c < k; c++) dot[c] += a[i + c] * b[i + c];
}

/* The vectors of conjugate gradients. */
typedef struct FitWork {
    double *x, *r, *z, *d, *q, *values;
    double *rho, *rho_first, *next;
} FitWork;

static void precondition(const LeastSquares *p, const double *r, double *z) {
    size_t k = (size_t)p->components;
    for (size_t i = 0; i < p->numbers; i++) z[i] = p->inverse_diagonal[i / k] * r[i];
}

/* One step for every component that has not converged; how many those were. */
static int iterate(const LeastSquares *p, FitWork *w) {
    size_t k = (size_t)p->components;
    int active = 0;
    apply(p, w->d, w->values, w->q);
    dots(p, w->d, w->q, w->next);
    for (size_t c = 0; c < k; c++) {
        bool done = !(w->rho[c] > TOLERANCE * TOLERANCE * w->rho_first[c]);
        double step = done || !(w->next[c] > 0) ? 0 : w->rho[c] / w->next[c];
        active += !done;
        for (size_t i = c; i < p->numbers; i += k) {
            w->x[i] += step * w->d[i];
            w->r[i] -= step * w->q[i];
        }
    }
    precondition(p, w->r, w->z);
    dots(p, w->r, w->z, w->next);
    for (size_t c = 0; c < k; c++) {
        double ratio = w->rho[c] > 0 ? w->next[c] / w->rho[c] : 0;
        w->rho[c] = w->next[c];
        for (size_t i = c; i < p->numbers; i += k) w->d[i] = w->z[i] + ratio * w->d[i];
    }
    return active;
}

/* x: details that solve the problem; starts from 0. */
static void solve(const LeastSquares *p, const float *y, FitWork *w) {
    add_data_gradient(p, w->x, y, w->r);
    transpose(p, w->r);
    for (size_t i = 0; i < p->numbers; i++) w->r[i] = -w->r[i];
    precondition(p, w->r, w->d);
    dots(p, w->r, w->d, w->rho);
    memcpy(w->rho_first, w->rho, (size_t)p->components * sizeof *w->rho);
    for (int i = 0; i < MAX_ITERATIONS && iterate(p, w) > 0; i++) continue;
}

/* ---- setting up -------------------------------------------------------------------------- */

/* The level on which a lattice point is new; 0: a corner on the horizon, -1: the pole. */
static int level_of(VertexLattice lattice, int x, int y) {
    int n = 1 << lattice.level, bits = x | y;
    if (bits == 0) return -1;
    int level = lattice.level - __builtin_ctz((unsigned)bits);
    return level < 0 || abs(x) == n || abs(y) == n ? 0 : level;
}

static double *make_penalty(VertexLattice lattice, double ridge, Arena *arena) {
    int n = 1 << lattice.level;
    double *penalty = ARENA_NEW(arena, double, vertex_count(lattice));
    for (int y = lattice.octants == 2 ? 0 : -n; y <= n; y++)
        for (int x = abs(y) - n; x <= n - abs(y); x++) {
            int level = level_of(lattice, x, y);
            penalty[vertex_index(lattice, x, y)] =
                level < 0 ? 0 : ridge * (double)(1ull << 4 * level);
        }
    return penalty;
}

/* The diagonal of S^T A^T w A S + penalty, with the off-diagonal part of the data's term
 * summed into it: sum over samples of w times the hat function. */
static double *make_inverse_diagonal(const LeastSquares *p, Arena *arena) {
    uint32_t count = vertex_count(p->lattice);
    LeastSquares one = *p;
    double *diagonal = ARENA_NEW(arena, double, count);
    one.components = 1;
    for (int s = 0; s < p->samples; s++)
        for (int i = 0; i < 3; i++)
            diagonal[p->points[s].vertex[i]] += p->weight[s] * (double)p->points[s].weight[i];
    transpose(&one, diagonal);
    for (uint32_t i = 0; i < count; i++) {
        double sum = diagonal[i] + p->penalty[i];
        diagonal[i] = sum > 0 ? 1 / sum : 0;
    }
    return diagonal;
}

static void make_hierarchy(LeastSquares *p, Arena *arena) {
    int n = 1 << p->lattice.level, levels = p->lattice.level;
    const int at[4][2] = {{n, 0}, {-n, 0}, {0, n}, {0, -n}};
    VertexEdge *edges = ARENA_NEW(arena, VertexEdge, vertex_count(p->lattice));
    for (int i = 0; i < levels; i++)
        p->edge_count += vertex_edges(p->lattice, i, edges + p->edge_count);
    p->edges = edges;
    p->pole = vertex_index(p->lattice, 0, 0);
    for (int i = 0; i < corner_count(p); i++)
        p->corner[i] = vertex_index(p->lattice, at[i][0], at[i][1]);
}

/* Weights over their sum. */
static bool make_weights(const VertexSamples *samples, double *weight, Error *err) {
    double sum = 0;
    for (int s = 0; s < samples->count; s++) {
        float w = samples->weight ? samples->weight[s] : 1.0f;
        if (!(w >= 0) || !isfinite(w))
            return error_set(err, ERROR_INPUT,
                             "sample %d has the weight %g, required: 0 or "
                             "more",
                             s, (double)w);
        sum += (double)w;
    }
    if (!(sum > 0))
        return error_set(err, ERROR_INPUT, "%d samples have no weight, required: some",
                         samples->count);
    for (int s = 0; s < samples->count; s++)
        weight[s] = (samples->weight ? (double)samples->weight[s] : 1.0) / sum;
    return true;
}

static bool check_samples(const VertexSamples *samples, Error *err) {
    size_t k = (size_t)samples->components;
    for (size_t i = 0; i < k * (size_t)samples->count; i++)
        if (!isfinite(samples->value[i]))
            return error_set(err, ERROR_INPUT, "sample %zu is %g, required: a finite number", i / k,
                             (double)samples->value[i]);
    return true;
}

static FitWork make_work(const LeastSquares *p, Arena *arena) {
    FitWork w;
    double **rows[] = {&w.x, &w.r, &w.z, &w.d, &w.q, &w.values};
    double **numbers[] = {&w.rho, &w.rho_first, &w.next};
    for (int i = 0; i < 6; i++) *rows[i] = ARENA_NEW(arena, double, p->numbers);
    for (int i = 0; i < 3; i++) *numbers[i] = ARENA_NEW(arena, double, p->components);
    return w;
}

bool vertex_fit(VertexLattice lattice, const VertexSamples *samples, double ridge, Arena *scratch,
                float *values, Error *err) {
    Arena arena = *scratch;
    const Geodesic *geodesic = geodesic_create(vertex_plane_level(lattice.level), &arena);
    VertexPoint *points = ARENA_NEW(&arena, VertexPoint, samples->count);
    double *weight = ARENA_NEW(&arena, double, samples->count);
    if (!check_samples(samples, err) || !make_weights(samples, weight, err)) return false;
    for (int s = 0; s < samples->count; s++)
        points[s] = vertex_find(geodesic, lattice, samples->direction[s]);
    LeastSquares p = {.lattice = lattice,
                      .components = samples->components,
                      .numbers = vertex_count(lattice) * (size_t)samples->components,
                      .points = points,
                      .weight = weight,
                      .samples = samples->count,
                      .penalty = make_penalty(lattice, ridge, &arena)};
    make_hierarchy(&p, &arena);
    p.inverse_diagonal = make_inverse_diagonal(&p, &arena);
    FitWork work = make_work(&p, &arena);
    solve(&p, samples->value, &work);
    synthesise(&p, work.x);
    for (size_t i = 0; i < p.numbers; i++) values[i] = (float)work.x[i];
    return true;
}
