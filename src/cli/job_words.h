/* SPDX-License-Identifier: Apache-2.0 */
/* job_words.h -- the command lines by which parts of a job are done, and a review is merged.
 *
 * Memory   the arena's.  Threads  one at a time.
 */
#pragma once
#include "cli/job/job.h"
#include "cli/options/cli.h"

typedef struct JobWords {
    char **list;
    int    count;
} JobWords;

/* `own`, the command's name first, then threads and progress as typed for this run, then the
 * job's words: a `--` among them ends the options. */
JobWords job_words(const SharedJob *job, const Cli *cli, const char *const *own, int own_count,
                Arena *arena);

/* Enters the folder from which the job's names are seen. Fails: ERROR_INPUT. */
bool job_enter(const SharedJob *job, Error *err);
