/* SPDX-License-Identifier: Apache-2.0 */
#include "hemisphere/surface_frame.h"

#include "base/mathf.h"
#include "base/units.h"

#define LEAST_DETERMINANT 1e-20f

static Vec2 multiplied(SurfaceAxes m, Vec2 v) {
    return (Vec2){m.xx * v.x + m.xy * v.y, m.xy * v.x + m.yy * v.y};
}

static float asinh_f(float x) /* x at least 0 */
{
    return log_f(x + sqrtf(1 + x * x));
}

SurfaceFrame surface_frame(bool is_cosine, SurfaceAxes axes, float reach) {
    float determinant = axes.xx * axes.yy - axes.xy * axes.xy;
    float over = 1 / (determinant > LEAST_DETERMINANT ? determinant : LEAST_DETERMINANT);
    return (SurfaceFrame){
        axes, {axes.yy * over, -axes.xy * over, axes.xx * over}, 1 / asinh_f(reach), is_cosine};
}

/* Polar angles over 90 degrees along one direction of s or b. */
typedef struct OffsetRay {
    Vec2 x;        /* axes times the unit direction */
    float length;  /* of x */
    float last;    /* asinh / asinh reach of the horizon */
    float horizon; /* s or b there */
} OffsetRay;

/* With g the light's share along the ray, wo.z = 0 where s^2 - 2 g s = 1, and where |b - wi| is
 * 1; written so that nothing is subtracted. */
static OffsetRay ray_along(const SurfaceFrame *frame, Vec3 wi, Vec2 unit) {
    OffsetRay ray = {multiplied(frame->axes, unit), 0, 0, 0};
    float g = wi.x * unit.x + wi.y * unit.y;
    if (!frame->is_cosine) g /= wi.z;
    float square = frame->is_cosine ? wi.z * wi.z : 1, root = sqrtf(g * g + square);
    ray.length = sqrtf(ray.x.x * ray.x.x + ray.x.y * ray.x.y);
    ray.horizon = g > 0 ? root + g : square / (root - g);
    ray.last = clampf(asinh_f(ray.horizon * ray.length) * frame->scale, 1e-6f, 1);
    return ray;
}

/* The horizon is moved to 90 degrees, the neighbourhood of the peak hardly at all. */
static float moved(float last, float at) {
    float share = at < last ? at / last : 1, square = share * share;
    return share * last + (1 - last) * square * square;
}

Vec3 surface_frame_stored(const SurfaceFrame *frame, Vec3 wi, Vec3 wo) {
    float over = frame->is_cosine ? 1 : 1 / (wi.z + wo.z), sine, cosine;
    Vec2 at = {(wi.x + wo.x) * over, (wi.y + wo.y) * over};
    float size = sqrtf(at.x * at.x + at.y * at.y);
    if (!(size > 1e-9f)) return vec3(0, 0, 1);
    OffsetRay ray = ray_along(frame, wi, (Vec2){at.x / size, at.y / size});
    float polar = moved(ray.last, asinh_f(size * ray.length) * frame->scale);
    sincos_turns(0.25f * clampf(polar, 0, 1), &sine, &cosine);
    return vec3(sine * ray.x.x / ray.length, sine * ray.x.y / ray.length,
                cosine > 0 ? cosine : 0.0f);
}

/* The inverse of `moved`, by halving. */
static float moved_back(float last, float polar) {
    float low = 0, high = last;
    for (int i = 0; i < 26; i++) {
        float middle = 0.5f * (low + high);
        if (moved(last, middle) < polar) low = middle;
        else high = middle;
    }
    return 0.5f * (low + high);
}

/* s or b of a stored direction. */
static Vec2 offset_of(const SurfaceFrame *frame, Vec3 wi, Vec3 stored) {
    float across = sqrtf(stored.x * stored.x + stored.y * stored.y);
    if (!(across > 0)) return (Vec2){0, 0};
    Vec2 unit = multiplied(frame->inverse, (Vec2){stored.x / across, stored.y / across});
    float size = sqrtf(unit.x * unit.x + unit.y * unit.y);
    unit = (Vec2){unit.x / size, unit.y / size};
    OffsetRay ray = ray_along(frame, wi, unit);
    float polar = atan2_f(across, stored.z) / (0.5f * PI_F);
    float e = exp_f(moved_back(ray.last, polar) / frame->scale);
    float length = 0.5f * (e - 1 / e) / ray.length;
    return (Vec2){unit.x * length, unit.y * length};
}

static Vec3 above_horizon(Vec3 d) {
    float across = sqrtf(d.x * d.x + d.y * d.y);
    if (d.z > 0 || !(across > 0)) return d;
    return vec3(d.x / across, d.y / across, 0);
}

/* `wi` mirrored by a facet with these slopes. */
static Vec3 mirrored(Vec3 wi, Vec2 slope) {
    float over =
        2 * (wi.x * slope.x + wi.y * slope.y + wi.z) / (1 + slope.x * slope.x + slope.y * slope.y);
    return vec3(over * slope.x - wi.x, over * slope.y - wi.y, over - wi.z);
}

Vec3 surface_frame_leaving(const SurfaceFrame *frame, Vec3 wi, Vec3 stored) {
    Vec2 at = offset_of(frame, wi, stored);
    if (!frame->is_cosine) return above_horizon(mirrored(wi, at));
    float x = at.x - wi.x, y = at.y - wi.y;
    float left = 1 - x * x - y * y;
    return above_horizon(vec3(x, y, safe_sqrtf(left)));
}

Vec3 surface_frame_same_facet(Vec3 light, Vec3 wo, Vec3 wi) {
    float over = 1 / (light.z + wo.z);
    return mirrored(wi, (Vec2){(light.x + wo.x) * over, (light.y + wo.y) * over});
}
