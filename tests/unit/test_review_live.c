/* SPDX-License-Identifier: Apache-2.0 */
/* What a review's page holds for its script: the rows of its sweeps' tables come back as they
 * went in, within the stated error. */
#include "fixture.h"

#include <jansson.h>
#include <zlib.h>

#include "page/page.h"
#include "review/output/review_live.h"
#include "text/base64.h"
#include "verdict_fixture.h"

/* ---- packed numbers ---------------------------------------------------------------------- */

/* As page.h says it, back again. */
static uint32_t *unpacked(const char *text, size_t count, int bytes, Arena *arena) {
    size_t size;
    uLong room = (uLong)(count * (size_t)bytes);
    unsigned char *packed = ARENA_NEW(arena, unsigned char, strlen(text));
    unsigned char *planes = ARENA_NEW(arena, unsigned char, room);
    uint32_t *out = ARENA_NEW(arena, uint32_t, count);
    assert_done(base64_decode(text, strlen(text), packed, &size, &err));
    assert_int_equal(uncompress(planes, &room, packed, (uLong)size), Z_OK);
    assert_int_equal(room, count * (size_t)bytes);
    for (int plane = 0; plane < bytes; plane++) {
        unsigned char value = 0;
        for (size_t i = 0; i < count; i++) {
            value = (unsigned char)(value + planes[(size_t)plane * count + i]);
            out[i] |= (uint32_t)value << 8 * plane;
        }
    }
    return out;
}

ARENA_TEST(numbers_come_back) {
    uint32_t values[1000];
    for (int bytes = 1; bytes <= 4; bytes++) {
        for (uint32_t i = 0; i < 1000; i++) values[i] = i * i * 2654435761u;
        const char *packed = page_packed(values, 1000, bytes, &arena, why());
        assert_non_null(packed);
        uint32_t *back = unpacked(packed, 1000, bytes, &arena);
        uint32_t mask = (uint32_t)(((uint64_t)1 << 8 * bytes) - 1);
        for (int i = 0; i < 1000; i++) assert_int_equal(back[i], values[i] & mask);
    }
}

/* ---- sweeps ------------------------------------------------------------------------------ */

enum { SUNS = 200 };

static float *some_numbers(double low, double high, double turn, Arena *arena) {
    float *out = ARENA_NEW(arena, float, SUNS);
    for (int i = 0; i < SUNS; i++)
        out[i] = (float)(low * pow(high / low, 0.5 + 0.5 * sin(turn * i)));
    out[7] = 0;
    return out;
}

/* What stands in the page of a review with live sweeps. */
static json_t *live_block(const Review *review, const ReviewLive *live, Arena *arena) {
    Text html = {.arena = arena};
    assert_done(review_live_add(&html, review, live, &err));
    const char *start = strchr(html.data, '{'), *end = strstr(html.data, "</script>");
    assert_true(start && end);
    json_error_t error;
    json_t *block = json_loadb(start, (size_t)(end - start), 0, &error);
    if (!block) fail_msg("%s", error.text);
    return block;
}

static void assert_numbers(const json_t *sweep, const char *name, const float *wanted,
                           Arena *arena) {
    const uint32_t *codes =
        unpacked(json_string_value(json_object_get(sweep, name)), SUNS, 2, arena);
    for (int i = 0; i < SUNS; i++) {
        double found = codes[i] ? 1e-6 * pow(1e15, (codes[i] - 1) / 65533.0) : 0;
        assert_true(fabs(found - (double)wanted[i]) <= 3e-4 * (double)wanted[i]);
    }
}

TEST(rows_come_back) {
    Arena arena = test_arena(state);
    Review review = fixture_review(&arena);
    LiveSun suns[SUNS];
    float margin[SUNS];
    unsigned char verdict[SUNS];
    for (int i = 0; i < SUNS; i++) {
        suns[i] = (LiveSun){-100 + 1.7 * i, -0.5 + 0.3 * i, 400 * i, i % 8};
        verdict[i] = (unsigned char)(i % 4);
        margin[i] = i % 9 ? -1 + 0.0317f * (float)i : NAN;
    }
    double headings[8] = {0, 45, 90, 135, 180, 225, 270, 315};
    LiveSky sky = {suns, SUNS, 2026, 60, headings, 8};
    LiveSweep sweeps[2] = {
        {0, &sky, 3, some_numbers(1, 1e3, 0.3, &arena), some_numbers(1, 900, 0.3, &arena),
         some_numbers(1, 1100, 0.3, &arena), margin, some_numbers(1, 1e4, 0.3, &arena),
         some_numbers(1e-5, 1e4, 0.2, &arena), some_numbers(0.02, 1, 0.1, &arena),
         some_numbers(1, 1e5, 0.7, &arena), verdict}};
    sweeps[1] = sweeps[0];
    sweeps[1].sweep_id = 1;
    sweeps[1].lux = some_numbers(1, 1e5, 0.71, &arena);
    ReviewLive live = {.sweeps = sweeps, .sweep_count = 2};
    json_auto_t *block = live_block(&review, &live, &arena);
    json_t *first = json_array_get(json_object_get(block, "sweeps"), 0);
    json_t *second = json_array_get(json_object_get(block, "sweeps"), 1);
    json_t *places = json_array_get(json_object_get(block, "skies"), 0);
    assert_int_equal(json_array_size(json_object_get(block, "skies")), 1);
    assert_numbers(first, "contrast", sweeps[0].contrast, &arena);
    assert_numbers(first, "low", sweeps[0].low, &arena);
    assert_numbers(first, "high", sweeps[0].high, &arena);
    assert_numbers(first, "reflected", sweeps[0].reflected, &arena);
    assert_numbers(first, "mirror", sweeps[0].mirror, &arena);
    assert_numbers(first, "level", sweeps[0].level, &arena);
    assert_numbers(second, "lux", sweeps[1].lux, &arena);
    assert_int_equal(json_integer_value(json_object_get(second, "level")), 0);
    assert_true(json_is_integer(json_object_get(second, "level")));
    assert_int_equal(json_integer_value(json_object_get(first, "worst")), 3);
    uint32_t *azimuth =
        unpacked(json_string_value(json_object_get(places, "azimuth")), SUNS, 2, &arena);
    uint32_t *step = unpacked(json_string_value(json_object_get(places, "step")), SUNS, 4, &arena);
    uint32_t *verdicts =
        unpacked(json_string_value(json_object_get(first, "verdict")), SUNS, 1, &arena);
    uint32_t *margins =
        unpacked(json_string_value(json_object_get(first, "margin")), SUNS, 2, &arena);
    for (int i = 0; i < SUNS; i++) {
        double turned = fmod(suns[i].azimuth_deg + 360, 360);
        assert_true(fabs(azimuth[i] / 100.0 - turned) <= 0.00501);
        assert_int_equal(step[i], 400 * i);
        assert_int_equal(verdicts[i], verdict[i]);
        if (isnan(margin[i])) assert_int_equal(margins[i], 0);
        else assert_true(fabs((margins[i] - 1) / 1000.0 - 1 - (double)margin[i]) <= 0.000501);
    }
}

/* What shows before black without limit, and what nothing is known of. */
ARENA_TEST(a_row_may_be_infinite) {
    Review review = fixture_review(&arena);
    LiveSun suns[2] = {{0, 10, -1, 0}, {10, 10, -1, 0}};
    float contrast[2] = {INFINITY, NAN}, none[2] = {0};
    unsigned char verdict[2] = {VERDICT_PASS, VERDICT_UNJUDGED};
    LiveSky sky = {suns, 2, 0, 0, NULL, 0};
    LiveSweep sweep = {0, &sky, 0, contrast, none, contrast, none, none, none, none, none, verdict};
    json_auto_t *block = live_block(&review, &(ReviewLive){&sweep, 1, NULL}, &arena);
    json_t *first = json_array_get(json_object_get(block, "sweeps"), 0);
    uint32_t *codes = unpacked(json_string_value(json_object_get(first, "contrast")), 2, 2, &arena);
    assert_int_equal(codes[0], 65535);
    assert_int_equal(codes[1], 0);
}

ARENA_TEST(nothing_to_move_is_nothing_in_the_page) {
    Review review = fixture_review(&arena);
    ReviewLive live = {0};
    Text html = {.arena = &arena};
    assert_true(review_live_add(&html, &review, &live, why()) && html.size == 0);
}

TEST_PROGRAM(make_arena, drop_arena)
