/* SPDX-License-Identifier: Apache-2.0 */
/* file.h -- reads whole files, and takes their names apart.
 *
 * Memory   what is read lies in the arena that is passed in, with a zero byte behind it.
 * Threads  no shared state.
 * Fails    with the path as the user named it, the system's reason and what was required.
 */
#pragma once
#include <stddef.h>

#include "base/arena.h"
#include "base/error.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct FileBytes {
    const unsigned char *data; /* data[size] is 0 */
    size_t size;
} FileBytes;

/* Reads a regular file of at most max_bytes. */
bool file_read(const char *path, size_t max_bytes, Arena *arena, FileBytes *out, Error *err);

/* Its first bytes: at most max_bytes of them, of a file of any length. */
bool file_read_start(const char *path, size_t max_bytes, Arena *arena, FileBytes *out, Error *err);

typedef struct FilePieces {
    size_t max_bytes; /* of a file that is read */
    bool is_start;    /* that many bytes at most, of a file of any length */
    void (*on_bytes)(void *user, size_t done, size_t size); /* after each piece; NULL: nobody */
    void *user;
} FilePieces;

/* Piece by piece, for who shows how far it has come. */
bool file_read_pieces(const char *path, const FilePieces *how, Arena *arena, FileBytes *out,
                      Error *err);

/* Behind the byte order mark that editors and spreadsheets like to write, where there is one. */
FileBytes file_unmarked(FileBytes bytes);

/* The bytes as text: behind its mark. Zero bytes, as UTF-16 has them, would end it early: an
 * ERROR_INPUT that names `path`. */
bool file_text(const char *path, const FileBytes *bytes, const char **out, Error *err);

/* True when something that can be opened for reading stands there. */
bool file_exists(const char *path);

/* True when both names are of one file that is there. */
bool file_is_same(const char *a, const char *b);

/* ---- names ----------------------------------------------------------------------------- */

/* `relative` as seen from the folder of the file `beside`; an absolute path stays itself. */
char *path_beside(const char *beside, const char *relative, Arena *arena);

/* The part after the last slash; points into `path`. */
const char *path_name(const char *path);

/* The ending of the name with its dot, or "". Points into `path`. */
const char *path_ending(const char *path);

/* How many folders above its start a relative path reaches at its highest point:
 * "a/../b" 0, "../b" 1, "../../b" 2. */
int path_climb(const char *relative);

#ifdef __cplusplus
}
#endif
