/* SPDX-License-Identifier: Apache-2.0 */
/* With d from the lit point to the mirror, n its normal of any length and e towards the light,
 *
 *     F = (n.n) d - 2 (n.d) n
 *
 * is n.n times d mirrored at n, and a reflection is where F points along e. Let c be the mean of
 * the unit vectors along e and a, b across it: then it is where G = (F.(e x a), F.(e x b)) is 0,
 * e.c > 0 and F.e > 0. Of a light far away e is c everywhere, and G is F's parts along b and a.
 * Over a triangle d, n and e are linear in the barycentric weights, so F is a cubic and G, where
 * the light is near, a quartic. F's ten Bernstein coefficients follow from the corners' d and n:
 * for corners i, j, k (i = j and so on allowed) by the blossom
 *
 *     C_ijk = 1/3 sum over the three ways to split {i, j, k} into a pair p, q and a rest r of
 *             (n_p.n_q) d_r - (n_p.d_q + n_q.d_p) n_r,
 *
 * and G's fifteen likewise: the mean over the four ways to take e from one corner and C from the
 * other three.
 *
 * Any smaller triangle in it, a patch, has corners and so coefficients of its own. Inside it G
 * is a weighted mean of them: where all have one sign there is no root (Farin, Curves and
 * Surfaces for CAGD, chapter 17). The derivative is such a mean of their differences; with P
 * the inverse of the derivative at the centre, q = max |P dG - 1| over the differences bounds
 * how far the patch is from linear. A small q means at most one root: it lies within q times
 * the patch of where the first of Newton's steps ends, and the steps, held in the patch, reach
 * it. Other patches are cut in four.
 *
 * Spread, with N the cross product of the edges and ' for derivatives by (u, v). Far away, the
 * light's direction is F / |F| with |F| = (n.n) |d|, so |ds'| = |det G'| / |F|^2, while the
 * point sees |dw'| = |N.d| / |d|^3. Their quotient is |N.d| (n.n)^2 / (|d| |det|).
 * Near: a step dx of the lit point across d changes F by -(n.n) times dx mirrored, and so G by
 * an area (n.n)^2 |e| (e.c) a unit area; the light sees |N.e| / |e|^3. So a source of one
 * candela makes |N.e| (n.n)^2 (e.c) / (|e|^2 |det|) lux there. */
#include "mirror/reflection_point.h"

#include <stdint.h>

#include "mirror/d3.h"

#define DEPTH_MAX 20
#define NEARLY_LINEAR 0.25 /* with it a fresh derivative is one to two thirds, too */
#define STEPS_MAX 16
#define FARTHEST 0.75 /* corner from the centre, in u and v */
#define ON_ROOT 1e-9  /* of the patch: the last step's length */
#define ALONG \
    (1 - 1e-9)          /* cosine between F and e at a root; G is 0, too, where e lies across c \
                         */
#define NO_NORMAL 1e-10 /* squared, of the corners': opposite ones leave none there */
#define CUBIC 10        /* coefficients over a triangle */
#define QUARTIC 15

typedef struct D2 {
    double a, b;
} D2;

/* Derivatives of F.a and F.b by u and v. */
typedef struct Slope {
    D2 by_u, by_v;
} Slope;

typedef struct PatchCorner {
    double u, v; /* in the whole triangle */
    D3 d, n, e;
} PatchCorner;

typedef struct Patch {
    PatchCorner corner[3];
} Patch;

typedef struct Search {
    bool is_near;
    D3 across[2], towards; /* a, b, c */
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

/* G, and the terms that it comes from. */
typedef struct Value {
    D2 g;
    D3 d, n, e, f;
    double nn, nd;
} Value;

/* f along the two axes that `along`, e or its derivative, has across the light. */
static D2 across(const Search *search, D3 f, D3 along) {
    if (!search->is_near) return (D2){d3_dot(f, search->across[0]), d3_dot(f, search->across[1])};
    return (D2){d3_dot(f, d3_cross(along, search->across[0])),
                d3_dot(f, d3_cross(along, search->across[1]))};
}

static Value value_at(const Search *search, const Patch *patch, double u, double v) {
    const PatchCorner *c = patch->corner;
    Value at = {.d = interpolate(c[0].d, c[1].d, c[2].d, u, v),
                .n = interpolate(c[0].n, c[1].n, c[2].n, u, v),
                .e = interpolate(c[0].e, c[1].e, c[2].e, u, v)};
    at.nn = d3_dot(at.n, at.n);
    at.nd = d3_dot(at.n, at.d);
    at.f = d3_along((D3){at.nn * at.d.x, at.nn * at.d.y, at.nn * at.d.z}, at.n, -2 * at.nd);
    at.g = across(search, at.f, at.e);
    return at;
}

/* dF = 2 (n.n') d + (n.n) d' - 2 (n'.d + n.d') n - 2 (n.d) n' along the edge between corners
 * 0 and k, and G's from it. */
static D2 derivative(const Search *search, const Patch *patch, const Value *at, int k) {
    const PatchCorner *from = &patch->corner[0], *to = &patch->corner[k];
    D3 edge_d = d3_sub(to->d, from->d), edge_n = d3_sub(to->n, from->n);
    double shrink = 2 * d3_dot(at->n, edge_n);
    double turn = 2 * (d3_dot(edge_n, at->d) + d3_dot(at->n, edge_d));
    D3 f = {shrink * at->d.x, shrink * at->d.y, shrink * at->d.z};
    f = d3_along(d3_along(d3_along(f, edge_d, at->nn), at->n, -turn), edge_n, -2 * at->nd);
    D2 g = across(search, f, at->e);
    if (!search->is_near) return g;
    D2 by_light = across(search, at->f, d3_sub(to->e, from->e));
    return (D2){g.a + by_light.a, g.b + by_light.b};
}

static Slope slope_at(const Search *search, const Patch *patch, const Value *at) {
    return (Slope){derivative(search, patch, at, 1), derivative(search, patch, at, 2)};
}

/* ---- Bernstein coefficients --------------------------------------------------------------
 *
 * That of so many times corners 0, 1 and 2 stands at place_of. */

static int place_of(int ones, int twos) {
    return (ones + twos) * (ones + twos + 1) / 2 + twos;
}

/* Of each coefficient its corners, three of a cubic, four of a quartic. */
static const uint8_t CORNERS3[CUBIC][3] = {{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {0, 1, 1}, {0, 1, 2},
                                           {0, 2, 2}, {1, 1, 1}, {1, 1, 2}, {1, 2, 2}, {2, 2, 2}};
static const uint8_t CORNERS4[QUARTIC][4] = {{0, 0, 0, 0}, {0, 0, 0, 1}, {0, 0, 0, 2}, {0, 0, 1, 1},
                                             {0, 0, 1, 2}, {0, 0, 2, 2}, {0, 1, 1, 1}, {0, 1, 1, 2},
                                             {0, 1, 2, 2}, {0, 2, 2, 2}, {1, 1, 1, 1}, {1, 1, 1, 2},
                                             {1, 1, 2, 2}, {1, 2, 2, 2}, {2, 2, 2, 2}};

/* weights[i]: of d of corner i, of n of corner i; F's coefficients are sums of these. */
typedef struct CubicTerms {
    double nn[3][3], nd[3][3];
} CubicTerms;

static CubicTerms cubic_terms(const PatchCorner *c) {
    CubicTerms t;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k <= i; k++) {
            t.nn[i][k] = t.nn[k][i] = d3_dot(c[i].n, c[k].n) * (1.0 / 3);
            t.nd[i][k] = t.nd[k][i] = (d3_dot(c[i].n, c[k].d) + d3_dot(c[k].n, c[i].d)) * (1.0 / 3);
        }
    return t;
}

/* G of a light far away: F's parts across it. */
static int far_coefficients(const Search *search, const PatchCorner *c, D2 *out) {
    CubicTerms t = cubic_terms(c);
    D2 d[3], n[3];
    for (int i = 0; i < 3; i++) {
        d[i] = across(search, c[i].d, c[i].e);
        n[i] = across(search, c[i].n, c[i].e);
    }
    for (int m = 0; m < CUBIC; m++) {
        out[m] = (D2){0, 0};
        for (int rest = 0; rest < 3; rest++) {
            int p = CORNERS3[m][(rest + 1) % 3], q = CORNERS3[m][(rest + 2) % 3];
            int r = CORNERS3[m][rest];
            out[m].a += t.nn[p][q] * d[r].a - t.nd[p][q] * n[r].a;
            out[m].b += t.nn[p][q] * d[r].b - t.nd[p][q] * n[r].b;
        }
    }
    return CUBIC;
}

static int near_coefficients(const Search *search, const PatchCorner *c, D2 *out) {
    CubicTerms t = cubic_terms(c);
    D3 f[CUBIC], a[3], b[3];
    for (int m = 0; m < CUBIC; m++) {
        f[m] = (D3){0, 0, 0};
        for (int rest = 0; rest < 3; rest++) {
            int p = CORNERS3[m][(rest + 1) % 3], q = CORNERS3[m][(rest + 2) % 3];
            int r = CORNERS3[m][rest];
            f[m] = d3_along(d3_along(f[m], c[r].d, t.nn[p][q]), c[r].n, -t.nd[p][q]);
        }
    }
    for (int i = 0; i < 3; i++) {
        a[i] = d3_cross(c[i].e, search->across[0]);
        b[i] = d3_cross(c[i].e, search->across[1]);
    }
    for (int m = 0; m < QUARTIC; m++) {
        out[m] = (D2){0, 0};
        for (int k = 0; k < 4; k++) {
            int taken = CORNERS4[m][k], ones = 0, twos = 0;
            for (int i = 0; i < 4; i++) {
                ones += i != k && CORNERS4[m][i] == 1;
                twos += i != k && CORNERS4[m][i] == 2;
            }
            const D3 *left = &f[place_of(ones, twos)];
            out[m].a += 0.25 * d3_dot(*left, a[taken]);
            out[m].b += 0.25 * d3_dot(*left, b[taken]);
        }
    }
    return QUARTIC;
}

/* All of one sign in a or in b; or all zero: then the point lies on a focus, the whole patch
 * sends its light there, and no single point of it does. */
static bool has_no_root(const D2 *c, int count, double size) {
    int above[2] = {0}, below[2] = {0}, something = 0;
    for (int m = 0; m < count; m++) {
        above[0] += c[m].a > 0;
        above[1] += c[m].b > 0;
        below[0] += c[m].a < 0;
        below[1] += c[m].b < 0;
        something += c[m].a * c[m].a + c[m].b * c[m].b > size * size * 1e-20;
    }
    return above[0] == count || above[1] == count || below[0] == count || below[1] == count ||
           !something;
}

static D2 times_difference(int degree, D2 a, D2 b) {
    return (D2){degree * (a.a - b.a), degree * (a.b - b.b)};
}

/* The greatest |P dG - 1| over the derivative's coefficients, G's differences; infinite where
 * there is no P. */
static double nonlinearity(const D2 *c, int count, const Slope *centre) {
    int degree = count == CUBIC ? 3 : 4;
    double det = determinant(centre), worst = 0;
    for (int ones = 0; ones < degree; ones++)
        for (int twos = 0; ones + twos < degree; twos++) {
            D2 here = c[place_of(ones, twos)];
            D2 by_u = times_difference(degree, c[place_of(ones + 1, twos)], here);
            D2 by_v = times_difference(degree, c[place_of(ones, twos + 1)], here);
            D2 u = unsloped(centre, det, by_u), v = unsloped(centre, det, by_v);
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
        step = unsloped(&slope, determinant(&slope), at.g);
        *u -= step.a;
        *v -= step.b;
        hold(u, v);
        if (*u == was_u && *v == was_v) break;
    }
    return step.a * step.a + step.b * step.b < ON_ROOT * ON_ROOT;
}

static double length(D3 a) {
    return sqrt(d3_dot(a, a));
}

/* At a point of the whole triangle. */
static double spread_at(const Search *search, const Value *at) {
    const PatchCorner *whole = search->whole.corner;
    Slope slope = slope_at(search, &search->whole, at);
    D3 edges = d3_cross(d3_sub(whole[1].d, whole[0].d), d3_sub(whole[2].d, whole[0].d));
    double det = fabs(determinant(&slope)), ahead = fabs(d3_dot(at->e, search->towards));
    if (search->is_near)
        return fabs(d3_dot(edges, at->e)) * at->nn * at->nn * ahead / (d3_dot(at->e, at->e) * det);
    return fabs(d3_dot(edges, at->d)) * at->nn * at->nn / (length(at->d) * det);
}

static void keep(Search *search, const Patch *patch, double u, double v) {
    const PatchCorner *c = patch->corner, *whole = search->whole.corner;
    double at_u = c[0].u + u * (c[1].u - c[0].u) + v * (c[2].u - c[0].u);
    double at_v = c[0].v + u * (c[1].v - c[0].v) + v * (c[2].v - c[0].v);
    Value at = value_at(search, &search->whole, at_u, at_v);
    double spread = spread_at(search, &at);
    if (!(at.nn > NO_NORMAL * d3_dot(whole[0].n, whole[0].n)) ||
        !(d3_dot(at.f, at.e) > ALONG * length(at.f) * length(at.e)) || !(spread < 1e30) ||
        search->count == REFLECTION_POINTS_MAX)
        return;
    search->out[search->count++] = (ReflectionPoint){(float)at_u, (float)at_v, (float)spread};
}

static PatchCorner middle(const PatchCorner *a, const PatchCorner *b) {
    return (PatchCorner){
        0.5 * (a->u + b->u), 0.5 * (a->v + b->v), interpolate(a->d, b->d, a->d, 0.5, 0),
        interpolate(a->n, b->n, a->n, 0.5, 0), interpolate(a->e, b->e, a->e, 0.5, 0)};
}

static void search_patch(Search *search, const Patch *patch, int depth);

static void search_quarters(Search *search, const Patch *patch, int depth) {
    const PatchCorner *c = patch->corner;
    PatchCorner m[3] = {middle(&c[0], &c[1]), middle(&c[1], &c[2]), middle(&c[2], &c[0])};
    const Patch quarters[4] = {
        {{c[0], m[0], m[2]}}, {{m[0], c[1], m[1]}}, {{m[2], m[1], c[2]}}, {{m[1], m[2], m[0]}}};
    for (int i = 0; i < 4; i++) search_patch(search, &quarters[i], depth + 1);
}

/* The axes follow the patch: the light's direction may turn by much over a large triangle. */
static void set_axes(Search *search, const Patch *patch) {
    D3 c = {0, 0, 0};
    for (int i = 0; i < 3; i++) c = d3_along(c, patch->corner[i].e, 1 / length(patch->corner[i].e));
    Frame frame = frame_from_z(vec3_normalize(vec3((float)c.x, (float)c.y, (float)c.z)));
    search->across[0] = d3_of(frame.x);
    search->across[1] = d3_of(frame.y);
    search->towards = d3_of(frame.z);
}

static void search_patch(Search *search, const Patch *patch, int depth) {
    const double third = 1.0 / 3;
    D2 c[QUARTIC];
    if (search->is_near) set_axes(search, patch);
    Value centre = value_at(search, patch, third, third);
    int count = search->is_near ? near_coefficients(search, patch->corner, c)
                                : far_coefficients(search, patch->corner, c);
    if (has_no_root(c, count, centre.nn * length(centre.d) * length(centre.e))) return;
    Slope slope = slope_at(search, patch, &centre);
    double q = nonlinearity(c, count, &slope);
    if (q > NEARLY_LINEAR) {
        if (depth < DEPTH_MAX) search_quarters(search, patch, depth);
        return;
    }
    D2 step = unsloped(&slope, determinant(&slope), centre.g);
    double u = third - step.a, v = third - step.b, reach = q * FARTHEST + ON_ROOT;
    if (u < -reach || v < -reach || u + v > 1 + 2 * reach) return;
    hold(&u, &v);
    if (newton(search, patch, &u, &v)) keep(search, patch, u, v);
}

static Search search_of(const MirrorTriangle *triangle, Vec3 from, const ReflectionLight *light) {
    Search search = {.is_near = light->is_near};
    D3 origin = d3_of(from), at = d3_of(light->at);
    for (int i = 0; i < 3; i++) {
        D3 position = d3_of(triangle->position[i]);
        search.whole.corner[i] =
            (PatchCorner){i == 1, i == 2, d3_sub(position, origin), d3_of(triangle->normal[i]),
                          light->is_near ? d3_sub(at, position) : at};
    }
    if (!light->is_near) {
        Frame frame = frame_from_z(light->at);
        search.across[0] = d3_of(frame.x);
        search.across[1] = d3_of(frame.y);
    }
    return search;
}

int reflection_points_find(const MirrorTriangle *triangle, Vec3 from, const ReflectionLight *light,
                           ReflectionPoint out[REFLECTION_POINTS_MAX]) {
    Search search = search_of(triangle, from, light);
    Patch whole = search.whole;
    search.out = out;
    search_patch(&search, &whole, 0);
    return search.count;
}

float reflection_spread(const MirrorTriangle *triangle, Vec3 from, const ReflectionLight *light,
                        Vec3 point) {
    Search search = search_of(triangle, from, light);
    const PatchCorner *c = search.whole.corner;
    D3 a = d3_sub(c[1].d, c[0].d), b = d3_sub(c[2].d, c[0].d), n = d3_cross(a, b);
    D3 p = d3_sub(d3_sub(d3_of(point), d3_of(from)), c[0].d);
    double nn = d3_dot(n, n);
    if (search.is_near) set_axes(&search, &search.whole);
    Value at = value_at(&search, &search.whole, d3_dot(d3_cross(p, b), n) / nn,
                        d3_dot(d3_cross(a, p), n) / nn);
    return (float)spread_at(&search, &at);
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

/* The half vector h = s - w, w = d / |d|, s towards the light, from which slopes follow: g =
 * h / h.z in the frame, slope = n.z (g.x, g.y) - (n.x, n.y). */
typedef struct HalfWay {
    D3 x, y, z; /* the frame */
    D3 d, n, w, s, h;
    double distance, to_light; /* m; infinite of a light far away */
} HalfWay;

/* dh = -(d' - w (w.d')) / |d| - (d' - s (s.d')) / |e|, dg = (dh - g dh.z) / h.z. */
static D2 slope_derivative(const HalfWay *at, D3 edge_d, D3 edge_n) {
    D3 none = {0, 0, 0}, dh = d3_along(edge_d, at->w, -d3_dot(at->w, edge_d));
    D3 ds = d3_along(edge_d, at->s, -d3_dot(at->s, edge_d));
    dh = d3_along(d3_along(none, dh, -1 / at->distance), ds, -1 / at->to_light);
    double hz = d3_dot(at->h, at->z), nz = d3_dot(at->n, at->z);
    double dhz = d3_dot(dh, at->z), dnz = d3_dot(edge_n, at->z);
    double gx = d3_dot(at->h, at->x) / hz, gy = d3_dot(at->h, at->y) / hz;
    return (D2){dnz * gx + nz * (d3_dot(dh, at->x) - gx * dhz) / hz - d3_dot(edge_n, at->x),
                dnz * gy + nz * (d3_dot(dh, at->y) - gy * dhz) / hz - d3_dot(edge_n, at->y)};
}

/* |dw'| / |slope'|, with |dw'| = |N.d| / |d|^3 as above. */
float reflection_slope_spread(const MirrorTriangle *triangle, Vec3 from,
                              const ReflectionLight *light, const ReflectionPoint *at) {
    Frame frame = reflection_frame(triangle);
    D3 d[3], n[3], none = {0, 0, 0};
    for (int i = 0; i < 3; i++) {
        d[i] = d3_sub(d3_of(triangle->position[i]), d3_of(from));
        n[i] = d3_of(triangle->normal[i]);
    }
    double u = (double)at->u, v = (double)at->v;
    HalfWay half = {.x = d3_of(frame.x),
                    .y = d3_of(frame.y),
                    .z = d3_of(frame.z),
                    .d = interpolate(d[0], d[1], d[2], u, v),
                    .n = interpolate(n[0], n[1], n[2], u, v),
                    .s = d3_of(light->at),
                    .to_light = INFINITY};
    half.distance = length(half.d);
    half.w = d3_along(none, half.d, 1 / half.distance);
    if (light->is_near) {
        D3 e = d3_sub(d3_sub(half.s, d3_of(from)), half.d);
        half.to_light = length(e);
        half.s = d3_along(none, e, 1 / half.to_light);
    }
    half.h = d3_sub(half.s, half.w);
    Slope slope = {slope_derivative(&half, d3_sub(d[1], d[0]), d3_sub(n[1], n[0])),
                   slope_derivative(&half, d3_sub(d[2], d[0]), d3_sub(n[2], n[0]))};
    D3 edges = d3_cross(d3_sub(d[1], d[0]), d3_sub(d[2], d[0]));
    double solid = fabs(d3_dot(edges, half.d)) / (half.distance * half.distance * half.distance);
    return (float)(solid / fabs(determinant(&slope)));
}
