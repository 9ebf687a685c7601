/* SPDX-License-Identifier: Apache-2.0 */
/* text_blocks.h -- matrices over one polar grid, one a quantity, as rows of a table.
 *
 * Memory   the arena's. Threads: one scan each.
 */
#pragma once
#include "import/text/text_options.h"
#include "import/text/text_rows.h"

#define TEXT_BLOCKS_MAX 512

typedef struct TextBlock {
    ColumnName name; /* QUANTITY_NONE: no label */
    const char *label;
    const char *corner;
    int line;      /* index of its head */
    double *angle; /* of the head: across */
    TextRows down; /* the angle of each, then its values */
} TextBlock;

typedef struct TextBlocks {
    const TextFile *text;
    const TextOptions *options;
    Arena *arena;
    TextBlock *block; /* TEXT_BLOCKS_MAX of them once there is one */
    int count, across;
    ColumnName label; /* of the block to come */
    const char *label_text;
} TextBlocks;

/* "[X]", "Luminance (cd/m2)": the label of the next block. */
bool text_blocks_label(TextBlocks *blocks, const TextCell *cell, int count);

/* A matrix begins: its corner and the angles across. */
bool text_blocks_begin(TextBlocks *blocks, const TextCell *cell, int count, char decimal, int line,
                       Error *err);

/* Room for the next row of the current block: its angle and its values. NULL: too many. */
double *text_blocks_row(TextBlocks *blocks, int line, Error *err);

/* Checks that all blocks have one grid and makes rows of them: theta, phi, quantities. */
bool text_blocks_finish(TextBlocks *blocks, NamedRows *out, Error *err);
