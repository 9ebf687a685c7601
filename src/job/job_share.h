/* SPDX-License-Identifier: Apache-2.0 */
/* job_share.h -- `--slurm N`: a frame or a review becomes a job's folder.
 *
 * Memory   the arena's.
 * Fails    ERROR_OUTPUT where the folder cannot be made, or is another job's; ERROR_INPUT where
 *          sbatch is requested and fails: the folder stays, and the line explains how to go on.
 */
#pragma once
#include <jansson.h>

#include "base/error.h"
#include "job/job.h"

/* --slurm: nothing is done, the work is shared out. */
typedef struct ShareRequest {
    long        parts;   /* 0: it is not */
    const char *split_name; /* how it is cut, for scripts */
    const char *dir;     /* the job's folder; without --job OUTPUT.parts */
    bool        submits; /* runs sbatch */
    int         threads; /* of each task: --threads; 0: not given */
    const char **words;  /* that all parts have */
    int         word_count;
} ShareRequest;

/* job: its kind, output, line, identity, instruction set; of a frame its size and parts, too.
 * answer: gets the document, where one is requested; NULL: lines go to stdout. */
bool job_share(const ShareRequest *request, const SharedJob *job, Arena *arena, json_t **answer,
               Error *err);
