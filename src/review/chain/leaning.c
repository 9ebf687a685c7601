/* SPDX-License-Identifier: Apache-2.0 */
#include "review/chain/leaning.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "base/units.h"

#define UPRIGHT 0.985f /* cosine of 10 degrees (scene/change/node_change.c) */

typedef struct Turn {
    Vec3  axis; /* unit */
    float cosine, sine;
} Turn;

/* Rodrigues' formula. */
static Vec3 turned(const Turn *turn, Vec3 v)
{
    Vec3 sum = vec3_along(vec3_scale(v, turn->cosine), vec3_cross(turn->axis, v), turn->sine);
    return vec3_along(sum, turn->axis, (1 - turn->cosine) * vec3_dot(turn->axis, v));
}

static Turn turn_of(const LeaningAsk *ask, double back_deg)
{
    const Vec3 up = vec3(0, 1, 0);
    double     angle = radians_from_degrees(back_deg);
    Vec3       n = ask->normal;
    if (fabsf(n.y) >= UPRIGHT) n = vec3_neg(vec3_from_doubles(ask->ahead));
    return (Turn){vec3_normalize(vec3_cross(n, up)), (float)cos_d(angle), (float)sin_d(angle)};
}

static uint32_t end_vertex(const Scene *scene, const Part *part)
{
    uint32_t end = part->first_vertex;
    for (uint32_t t = 0; t < part->triangle_count; t++)
        for (int i = 0; i < 3; i++) {
            uint32_t vertex = scene->triangles[part->first_triangle + t].vertex[i];
            if (vertex >= end) end = vertex + 1;
        }
    return end;
}

/* Normals of a part that has none of its own: of its triangles, by their area. */
static void add_flat_normals(const Scene *scene, const Part *part, Vec3 *normals)
{
    for (uint32_t t = 0; t < part->triangle_count; t++) {
        uint32_t triangle = part->first_triangle + t;
        Vec3     a = scene_corner(scene, triangle, 0);
        Vec3     n = vec3_cross(vec3_sub(scene_corner(scene, triangle, 1), a),
                                vec3_sub(scene_corner(scene, triangle, 2), a));
        for (int i = 0; i < 3; i++) {
            Vec3 *sum = &normals[scene_corner_place(scene, triangle, i)];
            *sum = vec3_add(*sum, n);
        }
    }
}

static Vec3 *turned_normals(const Scene *scene, const Part *part, const Turn *turn,
                            Arena *arena)
{
    uint32_t count = end_vertex(scene, part) - part->first_vertex;
    Vec3    *normals = ARENA_NEW(arena, Vec3, count);
    if (part->normals) memcpy(normals, part->normals, count * sizeof *normals);
    else add_flat_normals(scene, part, normals);
    for (uint32_t i = 0; i < count; i++)
        normals[i] = vec3_normalize(turned(turn, normals[i]));
    return normals;
}

LeaningDisplay *display_leaning(const LeaningAsk *ask, double back_deg, Arena *arena)
{
    const Scene    *scene = ask->context->scene;
    LeaningDisplay *out = ARENA_NEW(arena, LeaningDisplay, 1);
    Part *parts = ARENA_NEW(arena, Part, scene->part_count);
    Turn  turn = turn_of(ask, back_deg);
    memcpy(parts, scene->parts, (size_t)scene->part_count * sizeof *parts);
    for (int i = 0; i < ask->display->part_count; i++) {
        Part *part = &parts[ask->display->part_ids[i]];
        part->normals = turned_normals(scene, part, &turn, arena);
    }
    out->scene = *scene;
    out->scene.parts = parts;
    out->context = *ask->context;
    out->context.scene = &out->scene;
    return out;
}
