/* SPDX-License-Identifier: Apache-2.0 */
/* solid_energy.h -- what the facets of a closed solid's rough boundary pass to one another.
 *
 * A GGX boundary of single facets (dielectric.c) reflects and refracts less than it gets: light
 * that one facet sends into another is left out. Per side, of light from a direction: the share
 * that is `lost` so, its mean over that side's hemisphere, and how much of it goes `across`.
 * Spread over both sides as  lost(wo) lost(wi) / mean  it comes back whole, the same both ways
 * (after Kulla and Conty 2017: Revisiting physically based shading at Imageworks).
 *
 * Interpolated linearly between energy.h's nodes. Two alphas have brushed_loss.h's tables.
 *
 * Memory   31 KiB in the caller's arena. Threads: const once built.
 * Fails    never. A row of one alpha takes some milliseconds, all of them a third of a second.
 */
#pragma once
#include "shaders/facets/brushed_loss.h"
#include "shaders/facets/energy.h"

typedef struct SolidSide {
    float mean[ENERGY_ALPHAS]; /* of lost, weighted by the cosine */
    float lost[ENERGY_ALPHAS][ENERGY_COSINES];
    LostFacets mean_facets[ENERGY_ALPHAS];
    LostFacets *facets; /* [ENERGY_ALPHAS][ENERGY_COSINES]; NULL: for bare boundaries alone */
} SolidSide;

typedef struct SolidEnergy {
    float ior;                  /* of the solid against its surroundings */
    float flux[ENERGY_ALPHAS];  /* outside: mean times the share that goes across */
    SolidSide side[2];          /* outside, inside */
    const BrushedLoss *brushed; /* where both alphas differ; NULL: they never do */
} SolidEnergy;

/* ior: above 0, or 0 for what reflects everything. Rows are built for alpha from least to most,
 * each in [0, 1], and hold between these. has_facets: for boundaries that are not bare, too. */
const SolidEnergy *solid_energy_build(float ior, float least, float most, bool has_facets,
                                      Arena *arena);

/* A copy that holds for the pairs of alphas of a brushed boundary too. */
const SolidEnergy *solid_energy_brushed(const SolidEnergy *even, BrushedRange range, Arena *arena);

/* Losses at one alpha. */
SolidLost solid_lost(const SolidEnergy *energy, bool is_inside, float cosine, float alpha);

/* The facets of that loss and of its mean. The table must have them. */
LostFacets solid_lost_facets(const SolidEnergy *energy, bool is_inside, float cosine, float alpha);
LostFacets solid_mean_facets(const SolidEnergy *energy, bool is_inside, float alpha);
