/* SPDX-License-Identifier: Apache-2.0 */
/* metallic_energy.h -- what all facets of metallic_roughness send back together, and the
 * overlay over them.
 *
 * Directions are in the local frame, above the surface. Energies and averages over the
 * hemisphere are shares of light, [0, 1]: by the tables of an even surface (facets/energy.h),
 * by a few facets of a brushed, filmed or coated one (facets/lobe_facets.h).
 *
 * Threads  pure functions.  Fails  never.
 */
#pragma once
#include "shaders/facets/microfacet.h"
#include "shaders/metallic/metallic_view.h"

/* Brushed facets along a direction, and on average. */
Energy energy_brushed(const MetallicRoughness *m, Vec3 w);

Energy energy_brushed_average(const MetallicRoughness *m);

/* What a lobe sends back whose facets reflect so much at facet_cosine. */
Spectrum energy_of_lobe(const Spectrum at[LOBE_FACETS], const LobeFacets *facets);

/* Share that a coated face sends back in all. */
Spectrum energy_coated(const MetallicRoughness *m, Vec3 w);

Spectrum energy_coated_average(const MetallicRoughness *m);

/* Share that a filmed face sends back in all. */
Spectrum energy_filmed(const MetallicView *view, Vec3 w);

/* Its mean over the hemisphere; a smooth face's is that of its narrowest lobe. */
Spectrum energy_filmed_average(const MetallicView *view, float alpha);

/* A metal's mean reflectance, which every further bounce takes; the mean of Schlick's curve
 * over the hemisphere is f0 + (1 - f0) / 21. */
Spectrum energy_metal_mean(const MetallicRoughness *m);

/* Share that the overlay sends along a direction, and that it takes from facets beneath. */
OverlayShare energy_overlay(const MetallicRoughness *m, Vec3 w);

/* Share of light at a cosine that gets past the overlay. */
float energy_kept(const MetallicRoughness *m, float cosine);

static inline bool is_brushed(const MetallicRoughness *m) {
    return m->alpha_along > 0;
}

/* Of facets, along x and y. */
static inline Vec2 facet_alphas(const MetallicRoughness *m) {
    return (Vec2){is_brushed(m) ? m->alpha_along : m->alpha, m->alpha};
}

/* Energies that the base's facets send back along a direction above it, and on average. */
static inline Energy base_energy(const MetallicRoughness *m, Vec3 w) {
    return is_brushed(m) ? energy_brushed(m, w) : energy_directional(m->energy, w.z, m->alpha);
}

static inline Energy base_average(const MetallicRoughness *m) {
    return is_brushed(m) ? energy_brushed_average(m) : energy_average(m->energy, m->alpha);
}

static inline float base_lobe(const MetallicRoughness *m, Vec3 wo, Vec3 wi, Vec3 half) {
    return is_brushed(m) ? brushed_reflection(wo, wi, half, facet_alphas(m))
                         : ggx_reflection(wo, wi, half, m->alpha);
}

static inline float base_lobe_pdf(const MetallicRoughness *m, Vec3 wo, Vec3 half) {
    return is_brushed(m) ? brushed_reflection_pdf(wo, half, facet_alphas(m))
                         : ggx_reflection_pdf(wo, half, m->alpha);
}

static inline Vec3 base_sample(const MetallicRoughness *m, Vec3 wo, float u0, float u1) {
    return brushed_sample_reflection(wo, facet_alphas(m), u0, u1);
}

/* No colour is below 0. */
static inline bool has_overlay(const MetallicRoughness *m) {
    const float *color = m->overlay.color;
    return color[0] + color[1] + color[2] > 0;
}
