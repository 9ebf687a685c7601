/* SPDX-License-Identifier: Apache-2.0 */
/* detail.h -- gives back what a filter took from a picture besides noise.
 *
 * Fine textures (leather, cloth) go with the noise, also where the samples are enough to show
 * them. What the picture differs by from its filtered self is, squared and in the mean, its
 * variance and what the filter is wrong by. So the difference is given back by the share
 *
 *     share(x) = max(0, 1 - <variance> / <difference^2>)
 *
 * <>: sums over the square of DETAIL_REACH pixels around x. Where all is noise it is 0; with
 * the samples it goes to 1, and so the picture to the frame's. The squared error is the least
 * of all shares', as far as a filtered pixel does not follow its own noise (W. James, C. Stein,
 * Estimation with quadratic loss, 4th Berkeley Symposium 1961).
 *
 * Units    differences by the filtered luminance.
 * Threads  as many as requested; the same bits for any number.
 * Memory   scratch: 16 bytes a pixel.
 * Fails    never.
 */
#pragma once
#include <stddef.h>

#include "base/arena.h"

enum { DETAIL_REACH = 4 }; /* pixels to each side */
/* Of the square's difference^2: a pixel with more, 4 times the root of their mean, is taken for
 * a speck of rare light rather than a texture's, and stays filtered. */
#define DETAIL_SPECK 0.2f

/* Of a pixel; 0 where nothing was filtered or the variance is not known. */
typedef struct DetailDifference {
    float square, variance;
} DetailDifference;

typedef struct DetailPicture {
    int width, height;
    void *user;
    /* Both are called by several threads, for one pixel by one at a time. */
    void (*difference)(void *user, size_t pixel, DetailDifference *out);
    void (*give_back)(void *user, size_t pixel, float share);
} DetailPicture;

void detail_run(const DetailPicture *picture, int threads, Arena scratch);
