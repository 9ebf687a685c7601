/* SPDX-License-Identifier: Apache-2.0 */
/* film_add.h -- films added to each other.
 *
 * All sums are whole numbers: any order of adding gives the same bits.
 * Threads  one film belongs to one thread.
 */
#pragma once
#include "base/error.h"
#include "film/film_sample.h"

/* Adds pixels of a rectangle, row by row as the film keeps them, whose layers are the film's.
 * most_samples: what one of them may hold; films from files are not trusted: one with counts or
 * sums that no samples make is refused, and the film is then worth nothing. */
bool film_add_pixels(Film *film, FilmRect rect, const void *pixels, uint32_t most_samples,
                     Error *err);

void film_add_dropped(Film *film, const FilmDropped *dropped);
