/* SPDX-License-Identifier: Apache-2.0 */
#include "text/escape.h"

#include <string.h>

#include "text/utf8.h"

/* Extensible Markup Language (XML) 1.0, production 2; no deletion either. */
static bool is_allowed(unsigned code)
{
    bool is_control = (code < 0x20 && !strchr("\t\n\r", (int)code)) || code == 0x7f;
    return !is_control && code != 0xfffe && code != 0xffff;
}

void escape_markup(Text *text, const char *string)
{
    for (const char *c = string ? string : ""; *c;) {
        unsigned code = 0;
        int      length = utf8_decode(c, UTF8_BYTES_MAX, &code);
        if (!is_allowed(code)) length = 0;
        switch (*c) {
        case '&': text_add(text, "&amp;"); break;
        case '<': text_add(text, "&lt;"); break;
        case '>': text_add(text, "&gt;"); break;
        case '"': text_add(text, "&quot;"); break;
        case '\'': text_add(text, "&#39;"); break;
        default: text_add_bytes(text, length ? c : "?", length ? (size_t)length : 1);
        }
        c += length ? length : 1;
    }
}

const char *escape_shell(const char *word, Arena *arena)
{
    const char *quoted = "'", *rest = word;
    if (*word && !word[strcspn(word, " \t\n'\"\\$&|;<>()*?#!`~{}[]")]) return word;
    for (const char *mark; (mark = strchr(rest, '\'')); rest = mark + 1)
        quoted = arena_format(arena, "%s%.*s'\\''", quoted, (int)(mark - rest), rest);
    return arena_format(arena, "%s%s'", quoted, rest);
}
