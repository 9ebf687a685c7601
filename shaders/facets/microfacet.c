/* SPDX-License-Identifier: Apache-2.0 */
#include "shaders/facets/microfacet.h"

#include "base/units.h"

/* D = alpha^2 / (pi (x^2 + y^2 + alpha^2 z^2)^2): written without 1 - z^2, which would lose
 * every digit of a narrow lobe. */
float ggx_density(Vec3 normal, float alpha)
{
    float a2 = alpha * alpha;
    float d = normal.x * normal.x + normal.y * normal.y + a2 * normal.z * normal.z;
    return a2 / (PI_F * d * d);
}

/* |z| (1 + 2 Lambda), which stays finite at the horizon. */
static float stretched_length(Vec3 w, float alpha)
{
    float side2 = w.x * w.x + w.y * w.y;
    return sqrtf(w.z * w.z + alpha * alpha * side2);
}

/* G2 = 1 / (1 + Lambda(wo) + Lambda(wi)), so G2 / (4 zo zi) = 0.5 / (zo li + zi lo) with the
 * stretched lengths l (Heitz 2014, equation 99, after multiplying out). */
float ggx_reflection(Vec3 wo, Vec3 wi, Vec3 half, float alpha)
{
    float masked = fabsf(wo.z) * stretched_length(wi, alpha) +
                   fabsf(wi.z) * stretched_length(wo, alpha);
    return masked > 0 ? 0.5f * ggx_density(half, alpha) / masked : 0.0f;
}

/* A point of the unit sphere's cap above height -bound. */
static Vec3 sample_cap(float bound, float u0, float u1)
{
    float sine, cosine;
    float z = (1 - u1) * (1 + bound) - bound;
    float radius = safe_sqrtf(1 - z * z);
    sincos_turns(u0, &sine, &cosine);
    return vec3(radius * cosine, radius * sine, z);
}

/* Stretched to alpha = 1 a facet is half-way between wo and a point of a spherical cap. */
static Vec3 facet_from_cap(Vec3 stretched, Vec3 cap, float alpha)
{
    Vec3 sum = vec3_add(stretched, cap);
    return vec3_normalize(vec3(alpha * sum.x, alpha * sum.y, sum.z > 0 ? sum.z : 0));
}

static Vec3 stretch(Vec3 wo, float alpha)
{
    return vec3_normalize(vec3(alpha * wo.x, alpha * wo.y, wo.z));
}

Vec3 ggx_sample_visible(Vec3 wo, float alpha, float u0, float u1)
{
    Vec3 stretched = stretch(wo, alpha);
    return facet_from_cap(stretched, sample_cap(stretched.z, u0, u1), alpha);
}

/* G1 = 2 zo / (zo + stretched length). */
float ggx_visible_pdf(Vec3 wo, Vec3 normal, float alpha)
{
    float cosine = vec3_dot(wo, normal);
    if (!(cosine > 0)) return 0;
    return 2 * ggx_density(normal, alpha) * cosine / (wo.z + stretched_length(wo, alpha));
}

/* How far down the cap must reach for wo to be able to meet every facet that reflects upwards
 * (Eto and Tokuyoshi 2023, equation 5). */
static float cap_bound(Vec3 wo, float alpha)
{
    float a2 = alpha * alpha;
    float s = 1 + sqrtf(wo.x * wo.x + wo.y * wo.y);
    float s2 = s * s;
    return (1 - a2) * s2 / (s2 + a2 * wo.z * wo.z);
}

Vec3 ggx_sample_reflection(Vec3 wo, float alpha, float u0, float u1)
{
    Vec3 stretched = stretch(wo, alpha);
    Vec3 cap = sample_cap(cap_bound(wo, alpha) * stretched.z, u0, u1);
    Vec3 half = facet_from_cap(stretched, cap, alpha);
    return vec3_sub(vec3_scale(half, 2 * vec3_dot(wo, half)), wo);
}

float ggx_reflection_pdf(Vec3 wo, Vec3 half, float alpha)
{
    float reach = cap_bound(wo, alpha) * wo.z + stretched_length(wo, alpha);
    return ggx_density(half, alpha) / (2 * reach);
}
