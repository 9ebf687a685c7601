/* SPDX-License-Identifier: Apache-2.0 */
/* slurm.h -- hands a batch script to Slurm (--submit), and queries what it has of jobs that
 * were handed to it, and on what nodes. The only place where this program starts another one:
 * no shell is between.
 *
 * Threads  one at a time.
 * Fails    ERROR_INPUT in one line: the program is not there, or with what it said last.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"

/* tasks: of an array job, "0,4-7"; NULL: those that the script names. after: numbers of jobs,
 * with colons, whose end, well or not, is waited for; NULL: none. *id: the number of the job,
 * in the arena. */
typedef struct SlurmScript {
    const char *file, *tasks, *after;
} SlurmScript;

bool slurm_submit(const SlurmScript *script, Arena *arena, const char **id, Error *err);

/* What the nodes on which Slurm would run a job say that they have: a line each,
 * "avx512,gpu", in the arena. */
bool slurm_features(Arena *arena, const char **lines, Error *err);

/* jobs: numbers with commas. Lines "41_3 RUNNING", in the arena, of those that are left, each
 * task of an array by itself. */
bool slurm_queue(const char *jobs, Arena *arena, const char **lines, Error *err);
