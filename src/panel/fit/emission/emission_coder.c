/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/emission/emission_coder.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "base/mathf.h"
#include "base/units.h"
#include "hemisphere/haar/haar_tree.h"
#include "hemisphere/tree/tree_open.h"
#include "hemisphere/tree/tree_query.h"
#include "hemisphere/vertex/vertex.h"
#include "hemisphere/vertex/vertex_fit.h"
#include "hemisphere/vertex/vertex_tree.h"
#include "hemisphere/vertex/vertex_tree_build.h"
#include "panel/fit/common/scatter_surface.h"
#include "panel/fit/emission/emission_colour.h"
#include "panel/fit/emission/emission_model.h"

/* ---- values at vertices ----------------------------------------------------------------- */

/* Values at the vertices of a lattice by least squares: what the smooth
 * part leaves of an emission's scores, as smooth as their noise requires.
 * The ridge: noise^2 / (rows * the rest's expected curvature^2) is where a detail's own
 * evidence and the expectation that it is small weigh the same. */

typedef struct EmissionValues {
    const EmissionModel *model;
    const Geodesic *geodesic;
    VertexLattice lattice;
    uint32_t vertices;
    float *value; /* vertices x components */
} EmissionValues;

static double ridge_of(const EmissionModel *model, const float *rest, int component) {
    const EmissionSamples *s = model->samples;
    int n = model->rank->components;
    double sum = 0, area = 0, noise = (double)model->score_noise[component];
    for (int i = 0; i < s->rows; i++) {
        double r = (double)rest[i * n + component];
        sum += s->area[i] * r * r;
        area += s->area[i];
    }
    double variance = fmax(sum / area - noise * noise, 0.01 * noise * noise + 1e-12);
    return noise * noise / (s->rows * 6 * variance);
}

/* rms of what vertex values leave of the samples, weighted as they are. */
static double rest_of_fit(const EmissionValues *on, const VertexSamples *samples,
                          const float *values) {
    double sum = 0, total = 0;
    for (int i = 0; i < samples->count; i++) {
        VertexPoint at = vertex_find(on->geodesic, on->lattice, samples->direction[i]);
        double rest = (double)samples->value[i], w = (double)samples->weight[i];
        for (int q = 0; q < 3; q++) rest -= (double)at.weight[q] * (double)values[at.vertex[q]];
        sum += w * rest * rest;
        total += w;
    }
    return sqrt(sum / total);
}

#define RIDGE_STEP 32.0
#define LEAST_RIDGE 1e-12
#define WEAK_RIDGE 1e-9 /* weaker than this they hardly smooth; then */
#define WORTH 0.7       /* the next must leave so much less */

/* Where a component's fit begins and what it may leave. */
typedef struct FitGoal {
    double ridge, enough;
} FitGoal;

/* The noise, or nothing that matters. */
static FitGoal goal_of(const EmissionValues *on, const float *rest, int component) {
    return (FitGoal){ridge_of(on->model, rest, component),
                     fmax(1.2 * (double)on->model->score_noise[component],
                          0.1 * (double)on->model->step[component])};
}

/* The strongest ridge that leaves no more than the goal, or hardly more than a weaker one. */
static bool fit_values(const EmissionValues *on, const VertexSamples *samples, FitGoal goal,
                       Arena scratch, float *values, Error *err) {
    double before = INFINITY, ridge = goal.ridge;
    float *trial = ARENA_NEW(&scratch, float, on->vertices);
    for (;; ridge /= RIDGE_STEP) {
        Arena work = scratch;
        ridge = fmax(ridge, LEAST_RIDGE);
        if (!vertex_fit(on->lattice, samples, ridge, &work, trial, err)) return false;
        double rest = rest_of_fit(on, samples, trial);
        if (ridge < WEAK_RIDGE && rest > WORTH * before) return true;
        memcpy(values, trial, on->vertices * sizeof *values);
        if (ridge == LEAST_RIDGE || rest <= goal.enough) return true;
        before = rest;
    }
}

/* What the surface through scattered rows says; beyond the cone what it says at its edge. */
static void read_surface(const EmissionValues *on, const float *one, Arena scratch, float *values) {
    const EmissionSamples *s = on->model->samples;
    const ScatterSurface *surface = scatter_surface_make(s->master, false, one, 1, &scratch);
    Vec3 *at = ARENA_NEW(&scratch, Vec3, on->vertices);
    double low = cos_d(s->cone), across = sin_d(s->cone);
    vertex_directions(on->lattice, at);
    for (uint32_t v = 0; v < on->vertices; v++) {
        double r = sqrt((double)(at[v].x * at[v].x + at[v].y * at[v].y));
        if ((double)at[v].z < low)
            at[v] = vec3((float)(at[v].x * across / r), (float)(at[v].y * across / r), (float)low);
        scatter_surface_read(surface, at[v], &values[v]);
    }
}

/* One component of all values; rest: rows x components. */
static bool emission_values_fit(const EmissionValues *on, const float *rest, int component,
                                Arena scratch, Error *err) {
    const EmissionSamples *s = on->model->samples;
    int n = on->model->rank->components;
    float *one = ARENA_NEW(&scratch, float, s->rows);
    float *weight = ARENA_NEW(&scratch, float, s->rows);
    float *values = ARENA_NEW(&scratch, float, on->vertices), low = INFINITY, high = -low;
    for (int i = 0; i < s->rows; i++) {
        one[i] = rest[i * n + component];
        weight[i] = on->model->rank->belief[i] * (float)s->area[i];
        low = fminf(low, one[i]), high = fmaxf(high, one[i]);
    }
    if (on->model->is_scattered) read_surface(on, one, scratch, values);
    VertexSamples samples = {s->rows, 1, s->direction, one, weight};
    if (!on->model->is_scattered &&
        !fit_values(on, &samples, goal_of(on, rest, component), scratch, values, err))
        return false;
    for (uint32_t v = 0; v < on->vertices; v++) /* what nothing measures cannot run away */
        on->value[v * (uint32_t)n + (uint32_t)component] = clampf(values[v], low, high);
    return true;
}

#define ROUNDS 10

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

/* ---- vertex values --------------------------------------------------------------------- */

/* Scores less the smooth part, rows x components. */
float *emission_coder_rest(const EmissionModel *model, Arena *arena) {
    const EmissionSamples *s = model->samples;
    int n = model->rank->components;
    float *rest = ARENA_NEW(arena, float, (size_t)s->rows *(size_t)n);
    for (int i = 0; i < s->rows; i++) {
        float components[PANEL_COMPONENTS_MAX] = {0};
        emission_model_add_smooth(model, s->direction[i], components);
        for (int k = 0; k < n; k++) rest[i * n + k] = model->rank->score[i * n + k] - components[k];
    }
    return rest;
}

/* ---- the lattice ------------------------------------------------------------------------ */

double emission_coder_cell(int level) {
    return PI / 2 / (1 << level);
}

void emission_coder_find_wanted(EmissionCoder *coder) {
    const EmissionModel *model = coder->model;
    int n = model->rank->components, stride = model->spline.stride;
    size_t channels = (size_t)model->samples->channels;
    double reach = model->samples->cone + emission_coder_cell(coder->lattice.level);
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
            acos_d(fmin(1, (double)d.z)) <= reach ? 0.75f * (float)model->tolerance : INFINITY;
    }
}

/* The level below which an error of a channel counts relative to it: about where it is noise
 * anyway, and the floor. */
void emission_coder_least(const EmissionModel *model, float *least) {
    for (int c = 0; c < model->samples->channels; c++)
        least[c] = (float)fmax(20 * model->dim[c / 3][c % 3], model->samples->floor[c]);
}

/* The colour of the vertices that samples surround. */
static void hold_colours(EmissionCoder *coder, Arena scratch) {
    const EmissionModel *model = coder->model;
    size_t n = (size_t)model->rank->components;
    EmissionColour colour;
    emission_colour_make(model, &scratch, &colour);
    for (uint32_t v = 0; v < coder->vertices; v++) {
        float whole[PANEL_COMPONENTS_MAX] = {0}, *value = coder->value + v * n;
        emission_model_add_smooth(model, coder->direction[v], whole);
        for (size_t k = 0; k < n; k++) whole[k] += value[k];
        float before[PANEL_COMPONENTS_MAX];
        memcpy(before, whole, sizeof before);
        emission_colour_hold(&colour, coder->direction[v], whole);
        for (size_t k = 0; k < n; k++) value[k] += whole[k] - before[k];
    }
}

/* Values of the rest at the vertices, and what follows from them. */
static bool fit_vertices(EmissionCoder *coder, const float *rest, Arena scratch, Error *err) {
    EmissionValues values = {coder->model, coder->geodesic, coder->lattice, coder->vertices,
                             coder->value};
    for (int k = 0; k < coder->model->rank->components; k++)
        if (!emission_values_fit(&values, rest, k, scratch, err)) return false;
    hold_colours(coder, scratch);
    emission_coder_find_wanted(coder);
    return true;
}

/* A coder without values. */
EmissionCoder emission_coder_make(EmissionModel *model, int level, Arena *arena) {
    EmissionCoder coder, *out = &coder;
    size_t n = (size_t)model->rank->components, channels = (size_t)model->samples->channels;
    *out = (EmissionCoder){.model = model,
                           .geodesic = geodesic_create(level, arena),
                           .lattice = {level, 4},
                           .pardon = 5};
    size_t count = out->vertices = vertex_count(out->lattice);
    out->direction = ARENA_NEW(arena, Vec3, count);
    out->smooth = ARENA_NEW(arena, float, count *(size_t)model->spline.stride);
    out->value = ARENA_NEW(arena, float, count *n);
    out->wanted = ARENA_NEW(arena, float, count *channels);
    out->limit = ARENA_NEW(arena, float, count);
    out->least = ARENA_NEW(arena, float, channels);
    out->work = ARENA_NEW(arena, float, channels);
    vertex_directions(out->lattice, out->direction);
    emission_coder_least(model, out->least);
    return coder;
}

bool emission_coder_start(EmissionModel *model, int level, const float *rest, Arena *arena,
                          EmissionCoder *out, Error *err) {
    *out = emission_coder_make(model, level, arena);
    return fit_vertices(out, rest, *arena, err);
}

/* Adds the values at a point to components. */
static void add_values(const EmissionCoder *coder, const VertexPoint *at, float *components) {
    uint32_t n = (uint32_t)coder->model->rank->components;
    for (int q = 0; q < 3; q++)
        for (uint32_t k = 0; k < n; k++)
            components[k] += at->weight[q] * coder->value[at->vertex[q] * n + k];
}

/* ---- against the samples ---------------------------------------------------------------- */

/* The largest relative error of a row's channels, beyond so many sigmas of noise. */
float emission_coder_excess(const EmissionCoder *coder, int row, const float *components,
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

/* What vertex values leave of a row before they are coded. */
static double row_error(const EmissionCoder *coder, int row) {
    const EmissionModel *model = coder->model;
    Vec3 direction = model->samples->direction[row];
    VertexPoint at = vertex_find(coder->geodesic, coder->lattice, direction);
    float components[PANEL_COMPONENTS_MAX] = {0};
    emission_model_add_smooth(model, direction, components);
    add_values(coder, &at, components);
    return (double)emission_coder_excess(coder, row, components, 5);
}

/* Over all rows: what no tightening corrects. *row: where. */
double emission_coder_uncoded(const EmissionCoder *coder, int *row) {
    double worst = 0;
    for (int i = 0; i < coder->model->samples->rows; i++) {
        double miss = row_error(coder, i);
        if (miss > worst) worst = miss, *row = i;
    }
    return worst;
}

#define DARK_ROUNDS 5
#define DARK_RAISE 8.0f

/* A row below the floor has little weight, for its logarithm may be anywhere down there; but
 * where the surface passes far above it, it matters. Counts such rows and raises their
 * weight. */
static int believe_dark_rows(const EmissionCoder *coder) {
    const EmissionSamples *s = coder->model->samples;
    float *belief = coder->model->rank->belief;
    int raised = 0;
    for (int i = 0; i < s->rows; i++) {
        bool is_dark = false;
        for (int c = 0; c < s->channels; c++) {
            size_t number = (size_t)i * (size_t)s->channels + (size_t)c;
            is_dark |= s->floor[c] > EMISSION_NO_LIGHT && !isinf(s->sigma[number]) &&
                       (double)s->total[number] < s->floor[c];
        }
        if (!is_dark || belief[i] >= 1 || row_error(coder, i) < coder->model->tolerance) continue;
        belief[i] = fminf(1, DARK_RAISE * belief[i]);
        raised++;
    }
    return raised;
}

bool emission_coder_settle(EmissionCoder *coder, const float *rest, Arena scratch, Error *err) {
    for (int round = 0; round < DARK_ROUNDS && believe_dark_rows(coder); round++)
        if (!fit_vertices(coder, rest, scratch, err)) return false;
    return true;
}

/* The coded tree's components at a row. */
void emission_coder_components(const EmissionModel *model, const Tree *tree, Vec3 d,
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
        emission_coder_components(model, tree, s->direction[i], components);
        float excess = emission_coder_excess(coder, i, components, (float)coder->pardon);
        if (!(excess > (float)model->tolerance)) continue;
        missed++;
        VertexPoint at = vertex_find(coder->geodesic, coder->lattice, s->direction[i]);
        for (int q = 0; q < 3; q++) {
            float *limit = &coder->limit[at.vertex[q]];
            *limit = fmaxf(0.05f * (float)model->tolerance,
                           fminf(0.6f * *limit, 0.6f * (float)model->tolerance));
        }
    }
    return missed;
}

static bool code_once(EmissionCoder *coder, Arena *arena, EmissionTree *out, Tree *tree,
                      Error *err) {
    EmissionModel *model = coder->model;
    VertexTreeOptions options = {coder->lattice, model->rank->components, accepts, coder,
                                 model->step,    coder->threads};
    return (vertex_tree_build(&options, coder->value, arena, &out->bytes, &out->report, err) &&
            tree_open(out->bytes, tree_size(out->bytes), coder->geodesic, arena, tree, err)) ||
           error_prefix(err, "emission");
}

#define LOOSER 2.0f
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

bool emission_coder_code(EmissionCoder *coder, const FitOptions *options, Arena *arena,
                         EmissionTree *out, Error *err) {
    out->level = coder->lattice.level;
    if (options->basis == FIT_HAAR) return code_haar(coder, options, arena, out, err);
    return code_tree(coder, arena, out, err);
}
