/* lines.h -- a list of sentences that grows: reasons, notes, warnings.
 *
 * Memory   the list and its texts grow in its arena. Threads: one thread at a time.
 */
#pragma once
#include "base/arena.h"

typedef struct Lines {
    Arena       *arena;
    const char **list;
    int          count, capacity;
} Lines;

void lines_add(Lines *lines, const char *format, ...) __attribute__((format(printf, 2, 3)));
