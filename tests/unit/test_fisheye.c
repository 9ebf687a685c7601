/* SPDX-License-Identifier: Apache-2.0 */
#include "check.h"

#include "camera/camera.h"

#define PI 3.14159265358979323846
#define SIZE 64

static Camera fisheye_of(Fisheye kind) {
    SceneCamera camera = {.is_perspective = true,
                          .yfov = 0.3f,
                          .fisheye = kind,
                          .world_from_camera = transform_identity()};
    return camera_from_scene(&camera, SIZE, SIZE);
}

/* By the definitions: the radius over the circle's is a/90 degrees, or sqrt(2) sin(a/2). */
static double angle_of(Fisheye kind, double radius) {
    return kind == FISHEYE_EQUISOLID ? 2 * asin(radius / sqrt(2)) : radius * PI / 2;
}

/* The place of a direction of any length but 0; what lies behind is put on the rim. */
static Vec2 place_of(Fisheye kind, Vec3 d) {
    float beside = sqrtf(d.x * d.x + d.y * d.y), length = vec3_length(d);
    float sine = beside / length, radius = 1;
    if (!(beside > 0)) return (Vec2){d.z < 0 ? 0.0f : 1.0f, 0};
    if (d.z < 0)
        radius = kind == FISHEYE_EQUISOLID ? sine / sqrtf(1 - d.z / length)
                                           : atan2_f(beside, -d.z) * 0.636619772f;
    return (Vec2){radius * d.x / beside, radius * d.y / beside};
}

TEST(directions_are_those_of_the_projection) {
    for (Fisheye kind = FISHEYE_EQUIDISTANT; kind <= FISHEYE_EQUISOLID; kind++) {
        Camera camera = fisheye_of(kind);
        for (int i = 0; i < 400; i++) {
            double radius = sqrt((i + 0.5) / 400), turn = 2.399963 * i;
            double right = radius * cos(turn), up = radius * sin(turn);
            double a = angle_of(kind, radius);
            Ray ray =
                camera_ray(&camera, (float)((1 + right) * SIZE / 2), (float)((1 - up) * SIZE / 2));
            assert_near(ray.direction.x, sin(a) * cos(turn), 2e-6);
            assert_near(ray.direction.y, sin(a) * sin(turn), 2e-6);
            assert_near(ray.direction.z, -cos(a), 2e-6);
            assert_close(vec3_length(ray.direction), 1, 1e-6);
            Vec2 back = place_of(kind, vec3_scale(ray.direction, 3));
            assert_near(back.x, right, 3e-6);
            assert_near(back.y, up, 3e-6);
        }
    }
}

TEST(the_upper_half_is_up_and_the_left_is_left) {
    Camera camera = fisheye_of(FISHEYE_EQUIDISTANT);
    assert_true(camera_ray(&camera, SIZE / 2, 1).direction.y > 0.9f);
    assert_true(camera_ray(&camera, 1, SIZE / 2).direction.x < -0.9f);
}

TEST(a_turned_camera_turns_its_fisheye) {
    SceneCamera turned = camera_look_at(vec3(1, 2, 3), vec3(5, 2, 3), 1);
    turned.fisheye = FISHEYE_EQUISOLID;
    Camera camera = camera_from_scene(&turned, SIZE, SIZE);
    Ray middle = camera_ray(&camera, SIZE / 2, SIZE / 2);
    assert_near(middle.direction.x, 1, 1e-6);
    assert_close(middle.origin.z, 3, 1e-6);
    assert_near(camera_ray(&camera, SIZE, SIZE / 2).direction.z, 1, 1e-3);
}

/* Sides of 1.4 radii lie within the circle, their corners without. */
TEST(pixels_out_of_the_circle_are_not_seen) {
    Camera camera = fisheye_of(FISHEYE_EQUIDISTANT);
    int seen = 0;
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++) {
            double nearest = 2;
            for (int k = 0; k < 121; k++)
                nearest = fmin(nearest, hypot((x + k % 11 / 10.0) * 2 / SIZE - 1,
                                              (y + k / 11 / 10.0) * 2 / SIZE - 1));
            bool is_seen = camera_sees_pixel(&camera, x, y);
            if (fabs(nearest - 1) > 0.002) assert_int_equal(is_seen, nearest < 1);
            seen += is_seen;
        }
    assert_true(seen > PI / 4 * SIZE * SIZE && seen < PI / 4 * SIZE * SIZE + 4 * SIZE);
    assert_false(camera_sees_pixel(&camera, 0, 0));
    assert_false(camera_sees(&camera, 1, 1));
    assert_true(camera_sees(&camera, SIZE / 2, 1));
}

/* A pixel that the circle cuts: samples stay within, and are even there. */
TEST(samples_of_a_cut_pixel_are_even_over_what_is_seen) {
    Camera camera = fisheye_of(FISHEYE_EQUISOLID);
    int x = 9, y = 9, count = 20000, upper = 0;
    double wanted_upper = 0, wanted = 0;
    for (int k = 0; k < 1000000; k++) { /* the shares by a grid of its own */
        double px = x + (k % 1000 + 0.5) / 1000, py = y + (k / 1000 + 0.5) / 1000;
        if (hypot(px * 2 / SIZE - 1, py * 2 / SIZE - 1) > 1) continue;
        wanted++;
        if (px > py) wanted_upper++;
    }
    assert_true(wanted > 1e5 && wanted < 9e5);
    for (int i = 0; i < count; i++) {
        Sampler sampler = sampler_start(7, x, y, (uint32_t)i);
        Vec2 at = sampler_2d(&sampler);
        Ray ray = camera_pixel_ray(&camera, x, y, at, &sampler);
        assert_true(ray.direction.z < 1e-6f);
        Vec2 place = place_of(FISHEYE_EQUISOLID, ray.direction);
        if (place.x > -place.y) upper++;
    }
    assert_near(upper / (double)count, wanted_upper / wanted, 4 * 0.5 / sqrt(count));
}

TEST(a_whole_pixel_has_the_samples_of_any_camera) {
    Camera camera = fisheye_of(FISHEYE_EQUIDISTANT);
    for (int i = 0; i < 50; i++) {
        Sampler sampler = sampler_start(1, 30, 20, (uint32_t)i);
        Vec2 at = sampler_2d(&sampler);
        Ray a = camera_pixel_ray(&camera, 30, 20, at, &sampler);
        Ray b = camera_ray(&camera, 30 + at.x, 20 + at.y);
        assert_memory_equal(&a, &b, sizeof a);
    }
}

TEST_PROGRAM(NULL, NULL)
