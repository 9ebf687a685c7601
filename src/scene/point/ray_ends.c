/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/point/ray_ends.h"
#include "base/mathf.h"

static Vec3 interpolate(Vec3 a, Vec3 b, Vec3 c, float u, float v) {
    float w = 1 - u - v;
    return vec3(w * a.x + u * b.x + v * c.x, w * a.y + u * b.y + v * c.y,
                w * a.z + u * b.z + v * c.z);
}

/* A place from the first corner on. Added to that, it is rounded once at the size of the
 * coordinates, else at that of the triangle. */
static Vec3 from_corner(Vec3 first, Vec3 second, float u, float v) {
    return vec3_along(vec3_scale(first, u), second, v);
}

Vec3 triangle_position(const Scene *scene, uint32_t triangle, float u, float v) {
    Vec3 a = scene_corner(scene, triangle, 0);
    Vec3 first = vec3_sub(scene_corner(scene, triangle, 1), a);
    Vec3 second = vec3_sub(scene_corner(scene, triangle, 2), a);
    return vec3_add(a, from_corner(first, second, u, v));
}

/* ---- rounding ---------------------------------------------------------------------------- */

#define ROUNDING 0x1p-24f   /* of a float, relative */
#define SLIVER_MOST 1024.0f /* of s: slimmer ones have no normal to speak of */
#define NEIGHBOUR_MOST_M 4.0f

/* A triangle's edges from its first corner, and what follows from them. */
typedef struct TriangleEdges {
    Vec3 corner;        /* m, world */
    Vec3 first, second; /* to corners 1 and 2 */
    Vec3 ng;            /* unit */
    float twice_area;   /* m^2 */
    float longest;      /* m; */
    float longest_near; /* and of what may lie close to it, */
} TriangleEdges;

static float squared(Vec3 a) {
    return vec3_dot(a, a);
}

static void set_rounding(const TriangleEdges *edges, float s, TrianglePoint *point) {
    Vec3 p = point->position, n = edges->ng;
    float along = fabsf(n.x * p.x) + fabsf(n.y * p.y) + fabsf(n.z * p.z);
    point->slant = 4 * ROUNDING * (1 + min_f(s, SLIVER_MOST));
    point->rounding = ROUNDING * along + point->slant * edges->longest_near;
}

/* A place of a triangle beside its edges; i: the edge from corner i to the next. */
typedef struct Inside {
    Vec3 inward[3];  /* unit, across the edge */
    float height[3]; /* of the triangle over it, */
    float off[3];    /* and of the place; m */
    Vec3 place;      /* from the triangle's first corner */
} Inside;

static Inside beside_edges(const TriangleEdges *edges, const float away[3], Vec3 place) {
    Inside in = {.place = place};
    const Vec3 edge[3] = {edges->first, vec3_sub(edges->second, edges->first),
                          vec3_neg(edges->second)};
    for (int i = 0; i < 3; i++) {
        float length = vec3_length(edge[i]);
        in.inward[i] = vec3_scale(vec3_cross(edges->ng, edge[i]), 1 / length);
        in.height[i] = edges->twice_area / length;
        in.off[i] = away[i] * in.height[i];
    }
    return in;
}

#define MOST_IN 0.25f /* of a height; the centroid is at a third */

static float lack(const Inside *in, int edge, float reach) {
    return min_f(reach, MOST_IN * in->height[edge]) - in->off[edge];
}

static void move_inwards(Inside *in, int edge, float by) {
    in->place = vec3_along(in->place, in->inward[edge], by);
    for (int i = 0; i < 3; i++) in->off[i] += by * vec3_dot(in->inward[edge], in->inward[i]);
}

/* Off each edge straight across; where a sharp corner is too narrow for that, towards the
 * centroid, which is off every edge. */
static void set_inside(const TriangleEdges *edges, float u, float v, TrianglePoint *point) {
    float w = 1 - u - v, reach = ray_inset(point, edges->longest), share = 0;
    point->inside = point->position;
    if (min_f(w, min_f(u, v)) * edges->twice_area >= reach * edges->longest) return;
    Inside in = beside_edges(edges, (const float[3]){v, w, u},
                             from_corner(edges->first, edges->second, u, v));
    Vec3 centroid = vec3_scale(vec3_add(edges->first, edges->second), 1 / 3.0f);
    for (int i = 0; i < 3; i++)
        if (lack(&in, i, reach) > 0) move_inwards(&in, i, lack(&in, i, reach));
    for (int i = 0; i < 3; i++)
        if (lack(&in, i, reach) > 0)
            share = max_f(share, lack(&in, i, reach) / (in.height[i] / 3 - in.off[i]));
    in.place = vec3_along(in.place, vec3_sub(centroid, in.place), share);
    point->inside = vec3_add(edges->corner, in.place);
}

static void set_ends(const Scene *scene, TriangleEdges *edges, float u, float v,
                     TrianglePoint *point) {
    float a = squared(edges->first), b = squared(edges->second),
          c = squared(vec3_sub(edges->second, edges->first)), most = max_f(a, max_f(b, c));
    float shorter = sqrtf(a / most * b * c); /* the product of the two shorter ones */
    edges->longest = sqrtf(most);
    edges->longest_near = max_f(edges->longest, min_f(scene->longest_edge_m, NEIGHBOUR_MOST_M));
    set_rounding(edges, shorter / edges->twice_area, point);
    set_inside(edges, u, v, point);
}

/* ---- the point --------------------------------------------------------------------------- */

TrianglePoint triangle_point(const Scene *scene, uint32_t triangle, float u, float v) {
    const Triangle *t = &scene->triangles[triangle];
    const Part *part = &scene->parts[t->part_id];
    Vec3 a = scene->positions[t->vertex[0]], b = scene->positions[t->vertex[1]],
         c = scene->positions[t->vertex[2]];
    uint32_t i = t->vertex[0] - part->first_vertex, j = t->vertex[1] - part->first_vertex,
             k = t->vertex[2] - part->first_vertex;
    TriangleEdges edges = {.corner = a, .first = vec3_sub(b, a), .second = vec3_sub(c, a)};
    Vec3 across = vec3_cross(edges.first, edges.second);
    TrianglePoint point = {.u = u, .v = v};
    point.position = vec3_add(a, from_corner(edges.first, edges.second, u, v));
    edges.twice_area = vec3_length(across);
    edges.ng = point.ng = vec3_normalize(across);
    set_ends(scene, &edges, u, v, &point);
    point.ns = part->normals ? vec3_normalize(interpolate(part->normals[i], part->normals[j],
                                                          part->normals[k], u, v))
                             : point.ng;
    if (!(vec3_dot(point.ns, point.ns) > 0.5f)) point.ns = point.ng;
    for (int set = 0; set < SCENE_UV_SETS; set++) {
        const Vec2 *uv = part->uv[set];
        float w = 1 - u - v;
        if (uv)
            point.uv[set] = (Vec2){w * uv[i].x + u * uv[j].x + v * uv[k].x,
                                   w * uv[i].y + u * uv[j].y + v * uv[k].y};
    }
    return point;
}
