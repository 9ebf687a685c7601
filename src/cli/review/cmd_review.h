/* SPDX-License-Identifier: Apache-2.0 */
/* cmd_review.h -- the command of this folder, for other commands, too. */
#pragma once
#include "cli/options/command.h"
#include "cli/review/review_job.h"

/* argv as the command's. Of a part there is no answer, and no file but those of the task. */
Outcome cmd_review_run(int argc, char **argv, const ReviewTask *task, Arena *arena,
                       Error *err);

extern const Command command_review;
