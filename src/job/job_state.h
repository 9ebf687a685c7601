/* SPDX-License-Identifier: Apache-2.0 */
/* job_state.h -- how far the parts of a job are, from what lies in its folder.
 *
 * Memory   the arena's.
 * Threads  one at a time; other processes may be at work in the folder.
 */
#pragma once
#include "base/error.h"
#include "base/lines.h"
#include "job/job.h"
#include "job/job_queue.h"
#include "keep/journal.h"

typedef enum JobPartState {
    JOB_PART_MISSING, /* nothing is kept of it, and nobody is known to be at it */
    JOB_PART_QUEUED,  /* it waits in Slurm's queue, whatever it came to before */
    JOB_PART_BEGUN,   /* a checkpoint is there */
    JOB_PART_RUNNING, /* a task is at it: Slurm says so, or its lock (job_part_begin) */
    JOB_PART_FAILED,  /* it ended with an error, or its file is not what it has to be */
    JOB_PART_DONE
} JobPartState;

typedef struct JobPartReport {
    JobPartState state;
    uint32_t     kept;         /* samples of every pixel, or answers, in the furthest
                                  checkpoint */
    int          status;       /* of the failure */
    const char  *reason;       /* its line; NULL: none */
    const char  *worker;       /* "HOST-PID" that holds its lock; NULL: nobody does */
} JobPartReport;

/* The names that lie in the folder. */
bool job_folder_list(const SharedJob *job, Arena *arena, Lines *out, Error *err);

JobPartReport job_part_report(const SharedJob *job, const Lines *folder,
                              const JobQueue *queue, int index, Arena *arena);

/* Whether the part's file is there and is that part, whole. with_sums: every sum is read, and
 * the checksum compared; else its end alone. False: *err is what it is instead; its text is
 * empty where the file is not there. */
bool job_part_is_done(const SharedJob *job, int index, bool with_sums, Arena scratch,
                      Error *err);

/* Notes what has the output's name as the job is planned. Fails: ERROR_OUTPUT. */
bool job_note_replaced(const SharedJob *job, Arena scratch, Error *err);

/* Whether that has the output's name now: a manifest from anywhere may name any file. */
bool job_may_replace(const SharedJob *job, Arena scratch);

/* Whether the output is there and was made of the parts, as it is no older than any. */
bool job_is_merged(const SharedJob *job, Arena scratch);

/* The key of the entry that marks a review's part as done, behind all its answers. */
JournalKey job_part_mark(const SharedJob *job, int index, Arena scratch);

/* Shows others that this process is at the part, by a lock that goes with it; job_part_end
 * takes what it returned. Of several only the first is reported, and on a file system without
 * locks none. */
int job_part_begin(const SharedJob *job, int index, Arena scratch);
void job_part_end(const SharedJob *job, int index, int lock, Arena scratch);

/* Is it a checkpoint of the part, from any writer? */
bool job_is_checkpoint(const char *name, int index);

/* The checkpoint's name for a task of this process. */
const char *job_own_checkpoint(const SharedJob *job, int index, Arena *arena);

/* That one, of a frame: the furthest of those that are there becomes it. Damaged ones are
 * removed. */
const char *job_take_checkpoint(const SharedJob *job, const Lines *folder, int index,
                                Arena *arena);

/* Removes a finished part's checkpoints and its earlier failure. */
void job_part_clean(const SharedJob *job, int index, Arena scratch);

/* Removes the failure of a part that is begun again. */
void job_part_forget_failure(const SharedJob *job, int index, Arena scratch);

/* Keeps why it failed; a folder that cannot be written is no further error. */
void job_part_note_failure(const SharedJob *job, int index, int status, const char *line,
                           Arena scratch);
