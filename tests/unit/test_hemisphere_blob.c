/* SPDX-License-Identifier: Apache-2.0 */
/* test_hemisphere_blob.c -- damaged and hostile trees are refused, or harmless. */
#include "hemisphere/tree/haar_tree.h"
#include "hemisphere/tree/tree_expand.h"
#include "hemisphere/tree/tree_open.h"
#include "hemisphere_fixture.h"

static void query_everything(const Tree *tree, Arena scratch) {
    uint32_t seed = 8;
    float value[TREE_MAX_COMPONENTS];
    for (int i = 0; i < 16; i++) {
        Vec3 d = random_direction(&seed);
        tree_interpolate(tree, d, value);
        tree_value(tree, d, value);
    }
    float *leaves = ARENA_NEW(
        &scratch, float, ((size_t)tree->octants << 2 * tree->level) * (size_t)tree->components);
    tree_expand(tree, leaves, scratch);
}

/* A copy that ends where its memory ends, so that the sanitizer sees any step beyond. */
static void try_tree(const Fixture *f, const char *blob, size_t size, int *opened) {
    char *copy = malloc(size ? size : 1);
    Tree tree;
    Error err = {0};
    memcpy(copy, blob, size);
    Arena arena = f->arena;
    if (tree_open(copy, size, f->geodesic, &arena, &tree, &err)) {
        query_everything(&tree, arena);
        (*opened)++;
    } else {
        assert_true(err.text[0] != 0);
    }
    free(copy);
}

HEMISPHERE_TEST(mutated_trees_are_refused_or_harmless) {
    f->geodesic = geodesic_create(3, &f->arena); /* not a level more than the tree's */
    for (int rows = 0; rows <= TREE_ROWS_INT16; rows++) {
        HaarShape shape = {3, 4, 2, HAAR_AREA};
        HaarTreeOptions options = {.shape = shape, .keep_share = 0.1f, .rows = (TreeRowFormat)rows};
        const void *blob;
        uint32_t seed = 9;
        int opened = 0;
        float *source = leaves_of_signals(&shape, &f->arena);
        assert_done(haar_tree_build(&options, source, &f->arena, &blob, NULL, &err));
        size_t size = tree_size(blob);
        for (size_t prefix = 0; prefix < size; prefix++) try_tree(f, blob, prefix, &opened);
        assert_int_equal(opened, 0);
        char *copy = ARENA_NEW(&f->arena, char, size);
        for (int i = 0; i < 6000; i++) {
            memcpy(copy, blob, size);
            mutate(copy, size, &seed);
            try_tree(f, copy, size, &opened);
        }
        assert_int_equal(((const TreeHeader *)blob)->byte_level > 0, rows > 0);
        assert_true(opened > 100); /* changed numbers, same structure */
        assert_true(opened < 5000);
    }
}

/* Level 3, one component. */
static const void *small_tree(Fixture *f, float keep_share) {
    HaarShape shape = {3, 4, 1, HAAR_AREA};
    HaarTreeOptions options = {.shape = shape, .keep_share = keep_share};
    const void *blob;
    float *source = leaves_of_signals(&shape, &f->arena);
    assert_done(haar_tree_build(&options, source, &f->arena, &blob, NULL, &err));
    return blob;
}

/* A header with fewer levels than the nodes have, and one with fewer rows. */
HEMISPHERE_TEST(trees_deeper_than_their_header_are_refused) {
    const void *blob = small_tree(f, 0.2f);
    size_t size = tree_size(blob);
    TreeHeader *copy = arena_alloc(&f->arena, 1, 16, size);
    memcpy(copy, blob, size);
    copy->level = 2;
    assert_tree_refused(f, copy, size, "below the leaves' level 2");
    copy->level = 3;
    copy->row_count -= 2;
    copy->size -= 8;
    assert_tree_refused(f, copy, size, "row");
    copy->row_count += 4;
    copy->size += 16;
    assert_tree_refused(f, copy, size + 8, "row count is");
}

HEMISPHERE_TEST(a_bad_header_is_named) {
    const void *blob = small_tree(f, 0.5f);
    Tree tree;
    size_t size = tree_size(blob);
    char *copy = arena_alloc(&f->arena, 1, 16, size + 8);
    assert_tree_refused(f, (const char *)blob + 4, size, "multiple of 8");
    assert_tree_refused(f, blob, 20, "number of bytes is 20");
    assert_fails(tree_open(blob, size, geodesic_create(2, &f->arena), &f->arena, &tree, &err),
                 "level of the geodesic is 2, required: 3");
    memcpy(copy, blob, size);
    copy[0] ^= 1;
    assert_tree_refused(f, copy, size, "magic number");
    memcpy(copy, blob, size);
    ((TreeHeader *)(void *)copy)->version = 7;
    assert_tree_refused(f, copy, size, "version is 7, required: 1");
}

TEST_PROGRAM(NULL, NULL)
