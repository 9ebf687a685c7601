/* SPDX-License-Identifier: Apache-2.0 */
#include "missed/missed_eye.h"

#include <math.h>

#include "base/units.h"

/* The picture's area is A, in the units of half_width; a solid angle dw at the camera is dA of
 * it. A piece dS of a surface at the distance r fills dw = dS cos / r^2, and has the luminance
 * f lm / dS: its share of the mean over A is f lm cos (dA / dw) / (A r^2). */

/* dA / dw, and the place, of a direction in the camera's axes. False: out of view. */
static bool place_of_direction(const Camera *camera, Vec3 d, Vec2 *place, float *density) {
    if (!(d.z < 0)) return false;
    if (!camera->fisheye) {
        *place = (Vec2){d.x / -d.z, d.y / -d.z};
        *density = 1 / (-d.z * d.z * d.z);
        return true;
    }
    float angle = acosf(fminf(-d.z, 1)), sine = fmaxf(sinf(angle), 1e-6f);
    bool is_equisolid = camera->fisheye == FISHEYE_EQUISOLID;
    float r = is_equisolid ? sqrtf(1 + d.z) : 2 * INV_PI_F * angle;
    *place = (Vec2){r * d.x / sine, r * d.y / sine};
    *density = is_equisolid ? 0.5f : 2 * INV_PI_F * r / sine;
    return true;
}

bool eye_place_of(const Camera *camera, Vec3 position, EyePlace *out) {
    const Transform *world = &camera->world_from_camera;
    Vec3 away = vec3_sub(position, world->origin);
    Vec3 local = vec3(vec3_dot(away, world->x), vec3_dot(away, world->y), vec3_dot(away, world->z));
    float distance = vec3_length(away), density = 1;
    Vec2 place = {local.x, local.y};
    if (camera->is_perspective) {
        if (!(distance > 0) ||
            !place_of_direction(camera, vec3_scale(local, 1 / distance), &place, &density))
            return false;
        density /= distance * distance;
        out->ray = (Ray){position, vec3_scale(away, -1 / distance), 0, distance};
    } else {
        if (!(local.z < 0)) return false;
        out->ray = (Ray){position, world->z, 0, -local.z};
    }
    out->x = 0.5f * (place.x / camera->half_width + 1);
    out->y = 0.5f * (1 - place.y / camera->half_height);
    out->per_flux = density / (4 * camera->half_width * camera->half_height);
    return out->x >= 0 && out->x < 1 && out->y >= 0 && out->y < 1;
}
