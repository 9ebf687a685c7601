/* SPDX-License-Identifier: Apache-2.0 */
/* review_draft.h -- a review's files while it is not finished: DIR/unfinished holds them, with
 * what goes on after a kill, until they take their places all together.
 *
 *     DIR/unfinished/journal         readings that were taken (keep/journal.h)
 *     DIR/unfinished/HASH.lesson     a moment's trained guide
 *     DIR/unfinished/HASH.checkpoint of the frame in hand
 *     DIR/unfinished/new/            files as they will stand in DIR
 *
 * So what stands in DIR is always of one review: the earlier one until the new one is whole, or
 * has worked for a minute and shows what it knows so far, marked as such.
 * The files then move one by one, within milliseconds, review.json last; a kill in between is
 * replaced by the same command.
 *
 * Memory   from the arena.
 * Threads  one at a time.
 * Fails    with the file or folder that cannot be written.
 */
#pragma once
#include "keep/journal.h"
#include "review/verdict.h"

typedef struct ReviewDraft {
    Arena      *arena;
    const char *target;     /* DIR */
    const char *unfinished; /* DIR/unfinished */
    const char *folder;     /* DIR/unfinished/new */
    Journal    *journal;
} ReviewDraft;

/* Makes the folders that are not there. Work that was begun before goes on. */
bool review_draft_open(const char *target, Arena *arena, Problems *problems, ReviewDraft *out,
                       Error *err);

/* All files but frames that `review` does not name take their places, and what the review that
 * stood there named and this one does not is removed. */
bool review_draft_publish(const ReviewDraft *draft, const Review *review, Arena scratch,
                          Error *err);

/* Nothing is left to go on with. */
void review_draft_finish(ReviewDraft *draft);

/* After a failure: what was found stays; folders and a journal with nothing in them go. */
void review_draft_close(ReviewDraft *draft);
