/* SPDX-License-Identifier: Apache-2.0 */
/* text.h -- a text that grows, for documents and tables.
 *
 * Memory   the arena's. While nothing else is taken from the arena the text grows where it
 *          stands; else what is outgrown stays there until the arena goes.
 * Threads  one at a time.
 * Fails    never but in text_write.
 */
#pragma once
#include <stddef.h>

#include "base/arena.h"
#include "base/error.h"
#include "base/lines.h"

typedef struct Text {
    Arena *arena;
    char *data; /* data[size] is 0; NULL while empty */
    size_t size, capacity;
} Text;

void text_add(Text *text, const char *string);
void text_add_bytes(Text *text, const void *bytes, size_t size);
void text_format(Text *text, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Room for `size` bytes at the end, which the caller fills. */
char *text_extend(Text *text, size_t size);

/* The text becomes a file (base/file_write.h). */
bool text_write(const Text *text, const char *path, Error *err);

/* ---- inside languages that give some characters a meaning -------------------------------- */

/* Adds `size` bytes as they may be shown (printable.h). */
void text_add_printable(Text *text, const char *bytes, size_t size);

/* The same as the content of an element or of a quoted attribute, in HTML and in XML 1.0. NULL
 * adds nothing. */
void escape_markup(Text *text, const char *string);

/* A cell of CSV (RFC 4180): in quotes where a comma or a quote is in it. A spreadsheet takes what
 * begins with = + - or @ for a formula: unless it is a number, an apostrophe stands before it. */
void text_add_cell(Text *csv, const char *text);

/* A word as a POSIX shell reads it: itself, or in single quotes. */
const char *escape_shell(const char *word, Arena *arena);

/* Adds the words of a line as a POSIX shell cuts it, by quotes and backslashes; nothing stands
 * for something else ($, *, ~), and # begins no comment. False: a quote stays open. */
bool shell_words(const char *line, Lines *words);
