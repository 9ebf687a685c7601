/* SPDX-License-Identifier: Apache-2.0 */
/* channels.h -- every channel of two sides, value by value: what differs, what is no number.
 *
 * NaN and infinity in light are a fault on whichever side, even on both. In layers of the first
 * surface (display.*, depth, position, normal, albedo, uv) they mean "nothing there" and must
 * stand at the same places; frames whose paths differ (another seed, other instructions) may
 * disagree at the rim of a surface, where one pixel was hit by a few samples only. In layers of
 * the noise itself (variance, halves, display.halves) they mean "too few samples".
 *
 * Memory   from the arena. Threads: pure.
 */
#pragma once
#include "compare/selection.h"
#include "compare/structure.h"

typedef struct ChannelDifference {
    const char *name;
    long differing;    /* pixels whose values are not equal */
    long nonfinite[2]; /* of light: in the reference, in the test */
    int first[2][2];   /* x, y of the first of those, each side */
    long gaps;         /* NaN or infinity on one side only, which nothing excuses */
    long finite;       /* values that are so on both sides */
    double max, mean;  /* of |test - reference| where both are finite */
} ChannelDifference;

typedef struct ChannelDifferences {
    ChannelDifference *list;
    int count;
    long differing;   /* pixels of which some channel differs */
    long left_out[2]; /* pixels without finite light that do not count: see mask */
    long outside;     /* values that differ outside of the display window */
} ChannelDifferences;

/* Of pictures, band by band: `count` pixels of both, whose differs is scratch of as many bytes, 0;
 * counts: their mask. */
ChannelDifferences channels_start(int count, Arena *arena);
void channels_add_codes(const CodeRows sides[2], PixelMask counts, size_t count,
                        const CompareRules *rules, unsigned char *differs, ChannelDifferences *all);
void channels_end(ChannelDifferences *all);

/* Of frames that have the same pixels. Only channels that both have are looked at. */
ChannelDifferences channels_compare(const CompareInput *reference, const CompareInput *test,
                                    const Structure *structure, const CompareRules *rules,
                                    const Selection *selection, Arena *arena);

/* Reasons for what always fails; a note for what lies outside the selection. *structural: how
 * many reasons there are before those of gaps in layers. */
void channels_report(const ChannelDifferences *channels, Lines *reasons, Lines *notes,
                     int *structural);
