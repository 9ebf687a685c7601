/* SPDX-License-Identifier: Apache-2.0 */
#include "text/text.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/file_write.h"
#include "base/number.h"
#include "print/printable.h"
#include "print/utf8.h"

/* Room for `size` more bytes and the zero behind them. */
static void make_room(Text *text, size_t size) {
    size_t wanted = 2 * (text->size + size) + 4096;
    if (text->size + size < text->capacity) return;
    text->data = arena_grow(text->arena, text->data, text->capacity, wanted, 1);
    text->capacity = wanted;
}

char *text_extend(Text *text, size_t size) {
    make_room(text, size);
    char *room = text->data + text->size;
    text->size += size;
    text->data[text->size] = 0;
    return room;
}

void text_add_bytes(Text *text, const void *bytes, size_t size) {
    if (size) memcpy(text_extend(text, size), bytes, size);
}

void text_add(Text *text, const char *string) {
    text_add_bytes(text, string, strlen(string));
}

void text_format(Text *text, const char *format, ...) {
    va_list arguments, again;
    va_start(arguments, format);
    va_copy(again, arguments);
    make_room(text, 1);
    size_t left = text->capacity - text->size;
    int length = vsnprintf(text->data + text->size, left, format, arguments);
    if (length > 0 && (size_t)length >= left) {
        make_room(text, (size_t)length);
        vsnprintf(text->data + text->size, (size_t)length + 1, format, again);
    }
    if (length > 0) text->size += (size_t)length;
    va_end(again);
    va_end(arguments);
}

bool text_write(const Text *text, const char *path, Error *err) {
    return file_write(path, text->data ? text->data : "", text->size, err);
}

/* ---- inside languages that give some characters a meaning -------------------------------- */

void text_add_printable(Text *text, const char *bytes, size_t size) {
    char one[PRINTABLE_ROOM];
    for (size_t taken; size; bytes += taken, size -= taken) {
        taken = printable_next(bytes, size, one);
        text_add(text, one);
    }
}

/* inf and nan as printf has them are none. */
static bool is_formula(const char *text) {
    double number;
    bool is_word = *text && (!strcmp(text + 1, "inf") || !strcmp(text + 1, "nan"));
    return *text && strchr("=+-@", *text) && !is_word && !number_is(text, &number);
}

void text_add_cell(Text *csv, const char *text) {
    bool is_quoted = strpbrk(text, ",\"") != NULL;
    if (is_quoted) text_add(csv, "\"");
    if (is_formula(text)) text_add(csv, "'");
    for (size_t plain; *text; text += plain) {
        plain = strcspn(text, "\"");
        text_add_printable(csv, text, plain);
        if (text[plain]) text_add(csv, "\"\"");
        plain += text[plain] != '\0';
    }
    if (is_quoted) text_add(csv, "\"");
}

void escape_markup(Text *text, const char *string) {
    char one[PRINTABLE_ROOM];
    for (const char *c = string ? string : ""; *c;) {
        c += printable_next(c, UTF8_BYTES_MAX, one);
        switch (one[0]) {
        case '&': text_add(text, "&amp;"); break;
        case '<': text_add(text, "&lt;"); break;
        case '>': text_add(text, "&gt;"); break;
        case '"': text_add(text, "&quot;"); break;
        case '\'': text_add(text, "&#39;"); break;
        default: text_add(text, one);
        }
    }
}

const char *escape_shell(const char *word, Arena *arena) {
    const char *quoted = "'", *rest = word;
    if (*word && !word[strcspn(word, " \t\n'\"\\$&|;<>()*?#!`~{}[]")]) return word;
    for (const char *mark; (mark = strchr(rest, '\'')); rest = mark + 1)
        quoted = arena_format(arena, "%s%.*s'\\''", quoted, (int)(mark - rest), rest);
    return arena_format(arena, "%s%s'", quoted, rest);
}

/* Adds the part that begins at `text` to the word, and returns its end; NULL: it has none. */
static const char *add_part(const char *text, Text *word) {
    if (*text == '\'') {
        const char *end = strchr(text + 1, '\'');
        if (end) text_add_bytes(word, text + 1, (size_t)(end - text - 1));
        return end ? end + 1 : NULL;
    }
    if (*text != '"') {
        text += *text == '\\';
        if (*text) text_add_bytes(word, text, 1);
        return *text ? text + 1 : NULL;
    }
    for (text++; *text && *text != '"'; text++) {
        text += *text == '\\' && strchr("\"\\$`", text[1]) && text[1];
        text_add_bytes(word, text, 1);
    }
    return *text ? text + 1 : NULL;
}

bool shell_words(const char *line, Lines *words) {
    for (;;) {
        Text word = {.arena = words->arena};
        line += strspn(line, " \t\r\n");
        if (!*line) return true;
        while (line && *line && !strchr(" \t\r\n", *line)) line = add_part(line, &word);
        if (!line) return false;
        lines_put(words, word.size ? arena_string(words->arena, word.data, word.size) : "");
    }
}
