/* SPDX-License-Identifier: Apache-2.0 */
/* The tree of what the smooth part leaves: vertex values by least squares, coded so that every
 * channel of every table keeps the tolerance at every sample. */
#include "panel/fit/emission/emission_tree.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "base/units.h"
#include "hemisphere/haar/haar_tree.h"
#include "hemisphere/tree/tree_open.h"
#include "hemisphere/tree/tree_query.h"
#include "hemisphere/vertex/vertex.h"
#include "hemisphere/vertex/vertex_tree.h"
#include "hemisphere/vertex/vertex_tree_build.h"
#include "panel/fit/emission/emission_beam.h"
#include "panel/fit/emission/emission_colour.h"
#include "panel/fit/emission/emission_edges.h"
#include "panel/fit/emission/emission_values.h"
#include "panel/shape/panel_beam.h"

#define LEVEL_MOST 9
#define ROUNDS 10
#define BEAM_GATE 0.02 /* relative error of triangles that makes worth looking for a beam */
#define BEAM_WORTH 0.7   /* and that must go down so far */
#define NO_NOISE 0.02    /* of the tolerance: beams then keep it without pardon for noise */
#define BEAM_ENOUGH 0.25 /* of the tolerance: no other reach is tried */

/* Where a tree is coded and what it is held to. */
typedef struct EmissionCoder {
    EmissionModel   *model;
    const Geodesic  *geodesic;
    VertexLattice    lattice;
    uint32_t         vertices;
    Vec3            *direction; /* of vertices */
    float           *smooth;    /* vertices x stride: the spline there */
    float           *value;     /* vertices x components: the rest */
    float           *wanted;    /* vertices x channels: M in cd m^-2 */
    float           *limit;     /* vertices: relative; INFINITY: anything will do */
    float           *least;     /* channels: errors count relative to no less than this */
    float           *work;      /* channels */
    double           pardon;    /* sigmas of noise that a sample may miss by besides */
    int              threads;
} EmissionCoder;

static bool is_close(const float *m, const float *wanted, const float *least, int channels,
                     float limit)
{
    for (int c = 0; c < channels; c++) /* what has run away beyond the cone is nobody's wish */
        if (!(fabsf(m[c] - wanted[c]) <= limit * fmaxf(wanted[c], least[c])) &&
            isfinite(wanted[c]))
            return false;
    return true;
}

static bool accepts(const void *context, uint32_t vertex, const float *reconstructed)
{
    const EmissionCoder *coder = context;
    const EmissionModel *model = coder->model;
    int   n = model->rank->components, channels = model->samples->channels;
    float components[PANEL_COMPONENTS_MAX], m[3 * EMISSION_TABLES_MAX];
    if (isinf(coder->limit[vertex])) return true;
    memcpy(components, coder->smooth + (size_t)vertex * (size_t)model->spline.stride,
           sizeof *components * (size_t)model->spline.stride);
    for (int k = 0; k < n; k++) components[k] += reconstructed[k];
    emission_model_totals(model, components, coder->direction[vertex], m);
    return is_close(m, coder->wanted + (size_t)vertex * (size_t)channels,
                    coder->least, channels, coder->limit[vertex]);
}

/* ---- vertex values --------------------------------------------------------------------- */

/* Scores less the smooth part, rows x components. */
static float *rest_at_samples(const EmissionModel *model, Arena *arena)
{
    const EmissionSamples *s = model->samples;
    int    n = model->rank->components;
    float *rest = ARENA_NEW(arena, float, (size_t)s->rows * (size_t)n);
    for (int i = 0; i < s->rows; i++) {
        float components[PANEL_COMPONENTS_MAX] = {0};
        emission_model_add_smooth(model, s->direction[i], components);
        for (int k = 0; k < n; k++)
            rest[i * n + k] = model->rank->score[i * n + k] - components[k];
    }
    return rest;
}

/* ---- the lattice ------------------------------------------------------------------------ */

static double cell_of(int level)
{
    return PI / 2 / (1 << level);
}

static void find_wanted(EmissionCoder *coder)
{
    const EmissionModel *model = coder->model;
    int    n = model->rank->components, stride = model->spline.stride;
    size_t channels = (size_t)model->samples->channels;
    double reach = model->samples->cone + cell_of(coder->lattice.level);
    for (uint32_t v = 0; v < coder->vertices; v++) {
        Vec3   d = coder->direction[v];
        float *smooth = coder->smooth + (size_t)v * (size_t)stride;
        float  components[PANEL_COMPONENTS_MAX];
        emission_model_add_smooth(model, d, smooth);
        memcpy(components, smooth, sizeof *smooth * (size_t)stride);
        for (int k = 0; k < n; k++)
            components[k] += coder->value[(size_t)v * (size_t)n + (size_t)k];
        emission_model_totals(model, components, d, coder->wanted + v * channels);
        coder->limit[v] = acos_d(fmin(1, (double)d.z)) <= reach
                              ? 0.75f * (float)model->tolerance : INFINITY;
    }
}

/* The level below which an error of a channel counts relative to it: about where it is noise
 * anyway, and the floor. */
static void find_least(const EmissionModel *model, float *least)
{
    for (int c = 0; c < model->samples->channels; c++)
        least[c] = (float)fmax(20 * model->dim[c / 3][c % 3], model->samples->floor[c]);
}

/* The colour of the vertices that samples surround. */
static void hold_colours(EmissionCoder *coder, Arena scratch)
{
    const EmissionModel *model = coder->model;
    size_t         n = (size_t)model->rank->components;
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
static bool fit_vertices(EmissionCoder *coder, const float *rest, Arena scratch, Error *err)
{
    EmissionValues values = {coder->model, coder->geodesic, coder->lattice, coder->vertices,
                             coder->value};
    for (int k = 0; k < coder->model->rank->components; k++)
        if (!emission_values_fit(&values, rest, k, scratch, err)) return false;
    hold_colours(coder, scratch);
    find_wanted(coder);
    return true;
}

/* A coder without values. */
static EmissionCoder make_coder(EmissionModel *model, int level, Arena *arena)
{
    EmissionCoder coder, *out = &coder;
    size_t n = (size_t)model->rank->components, channels = (size_t)model->samples->channels;
    *out = (EmissionCoder){.model = model, .geodesic = geodesic_create(level, arena),
                           .lattice = {level, 4}, .pardon = 5};
    size_t count = out->vertices = vertex_count(out->lattice);
    out->direction = ARENA_NEW(arena, Vec3, count);
    out->smooth = ARENA_NEW(arena, float, count * (size_t)model->spline.stride);
    out->value = ARENA_NEW(arena, float, count * n);
    out->wanted = ARENA_NEW(arena, float, count * channels);
    out->limit = ARENA_NEW(arena, float, count);
    out->least = ARENA_NEW(arena, float, channels);
    out->work = ARENA_NEW(arena, float, channels);
    vertex_directions(out->lattice, out->direction);
    find_least(model, out->least);
    return coder;
}

static bool start_coder(EmissionModel *model, int level, const float *rest, Arena *arena,
                        EmissionCoder *out, Error *err)
{
    *out = make_coder(model, level, arena);
    return fit_vertices(out, rest, *arena, err);
}

/* Adds the values at a point to components. */
static void add_values(const EmissionCoder *coder, const VertexPoint *at, float *components)
{
    uint32_t n = (uint32_t)coder->model->rank->components;
    for (int q = 0; q < 3; q++)
        for (uint32_t k = 0; k < n; k++)
            components[k] += at->weight[q] * coder->value[at->vertex[q] * n + k];
}

/* ---- against the samples ---------------------------------------------------------------- */

/* The largest relative error of a row's channels, beyond so many sigmas of noise. */
static float excess_of(const EmissionCoder *coder, int row, const float *components,
                       float sigmas)
{
    const EmissionSamples *s = coder->model->samples;
    float excess = 0;
    emission_model_totals(coder->model, components, s->direction[row], coder->work);
    for (int c = 0; c < s->channels; c++) {
        size_t number = (size_t)row * (size_t)s->channels + (size_t)c;
        float  m = s->total[number], sigma = s->sigma[number];
        if (isinf(sigma)) continue;
        float miss = fabsf(coder->work[c] - m) - sigmas * sigma;
        excess = fmaxf(excess, miss / fmaxf(m, coder->least[c]));
    }
    return excess;
}

/* What vertex values leave of a row before they are coded. */
static double row_error(const EmissionCoder *coder, int row)
{
    const EmissionModel *model = coder->model;
    Vec3        direction = model->samples->direction[row];
    VertexPoint at = vertex_find(coder->geodesic, coder->lattice, direction);
    float       components[PANEL_COMPONENTS_MAX] = {0};
    emission_model_add_smooth(model, direction, components);
    add_values(coder, &at, components);
    return (double)excess_of(coder, row, components, 5);
}

/* Over all rows: what no tightening mends. *row: where. */
static double uncoded_error(const EmissionCoder *coder, int *row)
{
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
static int believe_dark_rows(const EmissionCoder *coder)
{
    const EmissionSamples *s = coder->model->samples;
    float *belief = coder->model->rank->belief;
    int    raised = 0;
    for (int i = 0; i < s->rows; i++) {
        bool is_dark = false;
        for (int c = 0; c < s->channels; c++) {
            size_t number = (size_t)i * (size_t)s->channels + (size_t)c;
            is_dark |= s->floor[c] > EMISSION_NO_LIGHT && !isinf(s->sigma[number]) &&
                       (double)s->total[number] < s->floor[c];
        }
        if (!is_dark || belief[i] >= 1 || row_error(coder, i) < coder->model->tolerance)
            continue;
        belief[i] = fminf(1, DARK_RAISE * belief[i]);
        raised++;
    }
    return raised;
}

static bool settle_dark_rows(EmissionCoder *coder, const float *rest, Arena scratch, Error *err)
{
    for (int round = 0; round < DARK_ROUNDS && believe_dark_rows(coder); round++)
        if (!fit_vertices(coder, rest, scratch, err)) return false;
    return true;
}

/* The coded tree's components at a row. */
static void coded_components(const EmissionModel *model, const Tree *tree, Vec3 d,
                             float *components)
{
    memset(components, 0, sizeof *components * PANEL_COMPONENTS_MAX);
    tree_interpolate(tree, d, components);
    emission_model_add_smooth(model, d, components);
}

/* How many samples the tree misses; the limits of the vertices around them are tightened. */
static int tighten(EmissionCoder *coder, const Tree *tree)
{
    const EmissionModel   *model = coder->model;
    const EmissionSamples *s = model->samples;
    int missed = 0;
    for (int i = 0; i < s->rows; i++) {
        float components[PANEL_COMPONENTS_MAX];
        coded_components(model, tree, s->direction[i], components);
        if (!(excess_of(coder, i, components, (float)coder->pardon) > (float)model->tolerance))
            continue;
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
                      Error *err)
{
    EmissionModel *model = coder->model;
    VertexTreeOptions options = {coder->lattice, model->rank->components, accepts, coder,
                                 model->step, coder->threads};
    return (vertex_tree_build(&options, coder->value, arena, &out->bytes, &out->report,
                              err) &&
            tree_open(out->bytes, tree_size(out->bytes), coder->geodesic, tree, err)) ||
           error_prefix(err, "emission");
}

#define LOOSER 2.0f
#define ATTEMPTS 10
#define HORIZON 0.01f /* cosine: nobody measures along the panel */

/* Loosens limits until the coder succeeds: none along the panel, twice as wide elsewhere. */
static bool code_first(EmissionCoder *coder, Arena *arena, EmissionTree *out, Tree *tree,
                       Error *err)
{
    Error unheard;
    if (code_once(coder, arena, out, tree, &unheard)) return true;
    for (int attempt = 0; attempt < ATTEMPTS; attempt++) {
        for (uint32_t v = 0; v < coder->vertices; v++)
            coder->limit[v] = coder->direction[v].z < HORIZON ? INFINITY
                                                              : LOOSER * coder->limit[v];
        if (code_once(coder, arena, out, tree, &unheard)) return true;
    }
    return error_set(err, ERROR_INPUT, "emission: the tables cannot be kept within %.2g %%: "
                     "ask for a looser bound (--max-error) or a coarser tree (--level)",
                     100 * coder->model->tolerance);
}

/* Codes, checks all samples, tightens around those that it misses, and codes again. */
static bool code_tree(EmissionCoder *coder, Arena *arena, EmissionTree *out, Error *err)
{
    int   before = INT32_MAX;
    Tree  tree;
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
                      EmissionTree *out, Error *err)
{
    const EmissionModel *model = coder->model;
    int    n = model->rank->components, level = coder->lattice.level;
    size_t leaves = geodesic_count(level);
    float *values = ARENA_NEW(arena, float, leaves * (size_t)n), scale[PANEL_COMPONENTS_MAX];
    for (size_t i = 0; i < leaves; i++) {
        VertexPoint at = vertex_find(coder->geodesic, coder->lattice,
                                     geodesic_center(level, (uint32_t)i));
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
                            .component_scale = scale, .rows = TREE_ROWS_INT16};
    return haar_tree_build(&tree, values, arena, &out->bytes, &out->report, err) ||
           error_prefix(err, "emission");
}

static bool code(EmissionCoder *coder, const FitOptions *options, Arena *arena,
                 EmissionTree *out, Error *err)
{
    out->level = coder->lattice.level;
    if (options->basis == FIT_HAAR) return code_haar(coder, options, arena, out, err);
    return code_tree(coder, arena, out, err);
}

/* ---- edges ------------------------------------------------------------------------------ */

#define CELLS_A_STEP 3.0 /* triangles between two rings */
#define EDGED_TOLERANCE 0.01
#define FINER 0.8   /* what a finer level must leave */

static int edge_level(const EmissionSamples *s, const FitOptions *options)
{
    int level = 5;
    if (options->level) return options->level;
    while (level < LEVEL_MOST - 1 &&
           degrees_from_radians(cell_of(level)) > s->step_deg / CELLS_A_STEP)
        level++;
    return level;
}

/* Few rings with an edge look like noise: it does not count beyond a per cent. */
static void hold_tolerance(EmissionModel *model)
{
    double most = fmax(EDGED_TOLERANCE, model->samples->tolerance);
    for (int k = 0; k < model->rank->components && model->tolerance > most; k++)
        model->step[k] *= (float)(most / model->tolerance);
    model->tolerance = fmin(model->tolerance, most);
}

/* The measured directions as cells, and the tree that a panel makes of them. */
typedef struct Cells {
    const void *bytes;
    Tree        tree;
    double      error; /* the largest of a row's */
} Cells;

static bool make_cells(EmissionCoder *coder, const EmissionEdges *edges, int level,
                       Arena *arena, Cells *out, Error *err)
{
    const EmissionModel *model = coder->model;
    const EmissionRank  *rank = model->rank;
    PanelEmission  as_read = {.components = rank->components, .mean = rank->mean,
                              .channels = model->samples->channels, .loading = rank->loading,
                              .cosine_power = rank->cosine_power};
    PanelGridCells cells = emission_edges_cells(edges, model, level);
    *out = (Cells){.bytes = panel_grid_pack(&cells, arena)};
    if (!panel_grid_expand(out->bytes, tree_size(out->bytes), &as_read, coder->geodesic, arena,
                           &out->tree))
        return error_set(err, ERROR_INPUT, "emission: the measured cells cannot be stored");
    for (int i = 0; i < model->samples->rows; i++) {
        float components[PANEL_COMPONENTS_MAX];
        coded_components(model, &out->tree, model->samples->direction[i], components);
        out->error = fmax(out->error, (double)excess_of(coder, i, components, 5));
    }
    return true;
}

/* A coder that errors of cells are found by, without vertices. */
static EmissionCoder make_judge(EmissionModel *model, const EmissionEdges *edges, Arena *arena)
{
    EmissionCoder coder = {.model = model, .pardon = 5,
                           .geodesic = geodesic_create(VERTEX_PLANE_LEVEL, arena),
                           .least = ARENA_NEW(arena, float, model->samples->channels),
                           .work = ARENA_NEW(arena, float, model->samples->channels)};
    find_least(model, coder.least);
    for (int c = 0; c < model->samples->channels; c++)
        coder.least[c] = fmaxf(coder.least[c], (float)edges->profiles.least[c]);
    return coder;
}

/* The same function as a coded tree: of many directions that is less. */
static bool code_cells(EmissionModel *model, const EmissionCoder *judge, const Cells *cells,
                       const FitOptions *options, Arena *arena, EmissionTree *out, Error *err)
{
    size_t        n = (size_t)model->rank->components;
    EmissionCoder coder = make_coder(model, cells->tree.level, arena);
    memcpy(coder.least, judge->least, sizeof *coder.least * (size_t)model->samples->channels);
    coder.threads = options->threads;
    for (uint32_t v = 0; v < coder.vertices; v++) {
        float components[PANEL_COMPONENTS_MAX] = {0};
        tree_interpolate(&cells->tree, coder.direction[v], components);
        memcpy(coder.value + v * n, components, n * sizeof *components);
    }
    find_wanted(&coder);
    return code(&coder, options, arena, out, err);
}

/* Kept numbers of cells, as a tree's report has them. */
static void report_cells(const EmissionModel *model, const Cells *cells, EmissionTree *out)
{
    const EmissionEdges *e = &out->edges;
    uint32_t rows = 1 + (uint32_t)((e->grid.thetas - 1) * e->grid.phis);
    out->bytes = cells->bytes;
    out->report = (TreeReport){.stored_rows = rows, .bytes = tree_size(cells->bytes),
        .stored_values = (size_t)rows * (size_t)model->rank->components};
}

/* Numbers of a source that are kept as they are where a fit would need as many. */
#define KEPT_VALUES 20000

static bool is_small(const EmissionModel *model)
{
    return (double)model->samples->rows * model->samples->channels <= KEPT_VALUES;
}

/* An emission as its cells: with edges, where a smooth part would only ring, or small. */
static bool build_cells(EmissionModel *model, const FitOptions *options, Arena *arena,
                        EmissionTree *out, Error *err)
{
    Cells cells, finer;
    int   level = edge_level(model->samples, options);
    hold_tolerance(model);
    if (!emission_model_clear_smooth(model, arena))
        return error_set(err, ERROR_INPUT, "emission: the smooth part cannot be stored");
    EmissionCoder judge = make_judge(model, &out->edges, arena);
    if (!make_cells(&judge, &out->edges, level, arena, &cells, err)) return false;
    while (!options->level && cells.error > model->tolerance && level < LEVEL_MOST) {
        if (!make_cells(&judge, &out->edges, ++level, arena, &finer, err)) return false;
        if (finer.error > FINER * cells.error) break;
        cells = finer;
    }
    out->level = cells.tree.level;
    if (options->keep_share > 0 || !is_small(model)) {
        if (!code_cells(model, &judge, &cells, options, arena, out, err)) return false;
        if (options->keep_share > 0 || tree_size(out->bytes) < tree_size(cells.bytes))
            return true;
    }
    report_cells(model, &cells, out);
    return true;
}

static int start_level(const EmissionSamples *s, const FitOptions *options)
{
    if (options->level) return options->level;
    return s->step_deg < 1.5 ? 7 : s->step_deg < 3 ? 6 : 5;
}

/* The tree's coder at a level, and what it leaves uncoded at the worst row. */
typedef struct Start {
    EmissionCoder coder;
    float        *rest;
    double        uncoded;
    int           worst;
} Start;

/* Inputs of start(). */
typedef struct Plan {
    EmissionModel *model;
    int            level, threads;
} Plan;

static bool start(const Plan *plan, Arena *arena, Start *out, Error *err)
{
    EmissionModel *model = plan->model;
    *out = (Start){.rest = rest_at_samples(model, arena)};
    if (!start_coder(model, plan->level, out->rest, arena, &out->coder, err) ||
        !settle_dark_rows(&out->coder, out->rest, *arena, err))
        return false;
    out->coder.threads = plan->threads;
    out->uncoded = uncoded_error(&out->coder, &out->worst);
    return true;
}

/* A beam at the worst row, of the reach that leaves less. *found: there is one. */
static bool add_beam(const Plan *plan, Arena *arena, Start *best, bool *found, Error *err)
{
    EmissionModel *model = plan->model;
    static const double reach[2] = {10, 30};
    const EmissionModel before = *model;
    EmissionModel       chosen = before;
    int                 worst = best->worst;
    *found = false;
    for (int i = 0; i < 2; i++) {
        Start one;
        *model = before;
        if (!emission_beam_find(model, worst, reach[i], arena)) continue;
        if (!emission_model_fit_smooth(model, arena))
            return error_set(err, ERROR_INPUT, "emission: the smooth part cannot be stored");
        if (!start(plan, arena, &one, err)) return false;
        if (!*found || one.uncoded < best->uncoded) *best = one, chosen = *model;
        *found = true;
        if (best->uncoded < BEAM_ENOUGH * model->tolerance) break;
    }
    *model = chosen;
    return true;
}

/* Where triangles miss samples by far, narrow beams are looked for; they stay if the tree is
 * much better off with them. */
static bool start_with_beams(const Plan *plan, Arena *arena, Start *out, Error *err)
{
    EmissionModel *model = plan->model;
    double gate = fmax(BEAM_GATE, 4 * model->tolerance);
    if (!start(plan, arena, out, err)) return false;
    if (out->uncoded <= gate) return true;
    EmissionModel plain = *model;
    EmissionRank  rank = *model->rank; /* whose scores change */
    Start         bare = *out;
    size_t        scores = (size_t)model->samples->rows * (size_t)rank.components;
    model->rank->score = ARENA_NEW(arena, float, scores);
    memcpy(model->rank->score, rank.score, scores * sizeof *rank.score);
    for (bool found = true; found && out->uncoded > gate && model->beams < PANEL_BEAMS_MAX;)
        if (!add_beam(plan, arena, out, &found, err)) return false;
    if (model->beams && out->uncoded < BEAM_WORTH * bare.uncoded) return true;
    *model = plain;
    *model->rank = rank;
    *out = bare;
    return true;
}

/* A model as it was before a smooth part, with its scores. */
typedef struct PlainModel {
    EmissionModel model;
    EmissionRank  rank;
    float        *score;
} PlainModel;

static PlainModel plain_of(const EmissionModel *model, Arena *arena)
{
    PlainModel out = {*model, *model->rank, NULL};
    size_t     numbers = (size_t)model->samples->rows * (size_t)out.rank.components;
    out.score = memcpy(ARENA_NEW(arena, float, numbers), out.rank.score,
                       numbers * sizeof *out.score);
    out.rank.score = out.score;
    return out;
}

static size_t smooth_bytes(const EmissionModel *model, const EmissionTree *tree)
{
    size_t sum = tree_size(tree->bytes) + model->spline_size;
    for (int b = 0; b < model->beams; b++) sum += model->beam[b].size;
    return sum;
}

static bool build_smooth(EmissionModel *model, const FitOptions *options, Arena *arena,
                         EmissionTree *out, Error *err)
{
    int           level = start_level(model->samples, options);
    Start         first;
    EmissionCoder coder, finer;
    Plan          plan = {model, level, options->threads};
    if (!start_with_beams(&plan, arena, &first, err)) return false;
    float *rest = first.rest;
    double uncoded = first.uncoded;
    coder = first.coder;
    if (model->beams && model->noise < NO_NOISE * model->tolerance) coder.pardon = 0;
    while (!options->level && uncoded > 0.5 * model->tolerance && level < LEVEL_MOST) {
        if (!start_coder(model, level + 1, rest, arena, &finer, err) ||
            !settle_dark_rows(&finer, rest, *arena, err))
            return false;
        finer.threads = coder.threads;
        finer.pardon = coder.pardon;
        double next = uncoded_error(&finer, &first.worst);
        if (next > 0.8 * uncoded) break;
        coder = finer;
        uncoded = next;
        level++;
    }
    return code(&coder, options, arena, out, err);
}

bool emission_tree_build(EmissionModel *model, const FitOptions *options, Arena *arena,
                         EmissionTree *out, Error *err)
{
    double cell = cell_of(edge_level(model->samples, options));
    out->has_grid = emission_edges_find(model, cell, is_small(model), arena, &out->edges);
    if (out->edges.are_there) return build_cells(model, options, arena, out, err);
    PlainModel plain = plain_of(model, arena);
    if (!build_smooth(model, options, arena, out, err)) return false;
    if (!out->has_grid || options->keep_share > 0 || !is_small(model)) return true;
    PanelGridCells cells = emission_edges_cells(&out->edges, &plain.model, 1);
    if (smooth_bytes(model, out) <= panel_grid_bytes(&cells.head)) return true;
    EmissionRank *rank = model->rank;
    *model = plain.model;
    *rank = plain.rank;
    return build_cells(model, options, arena, out, err);
}
