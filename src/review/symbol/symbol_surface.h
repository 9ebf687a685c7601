/* SPDX-License-Identifier: Apache-2.0 */
/* symbol_surface.h -- where a rectangle of a display's content lies in the world.
 *
 * Frames   metres, scene. uv of the content: after the display's own texture transform, u
 *          right, v down, 0..1.
 * Memory   from the arena; the scene must outlive the surface.
 * Threads  const once built.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"
#include "review/request/request.h"
#include "scene/scene.h"

/* Which rectangle of which display, and how many points are required of it. Of a display whose
 * material two nodes wear, ReviewDisplay holds the parts of one ("node:NAME"). */
typedef struct SymbolPlace {
    const Scene *scene;
    const ReviewDisplay *display;
    double uv[4];    /* left, top, right, bottom */
    int point_count; /* at least 1; a power of two spreads best */
} SymbolPlace;

/* A point of the display's surface. */
typedef struct SymbolPoint {
    uint32_t triangle;
    float u, v; /* barycentric weights of its vertices 1 and 2 */
    Vec3 position;
    Vec3 ng, ns;   /* unit; ng: geometric, of the front */
    Vec2 uv;       /* of the content */
    float area_m2; /* of the display that it stands for */
} SymbolPoint;

/* A triangle that reaches into the rectangle: the weight of its vertex k is
 * gradient[k - 1] . (uv - corner), for k = 1 and 2. */
typedef struct SymbolTriangle {
    uint32_t triangle;
    double corner[2], gradient[2][2];
    double area_m2; /* for a uv area of 1 */
} SymbolTriangle;

typedef struct SymbolSurface {
    const Scene *scene;
    int display_id;
    double uv[4];
    const SymbolTriangle *triangles;
    int triangle_count;
    SymbolPoint *points; /* Hammersley's of the rectangle: the same each time. Of
                            2^n points every half, quarter ... has its share */
    int point_count;
    double area_m2; /* sum of the points' */
} SymbolSurface;

/* Fails, without naming the symbol, when the display shows some of the rectangle nowhere. Of
 * triangles that show the same uv the first in the file counts. */
bool symbol_surface_build(const SymbolPlace *place, Arena *arena, SymbolSurface *out, Error *err);

/* A rectangle within that of a surface, with points of its own. */
bool symbol_surface_within(const SymbolSurface *of, const double uv[4], int point_count,
                           Arena *arena, SymbolSurface *out, Error *err);

/* The part of the rectangle that a point stands for: patches do not overlap, and together they
 * are the rectangle. */
typedef struct SymbolPatch {
    Vec3 middle, along, down; /* m; the last two are edges: 0 where the display shows some of it
                                 nowhere, and for counts that are no power of two */
} SymbolPatch;

/* Its left, top, right and bottom in uv; false: the count is no power of two. */
bool symbol_patch_box(const SymbolSurface *surface, int point, double uv[4]);

SymbolPatch symbol_patch(const SymbolSurface *surface, int point);

/* The patch of any rectangle of it, its edges 0 where that is not shown; the middle is. */
SymbolPatch symbol_patch_of(const SymbolSurface *surface, const double uv[4], Vec3 middle);

/* The point of the surface that shows uv, its area_m2 left 0; false: none of its triangles
 * does. */
bool symbol_surface_at(const SymbolSurface *surface, const double uv[2], SymbolPoint *out);

/* Where rays start at the point's front (scene/point/ray_ends.h). */
Vec3 symbol_point_start(const Scene *scene, const SymbolPoint *point);
