/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/statistic/statistic.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "compare/metrics/change.h"
#include "compare/statistic/noisy_pair.h"
#include "compare/statistic/regions.h"

#define LEVEL 0.01
#define FAMILIES 3
#define INTERVAL_PERCENT 196 /* of 95 %, of standard errors */

#define MORE "pixels differ by more than their noise: "

static const char *const CHANNELS[3] = {"red", "green", "blue"};

/* ---- the blocks' families ---------------------------------------------------------------- */

#define BLOCK_SIDE 8
#define WIDE_BLOCK 4 /* blocks along a side of a wide one */

/* Blocks of one size over the data window. */
typedef struct BlockGrid {
    int side; /* pixels */
    int columns, rows;
    SignFlipSum (*sums)[3]; /* R, G, B; a count of 0: nothing of it counts */
} BlockGrid;

typedef struct BlockFinding {
    int grid, index, channel; /* of the least p */
    double least;
    double tests, failed; /* blocks x channels, those beyond the corrected level */
    double p_least;       /* after Sidak */
    double p_squares;     /* too many small p */
    double mean_square;   /* over the small blocks' quotients */
} BlockFinding;

static BlockGrid make_grid(int width, int height, int side, Arena *arena) {
    BlockGrid grid = {side, (width + side - 1) / side, (height + side - 1) / side, NULL};
    grid.sums = arena_alloc(arena, sizeof *grid.sums, _Alignof(SignFlipSum),
                            (size_t)grid.columns * (size_t)grid.rows);
    return grid;
}

static size_t block_count(const BlockGrid *grid) {
    return (size_t)grid->columns * (size_t)grid->rows;
}

static void add_to_block(const NoisyPair *pair, int x, int y, SignFlipSum sums[3]) {
    if (!noisy_pair_counts(pair, x, y)) return;
    for (int c = 0; c < 3; c++) {
        NoisyNumber number;
        if (noisy_pair_number(pair, noisy_pair_index(pair, x, y), (NoisyChannel)c, 1, &number))
            sign_flip_add(&sums[c], &number, 1);
    }
}

static void add_to_blocks(const NoisyPair *pair, int width, int height, BlockGrid *grid) {
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            add_to_block(pair, x, y, grid->sums[y / grid->side * grid->columns + x / grid->side]);
}

/* grids: small blocks and wide ones. */
static void statistic_blocks(const NoisyPair *pair, Arena *arena, BlockGrid grids[2]) {
    int width = pair->data.x1 - pair->data.x0, height = pair->data.y1 - pair->data.y0;
    grids[0] = make_grid(width, height, BLOCK_SIDE, arena);
    grids[1] = make_grid(width, height, BLOCK_SIDE * WIDE_BLOCK, arena);
    add_to_blocks(pair, width, height, &grids[0]);
    for (int y = 0; y < grids[0].rows; y++)
        for (int x = 0; x < grids[0].columns; x++) {
            SignFlipSum *to = grids[1].sums[y / WIDE_BLOCK * grids[1].columns + x / WIDE_BLOCK];
            for (int c = 0; c < 3; c++)
                sign_flip_join(&to[c], &grids[0].sums[y * grids[0].columns + x][c]);
        }
}

/* ---- single blocks ----------------------------------------------------------------------- */

/* The least p of a block's channels; NaN where nothing counts. */
static float statistic_block_p(const BlockGrid *grid, int index, NoiseLaw law) {
    double least = 1;
    for (int c = 0; c < 3; c++) least = fmin(least, sign_flip_p(&grid->sums[index][c], law));
    return grid->sums[index][0].count ? (float)least : NAN;
}

static void find_least(const BlockGrid grids[2], NoiseLaw law, BlockFinding *out) {
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

static double count_failed(const BlockGrid grids[2], NoiseLaw law, double level) {
    double failed = 0;
    for (int g = 0; g < 2; g++)
        for (size_t i = 0; i < block_count(&grids[g]); i++)
            for (int c = 0; c < 3; c++) failed += sign_flip_p(&grids[g].sums[i][c], law) < level;
    return failed;
}

/* ---- all of them ------------------------------------------------------------------------- */

/* The sum over blocks of the mean over channels of the quotient's square. Its expectation is
 * the number of blocks; its variance at most the sum of each block's largest. */
typedef struct Squares {
    double blocks, sum, variance;
} Squares;

static void add_squares(const SignFlipSum sums[3], NoiseLaw law, Squares *to) {
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

static Squares squares_of_grid(const BlockGrid *grid, NoiseLaw law) {
    Squares out = {0, 0, 0};
    for (size_t i = 0; i < block_count(grid); i++) add_squares(grid->sums[i], law, &out);
    return out;
}

static double p_of_squares(Squares squares) {
    return gamma_tail(squares.sum, squares.blocks, squares.variance);
}

static BlockFinding statistic_block_finding(const BlockGrid grids[2], NoiseLaw law, double level) {
    BlockFinding out = {.mean_square = NAN};
    Squares small = squares_of_grid(&grids[0], law);
    double least = p_of_squares(small);
    find_least(grids, law, &out);
    out.p_least = out.tests > 0 ? sidak_p(out.least, out.tests) : 1;
    if (out.tests > 0) out.failed = count_failed(grids, law, sidak_level(level, out.tests));
    if (small.blocks > 0) out.mean_square = small.sum / small.blocks;
    least = fmin(least, p_of_squares(squares_of_grid(&grids[1], law)));
    out.p_squares = sidak_p(least, 2);
    return out;
}

/* ---- the answer in words ----------------------------------------------------------------- */

/* The surest region of displays that moved, since people look for them; else of what moved,
 * else of all. */
static const StatisticRegion *surest_region(const StatisticResult *r) {
    const StatisticRegion *best = &r->regions[0];
    for (int i = 1; i < r->region_count; i++) {
        const StatisticRegion *next = &r->regions[i];
        bool is_first_display = next->moved && best == &r->regions[0];
        bool is_surer = next->moved >= best->moved && next->p_value < best->p_value;
        if (is_first_display || (next->moved && !best->moved) || is_surer) best = next;
    }
    return best;
}

static ExrWindow window_of(const NoisyPair *pair, const BlockGrid *grid, int index) {
    const ExrWindow d = pair->data, w = pair->display_window;
    int x = d.x0 - w.x0 + index % grid->columns * grid->side;
    int y = d.y0 - w.y0 + index / grid->columns * grid->side;
    int right = d.x1 - w.x0, bottom = d.y1 - w.y0;
    return (ExrWindow){x, y, x + grid->side < right ? x + grid->side : right,
                       y + grid->side < bottom ? y + grid->side : bottom};
}

/* Fills `reason` and `block` of a result that is otherwise complete: a mean that moved, with its
 * interval of 95 %, where one is known to; else the test that failed, where and with which p. */
static void statistic_reason(const NoisyPair *pair, const BlockGrid grids[2],
                             const BlockFinding *found, double level, StatisticResult *out) {
    char *text = out->reason;
    size_t size = sizeof out->reason;
    if (out->verdict != STATISTIC_DIFFERENT || out->region_count == 0) return;
    const StatisticRegion *region = surest_region(out);
    double family_level = sidak_level(level, FAMILIES);
    bool is_shift = regions_shift_is_sure(region);
    if (out->p_blocks < family_level)
        out->block = window_of(pair, &grids[found->grid], found->index);
    const ExrWindow at = out->block;
    if (out->p_regions < family_level && region->moved && isnan(region->shift))
        snprintf(text, size, "the mean moved: %.80s, %.3g cd/m2 instead of 0", region->words,
                 region->test);
    else if (out->p_regions < family_level && region->moved)
        snprintf(text, size, "the mean moved: %.80s %+.3g +- %.2g %%%s", region->words,
                 100 * (is_shift ? region->shift : region->change),
                 INTERVAL_PERCENT * (is_shift ? region->shift_sigma : region->change_sigma),
                 is_shift ? "" : " in proportion");
    else if (out->p_regions < family_level && at.x1 == at.x0)
        snprintf(text, size, MORE "%.80s (p = %.2g)", region->words, region->p_value);
    else if (at.x1 == at.x0)
        snprintf(text, size,
                 MORE "small changes all over the frame, the blocks' squared deviations are %.3g "
                      "of what noise makes (p = %.2g)",
                 out->mean_square, out->p_histogram);
    size_t length = strlen(text);
    if (at.x1 > at.x0)
        snprintf(text + length, size - length, "%sblock at x %d..%d, y %d..%d: %s (p = %.2g)",
                 length ? "; " : MORE, at.x0, at.x1, at.y0, at.y1, CHANNELS[found->channel],
                 found->p_least);
}

static void count_pixels(const NoisyPair *pair, StatisticResult *out, bool *is_equal) {
    int width = pair->data.x1 - pair->data.x0, height = pair->data.y1 - pair->data.y0;
    *is_equal = true;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            if (!noisy_pair_counts(pair, x, y)) continue;
            size_t i = noisy_pair_index(pair, x, y);
            out->pixels++;
            out->differing += noisy_pair_differs(pair, i);
            for (int c = 0; c < 3; c++)
                if (memcmp(&pair->side[0].light[c][i], &pair->side[1].light[c][i], sizeof(float)) !=
                    0)
                    *is_equal = false;
        }
}

static void make_sigma(const NoisyPair *pair, Arena *arena, StatisticResult *out) {
    const ExrWindow d = pair->data, w = pair->display_window;
    int width = w.x1 - w.x0, height = w.y1 - w.y0;
    out->sigma = ARENA_NEW(arena, float, (size_t)width *(size_t)height);
    for (int y = 0; y < d.y1 - d.y0; y++)
        for (int x = 0; x < d.x1 - d.x0; x++) {
            int u = x + d.x0 - w.x0, v = y + d.y0 - w.y0;
            if (u >= 0 && v >= 0 && u < width && v < height)
                out->sigma[(size_t)v * (size_t)width + (size_t)u] =
                    (float)noisy_pair_sigma(pair, noisy_pair_index(pair, x, y), STANDOUT_SIGMAS);
        }
}

static void make_map(const BlockGrid *grid, NoiseLaw law, Arena *arena, StatisticResult *out) {
    int count = grid->columns * grid->rows;
    out->block_side = grid->side;
    out->blocks_x = grid->columns;
    out->blocks_y = grid->rows;
    out->block_p = ARENA_NEW(arena, float, count);
    for (int i = 0; i < count; i++) out->block_p[i] = statistic_block_p(grid, i, law);
}

/* Names the layers that would make the test more sensitive. */
static void take_note(const NoisyPair *pair, const StatisticResult *r, char *note, size_t size) {
    if (r->broken[0])
        snprintf(note, size,
                 "the %s has in layer %s: another program changed it; what that layer states "
                 "is left out, of displays too",
                 r->broken_side ? "test" : "reference", r->broken);
    else if (!pair->knows_samples)
        snprintf(note, size,
                 "the frames do not say how many samples they have: their noise is "
                 "taken to be of two shapes; --layers samples tells");
    else if (!pair->law.is_same && !pair->law.has_variance)
        snprintf(note, size,
                 "the frames have different sample counts and no layer variance: "
                 "what few samples missed is not known; --layers variance tells");
    else if (!pair->law.is_same && !pair->has_halves)
        snprintf(note, size,
                 "the frames have different sample counts and no layer halves: "
                 "their noise is taken to be that of independent samples, which is "
                 "more than it is; --layers halves tells");
}

bool statistic_compare(const FrameImage *reference, const FrameImage *test,
                       const StatisticOptions *options, Arena *arena, StatisticResult *out,
                       Error *err) {
    double level = options->level > 0 ? options->level : LEVEL;
    double family_level = sidak_level(level, FAMILIES);
    StatisticResult result = {.verdict = STATISTIC_SAME};
    NoisyPair pair;
    BlockGrid grids[2];
    bool is_equal;
    if (!noisy_pair_open(reference, test, options, &pair, err)) return false;
    result.shares_noise = pair.shares_noise;
    count_pixels(&pair, &result, &is_equal);
    RegionFindings regions =
        regions_measure(&pair, (const FrameImage *[2]){reference, test}, family_level, arena);
    result.regions = regions.list;
    result.region_count = regions.count;
    result.p_regions = regions.p;
    result.mean_shift = regions.mean_shift;
    statistic_blocks(&pair, arena, grids);
    BlockFinding found = statistic_block_finding(grids, pair.law, family_level);
    make_map(&grids[0], pair.law, arena, &result);
    make_sigma(&pair, arena, &result);
    result.broken_side = pair.side[0].broken[0] ? 0 : 1;
    memcpy(result.broken, pair.side[result.broken_side].broken, sizeof result.broken);
    take_note(&pair, &result, result.note, sizeof result.note);
    result.p_blocks = found.p_least;
    result.p_histogram = found.p_squares;
    result.mean_square = found.mean_square;
    result.fraction_failed = found.tests > 0 ? found.failed / found.tests : 0;
    result.p_value =
        sidak_p(fmin(fmin(result.p_blocks, result.p_histogram), result.p_regions), FAMILIES);
    if (is_equal) result.verdict = STATISTIC_EQUAL;
    else if (result.p_value < level) result.verdict = STATISTIC_DIFFERENT;
    else if (result.broken[0]) result.verdict = STATISTIC_UNKNOWN;
    statistic_reason(&pair, grids, &found, level, &result);
    *out = result;
    return true;
}
