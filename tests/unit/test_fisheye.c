/* SPDX-License-Identifier: Apache-2.0 */
#include "check.h"

#include "camera/camera.h"

#define PI 3.14159265358979323846
#define SIZE 64

static Camera fisheye_of(Fisheye kind)
{
    SceneCamera camera = {.is_perspective = true, .yfov = 0.3f, .fisheye = kind,
                          .world_from_camera = transform_identity()};
    return camera_from_scene(&camera, SIZE, SIZE);
}

/* By the definitions: the radius over the circle's is a/90 degrees, or sqrt(2) sin(a/2). */
static double angle_of(Fisheye kind, double radius)
{
    return kind == FISHEYE_EQUISOLID ? 2 * asin(radius / sqrt(2)) : radius * PI / 2;
}

TEST(directions_are_those_of_the_projection)
{
    for (Fisheye kind = FISHEYE_EQUIDISTANT; kind <= FISHEYE_EQUISOLID; kind++) {
        Camera camera = fisheye_of(kind);
        for (int i = 0; i < 400; i++) {
            double radius = sqrt((i + 0.5) / 400), turn = 2.399963 * i;
            double right = radius * cos(turn), up = radius * sin(turn);
            double a = angle_of(kind, radius);
            Ray ray = camera_ray(&camera, (float)((1 + right) * SIZE / 2),
                                 (float)((1 - up) * SIZE / 2));
            assert_near(ray.direction.x, sin(a) * cos(turn), 2e-6);
            assert_near(ray.direction.y, sin(a) * sin(turn), 2e-6);
            assert_near(ray.direction.z, -cos(a), 2e-6);
            assert_close(vec3_length(ray.direction), 1, 1e-6);
            Vec2 back = fisheye_place(kind, vec3_scale(ray.direction, 3));
            assert_near(back.x, right, 3e-6);
            assert_near(back.y, up, 3e-6);
        }
    }
}

TEST(the_upper_half_is_up_and_the_left_is_left)
{
    Camera camera = fisheye_of(FISHEYE_EQUIDISTANT);
    assert_true(camera_ray(&camera, SIZE / 2, 1).direction.y > 0.9f);
    assert_true(camera_ray(&camera, 1, SIZE / 2).direction.x < -0.9f);
}

TEST(a_turned_camera_turns_its_fisheye)
{
    SceneCamera turned = camera_look_at(vec3(1, 2, 3), vec3(5, 2, 3), 1);
    turned.fisheye = FISHEYE_EQUISOLID;
    Camera camera = camera_from_scene(&turned, SIZE, SIZE);
    Ray    middle = camera_ray(&camera, SIZE / 2, SIZE / 2);
    assert_near(middle.direction.x, 1, 1e-6);
    assert_close(middle.origin.z, 3, 1e-6);
    assert_near(camera_ray(&camera, SIZE, SIZE / 2).direction.z, 1, 1e-3);
}

/* Sides of 1.4 radii lie within the circle, their corners without. */
TEST(pixels_out_of_the_circle_are_not_seen)
{
    Camera camera = fisheye_of(FISHEYE_EQUIDISTANT);
    int    seen = 0;
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
TEST(samples_of_a_cut_pixel_are_even_over_what_is_seen)
{
    Camera camera = fisheye_of(FISHEYE_EQUISOLID);
    int    x = 9, y = 9, count = 20000, upper = 0;
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
        Vec2    at = sampler_2d(&sampler);
        Ray     ray = camera_pixel_ray(&camera, x, y, at, &sampler);
        assert_true(ray.direction.z < 1e-6f);
        Vec2 place = fisheye_place(FISHEYE_EQUISOLID, ray.direction);
        if (place.x > -place.y) upper++;
    }
    assert_near(upper / (double)count, wanted_upper / wanted, 4 * 0.5 / sqrt(count));
}

TEST(a_whole_pixel_has_the_samples_of_any_camera)
{
    Camera camera = fisheye_of(FISHEYE_EQUIDISTANT);
    for (int i = 0; i < 50; i++) {
        Sampler sampler = sampler_start(1, 30, 20, (uint32_t)i);
        Vec2    at = sampler_2d(&sampler);
        Ray     a = camera_pixel_ray(&camera, 30, 20, at, &sampler);
        Ray     b = camera_ray(&camera, 30 + at.x, 20 + at.y);
        assert_memory_equal(&a, &b, sizeof a);
    }
}

/* The middle pixel's own width and height as angles. */
TEST(the_cone_is_the_middle_pixels)
{
    for (Fisheye kind = FISHEYE_EQUIDISTANT; kind <= FISHEYE_EQUISOLID; kind++) {
        Camera camera = fisheye_of(kind);
        Vec3 a = camera_ray(&camera, SIZE / 2 - 0.5f, SIZE / 2).direction;
        Vec3 b = camera_ray(&camera, SIZE / 2 + 0.5f, SIZE / 2).direction;
        assert_close(camera_cone(&camera).spread, vec3_length(vec3_sub(a, b)), 1e-3);
        assert_near(camera_cone(&camera).width, 0, 0);
    }
}

/* ---- boxes of parts --------------------------------------------------------------------- */

static bool box_of(const Camera *camera, const Vec3 corner[3], FilmBox *out)
{
    Vec3     positions[3] = {corner[0], corner[1], corner[2]};
    Triangle triangle = {{0, 1, 2}, 0};
    Part     part = {.triangle_count = 1};
    Scene    scene = {.positions = positions, .vertex_count = 3, .triangles = &triangle,
                      .triangle_count = 1, .parts = &part, .part_count = 1};
    return camera_box_of_part(camera, &scene, 0, out);
}

/* All of the triangle's places, projected, lie within, and some reach each side. */
static void assert_tight(const Camera *camera, const Vec3 corner[3])
{
    FilmBox box, found = {SIZE, SIZE, 0, 0};
    assert_true(box_of(camera, corner, &box));
    for (int i = 0; i <= 300; i++)
        for (int k = 0; k <= 300 - i; k++) {
            Vec3 along = vec3_along(corner[0], vec3_sub(corner[1], corner[0]), i / 300.0f);
            Vec3 at = vec3_along(along, vec3_sub(corner[2], corner[0]), k / 300.0f);
            if (at.z >= 0) continue;
            Vec2  place = fisheye_place(camera->fisheye, at);
            float x = (1 + place.x) * SIZE / 2, y = (1 - place.y) * SIZE / 2;
            found = (FilmBox){fminf(found.x0, x), fminf(found.y0, y), fmaxf(found.x1, x),
                              fmaxf(found.y1, y)};
        }
    assert_near(box.x0, found.x0, 0.2);
    assert_near(box.y0, found.y0, 0.2);
    assert_near(box.x1, found.x1, 0.2);
    assert_near(box.y1, found.y1, 0.2);
}

TEST(a_box_is_about_the_bent_edges)
{
    const Vec3 wide[3] = {vec3(-3, -2, -1), vec3(3, -2, -1), vec3(0.5f, 4, -1)};
    const Vec3 side[3] = {vec3(1, -1, -0.5f), vec3(2, -0.5f, -3), vec3(1.5f, 2, -1)};
    for (Fisheye kind = FISHEYE_EQUIDISTANT; kind <= FISHEYE_EQUISOLID; kind++) {
        Camera camera = fisheye_of(kind);
        assert_tight(&camera, wide);
        const Vec3 turned[3] = {side[0], side[2], side[1]};
        FilmBox    box;
        assert_tight(&camera, box_of(&camera, side, &box) ? side : turned);
    }
}

TEST(what_lies_behind_has_no_box)
{
    Camera     camera = fisheye_of(FISHEYE_EQUIDISTANT);
    const Vec3 behind[3] = {vec3(-1, -1, 2), vec3(0, 1, 2), vec3(1, -1, 2)};
    FilmBox    box;
    assert_false(box_of(&camera, behind, &box));
}

TEST_PROGRAM(NULL, NULL)
