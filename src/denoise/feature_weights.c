/* SPDX-License-Identifier: Apache-2.0 */
#include "denoise/feature_weights.h"

#include "base/mathf.h"

#define UNLIKE 100.0f /* stricter than BUFFERS_UNLIKE: nothing else keeps surfaces apart */
#define NEAR 8.0f     /* pixels: standard deviation over the window */
#define LEAST_WEIGHT 1e-3f

static float weight_at(const DenoiseBuffers *b, size_t middle, size_t i, float square)
{
    if (b->kind[i] != b->kind[middle]) return 0;
    float weight = exp_f(-UNLIKE * buffers_feature_distance(b, middle, i) -
                         square / (2 * NEAR * NEAR));
    return weight < LEAST_WEIGHT ? 0 : weight;
}

void feature_weights(const DenoiseBuffers *b, int x, int y, float weights[PATCH_OFFSETS])
{
    size_t middle = (size_t)y * (size_t)b->width + (size_t)x;
    for (int offset = 0; offset < PATCH_OFFSETS; offset++) {
        int dx = offset % PATCH_WINDOW - PATCH_SEARCH, u = x + dx;
        int dy = offset / PATCH_WINDOW - PATCH_SEARCH, v = y + dy;
        weights[offset] = 0;
        if (u < 0 || v < 0 || u >= b->width || v >= b->height) continue;
        size_t i = (size_t)v * (size_t)b->width + (size_t)u;
        weights[offset] = weight_at(b, middle, i, (float)(dx * dx + dy * dy));
    }
}
