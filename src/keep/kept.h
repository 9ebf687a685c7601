/* SPDX-License-Identifier: Apache-2.0 */
/* kept.h -- files that the program keeps for itself: one head, one checksum, one reader.
 *
 * File     all numbers little endian:
 *            a head      magic, 8 bytes; byte order, version, 4 each; bytes of the file and of
 *                        the identity, 8 each
 *            facts       the format's own head, of fixed size
 *            identity    text: everything that decides what is kept
 *            body        the format's
 *            checksum    XXH3, 64 bits, of everything before
 * Memory   the arena's; a body goes through the caller's memory piece by piece.
 * Threads  one at a time.
 * Writing  seen when it is whole and on the disk: a process that is killed, or a full disk,
 *          leaves the file before as it was.
 * Fails    every fault of a file is reported in one line that names it. A checksum can be made
 *          to fit: what a body holds is checked by its format all the same.
 */
#pragma once
#include <stdint.h>
#include <stdio.h>

#include "base/arena.h"
#include "base/error.h"

/* One kind of file. */
typedef struct KeptFormat {
    char magic[9];    /* 8 letters, "PRHL" first */
    const char *name; /* as messages call it: "a checkpoint" */
    uint32_t version; /* others are refused */
    size_t facts_bytes;
} KeptFormat;

/* ---- writing ----------------------------------------------------------------------------- */

typedef struct KeptFile {
    const KeptFormat *format;
    const char *path;     /* must outlive the writer */
    const char *identity; /* "": nothing besides the facts decides it */
    const void *facts;    /* without padding */
    uint64_t body_bytes;
} KeptFile;

typedef struct KeptWriter KeptWriter;

/* Bytes of the whole file. */
uint64_t kept_bytes(const KeptFile *file);

/* The body is added in pieces; after a failure, and after the commit, the writer is closed. */
bool kept_begin(const KeptFile *file, Arena *arena, KeptWriter **out, Error *err);
bool kept_add(KeptWriter *writer, const void *bytes, size_t size, Error *err);
bool kept_commit(KeptWriter *writer, Error *err);

/* All at once. */
bool kept_write(const KeptFile *file, const void *body, Arena scratch, Error *err);

/* ---- reading ----------------------------------------------------------------------------- */

typedef struct KeptReader {
    const char *path, *identity;
    uint64_t bytes; /* of the file */
    uint64_t left;  /* of the body */
    FILE *file;
} KeptReader;

/* True when a file stands there that begins with the format's magic. */
bool kept_is_there(const KeptFormat *format, const char *path);

/* The same of any format. */
bool kept_is_ours(const char *path);

/* Checks all of the file against its checksum, and fills the facts. To be closed. */
bool kept_open(const KeptFormat *format, const char *path, void *facts, Arena *arena,
               KeptReader *out, Error *err);
void kept_close(KeptReader *reader);

/* The body's next bytes; never more than it has. */
bool kept_take(KeptReader *reader, void *to, size_t bytes, Error *err);

/* Whether the body has so many bytes, no more and no fewer, from here on. */
bool kept_has_left(const KeptReader *reader, uint64_t bytes, Error *err);

/* An ERROR_INPUT: the file is damaged, as `format` says. Returns false. */
bool kept_damaged(const KeptReader *reader, Error *err, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
