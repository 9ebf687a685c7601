/* SPDX-License-Identifier: Apache-2.0 */
/* sbatch.h -- hands a batch script to Slurm. The only place where this program starts another
 * one, and only when the user asked for it (--submit): no shell is between.
 *
 * Threads  one at a time.
 * Fails    ERROR_INPUT in one line: there is no sbatch, or with what it said last.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"

/* after: the number of a job whose end, well or not, is waited for; NULL: none. *id: the number
 * of the job, in the arena. */
bool sbatch_submit(const char *script, const char *after, Arena *arena, const char **id,
                   Error *err);
