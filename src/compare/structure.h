/* SPDX-License-Identifier: Apache-2.0 */
/* structure.h -- what two sides are made of: sizes, windows, channels, metadata.
 *
 * Differences that change what the picture shows are reasons to fail; those that explain it
 * (program, seed, samples, instruction set, command line, inputs) and layers that only one side
 * has are a note each, unless `strict`.
 *
 * Memory   texts come from the arena that is passed in. Threads: pure.
 * Fails    never: what differs is reported.
 */
#pragma once
#include "compare/input.h"
#include "base/lines.h"
#include "compare/metadata.h"

typedef struct Structure {
    bool same_pixels;  /* one size, and frames one data window */
    bool shares_paths; /* frames of one seed, the same samples, instructions and
                          program: their paths are the same where the scene is */
    bool shares_field; /* and, where light is, as what guides them is the same, too */
    MetadataRow *metadata;
    int metadata_count;
    bool knows_inputs; /* both frames state them */
    Lines inputs;      /* "night.gltf", "sky.exr (new)", "sky.exr (gone)": those that changed */
    Lines settings;    /* "seed (0, now 1)", "display cluster (level 1, now level 0.8)" */
} Structure;

/* The first of a list with commas, and how many more there are. */
const char *structure_joined(const Lines *list, int most);

Structure structure_compare(const CompareInput *reference, const CompareInput *test,
                            const CompareRules *rules, Arena *arena, Lines *reasons, Lines *notes);
