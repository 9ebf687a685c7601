/* SPDX-License-Identifier: Apache-2.0 */
/* compare_fixture.h -- small frames and pictures to compare, and what is said about them. */
#pragma once
#include "fixture.h"

#include "compare/compare.h"
#include "image/srgb.h"

enum { WIDTH = 12, HEIGHT = 8, COUNT = WIDTH * HEIGHT };
#define ARENA_BYTES ((size_t)1 << 30)

/* A frame whose red is i, green i / 2, blue 1, with metadata and a layer of a display. */
static inline CompareInput frame_input(const char *name, Arena *arena) {
    FrameImage frame = frame_create(WIDTH, HEIGHT, (ExrWindow){0, 0, WIDTH, HEIGHT}, 5, 8, arena);
    float *r = frame_add_channel(&frame, "R", false, arena);
    float *g = frame_add_channel(&frame, "G", false, arena);
    float *b = frame_add_channel(&frame, "B", false, arena);
    float *shown = frame_add_channel(&frame, "display.emitted.R", false, arena);
    for (int i = 0; i < COUNT; i++) {
        r[i] = (float)i;
        g[i] = (float)i / 2;
        b[i] = 1;
        shown[i] = i % WIDTH < 4 ? NAN : 5;
    }
    frame_set_string(&frame, "parhelion:unit", "cd/m2", arena);
    frame_set_string(&frame, "parhelion:camera", "eye", arena);
    frame_set_string(&frame, "parhelion:seed", "1", arena);
    frame_set_string(&frame, "parhelion:samples", "0:16", arena);
    frame_set_string(&frame, "parhelion:inputs", "00aa  a.gltf\n00bb  b.png\n", arena);
    return (CompareInput){
        .name = name, .kind = INPUT_FRAME, .light = {WIDTH, HEIGHT, {r, g, b}}, .frame = frame};
}

static inline float *channel(const CompareInput *input, const char *name) {
    for (int i = 0; i < input->frame.channel_count; i++)
        if (!strcmp(input->frame.channels[i].name, name)) return input->frame.channels[i].values;
    fail_msg("no channel %s", name);
    return NULL;
}

static inline CompareInput picture_input(const char *name, int bits, Arena *arena) {
    CompareInput input = {
        .name = name,
        .kind = INPUT_PICTURE,
        .bits = bits,
        .tags = {.orientation = 1, .words = "", .is_srgb = true, .is_known = true},
        .light = {WIDTH, HEIGHT, {NULL}},
        .codes = {WIDTH, HEIGHT, {NULL}}};
    for (int c = 0; c < 3; c++) {
        float *codes = ARENA_NEW(arena, float, COUNT), *light = ARENA_NEW(arena, float, COUNT);
        for (int i = 0; i < COUNT; i++) {
            codes[i] = (float)((i * 5 + c) % 256) / 255;
            light[i] = linear_from_srgb(codes[i]);
        }
        input.codes.rgb[c] = codes;
        input.light.rgb[c] = light;
    }
    return input;
}

static inline Comparison compared(const CompareInput *a, const CompareInput *b,
                                  CompareOptions options, Arena *arena) {
    Comparison c;
    Error err = {0};
    options.threads = 1;
    if (!compare_inputs(a, b, &options, arena, &c, &err)) fail_msg("%s", err.text);
    return c;
}

static inline void assert_reason(const Comparison *c, const char *part) {
    assert_false(c->same);
    if (lines_have(c->reasons.list, c->reasons.count, part)) return;
    fail_msg("no reason has \"%s\"; the verdict is \"%s\"", part, c->verdict);
}

static inline bool has_note(const Comparison *c, const char *part) {
    return lines_have(c->notes.list, c->notes.count, part);
}

/* Nothing but what fails whatever the limits are. */
static const Threshold ANYTHING = {METRIC_DIFFERING, 1};
static const CompareOptions LOOSE = {
    .groups = GROUP_MSE, .thresholds = &ANYTHING, .threshold_count = 1};
