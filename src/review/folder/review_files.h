/* SPDX-License-Identifier: Apache-2.0 */
/* review_files.h -- which files of a review's folder reviews have made: DIR/made-by-review.txt
 * lists them, a line each. What it does not list is somebody else's, and is neither replaced
 * nor removed. A folder of a version that wrote no list has what its review.json names.
 *
 * Memory   from the arena.
 * Threads  one at a time.
 * Fails    with the file in question.
 */
#pragma once
#include "base/lines.h"
#include "review/request/request.h"
#include "review/verdict.h"

/* Those that any review may have, the list itself among them. */
#define REVIEW_FILES_FIXED 8
extern const char *const review_files_fixed[REVIEW_FILES_FIXED];

/* Before the work: false where a file that no review made has a name that this one may need. */
bool review_files_check(const char *dir, const ReviewRequest *request, Arena scratch, Error *err);

/* Before the work: false where one of these files, which are read, has such a name in it, also
 * where a review made it. */
bool review_files_spare(const char *dir, const ReviewRequest *request, const Lines *inputs,
                        Arena scratch, Error *err);

/* False where a pipe or a device stands in the folder, or right below it, or a link to one: it
 * would be waited for, or written into, where links to files are replaced. */
bool review_files_are_plain(const char *folder, Arena scratch, Error *err);

/* A review's files while it is not finished: DIR/unfinished holds them, with
 * what goes on after a kill, until they take their places all together.
 *
 *     DIR/unfinished/lock            while somebody is at work
 *     DIR/unfinished/N-NAME.condition what was found of a condition (engine/condition_file.h)
 *     DIR/unfinished/HASH.frame      of a frame that is whole
 *     DIR/unfinished/HASH.checkpoint of the frame in hand
 *     DIR/unfinished/new/            files as they will stand in DIR
 *
 * So what stands in DIR is always of one review: the earlier one until the new one is whole.
 * The files then move one by one, within milliseconds, review.json last; a kill in between is
 * replaced by the same command.
 *
 * Memory   from the arena.
 * Threads  one at a time.
 * Fails    with the file or folder that cannot be written. */

/* The folder itself, sweeps, frames, conditions. */
#define REVIEW_PARTS 4

typedef struct ReviewDraft {
    Arena *arena;
    const char *target;     /* DIR */
    const char *unfinished; /* DIR/unfinished */
    const char *folder;     /* DIR/unfinished/new */
    int lock;
    bool unfinished_is_ours, is_ours[REVIEW_PARTS]; /* of DIR: made by reviews, not by the user */
} ReviewDraft;

/* Makes the folders that are not there. Work that was begun before goes on. A folder that
 * is a link is refused: nothing is written or removed behind one. */
bool review_draft_open(const char *target, Arena *arena, ReviewDraft *out, Error *err);

/* Is anything there of a review that was stopped? */
bool review_has_unfinished(const char *target, Arena scratch);

/* All files but frames that `review` does not name take their places, and what the review that
 * stood there named and this one does not is removed. */
bool review_draft_publish(const ReviewDraft *draft, const Review *review, Arena scratch,
                          Error *err);

/* Nothing is left to go on with. */
void review_draft_finish(ReviewDraft *draft);

/* After a failure: what was found stays; folders of reviews with nothing in them go. */
void review_draft_close(ReviewDraft *draft);
