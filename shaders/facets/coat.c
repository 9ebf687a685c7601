/* SPDX-License-Identifier: Apache-2.0 */
#include "shaders/facets/coat.h"

#include <string.h>

#include "base/mathf.h"
#include "shaders/facets/microfacet.h"
#include "spectrum/fresnel.h"

#define ROUNDS 24 /* of the scaling; it converges by about a digit in three */

/* A lobe as sums over the cosines' hat functions: what it sends there of light from `from`. */
typedef struct HatRow {
    float all[ENERGY_COSINES], shape[ENERGY_COSINES];
} HatRow;

float coat_reflectance(const EnergyTable *coat, float cosine, float coat_alpha) {
    float f0 = fresnel_normal(coat->ior);
    Energy e = energy_directional(coat, cosine, coat_alpha);
    return f0 * e.all + (1 - f0) * e.shape;
}

static void add_to_hats(const EnergyLobe *lobe, HatRow *row) {
    float weight = lobe->weight / ENERGY_LOBE_POINTS;
    float place = safe_sqrtf(lobe->cosine) * (ENERGY_COSINES - 1);
    int low = place < ENERGY_COSINES - 1 ? (int)place : ENERGY_COSINES - 2;
    float above = place - (float)low;
    row->all[low] += weight * (1 - above);
    row->all[low + 1] += weight * above;
    row->shape[low] += weight * lobe->shape * (1 - above);
    row->shape[low + 1] += weight * lobe->shape * above;
}

static void fill_lobe(const EnergyTable *base, int alpha_row, HatRow *rows) {
    float alpha = energy_alpha_of_row(alpha_row, COAT_PER_OCTAVE);
    memset(rows, 0, ENERGY_COSINES * sizeof *rows);
    for (int from = 0; from < ENERGY_COSINES; from++) {
        float cosine = energy_cosine_of_node(from);
        if (alpha_row == 0) {
            rows[from].all[from] = 1;
            rows[from].shape[from] = energy_directional(base, cosine, 0).shape;
            continue;
        }
        EnergyLobe lobe;
        for (int i = 0; i < ENERGY_LOBE_POINTS; i++)
            if (energy_lobe_point(base->ior, cosine, alpha, i, &lobe))
                add_to_hats(&lobe, &rows[from]);
    }
}

static float dot(const float *a, const float *b) {
    float sum = 0;
    for (int i = 0; i < ENERGY_COSINES; i++) sum += a[i] * b[i];
    return sum;
}

/* u: the symmetric scaling of the lobe; each round takes the mean of the old and of what would
 * put the row right. */
static void scale_lobe(const HatRow *rows, const float *open, const float *lobe, float *u) {
    for (int i = 0; i < ENERGY_COSINES; i++) u[i] = sqrtf(open[i]);
    for (int round = 0; round < ROUNDS; round++) {
        float next[ENERGY_COSINES];
        for (int i = 0; i < ENERGY_COSINES; i++) {
            float sent = dot(rows[i].all, u), wanted = open[i] * lobe[i];
            next[i] = sent > 0 ? sqrtf(u[i] * wanted / sent) : 0;
        }
        memcpy(u, next, sizeof next);
    }
}

/* Mean over the hemisphere of f t, f and t linear between nodes: 4 s^3 ds with cosine = s^2. */
static float mean_of(const float *f, const float *t) {
    const int fine = 16;
    double sum = 0;
    for (int i = 0; i < fine * (ENERGY_COSINES - 1); i++) {
        float at = ((float)(i % fine) + 0.5f) / (float)fine;
        double s = (i + 0.5) / (fine * (ENERGY_COSINES - 1));
        int k = i / fine;
        sum += 4 * s * s * s / (fine * (ENERGY_COSINES - 1)) *
               (double)(lerpf(f[k], f[k + 1], at) * lerpf(t[k], t[k + 1], at));
    }
    return (float)sum;
}

static void fill_pair(const EnergyTable *coat, const HatRow *rows, int a, int c, CoatTable *table) {
    float own[ENERGY_COSINES], open[ENERGY_COSINES], u[ENERGY_COSINES], one[ENERGY_COSINES];
    float lobe[ENERGY_COSINES], all[ENERGY_COSINES], shape[ENERGY_COSINES];
    float coat_alpha = energy_alpha_of_row(c, COAT_PER_OCTAVE);
    for (int i = 0; i < ENERGY_COSINES; i++) {
        own[i] = coat_reflectance(coat, energy_cosine_of_node(i), coat_alpha);
        open[i] = max_f(1 - own[i], 0);
        one[i] = 1;
    }
    for (int i = 0; i < ENERGY_COSINES; i++) lobe[i] = dot(rows[i].all, one);
    scale_lobe(rows, open, lobe, u);
    for (int i = 0; i < ENERGY_COSINES; i++) {
        CoatShare share = {u[i], dot(rows[i].all, own), dot(rows[i].shape, own)};
        all[i] = lobe[i] - share.all;
        shape[i] = dot(rows[i].shape, one) - share.shape;
        table->share[a][c][i] = share;
    }
    table->mean[a][c] = (CoatMean){mean_of(one, open), mean_of(lobe, open), mean_of(all, open),
                                   mean_of(shape, open)};
}

const CoatTable *coat_table_build(const EnergyTable *base, const EnergyTable *coat, Arena *arena) {
    CoatTable *table = ARENA_NEW(arena, CoatTable, 1);
    HatRow *rows = ARENA_NEW(arena, HatRow, ENERGY_COSINES);
    table->ior = base->ior;
    for (int a = 0; a < COAT_ALPHAS; a++) {
        fill_lobe(base, a, rows);
        for (int c = 0; c < COAT_ALPHAS; c++) fill_pair(coat, rows, a, c, table);
    }
    return table;
}

/* ---- looking up -------------------------------------------------------------------------- */

static CoatShare mix_shares(CoatShare a, CoatShare b, float t) {
    return (CoatShare){lerpf(a.boost, b.boost, t), lerpf(a.all, b.all, t),
                       lerpf(a.shape, b.shape, t)};
}

static CoatShare share_of_rows(const CoatShare row[ENERGY_COSINES], EnergyKnot c) {
    return mix_shares(row[c.low], row[c.low + 1], c.t);
}

CoatShare coat_share(const CoatTable *table, float cosine, float alpha, float coat_alpha) {
    EnergyKnot a = energy_alpha_knot(alpha, COAT_PER_OCTAVE);
    EnergyKnot k = energy_alpha_knot(coat_alpha, COAT_PER_OCTAVE);
    EnergyKnot c = energy_cosine_knot(cosine, ENERGY_COSINES);
    CoatShare below = mix_shares(share_of_rows(table->share[a.low][k.low], c),
                                 share_of_rows(table->share[a.low][k.low + 1], c), k.t);
    CoatShare above = mix_shares(share_of_rows(table->share[a.low + 1][k.low], c),
                                 share_of_rows(table->share[a.low + 1][k.low + 1], c), k.t);
    return mix_shares(below, above, a.t);
}

static CoatMean mix_means(CoatMean a, CoatMean b, float t) {
    return (CoatMean){lerpf(a.open, b.open, t), lerpf(a.lobe, b.lobe, t), lerpf(a.all, b.all, t),
                      lerpf(a.shape, b.shape, t)};
}

CoatMean coat_mean(const CoatTable *table, float alpha, float coat_alpha) {
    EnergyKnot a = energy_alpha_knot(alpha, COAT_PER_OCTAVE);
    EnergyKnot k = energy_alpha_knot(coat_alpha, COAT_PER_OCTAVE);
    const CoatMean *below = table->mean[a.low], *above = table->mean[a.low + 1];
    return mix_means(mix_means(below[k.low], below[k.low + 1], k.t),
                     mix_means(above[k.low], above[k.low + 1], k.t), a.t);
}

Spectrum coat_turns(float open, Spectrum albedo) {
    return spectrum_all(open) / (spectrum_all(1) - albedo * spectrum_all(1 - open));
}
