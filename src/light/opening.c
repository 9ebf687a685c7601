/* SPDX-License-Identifier: Apache-2.0 */
#include "light/opening.h"

/* A point of the unit body and its normal; both are on the opening's own axes. */
typedef struct BodyPoint {
    Vec3 at, normal;
} BodyPoint;

static void disc_point(const float u[2], float *x, float *y) {
    float radius = sqrtf(u[0]), sine, cosine;
    sincos_turns(u[1], &sine, &cosine);
    *x = radius * cosine;
    *y = radius * sine;
}

/* Uniform on what has no height: a rectangle or an ellipse. */
static Vec3 flat_point(OpeningShape shape, const float u[2]) {
    Vec3 at = vec3(2 * u[0] - 1, 2 * u[1] - 1, 0);
    if (shape != OPENING_BOX) disc_point(u, &at.x, &at.y);
    return at;
}

/* ---- bodies ------------------------------------------------------------------------------ */

/* Each sampler draws a point with density n . e / opening_unit_area(e) on the unit body: as
 * the body is seen from infinity in direction e. */

static BodyPoint box_point(Vec3 e, const float u[2]) {
    float total = fabsf(e.x) + fabsf(e.y) + fabsf(e.z), pick = u[0] * total;
    float before = 0, side = e.x, share = fabsf(e.x);
    int face = 0;
    if (pick >= share) {
        before = share;
        face = pick < before + fabsf(e.y) ? 1 : 2;
        if (face == 2) before += fabsf(e.y);
        side = face == 1 ? e.y : e.z;
        share = fabsf(side);
    }
    float sign = side < 0 ? -1 : 1;
    float a = 2 * clampf((pick - before) / share, 0, 1) - 1, b = 2 * u[1] - 1;
    if (face == 0) return (BodyPoint){vec3(sign, a, b), vec3(sign, 0, 0)};
    if (face == 1) return (BodyPoint){vec3(b, sign, a), vec3(0, sign, 0)};
    return (BodyPoint){vec3(a, b, sign), vec3(0, 0, sign)};
}

/* On the round side the sine of the angle from where it faces e is uniform. */
static BodyPoint cylinder_point(Vec3 e, const float u[2]) {
    float across = sqrtf(e.x * e.x + e.y * e.y);
    float cap = PI_F * fabsf(e.z), pick = u[0] * (cap + 4 * across);
    if (pick < cap || !(across > 0)) {
        const float v[2] = {clampf(pick / cap, 0, 1), u[1]};
        BodyPoint out = {vec3(0, 0, e.z < 0 ? -1 : 1), vec3(0, 0, e.z < 0 ? -1 : 1)};
        disc_point(v, &out.at.x, &out.at.y);
        return out;
    }
    float sine = 2 * clampf((pick - cap) / (4 * across), 0, 1) - 1;
    float cosine = safe_sqrtf(1 - sine * sine), x = e.x / across, y = e.y / across;
    Vec3 normal = vec3(x * cosine - y * sine, y * cosine + x * sine, 0);
    return (BodyPoint){vec3(normal.x, normal.y, 2 * u[1] - 1), normal};
}

static BodyPoint ball_point(Vec3 e, const float u[2]) {
    Vec3 local = vec3(0, 0, safe_sqrtf(1 - u[0]));
    Frame frame = frame_from_z(vec3_normalize(e));
    disc_point(u, &local.x, &local.y);
    Vec3 normal = frame_to_world(&frame, local);
    return (BodyPoint){normal, normal};
}

static BodyPoint body_point(OpeningShape shape, Vec3 e, const float u[2]) {
    switch (shape) {
    case OPENING_BOX: return box_point(e, u);
    case OPENING_CYLINDER: return cylinder_point(e, u);
    case OPENING_ELLIPSOID: return ball_point(e, u);
    case OPENING_POINT: break;
    }
    return (BodyPoint){vec3(0, 0, 0), vec3(0, 0, 0)};
}

/* Share of the light towards e that leaves by unit area about a point with normal n. */
static float share_towards(OpeningShape shape, Vec3 n, Vec3 e) {
    float seen = vec3_dot(n, e);
    return seen > 0 ? seen / opening_unit_area(shape, e) : 0;
}

/* Drawn as seen from infinity in the direction of `from`, weighed as seen from there. A point
 * visible from near by faces that direction too, since the middle lies below its plane. */
Vec3 opening_sample(const LuminousOpening *opening, Vec3 from, const float u[2], float *weight) {
    OpeningShape shape = opening->shape;
    Vec3 half = opening_half(opening), x = opening_turned(opening, from);
    *weight = 1;
    if (shape == OPENING_POINT) return vec3(0, 0, 0);
    if (opening->is_flat) {
        Vec3 at = flat_point(shape, u);
        return opening_turned_back(opening, vec3(half.x * at.x, half.y * at.y, 0));
    }
    Vec3 e = opening_stretched(half, x);
    *weight = 0;
    if (!(vec3_dot(e, e) > 0)) return vec3(0, 0, 0);
    BodyPoint point = body_point(shape, e, u);
    Vec3 at = vec3(half.x * point.at.x, half.y * point.at.y, half.z * point.at.z);
    Vec3 seen_by = opening_stretched(half, vec3_sub(x, at));
    float drawn = share_towards(shape, point.normal, e);
    if (drawn > 0) *weight = share_towards(shape, point.normal, seen_by) / drawn;
    return opening_turned_back(opening, at);
}
