/* SPDX-License-Identifier: Apache-2.0 */
/* film_quarter.h -- a film seen from twice as far: two by two pixels are one.
 *
 * Memory   the arena's.  Threads  one film belongs to one thread.  Fails  never.
 */
#pragma once
#include "film/film.h"

/* Of a quarter of the pixels, each with the samples of two by two, from the crop's corner on: it
 * begins at 0, 0 and has no other pixels. */
Film *film_quarter(const Film *film, int threads, Arena *arena);
