/* SPDX-License-Identifier: Apache-2.0 */
/* favour.h -- gives all samples to the pixels of an area, and fewer to the others.
 *
 * A pixel shows a display if one of some camera rays through it or through a pixel next to it
 * meets one; the rays are the same for every seed, sample range and crop.
 *
 * Memory   the arena's.
 * Threads  starts its own.
 */
#pragma once
#include "film/sample_shares.h"
#include "kernel/kernel.h"

#define FAVOUR_OTHERS 8u /* one of so many samples goes to the pixels outside */

/* Which pixels of a frame are favoured. */
typedef struct Favour {
    const Kernel *kernel;
    const PathContext *context;
    const Camera *camera;
    const FilmArea *area; /* NULL: all pixels take all samples */
    FilmRect crop;
    int threads;
} Favour;

/* Of each of the crop's pixels, row by row: 1: it shows the area's display. */
uint8_t *favour_shows(const Favour *favour, Arena *arena);

/* Of the crop's pixels. */
SampleShares favour_shares(const Favour *favour, Arena *arena);
