/* SPDX-License-Identifier: Apache-2.0 */
/* microfacet.h -- GGX: how a rough boundary's facets are turned, hidden and chosen.
 *
 * Local frame with +z the normal; directions leave the surface. Roughness `alpha` (root mean
 * square slope times sqrt 2), in [SMOOTH_ALPHA, 1]; brushed surfaces have two, along the
 * frame's x and y.
 * Sources  Walter et al. 2007 (D, refraction); Heitz 2014 (height-correlated G2, stretched
 *          surfaces), Heitz 2018 and Dupuy & Benyoub 2023 (visible normals as a spherical cap);
 *          Eto & Tokuyoshi 2023 (the cap bounded to what reflects upwards).
 * Threads  pure functions.
 */
#pragma once
#include "base/mathf.h"
#include "base/vec.h"
#include "spectrum/spectrum.h"

/* Below this alpha a boundary is a perfect mirror: its lobe would be narrower than a tenth of
 * the Sun's disc. glTF roughness 0.0316. */
#define SMOOTH_ALPHA 1e-3f

/* Up to this alpha the sun's image on a rough boundary is looked for: its lobe is then so
 * narrow that a surface beside it meets it once in thousands of samples. glTF roughness 0.21;
 * up to 0.091 a frame of the car took 1.16 times as long, for as many fireflies. */
#define GLINT_ALPHA 0.0451f

static inline bool is_smooth(float alpha) {
    return alpha < SMOOTH_ALPHA;
}

/* Normals per solid angle and projected area, sr^-1. */
float ggx_density(Vec3 normal, float alpha);

/* D G2 / (4 |wo.z| |wi.z|): a mirror-like lobe of reflectance 1, sr^-1. wo, wi and half on
 * the same side, half = normalised wo + wi. */
float ggx_reflection(Vec3 wo, Vec3 wi, Vec3 half, float alpha);
float brushed_reflection(Vec3 wo, Vec3 wi, Vec3 half, Vec2 alpha);

/* A visible facet normal for wo, wo.z > 0; u in [0,1)^2. Its density is
 * ggx_visible_pdf(wo, normal) = G1(wo) D(normal) max(0, wo.normal) / wo.z. */
Vec3 brushed_sample_visible(Vec3 wo, Vec2 alpha, float u0, float u1);
float ggx_visible_pdf(Vec3 wo, Vec3 normal, float alpha);
float brushed_visible_pdf(Vec3 wo, Vec3 normal, Vec2 alpha);
static inline Vec3 ggx_sample_visible(Vec3 wo, float alpha, float u0, float u1) {
    return brushed_sample_visible(wo, (Vec2){alpha, alpha}, u0, u1);
}

/* A mirror-like direction about a visible facet; few fall below the horizon (then z <= 0, and
 * the light is lost). The pdf of wi, sr^-1, holds for every wi, half as above. */
Vec3 brushed_sample_reflection(Vec3 wo, Vec2 alpha, float u0, float u1);
float ggx_reflection_pdf(Vec3 wo, Vec3 half, float alpha);
float brushed_reflection_pdf(Vec3 wo, Vec3 half, Vec2 alpha);
static inline Vec3 ggx_sample_reflection(Vec3 wo, float alpha, float u0, float u1) {
    return brushed_sample_reflection(wo, (Vec2){alpha, alpha}, u0, u1);
}

/* Where a facet, met at `cosine`, refracts light from wo; eta: the other side's index over this
 * one's; behind: the cosine on the other side (fresnel.h). Walter 2007, equation 40. */
static inline Vec3 refracted(Vec3 wo, Vec3 half, float eta, float cosine, float behind) {
    return vec3_sub(vec3_scale(half, cosine / eta - behind), vec3_scale(wo, 1 / eta));
}

/* A direction of a Lambert surface, with density z / pi. u in [0,1)^2. */
static inline Vec3 microfacet_cosine(float u0, float u1) {
    float sine, cosine, radius = sqrtf(u1);
    sincos_turns(u0, &sine, &cosine);
    return vec3(radius * cosine, radius * sine, safe_sqrtf(1 - u1));
}
