/* SPDX-License-Identifier: Apache-2.0 */
/* lines.h -- a list of texts that grows: reasons, notes, names of files.
 *
 * Memory   the list and its texts grow in its arena. Threads: one thread at a time.
 */
#pragma once
#include "base/arena.h"

typedef struct Lines {
    Arena *arena;
    const char **list;
    int count, capacity;
} Lines;

/* As it is; it is not copied. */
void lines_put(Lines *lines, const char *text);

/* A sentence for people, cut at 2047 bytes; what is foreign in it is escaped (printable.h). */
void lines_add(Lines *lines, const char *format, ...) __attribute__((format(printf, 2, 3)));
