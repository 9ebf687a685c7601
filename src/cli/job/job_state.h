/* SPDX-License-Identifier: Apache-2.0 */
/* job_state.h -- how far the parts of a job are, from what lies in its folder.
 *
 * Memory   the arena's.
 * Threads  one at a time; other processes may be at work in the folder.
 */
#pragma once
#include "base/error.h"
#include "cli/job/job.h"

typedef enum JobPartState {
    JOB_PART_MISSING, /* nothing is kept of it, whether somebody is at it or not */
    JOB_PART_BEGUN,   /* a checkpoint is there */
    JOB_PART_FAILED,  /* it ended with an error, or its file is not what it has to be */
    JOB_PART_DONE
} JobPartState;

typedef struct JobPartReport {
    JobPartState state;
    uint32_t     samples_kept; /* of every pixel, in the furthest checkpoint */
    int          status;       /* of the failure */
    const char  *reason;       /* its line; NULL: none */
} JobPartReport;

/* The names that lie in the folder. */
typedef struct JobFolder {
    const char **names;
    int          count;
} JobFolder;

bool job_folder_list(const RenderJob *job, Arena *arena, JobFolder *out, Error *err);

JobPartReport job_part_report(const RenderJob *job, const JobFolder *folder, int index,
                              Arena *arena);

/* Whether the part's file is there and is that part, whole. with_sums: every sum is read, and
 * the checksum compared; else its end alone. False: *err says what it is instead; of a file
 * that is not there the text is empty. */
bool job_part_is_done(const RenderJob *job, int index, bool with_sums, Arena scratch,
                      Error *err);

/* The checkpoint of this name for a task of this process: the furthest of those that are there
 * becomes it. Damaged ones are removed. */
const char *job_take_checkpoint(const RenderJob *job, const JobFolder *folder, int index,
                                Arena *arena);

/* Of a part that is done: all its checkpoints, and the failure before. */
void job_part_clean(const RenderJob *job, int index, Arena scratch);

/* Of one that is begun again. */
void job_part_forget_failure(const RenderJob *job, int index, Arena scratch);

/* Keeps why it failed; a folder that cannot be written is no further error. */
void job_part_note_failure(const RenderJob *job, int index, int status, const char *line,
                           Arena scratch);
