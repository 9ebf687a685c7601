/* SPDX-License-Identifier: Apache-2.0 */
/* geodesic.h -- the hemisphere cut into spherical triangles: the upper half of an octahedron.
 *
 * Level 0 is 4 octants, level i has 4^(i+1) triangles: every triangle (a, b, c) splits at the
 * normalised midpoints of its edges. Child 0 is the central one with corners (bc, ca, ab), each
 * opposite the father's corner of the same place; child k = 1..3 keeps the father's corner k-1
 * in its place k-1. Triangle n of a level has the children 4n .. 4n+3 of the next, so that the
 * base-4 digits of a leaf's id are its path from the octant.
 *
 * Octant    bit 0: x < 0, bit 1: y < 0; its corners are the x, y and z axis in this order. All
 *           octants are mirror images of octant 0, and so is the numbering inside them: a
 *           function that is symmetric in y needs octants 0 and 1 only (the lower half of ids).
 * Frame     +z is the pole. Directions need not be normalised unless stated; z < 0 counts as 0.
 * Units     areas in sr.
 * Threads   a Geodesic is constant after geodesic_create.
 *
 * How a direction finds its leaf: write d = u a + v b + w c in the corners of a triangle. The
 * three great circles through the midpoints are u = v + w, v = w + u and w = u + v, because
 * d = (v+w-u)/2 (b+c) + ... ; and the coordinates in the child follow without leaving these
 * numbers: the midpoint of (b, c) is (b+c)/|b+c| with |b+c| = 2 cos(bc/2). So one level costs
 * three comparisons and three products, and the last (u, v, w) are the barycentric coordinates
 * of the leaf's (gnomonic) plane, which interpolation needs.
 */
#pragma once
#include <stdint.h>

#include "base/arena.h"
#include "base/vec.h"

#define GEODESIC_MAX_LEVEL 10

/* Cosines of half the edges opposite corner 0, 1, 2: all that a descent reads. */
typedef struct GeodesicEdges {
    float half_cos[3];
} GeodesicEdges;

/* Areas of the children over the area of child 0. */
typedef struct GeodesicRatios {
    float of_child[4];
} GeodesicRatios;

/* Tables that depend on the level only, shared by every tree of this level or less. */
typedef struct Geodesic {
    int level;                                            /* of the finest triangles */
    const GeodesicEdges *edges[GEODESIC_MAX_LEVEL + 1];   /* levels < level: 4^level each */
    const GeodesicRatios *ratios[GEODESIC_MAX_LEVEL + 1]; /* levels < level: 4^level each */
    const float *areas[GEODESIC_MAX_LEVEL + 1];           /* every level: 4^level areas, sr */
} Geodesic;

/* Where a direction lies: the triangle and the coordinates in its corners. */
typedef struct GeodesicPoint {
    uint32_t id;     /* triangle of the level requested, all octants */
    float weight[3]; /* barycentric in the plane of the three unit corners; sum to 1 */
} GeodesicPoint;

typedef struct GeodesicTriangle {
    Vec3 corner[3]; /* unit vectors, in the order that children count on */
} GeodesicTriangle;

/* Triangles of a level: 4^(level+1). */
static inline uint32_t geodesic_count(int level) {
    return 4u << 2 * level;
}

/* level: 0..GEODESIC_MAX_LEVEL. About 12 bytes for every triangle of octant 0. */
const Geodesic *geodesic_create(int level, Arena *arena);

/* HOT. One descent, level by level, for queries that stop early or do more on the way. */
typedef struct GeodesicWalk {
    uint32_t octant;
    uint32_t place;  /* of the triangle inside its octant, 0 .. 4^level - 1 */
    float weight[3]; /* direction = sum of weight * corner, up to a common factor */
} GeodesicWalk;

/* The octant of a direction. */
static inline GeodesicWalk geodesic_walk_start(Vec3 d) {
    return (GeodesicWalk){.octant = (d.x < 0 ? 1u : 0u) | (d.y < 0 ? 2u : 0u),
                          .weight = {fabsf(d.x), fabsf(d.y), d.z > 0 ? d.z : 0.0f}};
}

/* From a triangle of `level` to its child; returns which one, 0..3. The child is as good as
 * random: all four outcomes and a look-up take half the time of mispredicted branches. */
static inline uint32_t geodesic_walk_down(const Geodesic *geodesic, int level, GeodesicWalk *walk) {
    const float *k = geodesic->edges[level][walk->place].half_cos;
    float u = walk->weight[0], v = walk->weight[1], w = walk->weight[2];
    float half = 0.5f * (u + v + w);
    float p = half - u, q = half - v, r = half - w; /* of bc, ca, ab; one below 0 at most */
    uint32_t child = (p < 0 ? 1u : 0u) + (q < 0 ? 2u : 0u) + (r < 0 ? 3u : 0u);
    const float a[4] = {p * k[0], -p, u * k[2], u * k[1]};
    const float b[4] = {q * k[1], v * k[2], -q, v * k[0]};
    const float c[4] = {r * k[2], w * k[1], w * k[0], -r};
    child &= 3;
    walk->weight[0] = a[child];
    walk->weight[1] = b[child];
    walk->weight[2] = c[child];
    walk->place = 4 * walk->place + child;
    return child;
}

/* Id and normalised weights after `level` steps down. */
static inline GeodesicPoint geodesic_walk_point(const GeodesicWalk *walk, int level) {
    float u = walk->weight[0], v = walk->weight[1], w = walk->weight[2];
    float sum = u + v + w, scale = sum > 0 ? 1 / sum : 0.0f;
    return (GeodesicPoint){walk->octant << 2 * level | walk->place,
                           {u * scale, v * scale, w * scale}};
}

/* HOT. The triangle of `level` (at most geodesic->level) that holds the direction. Corners and
 * edges belong to one of their triangles, always the same. */
GeodesicPoint geodesic_find(const Geodesic *geodesic, int level, Vec3 direction);

/* Corners of triangle `id` of `level`; needs no table. */
GeodesicTriangle geodesic_triangle(int level, uint32_t id);

/* The direction that stands for a triangle: the normalised sum of its corners. */
Vec3 geodesic_center(int level, uint32_t id);

/* Exact spherical area, sr, in double precision (sums over a level to 2 pi within 1e-9). */
double geodesic_area(int level, uint32_t id);

/* Exact areas of all 4^level triangles of octant 0, in order of id. */
void geodesic_areas(int level, double *areas);

/* HOT. The triangle across the edge opposite `corner` (0..2) inside the same octant, or
 * GEODESIC_NONE at the octant's border. There lies the mirror image of the triangle itself:
 * corner 0: id with octant bit 0 flipped; corner 1: bit 1; corner 2: the horizon, nothing.
 * Inside an octant the neighbour calls the shared edge by the same corner number, and the two
 * corners on the edge have changed numbers. */
uint32_t geodesic_neighbour(int level, uint32_t id, int corner);
#define GEODESIC_NONE UINT32_MAX

/* Constants of a spherical triangle for sampling it. area: of the triangle, sr. */
typedef struct GeodesicSampler {
    Vec3 a, b;    /* corners 0 and 1 */
    Vec3 across;  /* unit, from corner 0 along the arc to corner 2 */
    float area;   /* sr */
    float volume; /* |a . (b - a) x across| */
    float span;   /* 1 + a . b */
    float lean;   /* (b - a) . across */
} GeodesicSampler;

GeodesicSampler geodesic_sampler(const GeodesicTriangle *triangle, float area);

/* HOT. Uniform over the spherical triangle: u in [0,1)^2 to a unit vector, exactly (Arvo 1995,
 * "Stratified Sampling of Spherical Triangles", in a form without trigonometric functions of
 * the corners' angles that stays accurate for small triangles). */
Vec3 geodesic_sampler_draw(const GeodesicSampler *sampler, float u0, float u1);

/* The inverse of geodesic_sampler_draw for a direction inside the triangle. */
Vec2 geodesic_invert_triangle(const GeodesicTriangle *triangle, float area, Vec3 direction);
