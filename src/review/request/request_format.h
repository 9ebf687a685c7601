/* SPDX-License-Identifier: Apache-2.0 */
/* request_format.h -- the parts of REVIEW.json as rows (record/record.h), and what more than
 * one part of it uses. All of them stand in a ReviewRequest, the view's `whole`; warnings go to
 * its problems.
 *
 * Memory   the view's arena. Threads: one at a time.
 * Fails    as request_read.h.
 */
#pragma once
#include "record/record.h"
#include "review/request/request.h"

extern const RecordFormat review_eye_format, review_gaze_format, review_symbol_format;
extern const RecordFormat review_with_format, review_level_format, review_condition_format;
extern const RecordFormat review_glasses_format, review_variant_format;
extern const RecordFormat review_panes_format;
extern const RecordFormat review_content_format; /* of a ReviewContent: a file by display */

/* What names of them are looked for in. */
extern const RecordNames review_eye_names, review_symbol_names, review_level_names;
extern const RecordNames review_with_names;

/* A word for all of some names, or one by name. */
typedef struct WordOf {
    const char *name;
    int word;
} WordOf;

typedef struct WordsSaid {
    int all; /* -1: they are by name */
    const WordOf *by_name;
    int count;
} WordsSaid;

/* Of a row whose two forms fill a WordsSaid, the second by names: out gets each name's. */
bool request_read_words(const JsonView *view, const RecordRow *row, int *out, Error *err);

/* The forms of a polarity of symbols; the words are in the order of ReviewPolarity. */
extern const RecordRow review_polarity_forms[];

/* A file that was read, once. */
void request_note_input(const JsonView *view, const char *path, uint64_t hash);

/* The same, of a file whose bytes are to be hashed. */
bool request_note_file(const JsonView *view, const char *path, Error *err);
