#include <stdlib.h>
#include <string.h>

#include "hemisphere/vertex.h"

/* min over h of sum w (A S h - y)^2 / W + sum penalty h^2: A interpolates (three weights a
 * sample), S makes values of details. Conjugate gradients with a diagonal preconditioner, every
 * component by itself but all in one pass. */
typedef struct Problem {
    VertexLattice      lattice;
    int                components;
    size_t             numbers; /* vertices x components */
    const VertexPoint *points;
    const float       *weight; /* of samples, over their sum */
    int                samples;
    const float       *penalty, *inverse_diagonal; /* of vertices */
} Problem;

#define MAX_ITERATIONS 200
#define TOLERANCE 1e-5 /* of the preconditioned residual against the first */

/* ---- details with their corners relative to the pole ------------------------------------- */

static void corners_add_pole(const Problem *p, float *rows)
{
    int          n = 1 << p->lattice.level;
    const int    at[4][2] = {{n, 0}, {-n, 0}, {0, n}, {0, -n}};
    const float *pole = rows + vertex_index(p->lattice, 0, 0) * (size_t)p->components;
    for (int i = 0; i < (p->lattice.octants == 2 ? 3 : 4); i++) {
        float *row = rows +
                     vertex_index(p->lattice, at[i][0], at[i][1]) * (size_t)p->components;
        for (int c = 0; c < p->components; c++) row[c] += pole[c];
    }
}

static void corners_add_to_pole(const Problem *p, float *rows)
{
    int       n = 1 << p->lattice.level;
    const int at[4][2] = {{n, 0}, {-n, 0}, {0, n}, {0, -n}};
    float    *pole = rows + vertex_index(p->lattice, 0, 0) * (size_t)p->components;
    for (int i = 0; i < (p->lattice.octants == 2 ? 3 : 4); i++) {
        const float *row = rows + vertex_index(p->lattice, at[i][0], at[i][1]) *
                                      (size_t)p->components;
        for (int c = 0; c < p->components; c++) pole[c] += row[c];
    }
}

/* h to S h and x to S^T x, in place. */
static void synthesise(const Problem *p, float *rows)
{
    corners_add_pole(p, rows);
    vertex_values_from_details(p->lattice, p->components, rows);
}

static void transpose(const Problem *p, float *rows)
{
    vertex_gather(p->lattice, p->components, rows);
    corners_add_to_pole(p, rows);
}

/* ---- the normal equations ---------------------------------------------------------------- */

/* out += A^T w (A values - y), y NULL: 0. */
static void add_data_gradient(const Problem *p, const float *values, const float *y, float *out)
{
    size_t k = (size_t)p->components;
    for (int s = 0; s < p->samples; s++) {
        const VertexPoint *at = &p->points[s];
        const float *v[3] = {values + at->vertex[0] * k, values + at->vertex[1] * k,
                             values + at->vertex[2] * k};
        float *o[3] = {out + at->vertex[0] * k, out + at->vertex[1] * k,
                       out + at->vertex[2] * k};
        if (p->weight[s] == 0) continue;
        for (size_t c = 0; c < k; c++) {
            float f = at->weight[0] * v[0][c] + at->weight[1] * v[1][c] +
                      at->weight[2] * v[2][c];
            float r = p->weight[s] * (f - (y ? y[(size_t)s * k + c] : 0.0f));
            for (int i = 0; i < 3; i++) o[i][c] += at->weight[i] * r;
        }
    }
}

/* out = (S^T A^T w A S + penalty) h; values: room for S h. */
static void apply(const Problem *p, const float *h, float *values, float *out)
{
    size_t k = (size_t)p->components;
    memcpy(values, h, p->numbers * sizeof *h);
    synthesise(p, values);
    memset(out, 0, p->numbers * sizeof *out);
    add_data_gradient(p, values, NULL, out);
    transpose(p, out);
    for (size_t i = 0; i < p->numbers; i++) out[i] += p->penalty[i / k] * h[i];
}

/* a . b, of every component. */
static void dots(const Problem *p, const float *a, const float *b, double *dot)
{
    int k = p->components;
    for (int c = 0; c < k; c++) dot[c] = 0;
    for (size_t i = 0; i < p->numbers; i += (size_t)k)
        for (int c = 0; c < k; c++) dot[c] += (double)a[i + (size_t)c] * (double)b[i + (size_t)c];
}

/* The vectors of conjugate gradients. */
typedef struct Work {
    float  *x, *r, *z, *d, *q, *values;
    double *rho, *rho_first, *dq;
} Work;

static void precondition(const Problem *p, const float *r, float *z)
{
    size_t k = (size_t)p->components;
    for (size_t i = 0; i < p->numbers; i++) z[i] = p->inverse_diagonal[i / k] * r[i];
}

/* One step for every component that has not converged; how many those were. */
static int iterate(const Problem *p, Work *w)
{
    size_t k = (size_t)p->components;
    int    active = 0;
    apply(p, w->d, w->values, w->q);
    dots(p, w->d, w->q, w->dq);
    for (size_t c = 0; c < k; c++) {
        bool done = !(w->rho[c] > TOLERANCE * TOLERANCE * w->rho_first[c]) || !(w->dq[c] > 0);
        double step = done ? 0 : w->rho[c] / w->dq[c];
        active += !done;
        for (size_t i = c; i < p->numbers; i += k) {
            w->x[i] += (float)step * w->d[i];
            w->r[i] -= (float)step * w->q[i];
        }
    }
    precondition(p, w->r, w->z);
    dots(p, w->r, w->z, w->dq);
    for (size_t c = 0; c < k; c++) {
        double ratio = w->rho[c] > 0 ? w->dq[c] / w->rho[c] : 0;
        w->rho[c] = w->dq[c];
        for (size_t i = c; i < p->numbers; i += k)
            w->d[i] = w->z[i] + (float)ratio * w->d[i];
    }
    return active;
}

/* x: details that solve the problem; starts from 0. */
static void solve(const Problem *p, const float *y, Work *w)
{
    memset(w->x, 0, p->numbers * sizeof *w->x);
    memset(w->r, 0, p->numbers * sizeof *w->r);
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
static int level_of(VertexLattice lattice, int x, int y)
{
    int n = 1 << lattice.level, bits = x | y;
    if (bits == 0) return -1;
    int level = lattice.level - __builtin_ctz((unsigned)bits);
    return level < 0 || abs(x) == n || abs(y) == n ? 0 : level;
}

static float *make_penalty(VertexLattice lattice, double ridge, Arena *arena)
{
    int    n = 1 << lattice.level;
    float *penalty = ARENA_NEW(arena, float, vertex_count(lattice));
    for (int y = lattice.octants == 2 ? 0 : -n; y <= n; y++)
        for (int x = abs(y) - n; x <= n - abs(y); x++) {
            int level = level_of(lattice, x, y);
            penalty[vertex_index(lattice, x, y)] =
                level < 0 ? 0.0f : (float)(ridge * (double)(1ull << 4 * level));
        }
    return penalty;
}

/* The diagonal of S^T A^T w A S + penalty, with the off-diagonal part of the data's term
 * summed into it: sum over samples of w times the hat function. */
static float *make_inverse_diagonal(Problem *p, Arena *arena)
{
    uint32_t count = vertex_count(p->lattice);
    Problem  one = *p;
    float   *diagonal = ARENA_NEW(arena, float, count);
    one.components = 1;
    for (int s = 0; s < p->samples; s++)
        for (int i = 0; i < 3; i++)
            diagonal[p->points[s].vertex[i]] += p->weight[s] * p->points[s].weight[i];
    transpose(&one, diagonal);
    for (uint32_t i = 0; i < count; i++) {
        float sum = diagonal[i] + p->penalty[i];
        diagonal[i] = sum > 0 ? 1 / sum : 0.0f;
    }
    return diagonal;
}

/* Weights over their sum. */
static bool make_weights(const VertexSamples *samples, float *weight, Error *err)
{
    double sum = 0;
    for (int s = 0; s < samples->count; s++) {
        float w = samples->weight ? samples->weight[s] : 1.0f;
        if (!(w >= 0) || !isfinite(w))
            return error_set(err, ERROR_INPUT, "sample %d has the weight %g, wanted 0 or more",
                             s, (double)w);
        sum += (double)w;
    }
    if (!(sum > 0))
        return error_set(err, ERROR_INPUT, "%d samples have no weight, wanted some",
                         samples->count);
    for (int s = 0; s < samples->count; s++)
        weight[s] = (float)((samples->weight ? (double)samples->weight[s] : 1.0) / sum);
    return true;
}

static bool check_samples(const VertexSamples *samples, Error *err)
{
    size_t k = (size_t)samples->components;
    for (size_t i = 0; i < k * (size_t)samples->count; i++)
        if (!isfinite(samples->value[i]))
            return error_set(err, ERROR_INPUT, "sample %zu is %g, wanted a finite number",
                             i / k, (double)samples->value[i]);
    return true;
}

static Work make_work(const Problem *p, float *x, Arena *arena)
{
    Work w = {.x = x};
    w.r = ARENA_NEW(arena, float, p->numbers);
    w.z = ARENA_NEW(arena, float, p->numbers);
    w.d = ARENA_NEW(arena, float, p->numbers);
    w.q = ARENA_NEW(arena, float, p->numbers);
    w.values = ARENA_NEW(arena, float, p->numbers);
    w.rho = ARENA_NEW(arena, double, p->components);
    w.rho_first = ARENA_NEW(arena, double, p->components);
    w.dq = ARENA_NEW(arena, double, p->components);
    return w;
}

bool vertex_fit(const Geodesic *geodesic, VertexLattice lattice, const VertexSamples *samples,
                double ridge, Arena *scratch, float *values, Error *err)
{
    Arena        arena = *scratch;
    VertexPoint *points = ARENA_NEW(&arena, VertexPoint, samples->count);
    float       *weight = ARENA_NEW(&arena, float, samples->count);
    if (!check_samples(samples, err) || !make_weights(samples, weight, err)) return false;
    for (int s = 0; s < samples->count; s++)
        points[s] = vertex_find(geodesic, lattice, samples->direction[s]);
    Problem p = {.lattice = lattice,
                 .components = samples->components,
                 .numbers = vertex_count(lattice) * (size_t)samples->components,
                 .points = points,
                 .weight = weight,
                 .samples = samples->count,
                 .penalty = make_penalty(lattice, ridge, &arena)};
    p.inverse_diagonal = make_inverse_diagonal(&p, &arena);
    Work work = make_work(&p, values, &arena);
    solve(&p, samples->value, &work);
    synthesise(&p, values);
    return true;
}
