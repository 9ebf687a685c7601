/* SPDX-License-Identifier: Apache-2.0 */
/* covered_lobe.h -- what GGX facets send out through a coat, and below an overlay, in all.
 *
 * Of light from w that the coat let in, a facet met at cosine d sends R(d) lobe(w, wi) to wi,
 * times what the overlay keeps of both (overlay.h) and t(wi), the share that the coat lets out.
 * `facets` are the integral of that over wi, as lobe_facets.h's: it is the sum of weight
 * R(facet_cosine). A white metal's lobe has min(t(w), t(wi)) and R = 1 there instead; of the
 * light that coat and overlay let in along w, `lost` is what does not come back in that lobe.
 *
 * A table would have seven dimensions: it is integrated where it is evaluated, over points of
 * the lobe, but only for the differences of t and the overlay from their means over it; the
 * rest is lobe_facets.h's. That takes some microseconds.
 *
 * Errors   to 85 degrees 3e-4 of the light in the mean, at most 3e-3, beside lobe_facets.h's.
 * Threads  pure functions.  Fails  never.
 */
#pragma once
#include <stdbool.h>

#include "shaders/facets/energy.h"
#include "shaders/facets/lobe_facets.h"

/* Coat and overlay over the facets, by the cosine (energy_cosine_knot). */
typedef struct Cover {
    Vec2 alpha;                 /* of the facets, each in [SMOOTH_ALPHA, 1] */
    Vec3 normal;                /* of the coat, unit */
    float open[ENERGY_COSINES]; /* t: what the coat lets pass */
    bool has_overlay;
    float kept[ENERGY_COSINES]; /* what the overlay leaves; the lesser of both counts */
} Cover;

typedef struct CoveredLobe {
    LobeFacets facets;
    float lost;
} CoveredLobe;

/* w: a unit direction with z > 0. */
CoveredLobe covered_lobe(const Cover *cover, Vec3 w);

/* Means over the hemisphere, cosine-weighted; facets: of light that came to the coat. */
CoveredLobe covered_mean(const Cover *cover);
