/* SPDX-License-Identifier: Apache-2.0 */
/* A query's factors are rounded first, so that all later steps use the file's own numbers. */
#include "panel/fit/reflection/reflection_spectra.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "panel/fit/common/small_matrix.h"
#include "panel/query/panel_components.h"

#define PLACES_ENOUGH 17000 /* to find components from; what is left out is judged on all */
#define SPECTRAL_SHARE 0.06 /* of the bound: rms that spectra may lose */
#define JOINT_SHARE 0.06    /* of the bound: rms that components may lose */

/* Places that components are found from. */
static int stride_of(const ReflectionModel *model) {
    return 1 + model->places / PLACES_ENOUGH;
}

static int chosen_places(const ReflectionModel *model) {
    return (model->places + stride_of(model) - 1) / stride_of(model);
}

static double *ones(int count, Arena *arena) {
    double *out = ARENA_NEW(arena, double, count);
    for (int i = 0; i < count; i++) out[i] = 1;
    return out;
}

/* Multiples of scale, in +-32767. */
static float rounded(float value, float scale) {
    return scale > 0 ? scale * rintf(value / scale) : 0;
}

/* ---- means ------------------------------------------------------------------------------- */

/* Mean logarithm of every table and wavelength over the chosen places. */
static void choose_means(ReflectionModel *model) {
    size_t count = (size_t)model->tables * (size_t)model->wavelengths;
    double *sum = ARENA_NEW(model->arena, double, count);
    float most = 0;
    for (int i = 0; i < model->places; i += stride_of(model))
        for (size_t c = 0; c < count; c++)
            sum[c] += (double)model->value[(size_t)i * count + c] / chosen_places(model);
    for (size_t c = 0; c < count; c++) most = fmaxf(most, fabsf((float)sum[c]));
    model->mean_scale = (most + 1) / 32767;
    model->mean = ARENA_NEW(model->arena, float, count);
    for (size_t c = 0; c < count; c++) model->mean[c] = rounded((float)sum[c], model->mean_scale);
}

/* ---- spectra ----------------------------------------------------------------------------- */

/* Rows of the chosen places and all tables, less the means. */
static float *centred_rows(const ReflectionModel *model, Arena *arena) {
    int stride = stride_of(model), n = model->wavelengths;
    size_t size = (size_t)model->tables * (size_t)n, to = 0;
    float *out = ARENA_NEW(arena, float, (size_t)chosen_places(model) * size);
    for (int i = 0; i < model->places; i += stride)
        for (size_t c = 0; c < size; c++)
            out[to++] = model->value[(size_t)i * size + c] - model->mean[c];
    return out;
}

static void take_principal(ReflectionModel *model, const float *rows, int count, double tolerance,
                           Arena scratch) {
    int n = model->wavelengths;
    int most = n < PANEL_COEFFICIENTS_MAX ? n : PANEL_COEFFICIENTS_MAX;
    PrincipalShape shape = {count, n, most, tolerance};
    Principal p =
        principal_components(rows, ones(count, &scratch), ones(n, &scratch), shape, &scratch);
    model->coefficients = p.components;
    for (int k = 0; k < p.components; k++)
        for (int w = 0; w < n; w++) model->basis[k * n + w] = p.loading[w * p.components + k];
}

static void round_basis(ReflectionModel *model) {
    int n = model->wavelengths;
    for (int k = 0; k < model->coefficients; k++) {
        float most = 1e-12f, *row = model->basis + k * n;
        for (int w = 0; w < n; w++) most = fmaxf(most, fabsf(row[w]));
        model->basis_scale[k] = most / 32767;
        for (int w = 0; w < n; w++) row[w] = rounded(row[w], model->basis_scale[k]);
    }
}

static void choose_basis(ReflectionModel *model, double tolerance, Arena scratch) {
    int count = chosen_places(model) * model->tables;
    float *rows = centred_rows(model, &scratch);
    take_principal(model, rows, count, tolerance, scratch);
    round_basis(model);
}

/* inverse[k][w]: coefficients of a spectrum by least squares on the rounded basis. */
static double *pseudo_inverse(const ReflectionModel *model, Arena *arena) {
    int n = model->wavelengths, m = model->coefficients;
    double *gram = ARENA_NEW(arena, double, m *(m + n));
    for (int a = 0; a < m; a++) {
        double *row = gram + a * (m + n);
        for (int b = 0; b < m; b++)
            for (int w = 0; w < n; w++)
                row[b] += (double)model->basis[a * n + w] * (double)model->basis[b * n + w];
        for (int w = 0; w < n; w++) row[m + w] = (double)model->basis[a * n + w];
    }
    for (int a = 0; a < m; a++) { /* Gauss and Jordan; the Gram matrix is positive */
        double *row = gram + a * (m + n), pivot = 1 / row[a];
        for (int c = 0; c < m + n; c++) row[c] *= pivot;
        for (int b = 0; b < m; b++) {
            double *other = gram + b * (m + n), factor = other[a];
            if (b == a || factor == 0) continue;
            for (int c = 0; c < m + n; c++) other[c] -= factor * row[c];
        }
    }
    return gram;
}

/* Coefficients of every table at one place. */
static void place_coefficients(const ReflectionModel *model, const double *inverse, int place,
                               float *out) {
    int n = model->wavelengths, m = model->coefficients;
    for (int t = 0; t < model->tables; t++) {
        const float *row = reflection_model_row(model, model->value, place, t);
        for (int k = 0; k < m; k++) {
            const double *weight = inverse + k * (m + n) + m;
            double sum = 0;
            for (int w = 0; w < n; w++)
                sum += weight[w] * (double)(row[w] - model->mean[t * n + w]);
            out[t * m + k] = (float)sum;
        }
    }
}

/* ---- components that all tables share ---------------------------------------------------- */

/* Weights of the coefficients' errors in logarithms: the rms of their rows. */
static double *coefficient_weights(const ReflectionModel *model, Arena *arena) {
    int n = model->wavelengths, m = model->coefficients;
    double *out = ARENA_NEW(arena, double, model->tables *m);
    for (int c = 0; c < model->tables * m; c++) {
        double squares = 0;
        for (int w = 0; w < n; w++) squares += pow_d((double)model->basis[c % m * n + w], 2);
        out[c] = sqrt(squares / n);
    }
    return out;
}

static void round_loadings(ReflectionModel *model) {
    int channels = model->tables * model->coefficients, n = model->components;
    for (int c = 0; c < n; c++) {
        float most = 1e-12f;
        for (int i = 0; i < channels; i++) most = fmaxf(most, fabsf(model->loading[i * n + c]));
        model->loading_scale[c] = most / 32767;
        for (int i = 0; i < channels; i++)
            model->loading[i * n + c] = rounded(model->loading[i * n + c], model->loading_scale[c]);
    }
}

/* The components' values at all places: the weighted coefficients on the loadings, which are
 * orthogonal (up to their rounding) when weighted. */
static void fill_scores(ReflectionModel *model, const double *inverse, const double *weight) {
    int channels = model->tables * model->coefficients, n = model->components;
    model->score = ARENA_NEW(model->arena, float, (size_t)model->places *(size_t)n);
    Arena scratch = *model->arena;
    float *coefficient = ARENA_NEW(&scratch, float, channels);
    double *onto = ARENA_NEW(&scratch, double, channels *n);
    for (int c = 0; c < n; c++) {
        double squares = 0;
        for (int i = 0; i < channels; i++)
            squares += pow_d(weight[i] * (double)model->loading[i * n + c], 2);
        for (int i = 0; i < channels; i++)
            onto[i * n + c] = weight[i] * weight[i] * (double)model->loading[i * n + c] / squares;
    }
    for (int p = 0; p < model->places; p++) {
        double sum[PANEL_REFLECTION_COMPONENTS_MAX] = {0};
        place_coefficients(model, inverse, p, coefficient);
        for (int i = 0; i < channels; i++)
            for (int c = 0; c < n; c++) sum[c] += (double)coefficient[i] * onto[i * n + c];
        float *to = model->score + (size_t)p * (size_t)n;
        for (int c = 0; c < n; c++) to[c] = (float)sum[c];
    }
}

static void choose_loadings(ReflectionModel *model, const double *inverse, const double *weight,
                            double tolerance, Arena scratch) {
    int channels = model->tables * model->coefficients, stride = stride_of(model);
    int count = chosen_places(model);
    float *rows = ARENA_NEW(&scratch, float, (size_t)count *(size_t)channels);
    for (int i = 0; i < count; i++)
        place_coefficients(model, inverse, i * stride, rows + (size_t)i * (size_t)channels);
    int most =
        channels < PANEL_REFLECTION_COMPONENTS_MAX ? channels : PANEL_REFLECTION_COMPONENTS_MAX;
    PrincipalShape shape = {count, channels, most, tolerance / sqrt(model->coefficients)};
    Principal p = principal_components(rows, ones(count, &scratch), weight, shape, &scratch);
    model->components = p.components;
    memcpy(model->loading, p.loading, sizeof(float) * (size_t)channels * (size_t)p.components);
    round_loadings(model);
}

/* ---- back to logarithms ------------------------------------------------------------------ */

static void fill_matrix(ReflectionModel *model) {
    int n = model->components, m = model->coefficients, wavelengths = model->wavelengths;
    model->padded = (wavelengths + 3) / 4 * 4;
    model->padded_mean = ARENA_NEW(model->arena, float, model->tables * model->padded);
    model->matrix = ARENA_NEW(model->arena, float, model->tables *n * model->padded);
    for (int t = 0; t < model->tables; t++)
        for (int w = 0; w < wavelengths; w++) {
            model->padded_mean[t * model->padded + w] = model->mean[t * wavelengths + w];
            for (int c = 0; c < n; c++) {
                float *at = &model->matrix[(t * n + c) * model->padded + w];
                for (int k = 0; k < m; k++)
                    *at += model->loading[(t * m + k) * n + c] * model->basis[k * wavelengths + w];
            }
        }
}

/* Four wavelengths from `first` on. */
static inline PanelFloat4 four_logs(const ReflectionModel *model, int table, const float *component,
                                    int first) {
    const float *row = model->matrix + table * model->components * model->padded + first;
    const float *mean = model->padded_mean + table * model->padded + first;
    PanelFloat4 sum = *(const PanelFloat4 *)mean;
    for (int c = 0; c < model->components; c++, row += model->padded)
        sum += component[c] * *(const PanelFloat4 *)row;
    return sum;
}

void reflection_spectra_logs(const ReflectionModel *model, int table, const float *component,
                             float *logs) {
    for (int first = 0; first < model->wavelengths; first += 4) {
        PanelFloat4 four = four_logs(model, table, component, first);
        for (int i = 0; i < 4 && first + i < model->wavelengths; i++) logs[first + i] = four[i];
    }
}

bool reflection_spectra_is_near(const ReflectionModel *model, int table, const float *component,
                                const float *wanted, float tolerance) {
    for (int first = 0; first < model->wavelengths; first += 4) {
        PanelFloat4 four = four_logs(model, table, component, first);
        for (int i = 0; i < 4 && first + i < model->wavelengths; i++) {
            float error = four[i] - wanted[first + i];
            if (!(error <= tolerance && error >= -tolerance)) return false;
        }
    }
    return true;
}

void reflection_spectra_choose(ReflectionModel *model) {
    double noise = reflection_parts_most_noise(model->parts);
    double spectral = fmax(SPECTRAL_SHARE * model->bound, noise);
    double joint = fmax(JOINT_SHARE * model->bound, 0.5 * noise);
    size_t rows = (size_t)model->wavelengths * PANEL_COEFFICIENTS_MAX;
    size_t channels = (size_t)model->tables * PANEL_COEFFICIENTS_MAX;
    model->basis = ARENA_NEW(model->arena, float, rows);
    model->loading = ARENA_NEW(model->arena, float, channels *PANEL_REFLECTION_COMPONENTS_MAX);
    choose_means(model);
    choose_basis(model, spectral, *model->arena);
    const double *inverse = pseudo_inverse(model, model->arena);
    const double *weight = coefficient_weights(model, model->arena);
    choose_loadings(model, inverse, weight, joint, *model->arena);
    fill_scores(model, inverse, weight);
    fill_matrix(model);
}
