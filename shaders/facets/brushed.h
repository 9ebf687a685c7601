/* SPDX-License-Identifier: Apache-2.0 */
/* brushed.h -- GGX of a surface that is rougher along one direction than across it.
 *
 * Local frame with +z the normal; directions leave the surface. alpha: roughness along the
 * frame's x and y, each in [SMOOTH_ALPHA, 1]; with both equal, microfacet.h's.
 * Sources  Heitz 2014 (D and height-correlated G2 of stretched surfaces), Dupuy & Benyoub 2023
 *          (visible normals), Eto & Tokuyoshi 2023 (the cap bounded to what reflects upwards).
 * Threads  pure functions.
 */
#pragma once
#include "shaders/facets/microfacet.h"

/* D G2 / (4 |wo.z| |wi.z|), as ggx_reflection. */
float brushed_reflection(Vec3 wo, Vec3 wi, Vec3 half, Vec2 alpha);

/* As ggx_sample_visible and ggx_visible_pdf. */
Vec3  brushed_sample_visible(Vec3 wo, Vec2 alpha, float u0, float u1);
float brushed_visible_pdf(Vec3 wo, Vec3 normal, Vec2 alpha);

/* As ggx_sample_reflection and ggx_reflection_pdf. */
Vec3  brushed_sample_reflection(Vec3 wo, Vec2 alpha, float u0, float u1);
float brushed_reflection_pdf(Vec3 wo, Vec3 half, Vec2 alpha);
