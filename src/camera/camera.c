#include "camera/camera.h"

#include "base/mathf.h"
#include "base/units.h"

/* Through mathf.h: a frame's bits must not depend on the C library. */
static float half_angle_tangent(float angle)
{
    float sine, cosine;
    sincos_turns(angle * (0.25f * INV_PI_F), &sine, &cosine);
    return sine / cosine;
}

Camera camera_from_scene(const SceneCamera *camera, int width, int height)
{
    float half_height =
        camera->is_perspective ? half_angle_tangent(camera->yfov) : camera->ymag;
    return (Camera){.world_from_camera = camera->world_from_camera,
                    .is_perspective = camera->is_perspective,
                    .half_width = half_height * (float)width / (float)height,
                    .half_height = half_height,
                    .width = width,
                    .height = height};
}

Ray camera_ray(const Camera *camera, float x, float y)
{
    const Transform *world = &camera->world_from_camera;
    float right = (2 * x / (float)camera->width - 1) * camera->half_width;
    float up = (1 - 2 * y / (float)camera->height) * camera->half_height;
    if (camera->is_perspective) {
        Vec3 direction = vec3_normalize(transform_vector(world, vec3(right, up, -1)));
        return (Ray){world->origin, direction, 0, INFINITY};
    }
    return (Ray){transform_point(world, vec3(right, up, 0)), vec3_neg(world->z), 0, INFINITY};
}

SceneCamera camera_frame_scene(const Scene *scene)
{
    if (!scene->triangle_count)
        return (SceneCamera){.node_name = "", .camera_name = "origin", .is_perspective = true,
                             .yfov = 0.7f, .zfar = INFINITY,
                             .world_from_camera = transform_identity()};
    Vec3  centre = vec3_scale(vec3_add(scene->bounds_min, scene->bounds_max), 0.5f);
    Vec3  size = vec3_sub(scene->bounds_max, scene->bounds_min);
    float radius = fmaxf(0.5f * vec3_length(size), 1e-6f);
    float yfov = 0.7f;
    Vec3  z = vec3_normalize(vec3(0.35f, 0.3f, 1)); /* from the scene to the camera */
    Vec3  x = vec3_normalize(vec3_cross(vec3(0, 1, 0), z));
    float distance = radius / half_angle_tangent(yfov) * 1.15f;
    return (SceneCamera){.node_name = "", .camera_name = "whole scene", .is_perspective = true,
                         .yfov = yfov, .znear = 0, .zfar = INFINITY,
                         .world_from_camera = {x, vec3_cross(z, x), z,
                                               vec3_along(centre, z, distance)}};
}
