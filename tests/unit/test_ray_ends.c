/* SPDX-License-Identifier: Apache-2.0 */
/* Where rays start and end: no triangle stands in the way of its own rays, and nothing gets out
 * of a closed box, whatever the size, the place and the tilt. */
#include "fixture.h"

#include "base/sampler.h"
#include "base/units.h"
#include "bvh/bvh.h"
#include "scene/point/ray_ends.h"
#include "scene_builder.h"

static uint32_t random_state = 1;

static double random_unit(void) {
    random_state = random_state * 747796405u + 2891336453u;
    return (double)unit_float(hash_u32(random_state));
}

static double between(double low, double high) {
    return low + (high - low) * random_unit();
}

/* Even in its logarithm. */
static double decades(double low, double high) {
    return low * pow(high / low, random_unit());
}

static Vec3 random_direction(void) {
    double z = between(-1, 1), phi = between(0, 2 * PI), s = sqrt(1 - z * z);
    return vec3((float)(s * cos(phi)), (float)(s * sin(phi)), (float)z);
}

static Frame random_frame(void) {
    Frame frame = frame_from_z(random_direction());
    Frame turned = frame;
    double phi = between(0, 2 * PI);
    turned.x =
        vec3_normalize(vec3_along(vec3_scale(frame.x, (float)cos(phi)), frame.y, (float)sin(phi)));
    turned.y = vec3_cross(turned.z, turned.x);
    return turned;
}

/* At the origin, or up to 1 km from it. */
static Vec3 random_place(void) {
    double r = random_unit() < 0.25 ? 0 : decades(0.01, 1000);
    return vec3_scale(random_direction(), (float)r);
}

static Vec3 place_of(Vec3 middle, const Frame *frame, Vec3 local) {
    return vec3_add(middle, frame_to_world(frame, local));
}

/* On the side of n, down to 0.006 degrees from the plane. */
static Vec3 leaving(Vec3 n) {
    Frame frame = frame_from_z(n);
    double cosine = decades(1e-4, 1), s = sqrt(1 - cosine * cosine), phi = between(0, 2 * PI);
    return frame_to_world(&frame,
                          vec3((float)(s * cos(phi)), (float)(s * sin(phi)), (float)cosine));
}

/* As a dull surface scatters, but for directions that rounding leaves below it. */
static Vec3 scattered(Vec3 n) {
    Vec3 way = vec3(0, 0, 0);
    while (!(vec3_dot(way, n) > 0)) way = vec3_normalize(vec3_add(n, random_direction()));
    return way;
}

static TrianglePoint random_point_of(const Scene *scene, uint32_t triangle) {
    double u = random_unit(), v = random_unit();
    if (u + v > 1) u = 1 - u, v = 1 - v;
    if (random_unit() < 0.1) u *= 1e-6; /* by an edge */
    return triangle_point(scene, triangle, (float)u, (float)v);
}

static bool let_pass(void *user, const Hit *hit) {
    (void)user, (void)hit;
    return true;
}

/* ---- one triangle ------------------------------------------------------------------------ */

/* 1 mm to 1 km large, down to a hundredth as wide. */
static Scene *one_triangle(Arena *arena, double *size) {
    Scene *scene = builder_scene(arena);
    Frame frame = random_frame();
    Vec3 middle = random_place();
    *size = decades(1e-3, 1e3);
    float width = (float)(*size * decades(0.01, 1)), lean = (float)between(-1, 2);
    builder_part(scene, builder_material(0.5f));
    Vec3 corner[3] = {{0, 0, 0}, {(float)*size, 0, 0}, {lean * (float)*size, width, 0}};
    for (int k = 0; k < 3; k++)
        builder_vertex(scene, place_of(middle, &frame, corner[k]), frame.z, 0, 0);
    builder_triangle(scene, 0, 1, 2);
    return scene;
}

typedef struct OwnHits {
    long rays, at_start, at_end, too_far, moved;
} OwnHits;

/* Is the place moved along the triangle by more than its edges are left by, or, in a sharp
 * corner, than the way to where it is so wide? */
static bool is_moved(const Scene *scene, const TrianglePoint *point, double size) {
    Vec3 a = scene_corner(scene, 0, 0), b = scene_corner(scene, 0, 1);
    Vec3 c = scene_corner(scene, 0, 2), ab = vec3_sub(b, a), ac = vec3_sub(c, a);
    double longest = fmax(fmax((double)vec3_length(vec3_sub(c, b)), size), (double)vec3_length(ac));
    double height = (double)vec3_length(vec3_cross(ab, ac)) / longest;
    double moved = (double)vec3_length(vec3_sub(point->inside, point->position));
    double inset = (double)ray_inset(point, (float)longest);
    return moved > 3 * inset + 8 * fmin(inset, height) * longest / height;
}

static void send_from(const Scene *scene, const Bvh *bvh, double size, OwnHits *found) {
    TrianglePoint point = random_point_of(scene, 0);
    Vec3 side = random_unit() < 0.5 ? point.ng : vec3_neg(point.ng), way = leaving(side);
    Ray ray = {ray_start(&point, way), way, 0, INFINITY};
    double height = (double)fabsf(vec3_dot(way, point.ng)); /* the other end is rounded, too */
    double far_m = fmax(size * decades(0.01, 100), (double)ray_step(&point) / height);
    Ray back = ray_to(vec3_along(ray.origin, way, (float)far_m), &point, way);
    Vec3 end = vec3_along(back.origin, back.direction, back.t_max);
    Hit hit;
    found->rays++;
    found->moved += is_moved(scene, &point, size);
    found->at_start += bvh_intersect(bvh, ray, 0, &hit);
    found->at_end += bvh_occluded(bvh, back, let_pass, NULL);
    double off = fabs((double)vec3_dot(vec3_sub(end, point.inside), point.ng));
    double coordinate = (double)vec3_length(point.position);
    found->too_far += off > 1e-4 * (size + far_m) + 1e-6 * coordinate;
}

ARENA_TEST(no_triangle_stops_its_own_rays) {
    OwnHits found = {0};
    int triangles = all_laws() ? 20000 : 1000;
    for (int i = 0; i < triangles; i++) {
        Arena own = arena;
        Bvh *bvh;
        double size;
        Scene *scene = one_triangle(&own, &size);
        assert_done(bvh_create(scene, 1, NULL, &bvh, &err));
        for (int k = 0; k < 300; k++) send_from(scene, bvh, size, &found);
        bvh_destroy(bvh);
    }
    print_message("%ld rays, %ld start behind, %ld end behind, %ld end far off\n", found.rays,
                  found.at_start, found.at_end, found.too_far);
    assert_int_equal(found.at_start, 0);
    assert_int_equal(found.at_end, 0);
    assert_int_equal(found.too_far, 0);
    assert_int_equal(found.moved, 0);
}

/* ---- closed boxes ------------------------------------------------------------------------ */

/* A parallelepiped, 10 cm to 10 m, down to a twentieth as high; its corners shared or not. */
static Scene *box(Arena *arena) {
    static const int FACES[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                                    {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
    Scene *scene = builder_scene(arena);
    Frame frame = random_frame();
    Vec3 middle = random_place(), corner[8];
    double size = decades(0.1, 10),
           half[3] = {size, size * decades(0.05, 1), size * decades(0.05, 1)};
    for (int i = 0; i < 8; i++)
        corner[i] =
            place_of(middle, &frame,
                     vec3((float)(i & 1 ? half[0] : -half[0]), (float)(i & 2 ? half[1] : -half[1]),
                          (float)(i & 4 ? half[2] : -half[2])));
    builder_part(scene, builder_material(0.5f));
    for (int f = 0; f < 6; f++) {
        uint32_t first = scene->vertex_count;
        for (int k = 0; k < 4; k++) builder_vertex(scene, corner[FACES[f][k]], vec3(0, 1, 0), 0, 0);
        builder_triangle(scene, first, first + 1, first + 2);
        builder_triangle(scene, first, first + 2, first + 3);
    }
    return scene;
}

static Vec3 middle_of(const Scene *scene) {
    return vec3_scale(vec3_add(scene->bounds_min, scene->bounds_max), 0.5f);
}

static Vec3 inner_normal(const Scene *scene, const TrianglePoint *point) {
    Vec3 in = vec3_sub(middle_of(scene), point->position);
    return vec3_dot(in, point->ng) < 0 ? vec3_neg(point->ng) : point->ng;
}

typedef struct BoxFaults {
    long rays, leaks, shadows, looks;
} BoxFaults;

/* A path of dull bounces; true: it got out. */
static bool walks_out(const Scene *scene, const Bvh *bvh, BoxFaults *found) {
    Ray ray = {middle_of(scene), random_direction(), 0, INFINITY};
    Hit hit;
    for (int bounce = 0; bounce < 8; bounce++) {
        found->rays++;
        if (!bvh_intersect(bvh, ray, 0, &hit)) return true;
        TrianglePoint point = triangle_point(scene, hit.triangle, hit.u, hit.v);
        Vec3 way = scattered(inner_normal(scene, &point));
        ray = (Ray){ray_start(&point, way), way, 0, INFINITY};
    }
    return false;
}

/* Any two points of a convex box see each other. */
static void look_across(const Scene *scene, const Bvh *bvh, BoxFaults *found) {
    uint32_t from_id = (uint32_t)(random_unit() * 12), to_id = (uint32_t)(random_unit() * 12);
    if (from_id / 2 == to_id / 2) return;
    TrianglePoint from = random_point_of(scene, from_id), to = random_point_of(scene, to_id);
    Vec3 at = ray_start(&from, inner_normal(scene, &from));
    Ray ray = ray_to(at, &to, inner_normal(scene, &to));
    found->looks++;
    found->shadows += bvh_occluded(bvh, ray, let_pass, NULL);
}

ARENA_TEST(nothing_gets_out_of_a_closed_box) {
    BoxFaults found = {0};
    int boxes = 200, walks = all_laws() ? 62500 : 500;
    for (int i = 0; i < boxes; i++) {
        Arena own = arena;
        Bvh *bvh;
        Scene *scene = box(&own);
        assert_done(bvh_create(scene, 1, NULL, &bvh, &err));
        for (int k = 0; k < walks; k++) {
            found.leaks += walks_out(scene, bvh, &found);
            look_across(scene, bvh, &found);
        }
        bvh_destroy(bvh);
    }
    print_message("%ld rays, %ld leaks; %ld looks across, %ld in shadow\n", found.rays, found.leaks,
                  found.looks, found.shadows);
    assert_int_equal(found.leaks, 0);
    assert_int_equal(found.shadows, 0);
}

TEST_PROGRAM(make_arena, drop_arena)
