/* SPDX-License-Identifier: Apache-2.0 */
/* Trees that are read down to a coarser level: vertex trees keep the vertices' values and are
 * linear between them, below their base level too; Haar trees keep their triangles' means. */
#include "hemisphere/tree/tree_expand.h"
#include "hemisphere/tree/tree_stop.h"
#include "hemisphere/tree/vertex.h"
#include "hemisphere/tree/vertex_open.h"
#include "hemisphere/tree/vertex_tree_build.h"
#include "hemisphere_fixture.h"
#include "vertex_bound.h"

#define ASKED 300
#define COMPONENTS_MAX 11

typedef struct Example {
    VertexLattice lattice;
    int components;
    float tolerance;
} Example;

static const Example EXAMPLES[] = {
    {{6, 4}, 3, 0.002f},
    {{5, 2}, 11, 0.01f},
    {{0, 4}, 1, 0.01f},
    {{6, 2}, 1, 1e-4f},
};
#define EXAMPLE_COUNT ((int)(sizeof EXAMPLES / sizeof *EXAMPLES))

/* A peak beside what is smooth; later components are smaller. */
static Tree build(const Example *e, Fixture *f) {
    uint32_t count = vertex_count(e->lattice), k = (uint32_t)e->components;
    Vec3 *d = ARENA_NEW(&f->arena, Vec3, count);
    float *values = ARENA_NEW(&f->arena, float, count *k);
    vertex_directions(e->lattice, d);
    for (uint32_t i = 0; i < count * k; i++) {
        float part = 1 / (1 + 0.7f * (float)(i % k));
        values[i] = part * (0.02f * peak_signal(d[i / k]) + 0.3f * d[i / k].x);
    }
    Bound bound = {values, e->components, e->tolerance};
    VertexTreeOptions options = {.lattice = e->lattice,
                                 .components = e->components,
                                 .accepts = within_bound,
                                 .context = &bound};
    TreeReport report;
    const void *blob;
    Tree tree;
    assert_done(vertex_tree_build(&options, values, &f->arena, &blob, &report, &err));
    assert_done(tree_open(blob, tree_size(blob), f->geodesic, &f->arena, &tree, &err));
    return tree;
}

static Tree stopped(const Tree *tree, int level, Arena *arena) {
    Tree copy = *tree;
    tree_stop(&copy, level, arena);
    assert_int_equal(copy.level, level);
    return copy;
}

HEMISPHERE_TEST(the_finest_level_is_the_tree_to_the_bit) {
    for (int i = 0; i < EXAMPLE_COUNT; i++) {
        Fixture inner = *f;
        uint32_t seed = 7;
        Tree tree = build(&EXAMPLES[i], &inner);
        Tree same = stopped(&tree, tree.level, &inner.arena);
        size_t bytes = sizeof(float) * (size_t)tree.components;
        for (int q = 0; q < ASKED; q++) {
            float a[COMPONENTS_MAX], b[COMPONENTS_MAX];
            Vec3 d = random_direction(&seed);
            tree_interpolate(&tree, d, a);
            tree_interpolate(&same, d, b);
            assert_memory_equal(a, b, bytes);
        }
    }
}

/* The whole tree's values at the vertices of a level, linear in between, are the level; `whole`
 * is the tree expanded. The map of places is the whole tree's. */
static void check_level(const Tree *tree, int level, const float *whole, Arena arena) {
    VertexLattice fine = {tree->level, tree->octants}, lattice = {level, tree->octants};
    Tree coarse = stopped(tree, level, &arena);
    int n = 1 << level, apart = 1 << (tree->level - level), k = tree->components;
    uint32_t seed = 11;
    float *values = ARENA_NEW(&arena, float, vertex_count(lattice) * (uint32_t)k);
    for (int y = tree->octants == 2 ? 0 : -n; y <= n; y++)
        for (int x = abs(y) - n; x <= n - abs(y); x++)
            memcpy(values + vertex_index(lattice, x, y) * (size_t)k,
                   whole + vertex_index(fine, apart * x, apart * y) * (size_t)k,
                   sizeof *values * (size_t)k);
    for (int q = 0; q < ASKED; q++) {
        float out[COMPONENTS_MAX];
        Vec3 d = random_direction(&seed);
        VertexPlace place = map_place(tree->geodesic, tree->plane_level, d);
        place.octant &= (uint32_t)tree->octants - 1;
        VertexPoint p = map_point(lattice, place);
        tree_interpolate(&coarse, d, out);
        for (int c = 0; c < k; c++) {
            float sum = 0;
            for (int v = 0; v < 3; v++)
                sum += p.weight[v] * values[p.vertex[v] * (size_t)k + (size_t)c];
            assert_near(out[c], sum, 1e-5);
        }
    }
}

HEMISPHERE_TEST(a_level_is_linear_between_the_trees_values_at_its_vertices) {
    int below_base = 0;
    for (int i = 0; i < EXAMPLE_COUNT; i++) {
        Fixture inner = *f;
        Tree tree = build(&EXAMPLES[i], &inner);
        float *whole =
            ARENA_NEW(&inner.arena, float, tree_point_count(&tree) * (uint32_t)tree.components);
        vertex_tree_expand(&tree, whole);
        for (int level = 0; level <= tree.level; level++) {
            check_level(&tree, level, whole, inner.arena);
            below_base += level < tree.base_level;
        }
    }
    assert_true(below_base > 3);
}

/* A tree that is stopped twice is stopped at the lower level, to the bit. */
HEMISPHERE_TEST(stopping_again_is_stopping_once) {
    for (int i = 0; i < EXAMPLE_COUNT; i++) {
        Fixture inner = *f;
        Tree tree = build(&EXAMPLES[i], &inner);
        for (int level = 0; level < tree.level; level++) {
            uint32_t seed = 5;
            Tree above = stopped(&tree, level + 1, &inner.arena);
            Tree once = stopped(&tree, level, &inner.arena);
            Tree twice = stopped(&above, level, &inner.arena);
            for (int q = 0; q < 20; q++) {
                float a[COMPONENTS_MAX], b[COMPONENTS_MAX];
                Vec3 d = random_direction(&seed);
                tree_interpolate(&once, d, a);
                tree_interpolate(&twice, d, b);
                assert_memory_equal(a, b, sizeof(float) * (size_t)tree.components);
            }
        }
    }
}

HEMISPHERE_TEST(a_haar_level_keeps_the_means_of_its_triangles) {
    HaarShape shape = {6, 4, 1, HAAR_AREA};
    HaarTreeOptions options = {.shape = shape, .keep_share = 0.03f};
    TreeReport report;
    float *source = leaves_of_signals(&shape, &f->arena);
    Tree tree = build_and_open(f, &options, source, &report);
    float *leaves = ARENA_NEW(&f->arena, float, haar_leaf_count(&shape));
    tree_expand(&tree, leaves, f->arena);
    for (int level = 0; level <= 6; level++) {
        Tree coarse = stopped(&tree, level, &f->arena);
        uint32_t below = 1u << 2 * (6 - level);
        for (uint32_t id = 0; id < geodesic_count(level); id++) {
            double sum = 0, area = 0;
            float out;
            for (uint32_t i = id * below; i < (id + 1) * below; i++) {
                double a = (double)f->geodesic->areas[6][i & 4095];
                area += a;
                sum += a * (double)leaves[i];
            }
            tree_interpolate(&coarse, geodesic_center(level, id), &out);
            assert_near(out, sum / area, 1e-3);
        }
    }
}

TEST_PROGRAM(NULL, NULL)
