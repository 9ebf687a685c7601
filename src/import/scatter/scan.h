/* SPDX-License-Identifier: Apache-2.0 */
/* scan.h -- walks over a text file word by word or line by line, and knows the line.
 *
 * Words are separated by blanks and line ends (and by commas, where a format has them). A line
 * that begins with the comment mark is passed over.
 *
 * Memory   the arena's. Threads: one scan per thread.
 * Fails    with file, line, what was found and what was required.
 */
#pragma once
#include <stddef.h>

#include "base/arena.h"
#include "base/error.h"

typedef struct WordScan {
    const char *file;
    const char *next, *end; /* the text; *end is 0 */
    int line;               /* of `next`, from 1 */
    char comment;           /* 0: none */
    bool commas;            /* a comma separates words, too */
    Arena *arena;
} WordScan;

/* Reads the file (a byte order mark is passed over); '#' is the comment mark. */
bool scan_open(const char *file, Arena *arena, WordScan *out, Error *err);

/* The next word in the arena; NULL at the end. Comments between words are passed over. */
const char *scan_word(WordScan *scan);

/* As scan_word, without moving. */
const char *scan_peek(const WordScan *scan);

/* The rest of the line, blanks around it removed, in the arena; NULL at the end of the file.
 * Comment marks mean nothing here. */
const char *scan_line(WordScan *scan);

/* Moves when the next word is this one (case does not matter). */
bool scan_accept(WordScan *scan, const char *word);

/* A finite number; `what` names it in the message. */
bool scan_number(WordScan *scan, const char *what, double *out, Error *err);

/* A whole number from 1 to `most`, no larger than the rest of the file could hold as words. */
bool scan_count(WordScan *scan, const char *what, int most, int *out, Error *err);

/* `count` numbers into fresh memory. */
bool scan_list(WordScan *scan, const char *what, int count, double **out, Error *err);

/* scan_count and as many numbers. */
bool scan_counted_list(WordScan *scan, const char *what, int most, int *count, double **out,
                       Error *err);

/* The next word's place in a list that ends with NULL (case does not matter); or -1 and an
 * error, "WHAT is '...', required: WANTED". */
int scan_choice(WordScan *scan, const char *what, const char *const *list, const char *wanted,
                Error *err);

/* The lines from here to the end, one that has no end as well; no more than rows of a table. */
int scan_lines_left(const WordScan *scan);

/* A file that was cut inside a number could pass: the last line must be a whole one. */
bool scan_check_end(const WordScan *scan, Error *err);

/* An error at the current line. Always false. */
bool scan_fail(const WordScan *scan, Error *err, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Do the first bytes of a file hold this word at the beginning of a line (case matters)? */
bool scan_head_has(const char *head, size_t size, const char *line_start);
