/* SPDX-License-Identifier: Apache-2.0 */
/* How an emission is kept: a smooth part, beams and a tree of what they leave; or its cells. */
#include "panel/fit/emission/emission_tree.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "base/units.h"
#include "hemisphere/tree/tree_open.h"
#include "hemisphere/tree/tree_query.h"
#include "panel/fit/emission/emission_beam.h"
#include "panel/fit/emission/emission_coder.h"

#define BEAM_GATE 0.02   /* relative error of triangles that makes worth looking for a beam */
#define BEAM_WORTH 0.7   /* and that must go down so far */
#define NO_NOISE 0.02    /* of the tolerance: beams then keep it without pardon for noise */
#define BEAM_ENOUGH 0.25 /* of the tolerance: no other reach is tried */

/* ---- edges ------------------------------------------------------------------------------ */

#define CELLS_A_STEP 3.0 /* triangles between two rings */
#define EDGED_TOLERANCE 0.01
#define FINER 0.8 /* what a finer level must leave */

static int edge_level(const EmissionSamples *s, const FitOptions *options) {
    int level = 5;
    if (options->level) return options->level;
    while (level < EMISSION_LEVEL_MOST - 1 &&
           degrees_from_radians(emission_coder_cell(level)) > s->step_deg / CELLS_A_STEP)
        level++;
    return level;
}

/* Few rings with an edge look like noise: it does not count beyond a per cent. */
static void hold_tolerance(EmissionModel *model) {
    double most = fmax(EDGED_TOLERANCE, model->samples->tolerance);
    for (int k = 0; k < model->rank->components && model->tolerance > most; k++)
        model->step[k] *= (float)(most / model->tolerance);
    model->tolerance = fmin(model->tolerance, most);
}

/* The measured directions as cells, and the tree that a panel makes of them. */
typedef struct KeptCells {
    const void *bytes;
    Tree tree;
    double error; /* the largest of a row's */
    int missed;   /* rows beyond the tolerance */
} KeptCells;

static bool make_cells(EmissionCoder *coder, const EmissionEdges *edges, int level, Arena *arena,
                       KeptCells *out, Error *err) {
    const EmissionModel *model = coder->model;
    const EmissionRank *rank = model->rank;
    PanelEmission as_read = {.components = rank->components,
                             .mean = rank->mean,
                             .channels = model->samples->channels,
                             .loading = rank->loading,
                             .cosine_power = rank->cosine_power,
                             .has_black = model->samples->black >= 0};
    PanelGridCells cells = emission_edges_cells(edges, model, level);
    *out = (KeptCells){.bytes = panel_grid_pack(&cells, arena)};
    if (!panel_grid_expand(out->bytes, tree_size(out->bytes), &as_read, coder->geodesic, arena,
                           &out->tree))
        return error_set(err, ERROR_INPUT, "emission: the measured cells cannot be stored");
    for (int i = 0; i < model->samples->rows; i++) {
        float components[PANEL_COMPONENTS_MAX];
        emission_coder_components(model, &out->tree, model->samples->direction[i], components);
        double miss = (double)emission_coder_excess(coder, i, components, 5);
        out->error = fmax(out->error, miss);
        out->missed += miss > model->tolerance;
    }
    return true;
}

/* A coder that errors of cells are found by, without vertices. */
static EmissionCoder make_judge(EmissionModel *model, const EmissionEdges *edges, Arena *arena) {
    EmissionCoder coder = {.model = model,
                           .pardon = 5,
                           .geodesic = geodesic_create(VERTEX_PLANE_LEVEL, arena),
                           .least = ARENA_NEW(arena, float, model->samples->channels),
                           .work = ARENA_NEW(arena, float, model->samples->channels)};
    emission_coder_least(model, coder.least);
    for (int c = 0; c < model->samples->channels; c++)
        coder.least[c] = fmaxf(coder.least[c], (float)edges->profiles.least[c]);
    return coder;
}

/* The same function as a coded tree: of many directions that is less. */
static bool code_cells(const EmissionCoder *judge, const KeptCells *cells,
                       const FitOptions *options, Arena *arena, EmissionTree *out, Error *err) {
    EmissionModel *model = judge->model;
    size_t n = (size_t)model->rank->components;
    EmissionCoder coder = emission_coder_make(model, cells->tree.level, arena);
    memcpy(coder.least, judge->least, sizeof *coder.least * (size_t)model->samples->channels);
    coder.threads = options->threads;
    for (uint32_t v = 0; v < coder.vertices; v++) {
        float components[PANEL_COMPONENTS_MAX] = {0};
        tree_interpolate(&cells->tree, coder.direction[v], components);
        memcpy(coder.value + v * n, components, n * sizeof *components);
    }
    emission_coder_find_wanted(&coder);
    return emission_coder_code(&coder, options, arena, out, err);
}

/* Kept numbers of cells, as a tree's report has them. */
static void report_cells(const EmissionModel *model, const KeptCells *cells, EmissionTree *out) {
    const EmissionEdges *e = &out->edges;
    uint32_t rows = 1 + (uint32_t)((e->grid.thetas - 1) * e->grid.phis);
    out->bytes = cells->bytes;
    out->missed = cells->missed;
    out->report = (TreeReport){.stored_rows = rows,
                               .bytes = tree_size(cells->bytes),
                               .stored_values = (size_t)rows * (size_t)model->rank->components};
}

/* Numbers of a source that are kept as they are where a fit would need as many. */
#define KEPT_VALUES 20000

static bool is_small(const EmissionModel *model) {
    return (double)model->samples->rows * model->samples->channels <= KEPT_VALUES;
}

/* An emission as its cells: with edges, where a smooth part would only ring, or small. */
static bool build_cells(EmissionModel *model, const FitOptions *options, Arena *arena,
                        EmissionTree *out, Error *err) {
    KeptCells cells, finer;
    int level = edge_level(model->samples, options);
    hold_tolerance(model);
    if (!emission_model_clear_smooth(model, arena))
        return error_set(err, ERROR_INPUT, "emission: the smooth part cannot be stored");
    EmissionCoder judge = make_judge(model, &out->edges, arena);
    if (!make_cells(&judge, &out->edges, level, arena, &cells, err)) return false;
    while (!options->level && cells.error > model->tolerance && level < EMISSION_LEVEL_MOST) {
        if (!make_cells(&judge, &out->edges, ++level, arena, &finer, err)) return false;
        if (finer.error > FINER * cells.error) break;
        cells = finer;
    }
    out->level = cells.tree.level;
    if (options->basis == FIT_HAAR || !is_small(model)) {
        if (!code_cells(&judge, &cells, options, arena, out, err)) return false;
        if (options->basis == FIT_HAAR || tree_size(out->bytes) < tree_size(cells.bytes))
            return true;
    }
    report_cells(model, &cells, out);
    return true;
}

static int start_level(const EmissionSamples *s, const FitOptions *options) {
    if (options->level) return options->level;
    return s->step_deg < 1.5 ? 7 : s->step_deg < 3 ? 6 : 5;
}

/* The tree's coder at a level, and what it leaves uncoded at the worst row. */
typedef struct Start {
    EmissionCoder coder;
    float *rest;
    double uncoded;
    int worst;
} Start;

/* Inputs of start(). */
typedef struct Plan {
    EmissionModel *model;
    int level, threads;
} Plan;

static bool start(const Plan *plan, Arena *arena, Start *out, Error *err) {
    EmissionModel *model = plan->model;
    *out = (Start){.rest = emission_coder_rest(model, arena)};
    if (!emission_coder_start(model, plan->level, out->rest, arena, &out->coder, err) ||
        !emission_coder_settle(&out->coder, out->rest, *arena, err))
        return false;
    out->coder.threads = plan->threads;
    out->uncoded = emission_coder_uncoded(&out->coder, &out->worst);
    return true;
}

/* A beam at the worst row, of the reach that leaves less. *found: there is one. */
static bool add_beam(const Plan *plan, Arena *arena, Start *best, bool *found, Error *err) {
    EmissionModel *model = plan->model;
    static const double reach[2] = {10, 30};
    const EmissionModel before = *model;
    EmissionModel chosen = before;
    int worst = best->worst;
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
static bool start_with_beams(const Plan *plan, Arena *arena, Start *out, Error *err) {
    EmissionModel *model = plan->model;
    double gate = fmax(BEAM_GATE, 4 * model->tolerance);
    if (!start(plan, arena, out, err)) return false;
    if (out->uncoded <= gate) return true;
    EmissionModel plain = *model;
    EmissionRank rank = *model->rank; /* whose scores change */
    Start bare = *out;
    size_t scores = (size_t)model->samples->rows * (size_t)rank.components;
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
    EmissionRank rank;
    float *score;
} PlainModel;

static PlainModel plain_of(const EmissionModel *model, Arena *arena) {
    PlainModel out = {*model, *model->rank, NULL};
    size_t numbers = (size_t)model->samples->rows * (size_t)out.rank.components;
    out.score =
        memcpy(ARENA_NEW(arena, float, numbers), out.rank.score, numbers * sizeof *out.score);
    out.rank.score = out.score;
    return out;
}

static size_t smooth_bytes(const EmissionModel *model, const EmissionTree *tree) {
    size_t sum = tree_size(tree->bytes) + model->spline_size;
    for (int b = 0; b < model->beams; b++) sum += model->beam[b].size;
    return sum;
}

/* *worth false: a small table that the first lattice does not fit: its cells are fewer. */
static bool build_smooth(EmissionModel *model, const FitOptions *options, Arena *arena,
                         EmissionTree *out, bool *worth, Error *err) {
    int level = start_level(model->samples, options);
    Start first;
    EmissionCoder coder, finer;
    Plan plan = {model, level, options->threads};
    *worth = true;
    if (out->has_grid && options->basis != FIT_HAAR && is_small(model)) {
        if (!start(&plan, arena, &first, err)) return false;
        *worth = first.uncoded <= 0.5 * model->tolerance;
        if (!*worth) return true;
    } else if (!start_with_beams(&plan, arena, &first, err)) {
        return false;
    }
    float *rest = first.rest;
    double uncoded = first.uncoded;
    coder = first.coder;
    if (model->beams && model->noise < NO_NOISE * model->tolerance) coder.pardon = 0;
    while (!options->level && uncoded > 0.5 * model->tolerance && level < EMISSION_LEVEL_MOST) {
        if (!emission_coder_start(model, level + 1, rest, arena, &finer, err) ||
            !emission_coder_settle(&finer, rest, *arena, err))
            return false;
        finer.threads = coder.threads;
        finer.pardon = coder.pardon;
        double next = emission_coder_uncoded(&finer, &first.worst);
        if (next > 0.8 * uncoded) break;
        coder = finer;
        uncoded = next;
        level++;
    }
    return emission_coder_code(&coder, options, arena, out, err);
}

bool emission_tree_build(EmissionModel *model, const FitOptions *options, Arena *arena,
                         EmissionTree *out, Error *err) {
    double cell = emission_coder_cell(edge_level(model->samples, options));
    out->has_grid = emission_edges_find(model, cell, is_small(model), arena, &out->edges);
    if (out->edges.are_there) return build_cells(model, options, arena, out, err);
    PlainModel plain = plain_of(model, arena);
    bool worth;
    if (!build_smooth(model, options, arena, out, &worth, err)) return false;
    if (!out->has_grid || options->basis == FIT_HAAR || !is_small(model)) return true;
    PanelGridCells cells = emission_edges_cells(&out->edges, &plain.model, 1);
    if (worth && smooth_bytes(model, out) <= panel_grid_bytes(&cells.head)) return true;
    EmissionRank *rank = model->rank;
    *model = plain.model;
    *rank = plain.rank;
    return build_cells(model, options, arena, out, err);
}
