/* SPDX-License-Identifier: Apache-2.0 */
/* dealt_part.h -- `render --part K/N`: the samples of one run dealt to N parts, which `merge`
 * joins again. Each part has all pixels and a range of samples; the ranges meet in order, and
 * their sizes differ by one at most.
 *
 * Memory   scratch alone.
 * Fails    ERROR_USAGE with what was typed; ERROR_INPUT with the part.
 */
#pragma once
#include "film/film_part.h"

#define DEALT_PARTS_MAX 100000u

/* The attribute of frames that holds it, as it was typed. */
#define DEALT_PART_ATTRIBUTE "parhelion:part"

typedef struct DealtPart {
    uint32_t number, count; /* 1 to count; count 0: not dealt */
} DealtPart;

/* "3/12"; false: the text is none. */
bool dealt_part_parse(const char *text, DealtPart *out);

/* Which of the samples [0, *end) are the part's. False: there are fewer than parts. */
bool dealt_part_samples(DealtPart part, uint32_t *first, uint32_t *end, Error *err);

/* Whether each part that was dealt stands with all others of its number and pixels, once. parts
 * names the files. */
bool dealt_parts_check(const DealtPart *dealt, const FilmPart *parts, int count, Arena scratch,
                       Error *err);
