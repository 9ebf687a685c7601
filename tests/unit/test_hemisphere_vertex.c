/* SPDX-License-Identifier: Apache-2.0 */
/* The vertex basis: its lattice, trees and their queries. */
#include "hemisphere/tree/tree_expand.h"
#include "hemisphere/tree/tree_open.h"
#include "hemisphere/tree/tree_sum.h"
#include "hemisphere/tree/vertex_open.h"
#include "hemisphere/tree/vertex_tree_build.h"
#include "hemisphere_fixture.h"

#include "hemisphere/tree/vertex.h"
#include "hemisphere/tree/vertex_tree.h"
#include "vertex_bound.h"

static const VertexLattice LATTICES[] = {{0, 4}, {1, 2}, {3, 4}, {4, 2}, {6, 4}, {7, 2}};
#define LATTICE_COUNT ((int)(sizeof LATTICES / sizeof *LATTICES))

/* ---- the lattice ------------------------------------------------------------------------- */

HEMISPHERE_TEST(indices_are_one_to_one_with_directions) {
    for (int i = 0; i < LATTICE_COUNT; i++) {
        VertexLattice l = LATTICES[i];
        Arena scratch = f->arena;
        int n = 1 << l.level;
        uint32_t next = 0;
        for (int y = l.octants == 2 ? 0 : -n; y <= n; y++)
            for (int x = abs(y) - n; x <= n - abs(y); x++)
                assert_int_equal(vertex_index(l, x, y), next++);
        assert_int_equal(next, vertex_count(l));
        Vec3 *d = ARENA_NEW(&scratch, Vec3, next);
        vertex_directions(l, d);
        for (uint32_t v = 0; v < next; v++) {
            VertexPoint p = vertex_find(f->geodesic, l, d[v]);
            float own = 0;
            for (int k = 0; k < 3; k++) own += p.vertex[k] == v ? p.weight[k] : 0;
            assert_near(own, 1, 1e-4);
            assert_near(vec3_length(d[v]), 1, 1e-6);
        }
    }
}

TEST(mirrored_points_are_one_vertex) {
    VertexLattice l = {5, 2};
    for (int y = 0; y <= 32; y++)
        for (int x = y - 32; x <= 32 - y; x++)
            assert_int_equal(vertex_index(l, x, y), vertex_index(l, x, -y));
}

/* Corners of geodesic triangles, from whichever triangle or octant, are lattice points. */
HEMISPHERE_TEST(corners_of_triangles_are_lattice_points) {
    for (int level = 0; level <= 6; level++)
        for (uint32_t id = 0; id < geodesic_count(level); id += level < 4 ? 1 : 13) {
            GeodesicTriangle t = geodesic_triangle(level, id);
            float n = (float)(1 << level);
            for (int k = 0; k < 3; k++) {
                VertexPlace p = map_place(f->geodesic, vertex_plane_level(level), t.corner[k]);
                float slack = level <= VERTEX_PLANE_LEVEL ? 1e-5f : 3e-3f;
                assert_near(p.x * n, rintf(p.x * n), slack);
                assert_near(p.y * n, rintf(p.y * n), slack);
            }
        }
}

/* sum of weight * vertex points at the direction: the weights are those of the triangle's
 * plane. */
HEMISPHERE_TEST(weights_are_barycentric) {
    for (int i = 0; i < LATTICE_COUNT; i++) {
        VertexLattice l = LATTICES[i];
        Arena scratch = f->arena;
        uint32_t seed = 5;
        Vec3 *d = ARENA_NEW(&scratch, Vec3, vertex_count(l));
        vertex_directions(l, d);
        for (int q = 0; q < 2000; q++) {
            Vec3 at = random_direction(&seed), sum = vec3(0, 0, 0);
            VertexPoint p = vertex_find(f->geodesic, l, at);
            if (l.octants == 2) at.y = fabsf(at.y);
            assert_near(p.weight[0] + p.weight[1] + p.weight[2], 1, 1e-6);
            for (int k = 0; k < 3; k++) {
                assert_true(p.weight[k] >= 0);
                sum = vec3_along(sum, d[p.vertex[k]], p.weight[k]);
            }
            /* Beyond the plane level the corners' planes are not that plane. */
            assert_near(vec3_length(vec3_sub(vec3_normalize(sum), at)), 0, 2e-5);
        }
    }
}

/* ---- trees ------------------------------------------------------------------------------- */

static VertexTreeOptions options_of(VertexLattice lattice, const Bound *bound) {
    return (VertexTreeOptions){.lattice = lattice,
                               .components = bound->components,
                               .accepts = within_bound,
                               .context = bound};
}

typedef enum Kind { SMOOTH, PEAKED, BROKEN, NOISE } Kind;

/* Component c at a direction: smaller ones later, as principal components are. */
static float function_at(Kind kind, Vec3 d, int c, uint32_t *seed) {
    float part = 1 / (1 + 0.7f * (float)c), turned = d.x * (float)(c % 3) + d.y;
    if (kind == SMOOTH) return part * (d.z * d.z + 0.3f * turned * d.z);
    if (kind == PEAKED) return part * peak_signal(d) * 0.02f + 0.1f * d.x;
    if (kind == BROKEN) return d.x + 0.4f * d.y > 0.31f ? part : -part * d.z;
    return part * random_unit(seed);
}

static float *values_of(VertexLattice lattice, int components, Kind kind, Arena *arena) {
    uint32_t count = vertex_count(lattice), seed = 3;
    Vec3 *d = ARENA_NEW(arena, Vec3, count);
    float *values = ARENA_NEW(arena, float, count *(uint32_t)components);
    vertex_directions(lattice, d);
    for (uint32_t i = 0; i < count * (uint32_t)components; i++)
        values[i] =
            function_at(kind, d[i / (uint32_t)components], (int)(i % (uint32_t)components), &seed);
    return values;
}

/* A tree within a tolerance of a function, opened; *values: of the function. */
typedef struct Example {
    VertexLattice lattice;
    int components;
    Kind kind;
    float tolerance;
} Example;

static Tree build_example(Fixture *f, const Example *e, const float **values, TreeReport *report) {
    *values = values_of(e->lattice, e->components, e->kind, &f->arena);
    Bound bound = {*values, e->components, e->tolerance};
    VertexTreeOptions options = options_of(e->lattice, &bound);
    const void *blob;
    Tree tree;
    assert_done(vertex_tree_build(&options, *values, &f->arena, &blob, report, &err));
    assert_int_equal(report->bytes, tree_size(blob));
    assert_done(tree_open(blob, tree_size(blob), f->geodesic, &f->arena, &tree, &err));
    return tree;
}

static const Example EXAMPLES[] = {
    {{0, 4}, 1, SMOOTH, 0.01f},   {{1, 2}, 3, SMOOTH, 0.001f}, {{2, 4}, 2, NOISE, 1e-4f},
    {{5, 4}, 8, SMOOTH, 0.005f},  {{5, 2}, 17, PEAKED, 0.01f}, {{6, 4}, 3, PEAKED, 0.002f},
    {{6, 2}, 12, BROKEN, 0.05f},  {{4, 4}, 40, NOISE, 0.02f},  {{4, 2}, 1, NOISE, 1e-4f},
    {{3, 4}, 256, SMOOTH, 0.01f},
};
#define EXAMPLE_COUNT ((int)(sizeof EXAMPLES / sizeof *EXAMPLES))

/* Base vertices and details of an opened tree. */
static uint32_t stored_in(const Tree *tree) {
    uint32_t sum = vertex_count((VertexLattice){tree->base_level, tree->octants});
    for (int l = 0; l < tree->level_count; l++)
        for (uint32_t b = 0; b < tree->levels[l].width * tree->levels[l].height; b++)
            sum += vertex_count_bits(tree->blocks[tree->levels[l].block[b]].bits);
    return sum;
}

HEMISPHERE_TEST(every_vertex_keeps_its_bound) {
    for (int i = 0; i < EXAMPLE_COUNT; i++) {
        Fixture inner = *f;
        const float *values;
        TreeReport report;
        const Example *e = &EXAMPLES[i];
        Tree tree = build_example(&inner, e, &values, &report);
        uint32_t count = vertex_count(e->lattice) * (uint32_t)e->components;
        float *got = ARENA_NEW(&inner.arena, float, count);
        float worst = 0;
        vertex_tree_expand(&tree, got);
        for (uint32_t v = 0; v < count; v++) worst = fmaxf(worst, fabsf(got[v] - values[v]));
        assert_true(worst <= e->tolerance);
        assert_close(report.max_error, worst, 1e-3);
        assert_int_equal(report.stored_rows, stored_in(&tree));
    }
}

/* Queries are the barycentric interpolation of the vertices' values, never outside them. */
HEMISPHERE_TEST(queries_interpolate_the_vertices) {
    for (int i = 0; i < EXAMPLE_COUNT; i++) {
        Fixture inner = *f;
        const Example *e = &EXAMPLES[i];
        const float *values;
        TreeReport report;
        uint32_t k = (uint32_t)e->components, seed = 77;
        Tree tree = build_example(&inner, e, &values, &report);
        float *got = ARENA_NEW(&inner.arena, float, vertex_count(e->lattice) * k);
        float out[TREE_MAX_COMPONENTS];
        vertex_tree_expand(&tree, got);
        for (int q = 0; q < 2000; q++) {
            Vec3 d = random_direction(&seed);
            VertexPoint p = vertex_find(f->geodesic, e->lattice, d);
            tree_interpolate(&tree, d, out);
            for (uint32_t c = 0; c < k; c++) {
                float a = got[p.vertex[0] * k + c], b = got[p.vertex[1] * k + c];
                float third = got[p.vertex[2] * k + c];
                float sum = p.weight[0] * a + p.weight[1] * b + p.weight[2] * third;
                assert_near(out[c], sum, 3e-6);
                assert_true(out[c] <= fmaxf(fmaxf(a, b), third) + 2e-6f);
                assert_true(out[c] >= fminf(fminf(a, b), third) - 2e-6f);
            }
        }
    }
}

/* Two directions a step apart differ by no more than the steepest triangle allows. */
static void assert_small_step(const Tree *tree, Vec3 d, Vec3 step, float slope) {
    float a[TREE_MAX_COMPONENTS], b[TREE_MAX_COMPONENTS];
    tree_interpolate(tree, d, a);
    tree_interpolate(tree, vec3_add(d, step), b);
    for (int c = 0; c < tree->components; c++)
        assert_near(a[c], b[c], slope * vec3_length(step) + 3e-6f);
}

/* Everywhere, across octants, and where the tree's depth changes. */
HEMISPHERE_TEST(trees_are_continuous) {
    for (int i = 0; i < EXAMPLE_COUNT; i++) {
        Fixture inner = *f;
        const float *values;
        TreeReport report;
        uint32_t seed = 41;
        Tree tree = build_example(&inner, &EXAMPLES[i], &values, &report);
        float slope = 8 * (float)(1 << tree.level);
        for (int q = 0; q < 3000; q++) {
            Vec3 d = random_direction(&seed), step = random_direction(&seed);
            Vec3 small = vec3_scale(step, 2e-6f);
            float side = random_unit(&seed);
            if (q % 3 == 1) d.x = side < 0.5f ? 1e-6f : -1e-6f;
            if (q % 3 == 2) d.y = side < 0.5f ? 1e-6f : -1e-6f;
            d = vec3_normalize(d);
            assert_small_step(&tree, d, small, slope);
            assert_small_step(&tree, d, vec3(-2 * d.x * (float)(q % 3 == 1), 0, 0), slope);
        }
        /* Onto the grid's lines, where cells, blocks and windows end. */
        for (int q = 0; q < 3000; q++) {
            int n = 1 << tree.level, x = (int)(random_unit(&seed) * (float)n);
            int y = (int)(random_unit(&seed) * (float)(n - x));
            Vec3 d = vertex_direction(EXAMPLES[i].lattice, x, y);
            Vec3 small = vec3_scale(random_direction(&seed), 2e-6f);
            assert_small_step(&tree, d, small, slope);
            assert_small_step(&tree, d, vec3_neg(small), slope);
        }
    }
}

HEMISPHERE_TEST(half_trees_are_mirror_symmetric) {
    const Example e = {{5, 2}, 5, PEAKED, 0.01f};
    const float *values;
    TreeReport report;
    uint32_t seed = 13;
    Tree tree = build_example(f, &e, &values, &report);
    for (int q = 0; q < 2000; q++) {
        Vec3 d = random_direction(&seed);
        float a[5], b[5];
        tree_interpolate(&tree, d, a);
        tree_interpolate(&tree, vec3(d.x, -d.y, d.z), b);
        assert_memory_equal(a, b, sizeof a);
    }
}

HEMISPHERE_TEST(ranges_of_components_are_parts_of_the_whole) {
    const Example e = {{4, 4}, 40, NOISE, 0.02f};
    const float *values;
    TreeReport report;
    uint32_t seed = 17;
    Tree tree = build_example(f, &e, &values, &report);
    for (int q = 0; q < 2000; q++) {
        TreeTaps taps;
        float all[40], part[40];
        Vec3 d = random_direction(&seed);
        int first = (int)(random_unit(&seed) * 39.9f);
        int count = 1 + (int)(random_unit(&seed) * (39.9f - (float)first));
        tree_walk_interpolated(&tree, d, &taps);
        tree_sum(&tree, &taps, 0, 40, all);
        tree_sum(&tree, &taps, first, count, part);
        assert_memory_equal(part, all + first, (size_t)count * sizeof *part);
    }
}

HEMISPHERE_TEST(an_expanded_tree_has_the_values_at_its_centres) {
    const Example e = {{6, 4}, 3, PEAKED, 0.002f};
    const float *values;
    TreeReport report;
    Tree tree = build_example(f, &e, &values, &report);
    float value[3];
    float *leaves = ARENA_NEW(&f->arena, float, 3 * geodesic_count(6));
    tree_expand(&tree, leaves, f->arena);
    tree_interpolate(&tree, geodesic_center(6, 4711), value);
    assert_memory_equal(leaves + 3 * 4711, value, sizeof value);
}

HEMISPHERE_TEST(odd_directions_are_answered) {
    const Vec3 odd[] = {{0, 0, 0},           {0, 0, -1},
                        {1, 0, 0},           {0, -1, 0},
                        {0.5f, 0.5f, -0.7f}, {-0.7071f, 0.7071f, 0},
                        {1e-20f, 0, 1},      {-1e-30f, -1e-30f, 1e-30f},
                        {3e18f, 3e18f, 1},   {0.8f, -0.6f, 1e-9f}};
    for (int i = 0; i < EXAMPLE_COUNT; i++) {
        Fixture inner = *f;
        const float *values;
        TreeReport report;
        float out[TREE_MAX_COMPONENTS];
        Tree tree = build_example(&inner, &EXAMPLES[i], &values, &report);
        for (size_t q = 0; q < sizeof odd / sizeof *odd; q++) {
            tree_interpolate(&tree, odd[q], out);
            for (int c = 0; c < tree.components; c++) assert_true(fabsf(out[c]) < 3);
        }
    }
}

/* Storing vertices pays: few of them, in few bytes. */
HEMISPHERE_TEST(smooth_functions_take_few_bytes) {
    const Example e = {{7, 4}, 4, SMOOTH, 0.01f};
    const float *values;
    TreeReport report;
    build_example(f, &e, &values, &report);
    assert_true(report.stored_rows < 500);
    assert_true(report.bytes < 2600);
    assert_true(report.bytes * 200 < report.leaves * 4 * sizeof(float));
}

/* ---- failures ---------------------------------------------------------------------------- */

static bool accepts_nothing(const void *context, uint32_t vertex, const float *reconstructed) {
    const VertexLattice *l = context;
    (void)reconstructed;
    return vertex != vertex_index(*l, 4, 4);
}

static void assert_refused(const VertexTreeOptions *options, const float *values, const char *text,
                           Arena *arena) {
    const void *blob = arena;
    TreeReport report;
    Error err;
    assert_false(vertex_tree_build(options, values, arena, &blob, &report, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    if (!strstr(err.text, text)) fail_msg("'%s' does not hold '%s'", err.text, text);
    assert_ptr_equal(blob, arena);
}

HEMISPHERE_TEST(what_cannot_be_stored_is_refused) {
    VertexLattice l = {3, 4};
    float *values = values_of(l, 2, SMOOTH, &f->arena);
    Bound bound = {values, 2, 0.01f};
    VertexTreeOptions good = options_of(l, &bound), o = good;
    o.lattice.level = GEODESIC_MAX_LEVEL;
    assert_refused(&o, values, "level 10, required: 0 to 9", &f->arena);
    o = good;
    o.lattice.octants = 3;
    assert_refused(&o, values, "3 octants, required: 2 or 4", &f->arena);
    o = good;
    o.components = 0;
    assert_refused(&o, values, "0 components, required: 1 to 256", &f->arena);
    o = good;
    o.accepts = accepts_nothing;
    o.context = &l;
    assert_refused(&o, values, "theta 90.00 deg, phi 45.00 deg", &f->arena);
    values[7] = NAN;
    assert_refused(&good, values, "value 7 is nan", &f->arena);
    values[7] = INFINITY;
    assert_refused(&good, values, "value 7 is inf", &f->arena);
}

/* ---- blobs from anywhere ----------------------------------------------------------------- */

static const Example BLOBS[] = {
    {{5, 4}, 8, PEAKED, 0.01f}, {{6, 2}, 17, PEAKED, 0.004f}, {{2, 4}, 1, NOISE, 1e-3f}};

/* A copy in memory of its own size, so that a sanitizer sees every byte read beyond it. */
static void *exact_copy(const void *blob, size_t size) {
    void *copy = aligned_alloc(16, (size + 15) / 16 * 16);
    memcpy(copy, blob, size);
    return copy;
}

static const void *example_blob(Fixture *f, const Example *e) {
    float *values = values_of(e->lattice, e->components, e->kind, &f->arena);
    Bound bound = {values, e->components, e->tolerance};
    VertexTreeOptions options = options_of(e->lattice, &bound);
    const void *blob;
    assert_done(vertex_tree_build(&options, values, &f->arena, &blob, NULL, &err));
    return blob;
}

HEMISPHERE_TEST(every_prefix_is_refused) {
    for (size_t i = 0; i < sizeof BLOBS / sizeof *BLOBS; i++) {
        const void *blob = example_blob(f, &BLOBS[i]);
        for (size_t size = 0; size < tree_size(blob); size++) {
            void *copy = exact_copy(blob, size);
            Tree tree;
            assert_fails(tree_open(copy, size, f->geodesic, &f->arena, &tree, &err), "");
            free(copy);
        }
    }
}

HEMISPHERE_TEST(mutated_blobs_are_refused_or_harmless) {
    uint32_t seed = 2024, opened = 0;
    for (size_t i = 0; i < sizeof BLOBS / sizeof *BLOBS; i++) {
        const void *blob = example_blob(f, &BLOBS[i]);
        size_t size = tree_size(blob);
        char *copy = exact_copy(blob, size);
        for (int m = 0; m < 8000; m++) {
            Tree tree;
            Error err;
            float out[TREE_MAX_COMPONENTS];
            memcpy(copy, blob, size);
            mutate(copy, size, &seed);
            Arena scratch = f->arena;
            if (!tree_open(copy, size, f->geodesic, &scratch, &tree, &err)) continue;
            opened++;
            for (int q = 0; q < 8; q++) {
                Vec3 d = random_direction(&seed);
                tree_interpolate(&tree, d, out);
                for (int c = 0; c < tree.components; c++) assert_true(isfinite(out[c]));
            }
        }
        free(copy);
    }
    assert_true(opened > 500); /* changed numbers, same structure */
    assert_true(opened < 20000);
}

HEMISPHERE_TEST(a_bad_header_is_named) {
    const void *blob = example_blob(f, &BLOBS[0]);
    size_t size = tree_size(blob);
    char *copy = exact_copy(blob, size);
    Tree tree;
    ((VertexHeader *)(void *)copy)->version = 7;
    assert_tree_refused(f, copy, size, "version is 7, required: 2");
    memcpy(copy, blob, size);
    ((VertexHeader *)(void *)copy)->octants = 3;
    assert_tree_refused(f, copy, size, "octant count is 3, required: 4");
    assert_fails(tree_open(blob, size, geodesic_create(3, &f->arena), &f->arena, &tree, &err),
                 "level of the geodesic is 3, required: 4");
    memcpy(copy, blob, size);
    ((float *)(void *)(copy + sizeof(VertexHeader)))[2] = NAN;
    assert_tree_refused(f, copy, size, "scale 2 is nan");
    free(copy);
}

TEST_PROGRAM(NULL, NULL)
