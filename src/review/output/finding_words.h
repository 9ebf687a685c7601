/* SPDX-License-Identifier: Apache-2.0 */
/* finding_words.h -- a finding (review/finding.h) in words.
 *
 * Memory   the arena's. Texts are UTF-8 and not escaped. Threads: pure. Fails: never.
 */
#pragma once
#include "base/arena.h"
#include "review/finding.h"
#include "review/pane_verdict.h"

/* "speed, seen by driver, low sun"; of a sweep how often it fails, too. */
const char *finding_name(const Finding *finding, Arena *arena);

/* Why it has its verdict: "contrast 1.64 : 1, required >= 2 : 1", with what is known of it
 * besides. */
const char *finding_reason(const Finding *finding, Arena *arena);

/* "centre (centre) in windscreen (glass), 14.2° up, 16.6° right: 0.116 cd/m² against 0.140,
 * contrast 0.83 (0.80 to 0.85), at most 0.1 towards road" */
const char *review_pane_words(const PaneFinding *f, Arena *arena);

/* "14.2° up, 16.6° right" */
const char *words_pane_where(const PaneFinding *f, Arena *arena);
