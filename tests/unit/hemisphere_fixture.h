/* SPDX-License-Identifier: Apache-2.0 */
/* hemisphere_fixture.h -- what the tests of src/hemisphere share: an arena and a geodesic for
 * every case, a stream of numbers that is always the same, and three functions to store. */
#pragma once
#include "fixture.h"

#include <stdlib.h>
#include <string.h>

#include "base/mathf.h"
#include "base/sampler.h"
#include "base/units.h"
#include "hemisphere/tree/haar_tree.h"
#include "hemisphere/tree/tree_open.h"
#include "hemisphere/tree/tree_query.h"

#define LEVEL 7

static const HaarWeights WEIGHTS[] = {HAAR_EQUAL, HAAR_AREA};

typedef struct Fixture {
    Arena arena; /* for the test; copies are its scratch */
    const Geodesic *geodesic;
} Fixture;

static inline int set_up(void **state) {
    Fixture *fixture = malloc(sizeof *fixture);
    fixture->arena = arena_reserve((size_t)1 << 30);
    fixture->geodesic = geodesic_create(LEVEL, &fixture->arena);
    *state = fixture;
    return 0;
}

static inline int tear_down(void **state) {
    Fixture *fixture = *state;
    arena_release(&fixture->arena);
    free(fixture);
    return 0;
}

/* The test's own numbers: one stream, always the same. */
static inline float random_unit(uint32_t *seed) {
    *seed = *seed * 1664525u + 1013904223u;
    return unit_float(hash_u32(*seed));
}

static inline Vec3 random_direction(uint32_t *seed) {
    float z = random_unit(seed), across = sqrtf(1 - z * z), sine, cosine;
    sincos_turns(random_unit(seed), &sine, &cosine);
    return vec3(across * cosine, across * sine, z);
}

/* A display-like luminance, an anti-glare haze in the stored frame, a narrow peak. */
static inline float smooth_signal(Vec3 d) {
    return 300 * d.z * d.z + 40 * d.x * d.z + 20 * d.y + 25;
}

static inline float peak_signal(Vec3 d) {
    float angle = acos_f(d.z) + 0.1f * d.x;
    return 1 / (0.01f + angle * angle) + 0.2f;
}

static inline float zero_outside_signal(Vec3 d) {
    return d.x > 0.3f && d.z > 0.2f ? peak_signal(d) : 0.0f;
}

typedef float (*Signal)(Vec3);

/* Leaf values: component c is signal c of the table at the leaf's centre. */
static inline float *leaves_of_signals(const HaarShape *shape, Arena *arena) {
    const Signal signals[] = {smooth_signal, peak_signal, zero_outside_signal};
    uint32_t count = haar_leaf_count(shape);
    float *leaves = ARENA_NEW(arena, float, count *(uint32_t)shape->components);
    for (uint32_t leaf = 0; leaf < count; leaf++) {
        Vec3 center = geodesic_center(shape->level, leaf);
        for (int c = 0; c < shape->components; c++)
            leaves[leaf * (uint32_t)shape->components + (uint32_t)c] = signals[c % 3](center);
    }
    return leaves;
}

static inline Tree build_and_open(Fixture *f, const HaarTreeOptions *options, const float *leaves,
                                  TreeReport *report) {
    const void *blob;
    Tree tree;
    Error err;
    if (!haar_tree_build(options, leaves, &f->arena, &blob, report, &err)) fail_msg("%s", err.text);
    if (!tree_open(blob, tree_size(blob), f->geodesic, &f->arena, &tree, &err))
        fail_msg("%s", err.text);
    return tree;
}

static inline void assert_tree_refused(const Fixture *f, const void *blob, size_t size,
                                       const char *text) {
    Tree tree;
    Arena arena = f->arena;
    Error err = {0};
    assert_false(tree_open(blob, size, f->geodesic, &arena, &tree, &err));
    assert_non_null(strstr(err.text, text));
}

/* The leaf's value, which its centre keeps. */
static inline void tree_value(const Tree *tree, Vec3 direction, float *out) {
    uint32_t id = geodesic_find(tree->geodesic, tree->level, direction).id;
    tree_interpolate(tree, geodesic_center(tree->level, id), out);
}

/* Changes one to four bytes, often in the header. */
static inline void mutate(char *bytes, size_t size, uint32_t *seed) {
    for (int i = 0; i < 1 + (int)(random_unit(seed) * 3); i++) {
        size_t limit = random_unit(seed) < 0.5f && size > 64 ? 64 : size;
        size_t at = (size_t)(random_unit(seed) * (float)limit);
        float kind = random_unit(seed);
        bytes[at] = kind < 0.4f   ? (char)(bytes[at] ^ (1 << (int)(random_unit(seed) * 8)))
                    : kind < 0.7f ? (char)(unsigned char)(random_unit(seed) * 256)
                    : kind < 0.8f ? (char)0xff
                    : kind < 0.9f ? (char)0
                                  : (char)(bytes[at] + 1);
    }
}

/* A case with `Fixture *f`. */
#define HEMISPHERE_TEST(name) TEST_ON(name, set_up, tear_down, Fixture *f, *state)
