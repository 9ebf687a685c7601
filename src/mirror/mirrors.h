/* SPDX-License-Identifier: Apache-2.0 */
/* mirrors.h -- the smooth surfaces of a scene, in order, to find what they reflect.
 *
 * A mirror is a triangle whose material sends part of the light on by a smooth boundary about
 * the interpolated normal: glass, lacquer, polished metal, the glass of displays. Surfaces bent
 * by a normal map, or smooth only where a texture makes them so, are none. Which mirrors are
 * asked for which part of the scene is the caller's choice.
 *
 * Memory   from the arena.  Threads  const after mirrors_build.  Fails  never.
 */
#pragma once
#include "mirror/mirror_tree.h"
#include "scene/scene.h"

/* Can the material's triangles be smooth mirrors? */
bool mirrors_can_be(const Scene *scene, const Material *material);

/* GGX alpha of rough mirrors that are worth asking (GLINT_ALPHA at most); 0: these are none. */
float mirrors_rough_alpha(const Material *material);

/* The order in which pairs stand: negative, zero or positive, for qsort. */
int mirrors_compare_pairs(const void *a, const void *b);

bool mirrors_have(const Mirrors *mirrors, MirrorPair pair);

typedef struct MirrorQuery {
    int   part_id;
    bool  is_rough; /* then by u, in [0, 1)^2, facets lean as GGX facets do */
    Vec3  from;     /* the point, m, world */
    Vec3  towards;  /* unit, to the light */
    Vec2  u;
} MirrorQuery;

/* Called for each reflection with its triangle of the scene and the point on it. For rough
 * mirrors spread is solid angle seen from the point by area of slopes, over their density. */
typedef void MirrorFound(void *user, uint32_t triangle, const ReflectionPoint *point);

/* Finds all points of the part's mirrors that turn light from `towards` to the point, in an
 * order that the scene alone decides. Occlusion is not tested. Returns the number of nodes
 * that were visited. */
uint32_t mirrors_find(const Mirrors *mirrors, const MirrorQuery *query, MirrorFound *found,
                      void *user);
