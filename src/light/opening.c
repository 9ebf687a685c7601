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

/* Drawn as seen from infinity in direction e of the unit body, any length. */
static OpeningPoint draw(const LuminousOpening *opening, Vec3 e, const float u[2]) {
    OpeningShape shape = opening->shape;
    Vec3 half = opening_half(opening);
    OpeningPoint out = {.at = vec3(0, 0, 0), .drawn = 1};
    if (shape == OPENING_POINT) return out;
    if (opening->is_flat) {
        Vec3 at = flat_point(shape, u);
        out.at = opening_turned_back(opening, vec3(half.x * at.x, half.y * at.y, 0));
        return out;
    }
    out.drawn = 0;
    if (!(vec3_dot(e, e) > 0)) return out;
    BodyPoint point = body_point(shape, e, u);
    Vec3 at = vec3(half.x * point.at.x, half.y * point.at.y, half.z * point.at.z);
    out.at = opening_turned_back(opening, at);
    out.normal = point.normal;
    out.drawn = share_towards(shape, point.normal, e);
    return out;
}

float opening_share(const LuminousOpening *opening, const OpeningPoint *point, Vec3 from) {
    if (opening->shape == OPENING_POINT || opening->is_flat) return 1;
    if (!(point->drawn > 0)) return 0;
    Vec3 seen_by = opening_stretched(opening_half(opening),
                                     opening_turned(opening, vec3_sub(from, point->at)));
    return share_towards(opening->shape, point->normal, seen_by) / point->drawn;
}

/* By a random direction; of these half do not see a point. */
OpeningPoint opening_point(const LuminousOpening *opening, const float u[4]) {
    float z = 1 - 2 * u[2], r = safe_sqrtf(1 - z * z), sine, cosine;
    sincos_turns(u[3], &sine, &cosine);
    OpeningPoint out = draw(opening, vec3(r * cosine, r * sine, z), u);
    bool is_body = opening->shape != OPENING_POINT && !opening->is_flat;
    if (is_body) out.drawn *= 0.5f;
    return out;
}

/* A point visible from near by faces the direction of `from` too, since the middle lies below
 * its plane. */
Vec3 opening_sample(const LuminousOpening *opening, Vec3 from, const float u[2], float *weight) {
    Vec3 e = opening_stretched(opening_half(opening), opening_turned(opening, from));
    OpeningPoint point = draw(opening, e, u);
    *weight = opening_share(opening, &point, from);
    return point.at;
}
