/* SPDX-License-Identifier: Apache-2.0 */
/* file_write.h -- writes files so that a half-written one never shows: a file is seen when it
 * is whole and on the disk.
 *
 * Memory   temporary names lie in the arena that is passed in.
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
    int handle;
    FileKind kind;
} FileWriter;

bool file_writer_open(const char *path, FileWriter *out, Error *err);
bool file_writer_add(FileWriter *writer, const void *bytes, size_t size, Error *err);
bool file_writer_commit(FileWriter *writer, Error *err);

/* The same by another name on the same file system, in a folder made meanwhile. */
bool file_writer_commit_as(FileWriter *writer, const char *path, Error *err);
void file_writer_discard(FileWriter *writer);

/* Makes a folder, unless there is one: of several processes that do so at once all succeed. */
bool folder_make(const char *path, Error *err);

/* The same for a folder of ours within another, which may have come from anywhere: no link is
 * followed. *is_new: it was not there. */
bool folder_make_own(const char *path, bool *is_new, Error *err);

/* A file of ours that stays under its name, such as a lock: made where there is none, opened
 * where there is one, to be closed. Only a regular file; no link is followed, no pipe waited
 * for. */
bool file_open_own(const char *path, int *out, Error *err);

/* Removes a file, and what a process that was killed may have left of its successor. */
void file_remove(const char *path);

/* A name beside `path`, for a library that needs a path; unlike any other process's, of this
 * machine or of another that shares the folder. */
char *file_temporary_name(const char *path, Arena *arena);

/* Makes the temporary file's bytes durable and gives it the final name. On failure it is
 * removed. */
bool file_commit(const char *temporary, const char *path, Error *err);

/* Removes a temporary file after a failure. */
void file_discard(const char *temporary);

#ifdef __cplusplus
}
#endif
