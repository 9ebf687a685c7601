/* compare_fixture.h -- small frames and pictures to compare, and what is said about them. */
#pragma once
#include "check.h"

#include <string.h>
#include <unistd.h>

#include "compare/compare.h"

enum { WIDTH = 12, HEIGHT = 8, COUNT = WIDTH * HEIGHT };
#define ARENA_BYTES ((size_t)1 << 30)

/* A frame whose red is i, green i / 2, blue 1, with metadata and a layer of a display. */
static inline Subject frame_subject(const char *name, Arena *arena)
{
    FrameImage frame = frame_create(WIDTH, HEIGHT, (ExrWindow){0, 0, WIDTH, HEIGHT}, 5, 8,
                                    arena);
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
    return (Subject){.name = name, .kind = SUBJECT_FRAME, .has_metadata = true,
                     .light = {WIDTH, HEIGHT, {r, g, b}}, .frame = frame};
}

static inline float *channel(const Subject *subject, const char *name)
{
    for (int i = 0; i < subject->frame.channel_count; i++)
        if (!strcmp(subject->frame.channels[i].name, name))
            return subject->frame.channels[i].values;
    fail_msg("no channel %s", name);
    return NULL;
}

static inline Subject picture_subject(const char *name, int bits, Arena *arena)
{
    Subject subject = {.name = name, .kind = SUBJECT_PICTURE, .bits = bits,
                       .light = {WIDTH, HEIGHT, {NULL}}, .codes = {WIDTH, HEIGHT, {NULL}}};
    for (int c = 0; c < 3; c++) {
        float *codes = ARENA_NEW(arena, float, COUNT), *light = ARENA_NEW(arena, float, COUNT);
        for (int i = 0; i < COUNT; i++) {
            codes[i] = (float)((i * 5 + c) % 256) / 255;
            light[i] = linear_from_srgb(codes[i]);
        }
        subject.codes.rgb[c] = codes;
        subject.light.rgb[c] = light;
    }
    return subject;
}

static inline Comparison compared(const Subject *a, const Subject *b, CompareOptions options,
                           Arena *arena)
{
    Comparison c;
    Error      err = {0};
    options.threads = 1;
    if (!compare_subjects(a, b, &options, arena, &c, &err)) fail_msg("%s", err.text);
    return c;
}

static inline void assert_reason(const Comparison *c, const char *part)
{
    assert_false(c->same);
    for (int i = 0; i < c->reasons.count; i++)
        if (strstr(c->reasons.list[i], part)) return;
    fail_msg("no reason has \"%s\"; the verdict is \"%s\"", part, c->verdict);
}

static inline bool has_note(const Comparison *c, const char *part)
{
    for (int i = 0; i < c->notes.count; i++)
        if (strstr(c->notes.list[i], part)) return true;
    return false;
}

/* Nothing but what fails whatever the limits are. */
static const Threshold ANYTHING = {METRIC_DIFFERING, 1};
static const CompareOptions LOOSE = {.groups = GROUP_MSE, .thresholds = &ANYTHING,
                                     .threshold_count = 1};

static inline const char *temporary(const char *name, Arena *arena)
{
    return arena_format(arena, "%s/parhelion-compare-%d-%s", P_tmpdir, (int)getpid(), name);
}
