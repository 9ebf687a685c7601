/* SPDX-License-Identifier: Apache-2.0 */
/* review_folder.h -- the folder of a review: page, documents, tables, pictures.
 *
 * index.html (with many cases cases.html beside it), summary-SYMBOL.html, review.json,
 * cases.csv, junit.xml; sweeps/NAME.csv; frames/NAME.exr and .png;
 * responses/NAME.response; run.json with what may differ from run to run; diff.json beside an
 * earlier review; unfinished/ (review_files.h) until all is there.
 *
 * Memory   from the arena.
 * Threads  one at a time.
 * Fails    with the file or folder that cannot be written.
 */
#pragma once
#include "review/folder/review_files.h"
#include "review/run/review_run.h"

typedef struct ReviewFolder {
    const char *target; /* as on the command line */
    const ReviewRequest *request;
    const char *diff;        /* folder of an earlier review; NULL: none */
    const char *summary;     /* the symbol that --summary names; NULL: all */
    const char *const *only; /* conditions that --only names */
    int only_count;
    const char *profile, *root; /* as on the command line; NULL: not given */
    const char *state_text;     /* the same, each option with a blank before it */
    const char *responses;      /* the same, then where they are */
    int threads;
    bool is_strict;
    bool is_alone;          /* --no-variants */
    bool is_without_frames; /* --no-frames */
    bool is_self_contained; /* pictures stand in the page, not beside it */
    Review before;          /* what stood there */
    double begun_s;
    /* since it is open: */
    ReviewDraft draft;
    const char *name;            /* where its files are written: the draft's folder */
    const char *responses_shown; /* as review.json names the folder */
    bool has_own_responses;      /* DIR/responses ... */
    bool responses_are_new;      /* ... which was not there */
} ReviewFolder;

/* Sets where responses are. */
void review_folder_responses(ReviewFolder *folder, Arena *arena);

/* Before the work: makes it and what is in it, sees that it can be written and that frames can
 * be denoised, and reads the earlier review, which may lie in the same folder. What it made is
 * gone again when it fails. */
bool review_folder_open(ReviewFolder *folder, Arena *arena, Error *err);

/* After a failure: what was found is kept; the folders that were made go as far as they are
 * empty. */
void review_folder_close(ReviewFolder *folder);

/* The review is whole: nothing is left to go on with. */
void review_folder_finish(ReviewFolder *folder);

/* The command that makes it. */
const char *review_folder_command(const ReviewFolder *folder, Arena *arena);

/* All files; they take the places of an earlier review's, or of this one's without its pictures.
 * Sets the names of sweeps' tables. */
bool review_folder_write(const ReviewFolder *folder, ReviewOutcome *outcome, Arena *arena,
                         Error *err);
