/* SPDX-License-Identifier: Apache-2.0 */
#include "image/adapt.h"

#include <math.h>

#include "base/mathf.h"

#define EDGE_STOPS 0.3f   /* surroundings that vary by more have an edge inside */
#define SIDE_SHARE 12     /* the window reaches a twelfth of the shorter side */
#define STOPS_LEAST -8.0f /* deeper shadows do not count as deeper */
#define LN2 0.69314718f

float adapt_stops(float stops) {
    return stops > 0 ? ADAPT_SOFTNESS * log_f(1 + stops / ADAPT_SOFTNESS) : stops;
}

/* One picture, and how far the squares around its pixels reach. */
typedef struct GuideSquares {
    int width, height, reach;
    size_t count;
    float *line; /* scratch of one column */
} GuideSquares;

/* The sum of the `reach` values on both sides of each of `count`, and itself. */
static void sum_line(const float *from, size_t step, int count, int reach, float *to) {
    double sum = 0;
    for (int i = 0; i < count + reach; i++) {
        if (i < count) sum += (double)from[(size_t)i * step];
        if (i - 2 * reach - 1 >= 0) sum -= (double)from[(size_t)(i - 2 * reach - 1) * step];
        if (i >= reach) to[i - reach] = (float)sum;
    }
}

/* Sums over squares, in place. */
static void sum_squares(const GuideSquares *p, float *plane) {
    size_t width = (size_t)p->width;
    for (int y = 0; y < p->height; y++) {
        float *row = plane + (size_t)y * width;
        sum_line(row, 1, p->width, p->reach, p->line);
        for (size_t x = 0; x < width; x++) row[x] = p->line[x];
    }
    for (size_t x = 0; x < width; x++) {
        sum_line(plane + x, width, p->height, p->reach, p->line);
        for (int y = 0; y < p->height; y++) plane[(size_t)y * width + x] = p->line[y];
    }
}

/* The surroundings' brightness by a guided filter whose guide is the picture itself (He, Sun
 * and Tang 2010): in each square a line a v + b for the brightness v, with a near 1 where the
 * square has an edge and near 0 where it has none; a pixel takes the mean of the lines of all
 * squares that it lies in. */
static float *surroundings(const GuideSquares *p, const float *stops, const float *known,
                           Arena *arena) {
    float *plane[4]; /* how many are known, v, v^2; then a and b */
    for (int k = 0; k < 4; k++) plane[k] = ARENA_NEW(arena, float, p->count);
    for (size_t i = 0; i < p->count; i++) {
        plane[0][i] = known[i];
        plane[1][i] = known[i] * stops[i];
        plane[2][i] = known[i] * stops[i] * stops[i];
    }
    for (int k = 0; k < 3; k++) sum_squares(p, plane[k]);
    for (size_t i = 0; i < p->count; i++) {
        float count = fmaxf(plane[0][i], 1), mean = plane[1][i] / count;
        float variance = fmaxf(plane[2][i] / count - mean * mean, 0);
        float slope = variance / (variance + EDGE_STOPS * EDGE_STOPS);
        plane[0][i] = known[i];
        plane[2][i] = known[i] * slope;
        plane[3][i] = known[i] * mean * (1 - slope);
    }
    sum_squares(p, plane[0]);
    sum_squares(p, plane[2]);
    sum_squares(p, plane[3]);
    for (size_t i = 0; i < p->count; i++)
        plane[1][i] = (plane[2][i] * stops[i] + plane[3][i]) / fmaxf(plane[0][i], 1);
    return plane[1];
}

float *adapt_gains(const float *luminance, int width, int height, float grey, Arena *arena) {
    size_t count = (size_t)width * (size_t)height;
    int shorter = width < height ? width : height, longer = width + height - shorter;
    float *gains = ARENA_NEW(arena, float, count);
    Arena scratch = *arena;
    int reach = shorter / SIDE_SHARE > 1 ? shorter / SIDE_SHARE : 1;
    GuideSquares squares = {width, height, reach, count, ARENA_NEW(&scratch, float, longer)};
    float *stops = ARENA_NEW(&scratch, float, count);
    float *known = ARENA_NEW(&scratch, float, count);
    for (size_t i = 0; i < count; i++) {
        known[i] = luminance[i] > 0 && isfinite(luminance[i]) ? 1 : 0;
        if (known[i] > 0) stops[i] = fmaxf(log_f(luminance[i] / grey) / LN2, STOPS_LEAST);
    }
    const float *around = surroundings(&squares, stops, known, &scratch);
    for (size_t i = 0; i < count; i++)
        gains[i] = known[i] > 0 ? exp_f(LN2 * (adapt_stops(around[i]) - around[i])) : 1;
    return gains;
}
