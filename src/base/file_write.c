/* SPDX-License-Identifier: Apache-2.0 */
#include "base/file_write.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"

#define PATH_BYTES 4096

static bool output_error(const char *path, const char *what, int reason, Error *err) {
    return error_at(err, ERROR_OUTPUT, path, "", "cannot be %s: %s", what, strerror(reason));
}

/* A device or a pipe takes the bytes itself: a rename would put a file in its place. */
static bool is_special(const char *path) {
    struct stat info;
    return stat(path, &info) == 0 && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode);
}

/* A rename would also replace what its owner has protected. */
static bool is_protected(const char *path) {
    return access(path, W_OK) != 0 && errno != ENOENT;
}

/* ---- names beside a path ----------------------------------------------------------------- */

/* A folder that several machines share may see the same process number twice: FNV-1a, 32 bits,
 * of the machine's name distinguishes them. */
static unsigned machine_number(void) {
    char name[256] = "";
    unsigned hash = 2166136261u;
    gethostname(name, sizeof name - 1);
    for (const char *c = name; *c; c++) hash = (hash ^ (unsigned char)*c) * 16777619u;
    return hash;
}

char *file_temporary_name(const char *path, Arena *arena) {
    return arena_format(arena, "%s.%08x-%ld.part", path, machine_number(), (long)getpid());
}

/* The same without an arena. */
static void own_name(const char *path, char name[PATH_BYTES]) {
    snprintf(name, PATH_BYTES, "%s.%08x-%ld.part", path, machine_number(), (long)getpid());
}

/* Where a finished file stands for a moment before it replaces another: the same name for
 * everyone, so that what a killed process left there is gone with the next file. */
static void handover_name(const char *path, char name[PATH_BYTES]) {
    snprintf(name, PATH_BYTES, "%s.parhelion-part", path);
}

static void folder_name(const char *path, char name[PATH_BYTES]) {
    int length = (int)(path_name(path) - path);
    snprintf(name, PATH_BYTES, "%.*s", length ? length : 1, length ? path : ".");
}

/* Room for the longest of them; a file system may allow less than that. */
static bool fits_name(const char *path) {
    char name[PATH_BYTES];
    if (strlen(path) + 48 > sizeof name) return false;
    handover_name(path, name);
    return access(name, F_OK) == 0 || errno != ENAMETOOLONG;
}

/* ---- a file that nobody sees until it is whole ------------------------------------------- */

/* A file without a name in the path's folder: it vanishes with the process. -1 where the file
 * system, or a system without /proc, has no such thing; the reason is in errno. */
static int open_unnamed(const char *path) {
    char folder[PATH_BYTES], proc[64];
    folder_name(path, folder);
    int handle = open(folder, O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
    if (handle < 0) return -1;
    snprintf(proc, sizeof proc, "/proc/self/fd/%d", handle);
    if (access(proc, F_OK) == 0) return handle;
    close(handle);
    errno = EOPNOTSUPP;
    return -1;
}

static bool has_no_unnamed(int reason) {
    return reason == EOPNOTSUPP || reason == EISDIR || reason == EINVAL;
}

/* The one place where a file gets a name that somebody else may have taken before: what stands
 * there is not followed, not waited for and not written over. is_new: nothing may stand there.
 * -1, with errno: 0 where it is no regular file. */
static int open_own(const char *name, bool is_new) {
    int how = is_new ? O_EXCL : 0;
    int handle = open(name, O_RDWR | O_CREAT | how | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666);
    struct stat info;
    if (handle < 0) {
        if (errno == ELOOP || errno == ENXIO || errno == EISDIR) errno = 0;
        return -1;
    }
    if (fstat(handle, &info) == 0 && S_ISREG(info.st_mode)) return handle;
    close(handle);
    errno = 0;
    return -1;
}

bool file_open_own(const char *path, int *out, Error *err) {
    int handle = open_own(path, false);
    if (handle < 0 && !errno)
        return error_at(err, ERROR_OUTPUT, path, "",
                        "is no regular file, and is not opened: remove it");
    if (handle < 0) return output_error(path, "created", errno, err);
    *out = handle;
    return true;
}

/* What a killed process of the same number left there goes, or a link: not what it leads to. */
static int open_own_name(const char *path) {
    char name[PATH_BYTES];
    own_name(path, name);
    unlink(name);
    return open_own(name, true);
}

/* 0, or errno. */
static int open_writer(const char *path, FileWriter *out) {
    FileWriter writer = {.path = path};
    if (is_special(path)) {
        writer.kind = FILE_SPECIAL;
        writer.handle = open(path, O_WRONLY | O_CLOEXEC);
    } else {
        if (!fits_name(path)) return ENAMETOOLONG;
        writer.kind = FILE_UNNAMED;
        writer.handle = open_unnamed(path);
        if (writer.handle < 0 && has_no_unnamed(errno)) {
            writer.kind = FILE_NAMED;
            writer.handle = open_own_name(path);
        }
    }
    *out = writer;
    return writer.handle < 0 ? errno : 0;
}

bool file_writer_open(const char *path, FileWriter *out, Error *err) {
    FileWriter writer;
    int reason = open_writer(path, &writer);
    if (reason) return output_error(path, "created", reason, err);
    *out = writer;
    return true;
}

static bool write_all(int file, const char *bytes, size_t size) {
    while (size) {
        ssize_t n = write(file, bytes, size);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return false;
        bytes += n;
        size -= (size_t)n;
    }
    return true;
}

void file_writer_discard(FileWriter *writer) {
    char name[PATH_BYTES];
    close(writer->handle);
    if (writer->kind != FILE_NAMED) return;
    own_name(writer->path, name);
    unlink(name);
}

static bool writer_failed(FileWriter *writer, const char *path, int reason, Error *err) {
    file_writer_discard(writer);
    return output_error(path, "written", reason, err);
}

bool file_writer_add(FileWriter *writer, const void *bytes, size_t size, Error *err) {
    return write_all(writer->handle, bytes, size) ||
           writer_failed(writer, writer->path, errno, err);
}

/* Gives the unnamed file its name. A link cannot replace a file, a rename can: so where there
 * is one already the new file gets a name beside it first. Another process may do the same at
 * the same time, and take the name away: then again. */
static bool link_unnamed(int handle, const char *path) {
    char proc[64], name[PATH_BYTES];
    snprintf(proc, sizeof proc, "/proc/self/fd/%d", handle);
    handover_name(path, name);
    if (linkat(AT_FDCWD, proc, AT_FDCWD, path, AT_SYMLINK_FOLLOW) == 0) return true;
    for (int attempt = 0; attempt < 16 && (errno == EEXIST || errno == ENOENT); attempt++) {
        unlink(name);
        if (linkat(AT_FDCWD, proc, AT_FDCWD, name, AT_SYMLINK_FOLLOW) != 0) continue;
        if (rename(name, path) == 0) return true;
        int reason = errno;
        if (reason != ENOENT) unlink(name);
        errno = reason;
    }
    return false;
}

/* Still the file that was written: a link in its place does not get the path's name. */
static bool rename_own_name(int handle, const char *place, const char *path) {
    char name[PATH_BYTES];
    struct stat ours, there;
    own_name(place, name);
    if (fstat(handle, &ours) != 0 || lstat(name, &there) != 0) return false;
    errno = ESTALE;
    return ours.st_ino == there.st_ino && ours.st_dev == there.st_dev && rename(name, path) == 0;
}

/* The new name is durable only when the folder is written too; a file system that cannot do
 * that for folders is not a reason to fail. */
static void sync_folder(const char *path) {
    char folder[PATH_BYTES];
    folder_name(path, folder);
    int handle = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (handle < 0) return;
    fsync(handle);
    close(handle);
}

bool file_writer_commit_as(FileWriter *writer, const char *path, Error *err) {
    bool is_file = writer->kind != FILE_SPECIAL;
    if (is_file && (fsync(writer->handle) != 0 || is_protected(path)))
        return writer_failed(writer, path, errno, err);
    if (writer->kind == FILE_UNNAMED && !link_unnamed(writer->handle, path))
        return writer_failed(writer, path, errno, err);
    if (writer->kind == FILE_NAMED && !rename_own_name(writer->handle, writer->path, path))
        return writer_failed(writer, path, errno, err);
    if (close(writer->handle) != 0 && !is_file) return output_error(path, "written", errno, err);
    if (is_file) sync_folder(path);
    return true;
}

bool file_writer_commit(FileWriter *writer, Error *err) {
    return file_writer_commit_as(writer, writer->path, err);
}

bool file_write(const char *path, const void *bytes, size_t size, Error *err) {
    FileWriter writer;
    return file_writer_open(path, &writer, err) && file_writer_add(&writer, bytes, size, err) &&
           file_writer_commit(&writer, err);
}

bool file_check_writable(const char *path, Error *err) {
    FileWriter writer;
    struct stat info;
    if (stat(path, &info) == 0 && S_ISDIR(info.st_mode))
        return output_error(path, "written", EISDIR, err);
    if (is_protected(path)) return output_error(path, "written", errno, err);
    if (is_special(path)) return true;
    int reason = open_writer(path, &writer);
    if (reason) return output_error(path, "written", reason, err);
    file_writer_discard(&writer);
    return true;
}

/* Looked at only after mkdir: a folder that was not there a moment ago may be by now. */
bool folder_make(const char *path, Error *err) {
    struct stat info;
    if (mkdir(path, 0777) == 0) return true;
    int reason = errno;
    if (reason == EEXIST && stat(path, &info) == 0 && S_ISDIR(info.st_mode)) return true;
    return output_error(path, "made", reason == EEXIST ? ENOTDIR : reason, err);
}

bool folder_make_own(const char *path, bool *is_new, Error *err) {
    struct stat info;
    *is_new = mkdir(path, 0777) == 0;
    if (*is_new || (errno == EEXIST && lstat(path, &info) == 0 && S_ISDIR(info.st_mode)))
        return true;
    if (errno == EEXIST)
        return error_at(err, ERROR_OUTPUT, path, "",
                        "is a link or a file, and none is followed: a folder is required — remove "
                        "it, or name another folder");
    return output_error(path, "made", errno, err);
}

void file_remove(const char *path) {
    char name[PATH_BYTES];
    handover_name(path, name);
    unlink(path);
    unlink(name);
}

/* ---- for a writer that needs a path of its own ------------------------------------------- */

bool file_commit(const char *temporary, const char *path, Error *err) {
    int file = open(temporary, O_RDWR | O_CLOEXEC | O_NOFOLLOW);
    bool synced = file >= 0 && fsync(file) == 0;
    int reason = errno;
    if (file >= 0 && close(file) != 0 && synced) {
        synced = false;
        reason = errno;
    }
    if (synced && is_protected(path)) {
        synced = false;
        reason = errno;
    }
    if (synced && rename(temporary, path) == 0) {
        sync_folder(path);
        return true;
    }
    if (synced) reason = errno;
    unlink(temporary);
    return output_error(path, "written", reason, err);
}

void file_discard(const char *temporary) {
    unlink(temporary);
}
