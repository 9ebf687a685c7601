/* SPDX-License-Identifier: Apache-2.0 */
/* review_share.h -- `review --slurm`: a review becomes a job's folder (cli/job/job_share.h).
 *
 * Memory   the command's arena.  Fails  as job_share, and as the review would.
 */
#pragma once
#include "cli/job/job_share.h"
#include "cli/options/cli.h"
#include "cli/review/review_folder.h"
#include "review/run/run.h"

/* Rows of the option table: ShareRequest *. */
#define REVIEW_SHARE_OPTIONS(share)                                                            \
    {"--slurm", OPTION_INTEGER, "N",                                                           \
     "trace nothing: a folder that shares the review in N parts, for Slurm or any other",      \
     &(share)->parts, .low = 1, .high = JOB_PARTS_MAX},                                        \
    {"--job", OPTION_TEXT, "DIR", "that folder (default DIR.parts)", &(share)->dir},           \
    {"--submit", OPTION_FLAG, NULL, "hand it to Slurm's sbatch, and the merge after it",       \
     &(share)->submits}

/* Does it go with what else was typed? not_traced: an option that traces nothing itself, or
 * NULL. */
bool review_share_check(const ShareRequest *share, const char *not_traced, Error *err);

/* The job's folder, and the words of argv that all parts have. */
void review_share_set(ShareRequest *share, int argc, char **argv, const char *output,
                      const Cli *cli, Arena *arena);

/* Everything is loaded and checked as for the review itself. The answer goes to stdout. */
bool review_share(const ShareRequest *share, ReviewFolder *folder, ReviewRun *run, bool json,
                  Arena *arena, Error *err);
