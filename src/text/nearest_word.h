/* nearest_word.h -- which known word somebody may have meant.
 *
 * Distances are Levenshtein's: letters put in, taken out or changed. Of two words that are
 * equally far the first counts.
 *
 * Threads  no shared state. Fails: never.
 */
#pragma once

/* The nearest of at least one known word. */
const char *nearest_word(const char *word, const char *const *known, int count);

/* The nearest at most `limit` letters away, or NULL. */
const char *nearest_word_within(const char *word, const char *const *known, int count,
                                int limit);
