/* SPDX-License-Identifier: Apache-2.0 */
/* mirrors.h -- the smooth surfaces of a scene, in order, to find what they reflect.
 *
 * A mirror is a triangle whose material sends part of the light on by a smooth boundary about
 * the interpolated normal: glass, lacquer, polished metal, the glass of displays. Surfaces bent
 * by a normal map, or smooth only where a texture makes them so, are none. Which mirrors are
 * searched for which part of the scene is the caller's choice. They stand in trees.
 *
 * Memory   from the arena.  Threads  const after mirrors_build.  Fails  never.
 */
#pragma once
#include <stdbool.h>
#include <stdint.h>

#include "mirror/reflection_point.h"
#include "scene/scene.h"

#define MIRROR_PLANES 4
#define MIRROR_NO_TREE UINT32_MAX

/* A mirror that points of a part search; part_id may be NO_ID: points of no part. Its smooth
 * boundary and its rough one are searched separately. */
typedef struct MirrorPair {
    int part_id;
    bool is_rough;
    uint32_t triangle;
} MirrorPair;

/* A piece of a triangle, bent so little that its normals can be bounded. */
typedef struct MirrorPatch {
    MirrorTriangle corners;
    Vec2 uv[3];  /* of the corners in the triangle */
    uint32_t id; /* of the triangle, in Scene.triangles */
    float alpha; /* GGX, of its facets; 0: none that are searched */
} MirrorPatch;

typedef struct MirrorNode {
    Vec3 centre;               /* of the box of its patches, m */
    float radius;              /* from there to the box's corners, m */
    Vec3 plane[MIRROR_PLANES]; /* unit: all normals, turned to the side of their mean, lie
                                  below these planes; 0: nothing is known */
    uint32_t children;         /* the first of two; 0: it is a leaf, of */
    uint32_t patch;
    float alpha; /* the roughest patch's */
} MirrorNode;

typedef struct Mirrors {
    const MirrorPair *pairs;
    uint32_t pair_count;
    const uint32_t *roots; /* nodes, or MIRROR_NO_TREE; of mirror_root */
    const MirrorPatch *patches;
    const MirrorNode *nodes;
} Mirrors;

/* Where a part's tree stands in Mirrors.roots. */
static inline int mirror_root(int part_id, bool is_rough) {
    return 2 * (part_id + 1) + is_rough;
}

/* Can the material's triangles be smooth mirrors? */
bool mirrors_can_be(const Scene *scene, const Material *material);

/* GGX alpha of rough mirrors that are worth sampling (GLINT_ALPHA at most); 0: these are
 * none. */
float mirrors_rough_alpha(const Material *material);

/* The order in which pairs stand: negative, zero or positive, for qsort. */
int mirrors_compare_pairs(const void *a, const void *b);

/* A triangle of the scene as a mirror. */
MirrorTriangle mirror_triangle(const Scene *scene, uint32_t id);

bool mirrors_have(const Mirrors *mirrors, MirrorPair pair);

/* The spread (reflection_point.h) of a near light at a point of a scene's triangle that turns
 * its light to `from`. */
float mirror_spread_at(const Scene *scene, uint32_t triangle, Vec3 from, Vec3 light, Vec3 point);

typedef struct MirrorQuery {
    int part_id;
    bool is_rough; /* then by u, in [0, 1)^2, facets lean as GGX facets do */
    Vec3 from;     /* the point, m, scene */
    ReflectionLight light;
    Vec2 u;
} MirrorQuery;

/* Called for each reflection with its triangle of the scene and the point on it. For rough
 * mirrors spread is solid angle seen from the point by area of slopes, over their density. */
typedef void MirrorFound(void *user, uint32_t triangle, const ReflectionPoint *point);

/* Finds all points of the part's mirrors that turn the light to the point, in an
 * order that the scene alone decides. Occlusion is not tested. Returns the number of nodes
 * that were visited. */
uint32_t mirrors_find(const Mirrors *mirrors, const MirrorQuery *query, MirrorFound *found,
                      void *user);
