/* SPDX-License-Identifier: Apache-2.0 */
#include "shaders/facets/solid_energy.h"

#include "base/mathf.h"
#include "shaders/facets/microfacet.h"
#include "spectrum/fresnel.h"

/* A Fibonacci lattice over the unit square of visible facets; half the turn is enough. Heights
 * crowd where u1 nears 1: the steepest facets lose most. */
#define POINTS 4181
#define STEP 2584
/* Up to this alpha little is lost, and fewer will do. */
#define FINE_ALPHA 0.2f
#define FINE_POINTS 987
#define FINE_STEP 610

/* ---- what single facets send on --------------------------------------------------------- */

typedef struct Sent {
    double reflected, through;
    bool has_facets;
    LostFacets lost;
} Sent;

/* G2 / G1 of light that a visible facet, met at that cosine, sends from wo towards wi. */
static float passed_on(Vec3 wo, Vec3 wi, Vec3 half, float cosine, float alpha) {
    return 4 * ggx_reflection(wo, wi, half, alpha) * cosine * fabsf(wi.z) /
           ggx_visible_pdf(wo, half, alpha);
}

static void add_lost(LostFacets *sum, float cosine, float reflected, float through) {
    double at[LOBE_FACETS];
    facet_polynomials((double)cosine, at);
    for (int k = 0; k < LOBE_FACETS; k++) {
        sum->reflected[k] += reflected * (float)at[k];
        sum->through[k] += through * (float)at[k];
    }
}

static void add_facet(Vec3 wo, Vec3 half, float eta, float alpha, float share, Sent *sum) {
    float cosine = min_f(vec3_dot(wo, half), 1), behind = 0;
    if (!(cosine > 0)) return;
    float mirror = eta > 0 ? fresnel_mean(fresnel_dielectric(cosine, eta, &behind)) : 1;
    Vec3 back = vec3_sub(vec3_scale(half, 2 * cosine), wo);
    float is_sent = back.z > 0 ? passed_on(wo, back, half, cosine, alpha) : 0, passes = 0;
    sum->reflected += (double)(share * mirror * is_sent);
    if (!(behind > 0)) return;
    Vec3 on = refracted(wo, half, eta, cosine, behind);
    if (on.z < 0) passes = passed_on(wo, on, half, cosine, alpha);
    sum->through += (double)(share * (1 - mirror) * passes);
    if (sum->has_facets)
        add_lost(&sum->lost, eta >= 1 ? cosine : behind, share * (1 - is_sent),
                 share * (1 - passes));
}

/* Light sent on from a cosine in the medium against which the other's index is eta. */
static Sent sent_on(float cosine, float eta, float alpha, bool has_facets) {
    Vec3 wo = vec3(safe_sqrtf(1 - cosine * cosine), 0, cosine);
    Sent sum = {.has_facets = has_facets};
    int points = alpha > FINE_ALPHA ? POINTS : FINE_POINTS;
    int step = alpha > FINE_ALPHA ? STEP : FINE_STEP;
    for (int i = 0; i < points; i++) {
        float turn = ((float)(i * step % points) + 0.5f) / (float)(2 * points);
        float rest = ((float)i + 0.5f) / (float)points;
        Vec3 half = ggx_sample_visible(wo, alpha, turn, 1 - rest * rest);
        add_facet(wo, half, eta, alpha, 2 * rest / (float)points, &sum);
    }
    return sum;
}

/* ---- tables ----------------------------------------------------------------------------- */

static void add_facets(LostFacets *sum, const LostFacets *from, float share) {
    for (int k = 0; k < LOBE_FACETS; k++) {
        sum->reflected[k] += share * from->reflected[k];
        sum->through[k] += share * from->through[k];
    }
}

/* A node's weight in the mean over the hemisphere of a function linear between nodes: with t =
 * sqrt(cos) (energy.h) the integral of 4 t^3 times the hat about the node. */
static float node_weight(int node) {
    const float h = 1.0f / (ENERGY_COSINES - 1);
    float t = (float)node * h;
    if (node == 0) return 0.2f * h * h * h * h;
    if (node == ENERGY_COSINES - 1) return h * (2 - 2 * h + h * h - 0.2f * h * h * h);
    return 4 * h * (t * t * t + 0.5f * t * h * h);
}

/* Fills one row; returns how much of what single facets send on goes across, over the
 * hemisphere. */
static float fill_row(SolidSide *side, int row, float eta) {
    double reflected = 0, through = 0, mean = 0;
    float alpha = energy_alpha_of_row(row, ENERGY_PER_OCTAVE);
    for (int c = 0; c < ENERGY_COSINES; c++) {
        float weight = node_weight(c);
        Sent sent = sent_on(energy_cosine_of_node(c), eta, alpha, side->facets);
        float lost = clampf((float)(1 - sent.reflected - sent.through), 0, 1);
        side->lost[row][c] = lost;
        mean += (double)(weight * lost);
        reflected += (double)weight * sent.reflected;
        through += (double)weight * sent.through;
        if (!side->facets) continue;
        side->facets[row * ENERGY_COSINES + c] = sent.lost;
        add_facets(&side->mean_facets[row], &sent.lost, weight);
    }
    side->mean[row] = (float)mean;
    return (float)(through / (reflected + through));
}

/* Lost light crosses as single facets let it, as much as both sides allow: radiance runs both
 * ways alike where the flux from inside is 1/ior^2 of that from outside. */
static void fill_rows(SolidEnergy *out, int row) {
    float ior = out->ior, ior2 = ior * ior;
    if (row == 0) return; /* smooth: nothing is lost */
    float crosses = fill_row(&out->side[0], row, ior);
    float returns = fill_row(&out->side[1], row, ior > 0 ? 1 / ior : 0);
    out->flux[row] =
        min_f(crosses * out->side[0].mean[row], returns * out->side[1].mean[row] * ior2);
}

const SolidEnergy *solid_energy_build(float ior, float least, float most, bool has_facets,
                                      Arena *arena) {
    SolidEnergy *out = ARENA_NEW(arena, SolidEnergy, 1);
    int first = energy_alpha_knot(least, ENERGY_PER_OCTAVE).low;
    int last = energy_alpha_knot(most, ENERGY_PER_OCTAVE).low + 1;
    out->ior = ior;
    for (int i = 0; i < 2 && has_facets; i++)
        out->side[i].facets = ARENA_NEW(arena, LostFacets, ENERGY_ALPHAS * ENERGY_COSINES);
    for (int row = first; row <= last; row++) fill_rows(out, row);
    return out;
}

const SolidEnergy *solid_energy_brushed(const SolidEnergy *even, BrushedRange range, Arena *arena) {
    SolidEnergy *out = ARENA_NEW(arena, SolidEnergy, 1);
    *out = *even;
    out->brushed = brushed_loss_build(even->ior, range, even->side[0].facets != NULL, arena);
    return out;
}

/* ---- looking up -------------------------------------------------------------------------- */

SolidLost solid_lost(const SolidEnergy *energy, bool is_inside, float cosine, float alpha) {
    const SolidSide *side = &energy->side[is_inside];
    EnergyKnot a = energy_alpha_knot(alpha, ENERGY_PER_OCTAVE);
    EnergyKnot c = energy_cosine_knot(cosine, ENERGY_COSINES);
    const float *below = side->lost[a.low] + c.low, *above = below + ENERGY_COSINES;
    return (SolidLost){lerpf(lerpf(below[0], below[1], c.t), lerpf(above[0], above[1], c.t), a.t),
                       lerpf(side->mean[a.low], side->mean[a.low + 1], a.t),
                       lerpf(energy->flux[a.low], energy->flux[a.low + 1], a.t)};
}

LostFacets solid_lost_facets(const SolidEnergy *energy, bool is_inside, float cosine, float alpha) {
    EnergyKnot a = energy_alpha_knot(alpha, ENERGY_PER_OCTAVE);
    EnergyKnot c = energy_cosine_knot(cosine, ENERGY_COSINES);
    const LostFacets *below = energy->side[is_inside].facets + a.low * ENERGY_COSINES + c.low;
    LostFacets sum = {{0}, {0}};
    for (int i = 0; i < 4; i++)
        add_facets(&sum, &below[(i >> 1) * ENERGY_COSINES + (i & 1)],
                   (i >> 1 ? a.t : 1 - a.t) * (i & 1 ? c.t : 1 - c.t));
    return sum;
}

LostFacets solid_mean_facets(const SolidEnergy *energy, bool is_inside, float alpha) {
    EnergyKnot a = energy_alpha_knot(alpha, ENERGY_PER_OCTAVE);
    const LostFacets *row = energy->side[is_inside].mean_facets + a.low;
    LostFacets sum = {{0}, {0}};
    add_facets(&sum, &row[0], 1 - a.t);
    add_facets(&sum, &row[1], a.t);
    return sum;
}
