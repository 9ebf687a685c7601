/* SPDX-License-Identifier: Apache-2.0 */
/* How many samples a frame takes for a relative error: laws over light that is made up here,
 * sample by sample, without a scene. */
#include "fixture.h"

#include <math.h>

#include "base/count.h"
#include "render/noise_stop.h"
#include "render/tiles.h"

/* ---- light ------------------------------------------------------------------------------- */

/* So many samples in 2^32 are glints. A test has one thread. */
static uint32_t glints;
static uint32_t dark_seed; /* whose samples are black; 0: none is */

static double probability(void) {
    return glints / 4294967296.0;
}

static float glint_light(void) {
    return glints ? (float)(1 / probability()) : 0;
}

/* An even spread about 1, and glints that bring as much light again. */
static float luminance_of(uint32_t seed, int x, int y, uint32_t index) {
    uint32_t hash =
        hash_combine(hash_combine(hash_combine(hash_u32(seed), (uint32_t)x), (uint32_t)y), index);
    if (dark_seed && seed == dark_seed) return 0;
    float even = 0.5f + (float)hash_u32(hash + 1) / 4294967296.0f;
    return even + (hash < glints ? glint_light() : 0);
}

static void render(const TileJob *job, FilmRect rect, PathStatistics *statistics) {
    for (int y = rect.y0; y < rect.y1; y++)
        for (int x = rect.x0; x < rect.x1; x++) {
            uint32_t share = sample_shares_at(&job->shares, x, y);
            uint32_t end = sample_shares_own(share, job->end_sample);
            for (uint32_t i = sample_shares_own(share, job->first_sample); i < end; i++) {
                float y_value = luminance_of(job->seed, x, y, i);
                FilmSample sample = {.sample_index = i,
                                     .part_id = -1,
                                     .display_id = -1,
                                     .xyz = {0.95f * y_value, y_value, 1.09f * y_value}};
                film_add_sample(job->film, x, y, &sample);
                statistics->samples++;
            }
        }
}

static const Kernel made_up = {.isa = "none", .render = render};

/* Of a sample, and of the mean: half the light is rare, if any. */
static double true_error(uint32_t samples) {
    double p = probability(), even = 1 / 12.0, rare = p > 0 ? (1 - p) / p : 0;
    return sqrt((even + rare) / samples) / (p > 0 ? 2 : 1);
}

/* ---- frames ------------------------------------------------------------------------------ */

static FilmRect all; /* square */
static Camera camera;

static void set_side(int pixels) {
    all = (FilmRect){0, 0, pixels, pixels};
    camera = (Camera){.width = pixels, .height = pixels};
}

static NoiseArgs ask_of(uint32_t seed, double error) {
    return (NoiseArgs){.kernel = &made_up,
                       .camera = &camera,
                       .crop = all,
                       .area = {all, FILM_ALL_PIXELS},
                       .shares = {NULL, all},
                       .seed = seed,
                       .most = 4096,
                       .error = error,
                       .threads = 1,
                       .progress = PROGRESS_NONE};
}

static Film *frame_of(uint32_t seed, uint32_t samples, Arena *arena) {
    Film *film = film_create(all.x1, all.y1, all, 0, NULL, arena);
    TileJob job = {.camera = &camera,
                   .film = film,
                   .seed = seed,
                   .shares = {NULL, all},
                   .end_sample = samples};
    PathStatistics counts = {0};
    render(&job, all, &counts);
    return film;
}

/* ---- who decides ------------------------------------------------------------------------- */

/* A frame whose samples decide how many it takes stops where its rare light has not come yet.
 * So the number stays what it is whatever the frame's own samples show. */
MEMORY_TEST(no_sample_of_the_frame_decides) {
    static const double errors[] = {0.6, 0.3, 0.15};
    glints = 1u << 27; /* one in 32 */
    set_side(4);
    for (uint32_t seed = 1; seed <= 8; seed++)
        for (int k = 0; k < COUNT_OF(errors); k++) {
            Arena scratch = *arena;
            NoiseArgs args = ask_of(seed, errors[k]);
            NoiseStop stop = noise_stop_find(&args, &scratch), again;
            dark_seed = seed;
            again = noise_stop_find(&args, &scratch);
            dark_seed = 0;
            assert_true(stop.reached && stop.samples >= NOISE_LEAST_SAMPLES);
            assert_int_equal(again.samples, stop.samples);
            assert_true(again.error == stop.error);
        }
}

MEMORY_TEST(any_threads_find_the_same) {
    glints = 1u << 27;
    set_side(40); /* not all pixels are looked at */
    NoiseArgs args = ask_of(5, 0.2);
    NoiseStop one = noise_stop_find(&args, arena), three;
    args.threads = 3;
    three = noise_stop_find(&args, arena);
    assert_int_equal(one.pixels, NOISE_PIXELS_LEAST);
    assert_int_equal(one.samples, three.samples);
    assert_true(one.error == three.error);
    assert_true(noise_stop_doubt(&one, (FilmSpikes){0}, 100) ==
                noise_stop_doubt(&three, (FilmSpikes){0}, 100));
}

/* A smaller error takes more samples; one that is too small all there are, and an area that
 * nothing shows, too. */
MEMORY_TEST(samples_are_found_between_least_and_most) {
    uint32_t before = 0;
    glints = 1u << 27;
    set_side(12);
    for (double error = 0.8; error > 0.001; error /= 2) {
        Arena scratch = *arena;
        NoiseArgs args = ask_of(3, error);
        NoiseStop stop = noise_stop_find(&args, &scratch);
        assert_true(stop.samples >= before && stop.samples >= NOISE_LEAST_SAMPLES);
        assert_true(stop.reached ? stop.error <= error : stop.samples == args.most);
        before = stop.samples;
    }
    assert_int_equal(before, 4096);
    NoiseArgs none = ask_of(3, 0.5);
    none.area.rect = (FilmRect){12, 12, 13, 13};
    NoiseStop stop = noise_stop_find(&none, arena);
    assert_true(!stop.reached && stop.samples == none.most && isnan(stop.error));
    assert_true(isnan(noise_stop_doubt(&stop, (FilmSpikes){0}, 16)));
    assert_false(noise_stop_is_rare(&stop, (double)NAN, (double)NAN));
}

/* ---- what is reported -------------------------------------------------------------------- */

/* Of the frames that do not say that light is rare, the error that they report is that of their
 * samples to a fifth, in the mean; of frames whose light is rare nearly all say so. */
static void check_told(uint32_t some, double error, Arena arena) {
    double ratio = 0;
    int known = 0, count = 12;
    glints = some;
    for (int seed = 0; seed < count; seed++) {
        Arena scratch = arena;
        NoiseArgs args = ask_of(1000 + (uint32_t)seed, error);
        NoiseStop stop = noise_stop_find(&args, &scratch);
        Film *film = frame_of(args.seed, stop.samples, &scratch);
        double told = film_area_error(film, args.area);
        FilmSpikes spikes = film_area_spikes(film, args.area);
        double doubt = noise_stop_doubt(&stop, spikes, stop.samples);
        if (noise_stop_is_rare(&stop, told, doubt)) continue;
        ratio += told / true_error(stop.samples);
        known++;
    }
    print_message("p %g, error %g: %d of %d know it, told / true %.3f\n", probability(), error,
                  known, count, known ? ratio / known : (double)NAN);
    if (known > count / 10) assert_true(fabs(ratio / known - 1) < 0.2);
}

MEMORY_TEST(errors_that_are_told_are_true_or_not_known) {
    static const uint32_t some[] = {0, 1u << 30, 1u << 28, 1u << 26, 1u << 24, 1u << 22};
    static const double errors[] = {0.5, 0.3, 0.1};
    int count = COUNT_OF(errors) - !all_laws(); /* the last takes most of the time */
    set_side(12);
    for (int i = 0; i < COUNT_OF(some); i++)
        for (int k = 0; k < count; k++) check_told(some[i], errors[k], *arena);
}

TEST_PROGRAM(make_arena, drop_arena)
