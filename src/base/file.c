/* SPDX-License-Identifier: Apache-2.0 */
#include "base/file.h"

#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file_pieces.h"

bool file_read(const char *path, size_t max_bytes, Arena *arena, FileBytes *out, Error *err)
{
    const FilePieces how = {.max_bytes = max_bytes};
    return file_pieces_read(path, &how, arena, out, err);
}

bool file_read_start(const char *path, size_t max_bytes, Arena *arena, FileBytes *out,
                     Error *err)
{
    const FilePieces how = {.max_bytes = max_bytes, .is_start = true};
    return file_pieces_read(path, &how, arena, out, err);
}

bool file_text(const char *path, const FileBytes *bytes, const char **out, Error *err)
{
    const char *text = (const char *)bytes->data;
    if (memchr(text, 0, bytes->size))
        return error_at(err, ERROR_INPUT, path, "", "has zero bytes, wanted text in UTF-8");
    *out = text + (strncmp(text, "\xEF\xBB\xBF", 3) ? 0 : 3);
    return true;
}

bool file_exists(const char *path)
{
    return access(path, R_OK) == 0;
}

bool file_is_same(const char *a, const char *b)
{
    struct stat x, y;
    return !stat(a, &x) && !stat(b, &y) && x.st_dev == y.st_dev && x.st_ino == y.st_ino;
}

/* ---- names ----------------------------------------------------------------------------- */

const char *path_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

const char *path_ending(const char *path)
{
    const char *name = path_name(path), *dot = strrchr(name, '.');
    return dot && dot != name ? dot : name + strlen(name);
}

char *path_beside(const char *beside, const char *relative, Arena *arena)
{
    int folder = (int)(path_name(beside) - beside);
    if (relative[0] == '/') folder = 0;
    return arena_format(arena, "%.*s%s", folder, beside, relative);
}

int path_climb(const char *relative)
{
    int depth = 0, lowest = 0;
    for (const char *at = relative; *at;) {
        size_t length = strcspn(at, "/");
        if (length == 2 && at[0] == '.' && at[1] == '.')
            depth--;
        else if (length && !(length == 1 && at[0] == '.'))
            depth++;
        if (depth < lowest) lowest = depth;
        at += length + (at[length] == '/');
    }
    return -lowest;
}
