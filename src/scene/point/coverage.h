/* SPDX-License-Identifier: Apache-2.0 */
/* coverage.h -- how much of a triangle is there: its base colour's texel, and alpha. */
#pragma once
#include "scene/point/texture_slot.h"

/* COLOR_0 at the point, linear; false: the part has none. */
bool vertex_color(const Scene *scene, uint32_t triangle, const TrianglePoint *point, float rgba[4]);

/* Vertex colour times base colour texture at the point, straight alpha in [3]; linear, the
 * material's factor left out. */
void coverage_texel(const Scene *scene, const Material *material, const Hit *hit,
                    const TrianglePoint *point, float texel[4]);

/* Alpha of the material where its texel has this alpha: 1 all there, 0 a hole. */
float coverage_alpha(const Material *material, float texel_alpha);

/* Both at once; 1 without a look at textures where the material is opaque. */
float coverage_at(const Scene *scene, const Hit *hit, const TrianglePoint *point);
