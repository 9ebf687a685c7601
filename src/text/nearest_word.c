#include "text/nearest_word.h"

#include <limits.h>
#include <string.h>

#define LETTERS 64 /* that are compared: what follows counts as different */

static int edit_distance(const char *a, const char *b)
{
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

const char *nearest_word_within(const char *word, const char *const *known, int count,
                                int limit)
{
    const char *nearest = NULL;
    for (int i = 0; i < count; i++) {
        int distance = edit_distance(word, known[i]);
        if (distance > limit) continue;
        nearest = known[i];
        limit = distance - 1;
    }
    return nearest;
}

const char *nearest_word(const char *word, const char *const *known, int count)
{
    return nearest_word_within(word, known, count, INT_MAX);
}
