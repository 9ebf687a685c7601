/* SPDX-License-Identifier: Apache-2.0 */
/* footprint.h -- what a frame's pixel covers along a ray that mirrors and clear glass turn.
 *
 * Ray differentials (H. Igehy, Tracing Ray Differentials, SIGGRAPH 1999): by how much the ray's
 * place and direction change from one pixel of the frame to the next, along two directions at
 * right angles. Exact to first order, curved boundaries included: there the normal changes over
 * a triangle as that between its corners' does.
 *
 * Left out: the shift of an image by the thickness of a pane (nearly the same for all rays
 * nearby), and in dispersive glass the difference of an index from the mean one.
 *
 * Frame    scene, m.
 * Threads  plain values. HOT: no allocation, no libm.
 */
#pragma once
#include "path/surface.h"

typedef struct RayFootprint {
    Vec3 place[2]; /* m, at the ray's origin; what lies along the ray does not count */
    Vec3 way[2];   /* of the unit direction, across it */
} RayFootprint;

/* The footprint at the start of a camera's ray. */
RayFootprint footprint_of_cone(RayCone cone, Vec3 direction);

/* The place's changes at `distance` m along the ray, in the axes of a frame. */
void footprint_across(const RayFootprint *footprint, float distance, const Frame *frame,
                      Vec3 across[2]);

/* Turns it at a surface that the ray meets after `distance` m, coming from wo, and leaves by
 * `next` (local). False: it scatters there, or a texture bends its normal, and the footprint
 * is unknown from there on. */
bool footprint_turn(RayFootprint *footprint, const Scene *scene, const Surface *surface,
                    Vec3 wo, const BsdfSample *next, float distance);
