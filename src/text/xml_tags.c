/* SPDX-License-Identifier: Apache-2.0 */
#include "text/xml_tags.h"

#include <stdio.h>
#include <string.h>

/* What holds no tags: behind its end; NULL: it is none of these. */
static const char *skip_section(const char *at)
{
    static const char *const sections[][2] = {{"<!--", "-->"}, {"<![CDATA[", "]]>"},
                                              {"<?", "?>"}, {"<!", ">"}};
    for (int i = 0; i < 4; i++) {
        size_t length = strlen(sections[i][0]);
        if (strncmp(at, sections[i][0], length) != 0) continue;
        const char *end = strstr(at + length, sections[i][1]);
        return end ? end + strlen(sections[i][1]) : at + strlen(at);
    }
    return NULL;
}

/* The tag's last character, or where the text ends. */
static const char *skip_tag(const char *at, int *attributes)
{
    char quote = 0;
    *attributes = 0;
    for (; *at && (quote || *at != '>'); at++) {
        if (quote) quote = *at == quote ? 0 : quote;
        else if (*at == '"' || *at == '\'') quote = *at;
        else *attributes += *at == '=';
    }
    return at;
}

static bool refuse(const char *text, const char *at, const char *file, const char *what,
                   int most, Error *err)
{
    char place[32];
    long line = 1;
    for (; text < at; text++) line += *text == '\n';
    snprintf(place, sizeof place, "line %ld", line);
    return error_at(err, ERROR_INPUT, file, place,
                    "more than %d %s, required: at most that many", most, what);
}

bool xml_tags_check(const char *text, const char *file, Error *err)
{
    int depth = 0, attributes;
    for (const char *at = text; (at = strchr(at, '<'));) {
        const char *begin = at, *behind = skip_section(at);
        if (behind) {
            at = behind;
            continue;
        }
        at = skip_tag(at, &attributes);
        depth += begin[1] == '/' ? -1 : at[-1] != '/';
        if (attributes > XML_ATTRIBUTES_MAX)
            return refuse(text, begin, file, "attributes in one tag", XML_ATTRIBUTES_MAX, err);
        if (depth > XML_DEPTH_MAX)
            return refuse(text, begin, file, "elements within each other", XML_DEPTH_MAX, err);
    }
    return true;
}
