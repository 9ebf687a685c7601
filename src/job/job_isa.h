/* SPDX-License-Identifier: Apache-2.0 */
/* job_isa.h -- the instruction set that all parts of a job take, so that they have the bits of
 * one run. This machine may know more than those that will do them.
 *
 * Memory   the arena's.
 * Threads  one at a time.
 * Fails    as kernel_choose.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"

/* typed: --isa; NULL: as the job that `dir` holds already, or else the least that the nodes
 * have in common on which Slurm would run it, or where Slurm does not answer this machine's
 * best. */
bool job_isa_choose(const char *typed, const char *dir, Arena *arena, const char **out,
                    Error *err);
