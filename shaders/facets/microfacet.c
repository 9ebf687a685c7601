/* SPDX-License-Identifier: Apache-2.0 */
#include "shaders/facets/microfacet.h"

#include "base/units.h"

/* D = alpha^2 / (pi (x^2 + y^2 + alpha^2 z^2)^2): written without 1 - z^2, which would lose
 * every digit of a narrow lobe. */
float ggx_density(Vec3 normal, float alpha) {
    float a2 = alpha * alpha;
    float d = normal.x * normal.x + normal.y * normal.y + a2 * normal.z * normal.z;
    return a2 / (PI_F * d * d);
}

/* D = 1 / (pi ax ay ((x / ax)^2 + (y / ay)^2 + z^2)^2), times ax ay above and below. */
static float brushed_density(Vec3 normal, Vec2 alpha) {
    float x = normal.x * alpha.y, y = normal.y * alpha.x, a2 = alpha.x * alpha.y;
    float z = normal.z * a2, d = x * x + y * y + z * z;
    return a2 * a2 * a2 / (PI_F * d * d);
}

/* |z| (1 + 2 Lambda), which stays finite at the horizon. */
static float stretched_length(Vec3 w, float alpha) {
    float side2 = w.x * w.x + w.y * w.y;
    return sqrtf(w.z * w.z + alpha * alpha * side2);
}

static Vec3 stretched(Vec3 w, Vec2 alpha) {
    return vec3(alpha.x * w.x, alpha.y * w.y, w.z);
}

/* G2 = 1 / (1 + Lambda(wo) + Lambda(wi)), so G2 / (4 zo zi) = 0.5 / (zo li + zi lo) with the
 * stretched lengths l (Heitz 2014, equation 99, after multiplying out). */
float ggx_reflection(Vec3 wo, Vec3 wi, Vec3 half, float alpha) {
    float masked =
        fabsf(wo.z) * stretched_length(wi, alpha) + fabsf(wi.z) * stretched_length(wo, alpha);
    return masked > 0 ? 0.5f * ggx_density(half, alpha) / masked : 0.0f;
}

float brushed_reflection(Vec3 wo, Vec3 wi, Vec3 half, Vec2 alpha) {
    float masked = fabsf(wo.z) * vec3_length(stretched(wi, alpha)) +
                   fabsf(wi.z) * vec3_length(stretched(wo, alpha));
    return masked > 0 ? 0.5f * brushed_density(half, alpha) / masked : 0.0f;
}

/* Stretched to alpha 1 a facet is half-way between the eye and a point of the unit sphere's
 * cap, which reaches down to -bound. */
static Vec3 facet_of_cap(Vec3 eye, float bound, Vec2 alpha, const float u[2]) {
    float sine, cosine;
    float z = (1 - u[1]) * (1 + bound) - bound, radius = safe_sqrtf(1 - z * z);
    sincos_turns(u[0], &sine, &cosine);
    Vec3 sum = vec3_add(eye, vec3(radius * cosine, radius * sine, z));
    return vec3_normalize(stretched(vec3(sum.x, sum.y, sum.z > 0 ? sum.z : 0), alpha));
}

Vec3 brushed_sample_visible(Vec3 wo, Vec2 alpha, float u0, float u1) {
    Vec3 eye = vec3_normalize(stretched(wo, alpha));
    return facet_of_cap(eye, eye.z, alpha, (const float[]){u0, u1});
}

/* G1 = 2 zo / (zo + stretched length). */
float ggx_visible_pdf(Vec3 wo, Vec3 normal, float alpha) {
    float cosine = vec3_dot(wo, normal);
    if (!(cosine > 0)) return 0;
    return 2 * ggx_density(normal, alpha) * cosine / (wo.z + stretched_length(wo, alpha));
}

float brushed_visible_pdf(Vec3 wo, Vec3 normal, Vec2 alpha) {
    float cosine = vec3_dot(wo, normal);
    if (!(cosine > 0)) return 0;
    return 2 * brushed_density(normal, alpha) * cosine / (wo.z + vec3_length(stretched(wo, alpha)));
}

/* How far down the cap must reach for wo to be able to meet every facet that reflects upwards
 * (Eto and Tokuyoshi 2023, equation 5); alpha: the smaller one. */
static float cap_bound(Vec3 wo, float alpha) {
    float a2 = alpha * alpha;
    float s = 1 + sqrtf(wo.x * wo.x + wo.y * wo.y);
    float s2 = s * s;
    return (1 - a2) * s2 / (s2 + a2 * wo.z * wo.z);
}

static float smaller(Vec2 alpha) {
    return alpha.x < alpha.y ? alpha.x : alpha.y;
}

Vec3 brushed_sample_reflection(Vec3 wo, Vec2 alpha, float u0, float u1) {
    Vec3 eye = vec3_normalize(stretched(wo, alpha));
    float bound = cap_bound(wo, smaller(alpha)) * eye.z;
    Vec3 half = facet_of_cap(eye, bound, alpha, (const float[]){u0, u1});
    return vec3_sub(vec3_scale(half, 2 * vec3_dot(wo, half)), wo);
}

float ggx_reflection_pdf(Vec3 wo, Vec3 half, float alpha) {
    float reach = cap_bound(wo, alpha) * wo.z + stretched_length(wo, alpha);
    return ggx_density(half, alpha) / (2 * reach);
}

float brushed_reflection_pdf(Vec3 wo, Vec3 half, Vec2 alpha) {
    float reach = cap_bound(wo, smaller(alpha)) * wo.z + vec3_length(stretched(wo, alpha));
    return brushed_density(half, alpha) / (2 * reach);
}
