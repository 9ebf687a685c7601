/* test_hemisphere_sampling.c -- directions are drawn as their density says. */
#include "hemisphere_fixture.h"

#include "hemisphere/sampling_tree.h"
static const Signal SIGNALS[] = {smooth_signal, peak_signal, zero_outside_signal};

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
    if (!sampling_tree_build(&options, integrals, &f->arena, &blob, &err))
        fail_msg("%s", err.text);
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
        if (!(fabs(z) < 4.5))
            fail_msg("variant %d: chi-square %g with %d bins", variant, chi, bins);
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

/* Numbers at the ends of their range put directions on the cells' edges, where rounding could
 * find the neighbour, whose density may be 0. */
static void samples_on_edges_keep_a_density(void **state)
{
    Fixture        *f = *state;
    SamplingOptions options = {.level = 5, .octants = 4, .cells = 4096};
    SamplingTree    tree = sampler_of(f, options, zero_outside_signal);
    const float     ends[] = {0, 0x1p-24f, 0.25f, 0.5f, 0.75f, 1 - 0x1p-24f};
    for (int i = 0; i < 20000; i++)
        for (size_t k = 0; k < sizeof ends / sizeof *ends; k++) {
            float u = (float)i / 20000;
            assert_true(sampling_tree_sample(&tree, u, ends[k]).pdf > 0);
            assert_true(sampling_tree_sample(&tree, ends[k], u).pdf > 0);
        }
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
    f->geodesic = geodesic_create(3, &f->arena); /* not a level more than the tree's */
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

static void sampling_trees_deeper_than_their_header_are_refused(void **state)
{
    Fixture        *f = *state;
    uint32_t        seed = 18;
    float           integrals[256];
    SamplingOptions options = {.level = 3, .octants = 4, .cells = 100};
    const void     *blob;
    SamplingTree    tree;
    Error           err;
    for (int i = 0; i < 256; i++) integrals[i] = random_unit(&seed);
    assert_true(sampling_tree_build(&options, integrals, &f->arena, &blob, &err));
    size_t          size = sampling_tree_size(blob);
    SamplingHeader *copy = arena_alloc(&f->arena, 1, 16, size);
    memcpy(copy, blob, size);
    copy->level = 2;
    assert_false(sampling_tree_open(copy, size, f->geodesic, &tree, &err));
    assert_non_null(strstr(err.text, "depth is 3, wanted 2"));
    assert_false(sampling_tree_open(copy, size, geodesic_create(1, &f->arena), &tree, &err));
    assert_non_null(strstr(err.text, "level of the geodesic is 1, wanted 2"));
    memcpy(copy, blob, size);
    copy->octants = 2; /* the octants' children differ */
    assert_false(sampling_tree_open(copy, size, f->geodesic, &tree, &err));
    assert_non_null(strstr(err.text, "mirror image"));
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


int main(void)
{
    const struct CMUnitTest tests[] = {
        CASE(the_pdf_integrates_to_1),
        CASE(samples_follow_the_pdf),
        CASE(the_density_is_positive_where_the_function_is),
        CASE(samples_on_edges_keep_a_density),
        CASE(weights_of_importance_samples_vary_little),
        CASE(mutated_sampling_trees_are_refused_or_harmless),
        CASE(sampling_trees_deeper_than_their_header_are_refused),
        CASE(functions_that_cannot_be_sampled_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
