/* SPDX-License-Identifier: Apache-2.0 */
/* nearest_word.h -- which known word somebody may have meant.
 *
 * Distances are Levenshtein's: letters put in, taken out or changed. Of two words that are
 * equally far the first counts.
 *
 * Threads  no shared state. Fails: never.
 */
#pragma once
#include <stdbool.h>

/* The nearest of at least one known word. */
const char *nearest_word(const char *word, const char *const *known, int count);

/* The nearest at most `limit` letters away, or NULL. */
const char *nearest_word_within(const char *word, const char *const *known, int count, int limit);

/* The one that somebody who typed `word` may have meant: it begins so, or is near for a word of
 * that length. NULL when none is. */
const char *nearest_word_meant(const char *word, const char *const *known, int count);

/* The known key of the same quantity: all before the first '_' of the two is the same, as in
 * "luminance_cd_m2" and "luminance", "width_mm" and "width_m". Else within `limit` letters, or
 * NULL. */
const char *nearest_key(const char *key, const char *const *known, int count, int limit);

/* Advice on an unknown `word`, for an error's text: the name that may be meant, then all in the
 * order given, as far as they fit:
 *     did you mean cluster? There are cluster, "leather black" and 41 more
 * Names with blanks, commas or nothing in them stand in quotes. Fills and returns buffer, which
 * holds at least size chars; size at least 64. */
const char *nearest_word_advice(const char *word, const char *const *known, int count, char *buffer,
                                int size);
