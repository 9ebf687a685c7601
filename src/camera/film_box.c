/* SPDX-License-Identifier: Apache-2.0 */
#include "camera/film_box.h"

#define NEAREST_M 1e-3f /* what reaches nearer to the eye, or behind it, is cut off there */

/* Metres to the right, up, and forward of the eye. */
static Vec3 seen_from_eye(const Camera *camera, Vec3 point)
{
    const Transform *eye = &camera->world_from_camera;
    Vec3 away = vec3_sub(point, eye->origin);
    return vec3(vec3_dot(away, eye->x), vec3_dot(away, eye->y), -vec3_dot(away, eye->z));
}

static void add_point(const Camera *camera, Vec3 seen, FilmBox *box)
{
    float distance = camera->is_perspective ? seen.z : 1;
    float right = seen.x / (distance * camera->half_width);
    float up = seen.y / (distance * camera->half_height);
    float x = (1 + right) * 0.5f * (float)camera->width;
    float y = (1 - up) * 0.5f * (float)camera->height;
    *box = (FilmBox){fminf(box->x0, x), fminf(box->y0, y), fmaxf(box->x1, x),
                     fmaxf(box->y1, y)};
}

/* Adds the edge from a to b, without b. */
static void add_edge(const Camera *camera, Vec3 a, Vec3 b, FilmBox *box)
{
    bool sees_a = a.z >= NEAREST_M, sees_b = b.z >= NEAREST_M;
    if (sees_a) add_point(camera, a, box);
    if (sees_a == sees_b) return;
    Vec3 between = vec3_along(a, vec3_sub(b, a), (NEAREST_M - a.z) / (b.z - a.z));
    between.z = NEAREST_M;
    add_point(camera, between, box);
}

static bool faces_camera(const Camera *camera, const Vec3 corner[3])
{
    const Transform *eye = &camera->world_from_camera;
    Vec3 normal = vec3_cross(vec3_sub(corner[1], corner[0]), vec3_sub(corner[2], corner[0]));
    Vec3 to_eye = camera->is_perspective ? vec3_sub(eye->origin, corner[0]) : eye->z;
    return vec3_dot(normal, to_eye) > 0;
}

static void add_triangle(const Camera *camera, const Scene *scene, uint32_t triangle,
                         FilmBox *box)
{
    Vec3 corner[3], seen[3];
    for (int c = 0; c < 3; c++) {
        corner[c] = scene_corner(scene, triangle, c);
        seen[c] = seen_from_eye(camera, corner[c]);
    }
    if (!faces_camera(camera, corner)) return;
    for (int c = 0; c < 3; c++) add_edge(camera, seen[c], seen[(c + 1) % 3], box);
}

static FilmBox cut_to_frame(const Camera *camera, FilmBox box)
{
    return (FilmBox){fmaxf(box.x0, 0), fmaxf(box.y0, 0), fminf(box.x1, (float)camera->width),
                     fminf(box.y1, (float)camera->height)};
}

bool film_box_of_part(const Camera *camera, const Scene *scene, int part_id, FilmBox *out)
{
    const Part *part = &scene->parts[part_id];
    FilmBox     box = {INFINITY, INFINITY, -INFINITY, -INFINITY};
    for (uint32_t t = 0; t < part->triangle_count; t++)
        add_triangle(camera, scene, part->first_triangle + t, &box);
    box = cut_to_frame(camera, box);
    if (!(box.x0 < box.x1 && box.y0 < box.y1)) return false;
    *out = box;
    return true;
}
