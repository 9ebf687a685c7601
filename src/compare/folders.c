/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/folders.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/file.h"
#include "base/lines.h"
#include "compare/input.h"

#define MOST_LEVELS 64 /* of folders in folders: links may go round in circles */

bool is_folder(const char *path) {
    struct stat info;
    return stat(path, &info) == 0 && S_ISDIR(info.st_mode);
}

static bool is_failed(const char *name) {
    return !strcmp(path_ending(name), FOLDERS_FAILED);
}

/* The picture's name, of its NAME.failed as well. */
static const char *picture_of(const char *name, Arena *arena) {
    size_t left_out = is_failed(name) ? strlen(FOLDERS_FAILED) : 0;
    return arena_string(arena, name, strlen(name) - left_out);
}

/* below: "" or "sub/folder/". */
static bool list_folder(const char *top, const char *below, int level, Lines *names, Error *err) {
    const char *path = arena_format(names->arena, "%s/%s", top, below);
    if (level > MOST_LEVELS)
        return error_at(err, ERROR_INPUT, path, "", "more than %d folders inside one another",
                        MOST_LEVELS);
    DIR *folder = opendir(path);
    if (!folder)
        return error_at(err, ERROR_INPUT, path, "", "cannot be opened: %s", strerror(errno));
    bool ok = true;
    const struct dirent *entry;
    while (ok && (entry = readdir(folder))) {
        if (entry->d_name[0] == '.') continue;
        const char *name = arena_format(names->arena, "%s%s", below, entry->d_name);
        if (is_folder(arena_format(names->arena, "%s/%s", top, name)))
            ok = list_folder(top, arena_format(names->arena, "%s/", name), level + 1, names, err);
        else if (input_has_known_ending(picture_of(name, names->arena))) lines_put(names, name);
    }
    closedir(folder);
    return ok;
}

/* Of pictures, each with its NAME.failed beside it. */
static int by_name(const void *a, const void *b) {
    const char *one = *(const char *const *)a, *other = *(const char *const *)b;
    size_t end = strlen(FOLDERS_FAILED);
    size_t one_size = strlen(one) - (is_failed(one) ? end : 0);
    size_t other_size = strlen(other) - (is_failed(other) ? end : 0);
    int order = memcmp(one, other, one_size < other_size ? one_size : other_size);
    return order ? order : (one_size > other_size) - (one_size < other_size);
}

static bool sorted_names(const char *top, Arena *arena, Lines *out, Error *err) {
    *out = (Lines){.arena = arena};
    if (!list_folder(top, "", 0, out, err)) return false;
    if (out->count > 1) qsort(out->list, (size_t)out->count, sizeof *out->list, by_name);
    return true;
}

/* Without the slashes at the end. */
static const char *trimmed(const char *path, Arena *arena) {
    size_t length = strlen(path);
    while (length > 1 && path[length - 1] == '/') length--;
    return arena_string(arena, path, length);
}

/* The files of one folder, from *next on, that are the picture's. */
static void take_files(const char *top, const Lines *names, int *next, const char *name,
                       const char **picture, const char **failed) {
    Arena *arena = names->arena;
    for (; *next < names->count; (*next)++) {
        const char *file = names->list[*next];
        if (strcmp(picture_of(file, arena), name) != 0) return;
        *(is_failed(file) ? failed : picture) = arena_format(arena, "%s/%s", top, file);
    }
}

bool folders_match(const char *reference, const char *test, Arena *arena, FolderPairs *out,
                   Error *err) {
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
        const char *one = i < a.count ? picture_of(a.list[i], arena) : NULL;
        const char *two = j < b.count ? picture_of(b.list[j], arena) : NULL;
        FolderPair *pair = &out->list[out->count++];
        pair->name = !two || (one && strcmp(one, two) <= 0) ? one : two;
        take_files(reference, &a, &i, pair->name, &pair->reference, &pair->failed);
        take_files(test, &b, &j, pair->name, &pair->test, &pair->failed);
    }
    return true;
}
