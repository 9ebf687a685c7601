/* emission.h -- what a triangle sends out at one point, in one direction.
 *
 * Used where a ray hits an emitter and where one is sampled: the same numbers both times.
 */
#pragma once
#include "bvh/ray.h"
#include "scene/scene.h"
#include "spectrum/wavelengths.h"

/* A point of a triangle, interpolated. */
typedef struct TrianglePoint {
    Vec3  position;
    Vec3  ng;    /* unit, the front's side (counter-clockwise vertices) */
    Vec3  ns;    /* unit, interpolated vertex normal; ng where that vanishes */
    float uv[SCENE_UV_SETS][2];
} TrianglePoint;

TrianglePoint triangle_point(const Scene *scene, uint32_t triangle, float u, float v);

/* Texture coordinates of a slot. */
Vec2 slot_uv(const TextureSlot *slot, const float uv[][2]);

/* The display's frame at a point (physics: the display's frame): +z the shading normal, +x the
 * direction of growing U of its content, +y up. */
Frame display_frame(const Scene *scene, const Display *display, uint32_t triangle,
                    const TrianglePoint *point);

/* Codes, 0..255, that the display shows at the point; white where it has no content. */
void display_codes(const Scene *scene, const Display *display, const TrianglePoint *point,
                   float codes[3]);

/* Emitted colour of a material that is no display, linear Rec.709, cd m^-2; front side. */
void emitted_rgb(const Scene *scene, const Material *material, const TrianglePoint *point,
                 float rgb[3]);

/* Spectral radiance that leaves the point along `direction` (unit, world). */
Spectrum triangle_emission(const Scene *scene, uint32_t triangle, const TrianglePoint *point,
                           Vec3 direction, const Wavelengths *wavelengths);
