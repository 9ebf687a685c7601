/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/folders.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "compare/input.h"
#include "base/lines.h"

#define MOST_LEVELS 64 /* of folders in folders: links may go round in circles */

bool is_folder(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && S_ISDIR(info.st_mode);
}

/* below: "" or "sub/folder/". */
static bool list_folder(const char *top, const char *below, int level, Lines *names, Error *err)
{
    const char *path = arena_format(names->arena, "%s/%s", top, below);
    if (level > MOST_LEVELS)
        return error_at(err, ERROR_INPUT, path, "", "more than %d folders inside one another",
                        MOST_LEVELS);
    DIR *folder = opendir(path);
    if (!folder)
        return error_at(err, ERROR_INPUT, path, "", "cannot be opened: %s", strerror(errno));
    bool                 ok = true;
    const struct dirent *entry;
    while (ok && (entry = readdir(folder))) {
        if (entry->d_name[0] == '.') continue;
        const char *name = arena_format(names->arena, "%s%s", below, entry->d_name);
        if (is_folder(arena_format(names->arena, "%s/%s", top, name)))
            ok = list_folder(top, arena_format(names->arena, "%s/", name), level + 1, names,
                             err);
        else if (input_has_known_ending(name))
            lines_put(names, name);
    }
    closedir(folder);
    return ok;
}

static int by_name(const void *a, const void *b)
{
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

static bool sorted_names(const char *top, Arena *arena, Lines *out, Error *err)
{
    *out = (Lines){.arena = arena};
    if (!list_folder(top, "", 0, out, err)) return false;
    if (out->count > 1) qsort(out->list, (size_t)out->count, sizeof *out->list, by_name);
    return true;
}

/* Without the slashes at the end. */
static const char *trimmed(const char *path, Arena *arena)
{
    size_t length = strlen(path);
    while (length > 1 && path[length - 1] == '/') length--;
    return arena_string(arena, path, length);
}

bool folders_match(const char *reference, const char *test, Arena *arena, FolderPairs *out,
                   Error *err)
{
    Lines a, b;
    reference = trimmed(reference, arena);
    test = trimmed(test, arena);
    if (!sorted_names(reference, arena, &a, err) || !sorted_names(test, arena, &b, err))
        return false;
    if (a.count == 0 && b.count == 0)
        return error_at(err, ERROR_INPUT, reference, "",
                        "there is no picture in this folder nor in %s", test);
    *out = (FolderPairs){ARENA_NEW(arena, FolderPair, a.count + b.count), 0};
    for (int i = 0, j = 0; i < a.count || j < b.count;) {
        int order = i == a.count ? 1 : j == b.count ? -1 : strcmp(a.list[i], b.list[j]);
        const char *name = order <= 0 ? a.list[i] : b.list[j];
        out->list[out->count++] = (FolderPair){
            name, order <= 0 ? arena_format(arena, "%s/%s", reference, name) : NULL,
            order >= 0 ? arena_format(arena, "%s/%s", test, name) : NULL};
        i += order <= 0;
        j += order >= 0;
    }
    return true;
}
