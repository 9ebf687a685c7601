/* SPDX-License-Identifier: Apache-2.0 */
#include "text/xml_text.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "base/count.h"
#include "print/utf8.h"

typedef enum XmlEncoding {
    XML_UTF8, XML_UTF16LE, XML_UTF16BE, XML_LATIN1, XML_ASCII, XML_WINDOWS, XML_UTF32
} XmlEncoding;

static const char *const encoding_names[] = {"UTF-8", "UTF-16LE", "UTF-16BE", "ISO-8859-1",
                                             "US-ASCII", "windows-1252", "UTF-32"};

typedef struct XmlName {
    const char *name;
    XmlEncoding encoding; /* of UTF-16 without an order: either */
} XmlName;

static const XmlName names[] = {
    {"UTF-8", XML_UTF8},          {"UTF8", XML_UTF8},
    {"UTF-16", XML_UTF16LE},      {"UTF-16LE", XML_UTF16LE},
    {"UTF-16BE", XML_UTF16BE},    {"ISO-8859-1", XML_LATIN1},
    {"ISO_8859-1", XML_LATIN1},   {"ISO8859-1", XML_LATIN1},
    {"Latin1", XML_LATIN1},       {"Latin-1", XML_LATIN1},
    {"US-ASCII", XML_ASCII},      {"ASCII", XML_ASCII},
    {"windows-1252", XML_WINDOWS}, {"CP1252", XML_WINDOWS},
};

/* 0x80 to 0x9F of windows-1252; 0: none. */
static const unsigned short windows_codes[32] = {
    0x20AC, 0,      0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021, 0x02C6, 0x2030, 0x0160,
    0x2039, 0x0152, 0,      0x017D, 0,      0,      0x2018, 0x2019, 0x201C, 0x201D, 0x2022,
    0x2013, 0x2014, 0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0,      0x017E, 0x0178};

typedef struct XmlBytes {
    const char *file;
    const unsigned char *data;
    size_t      size, mark; /* bytes of the byte order mark */
    XmlEncoding encoding;   /* by the first bytes; XML_UTF8 stands for all of single bytes */
} XmlBytes;

static XmlBytes find_encoding(const char *file, const FileBytes *bytes)
{
    static const struct {
        const char *bytes;
        size_t      size, mark;
        XmlEncoding encoding;
    } heads[] = {
        {"\xFF\xFE\0\0", 4, 4, XML_UTF32}, {"\0\0\xFE\xFF", 4, 4, XML_UTF32},
        {"<\0\0\0", 4, 0, XML_UTF32},      {"\0\0\0<", 4, 0, XML_UTF32},
        {"\xEF\xBB\xBF", 3, 3, XML_UTF8},  {"\xFF\xFE", 2, 2, XML_UTF16LE},
        {"\xFE\xFF", 2, 2, XML_UTF16BE},   {"<\0", 2, 0, XML_UTF16LE},
        {"\0<", 2, 0, XML_UTF16BE}};
    XmlBytes in = {file, bytes->data, bytes->size, 0, XML_UTF8};
    for (int i = 0; i < COUNT_OF(heads); i++) {
        if (in.size < heads[i].size || memcmp(in.data, heads[i].bytes, heads[i].size)) continue;
        in.mark = heads[i].mark;
        in.encoding = heads[i].encoding;
        break;
    }
    return in;
}

static bool is_wide(XmlEncoding encoding)
{
    return encoding == XML_UTF16LE || encoding == XML_UTF16BE;
}

/* ---- characters -------------------------------------------------------------------------- */

/* The character at `at`; returns its bytes, 0 when there is none. */
static size_t wide_character(const XmlBytes *in, size_t at, unsigned *code)
{
    int high = in->encoding == XML_UTF16BE ? 0 : 1;
    const unsigned char *c = in->data + at;
    if (in->size - at < 2) return 0;
    *code = (unsigned)c[high] << 8 | c[1 - high];
    if (*code >> 11 != 0x1B) return 2;
    if (*code >> 10 != 0x36 || in->size - at < 4) return 0;
    unsigned low = (unsigned)c[2 + high] << 8 | c[3 - high];
    *code = 0x10000 + ((*code & 0x3FF) << 10 | (low & 0x3FF));
    return low >> 10 == 0x37 ? 4 : 0;
}

static size_t character(const XmlBytes *in, size_t at, unsigned *code)
{
    *code = in->data[at];
    if (is_wide(in->encoding)) return wide_character(in, at, code);
    if (in->encoding == XML_UTF8)
        return (size_t)utf8_decode((const char *)in->data + at, in->size - at, code);
    if (in->encoding == XML_WINDOWS && *code >= 0x80 && *code < 0xA0)
        *code = windows_codes[*code - 0x80];
    return in->encoding != XML_ASCII || *code < 0x80;
}

static bool decode(const XmlBytes *in, Arena *arena, const char **out, Error *err)
{
    char *text = ARENA_NEW(arena, char, 3 * (in->size - in->mark) + UTF8_BYTES_MAX), *to = text;
    long  line = 1;
    for (size_t at = in->mark; at < in->size;) {
        unsigned code;
        size_t   taken = character(in, at, &code);
        if (!taken || !code) {
            char place[32];
            snprintf(place, sizeof place, "line %ld", line);
            return error_at(err, ERROR_INPUT, in->file, place,
                            taken && !is_wide(in->encoding) && !in->data[at]
                                ? "has zero bytes (at byte %zu), required: %s"
                                : "holds bytes (at byte %zu) that are no %s",
                            at, encoding_names[in->encoding]);
        }
        line += code == '\n';
        to += utf8_encode(code, to);
        at += taken;
    }
    *out = text;
    return true;
}

/* ---- declaration ------------------------------------------------------------------------- */

/* Characters of the declaration are those of ASCII in every encoding: its text, without the
 * zeros between them. */
static void declaration_of(const XmlBytes *in, char *text, size_t most)
{
    size_t count = 0;
    for (size_t at = in->mark; at < in->size && count + 1 < most; at++)
        if (in->data[at]) text[count++] = (char)in->data[at];
    text[count] = 0;
    char *end = strstr(text, "?>");
    text[strncmp(text, "<?xml", 5) || !end ? 0 : end - text] = 0;
}

/* The name behind encoding=, cut off in place; NULL: none is declared. */
static const char *declared_in(char *text)
{
    char *at = strstr(text, "encoding");
    if (!at) return NULL;
    at += strlen("encoding");
    at += strspn(at, " \t\r\n=");
    if (*at != '"' && *at != '\'') return NULL;
    char *end = strchr(at + 1, *at);
    if (!end) return NULL;
    *end = 0;
    return at + 1;
}

static bool find_name(const XmlBytes *in, const char *declared, XmlEncoding *out, Error *err)
{
    for (int i = 0; i < COUNT_OF(names); i++)
        if (!strcasecmp(names[i].name, declared)) {
            *out = names[i].encoding;
            return true;
        }
    return error_at(err, ERROR_INPUT, in->file, "line 1", "declares the encoding '%.40s', "
                    "required UTF-8, UTF-16, ISO-8859-1, US-ASCII or windows-1252", declared);
}

/* Do the first bytes agree with what is declared? */
static bool check_declared(XmlBytes *in, const char *declared, Error *err)
{
    XmlEncoding named = in->encoding;
    if (!find_name(in, declared, &named, err)) return false;
    /* Programs that write text by characters declare UTF-16 and keep UTF-8 (.NET's do). */
    if (!strcasecmp(declared, "UTF-16") && in->encoding == XML_UTF8) return true;
    bool is_either = !strcasecmp(declared, "UTF-16") && is_wide(in->encoding);
    bool has_mark = in->mark > 0 || is_wide(in->encoding);
    if (!is_either && (is_wide(named) || has_mark) && named != in->encoding)
        return error_at(err, ERROR_INPUT, in->file, "line 1", "declares the encoding '%.40s', "
                        "but its bytes begin as %s does", declared,
                        encoding_names[in->encoding]);
    if (!is_either) in->encoding = named;
    return true;
}

#define DECLARATION_BYTES 512

bool xml_text_read(const char *file, const FileBytes *bytes, Arena *arena, const char **out,
                   Error *err)
{
    char     text[DECLARATION_BYTES];
    XmlBytes in = find_encoding(file, bytes);
    if (in.encoding == XML_UTF32)
        return error_at(err, ERROR_INPUT, file, "line 1", "is UTF-32, required: UTF-8, UTF-16, "
                        "ISO-8859-1, US-ASCII or windows-1252");
    declaration_of(&in, text, sizeof text);
    const char *declared = declared_in(text);
    return (!declared || check_declared(&in, declared, err)) && decode(&in, arena, out, err);
}
