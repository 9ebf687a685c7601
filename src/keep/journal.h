/* SPDX-License-Identifier: Apache-2.0 */
/* journal.h -- answers that were found, on the disk as soon as they are: looked up again, after
 * a kill, they are there at once.
 *
 * An answer is a row of bytes under a key, which is a hash of everything that decides it. So
 * work that is done once more from the beginning costs nothing up to where it was.
 *
 * File     a head without sizes (kept.h), then
 *            one entry an answer    key, 16 bytes; size, 8; XXH3 of both and of the answer, 8;
 *                                   the answer
 *          Entries are added at the end. One that was cut off by a kill, or damaged, ends what
 *          counts: it and all behind it are dropped when the file is opened.
 * Memory   an index in the arena; answers are read when they are looked up.
 *          A checksum can be made to fit: whether an answer may be is its asker's to check.
 * Threads  one at a time. Two processes never have one file: the second is refused.
 * Fails    as stated. A failed write (a full disk) is remembered and reported by journal_ok;
 *          the file keeps what it had.
 */
#pragma once
#include <stddef.h>
#include <stdint.h>

#include "base/problems.h"

typedef struct JournalKey {
    uint64_t low, high;
} JournalKey;

/* The hash of a text that holds all that decides the answer. */
JournalKey journal_key(const char *text);

typedef struct Journal Journal;

/* Opens the file, or makes it. What was dropped is a warning. To be closed. */
bool journal_open(const char *path, Arena *arena, Problems *problems, Journal **out,
                  Error *err);

/* False: there is no answer of that size under the key. A NULL journal knows none. */
bool journal_find(const Journal *journal, JournalKey key, void *answer, size_t size);

/* The same of floats. One that is not finite is none of ours: false, and they mean nothing. */
bool journal_find_floats(const Journal *journal, JournalKey key, float *out, size_t count);

/* Keeps it; of a key that is there already the first answer counts. NULL is fine. */
void journal_add(Journal *journal, JournalKey key, const void *answer, size_t size);

/* False: something could not be written, and *err has it. NULL is fine. */
bool journal_ok(const Journal *journal, Error *err);

/* How many answers there are. NULL: 0. */
int journal_count(const Journal *journal);

/* A file without answers is removed. NULL is fine. */
void journal_close(Journal *journal);
