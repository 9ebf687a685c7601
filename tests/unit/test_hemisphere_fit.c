/* SPDX-License-Identifier: Apache-2.0 */
/* Values of vertices from samples in any directions. */
#include "hemisphere/vertex/vertex_fit.h"
#include "hemisphere_fixture.h"

#include "hemisphere/vertex/vertex.h"

/* A smooth function of two components. */
static float function_at(Vec3 d, int c) {
    float part = 1 / (1 + 0.7f * (float)c), turned = d.x * (float)c + d.y;
    return part * (d.z * d.z + 0.3f * turned * d.z);
}

/* Random directions and the smooth function there; those below `lowest` z are left out. */
static VertexSamples smooth_samples(int count, float lowest, Arena *arena) {
    uint32_t seed = 23;
    Vec3 *d = ARENA_NEW(arena, Vec3, count);
    float *value = ARENA_NEW(arena, float, 2 * count);
    for (int i = 0; i < count; i++) {
        do d[i] = random_direction(&seed);
        while (d[i].z < lowest);
        for (int c = 0; c < 2; c++) value[2 * i + c] = function_at(d[i], c);
    }
    return (VertexSamples){count, 2, d, value, NULL};
}

HEMISPHERE_TEST(fits_recover_smooth_functions) {
    VertexLattice l = {5, 4};
    uint32_t count = vertex_count(l);
    Vec3 *d = ARENA_NEW(&f->arena, Vec3, count);
    float *values = ARENA_NEW(&f->arena, float, 2 * count);
    VertexSamples samples = smooth_samples(20000, 0, &f->arena);
    vertex_directions(l, d);
    assert_done(vertex_fit(l, &samples, 1e-12, &f->arena, values, &err));
    for (uint32_t i = 0; i < 2 * count; i++)
        assert_near(values[i], function_at(d[i / 2], (int)(i % 2)), 4e-3);
}

/* No samples below 53 degrees: the values go on smoothly and stay in sight. */
HEMISPHERE_TEST(fits_stay_smooth_in_gaps) {
    VertexLattice l = {5, 4};
    uint32_t count = vertex_count(l);
    float *values = ARENA_NEW(&f->arena, float, 2 * count);
    VertexSamples samples = smooth_samples(8000, 0.6f, &f->arena);
    assert_done(vertex_fit(l, &samples, 1e-10, &f->arena, values, &err));
    for (uint32_t i = 0; i < 2 * count; i++) assert_true(fabsf(values[i]) < 2);
    VertexEdge *edges = ARENA_NEW(&f->arena, VertexEdge, vertex_edges(l, 4, NULL));
    uint32_t edge_count = vertex_edges(l, 4, edges);
    for (uint32_t i = 0; i < edge_count; i++) {
        float ends = values[2 * edges[i].end[0]] + values[2 * edges[i].end[1]];
        assert_near(values[2 * edges[i].vertex] - 0.5f * ends, 0, 0.01);
    }
}

HEMISPHERE_TEST(fits_of_constants_are_constant) {
    VertexLattice l = {4, 2};
    uint32_t count = vertex_count(l);
    float *values = ARENA_NEW(&f->arena, float, count);
    const Vec3 d[2] = {{0, 0, 1}, {0.6f, 0, 0.8f}};
    const float three[2] = {3, 3};
    VertexSamples samples = {2, 1, d, three, NULL};
    assert_done(vertex_fit(l, &samples, 1e-6, &f->arena, values, &err));
    for (uint32_t i = 0; i < count; i++) assert_near(values[i], 3, 1e-3);
}

/* Weights of 0 hide samples; mirrored samples of half lattices are one. */
HEMISPHERE_TEST(fits_weigh_and_mirror) {
    VertexLattice l = {3, 2};
    float *values = ARENA_NEW(&f->arena, float, vertex_count(l));
    const Vec3 d[3] = {{0.6f, 0.48f, 0.64f}, {0.6f, -0.48f, 0.64f}, {0.6f, 0.48f, 0.64f}};
    const float value[3] = {1, 3, 1000}, weight[3] = {1, 1, 0};
    VertexSamples samples = {3, 1, d, value, weight};
    assert_done(vertex_fit(l, &samples, 1e-6, &f->arena, values, &err));
    for (uint32_t i = 0; i < vertex_count(l); i++) assert_near(values[i], 2, 1e-3);
}

HEMISPHERE_TEST(fits_refuse_what_is_no_number) {
    VertexLattice l = {2, 4};
    float values[64];
    const Vec3 d[2] = {{0, 0, 1}, {0.6f, 0, 0.8f}};
    float value[2] = {1, 2}, weight[2] = {0, 0};
    VertexSamples samples = {2, 1, d, value, weight};
    assert_fails(vertex_fit(l, &samples, 1e-6, &f->arena, values, &err),
                 "2 samples have no weight, required: some");
    weight[1] = -1;
    assert_fails(vertex_fit(l, &samples, 1e-6, &f->arena, values, &err),
                 "sample 1 has the weight -1, required: 0 or more");
    weight[1] = 1;
    value[0] = NAN;
    assert_fails(vertex_fit(l, &samples, 1e-6, &f->arena, values, &err),
                 "sample 0 is nan, required: a finite number");
}

TEST_PROGRAM(NULL, NULL)
