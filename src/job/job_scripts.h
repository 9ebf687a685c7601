/* SPDX-License-Identifier: Apache-2.0 */
/* job_scripts.h -- what of a job's folder is for those who run it: Slurm's two batch scripts,
 * and the plain commands.
 *
 * Fails    ERROR_OUTPUT with the file.
 */
#pragma once
#include "base/error.h"
#include "job/job.h"

#define JOB_ARRAY "array.sbatch"
#define JOB_MERGE "merge.sbatch"
#define JOB_COMMANDS "commands.txt"
#define JOB_REPLACES "replaces.txt"
#define JOB_LOGS "logs"
#define JOB_RESPONSES "responses"

/* threads: of each task, requested from Slurm; 0: nothing is requested. The folder of logs is
 * there already. */
bool job_scripts_write(const SharedJob *job, int threads, Arena scratch, Error *err);

/* How the two scripts are submitted by hand, for a shell. */
const char *job_scripts_by_hand(const SharedJob *job, Arena *arena);
