/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/emission/emission_model.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "base/mathf.h"
#include "hemisphere/tree/vertex.h"
#include "panel/fit/common/scatter_surface.h"
#include "panel/shape/least_squares.h"
#include "panel/query/panel_components.h"
#include "panel/shape/panel_spline.h"

#define SURFACE_LEVEL 5 /* of the lattice at which a surface through scattered rows is read */

void emission_model_add_smooth(const EmissionModel *model, Vec3 d, float *components) {
    panel_components_add_spline(&model->spline, d, log_f(clampf(d.z, PANEL_LEAST_COS, 1)),
                                components);
}

void emission_model_totals(const EmissionModel *model, const float *components, Vec3 direction,
                           float *m) {
    const EmissionSamples *s = model->samples;
    emission_rank_logs(model->rank, s->channels, components,
                       emission_rank_fall(model->rank->cosine_power, direction), m);
    for (int c = 0; c < s->channels; c++) m[c] = exp_f(m[c]);
    for (int c = 0; c < s->black; c++) m[c] += m[s->black + c % 3];
}

/* ---- the smooth part --------------------------------------------------------------------- */

#define UNKNOWNS_MAX (PANEL_SPLINE_TERMS_MAX * PANEL_SPLINE_NUMBERS)
#define TAPS_MAX (5 * PANEL_SPLINE_TERMS_MAX)

/* Penalties relative to the samples' total weight: on steps between neighbouring coefficients
 * (so that they stay the same where nothing is measured), on the power of the cosine. */
#define STEP_PENALTY 1e-8
#define POWER_PENALTY 1e-7
#define LEAST_PENALTY 1e-12

/* Prior of scores of variance 1: steps of STEP / (1 + m^2) between coefficients of harmonic
 * m, sizes of SIZE / (1 + m^2). Noise is weighed against it. */
#define STEP 0.3
#define SIZE 1.0

/* The terms that so many azimuths on a ring can distinguish. */
static int choose_terms(int azimuths, uint8_t term[PANEL_SPLINE_TERMS_MAX]) {
    int count = 0;
    for (int t = 0; t < PANEL_SPLINE_TERMS_MAX; t++) {
        int m = panel_spline_harmonic(t);
        if (t == 0 || 2 * m < azimuths || (2 * m == azimuths && t % 2)) term[count++] = (uint8_t)t;
    }
    return count;
}

/* A direction's weights on the unknowns [term][number]. */
typedef struct Taps {
    int count;
    int at[TAPS_MAX];
    double weight[TAPS_MAX];
} Taps;

static void find_taps(const uint8_t *term, int terms, Vec3 d, Taps *out) {
    double theta = atan2_d(hypot_d((double)d.x, (double)d.y), (double)d.z);
    double phi = atan2_d((double)d.y, (double)d.x);
    double log_cos = log_d(fmax((double)PANEL_LEAST_COS, (double)d.z));
    out->count = 0;
    for (int t = 0; t < terms; t++) {
        int m = panel_spline_harmonic(term[t]);
        double angle = term[t] == 0 ? 1 : term[t] % 2 ? cos_d(m * phi) : sin_d(m * phi);
        PanelSplineTaps taps = panel_spline_taps(m, theta);
        for (int i = 0; i < 5; i++) {
            double w = i < 4 ? (double)taps.weight[i] : log_cos;
            if (w == 0) continue;
            out->at[out->count] =
                t * PANEL_SPLINE_NUMBERS + (i < 4 ? taps.first + i : PANEL_SPLINE_COEFFICIENTS);
            out->weight[out->count++] = angle * w;
        }
    }
}

typedef struct Normal {
    int unknowns, components;
    double *matrix; /* lower half */
    double *right;  /* unknowns x components */
    double total;
    const uint8_t *term; /* the harmonics */
    int terms;
} Normal;

static void add_sample(Normal *normal, const Taps *taps, const float *score, double weight) {
    for (int a = 0; a < taps->count; a++) {
        double w = weight * taps->weight[a];
        double *row = normal->matrix + (size_t)taps->at[a] * (size_t)normal->unknowns;
        double *right = normal->right + (size_t)taps->at[a] * (size_t)normal->components;
        for (int b = 0; b <= a; b++) row[taps->at[b]] += w * taps->weight[b];
        for (int k = 0; k < normal->components; k++) right[k] += w * (double)score[k];
    }
    normal->total += weight;
}

/* noise: standard deviation of a sample's score. */
static void add_penalties(Normal *normal, const uint8_t *term, int terms, double noise,
                          int samples) {
    size_t n = (size_t)normal->unknowns;
    double doubt = normal->total / samples * noise * noise;
    for (int t = 0; t < terms; t++) {
        int m = panel_spline_harmonic(term[t]);
        double wave = (1 + m * m) * (1 + m * m), w = normal->total * STEP_PENALTY;
        double size = normal->total * LEAST_PENALTY + (m ? doubt * wave / (SIZE * SIZE) : 0);
        w += doubt * wave / (STEP * STEP);
        for (int i = 0; i < PANEL_SPLINE_NUMBERS; i++) {
            size_t a = (size_t)(t * PANEL_SPLINE_NUMBERS + i);
            bool is_power = i == PANEL_SPLINE_COEFFICIENTS;
            normal->matrix[a * n + a] +=
                is_power ? normal->total * POWER_PENALTY + doubt * wave : size;
            if (is_power || i == 0) continue;
            normal->matrix[a * n + a] += w;
            normal->matrix[(a - 1) * n + a - 1] += w;
            normal->matrix[a * n + a - 1] -= w;
        }
    }
}

/* One component's numbers [term][number]. */
static void solve_component(const Normal *normal, int component, const EmissionModel *model,
                            float *numbers, Arena scratch) {
    size_t n = (size_t)normal->unknowns;
    Normal one = *normal;
    double *right = ARENA_NEW(&scratch, double, n);
    one.matrix = ARENA_NEW(&scratch, double, n *n);
    memcpy(one.matrix, normal->matrix, n * n * sizeof *one.matrix);
    for (size_t a = 0; a < n; a++)
        right[a] = normal->right[a * (size_t)normal->components + (size_t)component];
    add_penalties(&one, one.term, one.terms, (double)model->score_noise[component],
                  model->samples->rows);
    least_squares_factor(one.matrix, n);
    least_squares_solve(one.matrix, right, n);
    for (size_t a = 0; a < n; a++) {
        size_t t = a / PANEL_SPLINE_NUMBERS, i = a % PANEL_SPLINE_NUMBERS;
        numbers[(t * (size_t)normal->components + (size_t)component) * PANEL_SPLINE_NUMBERS + i] =
            (float)right[a];
    }
}

/* The largest number of a block decides whether it is worth storing. */
static void drop_small_blocks(float *numbers, int terms, int components, const float *worth) {
    for (int b = 0; b < terms * components; b++) {
        float *block = numbers + b * PANEL_SPLINE_NUMBERS, most = 0;
        for (int i = 0; i < PANEL_SPLINE_NUMBERS; i++) most = fmaxf(most, fabsf(block[i]));
        if (most < worth[b % components]) memset(block, 0, sizeof *block * PANEL_SPLINE_NUMBERS);
    }
}

/* Into the model, as it will be read again. */
static bool keep_smooth(EmissionModel *model, const PanelSplineNumbers *all, Arena *arena) {
    size_t used;
    model->spline_size = panel_spline_pack(all, arena, &model->spline_bytes);
    return panel_spline_open(model->spline_bytes, model->spline_size, all->components, arena,
                             &model->spline, &used);
}

static void add_rows(Normal *normal, const EmissionModel *model) {
    const EmissionSamples *s = model->samples;
    for (int i = 0; i < s->rows; i++) {
        Taps taps;
        find_taps(normal->term, normal->terms, s->direction[i], &taps);
        add_sample(normal, &taps, model->rank->score + i * normal->components,
                   (double)model->rank->belief[i] * s->area[i]);
    }
}

/* Scattered rows leave holes in which harmonics would run away: the surface through them is
 * fitted instead. */
static void add_surface(Normal *normal, const EmissionModel *model, Arena scratch) {
    const EmissionSamples *s = model->samples;
    VertexLattice lattice = {SURFACE_LEVEL, 4};
    size_t n = (size_t)normal->components, count = vertex_count(lattice);
    Vec3 *at = ARENA_NEW(&scratch, Vec3, count);
    const ScatterSurface *surface =
        scatter_surface_make(s->master, false, model->rank->score, (int)n, &scratch);
    vertex_directions(lattice, at);
    for (size_t v = 0; v < count; v++) {
        Taps taps;
        float score[PANEL_COMPONENTS_MAX];
        if ((double)at[v].z < cos_d(s->cone)) continue;
        scatter_surface_read(surface, at[v], score);
        find_taps(normal->term, normal->terms, at[v], &taps);
        add_sample(normal, &taps, score, 1);
    }
}

bool emission_model_fit_smooth(EmissionModel *model, Arena *arena) {
    const EmissionSamples *samples = model->samples;
    const EmissionRank *rank = model->rank;
    uint8_t term[PANEL_SPLINE_TERMS_MAX];
    int terms = choose_terms(samples->azimuths, term), components = rank->components;
    if (model->has_edges) terms = 1;
    Arena scratch = arena_reserve((size_t)64 << 20);
    Normal normal = {terms * PANEL_SPLINE_NUMBERS, components, NULL, NULL, 0, term, terms};
    size_t unknowns = (size_t)normal.unknowns;
    normal.matrix = ARENA_NEW(&scratch, double, unknowns *unknowns);
    normal.right = ARENA_NEW(&scratch, double, unknowns *(size_t)components);
    if (model->is_scattered) add_surface(&normal, model, scratch);
    else add_rows(&normal, model);
    float *numbers = ARENA_NEW(&scratch, float, unknowns *(size_t)components);
    for (int k = 0; k < components && !model->has_edges; k++)
        solve_component(&normal, k, model, numbers, scratch);
    drop_small_blocks(numbers, terms, components, model->step);
    PanelSplineNumbers all = {term, terms, components, numbers, model->step};
    bool ok = keep_smooth(model, &all, arena);
    arena_release(&scratch);
    return ok;
}
