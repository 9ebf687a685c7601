/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/emission/emission_tree.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "base/mathf.h"
#include "base/units.h"
#include "hemisphere/tree/haar_tree.h"
#include "hemisphere/tree/tree_open.h"
#include "hemisphere/tree/tree_query.h"
#include "hemisphere/tree/vertex.h"
#include "hemisphere/tree/vertex_tree.h"
#include "hemisphere/tree/vertex_tree_build.h"
#include "panel/fit/common/direction_grid.h"
#include "panel/fit/common/scatter_surface.h"
#include "panel/fit/emission/emission_between.h"

#define LEVEL_MOST 9
#define SWEEPS 20          /* corrections of vertices by the samples around */
#define LEAST_WEIGHT 0.05f /* of the samples around a vertex */
#define SWEPT 0.4          /* of the tolerance: nearer samples are not corrected */
#define SWEPT_SIGMAS 1.0f  /* of noise besides */
#define PARDON 5.0f        /* sigmas of noise that a coded sample may miss by besides */
#define ENOUGH 1.0         /* tolerances: finer triangles are not tried */
#define FINER 0.8          /* what finer triangles must leave of the largest miss */

/* Where a tree is coded and what it is held to. */
typedef struct EmissionCoder {
    const EmissionModel *model;
    const Geodesic *geodesic;
    VertexLattice lattice;
    uint32_t vertices;
    Vec3 *direction;   /* of vertices */
    float *smooth;     /* vertices x stride: the spline there */
    float *value;      /* vertices x components: the rest */
    float *wanted;     /* vertices x channels: M in cd m^-2 */
    float *limit;      /* vertices: relative; INFINITY: anything will do */
    float *least;      /* channels: errors count relative to no less than this */
    float *work;       /* channels */
    VertexPoint *near; /* rows: the triangle around */
    double uncoded;    /* largest relative error of a row before coding, beside its noise */
    int threads;
} EmissionCoder;

/* The rest at the samples: scores less the smooth part; and what it is read from between them:
 * the cells of a grid, else (or of noisy rows) a surface for each component. */
typedef struct EmissionRest {
    float *value; /* rows x components */
    float low[PANEL_COMPONENTS_MAX], high[PANEL_COMPONENTS_MAX];
    DirectionGrid grid;
    const float *cell;
    const ScatterSurface *surface[PANEL_COMPONENTS_MAX];
} EmissionRest;

/* About how wide a triangle of a level is, radians. */
static double cell_width(int level) {
    return PI / 2 / (1 << level);
}

static bool reads_surface(const EmissionModel *model) {
    return model->is_scattered || (model->is_noisy && !model->has_edges);
}

static EmissionRest find_rest(const EmissionModel *model, Arena *arena) {
    const EmissionSamples *s = model->samples;
    int n = model->rank->components;
    EmissionRest rest = {.value = ARENA_NEW(arena, float, s->rows *n)};
    float *one = ARENA_NEW(arena, float, s->rows);
    for (int i = 0; i < s->rows; i++) {
        float components[PANEL_COMPONENTS_MAX] = {0};
        emission_model_add_smooth(model, s->direction[i], components);
        for (int k = 0; k < n; k++)
            rest.value[i * n + k] = model->rank->score[i * n + k] - components[k];
    }
    for (int k = 0; k < n; k++) {
        rest.low[k] = INFINITY, rest.high[k] = -INFINITY;
        for (int i = 0; i < s->rows; i++) {
            one[i] = rest.value[i * n + k];
            rest.low[k] = fminf(rest.low[k], one[i]);
            rest.high[k] = fmaxf(rest.high[k], one[i]);
        }
        if (reads_surface(model))
            rest.surface[k] = scatter_surface_make(s->master, false, one, 1, arena);
    }
    direction_grid_build(s->master, false, arena, &rest.grid);
    rest.cell = direction_grid_cells(&rest.grid, rest.value, n, arena);
    return rest;
}

/* ---- values at vertices ----------------------------------------------------------------- */

/* What cells or surfaces say; beyond the cone what they say at its edge. What nothing measures
 * cannot run away. */
static void read_rest(EmissionCoder *coder, const EmissionRest *rest) {
    const EmissionSamples *s = coder->model->samples;
    size_t n = (size_t)coder->model->rank->components;
    double low = cos_d(s->cone), across = sin_d(s->cone);
    bool is_surface = reads_surface(coder->model);
    for (uint32_t v = 0; v < coder->vertices; v++) {
        Vec3 d = coder->direction[v];
        double r = sqrt((double)(d.x * d.x + d.y * d.y));
        if ((double)d.z < low)
            d = vec3((float)(d.x * across / r), (float)(d.y * across / r), (float)low);
        float *to = coder->value + v * n;
        if (!is_surface) {
            GridTaps taps;
            direction_grid_taps(&rest->grid, acos_f(fminf(1, d.z)), atan2_f(d.y, d.x), &taps);
            direction_grid_read(&taps, rest->cell, (int)n, to);
        }
        for (size_t k = 0; k < n; k++) {
            if (is_surface) scatter_surface_read(rest->surface[k], d, &to[k]);
            to[k] = clampf(to[k], rest->low[k], rest->high[k]);
        }
    }
}

/* The largest relative error of a row's channels, beyond so many sigmas of noise. */
static float row_excess(const EmissionCoder *coder, int row, const float *components,
                        float sigmas) {
    const EmissionSamples *s = coder->model->samples;
    float excess = 0;
    emission_model_totals(coder->model, components, s->direction[row], coder->work);
    for (int c = 0; c < s->channels; c++) {
        size_t number = (size_t)row * (size_t)s->channels + (size_t)c;
        float m = s->total[number], sigma = s->sigma[number];
        if (isinf(sigma)) continue;
        float miss = fabsf(coder->work[c] - m) - sigmas * sigma;
        excess = fmaxf(excess, miss / fmaxf(m, coder->least[c]));
    }
    return excess;
}

/* Adds the values at a point to components. */
static void add_values(const EmissionCoder *coder, const VertexPoint *at, float *components) {
    uint32_t n = (uint32_t)coder->model->rank->components;
    for (int q = 0; q < 3; q++)
        for (uint32_t k = 0; k < n; k++)
            components[k] += at->weight[q] * coder->value[at->vertex[q] * n + k];
}

/* What vertex values leave of a row before they are coded. */
static double uncoded_error(const EmissionCoder *coder, int row, float sigmas) {
    float components[PANEL_COMPONENTS_MAX] = {0};
    emission_model_add_smooth(coder->model, coder->model->samples->direction[row], components);
    add_values(coder, &coder->near[row], components);
    return (double)row_excess(coder, row, components, sigmas);
}

/* A row's share in the correction of its three vertices, if triangles miss it. */
static void add_correction(const EmissionCoder *coder, const EmissionRest *rest, int row,
                           float *sum) {
    const VertexPoint *at = &coder->near[row];
    size_t n = (size_t)coder->model->rank->components;
    float sigmas = coder->model->is_noisy ? PARDON : SWEPT_SIGMAS;
    bool is_missed = uncoded_error(coder, row, sigmas) > SWEPT * coder->model->tolerance;
    for (int q = 0; q < 3; q++) sum[at->vertex[q] * (n + 1) + n] += at->weight[q];
    for (size_t k = 0; k < n && is_missed; k++) {
        float miss = rest->value[(size_t)row * n + k];
        for (int q = 0; q < 3; q++) miss -= at->weight[q] * coder->value[at->vertex[q] * n + k];
        for (int q = 0; q < 3; q++) sum[at->vertex[q] * (n + 1) + k] += at->weight[q] * miss;
    }
}

/* Where the surface bends faster than triangles can, or jumps, vertices go beside it until
 * triangles meet the samples: all rows at once, a vertex by the mean of those around (SIRT;
 * Gilbert, J. Theor. Biol. 36, 1972). */
static void sweep(EmissionCoder *coder, const EmissionRest *rest, Arena scratch) {
    size_t n = (size_t)coder->model->rank->components;
    size_t numbers = (size_t)coder->vertices * (n + 1);
    float *sum = ARENA_NEW(&scratch, float, numbers);
    for (int round = 0; round < SWEEPS; round++) {
        memset(sum, 0, numbers * sizeof *sum);
        for (int i = 0; i < coder->model->samples->rows; i++) add_correction(coder, rest, i, sum);
        for (uint32_t v = 0; v < coder->vertices; v++)
            for (size_t k = 0; k < n; k++)
                coder->value[v * n + k] +=
                    sum[v * (n + 1) + k] / fmaxf(LEAST_WEIGHT, sum[v * (n + 1) + n]);
    }
}

/* Vertices that samples surround stay between them. */
static void hold_between(EmissionCoder *coder, Arena scratch) {
    const EmissionModel *model = coder->model;
    size_t n = (size_t)model->rank->components;
    EmissionBetween between;
    emission_between_make(model, &scratch, &between);
    for (uint32_t v = 0; v < coder->vertices; v++) {
        float whole[PANEL_COMPONENTS_MAX] = {0}, *value = coder->value + v * n;
        emission_model_add_smooth(model, coder->direction[v], whole);
        for (size_t k = 0; k < n; k++) whole[k] += value[k];
        float before[PANEL_COMPONENTS_MAX];
        memcpy(before, whole, sizeof before);
        emission_between_hold(&between, coder->direction[v], whole);
        for (size_t k = 0; k < n; k++) value[k] += whole[k] - before[k];
    }
}

/* M and limits of all vertices. */
static void find_wanted(EmissionCoder *coder) {
    const EmissionModel *model = coder->model;
    int n = model->rank->components, stride = model->spline.stride;
    size_t channels = (size_t)model->samples->channels;
    double reach = model->samples->cone + cell_width(coder->lattice.level);
    for (uint32_t v = 0; v < coder->vertices; v++) {
        Vec3 d = coder->direction[v];
        float *smooth = coder->smooth + (size_t)v * (size_t)stride;
        float components[PANEL_COMPONENTS_MAX];
        emission_model_add_smooth(model, d, smooth);
        memcpy(components, smooth, sizeof *smooth * (size_t)stride);
        for (int k = 0; k < n; k++)
            components[k] += coder->value[(size_t)v * (size_t)n + (size_t)k];
        emission_model_totals(model, components, d, coder->wanted + v * channels);
        coder->limit[v] =
            acos_d(fmin(1, (double)d.z)) <= reach ? (float)model->tolerance : INFINITY;
    }
}

/* The level below which an error of a channel counts relative to it: about where it is noise
 * anyway, and the floor. */
static void find_least(const EmissionModel *model, float *least) {
    for (int c = 0; c < model->samples->channels; c++)
        least[c] = (float)fmax(20 * model->noise[c / 3].dim[c % 3], model->samples->floor[c]);
}

/* The coder of a level: its vertices have their values. */
static EmissionCoder start(const EmissionModel *model, const EmissionRest *rest, int level,
                           Arena *arena) {
    const EmissionSamples *s = model->samples;
    size_t n = (size_t)model->rank->components, channels = (size_t)s->channels;
    EmissionCoder coder = {.model = model,
                           .geodesic = geodesic_create(level, arena),
                           .lattice = {level, 4},
                           .near = ARENA_NEW(arena, VertexPoint, s->rows)};
    size_t count = coder.vertices = vertex_count(coder.lattice);
    coder.direction = ARENA_NEW(arena, Vec3, count);
    coder.smooth = ARENA_NEW(arena, float, count *(size_t)model->spline.stride);
    coder.value = ARENA_NEW(arena, float, count *n);
    coder.wanted = ARENA_NEW(arena, float, count *channels);
    coder.limit = ARENA_NEW(arena, float, count);
    coder.least = ARENA_NEW(arena, float, channels);
    coder.work = ARENA_NEW(arena, float, channels);
    vertex_directions(coder.lattice, coder.direction);
    find_least(model, coder.least);
    for (int i = 0; i < s->rows; i++)
        coder.near[i] = vertex_find(coder.geodesic, coder.lattice, s->direction[i]);
    read_rest(&coder, rest);
    hold_between(&coder, *arena);
    sweep(&coder, rest, *arena);
    find_wanted(&coder);
    for (int i = 0; i < s->rows; i++)
        coder.uncoded = fmax(coder.uncoded, uncoded_error(&coder, i, PARDON));
    return coder;
}

/* ---- coding ----------------------------------------------------------------------------- */

static bool is_close(const float *m, const float *wanted, const float *least, int channels,
                     float limit) {
    for (int c = 0; c < channels; c++) /* what has run away beyond the cone is nobody's wish */
        if (!(fabsf(m[c] - wanted[c]) <= limit * fmaxf(wanted[c], least[c])) && isfinite(wanted[c]))
            return false;
    return true;
}

static bool accepts(const void *context, uint32_t vertex, const float *reconstructed) {
    const EmissionCoder *coder = context;
    const EmissionModel *model = coder->model;
    int n = model->rank->components, channels = model->samples->channels;
    float components[PANEL_COMPONENTS_MAX], m[3 * EMISSION_TABLES_MAX];
    if (isinf(coder->limit[vertex])) return true;
    memcpy(components, coder->smooth + (size_t)vertex * (size_t)model->spline.stride,
           sizeof *components * (size_t)model->spline.stride);
    for (int k = 0; k < n; k++) components[k] += reconstructed[k];
    emission_model_totals(model, components, coder->direction[vertex], m);
    return is_close(m, coder->wanted + (size_t)vertex * (size_t)channels, coder->least, channels,
                    coder->limit[vertex]);
}

void emission_tree_components(const EmissionModel *model, const Tree *tree, Vec3 d,
                              float *components) {
    memset(components, 0, sizeof *components * PANEL_COMPONENTS_MAX);
    tree_interpolate(tree, d, components);
    emission_model_add_smooth(model, d, components);
}

/* How many samples the tree misses; the limits of the vertices around them are tightened. */
static int tighten(EmissionCoder *coder, const Tree *tree) {
    const EmissionModel *model = coder->model;
    const EmissionSamples *s = model->samples;
    int missed = 0;
    for (int i = 0; i < s->rows; i++) {
        float components[PANEL_COMPONENTS_MAX];
        emission_tree_components(model, tree, s->direction[i], components);
        float excess = row_excess(coder, i, components, PARDON);
        if (!(excess > (float)model->tolerance)) continue;
        missed++;
        for (int q = 0; q < 3; q++) {
            float *limit = &coder->limit[coder->near[i].vertex[q]];
            *limit = fmaxf(0.05f * (float)model->tolerance,
                           fminf(0.6f * *limit, 0.6f * (float)model->tolerance));
        }
    }
    return missed;
}

static bool code_once(EmissionCoder *coder, Arena *arena, EmissionTree *out, Tree *tree,
                      Error *err) {
    const EmissionModel *model = coder->model;
    VertexTreeOptions options = {coder->lattice, model->rank->components, accepts, coder,
                                 model->step,    coder->threads};
    return (vertex_tree_build(&options, coder->value, arena, &out->bytes, &out->report, err) &&
            tree_open(out->bytes, tree_size(out->bytes), coder->geodesic, arena, tree, err)) ||
           error_prefix(err, "emission");
}

#define LOOSER 2.0f
#define ROUNDS 10
#define ATTEMPTS 10
#define HORIZON 0.01f /* cosine: nobody measures along the panel */

/* Loosens limits until the coder succeeds: none along the panel, twice as wide elsewhere. */
static bool code_first(EmissionCoder *coder, Arena *arena, EmissionTree *out, Tree *tree,
                       Error *err) {
    Error unheard;
    if (code_once(coder, arena, out, tree, &unheard)) return true;
    for (int attempt = 0; attempt < ATTEMPTS; attempt++) {
        for (uint32_t v = 0; v < coder->vertices; v++)
            coder->limit[v] = coder->direction[v].z < HORIZON ? INFINITY : LOOSER * coder->limit[v];
        if (code_once(coder, arena, out, tree, &unheard)) return true;
    }
    return error_set(err, ERROR_INPUT,
                     "emission: the tables cannot be kept within %.2g %%: "
                     "ask for a looser bound (--max-error) or a coarser tree (--level)",
                     100 * coder->model->tolerance);
}

/* Codes, checks all samples, tightens around those that it misses, and codes again. */
static bool code_tree(EmissionCoder *coder, Arena *arena, EmissionTree *out, Error *err) {
    int before = INT32_MAX;
    Tree tree;
    Error unheard;
    for (int round = 0; round < ROUNDS; round++) {
        const void *good = out->bytes;
        if (!round && !code_first(coder, arena, out, &tree, err)) return false;
        if (round && !code_once(coder, arena, out, &tree, &unheard)) {
            out->bytes = good; /* finer than the coder can: the last one stands */
            return true;
        }
        out->missed = tighten(coder, &tree);
        if (out->missed == 0 || (round > 3 && out->missed >= before)) return true;
        before = out->missed;
    }
    return true;
}

/* ---- Haar ------------------------------------------------------------------------------ */

/* The same function as means over triangles. */
static bool code_haar(const EmissionCoder *coder, const FitOptions *options, Arena *arena,
                      EmissionTree *out, Error *err) {
    const EmissionModel *model = coder->model;
    int n = model->rank->components, level = coder->lattice.level;
    size_t leaves = geodesic_count(level);
    float *values = ARENA_NEW(arena, float, leaves *(size_t)n), scale[PANEL_COMPONENTS_MAX];
    for (size_t i = 0; i < leaves; i++) {
        VertexPoint at =
            vertex_find(coder->geodesic, coder->lattice, geodesic_center(level, (uint32_t)i));
        add_values(coder, &at, values + i * (size_t)n);
    }
    for (int k = 0; k < n; k++) {
        scale[k] = 1e-6f;
        for (int c = 0; c < model->samples->channels; c++)
            scale[k] = fmaxf(scale[k], fabsf(model->rank->loading[c * n + k]));
    }
    double numbers = (double)model->samples->rows * model->samples->channels;
    HaarTreeOptions tree = {.shape = {level, 4, n, HAAR_AREA},
                            .keep_share = fit_haar_share(options, numbers, (double)leaves, n),
                            .component_scale = scale,
                            .rows = TREE_ROWS_INT16};
    return haar_tree_build(&tree, values, arena, &out->bytes, &out->report, err) ||
           error_prefix(err, "emission");
}

/* ---- the level -------------------------------------------------------------------------- */

bool emission_tree_build(const EmissionModel *model, const FitOptions *options, Arena *arena,
                         EmissionTree *out, Error *err) {
    double step = model->samples->step_deg;
    int level = options->level ? options->level : step < 1.5 ? 7 : step < 3 ? 6 : 5;
    EmissionRest rest = find_rest(model, arena);
    EmissionCoder coder = start(model, &rest, level, arena);
    while (!options->level && level < LEVEL_MOST && coder.uncoded > ENOUGH * model->tolerance) {
        EmissionCoder finer = start(model, &rest, ++level, arena);
        if (finer.uncoded > FINER * coder.uncoded) break;
        coder = finer;
    }
    coder.threads = options->threads;
    out->level = coder.lattice.level;
    if (options->basis == FIT_HAAR) return code_haar(&coder, options, arena, out, err);
    return code_tree(&coder, arena, out, err);
}
