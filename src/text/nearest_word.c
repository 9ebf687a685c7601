/* SPDX-License-Identifier: Apache-2.0 */
#include "text/nearest_word.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>

#define LETTERS 64 /* that are compared: what follows counts as different */

static int edit_distance(const char *a, const char *b) {
    int row[LETTERS + 1];
    int length_a = (int)strnlen(a, LETTERS), length_b = (int)strnlen(b, LETTERS);
    for (int j = 0; j <= length_b; j++) row[j] = j;
    for (int i = 1; i <= length_a; i++) {
        int diagonal = row[0];
        row[0] = i;
        for (int j = 1; j <= length_b; j++) {
            int change = diagonal + (a[i - 1] != b[j - 1]);
            int gap = (row[j] < row[j - 1] ? row[j] : row[j - 1]) + 1;
            diagonal = row[j];
            row[j] = change < gap ? change : gap;
        }
    }
    return row[length_b] + (int)(strlen(a + length_a) + strlen(b + length_b));
}

const char *nearest_word_within(const char *word, const char *const *known, int count, int limit) {
    const char *nearest = NULL;
    for (int i = 0; i < count; i++) {
        int distance = edit_distance(word, known[i]);
        if (distance > limit) continue;
        nearest = known[i];
        limit = distance - 1;
    }
    return nearest;
}

const char *nearest_word(const char *word, const char *const *known, int count) {
    return nearest_word_within(word, known, count, INT_MAX);
}

const char *nearest_word_meant(const char *word, const char *const *known, int count) {
    size_t dashes = strspn(word, "-"), letters = strlen(word) - dashes;
    for (int i = 0; i < count && letters; i++)
        if (letters > 1 && !strncmp(word, known[i], strlen(word))) return known[i];
    return letters ? nearest_word_within(word, known, count, (int)letters / 3 + 1) : NULL;
}

const char *nearest_key(const char *key, const char *const *known, int count, int limit) {
    const char *near = nearest_word_within(key, known, count, limit), *same = NULL;
    size_t stem = strcspn(key, "_");
    for (int i = 0; i < count && !near && !same && stem; i++)
        if (stem == strcspn(known[i], "_") && !strncmp(key, known[i], stem)) same = known[i];
    return near ? near : same;
}

/* ---- what would be right ----------------------------------------------------------------- */

static const char *quote_of(const char *name) {
    return !*name || strpbrk(name, " ,\"") ? "\"" : "";
}

/* Room for ", ", quotes, and " and 1000000 more" behind every name but the last. */
static bool has_room(const char *name, bool is_last, int length, int size) {
    return length + (int)strlen(name) + 4 + (is_last ? 0 : 18) < size;
}

const char *nearest_word_advice(const char *word, const char *const *known, int count, char *buffer,
                                int size) {
    const char *near = nearest_word_meant(word, known, count);
    int length = 0;
    if (!count) return snprintf(buffer, (size_t)size, "there are none"), buffer;
    if (near && (int)strlen(near) + 48 < size)
        length = snprintf(buffer, (size_t)size, "did you mean %s%s%s? ", quote_of(near), near,
                          quote_of(near));
    length +=
        snprintf(buffer + length, (size_t)(size - length), "%s are", length ? "There" : "there");
    for (int i = 0; i < count; i++) {
        const char *name = known[i], *quote = quote_of(name);
        if (!has_room(name, i + 1 == count, length, size)) {
            snprintf(buffer + length, (size_t)(size - length), " and %d more", count - i);
            break;
        }
        length += snprintf(buffer + length, (size_t)(size - length), "%s%s%s%s", i ? ", " : " ",
                           quote, name, quote);
    }
    return buffer;
}
