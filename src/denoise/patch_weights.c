/* SPDX-License-Identifier: Apache-2.0 */
#include "denoise/patch_weights.h"

#include <string.h>

#include "base/mathf.h"

#define LEAST_WEIGHT 1e-3f
#define TOLERANCE 0.45f /* standard errors that do not count, as Rousselle et al. 2012 */

struct PatchScratch {
    float light[3][PATCH_WIDE][PATCH_WIDE], variance[3][PATCH_WIDE][PATCH_WIDE];
    float kind[PATCH_WIDE][PATCH_WIDE];
    float distance[PATCH_SIDE][PATCH_SIDE], counted[PATCH_SIDE][PATCH_SIDE];
    float distance_sum[PATCH_SIDE][PATCH_TILE], counted_sum[PATCH_SIDE][PATCH_TILE];
};

PatchScratch *patch_scratch_create(Arena *arena)
{
    return ARENA_NEW(arena, PatchScratch, 1);
}

/* The tile and what is around it; outside of the frame is a kind of its own. */
static void load(const PatchGuide *guide, int half, int x0, int y0, PatchScratch *s)
{
    const DenoiseBuffers *b = guide->buffers;
    const int             margin = PATCH_REACH + PATCH_SEARCH;
    const float           more = b->has_halves ? 1 / b->share[half] : 1;
    memset(s, 0, sizeof *s);
    for (int v = 0; v < PATCH_WIDE; v++)
        for (int u = 0; u < PATCH_WIDE; u++) {
            int x = x0 - margin + u, y = y0 - margin + v;
            if (x < 0 || y < 0 || x >= b->width || y >= b->height) continue;
            size_t i = (size_t)y * (size_t)b->width + (size_t)x;
            s->kind[v][u] = b->kind[i];
            for (int c = 0; c < 3; c++) {
                s->light[c][v][u] = guide->light[half][c][i];
                s->variance[c][v][u] = more * guide->variance[c][i];
            }
        }
}

/* Squared difference of two pixels beyond what noise lets expect, in units of the variance:
 * equation 4 of Rousselle et al. 2012. */
static void distances(PatchScratch *s, int dx, int dy)
{
    float square = TOLERANCE * TOLERANCE;
    for (int v = 0; v < PATCH_SIDE; v++) {
        int          a = v + PATCH_SEARCH, b = a + dy;
        float       *sum = s->distance[v], *counted = s->counted[v];
        const float *kind_a = s->kind[a] + PATCH_SEARCH;
        const float *kind_b = s->kind[b] + PATCH_SEARCH + dx;
        for (int u = 0; u < PATCH_SIDE; u++) {
            counted[u] = kind_a[u] == kind_b[u] && kind_a[u] > 0 ? 1.0f : 0.0f;
            sum[u] = 0;
        }
        for (int c = 0; c < 3; c++) {
            const float *la = s->light[c][a] + PATCH_SEARCH;
            const float *lb = s->light[c][b] + PATCH_SEARCH + dx;
            const float *va = s->variance[c][a] + PATCH_SEARCH;
            const float *vb = s->variance[c][b] + PATCH_SEARCH + dx;
            for (int u = 0; u < PATCH_SIDE; u++) {
                float difference = la[u] - lb[u];
                float both = va[u] + (va[u] < vb[u] ? va[u] : vb[u]);
                float scale = 1e-8f * la[u] * la[u] + 1e-20f + square * (va[u] + vb[u]);
                sum[u] += counted[u] * (difference * difference - both) / scale;
            }
        }
    }
}

static void sum_patches(PatchScratch *s)
{
    for (int v = 0; v < PATCH_SIDE; v++)
        for (int u = 0; u < PATCH_TILE; u++) {
            float distance = 0, counted = 0;
            for (int k = 0; k <= 2 * PATCH_REACH; k++) {
                distance += s->distance[v][u + k];
                counted += s->counted[v][u + k];
            }
            s->distance_sum[v][u] = distance;
            s->counted_sum[v][u] = counted;
        }
}

static float weight_of(const PatchScratch *s, float strength, int u, int v)
{
    float distance = 0, counted = 0;
    for (int k = 0; k <= 2 * PATCH_REACH; k++) {
        distance += s->distance_sum[v + k][u];
        counted += s->counted_sum[v + k][u];
    }
    if (s->counted[v + PATCH_REACH][u + PATCH_REACH] == 0) return 0;
    float mean = distance / (3 * counted);
    float weight = exp_f(-strength * (mean > 0 ? mean : 0));
    return weight < LEAST_WEIGHT ? 0 : weight;
}

/* Noise hides edges from patches, and the other layers show them: pixels of unlike features
 * count less, as in Rousselle et al. 2013. */
static void weigh_features(const DenoiseBuffers *b, int x, int y, float weights[PATCH_OFFSETS])
{
    size_t middle = (size_t)y * (size_t)b->width + (size_t)x;
    for (int offset = 0; offset < PATCH_OFFSETS; offset++) {
        if (weights[offset] == 0) continue;
        int    dx = offset % PATCH_WINDOW - PATCH_SEARCH;
        int    dy = offset / PATCH_WINDOW - PATCH_SEARCH;
        size_t i = (size_t)(y + dy) * (size_t)b->width + (size_t)(x + dx);
        float  like = buffers_likeness(b, middle, i);
        weights[offset] *= like;
        if (weights[offset] < LEAST_WEIGHT) weights[offset] = 0;
    }
}

void patch_weights(const PatchGuide *guide, int filtered, int x0, int y0, PatchScratch *s,
                   float (*weights)[PATCH_OFFSETS])
{
    const DenoiseBuffers *b = guide->buffers;
    load(guide, 1 - filtered, x0, y0, s);
    for (int offset = 0; offset < PATCH_OFFSETS; offset++) {
        distances(s, offset % PATCH_WINDOW - PATCH_SEARCH,
                  offset / PATCH_WINDOW - PATCH_SEARCH);
        sum_patches(s);
        for (int v = 0; v < PATCH_TILE; v++)
            for (int u = 0; u < PATCH_TILE; u++)
                weights[v * PATCH_TILE + u][offset] =
                    weight_of(s, guide->strength, u, v);
    }
    for (int v = 0; v < PATCH_TILE && y0 + v < b->height; v++)
        for (int u = 0; u < PATCH_TILE && x0 + u < b->width; u++)
            weigh_features(b, x0 + u, y0 + v, weights[v * PATCH_TILE + u]);
}
