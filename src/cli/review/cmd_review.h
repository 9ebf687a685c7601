/* SPDX-License-Identifier: Apache-2.0 */
/* cmd_review.h -- the command of this folder, for merge, too. */
#pragma once
#include "cli/options/cli.h"

/* Folders of reviews of some conditions each (cli->arguments) become one. output: -o's. */
Outcome cmd_review_merge(const Cli *cli, const char *output, Arena *arena, Error *err);

extern const Command command_review;
