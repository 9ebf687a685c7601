/* SPDX-License-Identifier: Apache-2.0 */
#include "shaders/metallic/metallic_energy.h"

#include "shaders/metallic/metallic_facet.h"

static Energy energy_of_facets(const MetallicRoughness *m, const LobeFacets *facets) {
    Energy e = {0, 0};
    for (int i = 0; i < LOBE_FACETS; i++) {
        e.all += facets->weight[i];
        e.shape += facets->weight[i] * fresnel_shape(m->energy->ior, facet_cosine[i]);
    }
    return (Energy){clampf(e.all, 0, 1), clampf(e.shape, 0, 1)};
}

Energy energy_brushed(const MetallicRoughness *m, Vec3 w) {
    LobeFacets facets = lobe_facets(&common_facet_table, w, facet_alphas(m));
    return energy_of_facets(m, &facets);
}

Energy energy_brushed_average(const MetallicRoughness *m) {
    LobeFacets facets = mean_facets(&common_facet_table, facet_alphas(m));
    return energy_of_facets(m, &facets);
}

/* The roughness along a direction's own azimuth. */
static float own_alpha(const MetallicRoughness *m, Vec3 w) {
    if (!is_brushed(m)) return m->alpha;
    float x = m->alpha_along * w.x, y = m->alpha * w.y, side2 = w.x * w.x + w.y * w.y;
    return side2 > 1e-12f ? sqrtf((x * x + y * y) / side2) : m->alpha;
}

Spectrum energy_of_lobe(const Spectrum at[LOBE_FACETS], const LobeFacets *facets) {
    Spectrum sum = spectrum_all(0);
    for (int i = 0; i < LOBE_FACETS; i++) sum += at[i] * spectrum_all(facets->weight[i]);
    return sum;
}

static Spectrum sum_of_facets(const Spectrum at[LOBE_FACETS], LobeFacets facets) {
    return spectrum_clamp(energy_of_lobe(at, &facets), 0, 1);
}

static Spectrum coated_facets(const MetallicRoughness *m, LobeFacets facets) {
    Spectrum at[LOBE_FACETS];
    for (int i = 0; i < LOBE_FACETS; i++)
        at[i] = coating_at(m->coating->face->front, m->wavelengths, facet_cosine[i]);
    return sum_of_facets(at, facets);
}

Spectrum energy_coated(const MetallicRoughness *m, Vec3 w) {
    const CoatingTables *face = m->coating->face;
    Spectrum all =
        is_brushed(m) ? coated_facets(m, lobe_facets(&common_facet_table, w, facet_alphas(m)))
        : is_smooth(m->alpha) ? coating_at(face->front, m->wavelengths, w.z)
                              : coating_energy_at(face->energy, m->wavelengths, w.z, m->alpha);
    return all * spectrum_all(m->specular);
}

Spectrum energy_coated_average(const MetallicRoughness *m) {
    if (is_brushed(m)) return coated_facets(m, mean_facets(&common_facet_table, facet_alphas(m)));
    return coating_energy_average(m->coating->face->energy, m->wavelengths, m->alpha);
}

Spectrum energy_filmed(const MetallicView *view, Vec3 w) {
    const MetallicRoughness *m = view->m;
    if (is_smooth(m->alpha)) return facet_reflectance(m, &view->boundary, w.z);
    return sum_of_facets(view->film, lobe_facets(&common_facet_table, w, facet_alphas(m)));
}

Spectrum energy_filmed_average(const MetallicView *view, float alpha) {
    Vec2 both = facet_alphas(view->m);
    if (is_smooth(alpha)) both = (Vec2){SMOOTH_ALPHA, SMOOTH_ALPHA};
    return sum_of_facets(view->film, mean_facets(&common_facet_table, both));
}

static Spectrum filmed_metal_mean(const MetallicRoughness *m) {
    Spectrum at[LOBE_FACETS];
    for (int i = 0; i < LOBE_FACETS; i++) at[i] = facet_metal_at(m, facet_cosine[i]);
    return sum_of_facets(at, mean_facets(&common_facet_table, (Vec2){SMOOTH_ALPHA, SMOOTH_ALPHA}));
}

Spectrum energy_metal_mean(const MetallicRoughness *m) {
    if (has_film(m)) return filmed_metal_mean(m);
    if (coated_metal(m)) return curve_lookup(&m->coating->metal->front_mean, m->wavelengths);
    return m->base_color + (spectrum_all(1) - m->base_color) * spectrum_all(1.0f / 21);
}

/* ---- the overlay ------------------------------------------------------------------------ */

OverlayShare energy_overlay(const MetallicRoughness *m, Vec3 w) {
    return overlay_share(&m->overlay, fabsf(w.z), own_alpha(m, w));
}

float energy_kept(const MetallicRoughness *m, float cosine) {
    if (!has_overlay(m)) return 1;
    return 1 - overlay_most(&m->overlay) * overlay_albedo(&m->overlay, cosine);
}
