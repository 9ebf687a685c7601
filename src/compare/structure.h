/* structure.h -- what two sides are made of: sizes, windows, channels, metadata.
 *
 * Differences that change what the picture shows are reasons to fail; those that explain it
 * (program, seed, samples, instruction set, command line, inputs) are notes, unless `strict`.
 *
 * Memory   texts come from the arena that is passed in. Threads: pure.
 * Fails    never: what differs is said.
 */
#pragma once
#include "compare/lines.h"
#include "compare/input.h"

typedef struct StructureRules {
    const char *const *ignored; /* metadata keys, channels, layers: left out */
    int  ignored_count;
    bool strict; /* every difference of metadata is a reason */
} StructureRules;

/* One metadata key of either side. */
typedef struct MetadataRow {
    const char *name;
    const char *reference, *test; /* NULL where there is none */
    bool        differs, decides, is_ignored;
} MetadataRow;

typedef struct Structure {
    bool         same_pixels; /* one size, and frames one data window */
    bool         shares_noise; /* frames that say so: one seed and the same samples */
    MetadataRow *metadata;
    int          metadata_count;
} Structure;

Structure structure_compare(const Subject *reference, const Subject *test,
                            const StructureRules *rules, Arena *arena, Lines *reasons,
                            Lines *notes);

/* Does one of the rules leave this channel or key out? A layer's name means all its channels,
 * and "parhelion:" need not be said. */
bool structure_ignores(const StructureRules *rules, const char *name);
