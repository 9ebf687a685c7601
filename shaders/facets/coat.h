/* SPDX-License-Identifier: Apache-2.0 */
/* coat.h -- what a lacquer lets through to a rough base and out again, tabulated.
 *
 * Light that a base sends up meets the lacquer from inside; what does not get out comes back
 * to the base, and so on. For a lobe of GGX facets of reflectance 1 under a whole lacquer,
 * CoatShare's `boost` u solves u(wo) * integral of lobe u(wi) cos dwi = t(wo) a(wo), t the
 * share that enters and a the lobe's own albedo (a symmetric scaling: Sinkhorn and Knopp 1967).
 * The lobe times u(wo) u(wi) then sends back all that entered and is reciprocal; a mirror's u
 * is sqrt(t), which is t^2 (1 + r + r^2 ...) with r = 1 - t. `all` and `shape` are the means of
 * what the lacquer holds back over the lobe, alone and times the exact Fresnel curve's shape
 * (energy.h).
 *
 * Memory   740 KiB in the caller's arena. Building takes about a fifth of a second.
 * Threads  const once built.
 */
#pragma once
#include "shaders/facets/energy.h"
#include "spectrum/spectrum.h"

#define COAT_PER_OCTAVE 3 /* rows of alpha; octaves and cosines are energy.h's */
#define COAT_ALPHAS (ENERGY_OCTAVES * COAT_PER_OCTAVE + 1)

typedef struct CoatShare {
    float boost, all, shape;
} CoatShare;

/* Means over the hemisphere, weighted by the cosine. */
typedef struct CoatMean {
    float open;       /* of t */
    float lobe;       /* of t a */
    float all, shape; /* of what the lobe sends out in one go, t (a - all); times the shape */
} CoatMean;

typedef struct CoatTable {
    float ior;                               /* of the base */
    CoatMean mean[COAT_ALPHAS][COAT_ALPHAS]; /* base, coat */
    CoatShare share[COAT_ALPHAS][COAT_ALPHAS][ENERGY_COSINES];
} CoatTable;

/* Of a lacquer on a base of its own index, made as common_energy_table. */
extern const CoatTable common_coat_table;

/* coat: the lacquer's own boundary; base: of the base's index of refraction. */
const CoatTable *coat_table_build(const EnergyTable *base, const EnergyTable *coat, Arena *arena);

/* Share of light along a direction of that cosine that the lacquer's boundary reflects. */
float coat_reflectance(const EnergyTable *coat, float cosine, float coat_alpha);

/* Cosine in [0, 1], both alphas in [0, 1]. */
CoatShare coat_share(const CoatTable *table, float cosine, float alpha, float coat_alpha);
CoatMean coat_mean(const CoatTable *table, float alpha, float coat_alpha);

/* Every further turn between a coat, which lets out the mean share `open`, and a base that
 * spreads light takes the base's albedo. */
Spectrum coat_turns(float open, Spectrum albedo);
