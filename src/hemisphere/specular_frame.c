/* SPDX-License-Identifier: Apache-2.0 */
#include "hemisphere/specular_frame.h"

#include "base/mathf.h"
#include "base/units.h"

#define RIGHT_ANGLE (0.5f * PI_F)

/* A point of the unit disk whose radius is the polar angle over 90 degrees. */
static Vec2 disk_from_direction(Vec3 d) {
    float across = sqrtf(d.x * d.x + d.y * d.y);
    if (!(across > 0)) return (Vec2){0, 0};
    float radius = atan2_f(across, d.z > 0 ? d.z : 0.0f) / RIGHT_ANGLE;
    return (Vec2){d.x * (radius / across), d.y * (radius / across)};
}

/* azimuth: unit; radius in [0, 1]. */
static Vec3 direction_from_polar(Vec2 azimuth, float radius) {
    float sine, cosine;
    sincos_turns(0.25f * clampf(radius, 0, 1), &sine, &cosine);
    return vec3(sine * azimuth.x, sine * azimuth.y, cosine > 0 ? cosine : 0.0f);
}

static float disk_radius(Vec2 p) {
    return sqrtf(p.x * p.x + p.y * p.y);
}

static Vec2 unit_or_right(Vec2 p) {
    float length = disk_radius(p);
    return length > 0 ? (Vec2){p.x / length, p.y / length} : (Vec2){1, 0};
}

/* base^exponent for base in [0, 1]; exact square and root for the common exponents. */
static float power(float base, float exponent) {
    if (exponent == 1.0f) return base;
    if (exponent == 2.0f) return base * base;
    if (exponent == 0.5f) return sqrtf(base);
    return pow_f(base, exponent);
}

SpecularFrame specular_frame(float theta_i, float k) {
    return (SpecularFrame){clampf(theta_i / RIGHT_ANGLE, 0, 89.0f / 90.0f), k > 1 ? k : 1.0f};
}

/* |U - (1-c) d0| = c with df = U - d0 is A c^2 - 2 (df.d0) c - |df|^2 = 0; its positive root,
 * in the form that subtracts nothing. */
static float blend_of(float offset, Vec2 df) {
    float a = 1 - offset * offset, b = 2 * df.x * offset;
    float square = df.x * df.x + df.y * df.y, root = sqrtf(b * b + 4 * a * square);
    if (!(square > 0)) return 0;
    return b > 0 ? (b + root) / (2 * a) : 2 * square / (root - b);
}

/* A stored point: azimuth e (unit), c = r^k. */
typedef struct StoredPoint {
    Vec2 e;
    float c, r;
} StoredPoint;

static StoredPoint stored_point(const SpecularFrame *frame, Vec2 u) {
    Vec2 df = {u.x - frame->offset, u.y};
    float c = clampf(blend_of(frame->offset, df), 0, 1);
    Vec2 e = c > 0 ? unit_or_right((Vec2){df.x + c * frame->offset, df.y}) : (Vec2){1, 0};
    return (StoredPoint){e, c, power(c, 1 / frame->exponent)};
}

Vec3 specular_frame_stored(const SpecularFrame *frame, Vec3 outer) {
    StoredPoint p = stored_point(frame, disk_from_direction(outer));
    return direction_from_polar(p.e, p.r);
}

/* U of a stored point: azimuth e, c = r^k. */
static Vec2 outer_disk(const SpecularFrame *frame, Vec2 e, float r) {
    float c = power(r, frame->exponent);
    return (Vec2){c * e.x + (1 - c) * frame->offset, c * e.y};
}

Vec3 specular_frame_outer(const SpecularFrame *frame, Vec3 stored) {
    Vec2 p = disk_from_direction(stored);
    Vec2 u = outer_disk(frame, unit_or_right(p), clampf(disk_radius(p), 0, 1));
    return direction_from_polar(unit_or_right(u), disk_radius(u));
}

/* sin t / t for t = radius * 90 degrees. */
static float sinc(float radius, float sine) {
    return radius < 1e-4f ? 1.0f : sine / (radius * RIGHT_ANGLE);
}

static float sine_of_radius(float radius) {
    float sine, cosine;
    sincos_turns(0.25f * radius, &sine, &cosine);
    return sine;
}

/* d(radius) of the stored disk to that of the outer one: k r^(2k-2), see below. */
static float stretch_at(float r, float k) {
    return k == 1.0f ? 1.0f : k * power(r * r, k - 1);
}

/* Polar angles are theta = 90deg * radius, so that d(solid angle) = sinc(theta) (pi/2)^2 dA of
 * the disk. With c = r^k the areas are
 *     dA_outer = |dU/dc x dU/dphi| dc dphi = c (1 - d0.e) k r^(k-1) dr dphi,
 *     dA_stored = r dr dphi. */
float specular_frame_jacobian(const SpecularFrame *frame, Vec3 stored) {
    Vec2 p = disk_from_direction(stored), e = unit_or_right(p);
    float r = clampf(disk_radius(p), 0, 1);
    float outer = disk_radius(outer_disk(frame, e, r));
    return sinc(outer, sine_of_radius(outer)) / sinc(r, sine_of_radius(r)) *
           (1 - frame->offset * e.x) * stretch_at(r, frame->exponent);
}

Vec3 specular_frame_outer_jacobian(const SpecularFrame *frame, Vec3 stored, float *jacobian) {
    Vec2 p = disk_from_direction(stored), e = unit_or_right(p);
    float r = clampf(disk_radius(p), 0, 1);
    Vec2 u = outer_disk(frame, e, r);
    float outer_r = disk_radius(u);
    Vec3 outer = direction_from_polar(unit_or_right(u), outer_r);
    float outer_sine = disk_radius((Vec2){outer.x, outer.y});
    float stored_sine = disk_radius((Vec2){stored.x, stored.y});
    *jacobian = sinc(outer_r, outer_sine) / sinc(r, stored_sine) * (1 - frame->offset * e.x) *
                stretch_at(r, frame->exponent);
    return outer;
}

/* The two directions know the sines of their polar angles already. */
Vec3 specular_frame_stored_jacobian(const SpecularFrame *frame, Vec3 outer, float *jacobian) {
    Vec2 u = disk_from_direction(outer);
    StoredPoint p = stored_point(frame, u);
    Vec3 stored = direction_from_polar(p.e, p.r);
    float outer_sine = disk_radius((Vec2){outer.x, outer.y});
    float stored_sine = disk_radius((Vec2){stored.x, stored.y});
    *jacobian = sinc(disk_radius(u), outer_sine) / sinc(p.r, stored_sine) *
                (1 - frame->offset * p.e.x) * stretch_at(p.r, frame->exponent);
    return stored;
}
