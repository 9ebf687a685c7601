/* SPDX-License-Identifier: Apache-2.0 */
/* panel_reference.h -- what a reflection is divided by before its logarithm is stored, and how
 * it goes on beyond the last measured incidence. Private to src/panel.
 *
 * A surface of facets (Torrance and Sparrow 1967; Walter et al. 2007) has
 *     f = F(theta_d) D(s) G / (4 cos theta_i cos theta_o),   cos 2 theta_d = wi . wo,
 * s the slopes of the facet between wi and wo. Stored over F(theta_d) / (cos theta_i +
 * cos theta_o)^2, which is reciprocal, finite at the horizon and the same near the mirror
 * direction; what is left changes little with the incidence. G is Smith's of GGX, of both
 * directions together (Heitz 2014): 1 / (1 + Lambda_i + Lambda_o).
 * Fine roughness (Harvey) is stored over the root of F(theta_i) F(theta_o).
 *
 * Units    sr^-1 up to constants. Threads: pure functions. HOT: no libm.
 */
#pragma once
#include "base/mathf.h"
#include "panel/query/panel_opened.h"
#include "spectrum/fresnel.h"

/* Cosine of the angle to the facet between two directions. */
static inline float panel_facet_cosine(Vec3 wi, Vec3 wo) {
    return clampf(safe_sqrtf(0.5f * (1 + vec3_dot(wi, wo))), 0, 1);
}

/* For frames other than the specular-following one. */
static inline float panel_reference(PanelFrameKind frame, float index, Vec3 wi, Vec3 wo) {
    if (frame == PANEL_FRAME_COSINES)
        return sqrtf(fresnel_unpolarised(wi.z, index) * fresnel_unpolarised(wo.z, index));
    float sum = wi.z + wo.z;
    return fresnel_unpolarised(panel_facet_cosine(wi, wo), index) / (sum * sum);
}

/* z (1 + 2 Lambda): stays finite at the horizon. */
static inline float panel_masked(SurfaceAxes roughness, Vec3 d) {
    float along =
        roughness.xx * d.x * d.x + 2 * roughness.xy * d.x * d.y + roughness.yy * d.y * d.y;
    return sqrtf(d.z * d.z + along);
}

/* G / (cos theta_i cos theta_o), up to a factor; Lambda = (masked / z - 1) / 2. */
static inline float panel_masking(SurfaceAxes roughness, Vec3 wi, Vec3 wo) {
    return 1 / (wo.z * panel_masked(roughness, wi) + wi.z * panel_masked(roughness, wo));
}
