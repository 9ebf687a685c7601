/* SPDX-License-Identifier: Apache-2.0 */
/* flat_tables.h -- what a program without compression would do: the recipe's closed form at
 * even steps, read by linear interpolation. For bench_panel.c, which says what they hold.
 */
#pragma once
#include <math.h>

#include "base/mathf.h"
#include "base/units.h"
#include "panel/set/synthetic_panel.h"
#include "spectrum/spectrum.h"

typedef float Float4 __attribute__((vector_size(16), aligned(4), may_alias));

/* ---- flat emission --------------------------------------------------------------------- */

/* Which two levels a code lies between, and their weights (of logarithms). */
typedef struct LevelWeights {
    int first;
    float weight[2], offset; /* offset: -1e4 for code 0, which adds nothing */
} LevelWeights;

typedef struct FlatEmission {
    int thetas, phis, stride; /* stride: floats of a node */
    float theta_scale, phi_scale;
    float *node;
    LevelWeights level[256];
    size_t bytes;
} FlatEmission;

static Vec3 direction_of(double theta, double phi) {
    return vec3((float)(sin(theta) * cos(phi)), (float)(sin(theta) * sin(phi)), (float)cos(theta));
}

static void set_level_weights(const SyntheticPanel *recipe, FlatEmission *flat) {
    const SyntheticEmission *e = &recipe->emission;
    for (int code = 0; code < 256; code++) {
        LevelWeights *w = &flat->level[code];
        int i = 0;
        while (i + 2 < e->level_count && e->level[i + 1] <= code) i++;
        double t = code ? log(code / e->level[i]) / log(e->level[i + 1] / e->level[i]) : 0;
        *w = (LevelWeights){i, {(float)(1 - t), (float)t}, code ? 0 : -1e4f};
    }
}

/* ln of a node's levels, X, Y, Z and a padding number each, red first; last: black. */
static void emission_node(const SyntheticPanel *recipe, double theta, double phi, float *node) {
    int levels = recipe->emission.level_count;
    double xyz[3], angles[2] = {fmin(theta, 0.5 * PI - 1e-4), phi};
    for (int p = 0; p < 3; p++)
        for (int i = 0; i < levels; i++) {
            closed_form_emission_xyz(recipe, p, recipe->emission.level[i], angles, xyz);
            for (int j = 0; j < 3; j++)
                node[4 * (p * levels + i) + j] = (float)log(fmax(xyz[j], 1e-12));
        }
    closed_form_black_xyz(recipe, angles, xyz);
    for (int j = 0; j < 3; j++) node[12 * levels + j] = (float)log(fmax(xyz[j], 1e-12));
}

static FlatEmission flat_emission_shape(const SyntheticPanel *recipe, double step_deg) {
    FlatEmission flat = {.thetas = (int)ceil(90 / step_deg) + 1,
                         .phis = (int)ceil(360 / step_deg),
                         .stride = 4 * (3 * recipe->emission.level_count + 1)};
    flat.theta_scale = (float)((flat.thetas - 1) / (0.5 * PI));
    flat.phi_scale = (float)(flat.phis / (2 * PI));
    flat.bytes = sizeof(float) * (size_t)flat.thetas * (size_t)flat.phis * (size_t)flat.stride;
    set_level_weights(recipe, &flat);
    return flat;
}

static FlatEmission flat_emission(const SyntheticPanel *recipe, double step_deg, Arena *arena) {
    FlatEmission flat = flat_emission_shape(recipe, step_deg);
    flat.node = arena_alloc(arena, 1, 64, flat.bytes + 64);
    for (int t = 0; t < flat.thetas; t++)
        for (int p = 0; p < flat.phis; p++)
            emission_node(recipe, t / (double)flat.theta_scale, p / (double)flat.phi_scale,
                          flat.node + (size_t)(t * flat.phis + p) * (size_t)flat.stride);
    return flat;
}

/* Place on an axis: *index and the weight of the next node. */
static inline float place_on(float at, int last, int *index) {
    int i = (int)at;
    if (i > last) i = last;
    *index = i;
    return at - (float)i;
}

static inline Float4 load_4(const float *from) {
    return *(const Float4 *)from;
}

/* XYZ from four nodes with the bilinear weights w. */
static inline void emission_from(const FlatEmission *flat, const float *const node[4],
                                 const float w[4], const int code[3], float xyz[3]) {
    union {
        Spectrum lanes;
        Float4 source[4];
    } logs;
    int levels = (flat->stride - 4) / 12;
    for (int p = 0; p < 3; p++) {
        const LevelWeights *l = &flat->level[code[p]];
        int at = 4 * (p * levels + l->first);
        Float4 low = {0}, high = {0};
        for (int c = 0; c < 4; c++) {
            low += w[c] * load_4(node[c] + at);
            high += w[c] * load_4(node[c] + at + 4);
        }
        logs.source[p] = l->weight[0] * low + l->weight[1] * high + l->offset;
    }
    logs.source[3] = (Float4){0};
    for (int c = 0; c < 4; c++) logs.source[3] += w[c] * load_4(node[c] + 12 * levels);
    logs.lanes = spectrum_exp(logs.lanes);
    Float4 sum = logs.source[0] + logs.source[1] + logs.source[2] + logs.source[3];
    for (int j = 0; j < 3; j++) xyz[j] = sum[j];
}

static inline float turn_of(Vec3 d) {
    float phi = atan2_f(d.y, d.x);
    return phi < 0 ? phi + 2 * PI_F : phi;
}

static void flat_emission_xyz(const FlatEmission *flat, Vec3 d, const int code[3], float xyz[3]) {
    int t, p;
    float x = place_on(acos_f(d.z) * flat->theta_scale, flat->thetas - 2, &t);
    float y = place_on(turn_of(d) * flat->phi_scale, flat->phis - 1, &p);
    int next = p + 1 == flat->phis ? 0 : p + 1;
    const float *row = flat->node + (size_t)(t * flat->phis) * (size_t)flat->stride;
    const float *below = row + (size_t)flat->phis * (size_t)flat->stride;
    const float *node[4] = {row + p * flat->stride, row + next * flat->stride,
                            below + p * flat->stride, below + next * flat->stride};
    const float w[4] = {(1 - x) * (1 - y), (1 - x) * y, x * (1 - y), x * y};
    emission_from(flat, node, w, code, xyz);
}

/* ---- flat BRDF ------------------------------------------------------------------------- */

/* theta_i, theta_o: so many nodes over 0..90 degrees; phi: over 0..180 (mirror-symmetric). */
typedef struct FlatBrdf {
    int thetas, phis;
    float theta_scale, phi_scale;
    Spectrum *node;
    size_t bytes;
} FlatBrdf;

static FlatBrdf flat_brdf_shape(double step_deg) {
    FlatBrdf flat = {.thetas = (int)ceil(90 / step_deg) + 1, .phis = (int)ceil(180 / step_deg) + 1};
    flat.theta_scale = (float)((flat.thetas - 1) / (0.5 * PI));
    flat.phi_scale = (float)((flat.phis - 1) / PI);
    flat.bytes = sizeof(Spectrum) * (size_t)flat.thetas * (size_t)flat.thetas * (size_t)flat.phis;
    return flat;
}

/* Times do not depend on the values: all lanes have the one of 550 nm. */
static FlatBrdf flat_brdf(const SyntheticPanel *recipe, double step_deg, Arena *arena) {
    FlatBrdf flat = flat_brdf_shape(step_deg);
    size_t at = 0;
    flat.node = arena_alloc(arena, 1, 64, flat.bytes);
    for (int i = 0; i < flat.thetas; i++)
        for (int o = 0; o < flat.thetas; o++)
            for (int p = 0; p < flat.phis; p++)
                flat.node[at++] = spectrum_all((float)closed_form_brdf(
                    recipe, i / (double)flat.theta_scale, o / (double)flat.theta_scale,
                    p / (double)flat.phi_scale, 550));
    return flat;
}

/* Azimuth of wo from the mirror direction of wi, folded to 0..pi. */
static inline float azimuth_between(Vec3 wo, Vec3 wi) {
    float c = -(wo.x * wi.x + wo.y * wi.y), s = wo.y * wi.x - wo.x * wi.y;
    return fabsf(atan2_f(s, c));
}

static Spectrum flat_brdf_value(const FlatBrdf *flat, Vec3 wo, Vec3 wi) {
    int i, o, p;
    float x = place_on(acos_f(wi.z) * flat->theta_scale, flat->thetas - 2, &i);
    float y = place_on(acos_f(wo.z) * flat->theta_scale, flat->thetas - 2, &o);
    float z = place_on(azimuth_between(wo, wi) * flat->phi_scale, flat->phis - 2, &p);
    const Spectrum *a = flat->node +
                        ((size_t)i * (size_t)flat->thetas + (size_t)o) * (size_t)flat->phis +
                        (size_t)p;
    const Spectrum *b = a + flat->phis, *c = a + (size_t)flat->thetas * (size_t)flat->phis;
    const Spectrum *d = c + flat->phis;
    float near = (1 - x) * (1 - y), over = (1 - x) * y, up = x * (1 - y), far = x * y;
    return spectrum_all(near * (1 - z)) * a[0] + spectrum_all(near * z) * a[1] +
           spectrum_all(over * (1 - z)) * b[0] + spectrum_all(over * z) * b[1] +
           spectrum_all(up * (1 - z)) * c[0] + spectrum_all(up * z) * c[1] +
           spectrum_all(far * (1 - z)) * d[0] + spectrum_all(far * z) * d[1];
}

/* ---- flat sampling --------------------------------------------------------------------- */

/* Cumulative sums of f cos over cells of theta and phi (one half), a slice every so many
 * degrees of wo: rows[slice][theta + 1], cells[slice][theta][phi + 1], both from 0 to 1. */
typedef struct FlatSampling {
    int slices, thetas, phis;
    float slice_scale, theta_step, phi_step;
    float *rows, *cells;
    size_t bytes;
} FlatSampling;

static FlatSampling flat_sampling(const SyntheticPanel *recipe, double slice_deg, double step_deg,
                                  Arena *arena) {
    FlatSampling f = {.slices = (int)ceil(90 / slice_deg) + 1,
                      .thetas = (int)ceil(90 / step_deg),
                      .phis = (int)ceil(180 / step_deg)};
    f.slice_scale = (float)((f.slices - 1) / (0.5 * PI));
    f.theta_step = (float)(0.5 * PI / f.thetas);
    f.phi_step = (float)(PI / f.phis);
    size_t rows = (size_t)f.slices * (size_t)(f.thetas + 1);
    size_t cells = (size_t)f.slices * (size_t)f.thetas * (size_t)(f.phis + 1);
    f.bytes = sizeof(float) * (rows + cells);
    f.rows = arena_alloc(arena, sizeof(float), 64, rows);
    f.cells = arena_alloc(arena, sizeof(float), 64, cells);
    float *row = f.rows, *cell = f.cells;
    for (int s = 0; s < f.slices; s++) {
        double sum = 0, wo = fmin(s / (double)f.slice_scale, 0.5 * PI - 1e-3);
        for (int t = 0; t < f.thetas; t++, cell += f.phis + 1) {
            double ring = 0, theta = (t + 0.5) * (double)f.theta_step;
            for (int p = 0; p < f.phis; p++) {
                ring += closed_form_brdf(recipe, wo, theta, (p + 0.5) * (double)f.phi_step, 550);
                cell[p + 1] = (float)ring;
            }
            for (int p = 0; p < f.phis; p++) cell[p + 1] /= (float)ring;
            sum += ring * cos(theta) * sin(theta);
            row[t + 1] = (float)sum;
        }
        for (int t = 0; t < f.thetas; t++) row[t + 1] /= (float)sum;
        row += f.thetas + 1;
    }
    return f;
}

/* The interval of a rising table from 0 to 1 that holds u. */
static inline int find_interval(const float *table, int count, float u) {
    int low = 0;
    while (count > 1) {
        int half = count / 2;
        if (table[low + half] <= u) low += half;
        count -= half;
    }
    return low;
}

static inline float slice_pdf(const FlatSampling *f, int slice, int t, int p, float sine) {
    const float *row = f->rows + slice * (f->thetas + 1) + t;
    const float *cell = f->cells +
                        ((size_t)slice * (size_t)f->thetas + (size_t)t) * (size_t)(f->phis + 1) +
                        (size_t)p;
    return (row[1] - row[0]) * (cell[1] - cell[0]) /
           (2 * f->theta_step * f->phi_step * sine); /* 2: both halves */
}

/* Draws from one of two slices by linear weight; the density is the mixture's. */
static float flat_sample(const FlatSampling *f, Vec3 wo, const float u[3], Vec3 *wi) {
    int s;
    float x = place_on(acos_f(wo.z) * f->slice_scale, f->slices - 2, &s);
    bool is_far = u[2] < x;
    float side = is_far ? u[2] / x : (u[2] - x) / (1 - x);
    const float *row = f->rows + (s + is_far) * (f->thetas + 1);
    int t = find_interval(row, f->thetas, u[0]);
    const float *cell =
        f->cells + ((size_t)(s + is_far) * (size_t)f->thetas + (size_t)t) * (size_t)(f->phis + 1);
    int p = find_interval(cell, f->phis, u[1]);
    float a = (u[0] - row[t]) / (row[t + 1] - row[t]);
    float b = (u[1] - cell[p]) / (cell[p + 1] - cell[p]);
    float sine, cosine, sine_phi, cosine_phi;
    sincos_turns(((float)t + a) * f->theta_step / (2 * PI_F), &sine, &cosine);
    sincos_turns(((float)p + b) * f->phi_step / (2 * PI_F), &sine_phi, &cosine_phi);
    if (side < 0.5f) sine_phi = -sine_phi;
    float across = 1 / fmaxf(1e-6f, sqrtf(wo.x * wo.x + wo.y * wo.y));
    float ex = -wo.x * across, ey = -wo.y * across;
    *wi = vec3(sine * (ex * cosine_phi - ey * sine_phi), sine * (ey * cosine_phi + ex * sine_phi),
               cosine);
    return (1 - x) * slice_pdf(f, s, t, p, sine) + x * slice_pdf(f, s + 1, t, p, sine);
}
