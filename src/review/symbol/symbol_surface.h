/* symbol_surface.h -- where a rectangle of a display's content lies in the world.
 *
 * Frames   metres, world. uv of the content: after the display's own texture transform, u right,
 *          v down, 0..1.
 * Memory   from the arena; scene and display must outlive the surface.
 * Threads  const once built.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"
#include "review/request/request.h"
#include "scene/scene.h"

/* Which rectangle of which display (review_display_find: a material, or "node:NAME" of the node
 * that wears it), and how many points are wanted of it. */
typedef struct SymbolPlace {
    const Scene         *scene;
    const ReviewDisplay *display;
    double               uv[4];       /* left, top, right, bottom */
    int                  point_count; /* a power of two spreads best: any rectangle of 1 / n of
                                         the whole then holds its share */
} SymbolPlace;

/* A point of the display's front. */
typedef struct SymbolPoint {
    uint32_t triangle;
    float    u, v;       /* barycentric weights of its vertices 1 and 2 */
    Vec3     position;
    Vec3     ng, ns;     /* unit; ng: geometric, of the front */
    Vec2     uv;         /* of the content */
    float    area_m2;    /* of the display's surface that it stands for */
} SymbolPoint;

typedef struct SymbolSurface {
    const Scene    *scene;
    int             display_id;
    double          uv[4];
    const uint32_t *triangles;  /* those that reach into the rectangle */
    int             triangle_count;
    SymbolPoint    *points;     /* Hammersley's points of the rectangle: the same each time */
    int             point_count;
    double          area_m2;    /* sum of the points' */
} SymbolSurface;

/* Fails, without naming the symbol, when some of the rectangle is on no triangle ("symbol
 * outside its display"), or when two of the display's nodes show it. Of triangles of one node
 * that lie over each other in uv the first in the file counts. */
bool symbol_surface_build(const SymbolPlace *place, Arena *arena, SymbolSurface *out,
                          Error *err);

/* The point of the surface that shows uv, its area_m2 0; false: none of its triangles does. */
bool symbol_surface_at(const SymbolSurface *surface, const double uv[2], SymbolPoint *out);
