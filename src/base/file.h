/* file.h -- reads whole files, writes them so that a half-written one never shows, and takes
 * URIs apart.
 *
 * Memory   what is read lies in the arena that is passed in, with a zero byte behind it.
 * Threads  no shared state.
 * Fails    with the path as the user named it, the system's reason and what was wanted.
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
bool file_read_start(const char *path, size_t max_bytes, Arena *arena, FileBytes *out,
                     Error *err);

/* True when something that can be opened for reading stands there. */
bool file_exists(const char *path);

/* ---- writing: seen when it is whole and on the disk ------------------------------------- */

/* Whether `path` could be written, before hours of work: not over a folder, nor over a file
 * that its owner has write-protected. Leaves nothing behind. */
bool file_check_writable(const char *path, Error *err);

/* Bytes in memory become a file. A device or a pipe is written as it stands. */
bool file_write(const char *path, const void *bytes, size_t size, Error *err);

/* The same piece by piece. Until file_writer_commit nobody sees the file, and where the file
 * system allows it (O_TMPFILE) it has no name either, so that a process that is killed leaves
 * nothing. Commit flushes the bytes and the folder to the disk. After a failure, and after
 * commit or discard, the writer is closed. `path` must outlive it. */
typedef enum FileKind { FILE_UNNAMED, FILE_NAMED, FILE_SPECIAL } FileKind;

typedef struct FileWriter {
    const char *path;
    int         handle;
    FileKind    kind;
} FileWriter;

bool file_writer_open(const char *path, FileWriter *out, Error *err);
bool file_writer_add(FileWriter *writer, const void *bytes, size_t size, Error *err);
bool file_writer_commit(FileWriter *writer, Error *err);
void file_writer_discard(FileWriter *writer);

/* Removes a file, and what a process that was killed may have left of its successor. */
void file_remove(const char *path);

/* A name beside `path`, for a library that wants a path; unlike any other process's. */
char *file_temporary_name(const char *path, Arena *arena);

/* Makes the temporary file's bytes durable and gives it the final name. On failure it is
 * removed. */
bool file_commit(const char *temporary, const char *path, Error *err);

/* Removes a temporary file after a failure. */
void file_discard(const char *temporary);

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

/* ---- URIs (RFC 3986, RFC 2397) --------------------------------------------------------- */

/* The length of the scheme before its colon, 0 when there is none ("C:/x" counts as one). */
size_t uri_scheme_length(const char *uri);
bool uri_is_data(const char *uri);

/* Percent-decoding. A broken escape or an encoded zero byte is an error. */
bool uri_decode(const char *uri, Arena *arena, char **out, Error *err);

/* The bytes of a data: URI; *media_type (may be NULL) is its type, "" if it has none. */
bool data_uri_decode(const char *uri, Arena *arena, FileBytes *out, const char **media_type,
                     Error *err);

#ifdef __cplusplus
}
#endif
