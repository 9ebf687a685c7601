/* SPDX-License-Identifier: Apache-2.0 */
/* Boxes around parts of a scene on the film, against the camera's own rays. */
#include "check.h"

#include "camera/camera.h"

#define PIXELS 1e-3 /* that floats may be off by */

/* A part of two triangles, with its front where they run counter-clockwise. */
typedef struct BoxScene {
    Vec3     corners[4];
    Triangle triangles[2];
    Part     part;
    Scene    scene;
} BoxScene;

static const Scene *scene_of(BoxScene *all, const Vec3 corners[4])
{
    for (int i = 0; i < 4; i++) all->corners[i] = corners[i];
    all->triangles[0] = (Triangle){{0, 1, 2}, 0};
    all->triangles[1] = (Triangle){{0, 2, 3}, 0};
    all->part = (Part){.triangle_count = 2};
    all->scene = (Scene){.positions = all->corners, .vertex_count = 4,
                         .triangles = all->triangles, .triangle_count = 2,
                         .parts = &all->part, .part_count = 1};
    return &all->scene;
}

static Camera camera_of(bool is_perspective)
{
    SceneCamera camera = camera_look_at(vec3(1, 2, 3), vec3(0, 0.5f, -1), 0.9f);
    camera.is_perspective = is_perspective;
    camera.ymag = 1.5f;
    return camera_from_scene(&camera, 320, 200);
}

/* What a place on the film sees `distance` away. */
static Vec3 seen_at(const Camera *camera, float x, float y, float distance)
{
    Ray ray = camera_ray(camera, x, y);
    return vec3_along(ray.origin, ray.direction, distance);
}

static void quad_at(const Camera *camera, FilmBox box, Vec3 out[4])
{
    out[0] = seen_at(camera, box.x0, box.y1, 2.0f);
    out[1] = seen_at(camera, box.x1, box.y1, 2.5f);
    out[2] = seen_at(camera, box.x1, box.y0, 3.0f);
    out[3] = seen_at(camera, box.x0, box.y0, 1.0f);
}

static void assert_box(FilmBox box, FilmBox wanted)
{
    assert_near(box.x0, wanted.x0, PIXELS);
    assert_near(box.y0, wanted.y0, PIXELS);
    assert_near(box.x1, wanted.x1, PIXELS);
    assert_near(box.y1, wanted.y1, PIXELS);
}

TEST(a_box_ends_where_the_camera_sees_the_corners)
{
    static const FilmBox wanted = {40, 25, 250, 180};
    for (int is_perspective = 0; is_perspective < 2; is_perspective++) {
        Camera   camera = camera_of(is_perspective);
        BoxScene all;
        Vec3     corners[4];
        FilmBox  box;
        quad_at(&camera, wanted, corners);
        assert_true(camera_box_of_part(&camera, scene_of(&all, corners), 0, &box));
        assert_box(box, wanted);
    }
}

TEST(a_back_has_no_box)
{
    for (int is_perspective = 0; is_perspective < 2; is_perspective++) {
        Camera   camera = camera_of(is_perspective);
        BoxScene all;
        Vec3     corners[4];
        FilmBox  box;
        quad_at(&camera, (FilmBox){40, 25, 250, 180}, corners);
        Vec3 turned[4] = {corners[3], corners[2], corners[1], corners[0]};
        assert_false(camera_box_of_part(&camera, scene_of(&all, turned), 0, &box));
    }
}

TEST(a_box_ends_with_the_frame)
{
    Camera   camera = camera_of(true);
    BoxScene all;
    Vec3     corners[4];
    FilmBox  box;
    quad_at(&camera, (FilmBox){-90, 100, 100, 500}, corners);
    assert_true(camera_box_of_part(&camera, scene_of(&all, corners), 0, &box));
    assert_box(box, (FilmBox){0, 100, 100, 200});
    quad_at(&camera, (FilmBox){330, 20, 400, 90}, corners);
    assert_false(camera_box_of_part(&camera, scene_of(&all, corners), 0, &box));
}

/* A floor from before the eye to behind it, seen from above: a box without what is behind would
 * end at its far edge, and one with it would be turned over. */
TEST(what_reaches_behind_the_eye_reaches_the_edge_of_the_frame)
{
    SceneCamera view = camera_look_at(vec3(0, 1, 0), vec3(0, 1, -1), 0.9f);
    Camera      camera = camera_from_scene(&view, 320, 200);
    BoxScene    all;
    FilmBox     box;
    const Vec3  floor[4] = {{-1, 0, 5}, {1, 0, 5}, {1, 0, -4}, {-1, 0, -4}};
    const Vec3  behind[4] = {{-1, 0, 5}, {1, 0, 5}, {1, 0, 2}, {-1, 0, 2}};
    assert_true(camera_box_of_part(&camera, scene_of(&all, floor), 0, &box));
    double horizon = 100 + 100 / tan(0.45) / 4; /* 1 m below the eye, 4 m away */
    assert_near(box.y0, horizon, 10 * PIXELS);
    assert_near(box.y1, 200, PIXELS);
    assert_near(box.x0, 0, PIXELS);
    assert_near(box.x1, 320, PIXELS);
    assert_false(camera_box_of_part(&camera, scene_of(&all, behind), 0, &box));
}

TEST_PROGRAM(NULL, NULL)
