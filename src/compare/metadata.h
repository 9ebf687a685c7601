/* SPDX-License-Identifier: Apache-2.0 */
/* metadata.h -- the attributes of two frames side by side, and what a comparison leaves out.
 *
 * Memory   texts come from the arena that is passed in. Threads: pure. Fails: never.
 */
#pragma once
#include "image/frame.h"

typedef struct CompareRules {
    const char *const *ignored; /* metadata keys, channels, layers: left out */
    int ignored_count;
    bool strict; /* every difference of metadata is a reason */
} CompareRules;

/* One metadata key of either side. */
typedef struct MetadataRow {
    const char *name;
    const char *reference, *test; /* NULL where there is none */
    bool differs, decides, is_ignored;
} MetadataRow;

/* Does one of the rules leave this channel or key out? A layer's name means all its channels,
 * and "parhelion:" may be left out. */
bool metadata_ignores(const CompareRules *rules, const char *name);

/* Every key of either frame, once each, those of the reference first. */
MetadataRow *metadata_compare(const FrameImage *reference, const FrameImage *test,
                              const CompareRules *rules, Arena *arena, int *count);
