/* SPDX-License-Identifier: Apache-2.0 */
#include "film/sample_shares.h"

static uint64_t pixel_count(FilmRect rect) {
    return (uint64_t)(rect.x1 - rect.x0) * (uint64_t)(rect.y1 - rect.y0);
}

uint64_t sample_shares_whole(const SampleShares *shares) {
    uint64_t pixels = pixel_count(shares->rect), count = 0;
    if (!shares->of) return pixels;
    for (uint64_t i = 0; i < pixels; i++) count += shares->of[i] == SAMPLE_SHARE_ALL;
    return count;
}

uint64_t sample_shares_sum(const SampleShares *shares, FilmRect part, uint32_t first,
                           uint32_t end) {
    uint64_t sum = 0;
    if (!shares->of) return pixel_count(part) * (end - first);
    for (int y = part.y0; y < part.y1; y++)
        for (int x = part.x0; x < part.x1; x++) {
            uint32_t share = sample_shares_at(shares, x, y);
            sum += sample_shares_own(share, end) - sample_shares_own(share, first);
        }
    return sum;
}
