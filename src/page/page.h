/* SPDX-License-Identifier: Apache-2.0 */
/* page.h -- one self-contained HTML page: what all reports have in common.
 *
 * A page opens anywhere: it asks no network, holds its pictures, is light or dark as the reader
 * has it, can be printed, and shows everything without script. A report begins it, adds its
 * parts and ends it; its own style and script come behind the shared ones (page.css names the
 * classes). Every `text` is escaped here; an `element` or `kind` is the program's own markup.
 *
 * Memory   the text's. Give a page a text with an arena for itself: then it grows in place.
 * Threads  one at a time per text.
 * Fails    for a picture that cannot be encoded and a file that cannot be written.
 */
#pragma once
#include <stdint.h>

#include "base/error.h"
#include "image/picture.h"
#include "text/text.h"

typedef struct PageHead {
    const char *title;   /* of the window */
    const char *style;   /* the report's own CSS */
    bool        is_dark; /* for every reader */
    int         renewed_s; /* the file is written anew: it is asked for after so long; 0: not */
} PageHead;

void page_begin(Text *page, const PageHead *head);

/* command: what made the page. scripts: the report's own, NULL behind the last. */
void page_end(Text *page, const char *command, const char *const *scripts);

/* Parts that were made one by one, as one file. */
bool page_write(const Text *const *parts, int count, const char *path, Error *err);

/* ---- text ------------------------------------------------------------------------------- */

/* <element>text</element>; an element is a name, with attributes if need be. */
void page_element(Text *page, const char *element, const char *text);

/* A name and its value, between <dl> and </dl>. */
void page_fact(Text *page, const char *name, const char *value);

/* kind: the list's class. */
void page_list(Text *page, const char *kind, const char *const *texts, int count);

/* Looked at first, between page_keys_begin and page_keys_end: a value above its name. */
void page_keys_begin(Text *page);
void page_key(Text *page, const char *value, const char *name, bool is_bad);
void page_keys_end(Text *page);

/* A part that is closed until the reader opens it. */
void page_more_begin(Text *page, const char *text);
void page_more_end(Text *page);

/* ---- tables ----------------------------------------------------------------------------- */

typedef struct PageColumn {
    const char *title;
    bool        is_number; /* to the right */
    const char *hint;      /* shown when pointed at; NULL: none */
} PageColumn;

/* title: a heading, "" none. kind: the table's class, "" none. It scrolls where it is wide. */
void page_table_begin(Text *page, const char *title, const char *kind,
                      const PageColumn *columns, int count);
void page_table_end(Text *page);

/* kind, of rows and cells: "", or classes: n number, good, bad, same, total. */
void page_row_begin(Text *page, const char *kind);
void page_row_end(Text *page);
void page_cell(Text *page, const char *kind, const char *text);
void page_cell_format(Text *page, const char *kind, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* A text of any length, which scrolls in its cell. */
void page_cell_long(Text *page, const char *text);

/* ---- pictures --------------------------------------------------------------------------- */

/* <img alt="..." src="data:...">, as PNG or JPEG. */
bool page_picture(Text *page, const char *alt, const Picture *picture, bool is_jpeg,
                  Arena scratch, Error *err);

/* ---- numbers for the page's script ------------------------------------------------------- */

/* Packed: whole numbers of 1 to 4 bytes, as base64 of a zlib stream (RFC 1950) of their bytes
 * in planes: the lowest byte of all numbers, then the next of all, ...; of each plane the first
 * byte, then every byte less the one before it, modulo 256. What changes little from number to
 * number is short so. A script unpacks it by DecompressionStream('deflate').
 *
 * values: the lowest `bytes` of each go in. scratch: twice the numbers' bytes. The same numbers
 * give the same text (of one version of zlib). Fails when memory is out. */
bool page_data_add(Text *page, const uint32_t *values, size_t count, int bytes, Arena scratch,
                   Error *err);
