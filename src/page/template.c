/* SPDX-License-Identifier: Apache-2.0 */
#include "page/template.h"

#include <math.h>
#include <string.h>

#include "base/number.h"

#define DEPTH_MOST 32 /* sections and templates within each other */
#define NAME_MOST 64

/* ---- what stands in a template ----------------------------------------------------------- */

typedef enum TagKind {
    TAG_RAW,
    TAG_SECTION,
    TAG_EMPTY,
    TAG_END,
    TAG_PART,
    TAG_VALUE,
    TAG_NOTE,
    TAG_STYLE,
    TAG_SCRIPT,
    TAG_KINDS
} TagKind;

/* The longer of two that begin alike comes first. */
static const struct {
    const char *open, *close;
} MARKS[TAG_KINDS] = {[TAG_RAW] = {"{{{", "}}}"},
                      [TAG_SECTION] = {"{{#", "}}"},
                      [TAG_EMPTY] = {"{{^", "}}"},
                      [TAG_END] = {"{{/", "}}"},
                      [TAG_PART] = {"{{>", "}}"},
                      [TAG_VALUE] = {"{{", "}}"},
                      [TAG_NOTE] = {"<!--", "-->"},
                      [TAG_STYLE] = {"<link rel=\"stylesheet\" href=\"", "\">"},
                      [TAG_SCRIPT] = {"<script src=\"", "\"></script>"}};

typedef struct Tag {
    TagKind kind;
    const char *begin, *after; /* in the template */
    char name[NAME_MOST];
    const char *format; /* in the name, behind its bar; NULL: none */
} Tag;

static bool starts_with(const char *text, const char *start) {
    return !strncmp(text, start, strlen(start));
}

/* A tag that is no value and has a line to itself takes the line's end with it. */
static const char *behind_line(const Tag *tag, const char *text) {
    const char *before = tag->begin;
    while (before > text && before[-1] == ' ') before--;
    bool is_alone = (before == text || before[-1] == '\n') && *tag->after == '\n';
    if (!is_alone || tag->kind == TAG_VALUE || tag->kind == TAG_RAW) return tag->after;
    return tag->after + 1;
}

static bool read_tag(const char *text, const char *at, Tag *tag) {
    int kind = 0;
    while (kind < TAG_KINDS && !starts_with(at, MARKS[kind].open)) kind++;
    const char *name = kind < TAG_KINDS ? at + strlen(MARKS[kind].open) : NULL;
    const char *end = name ? strstr(name, MARKS[kind].close) : NULL;
    if (!end || (kind >= TAG_STYLE && *name == '{')) return false;
    *tag = (Tag){.kind = (TagKind)kind, .begin = at, .after = end + strlen(MARKS[kind].close)};
    size_t length = (size_t)(end - name);
    if (length < NAME_MOST) memcpy(tag->name, name, length);
    char *bar = strchr(tag->name, '|');
    if (bar && kind == TAG_VALUE) {
        *bar = '\0';
        tag->format = bar + 1;
    }
    tag->after = behind_line(tag, text);
    return true;
}

/* The first in [at, end) of the template that begins at `text`. */
static bool next_tag(const char *text, const char *at, const char *end, Tag *tag) {
    for (; at < end; at++)
        if ((*at == '{' || *at == '<') && read_tag(text, at, tag)) return true;
    return false;
}

/* ---- rendering --------------------------------------------------------------------------- */

typedef struct Render {
    Text *to;
    const PageFormat *formats;
    Arena *scratch;
    Error *err;
    const json_t *context[DEPTH_MOST]; /* the innermost last */
    const json_t *names[DEPTH_MOST]; /* of an item: the members of all items of its list; or NULL */
    int depth;
    bool is_csv, is_indented; /* kinds of files: .csv; all but .html */
    const char *file, *text;  /* the template in hand, */
    const Tag *tag;           /* and the tag */
} Render;

static bool render(Render *r, const char *at, const char *end);

static bool fails(const Render *r, const char *what) {
    char where[32];
    long line = 1;
    for (const char *c = r->text; c < r->tag->begin; c++) line += *c == '\n';
    snprintf(where, sizeof where, "line %ld", line);
    return error_at(r->err, ERROR_LIBRARY, r->file, where, "%s '%s'", what, r->tag->name);
}

/* Templates of HTML are indented, the page is not; a line of CSV ends as RFC 4180 says. */
static void add_plain(const Render *r, const char *at, const char *end) {
    bool begins_line = at > r->text && at[-1] == '\n';
    while (begins_line && !r->is_indented && at < end && *at == ' ') at++;
    while (at < end) {
        const char *line = memchr(at, '\n', (size_t)(end - at));
        const char *next = line ? line + 1 : end;
        text_add_bytes(r->to, at, (size_t)((line ? line : end) - at));
        if (line) text_add(r->to, r->is_csv ? "\r\n" : "\n");
        while (line && !r->is_indented && next < end && *next == ' ') next++;
        at = next;
    }
}

static void add_words(const Render *r, const char *words) {
    if (r->is_csv) text_add_cell(r->to, words);
    else escape_markup(r->to, words);
}

static const char *file_text(const char *name) {
    for (int i = 0; i < page_file_count; i++)
        if (!strcmp(page_file_table[i].name, name)) return page_file_table[i].text;
    return NULL;
}

/* A member of an object; of a list the item of that number, null behind its last; of null
 * null. */
static const json_t *member_of(const json_t *value, const char *name, size_t length) {
    if (json_is_null(value)) return value;
    if (!json_is_array(value)) return json_object_getn(value, name, length);
    uint64_t at = 0;
    number_read_count(name, &at);
    const json_t *item = json_array_get(value, at);
    return item ? item : json_null();
}

/* NULL: no value has that name. */
static const json_t *look_up(const Render *r) {
    const char *name = r->tag->name;
    size_t first = strcspn(name, ".");
    const json_t *found = NULL;
    if (!strcmp(name, ".")) return r->context[r->depth - 1];
    for (int i = r->depth - 1; i >= 0 && !found; i--) {
        found = json_object_getn(r->context[i], name, first);
        if (!found && json_object_getn(r->names[i], name, first)) return NULL;
    }
    for (name += first; found && *name; name += first) {
        first = strcspn(++name, ".");
        found = member_of(found, name, first);
    }
    return found;
}

static bool is_empty(const json_t *value) {
    if (!value || json_is_null(value) || json_is_false(value)) return true;
    return json_is_string(value)    ? json_string_length(value) == 0
           : json_is_array(value)   ? json_array_size(value) == 0
           : json_is_integer(value) ? json_integer_value(value) == 0
                                    : false;
}

/* ---- values ------------------------------------------------------------------------------ */

/* The formats that every page has. NULL: it is none of them. */
static const char *common_format(const char *format, double value, Arena *arena) {
    bool is_printed = (*format == 'f' || *format == 'g') && format[1] && !format[2];
    int digits = is_printed ? format[1] - '0' : 0;
    if (!strcmp(format, "s")) return value == 1 ? "" : "s";
    if (digits < 0 || digits > 9 || !is_printed) return NULL;
    return arena_format(arena, *format == 'f' ? "%.*f" : "%.*g", digits, value);
}

static bool add_number(Render *r, const json_t *value) {
    const char *format = r->tag->format, *words = NULL;
    double number = json_is_number(value) ? json_number_value(value) : (double)NAN;
    Arena scratch = *r->scratch;
    if (!format && json_is_real(value)) format = r->is_csv ? "g6" : "g9";
    if (!format) {
        if (json_is_integer(value)) text_format(r->to, "%lld", json_integer_value(value));
        return true;
    }
    for (const PageFormat *f = r->formats; f && f->name && !words; f++)
        if (!strcmp(f->name, format)) words = f->of(number, &scratch);
    if (!words) words = common_format(format, number, &scratch);
    if (!words && json_is_null(value)) return true; /* it may be a list's, of texts */
    if (!words) return fails(r, "has no such format:");
    add_words(r, words);
    return true;
}

/* How many a list has; or its texts, with what stands behind the bar between them. */
static bool add_list(Render *r, const json_t *list) {
    Arena scratch = *r->scratch;
    Text joined = {.arena = &scratch};
    if (!r->tag->format) text_format(&joined, "%zu", json_array_size(list));
    for (size_t i = 0; r->tag->format && i < json_array_size(list); i++) {
        const char *text = json_string_value(json_array_get(list, i));
        if (i > 0) text_add(&joined, r->tag->format);
        text_add(&joined, text ? text : "");
    }
    if (joined.data) add_words(r, joined.data);
    return true;
}

static bool add_value(Render *r) {
    const json_t *value = look_up(r);
    if (!value) return fails(r, "has no value for");
    if (json_is_array(value)) return add_list(r, value);
    if (!json_is_string(value)) return add_number(r, value);
    if (r->tag->kind == TAG_VALUE) add_words(r, json_string_value(value));
    else text_add_bytes(r->to, json_string_value(value), json_string_length(value));
    return true;
}

/* ---- sections and parts ------------------------------------------------------------------ */

static bool find_end(const Render *r, const char *at, const char *end, Tag *close) {
    int depth = 1;
    for (; next_tag(r->text, at, end, close); at = close->after) {
        depth += close->kind == TAG_SECTION || close->kind == TAG_EMPTY;
        depth -= close->kind == TAG_END;
        if (depth == 0) return !strcmp(close->name, r->tag->name);
    }
    return false;
}

/* The part of the template within a section, once for an item. */
static bool render_item(Render *r, const json_t *item, const json_t *names, const char *at,
                        const char *end) {
    if (r->depth == DEPTH_MOST) return fails(r, "is too deep at");
    r->names[r->depth] = names;
    r->context[r->depth++] = item;
    bool ok = render(r, at, end);
    r->depth--;
    return ok;
}

/* *after: behind the section's end. */
static bool render_section(Render *r, const char *end, const char **after) {
    Tag close;
    const Tag *open = r->tag;
    const json_t *value = look_up(r);
    size_t count = json_is_array(value) ? json_array_size(value) : 1;
    if (!find_end(r, open->after, end, &close)) return fails(r, "has no end of");
    *after = close.after;
    if (open->kind == TAG_EMPTY) return !is_empty(value) || render(r, open->after, close.begin);
    json_t *names = count > 1 ? json_object() : NULL;
    for (size_t i = 0; names && i < count; i++)
        json_object_update_missing(names, json_array_get(value, i));
    bool ok = true;
    for (size_t i = 0; ok && !is_empty(value) && i < count; i++) {
        const json_t *item = json_is_array(value) ? json_array_get(value, i) : value;
        ok = render_item(r, item, names, open->after, close.begin);
    }
    json_decref(names);
    return ok;
}

/* One place of the stack goes to each, so that a part of itself comes to an end. */
static bool render_whole(Render *r, PageFile file) {
    Render part = *r;
    part.file = file.name;
    part.text = file.text;
    part.is_csv = strstr(file.name, ".csv") != NULL;
    part.is_indented = !strstr(file.name, ".html");
    return render_item(&part, r->context[r->depth - 1], r->names[r->depth - 1], file.text,
                       file.text + strlen(file.text));
}

static bool render_part(Render *r) {
    char name[NAME_MOST + 16];
    snprintf(name, sizeof name, "%.*s.html", NAME_MOST, r->tag->name);
    PageFile file = {name, file_text(name)};
    return file.text ? render_whole(r, file) : fails(r, "has no part");
}

static bool add_file(Render *r, const char *element) {
    const char *text = file_text(r->tag->name);
    if (!text) return fails(r, "has no file");
    text_format(r->to, "<%s>\n", element);
    text_add(r->to, text);
    text_format(r->to, "</%s>\n", element);
    return true;
}

static bool add_tag(Render *r, const char *end, const char **after) {
    switch (r->tag->kind) {
    case TAG_VALUE:
    case TAG_RAW: return add_value(r);
    case TAG_SECTION:
    case TAG_EMPTY: return render_section(r, end, after);
    case TAG_PART: return render_part(r);
    case TAG_STYLE: return add_file(r, "style");
    case TAG_SCRIPT: return add_file(r, "script");
    case TAG_NOTE: return true;
    default: return fails(r, "has no beginning of");
    }
}

static bool render(Render *r, const char *at, const char *end) {
    Tag tag;
    const Tag *outer = r->tag;
    bool ok = true;
    while (ok && next_tag(r->text, at, end, &tag)) {
        add_plain(r, at, tag.begin);
        at = tag.after;
        r->tag = &tag;
        ok = add_tag(r, end, &at);
    }
    if (ok) add_plain(r, at, end);
    r->tag = outer;
    return ok;
}

bool page_render_text(Text *to, PageFile page, const json_t *values, const PageFormat *formats,
                      Arena scratch, Error *err) {
    Tag all = {.kind = TAG_PART, .begin = page.text};
    Render r = {.to = to,
                .formats = formats,
                .scratch = &scratch,
                .err = err,
                .context = {values},
                .depth = 1,
                .file = page.name,
                .text = page.text,
                .tag = &all};
    return render_whole(&r, page);
}

bool page_render(Text *to, const char *name, const json_t *values, const PageFormat *formats,
                 Arena scratch, Error *err) {
    return page_render_text(to, (PageFile){name, file_text(name)}, values, formats, scratch, err);
}
