/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/statistic/statistic_blocks.h"

#include <math.h>

static BlockGrid make_grid(int width, int height, int side, Arena *arena)
{
    BlockGrid grid = {side, (width + side - 1) / side, (height + side - 1) / side, NULL};
    grid.sums = arena_alloc(arena, sizeof *grid.sums, _Alignof(SignFlipSum),
                            (size_t)grid.columns * (size_t)grid.rows);
    return grid;
}

static size_t block_count(const BlockGrid *grid)
{
    return (size_t)grid->columns * (size_t)grid->rows;
}

static void add_pixel(const NoisyPair *pair, int x, int y, SignFlipSum sums[3])
{
    if (!noisy_pair_counts(pair, x, y)) return;
    for (int c = 0; c < 3; c++) {
        NoisyNumber number;
        if (noisy_pair_number(pair, noisy_pair_index(pair, x, y), (NoisyChannel)c, 1, &number))
            sign_flip_add(&sums[c], &number, 1);
    }
}

static void add_pixels(const NoisyPair *pair, int width, int height, BlockGrid *grid)
{
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            add_pixel(pair, x, y, grid->sums[y / grid->side * grid->columns + x / grid->side]);
}

void statistic_blocks(const NoisyPair *pair, Arena *arena, BlockGrid grids[2])
{
    int width = pair->data.x1 - pair->data.x0, height = pair->data.y1 - pair->data.y0;
    grids[0] = make_grid(width, height, BLOCK_SIDE, arena);
    grids[1] = make_grid(width, height, BLOCK_SIDE * WIDE_BLOCK, arena);
    add_pixels(pair, width, height, &grids[0]);
    for (int y = 0; y < grids[0].rows; y++)
        for (int x = 0; x < grids[0].columns; x++) {
            SignFlipSum *to = grids[1].sums[y / WIDE_BLOCK * grids[1].columns + x / WIDE_BLOCK];
            for (int c = 0; c < 3; c++)
                sign_flip_join(&to[c], &grids[0].sums[y * grids[0].columns + x][c]);
        }
}

/* ---- single blocks ----------------------------------------------------------------------- */

float statistic_block_p(const BlockGrid *grid, int index, NoiseLaw law)
{
    double least = 1;
    for (int c = 0; c < 3; c++) least = fmin(least, sign_flip_p(&grid->sums[index][c], law));
    return grid->sums[index][0].count ? (float)least : NAN;
}

static void find_least(const BlockGrid grids[2], NoiseLaw law, BlockFinding *out)
{
    out->least = 2;
    for (int g = 0; g < 2; g++)
        for (size_t i = 0; i < block_count(&grids[g]); i++)
            for (int c = 0; c < 3; c++) {
                if (!grids[g].sums[i][c].count) continue;
                double p = sign_flip_p(&grids[g].sums[i][c], law);
                out->tests++;
                if (!(p < out->least)) continue;
                out->least = p;
                out->grid = g;
                out->index = (int)i;
                out->channel = c;
            }
}

static double count_failed(const BlockGrid grids[2], NoiseLaw law, double level)
{
    double failed = 0;
    for (int g = 0; g < 2; g++)
        for (size_t i = 0; i < block_count(&grids[g]); i++)
            for (int c = 0; c < 3; c++)
                failed += sign_flip_p(&grids[g].sums[i][c], law) < level;
    return failed;
}

/* ---- all of them ------------------------------------------------------------------------- */

/* The sum over blocks of the mean over channels of the quotient's square. Its expectation is
 * the number of blocks; its variance at most the sum of each block's largest. */
typedef struct Squares {
    double blocks, sum, variance;
} Squares;

static void add_squares(const SignFlipSum sums[3], NoiseLaw law, Squares *to)
{
    double squares = 0, variance = 0, channels = 0;
    for (int c = 0; c < 3; c++) {
        if (!(sums[c].square > 0)) continue;
        double quotient = sign_flip_quotient(&sums[c], law);
        squares += quotient * quotient;
        variance = fmax(variance, sign_flip_square_variance(&sums[c]));
        channels++;
    }
    if (channels == 0) return;
    to->blocks++;
    to->sum += squares / channels;
    to->variance += variance;
}

static Squares squares_of_grid(const BlockGrid *grid, NoiseLaw law)
{
    Squares out = {0, 0, 0};
    for (size_t i = 0; i < block_count(grid); i++) add_squares(grid->sums[i], law, &out);
    return out;
}

static double p_of_squares(Squares squares)
{
    return gamma_tail(squares.sum, squares.blocks, squares.variance);
}

BlockFinding statistic_block_finding(const BlockGrid grids[2], NoiseLaw law, double level)
{
    BlockFinding out = {.mean_square = NAN};
    Squares      small = squares_of_grid(&grids[0], law);
    double       least = p_of_squares(small);
    find_least(grids, law, &out);
    out.p_least = out.tests > 0 ? sidak_p(out.least, out.tests) : 1;
    if (out.tests > 0)
        out.failed = count_failed(grids, law, sidak_level(level, out.tests));
    if (small.blocks > 0) out.mean_square = small.sum / small.blocks;
    least = fmin(least, p_of_squares(squares_of_grid(&grids[1], law)));
    out.p_squares = sidak_p(least, 2);
    return out;
}
