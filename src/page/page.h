/* SPDX-License-Identifier: Apache-2.0 */
/* page.h -- one self-contained HTML page: what all reports have in common.
 *
 * A page is a template over values (template.h). It opens anywhere: it uses no network, holds
 * its pictures, is light or dark as the reader has it, can be printed, and shows everything
 * without script. page.css names the classes that all pages share.
 *
 * Memory   the text's and the arena's; values are jansson's. Give a page a text with an arena
 *          for itself: then it grows in place.
 * Threads  one at a time per text.
 * Fails    for a picture that cannot be encoded and a file that cannot be written.
 */
#pragma once
#include <jansson.h>
#include <stdint.h>

#include "base/error.h"
#include "image/picture.h"
#include "page/template.h"
#include "text/text.h"

/* The file of a firm's own style, behind that of every page: CSS. */
#define PAGE_STYLE_VARIABLE "PARHELION_STYLE"

/* The values that every page has: the window's title, the command that made it. Fails for a style
 * that cannot be read. */
bool page_set_head(json_t *values, const char *title, const char *command, Error *err);

/* Names a text; NULL is null. */
void page_set(json_t *values, const char *name, const char *text);
void page_set_flag(json_t *values, const char *name, bool is_set);
void page_set_count(json_t *values, const char *name, long count);

/* A new object at the end of a list, the list's. */
json_t *page_add(json_t *list);

/* Takes the values. The page is written as a whole. */
bool page_write_values(const char *page, json_t *values, const PageFormat *formats,
                       const char *path, Error *err);

/* Parts that were made one by one, as one file. */
bool page_write(const Text *const *parts, int count, const char *path, Error *err);

/* ---- pictures and numbers ---------------------------------------------------------------- */

/* "data:image/png;base64,...", as a value. */
json_t *page_bytes(const char *kind, const void *bytes, size_t size, Arena scratch);

/* The same of a picture, as PNG or JPEG. NULL, *err filled: it cannot be encoded. */
json_t *page_picture(const Picture *picture, bool is_jpeg, Arena scratch, Error *err);

/* For a script, which unpacks it by DecompressionStream('deflate'): base64 of a zlib stream (RFC
 * 1950). The same bytes give the same text (of one version of zlib). NULL: memory is out. */
const char *page_deflated(const void *bytes, size_t size, Arena *arena, Error *err);

/* Packed: whole numbers of 1 to 4 bytes, the same of their bytes in planes: the lowest byte of all
 * numbers, then the next of all, ...; of each plane the first byte, then every byte less the one
 * before it, modulo 256. What changes little from number to number is short so.
 *
 * values: the lowest `bytes` of each go in. */
const char *page_packed(const uint32_t *values, size_t count, int bytes, Arena *arena, Error *err);
