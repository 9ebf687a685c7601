/* SPDX-License-Identifier: Apache-2.0 */
#include "shaders/facets/energy.h"

#include "spectrum/fresnel.h"
#include "shaders/facets/microfacet.h"

/* Points of the midpoint rule over the unit square of facets; half the turn is enough. They
 * crowd where u1 nears 1: the facets that send light below the horizon lie there. */
#define TURNS 24
#define HEIGHTS (ENERGY_LOBE_POINTS / TURNS)

static Vec3 direction_at(float cosine) {
    return vec3(safe_sqrtf(1 - cosine * cosine), 0, cosine);
}

bool energy_lobe_point(float ior, float cosine, float alpha, int point, EnergyLobe *out) {
    Vec3 wo = direction_at(cosine);
    float u0 = ((float)(point % TURNS) + 0.5f) / (2 * TURNS);
    float rest = ((float)(point / TURNS) + 0.5f) / HEIGHTS;
    Vec3 wi = ggx_sample_reflection(wo, alpha, u0, 1 - rest * rest);
    if (!(wi.z > 0)) return false;
    Vec3 half = vec3_normalize(vec3_add(wo, wi));
    float weight =
        2 * rest * ggx_reflection(wo, wi, half, alpha) * wi.z / ggx_reflection_pdf(wo, half, alpha);
    float facet = vec3_dot(wo, half);
    *out = (EnergyLobe){wi.z, weight, fresnel_shape(ior, facet), facet};
    return true;
}

/* Integral of D G2 / (4 zo zi) * (1, shape) * zi over the hemisphere, by importance. */
static Energy integrate(float ior, float cosine, float alpha) {
    float all = 0, shape = 0;
    EnergyLobe lobe;
    for (int i = 0; i < ENERGY_LOBE_POINTS; i++) {
        if (!energy_lobe_point(ior, cosine, alpha, i, &lobe)) continue;
        all += lobe.weight;
        shape += lobe.weight * lobe.shape;
    }
    const float count = ENERGY_LOBE_POINTS;
    return (Energy){clampf(all / count, 0, 1), clampf(shape / count, 0, 1)};
}

/* 2 * integral of (piecewise linear in t) cos dcos with cos = t^2, that is of 4 t^3 dt: exact
 * by Simpson's rule up to t^3, split finely enough for the fourth power. */
static Energy average_of(const Energy *row) {
    const int fine = 16 * (ENERGY_COSINES - 1);
    double all = 0, shape = 0;
    for (int i = 0; i < fine; i++) {
        double t = (i + 0.5) / fine, weight = 4 * t * t * t / fine;
        int low = i / 16;
        Energy e = energy_mix(row[low], row[low + 1], ((float)(i % 16) + 0.5f) / 16);
        all += weight * (double)e.all;
        shape += weight * (double)e.shape;
    }
    return (Energy){(float)all, (float)shape};
}

const EnergyTable *energy_table_build(float ior, Arena *arena) {
    EnergyTable *table = ARENA_NEW(arena, EnergyTable, 1);
    table->ior = ior;
    for (int a = 0; a < ENERGY_ALPHAS; a++) {
        for (int c = 0; c < ENERGY_COSINES; c++) {
            float cosine = energy_cosine_of_node(c);
            float alpha = energy_alpha_of_row(a, ENERGY_PER_OCTAVE);
            /* Row 0, the smooth boundaries, has no facets that hide one another. */
            table->directional[a][c] =
                a > 0 ? integrate(ior, cosine, alpha) : (Energy){1, fresnel_shape(ior, cosine)};
        }
        table->average[a] = average_of(table->directional[a]);
    }
    return table;
}

/* A float's bits count octaves by themselves, and run evenly within one. */
EnergyKnot energy_alpha_knot(float alpha, int per_octave) {
    if (is_smooth(alpha)) return (EnergyKnot){0, 0};
    float octaves = (float)(bits_from_float(alpha) - bits_from_float(0x1p-10f)) * 0x1p-23f;
    return energy_knot(octaves * (float)per_octave, ENERGY_OCTAVES * per_octave + 1);
}

Energy energy_directional(const EnergyTable *table, float cosine, float alpha) {
    EnergyKnot a = energy_alpha_knot(alpha, ENERGY_PER_OCTAVE);
    EnergyKnot c = energy_cosine_knot(cosine, ENERGY_COSINES);
    return energy_between(table->directional[a.low] + c.low, ENERGY_COSINES, a.t, c.t);
}

Energy energy_average(const EnergyTable *table, float alpha) {
    EnergyKnot a = energy_alpha_knot(alpha, ENERGY_PER_OCTAVE);
    return energy_mix(table->average[a.low], table->average[a.low + 1], a.t);
}
