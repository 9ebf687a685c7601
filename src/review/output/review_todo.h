/* SPDX-License-Identifier: Apache-2.0 */
/* review_todo.h -- from what fails to what would help: one sentence for every failure, of the
 * words of review/terms.h. A level that is named was judged, or follows from a law that is linear
 * in it, with the end of the interval that is farthest from the limit; none lies above what the
 * display has been measured with (or stands at), nor so low that nothing of it is seen.
 *
 * Memory   the arena's. Texts are UTF-8 and not escaped. Threads: pure. Fails: never.
 */
#pragma once
#include "base/arena.h"
#include "review/finding.h"

/* "": it passes, or nothing is known that would help. */
const char *todo_of_finding(const Finding *finding, Arena *arena);
const char *todo_of_case(const ReviewCase *c, Arena *arena);
