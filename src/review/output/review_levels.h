/* SPDX-License-Identifier: Apache-2.0 */
/* review_levels.h -- visibility levels of a case in words; private to the output and the
 * console.
 *
 * Memory   the arena's. Texts are UTF-8 and not escaped. Threads: pure. Fails: never.
 */
#pragma once
#include "base/arena.h"
#include "review/verdict.h"

/* "visibility level 6.2 at 40 years, 2.9 at 70"; "": the case has none. */
const char *words_levels(const ReviewCase *c, Arena *arena);

/* Behind the figure that made the case's verdict, where it has any. */
const char *words_judged_and_levels(const ReviewCase *c, Arena *arena);

/* One of them: "2.9, 95 % sure between 2.8 and 3.0"; where the formula is doubtful also why. */
const char *words_level(const CaseVisibility *v, Arena *arena);

/* What it is of: "one of its strokes, 2.3 arc minutes wide, looked at in a glance of 0.2 s; the
 * eye adapted to 3.4 cd/m²: ...". */
const char *words_target(const CaseVisibility *v, Arena *arena);

/* Does any case have one? */
bool review_has_levels(const Review *review);
