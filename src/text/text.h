/* text.h -- a text that grows, for documents.
 *
 * Memory   the arena's; what is outgrown stays there until the arena goes.
 * Threads  one at a time. Fails: never.
 */
#pragma once
#include <stddef.h>

#include "base/arena.h"

typedef struct Text {
    Arena *arena;
    char  *data; /* data[size] is 0; NULL while empty */
    size_t size, capacity;
} Text;

void text_add(Text *text, const char *string);
void text_add_bytes(Text *text, const void *bytes, size_t size);
void text_format(Text *text, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* A copy in which every byte that is no UTF-8, and every control character, is a '?': names of
 * files may hold anything. */
const char *text_clean(const char *string, Arena *arena);

/* With &, <, > and both quotes as HTML names. NULL adds nothing. */
void text_add_escaped(Text *text, const char *string);
