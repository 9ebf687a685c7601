/* SPDX-License-Identifier: Apache-2.0 */
/* film_merge.h -- whether the parts of a frame make a whole.
 *
 * Memory   scratch alone.
 */
#pragma once
#include "film/film_part.h"

/* Whether the parts, all of one frame and at least one, fill the rectangle around them and one
 * range of samples, each sample of each pixel once. *out is what they make, without what was
 * dropped.
 * The error names the two parts that overlap, or the first pixels and samples that are
 * missing, and the part that was stopped before it came to them. */
bool film_merge_check(const FilmPart *parts, int count, Arena scratch, FilmPart *out, Error *err);
