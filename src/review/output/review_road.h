/* SPDX-License-Identifier: Apache-2.0 */
/* review_road.h -- gazes at roads that are lit by night: what the page, the console and tables
 * show of their threshold increment, and of the levels that keep a limit of it.
 *
 * Memory   the document's (jansson) and the arena's. Threads: one at a time. Fails: never.
 */
#pragma once
#include <jansson.h>

#include "base/arena.h"
#include "review/road_verdict.h"

/* "threshold increment 24.7 +- 0.3 %, required <= 15 %, at 70 years on a road of 0.3 cd/m2
 * (with the veil by CIE 135 21 %); displays make 98 % of it, screen 80 %, all straight"; why it
 * was not evaluated, or is not judged. */
const char *road_words(const GazeFinding *gaze, Arena *arena);

/* "pass", "fail", ...; "no limit", "not evaluated". */
const char *road_outcome(const GazeFinding *gaze);

/* Adds `roads` to the page's document. */
void road_add_values(json_t *document, const Review *review, Arena *arena);
