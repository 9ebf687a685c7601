/* SPDX-License-Identifier: Apache-2.0 */
#include "hemisphere/geodesic.h"

typedef struct DVec3 {
    double x, y, z;
} DVec3;

/* Corners in double precision: areas need it. */
typedef struct DTriangle {
    DVec3 corner[3];
} DTriangle;

static DVec3 dvec3_from(Vec3 v) {
    return (DVec3){(double)v.x, (double)v.y, (double)v.z};
}

static Vec3 vec3_from(DVec3 v) {
    return vec3((float)v.x, (float)v.y, (float)v.z);
}

static DVec3 dvec3_sub(DVec3 a, DVec3 b) {
    return (DVec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static double dvec3_dot(DVec3 a, DVec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static DVec3 dvec3_cross(DVec3 a, DVec3 b) {
    return (DVec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static DVec3 dvec3_normalize(DVec3 a) {
    double scale = 1 / sqrt(dvec3_dot(a, a));
    return (DVec3){a.x * scale, a.y * scale, a.z * scale};
}

static DVec3 midpoint(DVec3 a, DVec3 b) {
    return dvec3_normalize((DVec3){a.x + b.x, a.y + b.y, a.z + b.z});
}

/* atan t for t >= 0 from arithmetic and square roots alone, so that tables are the same bits
 * on every machine: three half-angle steps atan t = 2 atan(t / (1 + sqrt(1 + t^2))) bring t
 * below 0.099 (for t <= 1), then Taylor's series, relative error below 1e-16. */
static double arctangent(double t) {
    if (t > 1) return 1.5707963267948966 - arctangent(1 / t);
    for (int i = 0; i < 3; i++) t = t / (1 + sqrt(1 + t * t));
    double t2 = t * t, sum = 0;
    for (int n = 15; n >= 1; n -= 2) sum = 1.0 / n - t2 * sum;
    return 8 * t * sum;
}

/* tan(E/2) = det(a, b, c) / (1 + a.b + b.c + c.a) (Eriksson 1990, "On the Measure of Solid
 * Angles"), the determinant from edge vectors, which keeps its digits in small triangles. */
static double triangle_area(const DTriangle *t) {
    DVec3 a = t->corner[0], b = t->corner[1], c = t->corner[2];
    double det = fabs(dvec3_dot(a, dvec3_cross(dvec3_sub(b, a), dvec3_sub(c, a))));
    double sum = 1 + dvec3_dot(a, b) + dvec3_dot(b, c) + dvec3_dot(c, a);
    if (sum > 0) return 2 * arctangent(det / sum);
    return det > 0 ? 2 * (1.5707963267948966 + arctangent(-sum / det)) : 0;
}

static DTriangle octant_triangle(uint32_t octant) {
    double x = octant & 1 ? -1 : 1, y = octant & 2 ? -1 : 1;
    return (DTriangle){{{x, 0, 0}, {0, y, 0}, {0, 0, 1}}};
}

static DTriangle child_triangle(const DTriangle *t, uint32_t child) {
    DTriangle middle = {{midpoint(t->corner[1], t->corner[2]), midpoint(t->corner[2], t->corner[0]),
                         midpoint(t->corner[0], t->corner[1])}};
    if (child == 0) return middle;
    DVec3 kept = t->corner[child - 1];
    if (child == 1) return (DTriangle){{kept, middle.corner[2], middle.corner[1]}};
    if (child == 2) return (DTriangle){{middle.corner[2], kept, middle.corner[0]}};
    return (DTriangle){{middle.corner[1], middle.corner[0], kept}};
}

static DTriangle triangle_of(int level, uint32_t id) {
    DTriangle triangle = octant_triangle(id >> 2 * level & 3);
    for (int i = level - 1; i >= 0; i--) triangle = child_triangle(&triangle, id >> 2 * i & 3);
    return triangle;
}

/* Where geodesic_create writes. */
typedef struct Tables {
    int level;
    GeodesicEdges *edges[GEODESIC_MAX_LEVEL + 1];
    GeodesicRatios *ratios[GEODESIC_MAX_LEVEL + 1];
    float *areas[GEODESIC_MAX_LEVEL + 1];
} Tables;

static float half_edge_cos(DVec3 a, DVec3 b) {
    DVec3 sum = {a.x + b.x, a.y + b.y, a.z + b.z};
    return (float)(0.5 * sqrt(dvec3_dot(sum, sum)));
}

static void fill_tables(const Tables *tables, int level, uint32_t id, const DTriangle *t) {
    tables->areas[level][id] = (float)triangle_area(t);
    if (level == tables->level) return;
    double area[4];
    for (uint32_t i = 0; i < 4; i++) {
        DTriangle child = child_triangle(t, i);
        area[i] = triangle_area(&child);
        fill_tables(tables, level + 1, 4 * id + i, &child);
    }
    for (int i = 0; i < 4; i++) tables->ratios[level][id].of_child[i] = (float)(area[i] / area[0]);
    for (int i = 0; i < 3; i++)
        tables->edges[level][id].half_cos[i] =
            half_edge_cos(t->corner[(i + 1) % 3], t->corner[(i + 2) % 3]);
}

const Geodesic *geodesic_create(int level, Arena *arena) {
    Geodesic *geodesic = ARENA_NEW(arena, Geodesic, 1);
    Tables tables = {.level = level};
    geodesic->level = level;
    for (int i = 0; i <= level; i++) {
        uint32_t count = 1u << 2 * i;
        geodesic->areas[i] = tables.areas[i] = ARENA_NEW(arena, float, count);
        if (i == level) break;
        geodesic->edges[i] = tables.edges[i] = ARENA_NEW(arena, GeodesicEdges, count);
        geodesic->ratios[i] = tables.ratios[i] = ARENA_NEW(arena, GeodesicRatios, count);
    }
    DTriangle octant = octant_triangle(0);
    fill_tables(&tables, 0, 0, &octant);
    return geodesic;
}

GeodesicPoint geodesic_find(const Geodesic *geodesic, int level, Vec3 direction) {
    GeodesicWalk walk = geodesic_walk_start(direction);
    for (int i = 0; i < level; i++) geodesic_walk_down(geodesic, i, &walk);
    return geodesic_walk_point(&walk, level);
}

GeodesicTriangle geodesic_triangle(int level, uint32_t id) {
    DTriangle t = triangle_of(level, id);
    return (GeodesicTriangle){
        {vec3_from(t.corner[0]), vec3_from(t.corner[1]), vec3_from(t.corner[2])}};
}

Vec3 geodesic_center(int level, uint32_t id) {
    DTriangle t = triangle_of(level, id);
    DVec3 sum = {0, 0, 0};
    for (int i = 0; i < 3; i++) {
        sum.x += t.corner[i].x;
        sum.y += t.corner[i].y;
        sum.z += t.corner[i].z;
    }
    return vec3_from(dvec3_normalize(sum));
}

double geodesic_area(int level, uint32_t id) {
    DTriangle t = triangle_of(level, id);
    return triangle_area(&t);
}

static double *fill_areas(const DTriangle *t, int levels_left, double *next) {
    if (levels_left == 0) {
        *next = triangle_area(t);
        return next + 1;
    }
    for (uint32_t i = 0; i < 4; i++) {
        DTriangle child = child_triangle(t, i);
        next = fill_areas(&child, levels_left - 1, next);
    }
    return next;
}

void geodesic_areas(int level, double *areas) {
    DTriangle octant = octant_triangle(0);
    fill_areas(&octant, level, areas);
}

uint32_t geodesic_neighbour(int level, uint32_t id, int corner) {
    uint32_t across = (uint32_t)corner + 1; /* the corner child that touches no such edge */
    for (int i = 0; i < level; i++) {
        uint32_t digit = id >> 2 * i & 3, place = 3u << 2 * i;
        if (digit == 0) return (id & ~place) | across << 2 * i;
        if (digit == across) return id & ~place;
        id = (id & ~place) | (6 - digit - across) << 2 * i; /* the two others change places */
    }
    return GEODESIC_NONE;
}

/* tan x for 0 <= x <= pi/4, relative error below 2e-7: Taylor's sine over cosine. */
static float tangent(float x) {
    float x2 = x * x;
    float s = x * (1 + x2 * (-1 / 6.f + x2 * (1 / 120.f + x2 * (-1 / 5040.f + x2 / 362880.f))));
    float c = 1 + x2 * (-.5f + x2 * (1 / 24.f + x2 * (-1 / 720.f + x2 / 40320.f)));
    return s / c;
}

/* Triangle (a, b, c) of area E. First the point c' on the arc from a to c that cuts off a
 * triangle (a, b, c') of area u0 E. With e the unit vector across a towards c, c' at the angle
 * phi from a and t = tan(phi/2), Eriksson's formula for (a, b, c') is
 *   tan(u0 E / 2) = t det(a, b, e) / ((1 + a.b) + t b.e),
 * which is linear in t. Then the point on the arc from b to c' whose 1 - cosine to b is the
 * part u1 of that of c' (Arvo's second step). All vectors are differences from a or b. */
GeodesicSampler geodesic_sampler(const GeodesicTriangle *triangle, float area) {
    Vec3 a = triangle->corner[0], b = triangle->corner[1];
    Vec3 ab = vec3_sub(b, a), ac = vec3_sub(triangle->corner[2], a);
    Vec3 e = vec3_normalize(vec3_along(ac, a, 0.5f * vec3_dot(ac, ac)));
    return (GeodesicSampler){.a = a,
                             .b = b,
                             .across = e,
                             .area = area,
                             .volume = fabsf(vec3_dot(a, vec3_cross(ab, e))),
                             .span = 2 - 0.5f * vec3_dot(ab, ab),
                             .lean = vec3_dot(ab, e)};
}

Vec3 geodesic_sampler_draw(const GeodesicSampler *s, float u0, float u1) {
    float tan_half = tangent(0.5f * u0 * s->area);
    float t = tan_half * s->span / (s->volume - tan_half * s->lean);
    float scale = 2 * t / (1 + t * t);
    Vec3 cut = vec3_along(vec3_scale(s->across, scale), s->a, -t * scale); /* c' - a */
    Vec3 arc = vec3_sub(cut, vec3_sub(s->b, s->a));                        /* c' - b */
    float height = 0.5f * vec3_dot(arc, arc);                              /* 1 - c'.b */
    Vec3 across = vec3_normalize(vec3_along(arc, s->b, height));
    float drop = u1 * height;
    Vec3 p = vec3_along(vec3_scale(across, sqrtf(drop * (2 - drop))), s->b, 1 - drop);
    return vec3_normalize(p);
}

Vec2 geodesic_invert_triangle(const GeodesicTriangle *triangle, float area, Vec3 direction) {
    DVec3 a = dvec3_from(triangle->corner[0]), b = dvec3_from(triangle->corner[1]);
    DVec3 c = dvec3_from(triangle->corner[2]), p = dvec3_from(direction);
    DVec3 cut = dvec3_cross(dvec3_cross(b, dvec3_sub(p, b)), dvec3_cross(a, dvec3_sub(c, a)));
    if (dvec3_dot(cut, cut) == 0) return (Vec2){0, 0}; /* p is b */
    cut = dvec3_normalize(cut);
    if (dvec3_dot(cut, a) + dvec3_dot(cut, c) < 0) cut = (DVec3){-cut.x, -cut.y, -cut.z};
    DTriangle part = {{a, b, cut}};
    DVec3 to_p = dvec3_sub(p, b), to_cut = dvec3_sub(cut, b);
    return (Vec2){(float)(triangle_area(&part) / (double)area),
                  (float)(dvec3_dot(to_p, to_p) / dvec3_dot(to_cut, to_cut))};
}
