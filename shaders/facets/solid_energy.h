/* solid_energy.h -- what the facets of a closed solid's rough boundary pass to one another.
 *
 * A GGX boundary of single facets (dielectric.c) reflects and refracts less than it gets: light
 * that one facet sends into another is left out. Per side, of light from a direction: the share
 * that is `lost` so, its mean over that side's hemisphere, and how much of it goes `across`.
 * Spread over both sides as  lost(wo) lost(wi) / mean  it comes back whole, the same both ways
 * (after Kulla and Conty 2017: Revisiting physically based shading at Imageworks).
 *
 * Interpolated linearly between energy.h's nodes.
 *
 * Memory   31 KiB in the caller's arena. Threads: const once built.
 * Fails    never. A row of one alpha takes some milliseconds, all of them a third of a second.
 */
#pragma once
#include "shaders/facets/energy.h"
#include "shaders/facets/lobe_facets.h"

/* A reflectance other than bare glass's enters as the polynomial through its values at
 * facet_cosine (lobe_facets.h), cosines in the medium of the smaller index. Per unit of a
 * facet's reflectance or transmittance there, the share that is lost: */
typedef struct LostFacets {
    float reflected[LOBE_FACETS], through[LOBE_FACETS];
} LostFacets;

typedef struct SolidSide {
    float mean[ENERGY_ALPHAS]; /* of lost, weighted by the cosine */
    float lost[ENERGY_ALPHAS][ENERGY_COSINES];
    LostFacets  mean_facets[ENERGY_ALPHAS];
    LostFacets *facets; /* [ENERGY_ALPHAS][ENERGY_COSINES]; NULL: for bare boundaries alone */
} SolidSide;

typedef struct SolidEnergy {
    float     ior;                 /* of the solid against its surroundings */
    float     flux[ENERGY_ALPHAS]; /* outside: mean times the share that goes across */
    SolidSide outside, inside;
} SolidEnergy;

/* ior: above 0, or 0 for what reflects everything. Rows are built for alpha from least to most,
 * each in [0, 1], and hold between these. has_facets: for boundaries that are not bare, too. */
const SolidEnergy *solid_energy_build(float ior, float least, float most, bool has_facets,
                                      Arena *arena);

/* Of one side at one alpha. */
typedef struct SolidLost {
    float lost; /* of light from that cosine, [0, 1] */
    float mean; /* 0: nothing is lost */
    float flux; /* what goes across from outside, times that side's mean */
} SolidLost;

/* The facets of that loss and of its mean. The table must have them. */
LostFacets solid_lost_facets(const SolidEnergy *energy, bool is_inside, float cosine,
                             float alpha);
LostFacets solid_mean_facets(const SolidEnergy *energy, bool is_inside, float alpha);

SolidLost solid_lost(const SolidEnergy *energy, bool is_inside, float cosine, float alpha);
