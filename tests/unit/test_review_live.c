/* SPDX-License-Identifier: Apache-2.0 */
/* What a review's page holds for its script: numbers come back as they went in, light within
 * the stated error; a frame's two parts add up to it, smaller and in the eye as well. */
#include "frame_fixture.h"

#include <jansson.h>
#include <zlib.h>

#include "page/page.h"
#include "review/output/review_live.h"
#include "review/folder/live.h"
#include "text/base64.h"
#include "verdict_fixture.h"

/* ---- packed numbers ---------------------------------------------------------------------- */

/* As page.h says it, back again. */
static uint32_t *unpacked(const char *text, size_t count, int bytes, Arena *arena)
{
    size_t size;
    uLong  room = (uLong)(count * (size_t)bytes);
    unsigned char *packed = ARENA_NEW(arena, unsigned char, strlen(text));
    unsigned char *planes = ARENA_NEW(arena, unsigned char, room);
    uint32_t      *out = ARENA_NEW(arena, uint32_t, count);
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

ARENA_TEST(numbers_come_back)
{
    uint32_t values[1000];
    for (int bytes = 1; bytes <= 4; bytes++) {
        for (uint32_t i = 0; i < 1000; i++) values[i] = i * i * 2654435761u;
        const char *packed = page_packed(values, 1000, bytes, &arena, why());
        assert_non_null(packed);
        uint32_t *back = unpacked(packed, 1000, bytes, &arena);
        uint32_t  mask = (uint32_t)(((uint64_t)1 << 8 * bytes) - 1);
        for (int i = 0; i < 1000; i++) assert_int_equal(back[i], values[i] & mask);
    }
}

/* ---- sweeps ------------------------------------------------------------------------------ */

enum { SUNS = 200 };

static float *some_numbers(double low, double high, double turn, Arena *arena)
{
    float *out = ARENA_NEW(arena, float, SUNS);
    for (int i = 0; i < SUNS; i++)
        out[i] = (float)(low * pow(high / low, 0.5 + 0.5 * sin(turn * i)));
    out[7] = 0;
    return out;
}

/* What stands in the page of a review with live sweeps. */
static json_t *live_block(const Review *review, const ReviewLive *live, Arena *arena)
{
    Text  html = {.arena = arena};
    assert_done(review_live_add(&html, review, live, &err));
    const char *start = strchr(html.data, '{'), *end = strstr(html.data, "</script>");
    assert_true(start && end);
    json_error_t error;
    json_t      *block = json_loadb(start, (size_t)(end - start), 0, &error);
    if (!block) fail_msg("%s", error.text);
    return block;
}

static void assert_numbers(const json_t *sweep, const char *name, const float *wanted,
                           Arena *arena)
{
    const uint32_t *codes =
        unpacked(json_string_value(json_object_get(sweep, name)), SUNS, 2, arena);
    for (int i = 0; i < SUNS; i++) {
        double found = codes[i] ? 1e-6 * pow(1e15, (codes[i] - 1) / 65534.0) : 0;
        assert_true(fabs(found - (double)wanted[i]) <= 3e-4 * (double)wanted[i]);
    }
}

TEST(suns_come_back)
{
    Arena   arena = test_arena(state);
    Review  review = fixture_review(&arena);
    LiveSun suns[SUNS];
    unsigned char verdict[SUNS], ambient[SUNS];
    const LimitVerdict *asked[4] = {&review.cases[0].limits[0], NULL, NULL, NULL};
    for (int i = 0; i < SUNS; i++) {
        suns[i] = (LiveSun){-100 + 1.7 * i, -0.5 + 0.3 * i, 400 * i, i % 8};
        verdict[i] = (unsigned char)(i % 4);
        ambient[i] = (unsigned char)(i / 4 % 4);
    }
    double    headings[8] = {0, 45, 90, 135, 180, 225, 270, 315};
    LiveSky   sky = {suns, SUNS, false, 2026, 60, headings, 8};
    LiveSweep sweeps[2] = {{0, &sky, 3, some_numbers(1, 1e4, 0.3, &arena),
                            some_numbers(1e-5, 1e4, 0.2, &arena),
                            some_numbers(0.02, 1, 0.1, &arena),
                            some_numbers(1, 1e5, 0.7, &arena), verdict, ambient, 800, NAN,
                            asked}};
    sweeps[1] = sweeps[0];
    sweeps[1].sweep_id = 1;
    sweeps[1].lux = some_numbers(1, 1e5, 0.71, &arena);
    ReviewLive live = {.sweeps = sweeps, .sweep_count = 2, .colours = ""};
    json_auto_t *block = live_block(&review, &live, &arena);
    json_t    *first = json_array_get(json_object_get(block, "sweeps"), 0);
    json_t    *second = json_array_get(json_object_get(block, "sweeps"), 1);
    json_t    *places = json_array_get(json_object_get(block, "skies"), 0);
    assert_int_equal(json_array_size(json_object_get(block, "skies")), 1);
    assert_numbers(first, "reflected", sweeps[0].reflected, &arena);
    assert_numbers(first, "mirror", sweeps[0].mirror, &arena);
    assert_numbers(first, "level", sweeps[0].level, &arena);
    assert_numbers(second, "lux", sweeps[1].lux, &arena);
    assert_int_equal(json_integer_value(json_object_get(second, "level")), 0);
    assert_true(json_is_integer(json_object_get(second, "level")));
    assert_true(json_is_null(json_object_get(first, "background")));
    assert_int_equal(json_integer_value(json_object_get(first, "worst")), 3);
    uint32_t *azimuth = unpacked(json_string_value(json_object_get(places, "azimuth")), SUNS, 2,
                                 &arena);
    uint32_t *step = unpacked(json_string_value(json_object_get(places, "step")), SUNS, 4,
                              &arena);
    uint32_t *state_of = unpacked(json_string_value(json_object_get(first, "state")), SUNS, 1,
                                  &arena);
    for (int i = 0; i < SUNS; i++) {
        double turned = fmod(suns[i].azimuth_deg + 360, 360);
        assert_true(fabs(azimuth[i] / 100.0 - turned) <= 0.00501);
        assert_int_equal(step[i], 400 * i);
        assert_int_equal(state_of[i], verdict[i] | ambient[i] << 2);
    }
}

ARENA_TEST(nothing_to_move_is_nothing_in_the_page)
{
    Review     review = fixture_review(&arena);
    ReviewLive live = {.colours = ""};
    Text       html = {.arena = &arena};
    assert_true(review_live_add(&html, &review, &live, why()) && html.size == 0);
}

/* ---- light ------------------------------------------------------------------------------- */

static double luminance(double r, double g, double b)
{
    return 0.212639 * r + 0.715169 * g + 0.072192 * b;
}

ARENA_TEST(light_comes_back)
{
    enum { COUNT = 3000 };
    float *rgb[3];
    for (int c = 0; c < 3; c++) rgb[c] = ARENA_NEW(&arena, float, COUNT);
    for (int i = 0; i < COUNT; i++) {
        double size = pow(10, -5 + 14.9 * i / COUNT);
        rgb[0][i] = (float)(size * (1 + 0.5 * sin(i)));
        rgb[1][i] = (float)(size * (1 + 0.3 * sin(2.3 * i)));
        rgb[2][i] = (float)(size * (1 + 0.9 * sin(1.7 * i)));
    }
    rgb[1][COUNT - 1] = NAN;
    rgb[0][COUNT - 2] = rgb[1][COUNT - 2] = rgb[2][COUNT - 2] = 0;
    const float *in[3] = {rgb[0], rgb[1], rgb[2]};
    const char  *text = live_layer_pack(in, COUNT, &arena, why());
    uint32_t    *codes = unpacked(text, COUNT, 4, &arena);
    for (int i = 0; i < COUNT - 2; i++) {
        double wanted = luminance((double)rgb[0][i], (double)rgb[1][i], (double)rgb[2][i]);
        double found = 1e-5 * pow(1e15, ((codes[i] & 65535) - 1) / 4094.0);
        double X = 0.412391 * (double)rgb[0][i] + 0.357584 * (double)rgb[1][i] +
                   0.180481 * (double)rgb[2][i];
        double Z = 0.019331 * (double)rgb[0][i] + 0.119195 * (double)rgb[1][i] +
                   0.950532 * (double)rgb[2][i];
        double sum = X + 15 * wanted + 3 * Z;
        if (wanted > 1e-5) assert_true(fabs(found / wanted - 1) < LIVE_LAYER_ERROR);
        assert_true(fabs((codes[i] >> 16 & 255) / 410.0 - 4 * X / sum) < 0.5001 / 410);
        assert_true(fabs((codes[i] >> 24) / 410.0 - 9 * wanted / sum) < 0.5001 / 410);
    }
    assert_int_equal(codes[COUNT - 2], 0);
    assert_int_equal(codes[COUNT - 1], 0);
}

/* ---- a frame's two parts ----------------------------------------------------------------- */

static FrameImage shown_frame(Arena *arena)
{
    ExrWindow  whole = {0, 0, 40, 30};
    FrameImage frame = frame_create(40, 30, whole, 8, 0, arena);
    for (int c = 0; c < 3; c++) {
        float *all = frame_add_channel(&frame, (char[]){"RGB"[c], 0}, false, arena);
        char   name[] = "display.emitted.R";
        name[16] = "RGB"[c];
        float *shown = frame_add_channel(&frame, name, false, arena);
        for (int i = 0; i < 1200; i++) {
            all[i] = (float)(100 + 7 * (i % 40) + 3 * c);
            shown[i] = i % 40 < 20 ? 40 : NAN;
        }
    }
    float *coverage = frame_add_channel(&frame, "display.coverage", false, arena);
    for (int i = 0; i < 1200; i++) coverage[i] = i % 40 < 19 ? 1 : i % 40 == 19 ? 0.25f : 0;
    return frame;
}

static double mean_of(const float *values, int count)
{
    double sum = 0;
    for (int i = 0; i < count; i++) sum += (double)values[i];
    return sum / count;
}

ARENA_TEST(parts_add_up)
{
    FrameImage frame = shown_frame(&arena);
    LiveFrame  split;
    const float *rgb[3];
    assert_true(live_frame_split(&frame, &arena, &split, why()) && frame_rgb(&frame, "", rgb));
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < 1200; i++) {
            float shown = i % 40 < 19 ? 40 : i % 40 == 19 ? 10 : 0;
            assert_true(split.displays.rgb[c][i] == shown);
            assert_true(split.scene.rgb[c][i] + shown == rgb[c][i]);
        }
}

/* What displays show of a denoised frame is display.fine, bit for bit, where that is known, and
 * the samples' own elsewhere; both parts add up to the picture, and no light is negative. */
ARENA_TEST(displays_of_a_clean_picture_are_not_filtered)
{
    FrameImage frame = shown_frame(&arena);
    LiveFrame  plain, split;
    const float *rgb[3];
    float       *filtered[3];
    assert_done(live_frame_split(&frame, &arena, &plain, &err));
    for (int c = 0; c < 3; c++) {
        char name[] = "display.fine.R";
        name[13] = "RGB"[c];
        float *fine = frame_add_channel(&frame, name, false, &arena);
        filtered[c] = ARENA_NEW(&arena, float, 1200);
        for (int i = 0; i < 1200; i++) {
            fine[i] = i % 7 == 0 || i % 40 > 19 ? NAN : 39.3f + 0.1f * (float)(i % 5);
            filtered[c][i] = i == 3 ? 1 : 45 + (float)c;
        }
    }
    FrameImage clean = frame_with_rgb(&frame, filtered, &arena);
    assert_done(live_clean_split(&clean, &arena, &split, &err));
    assert_true(frame_rgb(&clean, "display.fine", rgb));
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < 1200; i++) {
            bool  has_fine = i % 7 != 0 && i % 40 <= 19;
            float shown = has_fine ? rgb[c][i] : plain.displays.rgb[c][i];
            assert_true(split.displays.rgb[c][i] == shown);
            assert_true(split.scene.rgb[c][i] == fmaxf(filtered[c][i] - shown, 0));
        }
    assert_true(split.scene.rgb[0][3] == 0); /* less light than its display has */
}

ARENA_TEST(a_frame_without_displays_layers_is_refused)
{
    FrameImage frame = uniform_frame(4, 4, 1, &arena);
    LiveFrame  split;
    assert_fails_as(live_frame_split(&frame, &arena, &split, &err), ERROR_INPUT,
                    "display.coverage");
}

/* Smaller by whole numbers or not: the mean stays, and what is even stays even. */
ARENA_TEST(smaller_is_as_bright)
{
    FrameImage frame = shown_frame(&arena);
    LiveFrame  split;
    assert_done(live_frame_split(&frame, &arena, &split, &err));
    static const int SIZES[][4] = {{20, 15, 20, 15}, {24, 30, 24, 18}, {64, 48, 40, 30},
                                   {7, 5, 7, 5}};
    for (int s = 0; s < 4; s++) {
        LivePlanes small = live_frame_shrink(&split.scene, SIZES[s][0], SIZES[s][1], &arena);
        assert_int_equal(small.width, SIZES[s][2]);
        assert_int_equal(small.height, SIZES[s][3]);
        for (int c = 0; c < 3; c++)
            assert_float_equal(mean_of(small.rgb[c], small.width * small.height),
                               mean_of(split.scene.rgb[c], 1200), 1e-3);
    }
    LivePlanes half = live_frame_shrink(&split.displays, 20, 15, &arena);
    assert_true(half.rgb[0][3] == 40 && half.rgb[0][9] == 25 && half.rgb[0][10] == 0);
}

/* An eye makes no light and loses none: a narrow view's pixels are all alike. */
ARENA_TEST(an_eye_keeps_the_light)
{
    FrameImage frame = shown_frame(&arena);
    LiveFrame  split;
    assert_done(live_frame_split(&frame, &arena, &split, &err));
    double before = mean_of(split.displays.rgb[1], 1200);
    HumanEye eye = {70, 0.5};
    assert_done(live_frame_spread(&split, 2, eye, 2, &arena, &err));
    assert_float_equal(mean_of(split.displays.rgb[1], 1200), before, 1e-3 * before);
    assert_true(split.displays.rgb[1][39] > 0 && split.displays.rgb[1][10] < 40);
}

TEST_PROGRAM(make_arena, drop_arena)
