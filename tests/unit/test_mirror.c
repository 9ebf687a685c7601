/* SPDX-License-Identifier: Apache-2.0 */
#include "check.h"

#include "base/sampler.h"
#include "base/units.h"
#include "mirror/mirrors_build.h"
#include "scene_builder.h"

static Vec3 random_direction(Sampler *sampler) {
    Vec2 at = sampler_2d(sampler);
    float z = 1 - 2 * at.x, r = sqrtf(fmaxf(1 - z * z, 0)), sine, cosine;
    sincos_turns(at.y, &sine, &cosine);
    return vec3(r * cosine, r * sine, z);
}

/* A triangle of about a metre at the origin whose normals turn by about `bend`. */
static MirrorTriangle random_triangle(Sampler *sampler, float bend) {
    MirrorTriangle t;
    for (int i = 0; i < 3; i++) t.position[i] = random_direction(sampler);
    Vec3 n = vec3_normalize(
        vec3_cross(vec3_sub(t.position[1], t.position[0]), vec3_sub(t.position[2], t.position[0])));
    for (int i = 0; i < 3; i++)
        t.normal[i] = vec3_normalize(vec3_along(n, random_direction(sampler), bend));
    return t;
}

static Vec3 blend(const Vec3 a[3], float u, float v) {
    return vec3_along(vec3_along(vec3_scale(a[0], 1 - u - v), a[1], u), a[2], v);
}

static Vec3 mirrored(const MirrorTriangle *t, Vec3 from, float u, float v) {
    Vec3 n = vec3_normalize(blend(t->normal, u, v));
    Vec3 w = vec3_normalize(vec3_sub(blend(t->position, u, v), from));
    return vec3_along(w, n, -2 * vec3_dot(n, w));
}

/* Every point that is told turns the light. Returns how many are the one at `at`. */
static int points_at(const MirrorTriangle *t, Vec3 from, const ReflectionLight *light, Vec2 at,
                     int *count) {
    ReflectionPoint points[REFLECTION_POINTS_MAX];
    int here = 0;
    *count = reflection_points_find(t, from, light, points);
    for (int k = 0; k < *count; k++) {
        Vec3 place = blend(t->position, points[k].u, points[k].v);
        Vec3 to = light->is_near ? vec3_normalize(vec3_sub(light->at, place)) : light->at;
        Vec3 off = vec3_sub(mirrored(t, from, points[k].u, points[k].v), to);
        assert_near(vec3_length(off), 0, 1e-4);
        here += hypotf(points[k].u - at.x, points[k].v - at.y) < 1e-3f;
    }
    assert_true(here <= 2);
    return here;
}

/* Of lights far away, and near. */
TEST(no_point_that_reflects_is_missed_and_every_one_told_does) {
    const float bends[] = {0, 0.05f, 0.3f, 0.6f, 1};
    for (int is_near = 0; is_near < 2; is_near++) {
        int asked = 0, found = 0, more = 0;
        for (int i = 0; i < 20000; i++) {
            Sampler sampler = sampler_start(1, i, is_near, 0);
            MirrorTriangle t = random_triangle(&sampler, bends[i % 5]);
            Vec3 from = vec3_scale(random_direction(&sampler), 3);
            Vec2 at = sampler_2d(&sampler);
            if (at.x + at.y > 1) at = (Vec2){1 - at.x, 1 - at.y};
            Vec3 place = blend(t.position, at.x, at.y), way = mirrored(&t, from, at.x, at.y);
            Vec3 flat = vec3_cross(vec3_sub(t.position[1], t.position[0]),
                                   vec3_sub(t.position[2], t.position[0]));
            ReflectionLight light = {vec3_normalize(way), is_near};
            if (is_near) light.at = vec3_along(place, way, 0.3f + 5 * sampler_1d(&sampler));
            if (is_near && !(vec3_dot(flat, way) * vec3_dot(flat, vec3_sub(from, place)) > 0))
                continue; /* it lies behind the triangle */
            int count;
            asked++;
            found += points_at(&t, from, &light, at, &count) > 0;
            more += count > 1;
        }
        /* Left: points a rounding away from another or from an edge. */
        if (asked < 10000 || found < asked - 20) fail_msg("%d of %d found", found, asked);
        if (more < 100) fail_msg("only %d triangles with more than one", more);
    }
}

/* Light by a flat mirror is that of the source's image behind it. */
TEST(a_candela_by_a_flat_mirror_gives_what_its_image_would) {
    int met = 0;
    for (int i = 0; i < 2000; i++) {
        ReflectionPoint points[REFLECTION_POINTS_MAX];
        Sampler sampler = sampler_start(6, i, 0, 0);
        MirrorTriangle t = random_triangle(&sampler, 0);
        Vec3 from = vec3_scale(random_direction(&sampler), 0.1f + 2 * sampler_1d(&sampler));
        const ReflectionLight light = {vec3_scale(random_direction(&sampler), 2), true};
        Vec3 n = t.normal[0], to = vec3_sub(light.at, t.position[0]);
        float far = vec3_dot(n, to), own = vec3_dot(n, vec3_sub(from, t.position[0]));
        Vec3 image = vec3_along(light.at, n, -2 * far);
        if (!(far * own > 0)) continue;
        if (!reflection_points_find(&t, from, &light, points)) continue;
        Vec3 way = vec3_sub(image, from);
        assert_close(points[0].spread, 1 / vec3_dot(way, way), 1e-4);
        met++;
    }
    if (met < 100) fail_msg("only %d", met);
}

/* Every direction in which the point sees the triangle comes from one direction of the light:
 * summed over all those, spread is the triangle's solid angle (van Oosterom, Strackee 1983). */
TEST(spread_adds_up_to_the_solid_angle) {
    const float bends[] = {0, 0.1f, 0.5f};
    enum { DIRECTIONS = 400000 };
    for (int i = 0; i < 9; i++) {
        Sampler sampler = sampler_start(2, i, 0, 0);
        MirrorTriangle t = random_triangle(&sampler, bends[i % 3]);
        Vec3 from = vec3_scale(random_direction(&sampler), 2), d[3];
        for (int k = 0; k < 3; k++) d[k] = vec3_normalize(vec3_sub(t.position[k], from));
        double solid = 2 * atan2(fabs((double)vec3_dot(d[0], vec3_cross(d[1], d[2]))),
                                 1.0 + (double)(vec3_dot(d[0], d[1]) + vec3_dot(d[1], d[2]) +
                                                vec3_dot(d[2], d[0])));
        double sum = 0, squares = 0;
        for (int k = 0; k < DIRECTIONS; k++) {
            ReflectionPoint points[REFLECTION_POINTS_MAX];
            Sampler at = sampler_start(3, i, 0, (uint32_t)k);
            const ReflectionLight light = {random_direction(&at), false};
            int count = reflection_points_find(&t, from, &light, points);
            double here = 0;
            for (int p = 0; p < count; p++) here += 4 * PI * (double)points[p].spread;
            sum += here;
            squares += here * here;
        }
        double mean = sum / DIRECTIONS;
        double sigma = sqrt(fmax(squares / DIRECTIONS - mean * mean, 0) / DIRECTIONS);
        if (!(fabs(mean - solid) < 4 * sigma) || !(sigma < 0.05 * solid))
            fail_msg("triangle %d: %g +- %g sr, expected %g", i, mean, sigma, solid);
    }
}

/* ---- whole surfaces --------------------------------------------------------------------- */

typedef struct Sum {
    const Scene *scene;
    Vec3 towards; /* the light: only fronts count */
    double spread;
    int count;
    uint32_t nodes; /* that it took */
} Sum;

static void add_point(void *user, uint32_t triangle, const ReflectionPoint *point) {
    Sum *sum = user;
    Vec3 n = scene_part(sum->scene, triangle)->normals[scene_corner_place(sum->scene, triangle, 0)];
    if (!(vec3_dot(n, sum->towards) > 0)) return;
    sum->spread += (double)point->spread;
    sum->count++;
}

static const Mirrors *all_mirrors(const Scene *scene, Arena *arena) {
    MirrorPair *pairs = ARENA_NEW(arena, MirrorPair, scene->triangle_count);
    for (uint32_t i = 0; i < scene->triangle_count; i++) pairs[i] = (MirrorPair){NO_ID, false, i};
    return mirrors_build(scene, pairs, scene->triangle_count, 2, arena);
}

static Sum ask_near(const Scene *scene, const Mirrors *mirrors, Vec3 from, Vec3 at) {
    Sum sum = {.scene = scene, .towards = at};
    const MirrorQuery query = {.part_id = NO_ID, .from = from, .light = {at, true}};
    sum.nodes = mirrors_find(mirrors, &query, add_point, &sum);
    return sum;
}

static Sum ask(const Scene *scene, const Mirrors *mirrors, Vec3 from, Vec3 towards) {
    Sum sum = {.scene = scene, .towards = towards};
    const MirrorQuery query = {.part_id = NO_ID, .from = from, .light = {towards, false}};
    sum.nodes = mirrors_find(mirrors, &query, add_point, &sum);
    return sum;
}

/* A sheet of a cylinder about the z axis, of radius 1, from angle a to b; normals inward. */
static void cylinder(Scene *scene, double a, double b, int columns) {
    uint32_t first = scene->vertex_count;
    for (int i = 0; i <= columns; i++)
        for (int k = -1; k <= 1; k += 2) {
            double angle = a + (b - a) * i / columns;
            Vec3 n = vec3((float)cos(angle), (float)sin(angle), 0);
            builder_vertex(scene, vec3_along(n, vec3(0, 0, 1), (float)k), vec3_neg(n), 0, 0);
        }
    for (uint32_t i = 0; i < (uint32_t)columns; i++) {
        uint32_t at = first + 2 * i;
        builder_triangle(scene, at, at + 1, at + 2);
        builder_triangle(scene, at + 1, at + 3, at + 2);
    }
}

/* Parallel light along +x meets the concave side at angle t, at incidence t, and leaves along
 * (-cos 2t, -sin 2t). After l its width is |1 - 2 l / cos t| of what it was (the mirror
 * equation's tangential focus): spread is one over that. */
TEST(a_concave_cylinder_focuses_as_the_mirror_equation_says) {
    ENDS_BY(arena_release) Arena arena = arena_reserve((size_t)1 << 28);
    Scene *scene = builder_scene(&arena);
    builder_part(scene, builder_mirror(1));
    cylinder(scene, -0.6, 0.6, 512);
    const Mirrors *mirrors = all_mirrors(scene, &arena);
    const double angles[] = {0.05, 0.2, 0.35, 0.5}, lengths[] = {0.2, 0.35, 0.6, 0.8};
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 4; k++) {
            double t = angles[i], l = lengths[k];
            Vec3 from =
                vec3((float)(cos(t) - l * cos(2 * t)), (float)(sin(t) - l * sin(2 * t)), 0.1f);
            /* All points that send light there: of -0.6 .. 0.6, by a fine scan. */
            double expected = 0;
            int roots = 0;
            const int steps = 200000;
            double before = 0;
            for (int j = 0; j <= steps; j++) {
                double a = -0.6 + 1.2 * j / steps;
                double miss = (from.x - cos(a)) * -sin(2 * a) - (from.y - sin(a)) * -cos(2 * a);
                double along = (cos(a) - from.x) * cos(2 * a) + (sin(a) - from.y) * sin(2 * a);
                if (j && miss * before <= 0 && along > 0) {
                    expected += 1 / fabs(1 - 2 * along / cos(a));
                    roots++;
                }
                before = miss;
            }
            Sum sum = ask(scene, mirrors, from, vec3(-1, 0, 0));
            assert_int_equal(sum.count, roots);
            assert_close(sum.spread, expected, 5e-3);
        }
}

/* A sphere of radius 1 spreads a beam that meets it at incidence t, after l, by 1 + 2 l / cos t
 * across the plane's line and by 1 + 2 l cos t across the plane. Light of a point at s before it
 * has the vergence 1 / s besides: its pencil is s + l + 2 s l / cos t by s + l + 2 s l cos t wide,
 * for a steradian. */
TEST(a_convex_sphere_spreads_as_the_mirror_equation_says) {
    for (int i = 1; i < 8; i++) {
        ENDS_BY(arena_release) Arena arena = arena_reserve((size_t)1 << 28);
        Scene *scene = builder_scene(&arena);
        double t = 0.18 * i, turn = 0.7 * i;
        Vec3 n = vec3((float)(sin(t) * cos(turn)), (float)(sin(t) * sin(turn)), (float)cos(t));
        Vec3 towards = vec3(0, 0, 1), out = vec3_sub(vec3_scale(n, 2 * n.z), towards);
        builder_part(scene, builder_mirror(1));
        builder_cap(scene, n);
        const Mirrors *mirrors = all_mirrors(scene, &arena);
        for (int k = 0; k < 12; k++) {
            double l = 0.3 * (1 << k % 4), s = 0.4 * (1 + k / 4 * 3);
            Vec3 from = vec3_along(n, out, (float)l);
            Sum far = ask(scene, mirrors, from, towards);
            Sum near = ask_near(scene, mirrors, from, vec3_along(n, towards, (float)s));
            assert_int_equal(far.count, 1);
            assert_int_equal(near.count, 1);
            assert_close(far.spread, 1 / ((1 + 2 * l / cos(t)) * (1 + 2 * l * cos(t))), 5e-3);
            assert_close(near.spread,
                         1 / ((s + l + 2 * s * l / cos(t)) * (s + l + 2 * s * l * cos(t))), 5e-3);
        }
    }
}

/* Nodes that searching a sphere's mirrors from all around it takes, on the average. */
static double asked_nodes(int rings, uint32_t *triangles) {
    ENDS_BY(arena_release) Arena arena = arena_reserve((size_t)1 << 30);
    Scene *scene = builder_scene(&arena);
    double sum = 0;
    builder_part(scene, builder_mirror(1));
    builder_sphere(scene, vec3(0, 0, 0), 1, rings, 0);
    *triangles = scene->triangle_count;
    const Mirrors *mirrors = all_mirrors(scene, &arena);
    for (uint32_t i = 0; i < 2000; i++) {
        Sampler at = sampler_start(7, 0, 0, i);
        Vec3 from = vec3_scale(random_direction(&at), 2);
        sum += ask(scene, mirrors, from, random_direction(&at)).nodes;
    }
    return sum / 2000;
}

static void assert_same_trees(const Mirrors *a, const Mirrors *b, uint32_t node_a,
                              uint32_t node_b) {
    MirrorNode x = a->nodes[node_a], y = b->nodes[node_b];
    uint32_t child_a = x.children, child_b = y.children;
    assert_int_equal(!child_a, !child_b);
    x.children = y.children = 0;
    assert_memory_equal(&x, &y, sizeof x);
    for (uint32_t k = 0; child_a && k < 2; k++) assert_same_trees(a, b, child_a + k, child_b + k);
}

/* Also where many parts sample the same mirrors. */
TEST(trees_do_not_depend_on_threads) {
    ENDS_BY(arena_release) Arena arena = arena_reserve((size_t)1 << 28);
    Scene *scene = builder_scene(&arena);
    const uint32_t parts = 7;
    builder_part(scene, builder_mirror(1));
    builder_sphere(scene, vec3(0, 0, 0), 1, 16, 0);
    uint32_t count = scene->triangle_count;
    MirrorPair *pairs = ARENA_NEW(&arena, MirrorPair, parts * count);
    scene->part_count = (int)parts - 1; /* those that sample; part 0 is the mirror */
    for (uint32_t i = 0; i < parts * count; i++)
        pairs[i] = (MirrorPair){(int)(i / count) - 1, false, i % count};
    const Mirrors *one = mirrors_build(scene, pairs, parts * count, 1, &arena);
    const Mirrors *five = mirrors_build(scene, pairs, parts * count, 5, &arena);
    for (int part = NO_ID; part < (int)parts - 1; part++) {
        int root = mirror_root(part, false);
        assert_true(one->roots[root] != MIRROR_NO_TREE);
        assert_same_trees(one, five, one->roots[root], five->roots[root]);
    }
    assert_int_equal(one->roots[mirror_root(0, true)], MIRROR_NO_TREE);
}

TEST(a_hundred_times_the_triangles_take_at_most_twice_the_nodes) {
    uint32_t few, many;
    double of_few = asked_nodes(16, &few), of_many = asked_nodes(158, &many);
    print_message("[          ] %u triangles %.1f nodes, %u triangles %.1f\n", few, of_few, many,
                  of_many);
    assert_true(many > 95 * few);
    assert_true(of_many < 2 * of_few);
}

TEST_PROGRAM(NULL, NULL)
