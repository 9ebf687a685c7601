/* SPDX-License-Identifier: Apache-2.0 */
/* compact_emitters.h -- small parts that shine: chance hardly finds them in mirrors.
 *
 * A part is compact whose longest edge is at most 15 cm; displays are none. Points are chosen
 * evenly over a part's area.
 *
 * Memory   from the arena. Threads: const after compact_emitters_build.
 */
#pragma once
#include "light/light.h"

typedef struct CompactEmitter {
    int part_id;
    float area_m2;
    const float *share_to; /* of the area, of the part's triangles up to each */
} CompactEmitter;

typedef struct CompactEmitters {
    const CompactEmitter *list;
    int count;
    const int *of_part; /* [part]: which it is, or NO_ID */
} CompactEmitters;

CompactEmitters compact_emitters_build(const Scene *scene, Arena *arena);

/* HOT. A point, u in [0,1)^3. */
typedef struct CompactPoint {
    uint32_t triangle;
    float u, v;
    TrianglePoint point;
} CompactPoint;

CompactPoint compact_emitter_point(const Scene *scene, const CompactEmitter *emitter,
                                   const float u[3]);

/* HOT. The point as a light of `place`: its radiance times *m2_cosine, the area that the point
 * stands for as it is seen from there, is what it sends there, per steradian. False: nothing. */
bool compact_emitter_towards(const Scene *scene, const CompactEmitter *emitter,
                             const CompactPoint *point, Vec3 place, LightSample *sample,
                             float *m2_cosine);
