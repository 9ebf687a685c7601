/* SPDX-License-Identifier: Apache-2.0 */
/* verdict_fixture.h -- reviews for tests of what is written from them: a plausible one, and one
 * of everything that can be odd.
 *
 * The plausible one follows the closed forms: contrast is (bright + reflected) / (dark +
 * reflected) with an interval of 3 %, limits are 5, 5, 3 and 2 by night, twilight, day and sun,
 * a height of at least 12 arc minutes.
 */
#pragma once
#include <math.h>
#include <string.h>

#include "base/arena.h"
#include "review/output/review_page.h"
#include "review/review_decide.h"

static const char WILD_NAME[] = "<a b=\"c\">&amp; 'q', \xc3\xa4 \xe9\x80\x9f\xe5\xba\xa6;\n=1";

typedef struct FixtureLight {
    const char *name;
    Ambient ambient;
    double azimuth, elevation, mirror, scattered, veil, level, lux;
} FixtureLight;

static const FixtureLight FIXTURE_LIGHTS[] = {
    {"night", AMBIENT_NIGHT, NAN, NAN, 0.004, 0.002, 0.01, 0.04, 0.8},
    {"overcast", AMBIENT_DAY, NAN, NAN, 21, 9, 1.5, 0.6, 3200},
    {"noon", AMBIENT_SUN, 178.4, 62.1, 96, 212, 18, 1, 41000},
    {"low sun behind", AMBIENT_SUN, 262.5, 11.4, 402, 118, 7, 1, 18500}};

static inline const char *const *fixture_chain(Arena *arena, const char *first, const char *second,
                                               const char *third) {
    const char **chain = ARENA_NEW(arena, const char *, 3);
    chain[0] = first;
    chain[1] = second;
    chain[2] = third;
    return chain;
}

static inline Verdict fixture_verdict(double low, double high, double limit) {
    return low >= limit ? VERDICT_PASS : high < limit ? VERDICT_FAIL : VERDICT_TOO_CLOSE;
}

static inline const LimitVerdict *fixture_limits(Arena *arena, const ReviewCase *c) {
    static const double WANTED[4] = {5, 5, 3, 2};
    static const char *const NAMES[4] = {"contrast at night", "contrast in twilight",
                                         "contrast by day", "contrast in the sun"};
    LimitVerdict *limits = ARENA_NEW(arena, LimitVerdict, 3);
    double wanted = WANTED[c->ambient], height = c->height_arcmin;
    limits[0] =
        (LimitVerdict){.name = NAMES[c->ambient],
                       .kind = "contrast_ratio",
                       .unit = "1",
                       .source = "clause 4.3.2 as it is commonly quoted",
                       .value = wanted,
                       .found = c->contrast_ratio,
                       .low = c->contrast_low,
                       .high = c->contrast_high,
                       .margin = log(c->contrast_ratio) / log(wanted) - 1,
                       .verdict = fixture_verdict(c->contrast_low, c->contrast_high, wanted)};
    limits[1] = (LimitVerdict){.name = "height of characters",
                               .kind = "character_height",
                               .unit = "arcmin",
                               .source = "clause 4.5.2",
                               .read_in_the_standard = true,
                               .value = 12,
                               .found = height,
                               .low = height,
                               .high = height,
                               .margin = height / 12 - 1,
                               .verdict = fixture_verdict(height, height, 12)};
    limits[2] = limits[1];
    limits[2].name = "height of characters, recommended";
    limits[2].is_advice = true;
    limits[2].value = 20;
    limits[2].margin = height / 20 - 1;
    limits[2].verdict = fixture_verdict(height, height, 20);
    return limits;
}

static inline const CaseCause *fixture_causes(Arena *arena, double reflected) {
    CaseCause *causes = ARENA_NEW(arena, CaseCause, 3);
    double share[3] = {0.62, 0.21, 0.09};
    causes[0] = (CaseCause){.chain = fixture_chain(arena, "display cluster: mirrors",
                                                   "glass Window_RR: through", "sky"),
                            .links = 3};
    causes[1] = (CaseCause){.chain = fixture_chain(arena, "display cluster: scatters",
                                                   "glass Windscreen: through", "sun"),
                            .links = 3};
    causes[2] = (CaseCause){.chain = fixture_chain(arena, "display cluster: mirrors",
                                                   "shirt of the driver: scatters", "sun"),
                            .links = 3};
    for (int i = 0; i < 3; i++) {
        causes[i].share = share[i];
        causes[i].cd_m2 = share[i] * reflected;
        causes[i].low = 0.97 * causes[i].cd_m2;
        causes[i].high = 1.03 * causes[i].cd_m2;
        causes[i].contrast_without = 2.5 + i;
    }
    return causes;
}

static inline CaseRemedy *fixture_remedies(Arena *arena, const ReviewCase *c) {
    CaseRemedy *remedies = ARENA_NEW(arena, CaseRemedy, 2);
    double scale = c->limits[0].value / c->contrast_ratio * 1.4;
    LimitVerdict then = c->limits[0];
    then.found = then.low = then.high = then.value;
    remedies[0] = (CaseRemedy){.what = "make the display brighter",
                               .contrast_ratio = then.found,
                               .level = scale * c->level,
                               .then = then,
                               .verdict = VERDICT_PASS};
    then.found = then.low = then.high = 1.3 * c->contrast_ratio;
    then.verdict = fixture_verdict(then.low, then.high, then.value);
    remedies[1] = (CaseRemedy){.what = "coat the cover glass: half of the mirror's reflection",
                               .contrast_ratio = then.found,
                               .level = NAN,
                               .then = then,
                               .verdict = then.verdict};
    return remedies;
}

/* Of one symbol under a light: limits, verdict, causes and all follow. */
static inline ReviewCase fixture_case(Arena *arena, const FixtureLight *light, const char *eye,
                                      const char *symbol, double white_cd_m2) {
    double reflected = light->mirror + light->scattered;
    double bright = white_cd_m2 * light->level, dark = bright / 900;
    ReviewCase c = {
        .condition = light->name,
        .eye = eye,
        .symbol = symbol,
        .display = "cluster",
        .ambient = light->ambient,
        .has_sun = !isnan(light->elevation),
        .sun_azimuth_deg = light->azimuth,
        .sun_elevation_deg = light->elevation,
        .luminance_cd_m2 = {bright, dark, reflected, light->mirror, light->scattered, light->veil},
        .contrast_ratio = (bright + reflected) / (dark + reflected),
        .whole = {{0.25, 0.4, 0.275, 0.6},
                  0.8 * reflected,
                  {0.75 * reflected, 0.9 * reflected},
                  (bright + 0.8 * reflected) / (dark + 0.8 * reflected),
                  0.79},
        .paths = 4096,
        .height_arcmin = 11 + white_cd_m2 / 100,
        .stroke_ratio = 0.14,
        .jnd = 212,
        .visibility = 41.5,
        .visible_share = 1,
        .eye_failed_share = 0.125,
        .level = light->level,
        .display_lux = light->lux,
        .limit_count = 3,
        .limit_id = 0,
        .cause_count = 3,
        .remedy_count = 2};
    double veiled = reflected + light->veil;
    c.contrast_with_veil = (bright + veiled) / (dark + veiled);
    c.contrast_low = 0.97 * c.contrast_ratio;
    c.contrast_high = 1.03 * c.contrast_ratio;
    c.limits = fixture_limits(arena, &c);
    c.margin = c.limits[0].margin;
    for (int i = 0; i < 2; i++)
        if (c.limits[i].verdict == VERDICT_FAIL || c.verdict == VERDICT_PASS)
            c.verdict = c.limits[i].verdict;
    c.causes = fixture_causes(arena, reflected);
    c.remedies = fixture_remedies(arena, &c);
    return c;
}

static inline ReviewSweep fixture_sweep(Arena *arena, const char *condition, double minutes) {
    FixtureLight light = FIXTURE_LIGHTS[3];
    light.name = condition;
    light.azimuth = 158;
    ReviewCase worst = fixture_case(arena, &light, "driver", "speed", 440);
    if (!isnan(minutes)) worst.when = "2026-02-20 16:00 UTC, heading 45°";
    return (ReviewSweep){.condition = condition,
                         .eye = "driver",
                         .symbol = "speed",
                         .cases = 35232,
                         .failed_share = 0.037,
                         .longest_failure_minutes = minutes,
                         .worst = worst,
                         .table = "sweeps/any_sun_driver_speed.csv"};
}

/* By day, facing the sun and at night, the last without anything mirrored. */
static inline void fixture_gazes(Arena *arena, Review *review) {
    static const double THROUGH[] = {4200, 3900, 0.8}, MIRRORED[] = {310, 640, 0};
    static const double SUN[] = {65, 8, 0}, REST[] = {74, 92, 0.05};
    review->gazes = ARENA_NEW(arena, GazeFinding, 3);
    review->gaze_count = 3;
    for (int i = 0; i < 3; i++) {
        GazeFinding g = {.condition = FIXTURE_LIGHTS[2 - i].name,
                         .eye = "driver",
                         .gaze = "road",
                         .sun_deg = i < 2 ? SUN[i] : NAN,
                         .veil_parts = {i == 1 ? 5100 : 0, 0.4 * REST[i], 0.1 * REST[i],
                                        0.1 * REST[i], 0.3 * REST[i], 0.1 * REST[i]},
                         .through = THROUGH[i],
                         .mirrored = MIRRORED[i],
                         .cornea_lux = 3 * THROUGH[i]};
        g.veil = g.veil_parts.sun + REST[i];
        g.veil_range = (MeanInterval){0.98 * g.veil, 1.02 * g.veil};
        g.mirrored_range = (MeanInterval){0.99 * g.mirrored, 1.01 * g.mirrored};
        if (g.mirrored > 0) {
            g.mirrored_by = "windscreen (windscreen glass)";
            g.mirrored_from = "dashboard pad (leather black)";
        }
        g.contrast_behind_glass = g.through / (g.through + g.mirrored);
        double veils = g.mirrored + g.veil - g.veil_parts.near;
        g.contrast_left = g.through / (g.through + veils);
        g.contrast_range = (MeanInterval){0.99 * g.contrast_left, 1.01 * g.contrast_left};
        review->gazes[i] = g;
    }
}

/* Three symbols, two eyes, four lights; two sweeps. One symbol hides behind the wheel. */
static inline Review fixture_review(Arena *arena) {
    static const char *const EYES[] = {"driver", "tall driver"};
    static const char *const SYMBOLS[] = {"speed", "range", "fuel telltale"};
    static const double WHITE[] = {640, 540, 380};
    static const char *const NOTES[] = {
        "The panel was measured up to 70°; beyond it values are extrapolated.",
        "Limits are those commonly quoted; the standard itself was not read for all of them."};
    static ReviewFalseSun false_suns[] = {{"a year", "driver", "ring (chrome)", 0.0003, 640, 4,
                                           "2026-10-03 06:42 UTC, heading 90 degrees", 181.5, 12.25,
                                           31000, "speed", 24.5, 410, NULL, 0, VERDICT_PASS},
                                          {"any sun", "driver", "glass Windscreen", 0.02, NAN, NAN,
                                           NULL, 170, 21, 7000, "road", 14, 260, NULL, 0,
                                           VERDICT_PASS}};
    static ReviewResponse responses[] = {
        {"speed, driver: reflected", "responses/a.response", 1200000, 4200000, 0.004},
        {"speed, driver: veil", NULL, 400000, 310000, 0.011}};
    static ReviewRest rests_on[] = {
        {REST_PANEL, REST_MEASURED, "cluster", "PX-9; conoscope, lab <B>", 1, 1},
        {REST_PANEL, REST_SYNTHETIC, "centre", "oled; simulated Fourier optics", 1, 1},
        {REST_MATERIAL, REST_GUESSED, "seat", "cloth, grey", 2, 2},
        {REST_EYE, REST_GIVEN, "driver", NULL, 1, 1},
        {REST_OCCUPANT, REST_NOBODY, NULL, NULL, 4, 4},
        {REST_LIMITS, REST_QUOTED, "ISO 15008", NULL, 1, 5}};
    static ReviewFile inputs[] = {{"car.gltf", NULL, "00000000deadbeef"},
                                  {"a \"b\" & c.png", NULL, "0123456789abcdef"}};
    Review review = {.title = "Cluster and centre display",
                     .profile = "ISO 15008: in-vehicle visual presentation, third edition",
                     .cases = ARENA_NEW(arena, ReviewCase, 24),
                     .case_count = 24,
                     .sweeps = ARENA_NEW(arena, ReviewSweep, 2),
                     .sweep_count = 2,
                     .responses = responses,
                     .response_count = 2,
                     .false_suns = false_suns,
                     .false_sun_count = 2,
                     .rests_on = rests_on,
                     .rests_on_count = 6,
                     .inputs = inputs,
                     .input_count = 2,
                     .notes = NOTES,
                     .note_count = 2};
    for (int i = 0; i < 24; i++)
        review.cases[i] = fixture_case(arena, &FIXTURE_LIGHTS[i % 4], EYES[i / 12],
                                       SYMBOLS[i / 4 % 3], WHITE[i / 4 % 3]);
    ReviewCase *hidden = &review.cases[20];
    static const CaseHider HIDERS[] = {{"wheel <rim> (leather)", 0.75},
                                       {"stalk (satin)", 0.125},
                                       {"driver's hand (skin)", 0.0625},
                                       {"hub (leather)", 0.0625}};
    hidden->hiders = HIDERS;
    hidden->hider_count = 4;
    hidden->visible_share = 0;
    hidden->contrast_ratio = hidden->contrast_low = hidden->contrast_high = NAN;
    hidden->contrast_with_veil = hidden->margin = hidden->jnd = hidden->height_arcmin = NAN;
    hidden->limit_count = hidden->cause_count = hidden->remedy_count = 0;
    hidden->limit_id = -1;
    hidden->verdict = VERDICT_UNJUDGED;
    hidden->unjudged = UNJUDGED_HIDDEN;
    review.sweeps[0] = fixture_sweep(arena, "any sun", NAN);
    review.sweeps[1] = fixture_sweep(arena, "a year", 85);
    fixture_gazes(arena, &review);
    review_decide(&review);
    return review;
}

/* Names and figures that no one expects. */
static inline Review fixture_odd_review(Arena *arena) {
    static const char *const CHAIN[] = {WILD_NAME, "", WILD_NAME};
    static const char *const NOTES[] = {WILD_NAME, ""};
    static const LimitVerdict LIMITS[] = {{WILD_NAME,
                                           "contrast_ratio",
                                           "1",
                                           WILD_NAME,
                                           2,
                                           false,
                                           false,
                                           false,
                                           NAN,
                                           NAN,
                                           NAN,
                                           NAN,
                                           VERDICT_TOO_CLOSE,
                                           NAN,
                                           NULL,
                                           NULL,
                                           {0, 0},
                                           {false, false},
                                           false},
                                          {WILD_NAME,
                                           "glare",
                                           WILD_NAME,
                                           WILD_NAME,
                                           0.1,
                                           true,
                                           true,
                                           true,
                                           1e-9,
                                           1e-10,
                                           1e12,
                                           1e8 - 1,
                                           VERDICT_PASS,
                                           70,
                                           WILD_NAME,
                                           WILD_NAME,
                                           {0, 0},
                                           {false, false},
                                           false}};
    static const CaseCause CAUSES[] = {{CHAIN, 3, NAN, NAN, NAN, NAN, NAN, NULL, 0},
                                       {CHAIN, 0, 1, 0, 0, 0, 1, NULL, 0}};
    static CaseRemedy REMEDIES[] = {{.what = WILD_NAME,
                                     .contrast_ratio = NAN,
                                     .level = NAN,
                                     .then = {WILD_NAME,
                                              "glare",
                                              WILD_NAME,
                                              WILD_NAME,
                                              2,
                                              false,
                                              false,
                                              false,
                                              NAN,
                                              NAN,
                                              NAN,
                                              NAN,
                                              VERDICT_UNJUDGED,
                                              0,
                                              NULL,
                                              NULL,
                                              {0, 0},
                                              {false, false},
                                              false},
                                     .verdict = VERDICT_UNJUDGED},
                                    {.what = "", .contrast_ratio = 3, .level = 4}};
    static ReviewResponse responses[] = {{WILD_NAME, WILD_NAME, 0, 0, NAN}};
    static ReviewFalseSun false_suns[] = {{WILD_NAME, WILD_NAME, WILD_NAME, NAN, NAN, NAN, NULL, 0,
                                           -1, 1e9, WILD_NAME, 0.1, 3e7, NULL, 0, VERDICT_PASS}};
    static const CaseColour COLOURS[] = {{.symbol = WILD_NAME,
                                          .uv = {0.2, 1.0 / 3},
                                          .dark_uv = {NAN, NAN},
                                          .apart = NAN,
                                          .low = 0,
                                          .high = NAN},
                                         {.symbol = "", .apart = 1e-7, .high = 1e9}};
    ReviewCase wild = {.condition = WILD_NAME,
                       .eye = WILD_NAME,
                       .symbol = WILD_NAME,
                       .display = WILD_NAME,
                       .ambient = AMBIENT_TWILIGHT,
                       .has_sun = true,
                       .sun_azimuth_deg = -1e-7,
                       .sun_elevation_deg = NAN,
                       .luminance_cd_m2 = {NAN, 0, 1e-12, NAN, NAN, 1e9},
                       .whole = {{NAN, 0, 1, NAN}, 1e9, {NAN, 1e-12}, NAN, 1.0 / 3},
                       .contrast_ratio = NAN,
                       .contrast_low = NAN,
                       .contrast_high = NAN,
                       .contrast_with_veil = NAN,
                       .height_arcmin = NAN,
                       .stroke_ratio = NAN,
                       .jnd = NAN,
                       .visibility = NAN,
                       .colours = COLOURS,
                       .colour_count = 2,
                       .eye_failed_share = NAN,
                       .when = WILD_NAME,
                       .visible_share = NAN,
                       .level = NAN,
                       .display_lux = NAN,
                       .limits = LIMITS,
                       .limit_count = 2,
                       .limit_id = 1,
                       .margin = NAN,
                       .verdict = VERDICT_TOO_CLOSE,
                       .causes = CAUSES,
                       .cause_count = 2,
                       .remedies = REMEDIES,
                       .remedy_count = 2,
                       .frame = WILD_NAME};
    ReviewCase bare = {.condition = "",
                       .eye = "",
                       .symbol = "",
                       .display = NULL,
                       .luminance_cd_m2 = {1, 2, 3, 1, 2, 0},
                       .contrast_ratio = 1.25,
                       .contrast_low = 1.25,
                       .contrast_high = 1.25,
                       .contrast_with_veil = 1.25,
                       .height_arcmin = 1.0 / 3,
                       .jnd = 0,
                       .visible_share = 1,
                       .level = 1,
                       .display_lux = 0,
                       .limit_id = -1,
                       .margin = NAN,
                       .verdict = VERDICT_PASS};
    static GazeFinding gazes[] = {{WILD_NAME,
                                   WILD_NAME,
                                   WILD_NAME,
                                   0,
                                   1e-9,
                                   {NAN, 1e9},
                                   {NAN, 0, 1e-12, -0.0, 1e9, 3},
                                   NAN,
                                   0,
                                   1e12,
                                   {NAN, NAN},
                                   WILD_NAME,
                                   WILD_NAME,
                                   0,
                                   NAN,
                                   {NAN, NAN},
                                   NULL,
                                   NULL,
                                   0,
                                   VERDICT_PASS,
                                   UNJUDGED_NOT},
                                  {"", NULL,   "",   NAN,    0,    {0, 0},       {0, 0, 0, 0, 0, 0},
                                   0,  0,      0,    {0, 0}, NULL, NULL,         NAN,
                                   0,  {0, 1}, NULL, NULL,   0,    VERDICT_PASS, UNJUDGED_NOT}};
    Review review = {.title = WILD_NAME,
                     .profile = WILD_NAME,
                     .cases = ARENA_NEW(arena, ReviewCase, 2),
                     .case_count = 2,
                     .sweeps = ARENA_NEW(arena, ReviewSweep, 1),
                     .sweep_count = 1,
                     .gazes = gazes,
                     .gaze_count = 2,
                     .responses = responses,
                     .response_count = 1,
                     .false_suns = false_suns,
                     .false_sun_count = 1,
                     .notes = NOTES,
                     .note_count = 2,
                     .is_strict = true};
    review.cases[0] = wild;
    review.cases[1] = bare;
    review.sweeps[0] = (ReviewSweep){WILD_NAME, WILD_NAME, WILD_NAME, 0,    NAN,      NAN,
                                     NAN,       WILD_NAME, NAN,       wild, WILD_NAME};
    review_decide(&review);
    return review;
}

/* Visibility levels at 50 years, the observer's, and at 70 for every case; nothing is known of
 * those of a symbol that is hidden. */
static inline void fixture_add_levels(Arena *arena, Review *review) {
    for (int i = 0; i < review->case_count; i++) {
        ReviewCase *c = &review->cases[i];
        CaseVisibility *v = ARENA_NEW(arena, CaseVisibility, 2);
        double level = isnan(c->contrast_ratio) ? NAN : 6 + i;
        v[0] =
            (CaseVisibility){50,    true,  2.25,        0.2,          1,    0.0625, 3.5,
                             0.125, level, level - 0.5, level + 0.25, NULL, {1, 1}, {false, false}};
        v[1] = (CaseVisibility){70,
                                false,
                                2.25,
                                0.2,
                                1.25,
                                0.0625,
                                3.75,
                                0.375,
                                level / 2,
                                level / 2 - 0.25,
                                level / 2 + 0.25,
                                "a <doubt>, \"quoted\"",
                                {1, 1},
                                {false, false}};
        c->visibilities = v;
        c->visibility_count = 2;
    }
}

/* ---- maps and calendars ----------------------------------------------------------------- */

/* Fails where the sun stands behind and low: a disc of 25 degrees. */
static inline ReviewMap fixture_map(Arena *arena, const ReviewSweep *sweep) {
    enum { COLUMNS = 181, ROWS = 41 };
    ReviewStep *cells = ARENA_NEW(arena, ReviewStep, COLUMNS * ROWS);
    for (int i = 0; i < COLUMNS * ROWS; i++) {
        double azimuth = i % COLUMNS * 2, elevation = i / COLUMNS * 2;
        double from = hypot(azimuth - 160, 1.5 * (elevation - 14));
        double ratio = 0.65 + 0.35 * from / 25 + 0.15 * sin(azimuth / 9) * sin(elevation / 7);
        cells[i] = (ReviewStep){.azimuth_deg = azimuth,
                                .elevation_deg = elevation,
                                .contrast = elevation > 76 ? (double)NAN : 2 * ratio,
                                .low = 1.9 * ratio,
                                .high = 2.1 * ratio,
                                .margin = ratio - 1,
                                .reflected = 100 * ratio,
                                .mirror = 90 * ratio,
                                .level = 1,
                                .lux = 5e4 * ratio,
                                .verdict = ratio < 0.98   ? VERDICT_FAIL
                                           : ratio < 1.02 ? VERDICT_TOO_CLOSE
                                                          : VERDICT_PASS};
    }
    return (ReviewMap){
        .of = sweep, .azimuth_deg = {0, 2, COLUMNS}, .elevation_deg = {0, 2, ROWS}, .cells = cells};
}

static inline ReviewCalendar fixture_calendar(Arena *arena, const ReviewSweep *sweep) {
    enum { DAYS = 365, STEPS = 24 };
    int *failing = ARENA_NEW(arena, int, DAYS *STEPS);
    for (int i = 0; i < DAYS * STEPS; i++) {
        double day = i / STEPS, hour = i % STEPS;
        double half = 6 - 2.2 * cos((day + 10) / 365 * 2 * acos(-1));
        double low = fabs(hour - 12) / half;
        failing[i] = low > 1 ? -1 : low > 0.72 ? (int)(8 * (low - 0.72) * 2.2) : 0;
    }
    return (ReviewCalendar){.of = sweep,
                            .year = 2026,
                            .days = DAYS,
                            .steps_a_day = STEPS,
                            .headings = 8,
                            .failing = failing};
}
