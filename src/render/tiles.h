/* SPDX-License-Identifier: Apache-2.0 */
/* tiles.h -- a frame cut into pieces of work: passes, and tiles of their pixels; and what the
 * workers count.
 *
 * Threads  each worker has its own WorkerCounts.
 */
#pragma once
#include "film/film.h"
#include "path/path.h"

/* Tiles of a crop, row by row; index counts from 0. */
int render_tile_count(FilmRect crop);
FilmRect render_tile(FilmRect crop, int index);

/* Samples a pixel of the pass that begins after `done` samples, for so many pixels; where no
 * pass ends at `done`, those that are left of the one that does not. */
uint32_t render_pass_samples(uint32_t done, size_t pixels);

/* One worker's counts, alone on their cache lines. */
typedef struct WorkerCounts {
    _Alignas(128) PathStatistics statistics;
} WorkerCounts;

PathStatistics worker_counts_sum(const WorkerCounts *counts, int threads);
