/* SPDX-License-Identifier: Apache-2.0 */
/* test_hemisphere_sampling.c -- directions are drawn as their density says. */
#include "hemisphere/tree/sampling_tree_build.h"
#include "hemisphere_fixture.h"

#include <float.h>

#include "hemisphere/tree/sampling_tree.h"
/* Function `function` alone. */
static SamplingMix sampling_only(int function) {
    return (SamplingMix){.count = 1, .function = {function}, .weight = {1}};
}

static const Signal SIGNALS[] = {smooth_signal, peak_signal, zero_outside_signal};

/* The integrals of functions over the leaves, one function after the other. */
static float *integrals_of(Fixture *f, const SamplingOptions *o, const Signal *signals) {
    uint32_t count = (uint32_t)o->octants << 2 * o->level, mask = (1u << 2 * o->level) - 1;
    float *integrals = ARENA_NEW(&f->arena, float, count *(uint32_t)o->functions);
    for (uint32_t k = 0; k < (uint32_t)o->functions; k++)
        for (uint32_t i = 0; i < count; i++) {
            Vec3 center = geodesic_center(o->level, i);
            integrals[k * count + i] =
                signals[k](center) * center.z * f->geodesic->areas[o->level][i & mask];
        }
    return integrals;
}

static SamplingTree sampler_of(Fixture *f, SamplingOptions options, const Signal *signals) {
    const void *blob;
    SamplingTree tree;
    assert_done(
        sampling_tree_build(&options, integrals_of(f, &options, signals), &f->arena, &blob, &err));
    assert_done(
        sampling_tree_open(blob, sampling_tree_size(blob), f->geodesic, &f->arena, &tree, &err));
    return tree;
}

/* Single functions, pairs and all three, alone and mixed. */
static SamplingMix mix_of(int functions) {
    if (functions == 1) return sampling_only(0);
    if (functions == 2) return (SamplingMix){2, {0, 1}, {0.25f, 0.75f}};
    return (SamplingMix){4, {2, 0, 1, 2}, {0.5f, 0, 0.375f, 0.125f}};
}

HEMISPHERE_TEST(the_pdf_integrates_to_1) {
    for (int variant = 0; variant < 12; variant++) {
        int functions = 1 + variant % 3;
        SamplingOptions options = {.level = 6,
                                   .octants = variant % 2 ? 2 : 4,
                                   .functions = functions,
                                   .cells = variant < 6 ? 655 : 100,
                                   .uniform_share = variant % 4 < 2 ? 0 : 0.1f};
        SamplingTree tree = sampler_of(f, options, SIGNALS);
        SamplingMix mix = mix_of(functions);
        double sum = 0;
        for (uint32_t id = 0; id < geodesic_count(6); id++)
            sum += (double)f->geodesic->areas[6][id & 4095] *
                   (double)sampling_tree_pdf(&tree, &mix, geodesic_center(6, id));
        assert_close(sum, 1, 1e-5);
    }
}

static SamplingResult draw(const SamplingTree *tree, const SamplingMix *mix, uint32_t *seed) {
    float u[3];
    for (int i = 0; i < 3; i++) u[i] = random_unit(seed);
    return sampling_tree_sample(tree, mix, u);
}

HEMISPHERE_TEST(samples_follow_the_pdf) {
    uint32_t seed = 12;
    const int count = 200000;
    for (int variant = 0; variant < 9; variant++) {
        int functions = 1 + variant / 3;
        SamplingOptions options = {.level = 6,
                                   .octants = variant % 2 ? 2 : 4,
                                   .cells = 400,
                                   .functions = functions,
                                   .uniform_share = variant == 4 ? 0.2f : 0};
        SamplingTree tree = sampler_of(f, options, SIGNALS + (functions == 1 ? variant : 0));
        SamplingMix mix = mix_of(functions);
        Arena scratch = f->arena;
        int *hits = ARENA_NEW(&scratch, int, geodesic_count(4));
        double *expected = ARENA_NEW(&scratch, double, geodesic_count(4)), chi = 0;
        for (int i = 0; i < count; i++) {
            SamplingResult s = draw(&tree, &mix, &seed);
            assert_true(s.pdf > 0 && s.direction.z >= 0);
            assert_true(s.pdf == sampling_tree_pdf(&tree, &mix, s.direction));
            hits[geodesic_find(f->geodesic, 4, s.direction).id]++;
        }
        for (uint32_t id = 0; id < geodesic_count(6); id++)
            expected[id >> 4] += count * (double)f->geodesic->areas[6][id & 4095] *
                                 (double)sampling_tree_pdf(&tree, &mix, geodesic_center(6, id));
        int bins = 0, pooled_hits = 0;
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
        if (!(fabs(z) < 4.5))
            fail_msg("variant %d: chi-square %g with %d bins", variant, chi, bins);
    }
}

HEMISPHERE_TEST(the_density_is_positive_where_the_function_is) {
    uint32_t seed = 13;
    SamplingMix only = sampling_only(0);
    SamplingOptions options = {.level = 6, .octants = 4, .functions = 1, .cells = 60};
    SamplingTree tree = sampler_of(f, options, SIGNALS + 2);
    for (uint32_t id = 0; id < geodesic_count(6); id++) {
        Vec3 center = geodesic_center(6, id);
        if (zero_outside_signal(center) > 0)
            assert_true(sampling_tree_pdf(&tree, &only, center) > 0);
    }
    options.uniform_share = 0.01f;
    tree = sampler_of(f, options, SIGNALS + 2);
    for (int i = 0; i < 1000; i++)
        assert_true(sampling_tree_pdf(&tree, &only, random_direction(&seed)) >=
                    0.005f / (2 * PI_F)); /* probabilities are stored in steps */
    assert_true(sampling_tree_pdf(&tree, &only, vec3(0, 0, -1)) == 0);
}

/* Numbers at the ends of their range put directions on the cells' edges, where rounding could
 * find the neighbour, whose density may be 0. */
HEMISPHERE_TEST(samples_on_edges_keep_a_density) {
    SamplingMix only = sampling_only(0);
    SamplingOptions options = {.level = 5, .octants = 4, .functions = 1, .cells = 4096};
    SamplingTree tree = sampler_of(f, options, SIGNALS + 2);
    const float ends[] = {0, 0x1p-24f, 0.25f, 0.5f, 0.75f, 1 - 0x1p-24f};
    for (int i = 0; i < 20000; i++)
        for (size_t k = 0; k < sizeof ends / sizeof *ends; k++) {
            float u = (float)i / 20000, a[3] = {u, ends[k]}, b[3] = {ends[k], u};
            assert_true(sampling_tree_sample(&tree, &only, a).pdf > 0);
            assert_true(sampling_tree_sample(&tree, &only, b).pdf > 0);
        }
}

/* Importance sampling beats cosine sampling by far on a narrow peak. */
HEMISPHERE_TEST(weights_of_importance_samples_vary_little) {
    uint32_t seed = 14;
    SamplingMix only = sampling_only(0);
    SamplingOptions options = {.level = 7, .octants = 4, .functions = 1, .cells = 655};
    SamplingTree tree = sampler_of(f, options, SIGNALS + 1);
    double sum = 0, squares = 0;
    const int count = 50000;
    for (int i = 0; i < count; i++) {
        SamplingResult s = draw(&tree, &only, &seed);
        double w = (double)(peak_signal(s.direction) * s.direction.z / s.pdf);
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

/* As few cells as a variance requires, and the variance is what is then measured. */
HEMISPHERE_TEST(cells_are_spent_until_the_variance_is_reached) {
    uint32_t last = 0;
    const float wanted[] = {0.2f, 0.05f, 0.0125f};
    for (int k = 0; k < 3; k++) {
        SamplingOptions options = {
            .level = 7, .octants = 4, .functions = 2, .cells = 16000, .variance = wanted[k]};
        SamplingTree tree = sampler_of(f, options, SIGNALS);
        assert_true(tree.cell_count > 2 * last);
        last = tree.cell_count;
        for (int function = 0; function < 2; function++) {
            SamplingMix only = sampling_only(function);
            double sum = 0, squares = 0;
            for (uint32_t id = 0; id < geodesic_count(7); id++) {
                Vec3 center = geodesic_center(7, id);
                double area = (double)f->geodesic->areas[7][id & 16383];
                double g = (double)(SIGNALS[function](center) * center.z);
                sum += g * area;
                squares += g * g * area / (double)sampling_tree_pdf(&tree, &only, center);
            }
            double variance = squares / (sum * sum) - 1;
            if (!(variance < 1.15 * (double)wanted[k] + 0.001))
                fail_msg("required: %g: %u cells, function %d varies %g", (double)wanted[k],
                         tree.cell_count, function, variance);
        }
    }
}

/* Functions that are alike cost little more than one of them. */
HEMISPHERE_TEST(functions_that_are_alike_take_few_bytes) {
    const void *one, *four;
    Signal signals[4] = {peak_signal, peak_signal, peak_signal, peak_signal};
    SamplingOptions options = {.level = 6, .octants = 2, .functions = 1, .cells = 500};
    float *integrals = integrals_of(f, &options, signals);
    assert_done(sampling_tree_build(&options, integrals, &f->arena, &one, &err));
    assert_true(sampling_tree_size(one) < 700);
    options.functions = 4;
    integrals = integrals_of(f, &options, signals);
    assert_done(sampling_tree_build(&options, integrals, &f->arena, &four, &err));
    assert_true(sampling_tree_size(four) < sampling_tree_size(one) + 3 * 70);
}

static void try_sampler(const Fixture *f, const char *blob, size_t size, int *opened) {
    char *copy = malloc(size ? size : 1);
    Arena scratch = f->arena;
    SamplingTree tree;
    Error err = {0};
    uint32_t seed = 15;
    memcpy(copy, blob, size);
    if (sampling_tree_open(copy, size, f->geodesic, &scratch, &tree, &err)) {
        for (int i = 0; i < 16; i++) {
            SamplingMix mix = {2, {0, tree.functions - 1}, {0.5f, 0.5f}};
            SamplingResult s = draw(&tree, &mix, &seed);
            assert_true(s.pdf >= 0 && isfinite(s.pdf) && vec3_is_within(s.direction, FLT_MAX));
        }
        (*opened)++;
    } else {
        assert_true(err.text[0] != 0);
    }
    free(copy);
}

/* A blob of two random functions, of a geodesic that is not a level finer than it. */
static const void *small_blob(Fixture *f, Arena *arena, size_t *size) {
    uint32_t seed = 16;
    float integrals[512];
    for (int i = 0; i < 512; i++) integrals[i] = random_unit(&seed);
    SamplingOptions options = {.level = 3, .octants = 4, .functions = 2, .cells = 100};
    const void *blob;
    f->geodesic = geodesic_create(3, arena);
    assert_done(sampling_tree_build(&options, integrals, arena, &blob, &err));
    *size = sampling_tree_size(blob);
    return blob;
}

HEMISPHERE_TEST(mutated_sampling_trees_are_refused_or_harmless) {
    uint32_t seed = 16;
    int opened = 0;
    size_t size;
    const void *blob = small_blob(f, &f->arena, &size);
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

static void assert_refused(const Fixture *f, const void *blob, size_t size, const char *text) {
    Arena scratch = f->arena;
    SamplingTree tree;
    Error err = {0};
    assert_false(sampling_tree_open(blob, size, f->geodesic, &scratch, &tree, &err));
    if (!strstr(err.text, text)) fail_msg("%s, required: %s", err.text, text);
}

HEMISPHERE_TEST(what_does_not_fit_the_header_is_named) {
    size_t size;
    const void *blob = small_blob(f, &f->arena, &size);
    SamplingHeader *copy = arena_alloc(&f->arena, 1, 16, size);
    memcpy(copy, blob, size);
    copy->level = 2;
    assert_refused(f, copy, size, "depth is 3, required: 2");
    f->geodesic = geodesic_create(1, &f->arena);
    assert_refused(f, copy, size, "level of the geodesic is 1, required: 2");
    f->geodesic = geodesic_create(3, &f->arena);
    memcpy(copy, blob, size);
    copy->splits++;
    assert_refused(f, copy, size, "number of splits");
    copy->splits -= 2;
    assert_refused(f, copy, size, "number of splits");
    memcpy(copy, blob, size);
    copy->functions = 3; /* nothing is left for the third */
    assert_refused(f, copy, size, "a probability is missing");
    copy->functions = 1;
    assert_refused(f, copy, size, "number of bytes");
    assert_refused(f, blob, size - 1, "number of bytes");
}

HEMISPHERE_TEST(functions_that_cannot_be_sampled_are_named) {
    float integrals[16] = {0};
    SamplingOptions options = {.level = 1, .octants = 4, .functions = 1, .cells = 8};
    const void *blob;
    assert_fails(sampling_tree_build(&options, integrals, &f->arena, &blob, &err),
                 "that is 0 cannot be sampled");
    integrals[5] = -1;
    assert_fails(sampling_tree_build(&options, integrals, &f->arena, &blob, &err), "leaf 5 is -1");
    options.cells = 3;
    assert_fails(sampling_tree_build(&options, integrals, &f->arena, &blob, &err), "cells are 3");
    options.functions = 0;
    assert_fails(sampling_tree_build(&options, integrals, &f->arena, &blob, &err),
                 "functions are 0");
}

TEST_PROGRAM(NULL, NULL)
