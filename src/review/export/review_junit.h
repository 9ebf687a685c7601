/* SPDX-License-Identifier: Apache-2.0 */
/* review_junit.h -- a review as JUnit XML, which every CI service shows: a test case for each
 * case and each sweep, failed with its reason; what cannot be judged is an
 * error; a verdict that fails only under --strict, or what does not count, is "skipped".
 *
 * Well-formed for any names. Threads: pure.
 * Fails    when the file cannot be written.
 */
#pragma once
#include "base/error.h"
#include "review/verdict.h"

bool review_junit_write(const Review *review, const char *path, Error *err);

/* All findings of a review as a table (RFC 4180): a header with units, one row each, figures as in
 * review.json, an empty cell for what has no value.
 *
 * Threads  pure.
 * Fails    when the file cannot be written. */

bool review_csv_write(const Review *review, const char *path, Error *err);
