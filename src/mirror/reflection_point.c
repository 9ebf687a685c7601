/* SPDX-License-Identifier: Apache-2.0 */
/* With d from the lit point to the mirror, n its normal of any length and s towards the light,
 *
 *     F = (n.n) d - 2 (n.d) n
 *
 * is n.n times d mirrored at n, and a reflection is where F points along s: F.a = F.b = 0 for
 * a, b across s, and F.s > 0. Over a triangle d and n are linear in the barycentric weights, so
 * F is a cubic, whose ten Bernstein coefficients follow from the corners' d and n: for corners
 * i, j, k (i = j and so on allowed) by the blossom
 *
 *     C_ijk = 1/3 sum over the three ways to split {i, j, k} into a pair p, q and a rest r of
 *             (n_p.n_q) d_r - (n_p.d_q + n_q.d_p) n_r.
 *
 * Any smaller triangle in it, a patch, has corners and so coefficients of its own. Inside it F
 * is a weighted mean of them: where all have one sign there is no root (Farin, Curves and
 * Surfaces for CAGD, chapter 17). The derivative is such a mean of their differences; with P
 * the inverse of the derivative at the centre, q = max |P dF - 1| over the differences bounds
 * how far the patch is from linear. A small q means at most one root: it lies within q times
 * the patch of where the first of Newton's steps ends, and the steps, held in the patch, reach
 * it. Other patches are cut in four.
 *
 * Spread, with N the cross product of the edges and ' for derivatives by (u, v): the light's
 * direction is F / |F| with |F| = (n.n) |d|, so |ds'| = |det (F.a, F.b)'| / |F|^2, while the
 * point sees |dw'| = |N.d| / |d|^3. Their quotient is |N.d| (n.n)^2 / (|d| |det|).
 */
#include "mirror/reflection_point.h"

#include <stdint.h>

#include "mirror/d3.h"

#define DEPTH_MAX 20
#define NEARLY_LINEAR 0.25 /* with it a fresh derivative is one to two thirds, too */
#define STEPS_MAX 16
#define FARTHEST 0.75 /* corner from the centre, in u and v */
#define ON_ROOT 1e-9  /* of the patch: the last step's length */
#define BERNSTEIN 10
#define DIFFERENCES 6

typedef struct D2 {
    double a, b;
} D2;

/* Derivatives of F.a and F.b by u and v. */
typedef struct Slope {
    D2 by_u, by_v;
} Slope;

typedef struct PatchCorner {
    double u, v; /* in the whole triangle */
    D3 d, n;
} PatchCorner;

typedef struct Patch {
    PatchCorner corner[3];
} Patch;

typedef struct Search {
    D3 across[2], towards; /* a, b, s */
    Patch whole;
    ReflectionPoint *out;
    int count;
} Search;

static double determinant(const Slope *s) {
    return s->by_u.a * s->by_v.b - s->by_v.a * s->by_u.b;
}

/* (u, v) whose image under the slope is f. */
static D2 unsloped(const Slope *s, double det, D2 f) {
    return (D2){(s->by_v.b * f.a - s->by_v.a * f.b) / det,
                (s->by_u.a * f.b - s->by_u.b * f.a) / det};
}

/* ---- the map ---------------------------------------------------------------------------- */

static D3 interpolate(D3 a, D3 b, D3 c, double u, double v) {
    return d3_along(d3_along(a, d3_sub(b, a), u), d3_sub(c, a), v);
}

/* F.a and F.b, and the terms that they come from. */
typedef struct Value {
    D2 f;
    D3 d, n;
    double nn, nd;
} Value;

static Value value_at(const Search *search, const Patch *patch, double u, double v) {
    const PatchCorner *c = patch->corner;
    Value at = {.d = interpolate(c[0].d, c[1].d, c[2].d, u, v),
                .n = interpolate(c[0].n, c[1].n, c[2].n, u, v)};
    at.nn = d3_dot(at.n, at.n);
    at.nd = d3_dot(at.n, at.d);
    D3 f = d3_along((D3){at.nn * at.d.x, at.nn * at.d.y, at.nn * at.d.z}, at.n, -2 * at.nd);
    at.f = (D2){d3_dot(f, search->across[0]), d3_dot(f, search->across[1])};
    return at;
}

/* dF = 2 (n.n') d + (n.n) d' - 2 (n'.d + n.d') n - 2 (n.d) n' along one edge. */
static D2 derivative(const Search *search, const Value *at, D3 edge_d, D3 edge_n) {
    double shrink = 2 * d3_dot(at->n, edge_n);
    double turn = 2 * (d3_dot(edge_n, at->d) + d3_dot(at->n, edge_d));
    D3 f = {shrink * at->d.x, shrink * at->d.y, shrink * at->d.z};
    f = d3_along(d3_along(d3_along(f, edge_d, at->nn), at->n, -turn), edge_n, -2 * at->nd);
    return (D2){d3_dot(f, search->across[0]), d3_dot(f, search->across[1])};
}

static Slope slope_at(const Search *search, const Patch *patch, const Value *at) {
    const PatchCorner *c = patch->corner;
    return (Slope){derivative(search, at, d3_sub(c[1].d, c[0].d), d3_sub(c[1].n, c[0].n)),
                   derivative(search, at, d3_sub(c[2].d, c[0].d), d3_sub(c[2].n, c[0].n))};
}

/* ---- Bernstein coefficients -------------------------------------------------------------- */

enum { C000, C111, C222, C001, C011, C112, C122, C022, C002, C012 };

static void coefficients(const Search *search, const Patch *patch, D2 out[BERNSTEIN]) {
    static const uint8_t corners[BERNSTEIN][3] = {
        [C000] = {0, 0, 0}, [C111] = {1, 1, 1}, [C222] = {2, 2, 2}, [C001] = {0, 0, 1},
        [C011] = {0, 1, 1}, [C112] = {1, 1, 2}, [C122] = {1, 2, 2}, [C022] = {0, 2, 2},
        [C002] = {0, 0, 2}, [C012] = {0, 1, 2}};
    const PatchCorner *c = patch->corner;
    double nn[3][3], nd[3][3];
    D2 d[3], n[3];
    for (int i = 0; i < 3; i++) {
        d[i] = (D2){d3_dot(c[i].d, search->across[0]), d3_dot(c[i].d, search->across[1])};
        n[i] = (D2){d3_dot(c[i].n, search->across[0]), d3_dot(c[i].n, search->across[1])};
        for (int k = 0; k <= i; k++) {
            nn[i][k] = nn[k][i] = d3_dot(c[i].n, c[k].n) * (1.0 / 3);
            nd[i][k] = nd[k][i] = (d3_dot(c[i].n, c[k].d) + d3_dot(c[k].n, c[i].d)) * (1.0 / 3);
        }
    }
    for (int m = 0; m < BERNSTEIN; m++) {
        out[m] = (D2){0, 0};
        for (int rest = 0; rest < 3; rest++) {
            int p = corners[m][(rest + 1) % 3], q = corners[m][(rest + 2) % 3],
                r = corners[m][rest];
            out[m].a += nn[p][q] * d[r].a - nd[p][q] * n[r].a;
            out[m].b += nn[p][q] * d[r].b - nd[p][q] * n[r].b;
        }
    }
}

/* All of one sign in a or in b; or all zero: then the point lies on a focus, the whole patch
 * sends its light there, and no single point of it does. */
static bool has_no_root(const D2 c[BERNSTEIN], double size) {
    int above[2] = {0}, below[2] = {0}, something = 0;
    for (int m = 0; m < BERNSTEIN; m++) {
        above[0] += c[m].a > 0;
        above[1] += c[m].b > 0;
        below[0] += c[m].a < 0;
        below[1] += c[m].b < 0;
        something += c[m].a * c[m].a + c[m].b * c[m].b > size * size * 1e-20;
    }
    return above[0] == BERNSTEIN || above[1] == BERNSTEIN || below[0] == BERNSTEIN ||
           below[1] == BERNSTEIN || !something;
}

static D2 tripled_difference(D2 a, D2 b) {
    return (D2){3 * (a.a - b.a), 3 * (a.b - b.b)};
}

/* Coefficients of the derivative, which is quadratic. */
static void differences(const D2 c[BERNSTEIN], Slope out[DIFFERENCES]) {
    static const uint8_t by[DIFFERENCES][4] = {{C001, C000, C002, C000}, {C111, C011, C112, C011},
                                               {C122, C022, C222, C022}, {C011, C001, C012, C001},
                                               {C112, C012, C122, C012}, {C012, C002, C022, C002}};
    for (int i = 0; i < DIFFERENCES; i++)
        out[i] = (Slope){tripled_difference(c[by[i][0]], c[by[i][1]]),
                         tripled_difference(c[by[i][2]], c[by[i][3]])};
}

/* The greatest |P dF - 1|; infinite where there is no P. */
static double nonlinearity(const D2 c[BERNSTEIN], const Slope *centre) {
    Slope steps[DIFFERENCES];
    double det = determinant(centre), worst = 0;
    differences(c, steps);
    for (int i = 0; i < DIFFERENCES; i++) {
        D2 u = unsloped(centre, det, steps[i].by_u), v = unsloped(centre, det, steps[i].by_v);
        double off = (u.a - 1) * (u.a - 1) + u.b * u.b + v.a * v.a + (v.b - 1) * (v.b - 1);
        if (!(off < 1e6)) return INFINITY;
        worst = off > worst ? off : worst;
    }
    return sqrt(worst);
}

/* ---- roots ------------------------------------------------------------------------------ */

/* The nearest point of the patch. */
static void hold(double *u, double *v) {
    if (*u < 0) *u = 0;
    if (*v < 0) *v = 0;
    double over = 0.5 * (*u + *v - 1);
    if (!(over > 0)) return;
    *u -= over;
    *v -= over;
    if (*u < 0) *u = 0, *v = 1;
    if (*v < 0) *u = 1, *v = 0;
}

/* False: there is no root. */
static bool newton(const Search *search, const Patch *patch, double *u, double *v) {
    D2 step = {1, 1};
    for (int i = 0; i < STEPS_MAX && step.a * step.a + step.b * step.b > 1e-20; i++) {
        Value at = value_at(search, patch, *u, *v);
        Slope slope = slope_at(search, patch, &at);
        double was_u = *u, was_v = *v;
        step = unsloped(&slope, determinant(&slope), at.f);
        *u -= step.a;
        *v -= step.b;
        hold(u, v);
        if (*u == was_u && *v == was_v) break;
    }
    return step.a * step.a + step.b * step.b < ON_ROOT * ON_ROOT;
}

static void keep(Search *search, const Patch *patch, double u, double v) {
    const PatchCorner *c = patch->corner, *whole = search->whole.corner;
    double at_u = c[0].u + u * (c[1].u - c[0].u) + v * (c[2].u - c[0].u);
    double at_v = c[0].v + u * (c[1].v - c[0].v) + v * (c[2].v - c[0].v);
    Value at = value_at(search, &search->whole, at_u, at_v);
    Slope slope = slope_at(search, &search->whole, &at);
    D3 edges = d3_cross(d3_sub(whole[1].d, whole[0].d), d3_sub(whole[2].d, whole[0].d));
    double along =
        at.nn * d3_dot(at.d, search->towards) - 2 * at.nd * d3_dot(at.n, search->towards);
    double spread = fabs(d3_dot(edges, at.d)) * at.nn * at.nn /
                    (sqrt(d3_dot(at.d, at.d)) * fabs(determinant(&slope)));
    if (!(along > 0) || !(spread < 1e30) || search->count == REFLECTION_POINTS_MAX) return;
    search->out[search->count++] = (ReflectionPoint){(float)at_u, (float)at_v, (float)spread};
}

static PatchCorner middle(const PatchCorner *a, const PatchCorner *b) {
    return (PatchCorner){0.5 * (a->u + b->u), 0.5 * (a->v + b->v),
                         interpolate(a->d, b->d, a->d, 0.5, 0),
                         interpolate(a->n, b->n, a->n, 0.5, 0)};
}

static void search_patch(Search *search, const Patch *patch, int depth);

static void search_quarters(Search *search, const Patch *patch, int depth) {
    const PatchCorner *c = patch->corner;
    PatchCorner m[3] = {middle(&c[0], &c[1]), middle(&c[1], &c[2]), middle(&c[2], &c[0])};
    const Patch quarters[4] = {
        {{c[0], m[0], m[2]}}, {{m[0], c[1], m[1]}}, {{m[2], m[1], c[2]}}, {{m[1], m[2], m[0]}}};
    for (int i = 0; i < 4; i++) search_patch(search, &quarters[i], depth + 1);
}

static void search_patch(Search *search, const Patch *patch, int depth) {
    const double third = 1.0 / 3;
    D2 c[BERNSTEIN];
    Value centre = value_at(search, patch, third, third);
    coefficients(search, patch, c);
    if (has_no_root(c, centre.nn * sqrt(d3_dot(centre.d, centre.d)))) return;
    Slope slope = slope_at(search, patch, &centre);
    double q = nonlinearity(c, &slope);
    if (q > NEARLY_LINEAR) {
        if (depth < DEPTH_MAX) search_quarters(search, patch, depth);
        return;
    }
    D2 step = unsloped(&slope, determinant(&slope), centre.f);
    double u = third - step.a, v = third - step.b, reach = q * FARTHEST + ON_ROOT;
    if (u < -reach || v < -reach || u + v > 1 + 2 * reach) return;
    hold(&u, &v);
    if (newton(search, patch, &u, &v)) keep(search, patch, u, v);
}

int reflection_points_find(const MirrorTriangle *triangle, Vec3 from, Vec3 towards,
                           ReflectionPoint out[REFLECTION_POINTS_MAX]) {
    Frame frame = frame_from_z(towards);
    Search search = {{d3_of(frame.x), d3_of(frame.y)}, d3_of(towards), .out = out};
    D3 origin = d3_of(from);
    for (int i = 0; i < 3; i++)
        search.whole.corner[i] =
            (PatchCorner){i == 1, i == 2, d3_sub(d3_of(triangle->position[i]), origin),
                          d3_of(triangle->normal[i])};
    Patch whole = search.whole;
    search_patch(&search, &whole, 0);
    return search.count;
}

/* ---- rough mirrors ---------------------------------------------------------------------- */

static Frame reflection_frame(const MirrorTriangle *t) {
    return frame_from_z(
        vec3_normalize(vec3_add(vec3_add(t->normal[0], t->normal[1]), t->normal[2])));
}

MirrorTriangle reflection_leaning(const MirrorTriangle *triangle, Vec2 slope) {
    MirrorTriangle leaning = *triangle;
    Frame frame = reflection_frame(triangle);
    for (int i = 0; i < 3; i++)
        leaning.normal[i] =
            vec3_along(vec3_along(triangle->normal[i], frame.x, slope.x), frame.y, slope.y);
    return leaning;
}

/* The half vector h = s - w, w = d / |d|, from which slopes follow: g = h / h.z in the frame,
 * slope = n.z (g.x, g.y) - (n.x, n.y). */
typedef struct HalfWay {
    D3 x, y, z; /* the frame */
    D3 d, n, w, h;
    double distance;
} HalfWay;

/* dh = -(d' - w (w.d')) / |d|, dg = (dh - g dh.z) / h.z. */
static D2 slope_derivative(const HalfWay *at, D3 edge_d, D3 edge_n) {
    D3 none = {0, 0, 0}, dh = d3_along(edge_d, at->w, -d3_dot(at->w, edge_d));
    dh = d3_along(none, dh, -1 / at->distance);
    double hz = d3_dot(at->h, at->z), nz = d3_dot(at->n, at->z);
    double dhz = d3_dot(dh, at->z), dnz = d3_dot(edge_n, at->z);
    double gx = d3_dot(at->h, at->x) / hz, gy = d3_dot(at->h, at->y) / hz;
    return (D2){dnz * gx + nz * (d3_dot(dh, at->x) - gx * dhz) / hz - d3_dot(edge_n, at->x),
                dnz * gy + nz * (d3_dot(dh, at->y) - gy * dhz) / hz - d3_dot(edge_n, at->y)};
}

/* |dw'| / |slope'|, with |dw'| = |N.d| / |d|^3 as above. */
float reflection_slope_spread(const MirrorTriangle *triangle, Vec3 from, Vec3 towards,
                              const ReflectionPoint *at) {
    Frame frame = reflection_frame(triangle);
    D3 d[3], n[3];
    for (int i = 0; i < 3; i++) {
        d[i] = d3_sub(d3_of(triangle->position[i]), d3_of(from));
        n[i] = d3_of(triangle->normal[i]);
    }
    double u = (double)at->u, v = (double)at->v;
    HalfWay half = {.x = d3_of(frame.x),
                    .y = d3_of(frame.y),
                    .z = d3_of(frame.z),
                    .d = interpolate(d[0], d[1], d[2], u, v),
                    .n = interpolate(n[0], n[1], n[2], u, v)};
    half.distance = sqrt(d3_dot(half.d, half.d));
    half.w = d3_along((D3){0, 0, 0}, half.d, 1 / half.distance);
    half.h = d3_sub(d3_of(towards), half.w);
    Slope slope = {slope_derivative(&half, d3_sub(d[1], d[0]), d3_sub(n[1], n[0])),
                   slope_derivative(&half, d3_sub(d[2], d[0]), d3_sub(n[2], n[0]))};
    D3 edges = d3_cross(d3_sub(d[1], d[0]), d3_sub(d[2], d[0]));
    double solid = fabs(d3_dot(edges, half.d)) / (half.distance * half.distance * half.distance);
    return (float)(solid / fabs(determinant(&slope)));
}
