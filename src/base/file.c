/* SPDX-License-Identifier: Apache-2.0 */
#include "base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define PIECE_BYTES ((size_t)8 << 20) /* at once */

static bool read_all(int file, const FilePieces *how, unsigned char *bytes, size_t size,
                     size_t *got) {
    *got = 0;
    while (*got < size) {
        size_t left = size - *got;
        ssize_t n = read(file, bytes + *got, left < PIECE_BYTES ? left : PIECE_BYTES);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return false;
        if (n == 0) break;
        *got += (size_t)n;
        if (how->on_bytes) how->on_bytes(how->user, *got, size);
    }
    return true;
}

static bool check_size(const char *path, const struct stat *info, size_t max_bytes, Error *err) {
    if (!S_ISREG(info->st_mode))
        return error_at(err, ERROR_INPUT, path, "", "is %s, a file is required",
                        S_ISDIR(info->st_mode) ? "a folder" : "not a regular file");
    if ((unsigned long long)info->st_size > max_bytes)
        return error_at(err, ERROR_INPUT, path, "", "has %lld bytes, at most %zu are read",
                        (long long)info->st_size, max_bytes);
    return true;
}

/* Opens a regular file of at most max_bytes; -1 after an error. */
static int open_regular(const char *path, size_t max_bytes, size_t *size, Error *err) {
    int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    struct stat info;
    if (file < 0 || fstat(file, &info) != 0) {
        int reason = errno;
        if (file >= 0) close(file);
        error_at(err, ERROR_INPUT, path, "", "cannot be opened: %s", strerror(reason));
        return -1;
    }
    if (!check_size(path, &info, max_bytes, err)) {
        close(file);
        return -1;
    }
    *size = (size_t)info.st_size;
    return file;
}

/* What a checkout without Git LFS has in a file's place. */
static bool is_lfs_pointer(const unsigned char *bytes, size_t size) {
    static const char BEGIN[] = "version https://git-lfs.github.com/spec/";
    return size >= sizeof BEGIN - 1 && !memcmp(bytes, BEGIN, sizeof BEGIN - 1);
}

bool file_read_pieces(const char *path, const FilePieces *how, Arena *arena, FileBytes *out,
                      Error *err) {
    size_t size, got = 0;
    int file = open_regular(path, how->is_start ? SIZE_MAX : how->max_bytes, &size, err);
    if (file < 0) return false;
    if (size > how->max_bytes) size = how->max_bytes;
    unsigned char *bytes = arena_try(arena, 1, 1, size + 1); /* the file is open */
    bool done = bytes && read_all(file, how, bytes, size, &got);
    int reason = errno;
    close(file);
    if (!bytes)
        return error_at(err, ERROR_MEMORY, path, "",
                        "is out of memory: %zu bytes required, "
                        "%zu left",
                        size + 1, arena_left(arena));
    if (!done) return error_at(err, ERROR_INPUT, path, "", "cannot be read: %s", strerror(reason));
    bytes[got] = 0;
    if (is_lfs_pointer(bytes, got))
        return error_at(err, ERROR_INPUT, path, "",
                        "is a pointer of Git LFS, required: the file itself — git lfs pull");
    *out = (FileBytes){bytes, got};
    return true;
}

bool file_read(const char *path, size_t max_bytes, Arena *arena, FileBytes *out, Error *err) {
    const FilePieces how = {.max_bytes = max_bytes};
    return file_read_pieces(path, &how, arena, out, err);
}

bool file_read_start(const char *path, size_t max_bytes, Arena *arena, FileBytes *out, Error *err) {
    const FilePieces how = {.max_bytes = max_bytes, .is_start = true};
    return file_read_pieces(path, &how, arena, out, err);
}

FileBytes file_unmarked(FileBytes bytes) {
    size_t mark = bytes.size >= 3 && !memcmp(bytes.data, "\xEF\xBB\xBF", 3) ? 3 : 0;
    return (FileBytes){bytes.data + mark, bytes.size - mark};
}

bool file_text(const char *path, const FileBytes *bytes, const char **out, Error *err) {
    const char *text = (const char *)file_unmarked(*bytes).data;
    if (memchr(bytes->data, 0, bytes->size))
        return error_at(err, ERROR_INPUT, path, "", "has zero bytes, required: text in UTF-8");
    *out = text;
    return true;
}

bool file_exists(const char *path) {
    return access(path, R_OK) == 0;
}

bool file_is_same(const char *a, const char *b) {
    struct stat x, y;
    return !stat(a, &x) && !stat(b, &y) && x.st_dev == y.st_dev && x.st_ino == y.st_ino;
}

/* ---- names ----------------------------------------------------------------------------- */

const char *path_name(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

const char *path_ending(const char *path) {
    const char *name = path_name(path), *dot = strrchr(name, '.');
    return dot && dot != name ? dot : name + strlen(name);
}

char *path_beside(const char *beside, const char *relative, Arena *arena) {
    int folder = (int)(path_name(beside) - beside);
    if (relative[0] == '/') folder = 0;
    return arena_format(arena, "%.*s%s", folder, beside, relative);
}

int path_climb(const char *relative) {
    int depth = 0, lowest = 0;
    for (const char *at = relative; *at;) {
        size_t length = strcspn(at, "/");
        if (length == 2 && at[0] == '.' && at[1] == '.') depth--;
        else if (length && !(length == 1 && at[0] == '.')) depth++;
        if (depth < lowest) lowest = depth;
        at += length + (at[length] == '/');
    }
    return -lowest;
}
