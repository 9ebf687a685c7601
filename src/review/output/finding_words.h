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

/* Why it has its verdict: "contrast 1.64 : 1 (minimum 2 : 1)", with what is known of it
 * besides. */
const char *finding_reason(const Finding *finding, Arena *arena);

/* "14.2° up, 16.6° right" */
const char *words_pane_where(const PaneFinding *f, Arena *arena);
