/* SPDX-License-Identifier: Apache-2.0 */
/* review_part.h -- a review that is shared: what a part does, and what the whole takes of it.
 *
 * Memory   scratch of the arena.
 * Fails    as the review does; when the user asks to stop, after a line that says how to go on.
 */
#pragma once
#include "cli/review/review_pin.h"

/* Answers the part's questions. responses: the folder that was typed; NULL: the pin's. */
bool review_part(ReviewRun *run, const ReviewPin *pin, const char *responses, Arena *arena,
                 Error *err);

/* What was found before, as far as it is whole. */
void review_take_answers(Journal *journal, const ReviewPin *pin, Arena scratch);

/* The parts' responses, into a folder of the review's own. */
bool review_take_responses(const char *folder, const ReviewPin *pin, Arena scratch, Error *err);
