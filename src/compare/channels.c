/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/channels.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Two planes of one channel, and how to look at them. */
typedef struct Pair {
    const float *values[2];
    size_t count;
    int row;                 /* values in a row */
    const FrameImage *frame; /* NULL: value i is pixel i */
    int width;               /* pixels of a row of the display window */
    bool is_light, is_noise, excuses_rims;
} Pair;

static bool is_one_of(const char *name, const char *const *layers, int count) {
    for (int i = 0; i < count; i++) {
        size_t length = strlen(layers[i]);
        if (!strncmp(name, layers[i], length) && (!name[length] || name[length] == '.'))
            return true;
    }
    return false;
}

/* NaN is no fault in layers of the first surface: there may be none. */
static bool is_surface_layer(const char *name) {
    static const char *const LAYERS[] = {"display", "depth", "position", "normal",
                                         "albedo",  "uv",    "Z",        "ZBack"};
    return is_one_of(name, LAYERS, sizeof LAYERS / sizeof *LAYERS);
}

static bool is_noise_layer(const char *name) {
    static const char *const LAYERS[] = {"variance", "halves", "display.halves", "display.variance",
                                         "display.second.variance"};
    return is_one_of(name, LAYERS, sizeof LAYERS / sizeof *LAYERS);
}

/* Is there a value beside value i that is finite (or, wanting a gap, is not)? */
static bool has_beside(const Pair *pair, const float *values, size_t i, bool wants_finite) {
    int x = (int)(i % (size_t)pair->row), y = (int)(i / (size_t)pair->row);
    int rows = (int)(pair->count / (size_t)pair->row);
    for (int v = y > 0 ? y - 1 : 0; v <= y + 1 && v < rows; v++)
        for (int u = x > 0 ? x - 1 : 0; u <= x + 1 && u < pair->row; u++)
            if (!!isfinite(values[(size_t)v * (size_t)pair->row + (size_t)u]) == wants_finite)
                return true;
    return false;
}

/* The rim of a surface runs through or beside this pixel on either side: chance decides whether
 * a sample hits it. The inside of a surface that came or went is no rim. */
static bool is_rim(const Pair *pair, size_t i) {
    int missing = isfinite(pair->values[0][i]) ? 1 : 0;
    return has_beside(pair, pair->values[missing], i, true) ||
           has_beside(pair, pair->values[1 - missing], i, false);
}

/* Or NaN both. */
static bool same_gap(float a, float b) {
    return isnan(a) ? isnan(b) : a == b;
}

/* A value that is not finite on some side; true when the pixel counts as different. */
static bool add_gap(const Pair *pair, size_t i, long place, ChannelDifference *out) {
    float a = pair->values[0][i], b = pair->values[1][i];
    if (pair->is_light) {
        for (int side = 0; side < 2; side++) {
            if (isfinite(side ? b : a)) continue;
            if (out->nonfinite[side]++ > 0) continue;
            out->first[side][0] = (int)(place % pair->width);
            out->first[side][1] = (int)(place / pair->width);
        }
        return true;
    }
    if (same_gap(a, b)) return false;
    bool is_excused = pair->excuses_rims && (pair->is_noise || is_rim(pair, i));
    if (!is_excused) out->gaps++;
    return true;
}

/* differs: one byte a place. */
static void add_values(const Pair *pair, PixelMask counts, unsigned char *differs,
                       ChannelDifference *out, ChannelDifferences *all) {
    for (size_t i = 0; i < pair->count; i++) {
        long place = pair->frame ? selection_place(pair->frame, i) : (long)i;
        float a = pair->values[0][i], b = pair->values[1][i];
        bool is_finite = isfinite(a) && isfinite(b);
        if (place < 0) {
            all->outside += !same_gap(a, b);
            continue;
        }
        if (!counts[place]) {
            all->left_out[0] += pair->is_light && !isfinite(a);
            all->left_out[1] += pair->is_light && !isfinite(b);
            continue;
        }
        bool is_different = is_finite ? a != b : add_gap(pair, i, place, out);
        if (is_finite) {
            double distance = fabs((double)b - (double)a);
            out->mean += distance;
            out->max = fmax(out->max, distance);
            out->finite++;
        }
        out->differing += is_different;
        if (is_different) differs[place] = 1;
    }
}

/* ---- the channels of frames and of pictures ---------------------------------------------- */

static Pair frame_pair(const CompareInput *reference, const CompareInput *test, const char *name,
                       const Structure *structure) {
    const FrameImage *f = &reference->frame;
    return (Pair){{frame_channel(f, name), frame_channel(&test->frame, name)},
                  frame_pixel_count(f),
                  f->data.x1 - f->data.x0,
                  f,
                  reference->light.width,
                  !is_surface_layer(name) && !is_noise_layer(name),
                  is_noise_layer(name),
                  !structure->shares_paths};
}

ChannelDifferences channels_start(int count, Arena *arena) {
    return (ChannelDifferences){.list = ARENA_NEW(arena, ChannelDifference, count)};
}

void channels_end(ChannelDifferences *all) {
    for (int i = 0; i < all->count; i++) all->list[i].mean /= fmax((double)all->list[i].finite, 1);
}

ChannelDifferences channels_compare(const CompareInput *reference, const CompareInput *test,
                                    const Structure *structure, const CompareRules *rules,
                                    const Selection *selection, Arena *arena) {
    ChannelDifferences out = channels_start(reference->frame.channel_count, arena);
    size_t pixels = planes_pixel_count(&reference->light);
    Arena scratch = *arena;
    unsigned char *differs = ARENA_NEW(&scratch, unsigned char, pixels);
    for (int i = 0; i < reference->frame.channel_count; i++) {
        const char *name = reference->frame.channels[i].name;
        Pair pair = frame_pair(reference, test, name, structure);
        if (!pair.values[1] || metadata_ignores(rules, name)) continue;
        ChannelDifference *to = &out.list[out.count++];
        to->name = name;
        add_values(&pair, selection->counts, differs, to, &out);
    }
    for (size_t i = 0; i < pixels; i++) out.differing += differs[i];
    channels_end(&out);
    return out;
}

void channels_add_codes(const CodeRows sides[2], PixelMask counts, size_t count,
                        const CompareRules *rules, unsigned char *differs,
                        ChannelDifferences *all) {
    static const char *const NAMES[4] = {"R", "G", "B", "A"};
    int n = 0;
    for (int c = 0; c < 4; c++) {
        Pair pair = {.count = count, .width = sides[0].codes.width, .is_light = true};
        for (int k = 0; k < 2; k++) pair.values[k] = c < 3 ? sides[k].codes.rgb[c] : sides[k].alpha;
        if (!pair.values[0] || !pair.values[1] || metadata_ignores(rules, NAMES[c])) continue;
        all->list[n].name = NAMES[c];
        add_values(&pair, counts, differs, &all->list[n++], all);
    }
    all->count = n;
    for (size_t i = 0; i < count; i++) all->differing += differs[i];
}

static void report_nonfinite(const ChannelDifference *c, Lines *reasons) {
    static const char *const SIDES[2] = {"reference", "test"};
    for (int side = 0; side < 2; side++)
        if (c->nonfinite[side])
            lines_add(reasons,
                      "channel %s has %ld values in the %s that are NaN or infinite, "
                      "the first at pixel %d,%d",
                      c->name, c->nonfinite[side], SIDES[side], c->first[side][0],
                      c->first[side][1]);
}

/* All channels of a kind of surface have the same gaps: they are reported together. */
static void report_gaps(const ChannelDifferences *channels, Lines *reasons) {
    char names[256] = "";
    long most = 0;
    int count = 0;
    size_t length = 0;
    for (int i = 0; i < channels->count; i++) {
        const ChannelDifference *c = &channels->list[i];
        if (!c->gaps) continue;
        if (length + strlen(c->name) + 8 < sizeof names)
            length += (size_t)snprintf(names + length, sizeof names - length, "%s%s",
                                       count ? ", " : "", c->name);
        most = c->gaps > most ? c->gaps : most;
        count++;
    }
    if (count)
        lines_add(reasons,
                  "%d channel%s NaN or infinite on one side only, in up to %ld "
                  "pixels: %s",
                  count, count > 1 ? "s are" : " is", most, names);
}

void channels_report(const ChannelDifferences *channels, Lines *reasons, Lines *notes,
                     int *structural) {
    for (int i = 0; i < channels->count; i++) report_nonfinite(&channels->list[i], reasons);
    *structural = reasons->count;
    report_gaps(channels, reasons);
    if (channels->outside)
        lines_add(notes,
                  "%ld values outside of the display window differ, which no figure "
                  "counts",
                  channels->outside);
    if (channels->left_out[0] || channels->left_out[1])
        lines_add(notes,
                  "%ld values of the reference and %ld of the test are NaN or infinite "
                  "in pixels that do not count",
                  channels->left_out[0], channels->left_out[1]);
}
