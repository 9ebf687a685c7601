/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/statistic/statistic.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "compare/statistic/statistic_blocks.h"
#include "compare/statistic/statistic_reason.h"
#include "compare/statistic/statistic_regions.h"

#define LEVEL 0.01
#define FAMILIES 3

static void count_pixels(const NoisyPair *pair, StatisticResult *out, bool *is_equal)
{
    int width = pair->data.x1 - pair->data.x0, height = pair->data.y1 - pair->data.y0;
    *is_equal = true;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            if (!noisy_pair_counts(pair, x, y)) continue;
            size_t i = noisy_pair_index(pair, x, y);
            out->pixels++;
            out->differing += noisy_pair_differs(pair, i);
            for (int c = 0; c < 3; c++)
                if (memcmp(&pair->side[0].light[c][i], &pair->side[1].light[c][i],
                           sizeof(float)) != 0)
                    *is_equal = false;
        }
}

static void make_map(const BlockGrid *grid, NoiseLaw law, Arena *arena, StatisticResult *out)
{
    int count = grid->columns * grid->rows;
    out->block_side = grid->side;
    out->blocks_x = grid->columns;
    out->blocks_y = grid->rows;
    out->block_p = ARENA_NEW(arena, float, count);
    for (int i = 0; i < count; i++) out->block_p[i] = statistic_block_p(grid, i, law);
}

/* Names the layers that would make the test more sensitive. */
static void take_note(const NoisyPair *pair, char *note, size_t size)
{
    if (!pair->knows_samples)
        snprintf(note, size, "the frames do not say how many samples they have: their noise is "
                             "taken to be of two shapes; --layers samples tells");
    else if (!pair->law.is_same && !pair->law.has_variance)
        snprintf(note, size, "the frames have different sample counts and no layer variance: "
                             "what few samples missed is not known; --layers variance tells");
    else if (!pair->law.is_same && !pair->has_halves)
        snprintf(note, size, "the frames have different sample counts and no layer halves: "
                             "their noise is taken to be that of independent samples, which is "
                             "more than it is; --layers halves tells");
}

bool statistic_compare(const FrameImage *reference, const FrameImage *test,
                       const StatisticOptions *options, Arena *arena, StatisticResult *out,
                       Error *err)
{
    double          level = options->level > 0 ? options->level : LEVEL;
    double          family_level = sidak_level(level, FAMILIES);
    StatisticResult result = {.verdict = STATISTIC_SAME};
    NoisyPair       pair;
    BlockGrid       grids[2];
    bool            is_equal;
    if (!noisy_pair_open(reference, test, options, &pair, err)) return false;
    result.shares_noise = pair.shares_noise;
    count_pixels(&pair, &result, &is_equal);
    statistic_regions(&pair, reference, family_level, arena, &result);
    statistic_blocks(&pair, arena, grids);
    BlockFinding found = statistic_block_finding(grids, pair.law, family_level);
    make_map(&grids[0], pair.law, arena, &result);
    take_note(&pair, result.note, sizeof result.note);
    result.p_blocks = found.p_least;
    result.p_histogram = found.p_squares;
    result.mean_square = found.mean_square;
    result.fraction_failed = found.tests > 0 ? found.failed / found.tests : 0;
    result.p_value = sidak_p(fmin(fmin(result.p_blocks, result.p_histogram), result.p_regions),
                             FAMILIES);
    if (is_equal)
        result.verdict = STATISTIC_EQUAL;
    else if (result.p_value < level)
        result.verdict = STATISTIC_DIFFERENT;
    statistic_reason(&pair, grids, &found, level, &result);
    *out = result;
    return true;
}
