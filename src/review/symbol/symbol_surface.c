/* SPDX-License-Identifier: Apache-2.0 */
#include "review/symbol/symbol_surface.h"

#include <math.h>

#include "base/sampler.h"
#include "light/emission.h"

/* Rounding of interpolated coordinates: a point is still on a triangle that it misses by this
 * share of it, so that no seam between two is a gap. */
#define SEAM 1e-5

/* ---- triangles --------------------------------------------------------------------------- */

static const TextureSlot *content_slot(const Scene *scene, int display_id) {
    return &scene->displays[display_id].content;
}

/* False: all of its corners show points of one line. */
static bool set_up(const Scene *scene, const TextureSlot *slot, uint32_t triangle,
                   SymbolTriangle *out) {
    Vec2 a = slot_corner_uv(scene, slot, triangle, 0);
    Vec2 b = slot_corner_uv(scene, slot, triangle, 1);
    Vec2 c = slot_corner_uv(scene, slot, triangle, 2);
    double b_u = (double)b.x - (double)a.x, b_v = (double)b.y - (double)a.y;
    double c_u = (double)c.x - (double)a.x, c_v = (double)c.y - (double)a.y;
    double det = b_u * c_v - b_v * c_u;
    if (!(fabs(det) > 0)) return false;
    *out = (SymbolTriangle){triangle,
                            {(double)a.x, (double)a.y},
                            {{c_v / det, -c_u / det}, {-b_v / det, b_u / det}},
                            scene_triangle_m2(scene, triangle) / (0.5 * fabs(det))};
    return true;
}

/* Do the boxes of rectangle and triangle meet? */
static bool reaches(const Scene *scene, const TextureSlot *slot, uint32_t triangle,
                    const double uv[4]) {
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int k = 0; k < 3; k++) {
        Vec2 corner = slot_corner_uv(scene, slot, triangle, k);
        low[0] = fmin(low[0], (double)corner.x);
        low[1] = fmin(low[1], (double)corner.y);
        high[0] = fmax(high[0], (double)corner.x);
        high[1] = fmax(high[1], (double)corner.y);
    }
    return low[0] <= uv[2] + SEAM && high[0] >= uv[0] - SEAM && low[1] <= uv[3] + SEAM &&
           high[1] >= uv[1] - SEAM;
}

static void take_triangles(const SymbolPlace *place, Arena *arena, SymbolSurface *surface) {
    const Scene *scene = place->scene;
    const TextureSlot *slot = content_slot(scene, surface->display_id);
    uint32_t most = 0;
    int count = 0;
    for (int i = 0; i < place->display->part_count; i++)
        most += scene->parts[place->display->part_ids[i]].triangle_count;
    SymbolTriangle *triangles = ARENA_NEW(arena, SymbolTriangle, most);
    for (int i = 0; i < place->display->part_count; i++) {
        const Part *part = &scene->parts[place->display->part_ids[i]];
        for (uint32_t k = 0; k < part->triangle_count; k++)
            if (reaches(scene, slot, part->first_triangle + k, place->uv) &&
                set_up(scene, slot, part->first_triangle + k, &triangles[count]))
                count++;
    }
    surface->triangles = triangles;
    surface->triangle_count = count;
}

/* ---- points ------------------------------------------------------------------------------ */

/* The triangle that shows uv, and the weights of its vertices 1 and 2; NULL: none. */
static const SymbolTriangle *triangle_of(const SymbolSurface *surface, const double uv[2],
                                         double weight[2]) {
    for (int i = 0; i < surface->triangle_count; i++) {
        const SymbolTriangle *t = &surface->triangles[i];
        double du = uv[0] - t->corner[0], dv = uv[1] - t->corner[1];
        for (int k = 0; k < 2; k++) weight[k] = t->gradient[k][0] * du + t->gradient[k][1] * dv;
        if (weight[0] >= -SEAM && weight[1] >= -SEAM && weight[0] + weight[1] <= 1 + SEAM) return t;
    }
    return NULL;
}

static SymbolPoint point_on(const Scene *scene, const SymbolTriangle *t, const double uv[2],
                            const double weight[2]) {
    SymbolPoint out = {.triangle = t->triangle,
                       .u = (float)weight[0],
                       .v = (float)weight[1],
                       .uv = {(float)uv[0], (float)uv[1]}};
    TrianglePoint point = triangle_point(scene, t->triangle, out.u, out.v);
    out.position = point.position;
    out.ng = point.ng;
    out.ns = point.ns;
    return out;
}

bool symbol_surface_at(const SymbolSurface *surface, const double uv[2], SymbolPoint *out) {
    double weight[2];
    const SymbolTriangle *t = triangle_of(surface, uv, weight);
    if (t) *out = point_on(surface->scene, t, uv, weight);
    return t != NULL;
}

Vec3 symbol_point_start(const Scene *scene, const SymbolPoint *point) {
    TrianglePoint at = triangle_point(scene, point->triangle, point->u, point->v);
    return ray_start(&at, at.ng);
}

static bool no_surface(const double uv[2], Error *err) {
    return error_set(err, ERROR_INPUT,
                     "the symbol lies outside its display, no part of which shows uv "
                     "[%.4g, %.4g] of its content",
                     uv[0], uv[1]);
}

/* Hammersley: i + 1/2 over n, and the digits of i in base 2 behind the point, in the middle of
 * their interval. */
static void place_of(const SymbolSurface *surface, int i, double uv[2]) {
    double n = surface->point_count;
    double s = (i + 0.5) / n;
    double t = reverse_bits((uint32_t)i) * 0x1p-32 + 0.5 / n;
    const double *box = surface->uv;
    uv[0] = box[0] + (t < 1 ? t : 1) * (box[2] - box[0]);
    uv[1] = box[1] + s * (box[3] - box[1]);
}

static bool place_points(SymbolSurface *surface, Error *err) {
    const double *box = surface->uv;
    double share = (box[2] - box[0]) * (box[3] - box[1]) / surface->point_count;
    for (int i = 0; i < surface->point_count; i++) {
        double uv[2], weight[2];
        place_of(surface, i, uv);
        const SymbolTriangle *t = triangle_of(surface, uv, weight);
        if (!t) return no_surface(uv, err);
        surface->points[i] = point_on(surface->scene, t, uv, weight);
        surface->points[i].area_m2 = (float)(t->area_m2 * share);
        surface->area_m2 += (double)surface->points[i].area_m2;
    }
    return true;
}

/* Every cell of a grid of 2^n cells has one of 2^n points in Hammersley's order. */
bool symbol_patch_box(const SymbolSurface *surface, int point, double uv[4]) {
    const double *box = surface->uv;
    int columns = 1, count = surface->point_count;
    if (count & (count - 1)) return false;
    while (4 * columns * columns <= count) columns *= 2;
    double at[2], step[2] = {(box[2] - box[0]) / columns, (box[3] - box[1]) * columns / count};
    place_of(surface, point, at);
    uv[0] = box[0] + floor(fmin((at[0] - box[0]) / step[0], columns - 1)) * step[0];
    uv[1] = box[1] + floor((at[1] - box[1]) / step[1]) * step[1];
    uv[2] = uv[0] + step[0];
    uv[3] = uv[1] + step[1];
    return true;
}

SymbolPatch symbol_patch_of(const SymbolSurface *surface, const double uv[4], Vec3 middle) {
    SymbolPoint first, along, down;
    if (!symbol_surface_at(surface, (double[2]){uv[0], uv[1]}, &first) ||
        !symbol_surface_at(surface, (double[2]){uv[2], uv[1]}, &along) ||
        !symbol_surface_at(surface, (double[2]){uv[0], uv[3]}, &down))
        return (SymbolPatch){.middle = middle};
    return (SymbolPatch){vec3_scale(vec3_add(along.position, down.position), 0.5f),
                         vec3_sub(along.position, first.position),
                         vec3_sub(down.position, first.position)};
}

SymbolPatch symbol_patch(const SymbolSurface *surface, int point) {
    double uv[4];
    Vec3 middle = surface->points[point].position;
    if (!symbol_patch_box(surface, point, uv)) return (SymbolPatch){.middle = middle};
    return symbol_patch_of(surface, uv, middle);
}

static bool corners_are_there(const SymbolSurface *surface, Error *err) {
    for (int k = 0; k < 4; k++) {
        double uv[2] = {surface->uv[k & 1 ? 2 : 0], surface->uv[k & 2 ? 3 : 1]}, weight[2];
        if (!triangle_of(surface, uv, weight)) return no_surface(uv, err);
    }
    return true;
}

bool symbol_surface_build(const SymbolPlace *place, Arena *arena, SymbolSurface *out, Error *err) {
    SymbolSurface surface = {.scene = place->scene,
                             .display_id = place->display->display_id,
                             .point_count = place->point_count};
    for (int k = 0; k < 4; k++) surface.uv[k] = place->uv[k];
    take_triangles(place, arena, &surface);
    surface.points = ARENA_NEW(arena, SymbolPoint, place->point_count);
    if (!corners_are_there(&surface, err) || !place_points(&surface, err)) return false;
    *out = surface;
    return true;
}

bool symbol_surface_within(const SymbolSurface *of, const double uv[4], int point_count,
                           Arena *arena, SymbolSurface *out, Error *err) {
    SymbolSurface surface = *of;
    for (int k = 0; k < 4; k++) surface.uv[k] = uv[k];
    surface.point_count = point_count;
    surface.area_m2 = 0;
    surface.points = ARENA_NEW(arena, SymbolPoint, point_count);
    if (!place_points(&surface, err)) return false;
    *out = surface;
    return true;
}
