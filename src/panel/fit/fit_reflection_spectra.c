/* A reflection as few numbers a place: spectra on a few rows of a basis, and the tables'
 * coefficients on a few principal components that all tables share. What a query multiplies is
 * rounded first, so that everything behind counts with the file's own numbers. */
#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "panel/fit/fit_reflect.h"
#include "panel/fit/principal.h"

#define PLACES_ENOUGH 17000 /* to find components from; what is left out is judged on all */
#define SPECTRAL_SHARE 0.06 /* of the bound: rms that spectra may lose */
#define JOINT_SHARE 0.06    /* of the bound: rms that components may lose */

/* Places that components are found from. */
static int stride_of(const ReflectionFit *fit)
{
    return 1 + fit->places / PLACES_ENOUGH;
}

static int chosen_places(const ReflectionFit *fit)
{
    return (fit->places + stride_of(fit) - 1) / stride_of(fit);
}

static double *ones(int count, Arena *arena)
{
    double *out = ARENA_NEW(arena, double, count);
    for (int i = 0; i < count; i++) out[i] = 1;
    return out;
}

static double largest_noise(const ReflectionFit *fit)
{
    double most = 0;
    for (int t = 0; t < fit->tables; t++) most = fmax(most, fit->out->noise[t]);
    return most;
}

/* Multiples of scale, in +-32767. */
static float rounded(float value, float scale)
{
    return scale > 0 ? scale * rintf(value / scale) : 0;
}

/* ---- means ------------------------------------------------------------------------------- */

/* Mean logarithm of every table and wavelength over the chosen places. */
static void choose_means(ReflectionFit *fit)
{
    size_t  count = (size_t)fit->tables * (size_t)fit->wavelengths;
    double *sum = ARENA_NEW(fit->arena, double, count);
    float   most = 0;
    for (int i = 0; i < fit->places; i += stride_of(fit))
        for (size_t c = 0; c < count; c++)
            sum[c] += (double)fit->value[(size_t)i * count + c] / chosen_places(fit);
    for (size_t c = 0; c < count; c++) most = fmaxf(most, fabsf((float)sum[c]));
    fit->mean_scale = (most + 1) / 32767;
    fit->mean = ARENA_NEW(fit->arena, float, count);
    for (size_t c = 0; c < count; c++) fit->mean[c] = rounded((float)sum[c], fit->mean_scale);
}

/* ---- spectra ----------------------------------------------------------------------------- */

/* Rows of the chosen places and all tables, less the means. */
static float *centred_rows(const ReflectionFit *fit, Arena *arena)
{
    int    stride = stride_of(fit), n = fit->wavelengths;
    size_t size = (size_t)fit->tables * (size_t)n, to = 0;
    float *out = ARENA_NEW(arena, float, (size_t)chosen_places(fit) * size);
    for (int i = 0; i < fit->places; i += stride)
        for (size_t c = 0; c < size; c++)
            out[to++] = fit->value[(size_t)i * size + c] - fit->mean[c];
    return out;
}

static void take_principal(ReflectionFit *fit, const float *rows, int count, double tolerance,
                           Arena scratch)
{
    int n = fit->wavelengths;
    int most = n < PANEL_COEFFICIENTS_MAX ? n : PANEL_COEFFICIENTS_MAX;
    PrincipalShape shape = {count, n, most, tolerance};
    Principal p = principal_components(rows, ones(count, &scratch), ones(n, &scratch), shape,
                                       &scratch);
    fit->coefficients = p.components;
    for (int k = 0; k < p.components; k++)
        for (int w = 0; w < n; w++)
            fit->basis[k * n + w] = p.loading[w * p.components + k];
}

/* The strongest wavelet coefficients, until what is left out is within the tolerance. */
static void take_wavelets(ReflectionFit *fit, float *rows, int count, double tolerance)
{
    int    n = fit->wavelengths, used = 0;
    double energy[MEASUREMENT_WAVELENGTHS_MAX] = {0}, rest = 0;
    float  norm[MEASUREMENT_WAVELENGTHS_MAX];
    WaveletKind kind = fit->options->wavelet;
    wavelet1d_norms(kind, n, norm);
    for (int i = 0; i < count; i++) {
        float *row = rows + (size_t)i * (size_t)n;
        wavelet1d_forward(kind, row, n);
        for (int w = 0; w < n; w++)
            energy[w] += (double)(row[w] * norm[w]) * (double)(row[w] * norm[w]) / count;
    }
    for (int w = 0; w < n; w++) rest += energy[w];
    while (used < n && used < PANEL_COEFFICIENTS_MAX) {
        if (used > 0 && used % 4 == 0 && sqrt(fmax(0, rest) / n) <= tolerance) break;
        int best = 0;
        for (int w = 1; w < n; w++)
            if (energy[w] > energy[best]) best = w;
        float *row = fit->basis + (size_t)used++ * (size_t)n;
        row[best] = 1;
        wavelet1d_inverse(kind, row, n);
        rest -= energy[best];
        energy[best] = -1;
    }
    fit->coefficients = used;
}

static void round_basis(ReflectionFit *fit)
{
    int n = fit->wavelengths;
    for (int k = 0; k < fit->coefficients; k++) {
        float most = 1e-12f, *row = fit->basis + k * n;
        for (int w = 0; w < n; w++) most = fmaxf(most, fabsf(row[w]));
        fit->basis_scale[k] = most / 32767;
        for (int w = 0; w < n; w++) row[w] = rounded(row[w], fit->basis_scale[k]);
    }
}

static void choose_basis(ReflectionFit *fit, double tolerance, Arena scratch)
{
    int    count = chosen_places(fit) * fit->tables;
    float *rows = centred_rows(fit, &scratch);
    if (fit->options->has_wavelet) take_wavelets(fit, rows, count, tolerance);
    else take_principal(fit, rows, count, tolerance, scratch);
    round_basis(fit);
}

/* inverse[k][w]: coefficients of a spectrum by least squares on the rounded basis. */
static double *pseudo_inverse(const ReflectionFit *fit, Arena *arena)
{
    int     n = fit->wavelengths, m = fit->coefficients;
    double *gram = ARENA_NEW(arena, double, m * (m + n));
    for (int a = 0; a < m; a++) {
        double *row = gram + a * (m + n);
        for (int b = 0; b < m; b++)
            for (int w = 0; w < n; w++)
                row[b] += (double)fit->basis[a * n + w] * (double)fit->basis[b * n + w];
        for (int w = 0; w < n; w++) row[m + w] = (double)fit->basis[a * n + w];
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
static void place_coefficients(const ReflectionFit *fit, const double *inverse, int place,
                               float *out)
{
    int n = fit->wavelengths, m = fit->coefficients;
    for (int t = 0; t < fit->tables; t++) {
        const float *row = reflect_row(fit, fit->value, place, t);
        for (int k = 0; k < m; k++) {
            const double *weight = inverse + k * (m + n) + m;
            double sum = 0;
            for (int w = 0; w < n; w++)
                sum += weight[w] * (double)(row[w] - fit->mean[t * n + w]);
            out[t * m + k] = (float)sum;
        }
    }
}

/* ---- components that all tables share ---------------------------------------------------- */

/* What an error of a coefficient is worth in logarithms: the rms of its row. */
static double *coefficient_weights(const ReflectionFit *fit, Arena *arena)
{
    int     n = fit->wavelengths, m = fit->coefficients;
    double *out = ARENA_NEW(arena, double, fit->tables * m);
    for (int c = 0; c < fit->tables * m; c++) {
        double squares = 0;
        for (int w = 0; w < n; w++)
            squares += (double)fit->basis[c % m * n + w] * (double)fit->basis[c % m * n + w];
        out[c] = sqrt(squares / n);
    }
    return out;
}

static void round_loadings(ReflectionFit *fit)
{
    int channels = fit->tables * fit->coefficients, n = fit->components;
    for (int c = 0; c < n; c++) {
        float most = 1e-12f;
        for (int i = 0; i < channels; i++) most = fmaxf(most, fabsf(fit->loading[i * n + c]));
        fit->loading_scale[c] = most / 32767;
        for (int i = 0; i < channels; i++)
            fit->loading[i * n + c] = rounded(fit->loading[i * n + c], fit->loading_scale[c]);
    }
}

/* The components' values at all places: the weighted coefficients on the loadings, which are
 * orthogonal (up to their rounding) when weighted. */
static void fill_scores(ReflectionFit *fit, const double *inverse, const double *weight)
{
    int     channels = fit->tables * fit->coefficients, n = fit->components;
    fit->score = ARENA_NEW(fit->arena, float, (size_t)fit->places * (size_t)n);
    Arena   scratch = *fit->arena;
    float  *coefficient = ARENA_NEW(&scratch, float, channels);
    double *onto = ARENA_NEW(&scratch, double, channels * n);
    for (int c = 0; c < n; c++) {
        double squares = 0;
        for (int i = 0; i < channels; i++)
            squares += pow_d(weight[i] * (double)fit->loading[i * n + c], 2);
        for (int i = 0; i < channels; i++)
            onto[i * n + c] = weight[i] * weight[i] * (double)fit->loading[i * n + c] / squares;
    }
    for (int p = 0; p < fit->places; p++) {
        double sum[PANEL_REFLECTION_COMPONENTS_MAX] = {0};
        place_coefficients(fit, inverse, p, coefficient);
        for (int i = 0; i < channels; i++)
            for (int c = 0; c < n; c++) sum[c] += (double)coefficient[i] * onto[i * n + c];
        float *to = fit->score + (size_t)p * (size_t)n;
        for (int c = 0; c < n; c++) to[c] = (float)sum[c];
    }
}

static void choose_loadings(ReflectionFit *fit, const double *inverse, const double *weight,
                            double tolerance, Arena scratch)
{
    int    channels = fit->tables * fit->coefficients, stride = stride_of(fit);
    int    count = chosen_places(fit);
    float  *rows = ARENA_NEW(&scratch, float, (size_t)count * (size_t)channels);
    for (int i = 0; i < count; i++)
        place_coefficients(fit, inverse, i * stride, rows + (size_t)i * (size_t)channels);
    int most = channels < PANEL_REFLECTION_COMPONENTS_MAX ? channels
                                                          : PANEL_REFLECTION_COMPONENTS_MAX;
    PrincipalShape shape = {count, channels, most, tolerance / sqrt(fit->coefficients)};
    Principal p = principal_components(rows, ones(count, &scratch), weight, shape, &scratch);
    fit->components = p.components;
    memcpy(fit->loading, p.loading,
           sizeof(float) * (size_t)channels * (size_t)p.components);
    round_loadings(fit);
}

/* ---- back to logarithms ------------------------------------------------------------------ */

static void fill_matrix(ReflectionFit *fit)
{
    int n = fit->components, m = fit->coefficients, wavelengths = fit->wavelengths;
    fit->padded = (wavelengths + 3) / 4 * 4;
    fit->padded_mean = ARENA_NEW(fit->arena, float, fit->tables * fit->padded);
    fit->matrix = ARENA_NEW(fit->arena, float, fit->tables * n * fit->padded);
    for (int t = 0; t < fit->tables; t++)
        for (int w = 0; w < wavelengths; w++) {
            fit->padded_mean[t * fit->padded + w] = fit->mean[t * wavelengths + w];
            for (int c = 0; c < n; c++) {
                float *at = &fit->matrix[(t * n + c) * fit->padded + w];
                for (int k = 0; k < m; k++)
                    *at += fit->loading[(t * m + k) * n + c] * fit->basis[k * wavelengths + w];
            }
        }
}

/* Four wavelengths from `first` on. */
static inline PanelFloat4 four_logs(const ReflectionFit *fit, int table, const float *component,
                                    int first)
{
    const float *row = fit->matrix + table * fit->components * fit->padded + first;
    PanelFloat4  sum = *(const PanelFloat4 *)(fit->padded_mean + table * fit->padded + first);
    for (int c = 0; c < fit->components; c++, row += fit->padded)
        sum += component[c] * *(const PanelFloat4 *)row;
    return sum;
}

void reflect_logs(const ReflectionFit *fit, int table, const float *component, float *logs)
{
    for (int first = 0; first < fit->wavelengths; first += 4) {
        PanelFloat4 four = four_logs(fit, table, component, first);
        for (int i = 0; i < 4 && first + i < fit->wavelengths; i++) logs[first + i] = four[i];
    }
}

bool reflect_is_near(const ReflectionFit *fit, int table, const float *component,
                     const float *wanted, float tolerance)
{
    for (int first = 0; first < fit->wavelengths; first += 4) {
        PanelFloat4 four = four_logs(fit, table, component, first);
        for (int i = 0; i < 4 && first + i < fit->wavelengths; i++) {
            float error = four[i] - wanted[first + i];
            if (!(error <= tolerance && error >= -tolerance)) return false;
        }
    }
    return true;
}

void reflect_choose_spectra(ReflectionFit *fit)
{
    double noise = largest_noise(fit);
    double spectral = fmax(SPECTRAL_SHARE * fit->bound, noise);
    double joint = fmax(JOINT_SHARE * fit->bound, 0.5 * noise);
    size_t rows = (size_t)fit->wavelengths * PANEL_COEFFICIENTS_MAX;
    size_t channels = (size_t)fit->tables * PANEL_COEFFICIENTS_MAX;
    fit->basis = ARENA_NEW(fit->arena, float, rows);
    fit->loading = ARENA_NEW(fit->arena, float, channels * PANEL_REFLECTION_COMPONENTS_MAX);
    choose_means(fit);
    choose_basis(fit, spectral, *fit->arena);
    const double *inverse = pseudo_inverse(fit, fit->arena);
    const double *weight = coefficient_weights(fit, fit->arena);
    choose_loadings(fit, inverse, weight, joint, *fit->arena);
    fill_scores(fit, inverse, weight);
    fill_matrix(fit);
}
