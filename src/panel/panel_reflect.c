/* HOT: what a panel reflects. No allocation, no lock, no libm. */
#include <string.h>

#include "base/units.h"
#include "hemisphere/specular_frame.h"
#include "hemisphere/tree_query.h"
#include "panel/panel_slices.h"

#define PADDED_MAX ((PANEL_WAVELENGTHS_MAX + 15) / 16 * 16)

bool panel_reflects(const Panel *panel)
{
    return panel->reflection != NULL;
}

/* Unpolarised Fresnel reflectance, exact. */
static float fresnel(float c, float n)
{
    float t = safe_sqrtf(1 - (1 - c * c) / (n * n));
    float s = (c - n * t) / (c + n * t), p = (n * c - t) / (n * c + t);
    return 0.5f * (s * s + p * p);
}

/* Cubic Hermite over four slices with the slopes of parabolas through three; the ends take
 * the straight slope. Weights may be negative: they are for logarithms only. */
static SliceMix cubic_mix(const PanelReflection *r, float theta)
{
    float u;
    int   i = panel_slice_interval(r, theta, &u);
    if (!r->is_cubic || r->slices < 3) return panel_linear_mix(r, theta);
    const float *x = r->slice_theta;
    bool  has_left = i > 0, has_right = i + 2 < (int)r->slices;
    float h = x[i + 1] - x[i], u2 = u * u, u3 = u2 * u;
    float a = (u3 - 2 * u2 + u) * h, b = (u3 - u2) * h; /* of the slopes at the two ends */
    float w[4] = {0, 2 * u3 - 3 * u2 + 1, 3 * u2 - 2 * u3, 0};
    float h0 = has_left ? x[i] - x[i - 1] : 0, h2 = has_right ? x[i + 2] - x[i + 1] : 0;
    /* slope at x[i] = (h d0 + h0 d1) / (h0 + h), d0 and d1 the divided differences */
    float a0 = has_left ? a * h / (h0 + h) : 0, a1 = a - a0;
    float b2 = has_right ? b * h / (h + h2) : 0, b1 = b - b2;
    if (has_left) {
        w[0] -= a0 / h0;
        w[1] += a0 / h0;
    }
    if (has_right) {
        w[2] -= b2 / h2;
        w[3] += b2 / h2;
    }
    w[1] -= (a1 + b1) / h;
    w[2] += (a1 + b1) / h;
    SliceMix mix = {i - has_left, 2 + has_left + has_right, {0, 0, 0, 0}};
    for (int k = 0; k < mix.count; k++) mix.weight[k] = w[k + !has_left];
    return mix;
}

/* A row of 16 floats that need not be aligned. */
static Spectrum load_16(const float *from)
{
    Spectrum value;
    memcpy(&value, from, sizeof value);
    return value;
}

/* ln (f / F) at all measured wavelengths. */
static void reflection_logs(const Panel *panel, Vec3 stored, float theta, Spectrum *logs)
{
    const PanelReflection *r = panel->reflection;
    SliceMix mix = cubic_mix(r, theta);
    TreeTaps taps;
    int      k_count = (int)r->coefficients;
    float    part[4 * PANEL_COEFFICIENTS_MAX], coefficient[PANEL_COEFFICIENTS_MAX] = {0};
    tree_walk_interpolated(&panel->reflection_tree, stored, &taps);
    tree_sum(&panel->reflection_tree, &taps, mix.first * k_count, mix.count * k_count, part);
    panel_add_profile(&panel->reflection_profile, stored, mix.first * k_count,
                      mix.count * k_count, part);
    for (int s = 0; s < mix.count; s++)
        for (int k = 0; k < k_count; k++)
            coefficient[k] += mix.weight[s] * part[s * k_count + k];
    int padded = (int)r->padded_wavelengths;
    for (int w = 0; w < padded; w += SPECTRUM_LANES) {
        Spectrum sum = spectrum_all(0);
        for (int k = 0; k < k_count; k++)
            sum += spectrum_all(coefficient[k]) * load_16(panel->basis + k * padded + w);
        logs[w / SPECTRUM_LANES] = sum;
    }
}

/* Values at the lanes, linear between measured wavelengths; the end value holds outside. */
static Spectrum spread(const Panel *panel, const float *value, const Wavelengths *wavelengths)
{
    const PanelReflection *r = panel->reflection;
    Spectrum out;
    if (r->wavelengths == 1) return spectrum_all(value[0]);
    for (int i = 0; i < SPECTRUM_LANES; i++) {
        float nm = clampf(wavelengths->nm[i], SPECTRAL_FIRST_NM, SPECTRAL_LAST_NM);
        int   n = panel->wavelength_index[(int)(nm - SPECTRAL_FIRST_NM)];
        while (n + 2 < (int)r->wavelengths && r->wavelength_nm[n + 1] <= nm) n++;
        float t = (nm - r->wavelength_nm[n]) * panel->wavelength_scale[n];
        out[i] = lerpf(value[n], value[n + 1], clampf(t, 0, 1));
    }
    return out;
}

Spectrum panel_brdf(const Panel *panel, Vec3 wo, Vec3 wi, const Wavelengths *wavelengths)
{
    const PanelReflection *r = panel->reflection;
    Spectrum logs[PADDED_MAX / SPECTRUM_LANES];
    if (!r || !(wo.z > 0) || !(wi.z > 0)) return spectrum_all(0);
    float theta = panel_polar_angle(wi);
    SpecularFrame frame = specular_frame(theta, r->frame_exponent);
    reflection_logs(panel, specular_frame_stored(&frame, panel_turned(wi, wo)), theta, logs);
    Spectrum exponent = spread(panel, (const float *)logs, wavelengths);
    return spectrum_exp(exponent) * spectrum_all(fresnel(wi.z, r->refractive_index));
}

Spectrum panel_mirror(const Panel *panel, float cos_theta, const Wavelengths *wavelengths)
{
    float    t;
    Spectrum row[PADDED_MAX / SPECTRUM_LANES];
    if (!panel->reflection || !(cos_theta > 0)) return spectrum_all(0);
    int          node = panel_angle_node(acos_f(cos_theta), &t);
    int          padded = (int)panel->reflection->padded_wavelengths;
    const float *a = panel->mirror + node * padded, *b = a + padded;
    for (int w = 0; w < padded; w += SPECTRUM_LANES)
        row[w / SPECTRUM_LANES] = load_16(a + w) + (load_16(b + w) - load_16(a + w)) *
                                                       spectrum_all(t);
    return spread(panel, (const float *)row, wavelengths);
}

float panel_haze_albedo(const Panel *panel, float cos_theta)
{
    float t;
    if (!panel->reflection || !(cos_theta > 0)) return 0;
    int node = panel_angle_node(acos_f(cos_theta), &t);
    const float *albedo = panel->reflection->haze_albedo;
    return lerpf(albedo[node], albedo[node + 1], t);
}
