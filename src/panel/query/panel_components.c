/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: the components of an emission at a direction, and its light. No allocation, no lock, no
 * libm. */
#include "panel/query/panel_components.h"

#include <string.h>

#include "hemisphere/tree/tree_query.h"
#include "panel/shape/spectral_warp.h"

/* Position in the spline's table over tan(theta / 2): *t in [0, 1] from node to node + 1. */
static inline int spline_node(float tan_half, float *t) {
    float at = clampf(tan_half, 0, 1) * (PANEL_SPLINE_ANGLES - 1);
    int node = (int)at;
    if (node > PANEL_SPLINE_ANGLES - 2) node = PANEL_SPLINE_ANGLES - 2;
    *t = at - (float)node;
    return node;
}

void panel_components_add_spline(const PanelSpline *spline, Vec3 d, float log_cos, float *out) {
    float t, s = safe_sqrtf(d.x * d.x + d.y * d.y);
    float cos_1 = s > 0 ? d.x / s : 1, sin_1 = s > 0 ? d.y / s : 0;
    float angle[PANEL_SPLINE_TERMS_MAX + 1] = {1, cos_1, sin_1};
    int node = spline_node(s / (1 + d.z), &t), row = spline->terms * spline->stride;
    const float *near = spline->table + node * row, *power = spline->power;
    for (int m = 2; m <= spline->harmonics; m++) {
        float c = angle[2 * m - 3], e = angle[2 * m - 2];
        angle[2 * m - 1] = c * cos_1 - e * sin_1;
        angle[2 * m] = e * cos_1 + c * sin_1;
    }
    for (int i = 0; i < spline->terms; i++, near += spline->stride, power += spline->stride) {
        float factor = angle[spline->term[i]];
        float a = factor * (1 - t), b = factor * t, c = factor * log_cos;
        for (int k = 0; k < spline->stride; k += 4)
            *(PanelFloat4 *)(out + k) += *(const PanelFloat4 *)(near + k) * a +
                                         *(const PanelFloat4 *)(near + row + k) * b +
                                         *(const PanelFloat4 *)(power + k) * c;
    }
}

float panel_components(const Panel *panel, Vec3 direction, float *components) {
    const PanelEmission *e = panel->emission;
    for (int k = e->components & ~3; k < e->stride; k++) components[k] = 0;
    tree_interpolate(&panel->emission_tree, direction, components);
    float log_cos = log_f(clampf(direction.z, PANEL_LEAST_COS, 1));
    panel_components_add_spline(&e->spline, direction, log_cos, components);
    return e->cosine_power * log_cos;
}

/* ---- the four sources of the light: red, green, blue and black --------------------------- */

bool panel_sources_are_measured(const Panel *panel, Vec3 direction) {
    return direction.z >= panel->emission->cone_cos - 1e-6f;
}

/* A source's ln XYZ (and a number that means nothing) from one row. */
static inline PanelFloat4 row_logs(const float *row, const float *components, int count) {
    PanelFloat4 sum = *(const PanelFloat4 *)row;
    for (int k = 0; k < count; k++) sum += components[k] * *(const PanelFloat4 *)(row + 4 * k + 4);
    return sum;
}

/* A primary at any code above 0: whole codes have a row; between two of them ln E is linear in
 * ln code; below 1 it is a power law. */
static PanelFloat4 primary_logs(const PanelEmission *e, int primary, float code,
                                const float *components) {
    int size = 4 * (e->components + 1), whole = code < 255 ? (int)code : 255;
    const float *rows = e->code_rows[primary];
    if ((float)whole >= code && whole > 0)
        return row_logs(rows + whole * size, components, e->components);
    if (whole == 0)
        return row_logs(rows + size, components, e->components) +
               row_logs(rows, components, e->components) * log_f(code);
    PanelFloat4 low = row_logs(rows + whole * size, components, e->components);
    PanelFloat4 high = row_logs(rows + (whole + 1) * size, components, e->components);
    float span = e->log_code[whole + 1] - e->log_code[whole];
    return low + (high - low) * ((log_f(code) - e->log_code[whole]) / span);
}

void panel_source_logs(const Panel *panel, Vec3 direction, const float rgb[3],
                       PanelFloat4 logs[4]) {
    const PanelEmission *e = panel->emission;
    float components[PANEL_COMPONENTS_MAX];
    float fall = panel_components(panel, direction, components);
    for (int s = 0; s < 4; s++) logs[s] = (PanelFloat4){0} + PANEL_DARK;
    for (int p = 0; p < 3; p++)
        if (rgb[p] > 0) logs[p] = fall + primary_logs(e, p, rgb[p], components);
    if (e->has_black) logs[3] = fall + row_logs(e->black_rows, components, e->components);
}

void panel_sources_xyz(const PanelFloat4 logs[4], float xyz[3]) {
    PanelFloat4 light[4];
    Spectrum all;
    memcpy(&all, logs, sizeof all);
    /* e^80 cd m^-2 is more than any display sends: a forged file stays finite. */
    all = spectrum_exp(spectrum_min(all, spectrum_all(80)));
    memcpy(light, &all, sizeof all);
    PanelFloat4 sum = (light[0] + light[1]) + (light[2] + light[3]);
    for (int j = 0; j < 3; j++) xyz[j] = sum[j];
}

/* ---- spectra --------------------------------------------------------------------------- */

/* The spectrum of a source at the lanes' wavelengths, linear between whole nm. */
static Spectrum spectrum_of(const float *spectrum, const Wavelengths *wavelengths) {
    Spectrum at = spectrum_clamp(wavelengths->nm - spectrum_all(SPECTRAL_FIRST_NM), 0,
                                 SPECTRAL_COUNT - 1.001f);
    SpectrumMask n = __builtin_convertvector(at, SpectrumMask);
    Spectrum low, high;
    spectrum_neighbours(spectrum, n, &low, &high);
    return low + (at - __builtin_convertvector(n, Spectrum)) * (high - low);
}

#define EXPONENT_MOST 60.0f

/* S = T exp(c0 + c1 t + c2 t^2) Y, t = (lambda - 560 nm) / 180 nm; strictly positive where T
 * is (spectral_warp.h). */
Spectrum panel_sources_spectrum(const Panel *panel, const PanelFloat4 source[4],
                                const Wavelengths *wavelengths) {
    Spectrum sum = spectrum_all(0);
    Spectrum t = (wavelengths->nm - spectrum_all(560)) * spectrum_all(1.0f / 180);
    for (int s = 0; s < 4; s++) {
        float c[3], logs[3] = {source[s][0], source[s][1], source[s][2]};
        if (logs[1] <= PANEL_DARK) continue;
        spectral_warp_at(&panel->primaries->warp[s], logs, c);
        Spectrum exponent =
            (spectrum_all(c[2]) * t + spectrum_all(c[1])) * t + spectrum_all(c[0] + logs[1]);
        /* Far from a narrow primary the curve may run away where the primary is dark: infinity
         * times nothing would be no number. */
        exponent = spectrum_min(exponent, spectrum_all(EXPONENT_MOST));
        sum += spectrum_of(panel->primaries->spectrum[s], wavelengths) * spectrum_exp(exponent);
    }
    return sum;
}
