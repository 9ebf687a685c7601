/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: no allocation, no lock, no libm. */
#include "sunlit/sunlit_map.h"

#include "base/mathf.h"

/* What the four quarters may send to the point, relative; their sum. From within its sphere a
 * quarter may lie anywhere. Without branches, so that compilers work on all four at once: this
 * runs for every level of every sample.
 *
 * An angle less another has the cosine c C + s S, and no more than 0 of it is left where
 * c >= C. */
static float weigh(const SunlitQuarters *four, const LitPoint *from, float weight[4]) {
    Vec3 at = from->position, ns = from->ns;
    bool both = from->both_sides;
    for (int k = 0; k < 4; k++) {
        float x = four->centre[0][k] - at.x, y = four->centre[1][k] - at.y;
        float z = four->centre[2][k] - at.z, r2 = four->square[k];
        float d2 = x * x + y * y + z * z, over = 1 / (d2 > r2 ? d2 : r2), near = sqrtf(over);
        float fills2 = r2 * over, fills = sqrtf(fills2); /* sine of the angle that it fills, */
        float wide = sqrtf(1 - fills2);                  /* and cosine */
        float lit = (ns.x * x + ns.y * y + ns.z * z) * near;
        float sent = -(four->axis[0][k] * x + four->axis[1][k] * y + four->axis[2][k] * z) * near;
        lit = both && lit < 0 ? -lit : lit;
        float away2 = 1 - lit * lit, aside2 = 1 - sent * sent;
        float away = sqrtf(away2 > 0 ? away2 : 0), aside = sqrtf(aside2 > 0 ? aside2 : 0);
        float cosine = four->cosine[k], sine = four->sine[k];
        bool in_cone = sent >= cosine;
        float left = in_cone ? 1 : sent * cosine + aside * sine;
        float beside = in_cone ? 0 : aside * cosine - sent * sine;
        lit = lit >= wide ? 1 : lit * wide + away * fills;
        left = left >= wide ? 1 : left * wide + beside * fills;
        float seen = (lit > 0 ? lit : 0) * (left > 0 ? left : 0);
        weight[k] = four->power[k] * over * (d2 > r2 ? seen : 1);
    }
    return (weight[0] + weight[1]) + (weight[2] + weight[3]);
}

/* u becomes a number in [0, 1) again. */
static int choose_child(const float weight[4], float sum, float *u) {
    float at = *u * sum;
    int k = 0;
    while (k < 3 && (at >= weight[k] || !(weight[k] > 0))) at -= weight[k++];
    while (k > 0 && !(weight[k] > 0)) k--;
    *u = clampf(at / weight[k], 0, 0x1.fffffep-1f);
    return k;
}

bool sunlit_map_choose(const SunlitMap *map, const LitPoint *from, const float u[3],
                       SunlitRay *ray) {
    float side = map->side, prob = 1, choice = u[0];
    uint32_t at = 0;
    ray->s = ray->t = 0;
    do {
        float weight[4], sum = weigh(&map->nodes[at], from, weight);
        if (!(sum > 0)) return false;
        int k = choose_child(weight, sum, &choice);
        prob *= weight[k] / sum;
        side *= 0.5f;
        ray->s += (float)(k & 1) * side;
        ray->t += (float)(k >> 1) * side;
        at = map->nodes[at].child[k];
    } while (at);
    ray->s += u[1] * side;
    ray->t += u[2] * side;
    ray->density = prob / (side * side);
    return ray->density > 0;
}

/* (s, t) of the ray that passes the place; false: outside the region. */
static bool ray_through(const SunlitMap *map, Vec3 at, Vec3 towards, float *s, float *t) {
    Vec3 from_corner = vec3_sub(at, map->corner);
    float high = vec3_dot(from_corner, map->frame.z);
    if (!(high < map->above && high > -map->below)) return false;
    Vec3 local = frame_to_local(
        &map->frame, vec3_along(from_corner, towards, -high / vec3_dot(towards, map->frame.z)));
    *s = local.x;
    *t = local.y;
    return *s >= 0 && *s < map->side && *t >= 0 && *t < map->side;
}

float sunlit_map_density(const SunlitMap *map, const LitPoint *from, Vec3 at, Vec3 towards) {
    float s, t, side = map->side, prob = 1;
    uint32_t node = 0;
    if (!ray_through(map, at, towards, &s, &t)) return 0;
    do {
        float weight[4], sum = weigh(&map->nodes[node], from, weight);
        side *= 0.5f;
        int k = (s >= side) + 2 * (t >= side);
        if (!(weight[k] > 0)) return 0;
        prob *= weight[k] / sum;
        s -= (float)(k & 1) * side;
        t -= (float)(k >> 1) * side;
        node = map->nodes[node].child[k];
    } while (node);
    return prob / (side * side);
}

Vec3 sunlit_map_entry(const SunlitMap *map, const SunlitRay *ray, Vec3 towards, float *length) {
    Vec3 at = vec3_add(map->corner, frame_to_world(&map->frame, vec3(ray->s, ray->t, 0)));
    float slope = vec3_dot(towards, map->frame.z);
    *length = (map->above + map->below) / slope;
    return vec3_along(at, towards, map->above / slope);
}
