/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/options/roff.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

static const char *escape_of(char letter)
{
    switch (letter) {
    case '\\': return "\\e";
    case '-': return "\\-";
    case '\'': return "\\(aq";
    case '`': return "\\(ga";
    case '^': return "\\(ha";
    case '~': return "\\(ti";
    case '"': return "\\(dq";
    case '|': return "|\\:"; /* lists of values may go on in the next line */
    default: return NULL;
    }
}

/* A point that begins a word may come to begin a line; blanks behind an end of line, as rows of
 * lists have them, would end it in the page, too. */
void roff_put(const char *text, size_t length)
{
    bool begins_line = false;
    for (size_t i = 0; i < length; i++) {
        const char *escape = escape_of(text[i]);
        bool        begins = i == 0 || !isalnum((unsigned char)text[i - 1]);
        begins_line = text[i] == '\n' || (begins_line && text[i] == ' ');
        if (begins_line && text[i] == ' ') continue;
        if (escape) fputs(escape, stdout);
        else if (text[i] == '.' && begins) fputs("\\&.", stdout);
        else putchar(text[i]);
    }
}

void roff_string(const char *text)
{
    roff_put(text, strlen(text));
}

/* "[words](target)" at text: how long it is, 0: there is none; *words: how long they are. */
static size_t link_length(const char *text, size_t length, size_t *words)
{
    const char *close = memchr(text, ']', length);
    if (*text != '[' || !close || close + 1 >= text + length || close[1] != '(') return 0;
    const char *end = memchr(close, ')', length - (size_t)(close - text));
    *words = (size_t)(close - text) - 1;
    return end ? (size_t)(end - text) + 1 : 0;
}

static void put_link(const char *text, size_t length, size_t words)
{
    roff_put(text + 1, words);
    fputs(" (", stdout);
    roff_put(text + words + 3, length - words - 4);
    putchar(')');
}

/* Markup at text, outside of code: how many letters it takes. */
static size_t put_markup(const char *text, size_t left, bool *is_strong)
{
    size_t words, length, mark = *text == '!' && left > 1;
    if (left > 1 && !memcmp(text, "**", 2)) {
        *is_strong = !*is_strong;
        fputs(*is_strong ? "\\fB" : "\\fR", stdout);
        return 2;
    }
    length = link_length(text + mark, left - mark, &words);
    if (!length) return roff_put(text, 1), 1;
    put_link(text + mark, length, words);
    return mark + length;
}

void roff_inline(const char *text, size_t length)
{
    bool is_strong = false;
    for (size_t i = 0; i < length;) {
        const char *code = text[i] == '`' ? memchr(text + i + 1, '`', length - i - 1) : NULL;
        if (code) {
            size_t size = (size_t)(code - text) - i - 1;
            fputs("\\fB", stdout);
            roff_put(text + i + 1, size);
            fputs("\\fR", stdout);
            i += size + 2;
        } else {
            size_t plain = strcspn(text + i + 1, "`*[!") + 1;
            if (plain > length - i) plain = length - i;
            if (strchr("`*[!", text[i])) i += put_markup(text + i, length - i, &is_strong);
            else roff_put(text + i, plain), i += plain;
        }
    }
}

/* No hyphens are added and no blanks: what is searched for is found, what is copied works. */
void roff_title(const char *name, size_t length, int section)
{
    printf("'\\\" t\n.nr HY 0\n.TH \"");
    for (size_t i = 0; i < length; i++) {
        char letter = (char)toupper((unsigned char)name[i]);
        roff_put(&letter, 1);
    }
    printf("\" %d \"\" \"Parhelion " PARHELION_VERSION "\" \"Parhelion\"\n.ad l\n"
           ".SH NAME\n", section);
    roff_put(name, length);
    printf(" \\- ");
}
