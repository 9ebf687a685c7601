/* SPDX-License-Identifier: Apache-2.0 */
/* footprint.h -- what a frame's pixel covers along a ray that mirrors and clear glass turn.
 *
 * Ray differentials (H. Igehy, Tracing Ray Differentials, SIGGRAPH 1999): by how much the ray's
 * place and direction change from one pixel of the frame to the next, along two directions at
 * right angles. Exact to first order, curved boundaries included: there the normal changes over
 * a triangle as that between its corners' does.
 *
 * A traced ray that leaves a surface starts a little off it and off its triangle's edges
 * (scene/point/ray_ends.h: up to 2^-14 of the longest edge, several sub-pixels of a display).
 * The ray that starts on the surface itself is carried along as one more ray beside the traced
 * one, to the same order, so that a display's image is not torn along a mirror's edges.
 *
 * Left out: the shift of an image by the thickness of a pane (nearly the same for all rays
 * nearby), in dispersive glass the difference of an index from the mean one, and the start
 * behind a sheet that the ray passes straight, off the sheet's edges.
 *
 * Frame    scene, m.
 * Threads  plain values. HOT: no allocation, no libm.
 */
#pragma once
#include "path/surface.h"

/* The rays beside the traced one: of two neighbouring pixels, and the exact one. */
#define FOOTPRINT_EXACT 2
#define FOOTPRINT_RAYS 3

typedef struct RayFootprint {
    Vec3 place[FOOTPRINT_RAYS]; /* m, at the ray's origin; what lies along the ray does not
                                   count */
    Vec3 way[FOOTPRINT_RAYS];   /* of the unit direction, across it */
} RayFootprint;

/* The footprint at the start of a camera's ray. */
RayFootprint footprint_of_cone(RayCone cone, Vec3 direction);

/* The place's changes at `distance` m along the ray, in the axes of a frame. */
void footprint_across(const RayFootprint *footprint, float distance, const Frame *frame,
                      Vec3 across[2]);

/* From where the traced ray meets the surface, coming from wo, to where the exact one does, in
 * the slot's texture coordinates. To the bit 0 until something has turned the ray. */
Vec2 footprint_exact(const RayFootprint *footprint, const Scene *scene,
                     const Surface *surface, const TextureSlot *slot, Vec3 wo, float distance);

/* Turns it at a surface that the ray meets after `distance` m, coming from wo, and leaves by
 * `next` (local). False: it scatters there, or a texture bends its normal, and the footprint
 * is unknown from there on. */
bool footprint_turn(RayFootprint *footprint, const Scene *scene, const Surface *surface,
                    Vec3 wo, const BsdfSample *next, float distance);
