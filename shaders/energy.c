#include "shaders/energy.h"

#include "shaders/fresnel.h"
#include "shaders/microfacet.h"

/* Points of the midpoint rule over the unit square of facets; half the turn is enough. */
#define TURNS 24
#define HEIGHTS 48

/* Exact reflectance's rise from normal incidence (0) to grazing (1). */
static float fresnel_shape(float ior, float cosine)
{
    if (!(ior > 1)) return 0;
    float f0 = fresnel_normal(ior);
    return (fresnel_mean(fresnel_dielectric(cosine, ior, NULL)) - f0) / (1 - f0);
}

static Vec3 direction_at(float cosine)
{
    return vec3(safe_sqrtf(1 - cosine * cosine), 0, cosine);
}

/* Integral of D G2 / (4 zo zi) * (1, shape) * zi over the hemisphere, by importance. */
static Energy integrate(float ior, float cosine, float alpha)
{
    Vec3  wo = direction_at(cosine);
    float all = 0, shape = 0;
    for (int i = 0; i < TURNS * HEIGHTS; i++) {
        float u0 = ((float)(i % TURNS) + 0.5f) / (2 * TURNS);
        float u1 = ((float)(i / TURNS) + 0.5f) / HEIGHTS;
        Vec3  wi = ggx_sample_reflection(wo, alpha, u0, u1);
        if (!(wi.z > 0)) continue;
        Vec3  half = vec3_normalize(vec3_add(wo, wi));
        float weight = ggx_reflection(wo, wi, half, alpha) * wi.z /
                       ggx_reflection_pdf(wo, half, alpha);
        all += weight;
        shape += weight * fresnel_shape(ior, vec3_dot(wo, half));
    }
    const float count = TURNS * HEIGHTS;
    return (Energy){clampf(all / count, 0, 1), clampf(shape / count, 0, 1)};
}

/* 2 * integral of (piecewise linear in t) cos dcos with cos = t^2, that is of 4 t^3 dt: exact
 * by Simpson's rule up to t^3, split finely enough for the fourth power. */
static Energy average_of(const Energy *row)
{
    const int fine = 16 * (ENERGY_COSINES - 1);
    double all = 0, shape = 0;
    for (int i = 0; i < fine; i++) {
        double t = (i + 0.5) / fine, weight = 4 * t * t * t / fine;
        int    low = i / 16;
        Energy e = energy_mix(row[low], row[low + 1], ((float)(i % 16) + 0.5f) / 16);
        all += weight * (double)e.all;
        shape += weight * (double)e.shape;
    }
    return (Energy){(float)all, (float)shape};
}

const EnergyTable *energy_table_build(float ior, Arena *arena)
{
    EnergyTable *table = ARENA_NEW(arena, EnergyTable, 1);
    table->ior = ior;
    for (int a = 0; a < ENERGY_ALPHAS; a++) {
        float root = (float)a / (ENERGY_ALPHAS - 1);
        float alpha = root * root > 1e-4f ? root * root : 1e-4f;
        for (int c = 0; c < ENERGY_COSINES; c++) {
            float t = (float)c / (ENERGY_COSINES - 1);
            float cosine = c > 0 ? t * t : 1e-5f;
            table->directional[a][c] = a > 0 ? integrate(ior, cosine, alpha) :
                                       (Energy){1, fresnel_shape(ior, cosine)};
        }
        table->average[a] = average_of(table->directional[a]);
    }
    return table;
}

/* Cell and place in it of a value in [0, 1] on an axis of `count` knots, even in its root. */
static int find_knot(float value, int count, float *t)
{
    float place = safe_sqrtf(value) * (float)(count - 1);
    int   cell = (int)place;
    if (cell > count - 2) cell = count - 2;
    *t = clampf(place - (float)cell, 0, 1);
    return cell;
}

Energy energy_directional(const EnergyTable *table, float cosine, float alpha)
{
    float ta, tc;
    int   a = find_knot(alpha, ENERGY_ALPHAS, &ta);
    int   c = find_knot(cosine, ENERGY_COSINES, &tc);
    const Energy *low = table->directional[a], *high = table->directional[a + 1];
    return energy_mix(energy_mix(low[c], low[c + 1], tc), energy_mix(high[c], high[c + 1], tc),
                      ta);
}

Energy energy_average(const EnergyTable *table, float alpha)
{
    float t;
    int   a = find_knot(alpha, ENERGY_ALPHAS, &t);
    return energy_mix(table->average[a], table->average[a + 1], t);
}
