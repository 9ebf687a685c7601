/* SPDX-License-Identifier: Apache-2.0 */
/* Laws of the frame in which a surface's own lobe stands still. */
#include "check.h"

#include <float.h>

#include "base/mathd.h"
#include "base/units.h"
#include "hemisphere/surface_frame.h"

static const SurfaceAxes AXES[] = {{5, 0, 5}, {20, 3, 6}, {300, -40, 9}};

static Vec3 direction(double theta_deg, double phi_deg) {
    double t = radians_from_degrees(theta_deg), p = radians_from_degrees(phi_deg);
    return vec3((float)(sin_d(t) * cos_d(p)), (float)(sin_d(t) * sin_d(p)), (float)cos_d(t));
}

static double distance(Vec3 a, Vec3 b) {
    return (double)vec3_length(vec3_sub(a, b));
}

/* The frames of all axes, for slopes and for cosines; `work` for light from all sides. */
static void for_all(void (*work)(const SurfaceFrame *frame, Vec3 wi)) {
    for (size_t k = 0; k < sizeof AXES / sizeof *AXES; k++)
        for (int cosine = 0; cosine < 2; cosine++)
            for (double theta = 0; theta < 89; theta += 17.3) {
                SurfaceFrame frame = surface_frame(cosine, AXES[k], 20000);
                work(&frame, direction(theta, 4.1 * theta));
            }
}

static void check_round_trip(const SurfaceFrame *frame, Vec3 wi) {
    for (double theta = 1; theta < 88; theta += 6)
        for (double phi = 0; phi < 360; phi += 25) {
            Vec3 wo = direction(theta, phi), stored = surface_frame_stored(frame, wi, wo);
            Vec3 back = surface_frame_leaving(frame, wi, stored);
            assert_near(vec3_length(stored), 1, 1e-5);
            assert_near(distance(back, wo), 0, 3e-4);
            assert_near(distance(surface_frame_stored(frame, wi, back), stored), 0, 3e-4);
        }
}

TEST(stored_directions_lead_back) {
    for_all(check_round_trip);
}

static void check_ends(const SurfaceFrame *frame, Vec3 wi) {
    Vec3 mirror = vec3(-wi.x, -wi.y, wi.z);
    assert_near(distance(surface_frame_stored(frame, wi, mirror), vec3(0, 0, 1)), 0, 2e-3);
    for (double phi = 0; phi < 360; phi += 11) {
        assert_near(surface_frame_stored(frame, wi, direction(89.9999, phi)).z, 0, 5e-3);
        assert_near(surface_frame_leaving(frame, wi, direction(90, phi)).z, 0, 5e-3);
    }
}

TEST(the_mirror_direction_is_the_pole_and_the_horizon_the_horizon) {
    for_all(check_ends);
}

/* Light from anywhere: the same facet is stored at the same place, as long as the horizon is
 * far away; so a lobe of facets neither turns nor moves. */
TEST(near_the_peak_a_facet_stays_where_it_is) {
    SurfaceFrame frame = surface_frame(false, (SurfaceAxes){20, 3, 6}, 3000);
    for (double azimuth = 0; azimuth < 360; azimuth += 45) {
        Vec3 facet = vec3_normalize(vec3(0.02f, 0.03f, 1));
        Vec3 first = vec3(0, 0, 0);
        for (double theta = 0; theta <= 50; theta += 10) {
            Vec3 wi = direction(theta, azimuth);
            Vec3 wo = vec3_along(vec3_neg(wi), facet, 2 * vec3_dot(wi, facet));
            Vec3 stored = surface_frame_stored(&frame, wi, wo);
            if (theta == 0) first = stored;
            assert_near(distance(stored, first), 0, 0.01);
            Vec3 other = surface_frame_same_facet(wi, wo, direction(30, azimuth));
            assert_near(
                distance(surface_frame_stored(&frame, direction(30, azimuth), other), first), 0,
                0.01);
        }
    }
}

static void check_finite(const SurfaceFrame *frame, Vec3 wi) {
    static const float heights[] = {1, 0.9999999f, 0.5f, 1e-3f, 1e-10f};
    for (int i = 0; i < 5; i++)
        for (double phi = 0; phi < 360; phi += 60) {
            float s = sqrtf(1 - heights[i] * heights[i]);
            Vec3 around = direction(90, phi), low = vec3(wi.x, wi.y, heights[i]);
            Vec3 wo = vec3(s * around.x, s * around.y, heights[i]);
            assert_true(vec3_is_within(surface_frame_stored(frame, wi, wo), FLT_MAX));
            assert_true(vec3_is_within(surface_frame_stored(frame, low, wo), FLT_MAX));
            assert_true(vec3_is_within(surface_frame_leaving(frame, low, wo), FLT_MAX));
        }
}

TEST(answers_are_finite_in_every_corner) {
    for_all(check_finite);
}

TEST_PROGRAM(NULL, NULL)
