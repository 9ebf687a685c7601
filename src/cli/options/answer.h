/* SPDX-License-Identifier: Apache-2.0 */
/* answer.h -- how answers, errors and warnings leave the program: answers go to stdout,
 * everything else to stderr.
 *
 * Threads  one at a time.
 * Fails    where a document cannot be made. That stdout was not written is found once, at the
 *          end of the program (main.c).
 */
#pragma once
#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>

#include "base/error.h"
#include "base/problems.h"
#include "table/table.h"

/* Prints the document to stdout with a newline, and releases it. */
bool cli_print_json(json_t *document, Error *err);

/* The document, or what people read of it: the columns of the kind. */
bool cli_print_answer(const TableKind *kind, json_t *document, bool as_json, Error *err);

/* The document into a file, which it does not release. */
bool cli_write_json(const json_t *document, const char *path, Error *err);

/* `parhelion: FILE: what is wrong (where) — what to do`: one line in buffer, no newline. */
void cli_error_line(const Error *error, char *buffer, int size);

/* The line on stderr, and with json also the error document on stdout. */
void cli_report_error(const Error *error, bool json);

/* Every warning of the list, once each, as one line on stderr: `parhelion: warning: ...`. */
void cli_print_warnings(const Problems *problems);

/* The same warnings as a JSON list of {"file","path","severity","message"}. */
json_t *cli_json_problems(const Problems *problems, Severity severity);

/* Columns of a frame: its relative error, and the one that there may be where its light is rare
 * (film.h). */
#define ERROR_COLUMN(key_, words_, none_) \
    {.key = key_, .words = words_, .unit = "%", .places = 4, .times = 100, .none = none_}
#define RARE_COLUMN \
    {.key = "rare_error", \
     .words = "rare light: error", \
     .unit = "% if what single samples brought to some pixels is everywhere", \
     .places = 4, \
     .times = 100, \
     .about = "null: it is not rare"}
