/* SPDX-License-Identifier: Apache-2.0 */
/* text_lines.h -- a foreign text file as lines of cells, for any encoding, line ends, delimiter
 * and decimal sign.
 *
 * Memory   the arena's; lines and cells are views into the decoded text.
 * Threads  no shared state.
 * Fails    with the file, the line, what was found and what was required.
 */
#pragma once

#include "base/arena.h"
#include "base/error.h"
#include "base/file.h"

typedef enum TextEncoding {
    ENCODING_AUTO,
    ENCODING_UTF8,
    ENCODING_LATIN1,
    ENCODING_UTF16LE,
    ENCODING_UTF16BE
} TextEncoding;

typedef struct TextLine {
    const char *text; /* not terminated; no line end */
    int length;
} TextLine;

typedef struct TextFile {
    const char *file;
    TextLine *line;
    int count; /* line i is number i + 1 of the file */
} TextFile;

/* Reads and decodes to UTF-8: a byte order mark tells UTF-16, else it is UTF-8, whose broken bytes
 * count as Latin-1. */
bool text_file_read(const char *file, TextEncoding encoding, Arena *arena, TextFile *out,
                    Error *err);

/* The same of bytes that are there already; `file` names them in messages. */
bool text_file_decode(const char *file, FileBytes bytes, TextEncoding encoding, Arena *arena,
                      TextFile *out, Error *err);

/* "line 12". */
const char *text_place(int line_index, Arena *arena);

/* ---- cells ------------------------------------------------------------------------------- */

#define TEXT_CELLS_MAX 4096

/* How a file separates and writes its numbers. */
typedef struct TextDialect {
    char delimiter; /* ',' ';' '\t' or ' ' (any run of blanks); 0: to be found */
    char decimal;   /* '.' or ','; 0: to be found */
} TextDialect;

typedef struct TextCell {
    const char *text; /* blanks and quotes around it removed */
    int length;
} TextCell;

/* Cuts a line; at most TEXT_CELLS_MAX cells. An empty last cell behind a final delimiter
 * counts. Returns the number of cells, or -1 when there are too many. */
int text_cells(TextLine line, char delimiter, TextCell *cell);

/* A decimal number and nothing else (but a degree sign), with this decimal sign. */
bool text_number(TextCell cell, char decimal, double *out);

/* Marks of a value that was not measured: nothing, "---", "NaN", "n/a", "***". */
bool text_is_masked(TextCell cell);

/* Finds what the user did not give: the delimiter and decimal sign under which most lines are
 * rows of numbers. */
bool text_find_dialect(const TextFile *text, int first_line, Arena scratch, TextDialect *dialect,
                       Error *err);
