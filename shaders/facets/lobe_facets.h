/* SPDX-License-Identifier: Apache-2.0 */
/* lobe_facets.h -- the facets that a rough boundary's lobe meets, as a few that stand for all.
 *
 * What GGX facets of roughness alpha (brushed.h) send back of light from one direction is the
 * integral, over the cosine at which facets are met, of their reflectance R times a weight that
 * does not depend on R. With R as the polynomial through its values at the LOBE_FACETS zeros of
 * a Chebyshev polynomial it is  sum of weight R(facet_cosine),  with weights that are tabulated
 * over both alphas, cosine and azimuth: of any index and of thin films. With R = 1 it is the
 * lobe's own albedo.
 *
 * Between its nodes the table is cubic: albedos are within 1.3e-3 to 85 degrees, in the mean
 * 2e-4, and what Fresnel's curve of index 1.5 sends back within 2.5e-3, in the mean 1e-4.
 *
 * Memory   1.2 MB, made with the program (tables/make_tables.c).
 * Threads  pure functions.  Fails  never.
 */
#pragma once
#include "base/vec.h"

#define LOBE_FACETS 8
/* Nodes on the axes of brushed_axes.h, both alphas' from FACET_LEAST to 1. */
#define FACET_ALPHAS 13   /* of the greater alpha, evenly in its fourth root */
#define FACET_RATIOS 10   /* of the lesser over the greater, likewise */
#define FACET_AZIMUTHS 11
#define FACET_COSINES 27

/* Weights sum up to the albedo of a lobe of reflectance 1. Some may be below 0. */
typedef struct LobeFacets {
    float weight[LOBE_FACETS];
} LobeFacets;

#define MEAN_ALPHAS (4 * FACET_ALPHAS - 3) /* on the same axes */
#define MEAN_RATIOS (4 * FACET_RATIOS - 3)

typedef struct FacetTable {
    LobeFacets mean[MEAN_ALPHAS][MEAN_RATIOS];
    LobeFacets lobe[FACET_ALPHAS][FACET_RATIOS][FACET_AZIMUTHS][FACET_COSINES];
} FacetTable;

extern const FacetTable common_facet_table;

/* Cosines at which R is read: 1/2 - 1/2 cos((k + 1/2) pi / LOBE_FACETS). */
extern const float facet_cosine[LOBE_FACETS];

/* Lagrange's polynomials of the facets' cosines at one. */
static inline void facet_polynomials(double x, double value[LOBE_FACETS])
{
    for (int i = 0; i < LOBE_FACETS; i++) {
        value[i] = 1;
        for (int j = 0; j < LOBE_FACETS; j++) {
            double here = (double)facet_cosine[i], other = (double)facet_cosine[j];
            if (j != i) value[i] *= (x - other) / (here - other);
        }
    }
}

/* w: a unit direction with z > 0. alpha: of x and y, each in [SMOOTH_ALPHA, 1]. */
LobeFacets lobe_facets(const FacetTable *table, Vec3 w, Vec2 alpha);

/* The same for light from everywhere, weighted by the cosine. */
LobeFacets mean_facets(const FacetTable *table, Vec2 alpha);
