/* review_folder.h -- the folder of a review: page, documents, tables, pictures.
 *
 * index.html, review.json, cases.csv, junit.xml; sweeps/NAME.csv; frames/NAME.exr and .png;
 * run.json with what may differ from run to run; diff.json beside an earlier review.
 *
 * Memory   from the arena.
 * Threads  one at a time.
 * Fails    with the file or folder that cannot be written.
 */
#pragma once
#include "review/run/sweep_output.h"

typedef struct ReviewFolder {
    const char          *name;
    const ReviewRequest *request;
    const char          *diff; /* folder of an earlier review; NULL: none */
    const char          *profile, *root; /* as on the command line; NULL: not given */
    int                  threads;
    bool                 is_strict;
    Review               before; /* what stood there */
    double               begun_s;
    const char          *made[3]; /* folders that were not there */
    int                  made_count;
} ReviewFolder;

/* Before the work: makes it and what is in it, sees that it can be written, and reads the
 * earlier review, which may lie in the same folder. What it made is gone again when it fails.
 */
bool review_folder_open(ReviewFolder *folder, Arena *arena, Error *err);

/* After a failure: the folders that were made, as far as they are empty. */
void review_folder_discard(const ReviewFolder *folder);

/* Sets the tables' names in the sweeps. */
bool review_folder_write(const ReviewFolder *folder, ReviewOutcome *outcome, Arena *arena,
                         Error *err);
