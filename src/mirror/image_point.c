/* SPDX-License-Identifier: Apache-2.0 */
/* With d from the eye to the point and s from there to the source, both unit, and n the normal,
 * r = d - 2 (n.d) n is where the mirror turns the eye's ray. The point is where r lies along s:
 * where both of r's parts across s, along a and b, are 0. */
#include "mirror/image_point.h"

#include <math.h>

#include "mirror/d3.h"

#define STEPS_MAX 16
#define DIFFERENCE 1e-5 /* of the weights, for derivatives */
#define ON_POINT 1e-9   /* radians, from r to s */
#define NEAR 1e-7       /* the same, that rounding may leave */
#define RIM 1e-6        /* of the weights: two triangles leave no gap between them */
#define FARTHEST 4.0    /* a start farther outside than that leads to no point inside */

typedef struct Solve {
    D3 corner[3], normal[3], from, source;
} Solve;

static D3 unit(D3 a) {
    double length = sqrt(d3_dot(a, a));
    return length > 0 ? d3_along((D3){0, 0, 0}, a, 1 / length) : a;
}

static D3 weighted(const D3 p[3], double u, double v) {
    return d3_along(d3_along(d3_along((D3){0, 0, 0}, p[0], 1 - u - v), p[1], u), p[2], v);
}

/* r's parts across s; is_ahead: r points along s, not against it. */
static void off_source(const Solve *solve, double u, double v, double out[2], bool *is_ahead) {
    D3 p = weighted(solve->corner, u, v), n = unit(weighted(solve->normal, u, v));
    D3 d = unit(d3_along(p, solve->from, -1)), s = unit(d3_along(solve->source, p, -1));
    D3 r = d3_along(d, n, -2 * d3_dot(n, d));
    D3 axis = fabs(s.x) < 0.6 ? (D3){1, 0, 0} : (D3){0, 1, 0};
    D3 a = unit(d3_cross(s, axis)), b = d3_cross(s, a);
    out[0] = d3_dot(r, a);
    out[1] = d3_dot(r, b);
    *is_ahead = d3_dot(r, s) > 0;
}

/* The weights of where the line to the mirrored source meets the plane; false: both points are
 * not on one side. */
static bool start(const Solve *solve, double *u, double *v) {
    D3 e1 = d3_along(solve->corner[1], solve->corner[0], -1);
    D3 e2 = d3_along(solve->corner[2], solve->corner[0], -1);
    D3 n = d3_cross(e1, e2), to = d3_along(solve->from, solve->corner[0], -1);
    double nn = d3_dot(n, n), h = d3_dot(n, to);
    double k = d3_dot(n, d3_along(solve->source, solve->corner[0], -1));
    if (!(nn > 0) || !(h * k > 0)) return false;
    D3 mirrored = d3_along(solve->source, n, -2 * k / nn);
    D3 p = d3_along(to, d3_along(mirrored, solve->from, -1), h / (h + k));
    *u = d3_dot(d3_cross(p, e2), n) / nn;
    *v = d3_dot(d3_cross(e1, p), n) / nn;
    return fabs(*u - 1 / 3.0) < FARTHEST && fabs(*v - 1 / 3.0) < FARTHEST;
}

/* One of Newton's steps; false: the mirror does not turn there. */
static bool newton(const Solve *solve, const double f[2], double *u, double *v) {
    double by_u[2], by_v[2];
    bool is_ahead;
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

bool image_point_find(const MirrorTriangle *triangle, Vec3 from, Vec3 source, ImagePoint *out) {
    Solve solve = {.from = d3_of(from), .source = d3_of(source)};
    double u, v, f[2], off = INFINITY;
    bool is_ahead = false;
    for (int k = 0; k < 3; k++) {
        solve.corner[k] = d3_of(triangle->position[k]);
        solve.normal[k] = unit(d3_of(triangle->normal[k]));
    }
    if (!start(&solve, &u, &v)) return false;
    for (int i = 0; i < STEPS_MAX; i++) {
        off_source(&solve, u, v, f, &is_ahead);
        off = sqrt(f[0] * f[0] + f[1] * f[1]);
        if (off < ON_POINT) break;
        if (!newton(&solve, f, &u, &v)) return false;
    }
    if (!(off < NEAR) || !is_ahead || u < -RIM || v < -RIM || u + v > 1 + RIM) return false;
    D3 p = weighted(solve.corner, u, v);
    *out = (ImagePoint){(float)u, (float)v, vec3((float)p.x, (float)p.y, (float)p.z)};
    return true;
}
