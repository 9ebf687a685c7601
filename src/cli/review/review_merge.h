/* SPDX-License-Identifier: Apache-2.0 */
/* review_merge.h -- reviews of some conditions each (`review --only`) become one, as one command
 * makes it: nothing is traced, the scene is not needed, the request is.
 *
 * Memory   the command's arena.
 * Threads  one at a time.
 * Fails    in one line: parts of other requests, files or programs; conditions that are missing,
 *          or there twice and not the same; ERROR_MACHINE where parts are of different
 *          instruction sets.
 */
#pragma once
#include "base/lines.h"
#include "review/run/review_run.h"

/* A condition in a folder. */
typedef struct MergePart {
    const char *folder, *path, *identity;
} MergePart;

typedef struct ReviewMerge {
    MergePart *parts;
    int count;
    Lines words; /* of the command, that all parts have in common */
} ReviewMerge;

/* Is any of the words a folder, of a review then? */
bool review_merge_is_meant(const char *const *folders, int count);

/* What is in the folders; whether it belongs together. */
bool review_merge_find(const char *const *folders, int count, Arena *arena, ReviewMerge *out,
                       Error *err);

/* The words of a `review` that its parts have in common, without its name (argv[0]). */
const char *const *review_merge_words(int argc, char **argv, Arena *arena, int *count);

/* Sets run->merged. */
bool review_merge_check(const ReviewMerge *merge, ReviewRun *run, Arena *arena, Error *err);

/* The responses that the review names, into its own folder. */
bool review_merge_responses(const ReviewMerge *merge, const Review *review, const char *folder,
                            Arena scratch, Error *err);
