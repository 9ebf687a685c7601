/* SPDX-License-Identifier: Apache-2.0 */
/* lost_facets.h -- what a solid's rough boundary loses of light from a direction, and by which
 * facets. For solid_energy.h and brushed_loss.h.
 */
#pragma once
#include "shaders/facets/lobe_facets.h"

/* Losses of one side at one alpha, or at one pair of alphas. */
typedef struct SolidLost {
    float lost; /* of light from that direction, [0, 1] */
    float mean; /* of lost over the hemisphere, weighted by the cosine; 0: nothing is lost */
    float flux; /* what goes across from outside, times that side's mean */
} SolidLost;

/* A reflectance other than bare glass's enters as the polynomial through its values at
 * facet_cosine (lobe_facets.h), cosines in the medium of the smaller index. Per unit of a
 * facet's reflectance or transmittance there, the share that is lost: */
typedef struct LostFacets {
    float reflected[LOBE_FACETS], through[LOBE_FACETS];
} LostFacets;
