/* SPDX-License-Identifier: Apache-2.0 */
/* job_run.h -- the command lines by which parts of a job are done; and a review that is shared
 * among machines: its parts answer questions (review/run/job.h), and the merge is the review
 * itself, which finds them answered.
 *
 * Memory   the arena's.  Threads  one at a time.
 * Fails    as the review does; ERROR_OUTPUT where a file of the job cannot be written.
 */
#pragma once
#include "cli/options/cli.h"
#include "job/job_state.h"

typedef struct JobWords {
    char **list;
    int    count;
} JobWords;

/* `own`, the command's name first, then threads and progress as typed for this run, then the
 * job's words: a `--` among them ends the options. */
JobWords job_words(const SharedJob *job, const Cli *cli, const char *const *own, int own_count,
                   Arena *arena);

/* Whether this processor has the job's instruction set. Fails: ERROR_MACHINE. */
bool job_check_machine(const SharedJob *job, const char *name, Error *err);

/* Whether a manifest's words are such as `--slurm` leaves there: none that names an output,
 * controls the run or makes something else. Fails: ERROR_INPUT with the first that is not. */
bool job_check_words(const SharedJob *job, Arena scratch, Error *err);

/* Enters the folder from which the job's names are seen. Fails: ERROR_INPUT, also where the
 * manifest has such words: who wrote it is not known. */
bool job_enter(const SharedJob *job, Arena scratch, Error *err);

typedef struct JobReviewPart {
    int              index;
    const char      *name;   /* for messages */
    const Lines *folder; /* what others left of the part is taken over */
} JobReviewPart;

/* The job's folder of names has been entered. */
Outcome job_review_part(const SharedJob *job, const Cli *cli, const JobReviewPart *part,
                        Arena *arena, Error *err);

/* All parts are done. output: as typed; NULL: the job's. The outcome is the review's. */
Outcome job_review_merge(const SharedJob *job, const Cli *cli, const char *output,
                         Arena *arena, Error *err);
