/* SPDX-License-Identifier: Apache-2.0 */
#include "light/compact_emitters.h"

#include <math.h>

#include "base/mathf.h"

#define LONGEST_M 0.15f

static bool is_compact(const Scene *scene, const Part *part) {
    const Material *m = &scene->materials[part->material_id];
    return m->is_emitter && m->display_id == NO_ID &&
           scene_part_longest_m(scene, part) <= LONGEST_M;
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
            area += scene_triangle_m2(scene, part->first_triangle + i);
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
