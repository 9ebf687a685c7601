/* SPDX-License-Identifier: Apache-2.0 */
/* Luminous openings: sampled points lie on the body, and their weights give what the surface
 * sends out, near by and from afar. */
#include "light_fixture.h"

#include <float.h>

#include "light/opening.h"

static const LuminousOpening OPENINGS[] = {
    {OPENING_BOX, 2, true, {0.5f, 0.2f, 0}},
    {OPENING_BOX, 1, true, {0.5f, 0, 0.3f}},
    {OPENING_BOX, 2, false, {0.5f, 0.2f, 0.1f}},
    {OPENING_CYLINDER, 2, true, {0.4f, 0.2f, 0}},
    {OPENING_CYLINDER, 0, true, {0, 0.3f, 0.3f}},
    {OPENING_CYLINDER, 2, false, {0.3f, 0.2f, 0.5f}},
    {OPENING_CYLINDER, 0, false, {0.6f, 0.1f, 0.1f}},
    {OPENING_ELLIPSOID, 2, false, {0.3f, 0.3f, 0.3f}},
    {OPENING_ELLIPSOID, 2, false, {0.3f, 0.2f, 0.5f}},
};
static const int OPENING_COUNT = (int)(sizeof OPENINGS / sizeof *OPENINGS);

/* cd, in no way symmetric. */
static double intensity(Vec3 d) {
    return 10 + 3 * (double)d.x - 2 * (double)d.y + 4 * (double)(d.z * d.x);
}

static Vec3 direction_of(uint32_t *random) {
    float z = 2 * random_unit(random) - 1, r = sqrtf(1 - z * z);
    double phi = 2 * PI * (double)random_unit(random);
    return vec3(r * (float)cos(phi), r * (float)sin(phi), z);
}

static Mean sampled(const LuminousOpening *opening, Vec3 from, Vec3 facing) {
    Mean mean = {0};
    uint32_t random = 5;
    for (int i = 0; i < SAMPLES; i++) {
        float u[3], weight;
        random3(&random, u);
        Vec3 away = vec3_sub(from, opening_sample(opening, from, u, &weight));
        Vec3 d = vec3_normalize(away);
        double cosine = fmax(-(double)vec3_dot(d, facing), 0);
        mean_add(&mean, (double)weight * intensity(d) * cosine / (double)vec3_dot(away, away));
    }
    return mean;
}

TEST(far_away_it_is_the_measured_intensity) {
    uint32_t random = 3;
    for (int i = 0; i < OPENING_COUNT; i++) {
        Vec3 d = direction_of(&random);
        double r = 300;
        Mean mean = sampled(&OPENINGS[i], vec3_scale(d, (float)r), vec3_neg(d));
        double wanted = intensity(d) / (r * r);
        assert_close(mean.sum / (double)mean.count, wanted, 2e-3);
    }
}

/* Points that are chosen for no receiver give each the same light. */
TEST(points_for_nobody_give_what_points_for_a_receiver_give) {
    uint32_t random = 11;
    for (int i = 0; i < OPENING_COUNT; i++) {
        const LuminousOpening *opening = &OPENINGS[i];
        Vec3 d = direction_of(&random), from = vec3_scale(d, 1.5f);
        Mean wanted = sampled(opening, from, vec3_neg(d)), mean = {0};
        for (int k = 0; k < 4 * SAMPLES; k++) {
            float u[6];
            random3(&random, u);
            random3(&random, u + 3);
            OpeningPoint point = opening_point(opening, u);
            Vec3 away = vec3_sub(from, point.at), to = vec3_normalize(away);
            double share = (double)opening_share(opening, &point, from);
            mean_add(&mean, share * intensity(to) * fmax((double)vec3_dot(to, d), 0) /
                                (double)vec3_dot(away, away));
        }
        assert_close(mean.sum / (double)mean.count, wanted.sum / (double)wanted.count, 1e-2);
    }
}

/* A point of the unit body's surface on a grid, with its vector area there. */
static bool grid_point(OpeningShape shape, int part, const double g[2], double size, Vec3 *at,
                       Vec3 *area) {
    double a = 2 * g[0] - 1, b = 2 * g[1] - 1, phi = 2 * PI * g[1], sign = part & 1 ? -1 : 1;
    Vec3 n = vec3(0, 0, 0);
    if (shape == OPENING_BOX && part >= 6) return false;
    if (shape == OPENING_BOX) {
        float p[3], m[3] = {0};
        p[part / 2] = m[part / 2] = (float)sign;
        p[(part / 2 + 1) % 3] = (float)a;
        p[(part / 2 + 2) % 3] = (float)b;
        *at = vec3(p[0], p[1], p[2]);
        *area = vec3_scale(vec3(m[0], m[1], m[2]), (float)(4 * size));
        return true;
    }
    if (shape == OPENING_CYLINDER && part < 2) {
        double r = sqrt(g[0]);
        *at = vec3((float)(r * cos(phi)), (float)(r * sin(phi)), (float)sign);
        *area = vec3(0, 0, (float)(sign * PI * size));
        return true;
    }
    if (shape == OPENING_CYLINDER) {
        n = vec3((float)cos(phi), (float)sin(phi), 0);
        *at = vec3(n.x, n.y, (float)a);
    } else {
        double r = sqrt(1 - a * a);
        *at = n = vec3((float)(r * cos(phi)), (float)(r * sin(phi)), (float)a);
    }
    *area = vec3_scale(n, (float)(4 * PI * size));
    return part == (shape == OPENING_CYLINDER ? 2 : 0);
}

/* Integral of I(d) / A(d) n.d over what faces `from`, on a grid of the whole surface. */
static double integrated(const LuminousOpening *opening, Vec3 from, Vec3 facing) {
    enum { GRID = 400 };
    double sum = 0;
    Vec3 half = opening_half(opening), at, area;
    for (int part = 0; part < 7; part++)
        for (int i = 0; i < GRID * GRID; i++) {
            double g[2] = {(i / GRID + 0.5) / GRID, (i % GRID + 0.5) / GRID};
            if (!grid_point(opening->shape, part, g, 1.0 / (GRID * GRID), &at, &area)) break;
            Vec3 p = vec3(half.x * at.x, half.y * at.y, half.z * at.z);
            Vec3 away = vec3_sub(from, opening_turned_back(opening, p));
            Vec3 d = vec3_normalize(away), e;
            e = opening_stretched(half, opening_turned(opening, d));
            double seen = (double)vec3_dot(area, e);
            double cosine = fmax(-(double)vec3_dot(d, facing), 0);
            if (seen > 0)
                sum += seen / (double)opening_area(opening, d) * intensity(d) * cosine /
                       (double)vec3_dot(away, away);
        }
    return sum;
}

TEST(near_by_it_is_the_integral_over_the_surface) {
    uint32_t random = 8;
    for (int i = 0; i < OPENING_COUNT; i++)
        for (int k = 0; k < 3; k++) {
            const float *h = OPENINGS[i].half;
            Vec3 d = direction_of(&random), facing = vec3_neg(d);
            float most = fmaxf(h[0], fmaxf(h[1], h[2]));
            Vec3 from = vec3_scale(d, most * (1.4f + (float)k));
            assert_mean("near field", sampled(&OPENINGS[i], from, facing),
                        integrated(&OPENINGS[i], from, facing));
        }
}

/* L = I / pi r^2 all over: pi L (r/d)^2 on a plane that faces its middle, however near. */
TEST(an_even_sphere_is_the_inverse_square_down_to_its_surface) {
    const LuminousOpening ball = {OPENING_ELLIPSOID, 2, false, {0.3f, 0.3f, 0.3f}};
    for (int i = 0; i < 3; i++) {
        float distance = 0.33f + 0.4f * (float)i;
        Mean mean = {0};
        uint32_t random = 5;
        for (int k = 0; k < SAMPLES; k++) {
            float u[3], weight;
            random3(&random, u);
            Vec3 from = vec3(0, 0, distance);
            Vec3 away = vec3_sub(from, opening_sample(&ball, from, u, &weight));
            double d2 = (double)vec3_dot(away, away), cosine = (double)away.z / sqrt(d2);
            mean_add(&mean, (double)weight * fmax(cosine, 0) / d2);
        }
        assert_mean("sphere", mean, 1 / (double)(distance * distance));
    }
}

/* Distance from the surface of the unit body: 0 on it. */
static float off_surface(OpeningShape shape, Vec3 p) {
    float across = sqrtf(p.x * p.x + p.y * p.y), z = fabsf(p.z);
    if (shape == OPENING_BOX) return fmaxf(fmaxf(fabsf(p.x), fabsf(p.y)), z) - 1;
    if (shape == OPENING_CYLINDER) return fmaxf(across, z) - 1;
    return vec3_length(p) - 1;
}

TEST(points_lie_on_the_surface_and_flat_ones_everywhere_on_it) {
    uint32_t random = 21;
    for (int i = 0; i < OPENING_COUNT; i++)
        for (int k = 0; k < 2000; k++) {
            const LuminousOpening *o = &OPENINGS[i];
            float u[3], weight;
            random3(&random, u);
            Vec3 from = vec3_scale(direction_of(&random), 1.2f), half = opening_half(o);
            Vec3 at = opening_turned(o, opening_sample(o, from, u, &weight));
            assert_true(weight >= 0 && isfinite(weight));
            if (o->is_flat) {
                assert_true(at.z == 0 && weight == 1);
                float outside = off_surface(o->shape, vec3(at.x / half.x, at.y / half.y, 0));
                assert_true(outside <= 1e-6f);
            } else {
                Vec3 unit = vec3(at.x / half.x, at.y / half.y, at.z / half.z);
                assert_true(fabsf(off_surface(o->shape, unit)) < 1e-5f);
            }
        }
}

/* From inside nothing of a body is seen; from its middle, and in the plane of a flat one, all
 * stays finite. */
TEST(inside_it_is_dark_and_nothing_is_infinite) {
    const float u[2] = {0.3f, 0.8f};
    for (int i = 0; i < OPENING_COUNT; i++) {
        const float *h = OPENINGS[i].half;
        float weight;
        Vec3 inside = vec3(0.3f * h[0], -0.2f * h[1], 0.4f * h[2]);
        Vec3 at = opening_sample(&OPENINGS[i], inside, u, &weight);
        assert_true(vec3_is_within(at, FLT_MAX) && weight == (OPENINGS[i].is_flat ? 1 : 0));
        at = opening_sample(&OPENINGS[i], vec3(0, 0, 0), u, &weight);
        assert_true(vec3_is_within(at, FLT_MAX) && isfinite(weight));
    }
}

TEST_PROGRAM(NULL, NULL)
