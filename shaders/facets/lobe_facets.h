/* SPDX-License-Identifier: Apache-2.0 */
/* lobe_facets.h -- the facets that a rough boundary's lobe meets, as a few that stand for all.
 *
 * What GGX facets of roughness alpha (microfacet.h) send back of light from one direction is
 * the integral, over the cosine at which facets are met, of their reflectance R times a weight
 * that does not depend on R. With R as the polynomial through its values at the LOBE_FACETS
 * zeros of a Chebyshev polynomial it is  sum of weight R(facet_cosine),  with weights that are
 * tabulated over both alphas, cosine and azimuth: of any index and of thin films. With R = 1 it
 * is the lobe's own albedo.
 *
 * Between its nodes the table is cubic: albedos are within 1.3e-3 to 85 degrees, in the mean
 * 2e-4, and what Fresnel's curve of index 1.5 sends back within 2.5e-3, in the mean 1e-4.
 *
 * Memory   1.2 MB, made with the program (tables/make_tables.c).
 * Threads  pure functions.  Fails  never.
 */
#pragma once
#include "base/mathf.h"
#include "base/vec.h"

#define LOBE_FACETS 8
/* Nodes on the axes below, both alphas' from FACET_LEAST to 1. */
#define FACET_ALPHAS 13 /* of the greater alpha, evenly in its fourth root */
#define FACET_RATIOS 10 /* of the lesser over the greater, likewise */
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
static inline void facet_polynomials(double x, double value[LOBE_FACETS]) {
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

/* ---- what a solid's rough boundary loses ------------------------------------------------- */

/* Losses of one side at one alpha, or at one pair of alphas. */
typedef struct SolidLost {
    float lost; /* of light from that direction, [0, 1] */
    float mean; /* of lost over the hemisphere, weighted by the cosine; 0: nothing is lost */
    float flux; /* what goes across from outside, times that side's mean */
} SolidLost;

/* A reflectance other than bare glass's enters as the polynomial through its values at
 * facet_cosine, cosines in the medium of the smaller index. Per unit of a facet's reflectance
 * or transmittance there, the share that is lost: */
typedef struct LostFacets {
    float reflected[LOBE_FACETS], through[LOBE_FACETS];
} LostFacets;

/* ---- how directions above a brushed boundary stand in tables -----------------------------
 *
 * For alphas much below 1 only ratios matter: of the two, and of the cosine to the alpha along
 * the direction's own azimuth (Heitz 2014: G depends on nothing else), `own` below. So the axes
 * are the fourth roots of the greater alpha and of the ratio of both; the root of own from the
 * lesser (0) to the greater (1), `turn`; and facet_axis.
 * alpha: of x and y, each in [SMOOTH_ALPHA, 1]. w: a unit direction with z > 0. */

#define FACET_LEAST 0.17782794f /* the fourth root of SMOOTH_ALPHA, where alphas begin */

/* Neighbours of an axis' nodes: four, or the one that it has. */
typedef struct FacetKnot {
    int first, count;
    float share[4];
} FacetKnot;

/* Lagrange's cubic at `share` of the axis, of at least four nodes. */
static inline FacetKnot facet_knot(float share, int count) {
    float place = clampf(share, 0, 1) * (float)(count - 1);
    int first = (int)place - 1;
    if (first < 0) first = 0;
    if (first > count - 4) first = count - 4;
    float a = place - (float)first, b = a - 1, c = a - 2, d = a - 3;
    return (FacetKnot){
        first,
        4,
        {b * c * d * (-1.0f / 6), a * c * d * 0.5f, a * b * d * -0.5f, a * b * c * (1.0f / 6)}};
}

static inline float facet_own(Vec3 w, Vec2 alpha) {
    float x = alpha.x * w.x, y = alpha.y * w.y, side2 = w.x * w.x + w.y * w.y;
    return side2 > 1e-12f ? sqrtf((x * x + y * y) / side2) : max_f(alpha.x, alpha.y);
}

static inline float facet_turn(float own, Vec2 alpha) {
    float high = max_f(alpha.x, alpha.y), low = min_f(alpha.x, alpha.y);
    return high > low ? safe_sqrtf((own - low) / (high - low)) : 0;
}

/* Where a cosine stands on the table's axis, 0 to 1. Half of the axis is for cosines about the
 * own alpha. */
static inline float facet_axis(float cosine, float own) {
    return 0.5f * cosine * (1 + (1 + own) / (cosine + own));
}

/* The inverse of facet_axis, which rises; for what is made before the first ray. */
static inline float facet_axis_cosine(float x, float own) {
    float low = 1e-5f, high = 1;
    if (x >= 1) return 1;
    for (int step = 0; step < 40; step++) {
        float middle = 0.5f * (low + high);
        if (facet_axis(middle, own) < x) low = middle;
        else high = middle;
    }
    return low;
}

/* A direction of that cosine and of that alpha along its azimuth; alpha.x is the greater. */
static inline Vec3 facet_direction(float cosine, float own, Vec2 alpha) {
    float range = alpha.x * alpha.x - alpha.y * alpha.y;
    float c2 = range > 0 ? clampf((own * own - alpha.y * alpha.y) / range, 0, 1) : 1;
    float sine = safe_sqrtf(1 - cosine * cosine);
    return vec3(sine * sqrtf(c2), sine * sqrtf(1 - c2), cosine);
}
