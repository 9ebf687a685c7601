/* SPDX-License-Identifier: Apache-2.0 */
#include "denoise/balance.h"

#include <math.h>

#include "base/mathf.h"
#include "base/parallel.h"

/* ---- blocks along one side --------------------------------------------------------------- */

typedef struct BlockLine {
    int blocks;
    int *block;   /* of each pixel */
    int *low;     /* of the two blocks whose middles lie around it, the lower */
    float *share; /* and what the higher one counts there */
} BlockLine;

static int block_start(int pixels, int blocks, int b) {
    return b == blocks ? pixels : b * BALANCE_BLOCK;
}

static float middle(int pixels, int blocks, int b) {
    return 0.5f * (float)(block_start(pixels, blocks, b) + block_start(pixels, blocks, b + 1));
}

static BlockLine line_of(int pixels, Arena *arena) {
    const int whole = (pixels + BALANCE_BLOCK / 2) / BALANCE_BLOCK;
    BlockLine line = {.blocks = whole > 1 ? whole : 1};
    line.block = ARENA_NEW(arena, int, (size_t)pixels);
    line.low = ARENA_NEW(arena, int, (size_t)pixels);
    line.share = ARENA_NEW(arena, float, (size_t)pixels);
    for (int i = 0; i < pixels; i++) {
        const float at = (float)i + 0.5f;
        const int last = line.blocks - 1;
        const int b = i / BALANCE_BLOCK < last ? i / BALANCE_BLOCK : last;
        const int below = b > 0 && at < middle(pixels, line.blocks, b) ? b - 1 : b;
        line.block[i] = b;
        line.low[i] = below < last ? below : last > 0 ? last - 1 : 0;
        if (!last) continue;
        const float from = middle(pixels, line.blocks, line.low[i]);
        const float to = middle(pixels, line.blocks, line.low[i] + 1);
        const float t = clampf((at - from) / (to - from), 0, 1);
        line.share[i] = t * t * (3 - 2 * t);
    }
    return line;
}

/* ---- all blocks -------------------------------------------------------------------------- */

enum { NEIGHBOURS = 9 }; /* a block and the eight around it */

typedef struct Blocks {
    const BalancePicture *picture;
    BlockLine x, y;
    int count;
    double *total, *missing, *rms;
    double *near; /* of each block: what it gains where a neighbour's g is 1 */
    double *g, *left;
} Blocks;

/* What a field of the blocks is at a pixel. */
static float at_pixel(const Blocks *blocks, const double *field, int x, int y) {
    const int right = blocks->x.blocks > 1, down = blocks->y.blocks > 1;
    const double *row = field + blocks->y.low[y] * blocks->x.blocks + blocks->x.low[x];
    const double *next = row + down * blocks->x.blocks;
    const double s = (double)blocks->x.share[x], t = (double)blocks->y.share[y];
    return (float)((1 - t) * ((1 - s) * row[0] + s * row[right]) +
                   t * ((1 - s) * next[0] + s * next[right]));
}

static BalanceLight light_at(const Blocks *blocks, int x, int y) {
    const BalancePicture *picture = blocks->picture;
    BalanceLight light;
    picture->light(picture->user, (size_t)y * (size_t)picture->width + (size_t)x, &light);
    return light;
}

typedef void PixelWork(Blocks *blocks, int x, int y);

typedef struct Pass {
    Blocks *blocks;
    PixelWork *work;
} Pass;

/* One thread does a whole row of blocks, so that sums have one order. */
static void pass_row(void *context, int row, int worker) {
    const Pass *pass = context;
    Blocks *blocks = pass->blocks;
    const int height = blocks->picture->height;
    (void)worker;
    for (int y = block_start(height, blocks->y.blocks, row);
         y < block_start(height, blocks->y.blocks, row + 1); y++)
        for (int x = 0; x < blocks->picture->width; x++) pass->work(blocks, x, y);
}

static void over_pixels(Blocks *blocks, PixelWork *work, int threads) {
    parallel_for(threads, blocks->y.blocks, pass_row, &(Pass){blocks, work});
}

static int block_of(const Blocks *blocks, int x, int y) {
    return blocks->y.block[y] * blocks->x.blocks + blocks->x.block[x];
}

static void add_up(Blocks *blocks, int x, int y) {
    const int b = block_of(blocks, x, y);
    const BalanceLight light = light_at(blocks, x, y);
    blocks->total[b] += (double)light.total;
    blocks->missing[b] += (double)light.before - (double)light.after;
    blocks->rms[b] += (double)light.after * (double)light.after;
    blocks->left[b] += light.after > 0;
}

static void end_sums(Blocks *blocks) {
    for (int b = 0; b < blocks->count; b++) {
        const double band = BALANCE_BAND * blocks->total[b], missing = blocks->missing[b];
        blocks->rms[b] = blocks->left[b] > 0 ? sqrt(blocks->rms[b] / blocks->left[b]) : 0;
        blocks->missing[b] = missing > band ? missing - band : missing < -band ? missing + band : 0;
    }
}

/* A pixel's light by g, without g. */
static float by_square(const Blocks *blocks, float after, int x, int y) {
    const float rms = at_pixel(blocks, blocks->rms, x, y);
    return rms > 0 ? after * (after / rms) : 0;
}

static void add_near(Blocks *blocks, int x, int y) {
    const int b = block_of(blocks, x, y);
    const float light = by_square(blocks, light_at(blocks, x, y).after, x, y);
    const int i = blocks->x.low[x] - blocks->x.block[x] + 1;
    const int j = blocks->y.low[y] - blocks->y.block[y] + 1;
    const float s = blocks->x.share[x], t = blocks->y.share[y];
    double *near = blocks->near + (size_t)b * NEIGHBOURS + j * 3 + i;
    near[0] += (double)(light * (1 - s) * (1 - t));
    if (blocks->x.blocks > 1) near[1] += (double)(light * s * (1 - t));
    if (blocks->y.blocks > 1) near[3] += (double)(light * (1 - s) * t);
    if (blocks->x.blocks > 1 && blocks->y.blocks > 1) near[4] += (double)(light * s * t);
}

/* ---- the shares -------------------------------------------------------------------------- */

/* Block b's neighbour k, or -1 beyond the picture. */
static int neighbour(const Blocks *blocks, int b, int k) {
    const int x = b % blocks->x.blocks + k % 3 - 1, y = b / blocks->x.blocks + k / 3 - 1;
    return x < 0 || y < 0 || x >= blocks->x.blocks || y >= blocks->y.blocks
               ? -1
               : y * blocks->x.blocks + x;
}

/* Rows by each block's light: all blocks count alike. out = A g, or its transpose. */
static void multiply(const Blocks *blocks, const double *in, bool is_transposed, double *out) {
    for (int b = 0; b < blocks->count; b++) out[b] = 0;
    for (int b = 0; b < blocks->count; b++) {
        if (!(blocks->total[b] > 0)) continue;
        for (int k = 0; k < NEIGHBOURS; k++) {
            const int n = neighbour(blocks, b, k);
            const double a = blocks->near[b * NEIGHBOURS + k] / blocks->total[b];
            if (n >= 0) out[is_transposed ? n : b] += a * in[is_transposed ? b : n];
        }
    }
}

static double square(const double *values, int count) {
    double sum = 0;
    for (int i = 0; i < count; i++) sum += values[i] * values[i];
    return sum;
}

enum { STEPS = 80 };
#define SMALL 1e-12 /* of the first gradient's square */

static void solve(Blocks *blocks, Arena scratch) {
    const int n = blocks->count;
    double *gradient = ARENA_NEW(&scratch, double, (size_t)n);
    double *way = ARENA_NEW(&scratch, double, (size_t)n);
    double *product = ARENA_NEW(&scratch, double, (size_t)n);
    for (int b = 0; b < n; b++) {
        blocks->g[b] = 0;
        blocks->left[b] = blocks->total[b] > 0 ? blocks->missing[b] / blocks->total[b] : 0;
    }
    multiply(blocks, blocks->left, true, gradient);
    const double first = square(gradient, n);
    double now = first;
    for (int b = 0; b < n; b++) way[b] = gradient[b];
    for (int step = 0; step < STEPS && now > SMALL * first; step++) {
        multiply(blocks, way, false, product);
        const double length = square(product, n);
        if (!(length > 0)) return;
        for (int b = 0; b < n; b++) {
            blocks->g[b] += now / length * way[b];
            blocks->left[b] -= now / length * product[b];
        }
        multiply(blocks, blocks->left, true, gradient);
        const double next = square(gradient, n);
        for (int b = 0; b < n; b++) way[b] = gradient[b] + next / now * way[b];
        now = next;
    }
}

/* Leaves out the blocks that would need too much; true if there was one. */
static bool drop_rare(Blocks *blocks) {
    bool has_dropped = false;
    for (int b = 0; b < blocks->count; b++) {
        if (blocks->g[b] >= -BALANCE_MOST && blocks->g[b] <= BALANCE_MOST) continue;
        has_dropped = has_dropped || blocks->missing[b] < 0 || blocks->missing[b] > 0;
        blocks->missing[b] = 0;
    }
    return has_dropped;
}

/* ---- all of it --------------------------------------------------------------------------- */

#define LEAST 0.5f

static void scale_pixel(Blocks *blocks, int x, int y) {
    const BalancePicture *picture = blocks->picture;
    const BalanceLight light = light_at(blocks, x, y);
    const float g = at_pixel(blocks, blocks->g, x, y);
    const float rms = at_pixel(blocks, blocks->rms, x, y);
    const float gain = rms > 0 ? fmaxf(1 + g * (light.after / rms), LEAST) : 1;
    blocks->left[block_of(blocks, x, y)] += (double)(light.after * gain) - (double)light.before;
    if (light.after > 0)
        picture->scale(picture->user, (size_t)y * (size_t)picture->width + (size_t)x, gain);
}

static double worst_block(const Blocks *blocks) {
    double worst = 0;
    for (int b = 0; b < blocks->count; b++)
        if (blocks->total[b] > 0) worst = fmax(worst, fabs(blocks->left[b] / blocks->total[b]));
    return worst;
}

double balance_run(const BalancePicture *picture, int threads, Arena scratch) {
    enum { ROUNDS = 4 };
    Blocks blocks = {.picture = picture,
                     .x = line_of(picture->width, &scratch),
                     .y = line_of(picture->height, &scratch)};
    blocks.count = blocks.x.blocks * blocks.y.blocks;
    double **fields[] = {&blocks.total, &blocks.missing, &blocks.rms, &blocks.g, &blocks.left};
    for (size_t i = 0; i < sizeof fields / sizeof *fields; i++)
        *fields[i] = ARENA_NEW(&scratch, double, (size_t)blocks.count);
    blocks.near = ARENA_NEW(&scratch, double, (size_t)blocks.count *NEIGHBOURS);
    over_pixels(&blocks, add_up, threads);
    end_sums(&blocks);
    over_pixels(&blocks, add_near, threads);
    solve(&blocks, scratch);
    for (int round = 0; round < ROUNDS && drop_rare(&blocks); round++) solve(&blocks, scratch);
    for (int b = 0; b < blocks.count; b++) {
        blocks.left[b] = 0;
        blocks.g[b] = fmax(fmin(blocks.g[b], BALANCE_MOST), -BALANCE_MOST);
    }
    over_pixels(&blocks, scale_pixel, threads);
    return worst_block(&blocks);
}
