/* SPDX-License-Identifier: Apache-2.0 */
#include "hemisphere/tree/vertex_tree_build.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mathd.h"
#include "hemisphere/tree/vertex.h"
#include "hemisphere/tree/vertex_choose.h"
#include "hemisphere/tree/vertex_code.h"
#include "hemisphere/tree/vertex_open.h"

/* ---- the closed loop --------------------------------------------------------------------- */

typedef struct Coder {
    const VertexTreeOptions *options;
    const float *values;
    VertexCode code;
    VertexChoice choice;
    VertexJudge judge;
    float *rebuilt;   /* vertices x components */
    float *step;      /* of each component, before exponents */
    float *tolerance; /* of each component */
} Coder;

/* The shortest blob so far. */
typedef struct Trial {
    size_t size;     /* 0: none */
    uint32_t stored; /* vertices */
    char *blob;
    int base_level;
    float coarseness;
    Arena scratch; /* for one trial at a time */
} Trial;

#define FIRST_BASE 1
#define LAST_BASE 3

static bool accepts(Coder *c, uint32_t vertex, const float *reconstructed) {
    return vertex_accepts(&c->judge, vertex, reconstructed);
}

/* prediction + factor * step * integers */
static void rebuild(const Coder *c, const float *prediction, const int16_t *integers, float factor,
                    float *out) {
    for (int i = 0; i < c->code.components; i++)
        out[i] = prediction[i] + c->step[i] * (factor * (float)integers[i]);
}

/* The integers nearest to a value; false: one is too large. */
static bool round_detail(const Coder *c, const float *value, const float *prediction, float factor,
                         int16_t *integers) {
    for (int i = 0; i < c->code.components; i++) {
        float q = rintf((value[i] - prediction[i]) / (factor * c->step[i]));
        if (!(fabsf(q) < VERTEX_MOST)) return false;
        integers[i] = (int16_t)q;
    }
    return true;
}

/* Looks for an accepted row among those that differ by 1 in one component. */
static bool search_near(Coder *c, uint32_t vertex, const float *prediction, float factor,
                        int16_t *integers) {
    float *out = c->rebuilt + vertex * (size_t)c->code.components;
    for (int i = 0; i < 2 * c->code.components; i++) {
        int16_t *at = &integers[i / 2], kept = *at;
        *at = (int16_t)(kept + (i % 2 ? 1 : -1));
        rebuild(c, prediction, integers, factor, out);
        if (accepts(c, vertex, out)) return true;
        *at = kept;
    }
    return false;
}

/* Stores a vertex as prediction plus integers: of its target; where rounding leaves what is
 * accepted, of its value. False: not even neighbours are accepted. */
static bool store(Coder *c, uint32_t vertex, const float *prediction, float factor) {
    size_t k = (size_t)c->code.components;
    int16_t *integers = c->code.integers + vertex * k;
    c->code.stored[vertex] = true;
    const float *wanted[2] = {c->choice.target + vertex * k, c->values + vertex * k};
    for (int i = 0; i < 2; i++) {
        if (!round_detail(c, wanted[i], prediction, factor, integers)) return false;
        rebuild(c, prediction, integers, factor, c->rebuilt + vertex * k);
        if (accepts(c, vertex, c->rebuilt + vertex * k) ||
            search_near(c, vertex, prediction, factor, integers))
            return true;
    }
    return false;
}

/* All new vertices of a level with one exponent. The first vertex that cannot be stored so
 * is left in *failed. */
static bool code_level(Coder *c, const VertexEdge *edges, uint32_t count, int exponent,
                       uint32_t *failed) {
    size_t k = (size_t)c->code.components;
    float prediction[TREE_MAX_COMPONENTS], factor = ldexpf(1, exponent);
    for (uint32_t i = 0; i < count; i++) {
        const VertexEdge *e = &edges[i];
        const float *u = c->rebuilt + e->end[0] * k, *w = c->rebuilt + e->end[1] * k;
        for (size_t j = 0; j < k; j++) prediction[j] = 0.5f * (u[j] + w[j]);
        c->code.stored[e->vertex] = false;
        memcpy(c->rebuilt + e->vertex * k, prediction, k * sizeof *prediction);
        if (!c->choice.chosen[e->vertex] && accepts(c, e->vertex, prediction)) continue;
        *failed = e->vertex;
        if (!store(c, e->vertex, prediction, factor)) return false;
    }
    return true;
}

static bool refuse_vertex(const Coder *c, uint32_t vertex, Error *err) {
    VertexLattice lattice = c->code.lattice;
    int n = 1 << lattice.level, x = 0, y = lattice.octants == 2 ? 0 : -n;
    while (vertex_index(lattice, n - abs(y), y) < vertex) y++;
    x = (int)(vertex - vertex_index(lattice, 0, y));
    Vec3 d = vertex_direction(lattice, x, y);
    double degrees = 57.29577951308232;
    return error_set(err, ERROR_INPUT,
                     "vertex tree: no stored value is accepted at theta %.2f deg, phi %.2f deg",
                     degrees * atan2_d(hypot_d((double)d.x, (double)d.y), (double)d.z),
                     degrees * atan2_d((double)d.y, (double)d.x));
}

#define LEAST_EXPONENT (-12)

static bool code_levels(Coder *c, Arena scratch, Error *err) {
    for (int i = c->code.base_level; i < c->code.lattice.level; i++) {
        Arena inner = scratch;
        uint32_t count = vertex_edges(c->code.lattice, i, NULL), failed = 0;
        VertexEdge *edges = ARENA_NEW(&inner, VertexEdge, count);
        int exponent = 0;
        vertex_edges(c->code.lattice, i, edges);
        while (!code_level(c, edges, count, exponent, &failed))
            if (--exponent < LEAST_EXPONENT) return refuse_vertex(c, failed, err);
        c->code.exponent[i - c->code.base_level] = exponent;
    }
    return true;
}

static bool code_base_with(Coder *c, int exponent, uint32_t *failed) {
    VertexLattice lattice = c->code.lattice;
    int n = 1 << lattice.level, spacing = n >> c->code.base_level;
    float zero[TREE_MAX_COMPONENTS] = {0};
    for (int y = lattice.octants == 2 ? 0 : -n; y <= n; y += spacing)
        for (int x = abs(y) - n; x <= n - abs(y); x += spacing) {
            *failed = vertex_index(lattice, x, y);
            if (!store(c, *failed, zero, ldexpf(1, exponent))) return false;
        }
    return true;
}

/* The base level: finer steps than details have, and coarser ones where 16 bits are full. */
static bool code_base(Coder *c, Error *err) {
    uint32_t failed = 0;
    size_t k = (size_t)c->code.components, count = vertex_count(c->code.lattice) * k;
    float most = 0;
    int full = -VERTEX_MAX_EXPONENT, exponent = -1;
    for (size_t i = 0; i < count; i++)
        most = fmaxf(most, fabsf(c->choice.target[i]) / c->step[i % k]);
    while (full < VERTEX_MAX_EXPONENT && most / ldexpf(1, full) > VERTEX_MOST - 1) full++;
    if (exponent < full) exponent = full;
    while (!code_base_with(c, exponent, &failed))
        if (--exponent < full) return refuse_vertex(c, failed, err);
    c->code.base_exponent = exponent;
    return true;
}

/* ---- steps ------------------------------------------------------------------------------- */

/* How far component i of a vertex may be off, within a factor of 1.2; at most `most`. */
static float tolerance_at(Coder *c, uint32_t vertex, int i, float most) {
    float row[TREE_MAX_COMPONENTS];
    memcpy(row, c->values + vertex * (size_t)c->code.components,
           (size_t)c->code.components * sizeof *row);
    float value = row[i], low = most * 1e-7f, high = most;
    while (high > 1.2f * low) {
        float middle = sqrtf(low * high);
        row[i] = value + middle;
        bool fits = accepts(c, vertex, row);
        row[i] = value - middle;
        fits = fits && accepts(c, vertex, row);
        low = fits ? middle : low;
        high = fits ? high : middle;
    }
    return low;
}

#define PROBES 256 /* vertices whose tolerance is measured */

/* tolerance[i]: the least of component i over some vertices. */
static void measure_tolerances(Coder *c, float *tolerance) {
    uint32_t count = vertex_count(c->code.lattice), stride = count / PROBES | 1;
    size_t k = (size_t)c->code.components;
    for (int i = 0; i < c->code.components; i++) {
        float most = 0;
        for (uint32_t v = 0; v < count; v++)
            most = fmaxf(most, fabsf(c->values[v * k + (size_t)i]));
        tolerance[i] = most > 0 ? most : 1;
        for (uint32_t v = 0; v < count && most > 0; v += stride)
            tolerance[i] = fminf(tolerance[i], tolerance_at(c, v, i, most));
    }
}

static bool check_options(const VertexTreeOptions *o, const float *values, Error *err) {
    if (o->lattice.level < 0 || o->lattice.level >= GEODESIC_MAX_LEVEL)
        return error_set(err, ERROR_INPUT, "vertex tree: level %d, required: 0 to %d",
                         o->lattice.level, GEODESIC_MAX_LEVEL - 1);
    if (o->lattice.octants != 2 && o->lattice.octants != 4)
        return error_set(err, ERROR_INPUT, "vertex tree: %d octants, required: 2 or 4",
                         o->lattice.octants);
    if (o->components < 1 || o->components > TREE_MAX_COMPONENTS)
        return error_set(err, ERROR_INPUT, "vertex tree: %d components, required: 1 to %d",
                         o->components, TREE_MAX_COMPONENTS);
    size_t count = vertex_count(o->lattice) * (size_t)o->components;
    for (size_t i = 0; i < count; i++)
        if (!(fabsf(values[i]) <= 1e15f))
            return error_set(err, ERROR_INPUT,
                             "vertex tree: value %zu is %g, required: a number within 1e15", i,
                             (double)values[i]);
    return true;
}

static Coder make_coder(const VertexTreeOptions *options, const float *values, Arena *arena) {
    size_t count = vertex_count(options->lattice), k = (size_t)options->components;
    Coder c = {.options = options,
               .values = values,
               .code = {.lattice = options->lattice, .components = options->components},
               .rebuilt = ARENA_NEW(arena, float, count *k),
               .step = ARENA_NEW(arena, float, k),
               .tolerance = ARENA_NEW(arena, float, k)};
    c.judge = (VertexJudge){options, values, c.tolerance, ARENA_NEW(arena, float, count), true};
    c.choice.chosen = ARENA_NEW(arena, bool, count);
    c.choice.target = ARENA_NEW(arena, float, count *k);
    c.code.scale = c.step;
    c.code.integers = ARENA_NEW(arena, int16_t, count *k);
    c.code.stored = ARENA_NEW(arena, bool, count);
    return c;
}

/* Every vertex of a finished tree as a query sees it; rebuilt: their values. Those that are not
 * accepted are evaluated every time from now on, *wrong is one of them; how many. */
static uint32_t count_wrong(Coder *c, const Trial *best, float *rebuilt, uint32_t *wrong) {
    VertexLattice lattice = c->code.lattice;
    Arena scratch = best->scratch;
    const Geodesic *geodesic = geodesic_create(vertex_plane_level(lattice.level), &scratch);
    uint32_t count = 0;
    Tree tree;
    Error err;
    if (!vertex_tree_open(best->blob, best->size, geodesic, &scratch, &tree, &err)) abort();
    vertex_tree_expand(&tree, rebuilt);
    for (uint32_t v = 0; v < vertex_count(lattice); v++) {
        if (c->options->accepts(c->options->context, v, rebuilt + v * (size_t)c->code.components))
            continue;
        c->judge.safe[v] = -1;
        *wrong = v;
        count++;
    }
    return count;
}

static uint32_t count_stored(const Coder *c) {
    uint32_t sum = 0;
    for (uint32_t v = 0; v < vertex_count(c->code.lattice); v++) sum += c->code.stored[v];
    return sum;
}

/* One way to code the choice: if shorter than best->size, it replaces the blob. False, with
 * the reason in *err: not possible. */
static bool try_coding(Coder *c, int base_level, float coarseness, Trial *best, Error *err) {
    Arena scratch = best->scratch;
    c->code.base_level = base_level;
    for (int i = 0; i < c->code.components; i++) {
        c->step[i] = coarseness * c->tolerance[i];
        if (c->options->coarsest_step) c->step[i] = fminf(c->step[i], c->options->coarsest_step[i]);
    }
    if (!code_base(c, err) || !code_levels(c, scratch, err)) return false;
    size_t size;
    const void *blob = vertex_encode(&c->code, &scratch, &size);
    if (best->size != 0 && size >= best->size) return true;
    best->size = size;
    best->stored = count_stored(c);
    best->base_level = base_level;
    best->coarseness = coarseness;
    memcpy(best->blob, blob, size);
    return true;
}

/* Steps from coarse to fine, then larger bases where these cost little: each is one level less
 * to walk through. */
static bool code_best(Coder *c, Trial *best, Error *err) {
    static const float coarseness[] = {2, 1.2f, 0.7f, 0.4f, 0.2f};
    int first = c->code.lattice.level < FIRST_BASE ? c->code.lattice.level : FIRST_BASE;
    for (size_t i = 0; i < sizeof coarseness / sizeof *coarseness; i++)
        try_coding(c, first, coarseness[i], best, err);
    if (best->size == 0) return false;
    size_t least = best->size;
    for (int base = first + 1; base <= LAST_BASE && base <= c->code.lattice.level; base++) {
        size_t so_far = best->size, most = least + least / 12;
        best->size = most;
        try_coding(c, base, best->coarseness, best, err);
        if (best->size == most) best->size = so_far;
        if (best->size < least) least = best->size;
    }
    return true;
}

static void fill_report(const Coder *c, const float *rebuilt, const Trial *best,
                        TreeReport *report) {
    uint32_t count = vertex_count(c->code.lattice);
    size_t numbers = count * (size_t)c->code.components;
    double error_square = 0, most = 0;
    for (size_t i = 0; i < numbers; i++) {
        double error = (double)rebuilt[i] - (double)c->values[i];
        error_square += error * error;
        most = fmax(most, fabs(error));
    }
    *report = (TreeReport){.leaves = count,
                           .stored_rows = best->stored,
                           .stored_values = best->stored * (size_t)c->code.components,
                           .bytes = best->size,
                           .max_error = (float)most,
                           .rms_error = (float)sqrt(error_square / (double)numbers)};
}

bool vertex_tree_build(const VertexTreeOptions *options, const float *values, Arena *arena,
                       const void **blob, TreeReport *report, Error *err) {
    if (!check_options(options, values, err)) return false;
    size_t numbers = vertex_count(options->lattice) * (size_t)options->components;
    Arena scratch = *arena; /* behind the blob's room */
    size_t room = 4 * numbers + 300 * vertex_count(options->lattice) + ((size_t)1 << 20);
    arena_alloc(&scratch, 1, 16, room);
    Coder c = make_coder(options, values, &scratch);
    float *rebuilt = ARENA_NEW(&scratch, float, numbers);
    Trial best = {.blob = arena_alloc(&scratch, 1, 16, room)};
    best.scratch = scratch;
    measure_tolerances(&c, c.tolerance);
    int base = options->lattice.level < FIRST_BASE ? options->lattice.level : FIRST_BASE;
    c.judge.is_exact = false;
    vertex_choose(&c.judge, base, scratch, &c.choice);
    if (!code_best(&c, &best, err)) return false;
    uint32_t wrong;
    for (int i = 0; count_wrong(&c, &best, rebuilt, &wrong) > 0; i++) {
        best.size = 0;
        c.judge.is_exact = i >= 2;
        if (i == 4) return refuse_vertex(&c, wrong, err);
        if (!try_coding(&c, best.base_level, best.coarseness, &best, err)) return false;
    }
    char *kept = arena_alloc(arena, 1, 16, best.size);
    memcpy(kept, best.blob, best.size);
    *blob = kept;
    if (report) fill_report(&c, rebuilt, &best, report);
    return true;
}
