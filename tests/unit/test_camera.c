/* SPDX-License-Identifier: Apache-2.0 */
#include "check.h"

#include "camera/camera.h"

static SceneCamera perspective(float yfov) {
    return (SceneCamera){
        .is_perspective = true, .yfov = yfov, .world_from_camera = transform_identity()};
}

TEST(the_middle_of_the_film_looks_along_minus_z) {
    SceneCamera scene_camera = perspective(0.8f);
    Camera camera = camera_from_scene(&scene_camera, 640, 360);
    Ray ray = camera_ray(&camera, 320, 180);
    assert_near(ray.direction.x, 0, 1e-6);
    assert_near(ray.direction.y, 0, 1e-6);
    assert_close(ray.direction.z, -1, 1e-6);
}

TEST(the_upper_edge_is_half_the_field_of_view_up) {
    for (int degrees = 5; degrees <= 150; degrees += 5) {
        SceneCamera scene_camera = perspective((float)(degrees * 3.14159265358979 / 180));
        Camera camera = camera_from_scene(&scene_camera, 100, 50);
        Ray top = camera_ray(&camera, 50, 0);
        assert_near(atan2((double)top.direction.y, -(double)top.direction.z),
                    degrees * 3.14159265358979 / 360, 2e-6);
    }
}

TEST(the_width_follows_the_frame_and_left_is_left) {
    SceneCamera scene_camera = perspective(0.8f);
    Camera camera = camera_from_scene(&scene_camera, 1000, 500);
    Ray left = camera_ray(&camera, 0, 250);
    assert_true(left.direction.x < 0);
    assert_close(-left.direction.x / -left.direction.z, 2 * tan(0.4), 1e-5);
    assert_close(vec3_length(left.direction), 1, 1e-6);
}

TEST(an_orthographic_ray_starts_on_the_film) {
    SceneCamera scene_camera = {.ymag = 1.5f, .world_from_camera = transform_identity()};
    scene_camera.world_from_camera.origin = vec3(1, 2, 3);
    Camera camera = camera_from_scene(&scene_camera, 200, 100);
    Ray ray = camera_ray(&camera, 0, 0);
    assert_close(ray.origin.x, 1 - 3.0, 1e-6);
    assert_close(ray.origin.y, 2 + 1.5, 1e-6);
    assert_close(ray.origin.z, 3, 1e-6);
    assert_close(ray.direction.z, -1, 1e-6);
}

TEST(an_eye_looks_at_its_point_with_y_up) {
    static const Vec3 EYES[] = {{3, 4, 5}, {-2, 0, 1}, {0, 9, 0}, {0, -9, 0}};
    const Vec3 target = vec3(0, 0, 0);
    for (int i = 0; i < 4; i++) {
        const SceneCamera seen = camera_look_at(EYES[i], target, 0.6f);
        const Camera camera = camera_from_scene(&seen, 40, 20);
        const Ray ray = camera_ray(&camera, 20, 10);
        Vec3 miss = vec3_along(ray.origin, ray.direction, vec3_length(EYES[i]));
        const Transform *t = &seen.world_from_camera;
        assert_true(vec3_length(miss) < 1e-5f);
        assert_close(transform_determinant(t), 1, 1e-5);
        if (i < 2) assert_true(t->x.y == 0 && t->y.y > 0); /* the horizon is level */
        else assert_near(t->y.z, -1, 1e-6);                /* -Z is up */
    }
}

/* Rectangles about a centre that face along a normal: displays, of one material. */
static void add_sheet(Scene *scene, Vec3 centre, Vec3 normal, float half) {
    Vec3 side = vec3_normalize(vec3_cross(vec3(0.3f, 1, 0.2f), normal));
    Vec3 up = vec3_cross(normal, side);
    uint32_t first = scene->vertex_count;
    for (int c = 0; c < 4; c++) {
        float a = c == 1 || c == 2 ? half : -half, b = c > 1 ? half : -half;
        Vec3 p = vec3_along(vec3_along(centre, side, a), up, b);
        scene->positions[scene->vertex_count++] = p;
    }
    scene->parts[scene->part_count++] =
        (Part){.first_triangle = scene->triangle_count, .triangle_count = 2};
    for (uint32_t t = 1; t < 3; t++)
        scene->triangles[scene->triangle_count++] =
            (Triangle){.vertex = {first, first + t, first + t + 1}};
}

static bool is_in_view(const SceneCamera *seen, Vec3 p) {
    const Transform *t = &seen->world_from_camera;
    Vec3 d = vec3_sub(p, t->origin);
    float depth = -vec3_dot(d, t->z), half = depth * tanf(0.5f * seen->yfov);
    return depth > 0 && fabsf(vec3_dot(d, t->x)) < half && fabsf(vec3_dot(d, t->y)) < half;
}

TEST(displays_without_a_camera_are_seen_whole_and_from_the_front) {
    static const Vec3 NORMALS[] = {{0, 0, 1}, {0.6f, 0, -0.8f}, {0, 1, 0}, {-0.48f, 0.6f, 0.64f}};
    for (int i = 0; i < 4; i++) {
        Vec3 positions[12];
        Triangle triangles[6];
        Part parts[3];
        Material materials[1] = {{.display_id = 0}};
        Scene scene = {.positions = positions,
                       .triangles = triangles,
                       .parts = parts,
                       .materials = materials,
                       .material_count = 1};
        add_sheet(&scene, vec3(1, 2, 3), NORMALS[i], 0.2f);
        add_sheet(&scene, vec3(1.5f, 2, 3.1f), NORMALS[i], 0.1f);
        const SceneCamera seen = camera_frame_scene(&scene);
        assert_string_equal(seen.camera_name, "displays");
        assert_true(vec3_dot(seen.world_from_camera.z, NORMALS[i]) > 0.999f);
        for (uint32_t v = 0; v < scene.vertex_count; v++)
            assert_true(is_in_view(&seen, positions[v]));
        add_sheet(&scene, vec3(0, 2, 3), vec3_neg(NORMALS[i]), 0.15f); /* faces away */
        const SceneCamera largest = camera_frame_scene(&scene);
        assert_true(vec3_dot(largest.world_from_camera.z, NORMALS[i]) > 0.999f);
        materials[0].display_id = NO_ID;
        scene.bounds_max = vec3(2, 3, 4);
        assert_string_equal(camera_frame_scene(&scene).camera_name, "whole scene");
    }
}

TEST_PROGRAM(NULL, NULL)
