/* SPDX-License-Identifier: Apache-2.0 */
/* mirror_tree.h -- the trees in which a scene's mirrors stand; mirrors.h has the queries.
 *
 * Threads  const after mirrors_build. Units: metres, world.
 */
#pragma once
#include <stdbool.h>
#include <stdint.h>

#include "mirror/reflection_point.h"

#define MIRROR_PLANES 4
#define MIRROR_NO_TREE UINT32_MAX

/* A mirror that points of a part ask for; part_id may be NO_ID: points of no part. Its smooth
 * boundary and its rough one are asked for separately. */
typedef struct MirrorPair {
    int      part_id;
    bool     is_rough;
    uint32_t triangle;
} MirrorPair;

/* A piece of a triangle, bent so little that its normals can be bounded. */
typedef struct MirrorPatch {
    MirrorTriangle corners;
    Vec2           uv[3]; /* of the corners in the triangle */
    uint32_t       id;    /* of the triangle, in Scene.triangles */
    float          alpha; /* GGX, of its facets; 0: none that are asked */
} MirrorPatch;

typedef struct MirrorNode {
    Vec3     centre;       /* of the box of its patches, m */
    float    radius;       /* from there to the box's corners, m */
    Vec3     plane[MIRROR_PLANES]; /* unit: all normals, turned to the side of their mean, lie
                                      below these planes; 0: nothing is known */
    uint32_t children;     /* the first of two; 0: it is a leaf, of */
    uint32_t patch;
    float    alpha;        /* the roughest patch's */
} MirrorNode;

typedef struct Mirrors {
    const MirrorPair  *pairs;
    uint32_t           pair_count;
    const uint32_t    *roots; /* nodes, or MIRROR_NO_TREE; of mirror_root */
    const MirrorPatch *patches;
    const MirrorNode  *nodes;
} Mirrors;

/* Where a part's tree stands in Mirrors.roots. */
static inline int mirror_root(int part_id, bool is_rough)
{
    return 2 * (part_id + 1) + is_rough;
}
