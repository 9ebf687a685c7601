/* SPDX-License-Identifier: Apache-2.0 */
/* review_privacy.h -- what is said of a symbol that must not be read (vision/privacy.h).
 *
 * Memory   the document's (jansson). Threads: pure. Fails: never.
 */
#pragma once
#include <jansson.h>

#include "review/verdict.h"

/* Before the reason of its verdict: "must not be read, but can be: "; "": it may be read. */
const char *privacy_words_before(const ReviewCase *c);

/* V and S with their 95 % intervals, whose ends are those of the contrast, the other way round.
 * NaN where the contrast is. */
typedef struct PrivacyFigures {
    double v, v_low, v_high, s, s_low, s_high;
} PrivacyFigures;

PrivacyFigures privacy_figures(const ReviewCase *c);

/* What review.json says of it: those figures, and what keeps it from being read. What is
 * infinite is null. NULL: it may be read. */
json_t *privacy_json(const ReviewCase *c);
