/* SPDX-License-Identifier: Apache-2.0 */
/* The colour of a symbol as it is seen, beside its own in the dark and other symbols'. */
#include "fixture.h"

#include "base/count.h"
#include "base/mathd.h"
#include "base/sampler.h"
#include "base/units.h"
#include "review/ask_colour.h"
#include "review/judge.h"
#include "spectrum/photometry.h"

static const double D65[3] = {0.95047, 1, 1.08883};
static const double RED[3] = {1.9, 1, 0.09}, AMBER[3] = {1.05, 1, 0.04};

/* Emits `lit` cd m^-2 of a colour and reflects so much of D65, all batches alike. */
static ColourLight light_of(const double colour[3], double lit, double reflected) {
    ColourLight light = {.lit = lit, .range = {reflected, reflected}, .is_on_display = true};
    for (int k = 0; k < 3; k++) {
        light.emitted[k] = lit * colour[k];
        light.reflected[k] = reflected * D65[k];
        for (int i = 0; i < CASE_BATCHES; i++) light.batches[i][k] = light.reflected[k];
    }
    return light;
}

/* own, then one other. */
static const CaseColour *colours_of(ColourLight lights[2], Arena *arena) {
    CaseColour *list = ARENA_NEW(arena, CaseColour, 2);
    for (int i = 0; i < 2; i++) list[i].light = &lights[i];
    ReviewCase c = {.luminance_cd_m2 = {.foreground = lights[0].emitted[1],
                                        .reflected = lights[0].reflected[1],
                                        .veil = lights[0].veil[1]},
                    .colours = list,
                    .colour_count = 2};
    return case_colours(&c, arena);
}

/* A grey Lambertian face of reflectance r under D65 of E lx sends r E / pi of D65, and lights
 * mix in XYZ: u'v' of the sum lies between the two, by their X + 15 Y + 3 Z. */
ARENA_TEST(a_grey_face_under_daylight_mixes) {
    for (int i = 0; i < 12; i++) {
        double lux = pow_d(10, i % 6), reflectance = 0.01 + 0.04 * (i / 6);
        double white = reflectance * lux / PI, lit = 300;
        ColourLight lights[2] = {light_of(RED, lit, white), light_of(AMBER, 2 * lit, white)};
        const CaseColour *colours = colours_of(lights, &arena);
        double seen[2][2];
        for (int k = 0; k < 2; k++) {
            const double *sent = k ? AMBER : RED;
            double weight = (k + 1) * lit * (sent[0] + 15 + 3 * sent[2]), uv[2], grey[2];
            double of_white = white * (D65[0] + 15 + 3 * D65[2]);
            uv_from_xyz(sent, uv);
            uv_from_xyz(D65, grey);
            for (int j = 0; j < 2; j++) {
                seen[k][j] = (weight * uv[j] + of_white * grey[j]) / (weight + of_white);
                assert_near(colours[k].uv[j], seen[k][j], 1e-12);
                assert_near(colours[k].dark_uv[j], uv[j], 1e-12);
            }
            if (!k)
                assert_near(colours[0].apart, hypot_d(seen[0][0] - uv[0], seen[0][1] - uv[1]),
                            1e-12);
            assert_near(colours[k].low, colours[k].apart, 1e-9); /* nothing is in doubt */
            assert_near(colours[k].high, colours[k].apart, 1e-9);
        }
        assert_near(colours[1].apart, hypot_d(seen[0][0] - seen[1][0], seen[0][1] - seen[1][1]),
                    1e-12);
    }
}

/* A veil counts as light does that is reflected there; what is set brighter takes others on its
 * display along; where nothing is emitted there is no colour. */
ARENA_TEST(light_adds_up) {
    ColourLight lights[2] = {light_of(RED, 100, 30), light_of(AMBER, 100, 30)};
    const CaseColour *plain = colours_of(lights, &arena);
    ColourLight veiled[2] = {light_of(RED, 100, 10), light_of(AMBER, 100, 30)};
    for (int k = 0; k < 3; k++) veiled[0].veil[k] = 20 * D65[k];
    const CaseColour *other = colours_of(veiled, &arena);
    for (int i = 0; i < 2; i++) assert_near(plain[i].apart, other[i].apart, 1e-12);
    ReviewCase c = {.luminance_cd_m2 = {.foreground = 200, .reflected = 30},
                    .colours = plain,
                    .colour_count = 2};
    ColourLight twice[2] = {light_of(RED, 200, 30), light_of(AMBER, 200, 30)};
    other = colours_of(twice, &arena);
    const CaseColour *brighter = case_colours(&c, &arena);
    for (int i = 0; i < 2; i++) assert_near(brighter[i].apart, other[i].apart, 1e-12);
    ColourLight black[2] = {light_of(RED, 0, 30), light_of(AMBER, 100, 30)};
    other = colours_of(black, &arena);
    assert_true(isnan(other[0].apart) && !isnan(other[1].apart));
}

/* What a panel states moves one colour alone, in closed form for a little of it. */
ARENA_TEST(stated_errors_add_as_squares) {
    ColourLight lights[2] = {light_of(RED, 100, 30), light_of(AMBER, 100, 30)};
    double reflecting, emitting;
    lights[0].reflection_error = 1e-4;
    const CaseColour *colours = colours_of(lights, &arena);
    double weight = 100 * (RED[0] + 15 + 3 * RED[2]), white = 30 * (D65[0] + 15 + 3 * D65[2]);
    double share = white / (white + weight);
    reflecting = colours[0].high - colours[0].apart;
    assert_close(reflecting, NORMAL_QUANTILE * 1e-4 * (1 - share) * colours[0].apart, 1e-3);
    assert_near(colours[0].sampling, 0, 1e-6);
    lights[0].reflection_error = 0;
    lights[0].emission_error = 1e-4;
    colours = colours_of(lights, &arena);
    emitting = colours[0].high - colours[0].apart;
    assert_true(emitting >= NORMAL_QUANTILE * 1e-4 * (1 - share) * colours[0].apart * 0.999);
    lights[0].reflection_error = 1e-4;
    colours = colours_of(lights, &arena);
    assert_close(colours[0].high - colours[0].apart, hypot_d(reflecting, emitting), 1e-3);
}

/* ---- limits ------------------------------------------------------------------------------ */

static ReviewCase judged(ColourLight lights[2], int count, double shift, double difference,
                         Arena *arena) {
    const ProfileLimit limits[] = {{.name = "shift",
                                    .kind = LIMIT_COLOUR_SHIFT,
                                    .ambients = {true, true, true, true},
                                    .is_upper = true,
                                    .value = shift},
                                   {.name = "difference",
                                    .kind = LIMIT_COLOUR_DIFFERENCE,
                                    .ambients = {true, true, true, true},
                                    .value = difference}};
    const Profile profile = {.limits = limits, .limit_count = COUNT_OF(limits)};
    CaseColour *list = ARENA_NEW(arena, CaseColour, 2);
    for (int i = 0; i < 2; i++)
        list[i] = (CaseColour){.symbol = i ? "caution" : "warning", .light = &lights[i]};
    ReviewCase c = {
        .luminance_cd_m2 = {.foreground = lights[0].lit, .reflected = lights[0].reflected[1]},
        .visible_share = 1,
        .colours = list,
        .colour_count = count};
    judge_case(&c, &profile, arena);
    assert_int_equal(c.limit_count, 2);
    return c;
}

/* 2 % either side decide; the nearest is named. What nobody asked for does not count. */
ARENA_TEST(limits_hold_shift_and_difference) {
    ColourLight lights[2] = {light_of(RED, 100, 30), light_of(AMBER, 100, 30)};
    const CaseColour *is = colours_of(lights, &arena);
    for (int side = -1; side <= 1; side += 2) {
        double shift = is[0].apart * (1 + 0.02 * side), apart = is[1].apart * (1 - 0.02 * side);
        ReviewCase c = judged(lights, 2, shift, apart, &arena);
        for (int i = 0; i < 2; i++)
            assert_int_equal(c.limits[i].verdict, side > 0 ? VERDICT_PASS : VERDICT_FAIL);
        assert_int_equal(c.verdict, c.limits[0].verdict);
        assert_null(c.limits[0].beside);
        assert_string_equal(c.limits[1].beside, "caution");
        assert_true(limit_wants_less(&c.limits[0]) == limit_wants_less(&c.limits[1]));
    }
    ReviewCase alone = judged(lights, 1, is[0].apart * 1.02, 1, &arena);
    assert_true(isnan(alone.limits[1].found));
    assert_int_equal(alone.verdict, VERDICT_PASS);
    assert_int_equal(judged(lights, 0, 1, 1, &arena).unjudged, UNJUDGED_LIMIT);
}

/* ---- how often intervals hold ------------------------------------------------------------ */

#define RUNS 2000

static double normal(uint32_t *random) {
    double u[2];
    for (int k = 0; k < 2; k++) {
        *random = hash_u32(*random + 0x9e3779b9u);
        u[k] = ((double)*random + 0.5) * 0x1p-32;
    }
    return sqrt(-2 * log_d(u[0])) * cos_d(2 * PI * u[1]);
}

/* As paths find it: its amount and its colour vary from batch to batch; a part is common to
 * both colours. */
static void shake(ColourLight *light, const double common[CASE_BATCHES], double spread,
                  uint32_t *random) {
    double mean[3] = {0, 0, 0}, squares = 0;
    for (int i = 0; i < CASE_BATCHES; i++)
        for (int k = 0; k < 3; k++) {
            light->batches[i][k] *= 1 + spread * (common[i] + 0.5 * normal(random));
            mean[k] += light->batches[i][k] / CASE_BATCHES;
        }
    memcpy(light->reflected, mean, sizeof mean);
    for (int i = 0; i < CASE_BATCHES; i++)
        squares += (light->batches[i][1] - mean[1]) * (light->batches[i][1] - mean[1]);
    double half = 2.04 * sqrt(squares / CASE_BATCHES / (CASE_BATCHES - 1));
    light->range = (MeanInterval){mean[1] - half, mean[1] + half};
}

/* Far apart, near each other, and one and the same, of which the low end says 0. At least 93 %
 * of many runs; of 2,000 the standard deviation is 0.5 %. What the one-sided low end of equal
 * colours leaves more is not an error. */
ARENA_TEST(intervals_hold_the_difference) {
    static const double PARTS[] = {1, 0.1, 0.01, 0};
    uint32_t random = 7;
    for (int p = 0; p < 4; p++) {
        int held[2] = {0, 0}, nothing = 0;
        double near[3];
        for (int k = 0; k < 3; k++) near[k] = RED[k] + PARTS[p] * (AMBER[k] - RED[k]);
        ColourLight exact[2] = {light_of(RED, 100, 30), light_of(near, 100, 30)};
        const CaseColour *truth = colours_of(exact, &arena);
        for (int run = 0; run < RUNS; run++) {
            Arena scratch = arena;
            ColourLight lights[2] = {exact[0], exact[1]};
            double common[CASE_BATCHES];
            for (int i = 0; i < CASE_BATCHES; i++) common[i] = normal(&random);
            for (int i = 0; i < 2; i++) shake(&lights[i], common, 0.2, &random);
            const CaseColour *found = colours_of(lights, &scratch);
            for (int i = 0; i < 2; i++)
                held[i] += found[i].low <= truth[i].apart && truth[i].apart <= found[i].high;
            nothing += found[1].low <= 0;
        }
        for (int i = 0; i < 2; i++)
            if (!(held[i] > (0.93 - 3 * 0.005) * RUNS))
                fail_msg("part %g of the way, %d: %d of %d held", PARTS[p], i, held[i], RUNS);
        if (PARTS[p] == 0) assert_true(nothing == held[1] && nothing > 0.93 * RUNS);
    }
}

TEST_PROGRAM(make_arena, drop_arena)
