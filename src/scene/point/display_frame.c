/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/point/display_frame.h"

/* The direction in the triangle's plane in which the slot's u grows: with edges e1, e2 and the
 * differences (du1, dv1), (du2, dv2) along them, dP/du ~ (dv2 e1 - dv1 e2) / det. */
static Vec3 direction_of_u(const Scene *scene, const TextureSlot *slot, uint32_t triangle) {
    Vec2 uv[3];
    Vec3 p[3];
    for (int i = 0; i < 3; i++) {
        uv[i] = slot_corner_uv(scene, slot, triangle, i);
        p[i] = scene_corner(scene, triangle, i);
    }
    float du1 = uv[1].x - uv[0].x, dv1 = uv[1].y - uv[0].y;
    float du2 = uv[2].x - uv[0].x, dv2 = uv[2].y - uv[0].y;
    float det = du1 * dv2 - du2 * dv1;
    Vec3 along =
        vec3_sub(vec3_scale(vec3_sub(p[1], p[0]), dv2), vec3_scale(vec3_sub(p[2], p[0]), dv1));
    return det < 0 ? vec3_neg(along) : along;
}

Frame display_frame(const Scene *scene, const Display *display, uint32_t triangle,
                    const TrianglePoint *point) {
    Vec3 n = vec3_dot(point->ns, point->ng) < 0 ? vec3_neg(point->ns) : point->ns;
    Vec3 right = direction_of_u(scene, &display->content, triangle);
    right = vec3_normalize(vec3_along(right, n, -vec3_dot(right, n)));
    if (!(vec3_dot(right, right) > 0.5f)) return frame_from_z(n);
    return (Frame){right, vec3_cross(n, right), n};
}

void display_place(const Display *display, const TrianglePoint *point, float place[2]) {
    const float *m = display->place_from_uv;
    Vec2 uv = slot_uv(&display->content, point);
    place[0] = m[0] * uv.x + m[1];
    place[1] = m[2] * uv.y + m[3];
}
