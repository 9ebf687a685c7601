/* SPDX-License-Identifier: Apache-2.0 */
/* template.h -- a page is a template (assets/pages) over a tree of values (a JSON document).
 *
 *   {{name}}          a value, escaped; {{a.b}} a member of a member, {{.}} the item itself
 *   {{a.0}}           the first item of a list; a member of null, and what is behind a list's
 *                     last item, is null: so {{#a.0}} stands about a list that may be empty
 *   {{a}}             of a list how many it has
 *   {{name|format}}   a number in a named format; what is a text already stays as it is
 *   {{name| > }}      the texts of a list, with that between them
 *   {{{name}}}        a value that is markup: a drawing, a picture's bytes
 *   {{#name}} {{/name}}  for each item of a list, within an object; once for a text or number;
 *                     not at all for what is absent, null, false, "", 0 or an empty list
 *   {{^name}} {{/name}}  where the other does not
 *   {{>name}}         the template name.html, with the same values
 *   <link rel="stylesheet" href="x.css">, <script src="x.js"></script> on a line of its own:
 *                     that file as it stands, so that a page needs nothing beside it
 *
 * Escaped is as the file's kind requires: .html and .xml as markup, .csv as a cell (RFC 4180).
 * Names are looked up from the innermost section outwards; one that another item of the same list
 * has, and this one lacks, is absent, whatever lies around has that name. Comments, spaces at the
 * start of a line (of HTML), and lines that hold nothing but one of these stay behind: templates
 * are indented, and read well in a browser as they lie there. There is no other logic.
 *
 * Memory   the text's arena, and scratch for the texts of formats.
 * Threads  one at a time per text; templates are constant.
 * Fails    ERROR_LIBRARY for a name that no value has, a format that is unknown, a section
 *          without its end: template, line and name. None of it hangs on a user's input.
 */
#pragma once
#include <jansson.h>

#include "base/error.h"
#include "text/text.h"

/* A number in words; NaN where the document has null. */
typedef const char *PageFormatOf(double value, Arena *arena);

/* Every page has "s" (the plural's letter; "" for 1), and "f0".."f9", "g1".."g9": printf's. */
typedef struct PageFormat {
    const char *name; /* NULL ends a list */
    PageFormatOf *of;
} PageFormat;

/* What the build embeds: assets/pages. */
typedef struct PageFile {
    const char *name, *text; /* "review.html" */
} PageFile;
extern const PageFile page_file_table[];
extern const int page_file_count;

/* name: "review.html" of assets/pages, which must be there. formats: more than every page has;
 * NULL: none. */
bool page_render(Text *to, const char *name, const json_t *values, const PageFormat *formats,
                 Arena scratch, Error *err);

/* The same of a template that is no file. */
bool page_render_text(Text *to, PageFile page, const json_t *values, const PageFormat *formats,
                      Arena scratch, Error *err);
