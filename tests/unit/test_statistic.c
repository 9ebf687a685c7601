/* SPDX-License-Identifier: Apache-2.0 */
/* The statistical test: its level on noise of every kind, masks, frames without noise. */
#include "statistic_fixture.h"

#define PAIRS 100
#define FALSE_ALARMS 3 /* of PAIRS at a level of 1 %: more come in 2 % of all cases */

/* ---- level ------------------------------------------------------------------------------- */

typedef struct Alarms {
    int count;
    double squares;                    /* mean square of the frame's shift in its standard errors */
    double regions, blocks, histogram; /* shares of p below 0.2 */
} Alarms;

static Alarms count_alarms(Maker *reference, Maker *test) {
    ENDS_BY(arena_release) Arena arena = arena_reserve(1 << 26);
    Alarms out = {0};
    for (uint32_t k = 0; k < PAIRS; k++) {
        StatisticResult r = judge_pair(reference, test, k, arena);
        double z = r.regions[0].shift / r.regions[0].shift_sigma;
        out.count += r.verdict == STATISTIC_DIFFERENT;
        out.squares += z * z / PAIRS;
        out.regions += (r.p_regions < 0.2) / (double)PAIRS;
        out.blocks += (r.p_blocks < 0.2) / (double)PAIRS;
        out.histogram += (r.p_histogram < 0.2) / (double)PAIRS;
    }
    return out;
}

TEST(noise_of_any_kind_keeps_the_level) {
    static const int SAMPLES[] = {1, 2, 8};
    for (Noise noise = NOISE_GAUSSIAN; noise <= NOISE_FIREFLIES; noise++)
        for (int s = 0; s < 3; s++) {
            Maker maker = plain_maker(noise, SAMPLES[s], 0), other = maker;
            Alarms alarms = count_alarms(&maker, &other);
            if (alarms.count > FALSE_ALARMS)
                fail_msg("noise %d, %d samples: %d false alarms of %d", (int)noise, SAMPLES[s],
                         alarms.count, PAIRS);
            /* 4 standard errors of 100: sqrt(0.2 * 0.8 / 100) = 0.04 */
            assert_true(alarms.regions < 0.36 && alarms.blocks < 0.36);
            assert_true(alarms.histogram < 0.36);
            if (noise != NOISE_FIREFLIES)             /* hardly any: a coin or two */
                assert_near(alarms.squares, 1, 0.57); /* 4 sqrt(2 / 100) */
        }
}

/* A reference of few samples saw hardly a firefly; or it is the test that did not. */
TEST(different_sample_counts_keep_the_level) {
    for (Noise noise = NOISE_GAUSSIAN; noise <= NOISE_FIREFLIES; noise++)
        for (int swap = 0; swap < 2; swap++) {
            Maker few = plain_maker(noise, 2, 0), many = plain_maker(noise, 20, 0);
            Alarms alarms = swap ? count_alarms(&many, &few) : count_alarms(&few, &many);
            if (alarms.count > FALSE_ALARMS)
                fail_msg("noise %d: %d false alarms of %d", (int)noise, alarms.count, PAIRS);
        }
}

/* A program that finds light better makes less noise of the same mean. */
TEST(less_noise_of_the_same_mean_is_no_change) {
    Maker before = plain_maker(NOISE_EXPONENTIAL, 8, 0);
    Maker after = plain_maker(NOISE_GAUSSIAN, 8, 0);
    assert_in_range(count_alarms(&before, &after).count, 0, FALSE_ALARMS);
    after.noise = NOISE_QUIET;
    assert_in_range(count_alarms(&after, &before).count, 0, FALSE_ALARMS);
}

static float *channel(FrameImage *frame, const char *layer, char letter) {
    char name[64];
    snprintf(name, sizeof name, "%s%c", layer, letter);
    for (int i = 0; i < frame->channel_count; i++)
        if (!strcmp(frame->channels[i].name, name)) return frame->channels[i].values;
    fail_msg("no channel %s", name);
    return NULL;
}

static void of_one_seed(FrameImage *frame, Arena *arena) {
    frame_set_string(frame, "parhelion:seed", "5", arena);
    frame_set_string(frame, "parhelion:samples", "0:64", arena);
}

ARENA_TEST(one_glint_in_one_frame_is_noise) {
    Maker maker = plain_maker(NOISE_GAUSSIAN, 32, 0), other = maker;
    int hit = 14 * WIDTH + 14, alarms = 0;
    for (uint32_t k = 0; k < 20; k++) {
        Arena scratch = arena;
        maker.seed = 2 * k;
        other.seed = 2 * k + 1;
        FrameImage a = make_frame(&maker, &scratch), b = make_frame(&other, &scratch);
        for (int c = 0; c < 3; c++) { /* one sample of 32 saw the sun: 1e7 cd m^-2 */
            channel(&b, "", "RGB"[c])[hit] += 1e7f / 32;
            channel(&b, "variance.", "RGB"[c])[hit] = 1e14f / 32 / 32;
        }
        StatisticResult r = judge(&a, &b, NULL, &scratch);
        alarms += r.verdict == STATISTIC_DIFFERENT;
        assert_true(r.mean_shift > 1); /* and yet the frame's mean has doubled */
    }
    assert_in_range(alarms, 0, 1);
}

/* ---- pixels without noise, rounding, equality -------------------------------------------- */

ARENA_TEST(frames_without_noise_differ_by_a_single_pixel) {
    Maker maker = plain_maker(NOISE_GAUSSIAN, 64, 3);
    FrameImage a = make_frame(&maker, &arena), b = make_frame(&maker, &arena);
    for (int side = 0; side < 2; side++)
        for (int i = 0; i < a.channel_count; i++) {
            const FrameImage *frame = side ? &b : &a;
            float *values = frame->channels[i].values;
            const char *name = frame->channels[i].name;
            bool is_light = strlen(name) == 1;
            for (int p = 0; p < PIXELS && (is_light || !strncmp(name, "variance", 8)); p++)
                values[p] = is_light ? 3 : 0;
        }
    StatisticResult r = judge(&a, &b, NULL, &arena);
    assert_int_equal(r.verdict, STATISTIC_EQUAL);
    assert_string_equal(r.reason, "");
    channel(&b, "", 'G')[100] = 3.5f;
    r = judge(&a, &b, NULL, &arena);
    assert_int_equal(r.verdict, STATISTIC_DIFFERENT);
    assert_int_equal(r.differing, 1);
}

ARENA_TEST(rounding_is_no_change) {
    Maker maker = plain_maker(NOISE_QUIET, 64, 3);
    FrameImage a = make_frame(&maker, &arena), b = make_frame(&maker, &arena);
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < PIXELS; i++) channel(&b, "", "RGB"[c])[i] *= 1 + 4e-6f;
    assert_int_equal(judge(&a, &b, NULL, &arena).verdict, STATISTIC_SAME);
    of_one_seed(&a, &arena);
    of_one_seed(&b, &arena);
    StatisticResult r = judge(&a, &b, NULL, &arena);
    assert_int_equal(r.verdict, STATISTIC_SAME);
    assert_true(r.shares_noise);
    assert_int_equal(r.differing, 0);
}

/* Frames of one seed: a few paths that went elsewhere are noise, one part in a thousand of all
 * light is not. */
ARENA_TEST(frames_that_share_their_noise_are_compared_pixel_by_pixel) {
    Maker maker = plain_maker(NOISE_EXPONENTIAL, 64, 3);
    FrameImage a = make_frame(&maker, &arena), b = make_frame(&maker, &arena);
    float *green = channel(&b, "", 'G');
    of_one_seed(&a, &arena);
    of_one_seed(&b, &arena);
    for (int i = 300; i < PIXELS; i += 100) green[i] *= i / 100 % 2 ? 1.03f : 0.96f;
    StatisticResult r = judge(&a, &b, NULL, &arena);
    assert_int_equal(r.verdict, STATISTIC_SAME);
    assert_int_equal(r.differing, 13);
    for (int i = 0; i < PIXELS; i++) green[i] *= 1.001f;
    r = judge(&a, &b, NULL, &arena);
    assert_int_equal(r.verdict, STATISTIC_DIFFERENT);
    assert_int_equal(r.differing, 1500);
}

/* ---- reasons ----------------------------------------------------------------------------- */

/* Every "+a +- b" of a reason has |a| > b; counts them. */
static int intervals_of(const char *reason) {
    int count = 0;
    for (const char *p = reason; (p = strstr(p, " +- ")); p++, count++) {
        const char *start = p;
        while (start > reason && start[-1] != ' ') start--;
        if (!(fabs(atof(start)) > atof(p + 4))) fail_msg("a reason holds 0: %s", reason);
    }
    return count;
}

/* A mean is named where it is known to move; what is seen in a few pixels alone is that their
 * noise does not explain them. */
ARENA_TEST(a_reason_is_no_interval_that_holds_0) {
    static const Noise NOISES[] = {NOISE_GAUSSIAN, NOISE_EXPONENTIAL, NOISE_FIREFLIES};
    int different = 0, means = 0;
    Maker a, b;
    for (uint32_t k = 0; k < 180; k++) {
        Noise noise = NOISES[k % 3];
        a = plain_maker(noise, k % 2 ? 16 : 64, 0);
        b = plain_maker(noise, k % 5 ? a.samples : 64, 0);
        int pixel = (int)(k * 37 % PIXELS);
        if (k % 4 == 0) b.light[pixel] += 300;
        if (k % 4 == 1)
            for (int i = 0; i < PIXELS; i++) b.light[i] *= 1.03;
        if (k % 4 == 2) b.light[pixel] += 40, b.light[(pixel + 700) % PIXELS] += 40;
        if (k % 4 == 3) brighten_block(&b, 16, 8, 0.5);
        StatisticResult r = judge_pair(&a, &b, k, arena);
        if (r.verdict != STATISTIC_DIFFERENT) continue;
        bool names_mean = strstr(r.reason, "the mean moved: ") != NULL;
        different++;
        assert_int_equal(intervals_of(r.reason) > 0 || strstr(r.reason, "instead of 0"),
                         names_mean);
        means += names_mean;
        if (!names_mean) assert_text_has(r.reason, "pixels differ by more than their noise: ");
    }
    assert_true(different > 90 && means > 30 && means < different - 10);
}

/* ---- what other programs make of a frame -------------------------------------------------- */

static void multiply(FrameImage *frame, float factor, bool light_only) {
    for (int c = 0; c < frame->channel_count; c++)
        for (int i = 0; i < PIXELS; i++)
            if (!light_only || strlen(frame->channels[c].name) == 1)
                frame->channels[c].values[i] *= factor;
}

/* No factor but 1 is the same: the counts of a frame that was multiplied are none any more. */
ARENA_TEST(a_frame_that_was_multiplied_is_never_the_same) {
    static const float FACTORS[] = {0.01f, 0.3f, 0.98f, 1, 1.02f, 1.3f, 2, -1};
    for (int k = 0; k < 16; k++) {
        Maker maker = plain_maker(NOISE_EXPONENTIAL, 16, 3);
        Maker other = plain_maker(NOISE_EXPONENTIAL, 16, k < 8 ? 3 : 4);
        FrameImage a = make_frame(&maker, &arena), b = make_frame(&other, &arena);
        float factor = FACTORS[k % 8];
        frame_set_string(&a, "parhelion:samples", "0:16", &arena);
        frame_set_string(&b, "parhelion:samples", "0:16", &arena);
        multiply(&b, factor, false);
        for (int turn = 0; turn < 2; turn++) { /* either may be the reference */
            StatisticResult r = judge(turn ? &b : &a, turn ? &a : &b, NULL, &arena);
            if (factor == 1) {
                assert_int_equal(r.verdict, k < 8 ? STATISTIC_EQUAL : STATISTIC_SAME);
                assert_string_equal(r.broken, "");
                continue;
            }
            assert_true(r.verdict == STATISTIC_DIFFERENT || r.verdict == STATISTIC_UNKNOWN);
            assert_text_has(r.broken, "samples.N: ");
            assert_text_has(r.note, turn ? "the reference has in layer samples.N: "
                                         : "the test has in layer samples.N: ");
        }
    }
}

/* Where the light alone was, its layers still state the noise. */
ARENA_TEST(light_that_was_multiplied_is_found_by_the_noise_of_its_layers) {
    Maker maker = plain_maker(NOISE_QUIET, 16, 3), other = plain_maker(NOISE_QUIET, 16, 4);
    FrameImage a = make_frame(&maker, &arena), b = make_frame(&other, &arena);
    multiply(&b, 1.02f, true);
    StatisticResult r = judge(&a, &b, NULL, &arena);
    assert_int_equal(r.verdict, STATISTIC_DIFFERENT);
    assert_string_equal(r.broken, "");
    assert_text_has(r.reason, "the mean moved: ");
}

/* ---- masks, gaps, words ------------------------------------------------------------------ */

ARENA_TEST(what_the_mask_leaves_out_does_not_count) {
    Maker maker = plain_maker(NOISE_GAUSSIAN, 16, 3);
    Maker other = plain_maker(NOISE_GAUSSIAN, 16, 4);
    unsigned char mask[PIXELS];
    for (int i = 0; i < PIXELS; i++) {
        mask[i] = i % WIDTH >= 16;
        if (!mask[i]) other.light[i] *= 2;
    }
    FrameImage a = make_frame(&maker, &arena), b = make_frame(&other, &arena);
    assert_int_equal(judge(&a, &b, NULL, &arena).verdict, STATISTIC_DIFFERENT);
    channel(&b, "", 'R')[20] = NAN;
    StatisticResult r = judge(&a, &b, mask, &arena);
    assert_int_equal(r.verdict, STATISTIC_SAME);
    assert_int_equal(r.pixels, 32 * HEIGHT - 1);
    assert_int_equal(r.regions[1].pixels, 8 * HEIGHT - 1);
    assert_true(isnan(r.block_p[0]) && isnan(r.block_p[1]) && !isnan(r.block_p[2]));
    memset(mask, 0, sizeof mask);
    r = judge(&a, &b, mask, &arena);
    assert_int_equal(r.verdict, STATISTIC_EQUAL);
    assert_int_equal(r.region_count, 0);
    assert_near(r.p_value, 1, 0);
}

/* A crop: the data window lies inside the display window, which the mask covers. */
ARENA_TEST(crops_have_their_place_in_the_frame) {
    Maker maker = plain_maker(NOISE_GAUSSIAN, 64, 3);
    Maker other = plain_maker(NOISE_GAUSSIAN, 64, 4);
    brighten_block(&other, 16, 0, 3);
    FrameImage a = make_frame(&maker, &arena), b = make_frame(&other, &arena);
    a.display = b.display = (ExrWindow){0, 0, 100, 100};
    a.data = b.data = (ExrWindow){50, 60, 50 + WIDTH, 60 + HEIGHT};
    StatisticResult r = judge(&a, &b, NULL, &arena);
    assert_text_has(r.reason, "block at x 66..74, y 60..68: ");
    unsigned char *mask = ARENA_NEW(&arena, unsigned char, 100 * 100);
    memset(mask, 1, 100 * 100);
    for (int y = 60; y < 68; y++) memset(mask + y * 100 + 66, 0, 8);
    r = judge(&a, &b, mask, &arena);
    assert_int_equal(r.verdict, STATISTIC_SAME);
    assert_int_equal(r.pixels, PIXELS - 64);
}

ARENA_TEST(either_layer_of_noise_is_enough) {
    static const char *const LEFT_OUT[] = {"variance", "halves", "samples.N"};
    for (int k = 0; k < 3; k++)
        for (int change = 0; change < 2; change++) {
            Maker maker = plain_maker(NOISE_EXPONENTIAL, 64, 13);
            Maker other = plain_maker(NOISE_EXPONENTIAL, 64, 14);
            for (int i = 0; i < PIXELS; i++) other.light[i] *= change ? 1.05 : 1;
            FrameImage a = make_frame(&maker, &arena), b = make_frame(&other, &arena);
            without(&a, LEFT_OUT[k]);
            without(&b, LEFT_OUT[k]);
            StatisticResult r = judge(&a, &b, NULL, &arena);
            assert_int_equal(r.verdict, change ? STATISTIC_DIFFERENT : STATISTIC_SAME);
            if (k == 2) assert_text_has(r.note, "--layers samples tells");
        }
}

ARENA_TEST(notes_say_what_would_help) {
    Maker few = plain_maker(NOISE_GAUSSIAN, 4, 0), many = plain_maker(NOISE_GAUSSIAN, 16, 1);
    FrameImage a = make_frame(&few, &arena), b = make_frame(&many, &arena);
    assert_string_equal(judge(&a, &b, NULL, &arena).note, "");
    without(&a, "halves");
    assert_text_has(judge(&a, &b, NULL, &arena).note, "--layers halves tells");
    b = make_frame(&many, &arena);
    a = make_frame(&few, &arena);
    without(&b, "variance");
    assert_text_has(judge(&a, &b, NULL, &arena).note, "--layers variance tells");
}

static void assert_refused(const FrameImage *a, const FrameImage *b, const char *file,
                           const char *text) {
    StatisticOptions options = {.reference_name = "a.exr", .test_name = "b.exr"};
    StatisticResult result;
    ENDS_BY(arena_release) Arena arena = arena_reserve(1 << 26);
    assert_false(statistic_compare(a, b, &options, &arena, &result, why()));
    assert_int_equal(why()->code, ERROR_INPUT);
    assert_string_equal(why()->file, file);
    assert_string_equal(why()->text, text);
}

#define TELLS_NOTHING \
    "has neither layer variance nor halves, which tell its noise; " \
    "render it with --layers variance,halves,samples"

ARENA_TEST(frames_that_do_not_tell_their_noise_are_refused) {
    Maker maker = plain_maker(NOISE_GAUSSIAN, 4, 0);
    FrameImage a = make_frame(&maker, &arena), b = make_frame(&maker, &arena);
    without(&b, "variance");
    without(&b, "halves");
    assert_refused(&a, &b, "b.exr", TELLS_NOTHING);
    assert_refused(&b, &a, "a.exr", TELLS_NOTHING);
    without(&b, "G");
    assert_refused(&a, &b, "b.exr", "has no channels R, G, B");
    b = make_frame(&maker, &arena);
    b.data = (ExrWindow){1, 0, WIDTH + 1, HEIGHT};
    assert_refused(&a, &b, "b.exr",
                   "holds pixels 1,0,49,32, the reference 0,0,48,32: required: the same");
}

TEST_PROGRAM(make_arena, drop_arena)
