#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "hemisphere/vertex_code.h"
#include "hemisphere/vertex_view.h"

/* ---- edges ------------------------------------------------------------------------------- */

uint32_t vertex_edges(VertexLattice lattice, int level, VertexEdge *edges)
{
    int      n = 1 << lattice.level, half = n >> (level + 1);
    uint32_t count = 0;
    for (int y = lattice.octants == 2 ? 0 : -n; y <= n; y += half)
        for (int x = abs(y) - n; x <= n - abs(y); x += half) {
            int dx = x & half ? half : 0, dy = y & half ? half : 0;
            if (!dx && !dy) continue;
            uint32_t cell_edge = dx && dy ? 2u : dx ? 0u : 1u;
            if (cell_edge == 2 && (x < 0) == (y < 0)) dy = -dy;
            if (edges)
                edges[count] = (VertexEdge){x, y, vertex_index(lattice, x, y),
                                            {vertex_index(lattice, x - dx, y - dy),
                                             vertex_index(lattice, x + dx, y + dy)},
                                            cell_edge};
            count++;
        }
    return count;
}

/* ---- the closed loop --------------------------------------------------------------------- */

typedef struct Coder {
    const VertexTreeOptions *options;
    const float             *values;
    VertexCode               code;
    float                   *rebuilt; /* vertices x components */
    float                   *step;    /* of each component, before exponents */
} Coder;

static const float *value_of(const Coder *c, uint32_t vertex)
{
    return c->values + vertex * (size_t)c->code.components;
}

static bool accepts(const Coder *c, uint32_t vertex, const float *reconstructed)
{
    return c->options->accepts(c->options->context, vertex, reconstructed);
}

/* prediction + factor * step * integers */
static void rebuild(const Coder *c, const float *prediction, const int16_t *integers,
                    float factor, float *out)
{
    for (int i = 0; i < c->code.components; i++)
        out[i] = prediction[i] + c->step[i] * (factor * (float)integers[i]);
}

/* The nearest integers; false: one is too large. */
static bool round_detail(const Coder *c, uint32_t vertex, const float *prediction, float factor,
                         int16_t *integers)
{
    const float *value = value_of(c, vertex);
    for (int i = 0; i < c->code.components; i++) {
        float q = rintf((value[i] - prediction[i]) / (factor * c->step[i]));
        if (!(fabsf(q) < VERTEX_MOST)) return false;
        integers[i] = (int16_t)q;
    }
    return true;
}

/* Looks for an accepted row among those that differ by 1 in one component. */
static bool search_near(const Coder *c, uint32_t vertex, const float *prediction, float factor,
                        int16_t *integers)
{
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

/* Stores a vertex as prediction plus integers; false: not even neighbours are accepted. */
static bool store(Coder *c, uint32_t vertex, const float *prediction, float factor)
{
    size_t   k = (size_t)c->code.components;
    int16_t *integers = c->code.integers + vertex * k;
    c->code.stored[vertex] = true;
    if (!round_detail(c, vertex, prediction, factor, integers)) return false;
    rebuild(c, prediction, integers, factor, c->rebuilt + vertex * k);
    return accepts(c, vertex, c->rebuilt + vertex * k) ||
           search_near(c, vertex, prediction, factor, integers);
}

/* All new vertices of a level with one exponent. The first vertex that cannot be stored so
 * is left in *failed. */
static bool code_level(Coder *c, const VertexEdge *edges, uint32_t count, int exponent,
                       uint32_t *failed)
{
    size_t k = (size_t)c->code.components;
    float  prediction[TREE_MAX_COMPONENTS], factor = ldexpf(1, exponent);
    for (uint32_t i = 0; i < count; i++) {
        const VertexEdge *e = &edges[i];
        const float *u = c->rebuilt + e->end[0] * k, *w = c->rebuilt + e->end[1] * k;
        for (size_t j = 0; j < k; j++) prediction[j] = 0.5f * (u[j] + w[j]);
        c->code.stored[e->vertex] = false;
        memcpy(c->rebuilt + e->vertex * k, prediction, k * sizeof *prediction);
        if (accepts(c, e->vertex, prediction)) continue;
        *failed = e->vertex;
        if (!store(c, e->vertex, prediction, factor)) return false;
    }
    return true;
}

static bool refuse_vertex(const Coder *c, uint32_t vertex, Error *err)
{
    VertexLattice lattice = c->code.lattice;
    int           n = 1 << lattice.level, x = 0, y = lattice.octants == 2 ? 0 : -n;
    while (vertex_index(lattice, n - abs(y), y) < vertex) y++;
    x = (int)(vertex - vertex_index(lattice, 0, y));
    Vec3   d = vertex_direction(lattice, x, y);
    double degrees = 57.29577951308232;
    return error_set(err, ERROR_INPUT,
                     "vertex tree: no stored value is accepted at theta %.2f deg, phi %.2f deg",
                     degrees * atan2(hypot((double)d.x, (double)d.y), (double)d.z),
                     degrees * atan2((double)d.y, (double)d.x));
}

#define LEAST_EXPONENT (-12)

static bool code_levels(Coder *c, Arena scratch, Error *err)
{
    for (int i = c->code.base_level; i < c->code.lattice.level; i++) {
        Arena       inner = scratch;
        uint32_t    count = vertex_edges(c->code.lattice, i, NULL), failed = 0;
        VertexEdge *edges = ARENA_NEW(&inner, VertexEdge, count);
        int         exponent = 0;
        vertex_edges(c->code.lattice, i, edges);
        while (!code_level(c, edges, count, exponent, &failed))
            if (--exponent < LEAST_EXPONENT) return refuse_vertex(c, failed, err);
        c->code.exponent[i - c->code.base_level] = exponent;
    }
    return true;
}

/* The base level's values with the finest exponent that 16 bits allow. */
static bool code_base(Coder *c, Error *err)
{
    VertexLattice lattice = c->code.lattice;
    int    n = 1 << lattice.level, spacing = n >> c->code.base_level;
    size_t k = (size_t)c->code.components;
    float  most = 0, zero[TREE_MAX_COMPONENTS] = {0};
    for (size_t i = 0; i < vertex_count(lattice) * k; i++)
        most = fmaxf(most, fabsf(c->values[i]) / c->step[i % k]);
    int exponent = -8;
    while (exponent < VERTEX_MAX_EXPONENT && most / ldexpf(1, exponent) > VERTEX_MOST - 1) exponent++;
    c->code.base_exponent = exponent;
    for (int y = lattice.octants == 2 ? 0 : -n; y <= n; y += spacing)
        for (int x = abs(y) - n; x <= n - abs(y); x += spacing) {
            uint32_t vertex = vertex_index(lattice, x, y);
            if (!store(c, vertex, zero, ldexpf(1, exponent)))
                return refuse_vertex(c, vertex, err);
        }
    return true;
}

/* ---- steps ------------------------------------------------------------------------------- */

/* How far component i of a vertex may be off, within a factor of 1.2; at most `most`. */
static float tolerance_at(const Coder *c, uint32_t vertex, int i, float most)
{
    float row[TREE_MAX_COMPONENTS];
    memcpy(row, value_of(c, vertex), (size_t)c->code.components * sizeof *row);
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
static void measure_tolerances(const Coder *c, float *tolerance)
{
    uint32_t count = vertex_count(c->code.lattice), stride = count / PROBES | 1;
    size_t   k = (size_t)c->code.components;
    for (int i = 0; i < c->code.components; i++) {
        float most = 0;
        for (uint32_t v = 0; v < count; v++)
            most = fmaxf(most, fabsf(c->values[v * k + (size_t)i]));
        tolerance[i] = most > 0 ? most : 1;
        for (uint32_t v = 0; v < count && most > 0; v += stride)
            tolerance[i] = fminf(tolerance[i], tolerance_at(c, v, i, most));
    }
}

/* ---- the whole --------------------------------------------------------------------------- */

static bool check_options(const VertexTreeOptions *o, const float *values, Error *err)
{
    if (o->lattice.level < 0 || o->lattice.level >= GEODESIC_MAX_LEVEL)
        return error_set(err, ERROR_INPUT, "vertex tree: level %d, wanted 0 to %d",
                         o->lattice.level, GEODESIC_MAX_LEVEL - 1);
    if (o->lattice.octants != 2 && o->lattice.octants != 4)
        return error_set(err, ERROR_INPUT, "vertex tree: %d octants, wanted 2 or 4",
                         o->lattice.octants);
    if (o->components < 1 || o->components > TREE_MAX_COMPONENTS)
        return error_set(err, ERROR_INPUT, "vertex tree: %d components, wanted 1 to %d",
                         o->components, TREE_MAX_COMPONENTS);
    size_t count = vertex_count(o->lattice) * (size_t)o->components;
    for (size_t i = 0; i < count; i++)
        if (!(fabsf(values[i]) <= 1e15f))
            return error_set(err, ERROR_INPUT,
                             "vertex tree: value %zu is %g, wanted a number within 1e15", i,
                             (double)values[i]);
    return true;
}

static Coder make_coder(const VertexTreeOptions *options, const float *values, Arena *arena)
{
    size_t count = vertex_count(options->lattice), k = (size_t)options->components;
    Coder  c = {.options = options,
                .values = values,
                .code = {.lattice = options->lattice, .components = options->components},
                .rebuilt = ARENA_NEW(arena, float, count * k),
                .step = ARENA_NEW(arena, float, k)};
    c.code.scale = c.step;
    c.code.integers = ARENA_NEW(arena, int16_t, count * k);
    c.code.stored = ARENA_NEW(arena, bool, count);
    return c;
}

/* Every vertex of a finished tree as a query sees it; rebuilt: their values. */
static bool verify(const Coder *c, const void *blob, size_t size, float *rebuilt, Arena scratch,
                   Error *err)
{
    VertexLattice   lattice = c->code.lattice;
    const Geodesic *geodesic = geodesic_create(vertex_plane_level(lattice.level), &scratch);
    Tree            tree;
    if (!tree_open(blob, size, geodesic, &tree, err)) return false;
    vertex_tree_expand(&tree, rebuilt);
    for (uint32_t v = 0; v < vertex_count(lattice); v++)
        if (!accepts(c, v, rebuilt + v * (size_t)c->code.components))
            return refuse_vertex(c, v, err);
    return true;
}

static bool code_all(Coder *c, Arena scratch, Error *err)
{
    return code_base(c, err) && code_levels(c, scratch, err);
}

static void fill_report(const Coder *c, const float *rebuilt, size_t size, TreeReport *report)
{
    uint32_t count = vertex_count(c->code.lattice), stored = 0;
    size_t   numbers = count * (size_t)c->code.components;
    double   square = 0, error_square = 0, most = 0;
    for (uint32_t v = 0; v < count; v++) stored += c->code.stored[v];
    for (size_t i = 0; i < numbers; i++) {
        double error = (double)rebuilt[i] - (double)c->values[i];
        square += (double)c->values[i] * (double)c->values[i];
        error_square += error * error;
        most = fmax(most, fabs(error));
    }
    *report = (TreeReport){.leaves = count,
                           .stored_rows = stored,
                           .stored_values = stored * (size_t)c->code.components,
                           .bytes = size,
                           .source_bytes = numbers * sizeof(float),
                           .max_error = (float)most,
                           .rms_error = (float)sqrt(error_square / (double)numbers),
                           .relative_l2 =
                               square > 0 ? (float)sqrt(error_square / square) : 0.0f};
}

bool vertex_tree_build(const VertexTreeOptions *options, const float *values, Arena *arena,
                       const void **blob, TreeReport *report, Error *err)
{
    if (!check_options(options, values, err)) return false;
    size_t numbers = vertex_count(options->lattice) * (size_t)options->components;
    Arena  scratch = *arena; /* behind the blob's room */
    arena_alloc(&scratch, 1, 16, numbers * 2 + 16 * numbers + ((size_t)1 << 19));
    Coder  c = make_coder(options, values, &scratch);
    measure_tolerances(&c, c.step);
    for (int i = 0; i < options->components; i++) {
        if (options->coarsest_step) c.step[i] = fminf(c.step[i], options->coarsest_step[i]);
    }
    c.code.base_level = options->lattice.level < 2 ? options->lattice.level : 2;
    size_t      size;
    float      *rebuilt = ARENA_NEW(&scratch, float, numbers);
    if (!code_all(&c, scratch, err)) return false;
    const void *out = vertex_code_write(&c.code, &scratch, &size);
    if (!verify(&c, out, size, rebuilt, scratch, err)) return false;
    char *kept = arena_alloc(arena, 1, 16, size);
    memcpy(kept, out, size);
    *blob = kept;
    if (report) fill_report(&c, rebuilt, size, report);
    return true;
}
