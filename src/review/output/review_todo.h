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
#include "review/pane_verdict.h"
#include "review/road_verdict.h"
#include "review/verdict.h"

/* "": it passes, or nothing is asked of it. */
const char *todo_of_case(const ReviewCase *c, Arena *arena);
const char *todo_of_road(const GazeFinding *gaze, Arena *arena);
const char *todo_of_pane(const PaneFinding *pane, Arena *arena);
