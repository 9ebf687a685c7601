/* test_hemisphere.c -- the laws of triangles, transforms, trees and sampling. */
#include "check.h"

#include <stdlib.h>
#include <string.h>

#include "base/mathf.h"
#include "base/sampler.h"
#include "base/units.h"
#include "hemisphere/sampling_tree.h"
#include "hemisphere/specular_frame.h"
#include "hemisphere/tree_query.h"
#include "hemisphere/wavelet1d.h"

#define LEVEL 7

typedef struct Fixture {
    Arena           arena; /* for the test; copies are its scratch */
    const Geodesic *geodesic;
} Fixture;

static int set_up(void **state)
{
    Fixture *fixture = malloc(sizeof *fixture);
    fixture->arena = arena_reserve((size_t)1 << 30);
    fixture->geodesic = geodesic_create(LEVEL, &fixture->arena);
    *state = fixture;
    return 0;
}

static int tear_down(void **state)
{
    Fixture *fixture = *state;
    arena_release(&fixture->arena);
    free(fixture);
    return 0;
}

/* The test's own numbers: one stream, always the same. */
static float random_unit(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return unit_float(hash_u32(*seed));
}

static Vec3 random_direction(uint32_t *seed)
{
    float z = random_unit(seed), across = sqrtf(1 - z * z), sine, cosine;
    sincos_turns(random_unit(seed), &sine, &cosine);
    return vec3(across * cosine, across * sine, z);
}

/* A display-like luminance, an anti-glare haze in the stored frame, a narrow peak. */
static float smooth_signal(Vec3 d)
{
    return 300 * d.z * d.z + 40 * d.x * d.z + 20 * d.y + 25;
}

static float peak_signal(Vec3 d)
{
    float angle = acos_f(d.z) + 0.1f * d.x;
    return 1 / (0.01f + angle * angle) + 0.2f;
}

static float zero_outside_signal(Vec3 d)
{
    return d.x > 0.3f && d.z > 0.2f ? peak_signal(d) : 0.0f;
}

typedef float (*Signal)(Vec3);
static const Signal SIGNALS[] = {smooth_signal, peak_signal, zero_outside_signal};

/* Leaf values: component c is signal c of the table at the leaf's centre. */
static float *leaves_of_signals(const HaarShape *shape, Arena *arena)
{
    uint32_t count = haar_leaf_count(shape);
    float   *leaves = ARENA_NEW(arena, float, count * (uint32_t)shape->components);
    for (uint32_t leaf = 0; leaf < count; leaf++) {
        Vec3 center = geodesic_center(shape->level, leaf);
        for (int c = 0; c < shape->components; c++)
            leaves[leaf * (uint32_t)shape->components + (uint32_t)c] = SIGNALS[c % 3](center);
    }
    return leaves;
}

static Tree build_and_open(Fixture *f, const TreeOptions *options, const float *leaves,
                           TreeReport *report)
{
    const void *blob;
    Tree        tree;
    Error       err;
    if (!tree_build(options, leaves, &f->arena, &blob, report, &err)) fail_msg("%s", err.text);
    if (!tree_open(blob, tree_size(blob), f->geodesic, &tree, &err)) fail_msg("%s", err.text);
    return tree;
}

/* ---- geodesic ----------------------------------------------------------------------------- */

static void a_level_has_4_to_the_level_plus_1_triangles(void **state)
{
    Fixture *f = *state;
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

static void areas_of_a_level_sum_to_the_hemisphere(void **state)
{
    Fixture *f = *state;
    for (int level = 0; level <= 8; level++) {
        Arena   scratch = f->arena;
        double *areas = ARENA_NEW(&scratch, double, 1u << 2 * level), sum = 0;
        geodesic_areas(level, areas);
        for (uint32_t i = 0; i < 1u << 2 * level; i++) sum += 4 * areas[i];
        assert_near(sum, 2 * PI, 1e-9);
        assert_close(areas[0], geodesic_area(level, 0), 1e-12);
    }
}

static void children_cover_their_father_exactly(void **state)
{
    (void)state;
    for (int level = 0; level < 6; level++)
        for (uint32_t id = 0; id < geodesic_count(level); id += 7) {
            double sum = 0;
            for (uint32_t i = 0; i < 4; i++) sum += geodesic_area(level + 1, 4 * id + i);
            assert_close(sum, geodesic_area(level, id), 1e-12);
        }
}

static void tables_agree_with_geometry(void **state)
{
    Fixture *f = *state;
    for (int level = 0; level < LEVEL; level++)
        for (uint32_t id = 0; id < 1u << 2 * level; id += 5) {
            const float     *cosines = f->geodesic->edges[level][id].half_cos;
            const float     *ratios = f->geodesic->ratios[level][id].of_child;
            GeodesicTriangle t = geodesic_triangle(level, id);
            double           middle = geodesic_area(level + 1, 4 * id);
            for (uint32_t i = 0; i < 3; i++) {
                Vec3 sum = vec3_add(t.corner[(i + 1) % 3], t.corner[(i + 2) % 3]);
                assert_close(cosines[i], 0.5f * vec3_length(sum), 1e-6);
                assert_close(ratios[i], geodesic_area(level + 1, 4 * id + i + 1) / middle, 1e-6);
            }
            assert_close(f->geodesic->areas[level][id], geodesic_area(level, id), 1e-6);
        }
}

static void the_leaf_of_a_leafs_centre_is_that_leaf(void **state)
{
    Fixture *f = *state;
    for (int level = 0; level <= LEVEL; level++)
        for (uint32_t id = 0; id < geodesic_count(level); id++) {
            GeodesicPoint p = geodesic_find(f->geodesic, level, geodesic_center(level, id));
            assert_int_equal(p.id, id);
            for (int i = 0; i < 3; i++) assert_near(p.weight[i], 1 / 3.0, 1e-4);
        }
}

static void a_found_leaf_holds_its_direction(void **state)
{
    Fixture *f = *state;
    uint32_t seed = 1;
    for (int i = 0; i < 20000; i++) {
        Vec3             d = random_direction(&seed);
        int              level = i % (LEVEL + 1);
        GeodesicPoint    p = geodesic_find(f->geodesic, level, d);
        GeodesicTriangle t = geodesic_triangle(level, p.id);
        Vec3             sum = {0, 0, 0};
        for (int k = 0; k < 3; k++) {
            Vec3  a = t.corner[(k + 1) % 3], b = t.corner[(k + 2) % 3];
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

static void ids_below_half_have_y_of_at_least_0(void **state)
{
    (void)state;
    for (uint32_t id = 0; id < geodesic_count(4); id++)
        assert_int_equal(geodesic_center(4, id).y > 0, id < geodesic_count(4) / 2);
}

static void mirrored_directions_have_mirrored_leaves(void **state)
{
    Fixture *f = *state;
    uint32_t seed = 2;
    for (int i = 0; i < 1000; i++) {
        Vec3     d = random_direction(&seed);
        uint32_t id = geodesic_find(f->geodesic, 6, d).id;
        assert_int_equal(geodesic_find(f->geodesic, 6, vec3(-d.x, d.y, d.z)).id, id ^ 1u << 12);
        assert_int_equal(geodesic_find(f->geodesic, 6, vec3(d.x, -d.y, d.z)).id, id ^ 2u << 12);
    }
}

/* Two triangles touch in an edge when they share exactly two corners. */
static void neighbours_share_an_edge_and_are_neighbours_of_each_other(void **state)
{
    (void)state;
    const int level = 4;
    int       borders = 0;
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

static void sampling_a_triangle_is_uniform_and_inverts(void **state)
{
    Fixture *f = *state;
    uint32_t seed = 3;
    for (int level = 0; level <= LEVEL; level++)
        for (int trial = 0; trial < 3; trial++) {
            uint32_t id = hash_u32((uint32_t)(level * 3 + trial)) % geodesic_count(level);
            GeodesicTriangle t = geodesic_triangle(level, id);
            float            area = (float)geodesic_area(level, id);
            int              hits[4] = {0}, wrong = 0;
            const int        count = 4000;
            for (int i = 0; i < count; i++) {
                float u0 = random_unit(&seed), u1 = random_unit(&seed);
                Vec3  d = geodesic_sample_triangle(&t, area, u0, u1);
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

/* ---- Haar ------------------------------------------------------------------------------------ */

static const HaarWeights WEIGHTS[] = {HAAR_EQUAL, HAAR_AREA};

static void the_haar_transform_inverts_exactly(void **state)
{
    Fixture *f = *state;
    for (int octants = 2; octants <= 4; octants += 2)
        for (size_t w = 0; w < 2; w++) {
            Arena     scratch = f->arena;
            HaarShape shape = {LEVEL, octants, 3, WEIGHTS[w]};
            size_t    count = haar_leaf_count(&shape) * 3ull;
            float    *source = leaves_of_signals(&shape, &scratch);
            float    *work = ARENA_NEW(&scratch, float, count), largest = 0;
            memcpy(work, source, count * sizeof *work);
            haar_forward(&shape, work, scratch);
            haar_inverse(&shape, work, scratch);
            for (size_t i = 0; i < count; i++) largest = fmaxf(largest, fabsf(source[i]));
            for (size_t i = 0; i < count; i++)
                assert_near(work[i], source[i], 1e-6 * (double)largest);
        }
}

static void area_weighted_octant_means_are_integral_means(void **state)
{
    Fixture  *f = *state;
    Arena     scratch = f->arena;
    HaarShape shape = {LEVEL, 4, 1, HAAR_AREA};
    float    *values = leaves_of_signals(&shape, &scratch);
    double   *areas = ARENA_NEW(&scratch, double, 1u << 2 * LEVEL), sum[4] = {0};
    geodesic_areas(LEVEL, areas);
    uint32_t octant = 1u << 2 * LEVEL;
    for (uint32_t i = 0; i < 4 * octant; i++)
        sum[i / octant] += (double)values[i] * areas[i % octant];
    haar_forward(&shape, values, scratch);
    for (uint32_t q = 0; q < 4; q++) assert_close(values[q * octant], sum[q] / (PI / 2), 1e-6);
}

static void equal_weights_give_plain_means(void **state)
{
    Fixture  *f = *state;
    Arena     scratch = f->arena;
    HaarShape shape = {1, 4, 1, HAAR_EQUAL};
    float     values[16];
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
static void norms_say_what_a_detail_is_worth(void **state)
{
    Fixture *f = *state;
    for (size_t w = 0; w < 2; w++) {
        Arena     scratch = f->arena;
        HaarShape shape = {3, 4, 1, WEIGHTS[w]};
        float    *norms = ARENA_NEW(&scratch, float, 256), *values;
        double   *areas = ARENA_NEW(&scratch, double, 64);
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

/* ---- wavelets over wavelength ------------------------------------------------------------ */

static const WaveletKind KINDS[] = {WAVELET_HAAR, WAVELET_CDF53, WAVELET_CDF97};

static void one_dimensional_wavelets_invert_at_every_length(void **state)
{
    (void)state;
    uint32_t seed = 4;
    for (size_t k = 0; k < 3; k++)
        for (int count = 1; count <= 130; count++) {
            float row[130], source[130];
            for (int i = 0; i < count; i++) source[i] = row[i] = random_unit(&seed) * 10 - 3;
            wavelet1d_forward(KINDS[k], row, count);
            wavelet1d_inverse(KINDS[k], row, count);
            for (int i = 0; i < count; i++) assert_near(row[i], source[i], 1e-5);
        }
}

static void constants_have_no_details(void **state)
{
    (void)state;
    for (size_t k = 0; k < 3; k++)
        for (int count = 1; count <= 65; count += 4) {
            float row[65];
            for (int i = 0; i < count; i++) row[i] = 5;
            wavelet1d_forward(KINDS[k], row, count);
            assert_close(row[0], 5, 1e-5);
            for (int i = 1; i < count; i++) assert_near(row[i], 0, 1e-5);
        }
}

/* Vanishing moments: straight lines for 5/3, cubics for 9/7, away from the ends. */
static void smooth_rows_have_small_details(void **state)
{
    (void)state;
    float line[64], cubic[64];
    for (int i = 0; i < 64; i++) {
        float x = ((float)i - 32) / 32;
        line[i] = 2 + x;
        cubic[i] = 1 + x - 2 * x * x + x * x * x;
    }
    wavelet1d_forward(WAVELET_CDF53, line, 64);
    for (int i = 33; i < 62; i++) assert_near(line[i], 0, 1e-6);
    wavelet1d_forward(WAVELET_CDF97, cubic, 64);
    for (int i = 35; i < 61; i++) assert_near(cubic[i], 0, 1e-6);
}

static void wavelet_norms_are_positive_and_haars_are_known(void **state)
{
    (void)state;
    float norms[8];
    wavelet1d_norms(WAVELET_HAAR, 8, norms);
    assert_close(norms[0], sqrt(8), 1e-6);
    assert_close(norms[1], 0.5 * sqrt(8), 1e-6);
    assert_close(norms[7], 0.5 * sqrt(2), 1e-6);
    wavelet1d_norms(WAVELET_CDF97, 8, norms);
    for (int i = 0; i < 8; i++) assert_true(norms[i] > 0.1f);
}

/* ---- compressed trees ---------------------------------------------------------------------- */

static void a_query_equals_the_inverted_tree_at_every_leaf(void **state)
{
    Fixture *f = *state;
    for (int variant = 0; variant < 8; variant++) {
        Arena       keep = f->arena;
        HaarShape   shape = {6, variant & 1 ? 2 : 4, 3, WEIGHTS[variant >> 1 & 1]};
        TreeOptions options = {.shape = shape, .keep_share = 0.05f,
                               .rows = variant & 4 ? TREE_ROWS_INT16 : TREE_ROWS_FLOAT};
        uint32_t    count = haar_leaf_count(&shape);
        TreeReport  report;
        float      *source = leaves_of_signals(&shape, &f->arena);
        Tree        tree = build_and_open(f, &options, source, &report);
        float      *leaves = ARENA_NEW(&f->arena, float, 3 * count);
        tree_expand(&tree, leaves, f->arena);
        assert_int_equal(report.stored_rows, (count * 5 + 50) / 100);
        float error = 0;
        for (uint32_t id = 0; id < count; id++) {
            float value[3], again[3];
            TreeTaps taps;
            tree_value(&tree, geodesic_center(6, id), value);
            tree_walk_triangle(&tree, 6, id, &taps);
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

static void a_tree_with_everything_kept_is_its_source(void **state)
{
    Fixture    *f = *state;
    HaarShape   shape = {5, 4, 3, HAAR_AREA};
    TreeOptions options = {.shape = shape, .keep_share = 1};
    TreeReport  report;
    float      *source = leaves_of_signals(&shape, &f->arena);
    Tree        tree = build_and_open(f, &options, source, &report);
    for (uint32_t id = 0; id < haar_leaf_count(&shape); id++) {
        float value[3];
        tree_value(&tree, geodesic_center(5, id), value);
        for (uint32_t c = 0; c < 3; c++) assert_near(value[c], source[3 * id + c], 1e-3);
    }
    assert_true(report.relative_l2 < 1e-6f);
}

static int larger_first(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x < y) - (x > y);
}

/* Families of three details are orthogonal to each other; inside one, the square error is
 * sum a_i d_i^2 + (sum a_i d_i)^2 / a_0, at most three times the sum of squares of normalised
 * details (Cauchy and Schwarz). */
static void thresholding_keeps_the_l2_bound(void **state)
{
    Fixture  *f = *state;
    Arena     scratch = f->arena;
    HaarShape shape = {6, 4, 1, HAAR_AREA};
    uint32_t  count = haar_leaf_count(&shape);
    float    *source = leaves_of_signals(&shape, &scratch);
    float    *coefficients = ARENA_NEW(&scratch, float, count);
    float    *norms = ARENA_NEW(&scratch, float, count);
    double   *squares = ARENA_NEW(&scratch, double, count);
    memcpy(coefficients, source, count * sizeof *source);
    haar_forward(&shape, coefficients, scratch);
    haar_norms(&shape, norms, scratch);
    for (uint32_t i = 0; i < count; i++) {
        double d = i % (count / 4) == 0 ? 0 : (double)coefficients[i] * (double)norms[i];
        squares[i] = d * d;
    }
    qsort(squares, count, sizeof *squares, larger_first);
    for (float share = 0.01f; share < 0.5f; share *= 3) {
        TreeOptions options = {.shape = shape, .keep_share = share};
        TreeReport  report;
        const void *blob;
        Error       err;
        Arena       inner = scratch;
        assert_true(tree_build(&options, source, &inner, &blob, &report, &err));
        double dropped = 0, error = (double)report.rms_error * (double)report.rms_error * 2 * PI;
        for (uint32_t i = report.stored_rows - 4; i < count; i++) dropped += squares[i];
        assert_true(error <= 3 * dropped * (1 + 1e-4));
        assert_true(error >= dropped * 0.1); /* and the bound is not an empty one */
    }
}

static void an_error_bound_holds_at_every_leaf(void **state)
{
    Fixture *f = *state;
    for (int rows = 0; rows < 2; rows++) {
        Arena       keep = f->arena;
        HaarShape   shape = {5, 2, 2, HAAR_AREA};
        const float scale[2] = {0.1f, 1};
        TreeOptions options = {.shape = shape, .max_error = 0.3f, .component_scale = scale,
                               .rows = (TreeRowFormat)rows};
        uint32_t    count = haar_leaf_count(&shape);
        TreeReport  report;
        float      *source = leaves_of_signals(&shape, &f->arena);
        Tree        tree = build_and_open(f, &options, source, &report);
        for (uint32_t id = 0; id < count; id++) {
            float value[2];
            tree_value(&tree, geodesic_center(5, id), value);
            for (uint32_t c = 0; c < 2; c++)
                assert_true(scale[c] * fabsf(value[c] - source[2 * id + c]) <= 0.3001f);
        }
        assert_true(report.stored_rows < count);
        f->arena = keep;
    }
}

static void an_unreachable_bound_is_refused_in_words(void **state)
{
    Fixture    *f = *state;
    Arena       scratch = f->arena;
    HaarShape   shape = {4, 4, 1, HAAR_AREA};
    TreeOptions options = {.shape = shape, .max_error = 1e-6f, .rows = TREE_ROWS_INT16};
    float      *source = leaves_of_signals(&shape, &scratch);
    const void *blob;
    Error       err;
    assert_false(tree_build(&options, source, &scratch, &blob, NULL, &err));
    assert_non_null(strstr(err.text, "wanted at most 1e-06"));
    source[7] = NAN;
    assert_false(tree_build(&options, source, &scratch, &blob, NULL, &err));
    assert_non_null(strstr(err.text, "leaf 7, component 0 is nan"));
    options.keep_share = 0.5f;
    assert_false(tree_build(&options, source, &scratch, &blob, NULL, &err));
    assert_non_null(strstr(err.text, "wanted one of them above 0"));
    options.shape.components = 0;
    assert_false(tree_build(&options, source, &scratch, &blob, NULL, &err));
    assert_non_null(strstr(err.text, "components are 0"));
    options.shape.octants = 3;
    assert_false(tree_build(&options, source, &scratch, &blob, NULL, &err));
    assert_non_null(strstr(err.text, "octants are 3"));
    options.shape.level = 11;
    assert_false(tree_build(&options, source, &scratch, &blob, NULL, &err));
    assert_non_null(strstr(err.text, "tree level is 11"));
}

/* Every mean of the tree is the exact mean of its leaves. */
static void a_mean_at_any_level_is_the_mean_of_its_leaves(void **state)
{
    Fixture    *f = *state;
    HaarShape   shape = {6, 4, 1, HAAR_AREA};
    TreeOptions options = {.shape = shape, .keep_share = 0.03f};
    uint32_t    count = haar_leaf_count(&shape);
    TreeReport  report;
    float      *source = leaves_of_signals(&shape, &f->arena);
    Tree        tree = build_and_open(f, &options, source, &report);
    float      *leaves = ARENA_NEW(&f->arena, float, count);
    tree_expand(&tree, leaves, f->arena);
    for (int level = 0; level <= 6; level++)
        for (uint32_t id = 0; id < geodesic_count(level); id++) {
            uint32_t first = id << 2 * (6 - level), leaf_count = 1u << 2 * (6 - level);
            double   sum = 0, area = 0;
            float    mean;
            if (level < 4 || id % 17 == 0) {
                for (uint32_t i = first; i < first + leaf_count; i++) {
                    double a = (double)f->geodesic->areas[6][i & 4095];
                    area += a;
                    sum += a * (double)leaves[i];
                }
                tree_mean(&tree, level, geodesic_center(level, id), &mean);
                assert_near(mean, sum / area, 1e-3);
            }
        }
}

/* ---- interpolation -------------------------------------------------------------------------- */

/* The interpolant straight from its definition, with all leaves at hand. */
static float reference_interpolation(const float *leaves, const Geodesic *geodesic, int level,
                                     Vec3 direction)
{
    GeodesicPoint    p = geodesic_find(geodesic, level, direction);
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

static void interpolation_follows_its_definition(void **state)
{
    Fixture  *f = *state;
    HaarShape shape = {3, 4, 1, HAAR_AREA};
    uint32_t  seed = 5, count = haar_leaf_count(&shape);
    float    *source = ARENA_NEW(&f->arena, float, count);
    for (uint32_t i = 0; i < count; i++) source[i] = random_unit(&seed);
    TreeOptions options = {.shape = shape, .keep_share = 1};
    Tree        tree = build_and_open(f, &options, source, NULL);
    for (int i = 0; i < 400; i++) {
        Vec3  d = random_direction(&seed);
        float value;
        if (i % 4 == 0) d.z *= 1e-3f; /* the horizon's leaves */
        if (i % 4 == 1) d.x *= 1e-2f, d.y *= 0.1f; /* octant borders, the pole */
        tree_interpolate(&tree, d, &value);
        assert_near(value, reference_interpolation(source, f->geodesic, 3, d), 2e-5);
    }
}

/* A tree of 2 octants is the tree of 4 of the function mirrored at y = 0. */
static void half_trees_equal_whole_trees_of_symmetric_functions(void **state)
{
    Fixture    *f = *state;
    HaarShape   half = {5, 2, 1, HAAR_AREA}, whole = {5, 4, 1, HAAR_AREA};
    uint32_t    count = haar_leaf_count(&half), seed = 6;
    float      *source = ARENA_NEW(&f->arena, float, 2 * count);
    for (uint32_t i = 0; i < count; i++) source[i] = source[i + count] = random_unit(&seed);
    TreeOptions half_options = {.shape = half, .keep_share = 1};
    TreeOptions whole_options = {.shape = whole, .keep_share = 1};
    Tree        a = build_and_open(f, &half_options, source, NULL);
    Tree        b = build_and_open(f, &whole_options, source, NULL);
    for (int i = 0; i < 3000; i++) {
        Vec3  d = random_direction(&seed);
        float x, y;
        if (i % 2) d.y *= 1e-2f;
        tree_interpolate(&a, d, &x);
        tree_interpolate(&b, d, &y);
        assert_near(x, y, 1e-5);
        tree_mean(&a, i % 6, d, &x);
        tree_mean(&b, i % 6, d, &y);
        assert_near(x, y, 1e-5);
    }
}

static void interpolation_keeps_centres_and_constants(void **state)
{
    Fixture    *f = *state;
    HaarShape   shape = {6, 4, 3, HAAR_AREA};
    TreeOptions options = {.shape = shape, .keep_share = 0.05f};
    uint32_t    count = haar_leaf_count(&shape), seed = 7;
    float      *source = leaves_of_signals(&shape, &f->arena);
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

/* Across many edges: steps of 1e-5 radian never jump; the piecewise constant value does. */
static void interpolation_is_continuous(void **state)
{
    Fixture    *f = *state;
    HaarShape   shape = {6, 4, 1, HAAR_AREA};
    TreeOptions options = {.shape = shape, .keep_share = 0.02f};
    Tree        tree = build_and_open(f, &options, leaves_of_signals(&shape, &f->arena), NULL);
    float       largest = 0, largest_plain = 0, before = 0, plain_before = 0;
    for (int line = 0; line < 4; line++)
        for (int i = 0; i < 40000; i++) {
            float sine, cosine, value, plain;
            sincos_turns(0.25f * (float)i / 40000, &sine, &cosine);
            Vec3 d = line < 2 ? vec3(sine * 0.8f, sine * (line ? -0.6f : 0.6f), cosine)
                              : vec3(cosine * 0.7f, sine * 0.7f, line == 2 ? 0.7f : 0.0f);
            tree_interpolate(&tree, d, &value);
            tree_value(&tree, d, &plain);
            if (i > 0) {
                largest = fmaxf(largest, fabsf(value - before));
                largest_plain = fmaxf(largest_plain, fabsf(plain - plain_before));
            }
            before = value;
            plain_before = plain;
        }
    assert_true(largest < 0.4f);
    assert_true(largest_plain > 20 * largest);
}

/* ---- hostile blobs ---------------------------------------------------------------------------- */

static void query_everything(const Tree *tree, Arena scratch)
{
    uint32_t seed = 8;
    float    value[TREE_MAX_COMPONENTS];
    for (int i = 0; i < 16; i++) {
        Vec3 d = random_direction(&seed);
        tree_interpolate(tree, d, value);
        tree_value(tree, d, value);
    }
    float *leaves = ARENA_NEW(&scratch, float,
                              ((size_t)tree->octants << 2 * tree->level) *
                                  (size_t)tree->components);
    tree_expand(tree, leaves, scratch);
}

/* A copy that ends where its memory ends, so that the sanitizer sees any step beyond. */
static void try_tree(const Fixture *f, const char *blob, size_t size, int *opened)
{
    char *copy = malloc(size ? size : 1);
    Tree  tree;
    Error err = {0};
    memcpy(copy, blob, size);
    if (tree_open(copy, size, f->geodesic, &tree, &err)) {
        query_everything(&tree, f->arena);
        (*opened)++;
    } else {
        assert_true(err.text[0] != 0);
    }
    free(copy);
}

static void mutate(char *bytes, size_t size, uint32_t *seed)
{
    for (int i = 0; i < 1 + (int)(random_unit(seed) * 3); i++) {
        size_t limit = random_unit(seed) < 0.5f && size > 64 ? 64 : size;
        size_t at = (size_t)(random_unit(seed) * (float)limit);
        float  kind = random_unit(seed);
        bytes[at] = kind < 0.4f   ? (char)(bytes[at] ^ (1 << (int)(random_unit(seed) * 8)))
                    : kind < 0.7f ? (char)(random_unit(seed) * 256)
                    : kind < 0.8f ? (char)0xff
                    : kind < 0.9f ? (char)0
                                  : (char)(bytes[at] + 1);
    }
}

static void mutated_trees_are_refused_or_harmless(void **state)
{
    Fixture *f = *state;
    for (int rows = 0; rows < 2; rows++) {
        HaarShape   shape = {3, 4, 2, HAAR_AREA};
        TreeOptions options = {.shape = shape, .keep_share = 0.1f, .rows = (TreeRowFormat)rows};
        const void *blob;
        Error       err;
        uint32_t    seed = 9;
        int         opened = 0;
        float      *source = leaves_of_signals(&shape, &f->arena);
        assert_true(tree_build(&options, source, &f->arena, &blob, NULL, &err));
        size_t size = tree_size(blob);
        for (size_t prefix = 0; prefix < size; prefix++)
            try_tree(f, blob, prefix, &opened);
        assert_int_equal(opened, 0);
        char *copy = ARENA_NEW(&f->arena, char, size);
        for (int i = 0; i < 6000; i++) {
            memcpy(copy, blob, size);
            mutate(copy, size, &seed);
            try_tree(f, copy, size, &opened);
        }
        assert_true(opened > 100); /* changed numbers, same structure */
        assert_true(opened < 5000);
    }
}

static void a_bad_header_is_named(void **state)
{
    Fixture    *f = *state;
    HaarShape   shape = {3, 4, 1, HAAR_AREA};
    TreeOptions options = {.shape = shape, .keep_share = 0.5f};
    const void *blob;
    Error       err;
    Tree        tree;
    assert_true(tree_build(&options, leaves_of_signals(&shape, &f->arena), &f->arena, &blob,
                           NULL, &err));
    size_t size = tree_size(blob);
    char  *copy = arena_alloc(&f->arena, 1, 16, size + 8);
    assert_false(tree_open((const char *)blob + 4, size, f->geodesic, &tree, &err));
    assert_non_null(strstr(err.text, "multiple of 8"));
    assert_false(tree_open(blob, 20, f->geodesic, &tree, &err));
    assert_non_null(strstr(err.text, "number of bytes is 20"));
    assert_false(tree_open(blob, size, geodesic_create(2, &f->arena), &tree, &err));
    assert_non_null(strstr(err.text, "level of the geodesic is 2, wanted 3"));
    memcpy(copy, blob, size);
    copy[0] ^= 1;
    assert_false(tree_open(copy, size, f->geodesic, &tree, &err));
    assert_non_null(strstr(err.text, "magic number"));
    memcpy(copy, blob, size);
    ((TreeHeader *)(void *)copy)->version = 7;
    assert_false(tree_open(copy, size, f->geodesic, &tree, &err));
    assert_non_null(strstr(err.text, "version is 7, wanted 1"));
}

/* ---- specular frame ---------------------------------------------------------------------------- */

static const float EXPONENTS[] = {1, 2, 1.5f};

static void the_specular_frame_round_trips(void **state)
{
    (void)state;
    uint32_t seed = 10;
    for (int k = 0; k < 3; k++)
        for (int theta = 0; theta <= 89; theta++) {
            SpecularFrame frame = specular_frame((float)radians_from_degrees(theta), EXPONENTS[k]);
            for (int i = 0; i < 40; i++) {
                Vec3 d = random_direction(&seed);
                Vec3 back = specular_frame_outer(&frame, specular_frame_stored(&frame, d));
                assert_true(vec3_length(vec3_sub(back, d)) < 2e-5f);
                back = specular_frame_stored(&frame, specular_frame_outer(&frame, d));
                assert_true(vec3_length(vec3_sub(back, d)) < (theta > 80 ? 2e-3f : 2e-4f));
            }
        }
}

static void the_horizon_stays_the_horizon_and_the_peak_is_the_pole(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++)
        for (int theta = 0; theta <= 80; theta += 10) {
            float         angle = (float)radians_from_degrees(theta);
            SpecularFrame frame = specular_frame(angle, EXPONENTS[k]);
            Vec3          mirror = vec3(sinf(angle), 0, cosf(angle));
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
static void the_jacobian_agrees_with_differences(void **state)
{
    (void)state;
    uint32_t seed = 11;
    for (int i = 0; i < 2000; i++) {
        float theta = (float)radians_from_degrees(85 * (double)random_unit(&seed));
        SpecularFrame frame = specular_frame(theta, EXPONENTS[i % 3]);
        Vec3          d = random_direction(&seed);
        if (d.z < 0.02f || d.z > 0.98f) continue;
        Frame axes = frame_from_z(d);
        float h = 2e-3f;
        Vec3  x = specular_frame_outer(&frame, vec3_normalize(vec3_along(d, axes.x, h)));
        Vec3  y = specular_frame_outer(&frame, vec3_normalize(vec3_along(d, axes.y, h)));
        Vec3  u = specular_frame_outer(&frame, vec3_normalize(vec3_along(d, axes.x, -h)));
        Vec3  v = specular_frame_outer(&frame, vec3_normalize(vec3_along(d, axes.y, -h)));
        float area = vec3_length(vec3_cross(vec3_sub(x, u), vec3_sub(y, v))) / (4 * h * h);
        assert_close(area, specular_frame_jacobian(&frame, d), 5e-3);
    }
}

/* The integral of J over the stored hemisphere is the outer hemisphere. */
static void the_jacobian_integrates_to_the_hemisphere(void **state)
{
    Fixture *f = *state;
    for (int k = 0; k < 3; k++)
        for (int theta = 0; theta <= 75; theta += 15) {
            SpecularFrame frame = specular_frame((float)radians_from_degrees(theta), EXPONENTS[k]);
            double        sum = 0;
            for (uint32_t id = 0; id < geodesic_count(6); id++)
                sum += (double)f->geodesic->areas[6][id & 4095] *
                       (double)specular_frame_jacobian(&frame, geodesic_center(6, id));
            assert_close(sum, 2 * PI, 1e-3);
        }
}

/* ---- sampling trees ---------------------------------------------------------------------------- */

static SamplingTree sampler_of(Fixture *f, SamplingOptions options, Signal signal)
{
    uint32_t count = (uint32_t)options.octants << 2 * options.level;
    float   *integrals = ARENA_NEW(&f->arena, float, count);
    uint32_t mask = (1u << 2 * options.level) - 1;
    for (uint32_t i = 0; i < count; i++) {
        Vec3 center = geodesic_center(options.level, i);
        integrals[i] = signal(center) * center.z * f->geodesic->areas[options.level][i & mask];
    }
    const void  *blob;
    SamplingTree tree;
    Error        err;
    if (!sampling_tree_build(&options, integrals, &f->arena, &blob, &err)) fail_msg("%s", err.text);
    if (!sampling_tree_open(blob, sampling_tree_size(blob), f->geodesic, &tree, &err))
        fail_msg("%s", err.text);
    return tree;
}

static void the_pdf_integrates_to_1(void **state)
{
    Fixture *f = *state;
    for (int variant = 0; variant < 12; variant++) {
        SamplingOptions options = {.level = 6, .octants = variant % 2 ? 2 : 4,
                                   .cells = variant < 6 ? 655 : 100,
                                   .uniform_share = variant % 4 < 2 ? 0 : 0.1f};
        SamplingTree tree = sampler_of(f, options, SIGNALS[variant % 3]);
        double       sum = 0;
        for (uint32_t id = 0; id < geodesic_count(6); id++)
            sum += (double)f->geodesic->areas[6][id & 4095] *
                   (double)sampling_tree_pdf(&tree, geodesic_center(6, id));
        assert_close(sum, 1, 1e-5);
    }
}

static void samples_follow_the_pdf(void **state)
{
    Fixture  *f = *state;
    uint32_t  seed = 12;
    const int count = 200000;
    for (int variant = 0; variant < 6; variant++) {
        SamplingOptions options = {.level = 6, .octants = variant % 2 ? 2 : 4, .cells = 400,
                                   .uniform_share = variant == 4 ? 0.2f : 0};
        SamplingTree tree = sampler_of(f, options, SIGNALS[variant % 3]);
        Arena        scratch = f->arena;
        int         *hits = ARENA_NEW(&scratch, int, geodesic_count(4));
        double      *expected = ARENA_NEW(&scratch, double, geodesic_count(4)), chi = 0;
        for (int i = 0; i < count; i++) {
            float          u0 = random_unit(&seed), u1 = random_unit(&seed);
            SamplingResult s = sampling_tree_sample(&tree, u0, u1);
            assert_true(s.pdf > 0 && s.direction.z >= 0);
            assert_true(s.pdf == sampling_tree_pdf(&tree, s.direction));
            hits[geodesic_find(f->geodesic, 4, s.direction).id]++;
        }
        for (uint32_t id = 0; id < geodesic_count(6); id++)
            expected[id >> 4] += count * (double)f->geodesic->areas[6][id & 4095] *
                                 (double)sampling_tree_pdf(&tree, geodesic_center(6, id));
        int    bins = 0, pooled_hits = 0;
        double pooled = 0;
        for (uint32_t id = 0; id < geodesic_count(4); id++) {
            pooled += expected[id];
            pooled_hits += hits[id];
            if (pooled < 10) continue;
            chi += (pooled_hits - pooled) * (pooled_hits - pooled) / pooled;
            bins++;
            pooled = pooled_hits = 0;
        }
        double z = (chi - (bins - 1)) / sqrt(2.0 * (bins - 1));
        if (!(fabs(z) < 4.5)) fail_msg("variant %d: chi-square %g with %d bins", variant, chi, bins);
    }
}

static void the_density_is_positive_where_the_function_is(void **state)
{
    Fixture        *f = *state;
    uint32_t        seed = 13;
    SamplingOptions options = {.level = 6, .octants = 4, .cells = 60};
    SamplingTree    tree = sampler_of(f, options, zero_outside_signal);
    for (uint32_t id = 0; id < geodesic_count(6); id++) {
        Vec3 center = geodesic_center(6, id);
        if (zero_outside_signal(center) > 0) assert_true(sampling_tree_pdf(&tree, center) > 0);
    }
    options.uniform_share = 0.01f;
    tree = sampler_of(f, options, zero_outside_signal);
    for (int i = 0; i < 1000; i++)
        assert_true(sampling_tree_pdf(&tree, random_direction(&seed)) >= 0.0099f / (2 * PI_F));
    assert_true(sampling_tree_pdf(&tree, vec3(0, 0, -1)) == 0);
}

/* Importance sampling beats cosine sampling by far on a narrow peak. */
static void weights_of_importance_samples_vary_little(void **state)
{
    Fixture        *f = *state;
    uint32_t        seed = 14;
    SamplingOptions options = {.level = 7, .octants = 4, .cells = 655};
    SamplingTree    tree = sampler_of(f, options, peak_signal);
    double          sum = 0, squares = 0;
    const int       count = 50000;
    for (int i = 0; i < count; i++) {
        float          u0 = random_unit(&seed), u1 = random_unit(&seed);
        SamplingResult s = sampling_tree_sample(&tree, u0, u1);
        double         w = (double)(peak_signal(s.direction) * s.direction.z / s.pdf);
        sum += w;
        squares += w * w;
    }
    double mean = sum / count, variance = squares / count / (mean * mean) - 1;
    assert_true(variance < 0.03);
    double exact = 0;
    for (uint32_t id = 0; id < geodesic_count(7); id++) {
        Vec3 center = geodesic_center(7, id);
        exact += (double)(f->geodesic->areas[7][id & 16383] * peak_signal(center) * center.z);
    }
    assert_close(mean, exact, 4 * sqrt(variance / count) + 1e-3);
}

static void try_sampler(const Fixture *f, const char *blob, size_t size, int *opened)
{
    char        *copy = malloc(size ? size : 1);
    SamplingTree tree;
    Error        err = {0};
    uint32_t     seed = 15;
    memcpy(copy, blob, size);
    if (sampling_tree_open(copy, size, f->geodesic, &tree, &err)) {
        for (int i = 0; i < 16; i++) {
            float u0 = random_unit(&seed), u1 = random_unit(&seed);
            sampling_tree_sample(&tree, u0, u1);
        }
        (*opened)++;
    } else {
        assert_true(err.text[0] != 0);
    }
    free(copy);
}

static void mutated_sampling_trees_are_refused_or_harmless(void **state)
{
    Fixture *f = *state;
    uint32_t seed = 16;
    float    integrals[256];
    for (int i = 0; i < 256; i++) integrals[i] = random_unit(&seed);
    SamplingOptions options = {.level = 3, .octants = 4, .cells = 100};
    const void     *blob;
    Error           err;
    int             opened = 0;
    assert_true(sampling_tree_build(&options, integrals, &f->arena, &blob, &err));
    size_t size = sampling_tree_size(blob);
    for (size_t prefix = 0; prefix < size; prefix++) try_sampler(f, blob, prefix, &opened);
    assert_int_equal(opened, 0);
    char *copy = ARENA_NEW(&f->arena, char, size);
    for (int i = 0; i < 12000; i++) {
        memcpy(copy, blob, size);
        mutate(copy, size, &seed);
        try_sampler(f, copy, size, &opened);
    }
    assert_true(opened > 0 && opened < 6000);
}

static void functions_that_cannot_be_sampled_are_named(void **state)
{
    Fixture        *f = *state;
    float           integrals[16] = {0};
    SamplingOptions options = {.level = 1, .octants = 4, .cells = 8};
    const void     *blob;
    Error           err;
    assert_false(sampling_tree_build(&options, integrals, &f->arena, &blob, &err));
    assert_non_null(strstr(err.text, "that is 0 cannot be sampled"));
    integrals[5] = -1;
    assert_false(sampling_tree_build(&options, integrals, &f->arena, &blob, &err));
    assert_non_null(strstr(err.text, "leaf 5 is -1"));
    options.cells = 3;
    assert_false(sampling_tree_build(&options, integrals, &f->arena, &blob, &err));
    assert_non_null(strstr(err.text, "cells are 3"));
}

#define CASE(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        CASE(a_level_has_4_to_the_level_plus_1_triangles),
        CASE(areas_of_a_level_sum_to_the_hemisphere),
        CASE(children_cover_their_father_exactly),
        CASE(tables_agree_with_geometry),
        CASE(the_leaf_of_a_leafs_centre_is_that_leaf),
        CASE(a_found_leaf_holds_its_direction),
        CASE(ids_below_half_have_y_of_at_least_0),
        CASE(mirrored_directions_have_mirrored_leaves),
        CASE(neighbours_share_an_edge_and_are_neighbours_of_each_other),
        CASE(sampling_a_triangle_is_uniform_and_inverts),
        CASE(the_haar_transform_inverts_exactly),
        CASE(area_weighted_octant_means_are_integral_means),
        CASE(equal_weights_give_plain_means),
        CASE(norms_say_what_a_detail_is_worth),
        CASE(one_dimensional_wavelets_invert_at_every_length),
        CASE(constants_have_no_details),
        CASE(smooth_rows_have_small_details),
        CASE(wavelet_norms_are_positive_and_haars_are_known),
        CASE(a_query_equals_the_inverted_tree_at_every_leaf),
        CASE(a_tree_with_everything_kept_is_its_source),
        CASE(thresholding_keeps_the_l2_bound),
        CASE(an_error_bound_holds_at_every_leaf),
        CASE(an_unreachable_bound_is_refused_in_words),
        CASE(a_mean_at_any_level_is_the_mean_of_its_leaves),
        CASE(interpolation_follows_its_definition),
        CASE(half_trees_equal_whole_trees_of_symmetric_functions),
        CASE(interpolation_keeps_centres_and_constants),
        CASE(interpolation_is_continuous),
        CASE(mutated_trees_are_refused_or_harmless),
        CASE(a_bad_header_is_named),
        CASE(the_specular_frame_round_trips),
        CASE(the_horizon_stays_the_horizon_and_the_peak_is_the_pole),
        CASE(the_jacobian_agrees_with_differences),
        CASE(the_jacobian_integrates_to_the_hemisphere),
        CASE(the_pdf_integrates_to_1),
        CASE(samples_follow_the_pdf),
        CASE(the_density_is_positive_where_the_function_is),
        CASE(weights_of_importance_samples_vary_little),
        CASE(mutated_sampling_trees_are_refused_or_harmless),
        CASE(functions_that_cannot_be_sampled_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
