/* SPDX-License-Identifier: Apache-2.0 */
/* review_print.h -- a review's answer on stdout: a line a case, or review.json.
 *
 * Memory   scratch only. Threads: one at a time. Fails: when stdout cannot be written.
 */
#pragma once
#include "cli/options/cli.h"
#include "review/verdict.h"

bool review_print(const Cli *cli, const Review *review, Arena scratch, Error *err);
