/* SPDX-License-Identifier: Apache-2.0 */
#include "text/name_hint.h"

#include <dirent.h>
#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "text/uri.h"

enum { MOST_ENTRIES = 100000 };

/* The name without escapes. */
static const char *plain_name(const char *name, Arena *arena) {
    Error ignored;
    char *plain;
    return uri_decode(name, arena, &plain, &ignored) ? plain : name;
}

/* ---- one folder -------------------------------------------------------------------------- */

static const char *find_like(const char *folder, const char *name, Arena *arena) {
    const char *wanted = plain_name(name, arena), *found = NULL;
    DIR *entries = opendir(folder);
    for (int i = 0; entries && i < MOST_ENTRIES; i++) {
        const struct dirent *entry = readdir(entries);
        if (!entry) break;
        Arena scratch = *arena;
        if (strcasecmp(plain_name(entry->d_name, &scratch), wanted) != 0) continue;
        if (!found || strcmp(entry->d_name, found) < 0)
            found = arena_string(arena, entry->d_name, strlen(entry->d_name));
    }
    if (entries) closedir(entries);
    return found;
}

/* In what the names differ; bits. */
enum { BY_CASE = 1, BY_ESCAPES = 2 };

static unsigned differences(const char *name, const char *found, Arena scratch) {
    const char *a = plain_name(name, &scratch), *b = plain_name(found, &scratch);
    unsigned out = strcmp(a, b) != 0 ? BY_CASE : 0;
    if (!out || !strcmp(a, name) != !strcmp(b, found)) out |= BY_ESCAPES;
    return out;
}

static const char *words_of(unsigned differs, Arena *arena) {
    const char *words = differs & BY_CASE ? "its letter case differs" : "";
    if (differs & BY_ESCAPES)
        words = arena_format(arena, "%s%sonly its percent escapes (%%20) differ", words,
                             *words ? ", " : "");
    return words;
}

/* ---- the whole path ---------------------------------------------------------------------- */

const char *name_hint(const char *path, Arena *arena) {
    unsigned differs = 0;
    const char *done = path[0] == '/' ? "/" : "", *tail = "";
    for (const char *at = path; *at;) {
        size_t length = strcspn(at, "/");
        const char *name = arena_string(arena, at, length), *own = name;
        at += length + strspn(at + length, "/");
        if (!length) continue;
        if (!file_exists(arena_format(arena, "%s%s", done, name)))
            own = find_like(*done ? done : ".", name, arena);
        if (!own) return "";
        if (own != name) differs |= differences(name, own, *arena);
        tail = differs ? arena_format(arena, "%s%s%s", tail, own, *at ? "/" : "") : "";
        done = arena_format(arena, "%s%s%s", done, own, *at ? "/" : "");
    }
    if (!differs) return "";
    return arena_format(arena, "; \"%s\" is there: %s", tail, words_of(differs, arena));
}
