/* SPDX-License-Identifier: Apache-2.0 */
/* Images of a curved pane against rays traced in double precision through two faces: spheres or
 * cylinders about one centre, or with a wedge between them. */
#include "check.h"

#include "base/units.h"
#include "shaders/bsdf.h"

#define THICKNESS 0.005
#define IOR 1.52
#define TRIES 4096 /* of the number that chooses an image */

/* ---- the tracer -------------------------------------------------------------------------- */

typedef struct Point {
    double x, y, z;
} Point;

/* Normal with z > 0 about the origin. */
typedef struct Curved {
    Point centre, axis; /* axis 0: a sphere, else a cylinder's, unit */
    double radius, sign;
} Curved;

static double inner(Point a, Point b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static Point plus(Point a, Point b, double t) {
    return (Point){a.x + t * b.x, a.y + t * b.y, a.z + t * b.z};
}

static Point across(const Curved *face, Point v) {
    return plus(v, face->axis, -inner(v, face->axis));
}

static Point normal_at(const Curved *face, Point place) {
    Point q = across(face, plus(place, face->centre, -1));
    double over = face->sign / sqrt(inner(q, q));
    return (Point){q.x * over, q.y * over, q.z * over};
}

/* The place nearer to the origin of the two where the line meets the face. */
static Point meet_at(const Curved *face, Point place, Point way) {
    Point q = across(face, plus(place, face->centre, -1)), w = across(face, way);
    double half = inner(q, w), w2 = inner(w, w);
    double root = sqrt(half * half - w2 * (inner(q, q) - face->radius * face->radius));
    Point a = plus(place, way, (root - half) / w2), b = plus(place, way, (-root - half) / w2);
    return inner(a, a) < inner(b, b) ? a : b;
}

static Point mirror_way(Point way, Point n) {
    return plus(way, n, -2 * inner(way, n));
}

/* eta: the index before the face over the one behind it. */
static Point refract_way(Point way, Point n, double eta) {
    double cosine = inner(way, n), inside = sqrt(1 - eta * eta * (1 - cosine * cosine));
    Point bent = {eta * way.x, eta * way.y, eta * way.z};
    return plus(bent, n, copysign(inside, cosine) - eta * cosine);
}

/* From the origin on, where `way` meets the near face. */
static void trace(const Curved face[2], int order, Point *place, Point *way) {
    *place = (Point){0, 0, 0};
    *way = refract_way(*way, (Point){0, 0, 1}, 1 / IOR);
    for (int i = 0; i < order; i++) {
        if (i) *way = mirror_way(*way, normal_at(&face[0], *place));
        *place = meet_at(&face[1], *place, *way);
        *way = mirror_way(*way, normal_at(&face[1], *place));
        *place = meet_at(&face[0], *place, *way);
    }
    *way = refract_way(*way, normal_at(&face[0], *place), IOR);
}

/* ---- panes ------------------------------------------------------------------------------- */

typedef struct PaneCase {
    double radius; /* m; below 0: concave on the side of +z */
    double turn;   /* of a cylinder's axis from x, degrees; below 0: a sphere */
    double slope;  /* towards +x */
    bool is_below; /* the eye: it looks at the other side */
} PaneCase;

static Glazing pane = {.layers = {{0.002f, 1.52f}, {0.001f, 1.52f}, {0.002f, 1.52f}},
                       .layer_count = 3,
                       .absorbing_ior = 1.52f,
                       .wedge_ior = 1.52f};

static void axis_of(const PaneCase *c, double axis[2]) {
    axis[0] = c->turn < 0 ? 0 : cos(c->turn * PI / 180);
    axis[1] = c->turn < 0 ? 0 : sin(c->turn * PI / 180);
}

/* As the eye's side has it. The far face of a wedge is turned about (0, 0, -THICKNESS). */
static void faces_of(const PaneCase *c, Curved face[2]) {
    double axis[2], r = c->is_below ? -c->radius : c->radius;
    double s = sin(c->slope), k = cos(c->slope), from = THICKNESS - r;
    axis_of(c, axis);
    face[0] = (Curved){{0, 0, -r}, {axis[0], axis[1], 0}, fabs(r), r > 0 ? 1 : -1};
    face[1] = (Curved){{s * from, 0, k * from - THICKNESS},
                       {k * axis[0], axis[1], -s * axis[0]},
                       fabs(r - THICKNESS),
                       face[0].sign};
}

static Bsdf bsdf_of(const PaneCase *c) {
    double axis[2];
    Bsdf bsdf = {.kind = BSDF_GLAZED_WINDOW};
    axis_of(c, axis);
    bsdf.glazed_window =
        (GlazedWindow){.pane = &pane, .slope = {(float)tan(c->slope), 0}, .front_is_up = true};
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++)
            bsdf.glazed_window.bend[i][j] = (float)(((i == j) - axis[i] * axis[j]) / c->radius);
    return bsdf;
}

static bool find_image(const Bsdf *bsdf, Vec3 wo, int order, BsdfSample *found) {
    double sine = sqrt((double)(wo.x * wo.x + wo.y * wo.y));
    double shift = 2 * THICKNESS * sine / sqrt(IOR * IOR - sine * sine);
    for (int i = 0; i < TRIES; i++) {
        const float u[3] = {0.5f, 0.5f, ((float)i + 0.5f) / TRIES};
        if (bsdf_sample(bsdf, wo, u, found) && !found->passes &&
            lround((double)found->along / shift) == order)
            return true;
    }
    return false;
}

/* The renderer lets an image go out of the plane of the near face at the origin. */
static void compare(const PaneCase *c, double angle, double azimuth, int order) {
    Bsdf bsdf = bsdf_of(c);
    BsdfSample sample;
    Curved face[2];
    double x = sin(angle) * cos(azimuth), y = sin(angle) * sin(azimuth);
    double z = cos(angle), side = c->is_below ? -1 : 1;
    Point place, way = {-x, -y, -z};
    assert_true(find_image(&bsdf, vec3((float)x, (float)y, (float)(side * z)), order, &sample));
    faces_of(c, face);
    trace(face, order, &place, &way);
    place = plus(place, way, -place.z / way.z);
    /* What is left out is of the second order. */
    double bent = order * THICKNESS / fabs(c->radius), lean = order * c->slope;
    double least = 6 * (bent + lean) * (bent + lean) + 1e-6, along = (double)sample.along;
    assert_near(sample.wi.x, way.x, least);
    assert_near(sample.wi.y, way.y, least);
    assert_near((double)sample.wi.z * side, way.z, 3 * least);
    assert_near(along, hypot(place.x, place.y), along * (6 * bent + 10 * lean) + 1e-6);
}

static void compare_all(const PaneCase *c) {
    for (int degrees = 45; degrees <= 70; degrees += 25)
        for (int turn = 0; turn < 360; turn += 50)
            for (int order = 1; order <= (degrees > 45 ? 3 : 2); order++)
                compare(c, degrees * PI / 180, turn * PI / 180, order);
}

TEST(images_of_a_curved_pane_leave_as_rays_through_two_faces_do) {
    const double radii[] = {1, 2, 5, 12}, turns[] = {-1, 0, 35, 90};
    for (int i = 0; i < 64; i++) {
        PaneCase c = {.radius = (i & 1 ? -1 : 1) * radii[i / 2 % 4],
                      .turn = turns[i / 8 % 4],
                      .is_below = i >= 32};
        compare_all(&c);
    }
}

TEST(a_wedge_adds_to_what_curvature_does) {
    for (int i = 0; i < 8; i++) {
        PaneCase c = {
            .radius = i & 1 ? -5 : 5, .turn = i & 2 ? 60 : -1, .slope = 5e-4, .is_below = i >= 4};
        compare_all(&c);
    }
}

/* Head on nothing is moved, so nothing turns. */
TEST(an_image_along_the_normal_comes_back) {
    PaneCase c = {.radius = 1, .turn = -1};
    Bsdf bsdf = bsdf_of(&c);
    BsdfSample sample;
    for (int i = 0; i < TRIES; i++) {
        const float u[3] = {0.5f, 0.5f, ((float)i + 0.5f) / TRIES};
        assert_true(bsdf_sample(&bsdf, vec3(0, 0, 1), u, &sample));
        assert_true(sample.wi.x == 0 && sample.wi.y == 0 && fabsf(sample.wi.z) == 1);
    }
}

/* Normals that turn by radians within a pane's thickness: no image may be lost in NaN. */
TEST(crumpled_normals_give_unit_directions_or_none) {
    const float bends[] = {1e2f, -1e3f, 1e6f, -1e20f, 1e38f, INFINITY, NAN};
    for (int i = 0; i < 7 * TRIES; i++) {
        Bsdf bsdf = {.kind = BSDF_GLAZED_WINDOW};
        BsdfSample sample;
        const float u[3] = {0.5f, 0.5f, ((float)(i / 7) + 0.5f) / TRIES};
        bsdf.glazed_window = (GlazedWindow){.pane = &pane, .front_is_up = true};
        bsdf.glazed_window.bend[0][0] = bends[i % 7];
        if (!bsdf_sample(&bsdf, vec3(0.8f, 0, 0.6f), u, &sample)) continue;
        assert_near(vec3_dot(sample.wi, sample.wi), 1, 1e-5);
        assert_true(sample.passes || sample.wi.z > 0);
    }
}

TEST_PROGRAM(NULL, NULL)
