/* SPDX-License-Identifier: Apache-2.0 */
/* review_json.h -- a review as JSON; the keys are promised to scripts, and back, to
 * hold another one against it.
 *
 * Figures have six significant digits; what is not a finite number is null. The same review
 * gives the same bytes. Texts that are no UTF-8 lose what is not ASCII (text/json_text.h).
 *
 * Units    as in verdict.h; keys name them.
 * Memory   documents are jansson's: whoever gets one releases it.
 * Threads  pure.
 * Fails    when the file cannot be written; reading with the file, the JSON path, what was
 *          found and what is required. Keys that a later version may add are passed over.
 */
#pragma once
#include <jansson.h>

#include "base/arena.h"
#include "base/error.h"
#include "record/record.h"
#include "review/verdict.h"

/* Of a Review. Of a document that the program keeps for itself (record_keep) all is read back to
 * the last bit but what is said of all conditions together: differences, and their findings. */
extern const RecordFormat review_rows;

/* "findings" has one object a line of a finding (review/finding.h), of one without a line one of
 * its own: {"condition", "eye", "subject", "kind", "when", "finding_verdict", "reason", "counts",
 * "quantity", "limit_name", "unit", "found", "interval", "bound", "limit", "margin", "verdict",
 * "advice", "with_veil", "age_years", "in_pane", "decides"}.
 *
 * {"pass", "strict", "title", "profile", "cases": [...], "sweeps", "responses", "notes"}. */
json_t *review_json(const Review *review);

/* A case of it. */
json_t *review_case_json(const ReviewCase *c);

/* A document becomes a file: review.json, diff.json. Takes the document. */
bool review_json_write(json_t *document, const char *path, Error *err);

/* Reads a file of review_json: every figure to its six digits, null as NaN. All lies in the
 * arena. */
bool review_json_read(const char *file, Arena *arena, Review *out, Error *err);
