/* SPDX-License-Identifier: Apache-2.0 */
#include "shaders/facets/brushed.h"

#include "base/units.h"

/* D = 1 / (pi ax ay ((x / ax)^2 + (y / ay)^2 + z^2)^2), times ax ay above and below. */
static float density(Vec3 normal, Vec2 alpha)
{
    float x = normal.x * alpha.y, y = normal.y * alpha.x, a2 = alpha.x * alpha.y;
    float z = normal.z * a2, d = x * x + y * y + z * z;
    return a2 * a2 * a2 / (PI_F * d * d);
}

static Vec3 stretched(Vec3 w, Vec2 alpha)
{
    return vec3(alpha.x * w.x, alpha.y * w.y, w.z);
}

float brushed_reflection(Vec3 wo, Vec3 wi, Vec3 half, Vec2 alpha)
{
    float masked = fabsf(wo.z) * vec3_length(stretched(wi, alpha)) +
                   fabsf(wi.z) * vec3_length(stretched(wo, alpha));
    return masked > 0 ? 0.5f * density(half, alpha) / masked : 0.0f;
}

/* How far down the cap must reach: equation 5 of Eto and Tokuyoshi, of the smaller alpha. */
static float cap_bound(Vec3 wo, Vec2 alpha)
{
    float a = alpha.x < alpha.y ? alpha.x : alpha.y, a2 = a * a;
    float s = 1 + sqrtf(wo.x * wo.x + wo.y * wo.y);
    float s2 = s * s;
    return (1 - a2) * s2 / (s2 + a2 * wo.z * wo.z);
}

/* Stretched to alpha 1 a facet is half-way between the eye and a point of the cap, which
 * reaches down to -bound. */
static Vec3 facet_of_cap(Vec3 eye, float bound, Vec2 alpha, const float u[2])
{
    float sine, cosine;
    float z = (1 - u[1]) * (1 + bound) - bound, radius = safe_sqrtf(1 - z * z);
    sincos_turns(u[0], &sine, &cosine);
    Vec3 sum = vec3_add(eye, vec3(radius * cosine, radius * sine, z));
    return vec3_normalize(stretched(vec3(sum.x, sum.y, sum.z > 0 ? sum.z : 0), alpha));
}

Vec3 brushed_sample_visible(Vec3 wo, Vec2 alpha, float u0, float u1)
{
    Vec3 eye = vec3_normalize(stretched(wo, alpha));
    return facet_of_cap(eye, eye.z, alpha, (const float[]){u0, u1});
}

float brushed_visible_pdf(Vec3 wo, Vec3 normal, Vec2 alpha)
{
    float cosine = vec3_dot(wo, normal);
    if (!(cosine > 0)) return 0;
    return 2 * density(normal, alpha) * cosine / (wo.z + vec3_length(stretched(wo, alpha)));
}

Vec3 brushed_sample_reflection(Vec3 wo, Vec2 alpha, float u0, float u1)
{
    Vec3  eye = vec3_normalize(stretched(wo, alpha));
    float bound = cap_bound(wo, alpha) * eye.z;
    Vec3  half = facet_of_cap(eye, bound, alpha, (const float[]){u0, u1});
    return vec3_sub(vec3_scale(half, 2 * vec3_dot(wo, half)), wo);
}

float brushed_reflection_pdf(Vec3 wo, Vec3 half, Vec2 alpha)
{
    float reach = cap_bound(wo, alpha) * wo.z + vec3_length(stretched(wo, alpha));
    return density(half, alpha) / (2 * reach);
}
