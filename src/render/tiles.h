/* SPDX-License-Identifier: Apache-2.0 */
/* tiles.h -- a rectangle of pixels cut into pieces of work, and what the workers count.
 *
 * Threads  each worker has its own WorkerCounts.
 */
#pragma once
#include "film/film.h"
#include "path/path.h"

/* Tiles of a crop, row by row; index counts from 0. */
int      render_tile_count(FilmRect crop);
FilmRect render_tile(FilmRect crop, int index);

/* One worker's counts, alone on their cache lines. */
typedef struct WorkerCounts {
    _Alignas(128) PathStatistics statistics;
} WorkerCounts;

PathStatistics worker_counts_sum(const WorkerCounts *counts, int threads);
