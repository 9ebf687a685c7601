/* SPDX-License-Identifier: Apache-2.0 */
#include "equip/equip_shipped.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/program.h"
#include "text/nearest_word.h"

#define NAMES_MAX 256

const ShippedKind shipped_panels = {"panel", "assets/panels", ".panel"};
const ShippedKind shipped_contents = {"content", "assets/content", ".png"};
const ShippedKind shipped_scenes = {"scene", "scenes", ".gltf"};

bool equip_shipped_is_name(const char *text) {
    return !strchr(text, '/') && !strchr(text, '.');
}

/* A checkout has them two folders above the program that was built in it. */
static bool find_folder(const ShippedKind *kind, Arena *arena, const char **path, Error *err) {
    char found[PATH_MAX];
    const ProgramPart part = {arena_format(arena, "the folder of %ss", kind->what),
                              arena_format(arena, "../../%s", kind->folder),
                              arena_format(arena, INSTALLED_SHARE "/%s", kind->folder)};
    if (!program_find(&part, found, err)) return false;
    *path = arena_string(arena, found, strlen(found));
    return true;
}

const char *equip_shipped_assets(Arena *arena) {
    const ShippedKind assets = {"asset", "assets", ""};
    const char *path;
    Error none;
    return find_folder(&assets, arena, &path, &none) ? path : NULL;
}

static int by_name(const void *a, const void *b) {
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

const char **equip_shipped_names(const ShippedKind *kind, int *count, Arena *arena) {
    const char **names = ARENA_NEW(arena, const char *, NAMES_MAX);
    const char *path;
    struct dirent *entry;
    Error none;
    *count = 0;
    DIR *folder = find_folder(kind, arena, &path, &none) ? opendir(path) : NULL;
    while (folder && *count < NAMES_MAX && (entry = readdir(folder))) {
        const char *ending = path_ending(entry->d_name);
        if (strcmp(ending, kind->ending) != 0) continue;
        size_t length = (size_t)(ending - entry->d_name);
        names[(*count)++] = arena_string(arena, entry->d_name, length);
    }
    if (folder) closedir(folder);
    qsort(names, (size_t)*count, sizeof *names, by_name);
    return names;
}

bool equip_shipped_find(const ShippedKind *kind, const char *name, Arena *arena, const char **path,
                        Error *err) {
    const char *folder;
    char advice[400];
    int count;
    if (!find_folder(kind, arena, &folder, err)) return false;
    *path = arena_format(arena, "%s/%s%s", folder, name, kind->ending);
    if (file_exists(*path)) return true;
    const char **names = equip_shipped_names(kind, &count, arena);
    return error_set(err, ERROR_INPUT,
                     "'%.60s' is no shipped %s — %s; or a path, as seen from "
                     "the model",
                     name, kind->what,
                     nearest_word_advice(name, names, count, advice, sizeof advice));
}
