/* SPDX-License-Identifier: Apache-2.0 */
/* statistic_blocks.h -- the blocks' family of the test: where the mean moved, and whether it
 * did a little everywhere.
 *
 * Memory   from the arena that is passed in.
 * Threads  pure.
 */
#pragma once
#include "base/arena.h"
#include "compare/statistic/noisy_pair.h"

#define BLOCK_SIDE 8
#define WIDE_BLOCK 4 /* blocks along a side of a wide one */

/* Blocks of one size over the data window. */
typedef struct BlockGrid {
    int side;   /* pixels */
    int columns, rows;
    SignFlipSum (*sums)[3]; /* R, G, B; a count of 0: nothing of it counts */
} BlockGrid;

typedef struct BlockFinding {
    int    grid, index, channel; /* of the least p */
    double least;
    double tests, failed; /* blocks x channels, those beyond the corrected level */
    double p_least;       /* after Sidak */
    double p_squares;     /* too many small p */
    double mean_square;   /* over the small blocks' quotients */
} BlockFinding;

/* grids: small blocks and wide ones. */
void statistic_blocks(const NoisyPair *pair, Arena *arena, BlockGrid grids[2]);
BlockFinding statistic_block_finding(const BlockGrid grids[2], NoiseLaw law, double level);

/* The least p of a block's channels; NaN where nothing counts. */
float statistic_block_p(const BlockGrid *grid, int index, NoiseLaw law);
