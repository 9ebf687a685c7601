/* SPDX-License-Identifier: Apache-2.0 */
/* guide_index.h -- which section of which guide is about a word: `parhelion help WORD`.
 *
 * The index is the pages themselves: a section (from one heading to the next) counts how often
 * it has the word, or one that the field uses for the same thing (synonyms below), a heading
 * counting as much as HEADING of them. Letters of either case; a word's plural is the word.
 *
 * Memory   the caller's list; texts are the guides'. Threads: pure. Fails: never.
 */
#pragma once
#include "cli/options/guides.h"

typedef struct GuideHit {
    const Guide *guide;
    const char  *heading; /* without its marks; the page's title where no other comes before */
    int          length;  /* of the heading */
    const char  *line;    /* the first line of the section that has the word */
    int          line_length;
    int          score;
} GuideHit;

/* Up to `most` sections, the best first, at most two of a guide. Returns how many. */
int guide_index_find(const char *word, GuideHit *hits, int most);
