/* SPDX-License-Identifier: Apache-2.0 */
/* test_hemisphere_tree.c -- compressed trees and their queries. */
#include "hemisphere/tree/haar_tree.h"
#include "hemisphere/tree/tree_expand.h"
#include "hemisphere/tree/tree_sum.h"
#include "hemisphere_fixture.h"

#include "hemisphere/tree/tree_query.h"
/* ---- compressed trees -------------------------------------------------------------------- */

HEMISPHERE_TEST(a_query_equals_the_inverted_tree_at_every_leaf) {
    for (int variant = 0; variant < 8; variant++) {
        Arena keep = f->arena;
        HaarShape shape = {6, variant & 1 ? 2 : 4, 3, WEIGHTS[variant >> 1 & 1]};
        HaarTreeOptions options = {.shape = shape,
                                   .keep_share = 0.05f,
                                   .rows = variant & 4 ? TREE_ROWS_INT16 : TREE_ROWS_FLOAT};
        uint32_t count = haar_leaf_count(&shape);
        TreeReport report;
        float *source = leaves_of_signals(&shape, &f->arena);
        Tree tree = build_and_open(f, &options, source, &report);
        float *leaves = ARENA_NEW(&f->arena, float, 3 * count);
        tree_expand(&tree, leaves, f->arena);
        assert_int_equal(report.stored_rows, (count * 5 + 50) / 100);
        float error = 0;
        for (uint32_t id = 0; id < count; id++) {
            float value[3], again[3];
            TreeTaps taps;
            tree_value(&tree, geodesic_center(6, id), value);
            tree_walk_interpolated(&tree, geodesic_center(6, id), &taps);
            tree_sum(&tree, &taps, 1, 2, again + 1);
            for (uint32_t c = 0; c < 3; c++) {
                assert_near(value[c], leaves[3 * id + c], 3e-4);
                if (c > 0) assert_near(again[c], value[c], 1e-6);
                error = fmaxf(error, fabsf(value[c] - source[3 * id + c]));
            }
        }
        assert_close(error, report.max_error, 1e-3);
        f->arena = keep;
    }
}

HEMISPHERE_TEST(a_tree_with_everything_kept_is_its_source) {
    HaarShape shape = {5, 4, 3, HAAR_AREA};
    HaarTreeOptions options = {.shape = shape, .keep_share = 1};
    TreeReport report;
    float *source = leaves_of_signals(&shape, &f->arena);
    Tree tree = build_and_open(f, &options, source, &report);
    double squares = 0;
    uint32_t count = haar_leaf_count(&shape);
    for (uint32_t id = 0; id < count; id++) {
        float value[3];
        tree_value(&tree, geodesic_center(5, id), value);
        for (uint32_t c = 0; c < 3; c++) {
            assert_near(value[c], source[3 * id + c], 1e-3);
            squares += (double)source[3 * id + c] * (double)source[3 * id + c];
        }
    }
    assert_true((double)report.rms_error < 1e-6 * sqrt(squares / (3 * count)));
}

/* With everything kept, 16 bits are the only error; it is reported, and small. */
HEMISPHERE_TEST(quantisation_is_part_of_the_report) {
    HaarShape shape = {5, 4, 1, HAAR_AREA};
    HaarTreeOptions options = {.shape = shape, .keep_share = 1, .rows = TREE_ROWS_INT16};
    TreeReport report;
    float *source = leaves_of_signals(&shape, &f->arena), largest = 0;
    Tree tree = build_and_open(f, &options, source, &report);
    for (uint32_t id = 0; id < haar_leaf_count(&shape); id++) {
        float value;
        tree_value(&tree, geodesic_center(5, id), &value);
        largest = fmaxf(largest, fabsf(value - source[id]));
    }
    assert_close(report.max_error, largest, 0.1);
    assert_true(largest > 1e-4f && largest < 0.02f); /* of values up to 325 */
}

/* Smooth functions have small details on fine levels: these take a byte a component, and the
 * error hardly grows. 23 components are summed in all three ways: 16, 4 and 1 at a time. */
HEMISPHERE_TEST(fine_details_take_8_bits) {
    HaarShape shape = {6, 2, 23, HAAR_AREA};
    HaarTreeOptions small = {.shape = shape, .keep_share = 0.3f, .rows = TREE_ROWS_INT16};
    HaarTreeOptions wide = {.shape = shape, .keep_share = 0.3f};
    TreeReport small_report, wide_report;
    uint32_t count = haar_leaf_count(&shape);
    float *source = ARENA_NEW(&f->arena, float, 23 * count), value[23];
    for (uint32_t i = 0; i < 23 * count; i++)
        source[i] = smooth_signal(geodesic_center(6, i / 23)) * (1 + 0.1f * (float)(i % 23));
    Tree tree = build_and_open(f, &small, source, &small_report);
    float *leaves = ARENA_NEW(&f->arena, float, 23 * count);
    build_and_open(f, &wide, source, &wide_report);
    assert_true(tree.byte_row > 0 && tree.byte_row < tree.row_count / 2);
    assert_true(small_report.max_error < 1.5f * wide_report.max_error);
    assert_true(small_report.bytes < 0.5 * (double)wide_report.bytes);
    tree_expand(&tree, leaves, f->arena);
    for (uint32_t id = 0; id < count; id++) {
        tree_value(&tree, geodesic_center(6, id), value);
        for (uint32_t c = 0; c < 23; c++) {
            assert_close(value[c], leaves[23 * id + c], 1e-5);
            assert_near(value[c], source[23 * id + c], 1.01 * (double)small_report.max_error);
        }
    }
}

typedef struct Detail {
    float significance;
    uint32_t place;
} Detail;

static int larger_first(const void *a, const void *b) {
    float x = ((const Detail *)a)->significance, y = ((const Detail *)b)->significance;
    return (x < y) - (x > y);
}

/* Normalised details, largest first; octant means come before all. */
static Detail *sorted_details(const float *coefficients, const float *norms, uint32_t count,
                              Arena *arena) {
    Detail *details = ARENA_NEW(arena, Detail, count);
    for (uint32_t i = 0; i < count; i++)
        details[i] =
            (Detail){i % (count / 4) == 0 ? INFINITY : fabsf(coefficients[i]) * norms[i], i};
    qsort(details, count, sizeof *details, larger_first);
    return details;
}

/* The error is what dropping the smallest normalised details gives. Families of three details
 * are orthogonal to each other; inside one, the square error is sum a_i d_i^2 +
 * (sum a_i d_i)^2 / a_0, at most three times the sum of squares of normalised details. */
HEMISPHERE_TEST(thresholding_keeps_the_l2_bound) {
    HaarShape shape = {6, 4, 1, HAAR_AREA};
    uint32_t count = haar_leaf_count(&shape);
    float *source = leaves_of_signals(&shape, &f->arena);
    float *coefficients = ARENA_NEW(&f->arena, float, count);
    float *norms = ARENA_NEW(&f->arena, float, count);
    memcpy(coefficients, source, count * sizeof *source);
    haar_forward(&shape, coefficients, f->arena);
    haar_norms(&shape, norms, f->arena);
    Detail *details = sorted_details(coefficients, norms, count, &f->arena);
    for (float share = 0.01f; share < 0.5f; share *= 3) {
        HaarTreeOptions options = {.shape = shape, .keep_share = share};
        TreeReport report;
        Arena keep = f->arena;
        build_and_open(f, &options, source, &report);
        float *values = ARENA_NEW(&f->arena, float, count);
        double dropped = 0, error = 0;
        for (uint32_t i = 0; i < count; i++)
            if (i < report.stored_rows) values[details[i].place] = coefficients[details[i].place];
            else dropped += (double)details[i].significance * (double)details[i].significance;
        haar_inverse(&shape, values, f->arena);
        for (uint32_t i = 0; i < count; i++) {
            double e = (double)(values[i] - source[i]);
            error += (double)f->geodesic->areas[6][i % (count / 4)] * e * e;
        }
        assert_close(report.rms_error, sqrt(error / (2 * PI)), 1e-4);
        assert_true(error <= 3 * dropped * (1 + 1e-4));
        f->arena = keep;
    }
}

HEMISPHERE_TEST(options_out_of_range_are_refused_in_words) {
    HaarShape shape = {4, 4, 1, HAAR_AREA};
    HaarTreeOptions options = {.shape = shape, .keep_share = 0.5f};
    float *source = leaves_of_signals(&shape, &f->arena);
    const void *blob;
    source[7] = NAN;
    assert_fails(haar_tree_build(&options, source, &f->arena, &blob, NULL, &err),
                 "leaf 7, component 0 is nan");
    options.keep_share = 0;
    assert_fails(haar_tree_build(&options, source, &f->arena, &blob, NULL, &err),
                 "keep share is 0, required: above 0 to 1");
    options.shape.components = 0;
    assert_fails(haar_tree_build(&options, source, &f->arena, &blob, NULL, &err),
                 "components are 0");
    options.shape.octants = 3;
    assert_fails(haar_tree_build(&options, source, &f->arena, &blob, NULL, &err), "octants are 3");
    options.shape.level = 11;
    assert_fails(haar_tree_build(&options, source, &f->arena, &blob, NULL, &err),
                 "tree level is 11");
}

/* ---- interpolation ----------------------------------------------------------------------- */

/* The interpolant straight from its definition, with all leaves at hand. */
static float reference_interpolation(const float *leaves, const Geodesic *geodesic, int level,
                                     Vec3 direction) {
    GeodesicPoint p = geodesic_find(geodesic, level, direction);
    GeodesicTriangle t = geodesic_triangle(level, p.id);
    double least = (double)fminf(p.weight[0], fminf(p.weight[1], p.weight[2]));
    double value = 3 * least * (double)leaves[p.id];
    for (int k = 0; k < 3; k++) {
        double sum = 0, area = 0;
        for (uint32_t id = 0; id < geodesic_count(level); id++) {
            GeodesicTriangle other = geodesic_triangle(level, id);
            for (int i = 0; i < 3; i++) {
                if (vec3_length(vec3_sub(other.corner[i], t.corner[k])) > 1e-5f) continue;
                sum += geodesic_area(level, id) * (double)leaves[id];
                area += geodesic_area(level, id);
            }
        }
        value += ((double)p.weight[k] - least) * sum / area;
    }
    return (float)value;
}

static void check_interpolation(Fixture *f, int level, int directions) {
    HaarShape shape = {level, 4, 1, HAAR_AREA};
    uint32_t seed = 5, count = haar_leaf_count(&shape);
    float *source = ARENA_NEW(&f->arena, float, count);
    for (uint32_t i = 0; i < count; i++) source[i] = random_unit(&seed);
    HaarTreeOptions options = {.shape = shape, .keep_share = 1};
    Tree tree = build_and_open(f, &options, source, NULL);
    for (int i = 0; i < directions; i++) {
        Vec3 d = random_direction(&seed);
        float value;
        if (i % 4 == 0) d.z *= 1e-3f;              /* the horizon's leaves */
        if (i % 4 == 1) d.x *= 1e-2f, d.y *= 0.1f; /* octant borders, the pole */
        tree_interpolate(&tree, d, &value);
        assert_near(value, reference_interpolation(source, f->geodesic, level, d), 2e-5);
    }
}

HEMISPHERE_TEST(interpolation_follows_its_definition) {
    for (int level = 0; level < 3; level++) check_interpolation(f, level, 100);
    check_interpolation(f, 3, 400);
}

/* Where a tree ends early, the answer must not depend on the short ways that are then taken:
 * the same values, with every detail stored. */
HEMISPHERE_TEST(a_small_tree_interpolates_like_its_expansion) {
    HaarShape shape = {5, 4, 1, HAAR_AREA};
    HaarTreeOptions options = {.shape = shape, .keep_share = 0.03f}, all = options;
    uint32_t count = haar_leaf_count(&shape), seed = 17;
    Tree small = build_and_open(f, &options, leaves_of_signals(&shape, &f->arena), NULL);
    float *leaves = ARENA_NEW(&f->arena, float, count);
    tree_expand(&small, leaves, f->arena);
    for (uint32_t i = 0; i < count; i++) leaves[i] += 0.01f * random_unit(&seed);
    all.keep_share = 1;
    Tree whole = build_and_open(f, &all, leaves, NULL);
    for (int i = 0; i < 20000; i++) {
        Vec3 d = random_direction(&seed);
        float a, b;
        tree_interpolate(&small, d, &a);
        tree_interpolate(&whole, d, &b);
        assert_near(a, b, 0.0101);
    }
}

/* A tree of 2 octants is the tree of 4 of the function mirrored at y = 0. */
HEMISPHERE_TEST(half_trees_equal_whole_trees_of_symmetric_functions) {
    HaarShape half = {5, 2, 1, HAAR_AREA}, whole = {5, 4, 1, HAAR_AREA};
    uint32_t count = haar_leaf_count(&half), seed = 6;
    float *source = ARENA_NEW(&f->arena, float, 2 * count);
    for (uint32_t i = 0; i < count; i++) source[i] = source[i + count] = random_unit(&seed);
    HaarTreeOptions half_options = {.shape = half, .keep_share = 1};
    HaarTreeOptions whole_options = {.shape = whole, .keep_share = 1};
    Tree a = build_and_open(f, &half_options, source, NULL);
    Tree b = build_and_open(f, &whole_options, source, NULL);
    for (int i = 0; i < 3000; i++) {
        Vec3 d = random_direction(&seed);
        float x, y;
        if (i % 2) d.y *= 1e-2f;
        tree_interpolate(&a, d, &x);
        tree_interpolate(&b, d, &y);
        assert_near(x, y, 1e-5);
    }
}

HEMISPHERE_TEST(interpolation_keeps_centres_and_constants) {
    HaarShape shape = {6, 4, 3, HAAR_AREA};
    HaarTreeOptions options = {.shape = shape, .keep_share = 0.05f};
    uint32_t count = haar_leaf_count(&shape), seed = 7;
    float *source = leaves_of_signals(&shape, &f->arena);
    for (uint32_t i = 0; i < count; i++) source[3 * i + 2] = 4;
    Tree tree = build_and_open(f, &options, source, NULL);
    for (uint32_t id = 0; id < count; id++) {
        float at[3], leaf[3];
        tree_interpolate(&tree, geodesic_center(6, id), at);
        tree_value(&tree, geodesic_center(6, id), leaf);
        for (int c = 0; c < 3; c++) assert_near(at[c], leaf[c], 1e-3 * (double)fabsf(leaf[c]));
    }
    for (int i = 0; i < 5000; i++) {
        float value[3];
        tree_interpolate(&tree, random_direction(&seed), value);
        assert_close(value[2], 4, 1e-6);
    }
}

/* Half circles over the pole, across both planes between octants, and along the horizon. */
static Vec3 on_half_circle(int line, float turns) {
    float sine, cosine;
    sincos_turns(turns, &sine, &cosine);
    if (line == 0) return vec3(0.8f * sine, 0.6f * sine, cosine);
    if (line == 1) return vec3(0.954f * sine, 0.3f, 0.954f * cosine);
    if (line == 2) return vec3(0.3f, 0.954f * sine, 0.954f * cosine);
    return vec3(cosine, sine, 0);
}

/* Steps of 4e-5 radian across many edges never jump; the piecewise constant value does. */
HEMISPHERE_TEST(interpolation_is_continuous) {
    HaarShape shape = {6, 4, 1, HAAR_AREA};
    HaarTreeOptions options = {.shape = shape, .keep_share = 0.02f};
    Tree tree = build_and_open(f, &options, leaves_of_signals(&shape, &f->arena), NULL);
    const int steps = 80000;
    for (int line = 0; line < 4; line++) {
        float largest = 0, largest_plain = 0, before = 0, plain_before = 0;
        for (int i = 0; i <= steps; i++) {
            float value, plain;
            Vec3 d = on_half_circle(line, 0.5f * (float)i / (float)steps - 0.25f);
            tree_interpolate(&tree, d, &value);
            tree_value(&tree, d, &plain);
            if (i > 0) {
                largest = fmaxf(largest, fabsf(value - before));
                largest_plain = fmaxf(largest_plain, fabsf(plain - plain_before));
            }
            before = value;
            plain_before = plain;
        }
        if (!(largest < 0.2f)) fail_msg("line %d: a step of %g", line, (double)largest);
        assert_true(largest_plain > 20 * largest);
    }
}

TEST_PROGRAM(NULL, NULL)
