/* SPDX-License-Identifier: Apache-2.0 */
#include "light/compact_emitters.h"

#include <math.h>

#include "base/mathf.h"

#define LONGEST_M 0.15f

static bool is_compact(const Scene *scene, const Part *part) {
    const Material *m = &scene->materials[part->material_id];
    Vec3 low = vec3(INFINITY, INFINITY, INFINITY), high = vec3_neg(low);
    if (!m->is_emitter || m->display_id != NO_ID) return false;
    for (uint32_t i = 0; i < 3 * part->triangle_count; i++) {
        Vec3 p = scene_corner(scene, part->first_triangle + i / 3, (int)(i % 3));
        low = vec3(fminf(low.x, p.x), fminf(low.y, p.y), fminf(low.z, p.z));
        high = vec3(fmaxf(high.x, p.x), fmaxf(high.y, p.y), fmaxf(high.z, p.z));
    }
    Vec3 size = vec3_sub(high, low);
    return fmaxf(fmaxf(size.x, size.y), size.z) <= LONGEST_M;
}

static double area_m2(const Scene *scene, uint32_t triangle) {
    Vec3 p[3];
    for (int i = 0; i < 3; i++) p[i] = scene_corner(scene, triangle, i);
    return 0.5 * (double)vec3_length(vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0])));
}

CompactEmitters compact_emitters_build(const Scene *scene, Arena *arena) {
    int *of_part = ARENA_NEW(arena, int, scene->part_count + 1);
    CompactEmitter *list = ARENA_NEW(arena, CompactEmitter, scene->part_count + 1);
    CompactEmitters out = {.list = list, .of_part = of_part};
    for (int id = 0; id < scene->part_count; id++) {
        const Part *part = &scene->parts[id];
        of_part[id] = NO_ID;
        if (!is_compact(scene, part)) continue;
        float *share_to = ARENA_NEW(arena, float, part->triangle_count);
        double area = 0;
        for (uint32_t i = 0; i < part->triangle_count; i++) {
            area += area_m2(scene, part->first_triangle + i);
            share_to[i] = (float)area;
        }
        if (!(area > 0)) continue;
        for (uint32_t i = 0; i < part->triangle_count; i++) share_to[i] /= (float)area;
        of_part[id] = out.count;
        list[out.count++] = (CompactEmitter){id, (float)area, share_to};
    }
    return out;
}

CompactPoint compact_emitter_point(const Scene *scene, const CompactEmitter *emitter,
                                   const float u[3]) {
    const Part *part = &scene->parts[emitter->part_id];
    uint32_t low = 0, high = part->triangle_count - 1;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (u[0] < emitter->share_to[middle]) high = middle;
        else low = middle + 1;
    }
    float root = sqrtf(u[1]);
    CompactPoint out = {.triangle = part->first_triangle + low, .u = root * u[2], .v = 1 - root};
    out.point = triangle_point(scene, out.triangle, out.u, out.v);
    return out;
}

bool compact_emitter_towards(const Scene *scene, const CompactEmitter *emitter,
                             const CompactPoint *point, Vec3 place, LightSample *sample,
                             float *m2_cosine) {
    Vec3 to = vec3_sub(point->point.position, place);
    float d2 = vec3_dot(to, to);
    *sample = (LightSample){.set = LIGHTS_EMITTERS,
                            .wi = vec3_normalize(to),
                            .distance = sqrtf(d2),
                            .pdf = 1,
                            .is_emitter = true,
                            .triangle = point->triangle,
                            .u = point->u,
                            .v = point->v,
                            .point = point->point};
    *m2_cosine = emitter->area_m2 * fabsf(vec3_dot(point->point.ng, sample->wi));
    return d2 > 0 && *m2_cosine > 0 &&
           triangle_emits_to(scene, point->triangle, &point->point, vec3_neg(sample->wi));
}
