/* SPDX-License-Identifier: Apache-2.0 */
/* test_hemisphere.c -- the laws of triangles, transforms and the specular frame. */
#include "hemisphere_fixture.h"

#include "hemisphere/specular_frame.h"
/* ---- geodesic ---------------------------------------------------------------------------- */

HEMISPHERE_TEST(a_level_has_4_to_the_level_plus_1_triangles) {
    for (int level = 0; level <= 6; level++) {
        uint32_t count = geodesic_count(level);
        assert_int_equal(count, (uint32_t)lrint(pow(4, level + 1)));
        Arena scratch = f->arena;
        bool *seen = ARENA_NEW(&scratch, bool, count);
        for (uint32_t id = 0; id < count; id++) {
            GeodesicPoint p = geodesic_find(f->geodesic, level, geodesic_center(level, id));
            assert_true(p.id < count);
            assert_false(seen[p.id]);
            seen[p.id] = true;
        }
    }
}

HEMISPHERE_TEST(areas_of_a_level_sum_to_the_hemisphere) {
    for (int level = 0; level <= 8; level++) {
        Arena scratch = f->arena;
        double *areas = ARENA_NEW(&scratch, double, 1u << 2 * level), sum = 0;
        geodesic_areas(level, areas);
        for (uint32_t i = 0; i < 1u << 2 * level; i++) sum += 4 * areas[i];
        assert_near(sum, 2 * PI, 1e-9);
        assert_close(areas[0], geodesic_area(level, 0), 1e-12);
    }
}

TEST(children_cover_their_father_exactly) {
    for (int level = 0; level < 6; level++)
        for (uint32_t id = 0; id < geodesic_count(level); id += 7) {
            double sum = 0;
            for (uint32_t i = 0; i < 4; i++) sum += geodesic_area(level + 1, 4 * id + i);
            assert_close(sum, geodesic_area(level, id), 1e-12);
        }
}

HEMISPHERE_TEST(tables_agree_with_geometry) {
    for (int level = 0; level < LEVEL; level++)
        for (uint32_t id = 0; id < 1u << 2 * level; id += 5) {
            const float *cosines = f->geodesic->edges[level][id].half_cos;
            const float *ratios = f->geodesic->ratios[level][id].of_child;
            GeodesicTriangle t = geodesic_triangle(level, id);
            double middle = geodesic_area(level + 1, 4 * id);
            for (uint32_t i = 0; i < 3; i++) {
                Vec3 sum = vec3_add(t.corner[(i + 1) % 3], t.corner[(i + 2) % 3]);
                assert_close(cosines[i], 0.5f * vec3_length(sum), 1e-6);
                assert_close(ratios[i + 1], geodesic_area(level + 1, 4 * id + i + 1) / middle,
                             1e-6);
            }
            assert_close(f->geodesic->areas[level][id], geodesic_area(level, id), 1e-6);
        }
}

HEMISPHERE_TEST(the_leaf_of_a_leafs_centre_is_that_leaf) {
    for (int level = 0; level <= LEVEL; level++)
        for (uint32_t id = 0; id < geodesic_count(level); id++) {
            GeodesicPoint p = geodesic_find(f->geodesic, level, geodesic_center(level, id));
            assert_int_equal(p.id, id);
            for (int i = 0; i < 3; i++) assert_near(p.weight[i], 1 / 3.0, 1e-4);
        }
}

HEMISPHERE_TEST(a_found_leaf_holds_its_direction) {
    uint32_t seed = 1;
    for (int i = 0; i < 20000; i++) {
        Vec3 d = random_direction(&seed);
        int level = i % (LEVEL + 1);
        GeodesicPoint p = geodesic_find(f->geodesic, level, d);
        GeodesicTriangle t = geodesic_triangle(level, p.id);
        Vec3 sum = {0, 0, 0};
        for (int k = 0; k < 3; k++) {
            Vec3 a = t.corner[(k + 1) % 3], b = t.corner[(k + 2) % 3];
            float inside = vec3_dot(vec3_cross(a, b), t.corner[k]);
            float here = vec3_dot(vec3_cross(a, b), d);
            assert_true(here / inside > -1e-4f);
            assert_true(p.weight[k] >= 0);
            sum = vec3_along(sum, t.corner[k], p.weight[k]);
        }
        Vec3 back = vec3_normalize(sum);
        assert_true(vec3_length(vec3_sub(back, d)) < 1e-6f);
    }
}

TEST(ids_below_half_have_y_of_at_least_0) {
    for (uint32_t id = 0; id < geodesic_count(4); id++)
        assert_int_equal(geodesic_center(4, id).y > 0, id < geodesic_count(4) / 2);
}

HEMISPHERE_TEST(mirrored_directions_have_mirrored_leaves) {
    uint32_t seed = 2;
    for (int i = 0; i < 1000; i++) {
        Vec3 d = random_direction(&seed);
        uint32_t id = geodesic_find(f->geodesic, 6, d).id;
        assert_int_equal(geodesic_find(f->geodesic, 6, vec3(-d.x, d.y, d.z)).id, id ^ 1u << 12);
        assert_int_equal(geodesic_find(f->geodesic, 6, vec3(d.x, -d.y, d.z)).id, id ^ 2u << 12);
    }
}

/* Two triangles touch in an edge when they share exactly two corners. */
TEST(neighbours_share_an_edge_and_are_neighbours_of_each_other) {
    const int level = 4;
    int borders = 0;
    for (uint32_t id = 0; id < geodesic_count(level); id++)
        for (int k = 0; k < 3; k++) {
            uint32_t next = geodesic_neighbour(level, id, k);
            if (next == GEODESIC_NONE) {
                borders++;
                continue;
            }
            assert_int_equal(geodesic_neighbour(level, next, k), id);
            GeodesicTriangle a = geodesic_triangle(level, id), b = geodesic_triangle(level, next);
            for (int i = 1; i < 3; i++) {
                Vec3 gap = vec3_sub(a.corner[(k + i) % 3], b.corner[(k + 3 - i) % 3]);
                assert_true(vec3_length(gap) < 1e-6f);
            }
        }
    assert_int_equal(borders, 4 * 3 * (1 << level));
}

HEMISPHERE_TEST(sampling_a_triangle_is_uniform_and_inverts) {
    uint32_t seed = 3;
    for (int level = 0; level <= LEVEL; level++)
        for (int trial = 0; trial < 3; trial++) {
            uint32_t id = hash_u32((uint32_t)(level * 3 + trial)) % geodesic_count(level);
            GeodesicTriangle t = geodesic_triangle(level, id);
            float area = (float)geodesic_area(level, id);
            int hits[4] = {0}, wrong = 0;
            const int count = 4000;
            GeodesicSampler sampler = geodesic_sampler(&t, area);
            for (int i = 0; i < count; i++) {
                float u0 = random_unit(&seed), u1 = random_unit(&seed);
                Vec3 d = geodesic_sampler_draw(&sampler, u0, u1);
                assert_close(vec3_length(d), 1, 1e-6);
                Vec2 u = geodesic_invert_triangle(&t, area, d);
                if (level < 5) {
                    assert_near(u.x, u0, 2e-3 / (double)sqrtf(u1 + 1e-4f));
                    assert_near(u.y, u1, 1e-3);
                }
                if (geodesic_find(f->geodesic, level, d).id != id) wrong++;
                if (level < LEVEL) hits[geodesic_find(f->geodesic, level + 1, d).id & 3]++;
            }
            assert_true(wrong <= 4);
            if (level == LEVEL) continue;
            double chi = 0;
            for (uint32_t k = 0; k < 4; k++) {
                double expected = count * geodesic_area(level + 1, 4 * id + k) / (double)area;
                chi += (hits[k] - expected) * (hits[k] - expected) / expected;
            }
            assert_true(chi < 21.1); /* 3 degrees of freedom, p = 1e-4 */
        }
}

/* ---- Haar
 * ------------------------------------------------------------------------------------ */

HEMISPHERE_TEST(the_haar_transform_inverts_exactly) {
    for (int octants = 2; octants <= 4; octants += 2)
        for (size_t w = 0; w < 2; w++) {
            Arena scratch = f->arena;
            HaarShape shape = {LEVEL, octants, 3, WEIGHTS[w]};
            size_t count = haar_leaf_count(&shape) * 3ull;
            float *source = leaves_of_signals(&shape, &scratch);
            float *work = ARENA_NEW(&scratch, float, count), largest = 0;
            memcpy(work, source, count * sizeof *work);
            haar_forward(&shape, work, scratch);
            haar_inverse(&shape, work, scratch);
            for (size_t i = 0; i < count; i++) largest = fmaxf(largest, fabsf(source[i]));
            for (size_t i = 0; i < count; i++)
                assert_near(work[i], source[i], 1e-6 * (double)largest);
        }
}

HEMISPHERE_TEST(area_weighted_octant_means_are_integral_means) {
    Arena scratch = f->arena;
    HaarShape shape = {LEVEL, 4, 1, HAAR_AREA};
    float *values = leaves_of_signals(&shape, &scratch);
    double *areas = ARENA_NEW(&scratch, double, 1u << 2 * LEVEL), sum[4] = {0};
    geodesic_areas(LEVEL, areas);
    uint32_t octant = 1u << 2 * LEVEL;
    for (uint32_t i = 0; i < 4 * octant; i++)
        sum[i / octant] += (double)values[i] * areas[i % octant];
    haar_forward(&shape, values, scratch);
    for (uint32_t q = 0; q < 4; q++) assert_close(values[q * octant], sum[q] / (PI / 2), 1e-6);
}

HEMISPHERE_TEST(equal_weights_give_plain_means) {
    Arena scratch = f->arena;
    HaarShape shape = {1, 4, 1, HAAR_EQUAL};
    float values[16];
    for (int i = 0; i < 16; i++) values[i] = (float)(i * i);
    haar_forward(&shape, values, scratch);
    for (int q = 0; q < 4; q++) {
        float mean = 0;
        for (int i = 4 * q; i < 4 * q + 4; i++) mean += 0.25f * (float)(i * i);
        assert_close(values[4 * q], mean, 1e-6);
        for (int i = 4 * q + 1; i < 4 * q + 4; i++)
            assert_close(values[i], (float)(i * i) - mean, 1e-5);
    }
}

/* Dropping one detail changes the square integral by (detail * norm)^2. */
HEMISPHERE_TEST(norms_say_what_a_detail_is_worth) {
    for (size_t w = 0; w < 2; w++) {
        Arena scratch = f->arena;
        HaarShape shape = {3, 4, 1, WEIGHTS[w]};
        float *norms = ARENA_NEW(&scratch, float, 256), *values;
        double *areas = ARENA_NEW(&scratch, double, 64);
        geodesic_areas(3, areas);
        haar_norms(&shape, norms, scratch);
        for (uint32_t place = 0; place < 256; place++) {
            Arena inner = scratch;
            values = ARENA_NEW(&inner, float, 256);
            values[place] = 1;
            haar_inverse(&shape, values, inner);
            /* Equal weights: the change below the father's children is what norms count. */
            double sum = 0;
            for (uint32_t i = 0; i < 256; i++)
                sum += areas[i % 64] * (double)values[i] * (double)values[i];
            assert_close(norms[place], sqrt(sum), 1e-5);
        }
    }
}

/* ---- specular frame
 * ---------------------------------------------------------------------------- */

static const float EXPONENTS[] = {1, 2, 1.5f};

TEST(the_specular_frame_round_trips) {
    uint32_t seed = 10;
    for (int k = 0; k < 3; k++)
        for (int theta = 0; theta <= 89; theta++) {
            SpecularFrame frame = specular_frame((float)radians_from_degrees(theta), EXPONENTS[k]);
            for (int i = 0; i < 40; i++) {
                Vec3 d = random_direction(&seed);
                Vec3 back = specular_frame_outer(&frame, specular_frame_stored(&frame, d));
                assert_true(vec3_length(vec3_sub(back, d)) < 4e-6f);
                back = specular_frame_stored(&frame, specular_frame_outer(&frame, d));
                assert_true(vec3_length(vec3_sub(back, d)) < (theta > 60 ? 2e-4f : 2e-5f));
            }
        }
}

TEST(the_horizon_stays_the_horizon_and_the_peak_is_the_pole) {
    for (int k = 0; k < 3; k++)
        for (int theta = 0; theta <= 80; theta += 10) {
            float angle = (float)radians_from_degrees(theta);
            SpecularFrame frame = specular_frame(angle, EXPONENTS[k]);
            Vec3 mirror = vec3(sinf(angle), 0, cosf(angle));
            assert_true(vec3_length(vec3_sub(specular_frame_stored(&frame, mirror),
                                             vec3(0, 0, 1))) < 2e-3f);
            for (int i = 0; i < 64; i++) {
                float sine, cosine;
                sincos_turns((float)i / 64, &sine, &cosine);
                Vec3 edge = vec3(cosine, sine, 0);
                assert_near(specular_frame_stored(&frame, edge).z, 0, 2e-6);
                assert_near(specular_frame_outer(&frame, edge).z, 0, 2e-6);
            }
        }
}

/* J is the area of the image of a small stored square over that of the square. */
TEST(the_jacobian_agrees_with_differences) {
    uint32_t seed = 11;
    for (int i = 0; i < 2000; i++) {
        float theta = (float)radians_from_degrees(85 * (double)random_unit(&seed));
        SpecularFrame frame = specular_frame(theta, EXPONENTS[i % 3]);
        Vec3 d = random_direction(&seed);
        if (d.z < 0.02f || d.z > 0.98f) continue;
        Frame axes = frame_from_z(d);
        float h = 2e-3f;
        Vec3 x = specular_frame_outer(&frame, vec3_normalize(vec3_along(d, axes.x, h)));
        Vec3 y = specular_frame_outer(&frame, vec3_normalize(vec3_along(d, axes.y, h)));
        Vec3 u = specular_frame_outer(&frame, vec3_normalize(vec3_along(d, axes.x, -h)));
        Vec3 v = specular_frame_outer(&frame, vec3_normalize(vec3_along(d, axes.y, -h)));
        float area = vec3_length(vec3_cross(vec3_sub(x, u), vec3_sub(y, v))) / (4 * h * h);
        assert_close(area, specular_frame_jacobian(&frame, d), 5e-3);
    }
}

TEST(both_at_once_agrees_with_one_by_one) {
    uint32_t seed = 19;
    for (int i = 0; i < 3000; i++) {
        float theta = 1.5f * random_unit(&seed), jacobian;
        SpecularFrame frame = specular_frame(theta, EXPONENTS[i % 3]);
        Vec3 outer = random_direction(&seed);
        Vec3 stored = specular_frame_stored_jacobian(&frame, outer, &jacobian);
        Vec3 alone = specular_frame_stored(&frame, outer);
        assert_true(stored.x == alone.x && stored.y == alone.y && stored.z == alone.z);
        assert_close(jacobian, specular_frame_jacobian(&frame, stored), 1e-4);
    }
}

/* The integral of J over the stored hemisphere is the outer hemisphere. */
HEMISPHERE_TEST(the_jacobian_integrates_to_the_hemisphere) {
    for (int k = 0; k < 3; k++)
        for (int theta = 0; theta <= 75; theta += 15) {
            SpecularFrame frame = specular_frame((float)radians_from_degrees(theta), EXPONENTS[k]);
            double sum = 0;
            for (uint32_t id = 0; id < geodesic_count(6); id++)
                sum += (double)f->geodesic->areas[6][id & 4095] *
                       (double)specular_frame_jacobian(&frame, geodesic_center(6, id));
            assert_close(sum, 2 * PI, 1e-3);
        }
}

TEST_PROGRAM(NULL, NULL)
