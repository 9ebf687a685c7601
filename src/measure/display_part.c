/* SPDX-License-Identifier: Apache-2.0 */
#include "measure/display_part.h"

#include <math.h>
#include <string.h>

static int display_count(const FrameImage *frame) {
    static const char PREFIX[] = "parhelion:display.";
    int count = 0;
    for (int i = 0; i < frame->attribute_count; i++)
        count += !strncmp(frame->attributes[i].name, PREFIX, sizeof PREFIX - 1);
    return count;
}

static bool find_second(const FrameImage *frame, DisplayLayers *out) {
    out->second_id = frame_channel(frame, "id.second");
    out->second_coverage = frame_channel(frame, "display.second.coverage");
    return out->second_id && out->second_coverage &&
           frame_rgb(frame, "display.second", out->second) &&
           frame_rgb(frame, "display.second.variance", out->second_variance);
}

bool display_layers_find(const FrameImage *frame, DisplayLayers *out) {
    *out = (DisplayLayers){.id = frame_channel(frame, "id.display"),
                           .coverage = frame_channel(frame, "display.coverage"),
                           .samples = frame_channel(frame, "samples.N")};
    if (!out->id || !out->coverage || !out->samples ||
        !frame_rgb(frame, "display.emitted", out->emitted) ||
        !frame_rgb(frame, "display.reflected", out->reflected) ||
        !frame_rgb(frame, "display.variance", out->variance))
        return false;
    if (display_count(frame) > 1) return find_second(frame, out);
    out->second_id = NULL;
    return true;
}

/* ---- a pixel ----------------------------------------------------------------------------- */

/* Light of some samples of a pixel: how many they are, their mean, and their squares about it.
 */
typedef struct PartShare {
    double samples, mean[3], squares[3];
} PartShare;

/* variance: of the mean; NaN: of one sample. */
static PartShare share_of(double samples, const double mean[3], const float *const variance[3],
                          size_t i) {
    PartShare share = {.samples = samples};
    for (int c = 0; c < 3; c++) {
        double of = (double)variance[c][i];
        share.mean[c] = mean[c];
        share.squares[c] = isnan(of) ? 0 : of * samples * (samples - 1);
    }
    return share;
}

static PartShare whole_share(const DisplayLayers *layers, size_t i) {
    double mean[3];
    for (int c = 0; c < 3; c++)
        mean[c] = (double)layers->emitted[c][i] + (double)layers->reflected[c][i];
    return share_of((double)layers->coverage[i] * (double)layers->samples[i], mean,
                    layers->variance, i);
}

static PartShare second_share(const DisplayLayers *layers, size_t i) {
    double mean[3];
    for (int c = 0; c < 3; c++) mean[c] = (double)layers->second[c][i];
    return share_of((double)layers->second_coverage[i] * (double)layers->samples[i], mean,
                    layers->second_variance, i);
}

/* What is left of `all` without `other`. Squares about the common mean are those about both
 * means and what lies between these. */
static PartShare share_without(const PartShare *all, const PartShare *other) {
    PartShare left = {.samples = all->samples - other->samples};
    for (int c = 0; c < 3; c++) {
        double a = all->mean[c], b = other->mean[c];
        double mean = (all->samples * a - other->samples * b) / left.samples;
        double between = left.samples * mean * mean + other->samples * b * b - all->samples * a * a;
        left.mean[c] = mean;
        left.squares[c] = fmax(all->squares[c] - other->squares[c] - between, 0);
    }
    return left;
}

static DisplayPart part_of(const PartShare *share, double n) {
    double coverage = share->samples / n;
    DisplayPart part = {.coverage = coverage, .spread = coverage * (1 - coverage) / (n - 1)};
    if (n < 2) part.spread = NAN;
    for (int c = 0; c < 3; c++) {
        part.rgb[c] = share->mean[c];
        part.scatter[c] = n < 2 ? (double)NAN : share->squares[c] / (n * (n - 1));
    }
    return part;
}

DisplayPart display_part(const DisplayLayers *layers, size_t i, int id) {
    float second_id = layers->second_id ? layers->second_id[i] : -1;
    bool is_first = layers->id[i] == (float)id, is_second = second_id == (float)id;
    if (id < 0 || (!is_first && !is_second) || !(layers->coverage[i] > 0)) return (DisplayPart){0};
    if (second_id < -1) return (DisplayPart){.is_shared = true, .is_unknown = true};
    double n = (double)layers->samples[i];
    PartShare share = whole_share(layers, i);
    if (second_id < 0) return part_of(&share, n);
    PartShare other = second_share(layers, i), first = share_without(&share, &other);
    DisplayPart part = part_of(is_first ? &first : &other, n);
    for (int c = 0; c < 3; c++) { /* what channels in single precision leave of a difference */
        double rounding = 0x1p-23 * (double)layers->coverage[i] * share.mean[c];
        part.scatter[c] += rounding * rounding;
    }
    part.is_shared = true;
    return part;
}

/* ---- a frame ----------------------------------------------------------------------------- */

/* A copy in its place; NULL: there is none. */
static float *new_channel(FrameImage *frame, const char *name, Arena *arena) {
    for (int i = 0; i < frame->channel_count; i++) {
        if (strcmp(frame->channels[i].name, name) != 0) continue;
        float *values = ARENA_NEW(arena, float, frame_pixel_count(frame));
        memcpy(values, frame->channels[i].values, frame_pixel_count(frame) * sizeof *values);
        frame->channels[i].values = values;
        return values;
    }
    return NULL;
}

/* One channel of R, G, B and of what states its noise. Pixels that show the display alone keep
 * their halves; the others have the root of their variance, which has the same expectation. */
static void fill_channel(const DisplayLayers *layers, int id, int c, size_t count,
                         float *const to[3]) {
    for (size_t i = 0; i < count; i++) {
        DisplayPart part = display_part(layers, i, id);
        double mean = part.rgb[c];
        double variance = part.scatter[c] + part.spread * mean * mean;
        bool is_alone = part.coverage == 1 && !part.is_shared;
        to[0][i] = part.is_unknown ? NAN : (float)(part.coverage * mean);
        to[1][i] = (float)variance;
        if (to[2] && !is_alone) to[2][i] = (float)sqrt(variance);
    }
}

FrameImage display_part_frame(const FrameImage *frame, const DisplayLayers *layers, int id,
                              Arena *arena) {
    static const char *const NAMES[3][3] = {{"R", "variance.R", "halves.R"},
                                            {"G", "variance.G", "halves.G"},
                                            {"B", "variance.B", "halves.B"}};
    FrameImage out = *frame;
    out.channel_room = frame->channel_count + 3;
    out.channels = ARENA_NEW(arena, ExrChannel, out.channel_room);
    memcpy(out.channels, frame->channels, (size_t)frame->channel_count * sizeof *out.channels);
    for (int c = 0; c < 3; c++) {
        float *to[3];
        for (int k = 0; k < 3; k++) to[k] = new_channel(&out, NAMES[c][k], arena);
        if (!to[1]) to[1] = frame_add_channel(&out, NAMES[c][1], false, arena);
        if (to[0]) fill_channel(layers, id, c, frame_pixel_count(frame), to);
    }
    return out;
}
