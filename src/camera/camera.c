/* SPDX-License-Identifier: Apache-2.0 */
#include "camera/camera.h"

#include "base/mathf.h"
#include "base/units.h"

/* Through mathf.h: a frame's bits must not depend on the C library. */
static float half_angle_tangent(float angle) {
    float sine, cosine;
    sincos_turns(angle * (0.25f * INV_PI_F), &sine, &cosine);
    return sine / cosine;
}

static Camera fisheye_camera(const SceneCamera *camera, int width, int height) {
    float circle = (float)(width < height ? width : height);
    return (Camera){.world_from_camera = camera->world_from_camera,
                    .is_perspective = true,
                    .fisheye = camera->fisheye,
                    .half_width = (float)width / circle,
                    .half_height = (float)height / circle,
                    .width = width,
                    .height = height};
}

Camera camera_from_scene(const SceneCamera *camera, int width, int height) {
    if (camera->fisheye) return fisheye_camera(camera, width, height);
    float half_height = camera->is_perspective ? half_angle_tangent(camera->yfov) : camera->ymag;
    return (Camera){.world_from_camera = camera->world_from_camera,
                    .is_perspective = camera->is_perspective,
                    .half_width = half_height * (float)width / (float)height,
                    .half_height = half_height,
                    .width = width,
                    .height = height};
}

/* Right and up of the middle, in the units of half_width. */
static Vec2 film_place(const Camera *camera, float x, float y) {
    return (Vec2){(2 * x / (float)camera->width - 1) * camera->half_width,
                  (1 - 2 * y / (float)camera->height) * camera->half_height};
}

Ray camera_ray(const Camera *camera, float x, float y) {
    const Transform *world = &camera->world_from_camera;
    Vec2 place = film_place(camera, x, y);
    float right = place.x, up = place.y;
    if (camera->fisheye) {
        Vec3 seen = fisheye_direction(camera->fisheye, right, up);
        return (Ray){world->origin, transform_vector(world, seen), 0, INFINITY};
    }
    if (camera->is_perspective) {
        Vec3 direction = vec3_normalize(transform_vector(world, vec3(right, up, -1)));
        return (Ray){world->origin, direction, 0, INFINITY};
    }
    return (Ray){transform_point(world, vec3(right, up, 0)), vec3_neg(world->z), 0, INFINITY};
}

/* ---- what a fisheye sees ----------------------------------------------------------------- */

#define PLACES_MOST 256 /* pairs that are tried for a pixel that the circle cuts */
#define PLACES_SEED 0x72696d21u

bool camera_sees(const Camera *camera, float x, float y) {
    Vec2 place = film_place(camera, x, y);
    return !camera->fisheye || place.x * place.x + place.y * place.y <= 1;
}

/* By the pixel's place that is nearest to the middle. */
bool camera_sees_pixel(const Camera *camera, int x, int y) {
    float middle_x = 0.5f * (float)camera->width, middle_y = 0.5f * (float)camera->height;
    return camera_sees(camera, clampf(middle_x, (float)x, (float)(x + 1)),
                       clampf(middle_y, (float)y, (float)(y + 1)));
}

/* Even over the part of the pixel that is seen: the first of independent places that is. Where
 * none is, less than a hundredth of the pixel is seen, and its place nearest to the middle
 * stands for it. */
static Vec2 place_in_view(const Camera *camera, int x, int y, Vec2 at, const Sampler *sampler) {
    Sampler own = *sampler;
    Vec2 place = {(float)x + at.x, (float)y + at.y};
    own.pixel_hash = hash_combine(own.pixel_hash, PLACES_SEED);
    for (own.dimension = 0; own.dimension < PLACES_MOST;) {
        if (camera_sees(camera, place.x, place.y)) return place;
        at = sampler_2d(&own);
        place = (Vec2){(float)x + at.x, (float)y + at.y};
    }
    return (Vec2){clampf(0.5f * (float)camera->width, (float)x, (float)(x + 1)),
                  clampf(0.5f * (float)camera->height, (float)y, (float)(y + 1))};
}

Ray camera_pixel_ray(const Camera *camera, int x, int y, Vec2 at, const Sampler *sampler) {
    Vec2 place = {(float)x + at.x, (float)y + at.y};
    if (camera->fisheye) place = place_in_view(camera, x, y, at, sampler);
    return camera_ray(camera, place.x, place.y);
}

SceneCamera camera_look_at(Vec3 eye, Vec3 target, float yfov) {
    Vec3 z = vec3_normalize(vec3_sub(eye, target)); /* from the scene to the camera */
    Vec3 up = fabsf(z.y) < 0.9999f ? vec3(0, 1, 0) : vec3(0, 0, -1);
    Vec3 x = vec3_normalize(vec3_cross(up, z));
    return (SceneCamera){.node_name = "",
                         .camera_name = "eye",
                         .is_perspective = true,
                         .yfov = yfov,
                         .zfar = INFINITY,
                         .world_from_camera = {x, vec3_cross(z, x), z, eye}};
}

/* ---- scenes without a camera ------------------------------------------------------------ */

#define FRAMING_YFOV 0.7f
#define FRAMING_MARGIN 1.15f

/* Where the displays are and which way they face: areas as vectors along their normals. */
typedef struct DisplayView {
    Vec3 low, high;
    Vec3 facing, largest; /* m2: the sum, and that of the largest part */
    float area;           /* m2 */
} DisplayView;

static Vec3 add_triangle(const Scene *scene, uint32_t triangle, DisplayView *view) {
    Vec3 corner[3];
    for (int c = 0; c < 3; c++) {
        Vec3 p = corner[c] = scene_corner(scene, triangle, c);
        view->low = vec3(min_f(view->low.x, p.x), min_f(view->low.y, p.y), min_f(view->low.z, p.z));
        view->high =
            vec3(max_f(view->high.x, p.x), max_f(view->high.y, p.y), max_f(view->high.z, p.z));
    }
    Vec3 facing = vec3_scale(
        vec3_cross(vec3_sub(corner[1], corner[0]), vec3_sub(corner[2], corner[0])), 0.5f);
    view->area += vec3_length(facing);
    return facing;
}

static DisplayView find_displays(const Scene *scene) {
    DisplayView view = {.low = vec3(INFINITY, INFINITY, INFINITY),
                        .high = vec3(-INFINITY, -INFINITY, -INFINITY)};
    for (int i = 0; i < scene->part_count; i++) {
        const Part *part = &scene->parts[i];
        Vec3 sum = vec3(0, 0, 0);
        if (scene->materials[part->material_id].display_id == NO_ID) continue;
        for (uint32_t t = 0; t < part->triangle_count; t++)
            sum = vec3_add(sum, add_triangle(scene, part->first_triangle + t, &view));
        view.facing = vec3_add(view.facing, sum);
        if (vec3_length(sum) > vec3_length(view.largest)) view.largest = sum;
    }
    return view;
}

static SceneCamera frame_bounds(Vec3 low, Vec3 high, Vec3 towards_eye, const char *name) {
    Vec3 centre = vec3_scale(vec3_add(low, high), 0.5f);
    float radius = max_f(0.5f * vec3_length(vec3_sub(high, low)), 1e-6f);
    float distance = radius / half_angle_tangent(FRAMING_YFOV) * FRAMING_MARGIN;
    SceneCamera camera =
        camera_look_at(vec3_along(centre, towards_eye, distance), centre, FRAMING_YFOV);
    camera.camera_name = name;
    return camera;
}

SceneCamera camera_frame_scene(const Scene *scene) {
    const DisplayView view = find_displays(scene);
    if (!scene->triangle_count)
        return (SceneCamera){.node_name = "",
                             .camera_name = "origin",
                             .is_perspective = true,
                             .yfov = FRAMING_YFOV,
                             .zfar = INFINITY,
                             .world_from_camera = transform_identity()};
    if (!(view.area > 0))
        return frame_bounds(scene->bounds_min, scene->bounds_max,
                            vec3_normalize(vec3(0.35f, 0.3f, 1)), "whole scene");
    bool face_apart = vec3_length(view.facing) < 0.5f * view.area;
    Vec3 facing = face_apart ? view.largest : view.facing;
    if (!(vec3_length(facing) > 0)) facing = vec3(0, 0, 1); /* closed all around */
    return frame_bounds(view.low, view.high, vec3_normalize(facing), "displays");
}
