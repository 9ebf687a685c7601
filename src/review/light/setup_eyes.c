/* SPDX-License-Identifier: Apache-2.0 */
#include "review/light/setup_eyes.h"

#include "review/request/request_check.h"

bool setup_eye_middle(const Setup *setup, const ReviewEye *eye, Arena scratch, Vec3 *out,
                      Error *err)
{
    int    id;
    double middle[3], moved[3];
    for (int i = 0; i < 3; i++) {
        moved[i] = eye->move_m[i];
        middle[i] = eye->position_m[i] + moved[i];
    }
    review_mirror_point(eye->mirror, middle);
    review_mirror_direction(eye->mirror, moved);
    *out = scene_from_world(setup->scene->origin, middle);
    if (eye->kind != EYE_CAMERA) return true;
    if (!review_camera_find(setup->scene, eye, scratch, &id, err))
        return error_in_file(err, setup->request->file);
    *out = vec3_add(setup->scene->cameras[id].world_from_camera.origin,
                    vec3_from_doubles(moved));
    return true;
}

Vec3 *setup_eye_points(const Setup *setup, const ReviewEye *eye, int *count, Arena *arena,
                       Error *err)
{
    *count = review_eye_count(eye);
    Vec3 *points = ARENA_NEW(arena, Vec3, *count);
    if (!review_eye_is_wide(eye))
        return setup_eye_middle(setup, eye, *arena, points, err) ? points : NULL;
    for (int i = 0; i < *count; i++) {
        double p[3];
        review_eye_point(eye, i, p);
        points[i] = scene_from_world(setup->scene->origin, p);
    }
    return points;
}
