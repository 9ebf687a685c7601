/* SPDX-License-Identifier: Apache-2.0 */
#include "text/uri.h"

#include <ctype.h>
#include <string.h>
#include <strings.h>

#include "text/base64.h"
#include "text/text.h"

size_t uri_scheme_length(const char *uri) {
    size_t length = 0;
    if (!isalpha((unsigned char)uri[0])) return 0;
    while (isalnum((unsigned char)uri[length]) || strchr("+-.", uri[length] ? uri[length] : ' '))
        length++;
    return uri[length] == ':' ? length : 0;
}

bool uri_is_data(const char *uri) {
    return strncasecmp(uri, "data:", 5) == 0;
}

static int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

/* `length` characters of `text` to `out`, which holds as many; *size is what came out. */
static bool percent_decode(const char *text, size_t length, char *out, size_t *size, Error *err) {
    *size = 0;
    for (size_t i = 0; i < length; i++) {
        char c = text[i];
        if (c == '%') {
            int high = length - i > 2 ? hex_digit(text[i + 1]) : -1;
            int low = high >= 0 ? hex_digit(text[i + 2]) : -1;
            if (low < 0)
                return error_set(err, ERROR_INPUT,
                                 "broken escape \"%.3s\" in a URI, %% and two hexadecimal "
                                 "digits are required",
                                 text + i);
            c = (char)(high * 16 + low);
            i += 2;
        }
        out[(*size)++] = c;
    }
    return true;
}

bool uri_decode(const char *uri, Arena *arena, char **out, Error *err) {
    size_t length = strlen(uri), size, colon = strcspn(uri, ":/?#");
    if (uri[colon] == ':' && !uri_scheme_length(uri)) /* RFC 3986, 4.2 */
        return error_set(err, ERROR_INPUT, "\"%.80s\" is no URI: before the colon no scheme stands",
                         uri);
    char *text = ARENA_NEW(arena, char, length + 1);
    if (!percent_decode(uri, length, text, &size, err)) return false;
    if (memchr(text, 0, size))
        return error_set(err, ERROR_INPUT, "a URI holds an encoded zero byte");
    *out = text;
    return true;
}

/* type/subtype;name=value;...;base64: no part between semicolons may be empty. */
static bool check_media_type(const char *head, size_t length, Error *err) {
    for (size_t i = 0; i < length; i++)
        if (head[i] == ';' && (i + 1 == length || head[i + 1] == ';'))
            return error_set(err, ERROR_INPUT, "the data: URI has an empty part in \"%.*s\"",
                             (int)(length < 80 ? length : 80), head);
    return true;
}

bool data_uri_decode(const char *uri, Arena *arena, FileBytes *out, const char **media_type,
                     Error *err) {
    const char *comma = uri_is_data(uri) ? strchr(uri, ',') : NULL;
    if (!comma) return error_set(err, ERROR_INPUT, "the data: URI has no comma before its data");
    size_t head = (size_t)(comma - uri), length = strlen(comma + 1), size;
    if (!check_media_type(uri, head, err)) return false;
    bool is_base64 = head >= 12 && strncasecmp(comma - 7, ";base64", 7) == 0;
    unsigned char *bytes = ARENA_NEW(arena, unsigned char, length + 1);
    if (is_base64) {
        if (!base64_decode(comma + 1, length, bytes, &size, err)) return false;
    } else if (!percent_decode(comma + 1, length, (char *)bytes, &size, err)) {
        return false;
    }
    bytes[size] = 0;
    if (media_type) *media_type = arena_string(arena, uri + 5, strcspn(uri + 5, ";,"));
    *out = (FileBytes){bytes, size};
    return true;
}

/* Length of the folders that both absolute paths begin with, the slash included. */
static size_t common_folders(const char *a, const char *b) {
    size_t length = 0;
    for (size_t i = 0; a[i] && a[i] == b[i]; i++)
        if (a[i] == '/') length = i + 1;
    return length;
}

static void add_escaped(Text *text, const char *path) {
    static const char plain[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
                                "0123456789-._~/";
    for (; *path; path++)
        if (strchr(plain, *path)) text_format(text, "%c", *path);
        else text_format(text, "%%%02X", (unsigned)(unsigned char)*path);
}

const char *uri_between(const char *folder, const char *file, Arena *arena) {
    Text text = {.arena = arena};
    size_t shared = common_folders(folder, file);
    for (const char *at = folder + shared; *at; at++)
        if (*at == '/') text_add(&text, "../");
    add_escaped(&text, file + shared);
    return text.data ? text.data : "";
}

bool uri_may_be_named(const char *from, const char *uri, ReferenceReach reach, Arena scratch) {
    Error none;
    char *relative;
    const char *path;
    return uri_decode(uri, &scratch, &relative, &none) &&
           reference_resolve(from, relative, reach, &scratch, &path, &none);
}
