/* SPDX-License-Identifier: Apache-2.0 */
#include "review/review_names.h"

#include "print/utf8.h"

const char *words_case(const ReviewCase *c, Arena *arena)
{
    return arena_format(arena, "%s, seen by %s, %s", c->symbol ? c->symbol : "?",
                        c->eye ? c->eye : "?", c->condition ? c->condition : "?");
}

const char *words_file_name(const char *text, Arena *arena)
{
    char *name = ARENA_NEW(arena, char, WORDS_FILE_NAME_MOST + 1);
    for (int length = 0; *text && length < WORDS_FILE_NAME_MOST; text++) {
        bool is_plain = (*text >= 'a' && *text <= 'z') || (*text >= 'A' && *text <= 'Z') ||
                        (*text >= '0' && *text <= '9') || *text == '_';
        if (!utf8_continues(*text)) name[length++] = is_plain ? *text : '-';
    }
    return name;
}
