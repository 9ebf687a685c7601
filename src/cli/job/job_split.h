/* SPDX-License-Identifier: Apache-2.0 */
/* job_split.h -- how a frame is cut into parts.
 *
 * Memory   the arena's.
 * Fails    ERROR_USAGE: more parts than there are samples, or rows.
 */
#pragma once
#include "base/error.h"
#include "cli/job/job.h"

typedef enum JobSplit {
    JOB_SPLIT_SAMPLES, /* every part has all pixels: equal work; each holds a whole film */
    JOB_SPLIT_ROWS     /* all samples of some rows: little memory and small files */
} JobSplit;

/* The names of --split, in the order of JobSplit. */
#define JOB_SPLITS "samples|rows"

/* `count` parts of `whole`, in order, whose sizes differ by one at most. */
bool job_split(const JobPart *whole, JobSplit how, int count, Arena *arena, JobPart **out,
               Error *err);
