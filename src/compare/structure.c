/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/structure.h"

#include <string.h>

#include "compare/metadata_report.h"
#include "compare/statistic/noisy_pair.h"

/* ---- sizes and windows ------------------------------------------------------------------- */

static bool same_window(ExrWindow a, ExrWindow b)
{
    return a.x0 == b.x0 && a.y0 == b.y0 && a.x1 == b.x1 && a.y1 == b.y1;
}

static bool compare_window(const char *what, ExrWindow a, ExrWindow b, Lines *reasons)
{
    if (same_window(a, b)) return true;
    lines_add(reasons, "the %s windows differ: %d,%d,%d,%d in the reference, %d,%d,%d,%d in "
              "the test", what, a.x0, a.y0, a.x1, a.y1, b.x0, b.y0, b.x1, b.y1);
    return false;
}

static bool compare_sizes(const CompareInput *reference, const CompareInput *test,
                          Lines *reasons)
{
    const Planes *a = &reference->light, *b = &test->light;
    bool          ok = a->width == b->width && a->height == b->height;
    if (!ok)
        lines_add(reasons, "the sizes differ: %dx%d pixels in the reference, %dx%d in the test",
                  a->width, a->height, b->width, b->height);
    if (reference->kind != INPUT_FRAME) return ok;
    const FrameImage *f = &reference->frame, *g = &test->frame;
    bool display_ok = !ok || compare_window("display", f->display, g->display, reasons);
    bool data_ok = !ok || compare_window("data", f->data, g->data, reasons);
    return ok && display_ok && data_ok;
}

/* ---- channels ---------------------------------------------------------------------------- */

static bool has_beginning(const FrameImage *frame, const char *beginning, size_t length)
{
    for (int i = 0; i < frame->channel_count; i++)
        if (!strncmp(frame->channels[i].name, beginning, length)) return true;
    return false;
}

/* The letters of what the other frame has nothing of: "light", or "light.sun" when it has other
 * lights, or the whole name. */
static size_t missing_length(const char *channel, const FrameImage *other)
{
    for (const char *dot = strchr(channel, '.'); dot; dot = strchr(dot + 1, '.')) {
        size_t length = (size_t)(dot - channel);
        if (!has_beginning(other, channel, length + 1)) return length;
    }
    return strlen(channel);
}

/* Names of `from` that `other` lacks, with commas, "" when there is none: layers, or channels
 * of the picture itself, which have no dot. */
static const char *missing(const FrameImage *from, const FrameImage *other, bool wants_layers,
                           const CompareRules *rules, Arena *arena)
{
    const char *names = "", *last = "";
    for (int i = 0; i < from->channel_count; i++) {
        const char *name = from->channels[i].name;
        if (frame_channel(other, name) || metadata_ignores(rules, name)) continue;
        if (!strchr(name, '.') == wants_layers) continue;
        name = arena_string(arena, name, missing_length(name, other));
        if (!strcmp(name, last)) continue; /* channels of a layer stand together */
        names = arena_format(arena, "%s%s%s", names, names[0] ? ", " : "", name);
        last = name;
    }
    return names;
}

static void compare_layers(const CompareInput *reference, const CompareInput *test,
                           const CompareRules *rules, Arena *arena, Lines *to)
{
    const char *gone = missing(&reference->frame, &test->frame, true, rules, arena);
    const char *more = missing(&test->frame, &reference->frame, true, rules, arena);
    if (!gone[0] && !more[0]) return;
    lines_add(to, "layers that are not compared: %s%s%s%s%s%s",
              gone[0] ? "only the reference has " : "", gone, gone[0] && more[0] ? "; " : "",
              more[0] ? "only the test has " : "", more, rules->strict ? " (--strict)" : "");
}

static void compare_channels(const CompareInput *reference, const CompareInput *test,
                             const CompareRules *rules, Arena *arena, Lines *reasons)
{
    const char *gone = missing(&reference->frame, &test->frame, false, rules, arena);
    const char *more = missing(&test->frame, &reference->frame, false, rules, arena);
    if (gone[0]) lines_add(reasons, "channels are missing in the test: %s", gone);
    if (more[0]) lines_add(reasons, "channels are missing in the reference: %s", more);
}

static void compare_pictures(const CompareInput *reference, const CompareInput *test,
                             const CompareRules *rules, Lines *reasons, Lines *notes)
{
    if (reference->bits != test->bits)
        lines_add(notes, "the reference has %d bits, the test %d: codes are compared as "
                  "fractions", reference->bits, test->bits);
    if (reference->has_alpha != test->has_alpha && !metadata_ignores(rules, "A"))
        lines_add(reasons, "only the %s is transparent in places (--ignore A leaves that out)",
                  reference->has_alpha ? "reference" : "test");
}

/* ---- both ------------------------------------------------------------------------------- */

Structure structure_compare(const CompareInput *reference, const CompareInput *test,
                            const CompareRules *rules, Arena *arena, Lines *reasons,
                            Lines *notes)
{
    Structure out = {.same_pixels = compare_sizes(reference, test, reasons)};
    if (reference->kind == INPUT_PICTURE) {
        compare_pictures(reference, test, rules, reasons, notes);
        return out;
    }
    compare_channels(reference, test, rules, arena, reasons);
    compare_layers(reference, test, rules, arena, rules->strict ? reasons : notes);
    out.shares_noise = noisy_pair_shares_noise(&reference->frame, &test->frame);
    if (reference->has_metadata && test->has_metadata) {
        out.metadata = metadata_compare(&reference->frame, &test->frame, rules, arena,
                                        &out.metadata_count);
        metadata_report(out.metadata, out.metadata_count, rules->strict, reasons, notes);
    } else {
        lines_add(notes, "%s carries no metadata and no unit: its light is taken for cd/m2",
                  reference->has_metadata ? "the test" : "the reference");
    }
    return out;
}
