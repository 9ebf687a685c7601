/* SPDX-License-Identifier: Apache-2.0 */
/* review_csv.h -- the cases of a review, and its gazes, as tables (RFC 4180): a header with
 * units, one row each, figures as in review.json, an empty cell for what has no value.
 *
 * Threads  pure.
 * Fails    when the file cannot be written.
 */
#pragma once
#include "base/error.h"
#include "review/verdict.h"

bool review_csv_write(const Review *review, const char *path, Error *err);

/* The same of its false suns, one row a condition, eye and mirror. */
bool review_csv_write_false_suns(const Review *review, const char *path, Error *err);
/* Eyes that look elsewhere than at symbols. */
bool review_csv_write_gazes(const Review *review, const char *path, Error *err);
