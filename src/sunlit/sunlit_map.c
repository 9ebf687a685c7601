/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: no allocation, no lock, no libm. */
#include "sunlit/sunlit_map.h"

#include "base/mathf.h"

/* Cosine of an angle less another, at least 0. */
static float cosine_less(float cosine, float less_cosine)
{
    if (cosine >= less_cosine) return 1;
    return cosine * less_cosine +
           safe_sqrtf(1 - cosine * cosine) * safe_sqrtf(1 - less_cosine * less_cosine);
}

/* What the quarter may send to the point, relative. From within its sphere it may lie
 * anywhere. */
static float importance(const SunlitNode *node, const LitPoint *from)
{
    if (!(node->power > 0)) return 0;
    Vec3  way = vec3_sub(node->centre, from->position);
    float d2 = vec3_dot(way, way), r2 = node->radius * node->radius;
    if (!(d2 > r2)) return node->power / r2;
    float wide = safe_sqrtf(1 - r2 / d2); /* cosine of the angle that the sphere fills */
    way = vec3_scale(way, 1 / sqrtf(d2));
    float lit = vec3_dot(from->ns, way);
    if (from->both_sides) lit = fabsf(lit);
    float sent = -vec3_dot(node->axis, way);
    sent = node->cosine > -1 ? cosine_less(cosine_less(sent, node->cosine), wide) : 1;
    return node->power * fmaxf(cosine_less(lit, wide), 0) * fmaxf(sent, 0) / d2;
}

/* Importances of the four children; their sum. */
static float weigh(const SunlitNode *four, const LitPoint *from, float weight[4])
{
    float sum = 0;
    for (int k = 0; k < 4; k++) sum += weight[k] = importance(&four[k], from);
    return sum;
}

/* u becomes a number in [0, 1) again. */
static int choose_child(const float weight[4], float sum, float *u)
{
    float at = *u * sum;
    int   k = 0;
    while (k < 3 && (at >= weight[k] || !(weight[k] > 0))) at -= weight[k++];
    while (k > 0 && !(weight[k] > 0)) k--;
    *u = clampf(at / weight[k], 0, 0x1.fffffep-1f);
    return k;
}

bool sunlit_map_choose(const SunlitMap *map, const LitPoint *from, const float u[3],
                       SunlitRay *ray)
{
    const SunlitNode *node = map->nodes;
    float side = map->side, prob = 1, choice = u[0];
    ray->s = ray->t = 0;
    while (node->child) {
        float weight[4];
        const SunlitNode *four = &map->nodes[node->child];
        float sum = weigh(four, from, weight);
        if (!(sum > 0)) return false;
        int k = choose_child(weight, sum, &choice);
        prob *= weight[k] / sum;
        side *= 0.5f;
        ray->s += (float)(k & 1) * side;
        ray->t += (float)(k >> 1) * side;
        node = &four[k];
    }
    ray->s += u[1] * side;
    ray->t += u[2] * side;
    ray->density = prob / (side * side);
    return ray->density > 0;
}

/* (s, t) of the ray that passes the place; false: outside the region. */
static bool ray_through(const SunlitMap *map, Vec3 at, Vec3 towards, float *s, float *t)
{
    Vec3  from_corner = vec3_sub(at, map->corner);
    float high = vec3_dot(from_corner, map->frame.z);
    if (!(high < map->above && high > -map->below)) return false;
    Vec3 local = frame_to_local(
        &map->frame, vec3_along(from_corner, towards, -high / vec3_dot(towards, map->frame.z)));
    *s = local.x;
    *t = local.y;
    return *s >= 0 && *s < map->side && *t >= 0 && *t < map->side;
}

float sunlit_map_density(const SunlitMap *map, const LitPoint *from, Vec3 at, Vec3 towards)
{
    const SunlitNode *node = map->nodes;
    float s, t, side = map->side, prob = 1;
    if (!ray_through(map, at, towards, &s, &t)) return 0;
    while (node->child) {
        float weight[4];
        const SunlitNode *four = &map->nodes[node->child];
        float sum = weigh(four, from, weight);
        side *= 0.5f;
        int k = (s >= side) + 2 * (t >= side);
        if (!(weight[k] > 0)) return 0;
        prob *= weight[k] / sum;
        s -= (float)(k & 1) * side;
        t -= (float)(k >> 1) * side;
        node = &four[k];
    }
    return prob / (side * side);
}

Vec3 sunlit_map_entry(const SunlitMap *map, const SunlitRay *ray, Vec3 towards, float *length)
{
    Vec3  at = vec3_add(map->corner, frame_to_world(&map->frame, vec3(ray->s, ray->t, 0)));
    float slope = vec3_dot(towards, map->frame.z);
    *length = (map->above + map->below) / slope;
    return vec3_along(at, towards, map->above / slope);
}
