/* SPDX-License-Identifier: Apache-2.0 */
#include "text/name_hint.h"

#include <dirent.h>
#include <string.h>
#include <unicode/unorm2.h>
#include <unicode/ustring.h>

#include "base/file.h"
#include "text/uri.h"

enum { LONGEST = 256, MOST_ENTRIES = 100000 };

/* A name without escapes, as UTF-16. */
typedef struct Name {
    UChar   text[LONGEST];
    int32_t length;
    bool    has_escapes;
} Name;

/* False: it is too long, or no UTF-8. */
static bool read_name(const char *text, Arena scratch, Name *out)
{
    Error      ignored;
    char      *plain;
    UErrorCode fault = U_ZERO_ERROR;
    out->has_escapes = uri_decode(text, &scratch, &plain, &ignored) && strcmp(plain, text) != 0;
    if (out->has_escapes) text = plain;
    u_strFromUTF8(out->text, LONGEST, &out->length, text, -1, &fault);
    return U_SUCCESS(fault);
}

static bool is_equal(const Name *a, const Name *b, uint32_t options)
{
    UErrorCode fault = U_ZERO_ERROR;
    return unorm_compare(a->text, a->length, b->text, b->length, options, &fault) == 0 &&
           U_SUCCESS(fault);
}

/* ---- one folder -------------------------------------------------------------------------- */

static const char *find_like(const char *folder, const char *name, Arena *arena)
{
    Name        wanted, own;
    const char *found = NULL;
    DIR        *entries = read_name(name, *arena, &wanted) ? opendir(folder) : NULL;
    for (int i = 0; entries && i < MOST_ENTRIES; i++) {
        const struct dirent *entry = readdir(entries);
        if (!entry) break;
        if (!read_name(entry->d_name, *arena, &own) ||
            !is_equal(&own, &wanted, U_COMPARE_IGNORE_CASE))
            continue;
        if (!found || strcmp(entry->d_name, found) < 0)
            found = arena_string(arena, entry->d_name, strlen(entry->d_name));
    }
    if (entries) closedir(entries);
    return found;
}

/* In what the names differ; bits. */
enum { BY_CASE = 1, BY_DECOMPOSED = 2, BY_COMPOSED = 4, BY_ESCAPES = 8 };

static unsigned differences(const char *name, const char *found, Arena scratch)
{
    Name     a, b;
    unsigned out = 0;
    if (!read_name(name, scratch, &a) || !read_name(found, scratch, &b)) return 0;
    if (!is_equal(&a, &b, 0)) out |= BY_CASE;
    if (u_strCaseCompare(a.text, a.length, b.text, b.length, 0, &(UErrorCode){U_ZERO_ERROR}))
        out |= b.length > a.length ? BY_DECOMPOSED : BY_COMPOSED;
    if (!out || a.has_escapes != b.has_escapes) out |= BY_ESCAPES;
    return out;
}

static const char *words_of(unsigned differs, Arena *arena)
{
    static const char *const WORDS[] = {
        "its letter case differs", "its letters are decomposed Unicode (NFD)",
        "its letters are composed Unicode (NFC)", "only its percent escapes (%20) differ"};
    const char *out = "";
    for (int i = 0; i < 4; i++)
        if (differs >> i & 1)
            out = arena_format(arena, "%s%s%s", out, *out ? ", " : "", WORDS[i]);
    return out;
}

/* ---- the whole path ---------------------------------------------------------------------- */

const char *name_hint(const char *path, Arena *arena)
{
    unsigned    differs = 0;
    const char *done = path[0] == '/' ? "/" : "", *tail = "";
    for (const char *at = path; *at;) {
        size_t      length = strcspn(at, "/");
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
