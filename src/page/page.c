/* SPDX-License-Identifier: Apache-2.0 */
#include "page/page.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <zlib.h>

#include "base/file_write.h"
#include "text/base64.h"
#include "text/text.h"

/* page.css and page.js beside this file; the build embeds them. */
extern const char PAGE_STYLE[], PAGE_SCRIPT[];

void page_begin(Text *page, const PageHead *head)
{
    text_format(page, "<!DOCTYPE html>\n<html lang=\"en\"%s><head><meta charset=\"utf-8\">\n"
                "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
                "<meta name=\"generator\" content=\"Parhelion %s\">\n",
                head->is_dark ? " class=\"dark\"" : "", PARHELION_VERSION);
    if (head->renewed_s)
        text_format(page, "<meta http-equiv=\"refresh\" content=\"%d\">\n", head->renewed_s);
    page_element(page, "title", head->title);
    text_format(page, "<style>\n%s%s</style></head>\n<body><main>\n", PAGE_STYLE, head->style);
}

void page_end(Text *page, const char *command, const char *const *scripts)
{
    text_format(page, "<footer>Parhelion %s, ", PARHELION_VERSION);
    escape_markup(page, command);
    text_add(page, "</footer>\n</main>\n<script>\n");
    text_add(page, PAGE_SCRIPT);
    while (*scripts) text_add(page, *scripts++);
    text_add(page, "</script>\n</body></html>\n");
}

bool page_write(const Text *const *parts, int count, const char *path, Error *err)
{
    FileWriter writer;
    if (!file_writer_open(path, &writer, err)) return false;
    for (int i = 0; i < count; i++)
        if (!file_writer_add(&writer, parts[i]->data, parts[i]->size, err)) return false;
    return file_writer_commit(&writer, err);
}

/* ---- text ------------------------------------------------------------------------------- */

static void add_between(Text *page, const char *before, const char *text, const char *after)
{
    text_add(page, before);
    escape_markup(page, text);
    text_add(page, after);
}

/* <name>, or <name class="kind">. */
static void open_element(Text *page, const char *name, const char *kind)
{
    text_format(page, kind[0] ? "<%s class=\"%s\">" : "<%s>", name, kind);
}

void page_element(Text *page, const char *element, const char *text)
{
    text_format(page, "<%s>", element);
    escape_markup(page, text);
    text_format(page, "</%.*s>\n", (int)strcspn(element, " "), element);
}

void page_fact(Text *page, const char *name, const char *value)
{
    page_element(page, "dt", name);
    page_element(page, "dd", value);
}

void page_list(Text *page, const char *kind, const char *const *texts, int count)
{
    open_element(page, "ul", kind);
    text_add(page, "\n");
    for (int i = 0; i < count; i++) page_element(page, "li", texts[i]);
    text_add(page, "</ul>\n");
}

void page_keys_begin(Text *page)
{
    text_add(page, "<div class=\"key\">\n");
}

void page_key(Text *page, const char *value, const char *name, bool is_bad)
{
    add_between(page, is_bad ? "<div class=\"over\"><b>" : "<div><b>", value, "</b><span>");
    add_between(page, "", name, "</span></div>\n");
}

void page_keys_end(Text *page)
{
    text_add(page, "</div>\n");
}

void page_more_begin(Text *page, const char *text)
{
    add_between(page, "<details><summary>", text, "</summary>\n");
}

void page_more_end(Text *page)
{
    text_add(page, "</details>\n");
}

/* ---- tables ----------------------------------------------------------------------------- */

void page_table_begin(Text *page, const char *title, const char *kind,
                      const PageColumn *columns, int count)
{
    if (title[0]) page_element(page, "h3", title);
    text_add(page, "<div class=\"wide\">");
    open_element(page, "table", kind);
    text_add(page, "<thead><tr>");
    for (int i = 0; i < count; i++) {
        text_add(page, columns[i].is_number ? "<th class=\"n\"" : "<th");
        if (columns[i].hint) add_between(page, " title=\"", columns[i].hint, "\"");
        add_between(page, ">", columns[i].title, "</th>");
    }
    text_add(page, "</tr></thead><tbody>\n");
}

void page_table_end(Text *page)
{
    text_add(page, "</tbody></table></div>\n");
}

void page_row_begin(Text *page, const char *kind)
{
    open_element(page, "tr", kind);
}

void page_row_end(Text *page)
{
    text_add(page, "</tr>\n");
}

void page_cell(Text *page, const char *kind, const char *text)
{
    open_element(page, "td", kind);
    add_between(page, "", text, "</td>");
}

void page_cell_format(Text *page, const char *kind, const char *format, ...)
{
    char    text[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    page_cell(page, kind, text);
}

void page_cell_long(Text *page, const char *text)
{
    add_between(page, "<td><div class=\"long\">", text, "</div></td>");
}

/* ---- pictures --------------------------------------------------------------------------- */

bool page_picture(Text *page, const char *alt, const Picture *picture, bool is_jpeg,
                  Arena scratch, Error *err)
{
    FileBytes   bytes;
    const char *kind = "png";
    PictureFile file = {.bits = 8, .is_srgb = true};
    if (is_jpeg ? !picture_encode_small(picture, &scratch, &bytes, &kind, err)
                : !picture_encode("a.png", picture, file, &scratch, &bytes, err))
        return error_prefix(err, "a picture of the report");
    add_between(page, "<img alt=\"", alt, "\" ");
    text_format(page, "src=\"data:image/%s;base64,", kind);
    base64_encode(page, bytes.data, bytes.size);
    text_add(page, "\">");
    return true;
}

/* ---- numbers for the script ------------------------------------------------------------- */

#define LEVEL 9 /* pages are written once and read often */

bool page_data_add(Text *page, const uint32_t *values, size_t count, int bytes, Arena scratch,
                   Error *err)
{
    size_t size = count * (size_t)bytes;
    uLong  room = compressBound((uLong)size);
    unsigned char *planes = ARENA_NEW(&scratch, unsigned char, size);
    unsigned char *packed = ARENA_NEW(&scratch, unsigned char, room);
    for (size_t at = 0; at < size; at++) {
        size_t   i = at % count;
        unsigned shift = 8 * (unsigned)(at / count);
        uint32_t before = i > 0 ? values[i - 1] >> shift : 0;
        planes[at] = (unsigned char)((values[i] >> shift) - before);
    }
    if (compress2(packed, &room, planes, (uLong)size, LEVEL) != Z_OK)
        return error_set(err, ERROR_MEMORY, "memory is out: numbers of the page");
    base64_encode(page, packed, room);
    return true;
}
