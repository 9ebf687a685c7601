/* SPDX-License-Identifier: Apache-2.0 */
/* condition_file.h -- what a review found of one condition, its variants' verdicts with it, in a
 * file: a review that was stopped goes on with the next condition, and reviews of some
 * conditions each become one (review/engine/engine.h).
 *
 * File     keep/kept.h. Its identity is the text of what decides it: the program, the request
 *          and the files that it names, options, and which condition it is. The files of scenes
 *          stand, with their hashes, in the review's own rows (Review.inputs).
 *          Body: the rows of review.json (output/review_json.h), of the review and of each
 *          variant, as record_keep has them; and the steps of its sweeps.
 * Memory   from the arena.
 * Threads  one at a time.
 * Fails    as kept.h. A file may come from anywhere: what cannot be of the request is refused.
 */
#pragma once
#include "base/lines.h"
#include "review/run/review_run.h"

typedef struct ConditionFound {
    ReviewOutcome own;
    Review *variants; /* [request->variant_count] */
    int variant_count;
    /* of a file: */
    const char *path, *identity;
    const SweepSuns *suns; /* of the condition; a moment has none */
} ConditionFound;

/* The text of what decides it, then a line for each word of the command ("word"). */
const char *condition_identity(const ReviewRun *run, int condition_id, Arena *arena, Error *err);

/* Of such a text: the rest without the lines of a name; the values of these. */
const char *condition_identity_without(const char *identity, const char *name, Arena *arena);
Lines condition_identity_values(const char *identity, const char *name, Arena *arena);

bool condition_read_identity(const char *path, Arena *arena, const char **out, Error *err);

/* "3-noon.condition" */
const char *condition_file_name(const ReviewRequest *request, int condition_id, Arena *arena);

bool condition_write(const ConditionFound *found, const char *path, const char *identity,
                     Arena scratch, Error *err);

/* Checks the file against the request's condition, but not its identity. */
bool condition_read(const ReviewRun *run, int condition_id, const char *path, Arena *arena,
                    ConditionFound *out, Error *err);

/* Are two files of a condition the same but for what is a folder's: frames, names of tables? */
bool condition_same_answers(const char *one, const char *other, Arena scratch, bool *out,
                            Error *err);

/* Is it of that identity, whatever the words, and are the files that were read for it what they
 * were? */
bool condition_is_reusable(const ConditionFound *found, const char *identity, Arena scratch);
