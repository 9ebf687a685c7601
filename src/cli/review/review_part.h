/* SPDX-License-Identifier: Apache-2.0 */
/* review_part.h -- a review that is shared: what a part does, and what the whole takes of it.
 *
 * Memory   scratch of the arena.
 * Fails    as the review does; when the user asks to stop, after a line on how to go on.
 */
#pragma once
#include "cli/review/review_task.h"

/* Answers the part's questions. responses: the folder that was typed; NULL: the task's. */
bool review_part(ReviewRun *run, const ReviewTask *task, const char *responses, Arena *arena,
                 Error *err);

/* Takes the answers found before, as far as they are whole. */
void review_take_answers(Journal *journal, const ReviewTask *task, Arena scratch);

/* The parts' responses, into a folder of the review's own. */
bool review_take_responses(const char *folder, const ReviewTask *task, Arena scratch,
                           Error *err);
