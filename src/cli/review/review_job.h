/* SPDX-License-Identifier: Apache-2.0 */
/* review_job.h -- a review that is a job's, or a part of one: how `review --slurm` makes the
 * job's folder (job/job_share.h), what was planned, what a part does, what the whole takes.
 *
 * Memory   the command's arena.
 * Fails    as job_share, and as the review does; when the user stops it, after a line on
 *          how to go on.
 */
#pragma once
#include "cli/options/cli.h"
#include "job/job_share.h"
#include "review/folder/review_folder.h"
#include "review/run/job.h"
#include "review/run/run.h"

/* A review, or a part of one, that was planned. */
typedef struct ReviewTask {
    const char  *name;        /* of the part, for messages */
    const char  *identity;    /* what its conditions have to be of */
    const char  *isa;         /* taken where the words name none */
    ReviewShare  share;       /* count 0: all, as a user's own command */
    const char  *answers;     /* of a part: the file that it writes, and */
    JournalKey   mark;        /* what that gets last */
    const char **found;       /* files of answers that were found before: those of a part may
                                 be damaged, those of the whole may not */
    int          found_count;
    const char  *responses;   /* where the parts' are, unless the words name a folder; and what
                                 they trained */
    const char  *resume_line; /* the command that goes on with it */
} ReviewTask;

/* Answers the part's questions. responses: the folder that was typed; NULL: the task's. */
Outcome review_part(ReviewRun *run, const ReviewTask *task, const char *responses,
                    Arena *arena, Error *err);

/* Takes the answers found before, as far as they are whole. */
void review_take_answers(Journal *journal, const ReviewTask *task);

/* The parts' responses, into a folder of the review's own. */
bool review_take_responses(const char *folder, const ReviewTask *task, Arena scratch,
                           Error *err);

/* Rows of the option table: ShareRequest *. */
#define REVIEW_SHARE_OPTIONS(share)                                                            \
    {"--slurm", OPTION_INTEGER, "N",                                                           \
     "trace nothing: a folder that shares the review in N parts, for Slurm or any other",      \
     &(share)->parts, .low = 1, .high = JOB_PARTS_MAX},                                        \
    {"--job", OPTION_TEXT, "DIR", "that folder (default DIR.parts)", &(share)->dir},           \
    {"--submit", OPTION_FLAG, NULL, "hand it to Slurm's sbatch, and the merge after it",       \
     &(share)->submits}

/* Does it go with what else was typed? not_traced: an option that traces nothing itself, or
 * NULL. */
bool review_share_check(const ShareRequest *share, const char *not_traced, Error *err);

/* The words of a `review` that its parts have in common, without its name (argv[0]). */
const char **review_part_words(int argc, char **argv, Arena *arena, int *count);

/* The job's folder, and the words of argv that all parts have. */
void review_share_set(ShareRequest *share, int argc, char **argv, const char *output,
                      const Cli *cli, Arena *arena);

/* Everything is loaded and checked as for the review itself. The answer goes to stdout. */
bool review_share(const ShareRequest *share, ReviewFolder *folder, ReviewRun *run, bool json,
                  Arena *arena, Error *err);
