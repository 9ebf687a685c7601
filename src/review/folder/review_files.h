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
#define REVIEW_FILES_FIXED 11
extern const char *const review_files_fixed[REVIEW_FILES_FIXED];

/* Names within the folder, "index.html", "sweeps/1-noon.csv"; none where nothing was made.
 * Other names than a review's are left out: a list may come with a folder from anywhere. */
Lines review_files_read(const char *dir, Arena *arena);

bool review_files_write(const char *dir, const Lines *files, Arena scratch, Error *err);

bool review_files_has(const Lines *files, const char *name);

/* Adds a name, once. */
void review_files_add(Lines *files, const char *name);

/* Whether a review may write a file of this name at all. */
bool review_files_may_have(const char *name);

/* Whether a frame or a table of this name belongs to what the review shows. */
bool review_files_is_named(const Review *review, const char *name);

/* All files in a folder and in the folders right below it, hidden ones too. prefix: "", or a
 * folder within it, "sweeps/". */
void review_files_list(Lines *files, const char *folder, const char *prefix);

/* Before the work: false where a file that no review made has a name that this one may need. */
bool review_files_check(const char *dir, const ReviewRequest *request, Arena scratch,
                        Error *err);

/* Before the work: false where one of these files, which are read, has such a name in it, also
 * where a review made it. */
bool review_files_spare(const char *dir, const ReviewRequest *request, const Lines *inputs,
                        Arena scratch, Error *err);

/* That a file of somebody else's stands there. */
bool review_files_refuse(const char *path, Error *err);
