/* SPDX-License-Identifier: Apache-2.0 */
#include "fixture.h"

#include "base/sampler.h"
#include "bvh/bvh.h"
#include "scene_builder.h"

static float random_unit(uint32_t *state) {
    *state = *state * 747796405u + 2891336453u;
    return unit_float(hash_u32(*state));
}

static Vec3 random_point(uint32_t *state, float size) {
    float x = random_unit(state), y = random_unit(state), z = random_unit(state);
    return vec3(size * (x - 0.5f), size * (y - 0.5f), size * (z - 0.5f));
}

static Scene *soup(Arena *arena, int triangles, int asked) {
    uint32_t random = 7;
    Scene *scene = builder_scene(arena);
    for (int kind = 0; kind < 2; kind++) {
        Material material = builder_material(0.5f);
        material.lets_light_through = kind == 1;
        builder_part(scene, material);
        for (int i = 0; i < (kind ? asked : triangles); i++) {
            Vec3 at = random_point(&random, 2);
            uint32_t first = scene->vertex_count;
            for (int k = 0; k < 3; k++)
                builder_vertex(scene, vec3_add(at, random_point(&random, 0.6f)), vec3(0, 1, 0), 0,
                               0);
            builder_triangle(scene, first, first + 1, first + 2);
        }
    }
    return scene;
}

/* Moeller-Trumbore in double precision: a slow opinion of our own. */
static int hits(const Scene *scene, uint32_t triangle, Ray ray, double *t) {
    double p[3][3], e1[3], e2[3], h[3], s[3], q[3];
    const double d[3] = {(double)ray.direction.x, (double)ray.direction.y, (double)ray.direction.z};
    const double o[3] = {(double)ray.origin.x, (double)ray.origin.y, (double)ray.origin.z};
    for (int k = 0; k < 3; k++) {
        Vec3 corner = scene_corner(scene, triangle, k);
        p[k][0] = (double)corner.x, p[k][1] = (double)corner.y, p[k][2] = (double)corner.z;
    }
    for (int i = 0; i < 3; i++) {
        e1[i] = p[1][i] - p[0][i];
        e2[i] = p[2][i] - p[0][i];
        s[i] = o[i] - p[0][i];
    }
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        h[i] = d[j] * e2[k] - d[k] * e2[j];
        q[i] = s[j] * e1[k] - s[k] * e1[j];
    }
    double det = e1[0] * h[0] + e1[1] * h[1] + e1[2] * h[2];
    double u = (s[0] * h[0] + s[1] * h[1] + s[2] * h[2]) / det;
    double v = (d[0] * q[0] + d[1] * q[1] + d[2] * q[2]) / det;
    *t = (e2[0] * q[0] + e2[1] * q[1] + e2[2] * q[2]) / det;
    return u >= 0 && v >= 0 && u + v <= 1 && *t > 0;
}

ARENA_TEST(the_nearest_of_all_triangles_is_hit) {
    Scene *scene = soup(&arena, 300, 100);
    Bvh *bvh;
    int disagree = 0;
    uint32_t random = 3;
    assert_done(bvh_create(scene, 1, NULL, &bvh, &err));
    for (int i = 0; i < 3000; i++) {
        Ray ray = {random_point(&random, 3), vec3_normalize(random_point(&random, 2)), 0, INFINITY};
        double nearest = INFINITY, t;
        Hit hit = {INFINITY, 0, 0, 0};
        for (uint32_t k = 0; k < scene->triangle_count; k++)
            if (hits(scene, k, ray, &t) && t < nearest) nearest = t;
        bvh_intersect(bvh, ray, 0, &hit);
        if (fabs((double)hit.t - nearest) > 1e-4 * nearest) disagree++;
        assert_int_equal(bvh_occluded(bvh, ray, NULL, NULL), isfinite(hit.t));
    }
    assert_true(disagree <= 3); /* rays through an edge may differ by rounding */
    bvh_destroy(bvh);
}

typedef struct Asked {
    const Scene *scene;
    int count;
    float transmitted;
} Asked;

static bool half_passes(void *user, const Hit *hit) {
    Asked *asked = user;
    assert_true(hit->triangle >= asked->scene->opaque_count);
    assert_true(hit->triangle < asked->scene->triangle_count);
    asked->count++;
    asked->transmitted *= 0.5f;
    return true;
}

ARENA_TEST(a_shadow_ray_asks_every_window_once) {
    Scene *scene = builder_scene(&arena);
    Material window = builder_material(1);
    Bvh *bvh;
    window.lets_light_through = true;
    builder_part(scene, builder_material(0.5f));
    builder_quad(scene, vec3(0, 0, -20), vec3(1, 0, 0), vec3(0, 1, 0));
    builder_part(scene, window);
    for (int i = 1; i <= 10; i++)
        builder_quad(scene, vec3(0, 0, (float)-i), vec3(1, 0, 0), vec3(0, 1, 0));
    assert_done(bvh_create(scene, 2, NULL, &bvh, &err));
    Asked asked = {scene, 0, 1};
    Ray ray = {vec3(0.3f, 0.1f, 0), vec3(0, 0, -1), 0, 15};
    assert_false(bvh_occluded(bvh, ray, half_passes, &asked));
    assert_int_equal(asked.count, 10);
    ray.t_max = 30; /* now the opaque wall stands in the way */
    assert_true(bvh_occluded(bvh, ray, half_passes, &asked));
    bvh_destroy(bvh);
}

ARENA_TEST(rays_that_are_not_finite_hit_nothing_and_light_nothing) {
    Scene *scene = soup(&arena, 50, 0);
    Bvh *bvh;
    Hit hit;
    const Ray bad[] = {
        {vec3(NAN, 0, 0), vec3(0, 0, 1), 0, INFINITY},
        {vec3(0, INFINITY, 0), vec3(0, 0, 1), 0, INFINITY},
        {vec3(0, 0, 0), vec3(0, NAN, 1), 0, INFINITY},
        {vec3(0, 0, 0), vec3(0, 0, 0), 0, INFINITY},
        {vec3(0, 0, 0), vec3(0, 0, 1), NAN, INFINITY},
        {vec3(0, 0, 0), vec3(0, 0, 1), -1, INFINITY},
        {vec3(0, 0, 0), vec3(0, 0, 1), 0, NAN},
        {vec3(0, -2e18f, 0), vec3(0, 0, 1), 0, INFINITY},
        {vec3(0, 0, 0), vec3(0, 3e38f, 1), 0, INFINITY},
    };
    assert_done(bvh_create(scene, 1, NULL, &bvh, &err));
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_false(bvh_intersect(bvh, bad[i], 0, &hit));
        assert_true(bvh_occluded(bvh, bad[i], NULL, NULL));
    }
    bvh_destroy(bvh);
}

ARENA_TEST(an_empty_scene_is_hit_nowhere) {
    Scene *scene = builder_scene(&arena);
    Bvh *bvh;
    Hit hit;
    assert_done(bvh_create(scene, 1, NULL, &bvh, &err));
    assert_false(bvh_intersect(bvh, (Ray){vec3(0, 0, 0), vec3(0, 0, 1), 0, INFINITY}, 0, &hit));
    bvh_destroy(bvh);
    bvh_destroy(NULL);
}

TEST_PROGRAM(make_arena, drop_arena)
