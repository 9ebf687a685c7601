/* film_merge.h -- films added to each other, and whether parts make a whole.
 *
 * All sums are whole numbers: any order of adding gives the same bits.
 * Memory   scratch alone.  Threads  one film belongs to one thread.
 */
#pragma once
#include "film/film_part.h"

/* Adds pixels of a rectangle, row by row as the film keeps them, whose layers are the film's.
 * most_samples: what one of them may hold; films from files are not trusted: one with counts or
 * sums that no samples make is refused, and the film is then worth nothing. */
bool film_add_pixels(Film *film, FilmRect rect, const void *pixels, uint32_t most_samples,
                     Error *err);

void film_add_dropped(Film *film, const FilmDropped *dropped);

/* Whether the parts, all of one frame and at least one, fill the rectangle around them and one
 * range of samples, each sample of each pixel once. *out is what they make, without what was
 * dropped.
 * The error names the two parts that overlap, or the first pixels and samples that are
 * missing, and the part that was stopped before it came to them. */
bool film_merge_check(const FilmPart *parts, int count, Arena scratch, FilmPart *out,
                      Error *err);
