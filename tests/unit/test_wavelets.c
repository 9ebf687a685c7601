/* SPDX-License-Identifier: Apache-2.0 */
/* test_wavelets.c -- a table in the paper's basis: exact laws, and errors that behave. */
#include "panel/wavelets/wavelet_study.h"
#include "fixture.h"

#include <math.h>

#include "base/units.h"

#define RINGS 44
#define AZIMUTHS 60

static float smooth(double theta, double phi)
{
    double z = cos(theta);
    return (float)(300 * z * z + 40 * sin(theta) * cos(phi) * z + 25);
}

static float even(double theta, double phi)
{
    (void)theta, (void)phi;
    return 7;
}

/* A white-only set of rings by 2 degrees. */
static Measurement *set_of(float (*luminance)(double, double), Arena *arena)
{
    int          rows = 1 + RINGS * AZIMUTHS;
    Measurement *set = ARENA_NEW(arena, Measurement, 1);
    float       *theta = ARENA_NEW(arena, float, rows), *phi = ARENA_NEW(arena, float, rows);
    float       *value = ARENA_NEW(arena, float, 3 * rows);
    for (int i = 0; i < rows; i++) {
        theta[i] = i ? (float)radians_from_degrees(2.0 * (1 + (i - 1) / AZIMUTHS)) : 0;
        phi[i] = i ? (float)(2 * PI * ((i - 1) % AZIMUTHS) / AZIMUTHS) : 0;
        for (int c = 0; c < 3; c++)
            value[3 * i + c] = (1 + 0.1f * (float)c) *
                               luminance((double)theta[i], (double)phi[i]);
    }
    set->file = "made.csv";
    set->is_white_only = true;
    set->white = (AngleTable){.name = "white", .rows = rows, .channels = 3, .theta = theta,
                              .phi = phi, .value = value,
                              .theta_max = (float)radians_from_degrees(2.0 * RINGS)};
    return set;
}

static WaveletStudy *study_of(const Measurement *set, WaveletOptions options, Arena *arena)
{
    WaveletStudy *study = ARENA_NEW(arena, WaveletStudy, 1);
    assert_done(wavelet_study(set, &options, arena, study, &err));
    return study;
}

static const WaveletOptions USUAL = {.level = -1};

/* Of the smooth table; made once. */
static const WaveletStudy *usual(Arena *arena)
{
    static const WaveletStudy *made;
    if (!made) made = study_of(set_of(smooth, arena), USUAL, arena);
    return made;
}

MEMORY_TEST(a_level_has_four_times_the_triangles_and_fathers_are_means)
{
    const WaveletStudy *s = usual(arena);
    assert_int_equal(s->level, 5); /* 4,096 triangles for 2,641 directions */
    for (int i = 0; i <= s->level; i++) {
        assert_int_equal(s->levels[i].triangles, 4 << 2 * i);
        if (i) assert_close(s->levels[i].resolution_deg,
                            s->levels[i - 1].resolution_deg / 2, 1e-12);
    }
    assert_true(s->mean_miss < 1e-6);
}

/* Without loss leaves are exact to rounding, and means come nearer with every level. */
MEMORY_TEST(without_loss_every_leaf_comes_back)
{
    WaveletOptions options = {.level = -1, .is_lossless = true};
    const WaveletStudy *s = study_of(set_of(smooth, arena), options, arena);
    assert_int_equal(s->kept.rows, 4096);
    assert_true(s->kept.leaf_max < 1e-6);
    for (int i = 1; i <= s->level; i++) {
        const WaveletErrors *e = &s->levels[i].errors, *coarser = &s->levels[i - 1].errors;
        assert_true(e->rms < 0.7 * coarser->rms);
        assert_true(i < 2 || e->smooth_rms < e->rms);
    }
    assert_true(s->levels[s->level].errors.smooth_rms < 0.01);
}

MEMORY_TEST(an_even_table_needs_its_four_means)
{
    const WaveletStudy *s = study_of(set_of(even, arena), USUAL, arena);
    assert_true(s->size_count >= 6);
    for (int i = 0; i < s->size_count; i++) {
        assert_true(s->sizes[i].leaf_max < 1e-5);
        assert_true(s->sizes[i].errors.smooth_max < 1e-5);
    }
}

/* More is nearer; bytes are about the share that was requested. */
MEMORY_TEST(errors_fall_with_size)
{
    const WaveletStudy *s = usual(arena);
    for (int i = 1; i < s->size_count; i++) {
        assert_true(s->sizes[i].leaf_rms < s->sizes[i - 1].leaf_rms);
        assert_true(s->sizes[i].errors.rms < s->sizes[i - 1].errors.rms);
    }
    const WaveletSize *last = &s->sizes[s->size_count - 1];
    assert_close(last->share, 0.1, 0.01);
    assert_true((double)last->bytes < 0.1 * (double)s->source_bytes);
    assert_true(last->leaf_rms < 0.08);
}

MEMORY_TEST(what_is_kept_of_noisy_data_is_nearer_to_the_truth)
{
    WaveletOptions options = USUAL;
    options.noise = 0.1;
    const WaveletStudy *s = study_of(set_of(smooth, arena), options, arena);
    const WaveletSize  *last = &s->sizes[s->size_count - 1];
    assert_close(s->noise_rms, 0.1, 0.05);
    assert_true(last->truth_rms < 0.8 * s->noise_rms);
    assert_true(last->truth_rms < last->errors.smooth_rms);
}

/* A query goes down one triangle a level: 4,096 times the triangles, not 30 times as long. */
MEMORY_TEST(queries_take_the_logarithm_of_the_triangles)
{
    const WaveletStudy *s = usual(arena);
    assert_true(s->query_ns[8] < 30 * s->query_ns[2]);
    assert_true(s->smooth_ns[8] < 30 * s->smooth_ns[2]);
}

MEMORY_TEST(a_spectrum_is_exact_where_its_wavelet_is)
{
    Measurement *set = set_of(smooth, arena);
    set->has_spectra = true;
    for (int i = 0; i < SPECTRAL_COUNT; i++) set->spectrum[1][i] = 2;
    const WaveletStudy *s = study_of(set, USUAL, arena);
    assert_int_equal(s->spectrum.count, SPECTRAL_COUNT);
    for (int k = 0; k < 3; k++) assert_true(s->spectrum.rms[k][0] < 1e-5);
    assert_int_equal(usual(arena)->spectrum.count, 0);
}

MEMORY_TEST(what_cannot_be_is_refused_in_words)
{
    WaveletStudy   study;
    Measurement   *set = set_of(smooth, arena);
    WaveletOptions options = USUAL;
    options.table = "mauve 12";
    assert_fails(wavelet_study(set, &options, arena, &study, &err),
                 "--table is 'mauve 12', which the set lacks");
    options = USUAL;
    options.keep = 1e-4;
    assert_fails(wavelet_study(set, &options, arena, &study, &err),
                 "--keep is 0.0001, required: at least");
    memset((float *)(uintptr_t)set->white.value, 0, 12 * (size_t)set->white.rows);
    assert_fails(wavelet_study(set, &USUAL, arena, &study, &err), "table white is dark");
    set->is_white_only = false;
    assert_fails(wavelet_study(set, &USUAL, arena, &study, &err), "has no table");
}

TEST_PROGRAM(make_arena, drop_arena)
