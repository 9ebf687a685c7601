/* SPDX-License-Identifier: Apache-2.0 */
/* With d from the eye to the point and s from there to the source, both unit, and n the normal,
 * r = d - 2 (n.d) n is where the mirror turns the eye's ray. The point is where r lies along s:
 * where both of r's parts across s, along a and b, are 0. */
#include "mirror/image_point.h"

#include <math.h>

#define STEPS_MAX 16
#define DIFFERENCE 1e-5 /* of the weights, for derivatives */
#define ON_POINT 1e-9   /* radians, from r to s */
#define NEAR 1e-7       /* the same, that rounding may leave */
#define RIM 1e-6        /* of the weights: two triangles leave no gap between them */
#define FARTHEST 4.0    /* a start farther outside than that leads to no point inside */

typedef struct P3 {
    double x, y, z;
} P3;

typedef struct Solve {
    P3 corner[3], normal[3], from, source;
} Solve;

static P3 p3_of(Vec3 a)
{
    return (P3){(double)a.x, (double)a.y, (double)a.z};
}

static P3 along(P3 a, P3 b, double s)
{
    return (P3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static double dot(P3 a, P3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static P3 cross(P3 a, P3 b)
{
    return (P3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static P3 unit(P3 a)
{
    double length = sqrt(dot(a, a));
    return length > 0 ? along((P3){0, 0, 0}, a, 1 / length) : a;
}

static P3 weighted(const P3 p[3], double u, double v)
{
    return along(along(along((P3){0, 0, 0}, p[0], 1 - u - v), p[1], u), p[2], v);
}

/* r's parts across s; is_ahead: r points along s, not against it. */
static void off_source(const Solve *solve, double u, double v, double out[2], bool *is_ahead)
{
    P3 p = weighted(solve->corner, u, v), n = unit(weighted(solve->normal, u, v));
    P3 d = unit(along(p, solve->from, -1)), s = unit(along(solve->source, p, -1));
    P3 r = along(d, n, -2 * dot(n, d));
    P3 axis = fabs(s.x) < 0.6 ? (P3){1, 0, 0} : (P3){0, 1, 0};
    P3 a = unit(cross(s, axis)), b = cross(s, a);
    out[0] = dot(r, a);
    out[1] = dot(r, b);
    *is_ahead = dot(r, s) > 0;
}

/* The weights of where the line to the mirrored source meets the plane; false: both points are
 * not on one side. */
static bool start(const Solve *solve, double *u, double *v)
{
    P3     e1 = along(solve->corner[1], solve->corner[0], -1);
    P3     e2 = along(solve->corner[2], solve->corner[0], -1);
    P3     n = cross(e1, e2), to = along(solve->from, solve->corner[0], -1);
    double nn = dot(n, n), h = dot(n, to);
    double k = dot(n, along(solve->source, solve->corner[0], -1));
    if (!(nn > 0) || !(h * k > 0)) return false;
    P3 mirrored = along(solve->source, n, -2 * k / nn);
    P3 p = along(to, along(mirrored, solve->from, -1), h / (h + k));
    *u = dot(cross(p, e2), n) / nn;
    *v = dot(cross(e1, p), n) / nn;
    return fabs(*u - 1 / 3.0) < FARTHEST && fabs(*v - 1 / 3.0) < FARTHEST;
}

/* One of Newton's steps; false: the mirror does not turn there. */
static bool newton(const Solve *solve, const double f[2], double *u, double *v)
{
    double by_u[2], by_v[2];
    bool   is_ahead;
    off_source(solve, *u + DIFFERENCE, *v, by_u, &is_ahead);
    off_source(solve, *u, *v + DIFFERENCE, by_v, &is_ahead);
    for (int k = 0; k < 2; k++) {
        by_u[k] = (by_u[k] - f[k]) / DIFFERENCE;
        by_v[k] = (by_v[k] - f[k]) / DIFFERENCE;
    }
    double det = by_u[0] * by_v[1] - by_v[0] * by_u[1];
    if (!(fabs(det) > 1e-300)) return false;
    *u -= (by_v[1] * f[0] - by_v[0] * f[1]) / det;
    *v -= (by_u[0] * f[1] - by_u[1] * f[0]) / det;
    return fabs(*u - 1 / 3.0) < FARTHEST && fabs(*v - 1 / 3.0) < FARTHEST;
}

bool image_point_find(const MirrorTriangle *triangle, Vec3 from, Vec3 source, ImagePoint *out)
{
    Solve  solve = {.from = p3_of(from), .source = p3_of(source)};
    double u, v, f[2], off = INFINITY;
    bool   is_ahead = false;
    for (int k = 0; k < 3; k++) {
        solve.corner[k] = p3_of(triangle->position[k]);
        solve.normal[k] = unit(p3_of(triangle->normal[k]));
    }
    if (!start(&solve, &u, &v)) return false;
    for (int i = 0; i < STEPS_MAX; i++) {
        off_source(&solve, u, v, f, &is_ahead);
        off = sqrt(f[0] * f[0] + f[1] * f[1]);
        if (off < ON_POINT) break;
        if (!newton(&solve, f, &u, &v)) return false;
    }
    if (!(off < NEAR) || !is_ahead || u < -RIM || v < -RIM || u + v > 1 + RIM) return false;
    P3 p = weighted(solve.corner, u, v);
    *out = (ImagePoint){(float)u, (float)v, vec3((float)p.x, (float)p.y, (float)p.z)};
    return true;
}
