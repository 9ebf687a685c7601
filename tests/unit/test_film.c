/* SPDX-License-Identifier: Apache-2.0 */
/* The film: exact sums, variance, layers. */
#include "film_samples.h"

#include "base/units.h"
#include "film/pixels.h"
#include "spectrum/photometry.h"

static float *member_of(FilmSample *sample, int row) {
    return (float *)(void *)((char *)sample + sums_rows[row].member);
}

/* Samples over 18 powers of ten, negative ones too, with every layer set. */
static FilmSample random_sample(uint32_t *state, uint32_t index) {
    FilmSample s = {.sample_index = index, .hit = random_unit(state) < 0.9f};
    for (int i = 0; i < 3; i++)
        s.xyz[i] = powf(10, -6 + 18 * random_unit(state)) * (random_unit(state) < 0.1f ? -1 : 1);
    for (int row = 0; row < SUMS_COUNT; row++)
        for (int i = 0; i < sums_rows[row].size && sums_rows[row].member != NO_MEMBER; i++)
            member_of(&s, row)[i] = 500 * random_unit(state) - 50;
    s.part_id = (int)(random_unit(state) * 5);
    s.display_id = random_unit(state) < 0.5f ? (int)(random_unit(state) * 3) : -1;
    s.theta = random_unit(state);
    s.phi = 6 * random_unit(state);
    return s;
}

static void assert_same_frames(const FrameImage *a, const FrameImage *b) {
    assert_int_equal(a->channel_count, b->channel_count);
    for (int i = 0; i < a->channel_count; i++) {
        assert_string_equal(a->channels[i].name, b->channels[i].name);
        assert_memory_equal(a->channels[i].values, b->channels[i].values,
                            frame_pixel_count(a) * sizeof(float));
    }
}

/* ---- every row of the table -------------------------------------------------------------- */

#define MEAN_ROW(NAME, bit, of, option, letters, reader, sums) \
    {option, letters, #reader, SUMS_##sums},

/* Channels of two samples' mean; those of displays are XYZ in the sample. */
static void check_mean(const FrameImage *frame, const char *layer, const char *letters,
                       const float mean[3]) {
    for (int i = 0; letters[i]; i++) {
        char name[64];
        snprintf(name, sizeof name, "%s.%c", layer, letters[i]);
        assert_near(at(frame, name, 0), (double)mean[i], 1e-4);
    }
}

ARENA_TEST(a_layer_of_a_member_is_its_mean_over_the_samples) {
    static const struct {
        const char *layer, *letters, *reader;
        int sums;
    } rows[] = {FILM_LAYERS(MEAN_ROW)};
    int checked = 0;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        int sums = rows[k].sums;
        FilmSample sample[2] = {{.hit = true}, {.sample_index = 1, .hit = true}};
        if (strcmp(rows[k].reader, "mean") != 0 || sums == SUMS_COUNT || !*rows[k].letters ||
            sums_rows[sums].member == NO_MEMBER)
            continue;
        float mean[3] = {0}, shown[3];
        Film *film = film_create(WIDTH, HEIGHT, whole, LAYER_ALL, NULL, &arena);
        for (int n = 0; n < 2; n++) {
            for (int i = 0; i < sums_rows[sums].size; i++) {
                member_of(&sample[n], sums)[i] = (float)(1 + 2 * n + i);
                mean[i] += 0.5f * (float)(1 + 2 * n + i);
            }
            film_add_sample(film, 0, 0, &sample[n]);
        }
        rgb_from_xyz(mean, shown);
        FrameImage frame = film_to_frame(film, 0, &arena);
        check_mean(&frame, rows[k].layer, rows[k].letters,
                   sums >= SUMS_FIRST_DISPLAY ? shown : mean);
        checked++;
    }
    assert_true(checked >= 11);
}

/* ---- exactness --------------------------------------------------------------------------- */

ARENA_TEST(any_order_of_adding_gives_the_same_bits) {
    enum { COUNT = 500 };
    FilmSample samples[COUNT];
    uint32_t random = 1;
    for (uint32_t i = 0; i < COUNT; i++) samples[i] = random_sample(&random, i);
    Film *rising = film_create(WIDTH, HEIGHT, whole, LAYER_ALL, NULL, &arena);
    for (int i = 0; i < COUNT; i++) film_add_sample(rising, 1, 1, &samples[i]);
    FrameImage expected = film_to_frame(rising, 0, &arena);
    for (int order = 0; order < 20; order++) {
        for (int i = COUNT - 1; i > 0; i--) {
            int other = (int)(random_unit(&random) * (float)(i + 1));
            FilmSample kept = samples[i];
            samples[i] = samples[other];
            samples[other] = kept;
        }
        Film *shuffled = film_create(WIDTH, HEIGHT, whole, LAYER_ALL, NULL, &arena);
        for (int i = 0; i < COUNT; i++) film_add_sample(shuffled, 1, 1, &samples[i]);
        FrameImage found = film_to_frame(shuffled, 0, &arena);
        assert_same_frames(&expected, &found);
    }
}

ARENA_TEST(the_mean_is_that_of_long_doubles) {
    static const float scales[] = {1e-6f, 1e-2f, 1, 1e4f, 1e12f};
    uint32_t random = 7;
    for (size_t k = 0; k < sizeof scales / sizeof *scales; k++) {
        Film *film = film_create(WIDTH, HEIGHT, whole, 0, NULL, &arena);
        long double sum[3] = {0};
        int count = 20000;
        for (int n = 0; n < count; n++) {
            FilmSample s = {.display_id = -1};
            for (int i = 0; i < 3; i++) {
                s.xyz[i] = scales[k] * (0.1f + random_unit(&random));
                sum[i] += (long double)s.xyz[i];
            }
            film_add_sample(film, 0, 0, &s);
        }
        FilmPixel pixel = film_pixel(film, 0, 0);
        for (int i = 0; i < 3; i++)
            assert_close(pixel.mean_xyz[i], (double)(sum[i] / count), 1e-12);
    }
}

ARENA_TEST(a_millionth_candela_survives_beside_a_tera_candela) {
    Film *film = film_create(WIDTH, HEIGHT, whole, 0, NULL, &arena);
    add_grey(film, 0, 0, 0, 1e12f);
    add_grey(film, 0, 0, 1, 1e-6f);
    add_grey(film, 0, 0, 2, -1e12f);
    assert_close(film_pixel(film, 0, 0).mean_xyz[1], (double)1e-6f / 3, 1e-12);
}

/* The worst sample's steps, times the most samples a pixel takes, fit 128 bits: white, and the
 * colours that have the largest R, G and B; just below the split of the squares, too. */
ARENA_TEST(the_largest_sums_do_not_overflow) {
    static const float worst[][3] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, 1}, {1, -1, 1}};
    static const float sizes[] = {0x1p47f, 0x1.3p16f, 0x1.ep16f};
    for (size_t k = 0; k < sizeof worst / sizeof *worst * 3; k++) {
        Film *film = film_create(WIDTH, HEIGHT, whole, 0, NULL, &arena);
        FilmSample s = {.display_id = -1};
        for (int i = 0; i < 3; i++) s.xyz[i] = sizes[k % 3] * worst[k / 3][i];
        film_add_sample(film, 0, 0, &s);
        const PixelSums *sums = film_sums(film, 0, 0);
        for (int i = 0; i < 3; i++) {
            Fixed product;
            assert_false(__builtin_mul_overflow(sums->xyz[i], (Fixed)FILM_SAMPLES_MAX, &product));
            for (int j = 0; j < 2; j++)
                assert_false(
                    __builtin_mul_overflow(sums->squares[i][j], (Fixed)FILM_SAMPLES_MAX, &product));
        }
    }
}

ARENA_TEST(losses_are_counted_and_the_smallest_kept_in_any_order) {
    Film *film = film_create(WIDTH, HEIGHT, whole, 0, NULL, &arena);
    static const float bad[] = {NAN, INFINITY, -INFINITY, 0x1.8p47f};
    for (int i = 0; i < 40; i++) {
        uint32_t index = (uint32_t)(i * 23 % 40);
        add_grey(film, (int)index % WIDTH, (int)index % HEIGHT, index, bad[i % 4]);
    }
    add_grey(film, 0, 0, 3, 5);
    FilmDropped dropped = film_dropped(film);
    assert_int_equal(dropped.count, 40);
    assert_int_equal(dropped.kept, FILM_DROPPED_KEPT);
    for (int i = 0; i < dropped.kept; i++) {
        assert_int_equal(dropped.first[i].sample_index, i);
        assert_int_equal(dropped.first[i].x, i % WIDTH);
        assert_int_equal(dropped.first[i].y, i % HEIGHT);
    }
    assert_close(film_pixel(film, 0, 0).mean_xyz[1], 5, 1e-15);
    assert_int_equal(film_pixel(film, 0, 0).samples, 1);
}

/* ---- variance and error ------------------------------------------------------------------ */

/* n samples, half of them a, half b: the variance of the mean is (a-b)^2 / 4 / (n-1). */
ARENA_TEST(variance_has_its_closed_form_at_every_scale) {
    static const float scales[] = {1e-5f, 1, 1e4f, 1e9f, 1e13f};
    for (size_t k = 0; k < sizeof scales / sizeof *scales; k++) {
        Film *film = film_create(WIDTH, HEIGHT, whole, 0, NULL, &arena);
        float low = scales[k], high = 3 * scales[k], xyz[3] = {1, 1, 1}, rgb[3];
        int n = 1000;
        for (int i = 0; i < n; i++) add_grey(film, 0, 0, (uint32_t)i, i % 2 ? low : high);
        FilmPixel pixel = film_pixel(film, 0, 0);
        rgb_from_xyz(xyz, rgb);
        for (int i = 0; i < 3; i++) {
            double range = ((double)high - (double)low) * (double)rgb[i];
            assert_close(pixel.variance_rgb[i], range * range / 4 / (n - 1), 1e-5);
        }
    }
}

ARENA_TEST(variance_spans_both_windows_of_squares) {
    Film *film = film_create(WIDTH, HEIGHT, whole, 0, NULL, &arena);
    float values[] = {1, 100, 8000, 200000, 1e6f};
    double sum = 0, squares = 0;
    float xyz[3] = {1, 1, 1}, rgb[3];
    rgb_from_xyz(xyz, rgb);
    for (int i = 0; i < 5; i++) {
        double green = (double)values[i] * (double)rgb[1];
        add_grey(film, 0, 0, (uint32_t)i, values[i]);
        sum += green;
        squares += green * green;
    }
    assert_close(film_pixel(film, 0, 0).variance_rgb[1], (squares - sum * sum / 5) / 4 / 5, 1e-6);
}

ARENA_TEST(variance_needs_two_samples) {
    Film *film = film_create(WIDTH, HEIGHT, whole, 0, NULL, &arena);
    assert_true(isnan(film_pixel(film, 0, 0).variance_rgb[0]));
    add_grey(film, 0, 0, 0, 1);
    assert_true(isnan(film_pixel(film, 0, 0).variance_rgb[0]));
    add_grey(film, 0, 0, 1, 1);
    assert_near(film_pixel(film, 0, 0).variance_rgb[0], 0, 1e-15);
}

TEST(relative_error_is_the_mean_of_sigma_over_luminance) {
    enum { SIDE = 100 };
    static const uint32_t counts[] = {20, 64, 200};
    for (int c = 0; c < 3; c++) {
        Arena arena = *test_memory();
        FilmRect square = {0, 0, SIDE, SIDE};
        Film *film = film_create(SIDE, SIDE, square, 0, NULL, &arena);
        assert_close(film_relative_error(film).frame, 1, 1e-15);
        for (int p = 0; p < SIDE * SIDE; p++)
            for (uint32_t i = 0; i < counts[c]; i++)
                add_grey(film, p % SIDE, p / SIDE, i, coin(p, i, (float)(1 + p % SIDE)));
        /* Pixels are 2 (1 + x) with sigma 1 (1 + x); the darkest count as half the key. */
        double expected = 0, key = 0;
        for (int x = 0; x < SIDE; x++) key += log(2.0 * (1 + x)) / SIDE;
        key = exp(key);
        for (int x = 0; x < SIDE; x++)
            expected += (1 + x) / fmax(2.0 * (1 + x), key / 2) / SIDE / sqrt(counts[c]);
        assert_close(film_relative_error(film).frame, expected, 0.03);
        assert_true(isnan(film_relative_error(film).displays));
    }
}

/* Samples whose errors cancel within every block: the mean is sure, whatever their spread. */
ARENA_TEST(relative_error_knows_that_even_samples_are_better) {
    Film *film = film_create(WIDTH, HEIGHT, whole, 0, NULL, &arena);
    for (int p = 0; p < WIDTH * HEIGHT; p++)
        for (uint32_t i = 0; i < 64; i++)
            add_grey(film, p % WIDTH, p / WIDTH, i, i % 2 ? 1.0f : 3.0f);
    assert_near(film_relative_error(film).frame, 0, 1e-12);
    assert_close(film_pixel(film, 0, 0).variance_rgb[1] / pow(0.948, 2), 1.0 / 63, 0.01);
}

/* Five pixels of 100 without noise and one of 1 with sigma 0.1: judged against half the key. */
ARENA_TEST(relative_error_judges_shadows_against_half_the_key) {
    Film *film = film_create(WIDTH, HEIGHT, whole, 0, NULL, &arena);
    double key = pow(100, 5.0 / 6);
    for (uint32_t i = 0; i < 26; i++)
        for (int p = 0; p < WIDTH * HEIGHT; p++)
            add_grey(film, p % WIDTH, p / WIDTH, i, p ? 100 : i % 2 ? 0.5f : 1.5f);
    assert_close(film_relative_error(film).frame, 0.1 / (key / 2) / 6, 1e-3);
}

/* One sample of one pixel is some hundred times as bright as all others. */
ARENA_TEST(one_bright_sample_makes_the_error_doubtful) {
    for (int is_rare = 0; is_rare < 2; is_rare++) {
        Film *film = film_create(WIDTH, HEIGHT, whole, 0, NULL, &arena);
        for (uint32_t i = 0; i < 64; i++)
            for (int p = 0; p < WIDTH * HEIGHT; p++)
                add_grey(film, p % WIDTH, p / WIDTH, i,
                         is_rare && !p && i == 20 ? 640
                         : (i / 16 + i) % 2       ? 0.9f
                                                  : 1.1f);
        double told = film_relative_error(film).frame, may_be = film_rare_error(film, told);
        if (!is_rare) {
            assert_true(isnan(may_be));
            continue;
        }
        assert_true(may_be > FILM_RARE * told);
    }
}

ARENA_TEST(relative_error_of_displays_counts_their_pixels_only) {
    enum { SIDE = 100 };
    FilmRect square = {0, 0, SIDE, SIDE};
    Film *film = film_create(SIDE, SIDE, square, 0, NULL, &arena);
    for (int p = 0; p < SIDE * SIDE; p++)
        for (uint32_t i = 0; i < 64; i++) {
            bool display = p % SIDE < SIDE / 2;
            float value = display ? 2 : coin(p, i, 1);
            FilmSample s = {.sample_index = i,
                            .xyz = {value, value, value},
                            .hit = true,
                            .display_id = display ? 4 : -1};
            film_add_sample(film, p % SIDE, p / SIDE, &s);
        }
    FilmError error = film_relative_error(film);
    assert_near(error.displays, 0, 1e-6);
    assert_close(error.frame, 0.5 * 0.5 / sqrt(64), 0.03);
    assert_int_equal(film_pixel(film, 0, 1).display_id, 4);
    assert_int_equal(film_pixel(film, SIDE - 1, 1).display_id, -1);

    FilmRect left = {-9, 0, SIDE / 2, SIDE}, right = {SIDE / 2, 0, SIDE + 9, SIDE};
    assert_close(film_area_error(film, (FilmArea){square, FILM_ALL_PIXELS}), error.frame, 1e-15);
    assert_close(film_area_error(film, (FilmArea){square, 4}), error.displays, 1e-15);
    assert_true(isnan(film_area_error(film, (FilmArea){square, 3})));
    assert_close(film_area_error(film, (FilmArea){left, FILM_ALL_PIXELS}), error.displays, 1e-15);
    assert_close(film_area_error(film, (FilmArea){right, FILM_ALL_PIXELS}),
                 2 * error.frame - error.displays, 1e-12);
    assert_true(isnan(film_area_error(film, (FilmArea){right, FILM_ANY_DISPLAY})));
}

/* Pixel p swings by p % 4 tenths around 100: of equals the first comes first. */
ARENA_TEST(the_worst_pixels_come_in_order) {
    FilmRect crop = {2, 1, 6, 4};
    Film *film = film_create(8, 5, crop, 0, NULL, &arena);
    FilmWorst worst[20];
    for (uint32_t i = 0; i < 26; i++)
        for (int p = 0; p < 12; p++)
            add_grey(film, 2 + p % 4, 1 + p / 4, i, 100 + 0.1f * (float)(p % 4) * (i % 2 ? 1 : -1));
    double frame = 0;
    assert_int_equal(film_worst_pixels(film, 20, worst), 12);
    for (int i = 0; i < 12; i++) {
        assert_int_equal(worst[i].x, 5 - i / 3);
        assert_int_equal(worst[i].y, 1 + i % 3);
        assert_close(worst[i].luminance, 100, 1e-6);
        assert_near(worst[i].error, 1e-3 * (3 - i / 3) / 5, 1e-7);
        frame += worst[i].error / 12;
    }
    assert_close(film_relative_error(film).frame, frame, 1e-12);
    assert_int_equal(film_worst_pixels(film, 2, worst), 2);
    assert_true(worst[1].x == 5 && worst[1].y == 2);
}

/* ---- layers ------------------------------------------------------------------------------ */

#define COUNT_LETTERS(NAME, bit, of, option, letters, reader, sums) +(int)strlen(letters)
#define NUMBER_CHANNELS 11 /* ids, angles, coverages, shares, contrast, how many samples */

ARENA_TEST(a_frame_has_the_channels_asked_for_and_no_others) {
    Film *film = film_create(WIDTH, HEIGHT, whole, LAYER_DEPTH | LAYER_ID, NULL, &arena);
    FrameImage frame = film_to_frame(film, 0, &arena);
    assert_int_equal(frame.channel_count, 6);
    assert_non_null(frame_channel(&frame, "depth.Z"));
    assert_non_null(frame_channel(&frame, "id.part"));
    assert_non_null(frame_channel(&frame, "id.display"));
    assert_null(frame_channel(&frame, "xyz.X"));
    film = film_create(WIDTH, HEIGHT, whole, LAYER_ALL, NULL, &arena);
    frame = film_to_frame(film, 0, &arena);
    int letters = 0 FILM_LAYERS(COUNT_LETTERS);
    assert_true(letters >= 57);
    assert_int_equal(frame.channel_count, 3 + letters + 3 + NUMBER_CHANNELS);
}

ARENA_TEST(layers_are_means_over_the_samples_that_hit) {
    Film *film = film_create(WIDTH, HEIGHT, whole, LAYER_ALL, NULL, &arena);
    FilmSample near_hit = {.sample_index = 5,
                           .hit = true,
                           .depth = 1,
                           .position = {1, 2, 3},
                           .normal = {0, 1, 0},
                           .albedo = {1, 0, 0},
                           .uv = {0.25f, 0},
                           .part_id = 7,
                           .display_id = -1};
    FilmSample far_hit = {.sample_index = 2,
                          .hit = true,
                          .depth = 3,
                          .position = {3, 2, 1},
                          .normal = {1, 0, 0},
                          .albedo = {0, 1, 0},
                          .uv = {0.75f, 1},
                          .part_id = 9,
                          .display_id = -1};
    FilmSample miss = {.sample_index = 0, .xyz = {3, 3, 3}, .part_id = -1, .display_id = -1};
    film_add_sample(film, 1, 0, &near_hit);
    film_add_sample(film, 1, 0, &far_hit);
    film_add_sample(film, 1, 0, &miss);
    FrameImage frame = film_to_frame(film, 0, &arena);
    assert_close(at(&frame, "depth.Z", 1), 2, 1e-7);
    assert_close(at(&frame, "position.X", 1), 2, 1e-7);
    assert_close(at(&frame, "normal.Y", 1), 0.5, 1e-7);
    assert_close(at(&frame, "albedo.G", 1), 0.5, 1e-7);
    assert_close(at(&frame, "uv.U", 1), 0.5, 1e-7);
    assert_close(at(&frame, "xyz.Y", 1), 1, 1e-7);
    assert_true(at(&frame, "id.part", 1) == 9);
    assert_true(at(&frame, "samples.N", 1) == 3);
    assert_true(isnan(at(&frame, "depth.Z", 0)));
    assert_true(isnan(at(&frame, "display.contrast", 1)));
    assert_true(isnan(at(&frame, "display.theta", 1)));
    assert_true(at(&frame, "id.part", 0) == -1);
    assert_true(at(&frame, "id.display", 1) == -1);
    assert_true(at(&frame, "R", 0) == 0);
}

ARENA_TEST(features_that_are_not_finite_leave_the_light_alone) {
    Film *film = film_create(WIDTH, HEIGHT, whole, LAYER_ALL, NULL, &arena);
    FilmSample s = {.xyz = {4, 4, 4}, .hit = true, .depth = NAN, .part_id = 1, .display_id = -1};
    film_add_sample(film, 0, 0, &s);
    FrameImage frame = film_to_frame(film, 0, &arena);
    assert_close(at(&frame, "xyz.Y", 0), 4, 1e-7);
    assert_true(isnan(at(&frame, "depth.Z", 0)));
    assert_true(at(&frame, "id.part", 0) == -1);
    assert_int_equal(film_dropped(film).count, 0);
}

ARENA_TEST(contrast_is_the_ratio_of_mean_luminances_with_the_reflection) {
    Film *film = film_create(WIDTH, HEIGHT, whole, LAYER_ALL, NULL, &arena);
    FilmSample s = display_sample(0, 0.5f, 1);
    film_add_sample(film, 0, 0, &s);
    s.xyz[1] = 100; /* the mean reflects 10 in Y */
    s.sample_index = 1;
    film_add_sample(film, 0, 0, &s);
    FrameImage frame = film_to_frame(film, 0, &arena);
    float rgb[3], xyz[3];
    assert_close(at(&frame, "display.contrast", 0), (380 + 10) / (0 + 10), 1e-6);
    const char *const names[] = {"display.reflected.R", "display.reflected.G",
                                 "display.reflected.B"};
    for (int i = 0; i < 3; i++) rgb[i] = (float)at(&frame, names[i], 0);
    xyz_from_rgb(rgb, xyz);
    assert_close(xyz[0], 10, 1e-5);
    assert_close(xyz[1], 10, 1e-5);
    assert_close(xyz[2], 30, 1e-5);
    assert_close(at(&frame, "display.theta", 0), degrees_from_radians(0.5), 1e-5);
    assert_close(at(&frame, "display.phi", 0), degrees_from_radians(1), 1e-5);
    assert_true(at(&frame, "id.display", 0) == 1);
}

ARENA_TEST(mirror_haze_and_lambertian_make_up_the_reflected) {
    unsigned parts = LAYER_DISPLAY_MIRROR | LAYER_DISPLAY_SCATTERED | LAYER_NEEDS_LAMBERTIAN;
    Film *film = film_create(WIDTH, HEIGHT, whole, parts, NULL, &arena);
    FilmSample s = display_sample(0, 0.5f, 1);
    for (uint32_t k = 0; k < 2; k++) {
        s.sample_index = k;
        for (int i = 0; i < 3; i++) {
            s.mirror[i] = (float)k * 7;
            s.lambertian[i] = k ? 0.5f : 3.5f;
            s.xyz[i] = s.emitted[i] + 10;
        }
        film_add_sample(film, 0, 0, &s);
    }
    FrameImage frame = film_to_frame(film, 0, &arena);
    const char *const layers[] = {"display.mirror", "display.scattered", "display.haze",
                                  "display.lambertian"};
    const double wanted[] = {3.5, 6.5, 4.5, 2};
    for (int l = 0; l < 4; l++) {
        float rgb[3], xyz[3];
        for (int i = 0; i < 3; i++)
            rgb[i] = (float)at(&frame, arena_format(&arena, "%s.%c", layers[l], "RGB"[i]), 0);
        xyz_from_rgb(rgb, xyz);
        for (int i = 0; i < 3; i++) assert_close(xyz[i], wanted[l], 1e-5);
        assert_true(isnan(at(&frame, arena_format(&arena, "%s.G", layers[l]), 1)));
    }
}

/* Of sums: a dark sample counts for little. */
ARENA_TEST(extrapolated_shares_are_those_of_the_mean_luminances) {
    unsigned layers = LAYER_DISPLAY_EXTRAPOLATED;
    Film *film = film_create(WIDTH, HEIGHT, whole, layers, NULL, &arena);
    FilmSample s = display_sample(0, 0.5f, 1);
    for (uint32_t k = 0; k < 2; k++) {
        s.sample_index = k;
        s.emitted[1] = k ? 300 : 100;
        s.xyz[1] = s.emitted[1] + (k ? 30 : 10);
        s.extrapolated[0] = k ? 300 : 0;
        s.extrapolated[1] = k ? 0 : 10;
        film_add_sample(film, 0, 0, &s);
    }
    s.xyz[1] = s.emitted[1];
    film_add_sample(film, 1, 0, &s);
    FrameImage frame = film_to_frame(film, 0, &arena);
    assert_close(at(&frame, "display.extrapolated.emitted", 0), 0.75, 1e-6);
    assert_close(at(&frame, "display.extrapolated.reflected", 0), 0.25, 1e-6);
    assert_true(at(&frame, "display.extrapolated.reflected", 1) == 0); /* of nothing */
    assert_true(isnan(at(&frame, "display.extrapolated.emitted", 2)));
    assert_true(at(&frame, "id.display", 0) == 1);
    assert_null(frame_channel(&frame, "display.reflected.G"));
}

ARENA_TEST(fine_emission_is_a_mean_over_the_samples_that_saw_a_display) {
    Film *film = film_create(WIDTH, HEIGHT, whole, LAYER_DISPLAY_FINE, NULL, &arena);
    FilmSample on = display_sample(0, 0.3f, 0), off = {.sample_index = 3, .display_id = -1};
    float rgb[3], xyz[3];
    for (uint32_t k = 0; k < 3; k++) {
        on.sample_index = k;
        for (int i = 0; i < 3; i++) on.fine[i] = (float)((int)k + 10 * i);
        film_add_sample(film, 0, 0, &on);
    }
    film_add_sample(film, 0, 0, &off);
    film_add_sample(film, 1, 0, &off);
    FrameImage frame = film_to_frame(film, 0, &arena);
    const char *const names[] = {"display.fine.R", "display.fine.G", "display.fine.B"};
    for (int i = 0; i < 3; i++) rgb[i] = (float)at(&frame, names[i], 0);
    xyz_from_rgb(rgb, xyz);
    for (int i = 0; i < 3; i++) assert_close(xyz[i], 1 + 10 * i, 1e-5);
    assert_close(at(&frame, "display.coverage", 0), 0.75, 1e-7);
    assert_true(at(&frame, "display.coverage", 1) == 0);
    assert_true(isnan(at(&frame, "display.fine.G", 1)));
}

ARENA_TEST(phi_is_averaged_as_a_direction) {
    Film *film = film_create(WIDTH, HEIGHT, whole, LAYER_DISPLAY_ANGLES, NULL, &arena);
    float turn = (float)(2 * PI);
    FilmSample before = display_sample(0, 0.3f, turn - 0.02f);
    FilmSample after = display_sample(1, 0.3f, 0.04f);
    film_add_sample(film, 0, 0, &before);
    film_add_sample(film, 0, 0, &after);
    FrameImage frame = film_to_frame(film, 0, &arena);
    assert_close(at(&frame, "display.phi", 0), degrees_from_radians(0.01), 1e-3);
}

ARENA_TEST(a_pixel_half_on_a_display_reports_the_display_half) {
    Film *film = film_create(WIDTH, HEIGHT, whole, LAYER_ALL, NULL, &arena);
    FilmSample on = display_sample(1, 0.1f, 0),
               off = {.xyz = {9, 9, 9}, .hit = true, .depth = 4, .display_id = -1};
    film_add_sample(film, 0, 0, &on);
    film_add_sample(film, 0, 0, &off);
    FrameImage frame = film_to_frame(film, 0, &arena);
    assert_close(at(&frame, "display.contrast", 0), (380.0 + 20) / 20, 1e-6);
    assert_close(at(&frame, "depth.Z", 0), 3, 1e-6);
}

ARENA_TEST(a_crop_is_the_data_window) {
    FilmRect crop = {1, 1, 3, 2};
    Film *film = film_create(WIDTH, HEIGHT, crop, LAYER_XYZ, NULL, &arena);
    add_grey(film, 2, 1, 0, 8);
    FrameImage frame = film_to_frame(film, 0, &arena);
    assert_int_equal(frame.data.x0, 1);
    assert_int_equal(frame.data.y1, 2);
    assert_int_equal(frame.display.x1, WIDTH);
    assert_int_equal(frame.display.y1, HEIGHT);
    assert_int_equal(frame_pixel_count(&frame), 2);
    assert_close(at(&frame, "xyz.X", 1), 8, 1e-7);
}

TEST(film_bytes_is_what_a_film_takes) {
    for (unsigned layers = 0; layers <= LAYER_ALL; layers += 193) {
        Arena arena = *test_memory();
        film_create(WIDTH, HEIGHT, whole, layers, NULL, &arena);
        assert_in_range(arena.next - arena.begin, film_bytes(whole, layers, 0),
                        film_bytes(whole, layers, 0) + 32);
    }
}

TEST_PROGRAM(make_arena, drop_arena)
