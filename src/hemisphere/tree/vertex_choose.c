/* SPDX-License-Identifier: Apache-2.0 */
/* Which vertices to store, and with what values.
 *
 * Interpolating a function at its own values is wasteful: where it curves, all errors between
 * the vertices have the same sign. Values that balance the errors need up to half as many
 * vertices. So: least squares over ALL vertices of the lattice for the details of those that
 * are stored, from the coarse levels to the fine; where that is not accepted, the weights grow,
 * and the detail of the level that would help most (gradient^2 over diagonal) is added. In the
 * end the details that matter least are dropped as long as everything stays accepted. */
#include "hemisphere/tree/vertex_choose.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "hemisphere/tree/vertex.h"

/* ---- what the caller accepts ------------------------------------------------------------- */

static float distance(const VertexJudge *judge, uint32_t vertex, const float *row) {
    const float *value = judge->values + (size_t)vertex * (size_t)judge->options->components;
    float most = 0;
    for (int i = 0; i < judge->options->components; i++)
        most = fmaxf(most, fabsf(row[i] - value[i]) / judge->unit[i]);
    return most;
}

static void go_beyond(const VertexJudge *judge, uint32_t vertex, const float *row, float factor,
                      float *farther) {
    const float *value = judge->values + (size_t)vertex * (size_t)judge->options->components;
    for (int i = 0; i < judge->options->components; i++)
        farther[i] = value[i] + factor * (row[i] - value[i]);
}

static bool row_passes(const VertexJudge *judge, uint32_t vertex, const float *row) {
    return judge->options->accepts(judge->options->context, vertex, row);
}

/* Queries add up in another order than the coder: what is near the bound is refused where that
 * happened to matter. */
static bool judge_strictly(const VertexJudge *judge, uint32_t vertex, const float *row) {
    float farther[TREE_MAX_COMPONENTS];
    go_beyond(judge, vertex, row, 1.001f, farther);
    return row_passes(judge, vertex, row) && row_passes(judge, vertex, farther);
}

bool vertex_accepts(VertexJudge *judge, uint32_t vertex, const float *row) {
    if (judge->safe[vertex] < 0) return judge_strictly(judge, vertex, row);
    if (judge->is_exact) return row_passes(judge, vertex, row);
    float reach = distance(judge, vertex, row);
    if (reach <= 0.5f * judge->safe[vertex]) return true;
    if (!row_passes(judge, vertex, row)) return false;
    judge->safe[vertex] = fmaxf(judge->safe[vertex], reach);
    return true;
}

/* The same for value + factor * (row - value). */
static bool accepts_beyond(VertexJudge *judge, uint32_t vertex, const float *row, float factor) {
    float farther[TREE_MAX_COMPONENTS];
    go_beyond(judge, vertex, row, factor, farther);
    return vertex_accepts(judge, vertex, farther);
}

/* ---- the choice -------------------------------------------------------------------------- */

#define SLACK 0.85f /* of the tolerance: the rest is for rounding */
#define STEPS 12    /* of conjugate gradients */
#define MOST_WEIGHT 64.0f
#define MENDS 12 /* rounds that add details where some are missing */

/* Four components: what least squares work on, side by side for all vertices. */
typedef float Four __attribute__((vector_size(16)));

/* One group of four components of everything, a number a vertex. */
typedef struct Group {
    Four *value, *detail, *fitted, *rest, *direction, *product, *gradient;
} Group;

typedef struct Chooser {
    const VertexTreeOptions *options;
    const float *values, *unit; /* the judge's */
    VertexJudge *judge;
    int base_level, k, group_count;
    uint32_t count;
    VertexEdge *edges[GEODESIC_MAX_LEVEL];
    uint32_t edge_count[GEODESIC_MAX_LEVEL];
    bool *chosen;   /* base vertices and stored details */
    bool *missed;   /* not accepted now */
    uint32_t *list; /* the chosen ones, while fitting */
    uint32_t list_count;
    float *weight, *diagonal;
    Group *group;
} Chooser;

/* ---- the hierarchy above the base level -------------------------------------------------- */

/* Details (base vertices: values) to values, in place. */
static void synthesise(const Chooser *c, Four *row) {
    for (int i = c->base_level; i < c->options->lattice.level; i++)
        for (uint32_t e = 0; e < c->edge_count[i]; e++) {
            const VertexEdge *edge = &c->edges[i][e];
            row[edge->vertex] += 0.5f * (row[edge->end[0]] + row[edge->end[1]]);
        }
}

/* The transpose. */
static void gather(const Chooser *c, Four *row) {
    for (int i = c->options->lattice.level - 1; i >= c->base_level; i--)
        for (uint32_t e = 0; e < c->edge_count[i]; e++) {
            const VertexEdge *edge = &c->edges[i][e];
            Four half = 0.5f * row[edge->vertex];
            row[edge->end[0]] += half;
            row[edge->end[1]] += half;
        }
}

/* The diagonal of S^T w S, with the squares of the hats taken as the hats. */
static void find_diagonal(Chooser *c) {
    memcpy(c->diagonal, c->weight, c->count * sizeof *c->weight);
    for (int i = c->options->lattice.level - 1; i >= c->base_level; i--)
        for (uint32_t e = 0; e < c->edge_count[i]; e++) {
            const VertexEdge *edge = &c->edges[i][e];
            float half = 0.5f * c->diagonal[edge->vertex];
            c->diagonal[edge->end[0]] += half;
            c->diagonal[edge->end[1]] += half;
        }
}

/* ---- least squares ----------------------------------------------------------------------- */

/* gradient = S^T w (value - S detail), of all vertices. */
static void find_gradient(const Chooser *c, const Group *g) {
    memcpy(g->fitted, g->detail, c->count * sizeof *g->fitted);
    synthesise(c, g->fitted);
    for (size_t v = 0; v < c->count; v++)
        g->gradient[v] = c->weight[v] * (g->value[v] - g->fitted[v]);
    gather(c, g->gradient);
}

/* product = S^T w S direction, of chosen vertices. */
static void multiply(const Chooser *c, const Group *g) {
    memcpy(g->product, g->direction, c->count * sizeof *g->product);
    synthesise(c, g->product);
    for (size_t v = 0; v < c->count; v++) g->product[v] *= c->weight[v];
    gather(c, g->product);
}

/* For every component: the sum over chosen vertices of rest^2 / diagonal, and of direction
 * times product. */
static void find_steps(const Chooser *c, const Group *g, double rho[4], double curvature[4]) {
    for (int j = 0; j < 4; j++) rho[j] = curvature[j] = 0;
    for (uint32_t i = 0; i < c->list_count; i++) {
        uint32_t v = c->list[i];
        Four r = g->rest[v] * g->rest[v] / c->diagonal[v], s = g->direction[v] * g->product[v];
        for (int j = 0; j < 4; j++) {
            rho[j] += (double)r[j];
            curvature[j] += (double)s[j];
        }
    }
}

/* Conjugate gradients from the details that are there, for four components. */
static void fit_group(void *context, int item, int worker) {
    const Chooser *c = context;
    const Group *g = &c->group[item];
    double rho[4], next[4], curvature[4];
    (void)worker;
    find_gradient(c, g);
    memset(g->direction, 0, c->count * sizeof *g->direction);
    for (uint32_t i = 0; i < c->list_count; i++) {
        uint32_t v = c->list[i];
        g->rest[v] = g->gradient[v];
        g->direction[v] = g->rest[v] / c->diagonal[v];
    }
    for (int step = 0; step < STEPS; step++) {
        Four a, b;
        multiply(c, g);
        find_steps(c, g, rho, curvature);
        for (int j = 0; j < 4; j++) a[j] = curvature[j] > 0 ? (float)(rho[j] / curvature[j]) : 0.0f;
        for (uint32_t i = 0; i < c->list_count; i++) {
            g->detail[c->list[i]] += a * g->direction[c->list[i]];
            g->rest[c->list[i]] -= a * g->product[c->list[i]];
        }
        find_steps(c, g, next, curvature);
        for (int j = 0; j < 4; j++) b[j] = rho[j] > 0 ? (float)(next[j] / rho[j]) : 0.0f;
        for (uint32_t i = 0; i < c->list_count; i++) {
            uint32_t v = c->list[i];
            g->direction[v] = g->rest[v] / c->diagonal[v] + b * g->direction[v];
        }
    }
    find_gradient(c, g);
}

static void fit(Chooser *c) {
    c->list_count = 0;
    for (uint32_t v = 0; v < c->count; v++)
        if (c->chosen[v]) c->list[c->list_count++] = v;
    find_diagonal(c);
    parallel_for(c->options->threads > 1 ? c->options->threads : 1, c->group_count, fit_group, c);
}

static uint32_t count_chosen(const Chooser *c) {
    uint32_t sum = 0;
    for (uint32_t v = 0; v < c->count; v++) sum += c->chosen[v];
    return sum;
}

/* One component of a vertex. */
static float *component(Four *row, uint32_t vertex, int j) {
    return (float *)&row[vertex] + j % 4;
}

/* The tree's current values at a vertex. */
static void fitted_row(const Chooser *c, uint32_t vertex, float *row) {
    for (int j = 0; j < c->k; j++) row[j] = *component(c->group[j / 4].fitted, vertex, j);
}

/* ---- what is missed ---------------------------------------------------------------------- */

/* Marks vertices not accepted with the slack and raises their weights; returns how many. */
static uint32_t find_missed(Chooser *c) {
    uint32_t missed = 0;
    float row[TREE_MAX_COMPONENTS];
    for (uint32_t v = 0; v < c->count; v++) {
        fitted_row(c, v, row);
        c->missed[v] = !accepts_beyond(c->judge, v, row, 1 / SLACK);
        missed += c->missed[v];
        if (c->missed[v] && c->weight[v] < MOST_WEIGHT) c->weight[v] *= 2;
    }
    return missed;
}

/* By how much a vertex's detail would reduce the weighted squares. */
static float gain_of(const Chooser *c, uint32_t vertex) {
    float sum = 0;
    for (int j = 0; j < c->k; j++) {
        float g = *component(c->group[j / 4].gradient, vertex, j) / c->unit[j];
        sum += g * g;
    }
    return sum / c->diagonal[vertex];
}

/* The new vertices of level i around a lattice point: the midpoints of the edges of the
 * triangle that holds it (other than those that do not reach it). */
static int vertices_around(VertexLattice lattice, int x, int y, int level, uint32_t vertex[3]) {
    int shift = lattice.level - level, size = 1 << shift, half = size / 2;
    int sx = x < 0 ? -1 : 1, sy = y < 0 ? -1 : 1, ax = abs(x), ay = abs(y);
    int cx = ax >> shift, cy = ay >> shift, u = ax - cx * size, v = ay - cy * size, count = 0;
    int upper = u + v > size;
    if (upper) {
        u = size - u;
        v = size - v;
    }
    int w = size - u - v, mx = cx * size + half, my = cy * size + half;
    if (u > 0 && w > 0 && v < half)
        vertex[count++] = vertex_index(lattice, sx * mx, sy * (cy + upper) * size);
    if (v > 0 && w > 0 && u < half)
        vertex[count++] = vertex_index(lattice, sx * (cx + upper) * size, sy * my);
    if (u > 0 && v > 0 && w < half) vertex[count++] = vertex_index(lattice, sx * mx, sy * my);
    return count;
}

/* A missed vertex and the detail that gains most there. */
typedef struct Wish {
    const VertexEdge *at;
    uint32_t vertex;
    int level; /* on whose edges the detail is new */
    float gain;
} Wish;

/* The best detail of levels first .. last - 1 around a vertex, or its own (of level `own`). */
static Wish best_around(const Chooser *c, const VertexEdge *at, int own, int first, int last) {
    uint32_t around[3];
    Wish wish = {at, at->vertex, own, c->chosen[at->vertex] ? -1 : gain_of(c, at->vertex)};
    for (int i = first; i < last; i++) {
        int count = vertices_around(c->options->lattice, at->x, at->y, i, around);
        for (int j = 0; j < count; j++) {
            if (c->chosen[around[j]]) continue;
            float gain = gain_of(c, around[j]);
            if (gain > wish.gain) wish = (Wish){at, around[j], i, gain};
        }
    }
    return wish;
}

static int by_gain(const void *a, const void *b) {
    const Wish *x = a, *y = b;
    if (x->gain != y->gain) return x->gain > y->gain ? -1 : 1;
    return x->at->vertex < y->at->vertex ? -1 : x->at->vertex > y->at->vertex;
}

/* Grants a wish: nothing else is added this round for the vertices close by. */
static void grant(Chooser *c, const Wish *wish) {
    VertexLattice lattice = c->options->lattice;
    int n = 1 << lattice.level, reach = n >> (wish->level + 2);
    c->chosen[wish->vertex] = true;
    c->missed[wish->at->vertex] = false;
    for (int y = wish->at->y - reach; y <= wish->at->y + reach; y++)
        for (int x = wish->at->x - reach; x <= wish->at->x + reach; x++)
            if (abs(x) + abs(y) <= n && (y >= 0 || lattice.octants == 4))
                c->missed[vertex_index(lattice, x, y)] = false;
}

/* Adds details for the missed vertices, those that gain most first. */
static void add_for_missed(Chooser *c, int first, int last, Arena scratch) {
    Wish *wishes = ARENA_NEW(&scratch, Wish, c->count);
    uint32_t count = 0;
    for (int i = c->base_level; i < c->options->lattice.level; i++)
        for (uint32_t e = 0; e < c->edge_count[i]; e++)
            if (c->missed[c->edges[i][e].vertex]) {
                Wish wish = best_around(c, &c->edges[i][e], i, first, last);
                if (wish.gain > 0) wishes[count++] = wish;
            }
    qsort(wishes, count, sizeof *wishes, by_gain);
    for (uint32_t i = 0; i < count; i++)
        if (c->missed[wishes[i].at->vertex]) grant(c, &wishes[i]);
}

/* Adds details until nearly all is accepted: the coder corrects the rest with details of its
 * own. Returns about how many details that makes. */
static uint32_t mend(Chooser *c, Arena scratch) {
    uint32_t missed = 0;
    for (int round = 0; round < MENDS; round++) {
        fit(c);
        missed = find_missed(c);
        if (missed * 64 <= count_chosen(c)) break;
        if (round % 2) /* heavier weights first */
            add_for_missed(c, c->base_level, c->options->lattice.level, scratch);
    }
    return count_chosen(c) + 2 * missed;
}

/* ---- dropping ---------------------------------------------------------------------------- */

typedef struct Loss {
    uint32_t vertex;
    float loss;
} Loss;

static int by_loss(const void *a, const void *b) {
    const Loss *x = a, *y = b;
    if (x->loss != y->loss) return x->loss < y->loss ? -1 : 1;
    return x->vertex < y->vertex ? -1 : 1;
}

/* Drops the share of the chosen details that cost the least. */
static void drop_least(Chooser *c, float share, Arena scratch) {
    Loss *loss = ARENA_NEW(&scratch, Loss, c->count);
    uint32_t count = 0;
    for (int i = c->base_level; i < c->options->lattice.level; i++)
        for (uint32_t e = 0; e < c->edge_count[i]; e++) {
            uint32_t v = c->edges[i][e].vertex;
            float sum = 0;
            if (!c->chosen[v]) continue;
            for (int j = 0; j < c->k; j++) {
                float d = *component(c->group[j / 4].detail, v, j) / c->unit[j];
                sum += d * d;
            }
            loss[count++] = (Loss){v, sum * c->diagonal[v]};
        }
    qsort(loss, count, sizeof *loss, by_loss);
    for (uint32_t i = 0; i < (uint32_t)(share * (float)count); i++) {
        c->chosen[loss[i].vertex] = false;
        for (int j = 0; j < c->group_count; j++)
            c->group[j].detail[loss[i].vertex] = (Four){0, 0, 0, 0};
    }
}

static Chooser start(VertexJudge *judge, int base_level, Arena *arena) {
    const VertexTreeOptions *options = judge->options;
    size_t n = vertex_count(options->lattice), k = (size_t)options->components;
    Chooser c = {.options = options,
                 .values = judge->values,
                 .unit = judge->unit,
                 .judge = judge,
                 .base_level = base_level,
                 .k = options->components,
                 .count = (uint32_t)n};
    for (int i = base_level; i < options->lattice.level; i++) {
        c.edge_count[i] = vertex_edges(options->lattice, i, NULL);
        c.edges[i] = ARENA_NEW(arena, VertexEdge, c.edge_count[i]);
        vertex_edges(options->lattice, i, c.edges[i]);
    }
    c.chosen = ARENA_NEW(arena, bool, n);
    c.missed = ARENA_NEW(arena, bool, n);
    c.list = ARENA_NEW(arena, uint32_t, n);
    c.weight = ARENA_NEW(arena, float, n);
    c.diagonal = ARENA_NEW(arena, float, n);
    c.group_count = (c.k + 3) / 4;
    c.group = ARENA_NEW(arena, Group, c.group_count);
    for (int i = 0; i < c.group_count; i++) {
        Group *g = &c.group[i];
        Four **rows[] = {&g->value,     &g->detail,  &g->fitted,  &g->rest,
                         &g->direction, &g->product, &g->gradient};
        for (size_t r = 0; r < sizeof rows / sizeof *rows; r++)
            *rows[r] = arena_alloc(arena, sizeof(Four), sizeof(Four), n);
    }
    for (size_t v = 0; v < n; v++)
        for (size_t j = 0; j < k; j++)
            *component(c.group[j / 4].value, (uint32_t)v, (int)j) = c.values[v * k + j];
    for (size_t v = 0; v < n; v++) c.weight[v] = 1;
    int side = 1 << options->lattice.level, spacing = side >> base_level;
    for (int y = options->lattice.octants == 2 ? 0 : -side; y <= side; y += spacing)
        for (int x = abs(y) - side; x <= side - abs(y); x += spacing) {
            size_t v = vertex_index(options->lattice, x, y);
            c.chosen[v] = true;
            for (int i = 0; i < c.group_count; i++) c.group[i].detail[v] = c.group[i].value[v];
        }
    return c;
}

/* Saves a round's choice to return to. Missed vertices keep their own values. */
static void keep(const Chooser *c, VertexChoice *out) {
    size_t k = (size_t)c->k;
    memcpy(out->chosen, c->chosen, c->count * sizeof *out->chosen);
    for (size_t v = 0; v < c->count; v++)
        if (c->missed[v]) memcpy(out->target + v * k, c->values + v * k, k * sizeof(float));
        else fitted_row(c, (uint32_t)v, out->target + v * k);
}

void vertex_choose(VertexJudge *judge, int base_level, Arena scratch, VertexChoice *out) {
    Chooser c = start(judge, base_level, &scratch);
    for (int i = base_level; i < judge->options->lattice.level; i++) {
        fit(&c);
        if (find_missed(&c) == 0) break;
        add_for_missed(&c, i, i + 1, scratch);
    }
    uint32_t best = mend(&c, scratch);
    keep(&c, out);
    for (float share = 0.25f; share > 0.03f;) {
        drop_least(&c, share, scratch);
        uint32_t now = mend(&c, scratch);
        bool better = now < best;
        if (now >= best - best / 25) share *= 0.5f;
        if (!better) continue;
        keep(&c, out);
        best = now;
    }
}
