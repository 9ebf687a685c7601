/* SPDX-License-Identifier: Apache-2.0 */
#include "path/sheets.h"

#include "scene/point/ray_ends.h"

/* Counts the corners of a that b has too, by position, since texture seams split vertices;
 * *apart: a's last corner that b has not. */
static int shared_corners(const Scene *scene, uint32_t a, uint32_t b, Vec3 *apart) {
    int count = 0;
    for (int i = 0; i < 3; i++) {
        Vec3 own = scene_corner(scene, a, i);
        bool is_shared = false;
        for (int k = 0; k < 3; k++) {
            Vec3 d = vec3_sub(own, scene_corner(scene, b, k));
            is_shared |= vec3_dot(d, d) == 0;
        }
        count += is_shared;
        if (!is_shared) *apart = own;
    }
    return count;
}

/* Both share an edge, and lie on its two sides: no point but of that edge is in both. */
bool sheets_are_one(const Scene *scene, uint32_t triangle, uint32_t other) {
    Vec3 of_a, of_b;
    if (scene_part(scene, triangle) != scene_part(scene, other) ||
        shared_corners(scene, triangle, other, &of_a) != 2 ||
        shared_corners(scene, other, triangle, &of_b) != 2)
        return false;
    Vec3 edge[2], *end = edge;
    for (int i = 0; i < 3 && end < edge + 2; i++) {
        Vec3 d = vec3_sub(scene_corner(scene, triangle, i), of_a);
        if (vec3_dot(d, d) > 0) *end++ = scene_corner(scene, triangle, i);
    }
    Vec3 along = vec3_sub(edge[1], edge[0]);
    return vec3_dot(vec3_cross(along, vec3_sub(of_a, edge[0])),
                    vec3_cross(along, vec3_sub(of_b, edge[0]))) < 0;
}

/* The t of its hits is their depth behind the plane of the hit that was met. */
typedef struct SheetSearch {
    const Scene *scene;
    SheetStack *out;
    float start; /* t of that plane along the search's ray */
    float rounding;
} SheetSearch;

/* Keeps the hits in falling order of their triangles: opaque ones stand first in the scene, the
 * others in the order of the file. */
static void insert(SheetStack *stack, Hit hit) {
    int place = stack->count;
    while (place > 0 && stack->hit[place - 1].triangle < hit.triangle) place--;
    if (place == SHEETS_MAX) return;
    if (stack->count < SHEETS_MAX) stack->count++;
    for (int i = stack->count - 1; i > place; i--) stack->hit[i] = stack->hit[i - 1];
    stack->hit[place] = hit;
}

static bool found(void *user, const Hit *hit) {
    SheetSearch *search = user;
    SheetStack *out = search->out;
    Hit at = {hit->t - search->start, hit->u, hit->v, hit->triangle};
    for (int i = 0; i < out->count; i++)
        if (out->hit[i].triangle == at.triangle ||
            (fabsf(out->hit[i].t - at.t) <= search->rounding &&
             sheets_are_one(search->scene, out->hit[i].triangle, at.triangle)))
            return true;
    insert(out, at);
    return true;
}

/* Sinks deeper hits behind nearer ones; those of one depth keep their order. */
static void order_by_depth(SheetStack *stack, float rounding) {
    for (int i = 1; i < stack->count; i++)
        for (int k = i; k > 0 && stack->hit[k].t < stack->hit[k - 1].t - rounding; k--) {
            Hit nearer = stack->hit[k];
            stack->hit[k] = stack->hit[k - 1];
            stack->hit[k - 1] = nearer;
        }
}

static void end_at_opaque(const Scene *scene, float t, SheetStack *stack) {
    for (int i = 0; i < stack->count; i++) {
        if (stack->hit[i].triangle < scene->opaque_count) stack->count = i + 1;
        stack->hit[i].t = t;
    }
}

/* The search goes along the normal, so that the place does not depend on the eye's. */
void sheets_at(const Scene *scene, const Bvh *bvh, const Hit *met, Vec3 direction,
               SheetStack *out) {
    TrianglePoint point = triangle_point(scene, met->triangle, met->u, met->v);
    Vec3 down = vec3_dot(point.ng, direction) < 0 ? vec3_neg(point.ng) : point.ng;
    float step = ray_step(&point);
    SheetSearch search = {scene, out, step, point.rounding};
    *out = (SheetStack){.hit = {{0, met->u, met->v, met->triangle}}, .count = 1};
    bvh_find_sheets(bvh, (Ray){vec3_along(point.position, down, -step), down, 0, 2 * step}, found,
                    &search);
    order_by_depth(out, search.rounding);
    end_at_opaque(scene, met->t, out);
}
