/* SPDX-License-Identifier: Apache-2.0 */
/* vec.h -- vectors, affine transforms and orthonormal frames of three dimensions.
 *
 * Frames of reference are named destination-from-source (`world_from_camera`).
 */
#pragma once
#include <math.h>
#include <stdbool.h>

typedef struct Vec2 {
    float x, y;
} Vec2;

typedef struct Vec3 {
    float x, y, z;
} Vec3;

/* Columns x, y, z are the images of the unit vectors; `origin` is the image of 0. */
typedef struct Transform {
    Vec3 x, y, z, origin;
} Transform;

/* Right-handed orthonormal: local (a, b, c) is a*x + b*y + c*z in the outer frame. */
typedef struct Frame {
    Vec3 x, y, z;
} Frame;

static inline Vec3 vec3(float x, float y, float z) {
    return (Vec3){x, y, z};
}

static inline Vec3 vec3_from_doubles(const double v[3]) {
    return vec3((float)v[0], (float)v[1], (float)v[2]);
}

static inline Vec3 vec3_add(Vec3 a, Vec3 b) {
    return vec3(a.x + b.x, a.y + b.y, a.z + b.z);
}

static inline Vec3 vec3_sub(Vec3 a, Vec3 b) {
    return vec3(a.x - b.x, a.y - b.y, a.z - b.z);
}

static inline Vec3 vec3_scale(Vec3 a, float s) {
    return vec3(a.x * s, a.y * s, a.z * s);
}

static inline Vec3 vec3_neg(Vec3 a) {
    return vec3(-a.x, -a.y, -a.z);
}

/* a + s b */
static inline Vec3 vec3_along(Vec3 a, Vec3 b, float s) {
    return vec3(a.x + s * b.x, a.y + s * b.y, a.z + s * b.z);
}

static inline float vec3_dot(Vec3 a, Vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline Vec3 vec3_cross(Vec3 a, Vec3 b) {
    return vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

static inline float vec3_length(Vec3 a) {
    return sqrtf(vec3_dot(a, a));
}

/* The zero vector stays zero. */
static inline Vec3 vec3_normalize(Vec3 a) {
    float length = vec3_length(a);
    return length > 0 ? vec3_scale(a, 1 / length) : a;
}

/* Every coordinate is a number, no further from 0 than `most`. */
static inline bool vec3_is_within(Vec3 a, float most) {
    return fabsf(a.x) <= most && fabsf(a.y) <= most && fabsf(a.z) <= most;
}

static inline Transform transform_identity(void) {
    return (Transform){{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};
}

static inline Vec3 transform_vector(const Transform *t, Vec3 v) {
    return vec3(t->x.x * v.x + t->y.x * v.y + t->z.x * v.z,
                t->x.y * v.x + t->y.y * v.y + t->z.y * v.z,
                t->x.z * v.x + t->y.z * v.y + t->z.z * v.z);
}

static inline Vec3 transform_point(const Transform *t, Vec3 p) {
    return vec3_add(transform_vector(t, p), t->origin);
}

/* First b, then a. */
static inline Transform transform_compose(const Transform *a, const Transform *b) {
    return (Transform){transform_vector(a, b->x), transform_vector(a, b->y),
                       transform_vector(a, b->z), transform_point(a, b->origin)};
}

static inline float transform_determinant(const Transform *t) {
    return vec3_dot(vec3_cross(t->x, t->y), t->z);
}

/* A normal's image, not normalised: the cofactor matrix, valid for any sign of the
 * determinant (the sign is kept out, so that a mirrored object's normals stay outside). */
static inline Vec3 transform_normal(const Transform *t, Vec3 n) {
    float sign = transform_determinant(t) < 0 ? -1.0f : 1.0f;
    Vec3 a = vec3_cross(t->y, t->z), b = vec3_cross(t->z, t->x), c = vec3_cross(t->x, t->y);
    return vec3(sign * (a.x * n.x + b.x * n.y + c.x * n.z),
                sign * (a.y * n.x + b.y * n.y + c.y * n.z),
                sign * (a.z * n.x + b.z * n.y + c.z * n.z));
}

/* Any frame around the unit vector z (Duff et al. 2017, JCGT 6(1), branchless). */
static inline Frame frame_from_z(Vec3 z) {
    float sign = copysignf(1.0f, z.z);
    float a = -1.0f / (sign + z.z);
    float b = z.x * z.y * a;
    return (Frame){vec3(1 + sign * z.x * z.x * a, sign * b, -sign * z.x),
                   vec3(b, sign + z.y * z.y * a, -z.y), z};
}

static inline Vec3 frame_to_local(const Frame *f, Vec3 v) {
    return vec3(vec3_dot(v, f->x), vec3_dot(v, f->y), vec3_dot(v, f->z));
}

static inline Vec3 frame_to_world(const Frame *f, Vec3 v) {
    return vec3_along(vec3_along(vec3_scale(f->x, v.x), f->y, v.y), f->z, v.z);
}
