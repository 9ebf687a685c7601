#include "check.h"

#include "camera/camera.h"

static SceneCamera perspective(float yfov)
{
    return (SceneCamera){.is_perspective = true, .yfov = yfov,
                         .world_from_camera = transform_identity()};
}

TEST(the_middle_of_the_film_looks_along_minus_z)
{
    (void)state;
    SceneCamera scene_camera = perspective(0.8f);
    Camera camera = camera_from_scene(&scene_camera, 640, 360);
    Ray    ray = camera_ray(&camera, 320, 180);
    assert_near(ray.direction.x, 0, 1e-6);
    assert_near(ray.direction.y, 0, 1e-6);
    assert_close(ray.direction.z, -1, 1e-6);
}

TEST(the_upper_edge_is_half_the_field_of_view_up)
{
    (void)state;
    for (int degrees = 5; degrees <= 150; degrees += 5) {
        SceneCamera scene_camera = perspective((float)(degrees * 3.14159265358979 / 180));
        Camera camera = camera_from_scene(&scene_camera, 100, 50);
        Ray    top = camera_ray(&camera, 50, 0);
        assert_near(atan2((double)top.direction.y, -(double)top.direction.z),
                    degrees * 3.14159265358979 / 360, 2e-6);
    }
}

TEST(the_width_follows_the_frame_and_left_is_left)
{
    (void)state;
    SceneCamera scene_camera = perspective(0.8f);
    Camera camera = camera_from_scene(&scene_camera, 1000, 500);
    Ray    left = camera_ray(&camera, 0, 250);
    assert_true(left.direction.x < 0);
    assert_close(-left.direction.x / -left.direction.z, 2 * tan(0.4), 1e-5);
    assert_close(vec3_length(left.direction), 1, 1e-6);
}

TEST(an_orthographic_ray_starts_on_the_film)
{
    (void)state;
    SceneCamera scene_camera = {.ymag = 1.5f, .world_from_camera = transform_identity()};
    scene_camera.world_from_camera.origin = vec3(1, 2, 3);
    Camera camera = camera_from_scene(&scene_camera, 200, 100);
    Ray    ray = camera_ray(&camera, 0, 0);
    assert_close(ray.origin.x, 1 - 3.0, 1e-6);
    assert_close(ray.origin.y, 2 + 1.5, 1e-6);
    assert_close(ray.origin.z, 3, 1e-6);
    assert_close(ray.direction.z, -1, 1e-6);
}

int main(void)
{
    return run_cases(NULL, NULL);
}
