/* SPDX-License-Identifier: Apache-2.0 */
/* flip_tile.h -- LDR-FLIP of one part of a picture, at one exposure after the other.
 *
 * A tile is at most FLIP_TILE columns wide and as high as one likes: the rows that the filters
 * along x have done stand in a ring as high as the filters along y, so that what a tile needs
 * of memory fits a cache and does not grow with the picture. A pixel's value depends on no
 * tile's border.
 *
 * Memory   FlipScratch, one for each thread.
 * Threads  a job is read only; tiles do not share pixels of the maps.
 */
#pragma once
#include "compare/metrics/flip_filters.h"
#include "compare/metrics/flip_tone.h"
#include "compare/metrics/planes.h"
#include "image/colour.h"

enum { FLIP_TILE = 128 }; /* columns */

typedef struct FlipJob {
    const Planes  *reference, *test;
    FlipFilters    filters;
    ColourMatrix   ratios_from_rgb, rgb_from_ratios;
    double         log_most;     /* of the difference of pure green and pure blue, a power */
    double         log_knee, log_stretch; /* of colour differences, see flip_tile.c */
    bool           is_hdr;
    FlipToneMapper tone_mapper;  /* these three: HDR */
    int            exposures;    /* LDR: 1 */
    const double  *gains;        /* 2^ev, one per exposure */
    float         *map;          /* zeroed before the tiles start */
    float         *exposure_map; /* zeroed, or NULL */
} FlipJob;

/* Constants and filters; all that is left is 0. */
FlipJob flip_job_create(const Planes *reference, const Planes *test, double pixels_per_degree,
                        Arena *arena);

typedef struct FlipScratch FlipScratch;

FlipScratch *flip_scratch_create(const FlipJob *job, Arena *arena);

typedef struct FlipTile {
    int x0, x1, y0, y1; /* pixels; x1 and y1 are the first ones outside */
} FlipTile;

/* Raises map to the greatest of all exposures. */
void flip_tile(const FlipJob *job, FlipTile tile, FlipScratch *scratch);
