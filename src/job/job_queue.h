/* SPDX-License-Identifier: Apache-2.0 */
/* job_queue.h -- what Slurm has of a job: the numbers under which it was submitted, which the
 * file `submitted` in its folder keeps ("array 41", "merge 42", a line each), and its queue.
 *
 * Memory   the arena's.
 * Threads  one at a time.
 * Fails    ERROR_OUTPUT with the file.
 */
#pragma once
#include "base/error.h"
#include "base/lines.h"
#include "job/job.h"

#define JOB_SUBMITTED "submitted"

typedef enum JobQueued { JOB_NOT_QUEUED, JOB_WAITS, JOB_RUNS } JobQueued;

typedef struct JobQueue {
    Lines          arrays, merges; /* numbers, the latest last */
    Lines          active;         /* of arrays: those of which something is left */
    unsigned char *parts;          /* JobQueued of each */
    JobQueued      merge;
    const char    *silence; /* why Slurm reported nothing of them; NULL: it did, or has none */
} JobQueue;

JobQueue job_queue_read(const SharedJob *job, Arena *arena);

/* kind: "array", "merge". */
bool job_queue_note(const SharedJob *job, const char *kind, const char *id, Arena scratch,
                    Error *err);
